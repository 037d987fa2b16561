//! The declaration, and two motions of the same sheet: of configurations, and of the elements of edges.

use clebsch::{Clebsch, ConnectionState, ConnectionStepper, Domain, Field, FieldStepper, Grid};
use clebsch_examples::claims::largest;
use clebsch_examples::integrate::FieldOf;
use clebsch_examples::scene::Failure;
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::f64::consts::TAU;

/// The principal chiral model: rotations with springs between neighbours.
#[derive(Clebsch, Clone, Debug)]
#[clebsch(
    action = |F: SO<3>, R: SO<3>| R * F,
    cost   = |h, F| (F - I).norm_squared() / (4 * h),
    space  = [
        |dx, W| (W - I).norm_squared() / (4 * dx.powi(2)),
        |dy, W| (W - I).norm_squared() / (4 * dy.powi(2)),
    ],
    emit   = [connection],
)]
pub struct Chiral;

/// A sheet that moves twice.
pub struct Sheet {
    pub domain: Domain<Chiral, Grid<f64, 2>>,
    sites: FieldStepper<Chiral, Grid<f64, 2>>,
    edges: ConnectionStepper<Chiral, Grid<f64, 2>>,
    pub by_sites: FieldOf<Chiral>,
    pub by_edges: ConnectionState<Chiral>,
}

/// Numbers of a sheet at one time.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub energy: f64,
    /// The total momentum in space.
    pub momentum: Vector3<f64>,
    /// The largest entry of curvature − I.
    pub flatness: f64,
    /// Between the elements and those of the configuration.
    pub apart: f64,
    /// Of WᵀW − I.
    pub orthogonality: f64,
}

impl Sheet {
    /// A periodic sheet, turned in two waves that go in different directions, at rest.
    ///
    /// # Errors
    /// Those of steppers and states.
    pub fn of(sites: usize, spacing: f64, h: f64, turn: f64) -> Result<Self, Failure> {
        let domain = Chiral.grid([sites; 2]).spacing([spacing; 2]).periodic();
        let place = |site: usize| [site / sites, site % sites].map(|i| TAU * i as f64 / sites as f64);
        let wave = |site: usize| {
            let [x, y] = place(site);
            let turns = [Vector3::x() * x.sin(), Vector3::new(0.0, 0.6, 0.8) * (x + y).cos()];
            turns.iter().fold(Rotation3::identity(), |all, own| all * Rotation3::new(own * turn)).into_inner()
        };
        let q: Vec<Matrix3<f64>> = (0..sites * sites).map(wave).collect();
        let mu = vec![Vector3::zeros(); q.len()];
        let (by_sites, by_edges) = (domain.clone().stepper(h)?, domain.connection(h)?);
        let elements = domain.edge_elements(&q)?;
        Ok(Self {
            by_edges: by_edges.state(elements, mu.clone())?,
            by_sites: by_sites.state(q, mu)?,
            domain,
            sites: by_sites,
            edges: by_edges,
        })
    }

    /// So many steps of both.
    ///
    /// # Errors
    /// Those of steps.
    pub fn advance(&mut self, steps: u64) -> Result<(), Failure> {
        let reached = self.by_edges.steps() + 1;
        self.sites.advance(&mut self.by_sites, steps).map_err(Failure::step(reached))?;
        self.edges.advance(&mut self.by_edges, steps).map_err(Failure::step(reached))
    }

    /// # Errors
    /// Those of energies.
    pub fn seen(&self) -> Result<Seen, Failure> {
        let elements = self.by_edges.elements();
        let expected = self.domain.edge_elements(self.by_sites.configuration())?;
        let off = |w: &Matrix3<f64>| (w.transpose() * w - Matrix3::identity()).amax();
        let momenta = self.by_sites.configuration().iter().zip(self.by_edges.momentum());
        Ok(Seen {
            energy: self.edges.energy(&self.by_edges)?,
            momentum: momenta.map(|(q, mu)| q * mu).sum(),
            flatness: self.domain.flatness(elements)?,
            apart: largest(elements.iter().zip(&expected).map(|(w, expected)| (w - expected).amax())),
            orthogonality: largest(elements.iter().map(off)),
        })
    }

    /// The configuration from the elements and the place of one site, and by how much others differ from those that moved themselves.
    ///
    /// # Errors
    /// [`clebsch::Error::NotFlat`].
    pub fn reconstructed(&self) -> Result<(Vec<Matrix3<f64>>, f64), Failure> {
        let q = self.by_sites.configuration();
        let found = self.domain.reconstruct(self.by_edges.elements(), (0, q[0]), 1e-9)?;
        let off = largest(found.iter().zip(q).map(|(found, q)| (found - q).amax()));
        Ok((found, off))
    }
}
