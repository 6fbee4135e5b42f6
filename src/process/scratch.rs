//! Temporary folders that are never left behind for long.

use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use tempfile::TempDir;

const PREFIX: &str = "hypercircle-";
/// Held locked by the process that made the folder, for as long as it lives: the kernel lets go of it at any death.
const LOCK: &str = ".alive";
/// A folder without a lock that is younger than this may be about to get one, unless the process in its name is gone.
const YOUNG: Duration = Duration::from_secs(60);
/// How long a process that was about to become another one may keep the lock of the one that started it.
const LETTING_GO: Duration = Duration::from_millis(400);

/// The folders that a signal has to take away.
static FOLDERS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A temporary folder in `TMPDIR`, removed when this value is dropped, when a signal ends the process, or, if that could
/// not be, when any process makes its next one.
#[derive(Debug)]
pub struct Scratch {
    folder: TempDir,
    _alive: File,
}

impl Scratch {
    /// Makes a folder, and removes those whose processes are gone.
    ///
    /// # Errors
    /// The folder for temporary files cannot be written to.
    pub fn new() -> io::Result<Self> {
        clear();
        Self::within(&std::path::absolute(std::env::temp_dir())?)
    }

    fn within(root: &Path) -> io::Result<Self> {
        let prefix = format!("{PREFIX}{}-", std::process::id());
        loop {
            let mut folders = folders();
            let folder = tempfile::Builder::new().prefix(&prefix).tempdir_in(root)?;
            folders.push(folder.path().to_path_buf());
            drop(folders);
            // Another process may take the folder for a dead one's before it is locked; then there will be another one.
            let lock = folder.path().join(LOCK);
            let alive = match OpenOptions::new().write(true).create_new(true).open(&lock) {
                Ok(alive) => alive,
                Err(error) => {
                    remove(folder.path());
                    if error.kind() == io::ErrorKind::NotFound {
                        continue;
                    }
                    return Err(error);
                }
            };
            let taken = flock(&alive, FlockOperation::NonBlockingLockExclusive) == Err(Errno::WOULDBLOCK);
            if !taken && lock.exists() {
                return Ok(Scratch { folder, _alive: alive });
            }
            remove(folder.path());
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// A folder inside it.
    ///
    /// # Errors
    /// It cannot be made.
    pub fn folder(&self, name: &str) -> io::Result<PathBuf> {
        let folder = self.path().join(name);
        fs::create_dir(&folder)?;
        Ok(folder)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        remove(self.folder.path());
    }
}

/// Removes every folder of this process: it is about to end.
pub(super) fn remove_all() {
    folders().iter().for_each(|folder| remove_busy(folder));
}

/// Removes a folder into which a thread of this process, or what a dead one started, may be writing still.
fn remove_busy(folder: &Path) {
    for _ in 0..10 {
        if fs::remove_dir_all(folder).is_ok() || !folder.exists() {
            break;
        }
    }
}

fn folders() -> MutexGuard<'static, Vec<PathBuf>> {
    FOLDERS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes a folder; until it is gone, a signal waits for that, so that this process does not end in the middle.
fn remove(folder: &Path) {
    let mut folders = folders();
    let _ = fs::remove_dir_all(folder);
    folders.retain(|other| other != folder);
}

/// Removes the folders in `root` that belong to this user and to no living process.
fn sweep(root: &Path) {
    let user = rustix::process::geteuid().as_raw();
    for entry in fs::read_dir(root).into_iter().flatten().flatten() {
        let named = entry.file_name().to_string_lossy().starts_with(PREFIX);
        // The entry itself: a link that somebody left here is not followed.
        let own = |e: &fs::DirEntry| e.metadata().is_ok_and(|m| m.is_dir() && m.uid() == user);
        if named
            && own(&entry)
            && let Some(_remains) = dead(&entry)
        {
            remove_busy(&entry.path());
        }
    }
}

/// A folder that belongs to no living process, with its lock if it has one. That is held until the folder is gone, so that a
/// process that was about to take it sees that it is taken.
struct Remains {
    _lock: Option<File>,
}

/// The remains in `folder`, if no living process has it.
fn dead(folder: &fs::DirEntry) -> Option<Remains> {
    let gone = || is_gone(&folder.file_name().to_string_lossy());
    match File::open(folder.path().join(LOCK)) {
        Ok(alive) => {
            let free = || flock(&alive, FlockOperation::NonBlockingLockExclusive).is_ok();
            // What a process was starting when it was killed holds its lock until it has become the other program.
            let let_go = || {
                std::thread::sleep(LETTING_GO / 20);
                free()
            };
            (free() || gone() && (0..20).any(|_| let_go())).then_some(Remains { _lock: Some(alive) })
        }
        Err(_) if gone() => Some(Remains { _lock: None }),
        Err(_) => {
            let age = folder.metadata().and_then(|m| m.modified()).ok().and_then(|t| t.elapsed().ok());
            age.is_some_and(|age| age > YOUNG).then_some(Remains { _lock: None })
        }
    }
}

/// True if the process that a folder is named after is gone; not known without `/proc`.
fn is_gone(name: &str) -> bool {
    let process =
        name.strip_prefix(PREFIX).and_then(|rest| rest.split_once('-')).and_then(|(id, _)| id.parse::<u32>().ok());
    Path::new("/proc/self").exists() && process.is_some_and(|id| !Path::new("/proc").join(id.to_string()).exists())
}

/// Removes the temporary folders whose processes are gone.
pub fn clear() {
    if let Ok(root) = std::path::absolute(std::env::temp_dir()) {
        sweep(&root);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_goes_with_its_value() {
        let root = tempfile::tempdir().expect("a folder");
        let scratch = Scratch::within(root.path()).expect("writable");
        let path = scratch.path().to_path_buf();
        fs::write(scratch.folder("inner").expect("writable").join("file"), "text").expect("writable");
        assert!(folders().contains(&path));
        drop(scratch);
        assert!(!path.exists() && !folders().contains(&path));
    }

    #[test]
    fn a_signal_finds_a_folder_for_as_long_as_it_exists() {
        let root = tempfile::tempdir().expect("a folder");
        let scratch = Scratch::within(root.path()).expect("writable");
        let path = scratch.path().to_path_buf();
        (0..3000).for_each(|k| fs::write(path.join(k.to_string()), "").expect("writable"));
        let removing = std::thread::spawn(move || drop(scratch));
        while folders().contains(&path) {}
        assert!(!path.exists(), "it is still being removed, and nobody would wait for that");
        removing.join().expect("removed");
    }

    #[test]
    fn what_a_dead_process_was_starting_keeps_its_folder_for_a_moment_only() {
        let root = tempfile::tempdir().expect("a folder");
        // No process has a number as large; a lock belongs to the open file, so this thread plays its child.
        let folder = root.path().join("hypercircle-4294967295-x");
        fs::create_dir(&folder).expect("writable");
        let alive = File::create(folder.join(LOCK)).expect("writable");
        flock(&alive, FlockOperation::NonBlockingLockExclusive).expect("free");
        let child = std::thread::spawn(move || {
            std::thread::sleep(LETTING_GO / 8);
            drop(alive);
        });
        sweep(root.path());
        assert!(!folder.exists());
        child.join().expect("ended");
        // In another container, say, where the number means another process.
        fs::create_dir(&folder).expect("writable");
        let elsewhere = File::create(folder.join(LOCK)).expect("writable");
        flock(&elsewhere, FlockOperation::NonBlockingLockExclusive).expect("free");
        sweep(root.path());
        assert!(folder.exists());
    }

    #[test]
    fn what_the_dead_left_is_removed_and_the_living_stay() {
        let root = tempfile::tempdir().expect("a folder");
        let living = Scratch::within(root.path()).expect("writable");
        let dead = root.path().join("hypercircle-dead");
        fs::create_dir(&dead).expect("writable");
        fs::write(dead.join(LOCK), "").expect("writable");
        fs::write(dead.join("problem.json"), "{}").expect("writable");
        // Killed before it was locked: no process has a number as large.
        fs::create_dir(root.path().join("hypercircle-4294967295-x")).expect("writable");
        // Not yet locked, somebody else's, and a link.
        let own = format!("hypercircle-{}-x", std::process::id());
        for name in ["hypercircle-young", "other-dead", &own] {
            fs::create_dir(root.path().join(name)).expect("writable");
        }
        let aside = tempfile::tempdir().expect("a folder");
        fs::write(aside.path().join(LOCK), "").expect("writable");
        std::os::unix::fs::symlink(aside.path(), root.path().join("hypercircle-link")).expect("writable");
        sweep(root.path());
        assert!(!dead.exists() && living.path().exists() && aside.path().join(LOCK).exists());
        assert!(!root.path().join("hypercircle-4294967295-x").exists());
        assert!(["hypercircle-young", "other-dead", &own].iter().all(|name| root.path().join(name).exists()));
    }

    #[test]
    fn a_folder_stays_whoever_sweeps_while_it_is_made() {
        let root = tempfile::tempdir().expect("a folder");
        let making = std::sync::atomic::AtomicUsize::new(4);
        let relaxed = std::sync::atomic::Ordering::Relaxed;
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let lost = (0..500).filter(|_| {
                        let scratch = Scratch::within(root.path()).expect("writable");
                        std::thread::sleep(Duration::from_micros(200));
                        !scratch.path().join(LOCK).exists()
                    });
                    let lost = lost.count();
                    making.fetch_sub(1, relaxed);
                    assert_eq!(lost, 0, "folders of 500 were taken away");
                });
            }
            scope.spawn(|| {
                while making.load(relaxed) > 0 {
                    sweep(root.path());
                }
            });
        });
    }

    #[test]
    fn a_place_that_cannot_be_written_to_is_an_error() {
        assert!(Scratch::within(Path::new("/nonexistent")).is_err());
    }
}
