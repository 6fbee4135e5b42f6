//! The scene: bodies, supports, loads, contacts.

use std::collections::BTreeMap;

use super::mark::{Mark, draw};
use super::outline::{self, View, chains, edge_chains, polyline, stations};
use super::svg::{Anchor, Svg, look};
use super::symbols;
use crate::mesh::touching;
use crate::problem::{Condition, Interface, Problem};
use crate::report::text::number::significant;

const WIDTH: f64 = 560.0;
const MARGIN: f64 = 58.0;
/// Page length of the largest traction.
const LONGEST_ARROW: f64 = 44.0;

/// The bodies in their undeformed state with everything that holds, loads or meets them.
pub fn scene(problem: &Problem, marks: &[Mark]) -> String {
    let mesh = &problem.mesh;
    let (view, height) = view(problem);
    let mut svg =
        Svg::new(WIDTH, height, format!("The scene {} with its supports, loads and contacts", problem.scene.title));
    other_half(&mut svg, problem, &view, height);
    for body in 0..problem.scene.bodies.len() {
        let look = look::BODIES[body % look::BODIES.len()];
        let d = outline::outline(mesh, body, &view);
        svg.path(look, r##"fill-rule="evenodd" stroke="#57606a" stroke-width="1""##, &d);
    }
    supports(&mut svg, problem, &view);
    contacts(&mut svg, problem, &view);
    springs(&mut svg, problem, &view);
    for line in touching(mesh, &problem.scene) {
        for line in page_chains(problem, &view, &line.edges) {
            svg.path(look::LOAD, r#"stroke-width="3" stroke-dasharray="2 4""#, &polyline(&line));
        }
    }
    tractions(&mut svg, problem, &view);
    labels(&mut svg, problem, &view);
    draw(&mut svg, marks, |mark| view.at(mark.at));
    svg.finish()
}

/// The first coordinate of the axis of a body of revolution that lies near enough to be drawn.
fn axis(problem: &Problem) -> Option<f64> {
    let axis = problem.section().axis()?;
    let radii = problem.mesh.points.iter().map(|p| p[0] - axis);
    let (least, most) = radii.fold((f64::INFINITY, 0.0_f64), |(least, most), r| (least.min(r), most.max(r)));
    (least <= most - least).then_some(axis)
}

/// All of the scene, with the other half of a body of revolution.
fn view(problem: &Problem) -> (View, f64) {
    let points = problem.mesh.points.iter().copied();
    match axis(problem) {
        Some(axis) => {
            let mirrored = points.clone().map(|[x, y]| [2.0 * axis - x, y]);
            View::fit(points.chain(mirrored), WIDTH, 460.0, MARGIN)
        }
        None => View::fit(points, WIDTH, 460.0, MARGIN),
    }
}

/// The axis of a body of revolution, and a pale image of the section beyond it.
fn other_half(svg: &mut Svg, problem: &Problem, view: &View, height: f64) {
    let Some(axis) = axis(problem) else { return };
    let [x, _] = view.at([axis, 0.0]);
    svg.raw(format_args!(r#"<g transform="translate({} 0) scale(-1 1)" opacity="0.3">"#, 2.0 * x));
    for body in 0..problem.scene.bodies.len() {
        let look = look::BODIES[body % look::BODIES.len()];
        svg.path(look, r#"fill-rule="evenodd""#, &outline::outline(&problem.mesh, body, view));
    }
    svg.raw(format_args!("</g>"));
    svg.line(look::LINE, r#"stroke-dasharray="12 3 2 3""#, [x, 0.3 * MARGIN], [x, height - 0.3 * MARGIN]);
}

/// The factor by which the picture exaggerates the gap of the contacts, or `None` where every gap is zero.
pub fn gap_exaggeration(problem: &Problem) -> Option<f64> {
    let (view, _) = view(problem);
    let largest = problem.pairs().flat_map(|p| p.gap).fold(0.0, f64::max);
    let page = largest * view.scale;
    if !(page.is_finite() && page > 0.0) {
        None
    } else if page >= 6.0 {
        Some(1.0)
    } else {
        let raw = 14.0 / page;
        let power = 10f64.powf(raw.log10().floor());
        Some(power * [1.0, 2.0, 5.0].into_iter().rev().find(|m| m * power <= raw).unwrap_or(1.0))
    }
}

fn page_chains(problem: &Problem, view: &View, edges: &[usize]) -> Vec<Vec<[f64; 2]>> {
    chains(&problem.mesh, edges).into_iter().map(|c| c.into_iter().map(|p| view.at(p)).collect()).collect()
}

fn edges_where(problem: &Problem, holds: impl Fn(&Condition) -> bool) -> Vec<usize> {
    (0..problem.conditions.len().min(problem.mesh.edges.len())).filter(|&e| holds(&problem.conditions[e])).collect()
}

fn supports(svg: &mut Svg, problem: &Problem, view: &View) {
    for line in page_chains(problem, view, &edges_where(problem, |c| matches!(c, Condition::Clamped(_)))) {
        symbols::clamped(svg, &line);
    }
    for line in page_chains(problem, view, &edges_where(problem, |c| matches!(c, Condition::Roller { .. }))) {
        symbols::roller(svg, &line);
    }
    let moved = edges_where(problem, Condition::is_moved);
    for line in page_chains(problem, view, &moved) {
        // Where one support meets another with a different value, the first edge of the chain speaks for it.
        let value = moved.iter().find_map(|&e| match problem.conditions[e] {
            condition if view.at(problem.mesh.points[problem.mesh.edges[e].vertices[0]]) == line[0] => {
                condition.prescribed().map(|ends| [0, 1].map(|c| 0.5 * (ends[0][c] + ends[1][c])))
            }
            _ => None,
        });
        if let (Some(u), Some(station)) = (value.filter(|u| *u != [0.0; 2]), stations(&line, 1e9).first()) {
            let d = u[0].hypot(u[1]);
            symbols::arrow(svg, look::LOAD, station.0, [30.0 * u[0] / d, -30.0 * u[1] / d], true);
        }
    }
}

fn springs(svg: &mut Svg, problem: &Problem, view: &View) {
    for bed in &problem.beds {
        let first: Vec<usize> = bed.pairs.iter().map(|pair| pair.edge).collect();
        for line in page_chains(problem, view, &first) {
            match bed.is_layer() {
                true => svg.path(look::CONTACT, r#"stroke-width="3" stroke-dasharray="6 2""#, &polyline(&line)),
                false => symbols::springs(svg, &line),
            }
        }
    }
}

fn contacts(svg: &mut Svg, problem: &Problem, view: &View) {
    let factor = gap_exaggeration(problem);
    for interface in &problem.interfaces {
        let first: Vec<usize> = interface.pairs.iter().filter_map(|pair| pair.edges[0]).collect();
        for line in page_chains(problem, view, &first) {
            svg.path(look::CONTACT, r#"stroke-width="3""#, &polyline(&line));
        }
        let shift = factor.unwrap_or(0.0);
        let rigid = interface.pairs.iter().any(|pair| pair.second.is_none());
        if factor.is_some() || rigid {
            for line in obstacle(problem, interface, view, shift) {
                svg.path(look::CONTACT, r#"stroke-width="1.5" stroke-dasharray="5 3""#, &polyline(&line));
                if rigid {
                    symbols::hatch(svg, &line, 1.0);
                }
            }
        }
    }
}

/// The other side of the gap, at `factor` times its distance, oriented like the first side (body on the left).
fn obstacle(problem: &Problem, interface: &Interface, view: &View, factor: f64) -> Vec<Vec<[f64; 2]>> {
    let mut lines: Vec<Vec<[f64; 2]>> = Vec::new();
    for pair in &interface.pairs {
        let mut ends = [0, 1].map(|k| {
            let p = problem.mesh.points[pair.first[k]];
            view.at([0, 1].map(|c| p[c] + factor * pair.gap[k] * pair.direction.unit(k)[c]))
        });
        // n' is outward: turn the pair round where walking along it would have the body on the right.
        let tangent = [0, 1].map(|c| problem.mesh.points[pair.first[1]][c] - problem.mesh.points[pair.first[0]][c]);
        let forward = tangent[1] * pair.normal[0] - tangent[0] * pair.normal[1] > 0.0;
        if !forward {
            ends.reverse();
        }
        let near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) < 0.01;
        match lines.last_mut() {
            Some(line) if forward && near(line[line.len() - 1], ends[0]) => line.push(ends[1]),
            Some(line) if !forward && near(line[0], ends[1]) => line.insert(0, ends[0]),
            _ => lines.push(ends.to_vec()),
        }
    }
    lines
}

fn tractions(svg: &mut Svg, problem: &Problem, view: &View) {
    let mesh = &problem.mesh;
    let loaded = edges_where(problem, |c| matches!(c, Condition::Traction(p) if p.iter().flatten().any(|x| *x != 0.0)));
    let values: BTreeMap<usize, [[f64; 2]; 2]> = loaded
        .iter()
        .filter_map(|&e| match problem.conditions[e] {
            Condition::Traction(p) => Some((e, p)),
            _ => None,
        })
        .collect();
    let largest = values.values().flatten().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
    if !(largest.is_finite() && largest > 0.0) {
        return;
    }
    let factor = LONGEST_ARROW / largest;
    let mut tails = String::new();
    for chain in edge_chains(mesh, &loaded) {
        // About one arrow per 16 page units, wherever they fall on the edges.
        let mut next = 8.0;
        for e in chain {
            let Some(p) = values.get(&e) else { continue };
            let ends = mesh.edges[e].vertices.map(|v| view.at(mesh.points[v]));
            let (_, normal) = mesh.edge_frame(e);
            let mix = |w: f64, x: [[f64; 2]; 2]| [0, 1].map(|c| (1.0 - w) * x[0][c] + w * x[1][c]);
            // The arrow at fraction w of the edge, and whether it pushes.
            let arrow = |w: f64| {
                let f = mix(w, *p);
                (mix(w, ends), [factor * f[0], -factor * f[1]], f[0] * normal[0] + f[1] * normal[1] < 0.0)
            };
            // Arrows stand outside the body, so the line along their tails bends where the normal part changes its sign.
            let tail = |w: f64| {
                let (at, v, pushes) = arrow(w);
                if pushes { [at[0] - v[0], at[1] - v[1]] } else { [at[0] + v[0], at[1] + v[1]] }
            };
            let bends = arrow(0.0).2 != arrow(1.0).2;
            let steps = if bends { 8 } else { 1 };
            tails.push_str(&polyline(&(0..=steps).map(|k| tail(f64::from(k) / f64::from(steps))).collect::<Vec<_>>()));
            let length = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]);
            while next <= length {
                let (at, v, pushes) = arrow(next / length);
                symbols::arrow(svg, look::LOAD, at, v, !pushes);
                next += 16.0;
            }
            next -= length;
        }
    }
    svg.path(look::LOAD, r#"fill-opacity="0" stroke-width="1" stroke-opacity="0.6""#, &tails);
    let text = format!("largest traction {}", significant(largest, 4));
    svg.text(look::DIM, [WIDTH - 6.0, svg.height - 8.0], Anchor::End, &text);
}

fn labels(svg: &mut Svg, problem: &Problem, view: &View) {
    let mesh = &problem.mesh;
    for (b, body) in problem.scene.bodies.iter().enumerate() {
        let (mut area, mut sum) = (0.0, [0.0; 2]);
        for t in (0..mesh.triangles.len()).filter(|&t| mesh.body[t] == b) {
            let [p, q, r] = mesh.corners(t);
            let a = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            area += a;
            sum = [0, 1].map(|c| sum[c] + a * (p[c] + q[c] + r[c]) / 3.0);
        }
        if area <= 0.0 {
            continue;
        }
        let at = view.at(sum.map(|s| s / area));
        svg.text(&format!(r#"{} font-weight="600""#, look::INK), at, Anchor::Middle, &body.name);
        let force = body.body_force.at(sum.map(|s| s / area));
        if force[0].hypot(force[1]) > 0.0 {
            let d = force[0].hypot(force[1]);
            symbols::arrow(svg, look::LOAD, [at[0], at[1] + 10.0], [28.0 * force[0] / d, -28.0 * force[1] / d], true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample::{Sample, Verdict, assert_well_formed};

    #[test]
    fn every_condition_has_its_symbol() {
        let problem = Sample::new(4, Verdict::Agree).problem;
        let text = scene(&problem, &[]);
        assert_well_formed(&text);
        for class in ["b0", "b1", "support", "contact", "load"] {
            assert!(text.contains(&format!("class=\"{class}\"")), "{class}");
        }
        assert!(text.contains("left &lt;a&amp;b&gt;") && text.contains("largest traction 4"));
        // The roller's circles lie below the block, the clamp's hatching right of it.
        assert!(text.contains("<circle"));
    }

    #[test]
    fn a_gap_is_drawn_as_a_second_line() {
        let mut problem = Sample::new(4, Verdict::Agree).problem;
        assert_eq!(gap_exaggeration(&problem), None);
        let without = scene(&problem, &[]).matches("stroke-dasharray").count();
        for pair in &mut problem.interfaces[0].pairs {
            pair.gap = [1e-3, 1e-3];
        }
        let factor = gap_exaggeration(&problem).unwrap();
        assert!(factor > 10.0 && factor < 1000.0, "{factor}");
        assert_eq!(scene(&problem, &[]).matches("stroke-dasharray").count(), without + 1);
        for pair in &mut problem.interfaces[0].pairs {
            pair.gap = [0.5, 0.5];
        }
        assert_eq!(gap_exaggeration(&problem), Some(1.0));
    }
}
