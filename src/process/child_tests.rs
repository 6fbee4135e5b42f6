use super::*;

fn shell(script: &str, limit: Duration) -> (Ended, Duration) {
    let started = Instant::now();
    let ended = supervise(Command::new("/bin/sh").args(["-c", script]), limit).expect("a shell");
    (ended, started.elapsed())
}

const LONG: Duration = Duration::from_secs(60);
const SHORT: Duration = Duration::from_millis(200);

fn alive(process: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    stat.rsplit_once(')').is_some_and(|(_, rest)| !rest.trim_start().starts_with('Z'))
}

#[track_caller]
fn assert_gone(process: u32) {
    let patience = Instant::now();
    while alive(process) && patience.elapsed() < GRACE {
        thread::sleep(POLL);
    }
    assert!(!alive(process), "process {process} lives");
}

#[test]
fn a_process_that_hangs_is_ended() {
    let (ended, took) = shell("echo waiting; sleep 60", SHORT);
    assert!(matches!(ended.outcome, Outcome::TimedOut), "{ended:?}");
    assert_eq!(ended.log, ["waiting"]);
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn a_process_that_ignores_requests_is_forced() {
    let (ended, took) = shell("trap '' TERM INT HUP; while :; do sleep 1; done", SHORT);
    assert!(matches!(ended.outcome, Outcome::TimedOut), "{ended:?}");
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn what_a_process_leaves_running_ends_with_it() {
    let (ended, took) = shell("sleep 60 & echo $!", LONG);
    assert!(matches!(ended.outcome, Outcome::Exit(status) if status.success()), "{ended:?}");
    assert!(took < Duration::from_secs(10), "{took:?}");
    assert_gone(ended.log[0].parse().expect("a number"));
}

#[test]
fn a_survivor_in_another_session_does_not_hold_the_pipes() {
    let (ended, took) = shell("setsid sleep 20 & echo $!; exit 3", LONG);
    assert!(matches!(ended.outcome, Outcome::Exit(status) if status.code() == Some(3)), "{ended:?}");
    assert!(took < Duration::from_secs(10), "{took:?}");
}

#[test]
fn a_flood_of_lines_costs_no_memory() {
    let (ended, _) = shell("yes | head -c 300000000 >&2; echo done >&2", Duration::from_secs(300));
    assert!(matches!(ended.outcome, Outcome::Exit(status) if status.success()), "{ended:?}");
    assert_eq!(ended.log.last().map(String::as_str), Some("done"));
    assert!(ended.log.len() <= 40);
}

#[test]
fn a_program_that_is_missing_is_an_error() {
    assert!(supervise(&mut Command::new("/nonexistent/program"), LONG).is_err());
}
