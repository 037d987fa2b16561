#![allow(missing_docs)]
use clebsch::Clebsch;
use nalgebra::{Matrix3, Vector3};
use std::time::Instant;
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    lagrangian = |omega| omega.dot(&(Matrix3::from_diagonal(&self.moments) * omega)) / 2,
    discretization = exact,
    potential = |R| R[(2, 2)],
    order = 4,
)]
pub struct Split4 { pub moments: Vector3<f64> }
fn main() {
    let moments = Vector3::new(1.0, 1.5, 2.0);
    let n: usize = std::env::args().nth(1).and_then(|s| s.parse().ok()).unwrap_or(20);
    let stepper = Split4 { moments }.stepper(1.0 / n as f64).unwrap();
    let (s, c) = 0.5_f64.sin_cos();
    let state = stepper.state(Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c), Vector3::new(0.1, 0.3, 10.0)).unwrap();
    let clock = Instant::now();
    let count: usize = std::env::args().nth(2).and_then(|s| s.parse().ok()).unwrap_or(500_000);
    let mut end = state;
    for _ in 0..count / 1000 { end = stepper.advance(&end, 1000).unwrap(); }
    println!("{:.1} ns/drift {}", clock.elapsed().as_nanos() as f64 / count as f64 / 4.0, end.momentum().x);
}
