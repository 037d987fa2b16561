//! The multipliers of joints, by block elimination from the first site to the last, in a tree from the leaves to the root.

use super::blocks::{Backward, Elimination, Forward, Place};
use super::loops::{Border, BorderOf};
use super::{Branch, Joined, JointOf, Mobile};
use crate::constraint::{Violation, check_place};
use crate::parts::{Mu, Q, T};
use crate::power::{Constants, SiteScheme, moved_site, site_constants};
use crate::scheme::{self, AtSite, Scheme};
use crate::space::larger;
use crate::{Error, Mask, Scalar, Space};
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// The most sweeps of a step.
const SWEEPS: u32 = 200;
/// A sweep that leaves so many rounding errors of φ is the last.
const ROUNDING: f64 = 1.0;
/// So many may stay, if a sweep does not decrease them.
const STALLED: f64 = 1024.0;
/// The corrections of a configuration, at most.
const CORRECTIONS: u32 = 32;
/// Sweeps end where they make φ so many times as large as the least one.
const GROWTH: f64 = 1e3;

/// The least pivot of a step, as a part of its entry of S.
#[inline(always)]
pub(crate) fn least_of_steps<T: Scalar>() -> T {
    T::EPSILON * T::from_f64(64.0)
}

/// The site after.
#[inline(always)]
fn after<const N: usize>(site: usize) -> usize {
    if site + 1 < N { site + 1 } else { 0 }
}

/// Whether a number is larger than another; NaN is the largest.
fn is_worse(ratio: f64, worst: f64) -> bool {
    !worst.is_nan() && (ratio.is_nan() || ratio > worst)
}

/// The joints of a power at one configuration, in the room of its sites.
pub(crate) struct Joints<'a, P: Joined<N, R, M>, const N: usize, const R: usize, const M: usize> {
    pub(super) system: &'a P,
    constants: &'a Constants<P, N>,
    pub(super) room: &'a mut [JointOf<P, N, R, M>; N],
    pub border: BorderOf<P, N, R, M>,
}

impl<'a, P: Joined<N, R, M>, const N: usize, const R: usize, const M: usize> Joints<'a, P, N, R, M> {
    /// Of a power with these constants.
    ///
    /// # Errors
    /// Those of the constants of a site, where sites differ.
    pub fn new(
        system: &'a P,
        constants: &'a Constants<P, N>,
        room: &'a mut [JointOf<P, N, R, M>; N],
    ) -> Result<Self, AtSite> {
        const { assert!(N > 1 || !P::IS_RING, "a ring of joints has at least two sites") };
        if !P::IS_UNIFORM {
            for (i, joint) in room.iter_mut().enumerate() {
                let made = site_constants(&system.site(i), constants.h).map_err(|error| (i, error))?;
                joint.constants = Some(made);
            }
        }
        Ok(Self { system, constants, room, border: Border::new() })
    }

    /// Whether joints make a tree.
    const IS_TREE: bool = <P::Branch as Branch<T<P>, R, M>>::IS_TREE;

    /// Whether a site has a parent.
    #[inline(always)]
    fn has_parent(site: usize) -> bool {
        if Self::IS_TREE { P::parent(site).is_some() } else { site > 0 || P::IS_RING }
    }

    /// The parent of a site. That of the first site is the last one, and in a tree the site itself.
    #[inline(always)]
    fn parent(site: usize) -> usize {
        if Self::IS_TREE {
            // below N, as the remainder says to those who check indices
            return P::parent(site).filter(|parent| *parent < site).unwrap_or(site) % N;
        }
        if site == 0 { N.saturating_sub(1) } else { site - 1 }
    }

    /// The result of `give` for a site and its constants.
    #[inline(always)]
    pub(super) fn of_site<V>(&self, site: usize, give: impl FnOnce(&P::Site, &scheme::Constants<P::Site>) -> V) -> V {
        let constants = self.room[site].constants.as_ref().unwrap_or(&self.constants.site);
        give(&self.system.site(site), constants)
    }

    /// Σ⁻¹Aᵀ of rows of a site.
    #[inline(always)]
    pub(super) fn moved_by<const K: usize>(&self, site: usize, rows: &SMatrix<T<P>, K, M>) -> SMatrix<T<P>, M, K> {
        self.of_site(site, |_, c| {
            let c = SiteScheme::<P, N>::whole(c);
            let mut columns: SMatrix<T<P>, M, K> = Space::origin();
            for i in 0..K {
                columns.set_column(i, &<P::Site as Mobile<M>>::mobility(c, &rows.row(i).transpose()));
            }
            columns
        })
    }

    /// The place of the block of a site.
    #[inline(always)]
    fn place(site: usize) -> Place {
        Place { site, sites: N, is_ring: P::IS_RING }
    }

    /// The rows at q, and the factors of S. A pivot of at most the part `least` of its entry is 0.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`], with the first site that has such a pivot.
    pub fn at(&mut self, t: T<P>, q: &Q<P>, least: T<P>) -> Result<(), AtSite> {
        let (mut number, mut elimination) = (0, Elimination::new());
        let mut last = Space::origin();
        if P::IS_RING && N > 0 {
            last = self.moved_by(N - 1, &self.system.rows_at(t, q, N - 1).own);
        }
        for i in 0..N {
            let rows = self.system.rows_at(t, q, i);
            let own = self.moved_by(i, &rows.own);
            let (mut diagonal, mut coupling) = (rows.own * own, Space::origin());
            if Self::has_parent(i) {
                diagonal += rows.before * self.moved_by(Self::parent(i), &rows.before);
                coupling = rows.before * last;
            }
            let size = T::<P>::one() + larger(q[i].max_abs(), q[Self::parent(i)].max_abs());
            let joint = &mut self.room[i];
            for k in 0..R {
                if !rows.are_there[k] {
                    diagonal[(k, k)] = T::<P>::one();
                }
                number += usize::from(rows.are_there[k]);
                let entries = rows.own.row(k);
                let all = entries.iter().chain(rows.before.row(k).iter()).fold(T::<P>::zero(), |sum, x| sum + x.abs());
                joint.rounding[k] = T::<P>::EPSILON * size * all;
            }
            joint.rows = rows;
            joint.metric = diagonal.diagonal();
            if !Self::IS_TREE {
                elimination.add(&mut joint.block, (diagonal, coupling), Self::place(i), least);
            }
            last = own;
        }
        let Elimination { zeros, first, .. } = elimination;
        let (mut zeros, mut first) = if Self::IS_TREE { self.factor_tree(least) } else { (zeros, first) };
        if Self::HAS_LOOPS {
            let (more, site) = self.factor_loops(t, q, least);
            number += BorderOf::<P, N, R, M>::COUNT;
            first = if zeros == 0 { site } else { first };
            zeros += more;
        }
        match (zeros, first) {
            (0, _) => Ok(()),
            (zeros, first) => {
                Err((first, Error::DependentConstraints { rank: number.saturating_sub(zeros), rows: number }))
            }
        }
    }

    /// Takes the next right side of S x = right.
    #[inline(always)]
    fn forward(&mut self, site: usize, right: SVector<T<P>, R>, forward: &mut Forward<T<P>, R>) {
        let block = &mut self.room[site].block;
        if Self::IS_TREE { block.right = right } else { forward.add(block, right, Self::place(site)) }
    }

    /// The solution x in the blocks, once all right sides were taken.
    #[inline(always)]
    fn backward(&mut self) {
        if Self::IS_TREE {
            return self.solve_tree();
        }
        let mut backward = Backward::new();
        for i in (0..N).rev() {
            backward.add(&mut self.room[i].block, Self::place(i));
        }
    }

    /// A_iᵀx_i + B_{i+1}ᵀx_{i+1}, the push of all joints on a site. In a tree it was gathered.
    #[inline(always)]
    fn push(&self, site: usize, x: impl Fn(&JointOf<P, N, R, M>) -> &SVector<T<P>, R>) -> SVector<T<P>, M> {
        if Self::IS_TREE {
            return self.gathered(site);
        }
        let joint = &self.room[site];
        let mut push = joint.rows.own.transpose() * x(joint);
        let next = after::<N>(site);
        if Self::has_parent(next) {
            let joint = &self.room[next];
            push += joint.rows.before.transpose() * x(joint);
        }
        push
    }

    /// The solutions of the blocks.
    pub fn solutions(&self) -> impl Iterator<Item = &SVector<T<P>, R>> {
        self.room.iter().map(|joint| &joint.block.right)
    }

    /// λ of the move, or μ of the projection after it, of each site.
    pub fn impulses(&self, is_after: bool) -> impl Iterator<Item = &SVector<T<P>, R>> {
        self.room.iter().map(move |joint| if is_after { &joint.block.right } else { &joint.multipliers })
    }

    /// Aᵀλ of the move, or Aᵀμ of the projection after it.
    pub fn pushes(&self, is_after: bool) -> Mu<P> {
        let mut pushes = [Space::origin(); N];
        // not by a closure: one that is not inlined does not know that its index is below N
        for i in 0..N {
            pushes[i] = self.push(i, |joint| if is_after { &joint.block.right } else { &joint.multipliers });
        }
        pushes
    }

    /// Moves all sites from (q, N) with multipliers so that φ(t + h, q⁺) = 0. The room may have the rows and the factors at
    /// (t, q) already. The border of loops is none of it.
    ///
    /// # Errors
    /// Those of the step of a site, [`Error::DependentConstraints`] and [`Error::NotConverged`].
    pub fn moved(
        &mut self,
        t: T<P>,
        (q, mu): (&Q<P>, &Mu<P>),
        u: Option<&P::Input>,
        (next, moved): (&mut Q<P>, &mut Mu<P>),
        is_factored: bool,
    ) -> Result<(), AtSite> {
        let h = self.constants.part(1.0);
        if !is_factored || Self::HAS_LOOPS {
            self.at(t, q, least_of_steps())?;
        }
        self.room.iter_mut().for_each(|joint| joint.multipliers = Space::origin());
        self.forget_loops();
        if Self::IS_TREE {
            self.gather(|joint| joint.multipliers);
        }
        let mut least = f64::INFINITY;
        for sweep in 1..=SWEEPS {
            let (site, worst) = self.sweep(t, (q, mu), u, (&mut *next, &mut *moved))?;
            if worst <= ROUNDING || (worst >= least && worst <= STALLED) {
                return Ok(());
            }
            // false for NaN
            let may_go_on = worst < least.max(1.0) * GROWTH && sweep < SWEEPS;
            if !may_go_on {
                let residual = (worst * T::<P>::EPSILON.to_f64()).min(f64::MAX);
                return Err((site, Error::NotConverged { residual, iterations: sweep }));
            }
            least = least.min(worst);
            let (mut backward, per_step) = (Backward::new(), h.recip());
            if Self::IS_TREE {
                self.solve_tree();
                self.room.iter_mut().for_each(|joint| joint.multipliers -= joint.block.right * per_step);
                self.correct_loops(per_step);
                self.gather(|joint| joint.multipliers);
                continue;
            }
            for i in (0..N).rev() {
                let joint = &mut self.room[i];
                joint.multipliers -= backward.add(&mut joint.block, Self::place(i)) * per_step;
            }
        }
        Ok(())
    }

    /// Moves all sites with the multipliers that are known. Returns the largest φ(t + h, q⁺), in its rounding errors, and
    /// its site, and eliminates φ from the first site on.
    ///
    /// # Errors
    /// Those of the step of a site.
    #[inline(always)]
    fn sweep(
        &mut self,
        t: T<P>,
        (q, mu): (&Q<P>, &Mu<P>),
        u: Option<&P::Input>,
        (next, moved): (&mut Q<P>, &mut Mu<P>),
    ) -> Result<(usize, f64), AtSite> {
        let end = t + self.constants.part(1.0);
        let (mut site, mut worst, mut forward) = (0, 0.0, Forward::new());
        for i in 0..N {
            let n = mu[i] + self.push(i, |joint| &joint.multipliers);
            let u = u.map_or_else(Space::origin, |u| *P::input_of_site(u, i));
            let step = |site: &_, c: &_| moved_site::<P, N>(site, c, t, (&q[i], &n), &u);
            (next[i], moved[i]) = self.of_site(i, step).map_err(|error| (i, error))?;
            if !P::IS_RING {
                self.violation(end, next, i, (&mut site, &mut worst), &mut forward);
            }
        }
        // the joint of the first site of a ring reads the last one
        if P::IS_RING {
            (0..N).for_each(|i| self.violation(end, next, i, (&mut site, &mut worst), &mut forward));
        }
        self.loop_violations(end, next, |at, ratio| {
            if is_worse(ratio, worst) {
                (site, worst) = (at, ratio);
            }
        });
        Ok((site, worst))
    }

    /// φ of one site.
    #[inline(always)]
    fn violation(
        &mut self,
        t: T<P>,
        q: &Q<P>,
        i: usize,
        (site, worst): (&mut usize, &mut f64),
        forward: &mut Forward<T<P>, R>,
    ) {
        let places = self.system.places_at(t, q, i);
        let joint = &mut self.room[i];
        for k in 0..R {
            if !joint.rows.are_there[k] {
                continue;
            }
            let ratio = places[k].abs() / joint.rounding[k];
            for lane in 0..T::<P>::LANES {
                let ratio = ratio.lane(lane).to_f64();
                if is_worse(ratio, *worst) {
                    (*site, *worst) = (i, ratio);
                }
            }
        }
        self.forward(i, places, forward);
    }

    /// Eliminates the right sides −∂φ/∂t − A ξ at (q, N). Returns the violation, and the site where it is largest.
    fn slip(&mut self, t: T<P>, q: &Q<P>, mu: &Mu<P>) -> (Violation<T<P>>, usize) {
        let (mut violation, mut worst, mut forward) = (Violation::<T<P>>::none(), 0, Forward::new());
        let velocity = |of: &Self, i: usize| {
            of.of_site(i, |site, c| site.velocity(SiteScheme::<P, N>::whole(c), t, &q[i], &mu[i]))
        };
        let mut last = Space::origin();
        if P::IS_RING && N > 0 {
            last = velocity(self, N - 1);
        }
        for i in 0..N {
            let own = velocity(self, i);
            if Self::IS_TREE {
                last = self.room[Self::parent(i)].branch.limb().map_or_else(Space::origin, |limb| limb.velocity);
            }
            let joint = &mut self.room[i];
            if let Some(limb) = joint.branch.limb_mut() {
                limb.velocity = own;
            }
            let mut slip = joint.rows.velocity - joint.rows.own * own;
            let mut energy = mu[i].dot(&own).abs();
            if Self::has_parent(i) {
                slip -= joint.rows.before * last;
                energy += mu[Self::parent(i)].dot(&last).abs();
            }
            for k in 0..R {
                let size = (joint.metric[k] * energy).sqrt() + joint.rows.velocity[k].abs();
                if violation.largest.below(slip[k].abs()).any() {
                    worst = i;
                }
                violation.largest = larger(violation.largest, slip[k].abs());
                violation.size = larger(violation.size, size);
            }
            self.forward(i, slip, &mut forward);
            last = own;
        }
        self.loop_slip(mu, &mut violation, &mut worst);
        (violation, worst)
    }

    /// Brings the velocity of N to the joints at q, by N + Aᵀμ. Returns the sum of all numbers of Aᵀμ.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    pub fn projected(&mut self, t: T<P>, q: &Q<P>, mu: &mut Mu<P>, least: T<P>) -> Result<T<P>, AtSite> {
        self.at(t, q, least)?;
        self.slip(t, q, mu);
        self.backward();
        let mut sum = T::<P>::zero();
        for i in 0..N {
            let push = self.push(i, |joint| &joint.block.right);
            mu[i] += push;
            sum += push.sum();
        }
        Ok(sum)
    }

    /// The multipliers of a push, as the solutions of the blocks.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    pub fn multipliers(&mut self, t: T<P>, q: &Q<P>, push: &Mu<P>) -> Result<(), AtSite> {
        self.at(t, q, least_of_steps())?;
        let mut moved = [Space::origin(); N];
        for i in 0..N {
            let push = &push[i];
            moved[i] = self.of_site(i, |_, c| <P::Site as Mobile<M>>::mobility(SiteScheme::<P, N>::whole(c), push));
        }
        self.put_loop_bends(t, q, None);
        self.solve_along(&moved, |_, _| Space::origin());
        Ok(())
    }

    /// The multipliers of the motion, as the solutions of the blocks. The content of the three buffers does not matter.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    pub fn reactions(
        &mut self,
        t: T<P>,
        (q, mu): (&Q<P>, &Mu<P>),
        u: &P::Input,
        (gradient, accelerations, velocities): (&mut Q<P>, &mut Mu<P>, &mut Mu<P>),
    ) -> Result<(), AtSite> {
        self.at(t, q, T::<P>::EPSILON.sqrt())?;
        self.system.kick_into(t, q, -T::<P>::one(), gradient, accelerations, velocities);
        for i in 0..N {
            let (q, mu, kick, u) = (&q[i], &mu[i], accelerations[i], P::input_of_site(u, i));
            (velocities[i], accelerations[i]) = self.of_site(i, |site, c| {
                let c = SiteScheme::<P, N>::whole(c);
                let free = site.acceleration(c, t, q, mu, u);
                (site.velocity(c, t, q, mu), -(free + <P::Site as Mobile<M>>::mobility(c, &kick)))
            });
        }
        self.put_loop_bends(t, q, Some(velocities));
        let velocities = &*velocities;
        self.solve_along(accelerations, |of, i| {
            -of.system.bend_at(t, q, i, &velocities[i], &velocities[Self::parent(i)])
        });
        Ok(())
    }

    /// Solves S x = A v + w with v of each site and w of its rows. Those of the loops are known.
    fn solve_along(&mut self, along: &[SVector<T<P>, M>; N], more: impl Fn(&Self, usize) -> SVector<T<P>, R>) {
        let mut forward = Forward::new();
        for i in 0..N {
            let joint = &self.room[i];
            let mut right = more(self, i) + joint.rows.own * along[i];
            if Self::has_parent(i) {
                right += joint.rows.before * along[Self::parent(i)];
            }
            self.forward(i, right, &mut forward);
        }
        self.put_loops_along(along);
        self.backward();
    }

    /// Takes the right sides A v of a tree, with the velocities in the limbs.
    pub(super) fn put_velocities(&mut self) {
        let velocity = |of: &Self, i: usize| of.room[i].branch.limb().map_or_else(Space::origin, |limb| limb.velocity);
        for i in 0..N {
            let own = velocity(self, i);
            let joint = &self.room[i];
            let mut right = joint.rows.own * own;
            if Self::has_parent(i) {
                right += joint.rows.before * velocity(self, Self::parent(i));
            }
            self.room[i].block.right = right;
        }
    }

    /// Moves q to φ = 0 by motions −Σ⁻¹Aᵀ S⁻¹φ, until φ no longer falls.
    ///
    /// # Errors
    /// [`Error::FarFromConstraint`], or [`Error::DependentConstraints`].
    pub fn placed(&mut self, t: T<P>, q: &mut Q<P>) -> Result<(), AtSite> {
        let mut last = f64::INFINITY;
        for corrections in 0..=CORRECTIONS {
            self.at(t, q, T::<P>::EPSILON.sqrt())?;
            let (mut site, mut worst, mut forward) = (0, 0.0, Forward::new());
            (0..N).for_each(|i| self.violation(t, q, i, (&mut site, &mut worst), &mut forward));
            self.loop_violations(t, q, |at, ratio| {
                if is_worse(ratio, worst) {
                    (site, worst) = (at, ratio);
                }
            });
            let most = T::<P>::EPSILON.to_f64().sqrt().recip();
            if worst <= ROUNDING || (worst <= most && worst >= last / 2.0) {
                return Ok(());
            }
            if !worst.is_finite() || corrections == CORRECTIONS {
                let violation = self.system.places_at(t, q, site).max_abs();
                let violation = (0..T::<P>::LANES).map(|lane| violation.lane(lane).to_f64()).fold(0.0, f64::max);
                return Err((site, Error::FarFromConstraint { violation: violation.min(f64::MAX), corrections }));
            }
            last = worst;
            self.backward();
            for i in 0..N {
                let push = self.push(i, |joint| &joint.block.right);
                q[i] = self.of_site(i, |site, c| {
                    let motion = <P::Site as Mobile<M>>::mobility(SiteScheme::<P, N>::whole(c), &push);
                    site.moved_by(&q[i], &-motion)
                });
            }
        }
        Ok(())
    }

    /// Whether φ(t, q) = 0, as [`check_place`](crate::constraint::check_place) asks.
    ///
    /// # Errors
    /// [`Error::OffConstraint`].
    pub fn check(system: &P, t: T<P>, q: &Q<P>) -> Result<(), AtSite> {
        for i in 0..N {
            let (places, rows) = (system.places_at(t, q, i), system.rows_at(t, q, i));
            let size = larger(q[i].max_abs(), q[Self::parent(i)].max_abs());
            let entries = rows.own.zip_map(&rows.before, |a, b| a.abs() + b.abs());
            check_place(&places, &entries, &size).map_err(|error| (i, error))?;
        }
        Self::check_loops(system, t, q)
    }

    /// By how much the velocity of N violates the joints at q, and the site where it does most.
    ///
    /// # Errors
    /// [`Error::DependentConstraints`].
    pub fn defect(&mut self, t: T<P>, q: &Q<P>, mu: &Mu<P>) -> Result<(Violation<T<P>>, usize), AtSite> {
        self.at(t, q, T::<P>::EPSILON.sqrt())?;
        Ok(self.slip(t, q, mu))
    }
}

#[cfg(test)]
mod tests;
