//! hypercircle: guaranteed two-sided energy bounds for plane frictionless contact.

pub mod mesh;
pub mod problem;
pub mod scene;
