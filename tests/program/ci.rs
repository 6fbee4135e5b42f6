//! The shell of the action, of the hooks and of docs/ci.md, run as the services run it.
//!
//! `hypercircle` is the program of these tests; `verify` is `solve` there, so that FEniCSx need not be installed.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

use crate::command::{PROGRAM, case, ended, script};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// The blocks `run: |` of a YAML text, in order.
fn steps(yaml: &str) -> Vec<String> {
    let lines: Vec<&str> = yaml.lines().collect();
    let is_step = |line: &&str| line.trim_start().trim_start_matches("- ") == "run: |";
    let starts = (0..lines.len()).filter(|&i| is_step(&lines[i]));
    let block = |start: usize| {
        let key = lines[start].find("run:").expect("the key");
        let inside = lines[start + 1..].iter().take_while(|line| line.trim().is_empty() || indent(line) > key);
        let inside: Vec<&str> = inside.copied().collect();
        let margin = inside.iter().filter(|line| !line.trim().is_empty()).map(|line| indent(line)).min().unwrap_or(0);
        inside.iter().map(|line| format!("{}\n", line.get(margin..).unwrap_or_default())).collect()
    };
    starts.map(block).collect()
}

/// The code blocks of a Markdown text in `language`.
fn blocks(markdown: &str, language: &str) -> Vec<String> {
    let start = format!("```{language}\n");
    markdown.split(&start).skip(1).map(|rest| rest.split("```").next().unwrap_or_default().to_string()).collect()
}

/// A checkout with three scenes, and programs in the place of those that would change the machine.
struct Checkout {
    folder: TempDir,
    programs: PathBuf,
}

impl Checkout {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let programs = folder.path().join("programs");
        for made in ["scenes", "programs"] {
            std::fs::create_dir(folder.path().join(made)).expect("writable");
        }
        for name in ["a", "b", "c"] {
            std::fs::copy(case("patch"), folder.path().join(format!("scenes/{name}.toml"))).expect("a case");
        }
        let body = format!("[ \"$1\" = verify ] && {{ shift; set -- solve \"$@\"; }}\nexec '{PROGRAM}' \"$@\"");
        script(programs.join("hypercircle"), &body);
        for name in ["sudo", "cargo"] {
            script(programs.join(name), &format!("echo \"$@\" >> '{}'", folder.path().join(name).display()));
        }
        // There is no release of the present commit.
        script(programs.join("curl"), "exit 22");
        Checkout { folder, programs }
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.folder.path().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// Runs `step` as GitHub does.
    fn run(&self, step: &str, variables: &[(&str, &str)]) -> Output {
        let mut shell = Command::new("bash");
        shell.args(["--noprofile", "--norc", "-e", "-o", "pipefail", "-c", step]).current_dir(self.folder.path());
        shell.env("PATH", format!("{}:/usr/bin:/bin", self.programs.display()));
        shell.env_remove("GITHUB_ACTIONS");
        for name in ["GITHUB_OUTPUT", "GITHUB_PATH", "GITHUB_STEP_SUMMARY"] {
            shell.env(name, self.folder.path().join(name));
        }
        shell.env("GITHUB_ACTION_PATH", root()).env("RUNNER_TEMP", self.folder.path().join("runner"));
        shell.envs(variables.iter().copied()).output().expect("bash")
    }
}

#[test]
fn the_action_installs_builds_and_runs() {
    let steps = steps(&text("action.yml"));
    let [reference, build, scenes] = steps.as_slice() else { panic!("{steps:?}") };
    let checkout = Checkout::new();
    ended("reference", &checkout.run(reference, &[]), 0, &[]);
    let words = checkout.read("sudo");
    let setup = words.split_whitespace().find(|word| word.ends_with("ci/setup")).expect("a script");
    assert!(Path::new(setup).is_file() && words.trim().ends_with("reference"), "{words}");

    ended("built before", &checkout.run(build, &[]), 0, &[]);
    assert!(!checkout.folder.path().join("cargo").exists());
    std::fs::rename(checkout.programs.join("hypercircle"), checkout.folder.path().join("aside")).expect("writable");
    ended("built", &checkout.run(build, &[]), 0, &[]);
    assert!(checkout.read("cargo").starts_with("install ") && checkout.read("GITHUB_PATH").contains("/bin"));
    // A release has the program, and nothing is built.
    std::fs::remove_file(checkout.folder.path().join("cargo")).expect("written");
    let archive = format!(
        "echo \"$@\" > '{0}/curl'; tar -cz -C '{0}' --transform s/aside/hypercircle/ aside",
        checkout.folder.path().display()
    );
    script(checkout.programs.join("curl"), &archive);
    let release = [("REPOSITORY", "https://github.com/OWNER/hypercircle"), ("HYPERCIRCLE_COMMIT", "v1.2.3")];
    ended("released", &checkout.run(build, &release), 0, &[]);
    assert!(
        checkout.read("curl").contains("OWNER/hypercircle/releases/download/v1.2.3/hypercircle-x86_64-linux.tar.gz")
    );
    let taken = checkout.folder.path().join("runner/hypercircle/bin/hypercircle");
    assert!(taken.is_file() && !checkout.folder.path().join("cargo").exists());
    std::fs::rename(checkout.folder.path().join("aside"), checkout.programs.join("hypercircle")).expect("writable");

    let inputs = [
        ("COMMAND", "solve"),
        ("SCENES", "scenes/a.toml scenes/b.toml"),
        ("OUT", "results"),
        ("OPTIONS", "--refine 1 --quiet"),
    ];
    ended("scenes", &checkout.run(scenes, &inputs), 0, &[]);
    assert_eq!(checkout.read("GITHUB_OUTPUT").trim(), "out=results");
    assert!(checkout.read("GITHUB_STEP_SUMMARY").contains("2 scenes: 2 passed"));
    let one = [("COMMAND", "solve"), ("SCENES", "scenes/a.toml"), ("OUT", "one"), ("OPTIONS", "")];
    ended("one scene", &checkout.run(scenes, &one), 0, &[]);
    assert!(checkout.folder.path().join("one/badge.svg").is_file());
    std::fs::write(checkout.folder.path().join("scenes/b.toml"), "x").expect("writable");
    ended("a bad scene", &checkout.run(scenes, &inputs), 2, &[]);
    // Every input reaches a step by the name that the step knows.
    let action = text("action.yml");
    for (input, variable) in [("command", "COMMAND"), ("scenes", "SCENES"), ("out", "OUT"), ("options", "OPTIONS")] {
        assert!(action.contains(&format!("{variable}: ${{{{ inputs.{input} }}}}")), "{input}");
    }
}

#[test]
fn the_steps_of_the_documentation_do_what_they_say() {
    let document = text("docs/ci.md");
    let yaml = blocks(&document, "yaml");
    let matrix = yaml.iter().find(|block| block.contains("matrix:")).expect("a matrix");
    let steps = steps(matrix);
    let [part, page] = steps.as_slice() else { panic!("{steps:?}") };
    let checkout = Checkout::new();
    for number in ["1", "2", "3", "4"] {
        ended(number, &checkout.run(part, &[("PART", number)]), 0, &[]);
    }
    ended("page", &checkout.run(page, &[]), 0, &[]);
    assert!(checkout.read("out/summary.md").contains("3 scenes: 3 passed"));

    let gitlab = yaml.iter().find(|block| block.contains("script:")).expect("GitLab");
    let lines: Vec<&str> = gitlab.lines().skip_while(|line| line.trim() != "script:").skip(1).collect();
    let commands: Vec<&str> = lines.iter().map_while(|line| line.trim().strip_prefix("- ")).collect();
    let checkout = Checkout::new();
    ended("gitlab", &checkout.run(&commands.join("\n"), &[]), 0, &[]);
    let report = gitlab.split("junit: ").nth(1).and_then(|rest| rest.split([' ', '}']).next()).expect("a file");
    assert!(checkout.folder.path().join(report).is_file());

    let queue = blocks(&document, "sh");
    let [array, gather] = queue.as_slice() else { panic!("{queue:?}") };
    let checkout = Checkout::new();
    for task in ["1", "2", "1"] {
        let variables = [("SLURM_ARRAY_TASK_ID", task), ("SLURM_ARRAY_TASK_COUNT", "2")];
        ended("array", &checkout.run(array, &variables), 0, &[]);
    }
    ended("gather", &checkout.run(gather, &[]), 0, &[]);
    assert!(checkout.folder.path().join("out/index.html").is_file());
}

#[test]
fn hooks_take_the_files_that_changed() {
    let hooks = text(".pre-commit-hooks.yaml");
    let entries: Vec<&str> = hooks.lines().filter_map(|line| line.trim().strip_prefix("entry: ")).collect();
    assert_eq!(entries.len(), 2);
    for entry in entries {
        let checkout = Checkout::new();
        let files = ["scenes/a.toml", "scenes/b.toml"];
        ended(entry, &checkout.run(&format!("{entry} {}", files.join(" ")), &[]), 0, &[]);
        std::fs::write(checkout.folder.path().join("scenes/b.toml"), "x").expect("writable");
        ended(entry, &checkout.run(&format!("{entry} {}", files.join(" ")), &[]), 2, &[]);
        ended(entry, &checkout.run(&format!("{entry} scenes/a.toml"), &[]), 0, &[]);
    }
}
