//! Data that meshio hands over, as JSON: a displacement field for `certify`, or a mesh.

use std::path::Path;

use hypercircle::mesh::files::foreign;
use hypercircle::study::ForeignField;

use super::msh::follow;
use super::setting::{certified, judge};

/// A refusal has to say something; a field on the mesh has to end in a report.
pub fn run(bytes: &[u8]) {
    match foreign::parse(bytes, Path::new("mesh.vtu")) {
        Ok((raw, _)) => follow(raw),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
    let certified = certified();
    let field = ForeignField::parse(bytes, Path::new("field.vtu"), "0".repeat(64), None);
    match field.and_then(|field| field.candidate(&certified.problem, 0.0)) {
        Ok(candidate) => judge(certified, vec![candidate]),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
