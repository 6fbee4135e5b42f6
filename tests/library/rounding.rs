//! Effect of rounding on the bounds: energies in twice the digits, stresses that miss equilibrium on purpose, and the
//! mid-field.

use crate::support::Blocks;
use crate::support::double_double::Dd;
use crate::support::random::Random;
use crate::support::toml::Toml;
use hypercircle::bounds::{Bracket, complementary, mid_field};
use hypercircle::dual::{self, Condensed, DualSolution, Equilibrium, Options};
use hypercircle::element::{Elements, StressField, block};
use hypercircle::problem::{Condition, Problem};
use hypercircle::scene::{Affine, Gap, Scene, SupportKind};
use hypercircle::stability::regime;
use hypercircle::study::{StudyError, certify};

type Point = [Dd; 2];

fn dd(x: f64) -> Dd {
    Dd::from(x)
}

fn point(p: [f64; 2]) -> Point {
    p.map(dd)
}

/// Corners of subtriangle `sub`, and twice its area.
fn sub_triangle(problem: &Problem, t: usize, sub: usize) -> ([Point; 3], Dd) {
    let a = problem.mesh.corners(t).map(point);
    let centre = [0, 1].map(|c| (a[0][c] + a[1][c] + a[2][c]) / dd(3.0));
    let q = [a[(sub + 1) % 3], a[(sub + 2) % 3], centre];
    let twice = (q[1][0] - q[0][0]) * (q[2][1] - q[0][1]) - (q[1][1] - q[0][1]) * (q[2][0] - q[0][0]);
    (q, twice)
}

/// κ and γ of plane strain, from E and ν as written.
fn constants(problem: &Problem, t: usize) -> (Dd, Dd, Dd) {
    let body = &problem.scene.bodies[problem.mesh.body[t]];
    let [young, poisson] = body.elasticity.isotropic().expect("isotropic");
    let (one, nu) = (dd(1.0), dd(poisson));
    ((one + nu) * (one - nu - nu) / dd(2.0), dd(2.0) * (one + nu), dd(young))
}

/// −Π of the stress as stored: plane strain, u0 = 0, contact on a vertical line.
fn lower(problem: &Problem, stress: &StressField) -> Dd {
    let mut energy = Dd::default();
    for t in 0..problem.mesh.triangles.len() {
        let (kappa, gamma, young) = constants(problem, t);
        for sub in 0..3 {
            let (_, twice) = sub_triangle(problem, t, sub);
            let s = [0, 1, 2].map(|k| stress.block(t)[3 * sub + k].map(dd));
            for i in 0..3 {
                for j in 0..3 {
                    let trace = (s[i][0] + s[i][1]) * (s[j][0] + s[j][1]);
                    let deviator = (s[i][0] - s[i][1]) * (s[j][0] - s[j][1]) / dd(4.0) + s[i][2] * s[j][2];
                    let weight = dd(if i == j { 2.0 } else { 1.0 }) / dd(24.0);
                    energy = energy + weight * twice * (kappa * trace + gamma * deviator) / young;
                }
            }
        }
    }
    let mut gap = Dd::default();
    for pair in problem.pairs() {
        let e = pair.edges[0].expect("two bodies");
        let t = problem.mesh.edges[e].triangles[0].expect("a triangle");
        let sub = problem.mesh.triangle_edges[t].iter().position(|&x| x == e).expect("its edge");
        let [a, b] = problem.mesh.edges[e].vertices.map(|v| point(problem.mesh.points[v]));
        // Normal (1, 0) and a constant gap: half the sum of σ_11 at the ends.
        let traction = dd(stress.block(t)[3 * sub][0]) + dd(stress.block(t)[3 * sub + 1][0]);
        gap = gap + (b[1] - a[1]) * traction * dd(pair.gap[0]) / dd(2.0);
    }
    gap - energy / dd(2.0)
}

/// 𝓛 of the displacement as stored.
fn upper(problem: &Problem, v: &hypercircle::element::Displacement) -> Dd {
    let mut energy = Dd::default();
    for t in 0..problem.mesh.triangles.len() {
        let (kappa, gamma, young) = constants(problem, t);
        for sub in 0..3 {
            let (q, twice) = sub_triangle(problem, t, sub);
            let g: [Point; 3] = [0, 1, 2].map(|i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                [(q[j][1] - q[k][1]) / twice, (q[k][0] - q[j][0]) / twice]
            });
            // The coefficient of l_i l_j of a quadratic, in the order of `element::triangle`.
            let u: Vec<Point> = v.sub(t, sub).map(point).collect();
            let of = |i: usize, j: usize| u[[[0, 1, 2], [1, 3, 4], [2, 4, 5]][i][j]];
            for at in 0..3 {
                let half = |i: usize| dd(if i == at { 0.0 } else { 0.5 });
                let mut du = [[Dd::default(); 2]; 2];
                for (i, gradient) in g.iter().enumerate() {
                    for j in 0..3 {
                        for (du, u) in du.iter_mut().zip(of(i, j)) {
                            for d in 0..2 {
                                du[d] = du[d] + dd(2.0) * half(j) * gradient[d] * u;
                            }
                        }
                    }
                }
                let (trace, off) = (du[0][0] + du[1][1], du[0][0] - du[1][1]);
                let shear = du[0][1] + du[1][0];
                let density = young * (trace * trace / (dd(4.0) * kappa) + (off * off + shear * shear) / gamma);
                energy = energy + twice / dd(12.0) * density;
            }
        }
    }
    let mut work = Dd::default();
    for (e, condition) in problem.conditions.iter().enumerate() {
        let Condition::Traction([pa, pb]) = condition else { continue };
        let [a, b] = problem.mesh.edges[e].vertices.map(|v| point(problem.mesh.points[v]));
        let t = problem.mesh.edges[e].triangles[0].expect("a triangle");
        let side = problem.mesh.triangle_edges[t].iter().position(|&x| x == e).expect("its edge");
        let u: Vec<Point> = v.side(t, side).map(point).collect();
        // Along an axis, so that one of the two differences is the length and the other zero.
        let length = if a[0].high == b[0].high { b[1] - a[1] } else { b[0] - a[0] };
        let length = if length.high < 0.0 { -length } else { length };
        for c in 0..2 {
            let (p, q) = (dd(pa[c]), dd(pb[c]));
            let (first, last) = (dd(3.0) * p + q, p + dd(3.0) * q);
            work = work + length / dd(12.0) * (first * u[0][c] + dd(2.0) * (p + q) * u[1][c] + last * u[2][c]);
        }
    }
    energy - work
}

fn solve(problem: &Problem) -> DualSolution {
    dual::solve(&Condensed::default(), problem, &[], &Options::default()).expect("solves")
}

#[test]
fn energies_are_within_the_widening_of_those_in_twice_the_digits() {
    for nu in [0.0, 0.3, 0.4999, 0.4999999] {
        for (size, gap) in [(1.0, 0.0), (1.0, 0.01), (1e-6, 0.0), (1e6, 1.0)] {
            let problem =
                Blocks { n: 4, materials: [(1.0, nu), (3.7, nu)], size, gap: Gap::Constant(gap), ..Blocks::default() }
                    .problem();
            let dual = solve(&problem);
            let bracket = Bracket::new(&problem, &dual);
            let free = bracket.free.as_ref().expect("an upper bound");
            let scale = bracket.complementary.strain;
            let off_lower = (lower(&problem, &dual.stress) - dd(bracket.complementary.lower())).high.abs();
            let off_upper = (upper(&problem, &free.displacement) - dd(free.potential.total())).high.abs();
            println!(
                "ν {nu} size {size} gap {gap}: lower off by {:.1e} of {:.1e}, upper by {:.1e} of {:.1e}",
                off_lower / scale,
                bracket.lower_widening / scale,
                off_upper / scale,
                free.widening / scale
            );
            assert!(off_lower <= bracket.lower_widening && off_upper <= free.widening);
            // Wide enough, and of no consequence beside the gap.
            assert!(bracket.lower_widening + free.widening < 1e-8 * scale);
        }
    }
}

/// A stress that misses equilibrium by a known amount must not give a higher bound than equilibrated ones can.
#[test]
fn a_stress_out_of_equilibrium_is_paid_for() {
    // The exact energy of this scene, from below.
    const EXACT: f64 = -1.796_413_41;
    let problem = Blocks { n: 8, ..Blocks::default() }.problem();
    let dual = solve(&problem);
    let honest = Bracket::new(&problem, &dual);
    for miss in [1e-3, 1e-2, 0.1] {
        let mut wrong = dual.clone();
        wrong.stress.values_mut().iter_mut().flatten().for_each(|s| *s *= 1.0 - miss);
        wrong.equilibrium = Equilibrium::measure(&problem, &wrong.stress, &wrong.moments);
        let bracket = Bracket::new(&problem, &wrong);
        assert!(bracket.complementary.lower() > EXACT, "scaled down, the energy alone would be too high");
        assert!(bracket.lower() < EXACT, "{} off by {miss}", bracket.lower());
        assert!(bracket.lower() > honest.lower() - 10.0 * miss, "{} off by {miss}", bracket.lower());
    }
}

fn distance(problem: &Problem, a: &StressField, b: &StressField) -> f64 {
    let mut off = a.clone();
    for t in 0..a.len() {
        for (x, y) in off.block_mut(t).iter_mut().zip(b.block(t)) {
            *x = [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
        }
    }
    (2.0 * complementary(problem, &off).strain).sqrt()
}

#[test]
fn the_mid_field_lies_half_way_and_halves_the_bound() {
    let problem = Blocks { n: 8, ..Blocks::default() }.problem();
    let dual = solve(&problem);
    let bracket = Bracket::new(&problem, &dual);
    let free = bracket.free.as_ref().expect("an upper bound");
    let mid = mid_field(&problem, &dual.stress, &free.displacement).expect("linear stresses");
    let constitutive: f64 = free.local.triangles.iter().sum();
    let half = distance(&problem, &dual.stress, &mid);
    assert!((half - 0.5 * (2.0 * constitutive).sqrt()).abs() < 1e-9 * half, "{half} for {constitutive}");
    let gap = free.upper() - bracket.lower();
    let (bound, whole) = (free.mid_error(gap), (2.0 * gap).sqrt());
    assert!(bound >= 0.5 * whole && bound < 0.55 * whole, "{bound} of {whole}");
}

/// A square turned by `angle`, far from the origin, its north held and moved by `displacement` of (along its west side, across
/// it), beside an obstacle that its west side touches.
fn moved_along_an_obstacle(angle: f64, [along, across]: [f64; 2]) -> Problem {
    let (sin, cos) = angle.sin_cos();
    let place = |[x, y]: [f64; 2]| [7.3 + cos * x - sin * y, -2.9 + sin * x + cos * y];
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(place);
    let [dx, dy] = [0, 1].map(|c| corners[3][c] - corners[0][c]);
    let displacement = [along * dx - across * dy, along * dy + across * dx];
    let toml = Toml::default()
        .size(0.4)
        .polygon("square", &corners, ["", "", "north", "west"])
        .table(&format!("[[supports]]\non = \"north\"\ntype = \"clamped\"\ndisplacement = {displacement:?}"))
        .rigid("west");
    Problem::load(Scene::parse(&toml.text(), "square.toml".as_ref()).expect("a scene")).expect("a problem")
}

/// The obstacle allows it, and the answer is without stress; what the data say only to rounding contradicts nothing.
#[test]
fn a_body_may_slide_along_an_obstacle_in_every_direction() {
    for k in 0..60 {
        let angle = 0.1 + 0.1047 * f64::from(k);
        let options = Options::default();
        let problem = moved_along_an_obstacle(angle, [1.66e-3, 0.0]);
        let found = certify(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{angle}: {e}"));
        let upper = found.bracket.free.as_ref().expect("an upper bound").upper();
        assert!(found.bracket.lower() <= 0.0 && (0.0..1e-18).contains(&upper), "{angle}: {upper:e}");
        let outcome = certify(moved_along_an_obstacle(angle, [1.66e-3, 1e-11]), &Condensed::default(), &options);
        assert!(matches!(outcome, Err(StudyError::Contradiction(_))), "{angle}: it penetrates");
        assert!(certify(moved_along_an_obstacle(angle, [1.66e-3, -1e-11]), &Condensed::default(), &options).is_ok());
    }
}

/// Coefficients of higher degrees carry more of the rounding of a prescribed displacement, and mean no more.
#[test]
fn a_body_that_is_moved_has_no_stress_in_any_degree() {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenes/moved_rigidly.toml");
    let given = Scene::read(&file).expect("a scene");
    for p in 1..=8 {
        for k in 0..6 {
            let mut scene = given.clone();
            if k > 0 {
                let (sin, cos) = (0.4 + f64::from(k)).sin_cos();
                let kind = SupportKind::Clamped { displacement: Affine::constant([0.48 * cos, 0.48 * sin]) };
                scene = scene.changed(|draft| draft.supports[0].kind = kind).expect("a valid scene");
            }
            let problem = Problem::load(scene).expect("a problem");
            let options = Options { elements: Elements::Uniform(block(p)), ..Options::default() };
            let found = certify(problem, &Condensed::default(), &options).unwrap_or_else(|e| panic!("{p}, {k}: {e}"));
            let upper = found.bracket.free.as_ref().expect("an upper bound").upper();
            assert!(found.bracket.lower() == 0.0 && (0.0..1e-20).contains(&upper), "{p}, {k}: {upper:e}");
        }
    }
}

/// Another method, or the same on more processes, gives the same moments with other last digits.
#[test]
fn the_last_digits_of_moments_are_not_to_be_seen_in_the_upper_bound() {
    // Flat triangles at a contact, and contacts along curves: relaxation takes dozens of sweeps.
    for (row, step) in [("slivers", 3), ("fan", 6), ("curved", 2), ("curved-hollow", 4), ("curved-facets", 4)] {
        let row = regime(row).expect("a row");
        let problem = row.problem(row.values[step]).expect("a problem");
        let mut dual = solve(&problem);
        let of = |dual: &DualSolution| Bracket::new(&problem, dual).free.expect("an upper bound").upper();
        let expected = of(&dual);
        let mut random = Random::new(7);
        for _ in 0..2 {
            for moment in dual.moments.values_mut().iter_mut().flatten() {
                *moment *= 1.0 + f64::EPSILON * random.between(-2.0, 2.0);
            }
            let found = of(&dual);
            let apart = ((found - expected) / expected).abs();
            println!("{} at {}: {apart:.1e}", row.id, row.values[step]);
            assert!(apart < 1e-10, "{} at {}: {apart:.1e}", row.id, row.values[step]);
        }
    }
}
