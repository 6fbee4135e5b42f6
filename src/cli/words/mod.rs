//! Output for people and services: text, progress, errors, exit codes.

pub mod ci;
pub mod error;
pub mod exit;
pub mod progress;
pub mod say;
pub mod show;
pub mod version;
