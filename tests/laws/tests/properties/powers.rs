//! Powers: each site is a system of its own, tied to the others by kicks alone.

use crate::arbitrary::{cases, unit, vector};
use crate::runner::proptest;
use clebsch::__private::{At, FreeSites, PowerConstants, Scheme, SitesOfFirstOrder, SitesOfSecondOrder, wrapped};
use clebsch::{Clebsch, Power, SiteStorage};
use clebsch_tests::stepping::Stepping;
use nalgebra::Vector3;
use proptest::prelude::*;

const N: usize = 5;
const H: f64 = 0.05;

/// A ring of spins, each of its own mass, in a field that changes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |F: [SO<3>; N], q: [Unit<Vector3>; N]| (0..N).map(|i| F[i] * q[i]),
    cost      = |h, F| (0..N).map(|i| self.mass[i] * (F[i] - I).norm_squared() / (4 * h)).sum(),
    potential = |t, q| (0..N).map(|i| self.exchange * q[i].dot(&q[(i + 2) % N]) - t.cos() * self.field.dot(&q[i])).sum(),
)]
pub struct Ring<const N: usize> {
    pub mass: [f64; N],
    pub exchange: f64,
    pub field: Vector3<f64>,
}

/// Bodies on springs, one for each pair: the share of a term is added at its sites.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action    = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    cost      = |h, a| (0..N).map(|i| a[i].norm_squared()).sum() / (2 * h),
    potential = |x| self.stiffness / 2 * (0..N).map(|i| (i + 1..N).map(|j| (x[i] - x[j]).norm_squared()).sum()).sum(),
)]
pub struct Springs<const N: usize> {
    pub stiffness: f64,
}

/// Bodies of unit mass, each with a push of its own.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
    lagrangian = |v| (0..N).map(|i| v[i].norm_squared()).sum() / 2,
    force      = |v, push: [Vector3; N]| (0..N).map(|i| push[i]),
    scalar     = f64,
)]
pub struct Pushed<const N: usize>;

type Spins = [Vector3<f64>; N];

fn rings() -> BoxedStrategy<Ring<N>> {
    let made = |(mass, exchange, field)| Ring { mass, exchange, field };
    (prop::array::uniform5(0.5_f64..2.0), -1.0_f64..1.0, vector::<3>(1.0)).prop_map(made).boxed()
}

/// Points with momenta across.
fn spins() -> BoxedStrategy<(Spins, Spins)> {
    let across = |(q, v): (Spins, Spins)| (q, std::array::from_fn(|i| q[i].cross(&v[i])));
    (prop::array::uniform5(unit()), prop::array::uniform5(vector::<3>(1.0))).prop_map(across).boxed()
}

fn apart(a: &Spins, b: &Spins) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn sites_are_systems_alone(ring in rings(), (q, mu) in spins(), p in prop::array::uniform5(vector::<3>(1.0)), t in -3.0_f64..3.0) {
        let constants = ring.power_constants(H)?;
        let drifted = FreeSites::<N>::step(At::new(&ring, &constants, t), (&q, &mu, &()), &())?;
        let f = FreeSites::<N>::inverse_legendre(At::new(&ring, &constants, t), &q, &mu)?;
        let (image, momenta, coadjoint) = (ring.act(&f, &q), ring.momentum_map(&q, &p), ring.coadjoint(&f, &mu));
        let (matrices, projected) = (<Ring<N> as Power<N>>::matrices_of(&mu), ring.project_momentum(&q, &p));
        prop_assert_eq!(ring.each(|site, i| site.act(&f[i], &q[i])), image);
        prop_assert!(apart(&<Ring<N> as Power<N>>::components_of(&matrices), &mu) < 1e-15);
        let (mut energy, mut defect, mut largest) = (0.0, 0.0_f64, 0.0_f64);
        let off: Spins = std::array::from_fn(|i| q[i] * (1.0 + 0.01 * i as f64));
        for i in 0..N {
            let site = ring.site(i);
            let own = site.step_constants(H)?;
            prop_assert_eq!(site.act(&f[i], &q[i]), image[i]);
            prop_assert_eq!(site.momentum_map(&q[i], &p[i]), momenta[i]);
            prop_assert_eq!(site.coadjoint(&f[i], &mu[i]), coadjoint[i]);
            prop_assert_eq!(site.project_momentum(&q[i], &p[i]), projected[i]);
            let (next, moved, _) = site.step(&own, t, &q[i], &mu[i], &(), &())?;
            prop_assert_eq!((next, moved), (drifted.0[i], drifted.1[i]));
            prop_assert_eq!(ring.at_site(&constants, i, |site, own| site.inverse_legendre(own, t, &q[i], &mu[i]))?, f[i]);
            prop_assert_eq!(ring.moved(&constants, t, i, (&q[i], &mu[i]), &())?, (next, moved));
            prop_assert_eq!(ring.kicked_and_moved(&constants, t, i, (&q[i], &mu[i], None), Some(&())), Ok((next, moved)));
            energy += site.kinetic_energy(&own, t, &q[i], &mu[i]);
            defect += site.isotropy_defect(&q[i], &p[i]).powi(2);
            largest = largest.max(site.orbit_defect(&off[i]));
        }
        prop_assert!((ring.power_kinetic_energy(&constants, t, &q, &mu) - energy).abs() <= 1e-14 * energy);
        prop_assert!((ring.power_isotropy_defect(&q, &p) - defect.sqrt()).abs() < 1e-14);
        prop_assert_eq!(ring.power_orbit_defect(&off), largest);
    }

    /// Differences of the potential, and the kicks from its gradient.
    #[test]
    fn kicks_are_gradients(ring in rings(), (q, _) in spins(), along in prop::array::uniform5(vector::<3>(1.0)), t in -3.0_f64..3.0, weight in -1.0_f64..1.0) {
        let slope = ring.slope(t, &q);
        prop_assert_eq!(slope, std::array::from_fn(|i| ring.gradient_at(t, &q, i)));
        let moved = |e: f64| ring.potential_of_sites(t, &std::array::from_fn(|i| q[i] + e * along[i]));
        // a quadratic potential has no error of third order
        let difference = (moved(1e-3) - moved(-1e-3)) / 2e-3;
        let expected: f64 = slope.iter().zip(&along).map(|(slope, along)| slope.dot(along)).sum();
        prop_assert!((difference - expected).abs() < 1e-11, "{} and {}", difference, expected);
        let kick = ring.power_kick(t, &q, weight);
        let by_map: Spins = ring.momentum_map(&q, &slope.map(|slope| weight * slope));
        prop_assert!(apart(&kick, &by_map) < 1e-14);
        prop_assert_eq!(kick, std::array::from_fn(|i| ring.kick_of_site(i, &q[i], &slope[i], weight)));
        let (mut gradient, mut again, mut momenta) = ([Vector3::x(); N], [Vector3::x(); N], [Vector3::y(); N]);
        let sum = ring.kick_into(t, &q, weight, &mut gradient, &mut again, &mut momenta);
        // gathered gradients are not stored
        prop_assert_eq!((gradient, again), ([Vector3::x(); N], kick));
        prop_assert!(apart(&momenta, &kick.map(|kick| kick + Vector3::y())) < 1e-15);
        // points on spheres are finite wherever their momenta are
        prop_assert!((sum - momenta.iter().map(Vector3::sum).sum::<f64>()).abs() < 1e-13);
        prop_assert_eq!(ring.power_stagger(weight, t, &q, -0.5, -0.5), [Vector3::zeros(); N]);
        prop_assert!(apart(&ring.power_stagger(weight, t, &q, 0.0, -1.0), &kick.map(|kick| -0.5 * kick)) < 1e-15);
    }

    /// Of springs between all pairs: k(N x_i − Σ x_j) on each, added to the gradient so far; gathered nowhere.
    #[test]
    fn what_terms_have_is_added_up(stiffness in 0.1_f64..2.0, x in prop::array::uniform5(vector::<3>(1.0)), weight in -1.0_f64..1.0) {
        let springs = Springs::<N> { stiffness };
        let all: Vector3<f64> = x.iter().sum();
        let expected: Spins = x.map(|x| stiffness * (N as f64 * x - all));
        let mut added = [Vector3::z(); N];
        springs.add_gradient(0.0, &x, &mut added);
        prop_assert!(apart(&added, &expected.map(|slope| slope + Vector3::z())) < 1e-13);
        prop_assert_eq!(springs.gradient_at(0.0, &x, 1), Vector3::zeros());
        let (mut gradient, mut kick, mut momenta) = ([Vector3::x(); N], [Vector3::x(); N], [Vector3::y(); N]);
        let sum = springs.kick_into(0.0, &x, weight, &mut gradient, &mut kick, &mut momenta);
        prop_assert_eq!((gradient, kick), (springs.slope(0.0, &x), springs.power_kick(0.0, &x, weight)));
        prop_assert!((sum - x.iter().chain(&momenta).map(Vector3::sum).sum::<f64>()).abs() < 1e-13);
    }

    /// Kick, move, kick; the transforms of both ends; and the same on T*Q.
    #[test]
    fn steps_are_kicks_and_moves(ring in rings(), (q, mu) in spins(), t in -3.0_f64..3.0) {
        let constants: PowerConstants<_, _> = ring.power_constants(H)?;
        prop_assert_eq!(constants.part(-0.5), -0.5 * H);
        prop_assert_eq!(<Ring<N> as Power<N>>::constants_of_sites(&ring.step_constants(H)?).part(1.0), H);
        let start = ring.power_kick(t, &q, constants.part(-0.5));
        let (at, later) = (At::new(&ring, &constants, t), At::new(&ring, &constants, t + H));
        let (next, momenta, kick) = SitesOfSecondOrder::<N>::step(at, (&q, &mu, &start), &())?;
        let kicked: Spins = std::array::from_fn(|i| mu[i] + start[i]);
        let (mut image, mut moved) = ([Vector3::x(); N], [Vector3::x(); N]);
        prop_assert!(ring.drift_into(&constants, t, (&q, &mu), Some(&start), None, (&mut image, &mut moved)).is_ok());
        let (mut in_place, mut carried) = (q, mu);
        prop_assert!(ring.drift_in_place(&constants, t, &mut in_place, &mut carried, Some(&start), None).is_ok());
        prop_assert_eq!((in_place, carried), (image, moved));
        prop_assert_eq!((image, moved, ()), FreeSites::<N>::step(at, (&q, &kicked, &()), &())?);
        prop_assert_eq!(next, image);
        prop_assert_eq!(kick, ring.power_kick(t + H, &next, constants.part(-0.5)));
        prop_assert!(apart(&momenta, &std::array::from_fn(|i| moved[i] + kick[i])) < 1e-15);
        let (mut image, mut moved, mut left) = ([Vector3::x(); N], [Vector3::x(); N], [Vector3::x(); N]);
        SitesOfSecondOrder::<N>::step_into(at, (&q, &mu, &start), &(), (&mut image, &mut moved, &mut left))?;
        prop_assert_eq!((image, moved, left), (next, momenta, kick));
        let f = SitesOfSecondOrder::<N>::inverse_legendre(at, &q, &mu)?;
        prop_assert!(apart(&ring.act(&f, &q), &next) < 1e-13);
        prop_assert!(apart(&ring.power_legendre(H, t, &q, &f, -0.5), &mu) < 1e-12);
        prop_assert!(apart(&ring.power_legendre_next(H, t, &q, &f, -0.5), &momenta) < 1e-12);
        let (first, late, ()) = SitesOfFirstOrder::<N>::step(at, (&q, &mu, &()), &())?;
        let (image, moved, ()) = FreeSites::<N>::step(at, (&q, &mu, &()), &())?;
        let (mut there, mut pushed) = (q, mu);
        FreeSites::<N>::step_into(at, (&q, &mu, &()), &(), (&mut there, &mut pushed, &mut ()))?;
        prop_assert_eq!((there, pushed), (image, moved));
        SitesOfFirstOrder::<N>::step_into(at, (&q, &mu, &()), &(), (&mut there, &mut pushed, &mut ()))?;
        prop_assert_eq!((there, pushed), (first, late));
        let whole = ring.power_kick(t + H, &image, constants.part(-1.0));
        prop_assert_eq!(first, image);
        // several at once are one after the other, but for the rounding of the time
        let near = |a: (&Spins, &Spins), b: (&Spins, &Spins)| apart(a.0, b.0).max(apart(a.1, b.1)) < 1e-14;
        let again = SitesOfFirstOrder::<N>::step(later, (&first, &late, &()), &())?;
        let both = SitesOfFirstOrder::<N>::steps(at, H, 2, (&q, &mu, &()), &())?;
        prop_assert!(near((&both.0, &both.1), (&again.0, &again.1)));
        let again = SitesOfSecondOrder::<N>::step(later, (&next, &momenta, &kick), &())?;
        let both = SitesOfSecondOrder::<N>::steps(at, H, 2, (&q, &mu, &start), &())?;
        prop_assert!(near((&both.0, &both.1), (&again.0, &again.1)) && apart(&both.2, &again.2) < 1e-14);
        let again = FreeSites::<N>::step(later, (&image, &moved, &()), &())?;
        let both = FreeSites::<N>::steps(at, H, 2, (&q, &mu, &()), &())?;
        prop_assert!(near((&both.0, &both.1), (&again.0, &again.1)));
        prop_assert!(apart(&late, &std::array::from_fn(|i| moved[i] + whole[i])) < 1e-15);
        // p = N × q has J(q, p) = N, as N is across q
        let p: Spins = std::array::from_fn(|i| mu[i].cross(&q[i]));
        let (there, covectors) = SitesOfSecondOrder::<N>::step_symmetric(at, &q, &p)?;
        prop_assert!(apart(&there, &next) < 1e-13);
        prop_assert!(apart(&ring.momentum_map(&there, &covectors), &momenta) < 1e-12);
    }

    /// Bit for bit, in vectors and in slices.
    #[test]
    fn storage_does_not_matter(ring in rings(), (q, mu) in spins(), steps in 0_u64..5) {
        let stepper = ring.stepper(H)?;
        let mut state = stepper.state(q, mu)?;
        let mut vectors = ring.stepper(H)?.sites(SiteStorage::of(q.to_vec(), mu.to_vec()))?;
        let mut single = ring.into_stepper(H)?.sites(SiteStorage::of(q, mu))?;
        for _ in 0..steps {
            state = stepper.step(&state)?;
            single.step()?;
        }
        vectors.advance(steps)?;
        prop_assert_eq!((vectors.configuration(), vectors.momentum()), (&state.configuration()[..], &state.momentum()[..]));
        prop_assert_eq!((single.configuration(), single.momentum()), (&state.configuration()[..], &state.momentum()[..]));
        prop_assert_eq!((vectors.time(), vectors.steps()), (state.time(), steps));
        prop_assert_eq!(vectors.energy()?, stepper.energy(&state));
        prop_assert_eq!(vectors.stepper().step_size(), H);
        let storage = vectors.into_storage();
        prop_assert_eq!((&storage.configuration[..], &storage.momentum[..]), (single.configuration(), single.momentum()));
    }

    /// Constant pushes give x + t v + t² u/2 and v + t u at the nodes.
    #[test]
    fn inputs_are_those_of_sites(x in prop::array::uniform5(vector::<3>(1.0)), v in prop::array::uniform5(vector::<3>(1.0)), u in prop::array::uniform5(vector::<3>(1.0)), steps in 1_u32..5) {
        let mut sites = Pushed::<N>.into_stepper(H)?.sites(SiteStorage::of(x.to_vec(), v.to_vec()))?;
        for _ in 0..steps {
            sites.step_with(&u)?;
        }
        let t = f64::from(steps) * H;
        for i in 0..N {
            prop_assert_eq!(<Pushed<N> as Power<N>>::input_of_site(&u, i), &u[i]);
            prop_assert!((sites.momentum()[i] - v[i] - t * u[i]).amax() < 1e-14);
            prop_assert!((sites.configuration()[i] - x[i] - t * v[i] - t * t / 2.0 * u[i]).amax() < 1e-14);
        }
        prop_assert!(sites.step_with(&[Vector3::repeat(f64::NAN); N]).is_err());
        prop_assert_eq!(sites.steps(), u64::from(steps));
    }

    /// A conserved quantity is a sum over sites.
    #[test]
    fn conserved_momenta_are_sums(mut ring in rings(), (q, mu) in spins()) {
        let along_field = |ring: &Ring<N>| -> Result<f64, TestCaseError> {
            Ok(ring.stepper(H)?.sites(SiteStorage::of(q.to_vec(), mu.to_vec()))?.conserved()?[0])
        };
        let total: Vector3<f64> = mu.iter().sum();
        prop_assert!((along_field(&ring)? - total.dot(&ring.field)).abs() < 1e-14);
        ring.field *= 2.0;
        prop_assert!((along_field(&ring)? - total.dot(&ring.field)).abs() < 1e-14);
    }

    #[test]
    fn indices_go_round(index in -40_isize..40) {
        prop_assert_eq!(wrapped::<7>(index) as isize, index.rem_euclid(7));
        prop_assert_eq!(wrapped::<1>(index), 0);
    }
}
