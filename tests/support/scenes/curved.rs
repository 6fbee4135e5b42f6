//! Bodies that meet along curves: blocks along an arc, rings, a cap in its seat, a round body on a straight one.

use std::f64::consts::PI;

use super::Made;
use super::frame::Frame;
use crate::support::random::Random;
use crate::support::toml::Toml;

/// A scene of one of these kinds.
pub fn curved(random: &mut Random) -> Made {
    let frame = Frame::random(random);
    let drawing = Drawing { length: frame.length, turn: frame.turn };
    let (toml, rounds) = match random.below(5) {
        0 => blocks_along_an_arc(random, &frame, &drawing),
        1 => blocks_along_facets(random, &frame, &drawing),
        2 => (rings(random, &frame, &drawing), true),
        3 => (cap(random, &frame, &drawing), true),
        _ => (round_on_straight(random, &frame, &drawing), false),
    };
    let plain = random.chance(0.6);
    let toml = if plain { toml } else { toml.model("plane-stress", random.between(0.1, 3.0)) };
    // Interferences are prescribed displacements.
    let most = 0.02 * frame.length;
    Made { toml, mesh: None, energy: frame.young * 4.0 * most * most, rounds }
}

/// Places in the units and the direction of a scene.
struct Drawing {
    length: f64,
    turn: [f64; 2],
}

impl Drawing {
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.turn;
        [c * x - s * y, s * x + c * y].map(|x| x * self.length)
    }

    fn along(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.turn;
        [c * x - s * y, s * x + c * y]
    }

    fn all(&self, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
        points.iter().map(|p| self.at(*p)).collect()
    }
}

fn materials(toml: Toml, random: &mut Random, frame: &Frame, bodies: [&str; 2]) -> Toml {
    bodies.into_iter().fold(toml, |toml, body| {
        let poisson = if random.chance(0.2) { 0.4999 } else { random.between(0.0, 0.45) };
        toml.material(body, frame.young * random.magnitude(-1.0, 1.0), poisson)
    })
}

fn normals(random: &mut Random) -> &'static str {
    if random.chance(0.75) { "" } else { "\nnormals = \"facets\"" }
}

/// No gap, one that the loads may close, or an interference.
fn gap(random: &mut Random, frame: &Frame) -> String {
    let small = frame.length * frame.load.min(0.01) * random.between(0.1, 1.0);
    match random.below(6) {
        0 => format!("\ngap = {small:?}"),
        1 => format!("\ngap = {:?}", -small),
        _ => String::new(),
    }
}

/// A pressure that varies, along the direction down.
fn weight_on(toml: Toml, on: &str, random: &mut Random, frame: &Frame, drawing: &Drawing) -> Toml {
    let size = frame.traction(random);
    let down = drawing.along([random.between(-0.1, 0.1) * size, -size]);
    let steep = size / frame.length * random.between(-1.0, 1.0);
    let along = drawing.along([1.0, 0.0]);
    let gradient = [0, 1].map(|r| [0, 1].map(|c| steep * drawing.along([0.0, 1.0])[r] * along[c]));
    toml.table(&format!("[[tractions]]\non = \"{on}\"\nvalue = {down:?}\ngradient = {gradient:?}"))
}

/// Height of the ends of an arc over a chord of length one, its rise, and the top of the upper block.
struct Arc {
    height: f64,
    rise: f64,
    top: f64,
}

impl Arc {
    fn random(random: &mut Random) -> Self {
        let rise = random.between(0.01, 0.3) * if random.chance(0.5) { 1.0 } else { -1.0 };
        let height = random.between(0.6, 0.9);
        Arc { height, rise, top: height + rise.max(0.0) + random.between(0.3, 0.8) }
    }

    /// The point at t from −1 to 1.
    fn at(&self, t: f64) -> [f64; 2] {
        let rise = self.rise;
        let radius = (0.25 + rise * rise) / (2.0 * rise);
        let angle = t * (0.5 / radius).asin();
        [0.5 + radius * angle.sin(), self.height + radius * angle.cos() - (radius - rise)]
    }

    fn conditions(&self, toml: Toml, random: &mut Random, frame: &Frame, drawing: &Drawing) -> Toml {
        let toml = materials(toml, random, frame, ["low", "up"]).clamp("base");
        let guided = random.chance(0.7);
        let toml = weight_on(toml, "load", random, frame, drawing);
        let (gap, normals) = (gap(random, frame), normals(random));
        // Facets alone would hold a couple with forces at the ends of edges, which no linear pressure follows on coarse meshes.
        let toml = if guided || !normals.is_empty() { toml.roller("side") } else { toml };
        toml.table(&format!("[[contacts]]\nbetween = [\"lower\", \"upper\"]{gap}{normals}"))
    }
}

/// Two blocks that meet along an arc of `[geometry]`.
fn blocks_along_an_arc(random: &mut Random, frame: &Frame, drawing: &Drawing) -> (Toml, bool) {
    let arc = Arc::random(random);
    let through = drawing.at(arc.at(0.0));
    let (a, b) = ([0.0, arc.height], [1.0, arc.height]);
    let toml = Toml::default()
        .size(frame.length * random.between(0.1, 0.3))
        .outline("low", &drawing.all(&[[0.0, 0.0], [1.0, 0.0], b, a]), &["base", "", "lower", ""])
        .arcs(&[(2, through)])
        .outline("up", &drawing.all(&[a, b, [1.0, arc.top], [0.0, arc.top]]), &["upper", "", "load", "side"])
        .arcs(&[(0, through)]);
    (arc.conditions(toml, random, frame, drawing), true)
}

/// Two blocks that meet along facets: of the arc itself, or of one that is squeezed to the left, so that no four vertices lie on a circle
/// and refinement keeps the facets.
fn blocks_along_facets(random: &mut Random, frame: &Frame, drawing: &Drawing) -> (Toml, bool) {
    let arc = Arc::random(random);
    let facets = 3 + random.below(12);
    let squeezed = facets > 3 && random.chance(0.7);
    let place = |[x, y]: [f64; 2]| [if squeezed { x * (0.8 + 0.2 * x) } else { x }, y];
    let mut curve: Vec<[f64; 2]> = (0..=facets).map(|i| place(arc.at(2.0 * i as f64 / facets as f64 - 1.0))).collect();
    (curve[0], curve[facets]) = ([0.0, arc.height], [1.0, arc.height]);
    let mut lower = vec![[0.0, 0.0], [1.0, 0.0]];
    lower.extend(curve.iter().rev());
    let mut upper = curve;
    upper.extend([[1.0, arc.top], [0.0, arc.top]]);
    let below = [vec!["base", ""], vec!["lower"; facets], vec![""]].concat();
    let above = [vec!["upper"; facets], vec!["", "load", "side"]].concat();
    let toml = Toml::default()
        .size(frame.length * random.between(0.15, 0.4))
        .outline("low", &drawing.all(&lower), &below)
        .outline("up", &drawing.all(&upper), &above);
    (arc.conditions(toml, random, frame, drawing), !squeezed)
}

/// Part of a ring in another one, rollers on the cuts, a pressure inside or an interference.
fn rings(random: &mut Random, frame: &Frame, drawing: &Drawing) -> Toml {
    let radii = [1.0, 1.0 + random.between(0.2, 0.6), 0.0];
    let radii = [radii[0], radii[1], radii[1] + random.between(0.2, 0.6)];
    let angle = if random.chance(0.5) { 0.5 * PI } else { random.between(0.4, 2.5) };
    let at = |r: f64, a: f64| drawing.at([r * a.cos(), r * a.sin()]);
    let mut toml = Toml::default().size(frame.length * random.between(0.15, 0.4));
    for (body, [r, s], [inside, outside]) in
        [("inner", [radii[0], radii[1]], ["inside", "seat"]), ("outer", [radii[1], radii[2]], ["bore", "outside"])]
    {
        let cuts = ["foot", "head"].map(|cut| format!("{body}_{cut}"));
        let corners = [at(r, 0.0), at(s, 0.0), at(s, angle), at(r, angle)];
        toml = toml
            .outline(body, &corners, &[&cuts[0], outside, &cuts[1], inside])
            .arcs(&[(1, at(s, 0.5 * angle)), (3, at(r, 0.5 * angle))])
            .roller(&cuts[0])
            .roller(&cuts[1]);
    }
    toml = materials(toml, random, frame, ["inner", "outer"]);
    toml = toml.pressure("inside", frame.traction(random));
    toml.table(&format!("[[contacts]]\nbetween = [\"seat\", \"bore\"]{}{}", gap(random, frame), normals(random)))
}

/// A round cap in a seat of the same radius, held by nothing else: it may turn in it.
fn cap(random: &mut Random, frame: &Frame, drawing: &Drawing) -> Toml {
    let reach = random.between(0.4, 1.3);
    let depth = random.between(0.4, 1.0);
    let at = |a: f64| [a.sin(), 1.0 - a.cos()];
    let (left, right) = (at(-reach), at(reach));
    let through = drawing.at(at(0.0));
    let foot = -depth;
    let seat = [[left[0], foot], [right[0], foot], right, left];
    let head = left[1] + random.between(0.2, 0.8);
    let body = [left, right, [right[0], head], [left[0], head]];
    let toml = Toml::default()
        .size(frame.length * random.between(0.15, 0.35))
        .outline("low", &drawing.all(&seat), &["base", "", "seat", ""])
        .arcs(&[(2, through)])
        .outline("up", &drawing.all(&body), &["round", "", "load", ""])
        .arcs(&[(0, through)]);
    let toml = materials(toml, random, frame, ["low", "up"]).clamp("base");
    if random.chance(0.5) {
        // Symmetric but for rounding.
        let toml = toml.pressure("load", frame.traction(random));
        return toml.table(&format!("[[contacts]]\nbetween = [\"seat\", \"round\"]{}", normals(random)));
    }
    // Facets would hold the couple with forces at the ends of edges, which linear pressures cannot follow on coarse meshes.
    weight_on(toml, "load", random, frame, drawing).table("[[contacts]]\nbetween = [\"seat\", \"round\"]")
}

/// A body with a round foot on a straight one, matched along the direction between them.
fn round_on_straight(random: &mut Random, frame: &Frame, drawing: &Drawing) -> Toml {
    let radius = random.between(0.8, 6.0);
    let reach = random.between(0.3, 0.6);
    let facets = 4 + random.below(12);
    let height = |x: f64| radius - (radius * radius - x * x).sqrt();
    let from = if random.chance(0.5) { 0.0 } else { -reach };
    let mut foot: Vec<[f64; 2]> =
        (0..=facets).map(|i| from + (reach - from) * i as f64 / facets as f64).map(|x| [x, height(x)]).collect();
    let top = height(reach) + random.between(0.3, 0.8);
    let mut names = vec!["round"; facets];
    names.extend(["", "load", "side"]);
    foot.extend([[reach, top], [from, top]]);
    let ends = [from - if from < 0.0 { 0.2 } else { 0.0 }, reach + random.between(0.0, 0.5)];
    let block = [[ends[0], -0.7], [ends[1], -0.7], [ends[1], 0.0], [ends[0], 0.0]];
    let mut toml = Toml::default()
        .size(frame.length * random.between(0.08, 0.3))
        .outline("up", &drawing.all(&foot), &names)
        .outline("low", &drawing.all(&block), &["base", "", "flat", ""]);
    toml = materials(toml, random, frame, ["low", "up"]).clamp("base");
    toml = if from < 0.0 && random.chance(0.3) { toml } else { toml.roller("side") };
    toml = weight_on(toml, "load", random, frame, drawing);
    let down = drawing.along([0.0, -1.0]);
    let direction = format!("direction = {down:?}");
    toml.table(&format!("[[contacts]]\nbetween = [\"round\", \"flat\"]\n{direction}{}", gap(random, frame)))
}
