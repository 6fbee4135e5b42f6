//! Stacked horizontal bars, each part with its own shade and hatching.

use plotters::prelude::*;

use super::{PlotError, accessible};
use crate::report::text::number::seconds;

/// One bar.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// Text on its left.
    pub label: String,
    /// Index into the names of the parts, and size.
    pub parts: Vec<(usize, f64)>,
}

const FONT: &str = "sans-serif";
const LEFT: i32 = 210;
const ROW: i32 = 34;
const BAR: i32 = 20;

/// Fill and hatching of part `i`: spacing of vertical and horizontal lines, 0 for none.
fn shade(i: usize) -> (RGBColor, i32, i32) {
    const SHADES: [(RGBColor, i32, i32); 12] = [
        (RGBColor(255, 255, 255), 0, 0),
        (RGBColor(221, 221, 221), 0, 0),
        (RGBColor(153, 153, 153), 0, 0),
        (RGBColor(240, 228, 66), 4, 0),
        (RGBColor(230, 159, 0), 0, 0),
        (RGBColor(86, 180, 233), 0, 4),
        (RGBColor(0, 114, 178), 0, 0),
        (RGBColor(213, 94, 0), 6, 6),
        (RGBColor(0, 158, 115), 0, 6),
        (RGBColor(204, 121, 167), 6, 0),
        (RGBColor(60, 60, 60), 0, 0),
        (RGBColor(250, 250, 250), 3, 3),
    ];
    SHADES[i % SHADES.len()]
}

/// The figure as SVG; lengths are seconds.
///
/// # Errors
/// [`PlotError`] with what the drawing library reported.
pub fn bars(title: &str, parts: &[String], bars: &[Bar], width: u32) -> Result<String, PlotError> {
    let legend_rows = parts.len().div_ceil(5) as i32;
    let height = 50 + ROW * bars.len() as i32 + 26 * legend_rows + 16;
    let total = |bar: &Bar| bar.parts.iter().map(|p| p.1.max(0.0)).sum::<f64>();
    let longest = bars.iter().map(total).fold(f64::MIN_POSITIVE, f64::max);
    let room = width as i32 - LEFT - 90;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (width, height as u32)).into_drawing_area();
        root.fill(&WHITE)?;
        let text =
            |s: &str, at: (i32, i32), size: i32| Text::new(s.to_string(), at, (FONT, size).into_font().color(&BLACK));
        root.draw(&text(title, (12, 12), 17))?;
        for (i, bar) in bars.iter().enumerate() {
            let top = 46 + ROW * i as i32;
            root.draw(&text(&bar.label, (12, top + 4), 13))?;
            let mut done = 0.0;
            for (part, value) in &bar.parts {
                let x = |v: f64| LEFT + (v / longest * f64::from(room)).round() as i32;
                let (from, to) = (x(done), x(done + value.max(0.0)));
                done += value.max(0.0);
                if to > from {
                    patch(&root, *part, [from, top, to, top + BAR])?;
                }
            }
            let end = LEFT + (done / longest * f64::from(room)).round() as i32;
            root.draw(&text(&seconds(done), (end + 6, top + 4), 13))?;
        }
        let first = 46 + ROW * bars.len() as i32 + 8;
        let column = (width as i32 - 24) / 5;
        for (i, name) in parts.iter().enumerate() {
            let (x, y) = (12 + column * (i as i32 % 5), first + 26 * (i as i32 / 5));
            patch(&root, i, [x, y, x + 22, y + 14])?;
            root.draw(&text(name, (x + 28, y + 1), 12))?;
        }
        root.present()?;
    }
    Ok(accessible(&svg, title))
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn patch(area: &Area<'_>, part: usize, [x0, y0, x1, y1]: [i32; 4]) -> Result<(), PlotError> {
    let (colour, vertical, horizontal) = shade(part);
    area.draw(&Rectangle::new([(x0, y0), (x1, y1)], colour.filled()))?;
    let line = BLACK.stroke_width(1);
    if vertical > 0 {
        for x in (x0..x1).step_by(vertical as usize) {
            area.draw(&PathElement::new(vec![(x, y0), (x, y1)], line))?;
        }
    }
    if horizontal > 0 {
        for y in (y0..y1).step_by(horizontal as usize) {
            area.draw(&PathElement::new(vec![(x0, y), (x1, y)], line))?;
        }
    }
    area.draw(&Rectangle::new([(x0, y0), (x1, y1)], line))?;
    Ok(())
}
