//! Every fixture does what its folder says: the accepted ones compile, the rejected ones have errors that say what to write.

use std::fs;
use std::path::{Path, PathBuf};

use clebsch_compiler::{Graph, WORK, compile, expand};
use clebsch_symbolic::work;
use proc_macro2::TokenStream;
use quote::ToTokens;

/// The files of a folder of fixtures, in order.
fn fixtures(folder: &str) -> Vec<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(folder);
    let entries = fs::read_dir(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a readable folder").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rs"));
    files.sort();
    files
}

/// What the compiler says about the item of a file: nothing, or its errors.
fn errors(file: &Path) -> Option<String> {
    compile(&Graph::new(), item(file)).err().map(|errors| errors.to_string())
}

/// The item of a file that carries the derive.
fn item(file: &Path) -> TokenStream {
    let text = fs::read_to_string(file).expect("a readable file");
    let items = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display())).items;
    let declared = |item: &syn::Item| {
        let attributes = match item {
            syn::Item::Struct(item) => &item.attrs,
            syn::Item::Enum(item) => &item.attrs,
            _ => return false,
        };
        attributes.iter().any(|attribute| attribute.path().is_ident("derive"))
    };
    let item = items.into_iter().find(declared).unwrap_or_else(|| panic!("{} derives nothing", file.display()));
    item.to_token_stream()
}

#[test]
fn accepted_fixtures_compile() {
    let files = fixtures("accept");
    assert!(files.len() >= 14, "only {} fixtures", files.len());
    for file in files {
        assert_eq!(errors(&file), None, "{}", file.display());
    }
}

/// What people declare is far from what is too large: no fixture takes a twentieth of the budget.
#[test]
fn accepted_fixtures_stay_far_within_the_budget() {
    let mut most = (0, String::new());
    for file in fixtures("accept") {
        let before = work::spent();
        expand(item(&file));
        most = most.max((work::spent() - before, file.display().to_string()));
    }
    println!("{} of {WORK}: {}", most.0, most.1);
    assert!(most.0 > WORK / 1000 && most.0 < WORK / 20, "{} of {WORK}: {}", most.0, most.1);
}

#[test]
fn rejected_fixtures_have_errors_that_help() {
    let files = fixtures("reject");
    assert!(files.len() >= 32, "only {} fixtures", files.len());
    for file in files {
        let text = errors(&file).unwrap_or_else(|| panic!("{} is accepted", file.display()));
        for error in text.split("\n\n") {
            let (first, rest) = error.split_once('\n').unwrap_or((error, ""));
            assert!(first.starts_with("error: ") && !first.ends_with('.'), "{}: {first}", file.display());
            assert!(rest.contains("help: ") || rest.contains("note: "), "{} only says: {first}", file.display());
        }
    }
}
