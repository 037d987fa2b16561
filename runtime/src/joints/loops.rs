//! Loops in a tree of joints: their equations are a border of S.
//!
//! The rows b of a joint that closes a loop read two sites of the tree. With S = A Σ⁻¹Aᵀ and the rows A of the tree:
//!
//! ```text
//! ⎛ S  cᵀ ⎞ ⎛ x ⎞   ⎛ r ⎞       c = b Σ⁻¹Aᵀ,    Z = S⁻¹cᵀ,    W = bᵀ − AᵀZ,    K = b Σ⁻¹W
//! ⎝ c  e  ⎠ ⎝ y ⎠ = ⎝ s ⎠,      y = K⁻¹(s − Zᵀr),    x = S⁻¹r − Z y
//! ```
//! The push Aᵀx + bᵀy is AᵀS⁻¹r + W y. For L rows S is solved L times more at each configuration, which takes O(N L)
//! operations, and K is a small dense matrix.

use super::blocks::invert_by_size;
use super::{Branch, Joined, Joints, Mobile};
use crate::constraint::{Violation, check_place};
use crate::parts::{Mu, Q, T};
use crate::power::SiteScheme;
use crate::scheme::{AtSite, Scheme};
use crate::space::larger;
use crate::{Mask, Scalar, Space};
use core::array::from_fn;
use nalgebra::{SMatrix, SVector};
use num_traits::{One, Zero};

/// An equation that closes a loop.
#[derive(Clone, Copy, Debug)]
pub struct Loop<T, const M: usize> {
    /// The two sites that it reads.
    pub sites: [usize; 2],
    /// Its row along motions of each.
    pub along: [SVector<T, M>; 2],
    /// −∂φ/∂t
    pub velocity: T,
    /// φ, or the right side of an equation; after a solve the solution.
    pub value: T,
    /// λ
    multiplier: T,
    /// The rounding error of φ.
    rounding: T,
    /// e of this equation.
    metric: T,
}

impl<T: Scalar, const M: usize> Loop<T, M> {
    fn none() -> Self {
        let (zero, along) = (T::zero(), SVector::from_element(T::zero()));
        let (value, multiplier, rounding) = (zero, zero, zero);
        Self { sites: [0; 2], along: [along; 2], velocity: zero, value, multiplier, rounding, metric: zero }
    }

    /// Its sites with its rows.
    fn ends(&self) -> impl Iterator<Item = (usize, &SVector<T, M>)> {
        self.sites.iter().copied().zip(&self.along)
    }
}

/// Puts the rows of C equations in their place, the first of them in row `first`.
#[inline(always)]
pub fn put_loops<T: Scalar, const M: usize, const C: usize>(
    loops: &mut [Loop<T, M>],
    first: usize,
    sites: [usize; 2],
    [own, before]: [[[T; M]; C]; 2],
    velocity: [T; C],
) {
    let rows = own.into_iter().zip(before).zip(velocity);
    for (row, ((own, before), velocity)) in loops.iter_mut().skip(first).zip(rows) {
        (row.sites, row.along, row.velocity) = (sites, [own.into(), before.into()], velocity);
    }
}

/// Puts C values in their place, the first of them in row `first`.
#[inline(always)]
pub fn put_loop_values<T: Scalar, const M: usize, const C: usize>(
    loops: &mut [Loop<T, M>],
    first: usize,
    values: [T; C],
) {
    loops.iter_mut().skip(first).zip(values).for_each(|(row, value)| row.value = value);
}

/// The loops of a tree: L equations, and K.
#[derive(Clone, Copy, Debug)]
pub struct Loops<T, const M: usize, const L: usize> {
    all: [Loop<T, M>; L],
    /// K, then K⁻¹.
    matrix: SMatrix<T, L, L>,
}

impl<T: Scalar, const M: usize, const L: usize> Loops<T, M, L> {
    /// The solution.
    #[inline]
    pub fn values(&self) -> SVector<T, L> {
        SVector::from_iterator(self.all.iter().map(|row| row.value))
    }
}

/// The border of S: the loops, whose number is known to this type alone.
pub trait Border<T: Scalar, const M: usize>: Clone + core::fmt::Debug {
    /// L
    const COUNT: usize;

    /// Empty room.
    fn new() -> Self;

    /// The equations.
    fn all(&self) -> &[Loop<T, M>];

    /// The same.
    fn all_mut(&mut self) -> &mut [Loop<T, M>];

    /// Inverts K, which `entry` gives. A pivot of at most the part `least` of its entry of e counts as 0; returns their number.
    fn factor(&mut self, entry: impl Fn(usize, usize) -> T, least: T) -> usize;

    /// K⁻¹ of the values, in their place.
    fn solve(&mut self);

    /// The solution: L numbers.
    type Values: Space<T>;

    /// The solution.
    fn solution(&self) -> Self::Values;

    /// λ of the move, or μ of the projection after it, where that is the solution.
    fn impulses(&self, is_after: bool) -> Self::Values;
}

impl<T: Scalar, const M: usize, const L: usize> Border<T, M> for Loops<T, M, L> {
    const COUNT: usize = L;

    #[inline(always)]
    fn new() -> Self {
        Self { all: from_fn(|_| Loop::none()), matrix: SMatrix::from_element(T::zero()) }
    }

    #[inline(always)]
    fn all(&self) -> &[Loop<T, M>] {
        &self.all
    }

    #[inline(always)]
    fn all_mut(&mut self) -> &mut [Loop<T, M>] {
        &mut self.all
    }

    fn factor(&mut self, entry: impl Fn(usize, usize) -> T, least: T) -> usize {
        for i in 0..L {
            for j in 0..=i {
                let value = entry(i, j);
                self.matrix[(i, j)] = value;
                self.matrix[(j, i)] = value;
            }
        }
        let entries = SVector::from_iterator(self.all.iter().map(|row| row.metric));
        invert_by_size(&mut self.matrix, &entries, least)
    }

    fn solve(&mut self) {
        let solved = self.matrix * self.values();
        self.all.iter_mut().zip(solved.iter()).for_each(|(row, solved)| row.value = *solved);
    }

    type Values = SVector<T, L>;

    fn solution(&self) -> SVector<T, L> {
        self.values()
    }

    fn impulses(&self, is_after: bool) -> SVector<T, L> {
        if is_after { self.values() } else { SVector::from_iterator(self.all.iter().map(|row| row.multiplier)) }
    }
}

/// The share of a site in a solve for the row of a loop.
#[derive(Clone, Copy, Debug)]
pub struct Column<T, const R: usize, const M: usize> {
    /// Z
    solved: SVector<T, R>,
    /// W
    push: SVector<T, M>,
}

impl<T: Scalar, const R: usize, const M: usize> Column<T, R, M> {
    pub(super) fn zero() -> Self {
        Self { solved: SVector::from_element(T::zero()), push: SVector::from_element(T::zero()) }
    }
}

/// The loops of P.
pub type BorderOf<P, const N: usize, const R: usize, const M: usize> =
    <<P as Joined<N, R, M>>::Branch as Branch<T<P>, R, M>>::Border;

impl<P: Joined<N, R, M>, const N: usize, const R: usize, const M: usize> Joints<'_, P, N, R, M> {
    /// Whether there are loops.
    pub(super) const HAS_LOOPS: bool = BorderOf::<P, N, R, M>::COUNT > 0;

    /// Σ⁻¹ of a covector at a site.
    fn mobile(&self, site: usize, push: &SVector<T<P>, M>) -> SVector<T<P>, M> {
        self.of_site(site % N, |_, c| <P::Site as Mobile<M>>::mobility(SiteScheme::<P, N>::whole(c), push))
    }

    /// The rows of the loops at q, and the factors of the border. S of the tree is factored. Returns the number of zero pivots
    /// and a site of one.
    pub(super) fn factor_loops(&mut self, t: T<P>, q: &Q<P>, least: T<P>) -> (usize, usize) {
        if !Self::HAS_LOOPS {
            return (0, 0);
        }
        self.system.loop_rows(t, q, self.border.all_mut());
        for number in 0..BorderOf::<P, N, R, M>::COUNT {
            let Some(&row) = self.border.all().get(number) else { continue };
            let (mut size, mut entries, mut metric) = (T::<P>::zero(), T::<P>::zero(), T::<P>::zero());
            for joint in self.room.iter_mut() {
                if let Some(limb) = joint.branch.limb_mut() {
                    limb.velocity = Space::origin();
                }
            }
            for (site, along) in row.ends() {
                let (motion, site) = (self.mobile(site, along), site % N);
                size = larger(size, q[site].max_abs());
                entries += along.iter().fold(T::<P>::zero(), |sum, x| sum + x.abs());
                metric += along.dot(&motion);
                if let Some(limb) = self.room[site].branch.limb_mut() {
                    limb.velocity += motion;
                }
            }
            self.put_velocities();
            self.solve_branches();
            for joint in self.room.iter_mut() {
                let solved = joint.block.right;
                let Some(push) = joint.branch.limb().map(|limb| -limb.push()) else { continue };
                if let Some(column) = joint.branch.columns_mut().get_mut(number) {
                    *column = Column { solved, push };
                }
            }
            for (site, along) in row.ends() {
                if let Some(column) = self.room[site % N].branch.columns_mut().get_mut(number) {
                    column.push += along;
                }
            }
            if let Some(row) = self.border.all_mut().get_mut(number) {
                row.rounding = T::<P>::EPSILON * (T::<P>::one() + size) * entries;
                row.metric = metric;
            }
        }
        let mut border = self.border.clone();
        let entry = |i: usize, j: usize| {
            let mut sum = T::<P>::zero();
            for (site, along) in self.border.all().get(i).iter().flat_map(|row| row.ends()) {
                if let Some(column) = self.room[site % N].branch.columns().get(j) {
                    sum += self.mobile(site, along).dot(&column.push);
                }
            }
            sum
        };
        let zeros = border.factor(entry, least);
        self.border = border;
        (zeros, self.border.all().first().map_or(0, |row| row.sites[0]))
    }

    /// The right sides of the loops, less those that S takes: s − Zᵀr.
    pub(super) fn border_right(&mut self) {
        for joint in self.room.iter().filter(|_| Self::HAS_LOOPS) {
            for (row, column) in self.border.all_mut().iter_mut().zip(joint.branch.columns()) {
                row.value -= column.solved.dot(&joint.block.right);
            }
        }
    }

    /// The solution with the loops, from that of the tree.
    pub(super) fn close(&mut self) {
        if !Self::HAS_LOOPS {
            return;
        }
        self.border.solve();
        for joint in self.room.iter_mut() {
            for (number, row) in self.border.all().iter().enumerate() {
                let Some(&Column { solved, push }) = joint.branch.columns().get(number) else { continue };
                joint.block.right -= solved * row.value;
                if let Some(limb) = joint.branch.limb_mut() {
                    limb.add_push(&(push * row.value));
                }
            }
        }
    }

    /// Forgets the multipliers of the loops.
    pub(super) fn forget_loops(&mut self) {
        self.border.all_mut().iter_mut().for_each(|row| row.multiplier = T::<P>::zero());
    }

    /// λ ← λ − y/h
    pub(super) fn correct_loops(&mut self, per_step: T<P>) {
        self.border.all_mut().iter_mut().for_each(|row| row.multiplier -= row.value * per_step);
    }

    /// Adds the pushes bᵀλ to those that were gathered.
    pub(super) fn gather_loops(&mut self) {
        for row in self.border.all().iter().filter(|_| Self::HAS_LOOPS) {
            for (site, along) in row.ends() {
                if let Some(limb) = self.room[site % N].branch.limb_mut() {
                    limb.add_push(&(along * row.multiplier));
                }
            }
        }
    }

    /// φ of the loops as right sides; tells the largest in its rounding errors, and its site.
    pub(super) fn loop_violations(&mut self, t: T<P>, q: &Q<P>, mut found: impl FnMut(usize, f64)) {
        if !Self::HAS_LOOPS {
            return;
        }
        self.system.loop_places(t, q, self.border.all_mut());
        for row in self.border.all() {
            let ratio = row.value.abs() / row.rounding;
            for lane in 0..T::<P>::LANES {
                found(row.sites[0], ratio.lane(lane).to_f64());
            }
        }
    }

    /// Right sides −∂φ/∂t − b ξ with the velocities that are known in the limbs.
    pub(super) fn loop_slip(&mut self, mu: &Mu<P>, violation: &mut Violation<T<P>>, worst: &mut usize) {
        for row in self.border.all_mut().iter_mut().filter(|_| Self::HAS_LOOPS) {
            let (mut slip, mut energy) = (row.velocity, T::<P>::zero());
            for (site, along) in row.sites.iter().map(|site| site % N).zip(&row.along) {
                let velocity = self.room[site].branch.limb().map_or_else(Space::origin, |limb| limb.velocity);
                slip -= along.dot(&velocity);
                energy += mu[site].dot(&velocity).abs();
            }
            if violation.largest.below(slip.abs()).any() {
                *worst = row.sites[0];
            }
            violation.largest = larger(violation.largest, slip.abs());
            violation.size = larger(violation.size, (row.metric * energy).sqrt() + row.velocity.abs());
            row.value = slip;
        }
    }

    /// Right sides b v + w, with v of each site and w in the values.
    pub(super) fn put_loops_along(&mut self, along: &[SVector<T<P>, M>; N]) {
        for row in self.border.all_mut().iter_mut().filter(|_| Self::HAS_LOOPS) {
            for (site, row_along) in row.sites.iter().map(|site| site % N).zip(&row.along) {
                row.value += row_along.dot(&along[site]);
            }
        }
    }

    /// Right sides 0, or −φ″ with constant velocities of the sites.
    pub(super) fn put_loop_bends(&mut self, t: T<P>, q: &Q<P>, velocities: Option<&[SVector<T<P>, M>; N]>) {
        if let Some(velocities) = velocities.filter(|_| Self::HAS_LOOPS) {
            self.system.loop_bends(t, q, velocities, self.border.all_mut());
            self.border.all_mut().iter_mut().for_each(|row| row.value = -row.value);
        } else {
            self.border.all_mut().iter_mut().for_each(|row| row.value = T::<P>::zero());
        }
    }

    /// Whether φ of the loops is 0.
    ///
    /// # Errors
    /// [`Error::OffConstraint`](crate::Error::OffConstraint).
    pub(super) fn check_loops(system: &P, t: T<P>, q: &Q<P>) -> Result<(), AtSite> {
        if !Self::HAS_LOOPS {
            return Ok(());
        }
        let mut border = BorderOf::<P, N, R, M>::new();
        system.loop_rows(t, q, border.all_mut());
        system.loop_places(t, q, border.all_mut());
        border.all().iter().try_for_each(|row| {
            let [a, b] = row.sites.map(|site| site % N);
            let entries = row.along[0].zip_map(&row.along[1], |a, b| a.abs() + b.abs()).transpose();
            let size = larger(q[a].max_abs(), q[b].max_abs());
            check_place(&SVector::from([row.value]), &entries, &size).map_err(|error| (a, error))
        })
    }
}
