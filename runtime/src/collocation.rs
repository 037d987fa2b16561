//! Steps of order 16: collocation of Hamilton's equations at the eight nodes of Gauss and Legendre.
//!
//! ```text
//! Y_i = y + h Σ_j a_ij K_j,    K_i = f(t + c_i h, Y_i),    y⁺ = y + h Σ_i b_i K_i,    y = (q, p)
//! ```
//! The method is symplectic on T*Q, and the same forwards and backwards. It conserves every invariant that is quadratic
//! in (q, p). With a linear action these are the momentum maps of all symmetries. Where q lies on an orbit of
//! rotations, the equations of that orbit are invariants too.
//!
//! The nodes lie the same about the middle of the step, and so a_ij − b_j/2 changes its sign where both stages are
//! mirrored. So two matrices of half the size make all stages, from sums and differences of the slopes K at mirrored
//! nodes. A tilde stands for the mirrored stage.
//! ```text
//! Y, Ỹ = y + h/2 Σ b_j (K̃_j + K_j) + h Σ even_ij (K̃_j − K_j) ± h Σ odd_ij (K̃_j + K_j),
//! even_ij = (a_ij̃ − a_ij)/2,    odd_ij = (a_ij + a_ij̃ − b_j)/2
//! ```
//! Slopes are found by iteration: each sweep over all stages leaves a part of the error that is proportional to h. All
//! stages of a sweep are independent, so that they fill the lanes of vector registers.
//!
//! Source: Hairer, Lubich and Wanner, *Geometric Numerical Integration*, sections II.1.3, IV.2.1 and VIII.6.

use crate::space::larger;
use crate::{Error, Mask, Scalar};
use num_traits::Zero;

/// The most sweeps of one step, unless fewer are asked for.
pub const SWEEPS: u32 = 64;
/// Sweeps after which a derivative has settled as well, for each order of derivatives.
const SWEEPS_OF_DERIVATIVES: u32 = 4;
/// A change that no longer shrinks is rounding where it is below this multiple of ε.
const ROUNDING: i64 = 1024;

/// Nodes and weights of Gauss and Legendre on [0, 1], and the matrices that act on slopes. Only those of the first half
/// of the nodes are stored; the others are mirrored.
#[derive(Clone, Copy, Debug)]
pub struct Gauss<const H: usize> {
    /// c_i
    nodes: [f64; H],
    /// b_i
    weights: [f64; H],
    /// (a_ij̃ − a_ij)/2
    even: [[f64; H]; H],
    /// (a_ij + a_ij̃ − b_j)/2
    odd: [[f64; H]; H],
}

/// Eight nodes: order 16.
pub const GAUSS_16: Gauss<4> = Gauss {
    nodes: [0.019_855_071_751_231_884, 0.101_666_761_293_186_64, 0.237_233_795_041_835_5, 0.408_282_678_752_175_1],
    weights: [0.050_614_268_145_188_13, 0.111_190_517_226_687_24, 0.156_853_322_938_943_63, 0.181_341_891_689_181],
    even: [
        [-0.012_792_321_199_855_492, 0.005_039_350_485_014_67, -0.004_099_253_200_833_713, 0.003_780_753_490_690_765_8],
        [-0.027_158_259_731_606_04, -0.028_580_096_762_146_28, 0.008_389_774_610_622_67, -0.006_682_530_473_753_852],
        [-0.024_603_170_847_081_697, -0.059_316_905_110_944_13, -0.041_535_063_665_788_15, 0.012_173_418_041_052_297],
        [-0.025_503_142_193_158_19, -0.054_695_652_229_354_59, -0.081_714_963_856_665_67, -0.053_345_993_582_807_755],
    ],
    odd: [
        [-0.012_792_321_199_855_492, -0.059_661_851_434_299_02, -0.076_245_083_523_275_07, -0.091_373_207_966_954_49],
        [0.002_293_927_963_354_214_4, -0.028_580_096_762_146_28, -0.083_676_683_094_630_82, -0.089_203_767_459_983_79],
        [-0.001_322_768_920_762_882, 0.005_947_361_272_885_416, -0.041_535_063_665_788_15, -0.094_472_631_165_416_63],
        [0.001_055_244_704_828_979, -0.004_097_420_694_349_799, 0.010_529_508_948_416_123, -0.053_345_993_582_807_755],
    ],
};

/// The same for a step of the size h, in the order in which sums need it.
struct Table<T, const H: usize> {
    nodes: [T; H],
    /// h b_j / 2
    weights: [T; H],
    /// h even_ij, columns first
    even: [[T; H]; H],
    /// h odd_ij, columns first
    odd: [[T; H]; H],
}

impl<const H: usize> Gauss<H> {
    #[inline]
    fn scaled<T: Scalar>(&self, h: T) -> Table<T, H> {
        let column = |matrix: &[[f64; H]; H], j: usize| core::array::from_fn(|i| h * T::from_f64(matrix[i][j]));
        let half = h * T::from_ratio(1, 2);
        Table {
            nodes: self.nodes.map(T::from_f64),
            weights: self.weights.map(|weight| half * T::from_f64(weight)),
            even: core::array::from_fn(|j| column(&self.even, j)),
            odd: core::array::from_fn(|j| column(&self.odd, j)),
        }
    }
}

/// y⁺ − y of a step of the size h that starts at the time t in y = (q, p), N numbers, q first. Of the S = 2H stages the second half are mirrored.
///
/// `guess` is a place near that after a part of the step. `terms` are K numbers of a time. `slope` is (q′, p′) at a time with these and a place. Sweeps end where they change q and p by less than
/// `tolerance` of them, where only rounding changes them, or after `most`. Ended one sweep earlier, energies would drift ten times as fast.
///
/// # Errors
/// [`Error::NotFinite`] where a slope is not, [`Error::NotConverged`] where sweeps do not contract: the step is too
/// long. An error stands for all lanes. A lane that fails while others succeed becomes NaN.
#[inline]
pub fn collocate<T: Scalar, const N: usize, const K: usize, const S: usize, const H: usize>(
    gauss: &Gauss<H>,
    (t, h): (T, T),
    start: &[T; N],
    (tolerance, most): (f64, u32),
    guess: impl Fn(T) -> [T; N],
    terms: impl Fn(T) -> [T; K],
    slope: impl Fn(T, &[T; K], &[T; N]) -> [T; N],
) -> Result<[T; N], Error> {
    const { assert!(S == 2 * H && N.is_multiple_of(2)) };
    let table = gauss.scaled(h);
    let tolerance = larger(T::from_f64(tolerance), T::EPSILON * T::from_ratio(4, 1));
    let (mut slopes, mut stages) = ([[T::zero(); S]; N], [[T::zero(); S]; N]);
    table.guess(&guess, &mut stages);
    let times = table.times((t, h), &terms);
    let (mut open, mut solved) = (T::Mask::everywhere(), T::Mask::nowhere());
    table.sweep((t, h), &times, &stages, open, &mut slopes, &slope);
    let (mut before, mut count) = (T::zero(), 0);
    while count < most && open.any() {
        T::iterated();
        table.stages(start, &slopes, &mut stages);
        let changes = table.sweep((t, h), &times, &stages, open, &mut slopes, &slope);
        count += 1;
        let sizes = sizes(h, start, &slopes);
        let change = changes[0] / positive(sizes[0]) + changes[1] / positive(sizes[1]);
        let stays = if count == 1 { T::Mask::nowhere() } else { before.at_most(change) };
        open = open & change.finite();
        let arrived =
            open & (change.at_most(tolerance) | stays & change.at_most(T::EPSILON * T::from_ratio(ROUNDING, 1)));
        (solved, open) = (solved | arrived, open & !arrived);
        // the last that was finite
        before = T::select(change.finite(), change, before);
    }
    if !solved.any() {
        return Err(failure(before, count, most));
    }
    for _ in 0..T::DERIVATIVES * SWEEPS_OF_DERIVATIVES {
        table.stages(start, &slopes, &mut stages);
        table.sweep((t, h), &times, &stages, solved, &mut slopes, &slope);
    }
    let mut change = *start;
    for v in 0..N {
        let half = table.sum(&slopes[v]);
        change[v] = T::select(solved, half + half, T::from_f64(f64::NAN));
    }
    Ok(change)
}

// written with loops over arrays in place: calls that make arrays of arrays are not inlined, and stages then do not share vector registers
impl<T: Scalar, const H: usize> Table<T, H> {
    /// The node of a stage, as a part of the step.
    #[inline]
    fn node(&self, stage: usize) -> T {
        if stage < H { self.nodes[stage] } else { T::one() - self.nodes[stage - H] }
    }

    /// Y_i as they are guessed.
    #[inline]
    fn guess<const N: usize, const S: usize>(&self, guess: &impl Fn(T) -> [T; N], stages: &mut [[T; S]; N]) {
        for i in 0..S {
            let place = guess(self.node(i));
            for v in 0..N {
                stages[v][i] = place[v];
            }
        }
    }

    /// The terms of the times of all stages.
    #[inline]
    fn times<const K: usize, const S: usize>(&self, (t, h): (T, T), terms: &impl Fn(T) -> [T; K]) -> [[T; S]; K] {
        let mut times = [[T::zero(); S]; K];
        for i in 0..S {
            let found = terms(t + self.node(i) * h);
            for k in 0..K {
                times[k][i] = found[k];
            }
        }
        times
    }

    /// h/2 Σ b_j (K̃_j + K_j)
    #[inline]
    fn sum<const S: usize>(&self, slopes: &[T; S]) -> T {
        let mut parts = [T::zero(); H];
        for j in 0..H {
            parts[j] = self.weights[j] * (slopes[H + j] + slopes[j]);
        }
        parts.into_iter().fold(T::zero(), |sum, part| sum + part)
    }

    /// Y_i
    #[inline(always)]
    fn stages<const N: usize, const S: usize>(&self, start: &[T; N], slopes: &[[T; S]; N], stages: &mut [[T; S]; N]) {
        for v in 0..N {
            let (slopes, stages) = (&slopes[v], &mut stages[v]);
            let (mut sums, mut differences) = ([T::zero(); H], [T::zero(); H]);
            for j in 0..H {
                sums[j] = slopes[H + j] + slopes[j];
                differences[j] = slopes[H + j] - slopes[j];
            }
            let (mut even, mut odd) = ([start[v] + self.sum(slopes); H], [T::zero(); H]);
            for j in 0..H {
                for i in 0..H {
                    even[i] += self.even[j][i] * differences[j];
                }
                for i in 0..H {
                    odd[i] += self.odd[j][i] * sums[j];
                }
            }
            for i in 0..H {
                stages[i] = even[i] + odd[i];
            }
            for i in 0..H {
                stages[H + i] = even[i] - odd[i];
            }
            // keeps the optimiser from taking several v at once, with gathers: 1.7 times slower where registers are wide
            core::hint::black_box(());
        }
    }

    /// The slopes at all stages, in the lanes that are open. With them, |h ΔK| of q and of p: the sums over all stages
    /// and entries.
    #[inline(always)]
    fn sweep<const N: usize, const K: usize, const S: usize>(
        &self,
        (t, h): (T, T),
        times: &[[T; S]; K],
        stages: &[[T; S]; N],
        open: T::Mask,
        slopes: &mut [[T; S]; N],
        slope: &impl Fn(T, &[T; K], &[T; N]) -> [T; N],
    ) -> [T; 2] {
        let mut changes = [[T::zero(); S]; 2];
        for i in 0..S {
            let mut place = [T::zero(); N];
            for v in 0..N {
                place[v] = stages[v][i];
            }
            let mut terms = [T::zero(); K];
            for k in 0..K {
                terms[k] = times[k][i];
            }
            let found = slope(t + self.node(i) * h, &terms, &place);
            for v in 0..N {
                let change = found[v] - slopes[v][i];
                changes[2 * v / N][i] += change.abs();
                // a single lane is open as long as there are sweeps
                slopes[v][i] = if T::LANES == 1 { found[v] } else { T::select(open, found[v], slopes[v][i]) };
            }
        }
        changes.map(|changes| changes.into_iter().fold(T::zero(), |sum, change| sum + change) * h.abs())
    }
}

/// |q| and |p| with h q′ and h p′ at the first node and at the last: sums, as squares would leave the range of numbers sooner.
#[inline]
fn sizes<T: Scalar, const N: usize, const S: usize>(h: T, start: &[T; N], slopes: &[[T; S]; N]) -> [T; 2] {
    let mut sizes = [T::zero(); 2];
    for v in 0..N {
        let (one, other) = (h * slopes[v][0], h * slopes[v][S / 2]);
        sizes[2 * v / N] += start[v].abs() + (one.abs() + other.abs());
    }
    sizes
}

/// Why sweeps have found nothing: changes did not shrink, whether or not they overflowed later; or slopes are not finite near the stages.
#[cold]
fn failure<T: Scalar>(last_change: T, sweeps: u32, most: u32) -> Error {
    let is_large = T::from_ratio(1, 16).below(last_change).any();
    if sweeps < most && !(sweeps > 1 && is_large) {
        return Error::NotFinite { name: "a slope of Hamilton's equations within the step" };
    }
    let largest = (0..T::LANES).map(|lane| last_change.lane(lane)).fold(T::Lane::zero(), larger);
    Error::NotConverged { residual: largest.to_f64(), iterations: sweeps }
}

/// x, or 1 where x = 0.
#[inline]
fn positive<T: Scalar>(x: T) -> T {
    T::select(x.equals(T::zero()), T::one(), x)
}

#[cfg(test)]
mod tests;
