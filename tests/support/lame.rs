//! Lamé's formulas for a ring in another one, in plane strain.
#![allow(dead_code)]

use std::f64::consts::PI;

/// A ring of radii a…b in one of radii b…c.
pub struct Rings {
    /// a, b, c.
    pub radii: [f64; 3],
    /// Young's moduli of the inner and the outer one.
    pub young: [f64; 2],
    /// Poisson's ratio of both.
    pub poisson: f64,
    /// Pressure at a.
    pub inside: f64,
    /// By how much the inner ring is larger than the bore of the outer one: the interference.
    pub depth: f64,
}

impl Rings {
    /// Radial displacement at `r` of the ring `radii` under the pressures `p` inside and `q` outside:
    /// u = (1 + ν)/E · [(1 − 2ν) A r + B/r] with σ_r = A − B/r², A = (p a² − q b²)/(b² − a²), B = a² b² (p − q)/(b² − a²).
    fn moved(&self, r: f64, [p, q]: [f64; 2], [a, b]: [f64; 2], young: f64) -> f64 {
        let (aa, bb) = (a * a, b * b);
        let (even, inverse) = ((p * aa - q * bb) / (bb - aa), aa * bb * (p - q) / (bb - aa));
        (1.0 + self.poisson) / young * ((1.0 - 2.0 * self.poisson) * even * r + inverse / r)
    }

    /// The pressure at b: there the outer ring moves by `depth` more than the inner one.
    pub fn pressure(&self) -> f64 {
        let [a, b, c] = self.radii;
        let [inner, outer] = self.young;
        let loaded = self.moved(b, [self.inside, 0.0], [a, b], inner);
        let back = self.moved(b, [0.0, 1.0], [a, b], inner);
        let opened = self.moved(b, [1.0, 0.0], [b, c], outer);
        (self.depth + loaded) / (opened - back)
    }

    /// Radial displacement at `r` in ring 0 or 1.
    pub fn displacement(&self, ring: usize, r: f64) -> f64 {
        let [a, b, c] = self.radii;
        let p = self.pressure();
        match ring {
            0 => self.moved(r, [self.inside, p], [a, b], self.young[0]),
            _ => self.moved(r, [p, 0.0], [b, c], self.young[1]),
        }
    }

    /// 𝓛(u) of a quarter: strain energy ½ (p_i u(a) a + p δ b) π/2 less the work p_i u(a) a π/2 of the pressure inside.
    pub fn energy(&self) -> f64 {
        let [a, b, _] = self.radii;
        0.25 * PI * (self.pressure() * self.depth * b - self.inside * self.displacement(0, a) * a)
    }
}

#[test]
fn radial_displacements_differ_by_the_interference_where_the_rings_meet() {
    let rings = Rings { radii: [1.0, 1.5, 2.0], young: [2.0, 1.0], poisson: 0.3, inside: 0.7, depth: 0.01 };
    let [inner, outer] = [0, 1].map(|ring| rings.displacement(ring, 1.5));
    assert!((outer - inner - 0.01).abs() < 1e-14, "{inner} {outer}");
    // A thin ring: p_i r²/(E* t).
    let thin = Rings { radii: [1.0, 1.001, 1.002], young: [1.0, 1.0], poisson: 0.3, inside: 1.0, depth: 0.0 };
    let hoop = (1.0 - 0.09) / 0.002;
    assert!((thin.displacement(0, 1.0) / hoop - 1.0).abs() < 3e-3, "{} {hoop}", thin.displacement(0, 1.0));
}
