//! The verdict of a job as a badge: data for an endpoint of shields.io, and a picture for those who have none.

use crate::report::figure::escape;

use super::data::Job;

const LABEL: &str = "hypercircle";
/// Width of a character of the font, on average and on the safe side.
const WIDTH: usize = 7;

fn colour(job: &Job) -> &'static str {
    match job.exit {
        0 => "#1a7f37",
        1 => "#cf222e",
        _ => "#9a6700",
    }
}

/// `47 of 50 agree`.
fn message(job: &Job) -> String {
    let word = if job.compares() { "agree" } else { "passed" };
    format!("{} of {} {word}", job.counts.agree, job.counts.scenes)
}

/// `badge.json`.
pub(super) fn json(job: &Job) -> String {
    let badge = serde_json::json!({
        "schemaVersion": 1,
        "label": LABEL,
        "message": message(job),
        "color": colour(job),
        "isError": job.exit > 1,
    });
    format!("{badge:#}\n")
}

/// `badge.svg`.
pub(super) fn svg(job: &Job) -> String {
    let message = message(job);
    let [left, right] = [LABEL.len(), message.chars().count()].map(|n| n * WIDTH + 12);
    let all = left + right;
    let text = |x: usize, words: &str| format!("<text x=\"{x}\" y=\"14\">{}</text>", escape(words));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{all}\" height=\"20\" role=\"img\" aria-label=\"{LABEL}: {label}\">\n\
         <clipPath id=\"r\"><rect width=\"{all}\" height=\"20\" rx=\"3\"/></clipPath>\n\
         <g clip-path=\"url(#r)\"><rect width=\"{left}\" height=\"20\" fill=\"#3b424a\"/>\
         <rect x=\"{left}\" width=\"{right}\" height=\"20\" fill=\"{}\"/></g>\n\
         <g fill=\"#fff\" text-anchor=\"middle\" font-family=\"Verdana,DejaVu Sans,sans-serif\" font-size=\"11\">{}{}</g>\n</svg>\n",
        colour(job),
        text(left / 2, LABEL),
        text(left + right / 2, &message),
        label = escape(&message),
    )
}
