//! Both models of a scene, end to end: the cases, random scenes, and displacement models that are wrong on purpose.

#[allow(dead_code)]
#[path = "../support/arcs.rs"]
mod arcs;
mod cases;
#[path = "../support/command.rs"]
mod command;
mod engine;
#[path = "../support/lame.rs"]
mod lame;
mod planted;
mod random_scenes;
#[path = "../support/mod.rs"]
mod support;
