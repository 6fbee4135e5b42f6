//! The shapes that a formula is held against.

/// Corners of an element, counter-clockwise, with what is special about them.
pub struct Shape {
    pub name: String,
    pub corners: Vec<[f64; 2]>,
}

/// An equilateral triangle, or a square, of size one.
pub fn regular(corners: usize) -> Vec<[f64; 2]> {
    match corners {
        3 => vec![[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]],
        _ => vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    }
}

/// A shape without symmetry.
pub fn irregular(corners: usize) -> Vec<[f64; 2]> {
    match corners {
        3 => vec![[0.1, -0.2], [1.3, 0.1], [0.4, 0.9]],
        _ => vec![[0.1, -0.1], [1.2, 0.1], [0.9, 1.1], [-0.1, 0.8]],
    }
}

/// Another one, larger and elsewhere.
pub fn lopsided(corners: usize) -> Vec<[f64; 2]> {
    match corners {
        3 => vec![[0.2, 0.3], [2.3, -0.4], [1.1, 1.9]],
        _ => vec![[0.3, 0.2], [2.2, -0.3], [1.8, 1.9], [-0.4, 1.3]],
    }
}

fn mapped(name: impl Into<String>, corners: &[[f64; 2]], map: impl Fn([f64; 2]) -> [f64; 2]) -> Shape {
    Shape { name: name.into(), corners: corners.iter().map(|x| map(*x)).collect() }
}

/// The irregular shape, turned.
pub fn rotations(corners: usize) -> Vec<Shape> {
    [30.0_f64, 90.0, 137.0, 250.0]
        .map(|degrees| {
            let (s, c) = degrees.to_radians().sin_cos();
            let turn = |[x, y]: [f64; 2]| [c * x - s * y + 3.0, s * x + c * y - 2.0];
            mapped(format!("turned by {degrees}°"), &irregular(corners), turn)
        })
        .into()
}

/// Stretched, sheared and distorted ones.
pub fn sweep(corners: usize) -> Vec<Shape> {
    let (regular, irregular) = (regular(corners), irregular(corners));
    let mut all: Vec<Shape> = [1.0, 3.0, 10.0, 100.0]
        .into_iter()
        .map(|a| mapped(format!("stretched 1 : {a}"), &regular, move |[x, y]| [x, y / a]))
        .collect();
    all.push(mapped("sheared by 45°", &regular, |[x, y]| [x + y, y]));
    all.push(mapped("without symmetry", &irregular, |x| x));
    all.push(mapped("without symmetry, stretched 1 : 10", &irregular, |[x, y]| [x, y / 10.0]));
    all.push(mapped("in millimetres", &irregular, |[x, y]| [1e3 * x + 5e3, 1e3 * y]));
    if corners == 4 {
        all.push(mapped(
            "with one corner moved inwards",
            &regular,
            |[x, y]| {
                if x + y > 1.5 { [0.65, 0.6] } else { [x, y] }
            },
        ));
    }
    all
}
