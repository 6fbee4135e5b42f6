mod build;
mod freedom;
mod pinning;
mod scenes;
mod table;
