//! `fields.vtu`: the fields for ParaView, discontinuities kept.
//!
//! Every subtriangle of every triangle has points of its own, so that a field that jumps between triangles, or has kinks at the
//! inner segments, is drawn as it is. Where stresses have degree p these are the nodes of the lattice of degree p, and p² plain
//! triangles between them: every program reads them, and what they show is exact at the nodes.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use super::Dossier;
use super::lattice::Lattice;
use crate::problem::Problem;
use crate::scene::Kinematics;

/// From this many triangles on, fields are stored in single precision: the file would otherwise be several hundred
/// megabytes, and is for looking at.
const SINGLE_PRECISION_FROM: usize = 100_000;

/// The VTK unstructured grid: for every triangle of degree p three times p² cells.
///
/// Point data: `dual_stress` (xx, yy, xy), `von_mises` and `pressure` of λ_h, `mid_stress` (xx, yy, xy), `displacement_…` of every model and the
/// rigid `motion` where there is one (three components, the last zero). Cell data: `triangle`, `body`, `degree` of the stresses where it is not
/// one everywhere, and the maps.
pub fn vtu(dossier: &Dossier) -> std::io::Result<Vec<u8>> {
    let mesh = &dossier.problem.mesh;
    let run = format!(" run {} ", dossier.report.run);
    let single = mesh.triangles.len() >= SINGLE_PRECISION_FROM;
    let lattice = Lattice::new(dossier);
    let cells: usize = (0..mesh.triangles.len()).map(|t| lattice.cells(t)).sum();
    let points = lattice.values(|t, sub, l| {
        let [x, y] = dossier.problem.scene.as_written(within(mesh.corners(t), sub, l));
        [x, y, 0.0]
    });
    let mut out = Sheet { xml: Writer::new_with_indent(Vec::new(), b' ', 1), single };
    out.xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    out.xml.write_event(Event::Comment(BytesText::new(&run)))?;
    out.open(
        "VTKFile",
        &[("type", "UnstructuredGrid"), ("version", "1.0"), ("byte_order", "LittleEndian"), ("header_type", "UInt64")],
    )?;
    out.open("UnstructuredGrid", &[])?;
    out.open("Piece", &[("NumberOfPoints", &(points.len() / 3).to_string()), ("NumberOfCells", &cells.to_string())])?;
    point_data(&mut out, dossier, &lattice)?;
    cell_data(&mut out, dossier, &lattice)?;
    out.open("Points", &[])?;
    out.array("Points", "Float64", 3, points.iter().flat_map(|x| x.to_le_bytes()))?;
    out.close("Points")?;
    out.open("Cells", &[])?;
    out.array("connectivity", "Int64", 1, lattice.connectivity().flat_map(i64::to_le_bytes))?;
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

fn point_data(out: &mut Sheet, dossier: &Dossier, lattice: &Lattice) -> std::io::Result<()> {
    let problem = dossier.problem;
    let mesh = &problem.mesh;
    out.open("PointData", &[])?;
    if let Some(dual) = dossier.dual.filter(|dual| dual.stress.len() == mesh.triangles.len()) {
        let stress = |t, sub, l| dual.stress.at(t, sub, l);
        out.field("dual_stress", 3, &lattice.values(stress))?;
        out.field("von_mises", 1, &lattice.values(|t, sub, l| [von_mises(problem, t, stress(t, sub, l))]))?;
        out.field("pressure", 1, &lattice.values(|t, sub, l| [mean_pressure(problem, t, stress(t, sub, l))]))?;
    }
    if let Some(mid) = dossier.mid.filter(|mid| mid.len() == mesh.triangles.len()) {
        out.field("mid_stress", 3, &lattice.values(|t, sub, l| mid.at(t, sub, l)))?;
    }
    let mut names = Vec::new();
    for (name, displacement) in &dossier.displacements {
        if displacement.len() == mesh.triangles.len() {
            let values = lattice.values(|t, sub, l| {
                let [x, y] = displacement.at(t, on_triangle(sub, l));
                [x, y, 0.0]
            });
            out.field(&unique_key(name, &mut names), 3, &values)?;
        }
    }
    if let Some(motion) = dossier.motion.as_ref().filter(|motion| motion.len() == mesh.points.len()) {
        let values = lattice.values(|t, sub, l| {
            let [x, y] = within(mesh.triangles[t].map(|v| motion[v]), sub, l);
            [x, y, 0.0]
        });
        out.field("motion", 3, &values)?;
    }
    out.close("PointData")
}

fn cell_data(out: &mut Sheet, dossier: &Dossier, lattice: &Lattice) -> std::io::Result<()> {
    let mesh = &dossier.problem.mesh;
    let on_cells = |value: &dyn Fn(usize) -> i64| -> Vec<u8> {
        let of = |t: usize| std::iter::repeat_n(value(t), lattice.cells(t));
        (0..mesh.triangles.len()).flat_map(of).flat_map(i64::to_le_bytes).collect()
    };
    out.open("CellData", &[])?;
    out.array("triangle", "Int64", 1, on_cells(&|t| t as i64))?;
    out.array("body", "Int64", 1, on_cells(&|t| mesh.body[t] as i64))?;
    if lattice.degrees.iter().any(|p| *p != 1) {
        out.array("degree", "Int64", 1, on_cells(&|t| lattice.degrees[t] as i64))?;
    }
    for map in dossier.maps.iter().filter(|map| map.values.len() == mesh.triangles.len()) {
        let of = |(t, v): (usize, &f64)| std::iter::repeat_n(*v, lattice.cells(t));
        let values: Vec<f64> = map.values.iter().enumerate().flat_map(of).collect();
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

/// What is linear on subtriangle `sub`, from its values at the corners of the triangle, with their mean at the centroid.
fn within(a: [[f64; 2]; 3], sub: usize, l: [f64; 3]) -> [f64; 2] {
    let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / 3.0);
    let corners = [a[(sub + 1) % 3], a[(sub + 2) % 3], centre];
    [0, 1].map(|c| (0..3).map(|i| l[i] * corners[i][c]).sum())
}

/// Barycentric coordinates on the triangle, from those on subtriangle `sub`.
fn on_triangle(sub: usize, l: [f64; 3]) -> [f64; 3] {
    let mut all = [l[2] / 3.0; 3];
    all[(sub + 1) % 3] += l[0];
    all[(sub + 2) % 3] += l[1];
    all
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
