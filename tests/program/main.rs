//! The program, called as a user calls it, without FEniCSx but where a test says so.

mod certify;
mod chart;
mod ci;
mod claimed;
#[path = "../support/command.rs"]
mod command;
mod command_line;
mod contact_in_the_mean;
mod diff;
mod element;
mod fields;
mod hostile;
mod jobs;
#[path = "../malformed/mod.rs"]
mod malformed;
mod malformed_meshes;
mod many_bodies;
mod memory;
mod named_mistakes;
mod printed;
mod quantities;
#[path = "../support/random.rs"]
#[allow(dead_code)]
mod random;
mod schemas;
mod stability;
