mod build;
mod freedom;
mod pinning;
mod program;
mod scenes;
mod sparse;
mod table;
