//! Several extremals between the same endpoints: other ways round, other windings.

use super::{Boundary, Guess, Node};
use crate::space::larger;
use crate::{Differentiated, Error, Real, Scalar, Variational};
use core::mem::swap;
use nalgebra::SVector;
use num_traits::{One, Zero};

/// One of several extremals between the same endpoints, found by [`Boundary::several`].
///
/// ```
/// # use clebsch::{Clebsch, Way};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(
/// #     action     = |a: Translation<1>, x: Vector1| x + a,
/// #     lagrangian = |v| self.mass * v.norm_squared() / 2,
/// #     potential  = |x| self.stiffness * x.norm_squared() / 2,
/// #     emit       = [boundary],
/// # )]
/// # struct Spring { mass: f64, stiffness: f64 }
/// # use nalgebra::Vector1;
/// # let stepper = Spring { mass: 1.0, stiffness: 1.0 }.into_stepper(0.1)?;
/// # let boundary = stepper.boundary();
/// let mut path = [boundary.rest(&Vector1::zeros()); 10];
/// let ways: Vec<Way<f64, 1>> =
///     boundary.several::<3>(&Vector1::zeros(), &Vector1::new(1.0), &mut path)?.into_iter().flatten().collect();
/// assert_eq!(ways.len(), 1); // a spring goes one way in less than half of its period
/// assert_eq!(ways[0].negative, 0);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way<T, const M: usize> {
    /// The action Σ ℓd.
    pub action: T,
    /// The momentum N_0 at the start.
    pub momentum: SVector<T, M>,
    /// The Morse index, 0 for a local minimum.
    pub negative: usize,
    /// The guess that led to it: [`Boundary::solve`] with this guess finds it again.
    pub guess: Guess<T, M>,
}

/// The angles of guessed velocities, in quarters of a turn. They go there and back from any point of a closed orbit,
/// and one turn more.
const QUARTERS: [f64; 4] = [1.0, 3.0, 5.0, 7.0];
/// The signs of the two directions that a velocity is along; the first two where they are one.
const SIGNS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0]];
/// Momenta that differ by less, relative to their size, are those of one extremal.
const APART: f64 = 1e-6;

impl<S: Variational<M, Scalar: Real>, B: Differentiated<S, M>, const M: usize> Boundary<'_, S, M, B> {
    /// At most K extremals from `start` to `target`, in order of their action. The first guess is the shortest way.
    /// Other guesses are velocities along each direction of the algebra and between each two, both ways. They turn by
    /// one to seven quarters in the time of the path.
    ///
    /// It is a search: K that are found are extremals, but others may exist. Between conjugate points, such as opposite points of a
    /// sphere, where extremals come in families, some of each family are given. The nodes of `path` are storage.
    ///
    /// Work: 1 + 8M² calls of [`solve`](Self::solve) at most.
    ///
    /// # Errors
    /// Those of [`solve`](Self::solve) for the arguments; if no guess led to an extremal, [`Error::Unreachable`] with
    /// the least distance.
    pub fn several<const K: usize>(
        &self,
        start: &S::Configuration,
        target: &S::Configuration,
        path: &mut [Node<S, M>],
    ) -> Result<[Option<Way<S::Scalar, M>>; K], Error> {
        let nodes = path.len();
        self.check(start, &Guess::Geodesic, nodes)?;
        self.stepper.check_configuration(target)?;
        let mut ways = [None; K];
        let mut failure = None;
        let mut look = |guess| match self.solve(start, target, guess, path) {
            Ok(extremal) => {
                let (action, momentum, negative) = (extremal.action, *extremal.momentum(), extremal.negative);
                insert(&mut ways, Way { action, momentum, negative, guess });
            }
            Err(error) => {
                failure.get_or_insert(error);
            }
        };
        look(Guess::Geodesic);
        let steps = S::Scalar::from_f64((nodes / B::EDGES.max(1)) as f64);
        let quarter = S::Scalar::PI * S::Scalar::from_ratio(1, 2) / (self.stepper.h * steps);
        for angle in QUARTERS {
            let length = S::Scalar::from_f64(angle) * quarter;
            for (i, j) in (0..M).flat_map(|i| (i..M).map(move |j| (i, j))) {
                let (count, share) =
                    if i == j { (2, S::Scalar::one()) } else { (4, S::Scalar::from_ratio(1, 2).sqrt()) };
                for signs in SIGNS.into_iter().take(count) {
                    let [first, second] = signs.map(|sign| S::Scalar::from_f64(sign) * length * share);
                    look(Guess::Velocity(SVector::from_fn(|k, _| match k {
                        k if k == i => first,
                        k if k == j => second,
                        _ => S::Scalar::zero(),
                    })));
                }
            }
        }
        match failure {
            Some(error) if K > 0 && ways.iter().all(Option::is_none) => Err(error),
            _ => Ok(ways),
        }
    }
}

/// Puts a way in its place, unless it is already known. Of more than K ways the one with the largest action is dropped.
fn insert<T: Real, const M: usize>(ways: &mut [Option<Way<T, M>>], way: Way<T, M>) {
    let is_known = |known: &Way<T, M>| {
        let apart = known.momentum - way.momentum;
        let size = larger(known.momentum.dot(&known.momentum), way.momentum.dot(&way.momentum));
        apart.dot(&apart) <= T::from_f64(APART * APART) * size
    };
    if ways.iter().flatten().any(is_known) {
        return;
    }
    let mut way = Some(way);
    for place in ways {
        if place.is_none_or(|known| way.is_some_and(|way| way.action < known.action)) {
            swap(place, &mut way);
        }
    }
}
