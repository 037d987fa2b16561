//! The benchmark of large systems: `cargo bench -p clebsch-tests --bench large`.
//!
//! Nanoseconds of a step of rigid bodies in n dimensions and of points on spheres, in unrolled code and in matrix code.
//! The same by hand in nalgebra is timed in turn in the same run. All are seen to make the same motion first.

#[path = "../steps/timing.rs"]
mod timing;

use clebsch::{Clebsch, Declared, Method, State, Stepper};
use nalgebra::{SMatrix, SVector};
use std::cell::RefCell;
use std::hint::black_box;
use timing::{Run, interleaved};

/// The step size: h|ω| is about 0.1.
const H: f64 = 0.02;

/// Unrolled code, next to that of the declarations, which is matrix code.
struct Unrolled;

/// A rigid body in n dimensions.
macro_rules! body {
    ($name:ident, $n:tt $(, $method:ident)?) => {
        #[derive(Clebsch, Clone)]
        #[clebsch(
            action = |F: SO<$n>, R: SO<$n>| R * F,
            cost   = |h, F| (self.j_d * (F - I) * (F - I).transpose()).trace() / h,
            code   = matrices,
            $(method $method = (code = unrolled),)?
        )]
        struct $name {
            #[clebsch(symmetric)]
            j_d: SMatrix<f64, $n, $n>,
        }
    };
}

/// A point on the unit sphere of n dimensions in a quadratic potential.
macro_rules! neumann {
    ($name:ident, $n:tt $(, $method:ident)?) => {
        #[derive(Clebsch, Clone)]
        #[clebsch(
            action    = |F: SO<$n>, q: Unit<SVector<$n>>| F * q,
            cost      = |h, F| (F - I).norm_squared() / (4 * h),
            potential = |q| self.stiffness.dot(&q.component_mul(&q)) / 2,
            code      = matrices,
            $(method $method = (code = unrolled),)?
        )]
        struct $name {
            stiffness: SVector<f64, $n>,
        }
    };
}

body!(Body4, 4, Unrolled);
body!(Body5, 5, Unrolled);
body!(Body6, 6, Unrolled);
body!(Body8, 8);
body!(Body10, 10);
neumann!(PointOn4, 4, Unrolled);
neumann!(PointOn8, 8, Unrolled);
neumann!(PointOn11, 11, Unrolled);
neumann!(PointOn21, 21);
neumann!(PointOn101, 101);

/// Principal values of ½∫ρρᵀdm between ½ and 3/2.
fn principal<const N: usize>() -> SVector<f64, N> {
    SVector::from_fn(|i, _| 0.5 + (i as f64 + 0.3) / N as f64)
}

/// The body by hand, in its principal axes: hM = FJ − JFᵀ with F = (I − Z)⁻¹(I + Z) is 2(JZ + ZJ) = h(I − Z)M(I + Z).
/// It is solved by the fixed point Z ← L⁻¹(h/2(M + MZ − ZM − ZMZ)), whose L is made once, entry by entry.
struct ByHand<const N: usize> {
    /// h/2 over the sums of two principal values.
    factor: SMatrix<f64, N, N>,
    r: SMatrix<f64, N, N>,
    m: SMatrix<f64, N, N>,
}

impl<const N: usize> ByHand<N> {
    fn step(&mut self) {
        let identity = SMatrix::<f64, N, N>::identity();
        let divided = |right: &SMatrix<f64, N, N>| right.component_mul(&self.factor);
        let mut z = divided(&self.m);
        let mut last = f64::INFINITY;
        for _ in 0..60 {
            let mz = self.m * z;
            let next = divided(&(self.m + mz - mz.transpose() - z * mz));
            let change = (next - z).amax();
            z = next;
            if change <= f64::EPSILON / 4.0 * z.amax() || change >= last {
                break;
            }
            last = change;
        }
        let f = (identity - z).try_inverse().expect("a rotation") * (identity + z);
        self.r *= f;
        self.m = f.transpose() * self.m * f;
    }
}

/// The point on the sphere by hand: (q, w) with the projection.
struct PointByHand<const N: usize> {
    stiffness: SVector<f64, N>,
    q: SVector<f64, N>,
    w: SVector<f64, N>,
}

impl<const N: usize> PointByHand<N> {
    fn step(&mut self) {
        self.w -= 0.5 * H * self.stiffness.component_mul(&self.q);
        self.w -= self.q * self.q.dot(&self.w);
        let square = self.w.norm_squared();
        assert!(H * H * square < 1.0, "the step is too long");
        let cosine = (1.0 - H * H * square).sqrt();
        let next = self.q * cosine + self.w * H;
        self.w = self.w * cosine - self.q * (H * square);
        self.q = next;
        self.w -= 0.5 * H * self.stiffness.component_mul(&self.q);
        self.w -= self.q * self.q.dot(&self.w);
        let off = self.q.norm_squared() - 1.0;
        if off.abs() > 8.0 * f64::EPSILON {
            self.q *= 1.0 - 0.5 * off;
        }
    }
}

/// Steps by a method, one by one or all at once.
fn stepped<S: Clebsch<Scalar = f64> + Clone, M: Method<S>>(
    system: &S,
    q: S::Configuration,
    mu: S::Momentum,
    at_once: bool,
    steps: u64,
) {
    let stepper = system.stepper_by::<M>(H).expect("a regular system");
    let mut state = stepper.state(q, mu).expect("a state");
    match at_once {
        true => state = stepper.advance(&state, steps as usize).expect("steps"),
        false => {
            for _ in 0..steps {
                state = stepper.step(&state).expect("a step");
            }
        }
    }
    black_box(state);
}

/// The configuration after ten steps.
fn after_ten<S: Clebsch<Scalar = f64> + Clone, M: Method<S>>(
    system: &S,
    q: S::Configuration,
    mu: S::Momentum,
) -> S::Configuration {
    let stepper = system.stepper_by::<M>(H).expect("a regular system");
    let mut state = stepper.state(q, mu).expect("a state");
    for _ in 0..10 {
        state = stepper.step(&state).expect("a step");
    }
    *state.configuration()
}

fn report(n: usize, names: &[&str], contestants: &[Run<'_>]) -> Vec<f64> {
    let times = interleaved(contestants);
    for (name, time) in names.iter().zip(&times) {
        println!("{n:>5} {name:24} {:10.1} {:10.1} {:6.2}", time.least, time.median, time.least / times[0].least);
    }
    times.iter().map(|time| time.least).collect()
}

/// Bodies of one dimension.
macro_rules! bodies {
    ($n:literal, $m:literal, $system:ident $(, $name:literal: $method:ident)*) => {{
        let momentum = SVector::<f64, $m>::from_fn(|k, _| 2.0 * (1.7 * k as f64 + 0.4).sin());
        let j = principal::<$n>();
        let by_hand = |steps: u64| {
            // components are those of E_ji − E_ij: M = ½ Σ μ_k E_k
            let mut m = SMatrix::<f64, $n, $n>::zeros();
            let mut k = 0;
            for a in 0..$n {
                for b in a + 1..$n {
                    (m[(b, a)], m[(a, b)]) = (0.5 * momentum[k], -0.5 * momentum[k]);
                    k += 1;
                }
            }
            let factor = SMatrix::from_fn(|a, b| 0.5 * H / (j[a] + j[b]));
            let mut body = ByHand { factor, r: SMatrix::identity(), m };
            (0..steps).for_each(|_| body.step());
            body.r
        };
        let turned = by_hand(10);
        let mut names = vec!["by hand"];
        let mut contestants: Vec<Run<'_>> = vec![Box::new(|steps| {
            black_box(by_hand(steps));
        })];
        $(
            names.push($name);
            let system = $system { j_d: SMatrix::from_diagonal(&j) };
            assert!((after_ten::<_, $method>(&system, SMatrix::identity(), momentum) - turned).amax() < 1e-12, "the same motion");
            contestants.push(Box::new(move |steps| stepped::<_, $method>(&system, SMatrix::identity(), momentum, false, steps)));
        )*
        report($n, &names, &contestants)
    }};
}

/// Points on the sphere of one dimension.
macro_rules! points {
    ($n:literal, $m:literal, $system:ident $(, $name:literal: $method:ident)*) => {{
        let stiffness = principal::<$n>();
        let q = SVector::<f64, $n>::from_fn(|i, _| (1.3 * i as f64 + 0.2).cos()).normalize();
        let w = SVector::<f64, $n>::from_fn(|i, _| (0.7 * i as f64).sin()).normalize();
        let w = w - q * q.dot(&w);
        let by_hand = |steps: u64| {
            let mut point = PointByHand { stiffness, q, w };
            (0..steps).for_each(|_| point.step());
            point.q
        };
        let moved = by_hand(10);
        let mut names = vec!["by hand, (q, w)"];
        let mut contestants: Vec<Run<'_>> = vec![Box::new(|steps| {
            black_box(by_hand(steps));
        })];
        $(
            let system = $system { stiffness };
            let mu = system.momentum_map(&q, &w);
            assert!((after_ten::<_, $method>(&system, q, mu) - moved).amax() < 1e-12, "the same motion");
            let other = system.clone();
            names.push($name);
            contestants.push(Box::new(move |steps| stepped::<_, $method>(&system, q, mu, false, steps)));
            names.push(concat!($name, ", advance"));
            contestants.push(Box::new(move |steps| stepped::<_, $method>(&other, q, mu, true, steps)));
            names.push(concat!($name, ", Integrator"));
            let stepper = $system { stiffness }.into_stepper_by::<$method>(H).expect("a regular system");
            let start = stepper.state(q, mu).expect("a state");
            let integrator = RefCell::new(stepper.integrator(start));
            contestants.push(Box::new(move |steps| (0..steps).for_each(|_| integrator.borrow_mut().step().expect("a step"))));
        )*
        report($n, &names, &contestants)
    }};
}

fn main() {
    println!("Time of a step of a rigid body in n dimensions, ns; ratio to by hand\n");
    println!("{:>5} {:24} {:>10} {:>10} {:>6}", "n", "", "least", "median", "ratio");
    bodies!(4, 6, Body4, "unrolled": Unrolled, "matrices": Declared);
    bodies!(5, 10, Body5, "unrolled": Unrolled, "matrices": Declared);
    bodies!(6, 15, Body6, "unrolled": Unrolled, "matrices": Declared);
    let eight = bodies!(8, 28, Body8, "matrices": Declared);
    let ten = bodies!(10, 45, Body10, "matrices": Declared);
    println!("\ntime of a step ∝ n^{:.2} from 8 to 10\n", (ten[1] / eight[1]).ln() / (10.0_f64 / 8.0).ln());
    println!("Time of a step on the unit sphere of n dimensions, ns; ratio to by hand\n");
    println!("{:>5} {:24} {:>10} {:>10} {:>6}", "n", "", "least", "median", "ratio");
    points!(4, 6, PointOn4, "unrolled": Unrolled, "matrices": Declared);
    points!(8, 28, PointOn8, "unrolled": Unrolled, "matrices": Declared);
    points!(11, 55, PointOn11, "unrolled": Unrolled, "matrices": Declared);
    let small = points!(21, 210, PointOn21, "matrices": Declared);
    let large = points!(101, 5050, PointOn101, "matrices": Declared);
    let growth = |k: usize| (large[k] / small[k]).ln() / (101.0_f64 / 21.0).ln();
    println!("\ntime ∝ n^{:.2} of a step, n^{:.2} of one of many, from 21 to 101", growth(1), growth(2));
    memory();
}

/// Bytes of a state and of a stepper, all that a step reads and writes; `tests/no_std/check` has the stack that a step
/// takes meanwhile.
fn memory() {
    println!("\nBytes of a state and of a stepper, whole matrices\n");
    println!("{:>5} {:24} {:>10} {:>10}", "n", "", "state", "stepper");
    let row =
        |n: usize, name: &str, [state, stepper]: [usize; 2]| println!("{n:>5} {name:24} {state:>10} {stepper:>10}");
    let bodies = [(5, bytes::<Body5>()), (6, bytes::<Body6>()), (8, bytes::<Body8>()), (10, bytes::<Body10>())];
    bodies.iter().for_each(|(n, bytes)| row(*n, "body", *bytes));
    let points = [(8, bytes::<PointOn8>()), (21, bytes::<PointOn21>()), (101, bytes::<PointOn101>())];
    points.iter().for_each(|(n, bytes)| row(*n, "point", *bytes));
    let growth = |rows: &[(usize, [usize; 2])], k: usize| {
        let (first, last) = (rows[0], rows[rows.len() - 1]);
        (last.1[k] as f64 / first.1[k] as f64).ln() / (last.0 as f64 / first.0 as f64).ln()
    };
    println!(
        "\nbytes ∝ n^{:.2} and n^{:.2} of bodies, whose inverse inertia is a matrix of all components; n^{:.2} and n^{:.2} of points",
        growth(&bodies, 0),
        growth(&bodies, 1),
        growth(&points, 0),
        growth(&points, 1)
    );
}

fn bytes<S: Clebsch>() -> [usize; 2] {
    [size_of::<State<S>>(), size_of::<Stepper<S>>()]
}
