//! Powers with a const generic, in storage on the heap.

use crate::run::Task;
use crate::trajectories::Recorder;
use clebsch::{Clebsch, SiteStorage};
use clebsch_tests::fixtures::spin_chain::SpinChain;
use nalgebra::Vector3;

/// Bodies that attract each other: the terms of their potential are gone through pair by pair.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| self.mass * a[i].norm_squared()).sum() / (2 * h),
    potential = |x| -self.mass * self.mass * (0..N).map(|i| (i + 1..N).map(|j| (x[i] - x[j]).norm().recip()).sum()).sum(),
)]
struct Bodies<const N: usize> {
    mass: f64,
}

/// The chain of first order, whose sites kick after they moved.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| self.inertia[i] * (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |q| (0..N).map(|i| -self.exchange * q[i].dot(&q[(i + 1) % N])).sum(),
    order     = 1,
)]
struct FirstOrderChain<const N: usize> {
    inertia: [f64; N],
    exchange: f64,
}

/// Sites that are tops, of fourth order.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SO<3>; N], R: [SO<3>; N]| (0..N).map(|i| R[i] * F[i]),
    lagrangian = |omega| (0..N).map(|i| omega[i].dot(&self.moments.component_mul(&omega[i])) / 2).sum(),
    potential  = |R| (0..N).map(|i| self.tie * (R[i] * Vector3::z()).dot(&(R[(i + 1) % N] * Vector3::z()))).sum(),
)]
struct Tops<const N: usize> {
    moments: Vector3<f64>,
    tie: f64,
}

const N: usize = 5;

pub fn all(task: &Recorder) {
    let q: [Vector3<f64>; N] = std::array::from_fn(|i| {
        let angle = 0.7 * i as f64;
        Vector3::new(angle.cos(), angle.sin(), 0.3).normalize()
    });
    let far = q.map(|q| 5.0 * q);
    let first = FirstOrderChain::<N> { inertia: std::array::from_fn(|i| 1.0 + 0.1 * i as f64), exchange: 0.7 };
    let tops = Tops::<N> { moments: Vector3::new(1.0, 1.4, 1.9), tie: 0.4 };
    task.combination("sites_bodies", Bodies::<N> { mass: 1.0 }, far, 0.02);
    task.combination("sites_first_order", first, q, 0.02);
    task.combination("sites_tops", tops, [clebsch_tests::scenes::turned(); N], 0.02);
    task.quantity("sites_spins", "sites", |record| {
        let spins = SpinChain::<N> { exchange: 0.7, field: Vector3::new(0.1, 0.2, 0.5) };
        let mu = q.map(|q| q.cross(&Vector3::new(0.3, -0.2, 0.1)));
        let storage = SiteStorage::of(q.to_vec(), mu.to_vec());
        let mut sites = spins
            .into_stepper(0.02)
            .and_then(|stepper| stepper.sites(storage).map_err(|error| error.error))
            .expect("spins");
        for _ in 0..1000 {
            sites.step().expect("a step");
            sites.configuration().iter().for_each(|q| record.add(q));
            sites.momentum().iter().for_each(|mu| record.add(mu));
        }
    });
}
