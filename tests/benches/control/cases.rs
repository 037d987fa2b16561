//! Random problems that other solvers get too. `-- cases FILE [COUNT] [SEED]` solves them, and writes a line of JSON for each.
//! `-- along FILE [COUNT] [SEED]` solves them from the interpolated path that the others begin with. `-- compare FILE PEER…` prints a table of
//! such files. `tests/peers` has the other side.
//!
//! | problem | case | steps |
//! |---|---|---|
//! | unicycle | θ, x, y of the goal | 50 of 0.02 s |
//! | body | rotation vector of the goal, momenta of start and goal | 50 of 0.02 s |
//! | quadrotor | rotation vector, position and velocity of the start, yaw and position of the goal | 100 of 0.01 s |

use super::systems::{SteeredBody, quadrotor};
use super::{moving, pose, rotation, ticks};
use clebsch::{Controlled, Target};
use clebsch_tests::fixtures::unicycle::Unicycle;
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix3, Rotation3, Vector2, Vector3, Vector4, Vector6};
use std::fmt::Write;
use std::time::Instant;

const PROBLEMS: [&str; 3] = ["unicycle", "body", "quadrotor"];
/// An optimum that is dearer than that of another solver by this part is a worse one.
const WORSE: f64 = 0.01;

/// The price and the linearisations of a plan, and whether one was found.
type Found = (f64, u32, bool);

/// A vector in a ball.
fn within(random: &mut Random, radius: f64) -> Vector3<f64> {
    loop {
        let vector = random.vector::<3>();
        if vector.norm() <= 1.0 {
            return vector * radius;
        }
    }
}

fn draw(problem: &str, random: &mut Random) -> Vec<f64> {
    let mut case = Vec::new();
    let mut add = |vector: Vector3<f64>| case.extend(vector.iter().copied());
    match problem {
        "unicycle" => {
            let angle = std::f64::consts::PI * random.number();
            add(Vector3::new(angle, 1.5 * random.number(), 1.5 * random.number()));
        }
        "body" => [3.0, 1.0, 1.0].into_iter().for_each(|radius| add(within(random, radius))),
        _ => {
            [1.0, 0.0, 1.0].into_iter().for_each(|radius| add(within(random, radius)));
            case.push(std::f64::consts::PI * random.number());
            case.extend(within(random, 1.5).iter().copied());
        }
    }
    case
}

/// A plan without a guess, or along the interpolated path that other solvers begin with.
macro_rules! planned {
    ($control:ident, $start:ident, $goal:ident, $plan:ident, $is_along:expr, $path:expr) => {{
        let target = Target::Place($goal);
        let solved = match $is_along {
            true => $control.solve_along(&$start, target, $path, &mut $plan),
            false => $control.solve(&$start, target, &mut $plan),
        };
        solved.map_or((f64::NAN, 0, false), |plan| (plan.price(), plan.iterations(), true))
    }};
}

fn solve(problem: &str, case: &[f64], is_along: bool) -> Found {
    let vector = |at: usize| Vector3::from_fn(|i, _| case[at + i]);
    match problem {
        "unicycle" => {
            let goal = Vector2::zeros();
            let system = Unicycle { turn_price: 1.0, top_turn: 7.0, time_price: 0.0, miss_price: 0.0, goal };
            let control = system.control(0.02).expect("regular");
            let place = |part: f64| {
                let (sin, cos) = (part * case[0]).sin_cos();
                Matrix3::new(cos, -sin, part * case[1], sin, cos, part * case[2], 0.0, 0.0, 1.0)
            };
            let (start, goal) = (Matrix3::identity(), place(1.0));
            let speed = if is_along { Vector2::new(case[0], case[1].hypot(case[2])) } else { Vector2::zeros() };
            let mut plan = [control.stage(&start).with_input(speed); 50];
            planned!(control, start, goal, plan, is_along, |k, _| place(k as f64 / 50.0))
        }
        "body" => {
            let inertia = Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
            let control = SteeredBody { inertia, top: 16.0 }.control(0.02).expect("regular");
            let (start, goal) = ((Matrix3::identity(), vector(3)), (rotation(vector(0)), vector(6)));
            let mut plan = [control.stage(&start); 50];
            let rate = inertia * vector(0);
            planned!(control, start, goal, plan, is_along, |k, _| (rotation(vector(0) * (k as f64 / 50.0)), rate))
        }
        _ => {
            let control = quadrotor().control(0.01).expect("regular");
            let start = moving(control.system(), &rotation(vector(0)), &vector(3), &vector(6));
            let goal = (pose(&rotation(Vector3::z() * case[9]), &vector(10)), Vector6::zeros());
            let mut plan = vec![control.stage(&start).with_input(Vector4::repeat(control.system().hover)); 100];
            let tilt = Rotation3::new(vector(0));
            let turn = (tilt.inverse() * Rotation3::new(Vector3::z() * case[9])).scaled_axis();
            let path = |k: usize, _| {
                let part = k as f64 / 100.0;
                let attitude = (tilt * Rotation3::new(turn * part)).into_inner();
                (pose(&attitude, &(vector(3) + part * (vector(10) - vector(3)))), Vector6::zeros())
            };
            planned!(control, start, goal, plan, is_along, path)
        }
    }
}

/// Draws and solves `count` cases of each problem, and writes them to a file. Where `is_along`, plans begin with the interpolated path.
pub fn write(path: &str, count: usize, seed: u64, is_along: bool) -> std::io::Result<()> {
    let mut lines = String::new();
    for problem in PROBLEMS {
        let random = &mut Random::new(seed);
        for k in 0..count {
            let case = draw(problem, random);
            // the first solution warms caches
            let (cost, iterations, ok) = solve(problem, &case, is_along);
            let before = Instant::now();
            solve(problem, &case, is_along);
            let us = before.elapsed().as_secs_f64() * 1e6;
            let cost = if ok { cost.to_string() } else { "null".into() };
            let _ = writeln!(
                lines,
                "{{\"problem\": \"{problem}\", \"k\": {k}, \"case\": {case:?}, \"cost\": {cost}, \"iters\": {iterations}, \"us\": {us:.1}, \"ok\": {ok}}}"
            );
        }
    }
    std::fs::write(path, lines)
}

/// A solution of a case.
pub struct Line {
    pub problem: String,
    pub k: usize,
    pub cost: f64,
    pub iterations: f64,
    pub us: f64,
    pub ok: bool,
}

/// The text behind a key of a flat object.
fn field<'l>(line: &'l str, key: &str) -> Option<&'l str> {
    let (_, rest) = line.split_once(&format!("\"{key}\": "))?;
    rest.split([',', '}']).next().map(|text| text.trim_matches('"'))
}

pub fn read(path: &str) -> Result<Vec<Line>, String> {
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let line = |(number, line): (usize, &str)| {
        let missing = |key: &str| format!("{path}, line {}: no `{key}`", number + 1);
        let text = |key: &str| field(line, key).ok_or_else(|| missing(key));
        let number = |key: &str| text(key).map(|text| text.parse().unwrap_or(f64::NAN));
        Ok(Line {
            problem: text("problem")?.into(),
            k: text("k")?.parse().map_err(|_| missing("k"))?,
            cost: number("cost")?,
            iterations: number("iters")?,
            us: number("us")?,
            ok: text("ok")? == "true",
        })
    };
    text.lines().enumerate().filter(|(_, line)| line.starts_with('{')).map(line).collect()
}

/// The name of a file, without its folder and ending.
pub fn stem(path: &str) -> String {
    std::path::Path::new(path).file_stem().map_or(path.into(), |stem| stem.to_string_lossy().into_owned())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Prints a table of plans by other solvers for the cases of a file, and of ours. Times are by ours, where both solved a case. Last come the numbers of worse
/// optima on either side, and how near the others are. Flights in gusts have a table of their own.
pub fn compare(path: &str, peers: &[String]) -> Result<(), String> {
    let ours = read(path)?;
    if ours.first().is_some_and(|line| line.problem == "gusts") {
        return ticks::compare(path, peers);
    }
    println!(
        "{:<10} {:<32} {:>7} {:>7} {:>7} {:>7} {:>10} {:>7} {:>10}",
        "problem", "by", "solved", "median", "9 of 10", "time", "we worse", "worse", "agree to"
    );
    for problem in PROBLEMS {
        let of = |lines: &[Line]| lines.iter().filter(|line| line.problem == problem).count();
        let row = |name: &str, lines: &[Line]| {
            let solved: Vec<&Line> = lines.iter().filter(|line| line.problem == problem && line.ok).collect();
            let mut counts: Vec<f64> = solved.iter().map(|line| line.iterations).collect();
            counts.sort_by(f64::total_cmp);
            let nine = counts.get(counts.len() * 9 / 10).copied().unwrap_or(f64::NAN);
            let both: Vec<(&Line, &Line)> = solved
                .iter()
                .filter_map(|line| {
                    ours.iter().find(|our| our.problem == problem && our.k == line.k && our.ok).map(|our| (our, *line))
                })
                .collect();
            let ratio = median(both.iter().map(|(our, line)| line.us / our.us).collect());
            let worse = |a: f64, b: f64| a > b * (1.0 + WORSE);
            let we = both.iter().filter(|(our, line)| worse(our.cost, line.cost)).count();
            let they = both.iter().filter(|(our, line)| worse(line.cost, our.cost)).count();
            let apart = |(our, line): &(&Line, &Line)| (our.cost - line.cost).abs() / line.cost.abs();
            let agree = median(both.iter().map(apart).filter(|apart| *apart < WORSE).collect());
            println!(
                "{problem:<10} {name:<32} {:>7} {:>7} {nine:>7} {ratio:>7.2} {we:>10} {they:>7} {agree:>10.1e}",
                format!("{}/{}", solved.len(), of(lines)),
                median(counts.clone()),
            );
        };
        row("clebsch", &ours);
        for peer in peers {
            let lines = read(peer)?;
            if of(&lines) > 0 {
                row(&stem(peer), &lines);
            }
        }
    }
    Ok(())
}
