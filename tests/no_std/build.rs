//! Writes every system that is linked, in the scalar type of the crate: the accepted fixtures as they stand, and of the scenes their declarations.
//!
//! A file that is declared in the other type is copied with this one in its place. So both crates have every system.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// Parameters of the structs that have some, and the suffixes of their names.
const INSTANCES: [(&str, &[(&str, &str)]); 11] = [
    ("AnnotatedBody", &[("", "<'static, (), 4>")]),
    ("GenericBody", &[("", "<f64>"), (".lanes", "<clebsch::F64x4>")]),
    ("Rock", &[("", "<f64>"), (".lanes", "<clebsch::F64x8>")]),
    ("SpinChain", &[("", "<8>")]),
    ("DrivenChain", &[("", "<8>")]),
    ("HangingChain", &[("", "<8>")]),
    ("BranchingBodies", &[("", "<7>")]),
    ("Whip", &[("", "<8>")]),
    ("FirstOrderChain", &[("", "<8>")]),
    ("Molecules", &[("", "<8>")]),
    ("FirstOrderMolecules", &[("", "<8>")]),
];

/// The directions of space of fields that have more than one, and the number of the conserved momenta of those that move.
const DIRECTIONS: [(&str, &str); 6] = [
    ("chiral.Chiral", "2, 6"),
    ("harmonic_map", "2"),
    ("lattice.Block", "3, 3"),
    ("skyrmion.HarmonicMap", "2"),
    ("wave_map", "2, 3"),
    ("wave_map.WaveMap", "2, 3"),
];

/// The names in `f32` of the lanes of `f64`.
const LANES: [&str; 2] = ["F64x4", "F64x8"];

/// Dimensions of problems of optimal control: of places, of inputs, and the number of bounds.
const DIMENSIONS: [(&str, &str); 19] = [
    ("attitude_estimation.Satellite", "6, 6, 0"),
    ("driven_sleigh", "6, 2, 1"),
    ("follower", "3, 2, 1"),
    ("frugal_car", "3, 2, 4"),
    ("gripping_disc", "4, 2, 2"),
    ("hopper", "2, 1, 2"),
    ("telescope", "6, 3, 0"),
    ("regulator", "2, 1, 0"),
    ("rate_limited_body", "6, 3, 2"),
    ("steered_body", "6, 3, 2"),
    ("unicycle", "3, 2, 3"),
    ("wheeled_car", "3, 3, 3"),
    ("mpc.Follower", "12, 4, 9"),
    ("plate_ball.Ball", "5, 2, 0"),
    ("quadrotor.Quadrotor", "12, 4, 8"),
    ("slew_least_effort.SteeredBody", "6, 3, 6"),
    ("trailer.TractorTrailer", "12, 2, 5"),
    ("unicycle.Forward", "3, 2, 3"),
    ("unicycle.Free", "3, 2, 0"),
];

/// The scene of the largest plan, which is linked without the others too.
const LARGEST: &str = "mpc";

/// Systems that are tried with an unknown start too: a map, inputs of a group, and a state. Without scenes the first is the only one.
const ESTIMATED: [&str; 3] = ["regulator", "attitude_estimation.Satellite", "rate_limited_body"];

/// Studies have their systems in every order and discretization, and the pictures of the book have theirs; they are those of fixtures.
/// The bodies of an engine need the standard library.
const STUDIES: [&str; 5] = ["avian", "extremes", "figures", "rapier", "work_precision"];

fn main() {
    let root = Path::new("../../..");
    let name = env::var("CARGO_PKG_NAME").expect("cargo sets it");
    let scalar = name.strip_prefix("clebsch-no-std-").expect("crates are named after their scalar type");
    let mut text = format!("#[rustfmt::skip]\nmod {scalar} {{\n");
    for path in files(&root.join("tests/fixtures/accept")) {
        text += &in_scalar(&fixture(&path), scalar);
    }
    for path in files(&root.join("examples")) {
        text += &in_scalar(&scene(root, &path), scalar);
    }
    text += "}\n";
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("systems.rs"), text).expect("the folder of the build can be written");
}

/// Whether all scenes are linked.
fn has_scenes() -> bool {
    env::var_os("CARGO_FEATURE_SCENES").is_some()
}

/// The files of Rust in a folder and below, in the order of their names.
fn files(folder: &Path) -> Vec<PathBuf> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("a folder can be listed").path()).collect();
    paths.sort();
    let below = |path: PathBuf| if path.is_dir() { files(&path) } else { vec![path] };
    paths.into_iter().flat_map(below).filter(|path| path.extension().is_some_and(|kind| kind == "rs")).collect()
}

fn read(path: &Path) -> (String, TokenStream) {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let tokens = text.parse().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    (text, tokens)
}

/// Both scalar types are written as `f64` before.
fn in_scalar(text: &str, scalar: &str) -> String {
    match scalar {
        "f64" => text.to_owned(),
        scalar => LANES.iter().fold(text.replace("f64", scalar), |text, lanes| text.replace(lanes, "F32x8")),
    }
}

/// All of the file, as it may have methods that the declaration names.
fn fixture(path: &Path) -> String {
    let (text, tokens) = read(path);
    let module = path.file_stem().and_then(|stem| stem.to_str()).expect("names are plain");
    let declared = declared(tokens);
    assert!(declared.systems.len() == 1, "{}: a fixture declares one struct", path.display());
    let roots = roots(module, &declared.systems);
    format!("mod {module} {{\n{}\n{roots}}}\n", text.replace("f32", "f64"))
}

/// The declarations alone, without the other code of the scene.
fn scene(root: &Path, path: &Path) -> String {
    let inside = path.strip_prefix(root.join("examples")).expect("it is there");
    if !(has_scenes() || inside.starts_with(LARGEST)) || STUDIES.iter().any(|study| inside.starts_with(study)) {
        return String::new();
    }
    let declared = declared(read(path).1);
    if declared.systems.is_empty() {
        return String::new();
    }
    let folder = inside.parent().and_then(Path::to_str).expect("names are plain").replace('/', "_");
    let root = |system: &System| roots(&format!("{folder}.{}", system.name), [system]);
    let roots: String = declared.systems.iter().map(root).collect();
    let text = declared.text.replace("f32", "f64");
    let file = path.file_stem().and_then(|stem| stem.to_str()).expect("names are plain");
    format!("mod scene_{folder}_{file} {{\nuse clebsch::{{Clebsch, Scalar}};\nuse nalgebra::*;\n{text}\n{roots}}}\n")
}

/// The functions that are exported for systems of a module, inside of it.
fn roots<'a>(name: &str, systems: impl IntoIterator<Item = &'a System>) -> String {
    let mut text = String::new();
    for system in systems {
        let instances = INSTANCES.iter().find(|(name, _)| *name == system.name);
        for (suffix, parameters) in instances.map_or(&[("", "")] as &[_], |(_, instances)| *instances) {
            let path = format!("{}{parameters}", system.name);
            let mut of_method = |kind: &str, method: &str, more: &str| {
                writeln!(text, "crate::{kind}!(\"{name}{method}{suffix}.f64\", {path}{more});").expect("text");
            };
            for method in &system.methods {
                of_method("stepping", &format!(".{method}"), &format!(", {method}"));
            }
            let mut export = |kind: &str, more: &str| of_method(kind, "", more);
            if system.is_field {
                let directions = DIRECTIONS.iter().find(|(system, _)| *system == name).map_or("1", |(_, count)| count);
                export(if system.is_static { "resting" } else { "spreading" }, &format!(", {directions}"));
            } else if !system.is_control_alone {
                export("stepping", "");
            }
            if system.has_tangent {
                export("sensitive", "");
            }
            if system.has_boundary {
                export("connecting", "");
            }
            if system.is_controlled {
                let dimensions = DIMENSIONS.iter().find(|(system, _)| *system == name);
                let (_, dimensions) = dimensions.unwrap_or_else(|| panic!("add {name} to DIMENSIONS in build.rs"));
                export("planning", &format!(", {dimensions}"));
                if ESTIMATED.iter().take(if has_scenes() { ESTIMATED.len() } else { 1 }).any(|system| *system == name) {
                    export("estimating", &format!(", {dimensions}"));
                }
            }
        }
    }
    text
}

/// A struct that derives the trait, and the words that its declaration asks for.
struct System {
    name: String,
    /// Methods other than the declared dials.
    methods: Vec<String>,
    is_control_alone: bool,
    is_controlled: bool,
    is_field: bool,
    is_static: bool,
    has_tangent: bool,
    has_boundary: bool,
}

/// The declarations of a file, and their text alone.
#[derive(Default)]
struct Declared {
    systems: Vec<System>,
    text: String,
}

/// Structs that derive the trait, by themselves or by a macro that is called with their names.
fn declared(tokens: TokenStream) -> Declared {
    let mut declared = Declared::default();
    let mut macros: Vec<(String, Vec<TokenTree>)> = Vec::new();
    for item in items(tokens) {
        let derives = has_word(&item, "derive") && has_word(&item, "Clebsch");
        let is_unit = matches!(item.as_slice(), [.., TokenTree::Ident(word), TokenTree::Ident(_), TokenTree::Punct(_)] if word == "struct");
        let defined = name_after(&item, "macro_rules").filter(|_| derives);
        let called = macros.iter().find(|(name, _)| item.first().is_some_and(|first| first.to_string() == *name));
        if let Some(name) = defined {
            let item = without_implementations(item);
            declared.text += &text(&item);
            macros.push((name, item));
        } else if let Some((_, body)) = called {
            let name = first_type(&item).expect("a macro that declares structs takes their names");
            declared.systems.push(system(name, [body, &item]));
            declared.text += &text(&item);
        } else if let Some(name) = name_after(&item, "struct").filter(|_| derives) {
            declared.systems.push(system(name, [&item]));
            declared.text += &text(&item);
        } else if is_unit && !derives {
            // it may stand for a method
            declared.text += &text(&item);
        } else {
            assert!(!derives, "a declaration is in something else, where it is not found: {}", text(&item));
        }
    }
    declared
}

fn system<'a>(name: String, tokens: impl IntoIterator<Item = &'a Vec<TokenTree>> + Clone) -> System {
    let says = |key: &str| tokens.clone().into_iter().any(|tokens| has_key(tokens, key));
    let emits = |what: &str| says("emit") && tokens.clone().into_iter().any(|tokens| has_word(tokens, what));
    let is_control_alone = says("controls") || says("dynamics");
    System {
        name,
        methods: tokens.clone().into_iter().flat_map(|tokens| methods(tokens)).collect(),
        is_control_alone,
        is_controlled: is_control_alone || says("effort"),
        is_field: says("space"),
        is_static: says("space") && !says("cost") && !says("lagrangian"),
        has_tangent: emits("tangent"),
        has_boundary: emits("boundary"),
    }
}

/// Items end at a semicolon or after braces. Other items that end there are no structs, and are left out.
fn items(tokens: TokenStream) -> Vec<Vec<TokenTree>> {
    let mut items = vec![Vec::new()];
    for token in tokens {
        let ends = match &token {
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            TokenTree::Punct(mark) => mark.as_char() == ';',
            _ => false,
        };
        items.last_mut().expect("there is one").push(token);
        if ends {
            items.push(Vec::new());
        }
    }
    items
}

fn text(item: &[TokenTree]) -> String {
    let tokens: TokenStream = item.iter().cloned().collect();
    format!("{tokens}\n")
}

/// A macro with nothing but its structs.
fn without_implementations(item: Vec<TokenTree>) -> Vec<TokenTree> {
    let structs = |body: TokenStream| {
        items(body).into_iter().filter(|item| name_after(item, "struct").is_some()).flatten().collect()
    };
    let rules = |rules: TokenStream| rules.into_iter().map(|token| in_braces(token, structs)).collect();
    item.into_iter().map(|token| in_braces(token, rules)).collect()
}

fn in_braces(token: TokenTree, map: impl Fn(TokenStream) -> TokenStream) -> TokenTree {
    match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
            Group::new(Delimiter::Brace, map(group.stream())).into()
        }
        token => token,
    }
}

/// `name` of `struct name` and of `macro_rules! name`.
fn name_after(item: &[TokenTree], keyword: &str) -> Option<String> {
    let after = item.iter().map(TokenTree::to_string).skip_while(|token| token != keyword).skip(1);
    after.skip_while(|token| token == "!").next()
}

/// The first word with a capital, but for those of comments and attributes.
fn first_type(call: &[TokenTree]) -> Option<String> {
    call.iter().find_map(|token| match token {
        TokenTree::Group(group) if group.delimiter() != Delimiter::Bracket => {
            first_type(&group.stream().into_iter().collect::<Vec<_>>())
        }
        TokenTree::Ident(word) => Some(word.to_string()).filter(|word| word.starts_with(char::is_uppercase)),
        _ => None,
    })
}

/// `NAME` of each `method NAME =`.
fn methods(tokens: &[TokenTree]) -> Vec<String> {
    let words = flat(tokens);
    words.windows(3).filter(|part| part[0] == "method" && part[2] == "=").map(|part| part[1].clone()).collect()
}

/// Whether a word stands somewhere among the tokens.
fn has_word(tokens: &[TokenTree], wanted: &str) -> bool {
    flat(tokens).iter().any(|token| token == wanted)
}

/// Whether `key =` does.
fn has_key(tokens: &[TokenTree], key: &str) -> bool {
    flat(tokens).windows(2).any(|pair| pair[0] == key && pair[1] == "=")
}

/// All tokens, those in groups too, without the brackets.
fn flat(tokens: &[TokenTree]) -> Vec<String> {
    let parts = tokens.iter().map(|token| match token {
        TokenTree::Group(group) => flat(&group.stream().into_iter().collect::<Vec<_>>()),
        token => vec![token.to_string()],
    });
    parts.flatten().collect()
}
