//! The text of a scene: read, and where it is accepted and small, meshed and solved.

use std::path::Path;

use hypercircle::dual::{Condensed, Options};
use hypercircle::mesh::expected_triangles;
use hypercircle::problem::Problem;
use hypercircle::scene::{MeshSource, Scene};
use hypercircle::study::certify;

use super::setting::SMALL;

/// A refusal has to name the place in the text, a solution has to have a lower bound below its upper one.
pub fn run(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let scene = match Scene::parse(&text, Path::new("scene.toml")) {
        Ok(scene) => scene,
        Err(error) => {
            assert!(!error.found().is_empty() && !error.remedy().is_empty());
            if let Some(place) = error.place() {
                assert!(place.line() >= 1 && place.column() >= 1 && place.span().end <= text.len(), "{error}");
            }
            return drop(error.to_string());
        }
    };
    let small = expected_triangles(&scene).is_some_and(|triangles| triangles <= SMALL as f64);
    if !small || matches!(scene.mesh, MeshSource::File(_) | MeshSource::Parts(_)) {
        return;
    }
    let problem = match Problem::load(scene) {
        Ok(problem) => problem,
        Err(error) => return assert!(!error.to_string().is_empty()),
    };
    if problem.mesh.triangles.len() > 4 * SMALL {
        return;
    }
    match certify(problem, &Condensed::default(), &Options::default()) {
        Ok(run) => {
            let lower = run.bracket.lower();
            assert!(lower.is_finite(), "the lower bound is {lower}");
            if let Ok(free) = run.bracket.free {
                assert!(lower <= free.upper(), "{lower:e} is above {:e}", free.upper());
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
