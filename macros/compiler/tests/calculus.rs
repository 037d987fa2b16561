//! Calculus is done where formulas are derived: behind that stage nothing is differentiated, substituted or expanded.

use std::path::{Path, PathBuf};

/// The methods of expressions that do calculus.
#[rustfmt::skip]
const CALCULUS: [&str; 8] =
    ["substitute", "gradient", "jacobian", "differential", "derivative", "expand", "expand_within", "blockwise"];

/// Whether a line calls one of them.
fn does_calculus(line: &str) -> bool {
    CALCULUS.iter().any(|name| line.contains(&format!(".{name}(")) || line.contains(&format!("Expr::{name}")))
}

/// All Rust files below a folder.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    paths.flat_map(|path| if path.is_dir() { sources(&path) } else { vec![path] }).collect()
}

#[test]
fn code_is_made_without_calculus() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let files: Vec<PathBuf> = ["lower", "emit"].iter().flat_map(|stage| sources(&source.join(stage))).collect();
    assert!(files.len() > 40, "only {} files", files.len());
    let mut found = Vec::new();
    for path in files {
        let text = std::fs::read_to_string(&path).expect("a readable file");
        for (number, line) in text.lines().enumerate() {
            if does_calculus(line) {
                found.push(format!("{}:{}: {}", path.display(), number + 1, line.trim()));
            }
        }
    }
    assert!(found.is_empty(), "make it a formula, in `derive`:\n{}", found.join("\n"));
}
