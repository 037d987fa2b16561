//! Plans of least price: `cargo bench -p clebsch-tests --bench control -- [PROBLEMS] [SEED]`.
//!
//! Random goals of a unicycle, of a body with bounded torques and of a quadrotor, all from a guess at rest. A car on random tracks, past
//! an obstacle that moves. A car whose sideways input vanishes by an equation, and a body whose tilt stays the same. Then a quadrotor that
//! is planned anew a hundred times a second while gusts push it. Printed are the share that is solved, and the median, the ninth decile and
//! the largest number of linearisations of a solution.
//!
//! With the word `cases`, `along`, `gusts` or `compare`, the problems are those that other solvers get too.

mod cases;
mod systems;
mod ticks;

use clebsch::{Controlled, Limits, Target};
use clebsch_tests::fixtures::follower::Follower;
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::fixtures::wheeled_car::WheeledCar;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector2, Vector3, Vector4, Vector6};
use systems::{Place, Quadrotor, SteeredBody, TiltedBody, quadrotor};
use ticks::Tick;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    let numbers: Vec<u64> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let count = numbers.first().map_or(200, |count| *count as usize);
    let seed = numbers.get(1).map_or(1, |seed| *seed);
    let outcome = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [way @ ("cases" | "along"), file, ..] => {
            cases::write(file, count, seed, way == "along").map_err(|error| format!("{file}: {error}"))
        }
        ["gusts", file, ..] => {
            let [flights, sweeps] =
                [(0, 5), (2, 4)].map(|(at, default)| numbers.get(at).map_or(default, |n| *n as usize));
            ticks::write(file, flights, seed, sweeps as u32).map_err(|error| format!("{file}: {error}"))
        }
        ["compare", file, ..] => cases::compare(file, &arguments[2..]),
        _ => {
            counts(count, seed);
            Ok(())
        }
    };
    if let Err(error) = outcome {
        eprintln!("control: {error}");
        std::process::exit(1);
    }
}

/// The linearisations of random problems, in a table.
fn counts(count: usize, seed: u64) {
    let random = &mut Random::new(seed);
    println!("{:<18} {:>9} {:>8} {:>8} {:>8} {:>8}", "problem", "solved", "median", "9 of 10", "most", "all");
    print("unicycle", (0..count).map(|_| car(random)));
    print("body", (0..count).map(|_| body(random)));
    print("quadrotor", (0..count / 2).map(|_| flight(random)));
    let seeds = &mut Random::new(seed + 2);
    print("car on a track", (0..count).map(|_| track(seeds)));
    print("car with equations", (0..count).map(|_| wheels(seeds)));
    print("tilted body", (0..count).map(|_| tilted(seeds)));
    print("quadrotor in gusts", flights(count, random, None).iter().map(|tick| tick.sweeps));
    println!(
        "\n{:<18} {:>9} {:>8} {:>14} {:>14}",
        "sweeps in a tick", "median", "most", "price of all", "gap of plans"
    );
    for most in [400, 8, 4, 2, 1] {
        let random = &mut Random::new(seed + 1);
        let ticks = flights(count, random, Some(Limits { sweeps: most }));
        let mut sweeps: Vec<u32> = ticks.iter().filter_map(|tick| tick.sweeps).collect();
        sweeps.sort_unstable();
        let Some((median, greatest)) = sweeps.get(sweeps.len() / 2).zip(sweeps.last()) else { continue };
        let price: f64 = ticks.iter().map(|tick| tick.price).sum();
        let gap = ticks.iter().map(|tick| tick.gap).sum::<f64>() / ticks.len() as f64;
        println!("{most:<18} {median:>9} {greatest:>8} {price:>14.6} {gap:>14.1e}");
    }
}

/// One flight for forty problems, without the first plans.
fn flights(count: usize, random: &mut Random, limits: Option<Limits>) -> Vec<Tick> {
    (0..count / 40).flat_map(|_| ticks::flight(random, limits).into_iter().skip(1)).collect()
}

/// A line of the table, of the linearisations of each solution that was found.
fn print(name: &str, solved: impl Iterator<Item = Option<u32>>) {
    let all: Vec<Option<u32>> = solved.collect();
    let mut found: Vec<u32> = all.iter().flatten().copied().collect();
    found.sort_unstable();
    let at = |part: usize| found.get(found.len() * part / 10).or(found.last()).copied().unwrap_or(0);
    let (share, sum) = (format!("{}/{}", found.len(), all.len()), found.iter().sum::<u32>());
    println!("{name:<18} {share:>9} {:>8} {:>8} {:>8} {sum:>8}", at(5), at(9), at(10));
}

fn vector(random: &mut Random, size: f64) -> Vector3<f64> {
    random.vector::<3>() * size
}

fn rotation(turn: Vector3<f64>) -> Matrix3<f64> {
    *Rotation3::new(turn).matrix()
}

/// A goal in any direction.
fn car(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 50;
    let system = Unicycle { turn_price: 1.0, top_turn: 7.0, time_price: 0.0, miss_price: 0.0, goal: Vector2::zeros() };
    let control = system.control(0.02).expect("regular");
    let (angle, x, y) = (3.0 * random.number(), random.number(), random.number());
    let goal = Matrix3::new(angle.cos(), -angle.sin(), x, angle.sin(), angle.cos(), y, 0.0, 0.0, 1.0);
    let start = Matrix3::identity();
    let mut plan = [control.stage(&start); STEPS];
    control.solve(&start, Target::Place(goal), &mut plan).ok().map(|found| found.iterations())
}

/// Along a swing, past an obstacle that is near the middle of it.
fn track(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 40;
    const H: f64 = 0.1;
    let control = Follower { price: 0.02, clearance: 0.4, miss_price: 1.0 }.control(H).expect("regular");
    let (width, phase, swing) = (1.0 + random.number(), 3.0 * random.number(), 1.0 + 0.5 * random.number());
    let track = |t: f64| Vector2::new(width * (phase + swing * t).sin(), t);
    let (middle, drift) = (track(2.0) + random.vector::<2>() * 0.4, random.vector::<2>() * 0.2);
    let control = control.with_end_reference(track(H * STEPS as f64)).expect("finite");
    let (point, angle) = (track(0.0) + random.vector::<2>() * 0.3, 3.0 * random.number());
    let start = Matrix3::new(angle.cos(), -angle.sin(), point.x, angle.sin(), angle.cos(), point.y, 0.0, 0.0, 1.0);
    let mut plan = [control.stage(&start); STEPS];
    control.refer(&mut plan, |_, t| (track(t), middle + drift * (t - 2.0)));
    control.solve(&start, Target::Free, &mut plan).ok().map(|found| found.iterations())
}

/// A goal in any direction, where an equation forbids to slide sideways.
fn wheels(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 50;
    let control = WheeledCar { turning: 1.0, fastest: 7.0 }.control(0.02).expect("regular");
    let (angle, x, y) = (3.0 * random.number(), random.number(), random.number());
    let goal = Matrix3::new(angle.cos(), -angle.sin(), x, angle.sin(), angle.cos(), y, 0.0, 0.0, 1.0);
    let start = Matrix3::identity();
    let mut plan = [control.stage(&start); STEPS];
    control.solve(&start, Target::Place(goal), &mut plan).ok().map(|found| found.iterations())
}

/// From rest to rest, turned by any angles about the vertical and about its own axis.
fn tilted(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 30;
    let moments = random.vector::<3>().map(|part| 2.0 + part);
    let axes = rotation(vector(random, 2.0));
    let inertia = axes * Matrix3::from_diagonal(&moments) * axes.transpose();
    let tilt = 0.8 * random.number();
    let mut place = || {
        let turn = |angle: f64| rotation(Vector3::z() * 3.0 * angle);
        (turn(random.number()) * rotation(Vector3::x() * tilt.acos()) * turn(random.number()), Vector3::zeros())
    };
    let (start, goal) = (place(), place());
    let control = TiltedBody { inertia, tilt }.control(0.1).expect("regular");
    let mut plan = [control.stage(&start); STEPS];
    control.solve(&start, Target::Place(goal), &mut plan).ok().map(|found| found.iterations())
}

/// From one tumbling to another.
fn body(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 50;
    let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
    let control = SteeredBody { inertia, top: 16.0 }.control(0.02).expect("regular");
    let start = (Matrix3::identity(), vector(random, 2.0));
    let goal = (rotation(vector(random, 1.7)), vector(random, 2.0));
    let mut plan = [control.stage(&start); STEPS];
    control.solve(&start, Target::Place(goal), &mut plan).ok().map(|found| found.iterations())
}

fn pose(attitude: &Matrix3<f64>, position: &Vector3<f64>) -> Matrix4<f64> {
    let mut pose = Matrix4::identity();
    pose.fixed_view_mut::<3, 3>(0, 0).copy_from(attitude);
    pose.fixed_view_mut::<3, 1>(0, 3).copy_from(position);
    pose
}

fn moving(system: &Quadrotor, attitude: &Matrix3<f64>, position: &Vector3<f64>, velocity: &Vector3<f64>) -> Place {
    let mut momentum = Vector6::zeros();
    momentum.fixed_rows_mut::<3>(3).copy_from(&(attitude.transpose() * velocity * system.mass));
    (pose(attitude, position), momentum)
}

/// From a tilted flight to rest, in a second.
fn flight(random: &mut Random) -> Option<u32> {
    const STEPS: usize = 100;
    let control = quadrotor().control(0.01).expect("regular");
    let attitude = rotation(vector(random, 0.5));
    let start = moving(control.system(), &attitude, &vector(random, 0.5), &vector(random, 0.5));
    let yaw = rotation(Vector3::z() * random.number());
    let goal = (pose(&yaw, &vector(random, 0.5)), Vector6::zeros());
    let mut plan = vec![control.stage(&start).with_input(Vector4::repeat(control.system().hover)); STEPS];
    control.solve(&start, Target::Place(goal), &mut plan).ok().map(|found| found.iterations())
}
