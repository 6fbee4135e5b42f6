//! Forecast of the terms of the gap on a finer mesh, learnt from their decrease so far.
//!
//! Rounds of marking between two solves go by predictions. Where the solution is smooth a term falls with the third power
//! of its triangle's area. At a point singularity it does not: the gap of the triangles around the point falls like a
//! small power γ of their area, as small as a few hundredths where bodies of unlike stiffness meet at the end of a
//! support, and nearly all of it stays with the piece at the point. A vertex keeps its place on every finer mesh, so γ is
//! measured vertex by vertex, and rounds then go where the gap stays.

use super::indicators::Indicators;
use crate::element::Elements;
use crate::mesh::Triangulation;

/// A term of the gap falls like this power of the triangle's area where the solution is smooth: with stresses linear on
/// a triangle of size h, ½∫ a(λ − τ):(λ − τ) is of order h⁴ · h².
const DECAY: f64 = 3.0;

/// Least power of the area by which the gap at a vertex is taken to fall.
const LEAST: f64 = 0.02;

/// Below this power the gap does not fall by refining everything: the vertex is a singular point.
const SINGULAR: f64 = 0.75;

/// A triangle counts as not refined if at least this part of its area is left.
const WHOLE: f64 = 0.9;

/// How the gap falls.
#[derive(Debug, Clone)]
pub struct Forecast {
    /// The power of a triangle's area by which its term falls away from singular points.
    smooth: f64,
    /// The triangles around each vertex of the last mesh: their terms, and their area.
    fans: Vec<[f64; 2]>,
    /// The power of the area by which the gap around a vertex falls, where that was seen.
    decay: Vec<Option<f64>>,
}

impl Default for Forecast {
    fn default() -> Self {
        Forecast { smooth: DECAY, fans: Vec::new(), decay: Vec::new() }
    }
}

impl Forecast {
    /// Learns from the terms on a mesh that was solved; meshes are nested, and vertices keep their numbers.
    pub fn learn(&mut self, mesh: &Triangulation, terms: &Indicators) {
        let mut fans = vec![[0.0; 2]; mesh.points.len()];
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for &v in corners {
                fans[v][0] += terms.of(t);
                fans[v][1] += mesh.area(t);
            }
        }
        self.decay.resize(mesh.points.len(), None);
        let (mut weighted, mut weight) = (0.0, 0.0);
        for ((decay, [old, before]), [new, now]) in self.decay.iter_mut().zip(&self.fans).zip(&fans) {
            let power = (old / new).ln() / (before / now).ln();
            if now / before < WHOLE && power.is_finite() {
                *decay = Some(power.max(LEAST));
                if power >= SINGULAR {
                    weighted += old * power.min(DECAY);
                    weight += old;
                }
            }
        }
        if weight > 0.0 {
            self.smooth = weighted / weight;
        }
        self.fans = fans;
    }

    /// The terms on `fine`, each from those of the triangle of `coarse` that it lies in, its parent; `elements` are those of
    /// `coarse`.
    pub fn foresee(
        &self,
        terms: &Indicators,
        (coarse, elements): (&Triangulation, &Elements),
        fine: &Triangulation,
        parent: &[usize],
    ) -> Indicators {
        let term = |(t, &p): (usize, &usize)| {
            let part = fine.area(t) / coarse.area(p);
            if part > WHOLE {
                return terms.of(p);
            }
            terms.of(p)
                * match self.singular(coarse.triangles[p]) {
                    Some((v, power)) if fine.triangles[t].contains(&v) => part.powf(power),
                    Some((_, power)) => (1.0 - 0.5_f64.powf(power)) * (2.0 * part).min(1.0),
                    // Each degree more is worth a power of the area.
                    None => part.powf(self.smooth + (elements.degree(p) - 1) as f64),
                }
        };
        parent.iter().enumerate().map(term).collect()
    }

    /// The singular point among the corners of a triangle, and the power by which the gap around it falls; the least one
    /// where there are several.
    pub fn singular(&self, corners: [usize; 3]) -> Option<(usize, f64)> {
        let known = corners.into_iter().filter_map(|v| Some((v, (*self.decay.get(v)?)?)));
        known.filter(|(_, power)| *power < SINGULAR).min_by(|(_, a), (_, b)| a.total_cmp(b))
    }
}
