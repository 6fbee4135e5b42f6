//! An HTML page that stands alone: no script, nothing loaded.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Tables and figures on white ground.
pub(crate) const PLAIN: &str = "body{margin:0 auto;max-width:1120px;padding:24px;font:16px/1.5 system-ui,sans-serif;color:#1f2328;background:#fff}\
h1{font-size:1.6rem}h2{margin-top:2.2em;border-bottom:1px solid #d1d9e0}table{border-collapse:collapse;font-size:.88rem;font-variant-numeric:tabular-nums;margin:12px 0}\
th,td{padding:4px 10px 4px 0;border-bottom:1px solid #d1d9e0;text-align:left;vertical-align:top}td.n,th.n{text-align:right;white-space:nowrap}\
figure{margin:18px 0}figure svg{max-width:100%;height:auto}figcaption{color:#59636e;font-size:.92rem;max-width:80ch}p{max-width:80ch}.dim{color:#59636e}\
.scroll{overflow-x:auto}.mark{font-weight:700}code{font:.9em ui-monospace,monospace}";

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
