//! The path that Newton's method starts from.

use super::Node;
use super::coarse::interpolated;
use super::newton::unreachable;
use super::sweep::Endpoints;
use crate::{Error, Real, Scalar, Variational};
use nalgebra::SVector;
use num_traits::{One, Zero};

/// Where the search for an extremal starts. Extremals between two endpoints are not unique: the guess selects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guess<T, const M: usize> {
    /// A path that moves by the same group element in every edge, the shortest way to the target. A minimum is looked
    /// for. Where no target is given, the path starts at rest.
    Geodesic,
    /// The same with this velocity ξ in 𝔤 to start with, for other windings and directions. It need not lead to the target: the
    /// velocity near it that does is taken. An extremal is found that may be no minimum.
    Velocity(SVector<T, M>),
    /// The increments that the nodes hold, as a solution left them: for another start or target, or another system. An extremal is
    /// found that may be no minimum.
    Path,
}

/// Corrections of a constant group element, or of a whole path, until its end is near the target.
const PASSES: usize = 60;

impl<S: Variational<M, Scalar: Real>, const M: usize> Endpoints<'_, S, M> {
    /// Fills the nodes with the guess and brings the end so near to the target that Newton's method does the rest. Returns q_N.
    ///
    /// # Errors
    /// [`Error::UndeterminedDirection`], [`Error::Unreachable`], [`Error::NotFinite`].
    pub fn prepare(&self, path: &mut [Node<S, M>], guess: &Guess<S::Scalar, M>) -> Result<S::Configuration, Error> {
        let end = match guess {
            Guess::Geodesic if self.target.is_none() => {
                self.fill(path, SVector::from_element(S::Scalar::zero()));
                self.roll_out(path)
            }
            Guess::Geodesic => {
                let gap = self.end(self.start, path.len());
                if gap.is_orthogonal() {
                    return Err(Error::UndeterminedDirection { distance: gap.distance.to_f64() });
                }
                let eta = self.fill(path, SVector::from_element(S::Scalar::zero()));
                self.refined(path, &eta)
            }
            Guess::Velocity(velocity) => {
                let edges = S::Scalar::from_f64(S::EDGES.max(1) as f64);
                self.fill(path, velocity * (self.h / edges));
                self.roll_out(path)
            }
            Guess::Path => self.roll_out(path),
        };
        let end = self.close(path, end, S::Scalar::from_ratio(1, 8));
        let gap = self.end(&end, path.len());
        if !(gap.distance.is_finite() && gap.along.is_finite()) {
            return Err(Error::NotFinite { name: "the end of the guessed path" });
        }
        if gap.is_orthogonal() { Err(unreachable(&gap)) } else { Ok(end) }
    }

    /// Fills the nodes with the same group element τ(η), after corrections of η that bring the end to the target.
    ///
    /// Each correction is the arc over the gap, divided by the number of edges. It is exact where all motions commute and along the
    /// rotations about one axis; where it does not bring the end nearer, the rest is left to [`close`](Self::close). Returns η.
    pub fn fill(&self, path: &mut [Node<S, M>], eta: SVector<S::Scalar, M>) -> SVector<S::Scalar, M> {
        let system = self.system;
        let edges = S::Scalar::from_f64(path.len() as f64);
        let end_of = |eta: &SVector<S::Scalar, M>| {
            let q = system.advance(self.start, &self.power(eta, path.len()));
            self.end(&q, path.len())
        };
        let mut eta = eta;
        let mut end = end_of(&eta);
        for _ in 0..PASSES {
            if end.is_near(S::Scalar::from_ratio(1, 256)) || end.is_orthogonal() {
                break;
            }
            let next = eta + end.arc() / edges;
            let next_end = end_of(&next);
            // Written so that NaN leaves the loop.
            if next_end.distance < end.distance {
                (eta, end) = (next, next_end);
            } else {
                break;
            }
        }
        let increment = system.retraction(&eta);
        path.iter_mut().for_each(|node| node.increment = increment);
        eta
    }

    /// Moves the vertices of a path of equal edges τ(η) to where a path of few edges finds them. Returns q_N.
    fn refined(&self, path: &mut [Node<S, M>], eta: &SVector<S::Scalar, M>) -> S::Configuration {
        let edges = path.len();
        let Some(increment) = path.last().map(|node| node.increment) else { return *self.start };
        let motions = self.coarse(path, eta);
        path.iter_mut().for_each(|node| node.increment = increment);
        match motions {
            Some(motions) => {
                let mut motion = interpolated(&motions, edges);
                self.displace(path, |index, _| motion(index + 1))
            }
            None => self.roll_out(path),
        }
    }

    /// The increment of τ(η)ⁿ, by squaring.
    fn power(&self, eta: &SVector<S::Scalar, M>, exponent: usize) -> S::Element {
        let system = self.system;
        let mut square = system.retraction(eta);
        let mut power = system.retraction(&SVector::from_element(S::Scalar::zero()));
        let mut rest = exponent;
        while rest > 0 {
            if rest & 1 == 1 {
                power = system.compose(&power, &square);
            }
            square = system.compose(&square, &square);
            rest >>= 1;
        }
        power
    }

    /// Moves vertex k by k/N of what the end lacks, until the gap is below `enough` of the size of the configuration or no pass makes
    /// it smaller. Returns q_N.
    #[cold]
    pub fn close(&self, path: &mut [Node<S, M>], end: S::Configuration, enough: S::Scalar) -> S::Configuration {
        let edges = S::Scalar::from_f64(path.len() as f64);
        let (mut q, mut gap) = (end, self.end(&end, path.len()));
        let mut fraction = S::Scalar::one();
        for _ in 0..PASSES {
            if gap.is_near(enough) || gap.is_orthogonal() || !gap.distance.is_finite() {
                break;
            }
            let motion = gap.arc() * fraction;
            let next = self.displace(path, |index, _| motion * (S::Scalar::from_f64((index + 1) as f64) / edges));
            let next_gap = self.end(&next, path.len());
            // Written so that NaN is taken back.
            if next_gap.distance < gap.distance {
                (q, gap) = (next, next_gap);
            } else {
                q = self.take_back(path);
                if gap.is_reached() {
                    break;
                }
                fraction *= S::Scalar::from_ratio(1, 2);
            }
        }
        q
    }
}
