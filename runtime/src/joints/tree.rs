//! Elimination in a tree of joints, from the leaves to the root.
//!
//! The joints of a site read it and its parent p. With W_i = Σ_i⁻¹ at first, each site from the last to the first has
//!
//! ```text
//! D_i = A_i W_i A_iᵀ + B_i G_i,    G_i = W_p B_iᵀ,    W_p ← W_p − G_i D_i⁻¹ G_iᵀ
//! ```
//! This is LDLᵀ of S = A Σ⁻¹Aᵀ. A joint changes S for the joint of its parent and for those of its siblings alone, and W_p
//! has all of that. So the work is O(N), however many children a site has.
//!
//! Source: Baraff, *Linear-time dynamics using Lagrange multipliers*, SIGGRAPH (1996).

use super::blocks::invert;
use super::loops::{Border, Column, Loops};
use super::{Joined, JointOf, Joints};
use crate::parts::T;
use crate::{Scalar, Space};
use nalgebra::{SMatrix, SVector};

/// The room of a site in a tree.
#[derive(Clone, Debug)]
pub struct Limb<T, const R: usize, const M: usize> {
    /// W
    mobility: SMatrix<T, M, M>,
    /// G
    moved: SMatrix<T, M, R>,
    /// The velocity that the pushes of the children make, in a solve.
    drift: SVector<T, M>,
    /// The push of all joints on the site.
    push: SVector<T, M>,
    /// The velocity of the site.
    pub(super) velocity: SVector<T, M>,
}

impl<T: Scalar, const R: usize, const M: usize> Limb<T, R, M> {
    /// The push of all joints on the site.
    #[inline(always)]
    pub(super) fn push(&self) -> &SVector<T, M> {
        &self.push
    }

    #[inline(always)]
    pub(super) fn add_push(&mut self, push: &SVector<T, M>) {
        self.push += push;
    }
}

/// The room of a site in a tree with L rows of loops.
#[derive(Clone, Debug)]
pub struct LoopedLimb<T, const R: usize, const M: usize, const L: usize> {
    limb: Limb<T, R, M>,
    /// Its share in the solves for the rows of loops.
    columns: [Column<T, R, M>; L],
}

/// The room that a joint has in addition, by the order in which joints are eliminated.
pub trait Branch<T: Scalar, const R: usize, const M: usize>: Clone + core::fmt::Debug {
    /// Whether joints make a tree, and no chain.
    const IS_TREE: bool;

    /// The loops of all sites.
    type Border: Border<T, M>;

    /// Empty room.
    fn new() -> Self;

    /// The room of a tree; none in a chain.
    fn limb(&self) -> Option<&Limb<T, R, M>>;

    /// The same.
    fn limb_mut(&mut self) -> Option<&mut Limb<T, R, M>>;

    /// The share of the site in the solves for the rows of loops.
    #[inline(always)]
    fn columns(&self) -> &[Column<T, R, M>] {
        &[]
    }

    /// The same.
    #[inline(always)]
    fn columns_mut(&mut self) -> &mut [Column<T, R, M>] {
        &mut []
    }
}

impl<T: Scalar, const R: usize, const M: usize> Branch<T, R, M> for () {
    const IS_TREE: bool = false;
    type Border = Loops<T, M, 0>;

    #[inline(always)]
    fn new() -> Self {}

    #[inline(always)]
    fn limb(&self) -> Option<&Limb<T, R, M>> {
        None
    }

    #[inline(always)]
    fn limb_mut(&mut self) -> Option<&mut Limb<T, R, M>> {
        None
    }
}

impl<T: Scalar, const R: usize, const M: usize> Branch<T, R, M> for Limb<T, R, M> {
    const IS_TREE: bool = true;
    type Border = Loops<T, M, 0>;

    fn new() -> Self {
        let (zero, moved) = (SVector::from_element(T::zero()), SMatrix::from_element(T::zero()));
        Self { mobility: SMatrix::from_element(T::zero()), moved, drift: zero, push: zero, velocity: zero }
    }

    #[inline(always)]
    fn limb(&self) -> Option<&Limb<T, R, M>> {
        Some(self)
    }

    #[inline(always)]
    fn limb_mut(&mut self) -> Option<&mut Limb<T, R, M>> {
        Some(self)
    }
}

impl<T: Scalar, const R: usize, const M: usize, const L: usize> Branch<T, R, M> for LoopedLimb<T, R, M, L> {
    const IS_TREE: bool = true;
    type Border = Loops<T, M, L>;

    fn new() -> Self {
        Self { limb: Limb::new(), columns: [Column::zero(); L] }
    }

    #[inline(always)]
    fn limb(&self) -> Option<&Limb<T, R, M>> {
        Some(&self.limb)
    }

    #[inline(always)]
    fn limb_mut(&mut self) -> Option<&mut Limb<T, R, M>> {
        Some(&mut self.limb)
    }

    #[inline(always)]
    fn columns(&self) -> &[Column<T, R, M>] {
        &self.columns
    }

    #[inline(always)]
    fn columns_mut(&mut self) -> &mut [Column<T, R, M>] {
        &mut self.columns
    }
}

impl<P: Joined<N, R, M>, const N: usize, const R: usize, const M: usize> Joints<'_, P, N, R, M> {
    /// A site with its limb, and the limb of its parent, if it has one.
    #[inline(always)]
    #[allow(clippy::type_complexity, reason = "a site, and the limb of its parent")]
    fn with_parent(&mut self, site: usize) -> Option<(&mut JointOf<P, N, R, M>, Option<&mut Limb<T<P>, R, M>>)> {
        let (before, rest) = self.room.split_at_mut_checked(site)?;
        let parent = P::parent(site).and_then(|parent| before.get_mut(parent)?.branch.limb_mut());
        Some((rest.first_mut()?, parent))
    }

    /// The factors of S, whose diagonal is known. A pivot of at most the part `least` of its entry is 0. Returns the number
    /// of these and a site of one.
    pub(super) fn factor_tree(&mut self, least: T<P>) -> (usize, usize) {
        let (mut all, mut site) = (0, 0);
        for i in 0..N {
            let columns = self.moved_by(i, &SMatrix::<T<P>, M, M>::identity());
            if let Some(limb) = self.room[i].branch.limb_mut() {
                limb.mobility = columns;
            }
        }
        for i in (0..N).rev() {
            let Some((joint, parent)) = self.with_parent(i) else { continue };
            let (rows, metric) = (&joint.rows, joint.metric);
            let Some(limb) = joint.branch.limb_mut() else { continue };
            let mut pivot = rows.own * limb.mobility * rows.own.transpose();
            for k in 0..R {
                if !rows.are_there[k] {
                    pivot[(k, k)] = metric[k];
                }
            }
            if let Some(parent) = &parent {
                limb.moved = parent.mobility * rows.before.transpose();
                pivot += rows.before * limb.moved;
            }
            let zeros = invert(&mut pivot, &metric, least);
            if zeros > 0 {
                site = i;
            }
            all += zeros;
            if let Some(parent) = parent {
                parent.mobility -= limb.moved * pivot * limb.moved.transpose();
            }
            joint.block.set_inverse(pivot);
        }
        (all, site)
    }

    /// Solves S x = right in the blocks, and in the loops. The pushes of the sites stay in the limbs.
    pub(super) fn solve_tree(&mut self) {
        self.border_right();
        self.solve_branches();
        self.close();
    }

    /// The same without loops.
    pub(super) fn solve_branches(&mut self) {
        for joint in self.room.iter_mut() {
            if let Some(limb) = joint.branch.limb_mut() {
                (limb.drift, limb.push) = (Space::origin(), Space::origin());
            }
        }
        for i in (0..N).rev() {
            let Some((joint, parent)) = self.with_parent(i) else { continue };
            let Some(limb) = joint.branch.limb_mut() else { continue };
            let mut right = joint.block.right - joint.rows.own * limb.drift;
            if let Some(parent) = &parent {
                right -= joint.rows.before * parent.drift;
            }
            let solved = joint.block.inverse() * right;
            if let Some(parent) = parent {
                parent.drift += limb.moved * solved;
            }
            joint.block.right = solved;
        }
        for i in 0..N {
            let Some((joint, parent)) = self.with_parent(i) else { continue };
            let Some(limb) = joint.branch.limb_mut() else { continue };
            if let Some(parent) = parent {
                joint.block.right -= joint.block.inverse() * (limb.moved.transpose() * parent.push);
                parent.push += joint.rows.before.transpose() * joint.block.right;
            }
            limb.push += joint.rows.own.transpose() * joint.block.right;
        }
    }

    /// Gathers the pushes Aᵀx of all joints at their sites, with those of the multipliers of loops.
    pub(super) fn gather(&mut self, x: impl Fn(&JointOf<P, N, R, M>) -> SVector<T<P>, R>) {
        for joint in self.room.iter_mut() {
            if let Some(limb) = joint.branch.limb_mut() {
                limb.push = Space::origin();
            }
        }
        for i in 0..N {
            let Some((joint, parent)) = self.with_parent(i) else { continue };
            let x = x(joint);
            if let Some(parent) = parent {
                parent.push += joint.rows.before.transpose() * x;
            }
            if let Some(limb) = joint.branch.limb_mut() {
                limb.push += joint.rows.own.transpose() * x;
            }
        }
        self.gather_loops();
    }

    /// The push that was gathered at a site.
    #[inline(always)]
    pub(super) fn gathered(&self, site: usize) -> SVector<T<P>, M> {
        self.room[site].branch.limb().map_or_else(Space::origin, |limb| limb.push)
    }
}
