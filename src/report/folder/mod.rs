//! How a folder of results changes from one run's files to the next one's: at once, and by one run at a time.
//!
//! The new files are written into a folder beside the old one, and the two folders change places in one step of the file
//! system. A reader, or whoever looks after a power failure, finds the files of one run. That is for folders that hold
//! nothing else. Where other files live in the folder, where it is the current one of this process, or where the file
//! system cannot exchange, the folder stays what it is and its files are replaced one by one; every file of a report names
//! its run, so that a mixture can be told (see [`super::run_of`]).
//!
//! Two runs take turns: each locks the folder and the one around it while it writes. The lock belongs to the process and
//! ends with it. What a killed run left half written is removed by the next one, under the same lock.
pub(super) mod run;
pub(super) mod stored;
pub(super) mod write;

use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io::{self, Read, Write};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use rustix::fs::{Access, CWD, FlockOperation, RenameFlags, access, flock, renameat_with};
use tempfile::TempDir;

use super::ReportError;
use crate::process::signals;

/// Begins the names of what is half written.
const UNFINISHED: &str = ".hypercircle-";
/// How long another run may write before this one gives up.
const PATIENCE: Duration = Duration::from_secs(30);
const POLL: Duration = Duration::from_millis(10);

/// Name and content of a file.
pub type NamedFile<'a> = (&'a str, Vec<u8>);

/// A file that one run leaves and the next may not.
#[derive(Debug, Clone, Copy)]
pub struct Passing<'a> {
    /// Its name.
    pub name: &'a str,
    /// How it begins: a file of the user's that has the name begins otherwise, and stays.
    pub begins: &'a [u8],
}

impl Passing<'_> {
    fn is_in(&self, dir: &Path) -> bool {
        let path = dir.join(self.name);
        let mut start = vec![0; self.begins.len()];
        fs::symlink_metadata(&path).is_ok_and(|m| m.is_file())
            && File::open(&path).and_then(|mut file| file.read_exact(&mut start)).is_ok()
            && start == self.begins
    }
}

/// Puts `files` into `dir`, which is made if need be, in the place of those of the same names. Of the `passing` ones those go
/// that are not among `files`.
///
/// # Errors
/// [`ReportError`]; the files of the run before are then still there.
pub fn replace(dir: &Path, files: &[NamedFile], passing: &[Passing]) -> Result<(), ReportError> {
    replace_within(dir, files, passing, PATIENCE)
}

fn replace_within(dir: &Path, files: &[NamedFile], passing: &[Passing], patience: Duration) -> Result<(), ReportError> {
    refuse(dir, files.iter().map(|(name, _)| *name))?;
    let create = |source| ReportError::Create { path: dir.to_path_buf(), source };
    let place = Place::of(dir).map_err(create)?;
    let since = Instant::now();
    let _around = lock(place.parent.as_deref(), since, patience, dir)?;
    // Made here if it is missing, by a run that went before otherwise.
    let exists = place.dir.is_dir();
    let _inside = lock(exists.then_some(place.dir.as_path()), since, patience, dir)?;
    let _unbroken = signals::unbroken();
    if let Some(parent) = &place.parent {
        sweep(parent);
    }
    if exists && !place.is_exchangeable(files, passing) {
        sweep(&place.dir);
        return one_by_one(&place.dir, files, passing);
    }
    let Some(parent) = &place.parent else { return one_by_one(&place.dir, files, passing) };
    let staging = match Staging::new(parent, files) {
        Ok(staging) => staging,
        // The folder may be open to us and the one around it not.
        Err(_) if exists => return one_by_one(&place.dir, files, passing),
        Err(source) => return Err(create(source)),
    };
    match staging.publish(&place.dir, exists) {
        Ok(()) => {
            let _ = File::open(parent).and_then(|f| f.sync_all());
            Ok(())
        }
        Err(_) if exists => one_by_one(&place.dir, files, passing),
        Err(source) => Err(create(source)),
    }
}

/// Waits for a run that is writing into `dir` now, so that one that does not end is known before there is anything to write.
///
/// # Errors
/// [`ReportError::Busy`].
pub fn wait(dir: &Path) -> Result<(), ReportError> {
    wait_within(dir, PATIENCE)
}

fn wait_within(dir: &Path, patience: Duration) -> Result<(), ReportError> {
    let since = Instant::now();
    // By one name each: a folder locked twice would wait for itself.
    let inside = dir.canonicalize().ok();
    let around = inside.as_deref().unwrap_or(dir).parent();
    let _around = lock(around, since, patience, dir)?;
    lock(inside.as_deref(), since, patience, dir).map(drop)
}

/// Refuses a path at which no file can be written, before there is anything to write.
///
/// # Errors
/// A folder has its name, or the one it would be in is missing or not writable.
pub fn refuse_file(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    Ok(access(around(path), Access::WRITE_OK | Access::EXEC_OK)?)
}

/// The folder that a file is in.
fn around(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Puts `bytes` in the place of the file `path`, which keeps its mode, in one step and under the lock of its folder.
///
/// # Errors
/// It cannot be written; what was there is then still there.
pub fn replace_file(path: &Path, bytes: Vec<u8>) -> io::Result<()> {
    refuse_file(path)?;
    let folder = around(path);
    let _alone = lock(Some(folder), Instant::now(), PATIENCE, folder).map_err(io::Error::other)?;
    let _unbroken = signals::unbroken();
    sweep(folder);
    let staging = Staging::new(folder, &[("file", bytes)])?;
    let new = staging.0.path().join("file");
    if let Ok(present) = fs::metadata(path) {
        fs::set_permissions(&new, present.permissions())?;
    }
    fs::rename(new, path)
}

/// Refuses a folder that cannot take `names`, before there is anything to write.
///
/// # Errors
/// [`ReportError`] when something else has the name of the folder or of a file, or the folder is not writable.
pub fn refuse<'a>(dir: &Path, names: impl IntoIterator<Item = &'a str>) -> Result<(), ReportError> {
    let existing = dir.ancestors().find(|folder| folder.symlink_metadata().is_ok());
    let existing = existing.filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !existing.is_dir() {
        return Err(ReportError::NotAFolder { path: existing.to_path_buf() });
    }
    // Folders of the system allow it, and refuse it when it is tried. A folder that is there may be exchanged by another run meanwhile.
    let tried = || match existing == dir {
        true => Ok(()),
        false => tempfile::Builder::new().prefix(UNFINISHED).tempdir_in(existing).map(drop),
    };
    if let Err(source) =
        access(existing, Access::WRITE_OK | Access::EXEC_OK).map_err(io::Error::from).and_then(|()| tried())
    {
        return Err(ReportError::Create { path: dir.to_path_buf(), source });
    }
    for path in names.into_iter().map(|name| dir.join(name)) {
        if path.is_dir() {
            return Err(ReportError::Write { path, source: io::ErrorKind::IsADirectory.into() });
        }
    }
    Ok(())
}

/// A folder without links in its path, and the one around it.
struct Place {
    dir: PathBuf,
    parent: Option<PathBuf>,
}

impl Place {
    fn of(dir: &Path) -> io::Result<Self> {
        let dir = match dir.canonicalize() {
            Ok(dir) => dir,
            Err(_) => {
                let parent = around(dir);
                fs::create_dir_all(parent)?;
                let name = dir.file_name().ok_or(io::ErrorKind::NotFound)?;
                parent.canonicalize()?.join(name)
            }
        };
        let parent = dir.parent().map(Path::to_path_buf);
        Ok(Place { dir, parent })
    }

    /// True if the folder is this program's alone: it holds nothing but `files` and leftovers, belongs to this user, and
    /// the working directory of this process is not in it.
    fn is_exchangeable(&self, files: &[NamedFile], passing: &[Passing]) -> bool {
        let went = |name: &OsStr| passing.iter().any(|own| name == own.name && own.is_in(&self.dir));
        let ours = |name: &OsStr| files.iter().any(|(own, _)| name == *own) || is_unfinished(name) || went(name);
        let alone = fs::read_dir(&self.dir)
            .is_ok_and(|mut entries| entries.all(|entry| entry.is_ok_and(|entry| ours(&entry.file_name()))));
        let own = fs::metadata(&self.dir).is_ok_and(|m| m.uid() == rustix::process::geteuid().as_raw());
        let elsewhere =
            std::env::current_dir().and_then(|here| here.canonicalize()).is_ok_and(|here| !here.starts_with(&self.dir));
        alone && own && elsewhere
    }
}

fn is_unfinished(name: &OsStr) -> bool {
    name.to_string_lossy().starts_with(UNFINISHED)
}

/// A folder of new files, removed with this value unless they were published.
struct Staging(TempDir);

impl Staging {
    fn new(parent: &Path, files: &[NamedFile]) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        // Temporary folders are private by default; a report is for everybody the umask allows.
        let folder = builder.prefix(UNFINISHED).permissions(Permissions::from_mode(0o777)).tempdir_in(parent)?;
        for (name, bytes) in files {
            let mut file = File::create_new(folder.path().join(name))?;
            file.write_all(bytes)?;
            file.sync_all()?;
        }
        File::open(folder.path())?.sync_all()?;
        Ok(Staging(folder))
    }

    /// Gives the folder the name `dir`; what had it is removed.
    fn publish(self, dir: &Path, exists: bool) -> io::Result<()> {
        let new = self.0.path();
        if exists {
            fs::set_permissions(new, fs::metadata(dir)?.permissions())?;
            // The value now stands for the old folder.
            return Ok(renameat_with(CWD, new, CWD, dir, RenameFlags::EXCHANGE)?);
        }
        fs::rename(new, dir)?;
        let _ = self.0.keep();
        Ok(())
    }
}

/// Replaces the files of a folder that others use, too.
fn one_by_one(dir: &Path, files: &[NamedFile], passing: &[Passing]) -> Result<(), ReportError> {
    let failed = |name: &str, source| ReportError::Write { path: dir.join(name), source };
    let staging = Staging::new(dir, files).map_err(|e| failed(files.first().map_or("", |f| f.0), e))?;
    for (name, _) in files {
        fs::rename(staging.0.path().join(name), dir.join(name)).map_err(|e| failed(name, e))?;
    }
    for old in passing.iter().filter(|old| files.iter().all(|(name, _)| *name != old.name) && old.is_in(dir)) {
        fs::remove_file(dir.join(old.name)).map_err(|e| failed(old.name, e))?;
    }
    let _ = File::open(dir).and_then(|f| f.sync_all());
    Ok(())
}

/// Removes what killed runs left; the folder must be locked.
fn sweep(dir: &Path) {
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        if is_unfinished(&entry.file_name()) {
            let folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            let _ = if folder { fs::remove_dir_all(entry.path()) } else { fs::remove_file(entry.path()) };
        }
    }
}

/// Locks a folder, or nothing where the file system has no locks; the kernel unlocks it when this process ends.
fn lock(folder: Option<&Path>, since: Instant, patience: Duration, dir: &Path) -> Result<Option<File>, ReportError> {
    let Some(file) = folder.and_then(|f| File::open(f).ok()) else { return Ok(None) };
    loop {
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Ok(()) => return Ok(Some(file)),
            Err(rustix::io::Errno::WOULDBLOCK) if since.elapsed() < patience => std::thread::sleep(POLL),
            Err(rustix::io::Errno::WOULDBLOCK) => return Err(ReportError::Busy { path: dir.to_path_buf() }),
            Err(rustix::io::Errno::INTR) => {}
            Err(_) => return Ok(None),
        }
    }
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
