//! The benchmark of powers: `cargo bench -p clebsch-tests --bench sites`.
//!
//! Nanoseconds of a step for each site of a ring of spins, and for each pair of bodies that attract each other. The same
//! for each link of a chain on ball joints. N goes from 4 to 100 000. The ways are `Sites`, an array where a stack has room for it, unrolled code with a number for N,
//! and nalgebra by hand. They are timed in turn in the same run.

mod chain;
#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Clebsch, SiteStorage};
use nalgebra::Vector3;
use std::cell::RefCell;
use timing::{Run, Time, interleaved};

/// The step size.
const H: f64 = 0.02;
/// Sites of a round, so that rounds of all N take about the same time.
const WORK: usize = 20_000;

/// A ring of spins, of N or of a number of them.
macro_rules! ring {
    ($name:ident, [$($generics:tt)*], $n:tt) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action    = |F: [SO<3>; $n], q: [Unit<Vector3>; $n]| (0..$n).map(|i| F[i] * q[i]),
            cost      = |h, F| (0..$n).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
            potential = |q| (0..$n).map(|i| -self.exchange * q[i].dot(&q[(i + 1) % $n]) - self.field.dot(&q[i])).sum(),
        )]
        struct $name $($generics)* {
            exchange: f64,
            field: Vector3<f64>,
        }
    };
}
ring!(Ring, [<const N: usize>], N);
ring!(Ring4, [], 4);
ring!(Ring16, [], 16);

/// Bodies that attract each other.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| self.mass * a[i].norm_squared()).sum() / (2 * h),
    potential = |x| -self.mass * self.mass * (0..N).map(|i| (i + 1..N).map(|j| (x[i] - x[j]).norm().recip()).sum()).sum(),
)]
struct Bodies<const N: usize> {
    mass: f64,
}

type Vectors = Vec<Vector3<f64>>;

const FIELD: Vector3<f64> = Vector3::new(0.1, 0.2, 0.5);
const EXCHANGE: f64 = 0.7;

/// A spiral, turning about the third axis.
fn spins(n: usize) -> (Vectors, Vectors) {
    let spin = |i: usize| Vector3::new((0.7 * i as f64).cos(), (0.7 * i as f64).sin(), 0.3).normalize();
    let q: Vectors = (0..n).map(spin).collect();
    let mu = q.iter().map(|q| q.cross(&Vector3::new(0.3, -0.2, 0.1))).collect();
    (q, mu)
}

/// Bodies on a helix, far enough from each other.
fn bodies(n: usize) -> (Vectors, Vectors) {
    let place = |i: usize| Vector3::new(5.0 * (i as f64).cos(), 5.0 * (i as f64).sin(), 0.7 * i as f64);
    ((0..n).map(place).collect(), vec![Vector3::zeros(); n])
}

/// The ring by hand: half a kick, the turn in closed form, length, half a kick; the neighbours of each are read where they stand.
struct ByHand {
    q: Vectors,
    mu: Vectors,
    kick: Vectors,
}

impl ByHand {
    fn new((q, mu): (Vectors, Vectors)) -> Self {
        let kick = vec![Vector3::zeros(); q.len()];
        let mut ring = Self { q, mu, kick };
        ring.kick();
        ring
    }

    fn kick(&mut self) {
        let n = self.q.len();
        for i in 0..n {
            let before = self.q[if i == 0 { n - 1 } else { i - 1 }];
            let after = self.q[if i + 1 == n { 0 } else { i + 1 }];
            self.kick[i] = 0.5 * H * self.q[i].cross(&(EXCHANGE * (before + after) + FIELD));
        }
    }

    fn step(&mut self) {
        for ((q, mu), kick) in self.q.iter_mut().zip(&mut self.mu).zip(&self.kick) {
            *mu += kick;
            let turn = H * *mu;
            let square = turn.norm_squared();
            assert!(square < 1.0, "the step is too long");
            let across = turn.cross(q);
            *q += across + turn.cross(&across) / (1.0 + (1.0 - square).sqrt());
            let off = q.norm_squared() - 1.0;
            if off.abs() > 8.0 * f64::EPSILON {
                *q *= 1.0 - 0.5 * off;
            }
        }
        self.kick();
        self.mu.iter_mut().zip(&self.kick).for_each(|(mu, kick)| *mu += kick);
    }
}

/// The bodies by hand: Störmer and Verlet, each pair once.
struct BodiesByHand {
    x: Vectors,
    p: Vectors,
    force: Vectors,
}

impl BodiesByHand {
    fn step(&mut self) {
        let n = self.x.len();
        for ((x, p), force) in self.x.iter_mut().zip(&mut self.p).zip(&self.force) {
            *p += 0.5 * H * force;
            *x += H * *p;
        }
        self.force.fill(Vector3::zeros());
        for i in 0..n {
            for j in i + 1..n {
                let apart = self.x[i] - self.x[j];
                let square = apart.norm_squared();
                let pull = apart / (square * square.sqrt());
                self.force[i] -= pull;
                self.force[j] += pull;
            }
        }
        self.p.iter_mut().zip(&self.force).for_each(|(p, force)| *p += 0.5 * H * force);
    }
}

fn main() {
    println!("Time of a step of one of N spins in a ring, ns; ratio to by hand. {} bytes a spin by `Sites`\n", 7 * 24);
    println!("{:>8} {:24} {:>8} {:>8} {:>6}", "N", "", "least", "median", "ratio");
    let growth = [
        (
            4,
            rings::<4>(Some([&|steps| written_out(Ring4 { exchange: EXCHANGE, field: FIELD }, steps), &|steps| {
                written_out_advanced(Ring4 { exchange: EXCHANGE, field: FIELD }, steps)
            }])),
        ),
        (
            16,
            rings::<16>(Some([&|steps| written_out(Ring16 { exchange: EXCHANGE, field: FIELD }, steps), &|steps| {
                written_out_advanced(Ring16 { exchange: EXCHANGE, field: FIELD }, steps)
            }])),
        ),
        (64, rings::<64>(None)),
        (1000, rings::<1000>(None)),
        (100_000, rings::<100_000>(None)),
    ];
    println!("\ntime of a step ∝ N^{:.2} from 64 to 100000 sites\n", exponent(&growth[2..]));
    println!("Time of a step for each pair of N bodies, ns; ratio to by hand\n");
    println!("{:>8} {:24} {:>8} {:>8} {:>6}", "N", "", "least", "median", "ratio");
    let growth = [(8, pairs::<8>()), (64, pairs::<64>()), (512, pairs::<512>())];
    println!("\ntime of a step ∝ N^{:.2} from 64 to 512 bodies\n", exponent(&growth[1..]));
    println!("Time of a step for each link of a chain on ball joints, ns; ratio to by hand\n");
    println!("{:>8} {:24} {:>8} {:>8} {:>6}", "N", "", "least", "median", "ratio");
    let growth = [
        (2, chains::<2>()),
        (5, chains::<5>()),
        (10, chains::<10>()),
        (30, chains::<30>()),
        (100, chains::<100>()),
        (1000, chains::<1000>()),
    ];
    println!("\ntime of a step ∝ N^{:.2} from 10 to 1000 links", exponent(&growth[2..]));
}

/// The exponent of N in the time of a step, from the first to the last.
fn exponent(steps: &[(usize, f64)]) -> f64 {
    let (first, last) = (steps[0], steps[steps.len() - 1]);
    (last.1 / first.1).ln() / (last.0 as f64 / first.0 as f64).ln()
}

/// Steps of a declaration with a number, as many as there are rounds.
fn written_out<S, const M: usize, const N: usize>(ring: S, steps: u64) -> u64
where
    S: Clebsch<Scalar = f64, Configuration = [Vector3<f64>; N], Momentum = nalgebra::SVector<f64, M>> + Clone,
{
    let (q, mu) = spins(N);
    let stepper = ring.stepper(H).expect("a ring");
    let points: [Vector3<f64>; N] = std::array::from_fn(|i| q[i]);
    let mut state = stepper.state(points, nalgebra::SVector::from_fn(|k, _| mu[k / 3][k % 3])).expect("a state");
    for _ in 0..steps {
        state = stepper.step(&state).expect("a step");
    }
    std::hint::black_box(state);
    steps
}

/// The same by `advance`: a function of its own, as the two together would not be inlined.
fn written_out_advanced<S, const M: usize, const N: usize>(ring: S, steps: u64) -> u64
where
    S: Clebsch<Scalar = f64, Configuration = [Vector3<f64>; N], Momentum = nalgebra::SVector<f64, M>> + Clone,
{
    let (q, mu) = spins(N);
    let stepper = ring.stepper(H).expect("a ring");
    let points: [Vector3<f64>; N] = std::array::from_fn(|i| q[i]);
    let state = stepper.state(points, nalgebra::SVector::from_fn(|k, _| mu[k / 3][k % 3])).expect("a state");
    std::hint::black_box(stepper.advance(&state, steps as usize).expect("steps"));
    steps
}

/// Times all ways to step N spins; gives the time of a step by `Sites`.
fn rings<const N: usize>(unrolled: Option<[&dyn Fn(u64) -> u64; 2]>) -> f64 {
    let (q, mu) = spins(N);
    let ring = Ring::<N> { exchange: EXCHANGE, field: FIELD };
    let by_sites =
        RefCell::new(ring.stepper(H).expect("regular").sites(SiteStorage::of(q.clone(), mu.clone())).expect("a ring"));
    let by_hand = RefCell::new(ByHand::new((q.clone(), mu.clone())));
    let steps = (WORK / N).max(1) as u64;
    let stepped = || (0..steps).for_each(|_| by_hand.borrow_mut().step());
    let in_array = |steps: u64| {
        let stepper = ring.stepper(H).expect("a ring");
        let (q, mu): ([_; N], [_; N]) = (std::array::from_fn(|i| q[i]), std::array::from_fn(|i| mu[i]));
        let mut state = stepper.state(q, mu).expect("a state");
        for _ in 0..steps {
            state = stepper.step(&state).expect("a step");
        }
        std::hint::black_box(state);
    };
    let advanced = |steps: u64| {
        let stepper = ring.stepper(H).expect("a ring");
        let (q, mu): ([_; N], [_; N]) = (std::array::from_fn(|i| q[i]), std::array::from_fn(|i| mu[i]));
        let state = stepper.state(q, mu).expect("a state");
        std::hint::black_box(stepper.advance(&state, steps as usize).expect("steps"));
    };
    let mut names = vec!["by hand", "Sites"];
    let mut contestants: Vec<Run<'_>> = vec![
        Box::new(|rounds| (0..rounds).for_each(|_| stepped())),
        Box::new(|rounds| (0..rounds).for_each(|_| by_sites.borrow_mut().advance(steps).expect("steps"))),
    ];
    if N <= 64 {
        names.push("array");
        contestants.push(Box::new(|rounds| in_array(rounds * steps)));
        names.push("array, Integrator");
        let stepper = ring.stepper(H).expect("a ring");
        let start = stepper.state(std::array::from_fn(|i| q[i]), std::array::from_fn(|i| mu[i])).expect("a state");
        let integrator = RefCell::new(stepper.integrator(start));
        contestants.push(Box::new(move |rounds| {
            (0..rounds * steps).for_each(|_| integrator.borrow_mut().step().expect("a step"));
        }));
        names.push("array, advance");
        contestants.push(Box::new(|rounds| advanced(rounds * steps)));
    }
    if let Some(unrolled) = unrolled {
        for (name, unrolled) in ["written out", "written out, advance"].into_iter().zip(unrolled) {
            names.push(name);
            contestants.push(Box::new(move |rounds| {
                unrolled(rounds * steps);
            }));
        }
    }
    report(N, &names, &interleaved(&contestants), steps as f64 * N as f64) * N as f64
}

/// Times both ways to step N bodies; gives the time of a step by `Sites`.
fn pairs<const N: usize>() -> f64 {
    let (q, mu) = bodies(N);
    let storage = SiteStorage::of(q.clone(), mu.clone());
    let by_sites =
        RefCell::new(Bodies::<N> { mass: 1.0 }.into_stepper(H).expect("regular").sites(storage).expect("bodies"));
    let by_hand = RefCell::new(BodiesByHand { force: vec![Vector3::zeros(); N], x: q, p: mu });
    let count = N * (N - 1) / 2;
    let steps = (WORK / count).max(1) as u64;
    let contestants: Vec<Run<'_>> = vec![
        Box::new(|rounds| (0..rounds * steps).for_each(|_| by_hand.borrow_mut().step())),
        Box::new(|rounds| by_sites.borrow_mut().advance(rounds * steps).expect("steps")),
    ];
    report(N, &["by hand", "Sites"], &interleaved(&contestants), steps as f64 * count as f64) * count as f64
}

/// Times both ways to step a chain of N links from its start; gives the time of a step by `Sites`.
fn chains<const N: usize>() -> f64 {
    let stepper = chain::chain::<N>().into_stepper(chain::H).expect("regular");
    let room = vec![stepper.joint(); N];
    let start = stepper.joined_sites(chain::storage(N), room).expect("a chain");
    let steps = (WORK / 20 / N).max(1) as u64;
    // both move alike
    let (mut sites, mut hand) = (start.clone(), chain::ByHand::new(N));
    sites.advance(20).expect("steps");
    (0..20).for_each(|_| hand.step());
    for (place, by_hand) in sites.configuration().iter().zip(hand.places()) {
        let far = (place.fixed_view::<3, 1>(0, 3) - by_hand).norm();
        assert!(far < 1e-10, "{far:e}");
    }
    let by_hand = RefCell::new(hand);
    let by_sites = RefCell::new(sites);
    let contestants: Vec<Run<'_>> = vec![
        Box::new(|rounds| (0..rounds * steps).for_each(|_| by_hand.borrow_mut().step())),
        Box::new(|rounds| by_sites.borrow_mut().advance(rounds * steps).expect("steps")),
    ];
    report(N, &["by hand", "Sites"], &interleaved(&contestants), steps as f64 * N as f64) * N as f64
}

/// Prints the time of each way for one of so many things; gives the least of the second.
fn report(n: usize, names: &[&str], times: &[Time], things: f64) -> f64 {
    for (name, time) in names.iter().zip(times) {
        let ratio = time.least / times[0].least;
        println!("{n:>8} {name:24} {:8.2} {:8.2} {ratio:6.2}", time.least / things, time.median / things);
    }
    times[1].least / things
}
