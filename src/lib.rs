//! hypercircle: guaranteed two-sided energy bounds for plane frictionless contact.

pub mod bounds;
pub mod cli;
pub mod compare;
pub mod dual;
pub mod element;
pub mod mesh;
pub mod primal;
pub mod problem;
pub mod report;
pub mod scene;
pub mod statics;
pub mod study;
