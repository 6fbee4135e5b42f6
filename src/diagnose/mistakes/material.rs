//! Wrong elastic constants.

use crate::diagnose::fit::Terms;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::words::{factor, near, number_beside};
use crate::diagnose::{Finding, Trial};
use crate::elasticity::Elasticity;
use crate::element::Material;
use crate::scene::{Body, Kinematics};

/// The other plane state.
pub fn other_state(space: &Space<'_>) -> Trial {
    let scene = &space.problem().scene;
    let (other, sentence) = match scene.kinematics {
        Kinematics::PlaneStrain | Kinematics::Axisymmetric => {
            (Kinematics::PlaneStress, "plane stress stands in place of plane strain")
        }
        Kinematics::PlaneStress => (Kinematics::PlaneStrain, "plane strain stands in place of plane stress"),
    };
    let change = space.with_materials(|b| {
        let Body { elasticity, initial, .. } = &scene.bodies[b];
        let possible = !elasticity.is_plane_stress_only();
        possible.then(|| Material::new(other, elasticity).with_initial(other, elasticity, initial))
    });
    let findings = vec![Finding::new("kinematics", None, None, sentence)];
    Trial { rank: 0, left: space.left_with(&change), findings }
}

/// Mistakes that result in other laws: ratios of the opposite sign, constants exchanged between bodies.
pub fn laws(space: &Space<'_>) -> Vec<Trial> {
    let bodies = &space.problem().scene.bodies;
    let constants: Vec<Option<[f64; 2]>> = bodies.iter().map(|body| body.elasticity.isotropic()).collect();
    let isotropic = |[young, poisson]: [f64; 2]| Elasticity::Isotropic { young, poisson };
    let trial = |name: String, sentence: String, law: &dyn Fn(usize) -> Option<Elasticity>| Trial {
        rank: 0,
        left: space.left_with(&space.with_laws(law)),
        findings: vec![Finding::new(name, None, None, sentence)],
    };
    let mut trials = Vec::new();
    if constants.iter().any(Option::is_some) {
        let sentence = "Poisson's ratio of every body has the opposite sign".to_string();
        let negative = |b: usize| constants[b].map(|[young, poisson]| isotropic([young, -poisson]));
        trials.push(trial("bodies/poisson-sign".into(), sentence, &negative));
    }
    let pairs = (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| (i, j)));
    for (i, j) in pairs.take(MOST_PAIRS) {
        let other = |b: usize| if b == i { Some(j) } else { (b == j).then_some(i) };
        let mut exchange = |name: &str, what: &str, law: &dyn Fn(usize) -> Option<Elasticity>| {
            let names = [&bodies[i].name, &bodies[j].name];
            let sentence = format!("{what} of {} and {} are exchanged", names[0], names[1]);
            trials.push(trial(format!("bodies/{}|{}/{name}", names[0], names[1]), sentence, law));
        };
        let constants_of = |b: usize| Some((constants[b]?, constants[other(b)?]?));
        let apart = match constants[i].zip(constants[j]) {
            Some((a, b)) => [a[0] != b[0], a[1] != b[1]],
            None => [false; 2],
        };
        if apart[1] {
            let law = |b: usize| constants_of(b).map(|(own, other)| isotropic([own[0], other[1]]));
            exchange("poisson-exchanged", "Poisson's ratios", &law);
        }
        if apart[0] {
            let law = |b: usize| constants_of(b).map(|(own, other)| isotropic([other[0], own[1]]));
            exchange("young-exchanged", "Young's moduli", &law);
        }
        if apart == [true; 2] || (apart == [false; 2] && bodies[i].elasticity != bodies[j].elasticity) {
            exchange("materials-exchanged", "the materials", &|b| Some(bodies[other(b)?].elasticity));
        }
    }
    trials
}

/// Pairs of bodies whose materials may be exchanged: more are not tried.
const MOST_PAIRS: usize = 200;
/// Bodies of their own in least squares: more are not tried.
pub const MOST_BODIES: usize = 64;
const NONE: Moduli = Moduli::NONE;

/// Constants that are off by a number.
pub fn terms<'a>(space: &'a Space<'a>, terms: &mut Terms<'a>) {
    let problem = space.problem();
    let (scene, bodies) = (&problem.scene, &problem.scene.bodies);
    let own = move |b: usize| Moduli::of_body(problem, &bodies[b]);
    let all = |name: &'static str, what: &'static str, part: fn(Moduli) -> Moduli, terms: &mut Terms<'a>| {
        let column = space.stiffness(|b| Some(part(own(b))));
        let poisson: Vec<f64> =
            bodies.iter().filter_map(|body| body.elasticity.isotropic()).map(|[_, nu]| nu).collect();
        terms.push(1, vec![column], move |x| {
            let s = 1.0 + x[0];
            let mut sentence = factor(what, s);
            let turned = |nu: &f64| *nu != 0.0 && near(s, (1.0 - 2.0 * nu) / (1.0 + 2.0 * nu));
            if name == "stiffness/lambda" && scene.kinematics == Kinematics::PlaneStrain && poisson.iter().all(turned) {
                sentence += ", as if 1 + 2ν stood in place of 1 − 2ν";
            }
            vec![Finding::new(name, Some(s), Some(1.0), sentence)]
        });
    };
    all("stiffness/lambda", "Lamé's λ of every body", |m| Moduli { lambda: m.lambda, ..NONE }, terms);
    all("stiffness/shear", "the shear stiffness of every body", |m| Moduli { shear: m.shear, ..NONE }, terms);
    for b in 0..bodies.len().min(MOST_BODIES) {
        let body = &bodies[b];
        let Some([given_young, given_poisson]) = body.elasticity.isotropic() else {
            anisotropic(space, b, own(b), terms);
            continue;
        };
        let part = |moduli: Moduli| space.stiffness(|at| (at == b).then_some(moduli));
        let (of_lambda, of_mu) = (part(Moduli { lambda: 1.0, ..NONE }), part(Moduli { mu: 1.0, shear: 1.0, ..NONE }));
        let Moduli { lambda, mu, .. } = own(b);
        let whole = of_lambda.iter().zip(&of_mu).map(|(l, m)| lambda * l + mu * m).collect();
        // With one body alone its modulus cannot be told from the loads, which have the word.
        if bodies.len() > 1 {
            terms.push(1, vec![whole], move |x| {
                let what = format!("Young's modulus of {}", body.name);
                let found = (1.0 + x[0]) * given_young;
                let sentence = factor(&what, 1.0 + x[0]);
                vec![Finding::new(format!("body/{}/young", body.name), Some(found), Some(given_young), sentence)]
            });
        }
        terms.push(2, vec![of_lambda, of_mu], move |x| {
            let [young, poisson] = Moduli::engineering(scene.kinematics, lambda + x[0], mu + x[1]);
            told(body, [young, poisson], [given_young, given_poisson])
        });
    }
    if bodies.len() > 1 {
        let column = |part: fn(Moduli) -> Moduli| space.stiffness(|b| Some(part(own(b))));
        let columns = vec![column(|m| Moduli { lambda: m.lambda, ..NONE }), column(|m| Moduli { lambda: 0.0, ..m })];
        let alike = bodies.iter().all(|b| b.elasticity == bodies[0].elasticity);
        if let (true, Some([given_young, given_poisson])) = (alike, bodies[0].elasticity.isotropic()) {
            terms.push(2, columns, move |x| {
                let first = own(0);
                let [young, poisson] =
                    Moduli::engineering(scene.kinematics, first.lambda * (1.0 + x[0]), first.mu * (1.0 + x[1]));
                let sentence = |what: &str, found: f64, given: f64| {
                    format!("{what} of every body is {} in place of {given}", number_beside(found, given))
                };
                let of = |key: &str, what: &str, found: f64, given: f64| {
                    Finding::new(format!("bodies/{key}"), Some(found), Some(given), sentence(what, found, given))
                };
                let mut findings = vec![of("poisson", "Poisson's ratio", poisson, given_poisson)];
                if !near(young, given_young) {
                    findings.push(of("young", "Young's modulus", young, given_young));
                }
                findings
            });
        }
    }
}

/// Findings on two constants of a body, with the values that the scene gives.
pub fn told(body: &Body, [young, poisson]: [f64; 2], [given_young, given_poisson]: [f64; 2]) -> Vec<Finding> {
    let mut findings = Vec::new();
    if !near(young, given_young) {
        let sentence = format!(
            "Young's modulus of {} is {} in place of {given_young}",
            body.name,
            number_beside(young, given_young)
        );
        findings.push(Finding::new(format!("body/{}/young", body.name), Some(young), Some(given_young), sentence));
    }
    if !near(poisson, given_poisson) || findings.is_empty() {
        let found = if poisson.abs() < NO_RATIO { "0".to_string() } else { number_beside(poisson, given_poisson) };
        let sentence = format!("Poisson's ratio of {} is {found} in place of {given_poisson}", body.name);
        let name = format!("body/{}/poisson", body.name);
        findings.push(Finding::new(name, Some(poisson), Some(given_poisson), sentence));
    }
    findings
}

/// Ratios that are smaller are none.
const NO_RATIO: f64 = 1e-4;

/// One factor on all moduli of a body that is not isotropic.
fn anisotropic<'a>(space: &'a Space<'a>, b: usize, own: Moduli, terms: &mut Terms<'a>) {
    let bodies = &space.problem().scene.bodies;
    if bodies.len() > 1 {
        let column = space.stiffness(|at| (at == b).then_some(own));
        terms.push(1, vec![column], move |x| {
            let sentence = factor(&format!("the stiffness of {}", bodies[b].name), 1.0 + x[0]);
            vec![Finding::new(format!("body/{}/stiffness", bodies[b].name), Some(1.0 + x[0]), Some(1.0), sentence)]
        });
    }
}
