//! A quadrotor that is planned anew a hundred times a second while gusts push it. `-- gusts FILE [FLIGHTS] [SEED] [SWEEPS]` writes a line of
//! JSON for each tick, `-- compare FILE PEER…` prints a table of such files. `tests/peers` flies in the same gusts.

use super::cases::{read, stem};
use super::systems::quadrotor;
use super::{pose, rotation, vector};
use clebsch::{Controlled, Limits, Target};
use clebsch_tests::oracle::random::Random;
use nalgebra::{Matrix4, Vector3, Vector4, Vector6};
use std::fmt::Write;
use std::time::Instant;

const STEPS: usize = 80;
const TICKS: usize = 60;

/// A hundredth of a second in gusts.
pub struct Tick {
    /// The change of velocity by the gust after it, m/s.
    pub gust: Vector3<f64>,
    /// The linearisations of its plan, if there is one.
    pub sweeps: Option<u32>,
    /// The price of the step that is flown.
    pub price: f64,
    /// The distance of the plan's end from the target.
    pub gap: f64,
    /// The time that the plan took, µs.
    pub us: f64,
}

/// Plans over the next 0.8 s, each from the plan before, within limits after the first one.
pub fn flight(random: &mut Random, limits: Option<Limits>) -> Vec<Tick> {
    let control = quadrotor().control(0.01).expect("regular");
    let goal = (pose(&rotation(Vector3::z() * 0.5), &Vector3::new(0.6, 0.2, 0.15)), Vector6::zeros());
    let mut place = (Matrix4::identity(), Vector6::zeros());
    let mut plan = vec![control.stage(&place).with_input(Vector4::repeat(control.system().hover)); STEPS];
    let constants = control.system().prepare(control.step_size()).expect("regular");
    let tick = |index: usize| {
        let target = Target::Place(goal);
        let before = Instant::now();
        let solved = match limits.filter(|_| index > 0) {
            Some(limits) => control.solve_within(&place, target, limits, &mut plan),
            None => control.solve(&place, target, &mut plan),
        };
        let us = before.elapsed().as_secs_f64() * 1e6;
        let (sweeps, gap) = solved.map_or((None, f64::NAN), |found| (Some(found.iterations()), found.gap()));
        let price = control.system().price(&constants, 0.0, &place, plan[0].input()).expect("a price");
        place = control.follow(&place, plan[0].input()).expect("a step");
        let gust = vector(random, 0.01);
        let push = gust * control.system().mass;
        place.1.fixed_rows_mut::<3>(3).iter_mut().zip(push.iter()).for_each(|(momentum, push)| *momentum += push);
        control.shift(&mut plan, 1);
        Tick { gust, sweeps, price, gap, us }
    };
    (0..TICKS).map(tick).collect()
}

/// Flies in random gusts, with so many linearisations in a tick, and writes all ticks to a file.
pub fn write(path: &str, flights: usize, seed: u64, sweeps: u32) -> std::io::Result<()> {
    let random = &mut Random::new(seed);
    let mut lines = String::new();
    for index in 0..flights {
        for (k, tick) in flight(random, Some(Limits { sweeps })).into_iter().enumerate() {
            let Tick { gust, sweeps, price, us, .. } = tick;
            let (gust, iterations) = (gust.as_slice(), sweeps.unwrap_or(0));
            let _ = writeln!(
                lines,
                "{{\"problem\": \"gusts\", \"flight\": {index}, \"k\": {k}, \"gust\": {gust:?}, \"cost\": {price}, \"iters\": {iterations}, \"us\": {us:.1}, \"ok\": {}}}",
                sweeps.is_some()
            );
        }
    }
    std::fs::write(path, lines)
}

/// Prints a table of flights by us and by other solvers, without the first plans. Times are by the median of the first file.
pub fn compare(path: &str, peers: &[String]) -> Result<(), String> {
    println!(
        "{:<24} {:>8} {:>8} {:>8} {:>8} {:>8} {:>12}",
        "flown by", "ticks", "sweeps", "median", "95 %", "worst", "price of all"
    );
    let mut unit = None;
    for file in [path].into_iter().chain(peers.iter().map(String::as_str)) {
        let lines = read(file)?;
        let later = lines.iter().filter(|line| line.k > 0 && line.ok);
        let mut times: Vec<f64> = later.clone().map(|line| line.us).collect();
        let mut sweeps: Vec<f64> = later.map(|line| line.iterations).collect();
        [&mut times, &mut sweeps].into_iter().for_each(|all| all.sort_by(f64::total_cmp));
        let at = |all: &[f64], part: usize| all.get(all.len() * part / 100).or(all.last()).copied().unwrap_or(f64::NAN);
        let unit = *unit.get_or_insert(at(&times, 50));
        let [median, most, worst] = [50, 95, 100].map(|part| at(&times, part) / unit);
        let price: f64 = lines.iter().filter(|line| line.k > 0).map(|line| line.cost).sum();
        let share = format!("{}/{}", times.len(), lines.iter().filter(|line| line.k > 0).count());
        println!(
            "{:<24} {share:>8} {:>8} {median:>8.2} {most:>8.2} {worst:>8.2} {price:>12.6}",
            stem(file),
            at(&sweeps, 50)
        );
    }
    Ok(())
}
