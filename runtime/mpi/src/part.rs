//! The rows of a field on one of many ranks, before it has a step size.

use crate::ranks::Ranks;
use crate::{Error, PartStepper};
use clebsch::{Alike, Clebsch, Domain, Field, Grid, MovingField, Population, Real, Scalar, Side, Sides, Slab, Various};
use mpi::traits::{Communicator, Equivalence};

/// The rows of a field on this rank. Made by [`slab`].
pub struct Part<S: Clebsch + Clone, const D: usize, P: Population = Alike> {
    ranks: Ranks,
    domain: Domain<S, Slab<S::Scalar, D>, P>,
}

/// Shares the rows of a field on a grid evenly among the ranks of a communicator. All ranks call it.
///
/// A row is all sites with one place in the first direction. The messages of the field go through a copy of the communicator.
///
/// # Errors
/// * [`Error::Ranks`] for more ranks than the grid has rows for.
/// * [`Error::Differs`] for another grid on another rank.
/// * [`Error::Field`] for an empty grid, or for a wrong spacing.
pub fn slab<S, P, const D: usize>(
    world: &impl Communicator,
    field: &Domain<S, Grid<S::Scalar, D>, P>,
) -> Result<Part<S, D, P>, Error>
where
    S: Field<D> + Clone,
    S::Scalar: Real + Equivalence,
    P: Population,
{
    let grid = field.lattice();
    let rows = grid.sizes().first().copied().unwrap_or(0);
    let ranks = Ranks::new(world, rows);
    ranks.agree(&grid.sizes().map(|size| ("the size of a direction", size as f64)))?;
    ranks.agree(&grid.spacings().map(|spacing| ("the spacing of a direction", spacing.to_f64())))?;
    ranks.agree(&grid.all_sides().map(|sides| ("the sides of a direction, by their number", number(sides))))?;
    let needed = S::REACH.max(1);
    // a grid without rows has an error of its own
    if rows > 0 && rows / ranks.count() < needed {
        return Err(Error::Ranks { ranks: ranks.count(), rows, needed });
    }
    let domain = ranks.common(field.slab(ranks.own()).map_err(|error| (0, None, error.to_string())))?;
    Ok(Part { ranks, domain })
}

/// A number for each kind of sides.
fn number(sides: Sides) -> f64 {
    let is_fixed = |side: Side| f64::from(u8::from(side == Side::Fixed));
    match sides {
        Sides::Periodic => 0.0,
        Sides::Open(first, last) => 1.0 + is_fixed(first) + 2.0 * is_fixed(last),
    }
}

impl<S: Field<D> + Clone, P: Population, const D: usize> Part<S, D, P> {
    /// The rows of this rank, with those of neighbours.
    pub fn lattice(&self) -> &Slab<S::Scalar, D> {
        self.domain.lattice()
    }

    /// A stepper of step size `h`, the same on all ranks. All ranks call it.
    ///
    /// # Errors
    /// [`Error::Differs`] for another step size on another rank. [`Error::Field`] with the text of the errors of `Domain::stepper`.
    pub fn stepper(self, h: S::Scalar) -> Result<PartStepper<S, D, P>, Error>
    where
        S: MovingField,
        S::Scalar: Real + Equivalence,
    {
        let Self { ranks, domain } = self;
        ranks.agree(&[("the step size", h.to_f64())])?;
        let stepper = ranks.common(domain.stepper(h).map_err(|error| (0, None, error.to_string())))?;
        PartStepper::new(ranks, stepper)
    }
}

impl<S: Field<D> + Clone, const D: usize> Part<S, D> {
    /// The same with parameters for each site by its place in the grid, as `Domain::various`.
    ///
    /// `site` is called for the sites of this rank and for those of neighbours.
    pub fn various(self, site: impl FnMut([usize; D]) -> S) -> Part<S, D, Various> {
        Part { ranks: self.ranks, domain: self.domain.various(site) }
    }
}
