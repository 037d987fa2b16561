//! The local law of a conserved momentum: the gain of a site in a step flows in over its edges.

use super::{FieldSite, FieldState, FieldStepper, Lattice, Population};
use crate::parts::{Mu, Q, T};
use crate::{Conserved, Conserves, Error, Scalar, SiteError};
use num_traits::Zero;

impl<S: FieldSite + Clone, G: Lattice<S>, P: Population> FieldStepper<S, G, P> {
    /// One step, in place, with the residuals of the local conservation laws of this step. They are for each site
    ///
    /// ```text
    /// J(q⁺, N⁺) − J(q, N) − Σ over edges from it of φ + Σ over edges to it of φ
    /// ```
    ///
    /// J are the momenta of [`conserved`](Self::conserved), in its order. The flow φ over an edge is J of the impulse on the site that
    /// it starts from. Each flow out of a site goes into another one: the sum of some sites changes over its border alone.
    ///
    /// The residuals are rounding errors, at each site and not only in the sum. Those of sites on a fixed side are 0: momentum leaves
    /// the field there. Where an energy lacks the symmetry, J is not in `conserved`.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::Vector3;
    ///
    /// /// Waves of unit vectors along a line.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |F: SO<3>, q: Unit<Vector3>| F * q,
    ///     cost   = |h, F| (F - I).norm_squared() / (4 * h),
    ///     space  = |dx, q, next| (next - q).norm_squared() / (2 * dx.powi(2)),
    /// )]
    /// struct Waves;
    ///
    /// let stepper = Waves.grid([3]).spacing([0.1]).stepper(0.05)?;
    /// let mut state = stepper.state([Vector3::x(), Vector3::y(), Vector3::z()], [Vector3::zeros(); 3])?;
    /// let mut residuals = [[0.0; 3]; 3]; // three components for each of three sites
    /// stepper.step_with_residuals(&mut state, &mut residuals)?;
    /// assert!(residuals.iter().flatten().all(|residual| residual.abs() < 1e-13));
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// Source: Marsden, Patrick and Shkoller, *Multisymplectic geometry, variational integrators, and nonlinear PDEs*,
    /// Communications in Mathematical Physics 199 (1998), §5 (the discrete theorem of Noether).
    ///
    /// # Errors
    /// As [`step`](Self::step); [`Error::NumberOfSites`] for residuals of another number, the state is then unchanged.
    pub fn step_with_residuals<Points, Momenta, const K: usize>(
        &self,
        state: &mut FieldState<Points, Momenta, S::Time>,
        residuals: &mut [[T<S>; K]],
    ) -> Result<(), SiteError>
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
        Points: AsRef<[Q<S>]> + AsMut<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]> + AsMut<[Mu<S>]>,
    {
        let (found, sites) = (residuals.len(), self.lattice().sites());
        if found != sites {
            return Err(Error::NumberOfSites { found, sites }.into());
        }
        residuals.fill([Zero::zero(); K]);
        self.add_momenta(state, -1.0, residuals)?;
        self.step_visited(state, |weight, q| self.add_flows(weight, q, residuals))?;
        self.add_momenta(state, 1.0, residuals)?;
        let fixed = residuals.iter_mut().enumerate().filter(|(site, _)| self.lattice().is_fixed(*site));
        fixed.for_each(|(_, residual)| *residual = [Zero::zero(); K]);
        Ok(())
    }

    /// Adds the momenta of each site, times a sign.
    fn add_momenta<Points, Momenta, const K: usize>(
        &self,
        state: &FieldState<Points, Momenta, S::Time>,
        sign: f64,
        residuals: &mut [[T<S>; K]],
    ) -> Result<(), SiteError>
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
        Points: AsRef<[Q<S>]>,
        Momenta: AsRef<[Mu<S>]>,
    {
        let (q, mu) = self.parts(state)?;
        for (((q, mu), system), residual) in q.iter().zip(mu).zip(self.each()).zip(residuals) {
            add(residual, T::<S>::from_f64(sign), &system.conserved(q, mu));
        }
        Ok(())
    }

    /// Takes the flows over all edges during a kick from each residual.
    fn add_flows<const K: usize>(&self, weight: T<S>, q: &[Q<S>], residuals: &mut [[T<S>; K]])
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
    {
        let field = self.configured(q);
        for (site, residual) in residuals.iter_mut().enumerate() {
            self.lattice().visit_edges(site, |edge, end| {
                let Some((system, q)) = field.ends(edge) else { return };
                let flow = system.conserved(q[0], &self.lattice().forces(system, edge, q).0);
                add(residual, if end == 0 { -weight } else { weight }, &flow);
            });
        }
    }
}

/// Adds momenta times a weight.
fn add<T: Scalar, const K: usize>(sum: &mut [T; K], weight: T, momenta: &Conserved<T, K>) {
    for (sum, (_, momentum)) in sum.iter_mut().zip(momenta.iter()) {
        *sum += weight * momentum;
    }
}
