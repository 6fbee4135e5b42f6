//! `mesh.html`: a drawing of a mesh file and tables of what it holds, with the lines that name each.

use maud::{Markup, PreEscaped, html};

use super::{curve_told, curves, kinds, piece_told, told};
use crate::mesh::inventory::Inventory;
use crate::report::CSS;
use crate::report::document::{PLOTS, document};
use crate::report::figure::mesh;
use crate::report::text::number::clean;

const MORE_CSS: &str = "pre{margin:0;font:0.86em ui-monospace,SFMono-Regular,Menlo,monospace;white-space:pre-wrap}";

/// The page: no script, nothing loaded. `scene` is the text of a scene to start from.
pub fn page(inventory: &Inventory, scene: &str) -> String {
    let name = inventory.file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let body = html! {
        header {
            h1 { (clean(&name)) }
            p.sub { (kinds(inventory)) }
            @for note in &inventory.notes { p { (clean(&note.text)) } }
        }
        main {
            section #drawing { h2 { "Drawing" } figure.plot { (PreEscaped(mesh::mesh(inventory))) }
                p { "Broken lines lie between two bodies. Names on the outline are those of the file, and proposals where it has none; the tables below have the lines that make them." }
            }
            (table("bodies", "Bodies", inventory.bodies.iter().map(|r| (told(r), inventory.body_lines(r)))))
            (table("groups", "Other groups of cells", inventory.groups.iter().map(|r| (told(r), vec![r.key()]))))
            @for (i, (title, list, of)) in curves(inventory).into_iter().enumerate() {
                (table(&format!("curves{i}"), title, list.iter().map(|c| (curve_told(c, of), inventory.curve_lines(c)))))
            }
            (table("outline", "Outline by line and circle",
                inventory.outline.iter().map(|p| (format!("{}: {}", p.name, piece_told(p, inventory)), inventory.piece_lines(p)))))
            section #scene { h2 { "A scene to start from" } div.scroll { pre { (scene.replace(|c: char| c.is_control() && c != '\n', " ")) } } }
        }
    };
    document(&format!("{} · hypercircle mesh", clean(&name)), &[CSS, PLOTS, MORE_CSS], None, body)
}

fn table(id: &str, title: &str, rows: impl Iterator<Item = (String, Vec<String>)>) -> Markup {
    let rows: Vec<(String, Vec<String>)> = rows.collect();
    html! {
        @if !rows.is_empty() {
            section id=(id) {
                h2 { (title) }
                div.scroll role="region" aria-label=(title) tabindex="0" {
                    table {
                        thead { tr { th { "what" } th { "lines of a scene" } } }
                        tbody { @for (told, lines) in &rows { tr { td.long { (clean(told)) } td {
                            @if lines.is_empty() { "by its name" } @else { pre { (lines.join("\n")) } }
                        } } } }
                    }
                }
            }
        }
    }
}
