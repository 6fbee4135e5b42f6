//! Tractions of a stress on the edges of a mesh.

use super::StressField;
use super::polynomial::side;
use crate::mesh::Triangulation;

impl StressField {
    /// Bernstein coefficients of degree `degree` of the traction of the stress on edge `e` from its first vertex to its second,
    /// as seen from its first or second triangle (outward normal of that triangle); no less than the degree of the stress there.
    pub fn edge_traction(&self, mesh: &Triangulation, e: usize, side: usize, degree: usize) -> Vec<[f64; 2]> {
        let edge = &mesh.edges[e];
        let Some(t) = edge.triangles[side] else { return vec![[0.0; 2]; degree + 1] };
        let sub = mesh.triangle_edges[t].iter().position(|&x| x == e).unwrap_or(0);
        let (_, n) = mesh.edge_frame(e);
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let traction = |tau: [f64; 3]| [sign * (tau[0] * n[0] + tau[2] * n[1]), sign * (tau[2] * n[0] + tau[1] * n[1])];
        let mut values: Vec<[f64; 2]> = self.on_side(t, sub).map(traction).collect();
        if mesh.triangles[t][(sub + 1) % 3] != edge.vertices[0] {
            values.reverse();
        }
        if values.len() == degree + 1 {
            return values;
        }
        let rows = side::elevation_matrix(values.len() - 1, degree).chunks_exact(values.len());
        rows.map(|row| [0, 1].map(|c| row.iter().zip(&values).map(|(e, t)| e * t[c]).sum())).collect()
    }
}
