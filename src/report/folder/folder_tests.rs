use std::sync::atomic::{AtomicBool, Ordering};

use super::*;

const NAMES: [&str; 3] = ["a.json", "b.html", "c.xml"];

fn set(run: usize) -> Vec<NamedFile<'static>> {
    NAMES.map(|name| (name, run.to_string().repeat(10_000).into_bytes())).to_vec()
}

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(dir).expect("readable").map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The runs whose files are in the folder.
fn runs(dir: &Path) -> Vec<Vec<u8>> {
    let mut found: Vec<_> = NAMES.iter().filter_map(|name| fs::read(dir.join(name)).ok()).collect();
    found.dedup();
    found
}

#[test]
fn a_reader_never_sees_two_runs() {
    let root = tempfile::tempdir().expect("a folder");
    let dir = root.path().join("deep/out");
    replace(&dir, &set(0), &[]).expect("writable");
    let over = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let reader = scope.spawn(|| {
            let mut looks = 0;
            while !over.load(Ordering::Relaxed) {
                // One handle on the folder: what it holds is one run's, whatever its name stands for by now.
                let Ok(folder) = File::open(&dir) else { panic!("the folder is gone") };
                let within = PathBuf::from(format!("/proc/self/fd/{}", std::os::fd::AsRawFd::as_raw_fd(&folder)));
                let seen = runs(&within);
                assert!(seen.len() <= 1, "a mixture of {} runs", seen.len());
                looks += 1;
            }
            looks
        });
        // Two writers at a time.
        std::thread::scope(|scope| {
            for writer in 1..=2 {
                let dir = &dir;
                scope.spawn(move || (0..40).for_each(|_| replace(dir, &set(writer), &[]).expect("writable")));
            }
        });
        over.store(true, Ordering::Relaxed);
        assert!(reader.join().expect("no mixture") > 0);
    });
    assert_eq!(names(&dir), NAMES);
    assert_eq!(names(&root.path().join("deep")), ["out"]);
}

#[test]
fn files_of_the_user_stay_and_so_does_the_folder() {
    let dir = tempfile::tempdir().expect("a folder");
    replace(dir.path(), &set(1), &[]).expect("writable");
    fs::create_dir(dir.path().join("mine")).expect("writable");
    fs::write(dir.path().join("mine/notes.txt"), "kept").expect("writable");
    let before = fs::metadata(dir.path()).expect("there").ino();
    replace(dir.path(), &set(2), &[]).expect("writable");
    assert_eq!(fs::metadata(dir.path()).expect("there").ino(), before);
    assert_eq!(fs::read(dir.path().join("mine/notes.txt")).expect("there"), b"kept");
    assert_eq!(runs(dir.path()), [set(2)[0].1.clone()]);
    assert_eq!(names(dir.path()), ["a.json", "b.html", "c.xml", "mine"]);
}

#[test]
fn what_killed_runs_left_is_removed() {
    let root = tempfile::tempdir().expect("a folder");
    let dir = root.path().join("out");
    replace(&dir, &set(1), &[]).expect("writable");
    for place in [root.path(), dir.as_path()] {
        fs::create_dir(place.join(".hypercircle-old")).expect("writable");
        fs::write(place.join(".hypercircle-old/a.json"), "half").expect("writable");
        fs::write(place.join(".hypercircle-file"), "half").expect("writable");
    }
    replace(&dir, &set(2), &[]).expect("writable");
    assert_eq!((names(root.path()), names(&dir)), (vec!["out".into()], NAMES.map(String::from).to_vec()));
    fs::write(dir.join("notes.txt"), "mine").expect("writable");
    fs::write(dir.join(".hypercircle-file"), "half").expect("writable");
    replace(&dir, &set(3), &[]).expect("writable");
    assert_eq!(names(&dir), ["a.json", "b.html", "c.xml", "notes.txt"]);
}

#[test]
fn a_file_that_a_run_no_longer_has_goes_and_one_of_the_user_s_stays() {
    const OLD: Passing = Passing { name: "d.csv", begins: b"quantity,kind" };
    let root = tempfile::tempdir().expect("a folder");
    // Alone, the folder changes as a whole; with a file of somebody else's in it, file by file.
    for (folder, others) in [("alone", &[][..]), ("shared", &["notes.txt"])] {
        let dir = root.path().join(folder);
        replace(&dir, &set(0), &[OLD]).expect("writable");
        others.iter().for_each(|name| fs::write(dir.join(name), "mine").expect("writable"));
        let mut files = set(1);
        files.push((OLD.name, b"quantity,kind\ntip".to_vec()));
        replace(&dir, &files, &[OLD]).expect("writable");
        assert_eq!(names(&dir).len(), 4 + others.len());
        let before = fs::metadata(&dir).expect("there").ino();
        replace(&dir, &set(2), &[OLD]).expect("writable");
        assert_eq!(names(&dir).len(), 3 + others.len());
        assert_eq!(fs::metadata(&dir).expect("there").ino() == before, !others.is_empty());
        fs::write(dir.join(OLD.name), "mine").expect("writable");
        replace(&dir, &set(3), &[OLD]).expect("writable");
        assert_eq!(fs::read(dir.join(OLD.name)).expect("there"), b"mine");
        fs::remove_file(dir.join(OLD.name)).expect("ours");
        fs::create_dir(dir.join(OLD.name)).expect("writable");
        replace(&dir, &set(3), &[OLD]).expect("writable");
        assert!(dir.join(OLD.name).is_dir());
    }
}

#[test]
fn permissions_and_links_survive() {
    let root = tempfile::tempdir().expect("a folder");
    let dir = root.path().join("real");
    fs::create_dir(&dir).expect("writable");
    fs::set_permissions(&dir, Permissions::from_mode(0o750)).expect("ours");
    let link = root.path().join("link");
    std::os::unix::fs::symlink(&dir, &link).expect("writable");
    replace(&link, &set(1), &[]).expect("writable");
    replace(&link, &set(2), &[]).expect("writable");
    assert!(link.symlink_metadata().expect("there").is_symlink());
    assert_eq!(fs::metadata(&dir).expect("there").permissions().mode() & 0o777, 0o750);
    assert_eq!(runs(&dir), [set(2)[0].1.clone()]);
    let file = fs::metadata(dir.join("a.json")).expect("there").permissions().mode();
    assert_eq!(file & 0o400, 0o400);
    assert_eq!(file & 0o111, 0, "a file is no program");
}

#[test]
fn a_run_that_does_not_end_is_not_waited_for_for_ever() {
    let root = tempfile::tempdir().expect("a folder");
    let dir = root.path().join("out");
    let other = File::open(root.path()).expect("readable");
    flock(&other, FlockOperation::LockExclusive).expect("nobody else");
    let error = replace_within(&dir, &set(1), &[], Duration::from_millis(50)).expect_err("busy");
    assert!(matches!(&error, ReportError::Busy { .. }), "{error}");
    assert!(error.to_string().contains("another run"), "{error}");
    drop(other);
    replace(&dir, &set(1), &[]).expect("writable");
}

#[test]
fn a_run_that_does_not_end_is_known_before_there_is_anything_to_write() {
    let root = tempfile::tempdir().expect("a folder");
    let dir = root.path().join("out");
    let short = Duration::from_millis(50);
    assert!(wait_within(&dir, short).is_ok(), "a folder that is not there is free");
    replace(&dir, &set(0), &[]).expect("writable");
    assert!(wait_within(&dir, short).is_ok());
    for held in [&dir, &root.path().to_path_buf()] {
        let folder = File::open(held).expect("readable");
        flock(&folder, FlockOperation::LockExclusive).expect("locks");
        assert!(matches!(wait_within(&dir, short), Err(ReportError::Busy { .. })), "{}", held.display());
    }
}

#[test]
fn what_a_killed_run_left_beside_a_file_is_removed_with_the_next() {
    let root = tempfile::tempdir().expect("a folder");
    let file = root.path().join("file.json");
    fs::create_dir(root.path().join(".hypercircle-killed")).expect("writable");
    fs::write(root.path().join(".hypercircle-killed/file"), "half").expect("writable");
    for text in ["one", "two"] {
        replace_file(&file, text.into()).expect("writable");
        assert_eq!(
            (fs::read_to_string(&file).expect("there").as_str(), names(root.path())),
            (text, vec!["file.json".into()])
        );
    }
}
