//! Twenty scenes at the border of equilibrium: what drives is 1 + `excess` times what holds.

use super::build::Build;
use crate::problem::Problem;
use crate::statics::MotionKind;

/// How the scene gives way: the body that drives, its motion, and where it goes or turns.
pub enum Gives {
    Lifts([f64; 2]),
    Tips([f64; 2]),
    Turns([f64; 2]),
}

pub struct Case {
    pub name: &'static str,
    pub scene: fn(f64) -> Problem,
    pub body: &'static str,
    pub gives: Gives,
}

impl Gives {
    /// True if `kind` is this kind of motion.
    pub fn is(&self, kind: MotionKind) -> bool {
        match self {
            Gives::Lifts(_) => matches!(kind, MotionKind::LiftsOff { centre: None }),
            Gives::Tips(_) => matches!(kind, MotionKind::Tips { .. }),
            Gives::Turns(_) => matches!(kind, MotionKind::Turns { .. }),
        }
    }
}

const SIN30: f64 = 0.5;

pub fn cases() -> Vec<Case> {
    use Gives::{Lifts, Tips, Turns};
    let case = |name, scene, body, gives| Case { name, scene, body, gives };
    vec![
        case("block on rollers pulled off an upright contact", pulled_off, "right", Lifts([1.0, 0.0])),
        case("block lifted off its base", lifted, "top", Lifts([0.0, 1.0])),
        case("overhang tips to the right", |x| overhang(x, false), "top", Tips([2.0, 1.0])),
        case("overhang tips to the left", |x| overhang(x, true), "top", Tips([1.0, 1.0])),
        case("beam on two bases tips over one", beam_on_two, "beam", Tips([3.0, 1.0])),
        case("block on an incline leaves its upper stop", |x| incline(x, true), "block", Lifts(down_slope(1.0))),
        case("block on an incline leaves its lower stop", |x| incline(x, false), "block", Lifts(down_slope(-1.0))),
        case("middle of three is pulled from its stop", middle_of_three, "middle", Lifts([-1.0, 0.0])),
        case("disk climbs out of a notch", notch, "disk", Lifts([0.75f64.sqrt(), SIN30])),
        case("wedge raises a block", wedge, "wedge", Lifts([-1.0, 0.0])),
        case("leaning tower", |x| tower(1.0 + x), "tower", Tips([1.0, 1.0])),
        case("seesaw pulled up at one end", seesaw, "bar", Tips([1.0, 0.0])),
        case("block pressed against a ceiling", ceiling, "block", Lifts([0.0, -1.0])),
        case("last of a row", |x| row(x, 2), "c", Lifts([1.0, 0.0])),
        case("middle of a row takes the last along", |x| row(x, 1), "b", Lifts([1.0, 0.0])),
        case("couple against two half contacts", couple, "block", Tips([1.0, 0.5])),
        case("overhang on a loose block", loose_block, "top", Tips([2.0, 2.0])),
        case("beam and foot tip together", beam_and_foot, "beam", Turns([1.75, 1.0])),
        case("disk lifted out of a socket", socket, "disk", Lifts([0.0, 1.0])),
        case("guided block lifted", guided, "block", Lifts([0.0, 1.0])),
    ]
}

fn pulled_off(excess: f64) -> Problem {
    Build::default()
        .block("left", [0.0, 0.0], [1.0, 1.0], 3)
        .block("right", [1.0, 0.0], [2.0, 1.0], 3)
        .clamp("left", [[0.0, 0.0], [0.0, 1.0]])
        .roller("right", [[1.0, 0.0], [2.0, 0.0]])
        .contact("left", "right", [[1.0, 0.0], [1.0, 1.0]])
        .push("right", [[2.0, 0.0], [2.0, 1.0]], [-1.0, 0.0])
        .gravity("right", [1.0 + excess, 0.0])
        .problem()
}

fn lifted(excess: f64) -> Problem {
    Build::default()
        .block("base", [0.0, 0.0], [1.0, 1.0], 2)
        .block("top", [0.0, 1.0], [1.0, 2.0], 2)
        .clamp("base", [[0.0, 0.0], [1.0, 0.0]])
        .contact("top", "base", [[0.0, 1.0], [1.0, 1.0]])
        .gravity("top", [0.0, -1.0])
        .push("top", [[0.0, 2.0], [1.0, 2.0]], [0.0, 1.0 + excess])
        .problem()
}

fn overhang(excess: f64, left: bool) -> Problem {
    let end = if left { [[0.0, 2.0], [1.0, 2.0]] } else { [[2.0, 2.0], [3.0, 2.0]] };
    Build::default()
        .block("base", [1.0, 0.0], [2.0, 1.0], 3)
        .quad("top", [[1.0, 1.0], [2.0, 1.0], [3.0, 2.0], [0.0, 2.0]], 3)
        .clamp("base", [[1.0, 0.0], [2.0, 0.0]])
        .contact("base", "top", [[1.0, 1.0], [2.0, 1.0]])
        .gravity("top", [0.0, -0.5])
        .push("top", end, [0.0, -1.0 - excess])
        .problem()
}

fn beam_on_two(excess: f64) -> Problem {
    Build::default()
        .block("first", [0.0, 0.0], [1.0, 1.0], 1)
        .block("second", [2.0, 0.0], [3.0, 1.0], 1)
        .block("beam", [0.0, 1.0], [4.0, 2.0], 4)
        .clamp("first", [[0.0, 0.0], [1.0, 0.0]])
        .clamp("second", [[2.0, 0.0], [3.0, 0.0]])
        .contact("beam", "first", [[0.0, 1.0], [1.0, 1.0]])
        .contact("beam", "second", [[2.0, 1.0], [3.0, 1.0]])
        .gravity("beam", [0.0, -0.125])
        .push("beam", [[3.0, 2.0], [4.0, 2.0]], [0.0, -1.0 - excess])
        .problem()
}

fn down_slope(sign: f64) -> [f64; 2] {
    [-sign * 0.75f64.sqrt(), -sign * SIN30]
}

/// A unit block on a plane that rises to the right at 30°, with a stop above or below it.
fn incline(excess: f64, upper_stop: bool) -> Problem {
    let (c, s) = (0.75f64.sqrt(), SIN30);
    let at = |x: f64, y: f64| [c * x - s * y, s * x + c * y];
    let corners = [at(1.0, 0.0), at(2.0, 0.0), at(2.0, 1.0), at(1.0, 1.0)];
    let (lower, upper) = ([corners[0], corners[3]], [corners[1], corners[2]]);
    let mut build = Build::default();
    build
        .fan("wedge", &[[0.0, -1.0], [2.0 * c, -1.0], at(2.0, 0.0), at(1.0, 0.0), [0.0, 0.0]])
        .quad("block", corners, 1)
        .clamp("wedge", [[0.0, -1.0], [2.0 * c, -1.0]])
        .contact("block", "wedge", [at(1.0, 0.0), at(2.0, 0.0)]);
    if upper_stop {
        build.gravity("block", [0.0, -(1.0 + excess) / s]).rigid("block", upper).push("block", lower, [c, s]);
    } else {
        let up = 1.0 + excess;
        build.gravity("block", [0.0, -1.0 / s]).rigid("block", lower).push("block", upper, [up * c, up * s]);
    }
    build.problem()
}

fn middle_of_three(excess: f64) -> Problem {
    Build::default()
        .block("bottom", [0.0, 0.0], [2.0, 1.0], 2)
        .block("middle", [0.0, 1.0], [2.0, 2.0], 2)
        .block("top", [0.0, 2.0], [2.0, 3.0], 2)
        .clamp("bottom", [[0.0, 0.0], [2.0, 0.0]])
        .contact("bottom", "middle", [[0.0, 1.0], [2.0, 1.0]])
        .contact("middle", "top", [[0.0, 2.0], [2.0, 2.0]])
        .rigid("middle", [[2.0, 1.0], [2.0, 2.0]])
        .push("middle", [[0.0, 1.0], [0.0, 2.0]], [1.0, 0.0])
        .gravity("middle", [-0.5 * (1.0 + excess), -1.0])
        .gravity("top", [0.0, -1.0])
        .problem()
}

/// Corners of a regular polygon with `n` sides, one of which faces straight down.
fn polygon(n: usize) -> Vec<[f64; 2]> {
    let angle = |i: usize| (i as f64 + 0.5) * std::f64::consts::TAU / n as f64 - std::f64::consts::FRAC_PI_2;
    (0..n).map(|i| [angle(i).cos(), angle(i).sin()]).collect()
}

fn notch(excess: f64) -> Problem {
    // Sides 0 → 1 and 10 → 11 face down at 30° to either side.
    let p = polygon(12);
    let h = 3f64.sqrt().recip() * (1.0 + excess);
    Build::default()
        .fan("disk", &p)
        .rigid("disk", [p[0], p[1]])
        .rigid("disk", [p[10], p[11]])
        .gravity("disk", [h, -1.0])
        .problem()
}

fn wedge(excess: f64) -> Problem {
    let slope = [[0.0, 0.5], [2.0, 1.5]];
    Build::default()
        .quad("wedge", [[0.0, 0.0], [2.0, 0.0], slope[1], slope[0]], 2)
        .quad("block", [slope[0], slope[1], [2.0, 3.0], [0.0, 3.0]], 2)
        .contact("wedge", "block", slope)
        .rigid("wedge", [[0.0, 0.0], [2.0, 0.0]])
        .rigid("wedge", [[2.0, 0.0], [2.0, 1.5]])
        .roller("block", [[0.0, 0.5], [0.0, 3.0]])
        .gravity("wedge", [-1.0 - excess, 0.0])
        .gravity("block", [0.0, -1.0])
        .problem()
}

pub fn tower(lean: f64) -> Problem {
    Build::default()
        .block("base", [0.0, 0.0], [1.0, 1.0], 4)
        .quad("tower", [[0.0, 1.0], [1.0, 1.0], [1.0 + lean, 2.0], [lean, 2.0]], 4)
        .clamp("base", [[0.0, 0.0], [1.0, 0.0]])
        .contact("tower", "base", [[0.0, 1.0], [1.0, 1.0]])
        .gravity("tower", [0.0, -1.0])
        .problem()
}

fn seesaw(excess: f64) -> Problem {
    Build::default()
        .block("bar", [-2.0, 0.0], [2.0, 1.0], 4)
        .block("post", [0.0, -1.0], [1.0, 0.0], 1)
        .clamp("post", [[0.0, -1.0], [1.0, -1.0]])
        .contact("post", "bar", [[0.0, 0.0], [1.0, 0.0]])
        .rigid("bar", [[-2.0, 0.0], [-1.0, 0.0]])
        .gravity("bar", [0.0, -0.25])
        .push("bar", [[-2.0, 1.0], [-1.0, 1.0]], [0.0, 0.4 * (1.0 + excess)])
        .problem()
}

fn ceiling(excess: f64) -> Problem {
    Build::default()
        .block("block", [0.0, 0.0], [3.0, 1.0], 3)
        .rigid("block", [[0.0, 1.0], [3.0, 1.0]])
        .push("block", [[0.0, 0.0], [3.0, 0.0]], [0.0, 1.0])
        .gravity("block", [0.0, -1.0 - excess])
        .problem()
}

/// Three blocks on rollers, pressed against a wall on the left, one of them pulled off.
fn row(excess: f64, pulled: usize) -> Problem {
    let mut build = Build::default();
    for (i, name) in ["a", "b", "c"].into_iter().enumerate() {
        let x = i as f64;
        let pull = if i == pulled { (3 - i) as f64 * (1.0 + excess) } else { 0.0 };
        build
            .block(name, [x, 0.0], [x + 1.0, 1.0], 2)
            .roller(name, [[x, 0.0], [x + 1.0, 0.0]])
            .gravity(name, [-1.0, 0.0])
            .push(name, [[x, 1.0], [x + 1.0, 1.0]], [pull, 0.0]);
    }
    build
        .rigid("a", [[0.0, 0.0], [0.0, 1.0]])
        .contact("a", "b", [[1.0, 0.0], [1.0, 1.0]])
        .contact("b", "c", [[2.0, 0.0], [2.0, 1.0]])
        .problem()
}

fn couple(excess: f64) -> Problem {
    let turning = 1.0 + excess;
    Build::default()
        .block("block", [0.0, 0.0], [2.0, 1.0], 2)
        .rigid("block", [[1.0, 0.0], [2.0, 0.0]])
        .rigid("block", [[0.0, 1.0], [1.0, 1.0]])
        .push("block", [[0.0, 0.0], [1.0, 0.0]], [0.0, 1.0])
        .push("block", [[1.0, 1.0], [2.0, 1.0]], [0.0, -1.0])
        .push("block", [[0.0, 0.0], [0.0, 0.5]], [0.0, -turning])
        .push("block", [[2.0, 0.0], [2.0, 0.5]], [0.0, turning])
        .problem()
}

fn loose_block(excess: f64) -> Problem {
    Build::default()
        .block("base", [0.0, 0.0], [3.0, 1.0], 3)
        .block("loose", [0.0, 1.0], [3.0, 2.0], 3)
        .quad("top", [[1.0, 2.0], [2.0, 2.0], [3.0, 3.0], [0.0, 3.0]], 1)
        .clamp("base", [[0.0, 0.0], [3.0, 0.0]])
        .contact("base", "loose", [[0.0, 1.0], [3.0, 1.0]])
        .contact("top", "loose", [[1.0, 2.0], [2.0, 2.0]])
        .gravity("top", [0.0, -1.0])
        // Weight 2 at lever ½; traction rising from 0 at (2, 2) to its peak at (3, 3), √2/2 of it at lever 2/3.
        .load("top", [[2.0, 2.0], [3.0, 3.0]], [[0.0, 0.0], [0.0, -1.5 * 2f64.sqrt() * (1.0 + excess)]])
        .problem()
}

fn beam_and_foot(excess: f64) -> Problem {
    Build::default()
        .block("base", [1.25, 0.0], [1.75, 1.0], 1)
        .quad("foot", [[1.25, 1.0], [1.75, 1.0], [2.0, 2.0], [1.0, 2.0]], 1)
        .block("beam", [0.0, 2.0], [3.0, 3.0], 3)
        .clamp("base", [[1.25, 0.0], [1.75, 0.0]])
        .contact("base", "foot", [[1.25, 1.0], [1.75, 1.0]])
        .contact("foot", "beam", [[1.0, 2.0], [2.0, 2.0]])
        .gravity("beam", [0.0, -1.0 / 3.0])
        .push("beam", [[2.0, 3.0], [3.0, 3.0]], [0.0, -(1.0 + excess) / 3.0])
        .problem()
}

fn socket(excess: f64) -> Problem {
    let p = polygon(16);
    let area = 8.0 * (std::f64::consts::TAU / 16.0).sin();
    let width = 2.0 * (std::f64::consts::PI / 16.0).sin();
    let mut build = Build::default();
    build.fan("disk", &p).gravity("disk", [0.0, -1.0]);
    for i in 13..17 {
        build.rigid("disk", [p[i % 16], p[(i + 1) % 16]]);
    }
    build.rigid("disk", [p[1], p[2]]);
    build.push("disk", [p[7], p[8]], [0.0, area / width * (1.0 + excess)]).problem()
}

fn guided(excess: f64) -> Problem {
    Build::default()
        .block("block", [0.0, 0.0], [1.0, 5.0], 5)
        .roller("block", [[0.0, 0.0], [0.0, 5.0]])
        .rigid("block", [[0.0, 0.0], [1.0, 0.0]])
        .gravity("block", [0.0, -1.0])
        .push("block", [[1.0, 0.0], [1.0, 5.0]], [0.0, 1.0 + excess])
        .problem()
}
