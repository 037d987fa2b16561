//! The start of mutations: the fixtures, and the declarations of `tests/fuzz/seeds`.
//!
//! The tests and the fuzz target `declarations` include this file.

use std::path::Path;

/// The folders with seeds, below `tests`.
const FOLDERS: [&str; 3] = ["fixtures/accept", "fixtures/reject", "fuzz/seeds"];

/// All seeds: the names of their files, and their texts.
pub fn all() -> Vec<(String, String)> {
    FOLDERS.iter().flat_map(|folder| of(folder)).collect()
}

/// One in so many of a folder; all of them where `CLEBSCH_FUZZ` is set.
#[allow(dead_code, reason = "a fuzz target takes all")]
pub fn sample(folder: &str, one_in: usize) -> Vec<(String, String)> {
    let step = if std::env::var_os("CLEBSCH_FUZZ").is_some() { 1 } else { one_in };
    of(folder).into_iter().step_by(step).collect()
}

/// The seeds of a folder, sorted by name.
pub fn of(folder: &str) -> Vec<(String, String)> {
    // two folders up from `macros/compiler` and from `tests/fuzz`
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests").join(folder);
    let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    paths.sort();
    let read = |path: &std::path::PathBuf| std::fs::read_to_string(path).expect("a readable seed");
    paths.iter().map(|path| (path.file_stem().expect("a name").to_string_lossy().into_owned(), read(path))).collect()
}
