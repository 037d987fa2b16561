//! Every page is in the table of contents, and every link leads to a file.

use crate::pages::{files, lines_of_prose, read, root, without_code};
use std::path::PathBuf;

/// The targets of the links of a line, without those to the web and within the page.
fn targets(line: &str) -> Vec<String> {
    let line = without_code(line);
    let targets = line.split("](").skip(1).filter_map(|text| text.split(')').next());
    let paths = targets.filter_map(|target| target.split('#').next());
    paths.filter(|path| !path.is_empty() && !path.contains("://")).map(str::to_owned).collect()
}

fn documents() -> Vec<PathBuf> {
    let mut documents = files(&root().join("docs"), "md");
    documents.extend(["README.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(|name| root().join(name)));
    documents
}

#[test]
fn links_lead_to_files() {
    let mut broken = Vec::new();
    for document in documents() {
        let folder = document.parent().expect("a folder");
        for target in lines_of_prose(&read(&document)).flat_map(targets) {
            if !folder.join(&target).exists() {
                broken.push(format!("{}: {target}", document.display()));
            }
        }
    }
    assert!(broken.is_empty(), "links to nothing:\n{}", broken.join("\n"));
}

#[test]
fn every_page_is_in_the_summary() {
    let source = root().join("docs/book/src");
    let summary = read(&source.join("SUMMARY.md"));
    for page in files(&source, "md") {
        let name = page.strip_prefix(&source).expect("a page of the book").display().to_string();
        assert!(
            name == "SUMMARY.md" || summary.contains(&format!("({name})")),
            "add {name} to docs/book/src/SUMMARY.md"
        );
    }
}
