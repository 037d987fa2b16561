//! The README shows the first example and its output: both are those of the repository.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

fn readme() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md");
    std::fs::read_to_string(path).expect("the README")
}

#[test]
fn the_readme_opens_with_the_code_of_the_first_example() {
    let source = include_str!("../rigid_body/main.rs");
    let code = &source[source.find("use clebsch").expect("the imports")..];
    assert!(readme().contains(code), "copy examples/rigid_body/main.rs into the first code block of the README");
}

/// The numbers of the rows of a table: those whose first word is a number.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let numbers = |line: &str| line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>();
    text.lines().filter_map(numbers).filter(|row| row.len() == 6).collect()
}

/// Rows of the README that are compared: the last one takes a million steps, ten seconds without optimisation.
const ROWS: usize = if cfg!(feature = "heavy") { 4 } else { 3 };

/// Printed digits are compared but for the last column, which is round-off and has to be that.
#[test]
fn the_readme_shows_its_output() {
    let test = std::env::current_exe().expect("a test has a path");
    let program = test.ancestors().nth(2).expect("cargo's layout").join("examples/rigid_body");
    let run = Command::new(&program).stdout(Stdio::piped()).spawn();
    let mut run = run.expect("the example; run `cargo build --examples` first");
    let lines = BufReader::new(run.stdout.take().expect("it is piped")).lines();
    let head: Vec<String> = lines.take(1 + ROWS).map(|line| line.expect("the example prints text")).collect();
    if cfg!(feature = "heavy") {
        assert!(run.wait().expect("the example ends").success());
    } else {
        run.kill().and_then(|()| run.wait()).expect("the example runs for a million steps");
    }
    let shown = rows(&readme());
    let printed = rows(&head.join("\n"));
    assert_eq!(shown.len(), 4, "the README shows four rows");
    assert_eq!(printed.len(), ROWS);
    for (shown, printed) in shown.iter().zip(&printed) {
        for column in 0..4 {
            assert!((shown[column] - printed[column]).abs() < 1e-4, "{shown:?} against {printed:?}");
        }
        assert!((shown[4] - printed[4]).abs() < 1e-12, "{shown:?} against {printed:?}");
        assert!(printed[5] < 1e-12 && shown[5] < 1e-12, "{shown:?} against {printed:?}");
    }
}
