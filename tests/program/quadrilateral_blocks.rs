//! `certify --solution` on fields of quadrilaterals whose contact sides have different vertices: right ones pass, mistakes are found.

use crate::command::{hypercircle, run, said};
use crate::quadrilaterals::by_scikit_fem;

const SCENE: &str = r#"
[model]
kinematics = "plane-strain"
[mesh]
file = "blocks.msh"
[bodies.lower]
tag = 1
young = 1.0
poisson = 0.3
[bodies.upper]
tag = 2
young = 2.0
poisson = 0.3
[[boundaries]]
name = "foot"
line = [[0, 0], [2, 0]]
[[boundaries]]
name = "guide"
body = "upper"
line = [[0, 1], [0, 2]]
[[boundaries]]
name = "top"
line = [[0, 2], [2, 2]]
[[boundaries]]
name = "above"
body = "upper"
line = [[0, 1], [2, 1]]
[[boundaries]]
name = "below"
body = "lower"
line = [[0, 1], [2, 1]]
[[supports]]
on = "foot"
type = "clamped"
[[supports]]
on = "guide"
type = "roller"
[[tractions]]
on = "top"
value = [0, -0.02]
gradient = [[0, 0], [-0.05, 0]]
[[contacts]]
between = ["above", "below"]
"#;

#[test]
fn solutions_on_quadrilaterals_that_contact_cuts_pass_and_mistakes_are_found() {
    let planted: [(&str, &[&str]); 3] = [
        ("Q4", &["right", "young", "tied", "open", "value"]),
        ("Q8", &["right", "load", "reduced", "tied"]),
        ("Q9", &["right", "reduced", "young"]),
    ];
    std::thread::scope(|scope| {
        for (cells, names) in planted {
            scope.spawn(move || {
                for seed in ["3", "4"] {
                    let folder = tempfile::tempdir().expect("a folder");
                    let folder = folder.path();
                    std::fs::write(folder.join("scene.toml"), SCENE).expect("writable");
                    let names = if seed == "3" { names } else { &names[..1] };
                    let args: Vec<&str> = [seed, cells].iter().chain(names).copied().collect();
                    if by_scikit_fem("quadrilateral_blocks.py", folder, &args).is_none() {
                        return;
                    }
                    for name in names {
                        let field = format!("{name}.vtu");
                        let args = ["certify", "scene.toml", "--displacement", &field, "--solution", "--quiet"];
                        let output = run(hypercircle(folder, args));
                        let expected = if *name == "right" { 0 } else { 1 };
                        assert_eq!(output.status.code(), Some(expected), "{cells} {name}: {}", said(&output));
                    }
                }
            });
        }
    });
}
