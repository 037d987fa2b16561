//! Joints between the sites of a power: chains, rings and moving ends, against the same systems unrolled, and against
//! RATTLE with a dense matrix.

use clebsch::{Clebsch, Error, F64x4, Scalar, SiteStorage, Space, Stepper};
use clebsch_tests::fixtures::{hanging_chain::HangingChain, jointed_bodies::JointedBodies};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix4, Rotation3, SVector, Vector1, Vector2, Vector3, Vector6};

mod declared {
    use clebsch::Clebsch;

    /// Links that differ, each with its own joints.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
        cost       = |h, F| (0..N).map(|i| {
            let turn = F[i].rotation() - I;
            ((turn * self.second_moments[i] * turn.transpose()).trace() + self.mass[i] * F[i].translation().norm_squared()) / (2 * h)
        }).sum(),
        potential  = |q| (0..N).map(|i| self.gravity * self.mass[i] * q[i].translation().z).sum(),
        constraint = |q| [
            q[0].rotation() * self.near[0] + q[0].translation() == Vector3::zeros(),
            (0..N - 1).map(|i| q[i + 1].rotation() * self.near[i + 1] + q[i + 1].translation() == q[i].rotation() * self.far[i] + q[i].translation()),
        ],
    )]
    pub struct Links<const N: usize> {
        #[clebsch(symmetric)]
        pub second_moments: [nalgebra::Matrix3<f64>; N],
        pub mass: [f64; N],
        pub gravity: f64,
        pub near: [nalgebra::Vector3<f64>; N],
        pub far: [nalgebra::Vector3<f64>; N],
    }

    /// Beads on rods. A hand moves the first one.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| self.mass * v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| self.mass * self.gravity * x[i].z).sum(),
        constraint = |t, x| [
            x[0] == self.swing * t.sin() * Vector3::x(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == self.rod.powi(2)),
        ],
        force      = |v| (0..N).map(|i| -self.drag * v[i]),
    )]
    pub struct Rope<T, const N: usize> {
        pub mass: T,
        pub gravity: T,
        pub rod: T,
        pub swing: T,
        pub drag: T,
    }

    /// The same, unrolled.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<3>; 4], x: [Vector3; 4]| (0..4).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..4).map(|i| self.mass * v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..4).map(|i| self.mass * self.gravity * x[i].z).sum(),
        constraint = |t, x| [
            x[0] == self.swing * t.sin() * Vector3::x(),
            (x[1] - x[0]).norm_squared() == self.rod.powi(2),
            (x[2] - x[1]).norm_squared() == self.rod.powi(2),
            (x[3] - x[2]).norm_squared() == self.rod.powi(2),
        ],
        force      = |v| (0..4).map(|i| -self.drag * v[i]),
        code       = unrolled,
    )]
    pub struct FourBeads {
        pub mass: f64,
        pub gravity: f64,
        pub rod: f64,
        pub swing: f64,
        pub drag: f64,
    }

    /// A necklace on a table that is tilted: a ring of rods in the plane z = 0.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| self.mass[i] * v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| self.mass[i] * x[i].dot(&self.slope) + x[i].norm_squared().powi(2)).sum(),
        constraint = |x| [
            (0..N).map(|i| (x[(i + 1) % N] - x[i]).norm_squared() == self.rod.powi(2)),
            (0..N).map(|i| x[i].z == 0),
        ],
        order      = 4,
    )]
    pub struct Necklace<const N: usize> {
        pub mass: [f64; N],
        pub slope: nalgebra::Vector3<f64>,
        pub rod: f64,
    }

    /// A chain of rods in the plane whose ends are fixed, without a potential.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
        constraint = |x| [
            x[0] == Vector2::zeros(),
            (0..N - 1).map(|i| (x[i + 1] - x[i]).norm_squared() == 1),
            x[N - 1] == self.end,
        ],
    )]
    pub struct Bridge<const N: usize> {
        pub end: nalgebra::Vector2<f64>,
    }

    /// Links that fly.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
        cost       = |h, F| (0..N).map(|i| ((F[i] - I) * self.mass_matrix * (F[i] - I).transpose()).trace() / (2 * h)).sum(),
        constraint = |q| [(1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation())],
    )]
    pub struct Flying<const N: usize> {
        #[clebsch(symmetric)]
        pub mass_matrix: nalgebra::Matrix4<f64>,
        pub near: nalgebra::Vector3<f64>,
        pub far: nalgebra::Vector3<f64>,
    }

    /// The same by quaternions, whose cost has one scalar unknown.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |F: [(Translation<3>, SU<2>); N], q: [(Vector3, SU<2>); N]| (0..N).map(|i| (q[i].0 + F[i].0, q[i].1 * F[i].1)),
        cost       = |h, F| (0..N).map(|i| {
            let turn = F[i].1.imag();
            (self.mass * F[i].0.norm_squared() + 4 * turn.dot(&(self.inertia * turn))) / (2 * h)
        }).sum(),
        potential  = |q| (0..N).map(|i| q[i].0.z * i).sum(),
        constraint = |q| [(1..N).map(|i| q[i].0 + q[i].1 * self.arm == q[i - 1].0 - q[i - 1].1 * self.arm)],
    )]
    pub struct Turning<const N: usize> {
        pub mass: f64,
        #[clebsch(symmetric)]
        pub inertia: nalgebra::Matrix3<f64>,
        pub arm: nalgebra::Vector3<f64>,
    }

    macro_rules! written {
        ($($name:ident $constraint:expr)*) => { $(
            /// Beads on rods that stay in their plane.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
                lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
                potential  = |x| (0..N).map(|i| x[i].x).sum(),
                constraint = $constraint,
            )]
            pub struct $name<const N: usize>;
        )* };
    }
    written! {
        OneByOne |x| [
            x[0] == Vector3::zeros(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
            (1..N).map(|i| x[i].z == x[i - 1].z),
        ]
        InLists |x| [
            x[0] == Vector3::zeros(),
            (1..N).map(|i| {
                let gap = x[i] - x[i - 1];
                [gap.norm_squared() == 1, gap.z == 0]
            }),
        ]
        InRanges |x| [
            x[0] == Vector3::zeros(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
            (1..N).map(|i| (2..3).map(|k| x[i][k] == x[i - 1][k])),
        ]
    }

    macro_rules! orders {
        ($($name:ident $order:literal)*) => { $(
            /// Beads on rods in a field that is not constant.
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
                lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
                potential  = |x| (0..N).map(|i| x[i].y + x[i].x.powi(4) / 4).sum(),
                constraint = |x| [x[0].norm_squared() == 1, (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1)],
                order      = $order,
            )]
            pub struct $name<const N: usize>;
        )* };
    }
    orders! { Second 2 Fourth 4 Sixth 6 Eighth 8 }
}

use declared::{
    Bridge, Eighth, Flying, FourBeads, Fourth, InLists, InRanges, Links, Necklace, OneByOne, Rope, Second, Sixth,
    Turning,
};

const NEAR: [Vector3<f64>; 2] = [Vector3::new(0.0, 0.0, 0.5), Vector3::new(0.0, 0.0, 0.4)];
const FAR: Vector3<f64> = Vector3::new(0.0, 0.0, -0.5);

fn placed(turn: Vector3<f64>, near: Vector3<f64>, joint: Vector3<f64>) -> Matrix4<f64> {
    let turn = *Rotation3::new(turn).matrix();
    let mut placed = turn.to_homogeneous();
    placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&(joint - turn * near));
    placed
}

fn at(q: &Matrix4<f64>, point: Vector3<f64>) -> Vector3<f64> {
    q.transform_point(&point.into()).coords
}

/// The reactions of two joints.
fn joined(reactions: &[Vector3<f64>; 2]) -> Vector6<f64> {
    Vector6::from_fn(|i, _| reactions[i / 3][i % 3])
}

/// The multipliers of the unrolled pair are found from its momentum equation, those of the chain by sweeps.
#[test]
fn a_chain_of_two_links_is_two_jointed_bodies() -> Result<(), Error> {
    let second_moments = [Vector3::new(0.09, 0.085, 0.01), Vector3::new(0.04, 0.038, 0.005)]
        .map(|moments| Matrix3::from_diagonal(&(-moments).add_scalar(moments.sum() / 2.0)));
    let (mass, gravity) = ([1.0, 0.7], 9.81);
    let pair = JointedBodies { second_moments, mass, gravity, near: NEAR, far: FAR }.into_stepper(0.02)?;
    let links = Links { second_moments, mass, gravity, near: NEAR, far: [FAR; 2] }.into_stepper(0.02)?;
    let first = placed(Vector3::new(0.6, 0.3, 0.1), NEAR[0], Vector3::zeros());
    let second = placed(Vector3::new(-0.4, 0.7, 0.2), NEAR[1], at(&first, FAR));
    let mut one = pair.project([first, second], SVector::<f64, 12>::from_fn(|i, _| 0.01 * (i as f64 - 5.0)))?;
    let momentum = one.momentum();
    let parts = [momentum.fixed_rows::<6>(0).into_owned(), momentum.fixed_rows::<6>(6).into_owned()];
    let mut other = links.state([first, second], parts)?;
    for step in 0..100 {
        let far = (pair.reactions(&one)? - joined(&links.reactions(&other)?)).norm();
        assert!(far < 1e-11, "reactions before step {step}: {far:e}");
        let ((next, pushes), (other_next, other_pushes)) =
            (pair.step_with_reactions(&one)?, links.step_with_reactions(&other)?);
        (one, other) = (next, other_next);
        let far = (pushes - joined(&other_pushes)).norm();
        assert!(far < 1e-10, "reactions of step {step}: {far:e}");
        let far = one.configuration().distance_squared(other.configuration()).sqrt();
        assert!(far < 1e-12, "step {step}: {far:e}");
        for i in 0..2 {
            let far = (one.momentum().fixed_rows::<6>(6 * i) - other.momentum()[i]).norm();
            assert!(far < 1e-12, "step {step}, link {i}: {far:e}");
        }
    }
    Ok(())
}

/// The places of beads on a zigzag from the origin.
fn zigzag<const N: usize>(rod: f64) -> [Vector3<f64>; N] {
    let mut place = Vector3::zeros();
    std::array::from_fn(|i| {
        if i > 0 {
            let (turn, lift) = (0.9 * i as f64, 0.4 * (i as f64).sin());
            place += Vector3::new(turn.cos() * lift.cos(), turn.sin() * lift.cos(), lift.sin()) * rod;
        }
        place
    })
}

/// A rope with a hand that moves, friction and weight: the same as four beads that are unrolled.
#[test]
fn a_rope_is_its_beads_unrolled() -> Result<(), Error> {
    let rope = Rope::<f64, 4> { mass: 0.3, gravity: 9.81, rod: 0.5, swing: 0.2, drag: 0.1 };
    let beads = FourBeads { mass: 0.3, gravity: 9.81, rod: 0.5, swing: 0.2, drag: 0.1 };
    let (rope, beads) = (rope.into_stepper(0.01)?, beads.into_stepper(0.01)?);
    let places = zigzag::<4>(0.5);
    // the hand moves at 0.2 m/s, and all beads with it
    let hand = Vector3::x() * 0.2;
    let mut one = rope.state_moving(places, [hand; 4])?;
    let mut other = beads.state_moving(places, SVector::<f64, 12>::from_fn(|i, _| hand[i % 3]))?;
    let storage = SiteStorage::of(places.to_vec(), vec![hand; 4]);
    let mut sites = rope.clone().joined_sites_moving(storage, vec![rope.joint(); 4])?;
    let mut in_storage = [Vector3::zeros(); 4];
    for step in 0..300 {
        // the three equations of the hand, and one of each rod
        let of_beads = |reactions: &[Vector3<f64>; 4]| {
            let [hand, first, second, third] = *reactions;
            Vector6::new(hand.x, hand.y, hand.z, first.x, second.x, third.x)
        };
        let far = (beads.reactions(&other)? - of_beads(&rope.reactions(&one)?)).norm();
        assert!(far < 1e-9, "reactions before step {step}: {far:e}");
        let ((next, pushes), (other_next, other_pushes)) =
            (rope.step_with_reactions(&one)?, beads.step_with_reactions(&other)?);
        (one, other) = (next, other_next);
        let far = (other_pushes - of_beads(&pushes)).norm();
        assert!(far < 1e-9, "reactions of step {step}: {far:e}");
        sites.step_with_reactions(&mut in_storage)?;
        let far = (other_pushes - of_beads(&in_storage)).norm();
        assert!(far < 1e-9, "reactions of step {step} in storage: {far:e}");
        assert_eq!((sites.configuration(), sites.momentum()), (&one.configuration()[..], &one.momentum()[..]));
        let far = one.configuration().distance_squared(other.configuration()).sqrt();
        assert!(far < 1e-11, "step {step}: {far:e}");
        let momentum: Vec<f64> = one.momentum().iter().flat_map(|n| n.iter().copied()).collect();
        let far = (other.momentum() - SVector::<f64, 12>::from_column_slice(&momentum)).norm();
        assert!(far < 1e-11, "step {step}: {far:e}");
    }
    let hand = one.configuration()[0] - Vector3::x() * 0.2 * one.time().sin();
    assert!(hand.norm() < 1e-15, "{hand}");
    Ok(())
}

/// Several equations for each index, in a list after a `let` or by a range of numbers, are those that are written one by one.
#[test]
fn equations_of_a_range_may_be_lists() -> Result<(), Error> {
    let places = std::array::from_fn::<_, 4, _>(|i| Vector3::new(0.6, 0.8, 0.0) * i as f64);
    let at_rest = [Vector3::zeros(); 4];
    let stepper = OneByOne::<4>.into_stepper(0.05)?;
    let expected = stepper.advance(&stepper.state(places, at_rest)?, 40)?;
    let ends: Vec<_> = expected.configuration().to_vec();
    assert!((ends[3] - places[3]).norm() > 0.1 && ends.iter().all(|x| x.z == 0.0), "{ends:?}");
    let listed = InLists::<4>.into_stepper(0.05)?;
    assert_eq!(listed.advance(&listed.state(places, at_rest)?, 40)?.configuration(), expected.configuration());
    let ranged = InRanges::<4>.into_stepper(0.05)?;
    assert_eq!(ranged.advance(&ranged.state(places, at_rest)?, 40)?.configuration(), expected.configuration());
    Ok(())
}

/// A composed step adds the impulses of its parts, in storage too.
#[test]
fn reactions_of_composed_steps_are_the_same_in_storage() -> Result<(), Error> {
    let stepper = Fourth::<5>.into_stepper(0.1)?;
    let places = std::array::from_fn(|i| Vector2::new(0.6, -0.8) * (i as f64 + 1.0));
    let mut state = stepper.state(places, [Vector2::zeros(); 5])?;
    let storage = SiteStorage::of(places.to_vec(), vec![Vector2::zeros(); 5]);
    let mut sites = stepper.clone().joined_sites(storage, vec![stepper.joint(); 5])?;
    let mut found = [Vector1::zeros(); 5];
    for step in 0..30 {
        let (next, expected) = stepper.step_with_reactions(&state)?;
        sites.step_with_reactions(&mut found)?;
        state = next;
        assert_eq!((sites.configuration(), sites.momentum()), (&state.configuration()[..], &state.momentum()[..]));
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).norm() < 1e-10 * (1.0 + expected.norm()), "step {step}: {found} {expected}");
        }
    }
    // too little room: the state is as before
    let refused = sites.step_with_reactions(&mut [Vector1::zeros(); 4]).map_err(|error| error.error);
    assert_eq!(refused, Err(Error::NumberOfSites { found: 4, sites: 5 }));
    assert_eq!((sites.configuration(), sites.steps()), (&state.configuration()[..], 30));
    Ok(())
}

#[test]
fn a_rope_in_single_precision_keeps_its_rods() -> Result<(), Error> {
    let rope = Rope::<f32, 9> { mass: 0.3, gravity: 9.81, rod: 0.5, swing: 0.2, drag: 0.1 }.into_stepper(0.005)?;
    let places = zigzag::<9>(0.5).map(|place| place.cast::<f32>());
    let mut state = rope.state_moving(places, [Vector3::x() * 0.2; 9])?;
    state = rope.advance(&state, if cfg!(feature = "heavy") { 2000 } else { 200 })?;
    // sweeps end at ε (1 + |x|) Σ|A| of φ, with |x| ≤ 4 and Σ|A| ≤ 2√3; a rod is longer by φ
    let most = f32::EPSILON * 5.0 * 2.0 * 3.0_f32.sqrt();
    for (a, b) in state.configuration().iter().zip(&state.configuration()[1..]) {
        assert!(((a - b).norm() - 0.5).abs() < most, "{}", (a - b).norm() - 0.5);
    }
    Ok(())
}

/// Four ropes with hands of their own, in the lanes of one: sweeps end where they end in all lanes.
#[test]
fn ropes_in_lanes_are_ropes_alone() -> Result<(), Error> {
    let number = F64x4::from;
    let swings = [0.2, 0.1, 0.0, -0.3];
    let rope = |swing: f64| Rope::<f64, 4> { mass: 0.3, gravity: 9.81, rod: 0.5, swing, drag: 0.1 };
    let (mass, gravity, rod, drag) = (number([0.3; 4]), number([9.81; 4]), number([0.5; 4]), number([0.1; 4]));
    let all = Rope::<F64x4, 4> { mass, gravity, rod, swing: number(swings), drag }.into_stepper(number([0.01; 4]))?;
    let places = zigzag::<4>(0.5);
    let wide = places.map(|place| place.map(|x| number([x; 4])));
    let hand = Vector3::new(number(swings), number([0.0; 4]), number([0.0; 4]));
    let end = all.advance(&all.state_moving(wide, [hand; 4])?, 100)?;
    for (lane, swing) in swings.into_iter().enumerate() {
        let stepper = rope(swing).into_stepper(0.01)?;
        let alone = stepper.advance(&stepper.state_moving(places, [Vector3::x() * swing; 4])?, 100)?;
        for (one, other) in end.configuration().iter().zip(alone.configuration()) {
            let far = (one.map(|x| x.lane(lane)) - other).norm();
            assert!(far < 1e-11, "lane {lane}: {far:e}");
        }
    }
    Ok(())
}

/// One step of RATTLE for beads on a ring of rods in the plane, with a dense Newton method for the multipliers.
fn rattle(necklace: &Necklace<5>, h: f64, x: &mut [Vector2<f64>; 5], p: &mut [Vector2<f64>; 5]) {
    let force = |x: &[Vector2<f64>; 5]| -> [Vector2<f64>; 5] {
        std::array::from_fn(|i| -necklace.slope.xy() * necklace.mass[i] - x[i] * (4.0 * x[i].norm_squared()))
    };
    let rods = |x: &[Vector2<f64>; 5]| {
        DVector::from_fn(5, |i, _| (x[(i + 1) % 5] - x[i]).norm_squared() - necklace.rod * necklace.rod)
    };
    let rows = |x: &[Vector2<f64>; 5]| {
        let mut rows = DMatrix::zeros(5, 10);
        for i in 0..5 {
            let along = 2.0 * (x[(i + 1) % 5] - x[i]);
            for k in 0..2 {
                rows[(i, 2 * ((i + 1) % 5) + k)] += along[k];
                rows[(i, 2 * i + k)] -= along[k];
            }
        }
        rows
    };
    let masses = DMatrix::from_fn(10, 10, |i, j| if i == j { 1.0 / necklace.mass[i / 2] } else { 0.0 });
    let push = |p: &[Vector2<f64>; 5], by: &DVector<f64>| -> [Vector2<f64>; 5] {
        std::array::from_fn(|i| p[i] + Vector2::new(by[2 * i], by[2 * i + 1]))
    };
    let start = rows(x);
    let f = force(x);
    let half: [Vector2<f64>; 5] = std::array::from_fn(|i| p[i] + f[i] * (h / 2.0));
    let mut multipliers = DVector::zeros(5);
    for _ in 0..30 {
        let moved = push(&half, &(start.transpose() * &multipliers));
        let next: [Vector2<f64>; 5] = std::array::from_fn(|i| x[i] + moved[i] * (h / necklace.mass[i]));
        let slope = rows(&next) * &masses * start.transpose() * h;
        multipliers -= slope.lu().solve(&rods(&next)).expect("a regular matrix");
    }
    let moved = push(&half, &(start.transpose() * &multipliers));
    *x = std::array::from_fn(|i| x[i] + moved[i] * (h / necklace.mass[i]));
    let f = force(x);
    let p_free: [Vector2<f64>; 5] = std::array::from_fn(|i| moved[i] + f[i] * (h / 2.0));
    let end = rows(x);
    let velocity = &masses * DVector::from_fn(10, |i, _| p_free[i / 2][i % 2]);
    let back = (&end * &masses * end.transpose()).lu().solve(&(&end * velocity)).expect("a regular matrix");
    *p = push(&p_free, &-(end.transpose() * back));
}

/// A ring has one more block in each corner; its plane is a second row of each site. The steps are those of Suzuki.
#[test]
fn a_necklace_on_a_table_steps_by_rattle() -> Result<(), Error> {
    let necklace = Necklace { mass: [0.3, 0.4, 0.5, 0.6, 0.2], slope: Vector3::new(0.2, -0.1, 0.0), rod: 1.1 };
    let stepper = necklace.stepper(0.02)?;
    let radius = 1.1 / (2.0 * (std::f64::consts::PI / 5.0).sin());
    let corner = |i: usize| Rotation3::new(Vector3::z() * (i as f64 * std::f64::consts::TAU / 5.0));
    let places: [Vector3<f64>; 5] = std::array::from_fn(|i| corner(i) * Vector3::x() * radius);
    let mut state = stepper.project(places, [Vector3::new(0.1, 0.05, 0.3); 5])?;
    let (momentum, places) = (state.momentum(), *state.configuration());
    let (mut x, mut p) = (places.map(|x| x.xy()), momentum.map(|p| p.xy()));
    assert!(momentum.iter().all(|p| p.z.abs() < 1e-15), "{momentum:?}");
    let gamma = 1.0 / (4.0 - 4.0_f64.cbrt());
    for step in 0..if cfg!(feature = "heavy") { 200 } else { 50 } {
        state = stepper.step(&state)?;
        for size in [gamma, gamma, 1.0 - 4.0 * gamma, gamma, gamma] {
            rattle(&necklace, size * 0.02, &mut x, &mut p);
        }
        for i in 0..5 {
            let far = (state.configuration()[i].xy() - x[i]).norm() + (state.momentum()[i].xy() - p[i]).norm();
            assert!(far < 1e-11, "step {step}, bead {i}: {far:e}");
            assert!(state.configuration()[i].z.abs() < 1e-15, "{}", state.configuration()[i]);
        }
    }
    Ok(())
}

/// Both ends are fixed: the last site has the rows of its rod and of its end.
#[test]
fn a_bridge_keeps_both_ends_and_its_energy() -> Result<(), Error> {
    // half a regular hexagon
    let (rise, half) = (0.75_f64.sqrt(), 0.5);
    let places = [Vector2::zeros(), Vector2::new(half, rise), Vector2::new(1.0 + half, rise), Vector2::new(2.0, 0.0)];
    let stepper = Bridge::<4> { end: places[3] }.into_stepper(0.01)?;
    let start = stepper.project(places, [Vector2::x(); 4])?;
    let energy = stepper.energy(&start);
    assert!(energy > 0.5, "{energy}");
    let mut state = start;
    for _ in 0..100 {
        state = stepper.advance(&state, 10)?;
        let x = state.configuration();
        assert!(x[0].norm() < 1e-15 && (x[3] - places[3]).norm() < 1e-15, "{x:?}");
        for i in 0..3 {
            assert!(((x[i + 1] - x[i]).norm() - 1.0).abs() < 1e-14, "{x:?}");
        }
        assert!((stepper.energy(&state) - energy).abs() < 1e-4 * energy, "{}", stepper.energy(&state) - energy);
    }
    // a straight chain has a velocity at right angles for which no rod is responsible
    let straight = std::array::from_fn(|i| Vector2::x() * i as f64);
    let stepper = Bridge::<4> { end: straight[3] }.into_stepper(0.01)?;
    let refused = stepper.state(straight, [Vector2::zeros(); 4]);
    assert_eq!(refused, Err(Error::DependentConstraints { rank: 6, rows: 7 }));
    Ok(())
}

/// The places of beads at the time 1, after so many steps.
fn end<S>(stepper: impl Fn(f64) -> Result<Stepper<S>, Error>, steps: usize) -> Result<[Vector2<f64>; 3], Error>
where
    S: clebsch::Constrained<Configuration = [Vector2<f64>; 3], Momentum = [Vector2<f64>; 3], Scalar = f64>,
{
    let places = [Vector2::new(0.8, -0.6), Vector2::new(0.8, -1.6), Vector2::new(0.0, -2.2)];
    let velocities = [Vector2::zeros(), Vector2::new(0.5, 0.0), Vector2::new(0.2, 0.4)];
    let stepper = stepper(1.0 / steps as f64)?;
    Ok(*stepper.advance(&stepper.state_moving(places, velocities)?, steps)?.configuration())
}

#[test]
fn steps_of_chains_have_their_orders() -> Result<(), Error> {
    let order = |coarse: f64, fine: f64| (coarse / fine).log2();
    let exact = end(|h| Eighth::<3>.into_stepper(h), 160)?;
    let error = |places: Result<[Vector2<f64>; 3], Error>| places.map(|q| exact.distance_squared(&q).sqrt());
    let second = |steps| error(end(|h| Second::<3>.into_stepper(h), steps));
    let fourth = |steps| error(end(|h| Fourth::<3>.into_stepper(h), steps));
    let sixth = |steps| error(end(|h| Sixth::<3>.into_stepper(h), steps));
    let eighth = |steps| error(end(|h| Eighth::<3>.into_stepper(h), steps));
    let found = [
        order(second(40)?, second(80)?),
        order(fourth(20)?, fourth(40)?),
        order(sixth(10)?, sixth(20)?),
        order(eighth(6)?, eighth(12)?),
    ];
    for (found, expected) in found.into_iter().zip([2.0, 4.0, 6.0, 8.0]) {
        assert!((found - expected).abs() < 0.06 * expected, "{found} for {expected}");
    }
    Ok(())
}

/// Links of 0.3 m from a fixed point, each turned a little more than the one before.
fn hanging<const N: usize>() -> (HangingChain<N>, [Matrix4<f64>; N]) {
    let half = Vector3::z() * 0.15;
    let mass_matrix = Matrix4::from_diagonal(&nalgebra::Vector4::new(1e-4, 1.2e-4, 0.5 * 0.09 / 12.0, 0.5));
    let chain = HangingChain { mass_matrix, weight: 4.905, near: -half, far: half };
    let mut joint = Vector3::zeros();
    let places = std::array::from_fn(|i| {
        let place = placed(Vector3::new(0.1 * (i as f64).sin(), 1.5 + 0.02 * i as f64, 0.3), chain.near, joint);
        joint = at(&place, chain.far);
        place
    });
    (chain, places)
}

/// 12 links; half the step, a quarter of the band of the energy. Back again, they are where they started.
#[test]
fn hanging_chains_stay_closed_and_are_time_symmetric() -> Result<(), Error> {
    let (chain, places) = hanging::<12>();
    let band = |h: f64, steps: usize| -> Result<f64, Error> {
        let stepper = chain.stepper(h)?;
        let start = stepper.state(places, [Vector6::zeros(); 12])?;
        let (mut state, mut band) = (start, 0.0_f64);
        for _ in 0..steps {
            state = stepper.step(&state)?;
            band = band.max((stepper.energy(&state) - stepper.energy(&start)).abs());
        }
        let q = state.configuration();
        assert!(at(&q[0], chain.near).norm() < 1e-14);
        for i in 1..12 {
            let open = (at(&q[i], chain.near) - at(&q[i - 1], chain.far)).norm();
            assert!(open < 1e-14, "link {i} by {open:e}");
        }
        let back = chain.stepper(-h)?;
        let end = back.advance(&back.state(*q, state.momentum())?, steps)?;
        let far = end.configuration().distance_squared(&places).sqrt();
        assert!(far < 1e-9, "{far:e}");
        Ok(band)
    };
    let ratio = band(0.002, crate::long(200))? / band(0.001, crate::long(400))?;
    assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
    Ok(())
}

/// Links that are moved apart come together again, by motions of the size of the gaps; far away there is an error.
#[test]
fn chains_are_closed_by_projection() -> Result<(), Error> {
    let (chain, places) = hanging::<12>();
    let stepper = chain.stepper(0.002)?;
    let mut open = places;
    for (i, place) in open.iter_mut().enumerate() {
        let by = Vector3::new((3.0 * i as f64).sin(), (5.0 * i as f64).cos(), (7.0 * i as f64).sin()) * 0.02;
        *place = Rotation3::new(by).to_homogeneous() * *place;
    }
    let closed = stepper.project(open, [Vector6::repeat(0.01); 12])?;
    let q = closed.configuration();
    assert!(at(&q[0], chain.near).norm() < 1e-15);
    for i in 1..12 {
        let gap = (at(&q[i], chain.near) - at(&q[i - 1], chain.far)).norm();
        assert!(gap < 4e-15, "link {i}: {gap:e}");
    }
    let far = q.distance_squared(&open).sqrt();
    let opened = (1..12).map(|i| (at(&open[i], chain.near) - at(&open[i - 1], chain.far)).norm()).sum::<f64>();
    assert!(opened > 0.1 && far < 2.0 * opened, "{opened} {far}");
    assert_eq!(stepper.state(*q, closed.momentum())?, closed);

    let apart = std::array::from_fn(|i| Matrix4::new_translation(&Vector3::new(1e3 * i as f64, 0.0, 0.0)));
    let refused = stepper.project(apart, [Vector6::zeros(); 12]);
    assert!(matches!(refused, Err(Error::FarFromConstraint { .. })), "{refused:?}");
    Ok(())
}

/// A chain at rest that hangs straight down: each joint carries the links below it.
#[test]
fn joints_of_a_hanging_chain_carry_its_weight() -> Result<(), Error> {
    let (chain, _) = hanging::<5>();
    let down = std::array::from_fn(|i| {
        // the links point down
        let turn = *Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI).matrix();
        let mut placed = turn.to_homogeneous();
        placed[(2, 3)] = -0.15 - 0.3 * i as f64;
        placed
    });
    let stepper = chain.into_stepper(0.002)?;
    let state = stepper.project(down, [Vector6::zeros(); 5])?;
    let (_, pushes) = stepper.step_with_reactions(&state)?;
    for reactions in [stepper.reactions(&state)?, pushes] {
        for (i, reaction) in reactions.iter().enumerate() {
            let expected = Vector3::z() * 4.905 * (5 - i) as f64;
            assert!((reaction - expected).norm() < 1e-11, "joint {i}: {reaction}");
        }
    }
    Ok(())
}

/// A joint turns with its links: φ changes by a combination of φ, and all six momenta of a chain that flies are constant.
#[test]
fn chains_that_fly_keep_their_momenta() -> Result<(), Error> {
    let (HangingChain { mass_matrix, near, far, .. }, places) = hanging::<6>();
    let stepper = Flying { mass_matrix, near, far }.into_stepper(0.002)?;
    let momenta = std::array::from_fn(|i| {
        Vector6::from_fn(|k, _| 0.002 * ((i + 3 * k) as f64).sin() * if k > 2 { 50.0 } else { 1.0 })
    });
    let mut state = stepper.project(places, momenta)?;
    let start = stepper.conserved(&state);
    assert_eq!(start.iter().count(), 6, "{start:?}");
    // rounding of the largest entries, which are those of a turn about the origin
    let largest = start.iter().fold(0.0_f64, |largest, (_, x)| largest.max(x.abs()));
    for step in 0..500 {
        state = stepper.step(&state)?;
        for ((name, now), (_, then)) in stepper.conserved(&state).iter().zip(start.iter()) {
            assert!((now - then).abs() < 1e-12 * largest, "step {step}, {name}: {now} {then}");
        }
    }
    Ok(())
}

/// After a million steps of eight links that fly, momenta, joints and rotations are off by rounding alone. Run with
/// `--nocapture` it prints by how much.
#[cfg(feature = "heavy")]
#[test]
fn a_million_steps_of_links_that_fly_leave_rounding() -> Result<(), Error> {
    const STEPS: usize = 1_000_000;
    let (HangingChain { mass_matrix, near, far, .. }, places) = hanging::<8>();
    let stepper = Flying { mass_matrix, near, far }.into_stepper(0.002)?;
    let momenta = std::array::from_fn(|i| {
        Vector6::from_fn(|k, _| 0.002 * ((i + 3 * k) as f64).sin() * if k > 2 { 50.0 } else { 1.0 })
    });
    let start = stepper.project(places, momenta)?;
    let end = stepper.advance(&start, STEPS)?;
    let q = end.configuration();
    let distance = q.iter().map(|q| q.fixed_view::<3, 1>(0, 3).norm()).fold(0.0_f64, f64::max);
    let walk = f64::EPSILON * (STEPS as f64).sqrt();
    // ⟨about each axis, along each axis⟩: a turn about the origin counts the distance
    let scale = end.momentum().iter().map(|n| n.norm()).sum::<f64>() * (1.0 + distance);
    let (before, after) = (stepper.conserved(&start), stepper.conserved(&end));
    let drift = before.iter().zip(after.iter()).map(|((_, a), (_, b))| (a - b).abs()).fold(0.0_f64, f64::max);
    let gap = (1..8).map(|i| (at(&q[i], near) - at(&q[i - 1], far)).norm()).fold(0.0_f64, f64::max);
    let turned = q.map(|q| {
        let turn = q.fixed_view::<3, 3>(0, 0).into_owned();
        (turn.transpose() * turn - Matrix3::identity()).amax()
    });
    let turned = turned.into_iter().fold(0.0_f64, f64::max);
    println!(
        "momenta {drift:.1e} of {scale:.1e}, joints {gap:.1e} at {distance:.0} m, RᵀR − I {turned:.1e}, ε√steps {walk:.1e}"
    );
    assert!(drift < 4.0 * walk * scale, "{drift:e}");
    assert!(gap < 4.0 * f64::EPSILON * (1.0 + distance), "{gap:e}");
    assert!(turned < 4.0 * walk, "{turned:e}");
    Ok(())
}

/// Storage of the caller steps to the same bits, and an error names its site.
#[test]
fn sites_with_joints_are_states_in_storage() -> Result<(), Error> {
    let (chain, places) = hanging::<7>();
    let stepper = chain.stepper(0.002)?;
    let state = stepper.advance(&stepper.state(places, [Vector6::zeros(); 7])?, 20)?;
    let storage = SiteStorage::of(places.to_vec(), vec![Vector6::zeros(); 7]);
    let room = vec![stepper.joint(); 7];
    let mut sites = stepper.clone().joined_sites(storage, room)?;
    sites.advance(20)?;
    assert_eq!(sites.configuration(), state.configuration());
    assert_eq!(sites.momentum(), &state.momentum());

    let mut open = places;
    open[4][(0, 3)] += 1e-3;
    let storage = SiteStorage::of(open.to_vec(), vec![Vector6::zeros(); 7]);
    let refused = stepper.clone().joined_sites(storage, vec![stepper.joint(); 7]).unwrap_err();
    assert_eq!(refused.site, Some(4));
    let Error::OffConstraint { violation, .. } = refused.error else { panic!("{refused}") };
    assert!((violation - 1e-3).abs() < 1e-12, "{violation}");

    // link 5 moves, and both of its joints are violated
    let mut momenta = vec![Vector6::zeros(); 7];
    momenta[5] = Vector6::from_element(0.1);
    let storage = SiteStorage::of(places.to_vec(), momenta);
    let refused = stepper.clone().joined_sites(storage, vec![stepper.joint(); 7]).unwrap_err();
    assert!(matches!(refused.error, Error::ConstraintViolated { .. }), "{refused}");
    assert!(matches!(refused.site, Some(5 | 6)), "{refused}");

    let storage = SiteStorage::of(places.to_vec(), vec![Vector6::zeros(); 7]);
    let refused = stepper.clone().joined_sites(storage, vec![stepper.joint(); 6]).unwrap_err();
    assert_eq!((refused.site, refused.error), (None, Error::NumberOfSites { found: 6, sites: 7 }));
    Ok(())
}

/// Steps that are far too long end with an error, and leave no NaN.
#[test]
fn steps_of_chains_that_are_too_long_are_refused() -> Result<(), Error> {
    let (chain, places) = hanging::<7>();
    let mut refused = 0;
    for h in [0.05, 0.2, 1.0, 10.0, 1e3, 1e6] {
        let stepper = chain.stepper(h)?;
        let mut state = stepper.state(places, [Vector6::zeros(); 7])?;
        for _ in 0..20 {
            match stepper.step(&state) {
                Ok(next) => state = next,
                Err(error) => {
                    assert!(
                        matches!(
                            error,
                            Error::NotConverged { .. } | Error::Unsolvable { .. } | Error::NotFinite { .. }
                        ),
                        "h = {h}: {error}"
                    );
                    refused += 1;
                    break;
                }
            }
            assert!(state.configuration().all_finite() && state.momentum().all_finite());
            let q = state.configuration();
            let open = (1..7).map(|i| (at(&q[i], chain.near) - at(&q[i - 1], chain.far)).norm()).fold(0.0, f64::max);
            assert!(open < 1e-10, "h = {h}: {open:e}");
        }
    }
    assert!(refused >= 4, "{refused} were refused");
    Ok(())
}

/// Hinges between bodies by quaternions hold, and the energy does not drift.
#[test]
fn hinges_of_quaternions_hold() {
    let arm = Vector3::new(0.5, 0.1, -0.2);
    let chain = Turning::<3> { mass: 1.2, inertia: Matrix3::from_diagonal(&Vector3::new(0.3, 0.4, 0.5)), arm };
    let stepper = chain.into_stepper(0.01).expect("a chain");
    let places = std::array::from_fn(|i| (arm * (-2.0 * i as f64), nalgebra::Quaternion::identity()));
    let start = stepper.state(places, [nalgebra::Vector6::zeros(); 3]).expect("a state");
    let end = stepper.advance(&start, 100).expect("steps");
    let bodies = end.configuration();
    for pair in bodies.windows(2) {
        let [(before, turn), (after, other)] = [pair[0], pair[1]];
        let [far, near] = [turn, other].map(|turn| nalgebra::UnitQuaternion::from_quaternion(turn) * arm);
        assert!((after + near - before + far).norm() < 1e-12, "{after} {before}");
    }
    assert!((bodies[2].1.w - 1.0).abs() > 1e-3, "it turns: {}", bodies[2].1);
    let (before, after) = (stepper.energy(&start), stepper.energy(&end));
    assert!((before - after).abs() < 1e-3, "{before} {after}");
}
