//! Quantities that scenes are asked for.

use hypercircle::dual::Options;
use hypercircle::element::{Elements, block};
use hypercircle::problem::Problem;
use hypercircle::scene::{Component, Extent, Invariant, PointValue, Quantity, Region, Target};

use super::random::Random;

/// Stresses of one degree, the factor kept for quantities.
pub fn of_degree(degree: usize) -> Options {
    Options { keep_factor: true, elements: Elements::Uniform(block(degree)), ..Options::default() }
}

pub fn quantity(name: &str, target: Target) -> Quantity {
    Quantity { name: name.to_string(), target }
}

/// Asks a problem for `quantities` and no others.
pub fn ask(problem: &mut Problem, quantities: Vec<Quantity>) {
    problem.scene = problem.scene.changed(|draft| draft.quantities = quantities).expect("a valid scene");
}

/// Everything that can be asked of a scene without knowing it.
pub fn everything(problem: &Problem, random: &mut Random) -> Vec<Quantity> {
    let scene = &problem.scene;
    let angle = random.between(0.0, 6.3);
    let direction = [angle.cos(), angle.sin()];
    let mut all = vec![quantity("body", Target::Displacement { of: Extent::Body(0), direction })];
    for traction in scene.tractions.iter().take(1) {
        let of = Extent::Boundary(traction.on.clone());
        all.push(quantity("loaded", Target::Displacement { of, direction }));
    }
    for (contact, interface) in problem.interfaces.iter().enumerate().take(2) {
        let mut forces = |name: String, window| {
            let of = |tangential| Target::ContactForce { contact, tangential, window };
            if problem.rubs_on(contact) {
                all.push(quantity(&format!("friction on {name}"), of(true)));
            }
            all.push(quantity(&name, of(false)));
        };
        forces(format!("contact {contact}"), None);
        // Where a window bends there is a vertex, on this mesh and on finer ones.
        let count = interface.pairs.len();
        if count >= 4 {
            forces(format!("window {contact}"), Some([0, 1, 2, 3].map(|i| interface.pairs[i * count / 4].arc[0])));
        }
    }
    for support in 0..scene.supports.len().min(2) {
        all.push(quantity(&format!("support {support}"), Target::SupportForce { support, direction }));
    }
    let component = Component::along(direction);
    all.push(quantity("stress", Target::Stress { body: 0, region: Region::Whole, component }));
    let t = (0..problem.mesh.triangles.len()).find(|&t| problem.mesh.body[t] == 0).expect("a triangle");
    let region = Region::Polygon(problem.mesh.corners(t).to_vec());
    all.push(quantity("corner", Target::Stress { body: 0, region, component }));
    // Points that lie anywhere, near the outline too.
    let t = random.below(problem.mesh.triangles.len());
    let (body, corners) = (problem.mesh.body[t], problem.mesh.corners(t));
    let weights = [0, 1, 2].map(|_| random.between(0.1, 1.0));
    let total: f64 = weights.iter().sum();
    let at = [0, 1].map(|c| (0..3).map(|i| weights[i] / total * corners[i][c]).sum());
    let values = [
        ("place", PointValue::Displacement(direction)),
        ("point", PointValue::Stress(component)),
        ("equivalent", PointValue::Invariant(random.pick(&Invariant::ALL))),
    ];
    for (name, value) in values {
        let smoothness = random.below(PointValue::SMOOTHEST + 1);
        all.push(quantity(name, Target::Point { body, at, value, smoothness }));
    }
    all
}
