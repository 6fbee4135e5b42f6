//! The table of modules in docs/architecture.md is the order in which they import: none imports what stands below it, or is missing there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Modules by their row in the table; those of one row do not import each other.
fn table(text: &str) -> BTreeMap<String, usize> {
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    let mut order = BTreeMap::new();
    for (row, line) in rows.enumerate() {
        let names = line.split('|').nth(1).unwrap_or_default();
        for name in names.split(',').map(|name| name.trim().trim_matches('`')) {
            order.insert(name.to_string(), row);
        }
    }
    order
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("readable").flatten() {
        let path = entry.path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|ext| ext == "rs") {
            found.push(path);
        }
    }
}

/// Modules that `text` names after `crate::`, also in braces; what only tests name is left out.
fn imported(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let first =
        |part: &str| part.trim_start().split(|c: char| !c.is_alphanumeric() && c != '_').next().map(str::to_string);
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let joined = lines.collect::<Vec<_>>().join("\n");
    joined
        .split("crate::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            // Names at the first level of the braces.
            Some(list) => {
                let (mut depth, mut names, mut start) = (1, Vec::new(), 0);
                for (at, c) in list.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' => depth -= 1,
                        _ => {}
                    }
                    if depth == 0 || depth == 1 && c == ',' {
                        names.push(&list[start..at]);
                        start = at + 1;
                    }
                    if depth == 0 {
                        break;
                    }
                }
                names.into_iter().filter_map(first).collect()
            }
            None => first(rest).into_iter().collect::<Vec<_>>(),
        })
        .filter(|name| !name.is_empty())
        .collect()
}

/// Everything that is wrong with the imports of `src`, by the table of `page`.
fn faults(src: &Path, page: &str) -> Vec<String> {
    let order = table(page);
    let mut files = Vec::new();
    sources(src, &mut files);
    let modules: Vec<String> = std::fs::read_dir(src)
        .expect("readable")
        .flatten()
        .filter_map(|entry| entry.path().file_stem().map(|stem| stem.to_string_lossy().into_owned()))
        .filter(|name| !["lib", "core", "main"].contains(&name.as_str()))
        .collect();
    let missing =
        modules.iter().filter(|name| !order.contains_key(*name)).map(|name| format!("{name} is not in the table"));
    let mut faults: Vec<String> = missing.collect();
    for file in files {
        let inner = file.strip_prefix(src).expect("a file of src");
        let own = inner.components().next().expect("a name").as_os_str().to_string_lossy().replace(".rs", "");
        let only_tests =
            inner.file_stem().is_some_and(|stem| stem == "tests" || stem.to_string_lossy().ends_with("_tests"))
                || inner.components().any(|part| part.as_os_str() == "tests");
        let Some(place) = order.get(&own).filter(|_| !only_tests) else { continue };
        let text = std::fs::read_to_string(&file).expect("readable");
        for name in imported(&text).into_iter().filter(|name| modules.contains(name) && *name != own) {
            if order.get(&name).is_some_and(|other| other >= place) {
                faults.push(format!("{} imports {name}, which does not stand above it", inner.display()));
            }
        }
    }
    faults.sort();
    faults.dedup();
    faults
}

#[test]
fn modules_import_what_stands_above_them() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/architecture.md")).expect("the page");
    let faults = faults(&root.join("src"), &page);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The table upside down allows nothing that is imported.
#[test]
fn another_order_is_another_answer() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/architecture.md")).expect("the page");
    let upside_down: Vec<&str> = page.lines().rev().collect();
    let faults = faults(&root.join("src"), &upside_down.join("\n"));
    assert!(faults.iter().any(|fault| fault.contains("imports scene")), "{faults:?}");
    assert_eq!(imported("use crate::{a::{b, c}, d};\nfn f() -> crate::e::F {}\n// crate::g"), ["a", "d", "e"]);
}
