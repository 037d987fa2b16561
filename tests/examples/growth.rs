//! The cost of a declaration against its size, in both forms of code: time of the expansion, lines of the output, and
//! time of `cargo build`.
//!
//! `cargo run -p clebsch-tests --features heavy --example growth`, with the compiler as cargo builds macros by default, without
//! optimisation. With `-- --compile` a crate of each declaration is built too, by default settings, after its
//! dependencies. The time is that of expansion and compilation of the struct with a function that makes a step, in the
//! profile `release`.

use clebsch_compiler::{Graph, compile, emit, expand};
use proc_macro2::TokenStream;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;
use std::{env, fs};

/// How often an expansion is timed.
const REPETITIONS: usize = 3;

/// A family of declarations with the size n.
struct Family {
    name: &'static str,
    /// `N` stands for the size, `FORM` for the form of code.
    declaration: &'static str,
    sizes: &'static [usize],
    /// The largest size that is unrolled here: the next ones take minutes, or are refused.
    written_out: usize,
}

#[rustfmt::skip]
const FAMILIES: [Family; 4] = [
    Family {
        name: "bodies, SO(n)",
        declaration: "#[derive(Clebsch, Clone, Debug)]
            #[clebsch(action = |F: SO<N>, R: SO<N>| R * F, cost = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h, code = FORM)]
            pub struct System { #[clebsch(symmetric)] pub j_d: SMatrix<f64, N, N> }",
        sizes: &[4, 5, 6, 7, 8, 9, 10],
        written_out: 7,
    },
    Family {
        name: "points on spheres, SO(n)",
        declaration: "#[derive(Clebsch, Clone, Debug)]
            #[clebsch(action = |F: SO<N>, q: Unit<SVector<f64, N>>| F * q, cost = |h, F| (F - I).norm_squared() / (4 * h),
                potential = |q| self.stiffness.dot(&q.component_mul(&q)) / 2, code = FORM)]
            pub struct System { pub stiffness: SVector<f64, N> }",
        sizes: &[4, 6, 8, 11, 21, 51, 101],
        written_out: 11,
    },
    Family {
        name: "linear optics, Sp(n)",
        declaration: "#[derive(Clebsch, Clone, Debug)]
            #[clebsch(action = |F: Sp<N>, q: Sp<N>| q * F, cost = |h, F| (F - I).norm_squared() / (2 * h), scalar = f64, code = FORM)]
            pub struct System;",
        sizes: &[4, 6, 8],
        written_out: 4,
    },
    Family {
        name: "fluid ellipsoids, SL(n)",
        declaration: "#[derive(Clebsch, Clone, Debug)]
            #[clebsch(action = |F: SL<N>, q: SL<N>| F * q, cost = |h, q, F| self.mass * (F * q - q).norm_squared() / (2 * h), code = FORM)]
            pub struct System { pub mass: f64 }",
        sizes: &[3, 4, 5, 6],
        written_out: 3,
    },
];

fn main() {
    let compiles = env::args().any(|argument| argument == "--compile");
    let builds = compiles.then(|| Builds::new(Path::new(env!("CARGO_MANIFEST_DIR"))));
    println!("medians of {REPETITIONS} expansions, ms{}", if compiles { "; of one build, s" } else { "" });
    for Family { name, declaration, sizes, written_out } in FAMILIES {
        println!(
            "\n{name}\n{:>6}  {:<12} {:>9} {:>7} {:>9}",
            "n",
            "code",
            "expansion",
            "lines",
            if compiles { "build" } else { "" }
        );
        for form in ["unrolled", "matrices"] {
            let sizes = sizes.iter().filter(|&&n| form == "matrices" || n <= written_out);
            let rows: Vec<(f64, [f64; 3])> = sizes
                .map(|&n| {
                    let source = declaration.replace("FORM", form).replace("<N>", &format!("<{n}>"));
                    let source = source.replace(", N>", &format!(", {n}>")).replace(", N,", &format!(", {n},"));
                    let row = measure(&source, builds.as_ref());
                    let [time, lines, build] = row;
                    let build = if compiles { format!("{build:9.2}") } else { String::new() };
                    println!("{n:6}  {form:<12} {time:9.1} {lines:7.0} {build}");
                    (n as f64, row)
                })
                .collect();
            if let [.., _, _, _] = rows[..] {
                let growth = |column: usize| growth(rows.iter().map(|(n, row)| (*n, row[column])));
                let build = if compiles { format!(", build ∝ n^{:.1}", growth(2)) } else { String::new() };
                println!("        {form}: expansion ∝ n^{:.1}, lines ∝ n^{:.1}{build}", growth(0), growth(1));
            }
        }
    }
}

/// Milliseconds of the expansion, lines of the output, and seconds of the build.
fn measure(source: &str, builds: Option<&Builds>) -> [f64; 3] {
    let item: TokenStream = source.parse().expect("Rust tokens");
    let mut times = [0.0; REPETITIONS].map(|_| {
        let (item, start) = (item.clone(), Instant::now());
        std::hint::black_box(expand(item));
        start.elapsed().as_secs_f64() * 1e3
    });
    times.sort_by(f64::total_cmp);
    let graph = Graph::new();
    let program = compile(&graph, item).unwrap_or_else(|errors| panic!("{errors}\n{source}"));
    let lines = emit::generated(&program).lines().count();
    [times[REPETITIONS / 2], lines as f64, builds.map_or(0.0, |builds| builds.seconds(source))]
}

/// The exponent of the power of n that fits best, by least squares of logarithms.
fn growth(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let points: Vec<(f64, f64)> = points.map(|(n, y)| (n.ln(), y.ln())).collect();
    let count = points.len() as f64;
    let [x, y] = points.iter().fold([0.0; 2], |sum, (x, y)| [sum[0] + x / count, sum[1] + y / count]);
    let [above, below] =
        points.iter().fold([0.0; 2], |sum, (a, b)| [sum[0] + (a - x) * (b - y), sum[1] + (a - x) * (a - x)]);
    above / below
}

/// A crate that is built anew for each declaration.
struct Builds {
    folder: PathBuf,
}

impl Builds {
    /// Next to the other files that are built, with the dependencies as the workspace has them.
    fn new(tests: &Path) -> Builds {
        let workspace = tests.parent().expect("the workspace");
        let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from);
        let folder = target.join("growth");
        fs::create_dir_all(folder.join("src")).expect("a folder");
        let runtime = workspace.join("runtime");
        let manifest = format!(
            "[package]\nname = \"growth\"\nedition = \"2024\"\n\n[dependencies]\nclebsch = {{ path = {runtime:?} }}\nnalgebra = {{ version = \"0.35\", default-features = false }}\n\n[workspace]\n"
        );
        fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
        fs::copy(workspace.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the versions of the workspace");
        let builds = Builds { folder };
        // dependencies
        builds.build("");
        builds
    }

    /// Seconds from the changed source to the library, less those of a library without code.
    fn seconds(&self, declaration: &str) -> f64 {
        let empty = self.build("");
        let step = "pub fn step(stepper: &clebsch::Stepper<System>, state: &clebsch::State<System>) -> Result<clebsch::State<System>, clebsch::Error> { stepper.step(state) }";
        let source = format!(
            "#![allow(missing_docs, unused_imports)]\nuse clebsch::Clebsch;\nuse nalgebra::*;\n{declaration}\n{step}\n"
        );
        self.build(&source) - empty
    }

    fn build(&self, source: &str) -> f64 {
        fs::write(self.folder.join("src/lib.rs"), source).expect("a source");
        let start = Instant::now();
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        let built = cargo.args(["build", "--release", "--quiet"]).current_dir(&self.folder);
        let built = built.env("CARGO_TARGET_DIR", self.folder.join("target")).status().expect("cargo");
        assert!(built.success(), "{source}");
        start.elapsed().as_secs_f64()
    }
}
