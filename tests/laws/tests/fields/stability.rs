//! The longest stable step: against the eigenvalues of second differences of the energy, and by runs on both sides of it.

use clebsch::{Clebsch, Error, Field, MovingField, SiteError};
use clebsch_tests::fixtures::cosserat_rod::CosseratRod;
use clebsch_tests::fixtures::sine_gordon::SineGordon;
use clebsch_tests::fixtures::wave_map::WaveMap;
use nalgebra::{DMatrix, DVector, Matrix4, SVector, Vector1, Vector2, Vector3, Vector4, Vector6};

/// A string, its displacement x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
)]
struct Strand;

/// The same in steps of order 4.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    order  = 4,
)]
struct StrandOfOrderFour;

/// The same in steps of order 6.
#[cfg(feature = "heavy")]
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    order  = 6,
)]
struct StrandOfOrderSix;

/// The same in steps of order 8.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |a: Translation<1>, x: Vector1| x + a,
    cost   = |h, a| a.norm_squared() / (2 * h),
    space  = |dx, x, next| (next - x).norm_squared() / (2 * dx.powi(2)),
    order  = 8,
)]
struct StrandOfOrderEight;

/// The largest |x| after so many steps of a share of the stable step. It starts with the shortest wave, ±1.
fn grown<S>(strand: S, share: f64, steps: u64) -> Result<f64, SiteError>
where
    S: Field<1> + MovingField + Clebsch<Scalar = f64, Configuration = Vector1<f64>, Momentum = Vector1<f64>> + Clone,
{
    let ring = strand.grid([8]).spacing([0.5]).periodic();
    let wave: Vec<_> = (0..8).map(|i| Vector1::new(if i % 2 == 0 { 1.0 } else { -1.0 })).collect();
    let stepper = ring.clone().stepper(share * ring.stable_step(&wave)?)?;
    let mut state = stepper.state(wave, vec![Vector1::new(0.0); 8])?;
    let mut largest: f64 = 0.0;
    for _ in 0..steps {
        stepper.step(&mut state)?;
        largest = state.configuration().iter().fold(largest, |largest, x| largest.max(x.x.abs()));
    }
    Ok(largest)
}

/// The bound is the limit itself for waves: the shortest one has ω = 2/dx.
#[test]
fn waves_stay_below_the_stable_step_and_grow_above_it() -> Result<(), SiteError> {
    // in 4000 steps; near the limit a stable wave of a composition goes along a long ellipse
    let runs = |share: f64| -> Result<Vec<f64>, SiteError> {
        Ok(vec![
            grown(Strand, share, 4000)?,
            grown(StrandOfOrderFour, share, 4000)?,
            #[cfg(feature = "heavy")]
            grown(StrandOfOrderSix, share, 4000)?,
            grown(StrandOfOrderEight, share, 4000)?,
        ])
    };
    assert!(runs(0.998)?.iter().all(|largest| *largest < 30.0), "{:?}", runs(0.998)?);
    assert!(runs(1.002)?.iter().all(|largest| *largest > 1e6), "{:?}", runs(1.002)?);
    Ok(())
}

/// 2/√(4/dx² + 4/dy²): Courant, Friedrichs and Lewy.
#[test]
fn the_stable_step_of_a_sheet_is_that_of_its_waves() -> Result<(), SiteError> {
    for (dx, dy) in [(0.1, 0.1), (0.1, 0.3), (2.0, 0.5)] {
        let sheet = WaveMap.grid([4, 6]).spacing([dx, dy]).periodic();
        let expected = 1.0 / f64::sqrt(1.0 / (dx * dx) + 1.0 / (dy * dy));
        let found = sheet.stable_step(&[Vector3::z(); 24])?;
        assert!((found / expected - 1.0).abs() < 1e-13, "{found} is not {expected}");
    }
    Ok(())
}

/// λ_max of Σ⁻¹H with H by second differences of the energy: `energy` of small motions of all coordinates.
fn largest_eigenvalue(inertia: &DVector<f64>, size: f64, energy: impl Fn(&DVector<f64>) -> f64) -> f64 {
    let n = inertia.len();
    let at = |pairs: &[(usize, f64)]| {
        let mut motion = DVector::zeros(n);
        pairs.iter().for_each(|&(i, sign)| motion[i] += sign * size / inertia[i].sqrt());
        energy(&motion)
    };
    let scaled = DMatrix::from_fn(n, n, |i, j| {
        let (a, b) = (
            at(&[(i, 1.0), (j, 1.0)]) + at(&[(i, -1.0), (j, -1.0)]),
            at(&[(i, 1.0), (j, -1.0)]) + at(&[(i, -1.0), (j, 1.0)]),
        );
        (a - b) / (4.0 * size * size)
    });
    scaled.symmetric_eigenvalues().max()
}

/// A free rod of unit length with a round section, straight and at rest: the bound holds, and is at most 1.1 times the frequency.
#[test]
fn the_bound_of_rods_holds_and_is_near() -> Result<(), SiteError> {
    let rods = [(6, 0.05), (10, 0.3), (10, 0.1), (10, 0.02)];
    for (sections, thickness) in rods.into_iter().take(if cfg!(feature = "heavy") { 4 } else { 1 }) {
        let (ds, area) = (1.0 / sections as f64, thickness * thickness);
        let second = area * area / 12.0;
        // E = ρ = 1, G = 0.4
        let half = |i: usize| if i == 0 || i == sections { 0.5 } else { 1.0 };
        let section = |i: usize| Vector4::new(second, second, second, area) * ds * half(i);
        let rod = |i: usize| CosseratRod {
            section: section(i),
            weight: 0.0,
            stiffness: Vector6::new(second, second, 0.8 * second, 0.4 * area, 0.4 * area, area),
            reference: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
            damping: 0.0,
        };
        let place = |i: usize| {
            let mut q = Matrix4::identity();
            q[(2, 3)] = ds * i as f64;
            q
        };
        let straight: Vec<_> = (0..=sections).map(place).collect();
        let domain = rod(1).grid([sections + 1]).spacing([ds]).various(|[i]| rod(i));
        let stable = domain.stable_step(&straight)?;
        // moments of inertia are sums of two second moments
        let inertia = (0..=sections).flat_map(|i| {
            let s = section(i);
            [s.y + s.z, s.x + s.z, s.x + s.y, s.w, s.w, s.w]
        });
        let inertia = DVector::from_iterator(6 * (sections + 1), inertia);
        let moved = |q: &Matrix4<f64>, motion: SVector<f64, 6>| {
            let (w, v) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
            let mut twist = Matrix4::zeros();
            twist.fixed_view_mut::<3, 3>(0, 0).copy_from(&Vector3::from(w).cross_matrix());
            twist.fixed_view_mut::<3, 1>(0, 3).copy_from(&v);
            q * twist.exp()
        };
        let energy = |motion: &DVector<f64>| {
            let q: Vec<_> = (0..=sections).map(|i| moved(&straight[i], motion.fixed_rows::<6>(6 * i).into())).collect();
            (0..sections).map(|i| rod(i).edge_energy(0, &[ds], &q[i], &q[i + 1])).sum()
        };
        let frequency = largest_eigenvalue(&inertia, 1e-5, energy).sqrt();
        let bound = 2.0 / stable;
        assert!((1.0 - 1e-4..1.1).contains(&(bound / frequency)), "{thickness}: {bound} for {frequency}");
    }
    Ok(())
}

/// ω² = 4/dx² + V″: the potential pulls too.
#[test]
fn a_potential_shortens_the_stable_step() -> Result<(), SiteError> {
    let ring = SineGordon.grid([16]).spacing([0.5]).periodic();
    let zero = [Vector2::x(); 16];
    // steps of order 4
    let expected = 2.720_974_538 / f64::sqrt(4.0 / 0.25 + 1.0);
    assert!(
        (ring.stable_step(&zero)? / expected - 1.0).abs() < 1e-13,
        "{} is not {expected}",
        ring.stable_step(&zero)?
    );
    Ok(())
}

#[test]
fn unstable_steps_are_named() -> Result<(), SiteError> {
    let string = Strand.grid([8]).spacing([0.5]);
    let state = |h: f64| -> Result<_, SiteError> {
        let stepper = string.clone().stepper(h)?;
        let state = stepper.state(vec![Vector1::new(0.0); 8], vec![Vector1::new(1.0); 8])?;
        Ok((stepper, state))
    };
    let (stepper, start) = state(0.6)?;
    let refused = SiteError::from(Error::UnstableStep { step_size: 0.6, stable: 0.5 });
    assert_eq!(stepper.check_stable(&start), Err(refused));
    let (stepper, start) = state(-0.5)?;
    assert_eq!(stepper.check_stable(&start), Ok(()));
    // nothing pulls one site back
    let alone = Strand.grid([1]).stable_step(&[Vector1::new(3.0)])?;
    assert_eq!(alone, f64::INFINITY);
    let refused = Strand.grid([2]).stable_step(&[Vector1::new(0.0); 3]).map_err(|error| error.error);
    assert_eq!(refused, Err(Error::NumberOfSites { found: 3, sites: 2 }));
    Ok(())
}

/// The suggested step gives about the error that was asked for, and is never unstable.
#[test]
fn suggested_steps_are_accurate_and_stable() -> Result<(), SiteError> {
    let ring = Strand.grid([32]).spacing([1.0 / 32.0]).periodic();
    let wave = |i: usize| Vector1::new((std::f64::consts::TAU * i as f64 / 32.0).sin());
    let (start, still): (Vec<_>, Vec<_>) = (0..32).map(|i| (wave(i), Vector1::new(0.0))).unzip();
    let probing = ring.clone().stepper(0.01)?;
    let from = probing.state(start.clone(), still.clone())?;
    let stable = probing.stable_step(&from)?;
    assert_eq!(probing.suggest_step_size(&from, 10.0, 20.0)?, stable);
    let (wanted, duration) = (1e-3, 5.0);
    let h = probing.suggest_step_size(&from, wanted, duration)?;
    assert!(h < stable);
    // the frequency of the wave on the grid
    let frequency = 64.0 * (std::f64::consts::PI / 32.0).sin();
    let steps = (duration / h).ceil();
    let stepper = ring.stepper(duration / steps)?;
    let mut state = stepper.state(start, still)?;
    stepper.advance(&mut state, steps as u64)?;
    let exact = wave(8).x * (frequency * duration).cos();
    let error = (state.configuration()[8].x - exact).abs();
    // the phase error counts by its slope, which may vanish here
    assert!(error < 2.0 * wanted, "{error}");
    Ok(())
}
