//! Each scene as a person runs it: short runs succeed and write what they promise, mistakes are explained.
//!
//! `cargo test` builds the examples first; with `--test scenes` alone, run `cargo build --examples` before.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Name, and the columns of the CSV file.
const SCENES: [(&str, &str); 4] = [
    ("toutatis", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3"),
    ("spherical_pendulum", "step,time,q1,q2,q3,N1,N2,N3"),
    ("heavy_top", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3"),
    (
        "rigid_body_4d",
        "step,time,R11,R12,R13,R14,R21,R22,R23,R24,R31,R32,R33,R34,R41,R42,R43,R44,M12,M13,M14,M23,M24,M34",
    ),
];

fn run(scene: &str, arguments: &[&str]) -> Output {
    let test = std::env::current_exe().expect("a test has a path");
    let program = test.ancestors().nth(2).expect("cargo's layout").join("examples").join(scene);
    let output = Command::new(&program).args(arguments).output();
    output.unwrap_or_else(|error| panic!("{}: {error}; run `cargo build --examples` first", program.display()))
}

/// What a run that has to fail prints on standard error; it must not be a panic.
fn refusal(scene: &str, arguments: &[&str]) -> String {
    let output = run(scene, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success(), "{scene} {arguments:?} succeeded");
    assert!(!errors.contains("panicked"), "{scene} {arguments:?}: {errors}");
    errors
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("cargo's target folder has a readable name")
}

#[test]
fn defaults_hold_all_their_claims() {
    for (scene, _) in SCENES {
        let figure = file(&format!("{scene}-default.svg"));
        let output = run(scene, &["--figure", text(&figure)]);
        let report = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{scene}: {report}{}", String::from_utf8_lossy(&output.stderr));
        assert!(report.contains("  holds  ") && !report.contains("  skipped  "), "{scene}: {report}");
        assert!(std::fs::read_to_string(figure).expect("the figure").contains("<polyline"));
    }
}

#[test]
fn short_runs_of_both_orders_write_the_promised_columns() {
    for (scene, columns) in SCENES {
        for order in ["1", "2"] {
            let (csv, figure) = (file(&format!("{scene}-{order}.csv")), file(&format!("{scene}-{order}.svg")));
            let arguments =
                ["--steps", "10", "--every", "4", "--order", order, "--csv", text(&csv), "--figure", text(&figure)];
            let output = run(scene, &arguments);
            assert!(output.status.success(), "{scene}: {}", String::from_utf8_lossy(&output.stderr));
            let lines = std::fs::read_to_string(csv).expect("the trajectory");
            let lines: Vec<&str> = lines.lines().collect();
            assert_eq!(lines[0], columns, "{scene}");
            let steps: Vec<&str> = lines[1..].iter().filter_map(|line| line.split(',').next()).collect();
            assert_eq!(steps, ["0", "4", "8"], "{scene}");
            assert!(lines[1..].iter().all(|line| line.split(',').count() == columns.split(',').count()), "{scene}");
        }
    }
}

#[test]
fn mistakes_are_explained() {
    for (scene, arguments, expected) in [
        ("toutatis", &["--inertia", "1,-2,3"][..], "`-2` is not above zero"),
        ("toutatis", &["--inertia", "1,2,9"], "no body has these moments"),
        ("toutatis", &["--inertia", "1,2"], "3 numbers separated by commas are needed, 2 were given"),
        ("toutatis", &["--spin", "1,nan,3"], "`nan` is not finite"),
        ("toutatis", &["--steps", "0"], "at least 1 is needed"),
        ("toutatis", &["--step-size", "-1"], "`-1` is not above zero"),
        ("toutatis", &["--order", "3"], "possible values: 1, 2"),
        ("toutatis", &["--csv", "/"], "cannot write /"),
        ("spherical_pendulum", &["--position", "0,2,0"], "normalise"),
        ("spherical_pendulum", &["--momentum", "1,1,0"], "leave the configuration unchanged"),
        ("spherical_pendulum", &["--step-size", "1"], "step 1 was not reached"),
        ("heavy_top", &["--step-size", "10"], "step 1 was not reached"),
        ("heavy_top", &["--center", "x,0,1"], "`x` is not a number"),
        ("rigid_body_4d", &["--j-d", "1,-1,2,3"], "entries 1 and 2 have the sum 0"),
        ("rigid_body_4d", &["--step-size", "100"], "step 1 was not reached"),
    ] {
        let errors = refusal(scene, arguments);
        assert!(errors.contains(expected), "{scene} {arguments:?}: {errors}");
    }
}
