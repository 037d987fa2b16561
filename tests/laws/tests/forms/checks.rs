//! The relations between the two forms of code of a declaration.

use clebsch::{Clebsch, Conserved, Conserves, Space, State, Variational};
use clebsch_tests::oracle::flat::{Flat, far};
use clebsch_tests::oracle::random::Random;
use clebsch_tests::stepping::Stepping;
use nalgebra::SVector;

const H: f64 = 0.03;

/// The random motions of a pair of systems.
const MOTIONS: usize = if cfg!(feature = "heavy") { 5 } else { 2 };

/// Every derived function is the same in both forms, and so are 20 steps of random motions from `rest`.
pub fn agree<U, W, const M: usize>(unrolled: &U, matrices: &W, rest: U::Configuration, seed: u64)
where
    U: Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Input = ()> + Clone,
    W: Clebsch<
            Scalar = f64,
            Configuration = U::Configuration,
            Element = U::Element,
            Momentum = SVector<f64, M>,
            MomentumMatrix = U::MomentumMatrix,
            Input = (),
            Time = U::Time,
        > + Clone,
    U::Configuration: Flat,
    U::Element: Flat,
    U::MomentumMatrix: Flat,
{
    let mut random = Random::new(seed);
    let near = |distance: f64, what: &str| {
        assert!(distance < 2e-13, "{what}: {distance:.1e} apart for {}", U::NAME);
    };
    for _ in 0..MOTIONS {
        let (a, b) = (unrolled.stepper(H).expect("a regular system"), matrices.stepper(H).expect("the same"));
        let (before, after) =
            (unrolled.step_constants(H).expect("constants"), matrices.step_constants(H).expect("constants"));
        let some = random.vector::<M>();
        let moved = unrolled.project_momentum(&rest, &some) * 4.0;
        let turn = unrolled.inverse_legendre(&before, 0.3, &rest, &moved).expect("a motion");
        let q = unrolled.act(&turn, &rest);
        near(far(&q, &matrices.act(&turn, &rest)), "the action");
        near(far(&unrolled.project_momentum(&q, &some), &matrices.project_momentum(&q, &some)), "the projection");
        let defect = |a: f64, b: f64| (a - b).abs();
        near(defect(unrolled.isotropy_defect(&q, &some), matrices.isotropy_defect(&q, &some)), "the defect of μ");
        let off = q.zip_map(&q, |x, _| x * 1.01);
        let (on, other) = (unrolled.orbit_defect(&off), matrices.orbit_defect(&off));
        near(defect(on, other), "the defect of q");
        let mu = unrolled.project_momentum(&q, &some);
        let p = q.zip_map(&q, |x, _| 0.3 * x * x + 0.1);
        near(far(&unrolled.momentum_map(&q, &p), &matrices.momentum_map(&q, &p)), "J");
        let f = unrolled.inverse_legendre(&before, 0.3, &q, &mu).expect("a solution");
        let g = matrices.inverse_legendre(&after, 0.3, &q, &mu).expect("a solution");
        near(far(&f, &g), "F");
        near(far(&unrolled.coadjoint(&f, &mu), &matrices.coadjoint(&f, &mu)), "Ad*");
        near(far(&unrolled.legendre(H, 0.3, &q, &f), &matrices.legendre(H, 0.3, &q, &f)), "F⁻ℓd");
        near(far(&matrices.legendre(H, 0.3, &q, &f), &mu), "F⁻ℓd inverted");
        near(far(&unrolled.legendre_next(H, 0.3, &q, &f), &matrices.legendre_next(H, 0.3, &q, &f)), "F⁺ℓd");
        near(far(&unrolled.stagger(H, 0.3, &q), &matrices.stagger(H, 0.3, &q)), "what the momentum is ahead by");
        near(far(&U::momentum_matrix(&mu), &W::momentum_matrix(&mu)), "M");
        near(far(&W::momentum_components(&W::momentum_matrix(&mu)), &mu), "the components of M");
        near(defect(unrolled.potential(0.3, &q), matrices.potential(0.3, &q)), "V");
        let mut x = a.state(q, mu).expect("a state");
        let mut y = b.state(q, mu).expect("a state");
        near(defect(a.kinetic_energy(&x), b.kinetic_energy(&y)), "T");
        let mut upstairs = a.cotangent_state(q, p).expect("a state on T*Q");
        let mut written = b.cotangent_state(q, p).expect("a state on T*Q");
        for _ in 0..20 {
            x = a.step(&x).expect("a step");
            y = b.step(&y).expect("a step");
            upstairs = a.step_symmetric(&upstairs).expect("a step on T*Q");
            written = b.step_symmetric(&written).expect("a step on T*Q");
        }
        assert!(far(x.configuration(), &q) > 1e-3, "it moves");
        near(far(x.configuration(), y.configuration()).max(far(&x.momentum(), &y.momentum())), "20 steps");
        let there =
            far(upstairs.configuration(), written.configuration()).max(far(upstairs.covector(), written.covector()));
        near(there, "20 steps on T*Q");
        let together = b.advance(&b.state(q, mu).expect("a state"), 20).expect("20 steps");
        near(far(together.configuration(), y.configuration()).max(far(&together.momentum(), &y.momentum())), "at once");
    }
}

/// Twenty steps under random inputs are the same in both forms, one by one and by an integrator.
pub fn agree_forced<U, W, const M: usize, const K: usize>(unrolled: &U, matrices: &W, rest: U::Configuration, seed: u64)
where
    U: Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Input = SVector<f64, K>> + Clone,
    W: Clebsch<
            Scalar = f64,
            Configuration = U::Configuration,
            Momentum = SVector<f64, M>,
            Input = SVector<f64, K>,
            Time = U::Time,
        > + Clone,
    U::Configuration: Flat,
{
    let mut random = Random::new(seed);
    for _ in 0..MOTIONS {
        let (a, b) = (unrolled.stepper(H).expect("a regular system"), matrices.stepper(H).expect("the same"));
        let mu = unrolled.project_momentum(&rest, &random.vector::<M>());
        let (mut x, mut y) = (a.state(rest, mu).expect("a state"), b.state(rest, mu).expect("a state"));
        let mut unforced = x;
        let mut integrator = b.clone().integrator(y);
        for _ in 0..20 {
            let input = random.vector::<K>();
            x = a.step_with(&x, &input).expect("a step");
            y = b.step_with(&y, &input).expect("a step");
            unforced = a.step(&unforced).expect("a step");
            integrator.step_with(&input).expect("a step");
        }
        let far = |x: &State<U>, y: &State<W>| {
            far(x.configuration(), y.configuration()).max(far(&x.momentum(), &y.momentum()))
        };
        assert!(far(&x, &y) < 2e-13, "{:.1e} apart for {}", far(&x, &y), U::NAME);
        assert!(far(&unforced, &y) > 1e-3, "the input acts on {}", U::NAME);
        assert_eq!(integrator.state(), &y);
    }
}

/// Steps, tangent maps and the extremals between their ends are the same in both forms.
pub fn agree_varied<U, W, const M: usize>(unrolled: &U, matrices: &W, rest: U::Configuration, seed: u64)
where
    U: Variational<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>, Input = (), Time = ()> + Clone,
    W: Variational<M>
        + Clebsch<
            Scalar = f64,
            Configuration = U::Configuration,
            Element = U::Element,
            Momentum = SVector<f64, M>,
            Input = (),
            Time = (),
        > + Clone,
    U::Configuration: Flat,
    U::Element: Flat,
{
    let mut random = Random::new(seed);
    let (a, b) = (unrolled.stepper(H).expect("a regular system"), matrices.stepper(H).expect("the same"));
    let (before, after) =
        (unrolled.step_constants(H).expect("constants"), matrices.step_constants(H).expect("constants"));
    let near = |distance: f64, what: &str| {
        assert!(distance < 1e-11, "{what}: {distance:.1e} apart for {}", U::NAME);
    };
    for _ in 0..MOTIONS {
        let mu = unrolled.project_momentum(&rest, &random.vector::<M>());
        let eta = random.vector::<M>() * 0.3;
        let d = unrolled.retraction(&eta);
        near(far(&d, &matrices.retraction(&eta)), "τ(η)");
        let next = unrolled.advance(&rest, &d);
        near(far(&next, &matrices.advance(&rest, &d)), "the motion");
        near(far(&unrolled.compose(&d, &d), &matrices.compose(&d, &d)), "the motion twice");
        near((unrolled.orbit_metric(&next) - matrices.orbit_metric(&next)).amax(), "GᵀG");
        near((unrolled.approach(&next, &rest) - matrices.approach(&next, &rest)).amax(), "the approach");
        let ends = [
            unrolled.momenta(&before, 0, 0.0, (&rest, &d, &next, &())),
            matrices.momenta(&after, 0, 0.0, (&rest, &d, &next, &())),
        ];
        near((ends[0].lagrangian - ends[1].lagrangian).abs(), "ℓd");
        near((ends[0].before - ends[1].before).amax().max((ends[0].after - ends[1].after).amax()), "the transforms");
        let edges = [
            unrolled.edge(&before, 0, 0.0, (&rest, &d, &next, &())),
            matrices.edge(&after, 0, 0.0, (&rest, &d, &next, &())),
        ];
        let [first, second] = edges.map(|e| [e.before_by_start, e.before_by_end, e.after_by_start, e.after_by_end]);
        let size = first.iter().fold(1.0_f64, |most, block| most.max(block.amax()));
        near(
            first.iter().zip(&second).fold(0.0_f64, |most, (a, b)| most.max((a - b).amax())) / size,
            "second derivatives",
        );
        let (mut x, mut y) = (a.state(rest, mu).expect("a state"), b.state(rest, mu).expect("a state"));
        for _ in 0..8 {
            let ((after, tangent), (stepped, other)) =
                (a.step_tangent(&x).expect("a step"), b.step_tangent(&y).expect("a step"));
            let apart = [
                tangent.motion_by_motion - other.motion_by_motion,
                tangent.motion_by_momentum - other.motion_by_momentum,
                tangent.momentum_by_motion - other.momentum_by_motion,
                tangent.momentum_by_momentum - other.momentum_by_momentum,
            ];
            assert!(apart.iter().all(|block| block.amax() < 1e-11), "{:?}", apart.map(|block| block.amax()));
            let kept = b.step(&y).expect("a step");
            assert!(far(stepped.configuration(), kept.configuration()) < 1e-14);
            (x, y) = (after, stepped);
        }
        assert!(far(x.configuration(), y.configuration()).max(far(&x.momentum(), &y.momentum())) < 1e-13);
    }
}

/// Conserved momenta have the same names and values.
pub fn conserve_alike<U, W, const M: usize, const K: usize>(unrolled: &U, matrices: &W, q: &U::Configuration)
where
    U: Conserves<Scalar = f64, Momentum = SVector<f64, M>, Conserved = Conserved<f64, K>>,
    W: Conserves<
            Scalar = f64,
            Configuration = U::Configuration,
            Momentum = SVector<f64, M>,
            Conserved = Conserved<f64, K>,
        >,
{
    let mu = Random::new(7).vector::<M>();
    let (a, b) = (unrolled.conserved(q, &mu), matrices.conserved(q, &mu));
    assert_eq!(a.names(), b.names());
    assert!(K > 0 && a.values().iter().zip(b.values()).all(|(a, b)| (a - b).abs() < 1e-13), "{a:?} {b:?}");
}
