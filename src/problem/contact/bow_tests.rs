use super::*;
use crate::problem::Direction;

/// Pseudo-random numbers in [0, 1).
fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn pair(gap: &Gap, arc: [f64; 2]) -> ContactPair {
    ContactPair {
        edges: [Some(0), None],
        first: [0, 1],
        second: None,
        normal: [0.0, -1.0],
        direction: Direction::constant([0.0, -1.0]),
        length: arc[1] - arc[0],
        arc,
        gap: arc.map(|s| gap.at(s)),
        bow: Bow::of(gap, arc),
        friction: None,
        stiffness: None,
    }
}

/// Curves of many radii and edges of them, long and short, near the point that touches, across it and far from it.
fn edges(round: bool) -> impl Iterator<Item = (Gap, ContactPair, f64)> {
    let mut next = numbers(7);
    (0..400).map(move |_| {
        let radius = 10.0_f64.powf(4.0 * next() - 2.0);
        let touching = Touching { radius, at: radius * (next() - 0.5) };
        let gap = if round { Gap::Circle(touching) } else { Gap::Parabola(touching) };
        let length = radius * 10.0_f64.powf(-3.5 * next());
        let from = touching.at + radius * 1.6 * (next() - 0.5) - next() * length;
        let pair = pair(&gap, [from, from + length]);
        (gap, pair, radius)
    })
}

fn at(pair: &ContactPair, t: f64) -> f64 {
    pair.arc[0] + t * pair.length
}

#[test]
fn a_parabola_is_its_polynomial() {
    for (gap, pair, radius) in edges(false) {
        assert_eq!((pair.gap_polynomial().len(), pair.bow.excess()), (3, 0.0));
        for t in [0.0, 0.21, 0.5, 0.93, 1.0] {
            let rounding = 1e-14 * (radius + pair.gap[0] + pair.gap[1]);
            assert!((pair.gap_at(t) - gap.at(at(&pair, t))).abs() <= rounding);
            assert!((side::value(&pair.gap_below(5), t) - pair.gap_at(t)).abs() <= rounding);
        }
    }
}

#[test]
fn the_polynomial_of_a_circle_lies_below_it_and_no_farther_than_it_says() {
    let mut tight = 0;
    for (gap, pair, radius) in edges(true) {
        let rounding = 4e-16 * (radius + pair.gap[0] + pair.gap[1]);
        (0..2).for_each(|end| assert!((pair.gap_at(end as f64) - pair.gap[end]).abs() <= rounding));
        for k in 1..200 {
            let t = f64::from(k) / 200.0;
            let above = gap.at(at(&pair, t)) - pair.gap_at(t);
            assert!(above >= -rounding, "{above} at {t} of {pair:?}");
            assert!(above <= 4.0 * t * (1.0 - t) * pair.bow.excess() + rounding, "{above} at {t} of {pair:?}");
        }
        tight += usize::from(pair.bow.excess() < 1e-9 * pair.length * pair.length / radius);
    }
    assert!(tight > 200, "{tight} of 400 are enclosed to nine digits");
}

#[test]
fn what_lies_below_the_gap_does_so_coefficient_by_coefficient() {
    for (_, pair, radius) in edges(true).chain(edges(false)) {
        let rounding = 1e-14 * (radius + pair.gap[0] + pair.gap[1]);
        let own = pair.gap_polynomial();
        for degree in 2..=10 {
            let below = pair.gap_below(degree);
            assert_eq!([below[0], below[degree]], pair.gap);
            let common = own.len().max(degree + 1) - 1;
            let [gap, below] = [&own, &below].map(|c| side::elevate(c, common));
            let least = gap.iter().zip(&below).map(|(g, b)| g - b).fold(f64::INFINITY, f64::min);
            assert!(least >= -rounding, "{least} in degree {degree} of {pair:?}");
        }
        let lowered = pair.gap_below(1);
        for k in 0..=50 {
            let t = f64::from(k) / 50.0;
            assert!(side::value(&lowered, t) <= pair.gap_at(t) + rounding);
        }
    }
}

#[test]
fn moments_and_mean_are_integrals_of_the_polynomial() {
    for (_, pair, _) in edges(true).step_by(20) {
        let steps = 2000;
        let weight = |i: usize| if i == 0 || i == steps { 1.0 } else { (2 + 2 * (i % 2)) as f64 };
        let integral = |f: &dyn Fn(f64) -> f64| {
            (0..=steps).map(|i| weight(i) * f(i as f64 / steps as f64)).sum::<f64>() / (3 * steps) as f64
        };
        let size = pair.gap[0] + pair.gap[1] + pair.bow.coefficients().first().unwrap_or(&0.0);
        assert!((pair.mean_gap() - integral(&|t| pair.gap_at(t))).abs() < 1e-9 * size);
        for (k, moment) in pair.gap_moments(3).into_iter().enumerate() {
            let expected = integral(&|t| pair.gap_at(t) * side::bernstein(3, k, t));
            assert!((moment - expected).abs() < 1e-9 * size);
        }
    }
}

#[test]
fn numbers_come_back() {
    for (_, pair, _) in edges(true).chain(edges(false)) {
        assert_eq!(Bow::from_numbers(pair.bow.numbers()), Some(pair.bow));
    }
    assert_eq!(Bow::from_numbers(Bow::default().numbers()), Some(Bow::default()));
    assert_eq!(Bow::from_numbers([f64::NAN; Bow::NUMBERS]), None);
}
