//! One file a command: its arguments, and what it calls.

pub mod cases;
pub mod certify;
pub mod chart;
pub mod diff;
pub mod element;
pub mod gather;
pub mod job;
pub mod mcp;
pub mod measure;
pub mod mesh;
pub mod part;
pub mod schema;
pub mod shell;
pub mod solve;
pub mod stability;
pub mod verify;
