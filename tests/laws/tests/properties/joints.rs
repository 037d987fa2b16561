//! Joints between neighbouring sites: their rows are differences of their equations, and states and steps obey them.

use crate::arbitrary::{cases, vector};
use crate::runner::proptest;
use clebsch::__private::{
    At, Border, Branch, Joined, JoinedInStorage, JointRows, Limb, Loop, LoopedLimb, Loops, Mobile, Power,
    put_loop_values, put_loops, put_places,
};
use clebsch::{Clebsch, Constrained, Error, SiteStorage};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, SVector, Vector2, Vector3};
use proptest::prelude::*;

/// Bodies in the plane on pins. The first pin moves. Their velocity is turned by a field: the momentum of velocity
/// zero is not 0. The last body slides on the line y = x.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<2>; N], q: [SE<2>; N]| (0..N).map(|i| q[i] * F[i]),
    lagrangian = |xi| (0..N).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2 + self.spin * xi[i].x).sum(),
    potential  = |q| (0..N).map(|i| self.mass[i] * q[i].translation().y).sum(),
    constraint = |t, q| [
        q[0].translation() == Vector2::new(self.speed * t, t.powi(2) / 2),
        (1..N).map(|i| q[i].rotation() * self.arm + q[i].translation() == q[i - 1].translation() - q[i - 1].rotation() * self.arm),
        q[N - 1].translation().x == q[N - 1].translation().y,
    ],
)]
pub struct Crane<const N: usize> {
    pub inertia: [f64; N],
    pub mass: [f64; N],
    pub spin: f64,
    pub speed: f64,
    pub arm: Vector2<f64>,
}

type CraneSteps = <Crane<3> as Clebsch>::Scheme;

/// Beads on rods: 1 and 2 on the first one, 3 and 4 on bead 1, 5 on bead 4. Bead 2 is on a line too.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    lagrangian = |v| (0..N).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
    constraint = |x| [
        (1..3).map(|i| (x[i] - x[0]).norm_squared() == self.rod),
        (3..5).map(|i| (x[i] - x[1]).norm_squared() == self.rod),
        (x[5] - x[4]).norm_squared() == self.rod,
        x[2].x == x[2].y,
    ],
)]
pub struct Twigs<const N: usize> {
    pub mass: [f64; N],
    pub rod: f64,
}

/// The same with three rods that close loops. The end of the first of them moves.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
    lagrangian = |v| (0..N).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
    constraint = |t, x| [
        (1..3).map(|i| (x[i] - x[0]).norm_squared() == self.rod),
        (3..5).map(|i| (x[i] - x[1]).norm_squared() == self.rod),
        (x[5] - x[4]).norm_squared() == self.rod,
        (x[3] - x[2] - self.speed * t * Vector2::x()).norm_squared() == self.rod,
        (4..6).map(|i| (x[i] - x[i - 4]).norm_squared() == self.rod),
    ],
)]
pub struct Web<const N: usize> {
    pub mass: [f64; N],
    pub rod: f64,
    pub speed: f64,
}

fn crane() -> Crane<3> {
    Crane { inertia: [0.2, 0.3, 0.1], mass: [1.0, 0.7, 0.4], spin: 0.3, speed: 0.4, arm: Vector2::new(0.5, 0.1) }
}

fn placed(angle: f64, place: Vector2<f64>) -> Matrix3<f64> {
    Matrix3::new(angle.cos(), -angle.sin(), place.x, angle.sin(), angle.cos(), place.y, 0.0, 0.0, 1.0)
}

/// The motion exp(ξ) − I to first order, applied from the right.
fn moved(q: &Matrix3<f64>, xi: Vector3<f64>, size: f64) -> Matrix3<f64> {
    q + q * Matrix3::new(0.0, -xi.x, xi.y, xi.x, 0.0, xi.z, 0.0, 0.0, 0.0) * size
}

/// A crane whose joints are closed at t = 0 for a first angle: the other two follow from the line y = x.
fn closed(crane: &Crane<3>, first: f64) -> Option<[Matrix3<f64>; 3]> {
    let arm = |angle: f64| placed(angle, Vector2::zeros()).fixed_view::<2, 2>(0, 0) * crane.arm;
    let second = first + 0.8;
    let place = |angle: f64, joint: Vector2<f64>| placed(angle, joint - arm(angle));
    let middle = place(second, -arm(first));
    let joint = middle.fixed_view::<2, 1>(0, 2) - arm(second);
    // x − y of the last body vanishes at some angle, found by halving
    let off = |angle: f64| {
        let last = place(angle, joint);
        last[(0, 2)] - last[(1, 2)]
    };
    let (mut low, mut high) = (0.0, std::f64::consts::PI);
    if off(low) * off(high) > 0.0 {
        return None;
    }
    for _ in 0..200 {
        let half = (low + high) / 2.0;
        if off(low) * off(half) <= 0.0 { high = half } else { low = half }
    }
    Some([placed(first, Vector2::zeros()), middle, place(low, joint)])
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn rows_of_joints_are_differences(angles in vector::<3>(2.0), places in vector::<6>(1.0), xi in vector::<3>(1.0), t in -1.0_f64..1.0) {
        let (crane, small) = (crane(), 1e-6);
        let q: [Matrix3<f64>; 3] = std::array::from_fn(|i| placed(angles[i], Vector2::new(places[2 * i], places[2 * i + 1])));
        for site in 0..3 {
            let rows: JointRows<f64, 3, 3> = crane.rows_at(t, &q, site);
            let count = if site == 2 { 3 } else { 2 };
            prop_assert_eq!(rows.are_there, [true, true, count == 3]);
            let along = |moving: usize| {
                let at = |size: f64| {
                    let mut q = q;
                    q[moving] = moved(&q[moving], xi, size);
                    crane.places_at(t, &q, site)
                };
                (at(small) - at(-small)) / (2.0 * small)
            };
            assert_near(&(rows.own * xi), &along(site), 1e-8, "along the site");
            if site > 0 {
                assert_near(&(rows.before * xi), &along(site - 1), 1e-8, "along the site before");
            }
            let later = (crane.places_at(t + small, &q, site) - crane.places_at(t - small, &q, site)) / (2.0 * small);
            assert_near(&rows.velocity, &-later, 1e-8, "with the time");
        }
    }

    /// Σ⁻¹(Σξ + A − A) is ξ.
    #[test]
    fn velocities_of_sites_are_those_of_momenta(angle in -3.0_f64..3.0, xi in vector::<3>(1.0), mu in vector::<3>(1.0)) {
        let crane = crane();
        let site = crane.site(1);
        let (q, constants) = (placed(angle, Vector2::new(0.1, 0.2)), site.constants(0.1)?);
        let momentum = site.momentum_of_velocity(0.0, &q, &xi);
        assert_near(&momentum, &Vector3::new(0.3 * xi.x + 0.3, 0.7 * xi.y, 0.7 * xi.z), 1e-15, "the momentum");
        assert_near(&site.velocity(&constants, 0.0, &q, &momentum), &xi, 1e-14, "the velocity");
        assert_near(&site.momentum_at_rest(0.0, &q).unwrap_or_default(), &(Vector3::x() * 0.3), 1e-15, "at rest");
        let kinetic = <<Crane<3> as Power<3>>::Site as Mobile<3>>::mobility(&constants, &mu).dot(&mu);
        let expected = mu.x * mu.x / 0.3 + (mu.y * mu.y + mu.z * mu.z) / 0.7;
        prop_assert!((kinetic - expected).abs() < 1e-14, "{} {}", kinetic, expected);
    }

    /// A projected momentum is a state; its steps close the joints at their times, in storage of others too.
    #[test]
    fn states_and_steps_obey_joints(first in -0.5_f64..0.5, mu in vector::<9>(0.3)) {
        let crane = crane();
        let Some(q) = closed(&crane, first) else { return Ok(()) };
        let stepper = crane.stepper(0.01)?;
        let mu: [Vector3<f64>; 3] = std::array::from_fn(|i| mu.fixed_rows::<3>(3 * i).into());
        crane.check_joints(0.0, &q)?;
        let constants = crane.constants(0.01)?;
        let projected = crane.joined_momentum(&constants, 0.0, &q, &mu)?;
        let start = stepper.project(q, mu)?;
        for (a, b) in projected.iter().zip(&start.momentum()) {
            assert_near(a, b, 1e-12, "the momentum");
        }
        let placed = crane.joined_places(&constants, 0.0, &q)?;
        prop_assert_eq!(&placed, start.configuration());
        let defect = crane.defect_of_joints(&constants, 0.0, &q, &projected)?;
        prop_assert!(defect.largest < 1e-12, "{:?}", defect);
        let start = stepper.state(q, projected)?;
        let end = stepper.advance(&start, 5)?;
        for site in 0..3 {
            let open = crane.places_at(end.time(), end.configuration(), site).amax();
            prop_assert!(open < 1e-13, "{}", open);
        }
        let storage = SiteStorage::of(q, projected);
        let mut sites = stepper.clone().joined_sites(storage, std::array::from_fn::<_, 3, _>(|_| stepper.joint()))?;
        sites.advance(5)?;
        prop_assert_eq!(sites.configuration(), end.configuration());
        prop_assert_eq!(sites.momentum(), &end.momentum());

        // from velocities
        let velocities = std::array::from_fn(|i| crane.site(i).velocity(&crane.site(i).constants(0.01).expect("constants"), 0.0, &q[i], &projected[i]));
        let moving = stepper.state_moving(q, velocities)?;
        for (a, b) in moving.momentum().iter().zip(&projected) {
            assert_near(a, b, 1e-14, "the momentum");
        }
        prop_assert_eq!(crane.momentum_of_velocity(0.0, &q, &velocities), moving.momentum());
        let room = || std::array::from_fn::<_, 3, _>(|_| stepper.joint());
        let moving_sites = stepper.clone().joined_sites_moving(SiteStorage::of(q, velocities), room())?;
        prop_assert_eq!(moving_sites.momentum(), &moving.momentum());
        let mut momenta = velocities;
        CraneSteps::momenta_of_velocities(At::new(&crane, &constants, 0.0), &q, &mut momenta);
        prop_assert_eq!(momenta, moving.momentum());

        // from the nearest state
        let mut near = q;
        near[1][(0, 2)] += 1e-3;
        let nearest = stepper.project(near, mu)?;
        let sites = stepper.clone().projected_joined_sites(SiteStorage::of(near, mu), room())?;
        prop_assert_eq!(sites.configuration(), nearest.configuration());
        prop_assert_eq!(sites.momentum(), &nearest.momentum());
        let (mut place, mut momentum) = (near, mu);
        CraneSteps::to_joints(At::new(&crane, &constants, 0.0), (&mut place, &mut momentum), &mut room()).map_err(|(_, error)| error)?;
        prop_assert_eq!((&place, momentum), (nearest.configuration(), nearest.momentum()));

        let mut open = q;
        open[1][(0, 2)] += 1e-3;
        let is_refused = matches!(crane.check_joints(0.0, &open), Err(Error::OffConstraint { .. }));
        prop_assert!(is_refused);
        let refused: Result<_, Error> = stepper.state(q, std::array::from_fn(|i| projected[i] + Vector3::repeat(0.1)));
        let is_refused = matches!(refused, Err(Error::ConstraintViolated { .. }));
        prop_assert!(is_refused, "{:?}", refused);
    }

    /// Each entry in its place, from the row that is named; rows behind the last have no place.
    #[test]
    fn rows_are_put_where_they_belong(own in vector::<4>(1.0), before in vector::<4>(1.0), first in 0_usize..6) {
        let mut rows = JointRows::<f64, 4, 2>::none();
        prop_assert_eq!((rows.own.amax(), rows.before.amax(), rows.are_there), (0.0, 0.0, [false; 4]));
        let nested = |v: &SVector<f64, 4>| [[v[0], v[1]], [v[2], v[3]]];
        rows.put(first, nested(&own), nested(&before), [own[0], before[0]]);
        let mut places = SVector::<f64, 4>::zeros();
        put_places(&mut places, first, [own[0], before[0]]);
        for i in 0..4_usize {
            let number = i.checked_sub(first).filter(|number| *number < 2);
            let entry = |v: &SVector<f64, 4>, j: usize| number.map_or(0.0, |number| v[2 * number + j]);
            prop_assert_eq!(rows.are_there[i], number.is_some());
            for j in 0..2 {
                prop_assert_eq!((rows.own[(i, j)], rows.before[(i, j)]), (entry(&own, j), entry(&before, j)));
            }
            let value = number.map_or(0.0, |number| [own[0], before[0]][number]);
            prop_assert_eq!((rows.velocity[i], places[i]), (value, value));
        }
    }

    /// φ″ with constant velocities is the second difference along q exp(sξ), and small motions are first differences.
    #[test]
    fn bends_of_joints_are_second_differences(angles in vector::<3>(2.0), places in vector::<6>(1.0), xi in vector::<9>(1.0), t in -1.0_f64..1.0) {
        let (crane, small) = (crane(), 1e-3);
        let q: [Matrix3<f64>; 3] = std::array::from_fn(|i| placed(angles[i], Vector2::new(places[2 * i], places[2 * i + 1])));
        let xi: [Vector3<f64>; 3] = std::array::from_fn(|i| xi.fixed_rows::<3>(3 * i).into());
        // to second order; the third cancels
        let at = |s: f64| std::array::from_fn(|i| {
            let once = moved(&q[i], xi[i], s) - q[i];
            q[i] + once + (moved(&once, xi[i], s) - once) / 2.0
        });
        for site in 0..3 {
            let along = |s: f64| crane.places_at(t + s, &at(s), site);
            let expected = (along(small) - 2.0 * along(0.0) + along(-small)) / (small * small);
            // no row of the first site reads one before
            let before = if site == 0 { 0 } else { site - 1 };
            assert_near(&crane.bend_at(t, &q, site, &xi[site], &xi[before]), &expected, 1e-5, "the bend");
            let (tiny, body) = (1e-7, crane.site(site));
            let motion = (body.moved_by(&q[site], &(xi[site] * tiny)) - body.moved_by(&q[site], &(xi[site] * -tiny))) / (2.0 * tiny);
            assert_near(&motion, &(moved(&q[site], xi[site], 1.0) - q[site]), 1e-7, "the motion");
        }
    }

    /// Rows and values of loops are put where they belong, and K is inverted. Its zero pivots are counted.
    #[test]
    fn loops_are_put_where_they_belong(entries in vector::<6>(1.0), first in 0_usize..4) {
        let mut loops = <Loops<f64, 2, 3> as Border<f64, 2>>::new();
        prop_assert_eq!(<Loops<f64, 2, 3> as Border<f64, 2>>::COUNT, 3);
        let row = |i: usize| [entries[i], entries[i + 1]];
        put_loops(loops.all_mut(), first, [4, 2], [[row(0), row(1)], [row(2), row(3)]], [entries[4], entries[5]]);
        put_loop_values(loops.all_mut(), first, [1.0, 2.0]);
        for (i, Loop { sites, along, velocity, value, .. }) in loops.all().iter().enumerate() {
            let number = i.checked_sub(first).filter(|number| *number < 2);
            let expected = number.map_or(([0; 2], [Vector2::zeros(); 2], 0.0, 0.0), |k| ([4, 2], [row(k).into(), row(k + 2).into()], entries[4 + k], 1.0 + k as f64));
            prop_assert_eq!((*sites, *along, *velocity, *value), expected);
        }
        let mut loops = <Loops<f64, 2, 3> as Border<f64, 2>>::new();
        let root = Matrix3::new(2.0, 0.0, 0.0, entries[0], 3.0, 0.0, entries[1], entries[2], 1.5);
        let matrix = root * root.transpose();
        put_loop_values(loops.all_mut(), 0, (matrix * Vector3::new(entries[3], entries[4], entries[5])).into());
        prop_assert_eq!(loops.factor(|i, j| matrix[(i, j)], 1e-12), 0);
        loops.solve();
        assert_near(&loops.values(), &Vector3::new(entries[3], entries[4], entries[5]), 1e-12, "the solution");
        prop_assert_eq!(loops.solution(), loops.values());
        // no sweep has corrected the multipliers of a move
        prop_assert_eq!([loops.impulses(true), loops.impulses(false)], [loops.values(), Vector3::zeros()]);
        prop_assert_eq!(loops.factor(|i, j| root[(i, 0)] * root[(j, 0)], 1e-12), 3 - usize::from(root[(0, 0)] != 0.0));
        let mut limb = <LoopedLimb<f64, 2, 2, 3> as Branch<f64, 2, 2>>::new();
        prop_assert_eq!((limb.columns().len(), limb.columns_mut().len()), (3, 3));
        prop_assert!(limb.limb().is_some() && limb.limb_mut().is_some());
        let mut limb = <Limb<f64, 2, 2> as Branch<f64, 2, 2>>::new();
        prop_assert_eq!((limb.columns().len(), limb.columns_mut().len()), (0, 0));
    }

    /// The parents of a tree are those of its equations, and a push Aᵀκ has the multipliers κ, wherever the beads are.
    /// Its sites have room for their children, which those of a chain have not.
    #[test]
    fn multipliers_of_trees_are_those_of_their_pushes(places in vector::<12>(2.0), masses in vector::<6>(0.9), kappa in vector::<12>(1.0)) {
        let mut rooms = (<() as Branch<f64, 2, 2>>::new(), <Limb<f64, 2, 2> as Branch<f64, 2, 2>>::new());
        prop_assert!(Branch::<f64, 2, 2>::limb(&rooms.0).is_none() && Branch::<f64, 2, 2>::limb_mut(&mut rooms.0).is_none());
        prop_assert!(rooms.1.limb().is_some() && rooms.1.limb_mut().is_some());
        let twigs = Twigs::<6> { mass: std::array::from_fn(|i| 1.0 + masses[i]), rod: 1.0 };
        let parents = [None, Some(0), Some(0), Some(1), Some(1), Some(4)];
        let q: [Vector2<f64>; 6] = std::array::from_fn(|i| Vector2::new(places[2 * i], places[2 * i + 1]));
        let rows: [JointRows<f64, 2, 2>; 6] = std::array::from_fn(|site| twigs.rows_at(0.0, &q, site));
        let kappa: [Vector2<f64>; 6] = std::array::from_fn(|i| Vector2::from_fn(|k, _| if rows[i].are_there[k] { kappa[2 * i + k] } else { 0.0 }));
        let mut push = [Vector2::zeros(); 6];
        for site in 0..6 {
            prop_assert_eq!(Twigs::<6>::parent(site), parents[site]);
            push[site] += rows[site].own.transpose() * kappa[site];
            if let Some(parent) = parents[site] {
                push[parent] += rows[site].before.transpose() * kappa[site];
            }
        }
        let constants = twigs.constants(0.01)?;
        let dense = nalgebra::DMatrix::from_fn(12, 12, |row, column| {
            let (site, of) = (row / 2, column / 2);
            match of {
                _ if of == site => rows[site].own[(row % 2, column % 2)],
                _ if Some(of) == parents[site] => rows[site].before[(row % 2, column % 2)],
                _ => 0.0,
            }
        });
        // rows that nearly depend on each other have no digits left
        let values = dense.singular_values();
        let least = values.iter().copied().filter(|value| *value > 1e-12).fold(f64::MAX, f64::min);
        prop_assume!(values.iter().filter(|value| **value > 1e-12).count() == 6 && least > 0.05);
        let found = twigs.multipliers_of_joints(&constants, 0.0, &q, &push);
        for (found, kappa) in found.iter().zip(&kappa) {
            assert_near(found, kappa, 1e-9, "the multipliers");
        }
    }

    /// The rows of rods that close loops are differences of their equations, and a push of all rods has its multipliers.
    #[test]
    fn multipliers_of_loops_are_those_of_their_pushes(places in vector::<12>(2.0), motion in vector::<12>(1.0), masses in vector::<6>(0.9), kappa in vector::<8>(1.0), t in -1.0_f64..1.0) {
        let web = Web::<6> { mass: std::array::from_fn(|i| 1.0 + masses[i]), rod: 1.0, speed: 0.3 };
        let points = |all: &SVector<f64, 12>| -> [Vector2<f64>; 6] { std::array::from_fn(|i| Vector2::new(all[2 * i], all[2 * i + 1])) };
        let (q, motions) = (points(&places), points(&motion));
        let rows_at = |t: f64, q: &[Vector2<f64>; 6]| {
            let mut loops = <Loops<f64, 2, 3> as Border<f64, 2>>::new();
            web.loop_rows(t, q, loops.all_mut());
            web.loop_places(t, q, loops.all_mut());
            loops
        };
        let loops = rows_at(t, &q);
        let sites: Vec<[usize; 2]> = loops.all().iter().map(|row| row.sites).collect();
        prop_assert_eq!(sites, vec![[3, 2], [4, 0], [5, 1]]);
        let along = |s: f64| rows_at(t + s, &points(&(places + motion * s))).values();
        let small = 1e-4;
        let change = (along(small) - along(-small)) / (2.0 * small);
        let mut bends = loops;
        web.loop_bends(t, &q, &motions, bends.all_mut());
        let bend = (along(small) - 2.0 * loops.values() + along(-small)) / (small * small);
        assert_near(&bends.values(), &bend, 1e-5, "the bends");
        for (i, row) in loops.all().iter().enumerate() {
            let [a, b] = row.sites;
            let rate = row.along[0].dot(&motions[a]) + row.along[1].dot(&motions[b]) - row.velocity;
            assert_near(&SVector::from([rate]), &SVector::from([change[i]]), 1e-6, "the rate of a rod");
        }
        let rows: [JointRows<f64, 1, 2>; 6] = std::array::from_fn(|site| web.rows_at(t, &q, site));
        let mut dense = nalgebra::DMatrix::zeros(8, 12);
        for site in 1..6 {
            prop_assert!(rows[site].are_there[0]);
            let parent = Web::<6>::parent(site).expect("a parent");
            for k in 0..2 {
                dense[(site - 1, 2 * site + k)] = rows[site].own[k];
                dense[(site - 1, 2 * parent + k)] = rows[site].before[k];
            }
        }
        for (i, row) in loops.all().iter().enumerate() {
            for (site, along) in row.sites.iter().zip(&row.along) {
                (0..2).for_each(|k| dense[(5 + i, 2 * site + k)] = along[k]);
            }
        }
        // rows that nearly depend on each other have no digits left
        let values = dense.singular_values();
        prop_assume!(values.min() > 0.05);
        let push = dense.transpose() * nalgebra::DVector::from_column_slice(kappa.as_slice());
        let push: [Vector2<f64>; 6] = std::array::from_fn(|i| Vector2::new(push[2 * i], push[2 * i + 1]));
        let constants = web.constants(0.01)?;
        let (joints, found) = web.multipliers_with_loops(&constants, t, &q, &push);
        for site in 1..6 {
            assert_near(&joints[site], &SVector::from([kappa[site - 1]]), 1e-8, "the multipliers of the tree");
        }
        assert_near(&found.values(), &kappa.fixed_rows::<3>(5).into_owned(), 1e-8, "the multipliers of the loops");
        // no force acts but those of the rods: A Σ⁻¹Aᵀλ = −φ″
        let mu: [Vector2<f64>; 6] = std::array::from_fn(|i| motions[i] * web.mass[i]);
        let (joints, loops) = web.reactions_with_loops(&constants, t, &q, &mu, &())?;
        let pulls = SVector::<f64, 8>::from_fn(|i, _| if i < 5 { joints[i + 1].x } else { loops.values()[i - 5] });
        let mobility = nalgebra::DMatrix::from_fn(12, 12, |i, j| if i == j { 1.0 / web.mass[i / 2] } else { 0.0 });
        let held = &dense * mobility * dense.transpose() * nalgebra::DVector::from_column_slice(pulls.as_slice());
        let bend = SVector::<f64, 8>::from_fn(|i, _| match i {
            0..5 => web.bend_at(t, &q, i + 1, &motions[i + 1], &motions[Web::<6>::parent(i + 1).unwrap_or(0)]).x,
            _ => bends.values()[i - 5],
        });
        assert_near(&SVector::<f64, 8>::from_column_slice(held.as_slice()), &-bend, 1e-8, "the bends of all rods");
    }

    /// With the reactions the joints stay closed: φ″ = 0. The accelerations of bodies alone are differences of their steps.
    #[test]
    fn reactions_keep_joints_closed(first in -0.5_f64..0.5, mu in vector::<9>(0.3), kappa in vector::<9>(1.0)) {
        let crane = crane();
        let Some(q) = closed(&crane, first) else { return Ok(()) };
        let constants = crane.constants(0.01)?;
        let mu: [Vector3<f64>; 3] = std::array::from_fn(|i| mu.fixed_rows::<3>(3 * i).into());
        let rows: [JointRows<f64, 3, 3>; 3] = std::array::from_fn(|site| crane.rows_at(0.0, &q, site));
        // Aᵀκ, and κ again
        let push = |kappa: &[SVector<f64, 3>; 3]| -> [Vector3<f64>; 3] {
            std::array::from_fn(|i| {
                let next = if i < 2 { rows[i + 1].before.transpose() * kappa[i + 1] } else { Vector3::zeros() };
                rows[i].own.transpose() * kappa[i] + next
            })
        };
        let kappa: [SVector<f64, 3>; 3] = std::array::from_fn(|i| SVector::from_fn(|k, _| if rows[i].are_there[k] { kappa[3 * i + k] } else { 0.0 }));
        let found = crane.multipliers_of_joints(&constants, 0.0, &q, &push(&kappa));
        for (found, kappa) in found.iter().zip(&kappa) {
            assert_near(found, kappa, 1e-9, "the multipliers");
        }
        let lambda = crane.reactions_of_joints(&constants, 0.0, &q, &mu, &())?;
        let stepper = crane.stepper(0.01)?;
        let start = stepper.project(q, mu)?;
        let room = std::array::from_fn::<_, 3, _>(|_| stepper.joint());
        let mut sites = stepper.clone().projected_joined_sites(SiteStorage::of(q, mu), room)?;
        let mut in_storage = [SVector::zeros(); 3];
        sites.reactions(&mut in_storage)?;
        prop_assert_eq!(in_storage, stepper.reactions(&start)?);
        in_storage = [SVector::zeros(); 3];
        sites.reactions_under(&(), &mut in_storage)?;
        prop_assert_eq!(in_storage, stepper.reactions(&start)?);
        let (next, mean) = stepper.step_with_reactions(&start)?;
        for step_under in [false, true] {
            let mut sites = sites.clone();
            if step_under { sites.step_with_reactions_under(&(), &mut in_storage)? } else { sites.step_with_reactions(&mut in_storage)? };
            prop_assert_eq!(sites.momentum(), &next.momentum()[..]);
            for (found, mean) in in_storage.iter().zip(&mean) {
                assert_near(found, mean, 1e-9, "the reactions of the step");
            }
        }
        let (pushes, weight) = (push(&lambda), crane.power_kick(0.0, &q, -1.0));
        let (mut velocities, mut accelerations) = ([Vector3::zeros(); 3], [Vector3::zeros(); 3]);
        for i in 0..3 {
            let site = crane.site(i);
            let c = site.constants(0.01)?;
            velocities[i] = site.velocity(&c, 0.0, &q[i], &mu[i]);
            let free = site.acceleration(&c, 0.0, &q[i], &mu[i], &());
            let after = |h: f64| -> Result<Vector3<f64>, Error> {
                let stepper = site.into_stepper(h)?;
                let next = stepper.step(&stepper.state(q[i], mu[i])?)?;
                Ok(site.velocity(&c, h, next.configuration(), &next.momentum()))
            };
            assert_near(&free, &((after(1e-4)? - after(-1e-4)?) / 2e-4), 1e-5, "the acceleration");
            let by = |push: &Vector3<f64>| <<Crane<3> as Power<3>>::Site as Mobile<3>>::mobility(&c, push);
            accelerations[i] = free + by(&(pushes[i] + weight[i]));
        }
        for site in 0..3 {
            let before = if site == 0 { 0 } else { site - 1 };
            let mut change = rows[site].own * accelerations[site] + crane.bend_at(0.0, &q, site, &velocities[site], &velocities[before]);
            if site > 0 {
                change += rows[site].before * accelerations[before];
            }
            for k in (0..3).filter(|&k| rows[site].are_there[k]) {
                prop_assert!(change[k].abs() < 1e-9, "site {}, row {}: {:e}", site, k, change[k]);
            }
        }
    }
}
