//! Groups, actions and momenta, on the sphere: a rigid body that nothing acts on.

use crate::Pictures;
use crate::top::{BOOK, Exact, Top};
use clebsch::{Clebsch, State, Stepper};
use clebsch_examples::claims::Claims;
use clebsch_examples::figure::{
    self, Area, BLUE, Drawn, GREEN, Globe, ORANGE, Pointer, RED, RGBColor, Track, View, along,
};
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// A free body that turns steadily.
const BALL: Top = Top { moments: Vector3::new(1.0, 1.0, 1.0), weight: 0.0 };
const VIEW: View = View { azimuth: 35.0, elevation: 25.0 };

/// Exact steps of the ball turn it at the rate `momentum`: the way of the body axis `axis`, and where the ball ends.
fn turned(from: &Matrix3<f64>, momentum: Vector3<f64>, axis: &Vector3<f64>) -> Result<(Matrix3<f64>, Way), Failure> {
    let stepper = BALL.stepper_by::<Exact>(1.0 / 48.0)?;
    let start = stepper.state(*from, momentum)?;
    let states = stepper.trajectory(start).take(49).collect::<Result<Vec<_>, _>>()?;
    let way = states.iter().map(|state| (state.configuration() * axis).into()).collect();
    Ok((*states.last().unwrap_or(&start).configuration(), way))
}

/// Unit vectors in the order of time.
type Way = Vec<[f64; 3]>;

/// Left one-parameter subgroups; right two turns in both orders.
pub fn group(pictures: &Pictures) -> Result<(), Failure> {
    let start = Matrix3::identity();
    let axis = Vector3::new(0.8, 0.0, 0.6);
    let mut circles = Vec::new();
    for velocity in [Vector3::x(), Vector3::z(), Vector3::new(1.0, 0.0, 1.0).normalize()] {
        circles.push(turned(&start, velocity * TAU, &axis)?.1);
    }
    let (x, z) = (Vector3::x() * FRAC_PI_2, Vector3::z() * FRAC_PI_2);
    let in_order = |first: Vector3<f64>, second: Vector3<f64>| {
        let (attitude, mut way) = turned(&start, first, &axis)?;
        way.extend(turned(&attitude, attitude.tr_mul(&second), &axis)?.1);
        Ok::<_, Failure>(way)
    };
    let orders = [in_order(x, z)?, in_order(z, x)?];
    pictures.draw("group", |area| {
        let (left, right) = figure::columns(area, 380.0);
        let left = figure::caption(&left, "A point, turned about three axes")?;
        let pointers =
            [pointer("e₁", Vector3::x(), BLUE), pointer("e₃", Vector3::z(), ORANGE), pointer("q", axis, RED)];
        globe(&left, &circles, &[BLUE, ORANGE, GREEN], &pointers)?;
        let right = figure::caption(&right, "Quarter turns: e₁ then e₃, e₃ then e₁")?;
        globe(&right, &orders, &[BLUE, ORANGE], &pointers)
    })
}

/// The same turns from the left and from the right.
pub fn action(pictures: &Pictures) -> Result<(), Failure> {
    let start = Rotation3::from_euler_angles(0.0, 0.85, 0.75).into_inner();
    let axis = Vector3::new(0.4, -0.7, 1.0).normalize();
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), TAU / 96.0).into_inner();
    let (mut left, mut right) = (vec![start], vec![start]);
    for step in 0..72 {
        left.push(turn * left[step]);
        right.push(BALL.act(&turn, &right[step]));
    }
    let way = |attitudes: &[Matrix3<f64>]| attitudes.iter().map(|attitude| (attitude * axis).into()).collect::<Way>();
    let ways = [way(&left), way(&right)];
    let pointers = [
        pointer("e₃ of space", Vector3::z(), BLUE),
        pointer("R e₃", start.column(2).into(), ORANGE),
        pointer("start", start * axis, RED),
    ];
    pictures.draw("action", |area| {
        let area = figure::caption(area, "The turn F about e₃, from the left (blue) and from the right (orange)")?;
        globe(&area, &ways, &[BLUE, ORANGE], &pointers)
    })
}

/// Momenta of a free body, in its frame: each stays on the sphere |π| = 1 and on a level of the energy.
pub fn momentum_map(pictures: &Pictures, claims: &mut Claims) -> Result<(), Failure> {
    let stepper = BOOK.stepper(0.1)?;
    let (mut ways, mut colours, mut worst) = (Vec::new(), Vec::new(), 0.0_f64);
    for (pole, share) in [(Vector3::x(), 0.1), (Vector3::z(), 0.9)] {
        for tilt in [0.2, 0.45, 0.7, 0.95_f64] {
            // towards the middle axis, from both ends of an outer one; 0.96 rad is the separatrix seen from either
            for end in [pole, -pole] {
                let start = stepper.state(Matrix3::identity(), end * tilt.cos() + Vector3::y() * tilt.sin())?;
                let way = around(&stepper, start)?;
                let energies = way.iter().map(|momentum| BOOK.energy(&(Matrix3::identity(), *momentum)));
                let energy = stepper.energy(&start);
                worst = energies.fold(worst, |worst, other| worst.max((other - energy).abs()));
                worst = way.iter().fold(worst, |worst, momentum| worst.max((momentum.norm() - 1.0).abs()));
                ways.push(way.into_iter().map(Into::into).collect());
                colours.push(along(share * (1.0 - tilt) + 0.45 * tilt));
            }
        }
    }
    claims.round_off("energy and |π| of the momenta in the picture", worst, 1000, 1.0);
    let pointers = [Vector3::x(), Vector3::y(), Vector3::z()];
    let pointers =
        ["π₁", "π₂", "π₃"].iter().zip(pointers).map(|(name, axis)| pointer(name, axis, RED)).collect::<Vec<_>>();
    pictures.draw("momentum-map", |area| {
        let area = figure::caption(area, "Body momenta of a free rigid body with the moments 1, 2 and 3")?;
        globe(&area, &ways, &colours, &pointers)
    })
}

/// Momenta from `start` until they come back, of a thousand steps at most.
fn around(stepper: &Stepper<Top>, start: State<Top>) -> Result<Vec<Vector3<f64>>, Failure> {
    /// Between two points of the picture.
    const SPACING: f64 = 0.05;
    let mut way = vec![start.momentum()];
    let mut has_left = false;
    for state in stepper.trajectory(start).skip(1).take(1000) {
        let momentum = state?.momentum();
        let distance = (momentum - way[0]).norm();
        has_left |= distance > 2.0 * SPACING;
        if has_left && distance < SPACING {
            way.push(way[0]);
            break;
        }
        if way.last().is_none_or(|last| (momentum - last).norm() > SPACING) {
            way.push(momentum);
        }
    }
    Ok(way)
}

fn pointer(label: &str, direction: Vector3<f64>, colour: RGBColor) -> Pointer<'_> {
    Pointer { label, direction: direction.into(), colour }
}

fn globe(area: &Area<'_>, ways: &[Way], colours: &[RGBColor], pointers: &[Pointer<'_>]) -> Drawn {
    let track = |(points, &colour): (_, &RGBColor)| Track { points, colour: Some(colour), width: 1.8 };
    let tracks: Vec<_> = ways.iter().map(Vec::as_slice).zip(colours).map(track).collect();
    Globe { view: VIEW, pointers, tracks: &tracks }.draw(area)
}
