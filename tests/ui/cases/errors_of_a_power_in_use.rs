use clebsch::Clebsch;
use nalgebra::Vector3;

/// The error of the declaration is the only one, however the system is used.
#[derive(Clebsch, Clone)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| q[i].dot(&q[i + 1])).sum(),
)]
struct Ring<const N: usize> {}

fn main() {
    let stepper = Ring::<4> {}.stepper(0.1).unwrap();
    let start = stepper.state([Vector3::x(); 4], [Vector3::z(); 4]).unwrap();
    let next = stepper.step(&start).unwrap();
    println!("{} {}", next.configuration()[0], next.momentum()[3]);
}
