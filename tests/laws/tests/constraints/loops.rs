//! Loops in trees of joints: against RATTLE with a dense matrix, and against the same bodies unrolled.

use clebsch::{Clebsch, Drive, Error, SiteStorage};
use clebsch_tests::fixtures::braced_beads::BracedBeads;
use nalgebra::{DMatrix, DVector, Matrix3, Rotation2, SVector, Vector2, Vector3};

mod declared {
    use clebsch::Clebsch;

    macro_rules! form {
        ($(#[$doc:meta])* $name:ident [$($generic:tt)*] $count:tt ($($constraint:tt)*) { $($field:ident: $ty:ty,)* } $($code:tt)*) => {
            $(#[$doc])*
            #[derive(Clebsch, Clone, Debug)]
            #[clebsch(
                action     = |F: [SE<2>; $count], q: [SE<2>; $count]| (0..$count).map(|i| q[i] * F[i]),
                lagrangian = |xi| (0..$count).map(|i| (self.inertia[i] * xi[i].x.powi(2) + self.mass[i] * (xi[i].y.powi(2) + xi[i].z.powi(2))) / 2).sum(),
                potential  = |q| (0..$count).map(|i| 9.81 * self.mass[i] * q[i].translation().y).sum(),
                constraint = $($constraint)*,
                $($code)*
            )]
            pub struct $name<$($generic)*> { pub inertia: [f64; $count], pub mass: [f64; $count], $(pub $field: $ty,)* }
        };
    }

    macro_rules! two_forms {
        ($(#[$doc:meta])* $name:ident $generic:ident $count:tt $constraint:tt $fields:tt) => {
            form! { $(#[$doc])* $name [] $count $constraint $fields }
            form! { $(#[$doc])* $generic [const N: usize] N $constraint $fields }
        };
    }

    macro_rules! three_forms {
        ($($(#[$doc:meta])* $name:ident $unrolled:ident $generic:ident $count:tt $constraint:tt $fields:tt)*) => { $(
            two_forms! { $(#[$doc])* $name $generic $count $constraint $fields }
            form! { $(#[$doc])* $unrolled [] $count $constraint $fields code = unrolled, }
        )* };
    }

    three_forms! {
        /// A five-bar loop on a frame that swings: the bars 1 and 2 are pinned to the frame, 3 to 1, and 3 to 2. A hand moves the
        /// frame.
        Linkage UnrolledLinkage GenericLinkage 4 (|t, q| [
            q[0].rotation() * self.near + q[0].translation() == Vector2::new(self.swing * t.sin(), 0),
            q[1].rotation() * self.near + q[1].translation() == q[0].rotation() * self.left + q[0].translation(),
            q[2].rotation() * self.near + q[2].translation() == q[0].rotation() * self.right + q[0].translation(),
            q[3].rotation() * self.near + q[3].translation() == q[1].rotation() * self.far + q[1].translation(),
            q[3].rotation() * self.far + q[3].translation() == q[2].rotation() * self.far + q[2].translation(),
        ]) {
            swing: f64,
            near: nalgebra::Vector2<f64>,
            far: nalgebra::Vector2<f64>,
            left: nalgebra::Vector2<f64>,
            right: nalgebra::Vector2<f64>,
        }

        /// A slider-crank on a frame that slides on a track: crank 1, rod 2 and slider 3, which stays on a rail of the frame.
        /// A counterweight hangs from the rod.
        SliderCrank UnrolledSliderCrank GenericSliderCrank 5 (|q| [
            q[0].translation().y == 0,
            q[0].rotation()[(1, 0)] == 0,
            q[1].rotation() * self.near + q[1].translation() == q[0].translation(),
            q[2].rotation() * self.near + q[2].translation() == q[1].rotation() * self.far + q[1].translation(),
            q[3].translation() == q[2].rotation() * self.far + q[2].translation(),
            q[4].rotation() * self.near + q[4].translation() == q[2].translation(),
            (q[0].rotation().transpose() * (q[3].translation() - q[0].translation())).y == self.offset,
            (q[0].rotation().transpose() * q[3].rotation())[(1, 0)] == 0,
        ]) {
            near: nalgebra::Vector2<f64>,
            far: nalgebra::Vector2<f64>,
            offset: f64,
        }
    }

    two_forms! {
        /// A platform on three legs of two bars each, in the plane: the legs stand on the ground. Two of the joints of the platform
        /// close loops.
        Platform GenericPlatform 7 (|q| [
            q[0].rotation() * self.near + q[0].translation() == self.feet[0],
            q[1].rotation() * self.near + q[1].translation() == self.feet[1],
            q[2].rotation() * self.near + q[2].translation() == self.feet[2],
            (3..6).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 3].rotation() * self.far + q[i - 3].translation()),
            q[6].rotation() * self.corners[0] + q[6].translation() == q[3].rotation() * self.far + q[3].translation(),
            q[6].rotation() * self.corners[1] + q[6].translation() == q[4].rotation() * self.far + q[4].translation(),
            q[6].rotation() * self.corners[2] + q[6].translation() == q[5].rotation() * self.far + q[5].translation(),
        ]) {
            near: nalgebra::Vector2<f64>,
            far: nalgebra::Vector2<f64>,
            feet: [nalgebra::Vector2<f64>; 3],
            corners: [nalgebra::Vector2<f64>; 3],
        }
    }

    /// A fan of beads with a strut too many.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<2>; N], x: [Vector2; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
        constraint = |x| [
            x[0] == Vector2::zeros(),
            (1..N).map(|i| (x[i] - x[0]).norm_squared() == 1),
            (2..4).map(|i| (x[i] - x[i - 1]).norm_squared() == self.struts[0]),
            (x[3] - x[1]).norm_squared() == self.struts[1],
        ],
    )]
    pub struct Fan<const N: usize> {
        pub struts: [f64; 2],
    }

    /// A ring in a tree: a bead hangs from a necklace that hangs from a nail.
    #[derive(Clebsch, Clone, Debug)]
    #[clebsch(
        action     = |a: [Translation<3>; N], x: [Vector3; N]| (0..N).map(|i| x[i] + a[i]),
        lagrangian = |v| (0..N).map(|i| v[i].norm_squared() / 2).sum(),
        potential  = |x| (0..N).map(|i| x[i].z).sum(),
        constraint = |x| [
            x[0] == Vector3::zeros(),
            (1..N).map(|i| (x[i] - x[i - 1]).norm_squared() == 1),
            (x[N - 1] - x[0]).norm_squared() == 1,
            (x[3] - x[1]).norm_squared() == 2,
        ],
    )]
    pub struct Necklace<const N: usize>;
}

use declared::*;

fn polar(from: Vector2<f64>, angle: f64) -> Vector2<f64> {
    from + Vector2::new(angle.sin(), -angle.cos())
}

/// The ends of the rods of [`BracedBeads`], then those of its struts. The first rod has one end at the origin.
const RODS: [(usize, Option<usize>); 10] = [
    (0, None),
    (1, Some(0)),
    (2, Some(0)),
    (3, Some(0)),
    (4, Some(2)),
    (5, Some(3)),
    (6, Some(4)),
    (6, Some(1)),
    (2, Some(1)),
    (3, Some(2)),
];

type Beads = [Vector2<f64>; 7];

fn rod(x: &Beads, (a, b): (usize, Option<usize>)) -> Vector2<f64> {
    x[a] - b.map_or(Vector2::zeros(), |b| x[b])
}

fn lengths(beads: &BracedBeads) -> DVector<f64> {
    DVector::from_iterator(
        10,
        RODS.iter().enumerate().map(|(i, _)| match i {
            7 => beads.long.powi(2),
            8.. => beads.short.powi(2),
            _ => 1.0,
        }),
    )
}

fn rows(x: &Beads) -> DMatrix<f64> {
    let mut rows = DMatrix::zeros(10, 14);
    for (i, &(a, b)) in RODS.iter().enumerate() {
        let along = 2.0 * rod(x, (a, b));
        for k in 0..2 {
            rows[(i, 2 * a + k)] = along[k];
            if let Some(b) = b {
                rows[(i, 2 * b + k)] = -along[k];
            }
        }
    }
    rows
}

fn stacked(x: &Beads) -> DVector<f64> {
    DVector::from_iterator(14, x.iter().flat_map(|x| [x.x, x.y]))
}

fn beads(all: &DVector<f64>) -> Beads {
    std::array::from_fn(|i| Vector2::new(all[2 * i], all[2 * i + 1]))
}

fn inverse_masses(of: &BracedBeads) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_fn(14, |i, _| 1.0 / of.mass[i / 2]))
}

fn weight(of: &BracedBeads) -> DVector<f64> {
    DVector::from_fn(14, |i, _| if i % 2 == 1 { -9.81 * of.mass[i / 2] } else { 0.0 })
}

/// A step of RATTLE with a dense Newton method; returns the mean force of each rod.
fn rattle(of: &BracedBeads, h: f64, x: &mut Beads, p: &mut DVector<f64>) -> DVector<f64> {
    let (inverse, start) = (inverse_masses(of), rows(x));
    let half = &*p + weight(of) * (h / 2.0);
    let mut pull = DVector::zeros(10);
    let moved = |pull: &DVector<f64>| &half + start.transpose() * pull;
    let drift = |pull: &DVector<f64>| beads(&(stacked(x) + &inverse * moved(pull) * h));
    for _ in 0..30 {
        let next = drift(&pull);
        let violation =
            DVector::from_iterator(10, RODS.iter().map(|&ends| rod(&next, ends).norm_squared())) - lengths(of);
        pull -= (rows(&next) * &inverse * start.transpose() * h).lu().solve(&violation).expect("a regular matrix");
    }
    let next = drift(&pull);
    let free = moved(&pull) + weight(of) * (h / 2.0);
    let end = rows(&next);
    let back = (&end * &inverse * end.transpose()).lu().solve(&(&end * &inverse * &free)).expect("a regular matrix");
    (*x, *p) = (next, free - end.transpose() * &back);
    (pull - back) / h
}

fn braced() -> (BracedBeads, Beads) {
    let root = polar(Vector2::zeros(), 0.2);
    let (a, b, c) = (polar(root, -0.9), polar(root, 0.1), polar(root, 1.1));
    let (d, e) = (polar(b, 0.5), polar(c, 0.3));
    let places = [root, a, b, c, d, e, polar(d, -0.7)];
    let mass = [0.5, 0.4, 0.7, 0.3, 0.2, 0.6, 0.4];
    (BracedBeads { mass, long: (places[6] - a).norm(), short: (b - a).norm() }, places)
}

/// The multipliers of all rods, as the dense matrix has them.
fn all(joints: &[SVector<f64, 1>; 7], loops: &SVector<f64, 3>) -> DVector<f64> {
    DVector::from_iterator(10, joints.iter().map(|one| one.x).chain(loops.iter().copied()))
}

#[test]
fn braced_beads_step_by_rattle_with_a_dense_matrix() -> Result<(), Error> {
    let (of, places) = braced();
    let stepper = of.stepper(0.01)?;
    let mut state = stepper.project(places, [Vector2::new(0.1, 0.05); 7])?;
    let (mut x, mut p) = (*state.configuration(), stacked(&state.momentum()));
    assert!((rows(&x) * inverse_masses(&of) * &p).amax() < 1e-13);
    let storage = SiteStorage::of(x.to_vec(), state.momentum().to_vec());
    let mut sites = stepper.clone().joined_sites(storage, vec![stepper.joint(); 7])?;
    let mut in_storage = [SVector::<f64, 1>::zeros(); 7];
    for step in 0..crate::long(300) {
        let (next, (joints, loops)) = stepper.step_with_reactions(&state)?;
        state = next;
        let pull = rattle(&of, 0.01, &mut x, &mut p);
        let far = (stacked(state.configuration()) - stacked(&x)).norm() + (stacked(&state.momentum()) - &p).norm();
        assert!(far < 1e-11, "step {step}: {far:e}");
        assert!((all(&joints, &loops) - &pull).norm() < 1e-9, "step {step}: {joints:?} {loops} {pull}");
        let loops = sites.step_with_reactions(&mut in_storage)?;
        assert!((all(&in_storage, &loops) - &pull).norm() < 1e-9, "step {step}: {in_storage:?} {loops} {pull}");
        // λ of the continuous motion: A Σ⁻¹(f + Aᵀλ) = −φ″ with constant velocities
        let (rows, inverse) = (rows(&x), inverse_masses(&of));
        let velocity = beads(&(&inverse * &p));
        let bend = DVector::from_iterator(10, RODS.iter().map(|&ends| 2.0 * rod(&velocity, ends).norm_squared()));
        let right = -(bend + &rows * &inverse * weight(&of));
        let exact = (&rows * &inverse * rows.transpose()).lu().solve(&right).expect("a regular matrix");
        let (joints, loops) = stepper.reactions(&state)?;
        assert!((all(&joints, &loops) - &exact).norm() < 1e-10 * (1.0 + exact.norm()), "step {step}");
    }
    Ok(())
}

#[test]
fn braced_beads_in_storage_step_to_the_same_bits() -> Result<(), Error> {
    let (of, places) = braced();
    let stepper = of.into_stepper(0.01)?;
    let start = stepper.state(places, [Vector2::zeros(); 7])?;
    let storage = SiteStorage::of(places.to_vec(), vec![Vector2::zeros(); 7]);
    let mut sites = stepper.clone().joined_sites(storage, vec![stepper.joint(); 7])?;
    sites.advance(200)?;
    let end = stepper.advance(&start, 200)?;
    let (places, momenta) = sites.state();
    assert_eq!((places, momenta), (&end.configuration()[..], &end.momentum()[..]));
    let off = stepper.state(start.configuration().map(|x| x * 1.01), [Vector2::zeros(); 7]);
    assert!(matches!(off, Err(Error::OffConstraint { .. })), "{off:?}");
    Ok(())
}

#[test]
fn a_strut_too_many_is_refused_with_the_rank() -> Result<(), Error> {
    let places = [0.0, 0.0, 0.4, 0.8, 1.7].map(|angle| polar(Vector2::zeros(), angle));
    let places = [Vector2::zeros(), places[1], places[2], places[3], places[4]];
    let struts = [(places[2] - places[1]).norm_squared(), (places[3] - places[1]).norm_squared()];
    let error = Fan { struts }.stepper(0.01)?.state(places, [Vector2::zeros(); 5]).unwrap_err();
    assert_eq!(error, Error::DependentConstraints { rank: 8, rows: 9 });
    Ok(())
}

fn flat(angle: f64, place: Vector2<f64>) -> Matrix3<f64> {
    let mut flat = Matrix3::identity();
    flat.fixed_view_mut::<2, 2>(0, 0).copy_from(Rotation2::new(angle).matrix());
    flat.fixed_view_mut::<2, 1>(0, 2).copy_from(&place);
    flat
}

/// Three forms of the same bodies step alike, with the same forces.
macro_rules! step_alike {
    ($one:expr, $other:expr, $generic:expr, $count:literal, $places:expr, $momenta:expr) => {{
        let (one, other, generic) =
            ($one.into_stepper(0.005)?, $other.into_stepper(0.005)?, $generic.into_stepper(0.005)?);
        let stacked =
            |parts: [Vector3<f64>; $count]| SVector::<f64, { 3 * $count }>::from_fn(|i, _| parts[i / 3][i % 3]);
        let mut one_state = one.project($places, $momenta)?;
        let mut other_state = other.state(*one_state.configuration(), stacked(one_state.momentum()))?;
        let mut generic_state = generic.state(*one_state.configuration(), one_state.momentum())?;
        // 0 for rows that a site does not have
        let sorted = |mut all: Vec<f64>| {
            all.resize(9 * $count, 0.0);
            all.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
            DVector::from_vec(all)
        };
        for step in 0..crate::long(300) {
            let (next, (joints, loops)) = one.step_with_reactions(&one_state)?;
            let (other_next, pulls) = other.step_with_reactions(&other_state)?;
            (one_state, other_state, generic_state) = (next, other_next, generic.step(&generic_state)?);
            let places = one_state.configuration().iter().zip(other_state.configuration());
            let far = places.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            assert!(far < 1e-11, "step {step}: {far:e}");
            let far = (stacked(one_state.momentum()) - other_state.momentum()).norm();
            assert!(far < 1e-11, "step {step}: {far:e}");
            let far = (stacked(one_state.momentum()) - stacked(generic_state.momentum())).norm();
            assert!(far < 1e-11, "step {step}: {far:e}");
            // the order of the rows differs
            let ours =
                |joints: Vec<f64>, loops: &[f64]| sorted(joints.into_iter().chain(loops.iter().copied()).collect());
            let mean = ours(joints.iter().flat_map(|rows| rows.iter().copied()).collect(), loops.as_slice());
            let pulls = sorted(pulls.as_slice().to_vec());
            assert!((&mean - &pulls).norm() < 1e-9 * (1.0 + pulls.norm()), "step {step}: {mean} {pulls}");
            let (joints, loops) = one.reactions(&one_state)?;
            let now = ours(joints.iter().flat_map(|rows| rows.iter().copied()).collect(), loops.as_slice());
            let others = sorted(other.reactions(&other_state)?.as_slice().to_vec());
            assert!((&now - &others).norm() < 1e-9 * (1.0 + others.norm()), "step {step}: {now} {others}");
        }
    }};
}

#[test]
fn a_linkage_on_a_frame_is_the_same_unrolled() -> Result<(), Error> {
    let (inertia, mass, swing) = ([0.1, 0.02, 0.03, 0.04], [1.0, 0.4, 0.3, 0.5], 0.2);
    let (near, far) = (Vector2::new(-0.5, 0.0), Vector2::new(0.5, 0.0));
    let (left, right) = (Vector2::new(0.2, -0.2), Vector2::new(1.1, -0.2));
    let one = Linkage { inertia, mass, swing, near, far, left, right };
    let other = UnrolledLinkage { inertia, mass, swing, near, far, left, right };
    let generic = GenericLinkage { inertia, mass, swing, near, far, left, right };
    let frame = flat(0.1, Rotation2::new(0.1) * -near);
    let pin = |pin: Vector2<f64>| frame.transform_point(&pin.into()).coords;
    let bar = |angle: f64, from: Vector2<f64>| flat(angle, from - Rotation2::new(angle) * near);
    let tip = |body: &Matrix3<f64>| body.transform_point(&far.into()).coords;
    let first = bar(-1.8, pin(left));
    // the last bar reaches from the first to a circle around the other pin
    let second = bar(-1.3, pin(right));
    let gap = tip(&second) - tip(&first);
    let third = bar(gap.y.atan2(gap.x), tip(&first));
    step_alike!(one, other, generic, 4, [frame, first, second, third], [Vector3::new(0.02, 0.1, 0.05); 4]);
    Ok(())
}

#[test]
fn a_slider_crank_is_the_same_unrolled() -> Result<(), Error> {
    let (inertia, mass, offset) = ([0.1, 0.01, 0.04, 0.02, 0.01], [2.0, 0.4, 0.6, 0.5, 0.3], 0.05);
    let (near, far) = (Vector2::new(-0.4, 0.0), Vector2::new(0.4, 0.0));
    let one = SliderCrank { inertia, mass, near, far, offset };
    let other = UnrolledSliderCrank { inertia, mass, near, far, offset };
    let generic = GenericSliderCrank { inertia, mass, near, far, offset };
    let bar = |angle: f64, from: Vector2<f64>| flat(angle, from - Rotation2::new(angle) * near);
    let tip = |body: &Matrix3<f64>| body.transform_point(&far.into()).coords;
    let crank = bar(0.4, Vector2::zeros());
    let rod = bar(((offset - tip(&crank).y) / 0.8).asin(), tip(&crank));
    let slider = flat(0.0, tip(&rod));
    let weight = bar(-1.2, rod.fixed_view::<2, 1>(0, 2).into_owned());
    let places = [Matrix3::identity(), crank, rod, slider, weight];
    step_alike!(one, other, generic, 5, places, [Vector3::new(0.05, 0.1, 0.02); 5]);
    Ok(())
}

/// The platform, and its places.
fn platform() -> (GenericPlatform<7>, [Matrix3<f64>; 7]) {
    let (near, far) = (Vector2::new(-0.3, 0.0), Vector2::new(0.3, 0.0));
    let feet = [Vector2::new(-0.8, 0.0), Vector2::new(0.9, 0.1), Vector2::new(0.1, 1.2)];
    let corners = [Vector2::new(-0.2, -0.1), Vector2::new(0.2, -0.1), Vector2::new(0.0, 0.2)];
    let (mut places, center) = ([Matrix3::identity(); 7], Vector2::new(0.05, 0.35));
    for i in 0..3 {
        // two bars of 0.6 m reach from the foot to the corner
        let gap: Vector2<f64> = center + corners[i] - feet[i];
        let (direction, bend) = (gap.y.atan2(gap.x), (gap.norm() / 1.2).acos());
        let (upper, lower) = (direction + bend, direction - bend);
        places[i] = flat(upper, feet[i] - Rotation2::new(upper) * near);
        let knee = places[i].transform_point(&far.into()).coords;
        places[3 + i] = flat(lower, knee - Rotation2::new(lower) * near);
    }
    places[6] = flat(0.0, center);
    let (inertia, mass) = ([0.02, 0.03, 0.02, 0.01, 0.02, 0.01, 0.05], [0.5, 0.6, 0.5, 0.4, 0.3, 0.4, 1.0]);
    (GenericPlatform { inertia, mass, near, far, feet, corners }, places)
}

#[test]
fn a_platform_on_three_legs_stays_closed_and_is_time_symmetric() -> Result<(), Error> {
    let (of, places) = platform();
    let GenericPlatform { inertia, mass, near, far, feet, corners } = of.clone();
    let by_number = Platform { inertia, mass, near, far, feet, corners };
    let band = |h: f64, steps: usize| -> Result<f64, Error> {
        let (stepper, other) = (of.stepper(h)?, by_number.stepper(h)?);
        let start = stepper.project(places, [Vector3::new(0.01, 0.05, 0.02); 7])?;
        let mut numbered = other.state(*start.configuration(), start.momentum())?;
        let (mut state, mut band) = (start, 0.0_f64);
        for _ in 0..steps {
            (state, numbered) = (stepper.step(&state)?, other.step(&numbered)?);
            band = band.max((stepper.energy(&state) - stepper.energy(&start)).abs());
        }
        let q = state.configuration();
        let far_apart = q.iter().zip(numbered.configuration()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far_apart < 1e-12, "{far_apart:e}");
        for i in 0..3 {
            let point = |body: usize, at: Vector2<f64>| q[body].transform_point(&at.into()).coords;
            let open = [
                point(i, near) - feet[i],
                point(3 + i, near) - point(i, far),
                point(6, corners[i]) - point(3 + i, far),
            ];
            assert!(open.iter().all(|open| open.norm() < 1e-14), "leg {i}: {open:?}");
        }
        let back = of.stepper(-h)?;
        let end = back.advance(&back.state(*q, state.momentum())?, steps)?;
        let far =
            end.configuration().iter().zip(start.configuration()).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(far < 1e-9, "{far:e}");
        Ok(band)
    };
    let ratio = band(0.002, crate::long(200))? / band(0.001, crate::long(400))?;
    assert!((ratio - 4.0).abs() < 0.2, "{ratio}");
    Ok(())
}

#[test]
fn a_ring_with_a_strut_is_a_tree_with_loops() -> Result<(), Error> {
    let stepper = Necklace::<6>.stepper(0.005)?;
    let regular: [Vector3<f64>; 6] = std::array::from_fn(|i| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / 6.0).sin_cos();
        Vector3::new(sin, 0.0, cos - 1.0)
    });
    let start = stepper.project(regular, [Vector3::new(0.1, 0.2, 0.0); 6])?;
    let late = stepper.advance(&start, crate::long(1000))?;
    let x = late.configuration();
    let open = (0..6).map(|i| (x[i] - x[(i + 1) % 6]).norm() - 1.0).chain([(x[3] - x[1]).norm_squared() - 2.0]);
    assert!(open.fold(0.0, |most: f64, open| most.max(open.abs())) < 1e-14);
    assert!((stepper.energy(&late) - stepper.energy(&start)).abs() < 1e-3);
    Ok(())
}
