//! Pages of motions in closed form. `runtime/plot/check` tries them in a browser.

use crate::{Motion, PlotError, Pose, Shape};
use clebsch::Error;
use nalgebra::{Matrix4, Quaternion, Rotation3, UnitQuaternion, Vector2, Vector3};

/// States without a system: their times.
fn times(times: &[f64]) -> impl Iterator<Item = Result<(f64, f64), Error>> {
    times.iter().map(|time| Ok((*time, *time)))
}

/// A point on a circle of radius 2 about (1, 0, 0), once round in 4 seconds, in the plane of the first two axes.
fn circle(t: &f64) -> Vector3<f64> {
    let angle = t * std::f64::consts::FRAC_PI_2;
    Vector3::new(1.0 + 2.0 * angle.cos(), 2.0 * angle.sin(), 0.0)
}

/// The page that the browser is to show: every kind of part, with names that are no HTML.
fn page() -> String {
    let all: Vec<f64> = (0..=400).map(|i| f64::from(i) / 100.0).collect();
    let turned = |t: &f64| Rotation3::from_axis_angle(&Vector3::z_axis(), t * std::f64::consts::FRAC_PI_2).into_inner();
    let placed = move |t: &f64| Matrix4::new_translation(&Vector3::new(0.0, 0.0, 2.0)) * turned(t).to_homogeneous();
    let motion = Motion::new(times(&all)).expect("states").title("<b> & \"c\"").time_unit("s").sphere(1.0);
    let motion = motion.body("</script><b>book", Shape::cuboid([1.0, 0.6, 0.2]), turned);
    let motion = motion.and_then(|motion| motion.body("ball", Shape::ellipsoid([1.0, 0.6, 0.6]), placed));
    let motion = motion.and_then(|motion| motion.point("point", circle));
    let motion = motion.and_then(|motion| motion.link("rod", |t| [Vector3::x(), Vector3::x() * 0.1 + circle(t) * 0.9]));
    let motion = motion.and_then(|motion| motion.arrow("arrow", |_| [Vector3::new(-1.0, 0.0, 0.0), Vector3::z()]));
    motion.and_then(|motion| motion.frame("frame", 0.8, placed)).and_then(|motion| motion.html()).expect("a page")
}

/// The numbers behind a key of the motion, each list of changes summed up.
fn numbers(page: &str, kind: &str) -> Vec<Vec<f64>> {
    let part = page.split(&format!("\"kind\":\"{kind}\"")).nth(1).expect("the part");
    let data = part.split("\"data\":[").nth(1).and_then(|data| data.split("]]").next()).expect("its data");
    let channel = |text: &str| {
        let changes = text.trim_start_matches('[').split(',').map(|change| change.parse::<f64>().expect("a number"));
        changes
            .scan(0.0, |sum, change| {
                *sum += change;
                Some(*sum)
            })
            .collect()
    };
    data.split("],").map(channel).collect()
}

#[test]
fn pages_have_the_points_of_a_motion_and_load_nothing() {
    let page = page();
    // the picture is a ball about everything: the ends of the arrow and of the frame are farthest from its middle
    let [x, y, z] = &numbers(&page, "point")[..] else { panic!("three numbers of a point") };
    assert_eq!((x.len(), y.len(), z.len()), (401, 401, 1), "the third coordinate stays");
    let radius = 2.0 / ((x[0] - x[200]) / 2.0);
    for (i, t) in [(0, 0.0), (57, 0.57), (100, 1.0), (399, 3.99)] {
        let [dx, dy] = [x[i] - x[200], y[i] - y[200]].map(|change| change * radius);
        let expected = circle(&t) - circle(&2.0);
        assert!((dx - expected.x).abs() < 2.0 * radius && (dy - expected.y).abs() < 2.0 * radius, "{t}: {dx}, {dy}");
    }
    // half sides of the book at the start: 0.5, 0.3 and 0.1
    let book = numbers(&page, "cuboid");
    for (channel, side) in [(3, 0.5), (7, 0.3), (11, 0.1)] {
        assert!((book[channel][0] * radius - side).abs() < radius, "{channel}");
    }
    assert!(!page.contains("\"times\""), "even times need no list");
    for word in ["http:", "https:", "url(", "src=", "href", "import", "fetch", "</script><b>", "<b> &"] {
        assert!(!page.contains(word), "{word}");
    }
    assert!(page.contains("&lt;b&gt; &amp;") && page.contains(r"\u003c/script\u003e\u003cb\u003ebook"));
    assert_eq!((page.matches("<script").count(), page.matches("</script>").count()), (2, 2));
    assert!(page.len() < 50_000, "{}", page.len());
    if let Some(file) = std::env::var_os("CLEBSCH_PAGE") {
        std::fs::write(file, page).expect("the page for the browser");
    }
}

#[test]
fn poses_are_those_of_their_numbers() {
    let rotation = Rotation3::new(Vector3::new(0.3, -1.2, 0.7));
    let place = Vector3::new(1.0, 2.0, 3.0);
    let of_matrix = Pose::from((place, rotation.into_inner()));
    let quaternion = UnitQuaternion::from_rotation_matrix(&rotation);
    let scaled: Quaternion<f64> = quaternion.into_inner() * 3.0;
    let group = Matrix4::new_translation(&place) * rotation.to_homogeneous();
    for pose in [Pose::from((place, quaternion)), Pose::from((place, scaled)), Pose::from(group)] {
        let (a, b) = (pose.axes().concat(), of_matrix.axes().concat());
        assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-15), "{pose:?}, {of_matrix:?}");
        assert_eq!(pose.place(), of_matrix.place());
    }
    let point = rotation * Vector3::new(0.1, 0.2, 0.3) + place;
    assert!((Vector3::from(of_matrix.point([0.1, 0.2, 0.3])) - point).norm() < 1e-15);
    let flat = nalgebra::Rotation2::new(0.4).into_inner();
    assert_eq!(Pose::from((Vector3::new(1.0, 2.0, 0.0), flat)), Pose::in_plane(1.0, 2.0, 0.4));
    assert_eq!(Pose::from(Vector2::new(1.0_f32, 2.0)), Pose::in_plane(1.0, 2.0, 0.0));
    assert_eq!(Pose::from(Quaternion::new(0.0, 0.0, 0.0, 0.0)), Pose::in_plane(0.0, 0.0, 0.0));
}

#[test]
fn bodies_have_their_moments() {
    // m (b² + c²)/12 of a cuboid, m (b² + c²)/5 by the half axes of an ellipsoid
    let moments = [1.0, 1.7, 2.1];
    let of = |half: [f64; 3], share: f64| {
        [0, 1, 2].map(|i| 0.5 * share * (half[(i + 1) % 3].powi(2) + half[(i + 2) % 3].powi(2)))
    };
    for (shape, share) in [(Shape::cuboid_of(moments, 0.5), 1.0 / 3.0), (Shape::ellipsoid_of(moments, 0.5), 0.2)] {
        let found = of(shape.half_sides().expect("a body"), share);
        assert!(found.iter().zip(moments).all(|(found, moment)| (found - moment).abs() < 1e-14), "{found:?}");
    }
    // a plate has no third side, and is drawn with one
    assert!(Shape::cuboid_of([1.0, 2.0, 3.0], 1.0).half_sides().is_some_and(|half| half[2] > 0.0));
    let none = [
        Shape::cuboid_of([1.0, 2.0, 3.1], 1.0),
        Shape::cuboid_of([1.0; 3], 0.0),
        Shape::cuboid_of([1.0; 3], -1.0),
        Shape::ellipsoid([0.0; 3]),
        Shape::cuboid([1.0, -1.0, 1.0]),
        Shape::cuboid([1.0, f64::NAN, 1.0]),
    ];
    for shape in none {
        let refused =
            Motion::new(times(&[0.0])).and_then(|motion| motion.body("it", shape, |_| Pose::in_plane(0.0, 0.0, 0.0)));
        assert!(matches!(refused, Err(PlotError::NoBody { name }) if name == "it"), "{shape:?}");
    }
}

#[test]
fn what_cannot_be_played_is_named() {
    let nothing = Motion::new(times(&[]));
    assert!(matches!(nothing, Err(PlotError::Nothing)));
    assert!(matches!(Motion::new(times(&[0.0, 1.0])).expect("states").html(), Err(PlotError::Nothing)));
    for wrong in [[0.0, 1.0, 1.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.5], [0.0, -1.0, 2.0]] {
        let index = if wrong[1] == 0.0 { 1 } else { 2 };
        assert!(
            matches!(Motion::new(times(&wrong)), Err(PlotError::TimeOrder { index: found }) if found == index),
            "{wrong:?}"
        );
    }
    assert!(Motion::new(times(&[0.0, -1.0, -3.0])).is_ok(), "back in time");
    assert!(matches!(Motion::new(times(&[0.0, f64::NAN])), Err(PlotError::NotFinite { index: 1, .. })));
    let failed = [Ok((0.0, ())), Err(Error::StepSize { value: 0.0 })];
    assert!(matches!(Motion::new(failed), Err(PlotError::Step { index: 1, .. })));
    let two = || Motion::new(times(&[0.0, 1.0])).expect("states");
    let failed = two().point("it", |t| Vector3::new(1.0 / (1.0 - t), 0.0, 0.0));
    assert!(matches!(failed, Err(PlotError::NotFinite { name, index: 1 }) if name == "it"));
    let failed = two().frame("it", 0.0, |_| Pose::in_plane(0.0, 0.0, 0.0));
    assert!(matches!(failed, Err(PlotError::Range { .. })));
}

#[test]
fn pages_of_any_size_are_written() {
    for size in [0.0, 5e-324, 1e-300, 1.0, 1e300, f64::MAX] {
        for end in [0.5, 5e-324, f64::MAX] {
            let motion = Motion::new(times(&[0.0, end])).expect("states").sphere(size);
            let motion = motion.point("point", |t| Vector3::new(size, if *t > 0.0 { -size } else { size }, 0.0));
            let motion = motion.and_then(|motion| motion.arrow("arrow", |_| [Vector3::new(0.0, size, 0.0); 2]));
            let page = motion.and_then(|motion| motion.html()).expect("a page");
            assert!(!page.contains("NaN,") && !page.contains("inf"), "{size:e}");
            let [_, y, _] = &numbers(&page, "point")[..] else { panic!("three numbers") };
            assert!(y.iter().all(|y| y.abs() <= 10_001.0), "{size:e}, {end:e}: {y:?}");
        }
    }
    let uneven = Motion::new(times(&[0.0, 1.0, 4.0])).expect("states").point("point", circle);
    let page = uneven.and_then(|motion| motion.html()).expect("a page");
    assert!(page.contains("\"times\":[0,250000,750000]"));
}
