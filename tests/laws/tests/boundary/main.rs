//! Fixed endpoints by the generated code: against published optima, closed forms, the stepper and the first-order conditions.

mod direct;
mod free_ends;
mod limits;
mod pairs;
mod singular;
mod systems;
mod ways;

use clebsch::{Clebsch, Error, Extremal, Guess, Node, Stepper, Variational};
use clebsch_tests::oracle::near::assert_near;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, Rotation3, SVector, Vector3};
use systems::{Chain, Composed, Flyer, Free, Point, Satellite, Top, Vehicle};

fn rotation(axis: Vector3<f64>) -> Matrix3<f64> {
    *Rotation3::from_scaled_axis(axis).matrix()
}

/// P5: 2.5 rad about (1, 2, 3)/√14 in one second.
fn slewed() -> Matrix3<f64> {
    rotation(Vector3::new(1.0, 2.0, 3.0) * (2.5 / 14.0_f64.sqrt()))
}

/// The optima were found by an interior point method and two other solvers, which agree in all digits.
#[test]
fn optimal_actions_of_a_slew() -> Result<(), Error> {
    let free = Free { mass: Vector3::new(2.0, 1.0, 0.0) };
    let stepper = free.stepper(0.02)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&Matrix3::identity()); 50];
    let extremal = boundary.solve(&Matrix3::identity(), &slewed(), Guess::Geodesic, &mut path)?;
    println!("{extremal:?}");
    assert!((extremal.action() - 7.470_515_323_9).abs() < 1e-10);
    assert_eq!(extremal.negative(), 0);
    shot(&stepper, &extremal, 1e-11)?;

    let top = Top { mass: Vector3::new(2.0, 1.0, 0.0), weight: 1.0 };
    let stepper = top.stepper(0.02)?;
    let boundary = stepper.boundary();
    let mut path = [boundary.rest(&Matrix3::identity()); 50];
    let extremal = boundary.solve(&Matrix3::identity(), &slewed(), Guess::Geodesic, &mut path)?;
    println!("{extremal:?}");
    assert!((extremal.action() - 6.832_031_192_2).abs() < 1e-10);
    assert_eq!(extremal.negative(), 0);
    shot(&stepper, &extremal, 1e-11)
}

/// Steps from the start with the momentum that was found lead through all vertices: the costate is the momentum map.
fn shot<S, const M: usize>(stepper: &Stepper<S>, extremal: &Extremal<'_, S, M>, tolerance: f64) -> Result<(), Error>
where
    S: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let mut states = extremal.states();
    let mut state = states.next().expect("a start");
    for found in states {
        state = stepper.step(&state)?;
        let off = clebsch::Space::distance_squared(state.configuration(), found.configuration()).sqrt();
        assert!(off < tolerance, "{}: {off:.1e} from the path", S::NAME);
        let scale = 1.0 + found.momentum().amax();
        assert!((state.momentum() - found.momentum()).amax() < tolerance * scale, "{}", S::NAME);
    }
    Ok(())
}

/// Solves from `q` to where steps with the momentum `mu` lead, N edges in all, from a guess that knows nothing of it, and shoots.
fn found_again<S, const M: usize, const N: usize>(
    stepper: &Stepper<S>,
    q: S::Configuration,
    mu: SVector<f64, M>,
    guess: Guess<f64, M>,
) -> Result<(), Error>
where
    S: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>>,
{
    let steps = N / S::EDGES;
    let start = stepper.state(q, mu)?;
    let target = stepper.trajectory(start).nth(steps).expect("endless")?;
    let boundary = stepper.boundary();
    let mut path: [Node<S, M>; N] = [boundary.rest(&q); N];
    let extremal = boundary.solve(&q, target.configuration(), guess, &mut path)?;
    println!("{}: {extremal:?}", S::NAME);
    assert!(extremal.gap() < 1e-12, "{}: {:?}", S::NAME, extremal);
    // over so short a time there is one extremal near rest, and it is a minimum
    let off = (extremal.momentum() - mu).amax();
    assert!(off < 1e-11, "{}: {off:.1e} from the momentum of the shot", S::NAME);
    assert_eq!(extremal.negative(), 0, "{}", S::NAME);
    shot(stepper, &extremal, 1e-9)
}

#[test]
fn two_edges_a_step() -> Result<(), Error> {
    let random = &mut Random::new(91);
    for _ in 0..3 {
        let system = Composed { mass: Vector3::new(1.0, 1.2, 0.9), skew: 0.05, weight: 0.7 };
        let stepper = system.stepper(0.05)?;
        found_again::<_, 3, 40>(&stepper, random.attitude(), random.vector(), Guess::Geodesic)?;
    }
    Ok(())
}

#[test]
fn logarithms_and_time() -> Result<(), Error> {
    let random = &mut Random::new(92);
    let system = Satellite { inertia: Vector3::new(1.0, 1.4, 1.9), orbital_rate: 0.8 };
    let stepper = system.stepper(0.05)?;
    for _ in 0..3 {
        found_again::<_, 3, 20>(&stepper, random.attitude(), random.vector(), Guess::Geodesic)?;
    }
    Ok(())
}

#[test]
fn motions_in_space() -> Result<(), Error> {
    let random = &mut Random::new(93);
    let system = Vehicle { inertia: Vector3::new(1.0, 1.4, 1.9), mass: Vector3::new(1.0, 1.5, 2.0), weight: 0.3 };
    let stepper = system.stepper(0.05)?;
    for _ in 0..3 {
        let mut q: Matrix4<f64> = random.rotation::<3>(1.0).to_homogeneous();
        q.fixed_view_mut::<3, 1>(0, 3).copy_from(&random.vector::<3>());
        found_again::<_, 6, 20>(&stepper, q, random.vector(), Guess::Geodesic)?;
    }
    Ok(())
}

#[test]
fn products_with_a_part_that_no_motion_fixes() -> Result<(), Error> {
    let random = &mut Random::new(94);
    let system = Flyer { mass: 1.7, inertia: 0.8, pull: 1.1 };
    let stepper = system.stepper(0.05)?;
    for _ in 0..3 {
        let q: Vector3<f64> = random.unit();
        let tangent = q.cross(&random.vector());
        let mu = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { [0.4, -0.3, 0.2][i] } else { tangent[i - 3] });
        found_again::<_, 6, 20>(&stepper, (random.vector(), q), mu, Guess::Geodesic)?;
    }
    Ok(())
}

/// The spheres of two pendulums, each with its isotropy.
#[test]
fn products_of_spheres() -> Result<(), Error> {
    let random = &mut Random::new(95);
    let stepper = Chain { coupling: 0.3 }.stepper(0.05)?;
    for _ in 0..3 {
        let (p, q): (Vector3<f64>, Vector3<f64>) = (random.unit(), random.unit());
        let (m, n) = (p.cross(&random.vector()), q.cross(&random.vector()));
        let mu = SVector::<f64, 6>::from_fn(|i, _| if i < 3 { m[i] } else { n[i - 3] });
        found_again::<_, 6, 20>(&stepper, (p, q), mu, Guess::Geodesic)?;
    }
    Ok(())
}

/// Without forces a point moves on a straight line, for any number of steps.
#[test]
fn straight_lines() -> Result<(), Error> {
    let stepper = Point { mass: 2.0 }.stepper(0.1)?;
    let boundary = stepper.boundary();
    let (start, target) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(2.0, 0.0, 3.5));
    let mut path = [boundary.rest(&start); 8];
    let extremal = boundary.solve(&start, &target, Guess::Geodesic, &mut path)?;
    assert_near(extremal.momentum(), &((target - start) * (2.0 / 0.8)), 1e-13, "momentum of a straight line");
    assert!((extremal.action() - (target - start).norm_squared() / 0.8).abs() < 1e-13);
    Ok(())
}

/// All but one of a thousand pairs away from the cut locus are joined by a path at least. The others have an error of
/// their own.
///
/// `CLEBSCH_RANDOM=10000` takes as many pairs of each system, and `-- --nocapture` shows their outcome.
#[test]
fn random_endpoints() {
    let count = std::env::var("CLEBSCH_RANDOM")
        .map_or(if cfg!(feature = "heavy") { 500 } else { 50 }, |count| count.parse().expect("a count of pairs"));
    for line in pairs::lines(count) {
        let pairs::Line { system, away, solved, near, solved_near, no_minimum, iterations, most, errors } = &line;
        println!(
            "{system}: {solved} of {away} and near the cut locus {solved_near} of {near}, {no_minimum} no minimum; {iterations} \
             linearisations, {most} at most; {errors:?}"
        );
        assert!(line.share() >= 0.999, "{system}: {solved} of {away}, {errors:?}");
    }
}
