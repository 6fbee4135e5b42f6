//! Communication of a process with others that make a displacement with it, each for a share of the mesh.

/// The share of one process. Default methods implement the single-process case: everything is its own, and there is nobody to ask.
///
/// All processes call the same methods in the same order, and get the same answers.
pub trait Share {
    /// True if the energy of triangle `t` is counted here; every triangle is counted once.
    fn has_triangle(&self, _t: usize) -> bool {
        true
    }

    /// True if row `row` of contact is looked after here.
    fn has_row(&self, _row: usize) -> bool {
        true
    }

    /// Brings up to date what the patches of front `front` have moved, as far as patches here read it.
    fn hand_on(&self, _front: usize, _values: &mut [[f64; 2]]) {}

    /// Brings up to date the values of all nodes that belong to others.
    fn refresh(&self, _values: &mut [[f64; 2]]) {}

    /// Sums over all processes, number by number.
    fn sum(&self, _own: &mut [f64]) {}

    /// The largest of all processes.
    fn largest(&self, own: f64) -> f64 {
        own
    }

    /// The least of all processes.
    fn least(&self, own: f64) -> f64 {
        own
    }

    /// The sum of one number of each process.
    fn total(&self, own: f64) -> f64 {
        let mut sum = [own];
        self.sum(&mut sum);
        sum[0]
    }
}

/// That of a process alone.
#[derive(Debug, Clone, Copy)]
pub struct Whole;

impl Share for Whole {}
