//! The axes in which the momenta of a free rotation are written.

use crate::newton::Spectrum;
use crate::space::Space;
use crate::{Real, Scalar};
use nalgebra::{SMatrix, SVector};

/// The axes of a body in N dimensions.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Axes<T, D, const N: usize> {
    /// Those of the coordinates, which are principal axes.
    Coordinates,
    /// The columns of this rotation, which are principal axes.
    Principal(SMatrix<T, N, N>),
    /// Those of the coordinates, with values that replace the moments: numbers with derivatives know no principal axes.
    Tensor(D),
}

impl<T: Real, D, const N: usize> Axes<T, D, N> {
    /// The principal moments of a tensor, and their axes. Only the lower triangle of the tensor is read.
    pub fn principal(tensor: &SMatrix<T, N, N>) -> (SVector<T, N>, Self) {
        if (0..N).all(|i| (0..i).all(|j| tensor[(i, j)] == T::zero())) {
            return (tensor.diagonal(), Self::Coordinates);
        }
        let Spectrum { values, vectors } = Spectrum::of(tensor);
        (values, Self::Principal(vectors))
    }
}

impl<T: Scalar, D: Space<T>, const N: usize> Axes<T, D, N> {
    /// Axes whose lanes are yet to be set.
    pub fn unset() -> Self {
        if T::DERIVATIVES > 0 { Self::Tensor(D::origin()) } else { Self::Coordinates }
    }

    fn rotation(&self) -> SMatrix<T, N, N> {
        match self {
            Self::Principal(axes) => *axes,
            _ => SMatrix::identity(),
        }
    }

    /// The axes of one lane.
    pub fn lane(&self, lane: usize) -> Axes<T::Lane, D::Lane, N> {
        match self {
            Self::Coordinates => Axes::Coordinates,
            Self::Principal(axes) => Axes::Principal(axes.lane(lane)),
            Self::Tensor(tensor) => Axes::Tensor(tensor.lane(lane)),
        }
    }

    /// Puts the axes of one body into a lane.
    #[cold]
    pub fn set_lane(&mut self, lane: usize, other: &Axes<T::Lane, D::Lane, N>) {
        match (&mut *self, other) {
            (Self::Coordinates, Axes::Coordinates) => {}
            (Self::Tensor(tensor), Axes::Tensor(other)) => tensor.set_lane(lane, other),
            // the axes of the coordinates are those of the identity, by which nothing is rounded
            _ => {
                let mut axes = self.rotation();
                axes.set_lane(lane, &other.rotation());
                *self = Self::Principal(axes);
            }
        }
    }
}
