//! Both models of a scene, end to end: the cases, random scenes, and displacement models that are wrong on purpose.

mod cases;
#[path = "../support/lame.rs"]
mod lame;
mod planted;
mod random_scenes;
#[path = "../support/mod.rs"]
mod support;
