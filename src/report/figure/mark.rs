//! Marks where something is wrong, the same in every picture.

use super::svg::{Anchor, Svg, escape, look, px};
use crate::compare::name::Name;
use crate::problem::Problem;
use crate::report::{Check, Report};
use crate::scene::Target;

/// A place with the number of its cause.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// In the coordinates of the problem.
    pub at: [f64; 2],
    /// Counted from one.
    pub number: usize,
    /// A triangle that has it.
    pub triangle: Option<usize>,
}

/// The places of all causes that have one.
pub fn marks(problem: &Problem, report: &Report) -> Vec<Mark> {
    let places = report.causes.iter().enumerate().filter_map(|(i, cause)| Some((i + 1, cause.place.as_ref()?)));
    let own = |at: [f64; 2]| [0, 1].map(|c| at[c] - problem.scene.origin[c]);
    places.map(|(number, place)| Mark { at: own(place.at), number, triangle: place.triangle }).collect()
}

/// Draws a ring with its number around each, at the place on the page that `at` gives.
pub(super) fn draw(svg: &mut Svg, marks: &[Mark], at: impl Fn(&Mark) -> [f64; 2]) {
    for mark in marks {
        let [x, y] = at(mark);
        svg.raw(format_args!(r#"<g class="place" data-cause="{}">"#, mark.number));
        svg.circle(RING, [x, y], 9.0);
        svg.text(
            &format!("{} {}", look::BAD, look::HALO),
            [x + 11.0, y - 8.0],
            Anchor::Start,
            &mark.number.to_string(),
        );
        svg.raw(format_args!("</g>"));
    }
}

/// A point at which a value is wanted.
#[derive(Debug, Clone, PartialEq)]
pub struct Spot {
    /// In the coordinates of the problem.
    pub at: [f64; 2],
    /// Names of the quantities there.
    pub names: Vec<String>,
    /// True if a check of one of them failed.
    pub off: bool,
}

/// The points of the quantities of the scene, each once.
pub fn spots(problem: &Problem, report: &Report) -> Vec<Spot> {
    let mut spots: Vec<Spot> = Vec::new();
    for quantity in &problem.scene.quantities {
        let Target::Point { at, .. } = quantity.target else { continue };
        let own = |check: &Check| matches!(Name::read(&check.name), Name::Quantity(name, _) if name == quantity.name);
        let off = report.checks.iter().any(|check| !check.passed && own(check));
        match spots.iter_mut().find(|spot| spot.at == at) {
            Some(spot) => {
                spot.names.push(quantity.name.clone());
                spot.off |= off;
            }
            None => spots.push(Spot { at, names: vec![quantity.name.clone()], off }),
        }
    }
    spots
}

/// Draws a small cross in a disc at each, red where something is wrong, with the names on hovering.
pub(super) fn draw_spots(svg: &mut Svg, spots: &[Spot], at: impl Fn([f64; 2]) -> [f64; 2]) {
    for spot in spots {
        let [x, y] = at(spot.at);
        svg.raw(format_args!(r#"<g class="spot"><title>{}</title>"#, escape(&spot.names.join(", "))));
        svg.circle(r##"fill="#f6f8fa" stroke="#1f2328""##, [x, y], 4.5);
        let cross = format!("M{} {}h6M{} {}v6", px(x - 3.0), px(y), px(x), px(y - 3.0));
        svg.path(if spot.off { OFF } else { look::LINE }, r#"stroke-width="1.6""#, &cross);
        svg.raw(format_args!("</g>"));
    }
}

/// A cross where something is wrong.
const OFF: &str = r##"fill="none" stroke="#cf222e""##;

/// A ring that is seen on any ground.
const RING: &str = r##"class="ring" fill="none" stroke="#cf222e" stroke-width="3""##;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict};
    use crate::scene::{Draft, Scene};

    #[test]
    fn causes_with_a_place_are_marked_where_the_bodies_are_drawn() {
        let mut sample = Sample::new(2, Verdict::Disagree);
        sample.problem.scene = Scene::unchecked(Draft { origin: [100.0, 0.0], ..(*sample.problem.scene).clone() });
        let report = sample.dossier().report;
        assert_eq!(marks(&sample.problem, &report), [Mark { at: [-99.0, 0.0], number: 1, triangle: Some(0) }]);
    }
}
