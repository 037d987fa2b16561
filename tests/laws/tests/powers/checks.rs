//! The relations between the two ways to compile a declaration.

use clebsch::{Clebsch, Power, SiteStorage, Space};
use clebsch_tests::oracle::flat::{Flat, far};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
use nalgebra::SVector;

const H: f64 = 0.02;

/// All components in one vector.
fn joined<const M: usize>(mu: &impl Flat) -> SVector<f64, M> {
    SVector::from_column_slice(&mu.numbers())
}

/// Every derived function of a power of four sites is that of the unrolled declaration, on 20 steps of a random motion.
pub fn agree<P, U, Q, F, K, const M: usize, const L: usize>(
    power: &P,
    unrolled: &U,
    q: [Q; 4],
    mu: [SVector<f64, M>; 4],
    random: &mut Random,
) where
    P: Clebsch<Scalar = f64, Configuration = [Q; 4], Element = [F; 4], Momentum = [SVector<f64, M>; 4], Input = ()>
        + Clone,
    U: Clebsch<
            Scalar = f64,
            Configuration = [Q; 4],
            Element = [F; 4],
            Momentum = SVector<f64, L>,
            Input = (),
            Time = P::Time,
            MomentumMatrix = P::MomentumMatrix,
        > + Clone,
    P::MomentumMatrix: Flat,
    P: Clebsch<MomentumMatrix = K>,
    K: Space<f64>,
    Q: Space<f64> + Flat,
    F: Space<f64> + Flat,
{
    assert_eq!(4 * M, L);
    let near = |distance: f64, what: &str| {
        assert!(distance < 1e-11, "{what}: {distance:.1e} apart for {}", P::NAME);
    };
    let (a, b) = (power.stepper(H).expect("a regular power"), unrolled.stepper(H).expect("a regular system"));
    let mut x = a.state(q, mu).expect("a state of the power");
    let mut y = b.state(q, joined(&mu)).expect("a state");
    let p: [Q; 4] = q.map(|q| q.zip_map(&q, |x, _| 0.3 * x + 0.1));
    near(far(&power.momentum_map(&q, &p), &joined::<L>(&unrolled.momentum_map(&q, &p))), "J");
    let f = power.inverse_legendre(&power.step_constants(H).expect("constants"), 0.3, &q, &mu).expect("a solution");
    let g = unrolled.inverse_legendre(&unrolled.step_constants(H).expect("constants"), 0.3, &q, &joined(&mu));
    near(far(&f, g.as_ref().expect("a solution")), "F");
    near(far(&power.act(&f, &q), &unrolled.act(&f, &q)), "the action");
    near(far(&power.coadjoint(&f, &mu), &unrolled.coadjoint(&f, &joined(&mu))), "Ad*");
    near(far(&power.legendre(H, 0.3, &q, &f), &unrolled.legendre(H, 0.3, &q, &f)), "F⁻ℓd");
    near(far(&power.legendre(H, 0.3, &q, &f), &mu), "F⁻ℓd inverted");
    near(far(&power.legendre_next(H, 0.3, &q, &f), &unrolled.legendre_next(H, 0.3, &q, &f)), "F⁺ℓd");
    near(far(&power.stagger(H, 0.3, &q), &unrolled.stagger(H, 0.3, &q)), "what the momentum is ahead by");
    near(far(&P::momentum_matrix(&mu), &U::momentum_matrix(&joined(&mu))), "M");
    near(far(&P::momentum_components(&P::momentum_matrix(&mu)), &mu), "the components of M");
    let some = std::array::from_fn(|_| random.vector::<M>());
    near(far(&power.project_momentum(&q, &some), &unrolled.project_momentum(&q, &joined(&some))), "the projection");
    let defect = |a: f64, b: f64| (a - b).abs();
    near(defect(power.isotropy_defect(&q, &some), unrolled.isotropy_defect(&q, &joined(&some))), "the defect of μ");
    let off: [Q; 4] = std::array::from_fn(|i| q[i].zip_map(&q[i], |x, _| x * (1.0 + 0.01 * i as f64)));
    near(defect(power.orbit_defect(&off), unrolled.orbit_defect(&off)), "the defect of q");
    near(defect(power.potential(0.3, &q), unrolled.potential(0.3, &q)), "V");
    near(defect(a.kinetic_energy(&x), b.kinetic_energy(&y)), "T");
    let mut upstairs = a.cotangent_state(q, p).expect("a state of the power on T*Q");
    let mut written = b.cotangent_state(q, p).expect("a state on T*Q");
    for _ in 0..20 {
        x = a.step(&x).expect("a step of the power");
        y = b.step(&y).expect("a step");
        upstairs = a.step_symmetric(&upstairs).expect("a step of the power on T*Q");
        written = b.step_symmetric(&written).expect("a step on T*Q");
    }
    assert!(far(x.configuration(), &q) > 1e-3, "it moves");
    near(far(x.configuration(), y.configuration()).max(far(&x.momentum(), &y.momentum())), "20 steps");
    let there =
        far(upstairs.configuration(), written.configuration()).max(far(upstairs.covector(), written.covector()));
    near(there, "20 steps on T*Q");
    near(defect(a.energy(&x), b.energy(&y)), "the energy");
}

/// Steps in arrays, vectors and slices have the same bits.
pub fn storage_does_not_matter<P, Q, const M: usize>(power: &P, q: [Q; 4], mu: [SVector<f64, M>; 4])
where
    P: Power<4> + Clebsch<Scalar = f64, Configuration = [Q; 4], Momentum = [SVector<f64, M>; 4], Input = ()> + Clone,
    P::Site: Clebsch<Configuration = Q, Momentum = SVector<f64, M>>,
    Q: Space<f64>,
{
    let stepper = power.stepper(H).expect("a regular power");
    let mut state = stepper.state(q, mu).expect("a state");
    let mut vectors =
        power.stepper(H).expect("regular").sites(SiteStorage::of(q.to_vec(), mu.to_vec())).expect("a state in vectors");
    let (mut points, mut momenta) = ([q; 3], [mu; 4]);
    let ([p1, p2, p3], [m1, m2, m3, m4]) = (points.each_mut(), momenta.each_mut());
    let storage = SiteStorage {
        configuration: &mut p1[..],
        momentum: &mut m1[..],
        more_points: [&mut p2[..], &mut p3[..]],
        more_momenta: [&mut m2[..], &mut m3[..], &mut m4[..]],
    };
    let mut slices = power.stepper(H).expect("regular").sites(storage).expect("a state in slices");
    for _ in 0..10 {
        state = stepper.step(&state).expect("a step");
    }
    vectors.advance(10).expect("steps in vectors");
    slices.advance(10).expect("steps in slices");
    assert_eq!((vectors.configuration(), vectors.momentum()), (&state.configuration()[..], &state.momentum()[..]));
    assert_eq!((slices.configuration(), slices.momentum()), (&state.configuration()[..], &state.momentum()[..]));
    assert_eq!(vectors.energy().expect("as many sites as before"), stepper.energy(&state));
    assert_eq!(vectors.steps(), 10);
}
