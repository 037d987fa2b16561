//! Sites that are counted from the last one, `q[N - 1]`, in trees and loops; loops in lanes; sites in storage.

use clebsch::{Clebsch, Error, F64x4, Scalar, SiteStorage};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation2, SVector, Vector1, Vector2, Vector3};

mod declared {
    use clebsch::Clebsch;

    /// Bars in the plane between two pins that stay: four bars with the ground, if N is 3.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<2>; N], q: [SE<2>; N]| (0..N).map(|i| q[i] * F[i]),
        lagrangian = |xi| (0..N).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2).sum(),
        potential  = |q| (0..N).map(|i| 9.81 * self.mass[i] * q[i].translation().y).sum(),
        constraint = |q| [
            q[0].translation() - q[0].rotation() * self.half[0] == Vector2::zeros(),
            (1..N).map(|i| q[i].translation() - q[i].rotation() * self.half[i] == q[i - 1].translation() + q[i - 1].rotation() * self.half[i - 1]),
            q[N - 1].translation() + q[N - 1].rotation() * self.half[N - 1] == self.ground,
        ],
    )]
    pub struct Bars<const N: usize> {
        pub inertia: [f64; N],
        pub mass: [f64; N],
        pub half: [nalgebra::Vector2<f64>; N],
        pub ground: nalgebra::Vector2<f64>,
    }

    /// The same with three bars, unrolled.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<2>; 3], q: [SE<2>; 3]| (0..3).map(|i| q[i] * F[i]),
        lagrangian = |xi| (0..3).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2).sum(),
        potential  = |q| (0..3).map(|i| 9.81 * self.mass[i] * q[i].translation().y).sum(),
        constraint = |q| [
            q[0].translation() - q[0].rotation() * self.half[0] == Vector2::zeros(),
            (1..3).map(|i| q[i].translation() - q[i].rotation() * self.half[i] == q[i - 1].translation() + q[i - 1].rotation() * self.half[i - 1]),
            q[2].translation() + q[2].rotation() * self.half[2] == self.ground,
        ],
        code       = unrolled,
    )]
    pub struct FourBars {
        pub inertia: [f64; 3],
        pub mass: [f64; 3],
        pub half: [nalgebra::Vector2<f64>; 3],
        pub ground: nalgebra::Vector2<f64>,
    }

    /// A rope of beads. A strut holds the last one apart from the second.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| self.mass * v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| self.mass * 9.81 * x[i].y).sum(),
        constraint = |x| [
            x[0] == Vector2::zeros(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
            (x[1] - x[N - 1]).norm_squared() == self.strut.powi(2),
        ],
    )]
    pub struct Braced<T, const N: usize> {
        pub mass: T,
        pub strut: T,
    }

    /// A rope of beads. The last one hangs from the first, and all others from the one before.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| 9.81 * x[i].y).sum(),
        constraint = |x| [
            x[0].norm_squared() == 1,
            (1..N - 1).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
            (x[N - 1] - x[1]).norm_squared() == 2,
        ],
    )]
    pub struct Forked<const N: usize>;

    /// A rope of beads whose first one a hand holds, in a wind that is an input.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| 9.81 * x[i].y).sum(),
        constraint = |t, x| [
            x[0] == self.swing * t.sin() * Vector2::x(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
        ],
        force      = |v, wind: Vector2| (0..N).map(|i| wind - v[i]),
        order      = 4,
    )]
    pub struct Blown<const N: usize> {
        pub swing: f64,
    }
}

use declared::*;

fn flat(angle: f64, place: Vector2<f64>) -> Matrix3<f64> {
    let mut flat = Matrix3::new_translation(&place);
    flat.fixed_view_mut::<2, 2>(0, 0).copy_from(Rotation2::new(angle).matrix());
    flat
}

#[test]
fn four_bars_of_a_const_generic_are_the_same_unrolled() -> Result<(), Error> {
    let (inertia, mass) = ([0.02, 0.05, 0.03], [0.5, 0.8, 0.6]);
    let half = [0.2, 0.5, 0.4].map(|half| Vector2::new(half, 0.0));
    let bar = |angle: f64, from: Vector2<f64>, half: Vector2<f64>| flat(angle, from + Rotation2::new(angle) * half);
    let tip = |body: &Matrix3<f64>, half: Vector2<f64>| body.transform_point(&half.into()).coords;
    let crank = bar(1.2, Vector2::zeros(), half[0]);
    let coupler = bar(0.3, tip(&crank, half[0]), half[1]);
    let rocker = bar(-1.3, tip(&coupler, half[1]), half[2]);
    let ground = tip(&rocker, half[2]);
    let bars = Bars { inertia, mass, half, ground }.into_stepper(0.005)?;
    let unrolled = FourBars { inertia, mass, half, ground }.into_stepper(0.005)?;
    let mut state = bars.project([crank, coupler, rocker], [Vector3::new(0.05, 0.1, 0.2); 3])?;
    let momentum = SVector::<f64, 9>::from_iterator(state.momentum().into_iter().flat_map(|mu| mu.data.0[0]));
    let mut other = unrolled.state(*state.configuration(), momentum)?;
    for step in 0..crate::long(400) {
        (state, other) = (bars.step(&state)?, unrolled.step(&other)?);
        let places = state.configuration().iter().zip(other.configuration());
        let far = places.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far < 1e-11, "step {step}: {far:e}");
    }
    // the joints of the last bar are four rows of its site: those of the pin before, and those of the ground
    let (ours, others) = (bars.reactions(&state)?, unrolled.reactions(&other)?);
    let rows = [ours[0][0], ours[0][1], ours[1][0], ours[1][1], ours[2][0], ours[2][1], ours[2][2], ours[2][3]];
    let far = (SVector::from(rows) - others).norm();
    assert!(far < 1e-8 * others.norm(), "{far:e}");
    Ok(())
}

type Beads = [Vector2<f64>; 6];

/// One rod for each bead, and then the strut.
const RODS: [(usize, Option<usize>); 7] =
    [(0, None), (1, Some(0)), (2, Some(1)), (3, Some(2)), (4, Some(3)), (5, Some(4)), (5, Some(1))];

/// The rows of a rope whose first bead stays at the origin, with its two coordinates for the first rod.
fn rows(x: &Beads, rods: &[(usize, Option<usize>)]) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(rods.len() + 1, 12);
    (rows[(0, 0)], rows[(1, 1)]) = (1.0, 1.0);
    for (i, &(a, b)) in rods.iter().enumerate().skip(1) {
        // by construction: all rods but the first one have two ends
        let b = b.expect("a rod with two ends");
        let along = 2.0 * (x[a] - x[b]);
        for k in 0..2 {
            rows[(i + 1, 2 * a + k)] = along[k];
            rows[(i + 1, 2 * b + k)] = -along[k];
        }
    }
    rows
}

/// Beads 1, 4, 5 are on a kite whose long rod is the strut.
fn places() -> (Beads, f64) {
    let down = |from: Vector2<f64>, angle: f64| from + Vector2::new(angle.sin(), -angle.cos());
    let mut x = [Vector2::zeros(); 6];
    for (i, angle) in [0.3, -0.4, 0.9, 2.0, 2.4].into_iter().enumerate() {
        x[i + 1] = down(x[i], angle);
    }
    (x, (x[5] - x[1]).norm())
}

/// The continuous multipliers of beads of equal masses, with a dense matrix.
fn multipliers(x: &Beads, v: &Beads, rods: &[(usize, Option<usize>)]) -> DVector<f64> {
    let rows = rows(x, rods);
    let weight = DVector::from_fn(12, |i, _| if i % 2 == 1 { -9.81 } else { 0.0 });
    let bend = |&(a, b): &(usize, Option<usize>)| b.map(|b| 2.0 * (v[a] - v[b]).norm_squared());
    let bend = DVector::from_iterator(rods.len() + 1, [0.0, 0.0].into_iter().chain(rods.iter().filter_map(bend)));
    // of masses of 1 kg: A Aᵀλ = −φ″ − A f
    (&rows * rows.transpose()).lu().solve(&-(bend + &rows * weight)).expect("a regular matrix")
}

#[test]
fn a_strut_between_the_last_site_and_the_second_closes_a_loop() -> Result<(), Error> {
    let (places, strut) = places();
    let stepper = Braced::<f64, 6> { mass: 1.0, strut }.into_stepper(0.001)?;
    let start = stepper.project(places, [Vector2::new(0.3, -0.2); 6])?;
    let late = stepper.advance(&start, 200)?;
    let (x, v) = (late.configuration(), late.momentum());
    for &(a, b) in &RODS[1..] {
        // by construction: all rods but the first one have two ends
        let length = (x[a] - x[b.expect("a rod with two ends")]).norm();
        let expected = if (a, b) == (5, Some(1)) { strut } else { 1.0 };
        assert!((length - expected).abs() < 1e-14, "{a}: {length}");
    }
    assert!((stepper.energy(&late) - stepper.energy(&start)).abs() < 1e-3);
    let (joints, loops) = stepper.reactions(&late)?;
    let expected = multipliers(x, &v, &RODS);
    let ours = joints.iter().enumerate().flat_map(|(i, rows)| rows.iter().copied().take(if i == 0 { 2 } else { 1 }));
    let ours = DVector::from_iterator(8, ours.chain([loops.x]));
    assert!((&ours - &expected).norm() < 1e-11 * expected.norm(), "{ours} {expected}");

    // in storage: the same bits, from velocities too
    let storage = SiteStorage::of(places.to_vec(), vec![Vector2::zeros(); 6]);
    let mut sites = stepper.clone().joined_sites_moving(storage, vec![stepper.joint(); 6])?;
    let from_rest = stepper.advance(&stepper.state(places, [Vector2::zeros(); 6])?, 50)?;
    sites.advance(50)?;
    assert_eq!(sites.configuration(), from_rest.configuration());
    let mut rods = vec![Vector2::zeros(); 6];
    let struts: Vector1<f64> = sites.reactions(&mut rods)?;
    assert_eq!((<[_; 6]>::try_from(rods).ok(), struts), stepper.reactions(&from_rest).map(|(a, b)| (Some(a), b))?);
    let refused = sites.reactions(&mut [Vector2::zeros(); 5]).map_err(|error| error.error);
    assert_eq!(refused, Err(Error::NumberOfSites { found: 5, sites: 6 }));
    // the reactions took room, and no state: the next step is the same
    sites.step()?;
    assert_eq!(sites.configuration(), stepper.step(&from_rest)?.configuration());
    Ok(())
}

/// Four braced ropes, with struts of their own in the lanes of one.
#[test]
fn loops_in_lanes_are_loops_alone() -> Result<(), Error> {
    let (places, strut) = places();
    let scales = [1.0, 0.9, 1.05, 0.95];
    let alone = scales.map(|scale| Braced::<f64, 6> { mass: 0.5, strut: strut * scale });
    let mut ends = Vec::new();
    for rope in &alone {
        let stepper = rope.stepper(0.01)?;
        let start = stepper.project(places, [Vector2::zeros(); 6])?;
        ends.push((stepper.advance(&start, 60)?, stepper.reactions(&start)?));
    }
    let number = F64x4::from;
    let all = Braced::<F64x4, 6> { mass: number([0.5; 4]), strut: number(scales.map(|scale| strut * scale)) };
    let stepper = all.into_stepper(number([0.01; 4]))?;
    let wide = places.map(|place| place.map(|x| number([x; 4])));
    let start = stepper.project(wide, [Vector2::repeat(number([0.0; 4])); 6])?;
    let (joints, loops) = stepper.reactions(&start)?;
    let end = stepper.advance(&start, 60)?;
    for (lane, (alone, (joints_alone, loops_alone))) in ends.iter().enumerate() {
        for (one, other) in end.configuration().iter().zip(alone.configuration()) {
            let far = (one.map(|x| x.lane(lane)) - other).norm();
            assert!(far < 1e-11, "lane {lane}: {far:e}");
        }
        for (one, other) in joints.iter().zip(joints_alone) {
            assert!((one.map(|x| x.lane(lane)) - other).norm() < 1e-10, "lane {lane}");
        }
        assert!((loops.x.lane(lane) - loops_alone.x).abs() < 1e-10, "lane {lane}");
    }
    Ok(())
}

#[test]
fn the_last_site_may_hang_from_any() -> Result<(), Error> {
    let (mut places, _) = places();
    places.iter_mut().for_each(|x| x.y -= 1.0);
    places[5] = places[1] + Vector2::new(1.0, -1.0);
    let stepper = Forked::<6>.into_stepper(0.001)?;
    let start = stepper.state(places, [Vector2::zeros(); 6])?;
    let late = stepper.advance(&start, 300)?;
    let x = late.configuration();
    assert!(((x[5] - x[1]).norm_squared() - 2.0).abs() < 1e-13);
    assert!((1..5).all(|i| ((x[i] - x[i - 1]).norm() - 1.0).abs() < 1e-14));
    assert!((stepper.energy(&late) - stepper.energy(&start)).abs() < 1e-3);
    // the site has one row, as all others have
    let pulls: [Vector1<f64>; 6] = stepper.reactions(&late)?;
    assert!(pulls.iter().all(|pull| pull.x < 0.0), "{pulls:?}");
    Ok(())
}

/// Sites in storage go on from the factors of the last step, if there are any: after errors and reactions there are none.
#[test]
fn sites_step_to_the_same_bits_after_errors_and_reactions() -> Result<(), Error> {
    let places: Beads = places().0;
    let stepper = Blown::<6> { swing: 0.1 }.into_stepper(0.003)?;
    let hand = [Vector2::x() * 0.1; 6];
    let mut state = stepper.state_moving(places, hand)?;
    let storage = SiteStorage::of(places.to_vec(), hand.to_vec());
    let mut sites = stepper.clone().joined_sites_moving(storage, vec![stepper.joint(); 6])?;
    let breeze = Vector2::new(0.5, 0.1);
    let mut errors = 0;
    for step in 0..60 {
        for size in (0..40).map(|number| 10.0_f64.powf(f64::from(number) / 4.0)).filter(|_| step % 20 == 10) {
            let (mut blown, gale) = (sites.clone(), Vector2::repeat(size));
            if blown.step_with(&gale).is_err() {
                errors += 1;
                blown.step_with(&breeze)?;
                let next = stepper.step_with(&state, &breeze)?;
                assert_eq!(blown.configuration(), next.configuration(), "step {step}, gale {size}");
            }
        }
        if step % 11 == 5 {
            let mut rods = [Vector2::zeros(); 6];
            sites.reactions_under(&breeze, &mut rods)?;
            assert_eq!(rods, stepper.reactions_under(&state, &breeze)?, "step {step}");
        }
        state = stepper.step_with(&state, &breeze)?;
        sites.step_with(&breeze)?;
        assert_eq!(sites.configuration(), state.configuration(), "step {step}");
        assert_eq!(sites.momentum(), state.momentum(), "step {step}");
    }
    assert!(errors > 20, "{errors}");
    Ok(())
}
