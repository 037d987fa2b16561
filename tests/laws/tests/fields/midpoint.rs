//! Implicit steps: closed forms of linear waves, the discrete principle by differences of the action, order, symmetry and momenta.

use clebsch::{
    Clebsch, Domain, Error, Field, FieldStepper, Grid, MidpointSite, MidpointStepper, MovingField, Population, Side,
    Sides, SiteError,
};
use nalgebra::{Matrix3, Matrix4, Rotation2, Rotation3, SVector, Vector1, Vector2, Vector3, Vector4, Vector6};

/// A string of density 1 and tension 1 on springs, its displacement x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: Translation<1>, x: Vector1| x + a,
    cost      = |h, a| a.norm_squared() / (2 * h),
    potential = |x| self.springs * x.norm_squared() / 2,
    space     = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    emit      = [midpoint],
)]
struct Strand {
    springs: f64,
}

/// A rod that bends, turns, stretches and shears.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.cayley() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
    emit   = [midpoint],
)]
struct Rod {
    section: Vector4<f64>,
    stiffness: SVector<f64, 6>,
    reference: SVector<f64, 6>,
}

/// The same in the plane, by a Lagrangian, in a wind that grows.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: SE<2>, q: SE<2>| q * F,
    lagrangian = |xi| xi.norm_squared() / 2,
    potential  = |t, q| self.wind * (1 + t) * q[(1, 2)],
    space      = |ds, W| (W.cayley() / ds - self.reference).norm_squared() * ds / 2,
    emit       = [midpoint],
)]
struct PlaneRod {
    wind: f64,
    reference: Vector3<f64>,
}

/// The same with an exponential, and with strains that are logarithms.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SE<2>, q: SE<2>| q * F,
    lagrangian     = |xi| xi.norm_squared() / 2,
    discretization = exponential,
    space          = |ds, W| (W.log() / ds - self.reference).norm_squared() * ds / 2,
    emit           = [midpoint],
)]
struct BentInPlane {
    reference: Vector3<f64>,
}

/// A rod in air, pushed in fixed directions of space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.log() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
    force  = |q, xi, load: Vector3| {
        let push = q.rotation().transpose() * load;
        vector![0, 0, 0, push.x, push.y, push.z] - self.damping * xi
    },
    emit   = [midpoint],
)]
struct Pushed {
    section: Vector4<f64>,
    stiffness: SVector<f64, 6>,
    reference: SVector<f64, 6>,
    damping: f64,
}

/// Beads in oil, each pulled.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    force  = |v, pull: Vector1| pull - self.oil * v,
    emit   = [midpoint],
)]
struct Beads {
    oil: f64,
}

/// Rotations that act from the left, with springs between them.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: SO<3>, R: SO<3>| F * R,
    cost      = |h, F| (self.mass_matrix * (F - I) * (F - I).transpose()).trace() / (2 * h),
    potential = |R| self.weight * R[(2, 2)],
    space     = |dx, R, next| (next - R).norm_squared() / (2 * dx),
    emit      = [midpoint],
)]
struct FromTheLeft {
    #[clebsch(symmetric)]
    mass_matrix: Matrix3<f64>,
    weight: f64,
}

/// A body and a point, tied to their neighbours.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |(F, a): (SO<3>, Translation<2>), (R, x): (SO<3>, Vector2)| (R * F, x + a),
    cost   = |h, F, a| (F - I).norm_squared() / (4 * h) + a.norm_squared() / (2 * h),
    space  = |dx, (W, b)| ((W - I).norm_squared() + b.norm_squared() * (W - I).norm_squared() + b.norm_squared()) / (2 * dx),
    emit   = [midpoint],
)]
struct Pair;

fn rod() -> Rod {
    Rod {
        section: Vector4::new(0.02, 0.03, 0.025, 0.4),
        stiffness: Vector6::new(0.5, 0.6, 0.4, 4.0, 5.0, 8.0),
        reference: Vector6::new(0.3, 0.0, 0.1, 0.0, 0.0, 1.0),
    }
}

/// Places along a curve.
fn curve(sites: usize, spacing: f64) -> Vec<Matrix4<f64>> {
    let along = |i: usize| {
        let s = spacing * i as f64;
        let mut place = Rotation3::new(Vector3::new(0.5 * s, 0.3 * (2.0 * s).sin(), -0.4 * s)).to_homogeneous();
        place.fixed_view_mut::<3, 1>(0, 3).copy_from(&Vector3::new(0.2 * s.sin(), 0.1 * s * s, s));
        place
    };
    (0..sites).map(along).collect()
}

/// A rod that is bent and neither stretched nor sheared.
fn unstretched(sites: usize, spacing: f64) -> Vec<Matrix4<f64>> {
    let edge = |i: usize| {
        let bend = Vector6::new(0.4 * (i as f64).sin(), 0.3, 0.0, 0.0, 0.0, 0.0);
        Rod::half_step(&((rod().reference + bend) * (spacing / 2.0)))
    };
    let mut places = vec![Matrix4::identity()];
    (1..sites).for_each(|i| places.push(places[i - 1] * edge(i)));
    places
}

fn wave<const M: usize>(sites: usize, size: f64) -> Vec<SVector<f64, M>> {
    (0..sites).map(|i| SVector::from_fn(|k, _| size * (1.3 * i as f64 + 0.7 * k as f64).sin())).collect()
}

/// A mode of wave number k turns by ωh with tan(ωh/2) = ½h √(springs + (2/dx sin(k dx/2))²), at any step. This is the midpoint rule of
/// a harmonic oscillator. The longest step is 300 times the largest that is stable for explicit steps.
#[test]
fn linear_waves_turn_by_the_angle_of_the_midpoint_rule() -> Result<(), SiteError> {
    let (sites, dx, springs) = (24, 0.1, 0.7);
    for h in [0.02, 0.3, 3.0, 30.0] {
        let stepper = Strand { springs }.grid([sites]).spacing([dx]).periodic().midpoint(h)?;
        for mode in [0, 1, 5, 12] {
            let k = core::f64::consts::TAU * f64::from(mode) / (sites as f64 * dx);
            let rate = (springs + (2.0 / dx * (k * dx / 2.0).sin()).powi(2)).sqrt();
            let angle = 2.0 * (rate * h / 2.0).atan();
            let shape = |i: usize| (k * dx * i as f64).cos();
            let start: Vec<_> = (0..sites).map(|i| Vector1::new(shape(i))).collect();
            let mut state = stepper.state(start, vec![Vector1::zeros(); sites])?;
            for step in 1..=50 {
                stepper.step(&mut state)?;
                assert!(state.iterations() <= 2, "{h} {mode}: {}", state.iterations());
                let (turned, speed) = ((angle * f64::from(step)).cos(), -rate * (angle * f64::from(step)).sin());
                for (i, (x, mu)) in state.configuration().iter().zip(state.momentum()).enumerate() {
                    assert!((x.x - turned * shape(i)).abs() < 1e-11, "{h} {mode} {step} {i}: {} {turned}", x.x);
                    assert!((mu.x - speed * shape(i)).abs() < 1e-11 * (1.0 + rate), "{h} {mode} {step} {i}: {mu}");
                }
            }
        }
    }
    Ok(())
}

/// √A by the iteration of Denman and Beavers.
fn root(a: &Matrix4<f64>) -> Matrix4<f64> {
    let (mut x, mut y) = (*a, Matrix4::identity());
    for _ in 0..12 {
        (x, y) = ((x + y.try_inverse().unwrap()) / 2.0, (y + x.try_inverse().unwrap()) / 2.0);
    }
    x
}

/// A step makes the action critical. Its momenta are the slopes of the discrete Lagrangian of both ends, by differences. This Lagrangian
/// is made anew here, with square roots of matrices.
#[test]
fn momenta_are_slopes_of_the_discrete_lagrangian() -> Result<(), SiteError> {
    let (sites, dx, h) = (4, 0.25, 0.4);
    let stepper = rod().grid([sites]).spacing([dx]).midpoint(h)?;
    let mut state = stepper.state(curve(sites, dx), wave(sites, 0.02))?;
    let lagrangian = |from: &[Matrix4<f64>], to: &[Matrix4<f64>]| {
        let element = |i: usize| from[i].try_inverse().unwrap() * to[i];
        let kinetic = |i: usize| {
            let d = element(i) - Matrix4::identity();
            (d * Matrix4::from_diagonal(&rod().section) * d.transpose()).trace() / (2.0 * h)
        };
        let middle: Vec<_> = (0..sites).map(|i| from[i] * root(&element(i))).collect();
        let energy: f64 = middle.windows(2).map(|edge| rod().edge_energy(0, &[dx], &edge[0], &edge[1])).sum();
        (0..sites).map(kinetic).sum::<f64>() - h * energy
    };
    let small = |k: usize, size: f64| {
        let axis = Vector3::ith(k % 3, size);
        if k < 3 { Rotation3::new(axis).to_homogeneous() } else { Matrix4::new_translation(&axis) }
    };
    for _ in 0..3 {
        let (from, momenta) = (state.configuration().clone(), state.momentum().clone());
        stepper.step(&mut state)?;
        for i in 0..sites {
            for (k, momentum) in momenta[i].iter().enumerate() {
                let size = 2e-5;
                let at = |size: f64, is_end: bool| {
                    let (mut from, mut to) = (from.clone(), state.configuration().clone());
                    let moved = if is_end { &mut to[i] } else { &mut from[i] };
                    *moved *= small(k, size);
                    lagrangian(&from, &to)
                };
                let slope = |is_end| (at(size, is_end) - at(-size, is_end)) / (2.0 * size);
                let (before, after) = (-slope(false), slope(true));
                assert!((before - momentum).abs() < 1e-8, "site {i}, {k}: {before} {momentum}");
                let found = state.momentum()[i][k];
                assert!((after - found).abs() < 1e-8, "site {i}, {k}: {after} {found}");
            }
        }
    }
    Ok(())
}

/// Explicit steps in one implicit step, where they stand for the exact motion.
const FINER: u64 = if cfg!(feature = "heavy") { 2000 } else { 500 };

type Implicit<S, P> = MidpointStepper<S, P>;
type Explicit<S, P> = FieldStepper<S, Grid<f64, 1>, P>;

/// Halving the step divides the distance to many short explicit steps by four, and a step back undoes a step.
#[track_caller]
fn check<S, P: Population, const M: usize>(
    domain: &Domain<S, Grid<f64, 1>, P>,
    (q, mu, h): (Vec<S::Configuration>, Vec<SVector<f64, M>>, f64),
    distance: impl Fn(&S::Configuration, &S::Configuration) -> f64,
) where
    S: Field<1> + MovingField + MidpointSite<M> + Clebsch<Scalar = f64, Momentum = SVector<f64, M>> + Clone,
{
    let largest = |a: &[S::Configuration], b: &[S::Configuration]| {
        a.iter().zip(b).map(|(a, b)| distance(a, b)).fold(0.0, f64::max)
    };
    let fine: Explicit<S, P> = domain.clone().stepper(h / FINER as f64).unwrap();
    let mut exact = fine.state(q.clone(), mu.clone()).unwrap();
    fine.advance(&mut exact, 8 * FINER).unwrap();
    let after = |parts: u32| {
        let stepper: Implicit<S, P> = domain.clone().midpoint(h / f64::from(parts)).unwrap();
        let mut state = stepper.state(q.clone(), mu.clone()).unwrap();
        stepper.advance(&mut state, 8 * u64::from(parts)).unwrap();
        let error = largest(state.configuration(), exact.configuration());
        let back: Implicit<S, P> = domain.clone().midpoint(-h / f64::from(parts)).unwrap();
        back.advance(&mut state, 8 * u64::from(parts)).unwrap();
        let undone = largest(state.configuration(), &q);
        assert!(undone < 1e-11, "not undone by {undone:e}");
        error
    };
    let errors = [after(4), after(8)];
    let ratio = errors[0] / errors[1];
    assert!((3.8..4.2).contains(&ratio) && errors[1] < 1e-2, "{errors:?}: ratio {ratio}");
}

#[test]
fn steps_have_order_two_and_are_symmetric() {
    let far = |a: &Matrix4<f64>, b: &Matrix4<f64>| (a - b).amax();
    for sides in [Sides::Open(Side::Free, Side::Free), Sides::Open(Side::Fixed, Side::Free)] {
        let domain = rod().grid([5]).spacing([0.25]).sides([sides]);
        check(&domain, (curve(5, 0.25), wave(5, 0.02), 0.05), far);
    }
    // every site with a mass of its own
    let site = |i: usize| Rod { section: rod().section * (1.0 + 0.3 * i as f64), ..rod() };
    let domain = rod().grid([4]).spacing([0.25]).various(|[i]| site(i));
    check(&domain, (curve(4, 0.25), wave(4, 0.02), 0.05), far);
    let plane = |i: usize| {
        let mut place = Rotation2::new(0.2 * i as f64).to_homogeneous();
        (place[(0, 2)], place[(1, 2)]) = (0.3 * i as f64, 0.1 * i as f64);
        place
    };
    let domain = PlaneRod { wind: 0.4, reference: Vector3::new(0.2, 1.0, -0.1) }.grid([5]).spacing([0.3]);
    check(&domain, ((0..5).map(plane).collect(), wave(5, 0.2), 0.1), |a, b| (a - b).amax());
    #[cfg(feature = "heavy")]
    {
        let domain = BentInPlane { reference: Vector3::new(0.2, 1.0, -0.1) }.grid([5]).spacing([0.3]);
        check(&domain, ((0..5).map(plane).collect(), wave(5, 0.2), 0.1), |a, b| (a - b).amax());
    }
    // rings of one, two and more sites: each site is a neighbour of itself, twice of another, and of two
    let turn = |i: usize| Rotation3::new(Vector3::new(0.4 * i as f64, 0.3, -0.2 * i as f64)).into_inner();
    for sites in [1, 2, 3, 6] {
        let mass_matrix = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.4, 0.2, 0.0, 0.2, 0.8);
        let domain = FromTheLeft { mass_matrix, weight: 0.5 }.grid([sites]).spacing([0.5]).periodic();
        check(&domain, ((0..sites).map(turn).collect(), wave(sites, 0.6), 0.1), |a, b| (a - b).amax());
    }
    let both = |i: usize| (turn(i), Vector2::new(0.2 * i as f64, 0.1));
    check(&Pair.grid([4]).spacing([0.5]), ((0..4).map(both).collect(), wave(4, 0.4), 0.1), |a, b| {
        (a.0 - b.0).amax().max((a.1 - b.1).amax())
    });
}

/// A mode x″ = −ω²x − cx′ + a by the midpoint rule: a linear map of (x, v), here solved anew.
#[test]
fn forces_of_linear_waves_are_those_of_the_midpoint_rule() -> Result<(), SiteError> {
    let (sites, dx, oil, h) = (12, 0.2, 0.8, 1.5);
    let stepper = Beads { oil }.grid([sites]).spacing([dx]).periodic().midpoint(h)?;
    let k = core::f64::consts::TAU * 3.0 / (sites as f64 * dx);
    let square = (2.0 / dx * (k * dx / 2.0).sin()).powi(2);
    let shape = |i: usize| Vector1::new((k * dx * i as f64).cos());
    let all = |size: f64| (0..sites).map(|i| shape(i) * size).collect::<Vec<_>>();
    let mut state = stepper.state(all(1.0), all(0.3))?;
    let (mut x, mut v) = (1.0, 0.3);
    for step in 0..20 {
        let pull = 0.5 * f64::from(step).sin();
        stepper.step_with(&mut state, &all(pull))?;
        // v⁺ = v + h(−ω²(x + x⁺)/2 − c(v + v⁺)/2 + a), x⁺ = x + h(v + v⁺)/2
        let next = (v * (1.0 - h * oil / 2.0 - h * h * square / 4.0) - h * square * x + h * pull)
            / (1.0 + h * oil / 2.0 + h * h * square / 4.0);
        (x, v) = (x + h * (v + next) / 2.0, next);
        for i in 0..sites {
            assert!((state.configuration()[i] - shape(i) * x).amax() < 1e-12, "{step} {i}");
            assert!((state.momentum()[i] - shape(i) * v).amax() < 1e-12, "{step} {i}");
        }
    }
    let inputs = [Vector1::new(f64::NAN); 12];
    let refused = stepper.step_with(&mut state, &inputs).unwrap_err();
    assert_eq!(refused, SiteError { site: Some(0), error: Error::NotFinite { name: "the input" } });
    let refused = stepper.step_with(&mut state, &inputs[1..]).unwrap_err();
    assert_eq!(refused, SiteError { site: None, error: Error::NumberOfSites { found: 11, sites: 12 } });
    Ok(())
}

/// A load with a fixed direction adds its impulse to the momentum in space, to round-off. With damping the order is still two, against
/// many short explicit steps.
#[test]
fn loads_and_damping_act_at_the_midpoint() -> Result<(), SiteError> {
    let (sites, dx) = (5, 0.25);
    let pushed = |damping| {
        let Rod { section, stiffness, reference } = rod();
        Pushed { section, stiffness, reference, damping }.grid([sites]).spacing([dx])
    };
    let loads: Vec<_> = (0..sites).map(|i| Vector3::new(0.03, 0.01 * i as f64, -0.02)).collect();
    let total = |state: &[Matrix4<f64>], mu: &[SVector<f64, 6>]| -> Vector3<f64> {
        state.iter().zip(mu).map(|(q, mu)| q.fixed_view::<3, 3>(0, 0) * mu.fixed_rows::<3>(3)).sum()
    };
    let stepper = pushed(0.0).midpoint(0.4)?;
    let mut state = stepper.state(curve(sites, dx), wave(sites, 0.02))?;
    let mut expected = total(state.configuration(), state.momentum());
    for _ in 0..20 {
        stepper.step_with(&mut state, &loads)?;
        expected += loads.iter().sum::<Vector3<f64>>() * 0.4;
        assert!((total(state.configuration(), state.momentum()) - expected).amax() < 1e-12);
    }
    let after = |h: f64, steps: usize| -> Result<Vec<Matrix4<f64>>, SiteError> {
        let stepper = pushed(0.4).midpoint(h)?;
        let mut state = stepper.state(curve(sites, dx), wave(sites, 0.02))?;
        (0..steps).try_for_each(|_| stepper.step_with(&mut state, &loads))?;
        Ok(state.configuration().clone())
    };
    let steps = 10 * FINER;
    let fine = pushed(0.4).stepper(0.4 / steps as f64)?;
    let mut exact = fine.state(curve(sites, dx), wave(sites, 0.02))?;
    (0..steps).try_for_each(|_| fine.step_with(&mut exact, &loads))?;
    let far = |q: &[Matrix4<f64>]| q.iter().zip(exact.configuration()).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
    let errors = [far(&after(0.02, 20)?), far(&after(0.01, 40)?)];
    assert!((3.8..4.2).contains(&(errors[0] / errors[1])), "{errors:?}");
    Ok(())
}

/// A quarter of the stable step to twenty times it: momenta stay to round-off, the energy within a part, and each step takes few iterations.
#[test]
fn long_steps_conserve_momenta() -> Result<(), SiteError> {
    let (sites, dx) = (11, 0.1);
    let domain = rod().grid([sites]).spacing([dx]);
    let stable = domain.clone().stable_step(&unstretched(sites, dx))?;
    for (times, most, band) in [(0.25, 3, 0.01), (1.0, 3, 0.03), (5.0, 4, 0.3), (20.0, 8, 0.3)] {
        let stepper = domain.clone().midpoint(times * stable)?;
        let mut state = stepper.state(unstretched(sites, dx), wave(sites, 0.002))?;
        let (momenta, energy) = (stepper.conserved(&state)?, stepper.energy(&state)?);
        for _ in 0..if cfg!(feature = "heavy") { 300 } else { 100 } {
            stepper.step(&mut state)?;
            assert!(state.iterations() <= most, "{times}: {} iterations", state.iterations());
            let change = stepper.energy(&state)? / energy - 1.0;
            assert!(change.abs() < band, "{times}: {change}");
        }
        for ((name, found), (_, expected)) in stepper.conserved(&state)?.iter().zip(momenta.iter()) {
            assert!((found - expected).abs() < 1e-13, "{times}, {name}: {found} {expected}");
        }
    }
    let (h, energy) = (10.0 * stable, domain.clone().stepper(stable)?);
    let energy = energy.energy(&energy.state(unstretched(sites, dx), wave(sites, 0.002))?)?;
    // explicit steps of this size end at once
    let explicit = domain.stepper(h)?;
    let mut other = explicit.state(unstretched(sites, dx), wave(sites, 0.002))?;
    let ends =
        (0..300).find(|_| explicit.step(&mut other).is_err() || explicit.energy(&other).unwrap_or(0.0) > 10.0 * energy);
    assert!(ends.is_some());
    Ok(())
}

#[test]
fn a_step_that_is_not_found_changes_nothing() -> Result<(), SiteError> {
    let stepper = rod().grid([6]).spacing([0.2]).midpoint(1e4)?;
    let mut state = stepper.state(curve(6, 0.2), wave(6, 1.0))?;
    let (q, mu) = (state.configuration().clone(), state.momentum().clone());
    let error = stepper.step(&mut state).unwrap_err();
    assert!(matches!(error.error, Error::NotConverged { iterations: 1.., .. }) && error.site.is_some(), "{error}");
    assert_eq!((state.configuration(), state.momentum(), state.steps()), (&q, &mu, 0));
    // the state of another field
    let other = rod().grid([5]).spacing([0.2]).midpoint(0.1)?;
    let error = other.step(&mut state).unwrap_err();
    assert_eq!(error, SiteError { site: None, error: Error::NumberOfSites { found: 6, sites: 5 } });
    Ok(())
}
