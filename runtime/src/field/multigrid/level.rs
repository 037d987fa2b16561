//! The grids of a multigrid, and one cycle over them.

use super::coarse::{Between, Coarse};
use crate::field::edges::{Configured, Placed};
use crate::field::relaxation::{ROUNDINGS, Rate, sweep};
use crate::field::{Domain, Field, Grid, Population};
use crate::parts::{Mu, Q, T};
use crate::space::larger;
use crate::{Clebsch, Real, Scalar, SiteError, Space};
use alloc::vec::Vec;
use core::marker::PhantomData;
use nalgebra::SVector;
use num_traits::{One, Zero};

/// Sweeps before and after the correction by the coarser grid.
const BEFORE: u64 = 2;
const AFTER: u64 = 2;
/// Sweeps over the finest grid in a cycle.
pub(super) const SWEEPS: u64 = BEFORE + AFTER;
/// The most sweeps over the coarsest grid, and how far corrections shrink there.
const SETTLING: u64 = 64;
const SETTLED: f64 = 1e-2;
/// A direction is coarsened where its neighbours are coupled by more than this part of the strongest coupling.
const STRONG: f64 = 0.4;
/// Halvings of a correction that raises the energy, at most.
const HALVINGS: usize = 4;

/// One grid.
///
/// On a coarser one the field is at rest where its own forces and `load` cancel. The load makes it start from rest where the finer one
/// is at rest:
///
/// ```text
/// load = R(forces of the finer grid) − forces of this one at the start
/// ```
///
/// R, the transpose of linear interpolation, adds the forces of the rows nearby.
pub(super) struct Level<S: Clebsch + Clone, const D: usize, P: Population> {
    systems: P::Of<S>,
    lattice: Coarse<T<S>, D>,
    pub q: Vec<Q<S>>,
    /// The forces from the finer grid; none on the finest.
    load: Vec<Mu<S>>,
    /// The motions of all sites since the start, in the coordinates of the group.
    motion: Vec<Mu<S>>,
    /// The sites of the finer grid that these are, and all of its rows between those of this one.
    chosen: Vec<usize>,
    places: [Vec<Between<T<S>>>; D],
}

impl<S, P: Population, const D: usize, const M: usize> Level<S, D, P>
where
    S: Field<D, Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    T<S>: Real,
{
    /// The grid of a field, and all coarser ones.
    pub fn all(domain: &Domain<S, Grid<T<S>, D>, P>, q: &[Q<S>]) -> Vec<Self> {
        let (grid, field) = (domain.lattice(), domain.configured(q));
        let double = grid.spacing(grid.spacings().map(|spacing| spacing * T::<S>::from_ratio(2, 1)));
        let (short, long): ([_; D], [_; D]) = (field.couplings(grid), field.couplings(&double));
        let powers = core::array::from_fn(|d| lacking_power(short[d], long[d]));
        let finest = Self {
            systems: domain.systems().clone(),
            lattice: Coarse::finest(*grid).scaled(powers),
            q: q.to_vec(),
            load: Vec::new(),
            motion: alloc::vec![SVector::zeros(); q.len()],
            chosen: Vec::new(),
            places: core::array::from_fn(|_| Vec::new()),
        };
        let mut next = finest.coarser();
        let mut levels = alloc::vec![finest];
        while let Some(level) = next {
            next = level.coarser();
            levels.push(level);
        }
        levels
    }

    /// The next coarser grid, if there is one. A direction that is coupled weakly stays as it is: sweeps do not smooth along it.
    fn coarser(&self) -> Option<Self> {
        let couplings: [_; D] = self.configured().couplings(&self.lattice);
        let can = |d: &usize| self.lattice.can_coarsen(*d);
        let strongest = (0..D).filter(can).fold(T::<S>::zero(), |strongest, d| larger(strongest, couplings[d]));
        let least = strongest * T::<S>::from_f64(STRONG);
        let coarsens = core::array::from_fn(|d| can(&d) && couplings[d] >= least);
        if !coarsens.contains(&true) {
            return None;
        }
        let (lattice, places) = self.lattice.coarser(coarsens);
        // the site of the finer grid at each place
        let rows = places.each_ref().map(|rows| {
            let is_chosen = |(_, between): &(usize, &Between<T<S>>)| between[0].1 == T::<S>::one();
            rows.iter().enumerate().filter(is_chosen).map(|(row, _)| row).collect::<Vec<_>>()
        });
        let finer = self.lattice.grid();
        let site = |coarse: usize| {
            let place = lattice.grid().split(coarse);
            let place = core::array::from_fn(|d| rows[d].get(place[d]).copied().unwrap_or(0));
            finer.index(place).unwrap_or(0)
        };
        let chosen: Vec<usize> = (0..lattice.grid().sites()).map(site).collect();
        let none = alloc::vec![SVector::zeros(); chosen.len()];
        let q = chosen.iter().filter_map(|site| self.q.get(*site).copied()).collect();
        let systems = P::some(&self.systems, chosen.iter().copied());
        Some(Self { systems, lattice, q, load: none.clone(), motion: none, chosen, places })
    }

    fn configured(&self) -> Configured<'_, S, Coarse<T<S>, D>, P> {
        let (systems, lattice, load) = (self.systems.as_ref(), &self.lattice, Some(&self.load[..]));
        Configured { systems, lattice, load, q: &self.q, population: PhantomData }
    }

    /// Moves each site once. Returns the largest motion.
    fn sweep(&mut self, factor: T<S>) -> Result<(T<S>, T<S>), SiteError> {
        let (load, motions) = (Some(&self.load[..]), &mut self.motion);
        let placed =
            Placed { systems: self.systems.as_ref(), lattice: &self.lattice, load, population: PhantomData::<P> };
        sweep(&placed, &mut self.q, factor, |site, motion| {
            if let Some(sum) = motions.get_mut(site) {
                *sum += motion;
            }
        })
    }

    /// Comes to rest, more or less.
    fn settle(&mut self) -> Result<T<S>, SiteError> {
        let (mut rate, mut first) = (Rate::new(None), None);
        for _ in 0..SETTLING {
            let (largest, squares) = self.sweep(rate.factor)?;
            if largest <= *first.get_or_insert(largest) * T::<S>::from_f64(SETTLED) {
                break;
            }
            rate.judge(squares.sqrt());
        }
        Ok(first.unwrap_or(T::<S>::zero()))
    }

    /// Visits the sites of this grid around one of the finer grid, with the weights of interpolation.
    fn around(&self, finer: &Grid<T<S>, D>, site: usize, mut visit: impl FnMut(usize, T<S>)) {
        let place = finer.split(site);
        for corner in 0..1_usize << D {
            let (mut number, mut weight) = ([0; D], T::<S>::one());
            for d in 0..D {
                let between = self.places[d].get(place[d]).map(|between| between[corner >> d & 1]);
                let (row, own) = between.unwrap_or((0, T::<S>::zero()));
                number[d] = row;
                weight *= own;
            }
            if let Some(number) = self.lattice.grid().index(number).filter(|_| !weight.is_zero()) {
                visit(number, weight);
            }
        }
    }

    /// Starts from the configuration of the finer grid, with its forces as a load.
    fn start(&mut self, finer: &Self) {
        for (q, site) in self.q.iter_mut().zip(&self.chosen) {
            if let Some(own) = finer.q.get(*site) {
                *q = *own;
            }
        }
        self.motion.fill(SVector::zeros());
        self.load.fill(SVector::zeros());
        let field = self.configured();
        let mut load: Vec<Mu<S>> = (0..self.q.len()).map(|site| -field.force_at(site)).collect();
        let field = finer.configured();
        for site in (0..finer.q.len()).filter(|site| !finer.lattice.grid().is_fixed(*site)) {
            let force = field.force_at(site);
            self.around(finer.lattice.grid(), site, |number, weight| {
                if let Some(load) = load.get_mut(number) {
                    *load += force * weight;
                }
            });
        }
        self.load = load;
    }

    /// Moves as the coarser grid did, as far as the energy falls most. Returns the largest motion.
    fn correct(&mut self, coarser: &Self) -> T<S> {
        let grid = self.lattice.grid();
        let mut motions: Vec<Mu<S>> = alloc::vec![SVector::zeros(); self.q.len()];
        for (site, motion) in motions.iter_mut().enumerate().filter(|(site, _)| !grid.is_fixed(*site)) {
            coarser.around(grid, site, |number, weight| {
                *motion += coarser.motion.get(number).copied().unwrap_or_else(SVector::zeros) * weight;
            });
        }
        let factor = self.configured().slopes([&motions, &[]]).least_along_first();
        factor.map_or_else(T::<S>::zero, |factor| self.go(&motions, factor))
    }

    /// Moves all sites by a factor times these motions, or by less if that raises the energy. Returns the largest motion.
    fn go(&mut self, motions: &[Mu<S>], mut factor: T<S>) -> T<S> {
        let (before, terms) = self.configured().energy_and_size();
        let load = self.work_of_load(motions);
        for _ in 0..HALVINGS {
            let moved = self.moved(motions, factor);
            let (after, others) = Configured { q: &moved, ..self.configured() }.energy_and_size();
            let done = load * factor;
            let rounding = T::<S>::EPSILON * T::<S>::from_ratio(ROUNDINGS, 1) * (terms + others + done.abs());
            if after - done <= before + rounding {
                self.q = moved;
                for (sum, motion) in self.motion.iter_mut().zip(motions) {
                    *sum += motion * factor;
                }
                return motions.iter().fold(T::<S>::zero(), |largest, own| larger(largest, own.max_abs())) * factor;
            }
            factor *= T::<S>::from_ratio(1, 2);
        }
        T::<S>::zero()
    }

    /// Goes on along the motions of this cycle and of the last one, to the least energy by its second derivatives. Returns the largest
    /// motion; `last` are the motions of this cycle then.
    ///
    /// Source: Knyazev, *Toward the optimal preconditioned eigensolver*, SIAM Journal on Scientific Computing 23 (2001) (the locally
    /// optimal choice of conjugate gradients).
    pub fn accelerate(&mut self, last: &mut Vec<Mu<S>>) -> T<S> {
        let none = alloc::vec![SVector::zeros(); self.q.len()];
        let motions = core::mem::replace(&mut self.motion, none);
        let mut largest = T::<S>::zero();
        if let Some([own, before]) = self.configured().slopes([&motions, last]).least() {
            let motion = |(site, motion): (usize, &Mu<S>)| {
                motion * own + last.get(site).copied().unwrap_or_else(SVector::zeros) * before
            };
            let more: Vec<Mu<S>> = motions.iter().enumerate().map(motion).collect();
            largest = self.go(&more, T::<S>::one());
        }
        *last = motions.iter().zip(&self.motion).map(|(own, more)| own + more).collect();
        self.motion.fill(SVector::zeros());
        largest
    }

    fn moved(&self, motions: &[Mu<S>], factor: T<S>) -> Vec<Q<S>> {
        let field = self.configured();
        let moved = |(site, motion): (usize, &Mu<S>)| {
            let (system, q) = field.site(site)?;
            Some(if self.lattice.grid().is_fixed(site) { *q } else { system.moved_by(q, &(motion * factor)) })
        };
        motions.iter().enumerate().filter_map(moved).collect()
    }

    fn work_of_load(&self, motions: &[Mu<S>]) -> T<S> {
        self.load.iter().zip(motions).fold(T::<S>::zero(), |work, (load, motion)| work + load.dot(motion))
    }
}

/// The power of its length that the energy of an edge lacks, from its second derivatives with one spacing and with twice that.
///
/// An edge of twice the length that stands for two has half of their second derivatives. Energies for each length have it by themselves,
/// those for each site lack a power, and those without a length have one too many.
fn lacking_power<T: Real>(short: T, long: T) -> i32 {
    let (found, two) = (long / short, T::from_ratio(2, 1).sqrt());
    let half = T::from_ratio(1, 2);
    if found < half / two {
        1
    } else if found > half * two {
        -1
    } else {
        0
    }
}

/// One cycle over a grid and all coarser ones. Returns the largest correction: of the last sweep, or by the coarser grid.
pub(super) fn cycle<S, P: Population, const D: usize, const M: usize>(
    levels: &mut [Level<S, D, P>],
) -> Result<T<S>, SiteError>
where
    S: Field<D, Momentum = SVector<<S as Clebsch>::Scalar, M>> + Clone,
    T<S>: Real,
{
    let Some((level, coarser)) = levels.split_first_mut() else { return Ok(T::<S>::zero()) };
    if coarser.is_empty() {
        return level.settle();
    }
    for _ in 0..BEFORE {
        level.sweep(T::<S>::one())?;
    }
    let mut correction = T::<S>::zero();
    if let Some(next) = coarser.first_mut() {
        next.start(level);
    }
    // a coarser grid that fails leaves this one to its sweeps
    if cycle(coarser).is_ok()
        && let Some(next) = coarser.first()
    {
        correction = level.correct(next);
    }
    for _ in 0..AFTER {
        correction = larger(correction, level.sweep(T::<S>::one())?.0);
    }
    Ok(correction)
}
