//! Each scene as a person runs it: short runs succeed and write the promised files, mistakes are explained.
//!
//! Scenes are built without optimisation here, so runs that take seconds are made with the feature `heavy` alone.
//! `cargo test --workspace --features heavy --profile heavy` optimises them.
//!
//! `cargo test` builds the examples first; with `--test scenes` alone, run `cargo build --examples` before.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Name, and the columns of the CSV file.
const SCENES: [(&str, &str); 19] = [
    ("toutatis", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3"),
    ("spherical_pendulum", "step,time,q1,q2,q3,N1,N2,N3"),
    ("sphere_molecules", "step,time,L1,L2,L3,kinetic,potential"),
    ("spin_chain", "step,time,q1,q2,q3,N1,N2,N3,energy"),
    ("heavy_top", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3"),
    (
        "rigid_body_4d",
        "step,time,R11,R12,R13,R14,R21,R22,R23,R24,R31,R32,R33,R34,R41,R42,R43,R44,M12,M13,M14,M23,M24,M34",
    ),
    ("sphere_geodesics", "step,time,q1,q2,q3,q4,q5,q6,q7,q8,w1,w2,w3,w4,w5,w6,w7,w8"),
    (
        "rigid_body_5d",
        "step,time,R11,R12,R13,R14,R15,R21,R22,R23,R24,R25,R31,R32,R33,R34,R35,R41,R42,R43,R44,R45,R51,R52,R53,R54,R55,\
         M12,M13,M14,M15,M23,M24,M25,M34,M35,M45",
    ),
    (
        "rigid_body_n",
        "step,time,R11,R12,R13,R14,R15,R16,R21,R22,R23,R24,R25,R26,R31,R32,R33,R34,R35,R36,\
         R41,R42,R43,R44,R45,R46,R51,R52,R53,R54,R55,R56,R61,R62,R63,R64,R65,R66,\
         M12,M13,M14,M15,M16,M23,M24,M25,M26,M34,M35,M36,M45,M46,M56",
    ),
    ("underwater_vehicle", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,x1,x2,x3,Pi1,Pi2,Pi3,P1,P2,P3"),
    ("fluid_ellipsoid", "step,time,q11,q12,q13,q21,q22,q23,q31,q32,q33,N1,N2,N3,N4,N5,N6,N7,N8"),
    (
        "relativistic_spin",
        "step,time,q00,q01,q02,q03,q10,q11,q12,q13,q20,q21,q22,q23,q30,q31,q32,q33,E1,E2,E3,B1,B2,B3",
    ),
    ("sphere_bvp", "step,time,q1,q2,q3,N1,N2,N3"),
    ("slew", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3,omega1,omega2,omega3"),
    ("unicycle", "step,time,x,y,theta,omega,v,ltheta,lx,ly"),
    ("plate_ball", "step,time,x,y,R11,R12,R13,R21,R22,R23,R31,R32,R33,u1,u2,m1,m2,m3"),
    ("inertia_estimation", "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3"),
    ("ensemble", "step,time,mean,least,greatest,exact"),
    ("spacecraft", "step,time,x1,x2,x3,R11,R12,R13,R21,R22,R23,R31,R32,R33,p1,p2,p3,pi1,pi2,pi3"),
];

/// Scenes whose runs by default take a second or more without optimisation: `other_flags_hold_all_their_claims` makes shorter ones.
const LONG: [&str; 30] = [
    "attitude_estimation",
    "spacecraft",
    "spin_chain",
    "rigid_body_4d",
    "sphere_geodesics",
    "sleigh",
    "snakeboard",
    "sphere_molecules",
    "rigid_body_5d",
    "rigid_body_n",
    "underwater_vehicle",
    "relativistic_spin",
    "slew",
    "unicycle",
    "plate_ball",
    "trailer",
    "inertia_estimation",
    "ensemble",
    "rattleback",
    "chain",
    "double_pendulum",
    "quadrotor",
    "mpc",
    "wave_map",
    "kink",
    "magnons",
    "rod",
    "lattice",
    "skyrmion",
    "chiral",
];

/// Scenes whose short runs take seconds too: most end with a plan or a fit.
const PLANNED: [&str; 4] = ["underwater_vehicle", "slew", "plate_ball", "inertia_estimation"];

/// Whether a run by default is made.
fn is_made(scene: &str) -> bool {
    cfg!(feature = "heavy") || !LONG.contains(&scene)
}

fn run(scene: &str, arguments: &[&str]) -> Output {
    let test = std::env::current_exe().expect("a test has a path");
    let program = test.ancestors().nth(2).expect("cargo's layout").join("examples").join(scene);
    let output = Command::new(&program).args(arguments).output();
    output.unwrap_or_else(|error| panic!("{}: {error}; run `cargo build --examples` first", program.display()))
}

/// The output on standard error of a run that has to fail; it must not be a panic.
fn refusal(scene: &str, arguments: &[&str]) -> String {
    let output = run(scene, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success(), "{scene} {arguments:?} succeeded");
    assert!(!errors.contains("panicked"), "{scene} {arguments:?}: {errors}");
    errors
}

/// Runs a check for each case, as many at once as the machine has cores. The test fails where one of them does.
fn for_each<T: Sync>(cases: &[T], check: impl Fn(&T) + Sync) {
    let next = AtomicUsize::new(0);
    let workers = std::thread::available_parallelism().map_or(1, NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    check(case);
                }
            });
        }
    });
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

fn text(path: &Path) -> &str {
    path.to_str().expect("cargo's target folder has a readable name")
}

#[test]
fn defaults_hold_all_their_claims() {
    for_each(&SCENES, |(scene, _)| {
        if !is_made(scene) {
            return;
        }
        let figure = file(&format!("{scene}-default.svg"));
        let output = run(scene, &["--figure", text(&figure)]);
        let report = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{scene}: {report}{}", String::from_utf8_lossy(&output.stderr));
        assert!(report.contains("  holds  ") && !report.contains("  skipped  "), "{scene}: {report}");
        assert!(std::fs::read_to_string(figure).expect("the figure").contains("<polyline"));
    });
}

/// Scenes with a page that plays their motion, and the parts of the page.
#[test]
fn motions_are_written_as_pages() {
    for (scene, parts) in [("heavy_top", 3), ("double_pendulum", 5)] {
        let (page, figure) = (file(&format!("{scene}.html")), file(&format!("{scene}-motion.svg")));
        let output = run(scene, &["--steps", "10", "--figure", text(&figure), "--motion", text(&page)]);
        assert!(output.status.success(), "{scene}: {}", String::from_utf8_lossy(&output.stderr));
        let page = std::fs::read_to_string(page).expect("the page");
        assert!(page.contains(r#"{"count":11,"start":0.0,"end":0."#), "{scene}");
        assert_eq!(page.matches("\"kind\":").count(), parts, "{scene}");
    }
}

/// Scenes of plans, which short runs do not suit, and those of constraints and fields, which have no steps of order 1.
/// They are a name, flags, and the columns of the CSV file.
const PLANS: [(&str, &[&str], &str); 18] = [
    (
        "slew",
        &["--least", "effort"],
        "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,pi1,pi2,pi3,omega1,omega2,omega3,u1,u2,u3",
    ),
    ("trailer", &[], "step,time,x,y,heading,xt,yt,headingt,fold,v,omega,thrust,torque"),
    ("rolling_ball", &[], "step,time,x,y,vx,vy,w1,w2,w3"),
    ("sleigh", &[], "step,time,x,y,heading,omega,v,omega1,omega2,omega3"),
    ("rattleback", &[], "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,x1,x2,x3,w1,w2,w3"),
    ("snakeboard", &[], "step,time,x,y,heading,rotor,wheel,speed"),
    ("chain", &[], "step,time,x,y,z,speed,height,tension"),
    ("wave_map", &[], "step,time,energy,L1,L2,L3,q1,q2,q3"),
    ("kink", &[], "step,time,steps,exact,energy"),
    ("magnons", &[], "step,time,energy,L1,L2,L3,centre"),
    ("rod", &[], "step,time,x1,y1,z1,x2,y2,z2,energy,p1,p2,p3,L1,L2,L3"),
    ("lattice", &[], "step,time,energy,L3"),
    ("chiral", &[], "step,time,energy,curvature,apart"),
    ("skyrmion", &[], "step,time,q1,q2,q3,e1,e2,e3"),
    ("double_pendulum", &[], "step,time,x1,y1,z1,x2,y2,z2,a1,a2,a3,b1,b2,b3"),
    ("quadrotor", &[], "step,time,R11,R12,R13,R21,R22,R23,R31,R32,R33,x1,x2,x3,v1,v2,v3,pi1,pi2,pi3,u1,u2,u3,u4"),
    ("attitude_estimation", &[], "step,time,attitude,b1,b2,b3,a1,a2,a3,s1,s2,s3"),
    ("mpc", &[], "step,time,x1,x2,x3,r1,r2,r3,o1,o2,o3,lean,u1,u2,u3,u4"),
];

#[test]
fn plans_hold_all_their_claims_and_write_the_promised_columns() {
    for_each(&PLANS, |&(scene, arguments, columns)| {
        if !is_made(scene) {
            return;
        }
        let (csv, figure) = (file(&format!("{scene}-plan.csv")), file(&format!("{scene}-plan.svg")));
        let output = run(scene, &[arguments, &["--csv", text(&csv), "--figure", text(&figure)]].concat());
        let report = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{scene}: {report}{}", String::from_utf8_lossy(&output.stderr));
        assert!(report.contains("  holds  ") && !report.contains("  skipped  "), "{scene}: {report}");
        let written = std::fs::read_to_string(csv).expect("the plan");
        assert_eq!(written.lines().next(), Some(columns), "{scene}");
        assert!(written.lines().all(|line| line.split(',').count() == columns.split(',').count()), "{scene}");
        assert!(std::fs::read_to_string(figure).expect("the figure").contains("<polyline"));
    });
}

/// The study is no scene: it has its own flags. The pendulum is the fastest of its systems.
#[cfg(feature = "heavy")]
#[test]
fn work_and_precision_hold_their_claims() {
    let (csv, figures) = (file("work_precision.csv"), file("work_precision"));
    let arguments = ["--scene", "pendulum", "--csv", text(&csv), "--figures", text(&figures)];
    let output = run("work_precision", &arguments);
    let report = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{report}{}", String::from_utf8_lossy(&output.stderr));
    assert!(report.contains("  holds  ") && report.contains("advice"), "{report}");
    let written = std::fs::read_to_string(csv).expect("the points");
    assert!(written.starts_with("scene,method,order,h,tolerance,steps,error,ns_per_second,"));
    assert!(written.lines().all(|line| line.split(',').count() == 13));
    let figure = std::fs::read_to_string(figures.join("work_precision_pendulum.svg"));
    assert!(figure.expect("the figure").contains("<polyline"));
}

/// Runs with these flags succeed, and their claims hold.
fn hold_all_their_claims(cases: &[(&str, &[&str])]) {
    for_each(cases, |&(scene, arguments)| {
        let figure = file(&format!("{scene}{}.svg", arguments.concat()));
        let output = run(scene, &[arguments, &["--figure", text(&figure)]].concat());
        let report = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{scene} {arguments:?}: {report}{}", String::from_utf8_lossy(&output.stderr));
        assert!(report.contains("  holds  "), "{scene} {arguments:?}: {report}");
    });
}

#[test]
fn other_flags_hold_all_their_claims() {
    hold_all_their_claims(&[
        ("sphere_geodesics", &["--sphere", "3"]),
        ("sphere_geodesics", &["--sphere", "3", "--velocity", "0,0,0,0", "--steps", "10"]),
        ("sphere_geodesics", &["--sphere", "3", "--discretization", "exponential", "--steps", "2000"]),
        (
            "sphere_geodesics",
            &["--sphere", "3", "--discretization", "exponential", "--step-size", "5", "--steps", "100"],
        ),
        ("sphere_molecules", &["--sites", "12", "--order", "1", "--steps", "100"]),
        ("spin_chain", &["--steps", "200"]),
        ("spin_chain", &["--order", "1", "--steps", "300"]),
        ("spin_chain", &["--sites", "8", "--field", "0"]),
        ("spin_chain", &["--tilt", "0", "--turns", "0", "--steps", "10"]),
        ("sphere_geodesics", &["--sphere", "20", "--steps", "2000"]),
        ("sphere_geodesics", &["--sphere", "100", "--steps", "200"]),
        ("rigid_body_n", &["--momentum", "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0", "--steps", "10"]),
        ("rigid_body_n", &["--j-d", "1,1,1,1,1,1", "--steps", "100"]),
        ("rigid_body_5d", &["--momentum", "0,0,0,0,0,0,0,0,0,0", "--steps", "10"]),
        (
            "relativistic_spin",
            &["--electric", "1000,0,0", "--magnetic", "0,0,0", "--step-size", "0.1", "--steps", "100"],
        ),
        ("relativistic_spin", &["--anomaly", "-2", "--steps", "200"]),
        ("relativistic_spin", &["--step-size", "0.1", "--steps", "200"]),
        ("relativistic_spin", &["--electric", "0,0,0", "--magnetic", "0,0,0", "--steps", "10"]),
        ("sphere_bvp", &["--order", "1"]),
        ("sphere_bvp", &["--steps", "20"]),
        ("sphere_bvp", &["--gravity", "0", "--from", "0.6,0.8,0", "--to", "0,0,-1"]),
        ("spacecraft", &["--steps", "200"]),
        ("rigid_body_4d", &["--steps", "1000"]),
        ("rolling_ball", &["--hollow", "--tilt", "0.5"]),
        ("rolling_ball", &["--table", "-2", "--velocity", "0,0"]),
        ("sleigh", &["--offset", "0.2", "--turning", "-2", "--omega", "0.3,-0.4", "--steps", "300"]),
        ("sleigh", &["--speed", "1", "--turning", "1e-3", "--omega", "1,1.6", "--steps", "100"]),
        ("snakeboard", &["--rotor", "0", "--steps", "130"]),
        ("wave_map", &["--sites", "16", "--steps", "5"]),
        ("kink", &["--spacing", "0.2", "--step-size", "0.1", "--steps", "20"]),
        ("magnons", &["--sites", "60", "--steps", "100"]),
        ("rod", &["--edges", "4", "--steps", "50"]),
        ("lattice", &["--side", "24", "--steps", "1"]),
        ("chiral", &["--sites", "8", "--steps", "20"]),
        ("skyrmion", &["--steps", "8", "--step-size", "0.25", "--size", "2"]),
        ("rattleback", &["--steps", "20"]),
        ("double_pendulum", &["--steps", "8"]),
        ("chain", &["--links", "5", "--steps", "8"]),
        ("attitude_estimation", &["--steps", "24"]),
        ("trailer", &["--goal", "3,0,0", "--step-size", "1", "--steps", "8"]),
    ]);
}

/// The same for runs and plans that take seconds.
#[cfg(feature = "heavy")]
#[test]
fn long_runs_hold_all_their_claims() {
    hold_all_their_claims(&[
        ("sphere_molecules", &["--sites", "642", "--steps", "20"]),
        ("sphere_molecules", &["--sites", "12", "--order", "1"]),
        ("sphere_geodesics", &["--sphere", "20", "--steps", "20000"]),
        ("sphere_geodesics", &["--sphere", "100", "--steps", "2000"]),
        ("sphere_bvp", &["--steps", "80"]),
        ("kink", &["--spacing", "0.2", "--step-size", "0.1", "--steps", "60"]),
        ("rattleback", &["--steps", "60"]),
        ("double_pendulum", &["--steps", "20"]),
        ("spacecraft", &["--steps", "500"]),
        ("spin_chain", &["--steps", "500"]),
        ("chiral", &["--sites", "8", "--steps", "40"]),
        ("spin_chain", &["--sites", "100000", "--steps", "3"]),
        ("rigid_body_n", &["--dimension", "5", "--order", "1"]),
        ("rigid_body_n", &["--dimension", "7", "--j-d", "5,0,0.1,2,3,4,1", "--step-size", "0.02", "--steps", "1000"]),
        ("rigid_body_n", &["--dimension", "8", "--rate", "3", "--seed", "7", "--step-size", "0.03", "--steps", "1000"]),
        ("rigid_body_n", &["--dimension", "9", "--steps", "1000"]),
        ("rigid_body_n", &["--dimension", "10", "--steps", "1000"]),
        ("rigid_body_5d", &["--j-d", "5,0,0.1,2,3", "--step-size", "0.01"]),
        ("relativistic_spin", &["--electric", "10,200,-30", "--momentum", "0.1,0.2,0.3", "--spin", "0,1,2"]),
        ("relativistic_spin", &["--electric", "299.792458,0,0", "--magnetic", "0,0,1", "--momentum", "0,0,0"]),
        ("slew", &["--discretization", "cayley", "--to", "0,0,1,90", "--steps", "10"]),
        ("slew", &["--inertia", "1,1,1,0,0,0", "--steps", "20"]),
        ("slew", &["--steps", "1"]),
        ("unicycle", &["--goal", "2,3,-120", "--step-size", "0.1"]),
        ("unicycle", &["--goal", "-1,0.5,180", "--costate", "-0.5,2,-1.5", "--steps", "100"]),
        ("unicycle", &["--goal", "1,0,0", "--costate", "3,0,0", "--time-price", "100"]),
        ("unicycle", &["--turn-price", "0.04", "--costate", "0,1,0", "--top-turn", "1", "--miss-price", "0.1"]),
        ("slew", &["--least", "effort", "--torque", "250", "--heavier", "0.01", "--tilted", "1"]),
        ("wave_map", &["--sites", "30", "--turn", "-40", "--step-size", "0.1", "--steps", "20", "--time"]),
        ("wave_map", &["--turn", "0", "--spin", "0", "--length", "20", "--steps", "3"]),
        ("magnons", &["--tilt", "50", "--spin", "6", "--exchange", "2", "--step-size", "0.02", "--wavelength", "9"]),
        (
            "kink",
            &["--speed", "0.7", "--frequency", "0.8", "--length", "60", "--spacing", "0.05", "--step-size", "0.02"],
        ),
        ("rod", &["--statics"]),
        ("rod", &["--edges", "10", "--moment", "0,40,-80", "--push", "8,0,3", "--steps", "3000"]),
        ("lattice", &["--side", "100", "--steps", "4"]),
        ("skyrmion", &["--steps", "16", "--step-size", "0.25", "--size", "2"]),
        ("rattleback", &["--spin", "1", "--tilt", "2", "--steps", "8000"]),
        ("snakeboard", &["--wheels", "0.8", "--cycle", "2", "--steps", "1200"]),
        ("double_pendulum", &["--bars", "0.3,0.4,0.5", "--ground", "0.6", "--crank", "0", "--steps", "400"]),
        ("double_pendulum", &["--gravity", "0", "--upper", "0,0,1", "--steps", "300"]),
        ("chain", &["--links", "5", "--hand", "0.3,0.1,0.2", "--width", "0.1", "--steps", "1600"]),
        ("chain", &["--links", "40", "--hand", "0,0,0", "--lean", "0", "--steps", "200"]),
        ("chain", &["--links", "10", "--gravity", "0", "--time", "--steps", "900"]),
        ("ensemble", &["--bodies", "13", "--inertia", "1,1.5,2", "--tilt", "20", "--spin", "1", "--seed", "3"]),
        ("inertia_estimation", &["--noise", "2000", "--step-size", "0.05", "--steps", "12000", "--seed", "2"]),
        ("inertia_estimation", &["--spin", "0,0,0", "--step-size", "0.1", "--steps", "6000", "--guess", "1,1,1"]),
        ("inertia_estimation", &["--spin", "0,0,2.67", "--radius", "1e9", "--step-size", "0.5", "--steps", "1200"]),
        ("slew", &["--body", "envisat", "--time", "600", "--steps", "60", "--to", "0,0,1,180"]),
        ("slew", &["--discretization", "cayley", "--to", "0,0,1,90", "--steps", "100"]),
        ("plate_ball", &["--turn", "0,0,1,90"]),
        ("plate_ball", &["--radius", "1", "--goal", "2,1", "--steps", "50", "--step-size", "0.1"]),
        ("trailer", &["--goal", "-1,2,0", "--fold", "50"]),
        ("trailer", &["--goal", "3,0,0", "--step-size", "0.2", "--steps", "40"]),
        ("trailer", &["--steps", "80", "--step-size", "0.2", "--goals", "4"]),
        ("quadrotor", &["--step-size", "0.01", "--steps", "120"]),
        ("attitude_estimation", &["--seed", "2", "--window", "90", "--stride", "3"]),
        ("mpc", &["--gust", "0.02", "--seed", "2"]),
        ("mpc", &["--steps", "20", "--horizon", "20"]),
    ]);
}

#[test]
fn short_runs_of_both_orders_write_the_promised_columns() {
    for_each(&SCENES, |&(scene, columns)| {
        if !cfg!(feature = "heavy") && PLANNED.contains(&scene) {
            return;
        }
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
    });
}

/// The largest systems of scenes, both orders: name, flags, and the number of columns of the CSV file.
#[test]
fn short_runs_of_large_systems_write_all_columns() {
    for (scene, arguments, columns) in [
        ("rigid_body_n", ["--dimension", "10"], 2 + 100 + 45),
        ("sphere_geodesics", ["--sphere", "20"], 2 + 2 * 21),
        ("sphere_geodesics", ["--sphere", "100"], 2 + 2 * 101),
    ] {
        for order in ["1", "2"] {
            let (csv, figure) =
                (file(&format!("{scene}-large-{order}.csv")), file(&format!("{scene}-large-{order}.svg")));
            let run_flags = ["--steps", "10", "--order", order, "--csv", text(&csv), "--figure", text(&figure)];
            let output = run(scene, &[&arguments[..], &run_flags].concat());
            assert!(output.status.success(), "{scene}: {}", String::from_utf8_lossy(&output.stderr));
            let written = std::fs::read_to_string(csv).expect("the trajectory");
            assert!(written.lines().all(|line| line.split(',').count() == columns), "{scene} {arguments:?}");
            assert_eq!(written.lines().count(), 12, "{scene} {arguments:?}");
        }
    }
}

/// A scene, flags, and a part of the message.
type Mistake = (&'static str, &'static [&'static str], &'static str);

fn are_explained(mistakes: &[Mistake]) {
    for &(scene, arguments, expected) in mistakes {
        let errors = refusal(scene, arguments);
        assert!(errors.contains(expected), "{scene} {arguments:?}: {errors}");
    }
}

/// Those that are found by a run which takes seconds.
#[cfg(feature = "heavy")]
#[test]
fn late_mistakes_are_explained() {
    are_explained(&[
        ("slew", &["--least", "effort", "--torque", "100"], "bounds"),
        ("double_pendulum", &["--step-size", "0.1"], "was not reached"),
        ("ensemble", &["--step-size", "2"], "step 1 was not reached"),
    ]);
}

#[test]
fn mistakes_are_explained() {
    are_explained(&[
        ("toutatis", &["--inertia", "1,-2,3"], "`-2` is not above zero"),
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
        ("rigid_body_5d", &["--j-d", "3,2,-2,3,4"], "entries 2 and 3 have the sum 0"),
        ("rigid_body_5d", &["--momentum", "1,2,3"], "10 numbers separated by commas are needed, 3 were given"),
        ("rigid_body_5d", &["--step-size", "3"], "step 1 was not reached"),
        ("rigid_body_n", &["--dimension", "4"], "`4` is not a whole number from 5 to 10"),
        ("rigid_body_n", &["--j-d", "3,-3,2,3,4,5"], "entries 1 and 2 have the sum 0"),
        ("rigid_body_n", &["--dimension", "5", "--j-d", "1,2,3"], "in 5 dimensions 5 numbers"),
        ("rigid_body_n", &["--momentum", "1,2,3"], "15 numbers separated by commas are needed, 3 were given"),
        ("rigid_body_n", &["--momentum", "1,2,3", "--rate", "2"], "cannot be used with"),
        ("rigid_body_n", &["--rate", "0"], "`0` is not above zero"),
        ("rigid_body_n", &["--dimension", "10", "--step-size", "5"], "step 1 was not reached"),
        ("relativistic_spin", &["--spin", "0,0,0"], "has no direction"),
        ("relativistic_spin", &["--anomaly", "-1"], "the inertia against rotations would be infinite"),
        ("relativistic_spin", &["--mass", "0"], "`0` is not above zero"),
        ("relativistic_spin", &["--step-size", "1"], "step 1 was not reached"),
        ("relativistic_spin", &["--momentum", "1e200,0,0"], "the configuration is not finite"),
        ("sphere_bvp", &["--from", "0,2,0"], "normalise"),
        ("sphere_bvp", &["--to", "0,-0.6,0.8"], "where they are opposite, give a velocity"),
        ("sphere_bvp", &["--to", "0,0.6,-0.8"], "two different points are needed"),
        ("slew", &["--to", "1,2,3,720"], "two different attitudes are needed"),
        ("slew", &["--from", "0,0,0,10"], "an axis needs a direction"),
        ("slew", &["--inertia", "1,2,9,0,0,0"], "no body has the principal moments"),
        ("slew", &["--inertia", "1,2,3,0,0,0", "--body", "envisat"], "cannot be used with"),
        ("slew", &["--least", "effort", "--torque", "0"], "`0` is not above zero"),
        ("quadrotor", &["--order", "1"], "plans are made with steps of order 2"),
        ("quadrotor", &["--thrust", "0.05"], "hovering takes 0.0687 N of each rotor"),
        ("quadrotor", &["--to", "0,0,0", "--yaw", "0"], "another place to hover at is needed"),
        ("quadrotor", &["--mass", "-1"], "`-1` is not above zero"),
        ("attitude_estimation", &["--order", "1"], "estimates are made with steps of order 2"),
        ("attitude_estimation", &["--stride", "200"], "no more steps than those of --window"),
        ("mpc", &["--order", "1"], "plans are made with steps of order 2"),
        ("mpc", &["--horizon", "0"], "at least 1 is needed"),
        ("mpc", &["--gust", "-1"], "`-1` is not above zero"),
        ("mpc", &["--steps", "1000000"], "no more than 100000 fit"),
        ("slew", &["--least", "effort", "--to", "1,2,3,720"], "two different attitudes are needed"),
        ("slew", &["--time", "1800", "--step-size", "10"], "cannot be used with"),
        ("unicycle", &["--goal", "1,2"], "3 numbers separated by commas are needed, 2 were given"),
        ("unicycle", &["--goal", "0,0,360"], "a place other than the origin is needed"),
        ("unicycle", &["--turn-price", "0"], "`0` is not above zero"),
        ("unicycle", &["--costate", "1e300,1,1"], "numbers of this size overflow"),
        ("unicycle", &["--steps", "1"], "that there are enough steps"),
        ("plate_ball", &["--turn", "0,0,0,3"], "an axis needs a direction"),
        ("plate_ball", &["--turn", "1,0,0,0"], "another place or another attitude is needed"),
        ("plate_ball", &["--radius", "-1"], "`-1` is not above zero"),
        ("trailer", &["--order", "1"], "steps with a constraint have order 2"),
        ("trailer", &["--goal", "1,2"], "3 numbers separated by commas are needed, 2 were given"),
        ("trailer", &["--goal", "0,0,360"], "a place other than the start is needed"),
        ("trailer", &["--fold", "91"], "`91` is more than 90"),
        ("trailer", &["--thrust", "0"], "`0` is not above zero"),
        ("rolling_ball", &["--order", "1"], "steps with a constraint have order 2"),
        ("rolling_ball", &["--table", "0"], "the table has to turn"),
        ("rolling_ball", &["--step-size", "0.1"], "was not reached"),
        ("sleigh", &["--turning", "0"], "both need a velocity that is not steady"),
        ("sleigh", &["--offset", "-1"], "`-1` is not above zero"),
        ("sleigh", &["--step-size", "10"], "was not reached"),
        ("rattleback", &["--spin", "-5"], "`-5` is not above zero"),
        ("rattleback", &["--step-size", "1"], "was not reached"),
        ("snakeboard", &["--wheels", "1.6"], "at a quarter of a turn the wheels stand across"),
        ("snakeboard", &["--cycle", "0"], "`0` is not above zero"),
        ("double_pendulum", &["--bars", "0.1,0.1,0.1"], "the loop cannot be closed"),
        ("double_pendulum", &["--ground", "0"], "`0` is not above zero"),
        ("chain", &["--links", "7"], "possible values: 5, 10, 20, 40"),
        ("chain", &["--width", "0"], "`0` is not above zero"),
        ("chain", &["--step-size", "0.2"], "was not reached"),
        ("wave_map", &["--order", "1"], "steps of fields have order 2 or more"),
        ("wave_map", &["--step-size", "0.1"], "the longest stable step"),
        ("wave_map", &["--sites", "3"], "`3` is not from 4 to 4096"),
        ("kink", &["--speed", "1"], "`1` is not below 1"),
        ("kink", &["--length", "20"], "the tails of the solitons reach the ends"),
        ("kink", &["--step-size", "0.1", "--steps", "240"], "the longest stable step"),
        ("magnons", &["--tilt", "90"], "`90` is not below 90"),
        ("magnons", &["--step-size", "0.5"], "which is too far for waves"),
        ("magnons", &["--spin", "0"], "`0` is not above zero"),
        ("rod", &["--edges", "7"], "`7` is not an even number up to 10000"),
        ("rod", &["--step-size", "0.01"], "the longest stable step"),
        ("rod", &["--push", "1,2"], "3 numbers separated by commas are needed, 2 were given"),
        ("lattice", &["--side", "23"], "`23` is not from 24 to 1024"),
        ("chiral", &["--sites", "3"], "`3` is not from 4 to 512"),
        ("chiral", &["--step-size", "0.1"], "the longest stable step"),
        ("skyrmion", &["--size", "0.4"], "a skyrmion of less than 4 falls through it"),
        ("skyrmion", &["--steps", "15"], "15 cells are not an even number from 8 to 1024"),
        ("lattice", &["--step-size", "0.6"], "the longest stable step"),
        ("sphere_geodesics", &["--step-size", "2"], "step 1 was not reached"),
        ("sphere_geodesics", &["--sphere", "5"], "possible values: 3, 7, 20, 100"),
        ("sphere_geodesics", &["--position", "1,0,0,0"], "a point of S7 has 8 coordinates, 4 were given"),
        ("sphere_geodesics", &["--sphere", "3", "--position", "1,1,0,0"], "normalise"),
        ("sphere_geodesics", &["--sphere", "3", "--velocity", "1,x,0,0"], "`x` is not a number"),
        ("sphere_geodesics", &["--sphere", "100", "--position", "1,0"], "a point of S100 has 101 coordinates, 2 were"),
        ("sphere_geodesics", &["--sphere", "20", "--step-size", "2"], "step 1 was not reached"),
        ("sphere_geodesics", &["--discretization", "exponential"], "add --sphere 3"),
        ("underwater_vehicle", &["--semi-axes", "1,0,2"], "`0` is not above zero"),
        ("underwater_vehicle", &["--offset", "5"], "its inertia is not positive"),
        ("underwater_vehicle", &["--spin", "fast"], "`fast` is not a number"),
        (
            "fluid_ellipsoid",
            &["--gradient", "1,0,0,0,1,0,0,0,1"],
            "the trace is 3, so the flow would change the volume",
        ),
        ("fluid_ellipsoid", &["--semi-axes", "1e-300,1,1e300"], "are too far apart"),
        ("ensemble", &["--inertia", "2,1,2.5"], "the second moment has to lie between the others"),
        ("ensemble", &["--bodies", "0"], "at least 1 is needed"),
        ("spacecraft", &["--inertia", "1,1,3,0,0,0"], "no body has the principal moments"),
        ("spacecraft", &["--mass", "1e-9"], "is too large for an orbit"),
        ("spacecraft", &["--step-size", "1e4"], "is too long for an orbit with a period"),
        ("inertia_estimation", &["--inertia", "1,1,3,0,0,0"], "no body has this inertia"),
        ("inertia_estimation", &["--steps", "2"], "do not determine 11 numbers"),
        ("inertia_estimation", &["--spin", "1e300,0,0"], "take shorter steps"),
        ("inertia_estimation", &["--noise", "0"], "`0` is not above zero"),
        ("spacecraft", &["--eccentricity", "1"], "`1` is not in 0 to 0.9"),
    ]);
}

/// All sections of the map, with little work: each prints its tables, its claims hold, and every cell is written.
#[cfg(feature = "heavy")]
#[test]
fn the_map_of_the_edge_holds_its_claims() {
    let sections = [
        ("step-sizes", "most: off 31 digits", 1000),
        ("inertia", "needle, 1e-12", 200),
        ("magnitudes", "length", 5000),
        ("starts", "on the separatrix", 400),
        ("potentials", "order 16", 70),
        ("random-states", "iterations", 18),
        ("long-runs", "exponent p", 90),
    ];
    for_each(&sections, |&(section, word, cells)| {
        let csv = file(&format!("extremes-{section}.csv"));
        let arguments = ["--quick", "--section", section, "--csv", text(&csv)];
        let output = run("extremes", &arguments);
        let report = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{report}{}", String::from_utf8_lossy(&output.stderr));
        assert!(report.contains("  holds  ") && report.contains(word), "{report}");
        let written = std::fs::read_to_string(&csv).expect("the cells");
        assert!(written.starts_with("section,scene,dial,scalar,value,outcome,"));
        assert!(written.lines().all(|line| line.split(',').count() == 13), "{section}");
        assert!(written.lines().count() > cells, "{section}: {}", written.lines().count());
    });
    let errors = refusal("extremes", &["--section", "nothing"]);
    assert!(errors.contains("step-sizes"), "{errors}");
}

/// Every picture of the book's concepts is drawn again, and its claims hold.
#[cfg(feature = "heavy")]
#[test]
fn the_pictures_of_the_concepts_are_drawn() {
    let folder = file("concepts");
    let output = run("figures", &[text(&folder)]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let report = String::from_utf8_lossy(&output.stdout);
    let page = include_str!("../../docs/book/src/concepts/optimal-control.md");
    for price in ["9.615", "20.750"] {
        assert!(report.contains(price) && page.contains(price), "{price} is not in {report}");
    }
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/book/src/concepts");
    for page in std::fs::read_dir(&book).expect("the concepts of the book") {
        let picture = page.expect("a file").path().with_extension("svg");
        let name = picture.file_name().expect("a name");
        assert!(picture.is_file() && folder.join(name).is_file(), "no picture {}", name.display());
    }
}
