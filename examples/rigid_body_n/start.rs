//! The body and its motion at the start.

use crate::euler;
use clap::Args;
use clebsch_examples::flags::{finite_numbers, positive};
use clebsch_examples::noise::Noise;
use clebsch_examples::scene::Failure;
use nalgebra::{SMatrix, SVector};

/// Flags of the body and of its motion.
#[derive(Args, Clone, Debug)]
pub struct Body {
    /// Diagonal of J_d (half the second moments of mass), n numbers, kg m2; every two of them must have a sum above zero [default: 1,1.5,2,..]
    #[arg(long, value_name = "A,B,..", value_parser = numbers, allow_hyphen_values = true)]
    j_d: Option<Numbers>,
    /// Speed at the start, rad/s: the root of the sum of the squared rates in all planes
    #[arg(long, value_name = "W", value_parser = positive, allow_hyphen_values = true, default_value = "1")]
    rate: f64,
    /// Which rates in the planes, drawn at random
    #[arg(long, value_name = "S", default_value = "1", allow_hyphen_values = true)]
    seed: u64,
    /// Momentum at the start, body frame, in place of rate and seed. These are the n(n - 1)/2 entries above the
    /// diagonal of the matrix M, row by row, kg m2/s
    #[arg(long, value_name = "M12,..", value_parser = numbers, allow_hyphen_values = true)]
    #[arg(conflicts_with_all = ["rate", "seed"])]
    momentum: Option<Numbers>,
}

/// As many numbers as were given: a list that clap does not take for a flag that may be repeated.
#[derive(Clone, Debug)]
struct Numbers(Vec<f64>);

fn numbers(text: &str) -> Result<Numbers, String> {
    finite_numbers(text).map(Numbers)
}

/// The body in its principal axes, and its momentum at the start.
pub struct Start<const N: usize> {
    /// The diagonal of J_d.
    pub j_d: SVector<f64, N>,
    /// M, body frame.
    pub momentum: SMatrix<f64, N, N>,
}

impl<const N: usize> Start<N> {
    /// Reads the flags.
    ///
    /// # Errors
    /// [`Failure::Flags`] for too many or too few numbers, and for a kinetic energy that is not positive.
    pub fn new(flags: &Body) -> Result<Self, Failure> {
        let j_d = match &flags.j_d {
            Some(Numbers(given)) => SVector::from_column_slice(counted(given, "--j-d", N, N)?),
            None => SVector::from_fn(|i, _| 1.0 + 0.5 * i as f64),
        };
        for (i, j) in planes(N) {
            let sum = j_d[i] + j_d[j];
            if sum <= 0.0 {
                let (i, j) = (i + 1, j + 1);
                return Err(Failure::Flags(format!(
                    "--j-d: entries {i} and {j} have the sum {sum}: it must be above zero"
                )));
            }
        }
        let momentum = match &flags.momentum {
            Some(Numbers(given)) => skew(counted(given, "--momentum", N, planes(N).count())?),
            None => drawn(flags, &j_d),
        };
        Ok(Self { j_d, momentum })
    }

    /// The norm of the velocity, rad/s: no rate of the motion is above it.
    pub fn rate(&self) -> f64 {
        euler::velocity(&self.momentum, &self.j_d).norm()
    }
}

/// The planes of rotation: row and column of each entry above the diagonal, from 0, row by row.
pub fn planes(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (i + 1..n).map(move |j| (i, j)))
}

fn counted<'a>(given: &'a [f64], flag: &str, n: usize, count: usize) -> Result<&'a [f64], Failure> {
    let found = given.len();
    if found == count {
        return Ok(given);
    }
    Err(Failure::Flags(format!(
        "{flag}: in {n} dimensions {count} numbers separated by commas are needed, {found} were given"
    )))
}

/// The skew matrix with these entries above the diagonal.
fn skew<const N: usize>(entries: &[f64]) -> SMatrix<f64, N, N> {
    let mut matrix = SMatrix::zeros();
    for ((i, j), entry) in planes(N).zip(entries) {
        matrix[(i, j)] = *entry;
        matrix[(j, i)] = -entry;
    }
    matrix
}

/// The momentum of a velocity in a random direction.
fn drawn<const N: usize>(flags: &Body, j_d: &SVector<f64, N>) -> SMatrix<f64, N, N> {
    let mut noise = Noise::new(flags.seed);
    let rates: Vec<f64> = planes(N).map(|_| noise.normal()).collect();
    let speed = rates.iter().map(|rate| rate * rate).sum::<f64>().sqrt();
    euler::momentum(&(skew::<N>(&rates) * (flags.rate / speed)), j_d)
}
