//! Trees of joints: against the same bodies unrolled, against RATTLE with a dense matrix, and by statics and conserved
//! momenta.

use clebsch::{Clebsch, Drive, Error, SiteStorage};
use clebsch_tests::fixtures::branching_bodies::BranchingBodies;
use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, Rotation3, Vector2, Vector3, Vector6};

mod declared {
    use clebsch::Clebsch;
    use nalgebra::Vector2;

    /// Bodies in the plane that all hang from the first one.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<2>; N], q: [SE<2>; N]| (0..N).map(|i| q[i] * F[i]),
        lagrangian = |xi| (0..N).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2).sum(),
        potential  = |q| (0..N).map(|i| self.mass[i] * q[i].translation().y).sum(),
        constraint = |t, q| [
            q[0].translation() == Vector2::new(self.speed * t, 0),
            (1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[0].rotation() * self.arms[i] + q[0].translation()),
        ],
    )]
    pub struct Hands<const N: usize> {
        pub inertia: [f64; N],
        pub mass: [f64; N],
        pub speed: f64,
        pub near: Vector2<f64>,
        pub arms: [Vector2<f64>; N],
    }

    /// Three of them, unrolled.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<2>; 3], q: [SE<2>; 3]| (0..3).map(|i| q[i] * F[i]),
        lagrangian = |xi| (0..3).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2).sum(),
        potential  = |q| (0..3).map(|i| self.mass[i] * q[i].translation().y).sum(),
        constraint = |t, q| [
            q[0].translation() == Vector2::new(self.speed * t, 0),
            q[1].rotation() * self.near + q[1].translation() == q[0].rotation() * self.arms[1] + q[0].translation(),
            q[2].rotation() * self.near + q[2].translation() == q[0].rotation() * self.arms[2] + q[0].translation(),
        ],
    )]
    pub struct ThreeHands {
        pub inertia: [f64; 3],
        pub mass: [f64; 3],
        pub speed: f64,
        pub near: Vector2<f64>,
        pub arms: [Vector2<f64>; 3],
    }

    /// Beads on rods: a tree whose first bead swings from the origin. The last bead slides on a track, which closes a loop.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| self.mass[i] * x[i].y + x[i].norm_squared().powi(2) / 4).sum(),
        constraint = |x| [
            x[0].norm_squared() == 1,
            (1..4).map(|i| (x[i] - x[0]).norm_squared() == 1),
            (x[4] - x[2]).norm_squared() == 1,
            (5..7).map(|i| (x[i] - x[i - 2]).norm_squared() == 1),
            x[6].y == self.track,
        ],
    )]
    pub struct Mobile<const N: usize> {
        pub mass: [f64; N],
        pub track: f64,
    }
}

use declared::{Hands, Mobile, ThreeHands};

fn flat(angle: f64, place: Vector2<f64>) -> Matrix3<f64> {
    Matrix3::new(angle.cos(), -angle.sin(), place.x, angle.sin(), angle.cos(), place.y, 0.0, 0.0, 1.0)
}

#[test]
fn three_bodies_of_a_tree_are_the_same_unrolled() -> Result<(), Error> {
    let (inertia, mass, speed, near) = ([0.2, 0.3, 0.1], [1.0, 0.7, 0.4], 0.3, Vector2::new(0.5, 0.1));
    let arms = [Vector2::zeros(), Vector2::new(0.6, 0.0), Vector2::new(-0.4, 0.2)];
    let tree = Hands { inertia, mass, speed, near, arms }.into_stepper(0.02)?;
    let unrolled = ThreeHands { inertia, mass, speed, near, arms }.into_stepper(0.02)?;
    let angles = [0.4f64, -1.9, 1.2];
    let places = std::array::from_fn(|i| {
        let turn = |angle: f64, x: Vector2<f64>| nalgebra::Rotation2::new(angle) * x;
        flat(angles[i], if i == 0 { Vector2::zeros() } else { turn(angles[0], arms[i]) - turn(angles[i], near) })
    });
    let mut one = tree.project(places, [Vector3::new(0.3, -0.2, 0.5); 3])?;
    let stacked = |parts: [Vector3<f64>; 3]| nalgebra::SVector::<f64, 9>::from_fn(|i, _| parts[i / 3][i % 3]);
    let mut other = unrolled.state(*one.configuration(), stacked(one.momentum()))?;
    for step in 0..200 {
        let (next, pushes) = tree.step_with_reactions(&one)?;
        let (other_next, other_pushes) = unrolled.step_with_reactions(&other)?;
        (one, other) = (next, other_next);
        let pushes = Vector6::from_fn(|i, _| pushes[i / 2][i % 2]);
        assert!((pushes - other_pushes).norm() < 1e-10, "step {step}: {pushes} {other_pushes}");
        let far =
            one.configuration().iter().zip(other.configuration()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far < 1e-12, "step {step}: {far:e}");
        let far = (stacked(one.momentum()) - other.momentum()).norm();
        assert!(far < 1e-12, "step {step}: {far:e}");
        let (reactions, others) = (tree.reactions(&one)?, unrolled.reactions(&other)?);
        let reactions = Vector6::from_fn(|i, _| reactions[i / 2][i % 2]);
        assert!((reactions - others).norm() < 1e-11, "step {step}: {reactions} {others}");
    }
    Ok(())
}

/// The ends of the rods of a [`Mobile`]: the first has one end at the origin.
const RODS: [(usize, Option<usize>); 7] =
    [(0, None), (1, Some(0)), (2, Some(0)), (3, Some(0)), (4, Some(2)), (5, Some(3)), (6, Some(4))];

/// φ of the rods and of the track.
fn rods(x: &[Vector2<f64>; 7], track: f64) -> DVector<f64> {
    let mut all: Vec<f64> =
        RODS.iter().map(|&(a, b)| (x[a] - b.map_or(Vector2::zeros(), |b| x[b])).norm_squared() - 1.0).collect();
    all.push(x[6].y - track);
    DVector::from_vec(all)
}

/// Their rows.
fn rows(x: &[Vector2<f64>; 7]) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(8, 14);
    for (i, &(a, b)) in RODS.iter().enumerate() {
        let along = 2.0 * (x[a] - b.map_or(Vector2::zeros(), |b| x[b]));
        for k in 0..2 {
            rows[(i, 2 * a + k)] = along[k];
            if let Some(b) = b {
                rows[(i, 2 * b + k)] = -along[k];
            }
        }
    }
    rows[(7, 13)] = 1.0;
    rows
}

/// One step of RATTLE, with a dense Newton method for the multipliers.
fn rattle(mobile: &Mobile<7>, h: f64, x: &mut [Vector2<f64>; 7], p: &mut [Vector2<f64>; 7]) {
    let mass = |i: usize| mobile.mass[i];
    let force = |x: &[Vector2<f64>; 7]| -> [Vector2<f64>; 7] {
        std::array::from_fn(|i| -Vector2::y() * mass(i) - x[i] * x[i].norm_squared())
    };
    let masses = DMatrix::from_fn(14, 14, |i, j| if i == j { 1.0 / mass(i / 2) } else { 0.0 });
    let push = |p: &[Vector2<f64>; 7], by: &DVector<f64>| -> [Vector2<f64>; 7] {
        std::array::from_fn(|i| p[i] + Vector2::new(by[2 * i], by[2 * i + 1]))
    };
    let (start, f) = (rows(x), force(x));
    let half: [Vector2<f64>; 7] = std::array::from_fn(|i| p[i] + f[i] * (h / 2.0));
    let mut multipliers = DVector::zeros(8);
    let drift = |multipliers: &DVector<f64>| -> ([Vector2<f64>; 7], [Vector2<f64>; 7]) {
        let moved = push(&half, &(start.transpose() * multipliers));
        (std::array::from_fn(|i| x[i] + moved[i] * (h / mass(i))), moved)
    };
    for _ in 0..30 {
        let (next, _) = drift(&multipliers);
        let slope = rows(&next) * &masses * start.transpose() * h;
        multipliers -= slope.lu().solve(&rods(&next, mobile.track)).expect("a regular matrix");
    }
    let (next, moved) = drift(&multipliers);
    let f = force(&next);
    let free: [Vector2<f64>; 7] = std::array::from_fn(|i| moved[i] + f[i] * (h / 2.0));
    let end = rows(&next);
    let velocity = &masses * DVector::from_fn(14, |i, _| free[i / 2][i % 2]);
    let back = (&end * &masses * end.transpose()).lu().solve(&(&end * velocity)).expect("a regular matrix");
    (*x, *p) = (next, push(&free, &-(end.transpose() * back)));
}

#[test]
fn beads_of_a_tree_step_by_rattle() -> Result<(), Error> {
    let at = |from: Vector2<f64>, angle: f64| from + Vector2::new(angle.sin(), -angle.cos());
    let root = at(Vector2::zeros(), 0.2);
    let (a, b, c) = (at(root, -0.9), at(root, 0.1), at(root, 1.1));
    let (d, e) = (at(b, 0.5), at(c, 0.3));
    let places = [root, a, b, c, d, e, at(d, -0.4)];
    let mobile = Mobile { mass: [0.5, 0.4, 0.7, 0.3, 0.2, 0.6, 0.4], track: places[6].y };
    let stepper = mobile.stepper(0.01)?;
    let mut state = stepper.project(places, [Vector2::new(0.1, 0.05); 7])?;
    let (mut x, mut p) = (*state.configuration(), state.momentum());
    assert!((rows(&x) * DVector::from_fn(14, |i, _| p[i / 2][i % 2] / mobile.mass[i / 2])).amax() < 1e-14);
    // rounding errors grow as changes of the start do, and are compared with one of 10⁻¹⁴
    let (mut near, mut pushed) = (x, p.map(|p| p * (1.0 + 1e-14)));
    let mut growth = 0.0_f64;
    for step in 0..crate::long(300) {
        state = stepper.step(&state)?;
        rattle(&mobile, 0.01, &mut x, &mut p);
        rattle(&mobile, 0.01, &mut near, &mut pushed);
        let apart = |q: &[Vector2<f64>; 7], n: &[Vector2<f64>; 7]| {
            (0..7).map(|i| (q[i] - x[i]).norm() + (n[i] - p[i]).norm()).fold(0.0, f64::max)
        };
        growth = growth.max(apart(&near, &pushed));
        let far = apart(state.configuration(), &state.momentum());
        assert!(far < 1e-14 + 40.0 * growth, "step {step}: {far:e}, where a change of 1e-14 is {growth:e}");
    }
    assert!(rods(state.configuration(), mobile.track).amax() < 1e-14);
    Ok(())
}

const PARENTS: [usize; 7] = [0, 0, 0, 1, 1, 2, 5];

fn point(q: &Matrix4<f64>, of_body: Vector3<f64>) -> Vector3<f64> {
    q.transform_point(&of_body.into()).coords
}

/// The joint of a body in the frame of its parent.
fn arm(bodies: &BranchingBodies<7>, body: usize) -> Vector3<f64> {
    if body == 2 || body == 5 { bodies.side } else { bodies.far }
}

/// Bodies that hang from each other, turned by these vectors.
fn hanging(turns: [Vector3<f64>; 7]) -> (BranchingBodies<7>, [Matrix4<f64>; 7]) {
    let (near, far, side) =
        (Vector3::new(0.0, 0.0, 0.15), Vector3::new(0.2, 0.05, -0.15), Vector3::new(-0.3, 0.1, -0.1));
    let second_moment = Matrix3::from_diagonal(&Vector3::new(2e-3, 3e-3, 4e-3));
    let bodies = BranchingBodies { second_moment, mass: 0.5, weight: 4.905, near, far, side };
    let mut places = [Matrix4::identity(); 7];
    for i in 0..7 {
        let joint = if i == 0 { Vector3::zeros() } else { point(&places[PARENTS[i]], arm(&bodies, i)) };
        let turn = Rotation3::new(turns[i]);
        places[i] = turn.to_homogeneous();
        places[i].fixed_view_mut::<3, 1>(0, 3).copy_from(&(joint - turn * near));
    }
    (bodies, places)
}

fn swung() -> [Vector3<f64>; 7] {
    std::array::from_fn(|i| Vector3::new(0.3 * (i as f64).sin(), 0.8 - 0.2 * i as f64, 0.1 * i as f64))
}

#[test]
fn bodies_of_a_tree_stay_together_and_are_time_symmetric() -> Result<(), Error> {
    let (bodies, places) = hanging(swung());
    let band = |h: f64, steps: usize| -> Result<f64, Error> {
        let stepper = bodies.stepper(h)?;
        let start = stepper.state(places, [Vector6::zeros(); 7])?;
        let (mut state, mut band) = (start, 0.0_f64);
        for _ in 0..steps {
            state = stepper.step(&state)?;
            band = band.max((stepper.energy(&state) - stepper.energy(&start)).abs());
        }
        let q = state.configuration();
        for i in 1..7 {
            let open = (point(&q[i], bodies.near) - point(&q[PARENTS[i]], arm(&bodies, i))).norm();
            assert!(open < 1e-14, "body {i} by {open:e}");
        }
        let back = bodies.stepper(-h)?;
        let end = back.advance(&back.state(*q, state.momentum())?, steps)?;
        let far = end.configuration().iter().zip(&places).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far < 1e-9, "{far:e}");
        Ok(band)
    };
    let ratio = band(0.002, crate::long(200))? / band(0.001, crate::long(400))?;
    assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
    Ok(())
}

/// A tree that hangs at rest: each joint carries the weights of all bodies below it.
#[test]
fn joints_of_a_tree_carry_the_weights_below() -> Result<(), Error> {
    let (mut bodies, _) = hanging([Vector3::zeros(); 7]);
    // balanced: each body hangs with its joints above each other
    bodies.far = Vector3::new(0.0, 0.0, -0.15);
    bodies.side = bodies.far;
    let mut places = [Matrix4::identity(); 7];
    for i in 0..7 {
        let joint = if i == 0 { Vector3::zeros() } else { point(&places[PARENTS[i]], arm(&bodies, i)) };
        places[i].fixed_view_mut::<3, 1>(0, 3).copy_from(&(joint - bodies.near));
    }
    let stepper = bodies.stepper(0.01)?;
    let start = stepper.state(places, [Vector6::zeros(); 7])?;
    let (next, pushes) = stepper.step_with_reactions(&start)?;
    let reactions = stepper.reactions(&next)?;
    let below = [7.0, 3.0, 3.0, 1.0, 1.0, 2.0, 1.0];
    for i in 0..7 {
        let weight = Vector3::z() * bodies.weight * below[i];
        assert!((pushes[i] - weight).norm() < 1e-11 && (reactions[i] - weight).norm() < 1e-11, "{i}: {}", pushes[i]);
    }
    Ok(())
}

#[test]
fn trees_are_states_in_storage() -> Result<(), Error> {
    let (bodies, places) = hanging(swung());
    let stepper = bodies.into_stepper(0.005)?;
    let start = stepper.state(places, [Vector6::zeros(); 7])?;
    let storage = SiteStorage::of(places.to_vec(), vec![Vector6::zeros(); 7]);
    let mut sites = stepper.clone().joined_sites(storage, vec![stepper.joint(); 7])?;
    sites.advance(100)?;
    let end = stepper.advance(&start, 100)?;
    let (places, momenta) = sites.state();
    assert_eq!((places, momenta), (&end.configuration()[..], &end.momentum()[..]));
    Ok(())
}

#[test]
fn a_site_that_follows_from_others_is_refused() -> Result<(), Error> {
    // the track and the rods of a stretched tree: the last bead hangs straight below, where the track pulls along no rod
    let down = |n: f64| Vector2::new(0.0, -n);
    let places = [down(1.0), down(2.0), down(2.0), down(2.0), down(3.0), down(3.0), down(4.0)];
    let mobile = Mobile { mass: [1.0; 7], track: -4.0 };
    let error = mobile.stepper(0.01)?.state(places, [Vector2::zeros(); 7]).unwrap_err();
    assert_eq!(error, Error::DependentConstraints { rank: 7, rows: 8 });
    Ok(())
}
