//! The most work of a step, over many random states.

use crate::declarations::{bodies, pendulums, tops};
use crate::map::{Map, SCALARS};
use crate::probe::{Cell, Dial};
use crate::random::Random;
use crate::setup::Setup;
use clebsch::Error;
use clebsch::implicit::LINEARIZATIONS;
use clebsch_examples::claims::Claims;
use clebsch_examples::counted::iterations;
use clebsch_examples::scene::{Failure, say};
use clebsch_examples::table::aligned;
use rayon::prelude::*;

/// States of one body.
const STATES: u64 = 10_000;
/// Most iterations of a solve: 12 by Newton's method, then those along the path. The last point of the path may take 4
/// more. A step of order 16 makes at most 64 sweeps.
const ITERATIONS: u32 = 12 + LINEARIZATIONS + 4;

/// How far F⁻ℓd(q, F) may be from N, in ε. A solution is accepted where ρ is within 8ε|Dρ||ξ|. |Dρ||ξ| is up to a
/// thousand times |N| with needles of that ratio. Fixed points end at rounding of Σ⁻¹ρ. This is further off where Dρ is
/// nearly singular, next to the end of `projection`: a ceiling, not derived.
const MISSED: [f64; 2] = [8000.0, 200_000.0];

/// Steps that are tried to tell the longest one that has a solution.
const TRIALS: u32 = 32;

/// Those with an iteration.
fn dials() -> Vec<Dial> {
    let explicit = ["exact", "exact, order 4", "chord", "exponential, order 4"];
    let composed = ["moser_veselov, order 8", "compensated"];
    let all = [bodies(), tops(), pendulums()].concat().into_iter();
    all.filter(|dial| !explicit.contains(&dial.name) && !composed.contains(&dial.name)).collect()
}

/// Moments of a ratio up to a thousand, any attitude, h|ω| of the first state of the order of one.
fn body(random: &mut Random) -> Setup {
    let masses = [0; 3].map(|_| 10.0_f64.powf(random.between(-3.0, 0.0)));
    let moments = [masses[1] + masses[2], masses[2] + masses[0], masses[0] + masses[1]];
    let setup = Setup { moments, attitude: random.attitude(), h: random.between(0.01, 0.1), ..Setup::ordinary() };
    let velocity = random.direction() / setup.h;
    setup.with_velocity(velocity)
}

/// The work of many steps.
#[derive(Clone, Debug, Default)]
struct Sample {
    /// Steps that were made.
    done: u64,
    /// How many of them took so many iterations, up to 63.
    iterations: Vec<u64>,
    /// The most iterations of one that was made.
    most: u32,
    /// Steps that have no solution.
    too_long: u64,
    /// The most iterations of one that was not made.
    most_refused: u32,
    /// Steps that were given up.
    not_converged: u64,
    /// Steps with another error, and states that were refused.
    others: u64,
    /// Numbers that are not finite, handed out as results.
    hidden: u64,
    /// The largest |F⁻ℓd(q, F) − N|, over momenta, of one in a hundred steps with h|ω| below one.
    missed: f64,
}

/// One step from each of `states` random states of a body: its attitude, any direction, and h|ω| of any size from 1e-8 to ten.
fn sample(dial: &Dial, scalar: usize, setup: &Setup, states: u64, seed: u64, sample: &mut Sample) {
    sample.iterations.resize(64, 0);
    let Ok(mut motion) = (dial.begin[scalar])(setup) else {
        sample.others += states;
        return;
    };
    let (mut random, size) = (Random::new(seed), setup.momentum.norm());
    for number in 0..states {
        let part = 10.0_f64.powf(random.between(-8.0, 1.0));
        let setup = Setup { momentum: random.direction() * (size * part), ..setup.clone() };
        if motion.restart(&setup).is_err() {
            sample.others += 1;
            continue;
        }
        let (stepped, count) = iterations(|| motion.step());
        match stepped {
            Ok(()) => {
                sample.done += 1;
                sample.iterations[count.min(63) as usize] += 1;
                sample.most = sample.most.max(count);
                sample.hidden += u64::from(!motion.is_finite());
                let is_measured = number % 100 == 0 && motion.has_equation();
                if is_measured && setup.h * setup.velocity().norm() < 1.0 && motion.restart(&setup).is_ok() {
                    sample.missed = sample.missed.max(motion.residual().unwrap_or(0.0));
                }
                continue;
            }
            Err(Error::Unsolvable { .. }) => sample.too_long += 1,
            Err(Error::NotConverged { .. }) => sample.not_converged += 1,
            Err(_) => sample.others += 1,
        }
        sample.most_refused = sample.most_refused.max(count);
    }
}

/// `states` random states of each scene, as many with each dial in each type.
pub fn explore(map: &mut Map<'_>, claims: &mut Claims, states: u64) -> Result<(), Failure> {
    let dials = dials();
    let kinds: Vec<(usize, &Dial)> =
        (0..SCALARS.len()).flat_map(|scalar| dials.iter().map(move |dial| (scalar, dial))).collect();
    let samples = kinds.par_iter().map(|&(scalar, dial)| {
        let (mut random, mut sample) = (Random::new(64), Sample::default());
        let states = states / kinds.iter().filter(|(_, other)| other.scene == dial.scene).count() as u64;
        for number in 0..states.div_ceil(STATES) {
            let setup = body(&mut random);
            self::sample(dial, scalar, &setup, STATES.min(states), number, &mut sample);
        }
        sample
    });
    let samples: Vec<Sample> = samples.collect();
    say(format_args!(
        "Random states, {states:e} of each scene: bodies of moments of a ratio up to 1000, h|ω| from 1e-8 to 10, any attitude and direction. How many steps take so many iterations\n"
    ));
    let headings = [
        "",
        "done",
        "≤ 2",
        "≤ 4",
        "≤ 12",
        "more",
        "most",
        "too long",
        "most",
        "not converged",
        "other errors",
        "missed",
    ];
    let mut rows = vec![headings.map(str::to_owned).to_vec()];
    let (mut most, mut most_refused, mut hidden, mut missed) = (0, 0, 0, [0.0_f64; 2]);
    for (&(scalar, dial), sample) in kinds.iter().zip(&samples) {
        let name = format!("{}, {}, {}", dial.scene, dial.name, SCALARS[scalar]);
        let below = |most: usize| sample.iterations.iter().take(most + 1).sum::<u64>();
        let share = |count: u64| format!("{:.1} %", 100.0 * count as f64 / sample.done.max(1) as f64);
        rows.push(vec![
            name.clone(),
            sample.done.to_string(),
            share(below(2)),
            share(below(4)),
            share(below(12)),
            (sample.done - below(12)).to_string(),
            sample.most.to_string(),
            sample.too_long.to_string(),
            sample.most_refused.to_string(),
            sample.not_converged.to_string(),
            sample.others.to_string(),
            format!("{:.0e}", sample.missed),
        ]);
        let cell = Cell { iterations: sample.most, residual: sample.missed, ..Cell::of(Ok(()), sample.done) };
        let refused = format!("{} refused", sample.too_long + sample.not_converged);
        map.add_run("random states", (dial.scene, dial.name), SCALARS[scalar], &refused, &cell)?;
        let epsilon = [f64::EPSILON, f64::from(f32::EPSILON)][scalar];
        let kind = usize::from(dial.name == "projection");
        missed[kind] = missed[kind].max(sample.missed / epsilon);
        most = most.max(sample.most);
        most_refused = most_refused.max(sample.most_refused);
        hidden += sample.hidden;
    }
    say(aligned(rows.iter()));
    claims.at_most(
        "random states: iterations of a step",
        f64::from(most),
        f64::from(ITERATIONS),
        "12 by Newton's method, then those along the path",
    );
    claims.at_most(
        "random states: iterations of a step that is refused",
        f64::from(most_refused),
        f64::from((TRIALS + 2) * ITERATIONS),
        "those of the step, made twice for the error, and of the trials for the longest one that would do",
    );
    for ((name, missed), most) in ["all but projection", "projection"].into_iter().zip(missed).zip(MISSED) {
        let claim = format!("random states: equations missed below h|ω| = 1, in ε, {name}");
        claims.at_most(&claim, missed, most, "one step in a hundred, over momenta");
    }
    claims.at_most("random states: numbers that are not finite", hidden as f64, 0.0, "in steps that were made");
    Ok(())
}
