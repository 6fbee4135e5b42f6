//! One map with a choice of what it shows.

use maud::{Markup, PreEscaped, html};

use super::links;
use super::values::values;
use crate::report::figure::map::{self, Scale};
use crate::report::figure::mark::{Mark, spots};
use crate::report::text::number::{clean, percent};
use crate::report::{Dossier, Map, MapKind};

/// The maps to choose from, in the order of the choice; the first is shown where no script runs.
fn ordered<'a>(dossier: &'a Dossier) -> Vec<&'a Map> {
    let triangles = dossier.problem.mesh.triangles.len();
    let best = dossier.report.stress.as_ref().map_or("", |stress| stress.against.as_str());
    let mut maps: Vec<&Map> = dossier.maps.iter().filter(|map| map.values.len() == triangles).collect();
    let kind = |map: &Map| MapKind::ALL.iter().position(|kind| *kind == map.kind);
    let of_best = |map: &Map| map.kind == MapKind::Difference && !best.is_empty() && map.title.ends_with(best);
    maps.sort_by_key(|map| (kind(map), !of_best(map)));
    maps
}

/// The figure: the first map as a picture, and the values of all of them for the script; nothing without maps.
pub(super) fn figure(dossier: &Dossier, marks: &[Mark]) -> Markup {
    let maps = ordered(dossier);
    let Some(first) = maps.first() else { return html! {} };
    let scaled: Vec<(&Map, Scale)> = maps.iter().map(|map| (*map, scale(&maps, map.kind))).collect();
    let kinds: Vec<MapKind> =
        MapKind::ALL.into_iter().filter(|kind| maps.iter().any(|map| map.kind == *kind)).collect();
    let title = format!("{}, {}", first.kind.in_words(), clean(&first.title));
    let data = serde_json::to_string(&values(dossier.problem, &scaled)).unwrap_or_default();
    html! {
        figure #map data-map=(data) {
            div.tools hidden {
                label { "Show "
                    select {
                        @for kind in &kinds {
                            optgroup label=(kind.in_words()) {
                                @for (i, map) in maps.iter().enumerate().filter(|(_, map)| map.kind == *kind) {
                                    option value=(i) { (clean(&map.title)) }
                                }
                            }
                        }
                    }
                }
                button type="button" data-zoom="1.5" { "Zoom in" } button type="button" data-zoom="0.6667" { "Zoom out" }
                button type="button" data-zoom="0" { "All" }
            }
            div.stage { (PreEscaped(map::map(dossier.problem, &title, &first.values, &scaled[0].1, (marks, &spots(dossier.problem, &dossier.report))))) }
            @for (i, kind) in kinds.iter().enumerate() {
                div.bar data-kind=(kind.in_words()) data-what=(kind.explanation()) hidden[i > 0] {
                    (PreEscaped(map::bar(kind.in_words(), &scale(&maps, *kind))))
                }
            }
            output aria-live="polite" hidden {}
            figcaption {
                p.what { b { (title) ". " } span { (first.kind.explanation()) } }
                @if map::is_coarsened(dossier.problem) {
                    p { "There are more triangles than the picture can tell apart: each cell shows the largest value in it." }
                }
                p.how hidden {
                    "Point at a triangle, or go from one to the next with the arrow keys, to read its values; drag to move. Maps of one kind \
                    have one scale."
                }
                details {
                    summary { "Where each map is largest" }
                    (super::tables::scroll("largest values of the maps", html! { table {
                        thead { tr { th { "map" } th.n { "largest" } th.n { "in triangle" } } }
                        tbody { @for map in &maps { (largest(map)) } }
                    } }))
                }
                (links::checks_of("map", &dossier.report))
            }
        }
    }
}

fn largest(map: &Map) -> Markup {
    let finite = (0..map.values.len()).filter(|t| map.values[*t].is_finite());
    let top = finite.max_by(|a, b| map.values[*a].total_cmp(&map.values[*b]));
    let number = |x: f64| match map.kind {
        MapKind::GapShare | MapKind::QuantityShare => percent(x),
        _ => crate::report::text::number::significant(x, 4),
    };
    html! {
        tr {
            td { (map.kind.in_words()) ", " (clean(&map.title)) }
            td.n { (top.map_or("–".to_string(), |t| number(map.values[t]))) }
            td.n { (top.map_or("–".to_string(), |t| t.to_string())) }
        }
    }
}

/// One scale for all maps of a kind.
fn scale(maps: &[&Map], kind: MapKind) -> Scale {
    let own: Vec<f64> = maps.iter().filter(|map| map.kind == kind).flat_map(|map| map.values.iter().copied()).collect();
    Scale::of(&own)
}
