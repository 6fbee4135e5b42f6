//! Quadrilaterals that are integrated otherwise than in full, or have more than their nodes' functions.

use nalgebra::{Matrix4, Vector4};

use crate::bounds::Cell;
use crate::compare::forces::cells;
use crate::diagnose::fit::fit;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::words::number;
use crate::diagnose::{Finding, Trial};
use crate::element::Quadrilateral;
use crate::scene::Kinematics;

/// All ways, each on every quadrilateral.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let list = &space.solution.candidate.cells;
    if list.is_empty() {
        return Vec::new();
    }
    let points = list.iter().map(|cell| cells::full(&cell.field)).max().unwrap_or(2);
    let reduced = move |own: &On<'_>| own.forces(points - 1, |moduli, e| moduli.stress(e));
    let trial = |rank: usize, name: &str, sentence: String, made: &dyn Fn(&On<'_>) -> Vec<[f64; 2]>| Trial {
        rank,
        left: space.left_with(&change(space, made)),
        findings: vec![Finding::new(format!("integration/{name}"), None, None, sentence)],
    };
    let fewer = points - 1;
    let mut trials = vec![
        trial(
            0,
            "reduced",
            format!("the quadrilaterals are integrated with {fewer} × {fewer} points in place of {points} × {points}"),
            &reduced,
        ),
        trial(
            1,
            "selective",
            format!(
                "λ div u is integrated with {fewer} × {fewer} points, the rest in full (selective reduced integration)"
            ),
            &|own| {
                let shear = own.forces(points, |moduli, e| Moduli { lambda: 0.0, ..moduli }.stress(e));
                let volume = own.forces(fewer, |moduli, e| Moduli { lambda: moduli.lambda, ..Moduli::NONE }.stress(e));
                shear.iter().zip(volume).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect()
            },
        ),
    ];
    if space.problem().scene.kinematics == Kinematics::PlaneStrain {
        let sentence = "the volumetric strain is the mean one of each quadrilateral (B-bar)";
        trials.push(trial(1, "b-bar", sentence.to_string(), &|own| own.mean_dilatation(points, true)));
    }
    if list.iter().all(|cell| cell.field.nodes() == 4) {
        let sentence = "the quadrilaterals have incompatible modes 1 − ξ² and 1 − η²";
        trials.push(trial(2, "incompatible", sentence.to_string(), &|own| own.incompatible(points)));
        trials.push(hourglass(space, &reduced));
    } else {
        // With four nodes the value at the centre is the mean one.
        let sentence = "the change of volume is the mean one of each quadrilateral (mean dilatation)";
        trials.push(trial(1, "mean-dilatation", sentence.to_string(), &|own| own.mean_dilatation(points, false)));
    }
    trials
}

/// One point, and a stiffness against hourglassing.
fn hourglass(space: &Space<'_>, reduced: &dyn Fn(&On<'_>) -> Vec<[f64; 2]>) -> Trial {
    let one: Vec<f64> = change(space, reduced).iter().zip(&space.residual).map(|(c, r)| c + r).collect();
    let square = one.iter().map(|x| x * x).sum::<f64>();
    let column = added(space, &|own| own.hourglass());
    let (x, left) = fit(&[&column], &one, square.max(f64::MIN_POSITIVE));
    let sentence = format!(
        "the quadrilaterals are integrated with one point and held against hourglassing by {} times μ",
        number(x[0])
    );
    Trial {
        rank: 2,
        left: left * square / space.square,
        findings: vec![Finding::new("integration/hourglass", Some(x[0]), None, sentence)],
    }
}

/// A quadrilateral with its values.
struct On<'a> {
    cell: &'a Quadrilateral,
    values: Vec<[f64; 2]>,
    moduli: Moduli,
}

/// Nodal forces of all quadrilaterals, as a column.
fn added(space: &Space<'_>, made: &dyn Fn(&On<'_>) -> Vec<[f64; 2]>) -> Vec<f64> {
    let problem = space.problem();
    let mut forces = vec![[0.0; 2]; space.count()];
    let candidate = space.solution.candidate;
    for cell in &candidate.cells {
        for (node, f) in cell.nodes.iter().zip(made(&on(space, cell))) {
            (0..2).for_each(|c| forces[*node][c] += problem.scene.thickness * f[c]);
        }
    }
    space.column(forces)
}

fn on<'a>(space: &Space<'_>, cell: &'a Cell) -> On<'a> {
    let problem = space.problem();
    let body = cell.triangles.first().map_or(0, |t| problem.mesh.body[*t]);
    let moduli = Moduli::of_body(problem, &problem.scene.bodies[body]);
    On { cell: &cell.field, values: cell.values(space.solution.candidate), moduli }
}

/// Nodal forces `made` less those of full integration.
fn change(space: &Space<'_>, made: &dyn Fn(&On<'_>) -> Vec<[f64; 2]>) -> Vec<f64> {
    added(space, &|own| {
        let points = space.solution.points.unwrap_or(cells::full(own.cell));
        let full = own.forces(points, |moduli, e| moduli.stress(e));
        made(own).iter().zip(full).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect()
    })
}

/// Gradients of the nodes' functions, strain, weight times determinant, and place.
type AtPoint = (Vec<[f64; 2]>, [f64; 3], f64, [f64; 2]);

impl On<'_> {
    fn forces(&self, points: usize, stress: impl Fn(Moduli, [f64; 3]) -> [f64; 3]) -> Vec<[f64; 2]> {
        cells::forces(self.cell, &self.values, points, |e| stress(self.moduli, e))
    }

    /// Σ over the points of a rule: the gradients of the nodes' functions, the strain, and the weight times the determinant.
    fn at_points(&self, points: usize) -> Vec<AtPoint> {
        let of = |(at, weight): ([f64; 2], f64)| {
            let (gradients, determinant) = self.cell.gradients(at);
            let gradients: Vec<[f64; 2]> = gradients.into_iter().map(|g| g.map(|g| g / determinant)).collect();
            let mut e = [0.0; 3];
            for (g, u) in gradients.iter().zip(&self.values) {
                let (x, y) = (u[0] - self.values[0][0], u[1] - self.values[0][1]);
                e[0] += g[0] * x;
                e[1] += g[1] * y;
                e[2] += 0.5 * (g[1] * x + g[0] * y);
            }
            (gradients, e, weight * determinant, at)
        };
        cells::rule(points).map(of).collect()
    }

    /// With the mean of div u in place of div u: in the part with λ, or as B-bar has it in all of the volumetric strain.
    fn mean_dilatation(&self, points: usize, everywhere: bool) -> Vec<[f64; 2]> {
        let at = self.at_points(points);
        let area: f64 = at.iter().map(|p| p.2).sum();
        let mean = at.iter().map(|(_, e, w, _)| w * (e[0] + e[1])).sum::<f64>() / area;
        let count = self.values.len();
        let of_node = |n: usize, c: usize| at.iter().map(|(g, _, w, _)| w * g[n][c]).sum::<f64>() / area;
        let means: Vec<[f64; 2]> = (0..count).map(|n| [of_node(n, 0), of_node(n, 1)]).collect();
        let Moduli { lambda, mu, .. } = self.moduli;
        let mut forces: Vec<[f64; 2]> = means.iter().map(|g| g.map(|g| lambda * mean * area * g)).collect();
        for (gradients, e, w, _) in &at {
            let missing = if everywhere { mean - e[0] - e[1] } else { 0.0 };
            let trace = e[0] + e[1];
            for (n, g) in gradients.iter().enumerate() {
                let own = [e[0] * g[0] + e[2] * g[1], e[1] * g[1] + e[2] * g[0]];
                for c in 0..2 {
                    let missing_of = if everywhere { means[n][c] - g[c] } else { 0.0 };
                    let volume = (missing * g[c] + missing_of * trace + missing * missing_of) / 3.0;
                    forces[n][c] += w * 2.0 * mu * (own[c] + volume);
                }
            }
        }
        let other = Moduli { other: self.moduli.other, ..Moduli::NONE };
        let rest = cells::forces(self.cell, &self.values, points, |e| other.stress(e));
        forces.iter_mut().zip(rest).for_each(|(force, rest)| (0..2).for_each(|c| force[c] += rest[c]));
        forces
    }

    /// With the modes 1 − ξ² and 1 − η² of both components inside, their gradients by the map at the centre (Taylor, Beresford &
    /// Wilson 1976).
    fn incompatible(&self, points: usize) -> Vec<[f64; 2]> {
        let at = self.at_points(points);
        let [p, q, r, s] = self.cell.corners();
        let a = [0, 1].map(|c| 0.25 * (q[c] + r[c] - p[c] - s[c]));
        let b = [0, 1].map(|c| 0.25 * (r[c] + s[c] - p[c] - q[c]));
        let modes = |at: [f64; 2], here: f64| {
            // Divided by the determinant here: constant stresses do no work on the modes.
            let gradient = |d: [f64; 2]| [(d[0] * b[1] - d[1] * a[1]) / here, (d[1] * a[0] - d[0] * b[0]) / here];
            let [f, g] = [gradient([-2.0 * at[0], 0.0]), gradient([0.0, -2.0 * at[1]])];
            [[f[0], 0.0, 0.5 * f[1]], [0.0, f[1], 0.5 * f[0]], [g[0], 0.0, 0.5 * g[1]], [0.0, g[1], 0.5 * g[0]]]
        };
        let product = |s: [f64; 3], e: [f64; 3]| s[0] * e[0] + s[1] * e[1] + 2.0 * s[2] * e[2];
        let (mut matrix, mut load) = (Matrix4::<f64>::zeros(), Vector4::<f64>::zeros());
        let determinant = |at: [f64; 2]| {
            let [d0, d1, d2] = self.cell.determinant();
            d0 + d1 * at[0] + d2 * at[1]
        };
        for (_, e, w, place) in &at {
            let modes = modes(*place, determinant(*place));
            for i in 0..4 {
                load[i] -= w * product(self.moduli.stress(*e), modes[i]);
                for j in 0..4 {
                    matrix[(i, j)] += w * product(self.moduli.stress(modes[j]), modes[i]);
                }
            }
        }
        let found = matrix.lu().solve(&load).unwrap_or_else(Vector4::zeros);
        let mut forces = vec![[0.0; 2]; self.values.len()];
        for (gradients, e, w, place) in &at {
            let modes = modes(*place, determinant(*place));
            let whole = [0, 1, 2].map(|k| e[k] + (0..4).map(|i| found[i] * modes[i][k]).sum::<f64>());
            let s = self.moduli.stress(whole);
            for (force, g) in forces.iter_mut().zip(gradients) {
                force[0] += w * (g[0] * s[0] + g[1] * s[2]);
                force[1] += w * (g[0] * s[2] + g[1] * s[1]);
            }
        }
        forces
    }

    /// μ γ (γ·u) with the hourglass vector γ of Flanagan & Belytschko (1981), which no linear displacement has a part of.
    fn hourglass(&self) -> Vec<[f64; 2]> {
        let (gradients, determinant) = self.cell.gradients([0.0; 2]);
        let corners = self.cell.corners();
        let signs = [1.0, -1.0, 1.0, -1.0];
        let slope = [0, 1].map(|c| (0..4).map(|i| signs[i] * (corners[i][c] - corners[0][c])).sum::<f64>());
        let vector: Vec<f64> = (0..4)
            .map(|i| signs[i] - (slope[0] * gradients[i][0] + slope[1] * gradients[i][1]) / determinant)
            .collect();
        let base = self.values[0];
        let part = [0, 1].map(|c| (0..4).map(|i| vector[i] * (self.values[i][c] - base[c])).sum::<f64>());
        vector.iter().map(|v| part.map(|p| self.moduli.mu * v * p)).collect()
    }
}
