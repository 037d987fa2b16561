//! The files of a folder of fixtures.

use std::collections::BTreeSet;
use std::panic::{RefUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use clebsch_compiler::lower::Program;
use clebsch_compiler::{Graph, compile};
use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{Attribute, Item};

/// A file with one annotated item.
pub struct Fixture {
    /// The name of the file, without its extension.
    pub name: String,
    /// Its text.
    pub source: String,
}

impl Fixture {
    /// All fixtures of a folder of `fixtures`, sorted by name.
    pub fn all(folder: &str) -> Vec<Fixture> {
        let paths = files(&root().join("fixtures").join(folder));
        let read = |path: PathBuf| Fixture {
            name: path.file_stem().expect("the name of a file").to_string_lossy().into_owned(),
            source: std::fs::read_to_string(&path).expect("a readable fixture"),
        };
        paths.into_iter().map(read).collect()
    }

    /// Checks all fixtures of a folder, so that one failure does not hide the next.
    pub fn check_all(folder: &str, check: impl Fn(&Fixture) + RefUnwindSafe) {
        let fails = |fixture: &Fixture| catch_unwind(|| check(fixture)).is_err();
        let failed: Vec<String> = Fixture::all(folder).into_iter().filter(fails).map(|fixture| fixture.name).collect();
        assert!(
            failed.is_empty(),
            "fixtures of {folder} that differ, see above: {failed:?}\n\
             if the change is meant: INSTA_UPDATE=always cargo test -p clebsch-laws --test snapshots, and review the diff"
        );
    }

    /// The item as the derive macro gets it: without its `#[derive]`, with the places of its tokens in this file.
    pub fn item(&self) -> TokenStream {
        let file = syn::parse_file(&self.source).unwrap_or_else(|error| panic!("{}: {error}", self.name));
        let mut items = file.items.into_iter().filter_map(|item| match item {
            Item::Struct(mut item) => derives(&mut item.attrs).then(|| item.into_token_stream()),
            Item::Enum(mut item) => derives(&mut item.attrs).then(|| item.into_token_stream()),
            Item::Union(mut item) => derives(&mut item.attrs).then(|| item.into_token_stream()),
            _ => None,
        });
        items.next().unwrap_or_else(|| panic!("{}: nothing derives Clebsch", self.name))
    }

    /// Compiles the item and looks at its program.
    pub fn with_program<R>(&self, look: impl FnOnce(&Program<'_>) -> R) -> R {
        let graph = Graph::new();
        match compile(&graph, self.item()) {
            Ok(program) => look(&program),
            Err(errors) => panic!("{}:\n{errors}", self.name),
        }
    }

    /// Runs assertions whose snapshots are in a folder of `snapshots`, with the fixture in their headers.
    pub fn snapshots(&self, folder: &str, assertions: impl FnOnce()) {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(root().join("snapshots").join(folder));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.set_info(&self.source.lines().collect::<Vec<_>>());
        settings.bind(assertions);
    }
}

/// The folder of fixtures and snapshots.
pub fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

/// The names of the fixtures that a folder of `snapshots` speaks about.
pub fn with_snapshots(folder: &str) -> BTreeSet<String> {
    let name = |path: PathBuf| path.file_name().and_then(|name| name.to_str()?.split('.').next().map(String::from));
    files(&root().join("snapshots").join(folder)).into_iter().filter_map(name).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    paths.sort();
    paths
}

/// Takes `#[derive(…)]` away; whether one of them names `Clebsch`.
fn derives(attributes: &mut Vec<Attribute>) -> bool {
    let count = attributes.len();
    let is_ours = |attribute: &Attribute| {
        attribute.path().is_ident("derive") && attribute.to_token_stream().to_string().contains("Clebsch")
    };
    let found = attributes.iter().any(is_ours);
    attributes.retain(|attribute| !attribute.path().is_ident("derive"));
    found && count > attributes.len()
}
