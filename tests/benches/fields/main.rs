//! The benchmark of fields: `cargo bench -p clebsch-tests --bench fields`.
//!
//! Nanoseconds of a step for each site, and the same by hand in plain Rust with nalgebra. There are waves of unit vectors on periodic
//! sheets, strings and rods. Then come waves by NumPy, and waves on one and on two threads. Contestants are timed in turn in the same run.
//! By hand no state is checked. All read their parameters at run time.
//!
//! `-- numpy` compares with NumPy alone, and fails without it. `PYTHON` names a Python that has NumPy, `python3` by default.

mod rod;
#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Clebsch, Field, FieldState, SiteError};
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{Matrix4, SVector, Vector1, Vector3, Vector4, Vector6};
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use rod::{ByHand, Section};
use std::cell::RefCell;
use std::hint::black_box;
use std::process::Command;
use timing::{Run, Time, interleaved};

/// The step size, and the spacing of sites.
const H: f64 = 0.05;
const SPACING: f64 = 0.1;
/// Motions are compared after so many steps.
const STEPS: u64 = 50;
/// 8ε, from which on |q|² is off.
const OFF: f64 = 8.0 * f64::EPSILON;

/// A string of density 1 and tension 1, its displacement x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
)]
struct Strand;

/// A rod of rigid sections that bends, turns, stretches and shears.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.cayley() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
)]
struct Rod {
    /// Principal second moments and mass of a section.
    section: Vector4<f64>,
    stiffness: SVector<f64, 6>,
    reference: SVector<f64, 6>,
}

type Vectors = Vec<Vector3<f64>>;

/// A wave with 1 along the sides and along the others.
fn wave(n: usize) -> (Vectors, Vectors) {
    let turn = |i: usize| std::f64::consts::TAU * i as f64 / n as f64;
    let tilt = |site: usize| 0.5 * turn(site / n).sin() * turn(site % n).cos();
    let place = |site: usize| Vector3::new(tilt(site).sin(), 0.0, tilt(site).cos());
    ((0..n * n).map(place).collect(), vec![Vector3::zeros(); n * n])
}

/// A sheet of n × n sites by hand, with the weights h/dx² and h/dy².
#[derive(Clone, Copy)]
struct Sheet {
    n: usize,
    h: f64,
    weights: [f64; 2],
}

impl Sheet {
    /// N ← N + q × Σ of the neighbours of each site, times their weights and `part`. The ends of a row have neighbours elsewhere.
    fn kick(&self, part: f64, q: &[Vector3<f64>], mu: &mut [Vector3<f64>]) {
        let (n, [down, along]) = (self.n, self.weights.map(|weight| weight * part));
        let row = |i: usize| &q[i % n * n..][..n];
        for (i, mu) in mu.chunks_mut(n).enumerate() {
            let (before, own, after) = (row(i + n - 1), row(i), row(i + 1));
            for j in [0, n - 1] {
                let sum = (before[j] + after[j]) * down + (own[(j + n - 1) % n] + own[(j + 1) % n]) * along;
                mu[j] += own[j].cross(&sum);
            }
            let across = before[1..n - 1].iter().zip(&after[1..n - 1]);
            for ((mu, own), (before, after)) in mu[1..n - 1].iter_mut().zip(own.windows(3)).zip(across) {
                let sum = (before + after) * down + (own[0] + own[2]) * along;
                *mu += own[1].cross(&sum);
            }
        }
    }

    /// q turns by θ about N, sin θ = h|N|.
    fn drift(&self, q: &mut [Vector3<f64>], mu: &[Vector3<f64>]) {
        for (q, mu) in q.iter_mut().zip(mu) {
            let x = mu * self.h;
            let cosine = (1.0 - x.norm_squared()).sqrt();
            *q = *q * cosine + x.cross(q);
            let squared = q.norm_squared();
            if (squared - 1.0).abs() > OFF {
                *q *= (3.0 - squared) / 2.0;
            }
        }
    }

    fn steps(&self, steps: u64, q: &mut [Vector3<f64>], mu: &mut [Vector3<f64>]) {
        self.kick(0.5, q, mu);
        for step in 1..=steps {
            self.drift(q, mu);
            self.kick(if step == steps { 0.5 } else { 1.0 }, q, mu);
        }
    }
}

/// So many steps of a string by hand.
fn string_by_hand(h: f64, weight: f64, steps: u64, x: &mut [f64], mu: &mut [f64]) {
    let n = x.len();
    let kick = |weight: f64, x: &[f64], mu: &mut [f64]| {
        mu[0] += weight * (x[1] + x[n - 1] - 2.0 * x[0]);
        for (mu, x) in mu[1..n - 1].iter_mut().zip(x.windows(3)) {
            *mu += weight * (x[0] + x[2] - 2.0 * x[1]);
        }
        mu[n - 1] += weight * (x[0] + x[n - 2] - 2.0 * x[n - 1]);
    };
    kick(weight / 2.0, x, mu);
    for step in 1..=steps {
        x.iter_mut().zip(&*mu).for_each(|(x, mu)| *x += h * mu);
        kick(if step == steps { weight / 2.0 } else { weight }, x, mu);
    }
}

/// Steps that go on from where the last ones ended: a start anew would take as long as some steps of many sites.
fn going_on<'a, V: 'a>(start: V, step: impl FnMut(&mut V, u64) + 'a) -> Run<'a> {
    let all = RefCell::new((start, step));
    Box::new(move |steps| {
        let (state, step) = &mut *all.borrow_mut();
        step(state, steps);
        black_box(state);
    })
}

/// The bytes of q and of N at a site, and whether drifts change N.
struct Memory(usize, usize, bool);

impl Memory {
    /// The bytes that a step reads and writes at each site if no cache has them. Kick and drift each take q and N.
    fn moved(&self) -> usize {
        let Memory(q, mu, is_moving) = *self;
        (q + 2 * mu) + (2 * q + if is_moving { 2 * mu } else { mu })
    }

    /// Bytes a nanosecond of a copy that reads and writes as many numbers as the states of these sites have.
    fn of_copy(&self, sites: usize) -> f64 {
        let Memory(q, mu, _) = *self;
        let numbers = sites * (q + mu) / 16;
        let copied = RefCell::new((vec![1.0_f64; numbers], vec![0.0_f64; numbers]));
        let copy = |times| {
            for _ in 0..times {
                let (from, to) = &mut *copied.borrow_mut();
                to.copy_from_slice(black_box(from));
                black_box(to);
            }
        };
        (16 * numbers) as f64 / interleaved(&[Box::new(copy)])[0].least
    }
}

/// A step is bound by memory where it moves more than this part of the bytes that a copy moves at the same time.
const BOUND: f64 = 0.5;

fn print(name: &str, sites: usize, memory: &Memory, times: &[Time]) {
    let [ours, by_hand] = [0, 1].map(|k| times[k].least / sites as f64);
    let medians = times[0].median / times[1].median;
    let (moved, part) = (memory.moved(), memory.moved() as f64 / ours / memory.of_copy(sites));
    let bound = if part > BOUND { "memory" } else { "operations" };
    println!(
        "{name:<24} {sites:>8} {ours:>10.2} {by_hand:>10.2} {:>8.2} {medians:>10.2} {moved:>8} {part:>8.2} {bound:>11}",
        ours / by_hand
    );
}

fn waves() -> Result<(), SiteError> {
    let (h, [dx, dy]) = black_box((H, [SPACING; 2]));
    for n in [32, 128, 512] {
        let stepper = WaveMap.grid([n, n]).spacing([dx, dy]).periodic().stepper(h)?;
        let (q, mu) = wave(n);
        let sheet = Sheet { n, h, weights: [h / (dx * dx), h / (dy * dy)] };
        let start: FieldState<Vectors, Vectors> = stepper.state(q.clone(), mu.clone())?;
        let mut check = (start.clone(), (q.clone(), mu.clone()));
        stepper.advance(&mut check.0, STEPS)?;
        sheet.steps(STEPS, &mut check.1.0, &mut check.1.1);
        assert_near(check.0.configuration(), &check.1.0);
        let ours = going_on(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let hand = going_on((q, mu), |(q, mu), steps| sheet.steps(steps, q, mu));
        print("waves of unit vectors", n * n, &Memory(24, 24, false), &interleaved(&[ours, hand]));
    }
    Ok(())
}

fn assert_near(some: &[Vector3<f64>], others: &[Vector3<f64>]) {
    let apart = some.iter().zip(others).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    assert!(some.len() == others.len() && apart < 1e-11, "both are the same motion, and {apart} apart");
}

fn strings() -> Result<(), SiteError> {
    let (h, dx) = black_box((H, SPACING));
    for n in [1024, 65_536] {
        let stepper = Strand.grid([n]).spacing([dx]).periodic().stepper(h)?;
        let heights = |i: usize| (std::f64::consts::TAU * i as f64 / n as f64).sin();
        let start =
            stepper.state((0..n).map(|i| Vector1::new(heights(i))).collect::<Vec<_>>(), vec![Vector1::zeros(); n])?;
        let ours = going_on(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let plain: (Vec<f64>, Vec<f64>) = ((0..n).map(heights).collect(), vec![0.0; n]);
        let hand = going_on(plain, |(x, mu), steps| string_by_hand(h, h / (dx * dx), steps, x, mu));
        print("string", n, &Memory(8, 8, false), &interleaved(&[ours, hand]));
    }
    Ok(())
}

/// Rods that are free at both ends, and bend and stretch after a push across one end.
fn rods() -> Result<(), SiteError> {
    let (h, spacing) = black_box((0.002, 0.1));
    let (moments, mass) = (Vector3::new(3e-4, 2e-4, 1e-4), 0.1);
    let (bending, stretching) = (Vector3::new(0.5, 0.6, 0.4), Vector3::new(40.0, 50.0, 80.0));
    let rod = Rod {
        section: moments.push(mass),
        stiffness: Vector6::from_iterator(bending.iter().chain(&stretching).copied()),
        reference: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
    };
    let by_hand = ByHand {
        inertia: Vector3::new(moments.y + moments.z, moments.x + moments.z, moments.x + moments.y),
        mass,
        bending,
        stretching,
        curvature: Vector3::zeros(),
        tangent: Vector3::z(),
        spacing,
        h,
    };
    for n in [100, 10_000] {
        let stepper = rod.grid([n]).spacing([spacing]).stepper(h)?;
        let place = |i: usize| Vector3::new(0.0, 0.0, spacing * i as f64);
        let push = |i: usize| Vector3::new(0.01, 0.02, 0.0) * (i as f64 * 0.3).cos();
        let turn = |i: usize| Vector3::new(1e-5, 2e-5, 1e-5) * (i as f64 * 0.2).sin();
        let momentum = |i: usize| Vector6::from_iterator(turn(i).iter().chain(&push(i)).copied());
        let start = stepper.state(
            (0..n).map(|i| Matrix4::new_translation(&place(i))).collect::<Vec<_>>(),
            (0..n).map(momentum).collect::<Vec<_>>(),
        )?;
        let section = |i: usize| Section {
            rotation: nalgebra::Matrix3::identity(),
            place: place(i),
            turning: turn(i),
            moving: push(i),
        };
        let sections: Vec<Section> = (0..n).map(section).collect();
        let mut check = (start.clone(), sections.clone());
        stepper.advance(&mut check.0, STEPS)?;
        by_hand.steps(STEPS, &mut check.1);
        for column in 0..4 {
            let of = |q: &Matrix4<f64>| q.fixed_view::<3, 1>(0, column).into_owned();
            let of_section = |section: &Section| {
                if column < 3 { section.rotation.column(column).into_owned() } else { section.place }
            };
            let ours: Vectors = check.0.configuration().iter().map(of).collect();
            assert_near(&ours, &check.1.iter().map(of_section).collect::<Vectors>());
        }
        let ours = going_on(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let hand = going_on(sections, |rod, steps| by_hand.steps(steps, rod));
        print("rod", n, &Memory(128, 48, true), &interleaved(&[ours, hand]));
    }
    Ok(())
}

/// Waves by NumPy, whose configuration after some steps is the same.
fn numpy(must_run: bool) -> Result<(), SiteError> {
    println!("\n{:<24} {:>8} {:>10} {:>10} {:>8}", "ns a step and site", "sites", "clebsch", "NumPy", "ratio");
    for n in [32_usize, 128, 512] {
        let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/benches/fields/by_numpy.py");
        let words = [n.to_string(), STEPS.to_string(), H.to_string(), SPACING.to_string()];
        let output = Command::new(&python).arg(script).args(words).output();
        let Some(output) = output.ok().filter(|output| output.status.success()) else {
            println!("not run: `{python}` has no NumPy; PYTHON names another");
            assert!(!must_run, "NumPy was asked for");
            return Ok(());
        };
        let text = String::from_utf8_lossy(&output.stdout);
        let mut lines = text.lines();
        let time: f64 = lines.next().and_then(|line| line.parse().ok()).expect("a time");
        let place =
            |line: &str| Vector3::from_iterator(line.split(' ').map(|number| number.parse().expect("a number")));
        let theirs: Vectors = lines.map(place).collect();
        let stepper = WaveMap.grid([n, n]).spacing([SPACING; 2]).periodic().stepper(H)?;
        let (q, mu) = wave(n);
        let start = stepper.state(q, mu)?;
        let mut check = start.clone();
        stepper.advance(&mut check, STEPS)?;
        assert_near(check.configuration(), &theirs);
        let ours = going_on(start, |state, steps| stepper.advance(state, steps).expect("steps"));
        let ours = interleaved(&[ours])[0].least / (n * n) as f64;
        println!("{:<24} {:>8} {ours:>10.2} {time:>10.2} {:>8.2}", "waves of unit vectors", n * n, ours / time);
    }
    Ok(())
}

/// Waves on one and on two threads, and a loop without memory, which tells how much of two processors there is. 1 is all of them.
/// Both threads may share one core. A copy of as many numbers tells how much more memory gives to two threads.
fn threads() -> Result<(), SiteError> {
    println!("\n{:<24} {:>8} {:>10} {:>10} {:>8}", "ns a step and site", "sites", "1 thread", "2 threads", "of 2");
    let [one, two] = [1, 2].map(|count| ThreadPoolBuilder::new().num_threads(count).build().expect("threads"));
    let print = |name: &str, sites: usize, runs: &[Run<'_>]| {
        let times = interleaved(runs);
        let [alone, both] = [0, 1].map(|k| times[k].least / sites as f64);
        println!("{name:<24} {sites:>8} {alone:>10.2} {both:>10.2} {:>8.2}", alone / both / 2.0);
    };
    let runs = [&one, &two].map(|pool| {
        let run = |steps: u64| {
            pool.install(|| {
                (0..steps).for_each(|_| {
                    black_box(rayon::join(spin, spin));
                })
            })
        };
        Box::new(run) as Run<'_>
    });
    print("a loop in registers", 2 * SPINS * ABREAST, &runs);
    for n in [128, 256, 512, 1024] {
        let stepper = WaveMap.grid([n, n]).spacing([SPACING; 2]).periodic().stepper(H)?;
        let (q, mu) = wave(n);
        let start = stepper.state(q, mu)?;
        let runs = [&one, &two].map(|pool| {
            let state = RefCell::new(start.clone());
            let stepper = &stepper;
            let run = move |steps| {
                let mut state = state.borrow_mut();
                let state = &mut *state;
                pool.install(|| stepper.par_advance(state, steps)).expect("steps");
            };
            Box::new(run) as Run<'_>
        });
        print("waves of unit vectors", n * n, &runs);
        let copies = [&one, &two].map(|pool| {
            let copied = RefCell::new((vec![1.0_f64; 6 * n * n], vec![0.0_f64; 6 * n * n]));
            let run = move |times: u64| {
                let (from, to) = &mut *copied.borrow_mut();
                pool.install(|| {
                    for _ in 0..times {
                        to.par_chunks_mut(SHARE)
                            .zip(from.par_chunks(SHARE))
                            .for_each(|(to, from)| to.copy_from_slice(from));
                        black_box(&mut *to);
                    }
                });
            };
            Box::new(run) as Run<'_>
        });
        print("a copy of their state", n * n, &copies);
    }
    Ok(())
}

/// The numbers that a thread copies at a time.
const SHARE: usize = 24_576;

/// The rounds of a loop in registers.
const SPINS: usize = 100_000;

/// The numbers of a loop in registers: enough that none waits for another. Processors that share the units of one core show it.
const ABREAST: usize = 16;

/// A loop in registers, as busy as one processor can be.
fn spin() -> [f64; ABREAST] {
    let mut numbers = [1.0; ABREAST];
    for i in 0..SPINS {
        let added = i as f64;
        numbers.iter_mut().for_each(|x| *x = *x * 0.999_999 + added);
    }
    black_box(numbers)
}

fn main() -> Result<(), SiteError> {
    if std::env::args().any(|argument| argument == "numpy") {
        return numpy(true);
    }
    println!(
        "{:<24} {:>8} {:>10} {:>10} {:>8} {:>10} {:>8} {:>8} {:>11}",
        "ns a step and site", "sites", "clebsch", "by hand", "ratio", "of medians", "bytes", "of copy", "bound by"
    );
    waves()?;
    strings()?;
    rods()?;
    numpy(false)?;
    threads()
}
