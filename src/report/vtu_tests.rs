use std::collections::BTreeMap;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::events::Event;

use super::*;
use crate::report::sample::{Sample, Verdict, assert_well_formed, with_quadrilaterals};
use crate::scene::{Draft, Kinematics, Scene};

/// Name → (type, components, bytes), read with nothing of the writer.
fn arrays(xml: &str) -> BTreeMap<String, (String, usize, Vec<u8>)> {
    let mut reader = quick_xml::Reader::from_str(xml);
    let (mut found, mut current) = (BTreeMap::new(), None);
    loop {
        match reader.read_event().unwrap() {
            Event::Start(start) if start.name().as_ref() == b"DataArray" => {
                let find = |key: &str| {
                    start
                        .try_get_attribute(key)
                        .unwrap()
                        .map(|a| a.normalized_value(quick_xml::XmlVersion::Explicit1_0).unwrap().into_owned())
                };
                let get = |key: &str| find(key).unwrap();
                assert_eq!(get("format"), "binary");
                let components = find("NumberOfComponents").map_or(1, |n| n.parse::<usize>().unwrap());
                current = Some((get("Name"), get("type"), components));
            }
            Event::Text(text) => {
                if let Some((name, kind, components)) = current.take() {
                    found.insert(name, (kind, components, inflated(text.decode().unwrap().trim())));
                }
            }
            Event::Eof => return found,
            _ => {}
        }
    }
}

/// An array as VTK compresses it: count of blocks, size of a block, size of the last, size of each compressed; then the blocks.
fn inflated(text: &str) -> Vec<u8> {
    let count = |bytes: &[u8]| u64::from_le_bytes(bytes.try_into().unwrap()) as usize;
    let blocks = count(&STANDARD.decode(&text[..32]).unwrap()[..8]);
    let head = (8 * (3 + blocks)).div_ceil(3) * 4;
    let sizes: Vec<usize> = STANDARD.decode(&text[..head]).unwrap().chunks(8).map(count).collect();
    let mut rest = STANDARD.decode(&text[head..]).unwrap();
    let mut all = Vec::new();
    for size in &sizes[3..] {
        let after = rest.split_off(*size);
        all.extend(miniz_oxide::inflate::decompress_to_vec_zlib(&rest).unwrap());
        rest = after;
    }
    assert!(rest.is_empty() && (blocks == 0 || all.len() == (blocks - 1) * sizes[1] + sizes[2]));
    all
}

fn floats(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

fn ints(bytes: &[u8]) -> Vec<i64> {
    bytes.chunks(8).map(|b| i64::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn points_cells_and_fields_fit_together() {
    let sample = Sample::new(3, Verdict::Agree);
    let dossier = sample.dossier();
    let text = String::from_utf8(vtu(&dossier).unwrap()).unwrap();
    assert_well_formed(&text);
    let arrays = arrays(&text);
    let triangles = sample.problem.mesh.triangles.len();
    for (name, kind, components, count) in [
        ("Points", "Float64", 3, 9 * triangles),
        ("dual_stress", "Float64", 6, 9 * triangles),
        ("von_mises", "Float64", 1, 9 * triangles),
        ("mean_stress", "Float64", 1, 9 * triangles),
        ("displacement_free", "Float64", 3, 9 * triangles),
        ("displacement_FEniCSx_P2", "Float64", 3, 9 * triangles),
        ("stress_difference", "Float64", 1, 3 * triangles),
        ("error_contribution", "Float64", 1, 3 * triangles),
        ("triangle", "Int64", 1, 3 * triangles),
        ("body", "Int64", 1, 3 * triangles),
        ("connectivity", "Int64", 1, 9 * triangles),
        ("offsets", "Int64", 1, 3 * triangles),
    ] {
        let (found_kind, found_components, bytes) = &arrays[name];
        assert_eq!((found_kind.as_str(), *found_components), (kind, components), "{name}");
        assert_eq!(bytes.len(), 8 * components * count, "{name}");
    }
    assert_eq!(arrays["types"].2, vec![5; 3 * triangles]);

    // The cells cover the two unit squares, each counter-clockwise.
    let points = floats(&arrays["Points"].2);
    let at = |p: i64| [points[3 * p as usize], points[3 * p as usize + 1]];
    let mut area = 0.0;
    for cell in ints(&arrays["connectivity"].2).chunks(3) {
        let [a, b, c] = [at(cell[0]), at(cell[1]), at(cell[2])];
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(twice > 0.0);
        area += 0.5 * twice;
    }
    assert!((area - 2.0).abs() < 1e-12);

    // The sample's σ_yy is constant on a triangle and differs from its neighbour's: nothing was averaged.
    let stress = floats(&arrays["dual_stress"].2);
    for t in 0..triangles {
        for p in 9 * t..9 * t + 9 {
            assert_eq!(stress[6 * p + 1], 0.05 * (t % 3) as f64);
            // Plane strain: ν times the sum of the two in the plane; nothing out of it in shear.
            assert_eq!(stress[6 * p + 2], 0.3 * (stress[6 * p] + stress[6 * p + 1]));
            assert_eq!(stress[6 * p + 4..6 * p + 6], [0.0; 2]);
        }
    }
    // The displacement is the sample's formula at the vertices, and its mean at the centroids, since it is linear there.
    let u = floats(&arrays["displacement_free"].2);
    let formula = |x: f64, y: f64, left: bool| {
        let lift = if left { 0.8 * (y - 0.5).max(0.0) } else { 0.0 };
        [(2.0 - x) * (0.9 - 0.3 * y) - lift, 0.15 * y * (2.0 - x) * if left { 1.3 } else { 1.0 }]
    };
    for p in 0..9 * triangles {
        let corners = sample.problem.mesh.corners(p / 9).map(|[x, y]| formula(x, y, p / 9 < triangles / 2));
        for c in 0..2 {
            let expected = match p % 3 {
                2 => corners.iter().map(|v| v[c]).sum::<f64>() / 3.0,
                _ => formula(points[3 * p], points[3 * p + 1], p / 9 < triangles / 2)[c],
            };
            assert!((u[3 * p + c] - expected).abs() < 1e-14, "point {p}");
        }
        assert_eq!(u[3 * p + 2], 0.0);
    }
    let offsets: Vec<i64> = (1..=3 * triangles as i64).map(|k| 3 * k).collect();
    assert_eq!(ints(&arrays["offsets"].2), offsets);
}

#[test]
fn stresses_of_a_degree_for_each_triangle_are_exact_at_all_points() {
    let mut sample = Sample::new(3, Verdict::Agree);
    sample.raise();
    let arrays = arrays(&String::from_utf8(vtu(&sample.dossier()).unwrap()).unwrap());
    let triangles = sample.problem.mesh.triangles.len();
    let degree = |t: usize| 1 + t % 3;
    let counts: Vec<usize> = (0..triangles).map(|t| 3 * (degree(t) + 1) * (degree(t) + 2) / 2).collect();
    let cells: usize = (0..triangles).map(|t| 3 * degree(t) * degree(t)).sum();
    let points = floats(&arrays["Points"].2);
    assert_eq!(points.len(), 3 * counts.iter().sum::<usize>());
    let stress = floats(&arrays["dual_stress"].2);
    let of_point = (0..triangles).flat_map(|t| std::iter::repeat_n(degree(t), counts[t]));
    for (k, p) in of_point.enumerate() {
        let exact = (points[3 * k] + 2.0 * points[3 * k + 1]).powi(p as i32);
        assert!((stress[6 * k] - exact).abs() < 1e-12, "{} is not {exact}", stress[6 * k]);
        assert_eq!(stress[6 * k + 1], p as f64);
    }
    // Cells have the degree of the points that they join, and together they are the two squares.
    let degrees = ints(&arrays["degree"].2);
    assert_eq!((degrees.len(), arrays["types"].2.len()), (cells, cells));
    let mut area = 0.0;
    for (cell, p) in ints(&arrays["connectivity"].2).chunks(3).zip(degrees) {
        let [a, b, c] = [0, 1, 2].map(|i| {
            let k = cell[i] as usize;
            assert_eq!(stress[6 * k + 1], p as f64);
            [points[3 * k], points[3 * k + 1]]
        });
        let twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        assert!(twice > 0.0);
        area += 0.5 * twice;
    }
    assert!((area - 2.0).abs() < 1e-12);
    // The displacement is linear on subtriangles: at the middle of two corners it is the mean of theirs.
    let u = floats(&arrays["displacement_free"].2);
    for c in 0..2 {
        // Triangle 1 has degree 2; its first six points are (2,0,0), (1,1,0), (1,0,1), (0,2,0), (0,1,1), (0,0,2) halves.
        let at = |k: usize| u[3 * (counts[0] + k) + c];
        assert!((at(1) - 0.5 * (at(0) + at(3))).abs() < 1e-14 && (at(4) - 0.5 * (at(3) + at(5))).abs() < 1e-14);
    }
}

#[test]
fn stresses_for_looking_at_are_right_to_a_part_of_the_largest() {
    let mut sheet = Sheet::new("", Precision::ForLooking).unwrap();
    let values = [4.0, 1e-4, -0.123456, 1.0, f64::NAN, 2e-9, 0.5, 7.0, 0.0, 1.0, 1.0, 1.0];
    sheet.stresses("s", &TENSOR, &values, &[STEP, 0.0]).unwrap();
    let bytes = sheet.finish().unwrap();
    let arrays = arrays(std::str::from_utf8(&bytes).unwrap());
    let found: Vec<f32> = arrays["s"].2.chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();
    assert_eq!(found.len(), values.len());
    for (k, (x, found)) in values.iter().zip(&found).enumerate().filter(|(k, _)| *k != 4) {
        let allowed = if k < 6 { 0.5 * STEP } else { 1e-7 };
        assert!((x - f64::from(*found)).abs() <= allowed, "{x} {found}");
    }
    assert!(found[4].is_nan());
}

#[test]
fn von_mises_of_known_states() {
    let mut sample = Sample::new(1, Verdict::Agree);
    // Plane strain, ν = 0.3, uniaxial 1: σ_33 = 0.3, ½(1² + 0.3² + 0.7²) = 0.79.
    assert!((von_mises(&sample.problem, 0, [1.0, 0.0, 0.0], [0.0; 2]) - 0.79_f64.sqrt()).abs() < 1e-15);
    let draft = Draft { kinematics: Kinematics::PlaneStress, ..(*sample.problem.scene).clone() };
    sample.problem.scene = Scene::unchecked(draft);
    assert!((von_mises(&sample.problem, 0, [1.0, 0.0, 0.0], [0.0; 2]) - 1.0).abs() < 1e-15);
    assert!((von_mises(&sample.problem, 0, [0.0, 0.0, 1.0], [0.0; 2]) - 3.0_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn names_become_keys_that_differ() {
    let mut taken = Vec::new();
    assert_eq!(unique_key("displacement", "FEniCSx P1", &mut taken), "displacement_FEniCSx_P1");
    assert_eq!(unique_key("displacement", "FEniCSx<P1", &mut taken), "displacement_FEniCSx_P1_");
}

#[test]
fn meshio_reads_the_file_where_it_is_installed() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("fields.vtu");
    let sample = Sample::new(2, Verdict::Infeasible);
    std::fs::write(&file, vtu(&sample.dossier()).unwrap()).unwrap();
    let script = "import sys\ntry:\n import meshio\nexcept ImportError:\n sys.exit(77)\n\
        m = meshio.read(sys.argv[1])\nprint(len(m.points), m.cells[0].type, len(m.cells[0].data), m.point_data['motion'].shape[1])";
    let Ok(output) = std::process::Command::new("python3").args(["-c", script]).arg(&file).output() else { return };
    if output.status.code() == Some(77) {
        return;
    }
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(text.trim(), "144 triangle 48 3", "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn meshio_finds_the_area_and_stresses_of_every_degree() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("fields.vtu");
    let mut sample = Sample::new(2, Verdict::Agree);
    sample.raise();
    std::fs::write(&file, vtu(&sample.dossier()).unwrap()).unwrap();
    let script = "import sys\ntry:\n import meshio\nexcept ImportError:\n sys.exit(77)\n\
        m = meshio.read(sys.argv[1])\n(c,) = m.cells\nx = m.points\ns = m.point_data['dual_stress']\n\
        a, b = x[c.data[:, 1]] - x[c.data[:, 0]], x[c.data[:, 2]] - x[c.data[:, 0]]\n\
        area = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])\n\
        off = abs(s[:, 0] - (x[:, 0] + 2 * x[:, 1]) ** s[:, 1]).max()\n\
        (p,) = m.cell_data['degree']\n\
        print(c.type, len(c.data), round(area.sum(), 9), off < 1e-12, sorted(set(p.tolist())), len(p))";
    let Ok(output) = std::process::Command::new("python3").args(["-c", script]).arg(&file).output() else { return };
    if output.status.code() == Some(77) {
        return;
    }
    let text = String::from_utf8_lossy(&output.stdout);
    // Sixteen triangles, of which six have degree 1, five 2 and five 3: 3 (6 + 5 · 4 + 5 · 9) cells.
    let complaints = String::from_utf8_lossy(&output.stderr);
    assert_eq!(text.trim(), "triangle 213 2.0 True [1, 2, 3] 213", "{complaints}");
}

#[test]
fn halves_of_a_quadrilateral_have_one_number() {
    let mut sample = Sample::new(2, Verdict::Agree);
    with_quadrilaterals(&mut sample.problem.mesh);
    let bytes = vtu(&sample.dossier()).expect("written");
    let found = arrays(std::str::from_utf8(&bytes).expect("UTF-8"));
    let (triangle, cell) = (ints(&found["triangle"].2), ints(&found["cell"].2));
    assert_eq!(triangle.len(), cell.len());
    assert!(triangle.iter().zip(&cell).all(|(t, c)| *c == t / 2), "{triangle:?} {cell:?}");
}
