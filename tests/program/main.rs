//! The program, called as a user calls it, without FEniCSx but where a test says so.

#[allow(dead_code)]
#[path = "../support/arcs.rs"]
mod arcs;
mod calculix_results;
mod carried_fields;
mod cases;
mod certify;
mod chart;
mod ci;
mod claimed;
mod claims_of_another;
#[path = "../support/command.rs"]
mod command;
mod command_line;
mod contact_in_the_mean;
mod contact_of_others;
mod decks;
mod diff;
mod element;
mod fields;
mod friction;
mod hostile;
mod jobs;
mod labels;
#[path = "../support/lame.rs"]
mod lame;
#[path = "../malformed/mod.rs"]
mod malformed;
mod malformed_meshes;
mod many_bodies;
mod mcp;
mod memory;
mod mesh;
mod named_mistakes;
mod own_mesh;
#[path = "../support/pages.rs"]
mod pages;
#[path = "../support/decks.rs"]
mod plates;
mod printed;
mod proof;
mod quadrilateral_blocks;
mod quadrilaterals;
mod quantities;
#[path = "../support/random.rs"]
#[allow(dead_code)]
mod random;
mod revolved_fields;
mod schemas;
mod spoiled;
mod stability;
mod stale;
mod statics;
mod unheard;
#[path = "../support/validate.rs"]
mod validate;
mod words;
