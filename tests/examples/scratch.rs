#![allow(missing_docs)]
use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};
use std::time::Instant;
macro_rules! top {
    ($name:ident, $order:literal, $disc:ident) => {
        #[derive(Clebsch, Clone, Debug)]
        #[clebsch(
            action = |F: SO<3>, R: SO<3>| R * F,
            lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
            discretization = $disc,
            potential = |R| R[(2, 2)],
            order = $order,
        )]
        pub struct $name {
            pub moments: Vector3<f64>,
        }
    };
}
top!(Split4, 4, exact);
top!(Split6, 6, exact);
top!(Strang, 2, exact);
top!(Plain, 2, moser_veselov);
top!(Eight, 8, cayley);
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = exact,
)]
pub struct Free {
    pub moments: Vector3<f64>,
}
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = moser_veselov,
)]
pub struct FreeMv {
    pub moments: Vector3<f64>,
}

fn start() -> (Matrix3<f64>, Vector3<f64>) {
    let (s, c) = 0.5_f64.sin_cos();
    (Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c), Vector3::new(0.1, 0.3, 10.0))
}
fn run<S: Clebsch<Scalar = f64, Configuration = Matrix3<f64>, Momentum = Vector3<f64>> + Clone>(
    s: &S,
    n: usize,
    t: usize,
) -> (Vec<Matrix3<f64>>, f64) {
    let stepper = s.clone().stepper(1.0 / n as f64).unwrap();
    let (r, m) = start();
    let mut best = f64::INFINITY;
    let mut out = vec![];
    for _ in 0..3 {
        out.clear();
        let mut state = stepper.state(r, m).unwrap();
        let clock = Instant::now();
        for _ in 0..t {
            state = stepper.advance(&state, n).unwrap();
            out.push(*state.configuration());
        }
        best = best.min(clock.elapsed().as_nanos() as f64 / (t * n) as f64);
    }
    (out, best)
}
fn err(a: &[Matrix3<f64>], b: &[Matrix3<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs().max()).fold(0.0, f64::max)
}
fn main() {
    let moments = Vector3::new(1.0, 1.5, 2.0);
    let t = 50;
    let (reference, _) = run(&Eight { moments }, 160, t);
    let (other, _) = run(&Split6 { moments }, 60, t);
    println!("references differ by {:e}", err(&reference, &other));
    for n in [2, 4, 10, 20] {
        let (p, ns) = run(&Split4 { moments }, n, t);
        println!("split4 {n}: {:.2e} {:.0} ns/unit {:.1} ns/step", err(&p, &other), ns * n as f64, ns);
    }
    for n in [2, 3, 5, 10, 20] {
        let (p, ns) = run(&Split6 { moments }, n, t);
        println!("split6 {n}: {:.2e} {:.0} ns/unit {:.1}", err(&p, &other), ns * n as f64, ns);
    }
    for n in [100] {
        let (p, ns) = run(&Strang { moments }, n, t);
        println!("strang {n}: {:.2e} {:.0} ns/unit {:.1}", err(&p, &other), ns * n as f64, ns);
    }
    for n in [100] {
        let (p, ns) = run(&Plain { moments }, n, t);
        println!("plain {n}: {:.2e} {:.0} ns/unit {:.1}", err(&p, &other), ns * n as f64, ns);
    }
    let moments = Vector3::new(1.0, 2.0, 3.0);
    for h in [0.01, 0.1, 1.0, 2.0] {
        let stepper = Free { moments }.stepper(h).unwrap();
        let plain = FreeMv { moments }.stepper(h).unwrap();
        let n = 1_000_00;
        let mut state = stepper.state(Matrix3::identity(), Vector3::new(0.3, 2.0, 0.6)).unwrap();
        let clock = Instant::now();
        for _ in 0..n {
            state = stepper.step(&state).unwrap();
        }
        let exact = clock.elapsed().as_nanos() as f64 / n as f64;
        let clock0 = Instant::now();
        let _ = clock0;
        let mut state = plain.state(Matrix3::identity(), Vector3::new(0.3, 2.0, 0.6)).unwrap();
        let clock = Instant::now();
        for _ in 0..n {
            match plain.step(&state) {
                Ok(s) => state = s,
                Err(_) => break,
            }
        }
        let clock = Instant::now();
        let state =
            stepper.advance(&stepper.state(Matrix3::identity(), Vector3::new(0.3, 2.0, 0.6)).unwrap(), n).unwrap();
        println!("advance {:.1} ns {}", clock.elapsed().as_nanos() as f64 / n as f64, state.momentum().x);
        println!("free h={h}: exact {exact:.1} ns, plain {:.1}", clock.elapsed().as_nanos() as f64 / n as f64);
    }
    let clock = Instant::now();
    for i in 0..1000 {
        std::hint::black_box(Free { moments }.stepper(0.1 + i as f64 * 1e-5).unwrap());
    }
    println!("stepper {:.1} µs", clock.elapsed().as_nanos() as f64 / 1e6);
}
