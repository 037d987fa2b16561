//! The numbers of parameters, configurations and momenta, one by one, to be replaced.

use nalgebra::{Quaternion, SMatrix};

/// A number in its place.
pub enum Slot<'a> {
    Double(&'a mut f64),
    Single(&'a mut f32),
}

impl Slot<'_> {
    /// Puts a number here, rounded to the precision of the place; a finite one stays finite.
    pub fn put(self, value: f64) {
        match self {
            Slot::Double(slot) => *slot = value,
            Slot::Single(slot) => *slot = single(value),
        }
    }
}

/// Where double precision ends, single precision does: the largest and the smallest are those of the other type.
fn single(value: f64) -> f32 {
    let [largest, least] = [f64::from(f32::MAX), 1e-45];
    match value.abs() {
        size if size > largest && size.is_finite() => f32::MAX.copysign(value as f32),
        size if size < least && size > 0.0 => f32::from_bits(1).copysign(value as f32),
        _ => value as f32,
    }
}

/// The numbers that a trial starts from.
#[derive(Clone, Copy)]
pub enum Part {
    Configuration,
    Momentum,
    Input,
}

/// Values that are made of numbers.
pub trait Slots {
    /// Visits all of them, in an order of its own.
    fn slots(&mut self) -> Vec<Slot<'_>>;

    /// The same with the number `value` at a place.
    fn with(mut self, place: usize, value: f64) -> Self
    where
        Self: Sized,
    {
        self.slots().into_iter().nth(place).expect("a place").put(value);
        self
    }
}

impl Slots for () {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        Vec::new()
    }
}
impl Slots for f64 {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        vec![Slot::Double(self)]
    }
}
impl Slots for f32 {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        vec![Slot::Single(self)]
    }
}
impl<T: Slots, const R: usize, const C: usize> Slots for SMatrix<T, R, C> {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        self.data.0.iter_mut().flatten().flat_map(Slots::slots).collect()
    }
}
impl<T: Slots> Slots for Quaternion<T> {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        self.coords.data.0.iter_mut().flatten().flat_map(Slots::slots).collect()
    }
}
impl<A: Slots, B: Slots> Slots for (A, B) {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        let (a, b) = self;
        a.slots().into_iter().chain(b.slots()).collect()
    }
}
impl<A: Slots, B: Slots, C: Slots> Slots for (A, B, C) {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        self.0.slots().into_iter().chain(self.1.slots()).chain(self.2.slots()).collect()
    }
}
impl<A: Slots, const N: usize> Slots for [A; N] {
    fn slots(&mut self) -> Vec<Slot<'_>> {
        self.iter_mut().flat_map(Slots::slots).collect()
    }
}
