//! The multisymplectic formula: linearised solutions pair to zero over the border of every region.

use super::{Domain, FieldSite, Lattice, Population};
use crate::parts::{Mu, Q, T};
use crate::{Clebsch, Error, SiteError};
use nalgebra::SVector;
use num_traits::Zero;

impl<S, G, P: Population, const M: usize> Domain<S, G, P>
where
    S: FieldSite<Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    G: Lattice<S>,
{
    /// The sum of the forms Ω_v(V, W) over the sites v at the border of a region, for motions V and W of all sites.
    ///
    /// It is 0 where the configuration is at rest inside, and V and W are linearised solutions. Those are motions after which it still
    /// is at rest, to first order. A region is the sites for which `is_inside` says so, with the edges between them. A site is at its border if it has
    /// an edge to another site, or if it is fixed. V and W are in the coordinates of the group, as
    /// [`edge_forces_along`](super::Field::edge_forces_along) takes them.
    ///
    /// ```text
    /// Ω_v(V, W) = Σ over edges of v in the region, to w, of W_v · ∂f_v/∂q_w V_w − V_v · ∂f_v/∂q_w W_w
    /// ```
    ///
    /// Changes of f_v by motions of v itself have no part in it. They would bring a bracket of V_v and W_v. Where all edges of v are in the
    /// region, they cancel as f_v = 0.
    ///
    /// ```
    /// use clebsch::{Clebsch, Field};
    /// use nalgebra::Vector1;
    ///
    /// /// A film over a frame, its height x.
    /// #[derive(Clebsch, Clone, Debug)]
    /// #[clebsch(
    ///     action = |a: Translation<1>, x: Vector1| x + a,
    ///     space  = [|dx, x, next| (next - x).norm_squared() / 2, |dy, x, next| (next - x).norm_squared() / 2],
    /// )]
    /// struct Film;
    ///
    /// let film = Film.grid([6, 6]).fixed();
    /// let rest = [Vector1::new(0.0); 36];
    /// // harmonic: ij and i² − j²
    /// let motion = |f: fn(f64, f64) -> f64| core::array::from_fn::<_, 36, _>(|site| Vector1::new(f((site / 6) as f64, (site % 6) as f64)));
    /// let (v, w) = (motion(|i, j| i * j), motion(|i, j| i * i - j * j));
    /// let sum = film.multisymplectic(&rest, [&v, &w], |site| site % 6 < 4)?;
    /// assert!(sum.abs() < 1e-12);
    /// // i² is not harmonic
    /// let other = motion(|i, _| i * i);
    /// assert!(film.multisymplectic(&rest, [&v, &other], |site| site % 6 < 4)?.abs() > 1.0);
    /// # Ok::<(), clebsch::SiteError>(())
    /// ```
    ///
    /// Source: Marsden, Patrick and Shkoller, *Multisymplectic geometry, variational integrators, and nonlinear PDEs*,
    /// Communications in Mathematical Physics 199 (1998), §5.
    ///
    /// # Errors
    /// [`Error::NumberOfSites`] for configurations or motions of another number than the sites.
    pub fn multisymplectic(
        &self,
        q: &[Q<S>],
        motions: [&[Mu<S>]; 2],
        mut is_inside: impl FnMut(usize) -> bool,
    ) -> Result<T<S>, SiteError> {
        let (lattice, field) = (self.lattice(), self.configured(q));
        let sites = lattice.sites();
        if let Some(found) = [q.len(), motions[0].len(), motions[1].len()].into_iter().find(|found| *found != sites) {
            return Err(Error::NumberOfSites { found, sites }.into());
        }
        let (none, [v, w]) = (SVector::zeros(), motions);
        let mut total = T::<S>::zero();
        for site in 0..sites {
            if !is_inside(site) {
                continue;
            }
            let (mut form, mut is_at_border) = (T::<S>::zero(), lattice.is_fixed(site));
            lattice.visit_edges(site, |edge, end| {
                let other = edge.ends[1 - end];
                if !is_inside(other) {
                    is_at_border = true;
                    return;
                }
                let (Some((system, q)), Some(own), Some(next)) =
                    (field.ends(edge), v.get(site).zip(w.get(site)), v.get(other).zip(w.get(other)))
                else {
                    return;
                };
                // the change of the force on this end by a motion of the other one
                let change = |motion: &Mu<S>| {
                    let along = if end == 0 { [&none, motion] } else { [motion, &none] };
                    let (before, after) = lattice.forces_along(system, edge, q, along);
                    if end == 0 { before } else { after }
                };
                form += own.1.dot(&change(next.0)) - own.0.dot(&change(next.1));
            });
            if is_at_border {
                total += form;
            }
        }
        Ok(total)
    }
}
