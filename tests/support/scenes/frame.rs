//! Places, units and magnitudes of a scene, and its numbers in the words of the file.

use super::conditions::Manner;
use super::layout::{Layout, Side};
use crate::support::random::Random;

/// Places, units and magnitudes.
pub struct Frame {
    pub turn: [f64; 2],
    pub length: f64,
    pub young: f64,
    /// Tractions, as a part of Young's modulus.
    pub load: f64,
}

impl Frame {
    pub fn random(random: &mut Random) -> Frame {
        let angle = match random.below(8) {
            0..=3 => None,
            4 => Some(std::f64::consts::FRAC_PI_6),
            5 => Some(std::f64::consts::FRAC_PI_4),
            _ => Some(random.between(-3.0, 3.0)),
        };
        let length = random.pick(&[1e-3, 1.0, 1.0, 1e3]);
        let young = if random.chance(0.4) { 1.0 } else { random.magnitude(-3.0, 9.0) };
        let turn = angle.map_or([1.0, 0.0], |a| [a.cos(), a.sin()]);
        Frame { turn, length, young, load: random.magnitude(-4.0, -1.5) }
    }

    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.turn;
        [c * x - s * y, s * x + c * y]
    }

    /// A displacement or a gap of an ordinary size.
    pub fn shift(&self, random: &mut Random) -> f64 {
        self.length * random.magnitude(-4.0, -1.0)
    }

    pub fn traction(&self, random: &mut Random) -> f64 {
        self.young * self.load * random.between(0.2, 1.0)
    }
}

/// A traction in the words of a scene.
pub fn load(random: &mut Random, frame: &Frame, manner: Manner) -> String {
    let size = frame.traction(random);
    if manner == Manner::Seated || random.chance(0.4) {
        let pull = manner != Manner::Seated && random.chance(0.3);
        return format!("pressure = {:?}", if pull { -size } else { size });
    }
    let value = frame.turned([size * random.between(-1.0, 1.0), size * random.between(-1.0, 1.0)]);
    if random.chance(0.5) {
        return format!("value = {value:?}");
    }
    let steep = size / frame.length;
    let row = |random: &mut Random| [0, 1].map(|_| steep * random.between(-0.5, 0.5));
    format!("value = {value:?}\ngradient = [{:?}, {:?}]", row(random), row(random))
}

/// A gap in the words of a scene.
pub fn gap(random: &mut Random, frame: &Frame, layout: &Layout, side: &Side, manner: Manner) -> String {
    if manner == Manner::Border && random.chance(0.3) {
        return format!("{:?}", 0.5 * frame.length);
    }
    // A gap that the loads are likely to close in part.
    let small = frame.length * if random.chance(0.5) { frame.load } else { random.magnitude(-4.0, -1.5) };
    match random.below(8) {
        0..=4 => "0.0".to_owned(),
        5 => format!("{:?}", small * random.between(0.1, 1.0)),
        6 => {
            let length: f64 = frame.length * side.pieces.iter().map(|p| layout.length(*p)).sum::<f64>();
            let rise = |random: &mut Random| small * random.between(0.0, 1.0);
            let middle = length * random.between(0.3, 0.6);
            format!("[[0.0, {:?}], [{middle:?}, 0.0], [{length:?}, {:?}]]", rise(random), rise(random))
        }
        _ => format!("[[0.0, 0.0], [{:?}, {:?}]]", 3.0 * frame.length, small),
    }
}
