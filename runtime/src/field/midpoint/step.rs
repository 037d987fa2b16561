//! The equations of a step, and their solution.

use super::Work;
use super::tridiagonal::Tridiagonal;
use crate::field::edges::Edge;
use crate::field::{Field, FieldStepper, Grid, Lattice, MidpointSite, Population};
use crate::parts::{Mu, Q, RestOf, T, U};
use crate::space::larger;
use crate::{Clebsch, Error, Real, Scalar, SiteError, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// The most linear systems of a step.
const ITERATIONS: u32 = 40;
/// The least part of a correction that is tried.
const LEAST: f64 = 1e-4;
/// A correction of so many roundings that does not decrease is one of rounding.
const ROUNDINGS: f64 = 1024.0;

/// A correction that was made.
struct Made<T> {
    /// The part that was made.
    part: T,
    /// The size of the next correction with the same matrix.
    next: T,
}

/// A step of all sites from a state.
pub(super) struct Step<'a, S: Clebsch + Clone, P: Population> {
    pub field: &'a FieldStepper<S, Grid<T<S>, 1>, P>,
    pub t: T<S>,
    pub inputs: Option<&'a [U<S>]>,
    pub q: &'a [Q<S>],
    pub mu: &'a [Mu<S>],
}

impl<S, P: Population, const M: usize> Step<'_, S, P>
where
    S: Field<1> + MidpointSite<M> + Clebsch<Momentum = SVector<T<S>, M>> + Clone,
    T<S>: Real,
{
    /// Finds the half steps of all sites, by Newton's method. A part λ of a correction Δ is made where the next correction with the same
    /// matrix is smaller than (1 − ¼λ)|Δ|.
    ///
    /// It starts at the identity: so a step is a function of its state alone. Long steps are also found in fewer iterations than from the last ones.
    pub fn solve(&self, work: &mut Work<S, M>) -> Result<(), SiteError> {
        let extent = self.q.iter().fold(T::<S>::one(), |most, q| larger(most, T::<S>::one() + q.max_abs()));
        let visible = T::<S>::EPSILON * extent;
        let (mut part, mut before) = (T::<S>::one(), None);
        work.iterations = 0;
        work.halves.fill(SVector::from_element(T::<S>::zero()));
        while work.iterations < ITERATIONS {
            work.iterations += 1;
            let size = self.correct(work)?;
            if let Some((size_before, next_before)) = before {
                // the correction here with the old matrix tells how much the matrix has changed
                let change = distance(&work.next, &work.correction, T::<S>::one());
                part = at_most_one::<T<S>>(size_before * next_before * part / (change * size));
            }
            if size <= visible {
                work.arrive_at(T::<S>::one());
                return Ok(());
            }
            let Some(made) = self.damped(work, (size, visible), part)? else { return Ok(()) };
            (part, before) = (made.part, Some((size, made.next)));
        }
        Err(work.failure())
    }

    /// Makes a part of the correction of this size, at most `part`. `None` where that ends the iteration.
    fn damped(
        &self,
        work: &mut Work<S, M>,
        (size, visible): (T<S>, T<S>),
        mut part: T<S>,
    ) -> Result<Option<Made<T<S>>>, SiteError> {
        let (one, half, quarter) = (T::<S>::one(), T::<S>::from_ratio(1, 2), T::<S>::from_ratio(1, 4));
        while part >= T::<S>::from_f64(LEAST) {
            work.try_at(part);
            self.residual(work);
            work.matrix.solve(&mut work.next);
            let next = largest(&work.next);
            let is_less = next < size * (one - part * quarter);
            if is_less {
                core::mem::swap(&mut work.halves, &mut work.tried);
                // full corrections decrease by this factor at least
                if part == one && next * next <= visible * size {
                    core::mem::swap(&mut work.correction, &mut work.next);
                    work.arrive_at(one);
                    return Ok(None);
                }
                return Ok(Some(Made { part, next }));
            }
            if next <= visible * T::<S>::from_f64(ROUNDINGS) {
                core::mem::swap(&mut work.halves, &mut work.tried);
                return Ok(None);
            }
            let bent = distance(&work.next, &work.correction, one - part);
            let possible = half * size * part * part / bent;
            part = if possible < half * part { possible } else { half * part };
        }
        Err(work.failure())
    }

    /// The correction of the half steps, and its size.
    fn correct(&self, work: &mut Work<S, M>) -> Result<T<S>, SiteError> {
        self.linearize(work);
        if work.matrix.eliminate().is_none() {
            work.correction.fill(SVector::from_element(T::<S>::one() / T::<S>::zero()));
            return Err(work.failure());
        }
        work.matrix.solve(&mut work.correction);
        let size = largest(&work.correction);
        if size.is_finite() { Ok(size) } else { Err(work.failure()) }
    }

    /// h f − s − C s at the half steps, and its derivatives with the other sign.
    fn linearize(&self, work: &mut Work<S, M>) {
        let (h, middle) = self.times();
        let Work { halves, midpoints, correction, matrix, .. } = work;
        matrix.clear();
        for (i, system) in self.field.each().enumerate() {
            let half = S::half_step(&halves[i]);
            let q = system.act(&half, &self.q[i]);
            let (sum, mut slope) = system.midpoint_equation(h, self.t, &half, &self.mu[i]);
            let mut right = -sum;
            if S::HAS_POTENTIAL {
                right += system.force_on_site(middle, &q) * h;
                let (along, _) = by_motions(|motion| {
                    (system.force_on_site_along(middle, &q, motion), SVector::from_element(T::<S>::zero()))
                });
                slope -= along * h;
            }
            if let Some((force, along)) = system.midpoint_force(h, middle, &q, &halves[i], &self.input(i)) {
                right += force * h;
                slope -= along * h;
            }
            (midpoints[i], correction[i]) = (q, right);
            matrix.add(i, i, &slope);
        }
        let lattice = self.field.lattice();
        let none = SVector::from_element(T::<S>::zero());
        self.each_edge(midpoints, |system, edge, ends| {
            let [from, to] = edge.ends;
            let (own, next) = lattice.forces(system, edge, ends);
            correction[from] += own * h;
            correction[to] += next * h;
            let (own, next) = by_motions(|motion| lattice.forces_along(system, edge, ends, [motion, &none]));
            matrix.add(from, from, &(own * -h));
            matrix.add(to, from, &(next * -h));
            let (own, next) = by_motions(|motion| lattice.forces_along(system, edge, ends, [&none, motion]));
            matrix.add(from, to, &(own * -h));
            matrix.add(to, to, &(next * -h));
        });
        self.hold(correction, Some(matrix));
    }

    /// The same without derivatives, at the half steps that are tried.
    fn residual(&self, work: &mut Work<S, M>) {
        let h = self.field.step_size();
        let Work { tried, midpoints, next: right, .. } = work;
        self.impulses(tried, midpoints, right);
        for (i, system) in self.field.each().enumerate() {
            right[i] -= system.midpoint_equation(h, self.t, &S::half_step(&tried[i]), &self.mu[i]).0;
        }
        self.hold(right, None);
    }

    /// h f of all sites, and their midpoints.
    fn impulses(&self, halves: &[SVector<T<S>, M>], midpoints: &mut [Q<S>], impulses: &mut [SVector<T<S>, M>]) {
        let (h, middle) = self.times();
        for (i, system) in self.field.each().enumerate() {
            let q = system.act(&S::half_step(&halves[i]), &self.q[i]);
            impulses[i] = SVector::from_element(T::<S>::zero());
            if S::HAS_POTENTIAL {
                impulses[i] += system.force_on_site(middle, &q) * h;
            }
            if let Some((force, _)) = system.midpoint_force(h, middle, &q, &halves[i], &self.input(i)) {
                impulses[i] += force * h;
            }
            midpoints[i] = q;
        }
        let lattice = self.field.lattice();
        self.each_edge(midpoints, |system, edge, ends| {
            let (own, next) = lattice.forces(system, edge, ends);
            impulses[edge.ends[0]] += own * h;
            impulses[edge.ends[1]] += next * h;
        });
    }

    /// The input of a site.
    fn input(&self, site: usize) -> U<S> {
        self.inputs.and_then(|inputs| inputs.get(site)).copied().unwrap_or_else(Space::origin)
    }

    fn each_edge(&self, q: &[Q<S>], mut visit: impl FnMut(&S, Edge, [&Q<S>; 2])) {
        for (i, system) in self.field.each().enumerate() {
            Lattice::<S>::visit_edges(self.field.lattice(), i, |edge, end| {
                let [from, to] = edge.ends;
                if let (0, Some(a), Some(b)) = (end, q.get(from), q.get(to)) {
                    visit(system, edge, [a, b]);
                }
            });
        }
    }

    /// Sites that do not move have no equation.
    fn hold(&self, right: &mut [SVector<T<S>, M>], mut matrix: Option<&mut Tridiagonal<T<S>, M>>) {
        let lattice = self.field.lattice();
        if !Lattice::<S>::has_fixed(lattice) {
            return;
        }
        for (i, right) in right.iter_mut().enumerate().filter(|(i, _)| lattice.is_fixed(*i)) {
            *right = SVector::from_element(T::<S>::zero());
            if let Some(matrix) = &mut matrix {
                matrix.hold(i);
            }
        }
    }

    /// The step size, and the time of the forces.
    fn times(&self) -> (T<S>, T<S>) {
        let h = self.field.step_size();
        (h, self.t + h * T::<S>::from_ratio(1, 2))
    }

    /// Where all sites are after the step, in the storage of midpoints and tries: N⁺ = C (C N + h f). Whatever the rounding of a solution is,
    /// it changes no sum of momenta.
    pub fn arrive(&self, work: &mut Work<S, M>) -> Result<(), SiteError> {
        let Work { halves, tried, midpoints, next: impulses, .. } = work;
        self.impulses(halves, midpoints, impulses);
        for (i, system) in self.field.each().enumerate() {
            let half = S::half_step(&halves[i]);
            let next = S::on_space(system.act(&half, &midpoints[i]), RestOf::<S>::origin()).0;
            let momentum = S::half_carried(&half, &(S::half_carried(&half, &self.mu[i]) + impulses[i]));
            if !(next.all_finite() && momentum.all_finite()) {
                return Err(SiteError { site: Some(i), error: Error::NotFinite { name: "the state after a step" } });
            }
            (midpoints[i], tried[i]) = (next, momentum);
        }
        Ok(())
    }
}

impl<S: MidpointSite<M>, const M: usize> Work<S, M>
where
    S: Clebsch<Momentum = SVector<T<S>, M>>,
    T<S>: Real,
{
    /// The half steps that are tried: the last ones, moved by a part of the correction.
    fn try_at(&mut self, part: T<S>) {
        for ((tried, half), correction) in self.tried.iter_mut().zip(&self.halves).zip(&self.correction) {
            *tried = half + S::half_step_motion(half, correction) * part;
        }
    }

    /// The same, as the last ones.
    fn arrive_at(&mut self, part: T<S>) {
        self.try_at(part);
        core::mem::swap(&mut self.halves, &mut self.tried);
    }

    /// Where a solve ends without a result.
    fn failure(&self) -> SiteError {
        let mut worst = (None, T::<S>::zero());
        for (i, correction) in self.correction.iter().enumerate() {
            let size = largest(core::slice::from_ref(correction));
            // NaN is larger
            if size > worst.1 || !size.is_finite() {
                worst = (Some(i), size);
            }
        }
        let error = Error::NotConverged { residual: worst.1.to_f64(), iterations: self.iterations };
        SiteError { site: worst.0, error }
    }
}

/// The matrices of two linear functions of a motion.
fn by_motions<T: Scalar, const M: usize>(
    f: impl Fn(&SVector<T, M>) -> (SVector<T, M>, SVector<T, M>),
) -> (SMatrix<T, M, M>, SMatrix<T, M, M>) {
    let zero = SMatrix::<T, M, M>::from_element(T::zero());
    let (mut first, mut second) = (zero, zero);
    for column in 0..M {
        let mut unit = SVector::<T, M>::from_element(T::zero());
        unit[column] = T::one();
        let (one, other) = f(&unit);
        first.set_column(column, &one);
        second.set_column(column, &other);
    }
    (first, second)
}

fn at_most_one<T: Real>(x: T) -> T {
    if x < T::one() { x } else { T::one() }
}

/// The largest entry of some vectors; NaN where one is.
fn largest<T: Real, const M: usize>(vectors: &[SVector<T, M>]) -> T {
    distance(vectors, vectors, T::zero())
}

/// The largest entry of a − part·b.
fn distance<T: Real, const M: usize>(a: &[SVector<T, M>], b: &[SVector<T, M>], part: T) -> T {
    let entries = a.iter().zip(b).flat_map(|(a, b)| a.iter().zip(b.iter()).map(|(a, b)| (*a - *b * part).abs()));
    entries.fold(T::zero(), |most, entry| if entry <= most { most } else { entry })
}
