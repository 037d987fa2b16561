//! Rotations of rigid bodies in rapier by clebsch. Copy this file, and name your crate in its first line.
use super::rapier::prelude::*; // rapier3d or rapier3d_f64
use clebsch::{Clebsch, Error, Stepper};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, convert};

/// A body that nothing acts on. Its attitude is that of its principal axes.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    discretization = exact,
)]
struct FreeBody {
    moments: Vector3<f64>,
}

/// A body: its attitude, its angular momentum in the world, and its attitude and angular velocity in rapier.
struct Turning {
    handle: RigidBodyHandle,
    stepper: Stepper<FreeBody>,
    attitude: UnitQuaternion<f64>,
    momentum: Vector3<f64>,
    seen: (UnitQuaternion<f64>, Vector),
}

/// The bodies that clebsch turns.
#[derive(Default)]
pub struct Attitudes(Vec<Turning>);

impl Attitudes {
    /// Adds a body that has its colliders already. An error is a moment of inertia that is 0.
    pub fn insert(&mut self, handle: RigidBodyHandle, world: &mut PhysicsWorld) -> Result<(), Error> {
        world.bodies[handle].recompute_mass_properties_from_colliders(&world.colliders);
        world.bodies[handle].enable_gyroscopic_forces(false);
        let (attitude, moments) = principal(&world.bodies[handle]);
        let stepper = FreeBody { moments }.into_stepper(convert(world.integration_parameters.dt))?;
        self.0.push(Turning { handle, stepper, attitude, momentum: Vector3::zeros(), seen: (attitude, Vector::ZERO) });
        Ok(())
    }

    /// One step of the world, in place of `world.step()`.
    pub fn step(&mut self, world: &mut PhysicsWorld) -> Result<(), Error> {
        let dt = convert(world.integration_parameters.dt);
        self.0.retain(|it| world.bodies.contains(it.handle));
        for it in self.0.iter_mut().filter(|_| dt > 0.0) {
            let Some(body) = free(&mut world.bodies, it.handle) else { continue };
            let (axes, moments) = principal(body);
            if it.stepper.system().moments != moments {
                it.stepper = FreeBody { moments }.into_stepper(dt)?;
                it.momentum = momentum(axes, moments, body.angvel());
            }
            if it.seen != (axes, body.angvel()) {
                // changed from outside, or asleep until now
                (it.attitude, it.momentum) = (axes, momentum(axes, moments, body.angvel()));
            }
            let state = it.stepper.state(*it.attitude, it.attitude.inverse() * it.momentum)?;
            it.attitude = UnitQuaternion::new_normalize(*it.stepper.step_for(&state, dt)?.configuration());
            // A steady ω takes rapier from its attitude to this one: 2 atan(|ω| dt / 2n) in each of n substeps.
            let substeps = world.integration_parameters.num_solver_iterations + body.additional_solver_iterations();
            let rate = |angle: f64| (angle / (2 * substeps) as f64).tan() * (2 * substeps) as f64 / dt;
            let turn = (it.attitude * axes.inverse()).axis_angle();
            let omega = turn.map_or(Vector3::zeros(), |(axis, angle)| *axis * rate(angle));
            body.set_angvel(omega.cast::<Real>().into(), false);
            it.seen = (axes, body.angvel());
        }
        world.step(); // or with hooks and events
        for it in &mut self.0 {
            let Some(body) = free(&mut world.bodies, it.handle) else { continue };
            let (axes, moments) = principal(body);
            // Contacts, joints and torques change ω with the inertia that the body had before the step.
            let change = body.angvel() - it.seen.1;
            it.momentum += momentum(it.seen.0, moments, change);
            if change != Vector::ZERO || it.attitude.angle_to(&axes) > convert(64.0 * Real::EPSILON) {
                it.attitude = axes; // with the corrections of rapier
            }
            let omega = it.attitude * (it.attitude.inverse() * it.momentum).component_div(&moments);
            body.set_angvel(omega.cast::<Real>().into(), false);
            it.seen = (axes, body.angvel());
        }
        Ok(())
    }
}

/// The body, if it is awake and turns about all axes.
fn free(bodies: &mut RigidBodySet, handle: RigidBodyHandle) -> Option<&mut RigidBody> {
    let body = bodies.get(handle).filter(|body| body.is_dynamic() && body.is_enabled() && !body.is_sleeping())?;
    (body.is_rotation_locked() == [false; 3]).then(|| &mut bodies[handle])
}

/// The attitude of the principal axes, and the moments about them.
fn principal(body: &RigidBody) -> (UnitQuaternion<f64>, Vector3<f64>) {
    let local = &body.mass_properties().local_mprops;
    let axes = Quaternion::from(*body.rotation() * local.principal_inertia_local_frame).cast();
    (UnitQuaternion::new_normalize(axes), Vector3::from(local.principal_inertia()).cast())
}

fn momentum(attitude: UnitQuaternion<f64>, moments: Vector3<f64>, rate: Vector) -> Vector3<f64> {
    attitude * moments.component_mul(&(attitude.inverse() * Vector3::from(rate).cast()))
}
