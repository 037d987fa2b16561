//! DOP853: the method of Dormand and Prince of order 8 with embedded methods of orders 5 and 3. Its steps are as long
//! as a tolerance allows.
//!
//! Source: Hairer, Nørsett and Wanner, *Solving Ordinary Differential Equations I*, §II.5 and §II.10; coefficients of its program DOP853.

use crate::classical::VectorField;
use nalgebra::SVector;

/// a_ij of the stages 2 to 12.
#[rustfmt::skip]
const A: [[f64; 11]; 11] = [
    [0.05260015195876773, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0197250569845379, 0.0591751709536137, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.02958758547680685, 0.0, 0.08876275643042054, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.2413651341592667, 0.0, -0.8845494793282861, 0.924834003261792, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.037037037037037035, 0.0, 0.0, 0.17082860872947386, 0.12546768756682242, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.037109375, 0.0, 0.0, 0.17025221101954405, 0.06021653898045596, -0.017578125, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.03709200011850479, 0.0, 0.0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402, 0.008273789163814023, 0.0, 0.0, 0.0, 0.0],
    [0.6241109587160757, 0.0, 0.0, -3.3608926294469414, -0.868219346841726, 27.59209969944671, 20.154067550477894, -43.48988418106996, 0.0, 0.0, 0.0],
    [0.47766253643826434, 0.0, 0.0, -2.4881146199716677, -0.590290826836843, 21.230051448181193, 15.279233632882423, -33.28821096898486, -0.020331201708508627, 0.0, 0.0],
    [-0.9371424300859873, 0.0, 0.0, 5.186372428844064, 1.0914373489967295, -8.149787010746927, -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196, 0.0],
    [2.273310147516538, 0.0, 0.0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996, -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636],
];
/// b_i
#[rustfmt::skip]
const B: [f64; 12] = [0.054293734116568765, 0.0, 0.0, 0.0, 0.0, 4.450312892752409, 1.8915178993145003, -5.801203960010585, 0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259];
/// b_i less those of the embedded method of order 5.
#[rustfmt::skip]
const FIFTH: [f64; 12] = [0.01312004499419488, 0.0, 0.0, 0.0, 0.0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864, -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294];
/// The b_i that the embedded method of order 3 has at the stages 1, 9 and 12.
const THIRD: [(usize, f64); 3] = [(0, 0.2440944881889764), (8, 0.7338466882816118), (11, 0.022058823529411766)];

/// How much a next step may be shorter or longer than the last.
const CHANGE: (f64, f64) = (0.333, 6.0);
/// A step is proposed at this share of the length that would just do.
const SAFETY: f64 = 0.9;
/// Steps up to one time, at most.
const MOST: u64 = 10_000_000;

/// The method for ẏ = f(y).
#[derive(Clone, Copy)]
pub struct DormandPrince<'a, F> {
    /// f
    pub field: &'a F,
}

/// y after a step, and the differences of the embedded methods of orders 5 and 3 from it, over h.
struct Step<const M: usize> {
    next: SVector<f64, M>,
    fifth: SVector<f64, M>,
    third: SVector<f64, M>,
}

impl<F> DormandPrince<'_, F> {
    #[inline]
    fn step<const M: usize>(&self, y: &SVector<f64, M>, slope: &SVector<f64, M>, h: f64) -> Step<M>
    where
        F: VectorField<M>,
    {
        let mut k = [SVector::zeros(); 12];
        k[0] = *slope;
        // unrolled, so that the optimiser sees the coefficients that are 0
        macro_rules! stages {
            ($($stage:literal)*) => { $(
                k[$stage] = self.field.rates(&(y + sum::<M, $stage>(&A[$stage - 1], &k) * h));
            )* };
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11);
        let mean = sum::<M, 12>(&B, &k);
        let third = THIRD.iter().fold(mean, |sum, &(stage, b)| sum - k[stage] * b);
        Step { next: y + mean * h, fifth: sum::<M, 12>(&FIFTH, &k), third }
    }
}

/// Σ aᵢ kᵢ over the first S.
#[inline(always)]
fn sum<const M: usize, const S: usize>(a: &[f64], k: &[SVector<f64, M>; 12]) -> SVector<f64, M> {
    let mut sum = k[0] * a[0];
    for stage in 1..S {
        if a[stage] != 0.0 {
            sum += k[stage] * a[stage];
        }
    }
    sum
}

/// A motion in steps of variable length.
pub struct Adaptive<'a, F, const M: usize> {
    method: DormandPrince<'a, F>,
    tolerance: f64,
    time: f64,
    h: f64,
    y: SVector<f64, M>,
    slope: SVector<f64, M>,
    steps: u64,
}

impl<'a, F: VectorField<M>, const M: usize> Adaptive<'a, F, M> {
    /// At the start; `tolerance` is relative for numbers above 1 and absolute for those below.
    pub fn new(method: DormandPrince<'a, F>, start: &SVector<f64, M>, tolerance: f64) -> Self {
        let slope = method.field.rates(start);
        // an eighth root of the tolerance in the time in which y changes by itself
        let h = tolerance.powf(0.125) * 0.1 * (1.0 + start.amax()) / slope.amax().max(f64::MIN_POSITIVE);
        Self { method, tolerance, time: 0.0, h, y: *start, slope, steps: 0 }
    }

    /// Goes on to a time; each step that is accepted is shown.
    #[inline]
    pub fn advance(&mut self, end: f64, mut observe: impl FnMut(f64, &SVector<f64, M>)) {
        let mut rejected = false;
        for _ in 0..MOST {
            let last = self.time + 1.01 * self.h >= end;
            let h = if last { end - self.time } else { self.h };
            let step = self.method.step(&self.y, &self.slope, h);
            let error = self.error(&step, h);
            self.steps += 1;
            let longest = if rejected { 1.0 } else { CHANGE.1 };
            let factor = (SAFETY * error.powf(-0.125)).clamp(CHANGE.0, longest);
            rejected = error > 1.0;
            if rejected {
                self.h = h * factor.min(1.0);
                continue;
            }
            self.time = if last { end } else { self.time + h };
            self.y = step.next;
            self.slope = self.method.field.rates(&self.y);
            // a step that was shortened to end here says little about the next
            self.h = if last { self.h.max(h * factor) } else { h * factor };
            observe(self.time, &self.y);
            if last {
                return;
            }
        }
    }

    /// The estimate of Hairer, Nørsett and Wanner, (10.17), over the tolerance.
    #[inline]
    fn error(&self, step: &Step<M>, h: f64) -> f64 {
        let (mut fifth, mut third) = (0.0, 0.0);
        for i in 0..M {
            let scale = self.tolerance * (1.0 + self.y[i].abs().max(step.next[i].abs()));
            fifth += (step.fifth[i] / scale).powi(2);
            third += (step.third[i] / scale).powi(2);
        }
        let both = fifth + 0.01 * third;
        if both > 0.0 { h.abs() * fifth / (both * M as f64).sqrt() } else { 0.0 }
    }

    /// Where the motion is.
    pub fn y(&self) -> &SVector<f64, M> {
        &self.y
    }

    /// Steps so far, those that were rejected too.
    pub fn steps(&self) -> u64 {
        self.steps
    }
}
