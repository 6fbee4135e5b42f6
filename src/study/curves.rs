//! How much of an answer is the polygon, and how much the curve that it stands for.

use super::Certified;
use crate::problem::{ContactPair, Note, Problem, Refinement};
use crate::report::HistoryRow;
use crate::report::text::number::{percent, significant};
use crate::statics::Statics;

/// A remark on what the edges of a finer mesh would change: what the last step of an adaptive run made of the answer.
pub fn remarks(certified: &Certified, history: &[HistoryRow]) -> Vec<Note> {
    let texts = last_step(certified, history);
    texts.into_iter().map(|text| Note { weakens_guarantee: false, text }).collect()
}

/// Divides edges of one circle together in all refinement to come where a body slides freely along a curved contact: vertices that
/// move to the curve here and there would shift the centre of its weight, and nothing holds it against the moment.
pub fn divide_evenly_what_slides(problem: &mut Problem, statics: &Statics) {
    if problem.refinement != Refinement::FollowsCurves || statics.held.is_empty() || !problem.follows_curves() {
        return;
    }
    let motions = statics.held_at_vertices(problem);
    let slides = |pair: &ContactPair| {
        let vertices = || pair.first.iter().chain(pair.second.iter().flatten());
        !pair.direction.is_constant() && motions.iter().any(|motion| vertices().any(|&v| motion[v] != [0.0; 2]))
    };
    let Some(curve) = problem.interfaces.iter().find(|interface| interface.pairs.iter().any(slides)) else { return };
    let text = format!(
        "contact {}: a body slides freely along it. Refinement divides all edges of a circle together, since vertices moved \
         to it here and there would shift the centre of the body's weight, and nothing would hold it",
        curve.name
    );
    problem.refinement = Refinement::FollowsCurvesEvenly;
    problem.notes.push(Note { weakens_guarantee: false, text });
}

/// By how much the middle of the bracket moved from the mesh before the last to the last one.
fn last_step(certified: &Certified, history: &[HistoryRow]) -> Option<String> {
    let problem = &certified.problem;
    let [.., before, last] = history else { return None };
    let follows = problem.contact_turns() && problem.refinement != Refinement::KeepsEdges;
    if !follows {
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
