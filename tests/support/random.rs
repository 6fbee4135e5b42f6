//! Reproducible random numbers (SplitMix64).

pub struct Random(u64);

/// How many random scenes a test takes: `HYPERCIRCLE_SCENES`, or `few` where it is not set.
pub fn scenes_or(few: usize) -> usize {
    std::env::var("HYPERCIRCLE_SCENES").ok().map_or(few, |n| n.parse().expect("a number of scenes"))
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    /// One of `choices`.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// 10 to a power that is uniform in [low, high).
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }

    /// Other numbers, without using up any of these.
    pub fn aside(&self) -> Random {
        Random(self.0 ^ 0x5851_f42d_4c95_7f2d)
    }
}
