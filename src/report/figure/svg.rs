//! A thin SVG writer.

use std::fmt::{self, Display, Write};

use crate::report::text::number::clean;

/// Looks by class, as attributes for where no style sheet reaches.
pub(crate) mod look {
    /// Text.
    pub const INK: &str = r##"class="ink" fill="#1f2328""##;
    /// Secondary text.
    pub const DIM: &str = r##"class="dim" fill="#59636e""##;
    /// A strong line.
    pub const LINE: &str = r##"class="line" fill="none" stroke="#1f2328""##;
    /// A line of the background.
    pub const GRID: &str = r##"class="grid" fill="none" stroke="#d1d9e0""##;
    /// Edges of the mesh.
    pub const MESH: &str = r##"class="mesh" fill="none" stroke="#8996a3" stroke-opacity="0.55""##;
    /// A support.
    pub const SUPPORT: &str = r##"class="support" fill="none" stroke="#57606a""##;
    /// A load.
    pub const LOAD: &str = r##"class="load" fill="#b35900" stroke="#b35900""##;
    /// Γ_K.
    pub const CONTACT: &str = r##"class="contact" fill="none" stroke="#cf222e""##;
    /// The bracket.
    pub const BAND: &str = r##"class="band" fill="#0072b2" fill-opacity="0.22""##;
    /// For text that lies on lines: an edge in the colour of the paper.
    pub const HALO: &str = r##"paint-order="stroke" stroke="#f6f8fa" stroke-width="4" stroke-linejoin="round""##;
    /// Marks of a contradiction.
    pub const BAD: &str = r##"class="bad" fill="#cf222e""##;
    /// Fills of the bodies, in turn.
    pub const BODIES: [&str; 6] = [
        r##"class="b0" fill="#cfe3f5""##,
        r##"class="b1" fill="#f3e3c3""##,
        r##"class="b2" fill="#d3ecd8""##,
        r##"class="b3" fill="#ecd9ee""##,
        r##"class="b4" fill="#f6d9d3""##,
        r##"class="b5" fill="#dfe2ea""##,
    ];
    /// Colours of the models in turn: class and colour (Okabe and Ito's palette).
    pub const SERIES: [(&str, &str); 6] = [
        ("s0", "#0072b2"),
        ("s1", "#d55e00"),
        ("s2", "#009e73"),
        ("s3", "#a4508b"),
        ("s4", "#9a6700"),
        ("s5", "#59636e"),
    ];
}

/// Where a text hangs on its point.
#[derive(Clone, Copy)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}

/// An SVG picture under construction, in page coordinates (y downwards).
pub(crate) struct Svg {
    pub width: f64,
    pub height: f64,
    label: String,
    body: String,
}

impl Svg {
    /// `label` is what a reader who cannot see the picture is told.
    pub fn new(width: f64, height: f64, label: impl AsRef<str>) -> Self {
        Svg { width, height, label: label.as_ref().to_string(), body: String::new() }
    }

    /// Adds markup; text in it must already be escaped.
    pub fn raw(&mut self, markup: fmt::Arguments) {
        // Writing to a String cannot fail.
        let _ = self.body.write_fmt(markup);
    }

    pub fn path(&mut self, look: &str, more: &str, d: &str) {
        if !d.is_empty() {
            self.raw(format_args!(r#"<path {look} {more} d="{d}"/>"#));
        }
    }

    pub fn line(&mut self, look: &str, more: &str, a: [f64; 2], b: [f64; 2]) {
        let (ax, ay, bx, by) = (px(a[0]), px(a[1]), px(b[0]), px(b[1]));
        self.raw(format_args!(r#"<path {look} {more} d="M{ax} {ay}L{bx} {by}"/>"#));
    }

    pub fn rect(&mut self, look: &str, x: f64, y: f64, width: f64, height: f64) {
        let (x, y, width, height) = (px(x), px(y), px(width), px(height));
        self.raw(format_args!(r#"<rect {look} x="{x}" y="{y}" width="{width}" height="{height}"/>"#));
    }

    pub fn circle(&mut self, look: &str, at: [f64; 2], radius: f64) {
        let (x, y, radius) = (px(at[0]), px(at[1]), px(radius));
        self.raw(format_args!(r#"<circle {look} cx="{x}" cy="{y}" r="{radius}"/>"#));
    }

    pub fn text(&mut self, look: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        let (x, y) = (px(at[0]), px(at[1]));
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let text = escape(text);
        self.raw(format_args!(r#"<text {look} x="{x}" y="{y}" text-anchor="{anchor}">{text}</text>"#));
    }

    /// A marker of a series: every series has its own shape.
    pub fn marker(&mut self, series: usize, at: [f64; 2], r: f64) {
        let (class, colour) = look::SERIES[series % look::SERIES.len()];
        let look = format!(r#"class="m {class}" fill="{colour}""#);
        let (x, y) = (at[0], at[1]);
        let polygon = |points: &[[f64; 2]]| {
            let mut d = String::new();
            for (i, p) in points.iter().enumerate() {
                let _ = write!(d, "{}{} {}", if i == 0 { 'M' } else { 'L' }, px(p[0]), px(p[1]));
            }
            d + "z"
        };
        match series % 5 {
            0 => self.circle(&look, at, r),
            1 => self.path(&look, "", &polygon(&[[x - r, y - r], [x + r, y - r], [x + r, y + r], [x - r, y + r]])),
            2 => self.path(&look, "", &polygon(&[[x, y - 1.3 * r], [x + 1.2 * r, y + r], [x - 1.2 * r, y + r]])),
            3 => self.path(
                &look,
                "",
                &polygon(&[[x, y - 1.4 * r], [x + 1.4 * r, y], [x, y + 1.4 * r], [x - 1.4 * r, y]]),
            ),
            _ => self.path(&look, "", &polygon(&[[x - 1.2 * r, y - r], [x + 1.2 * r, y - r], [x, y + 1.3 * r]])),
        }
    }

    /// The finished picture.
    pub fn finish(self) -> String {
        let Svg { width, height, label, body } = self;
        let (width, height, label) = (px(width), px(height), escape(&label));
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" aria-label="{label}" font-family="system-ui, sans-serif" font-size="13"><title>{label}</title>{body}</svg>"#
        )
    }
}

/// User text made safe for XML.
pub(crate) fn escape(text: &str) -> String {
    quick_xml::escape::escape(clean(text)).into_owned()
}

/// A page coordinate to a tenth of a pixel; one that is no number is put at the origin rather than into the file.
pub(crate) fn px(x: f64) -> impl Display {
    let rounded = (x.clamp(-1e5, 1e5) * 10.0).round() / 10.0;
    // Adding zero turns −0 into 0.
    if rounded.is_finite() { rounded + 0.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_finite() {
        assert_eq!(px(12.3456).to_string(), "12.3");
        assert_eq!(px(-0.01).to_string(), "0");
        assert_eq!(px(f64::NAN).to_string(), "0");
        assert_eq!(px(f64::INFINITY).to_string(), "100000");
    }

    #[test]
    fn labels_and_texts_are_escaped() {
        let mut svg = Svg::new(10.0, 10.0, "<a&b>\"\u{1}");
        svg.text(look::INK, [1.0, 2.0], Anchor::End, "</text><script>");
        let text = svg.finish();
        crate::report::sample::assert_well_formed(&text);
        assert!(!text.contains("<script>") && text.contains("&lt;a&amp;b&gt;"));
    }
}
