use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::*;
use crate::primal::fixture::pressed_square;
use crate::primal::{self, PrimalSolution};

/// A program that is still open for writing cannot be started, and a fork elsewhere may hold it open.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn with_fake(script: &str, change: impl FnOnce(&mut Options)) -> (Result<Vec<PrimalSolution>, PrimalError>, Duration) {
    let _guard = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = tempfile::tempdir().unwrap();
    let fake = folder.path().join("python");
    fs::write(&fake, format!("#!/bin/sh\n{script}\n")).unwrap();
    fs::set_permissions(&fake, fs::Permissions::from_mode(0o755)).unwrap();
    let scratch = Some(folder.path().join("scratch"));
    let mut options = Options { interpreter: Some(fake), scratch, ..Options::default() };
    change(&mut options);
    let started = Instant::now();
    (primal::run(&pressed_square(), &[], &options), started.elapsed())
}

fn short(options: &mut Options) {
    options.timeout = Duration::from_millis(300);
}

#[test]
fn a_process_that_hangs_is_ended_with_all_it_started() {
    // The child of the child is in a session of its own, as a rank of MPI would be.
    let note = tempfile::NamedTempFile::new().unwrap();
    let script = format!("setsid sleep 300 & echo $! > {}\necho waiting; sleep 300", note.path().display());
    let (outcome, took) = with_fake(&script, short);
    assert!(matches!(&outcome, Err(PrimalError::TimedOut { log, .. }) if log == "waiting"), "{outcome:?}");
    assert!(took < Duration::from_secs(10), "{took:?}");
    let grandchild = fs::read_to_string(note.path()).unwrap().trim().to_owned();
    let gone = || {
        let stat = fs::read_to_string(format!("/proc/{grandchild}/stat")).unwrap_or_default();
        stat.rsplit_once(')').is_none_or(|(_, rest)| rest.trim_start().starts_with('Z'))
    };
    let patience = Instant::now();
    while !gone() && patience.elapsed() < Duration::from_secs(2) {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(gone());
}

#[test]
fn a_crash_brings_the_end_of_the_log() {
    let (outcome, _) =
        with_fake("i=0; while [ $i -lt 100 ]; do echo line $i >&2; i=$((i+1)); done; kill -SEGV $$", |_| {});
    match outcome {
        Err(PrimalError::Failed { status, log, .. }) => {
            assert_eq!(status, "ended by signal 11");
            assert_eq!(log.lines().count(), 40);
            assert!(log.starts_with("line 60\n") && log.ends_with("line 99"), "{log}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_flood_of_output_is_drained() {
    let script = "head -c 20000000 /dev/zero | tr '\\0' 'x' >&2; head -c 20000000 /dev/zero; exit 3";
    let (outcome, _) = with_fake(script, |options| options.timeout = Duration::from_secs(60));
    assert!(matches!(&outcome, Err(PrimalError::Failed { log, .. }) if log.len() < 100_000));
}

#[test]
fn exit_code_four_means_not_installed() {
    let (outcome, _) = with_fake("echo 'hypercircle-reference: not installed: no dolfinx' >&2; exit 4", |_| {});
    assert!(matches!(&outcome, Err(PrimalError::NotInstalled(reason)) if reason == "no dolfinx"), "{outcome:?}");
}

#[test]
fn missing_programs_mean_not_installed() {
    for name in ["/nonexistent/python3", "no-such-interpreter-here"] {
        let (outcome, _) = with_fake("", |options| options.interpreter = Some(PathBuf::from(name)));
        assert!(matches!(&outcome, Err(PrimalError::NotInstalled(reason)) if reason.contains(name)), "{outcome:?}");
    }
}

#[test]
fn success_without_results_is_none() {
    let (outcome, _) = with_fake("exit 0", |_| {});
    assert!(matches!(&outcome, Err(PrimalError::BadResult { file, .. }) if file == "primal-P1.json"), "{outcome:?}");
    let (outcome, _) = with_fake("echo '{\"format\": \"hypercircle-primal\"' > \"$5/primal-P1.json\"", |_| {});
    assert!(matches!(outcome, Err(PrimalError::BadResult { .. })), "{outcome:?}");
}

#[test]
fn results_of_an_earlier_run_do_not_count() {
    let (outcome, _) = with_fake("exit 0", |options| {
        let scratch = options.scratch.clone().unwrap();
        fs::create_dir(&scratch).unwrap();
        fs::write(scratch.join("primal-P1.json"), "{}").unwrap();
    });
    assert!(
        matches!(&outcome, Err(PrimalError::BadResult { reason, .. }) if reason.contains("cannot be read")),
        "{outcome:?}"
    );
}

#[test]
fn arguments_and_environment_arrive() {
    let script = "echo \"$@\" threads=$OMP_NUM_THREADS; ls \"${PYTHONPATH%%:*}\"/*; exit 3";
    let (outcome, _) = with_fake(script, |options| {
        options.degrees = vec![2];
        options.sabotage = Some(Sabotage::DropRow);
        options.nodal_contact = true;
    });
    let Err(PrimalError::Failed { status, log, .. }) = outcome else { panic!("{outcome:?}") };
    assert_eq!(status, "exit code 3");
    for part in [
        "hypercircle_reference'",
        "--degree 2",
        "--sabotage drop-row",
        "--nodal-contact",
        "threads=1",
        "solve.py",
        "hypercircle_process:",
    ] {
        assert!(log.contains(part), "{part} is missing in {log}");
    }
    assert!(!log.contains("--degree 1"));
}

#[test]
fn degrees_and_ranks_are_checked() {
    for (degrees, ranks) in [(vec![1, 10], None), (vec![0], None), (vec![], None), (vec![1], Some(0))] {
        let (outcome, _) = with_fake("", |options| (options.degrees, options.ranks) = (degrees.clone(), ranks));
        assert!(matches!(outcome, Err(PrimalError::BadOptions { .. })), "{outcome:?}");
    }
}

#[test]
fn the_package_is_carried_completely() {
    let folder = crate::in_repository("reference/hypercircle_reference");
    let mut present: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter(|name| name.ends_with(".py"))
        .collect();
    present.sort();
    assert!(present.iter().eq(PACKAGE.files.iter().map(|(name, _)| name)));
}
