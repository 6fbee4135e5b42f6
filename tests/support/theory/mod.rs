//! Exact solutions, meshes and measurements for checking the theory that the method rests on.
//!
//! Nothing here integrates, projects or evaluates with code of the library, except where the library's own function
//! is what is measured. Shared by the tests and by `examples/theory_rates.rs`.
#![allow(dead_code)]

pub mod airy;
pub mod constant;
pub mod contact;
pub mod fields;
pub mod meshes;
pub mod quadrature;
pub mod rates;
pub mod tables;
pub mod westergaard;

/// Equally likely numbers in [0, 1), the same on every machine (SplitMix64).
pub struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}
