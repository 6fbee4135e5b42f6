//! A job with FEniCSx.

use super::place::{Place, scene};
use crate::command::{case, ended, hypercircle, run, with_reference};

#[test]
fn scenes_agree_and_a_planted_bug_is_on_the_page() {
    if !with_reference() {
        return;
    }
    let place = Place::with(&["patch"]);
    std::fs::copy(case("gap"), place.path("scenes/gap.toml")).expect("a case");
    let verify =
        |options: &[&str]| run(hypercircle(place.folder(), [&["verify", "scenes", "--jobs", "2"], options].concat()));
    ended("both", &verify(&["--baseline", "kept.toml", "--accept"]), 0, &[]);
    let job = place.json("out/job.json");
    assert!(job["scenes"].as_array().expect("scenes").iter().all(|scene| scene["status"] == "agree"), "{job}");
    assert!(place.read("kept.toml").contains("energy.FEniCSx P2"));
    let found = verify(&["--baseline", "kept.toml", "--sabotage", "flip-sign"]);
    ended("sabotage", &found, 1, &[]);
    let job = place.json("out/job.json");
    let failing = scene(&job, "patch")["failing"].to_string();
    assert!(failing.contains("recomputed") || failing.contains("equilibrium"), "{failing}");
    assert!(place.read("out/index.html").contains("FEniCSx P2") && place.read("out/junit.xml").contains("<failure"));
}
