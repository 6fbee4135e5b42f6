//! Errors on stderr: drawn with the lines they concern, plain where nobody watches.

use std::fmt;
use std::io::{IsTerminal, Write};

use miette::{Diagnostic, GraphicalReportHandler, GraphicalTheme, MietteHandler, MietteHandlerOpts, ReportHandler};

use crate::cli::Exit;

/// Columns of a report that no terminal limits; lines are not wrapped there, so that they can be searched.
const UNLIMITED: usize = 10_000;

/// Words of the standard library where the system refuses a thread, and those of a thread that it refuses what it starts with.
const NO_THREAD: &str = "failed to spawn thread";
const NO_STACK: &str = "failed to allocate an alternative stack";

/// Draws the error on stderr.
pub fn error(error: &dyn Diagnostic) {
    let handler = if std::io::stderr().is_terminal() { Handler::terminal() } else { Handler::plain() };
    // A closed stderr leaves no way to say so.
    let _ = writeln!(std::io::stderr(), "{}", Drawn { error, handler }.to_string().trim_end());
}

enum Handler {
    Terminal(Box<MietteHandler>),
    Plain(Box<GraphicalReportHandler>),
}

impl Handler {
    fn terminal() -> Self {
        Handler::Terminal(Box::new(MietteHandlerOpts::new().context_lines(2).build()))
    }

    fn plain() -> Self {
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::none());
        let handler = handler.with_links(false).with_wrap_lines(false).with_width(UNLIMITED).with_context_lines(2);
        Handler::Plain(Box::new(handler.without_cause_chain()))
    }
}

struct Drawn<'a> {
    error: &'a dyn Diagnostic,
    handler: Handler,
}

impl fmt::Display for Drawn<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.handler {
            Handler::Terminal(handler) => handler.debug(self.error, f),
            Handler::Plain(handler) => handler.debug(self.error, f),
        }
    }
}

/// Replaces the text of a panic, which is always a defect of the program, by a request to report it. With
/// `RUST_BACKTRACE` set the usual text follows.
pub fn install_panic_message() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        let place = panic.location().map_or_else(|| "an unknown place".to_owned(), ToString::to_string);
        let payload = panic.payload();
        let text = payload.downcast_ref::<&str>().copied();
        let what = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str)).unwrap_or("no message");
        if [NO_THREAD, NO_STACK].iter().any(|refusal| what.contains(refusal)) {
            let _ = writeln!(
                std::io::stderr(),
                "  x a thread could not be started ({what})\n  help: allow more threads or memory (ulimit -u, ulimit -v)"
            );
            if what.contains(NO_STACK) {
                // Such a thread has not begun, others would wait for it, and there may be no memory to unwind it.
                std::process::exit(Exit::Failed as i32);
            }
            return;
        }
        let version = env!("CARGO_PKG_VERSION");
        let _ = writeln!(
            std::io::stderr(),
            "hypercircle {version} stopped at an internal error ({place}: {what}).\n\
             This is a defect of the program and there is no result. Please report it with the scene and this message."
        );
        if std::env::var_os("RUST_BACKTRACE").is_some_and(|value| value != "0") {
            usual(panic);
        }
    }));
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{Drawn, Handler};
    use crate::cli::CliError;
    use crate::scene::Scene;

    #[test]
    fn a_scene_error_is_drawn_once_with_place_and_remedy() {
        let text = format!("title = \"{}\"\n[model]\nkinematic = \"plane-strain\"\n", "long ".repeat(60));
        let error = CliError::from(Scene::parse(&text, Path::new("folder/bad.toml")).expect_err("a wrong key"));
        let drawn = Drawn { error: &error, handler: Handler::plain() }.to_string();
        for piece in ["folder/bad.toml:3:1", "did you mean `kinematics`?", "kinematic = "] {
            assert_eq!(drawn.matches(piece).count(), 1, "{piece} in\n{drawn}");
        }
        assert!(!drawn.contains('\u{1b}'), "no colours without a terminal:\n{drawn}");
    }

    #[test]
    fn a_line_of_any_length_is_cut_around_the_place() {
        let points = "[0.0, 0.0], ".repeat(20_000);
        for (head, place) in [("", "bad.toml:5:"), ("typo = 1\n", "bad.toml:1:1]")] {
            let text = format!(
                "{head}[model]\nkinematics = \"plane-strain\"\n[[geometry.polygons]]\nbody = \"é\"\npoints = [{points}]\n\
                 edges = []\n[bodies.\"é\"]\nyoung = 1\npoisson = 0\n"
            );
            let error = CliError::from(Scene::parse(&text, Path::new("bad.toml")).expect_err("repeated corners"));
            let drawn = Drawn { error: &error, handler: Handler::plain() }.to_string();
            assert!(drawn.contains(place) && drawn.contains("help: "), "{drawn}");
            assert!(drawn.len() < 1500, "{} bytes", drawn.len());
        }
    }
}
