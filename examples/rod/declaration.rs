//! The declaration, and the flying rod of Simo and Vu-Quoc.

use crate::beam::{Beam, ENDS};
use clebsch::{Clebsch, Domain, Field, FieldState, FieldStepper, Grid, MidpointStepper, Various};
use clebsch_examples::integrate::FieldOf;
use nalgebra::{Matrix3, Matrix4, SVector, Vector3, Vector4, Vector6};

/// Rigid sections in space along a rod that bends, turns, stretches and shears. A force and a moment push a section, both
/// with fixed directions in space.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SE<3>, q: SE<3>| q * F,
    cost   = |h, F| ((F - I) * Matrix4::from_diagonal(&self.section) * (F - I).transpose()).trace() / (2 * h),
    space  = |ds, W| {
        let strain = W.cayley() / ds - self.reference;
        ds * strain.dot(&self.stiffness.component_mul(&strain)) / 2
    },
    force  = |q, load: SVector<6>| {
        let moment = q.rotation().transpose() * load.fixed_rows::<3>(0);
        let push = q.rotation().transpose() * load.fixed_rows::<3>(3);
        vector![moment.x, moment.y, moment.z, push.x, push.y, push.z]
    },
    emit   = [midpoint],
)]
pub struct Rod {
    /// Principal second moments and mass of a section, kg·m² and kg.
    pub section: Vector4<f64>,
    /// EI, EI, GJ in N·m², GA, GA, EA in N.
    pub stiffness: SVector<f64, 6>,
    /// Curvature in 1/m and tangent where the rod has no load.
    pub reference: SVector<f64, 6>,
}

/// Steps of a rod.
pub type Steps = FieldStepper<Rod, Grid<f64, 1>, Various>;
/// Sections of a rod.
pub type Sections = FieldOf<Rod>;

impl Beam {
    /// A section with this part of the mass of an inner one.
    pub fn rod(&self, edges: usize, part: f64) -> Rod {
        let ds = self.spacing(edges) * part;
        let moment = self.inertia * ds / 2.0;
        Rod {
            section: Vector4::new(moment, moment, moment, self.mass * ds),
            stiffness: Vector6::new(self.bending, self.bending, self.torsion, self.shear, self.shear, self.axial),
            reference: Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        }
    }

    /// A rod with so many edges; its end sections have half a mass.
    fn domain(&self, edges: usize) -> Domain<Rod, Grid<f64, 1>, Various> {
        let part = |i: usize| if i == 0 || i == edges { 0.5 } else { 1.0 };
        let domain = self.rod(edges, 1.0).grid([edges + 1]).spacing([self.spacing(edges)]);
        domain.various(|[i]| self.rod(edges, part(i)))
    }

    /// Steps of a rod with so many edges.
    ///
    /// # Errors
    /// Those of a stepper.
    pub fn steps(&self, edges: usize, h: f64) -> Result<Steps, clebsch::Error> {
        self.domain(edges).stepper(h)
    }

    /// Implicit steps of a rod with so many edges.
    ///
    /// # Errors
    /// Those of a stepper.
    pub fn implicit(&self, edges: usize, h: f64) -> Result<MidpointStepper<Rod, Various>, clebsch::Error> {
        self.domain(edges).midpoint(h)
    }

    /// A step that is stable for small strains, s.
    ///
    /// # Errors
    /// None of a rod with a mass.
    pub fn stable_step(&self, edges: usize) -> Result<f64, clebsch::SiteError> {
        self.domain(edges).stable_step(&self.straight(edges))
    }

    /// A straight rod between its ends in the plane of x and y, its first axis along z.
    pub fn straight(&self, edges: usize) -> Vec<Matrix4<f64>> {
        let [from, to] = ENDS.map(|[x, y]| Vector3::new(x, y, 0.0));
        let tangent = (to - from).normalize();
        let turn = Matrix3::from_columns(&[Vector3::z(), tangent.cross(&Vector3::z()), tangent]);
        let place = |i: usize| {
            let mut place = turn.to_homogeneous();
            place.fixed_view_mut::<3, 1>(0, 3).copy_from(&(from + tangent * (self.spacing(edges) * i as f64)));
            place
        };
        (0..=edges).map(place).collect()
    }
}

/// Where a section is, metres.
pub fn centre(q: &Matrix4<f64>) -> Vector3<f64> {
    q.fixed_view::<3, 1>(0, 3).into_owned()
}

/// Total momentum and total angular momentum about the origin.
pub fn momenta<Time>(state: &FieldState<Vec<Matrix4<f64>>, Vec<SVector<f64, 6>>, Time>) -> [Vector3<f64>; 2] {
    let mut sum = [Vector3::zeros(); 2];
    for (q, mu) in state.configuration().iter().zip(state.momentum()) {
        let turn = q.fixed_view::<3, 3>(0, 0);
        let push = turn * mu.fixed_rows::<3>(3);
        sum[0] += push;
        sum[1] += turn * mu.fixed_rows::<3>(0) + centre(q).cross(&push);
    }
    sum
}

/// A rod at rest: steps go along it, and h is the length of an edge. Strains are logarithms, and a force with a fixed
/// direction pulls its end.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action         = |W: SE<3>, q: SE<3>| q * W,
    lagrangian     = |xi| (xi - self.reference).dot(&self.stiffness.component_mul(&(xi - self.reference))) / 2,
    discretization = exponential,
    endpoint       = |q| -self.pull.dot(&q.translation()),
    emit           = [boundary],
)]
pub struct StaticRod {
    /// EI, EI, GJ in N·m², GA, GA, EA in N.
    pub stiffness: SVector<f64, 6>,
    /// Curvature in 1/m and tangent where the rod has no load.
    pub reference: SVector<f64, 6>,
    /// Newtons.
    pub pull: Vector3<f64>,
}
