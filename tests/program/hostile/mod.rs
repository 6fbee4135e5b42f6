//! The program among hostile files, folders and signals: it runs nobody's code, is never half written, takes with it what
//! it started, and refuses what it cannot use before it works for it.

mod children;
mod early;
mod isolation;
mod kills;
mod offsets;
mod outputs;
mod run;
mod signals;
