//! Pictures of a motion in closed form, and of numbers that no picture expects.

use crate::figure::{self, Panel, Path, Plane, Series};
use crate::{PlotError, Sphere, drift, quantities, sphere, work_precision};
use clebsch::{Clebsch, Declared, DoubleDouble, Error, Scalar};
use nalgebra::{Vector1, Vector2, Vector3};

/// A point that flies freely: x = x₀ + v t.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<2>, x: Vector2| x + a,
    cost      = |h, a| self.mass * a.norm_squared() / (2 * h),
    potential = |x| self.weight * x.y,
    scalar    = f32,
)]
struct Stone {
    mass: f32,
    weight: f32,
}

/// A body on a spring, by two methods.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| self.stiffness * x.norm_squared() / 2,
    method Fine = (order = 8),
)]
struct Spring {
    stiffness: f64,
}

struct Fine;

/// The texts of a picture.
fn texts(svg: &str) -> Vec<&str> {
    svg.split("<text")
        .skip(1)
        .filter_map(|part| part.split_once(">\n")?.1.split_once("\n<"))
        .map(|(text, _)| text)
        .collect()
}

/// The points of the lines of a picture, in its units.
fn lines(svg: &str) -> Vec<Vec<(f64, f64)>> {
    let point = |text: &str| {
        let (x, y) = text.split_once(',').expect("two coordinates");
        (x.parse().expect("a number"), y.parse().expect("a number"))
    };
    let attributes =
        svg.split("<polyline").skip(1).filter_map(|line| line.split("points=\"").nth(1)?.split('"').next());
    attributes.map(|points| points.split_whitespace().map(point).collect()).collect()
}

#[test]
fn charts_have_the_names_units_and_lines_of_their_columns() {
    let stepper = Stone { mass: 2.0, weight: 0.0 }.into_stepper(0.5).expect("a stepper");
    let start = stepper.state(Vector2::zeros(), Vector2::new(6.0, -2.0)).expect("a state");
    let states = stepper.trajectory(start).every(0.5).with_times().take(9);
    let table = stepper.table().energy().units(&[("t", "s"), ("x", "m")]);
    let picture = quantities(table, states).expect("a picture").only(&["x"]).expect("the value").title("a < b & c");
    let svg = picture.svg().expect("an SVG file");
    let texts = texts(&svg);
    for text in ["a &lt; b &amp; c", "x  (m)", "x.x", "x.y", "t (s)"] {
        assert!(texts.contains(&text), "{text} is not in {texts:?}");
    }
    // x = 3 t and y = −t from t = 0 to 4: straight lines, one three times as steep upwards
    let all = lines(&svg);
    let curves: Vec<_> = all.iter().filter(|line| line.len() == 9).collect();
    let rise = |line: &[(f64, f64)]| line[0].1 - line[8].1;
    assert_eq!(curves.len(), 2);
    assert!((rise(curves[0]) / rise(curves[1]) + 3.0).abs() < 0.01, "{curves:?}");
    for line in curves {
        let middle = ((line[0].0 + line[8].0) / 2.0, (line[0].1 + line[8].1) / 2.0);
        assert!((line[4].0 - middle.0).abs() <= 1.0 && (line[4].1 - middle.1).abs() <= 1.0);
    }
}

#[test]
fn drifts_are_relative_to_what_moves_and_the_law_is_that_of_the_scalar() {
    // kick and drift of order 2 under a constant force: the energy m g²h²/8 of the kicks alone is lost, at every step the same
    let stepper = Stone { mass: 2.0, weight: 4.0 }.into_stepper(0.25).expect("a stepper");
    let start = stepper.state(Vector2::new(0.0, 8.0), Vector2::new(6.0, 0.0)).expect("a state");
    let states = stepper.trajectory(start).every(0.25).with_times().take(17);
    let picture = drift(stepper.table().energy().conserved(), states).expect("a picture");
    assert_eq!(picture.largest("along e1, spatial"), Some(0.0));
    assert_eq!(picture.largest("energy"), Some(0.0), "falling bodies are exact by kicks and drifts");
    let svg = picture.svg().expect("an SVG file");
    assert!(texts(&svg).contains(&"energy: no change"), "{:?}", texts(&svg));
    // ε of f32 is 1.2e-7, so the law goes from 1e-7 to below 1e-6
    assert!(texts(&svg).contains(&"1e-7") && texts(&svg).contains(&"1e-6"));

    // a number of one's own, by a scale of one's own
    let states = || stepper.trajectory(start).every(0.25).with_times().take(17);
    let height = drift(stepper.table().with("height", |state| state.configuration().y), states()).expect("a picture");
    // y = 8 − g t²/2 with g = 2 falls by 16 in 4 seconds
    assert_eq!(height.clone().scale("height", 32.0).expect("the column").largest("height"), Some(0.5));
    assert!(matches!(height.clone().scale("depth", 1.0), Err(PlotError::UnknownName { .. })));
    assert!(matches!(height.scale("height", 0.0), Err(PlotError::Range { .. })));
}

#[test]
fn energies_are_relative_to_kinetic_and_potential_energy() {
    // kicks and drifts conserve p²/2 + k (1 − k h²/4) x²/2. So the energy falls by k² h²/8 from x = 1, p = 0 to x = 0.
    let (k, h) = (4.0, 0.01);
    let stepper = Spring { stiffness: k }.into_stepper(h).expect("a stepper");
    let start = stepper.state(Vector1::new(1.0), Vector1::zeros()).expect("a state");
    let states = stepper.trajectory(start).every(h).with_times().take(2000);
    let picture = drift(stepper.table().energy(), states).expect("a picture");
    let (kinetic, potential) = (k / 2.0 * (1.0 - k * h * h / 4.0), k / 2.0);
    let expected = k * k * h * h / 8.0 / (kinetic + potential);
    let found = picture.largest("energy").expect("the energy");
    assert!((found / expected - 1.0).abs() < 1e-3, "{found:e}, {expected:e}");
    let over_joules = picture.scale("energy", 2.0).expect("the energy").largest("energy");
    assert!(over_joules.is_some_and(|found| (found / (k * k * h * h / 16.0) - 1.0).abs() < 1e-3), "{over_joules:?}");
}

/// A point on a line, in any scalar.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
struct Particle<T: Scalar> {
    mass: T,
}

#[test]
fn drifts_have_the_digits_of_their_scalar() {
    // x = 1 + 10⁻²⁵ t, whose change is below the digits of f64
    let stepper =
        Particle { mass: DoubleDouble::from_f64(1.0) }.into_stepper(DoubleDouble::from_f64(1.0)).expect("a stepper");
    let [one, slow] = [1.0, 1e-25].map(DoubleDouble::from_f64);
    let start = stepper.state(Vector1::new(one), Vector1::new(slow)).expect("a state");
    let states = stepper.trajectory(start).every(one).with_times().take(5);
    let picture = drift(stepper.table().with("place", |state| *state.configuration()), states).expect("a picture");
    let moved = picture.largest("place.x").expect("the column");
    assert!((moved / 4e-25 - 1.0).abs() < 1e-6, "{moved:e}");
    // the law begins at ε of the scalar, and so does the picture
    let lowest = format!("1e{}", DoubleDouble::EPSILON.to_f64().log10().floor());
    assert!(picture.svg().is_ok_and(|svg| texts(&svg).contains(&lowest.as_str())), "{lowest}");
}

#[test]
fn errors_of_methods_are_those_against_the_closed_form() {
    let start = (Vector1::new(1.0), Vector1::zeros());
    let study = work_precision(&Spring { stiffness: 4.0 }, start, 1.0).expect("a study").steps(&[1, 10, 20]);
    let study = study.method::<Declared>("order 2").and_then(|study| study.method::<Fine>("order 8"));
    let study = study.and_then(|study| study.reference::<Fine>(400)).expect("a reference");
    assert!(study.reference_error() < 1e-12, "{}", study.reference_error());
    // the step of order 2 turns the phase by acos(1 − (2h)²/2) in place of 2h
    for (error, steps) in study.errors("order 2")[1..].iter().zip([10.0, 20.0]) {
        let phase = steps * f64::acos(1.0 - 2.0 / (steps * steps));
        assert!((error - (phase.cos() - 2_f64.cos()).abs()).abs() < 1e-12, "{steps}");
    }
    assert_eq!((study.errors("order 8").len(), study.errors("order 4").len()), (3, 0));
    let texts = study.svg().expect("an SVG file");
    assert!(texts.contains("order 8") && texts.contains("error of the reference"));

    let study = || work_precision(&Spring { stiffness: 4.0 }, start, 1.0).expect("a study");
    assert!(matches!(study().reference::<Declared>(10), Err(PlotError::Nothing)));
    let refused = study().steps(&[]).method::<Declared>("none");
    assert!(matches!(refused, Err(PlotError::Nothing)));
    let refused = study().steps(&[0]).method::<Declared>("none");
    assert!(matches!(refused, Err(PlotError::NoRun { error: Error::StepSize { .. }, .. })), "{refused:?}");
    let refused = work_precision(&Spring { stiffness: 4.0 }, start, f64::INFINITY);
    assert!(matches!(refused, Err(PlotError::Range { name: "duration", .. })));
}

#[test]
fn paths_lie_where_their_points_are() {
    // from above, the third axis is the centre; the ring of a point that stays has its middle there
    let sphere = Sphere::new().path("axis", vec![Vector3::<f64>::z(); 3]).expect("a path").view(0.0, 90.0);
    let svg = sphere.size(400, 400).svg().expect("an SVG file");
    let all = lines(&svg);
    let ring: Vec<_> = all.iter().rev().take_while(|line| line.len() < 13).flatten().collect();
    let near = |(x, y): &&(f64, f64)| (x - 2000.0).abs() < 40.0 && (y - 2000.0).abs() < 40.0;
    assert!(ring.iter().filter(|point| near(point)).count() >= 12, "{ring:?}");
    // equal directions are equal pictures, at every length
    let path = |length: f64| {
        let points = (0..40).map(|i| f64::from(i) / 5.0).map(|a| Vector3::new(a.cos(), a.sin(), 0.2 * a) * length);
        Sphere::new().path("axis", points).and_then(|sphere| sphere.svg()).expect("an SVG file")
    };
    assert_eq!((path(1.0), path(1.0)), (path(1024.0), path(f64::exp2(-1000.0))));
}

#[test]
fn nothing_and_what_is_not_finite_are_named() {
    let stepper = Stone { mass: 2.0, weight: 0.0 }.into_stepper(3e38).expect("a stepper");
    let start = stepper.state(Vector2::zeros(), Vector2::new(6.0, 0.0)).expect("a state");
    let failed = sphere(stepper.trajectory(start).take(1), |state| *state.configuration());
    assert!(matches!(failed, Err(PlotError::NoDirection { index: 0, .. })), "{failed:?}");
    let failed = sphere(stepper.trajectory(start), |_| Vector3::<f64>::x());
    assert!(matches!(failed, Err(PlotError::Step { index: 1, .. })), "{failed:?}");
    let none = quantities(stepper.table(), stepper.trajectory(start).every(1.0).with_times().take(0));
    assert!(matches!(none, Err(PlotError::Nothing)));
    let some = || [Ok((0.0, start)), Ok((1.0, start))];
    let bad = quantities(stepper.table().with("bad", |state| 1.0 / state.configuration().x), some());
    assert!(matches!(&bad, Err(PlotError::NotFinite { name, index: 0 }) if name == "bad"), "{bad:?}");
    let unknown = quantities(stepper.table(), some()).and_then(|picture| picture.only(&["N", "energy"]));
    let message = unknown.expect_err("no energy").to_string();
    assert_eq!(message, "no value is called `energy`; those of the table are `x`, `N`");
    assert!(matches!(drift(stepper.table(), some()).expect("a picture").svg(), Err(PlotError::Nothing)));
    // a file where a folder should be
    let picture = quantities(stepper.table(), some()).expect("a picture");
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml/picture.svg");
    assert!(matches!(picture.save(path), Err(PlotError::File { .. })));
}

#[test]
fn pictures_of_any_numbers_are_drawn() {
    let values = [0.0, -0.0, 1.0, -1.0, 5e-324, 1e-300, 1.0 + f64::EPSILON, 1e17, 1e300, -1e300, f64::MAX, f64::MIN];
    let more = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];
    for &a in values.iter().chain(&more) {
        for &b in values.iter().chain(&more) {
            let points = vec![(a, b), (b, a), (a, a)];
            let series = vec![Series { label: "", colour: figure::RED, points: points.clone() }];
            let panel = Panel { title: "", unit: "", x_label: "x", series };
            let paths = [Path { label: "", points: &points, colour: None, width: 1.0 }];
            let curve = figure::Curve {
                label: "",
                colour: figure::RED,
                width: 1.0,
                points: points.clone(),
                ringed: Vec::new(),
            };
            let chart = figure::Decades { title: "", x_label: "", y_label: "", curves: &[curve] };
            let cells =
                figure::Cells { x_label: "x", y_label: "y", x: (a, b), y: (b, a), columns: &[vec![figure::RED]] };
            let track = figure::Track { points: &[[a, b, a], [b, b, b]], colour: None, width: 1.0 };
            let view = figure::View { azimuth: a, elevation: b };
            let globe = figure::Globe { view, pointers: &[], tracks: &[track] };
            let svg = figure::svg((300, 200), |area| {
                panel.draw(area)?;
                Plane { unit: "", paths: &paths, arrows: &[] }.draw(area)?;
                chart.draw(area)?;
                figure::Interval { title: "", published: a, uncertainty: b, computed: a }.draw(area)?;
                cells.draw(area)?;
                globe.draw(area)
            });
            assert!(svg.is_ok_and(|svg| svg.len() < 100_000), "{a:e}, {b:e}");
        }
    }
    for size in [0, 1, 300, u32::MAX] {
        let sphere = Sphere::new().path("axis", [Vector3::new(1.0, 0.0, 0.0)]).expect("a path");
        assert!(sphere.size(size, size).svg().is_ok());
    }
    let sheet = figure::Vectors { side: 1.0, count: 0, vectors: &[] };
    assert!(figure::svg((300, 200), |area| sheet.draw(area)).is_ok());
    let sheet = figure::Vectors { side: 1.0, count: 9, vectors: &[Vector3::x()] };
    assert!(figure::svg((300, 200), |area| sheet.draw(area)).is_ok());
}
