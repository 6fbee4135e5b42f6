//! Friction along an interface: where the sides stick, slide and part, and the traction along them beside its bound.

use super::axis::Axis;
use super::pressure::{LEFT, RIGHT, WIDTH, along, extent, path_of, stroke};
use super::svg::{Anchor, Svg, look};
use crate::compare::{FrictionState, FrictionSummary};
use crate::report::ContactSummary;

/// Height of the strip of states.
const STRIP: f64 = 16.0;
/// Height of the panel with the traction.
const PANEL: f64 = 190.0;

/// All states, in the order of their legend.
pub const STATES: [FrictionState; 4] =
    [FrictionState::Stick, FrictionState::Slip, FrictionState::Free, FrictionState::Open];

/// The word for a state.
pub fn word(state: FrictionState) -> &'static str {
    match state {
        FrictionState::Stick => "stick",
        FrictionState::Slip => "slip",
        FrictionState::Free => "without friction",
        FrictionState::Open => "open",
    }
}

fn fill(state: FrictionState) -> &'static str {
    match state {
        FrictionState::Stick => r##"class="stick" fill="#0072b2""##,
        FrictionState::Slip => r##"class="slip" fill="#e69f00""##,
        FrictionState::Free => r##"class="unbound" fill="#8996a3" fill-opacity="0.45""##,
        FrictionState::Open => r##"class="open" fill="none" stroke="#8996a3""##,
    }
}

/// A strip of states over the tangential traction of the dual solution between plus and minus its bound, with the arc lengths of
/// [`super::pressure::pressure`] and its `marks`; nothing where a contact has no friction.
pub fn friction(contact: &ContactSummary, marks: &[(f64, usize)]) -> Option<String> {
    let friction = contact.friction.as_ref()?;
    let x = along(extent(contact), marks);
    let (top, bottom) = (74.0, 74.0 + PANEL);
    let label = format!("States and tangential traction along the contact {}", contact.name);
    let mut svg = Svg::new(WIDTH, bottom + 46.0, label);
    strip(&mut svg, friction, &x);
    let shown = |s: f64| (x.from..=x.to).contains(&s);
    let within = |points: &[[f64; 2]]| points.iter().copied().filter(|p| shown(p[0])).collect::<Vec<_>>();
    let (traction, bound) = (within(&friction.traction), within(&friction.bound));
    let values = traction.iter().map(|p| p[1]).chain(bound.iter().flat_map(|p| [p[1], -p[1]])).chain([0.0]);
    let y = Axis::over(values, bottom, top, false).padded(0.05);
    x.draw_below(&mut svg, bottom, top, "arc length along the contact");
    y.draw_left(
        &mut svg,
        LEFT,
        RIGHT,
        "tangential traction on the first side (dual), dashed: plus and minus its bound",
    );
    svg.line(look::LINE, r#"stroke-width="0.8""#, [LEFT, y.at(0.0)], [RIGHT, y.at(0.0)]);
    let on_page = |points: &[[f64; 2]], sign: f64| -> Vec<Option<[f64; 2]>> {
        points.iter().map(|p| p[1].is_finite().then(|| [x.at(p[0]), y.at(sign * p[1])])).collect()
    };
    for sign in [1.0, -1.0] {
        let look = format!("{} {}", look::SUPPORT, r#"stroke-dasharray="6 4""#);
        svg.path(&look, "", &path_of(&on_page(&bound, sign)));
    }
    svg.path(&stroke(0), "", &path_of(&on_page(&traction, 1.0)));
    Some(svg.finish())
}

/// The strip, with the words that its colours stand for above it.
fn strip(svg: &mut Svg, friction: &FrictionSummary, x: &Axis) {
    let there = STATES.into_iter().filter(|state| friction.zones.iter().any(|zone| zone.state == *state));
    let mut at = LEFT;
    for state in there {
        svg.rect(fill(state), at, 6.0, 12.0, 12.0);
        svg.text(look::INK, [at + 17.0, 16.5], Anchor::Start, word(state));
        at += 34.0 + 7.5 * word(state).len() as f64;
    }
    for zone in &friction.zones {
        let [from, to] = [zone.from, zone.to].map(|s| x.at(s.clamp(x.from, x.to)));
        if to > from {
            svg.rect(fill(zone.state), from, 26.0, to - from, STRIP);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::FrictionZone;
    use crate::report::figure::svg::px;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn states_and_bounds_are_drawn_where_they_are() {
        let mut contact = Sample::new(4, Verdict::Agree).dossier().report.contact.remove(0);
        assert!(friction(&contact, &[]).is_none());
        let zone = |from, to, state| FrictionZone { from, to, state };
        contact.friction = Some(FrictionSummary {
            kind: "bound".into(),
            coefficient: None,
            bound_distance: None,
            iterations: 1,
            stick_fraction: 0.25,
            slip_fraction: 0.25,
            force: 0.1,
            zones: vec![
                zone(0.0, 0.25, FrictionState::Stick),
                zone(0.25, 0.5, FrictionState::Slip),
                zone(0.5, 1.0, FrictionState::Open),
            ],
            traction: vec![[0.0, 0.0], [0.25, 0.3], [0.5, 0.3], [0.5, 0.0], [1.0, f64::NAN]],
            bound: vec![[0.0, 0.3], [1.0, 0.3]],
        });
        let text = friction(&contact, &[]).expect("a figure");
        assert_well_formed(&text);
        let [from, to] = extent(&contact);
        let at = |s: f64| px(LEFT + (RIGHT - LEFT) * (s - from) / (to - from)).to_string();
        assert!(text.contains(&format!("class=\"slip\" fill=\"#e69f00\" x=\"{}\" y=\"26\"", at(0.25))), "{text}");
        assert_eq!(text.matches("stroke-dasharray=\"6 4\"").count(), 2);
        for word in ["stick", "slip", "open"] {
            assert!(text.contains(&format!(">{word}<")), "{word}");
        }
    }
}
