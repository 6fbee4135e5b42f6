//! `fields.vtu`: the fields for ParaView, discontinuities kept.
//!
//! Every subtriangle of every triangle is a cell with three points of its own, so that a field that jumps between
//! triangles, or is linear with kinks at the inner segments, is drawn as it is.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use super::Dossier;
use crate::mesh::Triangulation;
use crate::problem::Problem;
use crate::scene::Kinematics;

/// Corners of a subtriangle in its barycentric coordinates.
const CORNERS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// From this many triangles on, fields are stored in single precision: the file would otherwise be several hundred
/// megabytes, and is for looking at.
const SINGLE_PRECISION_FROM: usize = 100_000;

/// The VTK unstructured grid: for every triangle three cells with three points each.
///
/// Point data: `dual_stress` (xx, yy, xy), `von_mises` and `pressure` of λ_h, `mid_stress` (xx, yy, xy), `displacement_…` of every model and the
/// rigid `motion` where there is one (three components, the last zero). Cell data: `triangle`, `body` and the maps.
pub fn vtu(dossier: &Dossier) -> std::io::Result<Vec<u8>> {
    let mesh = &dossier.problem.mesh;
    let run = format!(" run {} ", dossier.report.run);
    let single = mesh.triangles.len() >= SINGLE_PRECISION_FROM;
    let cells = 3 * mesh.triangles.len();
    let mut out = Sheet { xml: Writer::new_with_indent(Vec::new(), b' ', 1), single };
    out.xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    out.xml.write_event(Event::Comment(BytesText::new(&run)))?;
    out.open(
        "VTKFile",
        &[("type", "UnstructuredGrid"), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")],
    )?;
    out.open("UnstructuredGrid", &[])?;
    out.open("Piece", &[("NumberOfPoints", &(3 * cells).to_string()), ("NumberOfCells", &cells.to_string())])?;
    point_data(&mut out, dossier)?;
    cell_data(&mut out, dossier)?;
    out.open("Points", &[])?;
    let points = corner_values(mesh, |t, i| {
        let [x, y] = dossier.problem.scene.as_written(corner(mesh, t, i));
        [x, y, 0.0]
    });
    out.array("Points", "Float64", 3, points.iter().flat_map(|x| x.to_le_bytes()))?;
    out.close("Points")?;
    out.open("Cells", &[])?;
    out.array("connectivity", "Int64", 1, (0..3 * cells as i64).flat_map(i64::to_le_bytes))?;
    out.array("offsets", "Int64", 1, (1..=cells as i64).flat_map(|k| (3 * k).to_le_bytes()))?;
    const VTK_TRIANGLE: u8 = 5;
    out.array("types", "UInt8", 1, std::iter::repeat_n(VTK_TRIANGLE, cells))?;
    for name in ["Cells", "Piece", "UnstructuredGrid", "VTKFile"] {
        out.close(name)?;
    }
    let mut bytes = out.xml.into_inner();
    bytes.push(b'\n');
    Ok(bytes)
}

fn point_data(out: &mut Sheet, dossier: &Dossier) -> std::io::Result<()> {
    let problem = dossier.problem;
    let mesh = &problem.mesh;
    out.open("PointData", &[])?;
    if let Some(dual) = dossier.dual.filter(|dual| dual.stress.len() == mesh.triangles.len()) {
        let stress = |t, (sub, k): (usize, usize)| dual.stress.at(t, sub, CORNERS[k]);
        out.field("dual_stress", 3, &corner_values(mesh, stress))?;
        out.field("von_mises", 1, &corner_values(mesh, |t, i| [von_mises(problem, t, stress(t, i))]))?;
        out.field("pressure", 1, &corner_values(mesh, |t, i| [mean_pressure(problem, t, stress(t, i))]))?;
    }
    if let Some(mid) = dossier.mid.filter(|mid| mid.len() == mesh.triangles.len()) {
        out.field("mid_stress", 3, &corner_values(mesh, |t, (sub, k)| mid.at(t, sub, CORNERS[k])))?;
    }
    let mut names = Vec::new();
    for (name, displacement) in &dossier.displacements {
        if displacement.len() == mesh.triangles.len() {
            let values = corner_values(mesh, |t, (sub, k)| {
                let [x, y] = match k {
                    2 => displacement.centre(t),
                    k => displacement.corner(t, (sub + 1 + k) % 3),
                };
                [x, y, 0.0]
            });
            out.field(&unique_key(name, &mut names), 3, &values)?;
        }
    }
    if let Some(motion) = dossier.motion.as_ref().filter(|motion| motion.len() == mesh.points.len()) {
        let values = corner_values(mesh, |t, (sub, k)| {
            let u = mesh.triangles[t].map(|v| motion[v]);
            let centre = [0, 1].map(|c| (u[0][c] + u[1][c] + u[2][c]) / 3.0);
            let [x, y] = [u[(sub + 1) % 3], u[(sub + 2) % 3], centre][k];
            [x, y, 0.0]
        });
        out.field("motion", 3, &values)?;
    }
    out.close("PointData")
}

fn cell_data(out: &mut Sheet, dossier: &Dossier) -> std::io::Result<()> {
    let mesh = &dossier.problem.mesh;
    let thrice = |values: &mut dyn Iterator<Item = i64>| -> Vec<u8> {
        values.flat_map(|v| std::iter::repeat_n(v, 3)).flat_map(i64::to_le_bytes).collect()
    };
    out.open("CellData", &[])?;
    out.array("triangle", "Int64", 1, thrice(&mut (0..mesh.triangles.len() as i64)))?;
    out.array("body", "Int64", 1, thrice(&mut mesh.body.iter().map(|&b| b as i64)))?;
    for map in dossier.maps.iter().filter(|map| map.values.len() == mesh.triangles.len()) {
        let values: Vec<f64> = map.values.iter().flat_map(|&v| [v; 3]).collect();
        out.field(map.key, 1, &values)?;
    }
    out.close("CellData")
}

/// The XML under construction.
struct Sheet {
    xml: Writer<Vec<u8>>,
    single: bool,
}

impl Sheet {
    fn open(&mut self, name: &str, attributes: &[(&str, &str)]) -> std::io::Result<()> {
        let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
        self.xml.write_event(Event::Start(start))
    }

    fn close(&mut self, name: &str) -> std::io::Result<()> {
        self.xml.write_event(Event::End(BytesEnd::new(name)))
    }

    /// A field of floating-point numbers in the precision of this file.
    fn field(&mut self, name: &str, components: usize, values: &[f64]) -> std::io::Result<()> {
        if self.single {
            self.array(name, "Float32", components, values.iter().flat_map(|&x| (x as f32).to_le_bytes()))
        } else {
            self.array(name, "Float64", components, values.iter().flat_map(|x| x.to_le_bytes()))
        }
    }

    /// Inline binary: the number of bytes and the bytes, in one base64 text.
    fn array(
        &mut self,
        name: &str,
        kind: &str,
        components: usize,
        data: impl IntoIterator<Item = u8>,
    ) -> std::io::Result<()> {
        let mut bytes = vec![0; 8];
        bytes.extend(data);
        let length = bytes.len() as u64 - 8;
        bytes[..8].copy_from_slice(&length.to_le_bytes());
        let attributes = [("type", kind), ("Name", name), ("format", "binary")];
        let mut element = self.xml.create_element("DataArray").with_attributes(attributes);
        // Scalars go without the count, as VTK itself writes them: some readers make a column of one otherwise.
        if components > 1 {
            element = element.with_attribute(("NumberOfComponents", components.to_string().as_str()));
        }
        element.write_text_content(BytesText::from_escaped(STANDARD.encode(bytes)))?;
        Ok(())
    }
}

/// One value per own point: triangle by triangle, subtriangle by subtriangle, corner by corner.
fn corner_values<const N: usize>(mesh: &Triangulation, value: impl Fn(usize, (usize, usize)) -> [f64; N]) -> Vec<f64> {
    let mut values = Vec::with_capacity(9 * N * mesh.triangles.len());
    for t in 0..mesh.triangles.len() {
        for sub in 0..3 {
            for k in 0..3 {
                values.extend(value(t, (sub, k)));
            }
        }
    }
    values
}

fn corner(mesh: &Triangulation, t: usize, (sub, k): (usize, usize)) -> [f64; 2] {
    let a = mesh.corners(t);
    match k {
        0 => a[(sub + 1) % 3],
        1 => a[(sub + 2) % 3],
        _ => [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0),
    }
}

/// σ_33: ν (σ_11 + σ_22) in plane strain, zero in plane stress.
fn out_of_plane(problem: &Problem, t: usize, s: [f64; 3]) -> f64 {
    match problem.scene.kinematics {
        Kinematics::PlaneStress => 0.0,
        Kinematics::PlaneStrain => {
            let body = problem.mesh.body.get(t).and_then(|&b| problem.scene.bodies.get(b));
            body.map_or(0.0, |body| body.poisson * (s[0] + s[1]))
        }
    }
}

/// Von Mises stress of (xx, yy, xy) in triangle `t`.
pub(crate) fn von_mises(problem: &Problem, t: usize, s: [f64; 3]) -> f64 {
    let zz = out_of_plane(problem, t, s);
    let differences = (s[0] - s[1]).powi(2) + (s[1] - zz).powi(2) + (zz - s[0]).powi(2);
    (0.5 * differences + 3.0 * s[2] * s[2]).sqrt()
}

/// −tr σ / 3.
fn mean_pressure(problem: &Problem, t: usize, s: [f64; 3]) -> f64 {
    -(s[0] + s[1] + out_of_plane(problem, t, s)) / 3.0
}

/// `displacement_` and the name in letters that every program reads, made unique.
fn unique_key(name: &str, taken: &mut Vec<String>) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let mut key = format!("displacement_{plain}");
    while taken.contains(&key) {
        key.push('_');
    }
    taken.push(key.clone());
    key
}

#[cfg(test)]
#[path = "vtu_tests.rs"]
mod tests;
