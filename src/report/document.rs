//! An HTML page that stands alone: nothing loaded.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// For figures that are drawn on white, whatever the page is.
pub(crate) const PLOTS: &str = ".plot{background:#fff;margin:18px 0}.plot svg{max-width:1000px}.mark{font-weight:700}";

/// The page with the given body and style sheets; `run` identifies the run that it shows.
pub(crate) fn document(title: &str, styles: &[&str], run: Option<&str>, body: Markup) -> String {
    let page: Markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                @if let Some(run) = run { meta name="run" content=(run); }
                title { (title) }
                style { @for style in styles { (PreEscaped(style)) } }
            }
            body { (body) }
        }
    };
    page.into_string()
}
