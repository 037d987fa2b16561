//! A chain of links on ball joints, by `Sites` and by hand in nalgebra: the same step, multipliers by block elimination.

use clebsch::{Clebsch, SiteStorage};
use nalgebra::{Matrix3, Matrix4, Rotation3, Vector3, Vector6};

/// Links of a chain that hangs from the origin. Their frames are at the centres of mass.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action     = |F: [SE<3>; N], q: [SE<3>; N]| (0..N).map(|i| q[i] * F[i]),
    cost       = |h, F| (0..N).map(|i| {
        let turn = F[i].rotation() - I;
        ((turn * self.second_moments * turn.transpose()).trace() + self.mass * F[i].translation().norm_squared()) / (2 * h)
    }).sum(),
    potential  = |q| (0..N).map(|i| self.gravity * self.mass * q[i].translation().z).sum(),
    constraint = |q| [
        q[0].rotation() * self.near + q[0].translation() == Vector3::zeros(),
        (1..N).map(|i| q[i].rotation() * self.near + q[i].translation() == q[i - 1].rotation() * self.far + q[i - 1].translation()),
    ],
)]
pub struct Chain<const N: usize> {
    #[clebsch(diagonal)]
    pub second_moments: Matrix3<f64>,
    pub mass: f64,
    pub gravity: f64,
    pub near: Vector3<f64>,
    pub far: Vector3<f64>,
}

/// Principal moments of a link, kg·m².
pub const INERTIA: Vector3<f64> = Vector3::new(3.85e-3, 3.87e-3, 2.2e-4);
/// Kilograms.
pub const MASS: f64 = 0.5;
/// m/s²
pub const GRAVITY: f64 = 9.81;
/// From the centre of a link to a joint, metres.
pub const HALF: f64 = 0.15;
/// The joint with the link before, in the frame of the link.
pub const NEAR: Vector3<f64> = Vector3::new(0.0, 0.0, -HALF);
/// The joint with the link after.
pub const FAR: Vector3<f64> = Vector3::new(0.0, 0.0, HALF);
/// The step size.
pub const H: f64 = 0.002;

pub fn chain<const N: usize>() -> Chain<N> {
    let second_moments = Matrix3::from_diagonal(&(-INERTIA).add_scalar(INERTIA.sum() / 2.0));
    Chain { second_moments, mass: MASS, gravity: GRAVITY, near: NEAR, far: FAR }
}

/// Links at rest, nearly level.
pub fn places(n: usize) -> Vec<(Matrix3<f64>, Vector3<f64>)> {
    let mut joint = Vector3::zeros();
    let link = |i: usize| {
        let (i, half) = (i as f64, std::f64::consts::FRAC_PI_2);
        let turn = *Rotation3::from_euler_angles(0.0, half + 0.05 * (0.7 * i).sin(), 0.1 * i.cos()).matrix();
        let place = joint - turn * NEAR;
        joint = place + turn * FAR;
        (turn, place)
    };
    (0..n).map(link).collect()
}

/// The chain in storage, at its start.
pub fn storage(n: usize) -> SiteStorage<Vec<Matrix4<f64>>, Vec<Vector6<f64>>> {
    let placed = |(turn, place): (Matrix3<f64>, Vector3<f64>)| {
        let mut placed = turn.to_homogeneous();
        placed.fixed_view_mut::<3, 1>(0, 3).copy_from(&place);
        placed
    };
    SiteStorage::of(places(n).into_iter().map(placed).collect(), vec![Vector6::zeros(); n])
}

/// The same by hand.
pub struct ByHand {
    links: Vec<Link>,
    joints: Vec<Joint>,
    moved: Vec<Link>,
}

/// Attitude, place, and momenta in the frame of the link.
#[derive(Clone, Copy)]
struct Link {
    turn: Matrix3<f64>,
    place: Vector3<f64>,
    spin: Vector3<f64>,
    push: Vector3<f64>,
}

/// λ, φ, and the factors of S.
#[derive(Clone, Copy)]
struct Joint {
    force: Vector3<f64>,
    open: Vector3<f64>,
    inverse: Matrix3<f64>,
    lower: Matrix3<f64>,
}

/// R a^ J⁻¹ (b^)ᵀ Rᵀ + 1/m
fn mobility(turn: &Matrix3<f64>, a: &Vector3<f64>, b: &Vector3<f64>) -> Matrix3<f64> {
    let inverse = Matrix3::from_diagonal(&INERTIA.map(f64::recip));
    turn * a.cross_matrix() * inverse * b.cross_matrix().transpose() * turn.transpose() + Matrix3::identity() / MASS
}

impl Link {
    /// The free step with a momentum: a(1 + |c|²) = Jc + c × Jc with a = hπ/2.
    fn moved(&self, spin: Vector3<f64>, push: Vector3<f64>) -> Link {
        let a = spin * (H / 2.0);
        let mut c = a.component_div(&INERTIA);
        for _ in 0..30 {
            let turned = INERTIA.component_mul(&c);
            let residual = turned + c.cross(&turned) - a * (1.0 + c.norm_squared());
            let slope = Matrix3::from_diagonal(&INERTIA) + c.cross_matrix() * Matrix3::from_diagonal(&INERTIA)
                - turned.cross_matrix()
                - a * (2.0 * c).transpose();
            let change = slope.try_inverse().expect("a regular slope") * residual;
            c -= change;
            if change.norm_squared() <= 1e-18 * c.norm_squared() {
                break;
            }
        }
        let hat = c.cross_matrix();
        let increment = (hat + hat * hat) * (2.0 / (1.0 + c.norm_squared()));
        let back = |momentum: Vector3<f64>| momentum + increment.tr_mul(&momentum);
        let turn = self.turn + self.turn * increment;
        let place = self.place + self.turn * (push * (H / MASS));
        Link { turn, place, spin: back(spin), push: back(push) }
    }

    fn weight(&self) -> Vector3<f64> {
        self.turn.transpose() * Vector3::new(0.0, 0.0, -MASS * GRAVITY * H / 2.0)
    }
}

impl ByHand {
    pub fn new(n: usize) -> Self {
        let zero = Vector3::zeros();
        let links: Vec<Link> =
            places(n).into_iter().map(|(turn, place)| Link { turn, place, spin: zero, push: zero }).collect();
        let joint = Joint { force: zero, open: zero, inverse: Matrix3::zeros(), lower: Matrix3::zeros() };
        Self { moved: links.clone(), joints: vec![joint; n], links }
    }

    pub fn places(&self) -> Vec<Vector3<f64>> {
        self.links.iter().map(|link| link.place).collect()
    }

    fn factor(&mut self) {
        for i in 0..self.links.len() {
            let turn = &self.links[i].turn;
            let mut block = mobility(turn, &NEAR, &NEAR);
            self.joints[i].lower = Matrix3::zeros();
            if i > 0 {
                let before = &self.links[i - 1].turn;
                block += mobility(before, &FAR, &FAR);
                let coupling = -mobility(before, &FAR, &NEAR);
                let lower = coupling * self.joints[i - 1].inverse;
                block -= lower * coupling.transpose();
                self.joints[i].lower = lower;
            }
            self.joints[i].inverse = block.try_inverse().expect("regular joints");
        }
    }

    /// Solves with the open joints in their place.
    fn solve(&mut self) {
        for i in 1..self.joints.len() {
            let known = self.joints[i].lower * self.joints[i - 1].open;
            self.joints[i].open -= known;
        }
        let mut after = Vector3::zeros();
        for i in (0..self.joints.len()).rev() {
            let Joint { inverse, open, .. } = self.joints[i];
            let solved = inverse * open - after;
            self.joints[i].open = solved;
            after = self.joints[i].lower.transpose() * solved;
        }
    }

    /// The momenta of a link with the forces of its joints.
    fn pushed(&self, i: usize, of: impl Fn(&Joint) -> Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let link = &self.links[i];
        let near = link.turn.transpose() * of(&self.joints[i]);
        let (mut spin, mut push) = (link.spin + NEAR.cross(&near), link.push + near);
        if let Some(joint) = self.joints.get(i + 1) {
            let far = link.turn.transpose() * of(joint);
            spin -= FAR.cross(&far);
            push -= far;
        }
        (spin, push)
    }

    pub fn step(&mut self) {
        let n = self.links.len();
        self.links.iter_mut().for_each(|link| link.push += link.weight());
        self.factor();
        self.joints.iter_mut().for_each(|joint| joint.force = Vector3::zeros());
        loop {
            let mut worst = 0.0_f64;
            let mut end = Vector3::zeros();
            for i in 0..n {
                let (spin, push) = self.pushed(i, |joint| joint.force);
                let moved = self.links[i].moved(spin, push);
                let open = moved.turn * NEAR + moved.place - end;
                worst = worst.max(open.amax() / (1.0 + moved.place.amax()));
                end = moved.turn * FAR + moved.place;
                (self.moved[i], self.joints[i].open) = (moved, open);
            }
            if worst <= 4.0 * f64::EPSILON {
                break;
            }
            self.solve();
            self.joints.iter_mut().for_each(|joint| joint.force -= joint.open / H);
        }
        std::mem::swap(&mut self.links, &mut self.moved);
        self.links.iter_mut().for_each(|link| link.push += link.weight());
        self.factor();
        let velocity = |link: &Link, at: &Vector3<f64>| {
            link.turn * (link.push / MASS + link.spin.component_div(&INERTIA).cross(at))
        };
        for i in 0..n {
            let before = if i > 0 { velocity(&self.links[i - 1], &FAR) } else { Vector3::zeros() };
            self.joints[i].open = before - velocity(&self.links[i], &NEAR);
        }
        self.solve();
        for i in 0..n {
            let (spin, push) = self.pushed(i, |joint| joint.open);
            (self.links[i].spin, self.links[i].push) = (spin, push);
        }
    }
}
