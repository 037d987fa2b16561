//! The README shows the first example and its output: both are those of the repository.

use std::path::Path;
use std::process::Command;

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

/// Printed digits are compared but for the last column, which is round-off and has to be that.
#[test]
fn the_readme_shows_its_output() {
    let test = std::env::current_exe().expect("a test has a path");
    let program = test.ancestors().nth(2).expect("cargo's layout").join("examples/rigid_body");
    let output = Command::new(&program).output().expect("the example; run `cargo build --examples` first");
    let (shown, printed) = (rows(&readme()), rows(&String::from_utf8_lossy(&output.stdout)));
    assert_eq!(shown.len(), 4, "the README shows four rows");
    assert_eq!(shown.len(), printed.len());
    for (shown, printed) in shown.iter().zip(&printed) {
        for column in 0..4 {
            assert!((shown[column] - printed[column]).abs() < 1e-4, "{shown:?} against {printed:?}");
        }
        assert!((shown[4] - printed[4]).abs() < 1e-12, "{shown:?} against {printed:?}");
        assert!(printed[5] < 1e-12 && shown[5] < 1e-12, "{shown:?} against {printed:?}");
    }
}
