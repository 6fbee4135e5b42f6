//! Wrong elastic constants.

use crate::diagnose::fit::Terms;
use crate::diagnose::space::{Moduli, Space};
use crate::diagnose::words::{factor, near, number_beside};
use crate::diagnose::{Finding, Trial};
use crate::element::Material;
use crate::scene::{Body, Kinematics};

/// Mistakes without a number: the other plane state, constants exchanged between bodies.
pub fn trials(space: &Space<'_>) -> Vec<Trial> {
    let problem = space.problem();
    let (scene, bodies) = (&problem.scene, &problem.scene.bodies);
    let own: Vec<Moduli> = bodies.iter().map(|b| Moduli::of_body(problem, b)).collect();
    let with = |others: &dyn Fn(usize) -> Moduli, finding: Finding| {
        let change = space.stiffness(|b| Some(others(b).less(own[b])).filter(|d| *d != NONE));
        Trial { rank: 0, left: space.left_with(&change), findings: vec![finding] }
    };
    let isotropic = |body: &Body| body.elasticity.isotropic();
    let (other, sentence) = match scene.kinematics {
        Kinematics::PlaneStrain | Kinematics::Axisymmetric => {
            (Kinematics::PlaneStress, "plane stress stands in place of plane strain")
        }
        Kinematics::PlaneStress => (Kinematics::PlaneStrain, "plane strain stands in place of plane stress"),
    };
    let negative =
        Finding::new("bodies/poisson-sign", None, None, "Poisson's ratio of every body has the opposite sign");
    let mut trials = Vec::new();
    if bodies.iter().any(|body| isotropic(body).is_some()) {
        let turned = |b: usize| match isotropic(&bodies[b]) {
            Some([young, poisson]) => Moduli::of(scene.kinematics, young, -poisson),
            None => own[b],
        };
        trials.push(with(&turned, negative));
    }
    let in_other_state = super::anisotropic::change(space, |b| {
        let Body { elasticity, initial, .. } = &bodies[b];
        let possible = !elasticity.is_plane_stress_only();
        possible.then(|| Material::new(other, elasticity).with_initial(other, elasticity, initial))
    });
    let findings = vec![Finding::new("kinematics", None, None, sentence)];
    trials.push(Trial { rank: 0, left: space.left_with(&in_other_state), findings });
    let pairs = (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| (i, j)));
    for (i, j) in pairs.take(MOST_PAIRS) {
        let swapped = |b: usize| {
            if b == i {
                j
            } else if b == j {
                i
            } else {
                b
            }
        };
        let mut exchange = |name: &str, what: &str, made: &dyn Fn(&Body, &Body) -> Moduli| {
            let finding = Finding::new(
                format!("bodies/{}|{}/{name}", bodies[i].name, bodies[j].name),
                None,
                None,
                format!("{what} of {} and {} are exchanged", bodies[i].name, bodies[j].name),
            );
            let own = &own;
            trials
                .push(with(&|b| if swapped(b) == b { own[b] } else { made(&bodies[b], &bodies[swapped(b)]) }, finding));
        };
        let exchanged = |own: &Body, other: &Body, which: [bool; 2]| {
            let constants = isotropic(own).zip(isotropic(other));
            constants.map_or(NONE, |(own, other)| {
                let [young, poisson] = [0, 1].map(|i| if which[i] { other[i] } else { own[i] });
                Moduli::of(scene.kinematics, young, poisson)
            })
        };
        let apart = match isotropic(&bodies[i]).zip(isotropic(&bodies[j])) {
            Some((a, b)) => [a[0] != b[0], a[1] != b[1]],
            None => [false; 2],
        };
        if apart[1] {
            exchange("poisson-exchanged", "Poisson's ratios", &|own, other| exchanged(own, other, [false, true]));
        }
        if apart[0] {
            exchange("young-exchanged", "Young's moduli", &|own, other| exchanged(own, other, [true, false]));
        }
        if apart == [true; 2] || (apart == [false; 2] && bodies[i].elasticity != bodies[j].elasticity) {
            exchange("materials-exchanged", "the materials", &|_, other| {
                Moduli::of_law(scene.kinematics, &other.elasticity)
            });
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
