//! Friction along a contact: the direction of sliding, and the bound of the traction along it.
//!
//! With j_t = (v' − v'')·t̂ along t̂, at right angles to the direction of contact, the law is φ(j_t) = τ̄ |j_t| with a given bound
//! τ̄ (Tresca): the traction on the first side along t̂ lies in [−τ̄, τ̄], and is against the sliding where there is any.
//!
//! On a body of revolution tractions are weighted with the distance r from the axis, and so is their bound, a quadratic r τ̄.

use crate::element::Section;
use crate::element::polynomial::side;
use crate::mesh::Triangulation;
use crate::problem::{ContactPair, Direction, EdgeWeight, Interface, Note};
use crate::scene::Contact;

/// Part of the length of a contact within which an arc length is that of a vertex.
const AT_VERTEX: f64 = 1e-9;

/// The resistance to sliding along a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// τ̄ at the two ends of the pair, linear between; per length of the pair, like the traction along n̂.
    pub bound: [f64; 2],
    /// t̂, with the arc length of the first side.
    pub tangent: Direction,
    /// Weight of the points of the pair in integrals.
    pub weight: EdgeWeight,
    /// Coulomb's coefficient where a displacement is held to its own contact forces: they bound its friction then, and `bound` is nothing.
    pub coefficient: Option<f64>,
}

impl Friction {
    /// Bernstein coefficients of τ̄ times the weight of the pair.
    pub fn weighted(&self) -> Vec<f64> {
        self.weight.times(&self.bound)
    }

    /// Friction of `pair` with these bounds at its two ends; none where both are zero.
    pub(super) fn within(bound: [f64; 2], pair: &ContactPair, place: (&Triangulation, Section)) -> Option<Self> {
        (bound != [0.0; 2]).then(|| Friction { bound, ..Friction::without_resistance(pair, place) })
    }

    /// Friction of `pair` with a bound of zero, which problems do not have.
    pub(super) fn without_resistance(pair: &ContactPair, (mesh, section): (&Triangulation, Section)) -> Self {
        let weight = EdgeWeight::of_pair(section, mesh, pair);
        Friction { bound: [0.0; 2], tangent: tangent(pair, mesh), weight, coefficient: None }
    }

    /// Bernstein coefficients of degree `degree` of a function that is nowhere larger than the weighted τ̄, and nowhere negative: that itself
    /// where it has this degree.
    pub fn coefficients(&self, degree: usize) -> Vec<f64> {
        let own = self.weighted();
        match own[..] {
            [a, .., b] if degree == 0 => vec![a.min(b)],
            [a, middle, b] if degree == 1 => below(a, middle, b).to_vec(),
            _ => side::elevate(&own, degree),
        }
    }

    /// The larger of the two ends.
    pub fn largest(&self) -> f64 {
        self.bound[0].max(self.bound[1])
    }
}

/// The ends of a line that is nowhere above the quadratic with these Bernstein coefficients, a product of two functions that are linear and
/// nowhere negative, and nowhere negative itself: its chord, or where that lies above it the tangent at its middle or at its lower end.
fn below(a: f64, middle: f64, b: f64) -> [f64; 2] {
    if a - 2.0 * middle + b <= 0.0 {
        return [a, b];
    }
    let at_middle = [0.25 * (3.0 * a + 2.0 * middle - b), 0.25 * (3.0 * b + 2.0 * middle - a)];
    if at_middle.iter().all(|end| *end >= 0.0) {
        at_middle
    } else if a <= b {
        [a, (2.0 * middle - a).max(0.0)]
    } else {
        [(2.0 * middle - b).max(0.0), b]
    }
}

/// Gives the pairs of a contact with friction, whose directions are known, its bound; pairs along which nothing resists have none.
pub(in crate::problem) fn resist(
    contact: &Contact,
    (mesh, section): (&Triangulation, Section),
    interface: &mut Interface,
    notes: &mut Vec<Note>,
) {
    let Some(bound) = &contact.friction else { return };
    let length = interface.pairs.iter().fold(0.0_f64, |m, pair| m.max(pair.arc[1]));
    let close = AT_VERTEX * length;
    let breaks = bound.breaks();
    let on_break = |s: f64| breaks.iter().copied().find(|b| (b - s).abs() <= close).unwrap_or(s);
    for pair in &mut interface.pairs {
        let ends = pair.arc.map(|s| bound.at(on_break(s)));
        pair.friction = Friction::within(ends, pair, (mesh, section));
    }
    let inside = |s: &&f64| interface.pairs.iter().any(|pair| **s - pair.arc[0] > close && pair.arc[1] - **s > close);
    let missed: Vec<String> = breaks.iter().filter(inside).map(f64::to_string).collect();
    if !missed.is_empty() {
        let text = format!(
            "contact {}: the break points of the friction bound at s = {} are no vertices; the bounds are for the friction bound \
             interpolated linearly on every edge",
            contact.name(),
            missed.join(", ")
        );
        notes.push(Note { weakens_guarantee: true, text });
    }
}

/// The direction of contact turned by a right angle, with the arc length of the first side.
fn tangent(pair: &ContactPair, mesh: &Triangulation) -> Direction {
    let forward = pair.edges[0].is_none_or(|e| mesh.edges[e].vertices[0] == pair.first[0]);
    let sign = if forward { 1.0 } else { -1.0 };
    Direction { ends: pair.direction.ends.map(|[x, y]| [-sign * y, sign * x]), shares: pair.direction.shares }
}

impl crate::problem::Problem {
    /// True if any contact resists sliding.
    pub fn has_friction(&self) -> bool {
        self.pairs().any(|pair| pair.friction.is_some())
    }

    /// True if contact number `contact` resists sliding.
    pub fn rubs_on(&self, contact: usize) -> bool {
        self.interfaces.get(contact).is_some_and(|interface| interface.pairs.iter().any(|pair| pair.friction.is_some()))
    }
}

#[cfg(test)]
mod tests {
    use crate::problem::Problem;
    use crate::scene::Scene;

    const SCENE: &str = r#"
        model = { kinematics = "plane-strain" }
        geometry.polygons = [
            { body = "low", points = [[0, 0], [2, 0], [2, 1], [0, 1]], edges = ["floor", "", "top", ""] },
            { body = "high", points = [[0, 1], [2, 1], [2, 2], [0, 2]], edges = ["foot", "", "load", ""] },
        ]
        bodies.low = { young = 1, poisson = 0.3 }
        bodies.high = { young = 1, poisson = 0.3 }
        supports = [{ on = "floor", type = "clamped" }]
        contacts = [{ between = ["top", "foot"], friction = { bound = BOUND } }]
    "#;

    fn problem(bound: &str) -> Problem {
        let scene = Scene::parse(&SCENE.replace("BOUND", bound), "scene.toml".as_ref()).expect("a scene");
        Problem::load(scene).expect("a problem")
    }

    #[test]
    fn bounds_bend_at_vertices_and_tangents_go_with_the_arc_length() {
        let problem = problem("[[0.5, 0.0], [1.25, 0.3], [1.5, 0.2]]").refine_uniform(1).expect("a finer mesh");
        assert!(problem.notes.iter().all(|note| !note.weakens_guarantee), "{:?}", problem.notes);
        for pair in problem.pairs() {
            let Some(friction) = pair.friction else {
                assert!(pair.arc[1] <= 0.5);
                continue;
            };
            assert_eq!(friction.tangent.ends, [[1.0, 0.0]; 2]);
            for (s, bound) in pair.arc.into_iter().zip(friction.bound) {
                let exact = if s < 1.25 { 0.4 * (s - 0.5) } else { (0.3 - 0.4 * (s - 1.25)).max(0.2) };
                assert!((bound - exact).abs() < 1e-12, "{bound} at {s}");
            }
        }
        assert!(problem.has_friction());
    }

    #[test]
    fn no_bound_is_no_friction() {
        let problem = problem("0.0");
        assert!(!problem.has_friction());
    }
}
