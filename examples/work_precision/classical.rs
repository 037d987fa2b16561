//! Methods for any differential equation, to compare with: the classical Runge–Kutta method of order 4 and DOP853.

use crate::dormand_prince::{Adaptive, DormandPrince};
use crate::motion::Field;
use crate::setting::{Dial, Family, Name, Observe, READING, SAMPLES, Setting, clock_steps, fixed, is_observed};
use clebsch::Error;
use nalgebra::SVector;
use std::hint::black_box;
use std::time::Instant;

/// ẏ = f(y) in M numbers.
///
/// Methods evaluate it at several places. Where the optimiser chooses, it inlines some of them, and the times of one method
/// differ from build to build. So each implementation says whether to inline, whichever is faster for DOP853.
pub trait VectorField<const M: usize> {
    /// f(y)
    fn rates(&self, y: &SVector<f64, M>) -> SVector<f64, M>;
}

/// ẏ = f(y) in M numbers, the fast form of a person, next to the N of the scene.
#[derive(Clone)]
pub struct Equation<F, const M: usize, const N: usize> {
    /// f
    pub field: F,
    /// y at the start.
    pub start: SVector<f64, M>,
    /// y as the numbers of the scene.
    pub flat: fn(&SVector<f64, M>) -> SVector<f64, N>,
}

impl<F: VectorField<M> + Clone + 'static, const M: usize, const N: usize> Equation<F, M, N> {
    /// Both classical methods for it.
    pub fn settings(self) -> [Box<dyn Setting<N>>; 2] {
        [Box::new(RungeKutta(self.clone())), Box::new(Embedded(self))]
    }
}

impl<const N: usize> VectorField<N> for Field<N> {
    fn rates(&self, y: &SVector<f64, N>) -> SVector<f64, N> {
        self(y)
    }
}

/// One step of the classical method of order 4.
#[inline]
pub fn runge_kutta<const M: usize>(field: &impl VectorField<M>, y: &SVector<f64, M>, h: f64) -> SVector<f64, M> {
    let a = field.rates(y);
    let b = field.rates(&(y + a * (h / 2.0)));
    let c = field.rates(&(y + b * (h / 2.0)));
    let d = field.rates(&(y + c * h));
    (a + (b + c) * 2.0 + d) * (h / 6.0)
}

/// Steps of equal length.
struct RungeKutta<F, const M: usize, const N: usize>(Equation<F, M, N>);

impl<F: VectorField<M>, const M: usize, const N: usize> Setting<N> for RungeKutta<F, M, N> {
    fn name(&self) -> Name {
        Name { method: "RK4", order: 4, family: Family::Classical, tolerance: None }
    }

    fn walk(&self, dial: Dial, duration: f64, observe: &mut Observe<'_, N>) -> Result<u64, Error> {
        let Equation { field, start, flat } = &self.0;
        let (steps, h) = fixed(dial, duration);
        let mut y = *start;
        for step in 0..=steps {
            if is_observed(step, steps) {
                observe(step as f64 * h, &flat(&y));
            }
            y += runge_kutta(field, &y, h);
        }
        Ok(steps)
    }

    fn clock(&self, dial: Dial, duration: f64) -> f64 {
        let (steps, h) = fixed(dial, duration);
        clock_steps(steps, h, self.0.start, |y| y + runge_kutta(&self.0.field, y, h))
    }
}

/// Steps as long as a tolerance allows.
struct Embedded<F, const M: usize, const N: usize>(Equation<F, M, N>);

impl<F: VectorField<M>, const M: usize, const N: usize> Setting<N> for Embedded<F, M, N> {
    fn name(&self) -> Name {
        Name { method: "DOP853", order: 8, family: Family::Classical, tolerance: None }
    }

    fn is_adaptive(&self) -> bool {
        true
    }

    fn walk(&self, dial: Dial, duration: f64, observe: &mut Observe<'_, N>) -> Result<u64, Error> {
        let Equation { field, start, flat } = &self.0;
        let mut motion = adaptive(field, start, dial);
        observe(0.0, &flat(start));
        for sample in 1..=SAMPLES {
            motion.advance(duration * sample as f64 / SAMPLES as f64, |time, y| observe(time, &flat(y)));
        }
        Ok(motion.steps())
    }

    /// Steps are not shortened here to end at the samples.
    fn clock(&self, dial: Dial, duration: f64) -> f64 {
        let Equation { field, start, .. } = &self.0;
        let mut runs = 0;
        let began = Instant::now();
        while began.elapsed().as_nanos() < READING {
            let mut motion = adaptive(field, black_box(start), dial);
            motion.advance(duration, |_, _| {});
            runs += 1;
            black_box(motion.y());
        }
        began.elapsed().as_nanos() as f64 / (f64::from(runs) * duration)
    }
}

fn adaptive<'a, F: VectorField<M>, const M: usize>(
    field: &'a F,
    start: &SVector<f64, M>,
    dial: Dial,
) -> Adaptive<'a, F, M> {
    let tolerance = if let Dial::Tolerance(tolerance) = dial { tolerance } else { f64::NAN };
    Adaptive::new(DormandPrince { field }, start, tolerance)
}
