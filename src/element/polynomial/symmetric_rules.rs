//! Quadrature on triangles as displacement programs have it: rules that are the same from all corners.
//!
//! Which of them a program used shows where integrands are no polynomials, as in bodies of revolution.

use std::sync::OnceLock;

use super::quadrature::even_rule;

/// Points in barycentric coordinates with weights that sum to one.
pub type Rule = Vec<([f64; 3], f64)>;

/// A weight and the coordinates of one of the points that have it: the others are its permutations.
type Orbit = (f64, [f64; 3]);

const THIRD: f64 = 1.0 / 3.0;
const SIXTH: f64 = 1.0 / 6.0;

/// Number of points and degree: 1 (1), 3 and 3 (2), 4 (3), 6 (3), 6 (4), 7 (5), 12 (6), 13 (7), 16 (8): Strang & Fix, Radon, Dunavant.
const ORBITS: [&[Orbit]; 10] = [
    &[(1.0, [THIRD; 3])],
    &[(THIRD, [2.0 * THIRD, SIXTH, SIXTH])],
    &[(THIRD, [0.0, 0.5, 0.5])],
    &[(-0.5625, [THIRD; 3]), (25.0 / 48.0, [0.6, 0.2, 0.2])],
    &[(SIXTH, [0.109_039_009_072_877, 0.231_933_368_553_031, 0.659_027_622_374_092])],
    &[
        (0.223_381_589_678_011, [0.108_103_018_168_070, 0.445_948_490_915_965, 0.445_948_490_915_965]),
        (0.109_951_743_655_322, [0.816_847_572_980_459, 0.091_576_213_509_771, 0.091_576_213_509_771]),
    ],
    &[
        (0.225, [THIRD; 3]),
        (0.125_939_180_544_827, [0.797_426_985_353_087, 0.101_286_507_323_456, 0.101_286_507_323_456]),
        (0.132_394_152_788_506, [0.059_715_871_789_770, 0.470_142_064_105_115, 0.470_142_064_105_115]),
    ],
    &[
        (0.116_786_275_726_379, [0.501_426_509_658_179, 0.249_286_745_170_910, 0.249_286_745_170_910]),
        (0.050_844_906_370_207, [0.873_821_971_016_996, 0.063_089_014_491_502, 0.063_089_014_491_502]),
        (0.082_851_075_618_374, [0.053_145_049_844_817, 0.310_352_451_033_784, 0.636_502_499_121_399]),
    ],
    &[
        (-0.149_570_044_467_682, [THIRD; 3]),
        (0.175_615_257_433_208, [0.479_308_067_841_920, 0.260_345_966_079_040, 0.260_345_966_079_040]),
        (0.053_347_235_608_838, [0.869_739_794_195_568, 0.065_130_102_902_216, 0.065_130_102_902_216]),
        (0.077_113_760_890_257, [0.048_690_315_425_316, 0.312_865_496_004_874, 0.638_444_188_569_810]),
    ],
    &[
        (0.144_315_607_677_787, [THIRD; 3]),
        (0.095_091_634_267_285, [0.081_414_823_414_554, 0.459_292_588_292_723, 0.459_292_588_292_723]),
        (0.103_217_370_534_718, [0.658_861_384_496_480, 0.170_569_307_751_760, 0.170_569_307_751_760]),
        (0.032_458_497_623_198, [0.898_905_543_365_938, 0.050_547_228_317_031, 0.050_547_228_317_031]),
        (0.027_230_314_174_435, [0.008_394_777_409_958, 0.263_112_829_634_638, 0.728_492_392_955_404]),
    ],
];

/// All of them, the one of FEniCSx beside this program first.
pub fn symmetric_rules() -> &'static [Rule] {
    static RULES: OnceLock<Vec<Rule>> = OnceLock::new();
    RULES.get_or_init(|| {
        let made = |orbits: &&[Orbit]| orbits.iter().flat_map(|orbit| points(*orbit)).collect();
        std::iter::once(even_rule()).chain(ORBITS.iter().map(made)).collect()
    })
}

fn points((weight, [a, b, c]): Orbit) -> Rule {
    let mut all: Rule = Vec::new();
    for point in [[a, b, c], [b, c, a], [c, a, b], [a, c, b], [c, b, a], [b, a, c]] {
        if all.iter().all(|(known, _)| *known != point) {
            all.push((point, weight));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degrees() {
        let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
        for (rule, (count, degree)) in symmetric_rules()[1..].iter().zip([
            (1, 1),
            (3, 2),
            (3, 2),
            (4, 3),
            (6, 3),
            (6, 4),
            (7, 5),
            (12, 6),
            (13, 7),
            (16, 8),
        ]) {
            assert_eq!(rule.len(), count);
            for i in 0..=degree {
                for j in 0..=degree - i {
                    let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                    let sum: f64 = rule.iter().map(|(l, w)| w * l[0].powi(i as i32) * l[2].powi(j as i32)).sum();
                    assert!((sum - exact).abs() < 1e-13, "{count} points: {i} {j}: {sum} is not {exact}");
                }
            }
        }
    }
}
