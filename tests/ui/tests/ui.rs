//! Mistakes as rustc shows them: one error each, at its place, and nothing that follows from it.
//!
//! Snapshots of `fixtures/reject` show the messages themselves. This test shows that they arrive. It compiles each file
//! of `cases` with the libraries that cargo has built for the test. Then it compares the output of rustc with the
//! `.stderr` file of the same name. `INSTA_UPDATE=always` writes these files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates that cases use.
const CRATES: [&str; 2] = ["clebsch", "nalgebra"];

/// The first words of lines at the end of the output: they count errors and name pages.
const ENDINGS: [&str; 3] =
    ["error: aborting due to ", "For more information about this error", "Some errors have detailed"];

/// The first words of a note that shows lines of the runtime.
const BOUND: &str = "note: required by a bound";

/// The libraries of [`CRATES`], built by cargo as they are for this test.
struct Libraries(Vec<(&'static str, PathBuf)>);

impl Libraries {
    /// Asks cargo for the files. After `cargo test --workspace` they exist already; after a test of this package alone cargo builds them.
    fn built() -> Libraries {
        // tests are in TARGET/PROFILE/deps, their files in TARGET/tmp
        let test = std::env::current_exe().expect("a test has a path");
        let folder = test.ancestors().nth(2).and_then(Path::file_name).expect("cargo's layout");
        let profile = if folder == "debug" { "dev" } else { folder.to_str().expect("the name of a profile") };
        let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("cargo's layout");
        // `--workspace`: with the features of this package alone these would be other libraries
        let output = Command::new(env!("CARGO"))
            .args([
                "test",
                "--workspace",
                "--test",
                "ui",
                "--no-run",
                "--offline",
                "--quiet",
                "--message-format",
                "json",
            ])
            .args(["--profile", profile, "--target-dir"])
            .arg(target)
            .output()
            .expect("cargo runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let messages = String::from_utf8(output.stdout).expect("text");
        let messages: Vec<serde_json::Value> =
            messages.lines().map(|line| serde_json::from_str(line).expect("a message of cargo")).collect();
        Libraries(CRATES.map(|name| (name, library(&messages, name))).into())
    }

    /// The output of rustc for a case; `None` if the case compiles.
    fn errors(&self, case: &Path) -> Option<String> {
        let mut rustc = Command::new("rustc");
        rustc.args(["--edition=2024", "--crate-type=bin", "--emit=metadata", "--color=never", "-o"]);
        rustc.arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join(case.with_extension("rmeta").file_name()?));
        for (name, path) in &self.0 {
            rustc.arg("--extern").arg(format!("{name}={}", path.display()));
            rustc.arg("-L").arg(format!("dependency={}", path.parent()?.display()));
        }
        let output = rustc.arg(case).current_dir(env!("CARGO_MANIFEST_DIR")).output().expect("rustc runs");
        let text = String::from_utf8(output.stderr).expect("text");
        let is_ending = |line: &&str| ENDINGS.iter().any(|ending| line.starts_with(ending));
        // a note on a bound ends at an empty line: it shows where the runtime stands on this machine
        let mut in_library = false;
        let is_of_case = |line: &&str| {
            in_library = !line.is_empty() && (in_library || line.starts_with(BOUND));
            !in_library
        };
        let lines = text.lines().filter(|line| !is_ending(line)).map(str::trim_end);
        let lines: Vec<&str> = lines.filter(is_of_case).collect();
        (!output.status.success()).then(|| format!("{}\n", lines.join("\n").trim_end()))
    }
}

/// The library of a crate among the messages of cargo.
fn library(messages: &[serde_json::Value], name: &str) -> PathBuf {
    let is_library = |message: &&serde_json::Value| {
        message["reason"] == "compiler-artifact"
            && message["target"]["name"] == name
            && message["target"]["kind"][0] == "lib"
    };
    let files = messages.iter().filter(is_library).filter_map(|message| message["filenames"].as_array()).flatten();
    let mut files = files.filter_map(|file| file.as_str()).filter(|file| file.ends_with(".rlib"));
    files.next().unwrap_or_else(|| panic!("cargo builds no library `{name}`")).into()
}

#[test]
fn mistakes_as_rustc_shows_them() {
    let libraries = Libraries::built();
    let overwrites = std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always");
    let folder = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("cases")).expect("a folder");
    let mut names: Vec<PathBuf> =
        folder.map(|file| Path::new("cases").join(file.expect("a file").file_name())).collect();
    names.retain(|name| name.extension().is_some_and(|extension| extension == "rs"));
    names.sort();
    let mut failures = Vec::new();
    for case in &names {
        let snapshot = Path::new(env!("CARGO_MANIFEST_DIR")).join(case.with_extension("stderr"));
        let expected = fs::read_to_string(&snapshot).unwrap_or_default();
        match libraries.errors(case) {
            None => failures.push(format!("{} compiles", case.display())),
            Some(errors) if errors == expected => {}
            Some(errors) if overwrites => fs::write(&snapshot, errors).expect("the snapshot is written"),
            Some(errors) => {
                failures.push(format!("{}: expected\n\n{expected}\nand rustc says\n\n{errors}", case.display()))
            }
        }
    }
    assert!(names.len() >= 8, "only {} cases", names.len());
    assert!(
        failures.is_empty(),
        "{}\n\nINSTA_UPDATE=always cargo test -p clebsch-ui writes the files",
        failures.join("\n\n")
    );
}
