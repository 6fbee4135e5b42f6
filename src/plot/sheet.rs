//! Curves on one pair of axes, with a legend beside them.

use plotters::prelude::*;

use super::{Ink, PlotError, Scale, accessible};

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Text in the legend.
    pub label: String,
    /// Which ink, see [`Ink::of`].
    pub ink: usize,
    /// Thin line and hollow markers: the second quantity of a method.
    pub secondary: bool,
    /// Points in the order of the line; those that an axis has no place for are left out.
    pub points: Vec<[f64; 2]>,
    /// Least and most x at each point, where they were measured.
    pub spread: Vec<[f64; 2]>,
    /// Least and most that y can be at each point, where it is not known exactly; a least of zero reaches to the axis.
    pub open: Vec<[f64; 2]>,
}

/// A figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Heading.
    pub title: String,
    /// Labels of x and y.
    pub labels: [String; 2],
    /// How x is placed; y is logarithmic.
    pub x: Scale,
    /// The curves.
    pub series: Vec<Series>,
    /// A front of points that no other beats, drawn as steps below everything else.
    pub front: Vec<[f64; 2]>,
    /// A horizontal line with its text.
    pub level: Option<(f64, String)>,
    /// Lines below the legend.
    pub notes: Vec<String>,
    /// Width and least height in pixels; the height grows with the legend.
    pub size: [u32; 2],
}

impl Sheet {
    /// The height in pixels that holds the whole legend.
    fn height(&self, front: bool, level: bool) -> u32 {
        let rows = self.series.len() + usize::from(front) + usize::from(level);
        self.size[1].max((TOP + ROW * rows as i32 + NOTE * self.notes.len() as i32).unsigned_abs())
    }
}

const LEGEND: u32 = 260;
/// The first row of a legend, and the distances of rows and of notes, in pixels.
const TOP: i32 = 44;
const ROW: i32 = 22;
const NOTE: i32 = 18;
const FONT: &str = "sans-serif";
const GREY: RGBColor = RGBColor(105, 105, 105);

/// The figure as SVG.
///
/// # Errors
/// [`PlotError`] with what the drawing library reported.
pub fn draw(sheet: &Sheet) -> Result<String, PlotError> {
    let y = Scale::Logarithmic;
    let place = |p: &[f64; 2]| Some((sheet.x.position(p[0])?, y.position(p[1])?));
    let placed: Vec<Vec<(f64, f64)>> =
        sheet.series.iter().map(|s| s.points.iter().filter_map(place).collect()).collect();
    let front: Vec<(f64, f64)> = sheet.front.iter().filter_map(place).collect();
    let level = sheet.level.as_ref().and_then(|(value, text)| Some((y.position(*value)?, text)));
    let all = || placed.iter().flatten();
    let most = sheet.series.iter().flat_map(|s| &s.open).filter_map(|[_, most]| y.position(*most));
    let x_axis = sheet.x.axis(all().map(|p| p.0));
    let y_axis = y.axis(all().map(|p| p.1).chain(level.map(|l| l.0)).chain(most));
    let height = sheet.height(!front.is_empty(), level.is_some());
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (sheet.size[0], height)).into_drawing_area();
        root.fill(&WHITE)?;
        let (left, right) = root.split_horizontally(sheet.size[0].saturating_sub(LEGEND));
        let mut chart = ChartBuilder::on(&left)
            .caption(&sheet.title, (FONT, 17))
            .margin(10)
            .x_label_area_size(46)
            .y_label_area_size(70)
            .build_cartesian_2d(x_axis.clone(), y_axis.clone())?;
        chart
            .configure_mesh()
            .x_desc(&sheet.labels[0])
            .y_desc(&sheet.labels[1])
            .axis_desc_style((FONT, 14))
            .label_style((FONT, 12))
            .bold_line_style(RGBColor(214, 214, 214))
            .light_line_style(TRANSPARENT)
            .draw()?;
        if !front.is_empty() {
            let mut steps = vec![(front[0].0, y_axis.range[1])];
            for (i, p) in front.iter().enumerate() {
                steps.push(*p);
                let next = front.get(i + 1).map_or(x_axis.range[1], |n| n.0);
                steps.push((next, p.1));
            }
            chart.draw_series([PathElement::new(steps, RGBColor(200, 200, 200).stroke_width(7))])?;
        }
        if let Some((value, _)) = level {
            let ends = vec![(x_axis.range[0], value), (x_axis.range[1], value)];
            chart.draw_series(DashedLineSeries::new(ends, 2, 3, GREY.stroke_width(1)))?;
        }
        for (series, points) in sheet.series.iter().zip(&placed) {
            let ink = Ink::of(series.ink);
            let style = ink.colour.stroke_width(if series.secondary { 1 } else { 2 });
            match ink.dash {
                None => chart.draw_series(LineSeries::new(points.clone(), style))?,
                Some([length, space]) => {
                    chart.draw_series(DashedLineSeries::new(points.clone(), length, space, style))?
                }
            };
            for (p, spread) in series.points.iter().zip(&series.spread) {
                let (Some(p), Some(a), Some(b)) = (place(p), sheet.x.position(spread[0]), sheet.x.position(spread[1]))
                else {
                    continue;
                };
                chart.draw_series([PathElement::new(vec![(a, p.1), (b, p.1)], ink.colour.stroke_width(1))])?;
            }
            for (p, open) in series.points.iter().zip(&series.open) {
                let (Some(p), Some(most)) = (place(p), y.position(open[1])) else { continue };
                let least = y.position(open[0]).map_or(y_axis.range[0], |least| least.max(y_axis.range[0]));
                chart.draw_series([PathElement::new(vec![(p.0, least), (p.0, most)], ink.colour.stroke_width(1))])?;
            }
            for p in points {
                if series.secondary {
                    chart.draw_series([EmptyElement::at(*p) + Polygon::new(ink.marker, WHITE)])?;
                    chart.draw_series([EmptyElement::at(*p) + outline(ink)])?;
                } else {
                    chart.draw_series([EmptyElement::at(*p) + Polygon::new(ink.marker, ink.colour)])?;
                }
            }
        }
        legend(&right, sheet, !front.is_empty(), level.map(|l| l.1.as_str()))?;
        root.present()?;
    }
    Ok(accessible(&svg, &sheet.title))
}

fn outline(ink: Ink) -> PathElement<(i32, i32)> {
    let mut corners = ink.marker.to_vec();
    corners.extend(ink.marker.first());
    PathElement::new(corners, ink.colour.stroke_width(1))
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn legend(area: &Area<'_>, sheet: &Sheet, front: bool, level: Option<&str>) -> Result<(), PlotError> {
    let mut row = TOP;
    let text = |s: &str, at: (i32, i32)| Text::new(s.to_string(), at, (FONT, 13).into_font().color(&BLACK));
    for series in &sheet.series {
        let ink = Ink::of(series.ink);
        let style = ink.colour.stroke_width(if series.secondary { 1 } else { 2 });
        let (start, end) = ((4, row), (44, row));
        match ink.dash {
            None => area.draw(&PathElement::new(vec![start, end], style))?,
            Some([length, space]) => {
                let mut x = start.0;
                while x < end.0 {
                    area.draw(&PathElement::new(vec![(x, row), ((x + length).min(end.0), row)], style))?;
                    x += length + space;
                }
            }
        }
        let centre = |(x, y): &(i32, i32)| (24 + x, row + y);
        let mut corners: Vec<(i32, i32)> = ink.marker.iter().map(centre).collect();
        if series.secondary {
            area.draw(&Polygon::new(corners.clone(), WHITE))?;
            corners.extend(corners.first().copied());
            area.draw(&PathElement::new(corners, ink.colour.stroke_width(1)))?;
        } else {
            area.draw(&Polygon::new(corners, ink.colour))?;
        }
        area.draw(&text(&series.label, (52, row - 6)))?;
        row += ROW;
    }
    if front {
        area.draw(&PathElement::new(vec![(4, row), (44, row)], RGBColor(200, 200, 200).stroke_width(7)))?;
        area.draw(&text("nothing is better in both", (52, row - 6)))?;
        row += ROW;
    }
    if let Some(level) = level {
        for x in (4..44).step_by(5) {
            area.draw(&PathElement::new(vec![(x, row), (x + 2, row)], GREY.stroke_width(1)))?;
        }
        area.draw(&text(level, (52, row - 6)))?;
        row += ROW;
    }
    for note in &sheet.notes {
        area.draw(&text(note, (4, row)))?;
        row += NOTE;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(points: Vec<[f64; 2]>) -> Sheet {
        Sheet {
            title: "errors & \"time\"".to_string(),
            labels: ["x".to_string(), "y".to_string()],
            x: Scale::Logarithmic,
            series: vec![Series {
                label: "a < b".to_string(),
                ink: 1,
                secondary: false,
                points,
                spread: Vec::new(),
                open: Vec::new(),
            }],
            front: Vec::new(),
            level: None,
            notes: Vec::new(),
            size: [800, 400],
        }
    }

    #[test]
    fn a_long_legend_makes_the_figure_higher() {
        let mut many = sheet(vec![[1.0, 1.0], [2.0, 0.5]]);
        many.series = std::iter::repeat_n(many.series[0].clone(), 30).collect();
        many.notes = vec!["below all of it".to_string()];
        let svg = draw(&many).expect("a figure");
        let number = |from: &str| {
            let rest = svg.rsplit_once(from).expect("an attribute").1;
            rest[..rest.find('"').expect("its end")].parse::<i32>().expect("a number")
        };
        assert!(svg.contains("height=\"722\""), "{}", &svg[..200]);
        assert!(number(" y=\"") < 722 - 12, "{}", number(" y=\""));
    }

    #[test]
    fn what_is_not_known_exactly_is_a_line_from_the_least_to_the_most() {
        let mut known = sheet(vec![[1.0, 1e-2], [10.0, 1e-3], [100.0, 1e-4]]);
        known.series[0].open = vec![[1e-2, 1e-2], [5e-4, 2e-3], [0.0, 2e-4]];
        let svg = draw(&known).expect("draws");
        let (start, end) = ("<polyline", "/>");
        let lines: Vec<Vec<[i32; 2]>> = svg
            .split(start)
            .skip(1)
            .filter_map(|rest| rest.split(end).next()?.split("points=\"").nth(1)?.split('"').next())
            .map(|points| {
                let number = |word: &str| word.trim().parse().expect("a coordinate");
                points
                    .split_whitespace()
                    .filter_map(|p| p.split_once(','))
                    .map(|(x, y)| [number(x), number(y)])
                    .collect()
            })
            .collect();
        let upright: Vec<i32> = (lines.iter())
            .filter(|line| line.len() == 2 && line[0][0] == line[1][0] && line[0][0] > 90 && line[0][0] < 530)
            .map(|line| (line[0][1] - line[1][1]).abs())
            .collect();
        // From half to twice, and from twice to the end of the axis, which has a margin of 0.12 decades; ticks have five pixels.
        let long: Vec<f64> = upright.iter().filter(|length| **length > 5).map(|length| f64::from(*length)).collect();
        let ratio = 4.0_f64.log10() / (2.0_f64.log10() + 0.12);
        assert!(long.len() == 2 && (long[0] / long[1] - ratio).abs() < 0.05, "{upright:?}");
    }

    #[test]
    fn a_figure_is_well_formed_whatever_the_numbers() {
        for points in [
            vec![],
            vec![[1.0, 1.0]],
            vec![[0.0, 1.0], [f64::NAN, 2.0], [1.0, -3.0]],
            vec![[1e-12, 1e12], [1e9, 1e-300]],
        ] {
            let svg = draw(&sheet(points)).expect("draws");
            let mut reader = quick_xml::Reader::from_str(&svg);
            loop {
                match reader.read_event() {
                    Ok(quick_xml::events::Event::Eof) => break,
                    Ok(_) => {}
                    Err(error) => panic!("{error}: {svg}"),
                }
            }
        }
    }
}
