//! Both models of a scene, end to end: the cases, random scenes, and displacement models that are wrong on purpose.

#[allow(dead_code)]
#[path = "../support/arcs.rs"]
mod arcs;
mod cases;
#[path = "../support/command.rs"]
mod command;
mod decks;
mod engine;
#[path = "../support/lame.rs"]
mod lame;
#[allow(dead_code)]
#[path = "../support/pages.rs"]
mod pages;
mod planted;
#[path = "../support/decks.rs"]
mod plates;
mod printed;
mod random_scenes;
mod schemas;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/validate.rs"]
mod validate;
