//! The sizes of force, stress, displacement and energy that the data of a problem stand for.
//!
//! Zero is judged against the data, never against the answer alone: where the answer is free of stress
//! (a body moved rigidly, a gap that stays open) everything in it is round-off, and comparing round-off with round-off is
//! meaningless. Data cause stress in two ways. Tractions and weights have a size of their own. Prescribed displacements,
//! and gaps that a body crosses before contact holds it, cause at most modulus times displacement over length; the
//! stresses that they actually cause may be smaller or zero, but are computed from displacements of that size, and carry
//! their rounding errors.

use super::{BedPair, Condition, Problem};
use crate::element::Material;
use crate::vector::norm;

/// Rounding errors that a computed number carries, relative to the largest that it was computed from.
pub const ROUND_OFF: f64 = 64.0 * f64::EPSILON;

/// One number for each kind of quantity.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sizes {
    /// Force; thickness included.
    pub force: f64,
    /// Stress or traction.
    pub stress: f64,
    /// Displacement.
    pub displacement: f64,
    /// Energy; thickness included.
    pub energy: f64,
}

/// The sizes of a problem. All are zero exactly where nothing is applied, prescribed or open, and the answer then is.
#[derive(Debug, Clone, PartialEq)]
pub struct Scales {
    /// Upper limits of the effect of the data; not an estimate of the answer, which may be much smaller.
    pub data: Sizes,
    /// Rounding errors where the answer is zero. Numbers up to this size are to be taken as zero.
    pub round_off: Sizes,
    /// Largest applied traction, or what a body force adds up to across its body.
    pub traction: f64,
    /// How far supports and gaps can move a body: the largest prescribed displacement, the deepest overlap and all gaps beside pieces that
    /// are not clamped. The widest gap where there is nothing else.
    pub imposed: f64,
    /// Of each body, stress for a unit strain in one direction with none across it.
    modulus: Vec<f64>,
}

impl Scales {
    /// The sizes of `problem`.
    pub fn new(problem: &Problem) -> Self {
        let scene = &problem.scene;
        let bodies = Extents::of_bodies(problem);
        let loads = Loads::new(problem, &bodies);
        let materials = problem.materials();
        let imposed = match imposed(problem) {
            0.0 if loads.force == 0.0 => widest_gap(problem),
            imposed => imposed,
        };
        let imposed = imposed + initial(problem, &materials, &bodies);
        let modulus: Vec<f64> = materials.iter().map(Material::uniaxial).collect();
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let used = || materials.iter().zip(&bodies).filter(|(_, extent)| extent.any());
        let stiffest = largest(&mut used().map(|(material, _)| material.young()[1]));
        let softest = used().map(|(material, _)| material.young()[0]).fold(f64::INFINITY, f64::min);
        let hardest = largest(&mut modulus.iter().copied());
        let displacement =
            imposed + loads.force / (scene.thickness * softest) + loads.force / scene.thickness * give(problem);
        let energy = |stiffness: f64| loads.force * displacement + scene.thickness * stiffness * imposed * imposed;
        let strained = largest(&mut used().map(|(material, extent)| material.young()[1] * imposed / extent.diameter()));
        let resolved = largest(&mut (0..problem.mesh.triangles.len()).map(|t| per_length(problem, &modulus, t)));
        Scales {
            data: Sizes {
                force: loads.force + scene.thickness * stiffest * imposed,
                stress: loads.traction.max(strained),
                displacement,
                energy: energy(stiffest),
            },
            round_off: Sizes {
                force: ROUND_OFF * (loads.force + scene.thickness * hardest * imposed),
                stress: ROUND_OFF * (loads.traction + resolved * imposed),
                displacement: ROUND_OFF * displacement,
                energy: ROUND_OFF * energy(hardest),
            },
            traction: loads.traction,
            imposed,
            modulus,
        }
    }

    /// Sizes for a model that starts with every contact closed, as displacement models do: crossing a gap and coming back leaves
    /// a rounding error in proportion to the gap, even where the gap does not affect the answer. An energy at its minimum sees the
    /// square of that error.
    pub fn from_closed_contacts(mut self, problem: &Problem) -> Self {
        let pairs = problem.pairs();
        let widest = pairs.flat_map(|pair| pair.gap).fold(0.0, f64::max);
        let hardest = self.modulus.iter().copied().fold(0.0, f64::max);
        let stiffness = problem.scene.thickness * hardest;
        self.round_off.displacement += ROUND_OFF * widest;
        self.round_off.force += ROUND_OFF * stiffness * widest;
        self.round_off.energy += ROUND_OFF * ROUND_OFF * stiffness * widest * widest;
        self
    }

    /// Rounding error of imposed displacements, as stress of degree `degree` in triangle `t`, where the stress is zero.
    pub fn stress_round_off(&self, problem: &Problem, t: usize, degree: usize) -> f64 {
        if self.imposed == 0.0 {
            return 0.0;
        }
        ROUND_OFF * amplified(degree) * self.imposed * per_length(problem, &self.modulus, t)
    }
}

/// By how much more of rounding is left in coefficients of degree `degree` than in linear ones. The largest Bernstein
/// coefficients of polynomials of unit size grow like 2^p, and stresses meet them twice: once where the moments of the
/// displacement are weighed, once in their own coefficients.
pub fn amplified(degree: usize) -> f64 {
    4.0_f64.powi(degree as i32 - 1)
}

/// The stress of a unit displacement across the smallest height of a triangle.
fn per_length(problem: &Problem, modulus: &[f64], t: usize) -> f64 {
    let mesh = &problem.mesh;
    let [a, b, c] = mesh.corners(t);
    let side = |p: [f64; 2], q: [f64; 2]| norm([q[0] - p[0], q[1] - p[1]]);
    modulus[mesh.body[t]] * side(a, b).max(side(b, c)).max(side(c, a)) / (2.0 * mesh.area(t))
}

/// The box around a body.
#[derive(Debug, Clone, Copy)]
struct Extents {
    low: [f64; 2],
    high: [f64; 2],
}

impl Extents {
    fn of_bodies(problem: &Problem) -> Vec<Extents> {
        let nothing = Extents { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        let mut all = vec![nothing; problem.scene.bodies.len()];
        for (t, &body) in problem.mesh.body.iter().enumerate() {
            for point in problem.mesh.corners(t) {
                for (i, x) in point.into_iter().enumerate() {
                    all[body].low[i] = all[body].low[i].min(x);
                    all[body].high[i] = all[body].high[i].max(x);
                }
            }
        }
        all
    }

    fn any(&self) -> bool {
        self.low[0].is_finite()
    }

    fn sides(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }

    fn diameter(&self) -> f64 {
        norm(self.sides())
    }
}

/// Applied tractions and weights.
struct Loads {
    traction: f64,
    /// The sum of the magnitudes of all forces; thickness included.
    force: f64,
}

impl Loads {
    fn new(problem: &Problem, bodies: &[Extents]) -> Self {
        let (mut traction, mut force) = (0.0_f64, 0.0);
        for (e, condition) in problem.conditions.iter().enumerate() {
            let Condition::Traction([p, q]) = *condition else { continue };
            traction = traction.max(norm(p)).max(norm(q));
            force += 0.5 * problem.mesh.edge_frame(e).0 * (norm(p) + norm(q));
        }
        for (body, extent) in problem.scene.bodies.iter().zip(bodies).filter(|(_, extent)| extent.any()) {
            let [width, height] = extent.sides();
            traction = traction.max(body.body_force.largest_in([extent.low, extent.high]) * width.min(height));
        }
        for t in 0..problem.mesh.triangles.len() {
            force += problem.mesh.area(t) * problem.force_on(t).largest();
        }
        Loads { traction, force: problem.scene.thickness * force }
    }
}

/// The largest prescribed displacement, the deepest overlap of bodies, and the gaps that nothing but contact keeps a piece from crossing.
fn imposed(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let (piece, count) = mesh.pieces();
    let mut clamped = vec![false; count];
    let mut prescribed = 0.0_f64;
    for (edge, condition) in mesh.edges.iter().zip(&problem.conditions) {
        if let (Some(ends), Some(t)) = (condition.prescribed(), edge.triangles[0]) {
            clamped[piece[t]] |= matches!(condition, Condition::Clamped(_));
            prescribed = ends.into_iter().fold(prescribed, |most, u| most.max(norm(u)));
        }
    }
    let loose = |e: &Option<usize>| e.and_then(|e| mesh.edges[e].triangles[0]).is_some_and(|t| !clamped[piece[t]]);
    let crossed = problem.interfaces.iter().map(|interface| {
        let pairs = interface.pairs.iter().filter(|pair| pair.edges.iter().any(loose));
        pairs.flat_map(|pair| pair.gap).fold(0.0, f64::max)
    });
    let overlaps = problem.pairs().flat_map(|pair| pair.gap).fold(0.0_f64, |most, gap| most.max(-gap));
    prescribed + overlaps + crossed.sum::<f64>()
}

/// By how much a unit force, per unit thickness, moves a piece that nothing but springs holds in some motion, at most: the
/// softest of their stiffnesses, all edges taken together.
fn give(problem: &Problem) -> f64 {
    let mesh = &problem.mesh;
    let (piece, count) = mesh.pieces();
    let mut held = vec![false; count];
    for (edge, condition) in mesh.edges.iter().zip(&problem.conditions) {
        if let (Condition::Clamped(_), Some(t)) = (condition, edge.triangles[0]) {
            held[piece[t]] = true;
        }
    }
    let mut most = 0.0_f64;
    for bed in &problem.beds {
        let own = |pair: &BedPair| mesh.edges[pair.edge].triangles[0].is_none_or(|t| held[piece[t]]);
        if bed.pairs.iter().all(own) {
            continue;
        }
        let length: f64 = bed.pairs.iter().map(|pair| pair.length * pair.weight.mean()).sum();
        let softest = bed.stiffness.into_iter().filter(|k| *k > 0.0).fold(f64::INFINITY, f64::min);
        most = most.max(1.0 / (softest * length));
    }
    most
}

/// How far initial strains move the bodies that have one.
fn initial(problem: &Problem, materials: &[Material], bodies: &[Extents]) -> f64 {
    let of = |(material, extent): (&Material, &Extents)| {
        let strain = material.initial();
        if strain.is_none() || !extent.any() {
            return 0.0;
        }
        let [low, high] = [extent.low, extent.high];
        let corners = [low, high, [low[0], high[1]], [high[0], low[1]]];
        let size = |p: [f64; 2]| strain.around(p).iter().fold(0.0_f64, |most, e| most.max(e.abs()));
        corners.map(size).into_iter().fold(0.0, f64::max) * extent.diameter()
    };
    debug_assert_eq!(materials.len(), problem.scene.bodies.len());
    materials.iter().zip(bodies).map(of).fold(0.0, f64::max)
}

fn widest_gap(problem: &Problem) -> f64 {
    let pairs = problem.pairs();
    pairs.flat_map(|pair| pair.gap).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elasticity::Elasticity;
    use crate::mesh::testing::*;
    use crate::scene::{Affine, Gap, Load, Scene, SupportKind};

    /// Two unit squares side by side, the right one clamped.
    fn squares(gap: f64) -> Scene {
        let polygons = vec![rectangle("a", [0.0; 2], [1.0; 2]), rectangle("b", [1.0, 0.0], [2.0, 1.0])];
        let scene = geometry(scene(&["a", "b"]), Some(0.5), polygons);
        contact(clamp(scene, "b_right"), "a_right", "b_left", Gap::Constant(gap))
    }

    fn scales(scene: Scene) -> Scales {
        Scales::new(&Problem::load(scene).expect("a good scene"))
    }

    #[test]
    fn without_data_everything_is_zero() {
        let found = scales(squares(0.0));
        assert_eq!((found.data, found.round_off), (Sizes::default(), Sizes::default()));
    }

    #[test]
    fn loads_have_sizes_of_their_own() {
        let mut scene =
            load(squares(0.0), "a_left", Load::Affine(Affine { value: [3.0, 4.0], gradient: [[0.0; 2]; 2] }));
        scene.draft.thickness = 0.5;
        scene.draft.bodies[1].body_force = [0.0, -2.0].into();
        scene.draft.bodies[1].elasticity = Elasticity::Isotropic { young: 10.0, poisson: 0.3 };
        let found = scales(scene);
        assert!((found.traction, found.imposed) == (5.0, 0.0) && (found.data.force - 3.5).abs() < 1e-14);
        assert!((found.data.displacement - 7.0).abs() < 1e-14 && (found.data.energy - 24.5).abs() < 1e-13);
        assert_eq!(found.round_off.stress, ROUND_OFF * 5.0);
    }

    #[test]
    fn gaps_count_where_a_piece_can_cross_them() {
        let loose = scales(squares(0.25));
        let held = || clamp(squares(0.25), "a_left");
        let loaded = scales(load(held(), "a_top", Load::Pressure(1.0)));
        assert_eq!((loose.imposed, loaded.imposed, scales(held()).imposed), (0.25, 0.0, 0.25));
        assert!((loose.data.stress - 0.25 / 2.0_f64.sqrt()).abs() < 1e-15 && loose.round_off.energy > 0.0);
    }

    #[test]
    fn bodies_that_overlap_move_as_far() {
        assert_eq!([squares(-0.25), clamp(squares(-0.25), "a_left")].map(|scene| scales(scene).imposed), [0.25; 2]);
    }

    #[test]
    fn units_of_length_and_stress_scale_the_sizes() {
        let made = |length: f64, stress: f64| {
            let mut scene = load(squares(0.0), "a_left", Load::Pressure(2.0 * stress));
            scene.draft.supports[0].kind =
                SupportKind::Clamped { displacement: Affine::constant([0.01 * length, 0.0]) };
            scene.draft.bodies.iter_mut().for_each(|body| body.elasticity = body.elasticity.stiffened(stress));
            let mut problem = Problem::load(scene).expect("a good scene");
            problem.mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x *= length);
            Scales::new(&problem)
        };
        let unit = made(1.0, 1.0);
        for (length, stress) in [(1e-3, 1e9), (1e3, 1e-3)] {
            let found = made(length, stress);
            for (own, of) in [(found.data, unit.data), (found.round_off, unit.round_off)] {
                let same = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
                assert!(same(own.stress, of.stress * stress) && same(own.force, of.force * stress * length));
                assert!(same(own.displacement, of.displacement * length));
                assert!(same(own.energy, of.energy * stress * length * length));
            }
        }
    }
}
