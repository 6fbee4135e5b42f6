//! Which scenes a job has, and what each is called.

use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::JobError;
use crate::scene::{MeshSource, Scene, scene_name};
use crate::study::hash;

/// Names that files and folders of the job itself have.
const TAKEN: [&str; 9] = [
    "index.html",
    "junit.xml",
    "summary.md",
    "job.json",
    "badge.json",
    "badge.svg",
    "baseline.patch",
    super::PARTS,
    super::PLAN,
];
/// Top-level keys that only a scene has; a TOML file with keys, and none of these, is about something else.
const OF_SCENES: [&str; 8] = ["model", "mesh", "geometry", "bodies", "supports", "tractions", "contacts", "quantities"];

/// The work of a job. The parts of a job that are run on several machines have the same plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Version of this format.
    pub schema_version: u32,
    /// `verify`, `solve` or `certify`.
    pub command: String,
    /// Options that every scene is given, as the command line takes them.
    pub options: Vec<String>,
    /// Hash of the settings that all scenes share: command, options and baseline.
    pub settings: String,
    /// The scenes.
    pub scenes: Vec<Planned>,
    /// TOML files in the folders that are no scenes.
    pub left_out: Vec<String>,
    /// The baseline, if there is one.
    pub baseline: Option<PathBuf>,
    /// True if the numbers that are found become the baseline.
    pub accept: bool,
}

/// One scene of a plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Planned {
    /// Its name in the job.
    pub name: String,
    /// The scene file, as given.
    pub scene: PathBuf,
    /// Hash of the input: the scene file, its mesh and all else that belongs to it.
    pub content: String,
    /// Options for this scene alone.
    pub options: Vec<String>,
}

/// The scene files of `arguments`, which are scene files and folders of them, and the TOML files in these folders that are
/// something else. A folder stands for the files in it whose names end with `.toml` and begin with no dot, by name; those in
/// its folders are not looked for. A file that is given twice is there once.
///
/// # Errors
/// A folder cannot be read or holds no scene, or a name is not Unicode.
pub fn scenes_of(arguments: &[PathBuf]) -> Result<(Vec<PathBuf>, Vec<PathBuf>), JobError> {
    let (mut scenes, mut left_out) = (Vec::new(), Vec::new());
    let mut seen = HashSet::new();
    for argument in arguments {
        if !argument.is_dir() {
            scenes.push(argument.clone());
            continue;
        }
        let unreadable = |source| JobError::Folder { path: argument.clone(), source };
        let mut files: Vec<PathBuf> = Vec::new();
        for entry in fs::read_dir(argument).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            let hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
            if path.extension().is_some_and(|extension| extension == "toml") && !hidden && !path.is_dir() {
                files.push(path);
            }
        }
        files.sort();
        let (own, other): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(|path| may_be_scene(path));
        if own.is_empty() {
            return Err(JobError::NoScenes { path: argument.clone(), other: other.len() });
        }
        scenes.extend(own);
        left_out.extend(other);
    }
    scenes.retain(|path| seen.insert(path.canonicalize().unwrap_or_else(|_| path.clone())));
    left_out.retain(|path| !scenes.contains(path));
    match scenes.iter().chain(&left_out).find(|path| path.to_str().is_none()) {
        Some(path) => Err(JobError::NotUnicode { path: path.clone() }),
        None => Ok((scenes, left_out)),
    }
}

/// True if a file counts as a scene: all do but those that are TOML about something else. One that cannot be read, or is
/// no TOML, is a scene with a mistake in it.
fn may_be_scene(path: &Path) -> bool {
    if !path.is_file() {
        return true;
    }
    let Some(table) = fs::read_to_string(path).ok().and_then(|text| text.parse::<toml::Table>().ok()) else {
        return true;
    };
    table.is_empty() || table.keys().any(|key| OF_SCENES.contains(&key.as_str()))
}

/// A name for each scene that no other has, also where letters are told from capitals by nobody: the name of the file,
/// that of its folder before it where several files have the same one, and a number behind it where that is not enough.
pub fn names(scenes: &[PathBuf]) -> Vec<String> {
    let alike = |name: &str| name.to_lowercase();
    let plain: Vec<String> = scenes.iter().map(|path| scene_name(path)).collect();
    let mut count: BTreeMap<String, usize> = TAKEN.iter().map(|name| (alike(name), 1)).collect();
    for name in &plain {
        *count.entry(alike(name)).or_default() += 1;
    }
    let mut given: HashSet<String> = TAKEN.iter().map(|name| alike(name)).collect();
    // What only one scene is called is kept for it.
    given.extend(plain.iter().map(|name| alike(name)).filter(|name| count[name] == 1));
    let named = scenes.iter().zip(plain).map(|(path, name)| {
        if count[&alike(&name)] == 1 {
            return name;
        }
        let folder = path.canonicalize().ok();
        let folder = folder.as_deref().and_then(Path::parent).and_then(Path::file_name);
        let longer = folder.map_or(name.clone(), |folder| format!("{}-{name}", folder.to_string_lossy()));
        let mut free = longer.clone();
        let mut number = 2;
        while !given.insert(alike(&free)) {
            free = format!("{longer}-{number}");
            number += 1;
        }
        free
    });
    named.collect()
}

/// The scene file, the meshes that it names and `others`, in one number. What cannot be read counts as empty: the run will
/// say so.
pub fn content(scene: &Path, others: &[PathBuf]) -> String {
    let mesh = match Scene::read(scene).map(|scene| scene.mesh.clone()) {
        Ok(MeshSource::File(path)) => vec![path],
        Ok(MeshSource::Parts(parts)) => parts.into_iter().map(|part| part.file).collect(),
        _ => Vec::new(),
    };
    let files =
        std::iter::once(scene).chain(mesh.iter().map(PathBuf::as_path)).chain(others.iter().map(PathBuf::as_path));
    let read = |path: &Path| if path.is_file() { fs::read(path).unwrap_or_default() } else { Vec::new() };
    let hashes: Vec<String> = files.map(|path| hash(&read(path))).collect();
    hash(hashes.join(" ").as_bytes())
}

/// A part of a job: every n-th scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 1.
    pub number: usize,
    /// Of how many.
    pub of: usize,
}

impl Shard {
    /// The whole of it.
    pub const WHOLE: Shard = Shard { number: 1, of: 1 };

    /// True if scene number `index`, from 0, belongs to it.
    pub fn has(self, index: usize) -> bool {
        index % self.of == self.number - 1
    }
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err("write I/N with I from 1 to N, for instance 2/5".to_string()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
        let folder = tempfile::tempdir().expect("a folder");
        for (name, text) in files {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("a parent")).expect("writable");
            fs::write(path, text).expect("writable");
        }
        folder
    }

    #[test]
    fn a_folder_stands_for_its_scenes_and_hides_no_mistake() {
        let folder = folder(&[
            ("b.toml", "[bodies.x]"),
            ("a.toml", "this is = no toml at ["),
            ("empty.toml", ""),
            ("misspelt.toml", "[modell]\n[bodies]"),
            ("Cargo.toml", "[package]\nname = \"x\""),
            (".hidden.toml", "[model]"),
            ("notes.txt", ""),
            ("deeper/c.toml", "[model]"),
        ]);
        let (scenes, left_out) = scenes_of(&[folder.path().to_path_buf()]).expect("scenes");
        let names = |paths: &[PathBuf]| -> Vec<String> {
            paths.iter().map(|p| p.file_name().expect("a name").to_string_lossy().into_owned()).collect()
        };
        assert_eq!(names(&scenes), ["a.toml", "b.toml", "empty.toml", "misspelt.toml"]);
        assert_eq!(names(&left_out), ["Cargo.toml"]);
        // Given again by name, a scene is still one; given by name, anything is a scene.
        let again = [folder.path().to_path_buf(), folder.path().join("b.toml"), folder.path().join("Cargo.toml")];
        let (scenes, left_out) = scenes_of(&again).expect("scenes");
        assert_eq!((scenes.len(), left_out.len()), (5, 0));
    }

    #[test]
    fn a_folder_without_scenes_is_refused() {
        let folder = folder(&[("Cargo.toml", "[package]")]);
        let error = scenes_of(&[folder.path().to_path_buf()]).expect_err("no scenes");
        assert!(matches!(error, JobError::NoScenes { other: 1, .. }), "{error}");
    }

    #[test]
    fn no_two_scenes_have_the_same_name() {
        let folder = folder(&[("one/x.toml", ""), ("two/x.toml", ""), ("two/X.toml", ""), ("two/two-x.toml", "")]);
        let paths: Vec<PathBuf> =
            ["one/x.toml", "two/x.toml", "two/X.toml", "two/two-x.toml", "index.html.toml", "y.toml"]
                .iter()
                .map(|name| folder.path().join(name))
                .collect();
        let names = names(&paths);
        assert_eq!(names[..4], ["one-x", "two-x-2", "two-X-3", "two-x"]);
        assert!(!TAKEN.contains(&names[4].as_str()) && names[5] == "y", "{names:?}");
    }

    #[test]
    fn shards_share_the_scenes() {
        let shards: Vec<Shard> = (1..=3).map(|i| format!("{i}/3").parse().expect("a shard")).collect();
        for index in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(index)).count(), 1);
        }
        for wrong in ["0/3", "4/3", "1", "a/b", "1/0", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
        }
    }
}
