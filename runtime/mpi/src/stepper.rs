//! Steps of the rows of a field on one of many ranks.

use crate::Error;
use crate::numbers::count;
use crate::ranks::{Failure, Halo, LONGEST, Ranks};
#[cfg(feature = "serde")]
use clebsch::Scalar;
use clebsch::{
    Alike, Clebsch, Conserved, Conserves, Field, FieldState, FieldStepper, MovingField, Population, Real, SiteError,
    Slab, Space,
};
use mpi::traits::Equivalence;

type T<S> = <S as Clebsch>::Scalar;
type Q<S> = <S as Clebsch>::Configuration;
type Mu<S> = <S as Clebsch>::Momentum;
type Parts<S> = FieldState<Vec<Q<S>>, Vec<Mu<S>>, <S as Clebsch>::Time>;

/// So many moves of all sites are made until ranks ask each other whether one has failed.
const PATIENCE: u64 = 16;

/// What ends the steps of a rank when another one has failed. Nobody sees it: the error of that one is told.
const STOP: clebsch::Error = clebsch::Error::NotFinite { name: "the state of another rank" };

/// A rank resumes a state that is not its own.
#[cfg(feature = "serde")]
const FOREIGN: &str =
    "the rows of neighbours are not those that they have: let each rank resume the state that it saved";

/// All configurations and all momenta, in the order of the grid; `None` where they are not gathered.
pub type Gathered<S> = Option<(Vec<Q<S>>, Vec<Mu<S>>)>;

/// The rows of a field on this rank, with a step size. Made by [`Part::stepper`](crate::Part::stepper).
///
/// All ranks call its methods, in the same order.
pub struct PartStepper<S: Clebsch + Clone, const D: usize, P: Population = Alike> {
    ranks: Ranks,
    stepper: FieldStepper<S, Slab<T<S>, D>, P>,
}

/// The state of the rows of a field on this rank.
pub struct PartState<S: Clebsch> {
    field: Parts<S>,
    own: std::ops::Range<usize>,
    halo: Halo<T<S>>,
    failed: Option<Error>,
}

impl<S: Clebsch> PartState<S> {
    /// The configurations of the sites of this rank.
    pub fn configuration(&self) -> &[Q<S>] {
        self.field.configuration().get(self.own.clone()).unwrap_or_default()
    }

    /// The momenta of the sites of this rank.
    pub fn momentum(&self) -> &[Mu<S>] {
        self.field.momentum().get(self.own.clone()).unwrap_or_default()
    }

    /// The number of steps that it has made.
    pub fn steps(&self) -> u64 {
        self.field.steps()
    }

    /// The time t; 0 for a field that does not depend on it.
    pub fn time(&self) -> T<S> {
        self.field.time()
    }

    /// The state with the sites of neighbours, as `clebsch` has it. With its feature `serde` each rank can save its own.
    pub fn field(&self) -> &FieldState<Vec<Q<S>>, Vec<Mu<S>>, S::Time> {
        &self.field
    }
}

impl<S, P, const D: usize> PartStepper<S, D, P>
where
    S: Field<D> + MovingField + Clone,
    T<S>: Real + Equivalence,
    P: Population,
{
    pub(crate) fn new(ranks: Ranks, stepper: FieldStepper<S, Slab<T<S>, D>, P>) -> Result<Self, Error> {
        let all = Self { ranks, stepper };
        let numbers = all.numbers();
        // rows are alike on all ranks
        if numbers > LONGEST {
            return Err(Error::Message { numbers, most: LONGEST });
        }
        Ok(all)
    }

    /// How many numbers a message between neighbours has.
    fn numbers(&self) -> usize {
        let row = self.slab().row(self.slab().rows().start).map_or(0, |row| row.len());
        row.saturating_mul(S::REACH).saturating_mul(count::<T<S>, Q<S>>(&Space::origin()))
    }

    /// The rows of this rank, with those of neighbours.
    pub fn slab(&self) -> &Slab<T<S>, D> {
        self.stepper.lattice()
    }

    /// The stepper of this rank by itself.
    pub fn stepper(&self) -> &FieldStepper<S, Slab<T<S>, D>, P> {
        &self.stepper
    }

    /// The number of this rank, from 0 on.
    pub fn rank(&self) -> usize {
        self.ranks.rank()
    }

    /// The number of ranks.
    pub fn ranks(&self) -> usize {
        self.ranks.count()
    }

    /// The error of a site of this rank, with its number in the grid of all ranks.
    fn failure(&self, time: u64, SiteError { site, error }: SiteError) -> Failure {
        let slab = self.slab();
        // an error at a site of a neighbour is told by that one, if it has seen it
        let is_own = site.is_none_or(|site| slab.own().contains(&site));
        let site = site.and_then(|site| slab.grid().index(slab.place(site)?));
        (2 * time + u64::from(!is_own), site, error.to_string())
    }

    /// The state in which `site` gives the configuration and the momentum at each place of this rank. Where the time matters it
    /// starts at 0.
    ///
    /// # Errors
    /// [`Error::Field`] with the text of the errors of `FieldStepper::state`: the first site of the grid that has one.
    pub fn state(&self, mut site: impl FnMut([usize; D]) -> (Q<S>, Mu<S>)) -> Result<PartState<S>, Error> {
        let slab = self.slab();
        let (mut q, mut mu) = (vec![Space::origin(); slab.sites()], vec![Space::origin(); slab.sites()]);
        for number in slab.own() {
            if let (Some(place), Some(q), Some(mu)) = (slab.place(number), q.get_mut(number), mu.get_mut(number)) {
                (*q, *mu) = site(place);
            }
        }
        self.started(q, |q| self.stepper.state(q, mu))
    }

    /// The state that was saved by this rank, after the checks of [`state`](Self::state). The next steps have the bits that they would
    /// have had. The number of ranks is that of then.
    ///
    /// # Errors
    /// As [`state`](Self::state). [`Error::Differs`] for another number of steps or another time on another rank, and
    /// [`Error::Field`] where a rank resumes the state of another one.
    #[cfg(feature = "serde")]
    pub fn resume(&self, saved: clebsch::SavedField<Vec<Q<S>>, Vec<Mu<S>>, S::Time>) -> Result<PartState<S>, Error> {
        let mut state = self.started(Vec::new(), |_| self.stepper.resume(saved))?;
        self.ranks.agree(&[("the number of steps", state.steps() as f64), ("the time", state.time().to_f64())])?;
        let mut q = state.field.configuration().clone();
        state.halo.exchange(&self.ranks, self.slab(), S::REACH, &mut q);
        let is_its_own = q == *state.field.configuration();
        self.ranks.passed((!is_its_own).then(|| (0, None, FOREIGN.to_owned())))?;
        Ok(state)
    }

    /// A state whose neighbours have sent their sites.
    fn started(
        &self,
        mut q: Vec<Q<S>>,
        state: impl FnOnce(Vec<Q<S>>) -> Result<Parts<S>, SiteError>,
    ) -> Result<PartState<S>, Error> {
        let mut halo = Halo::new(self.numbers());
        halo.exchange(&self.ranks, self.slab(), S::REACH, &mut q);
        let field = self.ranks.common(state(q).map_err(|error| self.failure(0, error)))?;
        Ok(PartState { field, own: self.slab().own(), halo, failed: None })
    }

    /// On all ranks the state is that of this field.
    fn check(&self, state: &PartState<S>) -> Result<(), Error> {
        let (found, sites) = (state.field.configuration().len(), self.slab().sites());
        let is_own = found == sites && state.own == self.slab().own() && state.halo.numbers() == self.numbers();
        let error = clebsch::Error::NumberOfSites { found, sites };
        self.ranks.passed((!is_own).then(|| (0, None, error.to_string())))
    }

    /// One step, in place.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    pub fn step(&self, state: &mut PartState<S>) -> Result<(), Error> {
        self.advance(state, 1)
    }

    /// So many steps, in place, with the bits of `FieldStepper::advance`. No step allocates.
    ///
    /// # Errors
    /// [`Error::Differs`] for another number of steps on another rank. [`Error::Field`] with the error of the first part of a step
    /// that fails on any rank. The state is then that of no time: each further step gives the same error.
    pub fn advance(&self, state: &mut PartState<S>, steps: u64) -> Result<(), Error> {
        self.ranks.agree(&[("the number of steps", steps as f64)])?;
        self.check(state)?;
        if let Some(error) = &state.failed {
            return Err(error.clone());
        }
        let PartState { field, halo, .. } = state;
        let (mut moves, mut failure) = (0, None);
        let result = self.stepper.advance_exchanging(field, steps, |q, result| {
            moves += 1;
            // a rank that has failed still sends rows, so that its neighbours do not wait for ever
            if failure.is_none() {
                failure = result.err().map(|error| (moves, error));
            }
            halo.exchange(&self.ranks, self.slab(), S::REACH, q);
            if moves % PATIENCE == 0 && self.ranks.any(failure.is_some()) { Err(STOP.into()) } else { Ok(()) }
        });
        let failure = failure.or(result.err().map(|error| (moves + 1, error)));
        let result = self.ranks.passed(failure.map(|(moves, error)| self.failure(moves, error)));
        state.failed = result.as_ref().err().cloned();
        result
    }

    /// The kinetic energies of all sites of all ranks, their potentials, and the energies of all edges, in joules.
    ///
    /// The root adds the energies of rows in their order, so that the bits are those of `FieldStepper::energy`. All ranks have it.
    ///
    /// # Errors
    /// [`Error::Field`] for the state of another field.
    pub fn energy(&self, state: &PartState<S>) -> Result<T<S>, Error> {
        self.check(state)?;
        let rows = self.stepper.energy_of_rows(&state.field).map_err(|error| self.failure(0, error));
        let rows = self.ranks.common(rows)?.collect();
        let all = self.ranks.gather::<T<S>, T<S>>(rows, |rows| rows.len());
        let [total] = self.ranks.told([self.stepper.total(all.unwrap_or_default())]);
        Ok(total)
    }

    /// The momenta that no step changes, sums over all sites of all ranks, with the bits of `FieldStepper::conserved`. All ranks have them.
    ///
    /// # Errors
    /// As [`energy`](Self::energy).
    pub fn conserved<const K: usize>(&self, state: &PartState<S>) -> Result<Conserved<T<S>, K>, Error>
    where
        S: Conserves<Conserved = Conserved<T<S>, K>>,
    {
        self.check(state)?;
        let rows = self.stepper.conserved_of_rows(&state.field).map_err(|error| self.failure(0, error));
        let mut names = [""; K];
        let rows =
            self.ranks.common(rows)?.inspect(|momenta| names = *momenta.names()).map(|momenta| *momenta.values());
        let rows: Vec<[T<S>; K]> = rows.collect();
        let all = self.ranks.gather::<T<S>, [T<S>; K]>(rows, |rows| rows.len()).unwrap_or_default();
        let mut totals: [T<S>; K] = Space::origin();
        for (k, total) in totals.iter_mut().enumerate() {
            *total = self.stepper.total(all.iter().filter_map(|momenta| momenta.get(k).copied()));
        }
        Ok(Conserved::new(names, self.ranks.told(totals)))
    }

    /// The configurations and the momenta of all ranks in the order of the grid, on rank 0; `None` on the others.
    ///
    /// # Errors
    /// [`Error::Field`] for the state of another field.
    pub fn gather(&self, state: &PartState<S>) -> Result<Gathered<S>, Error> {
        self.check(state)?;
        let row = self.slab().own().len().checked_div(self.slab().rows().len()).unwrap_or(0);
        let q = self.ranks.gather::<T<S>, Q<S>>(state.configuration().to_vec(), |rows| row * rows.len());
        let mu = self.ranks.gather::<T<S>, Mu<S>>(state.momentum().to_vec(), |rows| row * rows.len());
        Ok(q.zip(mu))
    }
}
