//! A sign of life for runs of more than two seconds, on a terminal only, and remarks that cannot wait for the report.

use std::io::{IsTerminal, Write, stderr};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Runs shorter than this show nothing.
const PATIENCE: Duration = Duration::from_secs(2);

/// What a run is doing, shown after two seconds.
pub struct Progress {
    bar: ProgressBar,
    quiet: bool,
}

impl Progress {
    /// Starts silently; `quiet` keeps it silent.
    pub fn new(quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        if !quiet && stderr().is_terminal() {
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
        Progress { bar, quiet }
    }

    /// Names the present phase.
    pub fn phase(&self, what: impl Into<std::borrow::Cow<'static, str>>) {
        self.bar.set_message(what);
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
            // Nobody need be listening.
            self.bar.suspend(|| writeln!(stderr(), "{what}")).unwrap_or_default();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
