//! A sign of life for runs of more than two seconds, on a terminal only, and remarks that cannot wait for the report.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::measure::Step;
use crate::process::stop_if_unwanted;

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// Off a terminal, one line after so long, and another one each time it has gone by: those who read a log see that
/// something happens, and services that end what is silent do not end it.
const SILENCE: Duration = Duration::from_secs(30);

/// Display of the phase of a run: on a terminal shown after two seconds, elsewhere in a line every half minute.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
    began: Instant,
    /// Off a terminal, the phase to tell.
    told: Option<Arc<Mutex<String>>>,
}

impl Progress {
    /// Starts silently; `quiet` keeps it silent.
    pub fn new(quiet: bool) -> Self {
        let (bar, began) = (ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()), Instant::now());
        let mut told = None;
        if !quiet && !stderr().is_terminal() {
            let phase = told.insert(Arc::new(Mutex::new("working".to_string())));
            let late = Arc::downgrade(phase);
            let _ = std::thread::Builder::new().spawn(move || {
                loop {
                    std::thread::sleep(SILENCE);
                    let Some(phase) = late.upgrade() else { break };
                    let phase = phase.lock().unwrap_or_else(PoisonError::into_inner).clone();
                    let _ = writeln!(stderr(), "{phase} ({} after the start)", time(began.elapsed()));
                }
            });
        } else if !quiet {
            let style = ProgressStyle::with_template("{spinner} {msg} ({elapsed})");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            let late = bar.downgrade();
            // Without the thread nothing is shown, and nothing else is lost.
            let _ = std::thread::Builder::new().spawn(move || {
                std::thread::sleep(PATIENCE);
                if let Some(bar) = late.upgrade().filter(|b| !b.is_finished()) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(Duration::from_millis(120));
                }
            });
        }
        Progress { bar, quiet, began, told }
    }

    /// Names the present phase. One that nobody wants any more does not begin.
    pub fn phase(&self, what: impl Into<std::borrow::Cow<'static, str>>) {
        stop_if_unwanted();
        let what = what.into();
        if let Some(told) = &self.told {
            *told.lock().unwrap_or_else(PoisonError::into_inner) = what.to_string();
        }
        self.bar.set_message(what);
    }

    /// Names a run of many, with the time that those behind it let expect for the others.
    pub fn step(&self, Step { what, done, left }: Step) {
        let expected = self.began.elapsed().checked_div(u32::try_from(done).unwrap_or(u32::MAX));
        let expected = expected.and_then(|each| each.checked_mul(u32::try_from(left).unwrap_or(u32::MAX)));
        let runs = if left == 1 { "run" } else { "runs" };
        self.phase(match expected {
            Some(expected) => format!("{what}; {left} {runs} left, about {} at this pace", time(expected)),
            None => format!("{what}; {left} {runs} left at most"),
        });
    }

    /// Prints a line on standard output.
    pub fn line(&self, text: &str) {
        if !self.quiet {
            self.bar.suspend(|| super::say::line(text));
        }
    }

    /// Says at once, as a line of its own, what whoever waits should know.
    pub fn remark(&self, what: &str) {
        if !self.quiet {
            self.warn(what);
        }
    }

    /// Says, also where silence is asked for, that something is missing which was asked for too.
    pub fn warn(&self, what: &str) {
        // Nobody need be listening.
        self.bar.suspend(|| writeln!(stderr(), "{what}")).unwrap_or_default();
    }
}

/// A time as people say it.
fn time(duration: Duration) -> String {
    match duration.as_secs() {
        seconds @ 0..120 => format!("{seconds} s"),
        seconds @ 120..7200 => format!("{} min", seconds.div_ceil(60)),
        seconds => format!("{:.1} h", seconds as f64 / 3600.0),
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_of_many_is_told_with_what_is_left() {
        let mut progress = Progress::new(true);
        progress.told = Some(Arc::default());
        let told = |progress: &Progress| progress.told.as_ref().map(|told| told.lock().expect("free").clone());
        progress.step(Step { what: "a".to_string(), done: 0, left: 3 });
        assert_eq!(told(&progress).as_deref(), Some("a; 3 runs left at most"));
        progress.began -= Duration::from_secs(60);
        progress.step(Step { what: "b".to_string(), done: 2, left: 1 });
        assert_eq!(told(&progress).as_deref(), Some("b; 1 run left, about 30 s at this pace"));
    }

    #[test]
    fn times_are_said_in_what_people_count_in() {
        assert_eq!([7, 121, 9000].map(|s| time(Duration::from_secs(s))), ["7 s", "3 min", "2.5 h"]);
    }
}
