//! Fields at rest on grids, by multigrid: as many cycles whatever the number of sites.

mod coarse;
mod level;
mod slopes;

use super::{Domain, Field, Grid, Population, Relaxation, Relaxed, StaticField};
use crate::parts::{Q, T};
use crate::space::larger;
use crate::{Clebsch, Error, Real, Scalar, SiteError};
use alloc::vec::Vec;
use level::Level;
use nalgebra::SVector;
use num_traits::Zero;

/// The most cycles as provided.
const CYCLES: u64 = 100;

/// How a field on a grid is relaxed by multigrid. Made by [`Relaxation::multigrid`].
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
/// // the height of a side is the square of the distance along it
/// for n in [17_usize, 33] {
///     let film = Film.grid([n, n]).fixed();
///     let side = |site: usize| if film.lattice().is_fixed(site) { ((site % n) as f64).powi(2) } else { 0.0 };
///     let mut height: Vec<_> = (0..n * n).map(|site| Vector1::new(side(site))).collect();
///     let found = film.relax().multigrid().solve(&mut height)?;
///     assert!(found.sweeps() <= 4 * 12);
/// }
/// # Ok::<(), clebsch::SiteError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Multigrid<'a, S: Clebsch + Clone, const D: usize, P: Population> {
    domain: &'a Domain<S, Grid<T<S>, D>, P>,
    tolerance: T<S>,
    cycles: u64,
}

impl<'a, S: StaticField<Scalar: Real> + Field<D> + Clone, P: Population, const D: usize>
    Relaxation<'a, S, Grid<T<S>, D>, P>
{
    /// Relaxation by cycles over this grid and coarser ones, with this tolerance. It has its own most cycles, and no factor of
    /// over-relaxation: those given before are not read.
    pub fn multigrid(self) -> Multigrid<'a, S, D, P> {
        Multigrid { domain: self.domain, tolerance: self.tolerance, cycles: CYCLES }
    }
}

impl<S: Clebsch + Clone, P: Population, const D: usize> Multigrid<'_, S, D, P> {
    /// The same with another tolerance: the largest correction of a cycle, by its last sweeps or by the coarser grid. It is in the
    /// coordinates of the group. As provided it is that of the relaxation, see [`Relaxation::tolerance`].
    #[must_use]
    pub fn tolerance(self, tolerance: T<S>) -> Self {
        Self { tolerance, ..self }
    }

    /// The same with at most so many cycles; 100 as provided.
    #[must_use]
    pub fn cycles(self, cycles: u64) -> Self {
        Self { cycles, ..self }
    }
}

impl<S, P: Population, const M: usize, const D: usize> Multigrid<'_, S, D, P>
where
    S: StaticField<Momentum = SVector<<S as Clebsch>::Scalar, M>> + Field<D> + Clone,
    T<S>: Real,
{
    /// Moves the sites to rest, in place, from this guess. Sites that are fixed stay where they are.
    ///
    /// A cycle makes two sweeps, a correction by the grid with every second site, and two sweeps. That grid does the same by a still
    /// coarser one. It starts from the same configuration, and has the forces of the finer one as loads. Its motions ξ are interpolated:
    ///
    /// ```text
    /// q ← exp(w I ξ)·q,    w = f·Iξ / Iξ·H·Iξ
    /// ```
    ///
    /// w brings the energy down most, by the forces f and the second derivatives H. After a cycle the same is done along its motions and
    /// those of the last one. About ten cycles bring all corrections below 10⁻¹⁰, whatever the number of sites. More are needed where a
    /// mode has hardly any stiffness, as the size of an instanton.
    ///
    /// Any sizes go. A direction whose neighbours are coupled much more weakly than those of another is not coarsened at first.
    /// Energies of edges may be for each length (1/dx), for each site (1/dx²), or without a length. Parameters of sites are those of
    /// every second one.
    ///
    /// It allocates two configurations and five momenta for each site of the grid, at most, and fewer for the coarser ones.
    ///
    /// Source: Brandt, *Multi-level adaptive solutions to boundary-value problems*, Mathematics of Computation 31 (1977) (the full
    /// approximation scheme).
    ///
    /// # Errors
    /// As [`Relaxation::solve`]; the sweeps of [`Error::NotRelaxed`] are those of the finest grid.
    pub fn solve(&self, configuration: &mut [Q<S>]) -> Result<Relaxed<T<S>>, SiteError> {
        self.domain.relax().check(configuration)?;
        let mut levels = Level::all(self.domain, configuration);
        let mut last = Vec::new();
        let (mut sweeps, mut correction) = (0, T::<S>::zero());
        for _ in 0..self.cycles {
            let result = level::cycle(&mut levels);
            let Some(finest) = levels.first_mut() else { break };
            let more = finest.accelerate(&mut last);
            configuration.copy_from_slice(&finest.q);
            sweeps += level::SWEEPS;
            correction = larger(result?, more);
            if correction <= self.tolerance {
                return Ok(Relaxed::of(&self.domain.configured(configuration), sweeps, correction));
            }
        }
        Err(Error::NotRelaxed { sweeps, correction: correction.to_f64(), tolerance: self.tolerance.to_f64() }.into())
    }
}
