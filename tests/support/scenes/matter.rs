//! Materials, temperatures and initial stresses, in the words of a scene.

use super::super::random::Random;

/// The keys of a body with constants of the size of these, initial strains up to `strain`, in a scene of this length.
pub fn keys(random: &mut Random, constants: (f64, f64), strain: f64, length: f64) -> String {
    made(random, constants, (strain, length), true)
}

/// As [`keys`], with moduli that are never a thousand times apart, a ratio for which no coarse mesh has a bracket.
pub fn moderate(random: &mut Random, constants: (f64, f64), strain: f64, length: f64) -> String {
    made(random, constants, (strain, length), false)
}

fn made(random: &mut Random, (young, poisson): (f64, f64), (strain, length): (f64, f64), far: bool) -> String {
    let law = match random.below(4) {
        0 => format!("young = {young:?}\npoisson = {poisson:?}"),
        1 => {
            let [first, second, third, shear, nu] = constants(random, young, poisson, far);
            let mut rows = [[0.0; 6]; 6];
            for (i, e) in [first, second, third].into_iter().enumerate() {
                rows[i][i] = 1.0 / e;
            }
            for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                let off = -nu * (rows[i][i] * rows[j][j]).sqrt();
                (rows[i][j], rows[j][i]) = (off, off);
            }
            (rows[3][3], rows[4][4], rows[5][5]) = (1.0 / shear, 1.0 / shear, 1.0 / shear);
            format!("compliance = {rows:?}\nangle = {:?}", angle(random))
        }
        _ => {
            let [first, second, third, shear, nu] = constants(random, young, poisson, far);
            let of = |a: f64, b: f64| nu * (a / b).sqrt();
            let poisson = [of(first, second), of(first, third), of(second, third)];
            let young = [first, second, third];
            format!(
                "orthotropic = {{ young = {young:?}, poisson = {poisson:?}, shear = {shear:?}, angle = {:?} }}",
                angle(random)
            )
        }
    };
    let mut keys = law;
    if random.chance(0.5) {
        let expansion = if random.chance(0.5) { [1e-5; 3] } else { [0, 1, 2].map(|_| random.between(-1e-5, 3e-5)) };
        let warm = strain / 1e-5;
        let value = warm * random.between(-1.0, 1.0);
        let slope =
            |random: &mut Random| if random.chance(0.5) { 0.0 } else { warm / length * random.between(-0.5, 0.5) };
        let gradient = [slope(random), slope(random)];
        keys += &format!("\nexpansion = {expansion:?}\ntemperature = {{ value = {value:?}, gradient = {gradient:?} }}");
    }
    if random.chance(0.25) {
        let stress = [0, 1, 2].map(|_| young * strain * random.between(-1.0, 1.0));
        keys += &format!("\ninitial_stress = {stress:?}");
    }
    keys
}

fn angle(random: &mut Random) -> f64 {
    random.pick(&[0.0, 30.0, 45.0, -60.0, 90.0]) + if random.chance(0.5) { random.between(-20.0, 20.0) } else { 0.0 }
}

/// E1, E2, E3, G12 and ν of ν_ij = ν √(E_i/E_j), which is positive definite for ν in (−1, ½).
fn constants(random: &mut Random, young: f64, poisson: f64, far: bool) -> [f64; 5] {
    let spread = if far && random.chance(0.1) { 4.0 } else { 1.0 };
    let mut modulus = || young * random.magnitude(-spread, 0.0);
    let [first, second, third] = [modulus(), modulus(), modulus()];
    let shear = 0.5 * (first * second).sqrt() / (1.0 + poisson) * random.between(0.3, 1.5);
    [first, second, third, shear, poisson]
}
