//! Writes one documented module for each Markdown file, so that rustdoc compiles and runs its code.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let book = PathBuf::from(env::var("CARGO_MANIFEST_DIR").map_err(io::Error::other)?);
    let root = book.join("src");
    println!("cargo::rerun-if-changed={}", root.display());

    let mut pages = Vec::new();
    collect(&root, &mut pages)?;
    pages.push(book.join("../../README.md"));
    // pages of the book include its sections
    pages.push(book.join("../../macros/reference.md"));
    pages.sort();

    let modules: String = pages.iter().map(|page| module(&root, page)).collect();
    let out = PathBuf::from(env::var("OUT_DIR").map_err(io::Error::other)?);
    fs::write(out.join("pages.rs"), modules)
}

/// All Markdown files in a folder and those below it.
fn collect(folder: &Path, pages: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, pages)?;
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

/// A module with the name of its page, `concepts_exact_drift` for `concepts/exact-drift.md`: failing code is named by it.
fn module(root: &Path, page: &Path) -> String {
    let of_book = page.strip_prefix(root).ok().map(|path| path.with_extension("").display().to_string());
    let name = of_book.or_else(|| Some(page.file_stem()?.display().to_string())).unwrap_or_default();
    let name: String = name.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    format!("#[doc = include_str!({:?})]\npub mod {} {{}}\n", page.display().to_string(), name.to_lowercase())
}
