//! The path that Newton's method starts from. A path of many edges is begun with few, which cost little.

use super::sweep::{Endpoints, Search};
use crate::newton::Curvature;
use crate::parameters::check_finite;
use crate::scheme::Scheme;
use crate::{Differentiated, Error, Real, Space, Variational};
use nalgebra::SVector;

/// Where the search for an extremal starts. Extremals between two endpoints are not unique: the guess selects.
///
/// ```
/// # use clebsch::{Clebsch, Guess};
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
/// # let mut path = [boundary.rest(&Vector1::zeros()); 10];
/// # let start = Vector1::zeros();
/// let first = boundary.solve(&start, &Vector1::new(1.0), Guess::Geodesic, &mut path)?.iterations();
/// // the next target is near: the path that was found is the better guess
/// let second = boundary.solve(&start, &Vector1::new(1.01), Guess::Path, &mut path)?.iterations();
/// assert!(second <= first);
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Guess<T, const M: usize> {
    /// A path with the same group element in every edge, the shortest way to the target, or at rest without one. A minimum is looked for.
    Geodesic,
    /// The same with this velocity ξ in 𝔤, for other windings: the velocity near it that leads to the target is taken. It may find no minimum.
    Velocity(SVector<T, M>),
    /// The increments that the nodes hold, from another start, target or system. An extremal is found that may be no minimum.
    Path,
}

/// Corrections of a constant group element, or of a path, until its end is near the target.
const PASSES: usize = 60;
/// The edges of a coarse path, an even number: a step has at most two.
pub(super) const COARSE: usize = 8;
/// Edges from which on a coarse path is made.
const MANY: usize = 4 * COARSE;
/// Corrections of the coarse path.
const CORRECTIONS: usize = 3;

/// The motions of the vertices of a coarse path, q_0 first.
type Motions<T, const M: usize> = [SVector<T, M>; COARSE + 1];

impl<T: Real, S: Variational<M, Scalar = T>, B: Differentiated<S, M>, const M: usize> Search<'_, S, M, B> {
    /// Fills the nodes with the guess and brings the end so near to the target that Newton's method takes over.
    pub fn prepare(&mut self, guess: &Guess<T, M>) -> Result<(), Error> {
        let start = match guess {
            Guess::Geodesic => Some(Space::origin()),
            Guess::Velocity(velocity) => Some(velocity * (self.problem.h / T::from_f64(B::EDGES.max(1) as f64))),
            Guess::Path => None,
        };
        let mut motions = None;
        if let Some(start) = start {
            let is_geodesic = *guess == Guess::Geodesic && self.problem.target.is_some();
            if is_geodesic {
                let gap = self.problem.end(self.problem.start, self.path.len());
                if gap.is_orthogonal() {
                    return Err(Error::UndeterminedDirection { distance: gap.distance.to_f64() });
                }
            }
            let eta = self.constant(start);
            motions = if is_geodesic { self.coarse(&eta) } else { None };
            self.fill(&eta);
        }
        match motions {
            Some(motions) => {
                let edges = self.path.len();
                self.displace(|index, _| interpolated(&motions, edges, index + 1));
            }
            None => self.roll_out(),
        }
        self.close(T::from_ratio(1, 8));
        let gap = self.end();
        check_finite("the end of the guessed path", &[gap.distance, gap.along])?;
        if gap.is_orthogonal() { Err(gap.unreachable()) } else { Ok(()) }
    }

    /// η of the group element τ(η) that all edges share, corrected so that the end is brought to the target. Each correction is the arc over
    /// the gap, divided by the number of edges. It is exact where all motions commute and along the rotations about one axis; where it does
    /// not bring the end nearer, [`close`](Self::close) takes over.
    fn constant(&self, mut eta: SVector<T, M>) -> SVector<T, M> {
        let Endpoints { system, start, .. } = self.problem;
        let edges = self.path.len();
        let end_of = |eta: &SVector<T, M>| {
            // τ(η)ᴺ by squaring
            let mut square = system.retraction(eta);
            let mut power = system.retraction(&Space::origin());
            let mut exponent = edges;
            while exponent > 0 {
                if exponent & 1 == 1 {
                    power = system.compose(&power, &square);
                }
                square = system.compose(&square, &square);
                exponent >>= 1;
            }
            self.problem.end(&system.advance(start, &power), edges)
        };
        let mut end = end_of(&eta);
        for _ in 0..PASSES {
            if end.is_near(T::from_ratio(1, 256)) || end.is_orthogonal() {
                break;
            }
            let next = eta + end.arc() / T::from_f64(edges as f64);
            let next_end = end_of(&next);
            // Written so that NaN leaves the loop.
            if next_end.distance < end.distance {
                (eta, end) = (next, next_end);
            } else {
                break;
            }
        }
        eta
    }

    /// Makes all increments those of τ(η).
    fn fill(&mut self, eta: &SVector<T, M>) {
        let increment = self.problem.system.retraction(eta);
        self.path.iter_mut().for_each(|node| node.increment = increment);
    }

    /// How the vertices of a coarse path move from where all its edges are alike to near where its action is least. The
    /// path has as many steps as it takes in the same time, and its first nodes are made use of. `None` for a path of
    /// few edges, and where corrections are not small motions towards a minimum. Steps may then be too long for the
    /// motion.
    fn coarse(&mut self, eta: &SVector<T, M>) -> Option<Motions<T, M>> {
        let ratio = T::from_f64(self.path.len() as f64) / T::from_f64(COARSE as f64);
        let path = self.path.get_mut(..COARSE).filter(|_| ratio >= T::from_f64((MANY / COARSE) as f64))?;
        let h = self.problem.h * ratio;
        let constants = B::Scheme::constants(self.problem.system, h).ok()?;
        let problem = Endpoints { h, constants: &constants, ..self.problem };
        let mut few = Search { problem, path, last: self.last };
        let eta = few.constant(eta * ratio);
        few.fill(&eta);
        few.roll_out();
        let mut motions: Motions<T, M> = Space::origin();
        let mut bound = T::one();
        for _ in 0..CORRECTIONS {
            let summary = few.eliminate(&few.end(), Curvature::exact(T::zero()));
            // Written so that NaN is no progress.
            if !(summary.negative == 0 && summary.size <= bound) {
                return None;
            }
            few.correct(T::one());
            motions.iter_mut().skip(1).zip(few.path.iter()).for_each(|(sum, node)| *sum += node.motion);
            // The next correction would be less than the difference of few edges from many.
            if summary.size <= T::from_ratio(1, 8) {
                return motions.all_finite().then_some(motions);
            }
            bound = summary.size * T::from_ratio(1, 2);
        }
        None
    }

    /// Moves vertex k by k/N of the gap at the end. It ends when the gap is below `enough` of the configuration, or
    /// when no pass makes it smaller.
    #[cold]
    pub fn close(&mut self, enough: T) {
        let edges = T::from_f64(self.path.len() as f64);
        let mut gap = self.end();
        let mut fraction = T::one();
        for _ in 0..PASSES {
            if gap.is_near(enough) || gap.is_orthogonal() || !gap.distance.is_finite() {
                break;
            }
            let motion = gap.arc() * fraction;
            self.displace(|index, _| motion * (T::from_f64((index + 1) as f64) / edges));
            let next = self.end();
            // Written so that NaN is taken back.
            if next.distance < gap.distance {
                gap = next;
                continue;
            }
            self.take_back();
            if gap.is_reached() {
                break;
            }
            fraction *= T::from_ratio(1, 2);
        }
    }
}

/// The motion of vertex k of a path of so many edges: a cubic through those of the four coarse vertices about it.
pub(super) fn interpolated<T: Real, const M: usize>(motions: &Motions<T, M>, edges: usize, k: usize) -> SVector<T, M> {
    let half = T::from_ratio(1, 2);
    let sixth = T::from_ratio(1, 6);
    let spacing = T::from_f64(COARSE as f64) / T::from_f64(edges as f64);
    let first = (k * COARSE / edges.max(1)).saturating_sub(1).min(COARSE - 3);
    let x = T::from_f64(k as f64) * spacing - T::from_f64(first as f64);
    let (a, b, c) = (x - T::one(), x - T::from_f64(2.0), x - T::from_f64(3.0));
    let (early, late) = (b * c, x * a);
    let weights = [-a * early * sixth, x * early * half, -late * c * half, late * b * sixth];
    let nearest = motions.iter().skip(first).zip(weights);
    nearest.fold(SVector::zeros(), |sum, (motion, weight)| sum + motion * weight)
}
