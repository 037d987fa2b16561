//! Accepted declarations give Rust that compiles: changed declarations without errors, as rustc sees them.
//!
//! It takes minutes and runs only on request, by
//! `CLEBSCH_FUZZ_CHECK=2000 cargo test -p clebsch-compiler --test fuzz accepted -- --nocapture`. This changes two
//! thousand declarations and checks those that have an integrator, in a crate of their own below the target folder.

use std::path::Path;
use std::process::Command;

use quote::ToTokens;

use crate::mutation::{Choices, mutated};
use crate::seeds;
use crate::verdict::{declaration, verdict};

/// Facts that no macro can know: names that are not there, traits that a type of the user's has not.
const UNKNOWN: [&str; 13] = [
    "E0412", "E0425", "E0433", "E0432", "E0405", "E0277", "E0106", "E0261", "E0392", "E0107", "E0204", "E0404", "E0573",
];

#[test]
fn accepted_changes_compile() {
    let Ok(count) = std::env::var("CLEBSCH_FUZZ_CHECK") else { return };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("accepted");
    let mut texts = accepted(count.parse().expect("CLEBSCH_FUZZ_CHECK is a count"));
    println!("{} accepted", texts.len());
    // rustc looks at types once all names are known: declarations with other errors are left out, and the others
    // checked again
    loop {
        let errors = check(&folder, &texts);
        let is_unknown = |error: &&String| UNKNOWN.iter().any(|code| error.contains(code));
        let (unknown, ours): (Vec<&String>, Vec<&String>) = errors.iter().partition(is_unknown);
        assert!(ours.is_empty(), "errors in {}:\n{ours:#?}", folder.display());
        if unknown.is_empty() {
            return println!("{} compile", texts.len());
        }
        println!("names and traits that no macro knows: {unknown:#?}");
        let is_named = |number: usize| unknown.iter().any(|error| error.starts_with(&format!("src/m{number}.rs:")));
        texts = (0..texts.len()).filter(|&number| !is_named(number)).map(|number| texts[number].clone()).collect();
    }
}

/// The errors of rustc in a crate of these texts.
fn check(folder: &Path, texts: &[String]) -> Vec<String> {
    write(folder, texts);
    let check = Command::new(env!("CARGO"))
        .args(["check", "--offline", "--message-format", "short"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .output()
        .expect("cargo runs");
    let said = String::from_utf8_lossy(&check.stderr);
    let errors: Vec<String> =
        said.lines().filter(|line| line.starts_with("src/") && line.contains(": error")).map(String::from).collect();
    assert!(check.status.success() || !errors.is_empty(), "no check:\n{said}");
    errors
}

/// Changed declarations that have an integrator.
fn accepted(count: u64) -> Vec<String> {
    let (seeds, from) = (seeds::all(), seeds::of("fixtures/accept"));
    let change = |number| {
        let choices = &mut Choices::new(number ^ 0xacce);
        let (one, other) = (choices.pick(from.len()), choices.pick(seeds.len()));
        mutated(&from[one].1, &seeds[other].1, choices)
    };
    (0..count).map(change).filter(|text| matches!(verdict(text), Ok(None))).filter_map(|text| item(&text)).collect()
}

/// The item of a text as a module has it. `None` if rustc would not give it to a macro, and for potentials whose
/// methods stand outside of the item.
fn item(text: &str) -> Option<String> {
    let mut item: syn::DeriveInput = syn::parse2(declaration(text.parse().ok()?)).ok()?;
    // other attributes are not ours to read
    item.attrs.retain(|attribute| attribute.path().is_ident("clebsch"));
    if let syn::Data::Struct(data) = &mut item.data {
        data.fields.iter_mut().for_each(|field| field.attrs.retain(|attribute| attribute.path().is_ident("clebsch")));
    }
    let text = item.to_token_stream().to_string();
    (!text.contains("opaque")).then(|| format!("use clebsch::Clebsch;\nuse nalgebra::*;\n#[derive(Clebsch)]\n{text}\n"))
}

/// A crate with a module for each text.
fn write(folder: &Path, texts: &[String]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace");
    let source = folder.join("src");
    let _ = std::fs::remove_dir_all(&source);
    std::fs::create_dir_all(&source).expect("a folder");
    let put = |name: &str, text: String| std::fs::write(folder.join(name), text).expect("a file");
    let (runtime, version) = (root.join("runtime"), "version = \"0.1.0\"\nedition = \"2024\"");
    put(
        "Cargo.toml",
        format!(
            "[workspace]\n[package]\nname = \"accepted\"\n{version}\n[dependencies]\nclebsch = {{ path = {runtime:?} }}\n\
         nalgebra = {{ version = \"0.35\", default-features = false, features = [\"macros\", \"libm\"] }}\n"
        ),
    );
    std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
    let modules: String = (0..texts.len()).map(|number| format!("mod m{number};\n")).collect();
    put("src/lib.rs", format!("#![allow(warnings)]\n{modules}"));
    for (number, text) in texts.iter().enumerate() {
        put(&format!("src/m{number}.rs"), text.clone());
    }
}
