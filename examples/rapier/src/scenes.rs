//! Bodies in rapier, turned by rapier and turned by clebsch.

use super::attitudes::Attitudes;
use super::rapier::prelude::*;
use crate::theory::{self, MOMENTS, RATE};
use clebsch::{Clebsch, Error};
use nalgebra::{Quaternion, UnitQuaternion, Vector3, convert};
use std::f64::consts::PI;
use std::time::Instant;

/// Who turns the bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum By {
    /// rapier, with its gyroscopic forces.
    Rapier,
    /// clebsch, by [`Attitudes`].
    Clebsch,
    /// clebsch, whose attitude replaces that of rapier after each step. The corrections of rapier are lost.
    Replacing,
}

/// A world with bodies that are turned in one of these ways.
pub struct Scene {
    /// The world of rapier.
    pub world: PhysicsWorld,
    by: By,
    attitudes: Attitudes,
    /// Each body whose attitude is replaced, with its angular momentum.
    replaced: Vec<(RigidBodyHandle, Vector3<f64>)>,
}

impl Scene {
    /// An empty world. `gravity` acts along −z, m/s².
    pub fn new(by: By, gravity: Real) -> Self {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, 0.0, -gravity);
        Self { world, by, attitudes: Attitudes::default(), replaced: Vec::new() }
    }

    /// A body with its collider, if it has one.
    ///
    /// # Errors
    /// Those of [`Attitudes::insert`].
    pub fn insert(
        &mut self,
        body: RigidBodyBuilder,
        collider: Option<ColliderBuilder>,
    ) -> Result<RigidBodyHandle, Error> {
        let handle = self.world.insert_body(body);
        if let Some(collider) = collider {
            self.world.insert_collider(collider, Some(handle));
        }
        match self.by {
            By::Rapier => {
                self.world.bodies[handle].recompute_mass_properties_from_colliders(&self.world.colliders);
            }
            By::Clebsch => self.attitudes.insert(handle, &mut self.world)?,
            By::Replacing => {
                self.world.bodies[handle].enable_gyroscopic_forces(false);
                self.world.bodies[handle].recompute_mass_properties_from_colliders(&self.world.colliders);
                self.replaced.push((handle, self.spin(handle)));
            }
        }
        Ok(handle)
    }

    /// A floor through the origin.
    pub fn floor(&mut self) {
        let ground = ColliderBuilder::cuboid(50.0, 50.0, 1.0).translation(Vector::new(0.0, 0.0, -1.0));
        self.world.insert_collider(ground, None);
    }

    /// One step of all bodies.
    ///
    /// # Errors
    /// Those of clebsch.
    pub fn step(&mut self) -> Result<(), Error> {
        if self.by == By::Clebsch {
            return self.attitudes.step(&mut self.world);
        }
        let before: Vec<_> = self.replaced.iter().map(|&(handle, _)| self.motion(handle)).collect();
        self.world.step();
        for ((handle, spin), (axes, moments, rate)) in self.replaced.iter_mut().zip(before) {
            let dt = convert(self.world.integration_parameters.dt);
            let stepper = Body { moments }.into_stepper(dt)?;
            let state = stepper.step(&stepper.state(*axes, axes.inverse() * *spin)?)?;
            let attitude = UnitQuaternion::new_normalize(*state.configuration());
            let body = &mut self.world.bodies[*handle];
            let change = Vector3::from(body.angvel()).cast() - rate;
            *spin += axes * moments.component_mul(&(axes.inverse() * change));
            let rate = attitude * (attitude.inverse() * *spin).component_div(&moments);
            let frame = body.mass_properties().local_mprops.principal_inertia_local_frame;
            let rotation: Rotation = attitude.cast::<Real>().into();
            body.set_rotation(rotation * frame.inverse(), false);
            body.set_angvel(rate.cast::<Real>().into(), false);
        }
        Ok(())
    }

    /// Principal axes in the world, moments about them, and angular velocity in the world, as rapier has them.
    pub fn motion(&self, handle: RigidBodyHandle) -> (UnitQuaternion<f64>, Vector3<f64>, Vector3<f64>) {
        let body = &self.world.bodies[handle];
        let local = &body.mass_properties().local_mprops;
        let axes = Quaternion::from(*body.rotation() * local.principal_inertia_local_frame).cast();
        let moments = Vector3::from(local.principal_inertia()).cast();
        (UnitQuaternion::new_normalize(axes), moments, Vector3::from(body.angvel()).cast())
    }

    /// The angular momentum about the centre of mass, in the world, kg·m²/s.
    pub fn spin(&self, handle: RigidBodyHandle) -> Vector3<f64> {
        let (axes, moments, rate) = self.motion(handle);
        axes * moments.component_mul(&(axes.inverse() * rate))
    }
}

#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |F: SU<2>, Q: SU<2>| Q * F,
    lagrangian     = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
    discretization = exact,
)]
struct Body {
    moments: Vector3<f64>,
}

/// A body of 1 kg with these moments in the frame `axes`, about the point `centre` of its own coordinates.
pub fn body(moments: [Real; 3], axes: Rotation, centre: Vector) -> RigidBodyBuilder {
    let mass = MassProperties::with_principal_inertia_frame(centre, 1.0, moments.into(), axes);
    RigidBodyBuilder::dynamic().additional_mass_properties(mass).can_sleep(false)
}

/// A free body that turns over.
#[derive(Clone, Copy, Debug)]
pub struct Tumbling {
    /// How often the rate about its middle axis has changed its sign.
    pub turns: u32,
    /// The largest angle between the angular momentum and that at the start, rad.
    pub direction: f64,
    /// The largest relative change of the energy.
    pub energy: f64,
    /// The shortest time of a step, ns.
    pub nanoseconds: f64,
}

/// Lets the body of [`MOMENTS`] and [`RATE`] turn over for so many steps of 1/60 s.
///
/// # Errors
/// Those of clebsch.
pub fn tumbling(by: By, steps: u32) -> Result<Tumbling, Error> {
    let mut scene = Scene::new(by, 0.0);
    let [rate, moments] = [RATE, MOMENTS].map(|numbers| numbers.map(convert::<f64, Real>));
    let handle = scene.insert(body(moments, Rotation::IDENTITY, Vector::ZERO).angvel(rate.into()), None)?;
    let motion = |scene: &Scene| {
        let (axes, moments, rate) = scene.motion(handle);
        let rate = axes.inverse() * rate;
        (rate.y, moments.component_mul(&rate).dot(&rate))
    };
    let start = scene.spin(handle);
    let (mut before, first) = motion(&scene);
    let mut report = Tumbling { turns: 0, direction: 0.0, energy: 0.0, nanoseconds: f64::INFINITY };
    for _ in 0..steps.div_ceil(1000) {
        let mut spent = 0.0;
        for _ in 0..1000 {
            let begun = Instant::now();
            scene.step()?;
            spent += begun.elapsed().as_secs_f64();
            let (rate, energy) = motion(&scene);
            report.turns += u32::from(rate * before < 0.0);
            report.direction = report.direction.max(angle(&scene.spin(handle), &start));
            report.energy = report.energy.max((energy / first - 1.0).abs());
            before = rate;
        }
        report.nanoseconds = report.nanoseconds.min(spent * 1e9 / 1000.0);
    }
    Ok(report)
}

fn angle(a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

/// A thrown body whose centre of mass is off the origin, and whose principal axes are turned, after some time.
#[derive(Clone, Copy, Debug)]
pub struct Thrown {
    /// The angle to the attitude by Euler's equations, rad.
    pub attitude: f64,
    /// The distance of the centre of mass from its straight line, m.
    pub path: f64,
    /// The relative change of the angular momentum.
    pub momentum: f64,
}

/// Throws a body with an angular velocity in the world, rad/s, and follows it for ten seconds. `steps` are the sizes of
/// its steps in turn, s.
///
/// # Errors
/// Those of clebsch.
pub fn thrown(by: By, rate: [Real; 3], steps: &[f64]) -> Result<Thrown, Error> {
    let mut scene = Scene::new(by, 0.0);
    let frame = Rotation::from_scaled_axis(Vector::new(0.3, -0.8, 0.5));
    let (centre, speed) = (Vector::new(0.3, -0.2, 0.5), Vector::new(0.25, -0.5, 1.0));
    let body = body([1.0, 2.0, 3.0], frame, centre).linvel(speed).angvel(rate.into()).allow_fast_rotation(true);
    let handle = scene.insert(body.rotation(Vector::new(0.5, 0.25, -1.0)), None)?;
    let (axes, moments, rate) = scene.motion(handle);
    let place = |scene: &Scene| Vector3::from(scene.world.bodies[handle].center_of_mass()).cast::<f64>();
    let (spin, start) = (scene.spin(handle), place(&scene));
    let mut time = 0.0;
    for &step in steps.iter().cycle() {
        if time >= 10.0 {
            break;
        }
        scene.world.integration_parameters.dt = convert(step);
        scene.step()?;
        time += convert::<Real, f64>(scene.world.integration_parameters.dt);
    }
    let expected = theory::attitude(moments, axes, axes.inverse() * rate, time);
    Ok(Thrown {
        attitude: scene.motion(handle).0.angle_to(&expected),
        path: (place(&scene) - start - Vector3::from(speed).cast() * time).norm(),
        momentum: (scene.spin(handle) - spin).norm() / spin.norm(),
    })
}

/// A box that has fallen on the floor.
#[derive(Clone, Copy, Debug)]
pub struct Resting {
    /// Its speed from the tenth to the twentieth second, by the way it has made, m/s.
    pub creeping: f64,
    /// Its largest angular velocity in that time, rad/s.
    pub rate: f64,
}

fn box_of(half: [Real; 3]) -> ColliderBuilder {
    ColliderBuilder::cuboid(half[0], half[1], half[2])
}

/// A box falls on an edge and comes to rest. It does not sleep.
///
/// # Errors
/// Those of clebsch.
pub fn resting(by: By) -> Result<Resting, Error> {
    let mut scene = Scene::new(by, 9.81);
    scene.floor();
    let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 1.0)).can_sleep(false);
    let handle = scene.insert(body.rotation(Vector::new(0.4, 0.3, 0.2)), Some(box_of([0.5, 0.4, 0.3])))?;
    for _ in 0..600 {
        scene.step()?;
    }
    let start = scene.world.bodies[handle].translation();
    let mut report = Resting { creeping: 0.0, rate: 0.0 };
    for _ in 0..600 {
        scene.step()?;
        report.rate = report.rate.max(scene.motion(handle).2.norm());
    }
    let way = scene.world.bodies[handle].translation() - start;
    report.creeping = Vector3::from(way).cast::<f64>().norm() / 10.0;
    Ok(report)
}

/// A stack of boxes that sleeps, and is woken.
#[derive(Clone, Copy, Debug)]
pub struct Stack {
    /// Steps until all sleep; none where they do not in a minute.
    pub asleep_after: Option<u32>,
    /// The height of the highest box less that of a stack without gaps, m.
    pub height: f64,
    /// How many are awake after the highest one was pushed.
    pub woken: usize,
}

/// Five boxes fall on each other, sleep, and one is pushed.
///
/// # Errors
/// Those of clebsch.
pub fn stack(by: By) -> Result<Stack, Error> {
    let mut scene = Scene::new(by, 9.81);
    scene.floor();
    let mut boxes = Vec::new();
    for i in 0..5 {
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 0.35 + 0.62 * i as Real));
        boxes.push(scene.insert(body, Some(box_of([0.5, 0.4, 0.3])))?);
    }
    let sleeping = |scene: &Scene| boxes.iter().filter(|&&handle| scene.world.bodies[handle].is_sleeping()).count();
    let mut asleep_after = None;
    for step in 1..=3600 {
        scene.step()?;
        if sleeping(&scene) == boxes.len() {
            asleep_after = Some(step);
            break;
        }
    }
    let top = boxes[4];
    let height = Vector3::from(scene.world.bodies[top].translation()).cast::<f64>().z - 2.7;
    scene.world.bodies[top].apply_impulse(Vector::new(0.5, 0.0, 0.0), true);
    scene.step()?;
    Ok(Stack { asleep_after, height, woken: boxes.len() - sleeping(&scene) })
}

/// Two boxes that collide.
#[derive(Clone, Copy, Debug)]
pub struct Collision {
    /// The impulses of rapier's contacts, N·s.
    pub impulse: f64,
    /// The largest difference, over the steps, of the change of either angular momentum and the moment of these impulses,
    /// relative to the largest change.
    pub balance: f64,
    /// Steps with a contact.
    pub contacts: u32,
}

/// A box hits another one off its centre, without friction, and both turn away.
///
/// # Errors
/// Those of clebsch.
pub fn collision(by: By) -> Result<Collision, Error> {
    let mut scene = Scene::new(by, 0.0);
    let bodies = [(Vector::new(-2.0, 0.3, 0.1), 3.0), (Vector::new(0.0, 0.0, 0.0), 0.0)];
    let mut handles = Vec::new();
    for (place, speed) in bodies {
        let body = RigidBodyBuilder::dynamic().translation(place).linvel(Vector::new(speed, 0.0, 0.0));
        let shape = box_of([0.5, 0.4, 0.3]).friction(0.0).restitution(0.5);
        handles.push(scene.insert(body.angvel(Vector::new(1.0, 2.0, -speed)).can_sleep(false), Some(shape))?);
    }
    let mut report = Collision { impulse: 0.0, balance: 0.0, contacts: 0 };
    let mut largest: f64 = 0.0;
    for _ in 0..120 {
        let before = [0, 1].map(|i| scene.spin(handles[i]));
        scene.step()?;
        let mut moments = [Vector3::zeros(); 2];
        let mut impulse = 0.0;
        for pair in scene.world.contact_pairs() {
            let parent = |collider: ColliderHandle| scene.world.colliders[collider].parent() == Some(handles[0]);
            let order = if parent(pair.collider1) { [0, 1] } else { [1, 0] };
            for manifold in pair.solver_manifolds() {
                let normal = Vector3::from(manifold.data.normal).cast::<f64>();
                for contact in &manifold.points {
                    let size: f64 = convert(contact.data.impulse);
                    let arms = [contact.data.solver_dp1, contact.data.solver_dp2];
                    let [near, far] = arms.map(|arm| Vector3::from(arm).cast());
                    moments[order[0]] -= near.cross(&normal) * size;
                    moments[order[1]] += far.cross(&normal) * size;
                    impulse += size;
                }
            }
        }
        for i in 0..2 {
            let change = scene.spin(handles[i]) - before[i];
            largest = largest.max(change.norm());
            report.balance = report.balance.max((change - moments[i]).norm());
        }
        report.impulse += impulse;
        report.contacts += u32::from(impulse > 0.0);
    }
    report.balance /= largest;
    Ok(report)
}

/// The shortest time of a step of `count` boxes that turn freely, ns for each of them.
///
/// # Errors
/// Those of clebsch.
pub fn crowd(by: By, count: u32) -> Result<f64, Error> {
    let mut scene = Scene::new(by, 0.0);
    for i in 0..count {
        let place = Vector::new(3.0 * (i % 32) as Real, 3.0 * (i / 32) as Real, 0.0);
        let rate = Vector::new(0.3, 5.0, 0.2);
        let body = RigidBodyBuilder::dynamic().translation(place).angvel(rate).can_sleep(false);
        scene.insert(body, Some(box_of([0.5, 0.4, 0.3])))?;
    }
    let mut least = f64::INFINITY;
    for _ in 0..200 {
        let begun = Instant::now();
        scene.step()?;
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok(least * 1e9 / f64::from(count))
}

/// A wheel on an axle that hangs from a joint at its other end. It turns fast, so its axle goes around and stays level.
#[derive(Clone, Copy, Debug)]
pub struct Gyroscope {
    /// The angle that the axle has made about the vertical, over that of the theory.
    pub angle: f64,
    /// The largest angle between the axle and the horizontal, rad.
    pub tilt: f64,
}

/// A wheel of 1 kg: moments across and along the axle in kg·m², length of the axle in m, spin in rad/s.
const WHEEL: [f64; 4] = [0.05, 0.08, 0.5, 40.0];

/// Ten seconds of a wheel that starts with its steady motion. A level axle goes around with m g l/(J ω) then.
///
/// # Errors
/// Those of clebsch.
pub fn gyroscope(by: By, step: f64) -> Result<Gyroscope, Error> {
    let mut scene = Scene::new(by, 9.81);
    scene.world.integration_parameters.dt = convert(step);
    let around = 9.81 * WHEEL[2] / (WHEEL[1] * WHEEL[3]);
    let speed: Real = convert(around * WHEEL[2]);
    let [across, along, length, spin] = WHEEL.map(convert::<f64, Real>);
    let wheel = body([along, across, across], Rotation::IDENTITY, Vector::ZERO)
        .translation(Vector::new(length, 0.0, 0.0))
        .angvel(Vector::new(spin, 0.0, convert(around)))
        .linvel(Vector::new(0.0, speed, 0.0));
    let wheel = scene.insert(wheel, None)?;
    let ground = scene.world.insert_body(RigidBodyBuilder::fixed());
    let joint = SphericalJointBuilder::new().local_anchor2(Vector::new(-length, 0.0, 0.0));
    scene.world.insert_impulse_joint(ground, wheel, joint);
    let (mut angle, mut tilt, mut before): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for _ in 0..(10.0 / step).round() as u32 {
        scene.step()?;
        let axle = Vector3::from(scene.world.bodies[wheel].translation()).cast::<f64>();
        let now = axle.y.atan2(axle.x);
        angle += (now - before + PI).rem_euclid(2.0 * PI) - PI;
        tilt = tilt.max(axle.z.atan2(axle.xy().norm()).abs());
        before = now;
    }
    Ok(Gyroscope { angle: angle / (10.0 * around), tilt })
}
