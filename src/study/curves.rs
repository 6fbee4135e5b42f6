//! How much of an answer is the polygon, and how much the curve that it stands for.

use super::Certified;
use crate::problem::Note;
use crate::report::HistoryRow;
use crate::report::number::{percent, significant};
use crate::scene::{Gap, Touching};

/// Part of the largest pressure from which an edge counts as closed.
const CLOSED: f64 = 1e-6;

/// Remarks on what edges and gaps on a finer mesh would change: how far interpolated gaps are from their curve where they
/// close, and what the last step of an adaptive run made of the answer.
pub fn remarks(certified: &Certified, history: &[HistoryRow]) -> Vec<Note> {
    let mut texts = interpolated(certified);
    texts.extend(last_step(certified, history));
    texts.into_iter().map(|text| Note { weakens_guarantee: false, text }).collect()
}

/// The distance of a gap that is linear between vertices from its curve, l²/8R, relative to the largest gap that closes.
fn interpolated(certified: &Certified) -> Vec<String> {
    let Certified { problem, dual, .. } = certified;
    let interfaces = problem.interfaces.iter().zip(&problem.scene.contacts).zip(&dual.contact_traction);
    let texts = interfaces.filter_map(|((interface, contact), tractions)| {
        let (Gap::Circle(Touching { radius, .. }) | Gap::Parabola(Touching { radius, .. })) = contact.gap else {
            return None;
        };
        let largest = tractions.values().iter().fold(0.0_f64, |m, t| m.max(-t));
        let closed = || {
            let pressed = |t: &[f64]| t.iter().any(|t| -t > CLOSED * largest);
            interface.pairs.iter().zip(tractions.iter()).filter(move |(_, t)| pressed(t)).map(|(pair, _)| pair)
        };
        let away = closed().map(|pair| pair.length * pair.length / (8.0 * radius)).fold(0.0, f64::max);
        let closing = closed().flat_map(|pair| pair.gap).fold(0.0, f64::max);
        (closing > 0.0).then(|| {
            format!(
                "contact {}: where it is closed, the gap is up to {away:.1e} away from its curve, {} of the largest gap that \
                 closes",
                interface.name,
                percent(away / closing)
            )
        })
    });
    texts.collect()
}

/// By how much the middle of the bracket moved from the mesh before the last to the last one.
fn last_step(certified: &Certified, history: &[HistoryRow]) -> Option<String> {
    let problem = &certified.problem;
    let curves = problem.scene.contacts.iter().any(|c| matches!(c.gap, Gap::Circle(_) | Gap::Parabola(_)));
    let [.., before, last] = history else { return None };
    if !(problem.contact_turns() || curves) {
        return None;
    }
    let middle = |row: &HistoryRow| 0.5 * (row.lower + row.upper);
    let change = (middle(last) - middle(before)).abs();
    (change.is_finite() && middle(last) != 0.0).then(|| {
        format!(
            "curved contact: from {} to {} triangles the middle of the bracket moved by {}, {} of itself: smaller elements \
             and edges closer to the curve together. The bounds are for the edges of the last mesh",
            before.triangles,
            last.triangles,
            significant(change, 2),
            percent(change / middle(last).abs())
        )
    })
}
