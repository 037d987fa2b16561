//! Rotations of rigid bodies in avian by clebsch, as a plugin. Copy this file.
use avian3d::dynamics::solver::schedule::SolverSystems;
use avian3d::dynamics::solver::solver_body::{SolverBody, SolverBodyFlags};
use avian3d::math::{Matrix, Scalar, Vector};
use avian3d::prelude::*;
use bevy::prelude::*;
use clebsch::{Clebsch, Stepper};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, convert};

/// A body that nothing acts on.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian     = |omega| omega.dot(&(self.inertia * omega)) / 2,
    discretization = exact,
)]
struct FreeBody {
    #[clebsch(symmetric)]
    inertia: Matrix3<f64>,
}

/// A body that clebsch turns. Insert its default next to the rigid body.
#[derive(Component, Default)]
pub struct Turned(Option<Turning>);

/// The attitude, the angular momentum in the world, and the attitude and angular velocity in avian.
struct Turning {
    stepper: Stepper<FreeBody>,
    attitude: UnitQuaternion<f64>,
    momentum: Vector3<f64>,
    seen: (UnitQuaternion<f64>, Vector),
}

/// Turns all bodies that are [`Turned`]. Add it after the plugins of avian. Errors of clebsch go to the handler of Bevy.
pub struct AttitudePlugin;

impl Plugin for AttitudePlugin {
    fn build(&self, app: &mut App) {
        let before = before_step.after(SolverSystems::PrepareSolverBodies).before(SolverSystems::PrepareJoints);
        let after = after_step.after(SolverSystems::Finalize).before(SolverSystems::StoreContactImpulses);
        app.add_systems(PhysicsSchedule, (before, after));
    }
}

type Moving<'a> = (&'a mut Turned, &'a mut SolverBody, &'a Rotation, &'a ComputedAngularInertia);

fn before_step(time: Res<Time>, substeps: Res<SubstepCount>, mut bodies: Query<Moving>) -> Result {
    let count = f64::from(substeps.0);
    let dt = time.delta().div_f64(count).as_secs_f64() * count; // as avian rounds it to nanoseconds
    for (mut turned, mut body, rotation, inertia) in &mut bodies {
        let before = turned.0.take();
        let locked = SolverBodyFlags::ROTATION_LOCKED | SolverBodyFlags::IS_KINEMATIC;
        if dt <= 0.0 || !inertia.is_finite() || body.flags.intersects(locked) {
            continue;
        }
        body.flags.remove(SolverBodyFlags::GYROSCOPIC_MOTION);
        let inertia = Matrix3::from(Matrix::from(inertia.tensor())).cast::<f64>();
        let axes = UnitQuaternion::new_normalize(Quaternion::from(rotation.0).cast());
        let momentum = axes * (inertia * (axes.inverse() * Vector3::from(body.angular_velocity).cast()));
        let mut it = match before.filter(|it| it.stepper.system().inertia == inertia) {
            Some(it) if it.seen == (axes, body.angular_velocity) => it,
            Some(it) => Turning { attitude: axes, momentum, ..it }, // changed from outside
            None => {
                let stepper = FreeBody { inertia }.into_stepper(dt)?;
                Turning { stepper, attitude: axes, momentum, seen: (axes, Vector::ZERO) }
            }
        };
        let state = it.stepper.state(*it.attitude, it.attitude.inverse() * it.momentum)?;
        it.attitude = UnitQuaternion::new_normalize(*it.stepper.step_for(&state, dt)?.configuration());
        let steady = (it.attitude * axes.inverse()).scaled_axis() / dt;
        body.angular_velocity = steady.cast::<Scalar>().into();
        it.seen = (axes, body.angular_velocity);
        turned.0 = Some(it);
    }
    Ok(())
}

fn after_step(mut bodies: Query<(&mut Turned, &mut AngularVelocity, &Rotation), With<SolverBody>>) {
    for (mut turned, mut velocity, rotation) in &mut bodies {
        let Some(it) = &mut turned.0 else { continue };
        let (inertia, axes) = (it.stepper.system().inertia, it.seen.0);
        let change = velocity.0 - it.seen.1;
        it.momentum += axes * (inertia * (axes.inverse() * Vector3::from(change).cast()));
        let now = UnitQuaternion::new_normalize(Quaternion::from(rotation.0).cast());
        if change != Vector::ZERO || it.attitude.angle_to(&now) > convert(64.0 * Scalar::EPSILON) {
            it.attitude = now; // with the corrections of avian
        }
        let omega = inertia.try_inverse().unwrap_or_default() * (it.attitude.inverse() * it.momentum);
        velocity.0 = (it.attitude * omega).cast::<Scalar>().into();
        it.seen = (now, velocity.0);
    }
}
