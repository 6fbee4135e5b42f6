//! Scenes with curved contact: blocks that meet along an arc, a disc in its bore, a ring on a ring.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use super::lame::Rings;

/// Two blocks that meet along an arc of `n` facets; the upper one is guided on its left and pressed down.
pub struct Arcs {
    /// Number of facets.
    pub n: usize,
    /// Height of the arc over its chord of length one; negative where the lower block is hollow.
    pub rise: f64,
    /// `smooth` or `facets`.
    pub normals: &'static str,
    /// True if the arc is one of an ellipse.
    pub squeezed: bool,
}

impl Default for Arcs {
    fn default() -> Self {
        Arcs { n: 16, rise: 0.12, normals: "smooth", squeezed: false }
    }
}

impl Arcs {
    /// The scene file.
    pub fn text(&self) -> String {
        let curve: Vec<[f64; 2]> = (0..=self.n).map(|i| self.point(i)).collect();
        let mut lower = vec![[0.0, 0.0], [1.0, 0.0]];
        lower.extend(curve.iter().rev());
        let mut upper = curve.clone();
        upper.extend([[1.0, 1.3], [0.0, 1.3]]);
        let named = |count: usize, name: &str| vec![name.to_string(); count];
        let mut below = vec!["base".to_string(), String::new()];
        below.extend(named(self.n, "lower"));
        below.push(String::new());
        let mut above = named(self.n, "upper");
        above.extend(["", "load", "side"].map(String::from));
        let polygons = [("low", lower, below), ("up", upper, above)];
        scene(1.05 / self.n as f64, &polygons, &pressed(self.normals))
    }

    fn point(&self, i: usize) -> [f64; 2] {
        let (n, t) = (self.n, i as f64 / self.n as f64);
        if i == 0 || i == n {
            return [t, 0.5];
        }
        let rise = self.rise.abs();
        if rise == 0.0 {
            return [t, 0.5];
        }
        let radius = (0.25 + rise * rise) / (2.0 * rise);
        let angle = (2.0 * t - 1.0) * (0.5 / radius).asin();
        let height = (radius * angle.cos() - (radius - rise)) * self.rise.signum();
        // Squeezed towards one side, the facets differ and no four vertices lie on a circle.
        let x = 0.5 + radius * angle.sin();
        [if self.squeezed { x * (0.8 + 0.2 * x) } else { x }, 0.5 + height]
    }
}

/// Two blocks as those of [`Arcs`], with an arc of the scene file between them.
pub fn between_arcs(rise: f64) -> String {
    let through = [0.5, 0.5 + rise];
    let mut text = String::from("[model]\nkinematics = \"plane-strain\"\n[geometry]\n");
    let blocks = [
        ("low", [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]], ["base", "", "lower", ""], 2),
        ("up", [[0.0, 0.5], [1.0, 0.5], [1.0, 1.3], [0.0, 1.3]], ["upper", "", "load", "side"], 0),
    ];
    for (body, points, edges, arc) in blocks {
        let _ = write!(
            text,
            "[[geometry.polygons]]\nbody = \"{body}\"\npoints = {points:?}\nedges = {edges:?}\n\
             arcs = [{{ edge = {arc}, through = {through:?} }}]\n[bodies.{body}]\nyoung = 1.0\npoisson = 0.3\n"
        );
    }
    text + &pressed("smooth")
}

/// The lower block clamped at its base, the upper one guided on its left and pressed down.
fn pressed(normals: &str) -> String {
    format!(
        "[[supports]]\non = \"base\"\ntype = \"clamped\"\n[[supports]]\non = \"side\"\ntype = \"roller\"\n\
         [[tractions]]\non = \"load\"\nvalue = [0.0, -1.0]\ngradient = [[0.0, 0.0], [0.5, 0.0]]\n\
         [[contacts]]\nbetween = [\"lower\", \"upper\"]\nnormals = \"{normals}\"\n"
    )
}

/// A disc with a hole of radius ½ in the bore, of radius 1 and `n` facets, of a round plate that is clamped at its rim. `load` is
/// `couple` (tractions along its inner boundary), `force` (its weight) or nothing.
pub fn disc(n: usize, load: &str, normals: &str) -> String {
    let on = |radius: f64, i: usize, n: usize| {
        let angle = TAU * i as f64 / n as f64;
        // Cosine and sine of a multiple of π are not quite what they should be.
        let clean = |x: f64| if x.abs() < 1e-15 { 0.0 } else { x };
        [clean(radius * angle.cos()), clean(radius * angle.sin())]
    };
    // The rings are cut along the rays to vertex 0 and to the one nearest to half a turn.
    let half = n / 2;
    let part = |from: usize, to: usize, body: &str, radii: [f64; 2], names: [&str; 2]| {
        let outer: Vec<[f64; 2]> = (from..=to).map(|i| on(radii[1], i % n, n)).collect();
        let inner: Vec<[f64; 2]> = (from..=to).rev().map(|i| on(radii[0], i % n, n)).collect();
        let mut edges = vec![names[1].to_string(); to - from];
        edges.push(String::new());
        edges.extend(vec![names[0].to_string(); to - from]);
        edges.push(String::new());
        (body.to_string(), [outer, inner].concat(), edges)
    };
    let parts = [
        part(0, half, "disc", [0.5, 1.0], ["hub", "rim"]),
        part(half, n, "disc", [0.5, 1.0], ["hub", "rim"]),
        part(0, half, "plate", [1.0, 2.0], ["bore", "wall"]),
        part(half, n, "plate", [1.0, 2.0], ["bore", "wall"]),
    ];
    let polygons: Vec<Outline<'_>> =
        parts.iter().map(|(body, points, edges)| (body.as_str(), points.clone(), edges.clone())).collect();
    let mut conditions = format!(
        "[[supports]]\non = \"wall\"\ntype = \"clamped\"\n[[contacts]]\nbetween = [\"rim\", \"bore\"]\nnormals = \"{normals}\"\n"
    );
    if load == "couple" {
        conditions.push_str("[[tractions]]\non = \"hub\"\nvalue = [0.0, 0.0]\ngradient = [[0.0, -1.0], [1.0, 0.0]]\n");
    }
    let text = scene(TAU / n as f64 * 1.1, &polygons, &conditions);
    if load == "force" { text.replace("[bodies.disc]\n", "[bodies.disc]\nbody_force = [0.0, -0.1]\n") } else { text }
}

/// A ring (radii 1 and 2, 24 facets) that nothing holds but a rigid pin of radius 1.01 around `centre`, in its bore.
pub fn ring_on_pin(centre: [f64; 2]) -> String {
    let n = 24;
    let on = |radius: f64, i: usize| {
        let angle = TAU * i as f64 / n as f64;
        [radius * angle.cos(), radius * angle.sin()]
    };
    let half = |from: usize| {
        let outer = (from..=from + n / 2).map(|i| on(2.0, i));
        let inner = (from..=from + n / 2).rev().map(|i| on(1.0, i));
        outer.chain(inner).collect::<Vec<_>>()
    };
    let named = |name: &str| vec![name.to_string(); n / 2];
    let edges = [named("rim"), vec![String::new()], named("bore"), vec![String::new()]].concat();
    let polygons: Vec<Outline<'_>> = [0, n / 2].map(|from| ("ring", half(from), edges.clone())).to_vec();
    let conditions = format!(
        "[[contacts]]\non = \"bore\"\nobstacle = {{ circle = {{ centre = {centre:?}, radius = 1.01, side = \"outside\" }} }}\n"
    );
    scene(TAU / n as f64 * 1.1, &polygons, &conditions)
}

/// A ring in another one under a pressure of one inside.
pub const PRESSED: Rings = Rings { radii: [1.0, 1.5, 2.0], young: [2.0, 1.0], poisson: 0.3, inside: 1.0, depth: 0.0 };

/// A quarter of a ring (radii 1 and 1.5, E = 2) in another (1.5 and 2, E = 1), rollers on the cuts, a pressure of 1
/// inside, each of n facets along the contact; and the pressure between them after Lamé.
pub fn ring_on_ring(n: usize) -> (String, f64) {
    let part = |body: &str, radii: [f64; 2], names: [&str; 4]| {
        let on = |radius: f64, i: usize| {
            let angle = 0.5 * PI * i as f64 / n as f64;
            match i {
                0 => [radius, 0.0],
                _ if i == n => [0.0, radius],
                _ => [radius * angle.cos(), radius * angle.sin()],
            }
        };
        let outer: Vec<[f64; 2]> = (0..=n).map(|i| on(radii[1], i)).collect();
        let inner: Vec<[f64; 2]> = (0..=n).rev().map(|i| on(radii[0], i)).collect();
        let mut edges = vec![names[1].to_string(); n];
        edges.push(names[2].to_string());
        edges.extend(vec![names[0].to_string(); n]);
        edges.push(names[3].to_string());
        (body.to_string(), [outer, inner].concat(), edges)
    };
    let parts = [
        part("inner", [1.0, 1.5], ["inside", "seat", "inner_left", "inner_foot"]),
        part("outer", [1.5, 2.0], ["bore", "outside", "outer_left", "outer_foot"]),
    ];
    let polygons: Vec<Outline<'_>> =
        parts.iter().map(|(body, points, edges)| (body.as_str(), points.clone(), edges.clone())).collect();
    let mut conditions = String::new();
    for on in ["inner_left", "inner_foot", "outer_left", "outer_foot"] {
        let _ = writeln!(conditions, "[[supports]]\non = \"{on}\"\ntype = \"roller\"");
    }
    conditions
        .push_str("[[tractions]]\non = \"inside\"\npressure = 1.0\n[[contacts]]\nbetween = [\"seat\", \"bore\"]\n");
    let text = scene(0.5 * PI * 1.5 / n as f64 * 1.05, &polygons, &conditions);
    (text.replace("[bodies.inner]\nyoung = 1.0", "[bodies.inner]\nyoung = 2.0"), PRESSED.pressure())
}

/// A body with its corners and the names of its edges.
type Outline<'a> = (&'a str, Vec<[f64; 2]>, Vec<String>);

fn scene(size: f64, polygons: &[Outline<'_>], conditions: &str) -> String {
    let mut text = format!("[model]\nkinematics = \"plane-strain\"\n[geometry]\nsize = {size}\n");
    let mut bodies: Vec<&str> = Vec::new();
    for (body, points, edges) in polygons {
        let _ = write!(text, "[[geometry.polygons]]\nbody = \"{body}\"\npoints = {points:?}\nedges = {edges:?}\n");
        if !bodies.contains(body) {
            bodies.push(body);
        }
    }
    for body in bodies {
        let _ = write!(text, "[bodies.{body}]\nyoung = 1.0\npoisson = 0.3\n");
    }
    text + conditions
}
