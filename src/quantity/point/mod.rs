//! Values at points.
//!
//! In a disc inside one homogeneous isotropic body displacement and stress are biharmonic, loads being constant or linear there, so that
//! their value in the middle is a mean over the disc with a smooth weight ([`Kernel`]): a bounded functional of the solution. The largest
//! disc that fits is taken.

mod disc;
mod displacement;
mod kernel;

use self::disc::Place;
pub use self::disc::{Disc, Spot, distance};
use self::kernel::Kernel;
use super::functional::projection::projected;
use super::functional::{Functional, NotBounded};
use crate::dual::ShapedStrain;
use crate::element::{Displacement, contraction};
use crate::problem::Problem;

/// Distances from the outline of the body below this part of its size put a point on it.
const ON_OUTLINE: f64 = 1e-9;

/// The part of the distance from the outline that is the radius: rounding puts no part of the disc beyond it.
const INSIDE: f64 = 1.0 - 1e-12;

/// Relative rounding error of a difference of squares.
const ROUNDING: f64 = 1e-13;

/// The value that is wanted at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wanted {
    /// Σ factors · (σ_xx, σ_yy, σ_xy).
    Stress([f64; 3]),
    /// The displacement along a unit vector.
    Displacement([f64; 2]),
}

/// A value at a point, as a mean over a disc about it.
#[derive(Debug, Clone)]
pub struct Point {
    wanted: Wanted,
    body: usize,
    disc: Disc,
    kernel: Kernel,
    /// Triangles that have a part of the disc.
    triangles: Vec<usize>,
}

impl Point {
    /// The value at `at` in body `body`, with a weight of this smoothness.
    ///
    /// # Errors
    /// [`NotBounded::PointInAnisotropic`], [`NotBounded::PointOutside`], [`NotBounded::PointOnOutline`].
    pub fn new(
        problem: &Problem,
        body: usize,
        at: [f64; 2],
        smoothness: usize,
        wanted: Wanted,
    ) -> Result<Self, NotBounded> {
        let mesh = &problem.mesh;
        let name = problem.scene.bodies[body].name.clone();
        if problem.materials()[body].softest().is_none() {
            return Err(NotBounded::PointInAnisotropic { body: name });
        }
        let seen = |v: usize| [mesh.points[v][0] - at[0], mesh.points[v][1] - at[1]];
        let is_own = |t: Option<usize>| t.is_some_and(|t| mesh.body[t] == body);
        let (mut nearest, mut size, mut on) = (f64::INFINITY, 0.0_f64, None);
        for (e, edge) in mesh.edges.iter().enumerate() {
            let [first, second] = edge.triangles.map(is_own);
            let [a, b] = edge.vertices.map(seen);
            if first != second {
                let away = distance(a, b);
                size = size.max(a[0].hypot(a[1]));
                if away < nearest {
                    (nearest, on) = (away, Some(e));
                }
            }
        }
        let [x, y] = problem.scene.as_written(at);
        if let Some(edge) = on.filter(|_| nearest <= ON_OUTLINE * size) {
            let own = mesh.edges[edge].triangles.into_iter().flatten().find(|&t| mesh.body[t] == body);
            let corners = own.map_or([at; 3], |t| mesh.corners(t)).map(|p| problem.scene.as_written(p));
            let boundary = mesh.edges[edge].name.map(|n| mesh.names[n].clone());
            return Err(NotBounded::PointOnOutline { x, y, body: name, instead: instead(wanted, corners, boundary) });
        }
        let holds = |t: usize| {
            let [a, b, c] = mesh.triangles[t].map(seen);
            let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
            cross(a, b) >= 0.0 && cross(b, c) >= 0.0 && cross(c, a) >= 0.0
        };
        let own = || (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == body);
        if !own().any(holds) {
            return Err(NotBounded::PointOutside { x, y, body: name });
        }
        let disc = Disc { middle: at, radius: INSIDE * nearest };
        let triangles = own().filter(|&t| disc.place(mesh.corners(t)) != Place::Outside).collect();
        Ok(Point { wanted, body, disc, kernel: Kernel::new(disc.radius, smoothness), triangles })
    }

    /// True if it is a displacement.
    pub fn is_displacement(&self) -> bool {
        matches!(self.wanted, Wanted::Displacement(_))
    }

    /// The strain χ that makes ∫ χ:σ the stress that is wanted, over k.
    fn strain(&self) -> Option<[f64; 3]> {
        match self.wanted {
            Wanted::Stress([xx, yy, xy]) => Some([xx, yy, 0.5 * xy]),
            Wanted::Displacement(_) => None,
        }
    }

    /// ∫ k χ:σ with the stress that `at` gives at points of subtriangles, of degree `degree` on each triangle; zero where no stress is
    /// wanted.
    pub fn strained(
        &self,
        problem: &Problem,
        degree: impl Fn(usize) -> usize,
        mut at: impl FnMut(usize, usize, [f64; 3]) -> [f64; 3],
    ) -> f64 {
        let Some(strain) = self.strain() else { return 0.0 };
        let mut sum = crate::bounds::Sum::default();
        for &t in &self.triangles {
            for spot in self.disc.spots(problem.mesh.corners(t), self.kernel.degree() + degree(t)) {
                let weight = spot.weight * self.kernel.weight(spot.from_middle);
                sum.add(weight * contraction(strain, at(t, spot.sub, spot.l)));
            }
        }
        sum.value()
    }

    /// The mean of kχ over each triangle, with ∫ c(kχ − mean):(kχ − mean) of what that leaves; `None` where no stress is wanted.
    pub fn means(&self, problem: &Problem) -> Option<Vec<(usize, [f64; 3], f64)>> {
        let strain = self.strain()?;
        let square = problem.materials()[self.body].strain_product(strain, strain);
        let of = |&t: &usize| {
            let (mut sum, mut squares) = (crate::bounds::Sum::default(), crate::bounds::Sum::default());
            for spot in self.disc.spots(problem.mesh.corners(t), 2 * self.kernel.degree()) {
                let k = self.kernel.weight(spot.from_middle);
                sum.add(spot.weight * k);
                squares.add(spot.weight * k * k);
            }
            let (area, squares) = (problem.mesh.area(t), squares.value());
            let mean = sum.value() / area;
            let left = (squares - area * mean * mean).max(0.0) + ROUNDING * squares;
            (t, strain.map(|e| mean * e), left * square)
        };
        Some(self.triangles.iter().map(of).collect())
    }

    /// ∫ k d·v; zero where no displacement is wanted.
    pub fn displaced(&self, problem: &Problem, v: &Displacement) -> f64 {
        let Wanted::Displacement(d) = self.wanted else { return 0.0 };
        let mut sum = crate::bounds::Sum::default();
        for &t in &self.triangles {
            for spot in self.disc.spots(problem.mesh.corners(t), self.kernel.degree() + v.degree(t)) {
                let u = v.in_sub(t, spot.sub, spot.l);
                sum.add(spot.weight * self.kernel.weight(spot.from_middle) * (d[0] * u[0] + d[1] * u[1]));
            }
        }
        sum.value()
    }

    /// Adds what the adjoint problem is loaded with to `functional`, in the degrees of the fields on each triangle and of each edge.
    pub fn load(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        stress_degree: impl Fn(usize) -> usize,
        edge_degree: impl Fn(usize) -> usize,
    ) {
        match self.strain() {
            Some(strain) => self.load_of_stress(problem, functional, strain, stress_degree),
            None => self.load_of_displacement(problem, functional, stress_degree, edge_degree),
        }
    }

    fn load_of_stress(
        &self,
        problem: &Problem,
        functional: &mut Functional,
        strain: [f64; 3],
        stress_degree: impl Fn(usize) -> usize,
    ) {
        let material = problem.materials()[self.body];
        for &t in &self.triangles {
            let corners = problem.mesh.corners(t);
            let degree = stress_degree(t);
            let spots = self.disc.spots(corners, 2 * self.kernel.degree().max(degree));
            let chi: Vec<[f64; 3]> = spots
                .iter()
                .map(|spot| {
                    let k = self.kernel.weight(spot.from_middle);
                    strain.map(|e| k * e)
                })
                .collect();
            let whole = self.disc.place(corners) == Place::Inside;
            let found = projected(corners, &material, degree, (&spots, whole), &chi);
            functional.load.shaped.push(ShapedStrain { triangle: t, strain: found.field });
            functional.rests.push(found.rest);
        }
    }
}

/// An alternative to a value on the outline, in the words of a scene.
fn instead(wanted: Wanted, corners: [[f64; 2]; 3], boundary: Option<String>) -> String {
    let middle = [0, 1].map(|c| corners.iter().map(|p| p[c]).sum::<f64>() / 3.0);
    let point = |[x, y]: [f64; 2]| format!("[{x:.6}, {y:.6}]");
    let inside = format!("`point = {}`, a point inside", point(middle));
    match (wanted, boundary) {
        (Wanted::Displacement(_), Some(name)) => {
            format!("{inside}, or `displacement = \"{name}\"` without `point`, the mean over that boundary")
        }
        (Wanted::Displacement(_), None) => inside,
        (Wanted::Stress(_), _) => {
            let polygon = corners.map(point).join(", ");
            format!(
                "{inside}, or `polygon = [{polygon}]` in the place of `point`, the mean over one triangle of the mesh"
            )
        }
    }
}
