//! Momenta that no step changes, with their names.

use crate::fields::getters;
use crate::{Clebsch, Columns, Scalar};
use core::fmt::{self, Debug, Display, Formatter, LowerExp};
use core::iter::Zip;
use core::ops::Index;

/// A system with conserved momenta.
///
/// Implemented by `#[derive(Clebsch)]` where it has found some: a system without any has no method
/// [`Stepper::conserved`](crate::Stepper::conserved). Found are the directions of the symmetries along which cost and potential are
/// invariant for every value of the parameters (Noether's theorem). A step keeps their momenta exactly, a computed one to round-off.
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// assert_eq!(stepper.conserved(&start).to_string(), "along e1, spatial = 6");
/// # Ok::<(), clebsch::Error>(())
/// ```
///
/// Source: Marsden and West, *Discrete mechanics and variational integrators*, 2001, theorem 1.3.3.
#[diagnostic::on_unimplemented(
    message = "no conserved momentum of `{Self}` was found",
    note = "write `symmetry = |S: SO<3>, q, F| …` in the declaration to offer a symmetry that lies outside its group"
)]
pub trait Conserves: Clebsch {
    /// The momenta: a [`Conserved`].
    type Conserved: Columns<Self::Scalar> + Copy + Debug + Display + PartialEq;

    /// The names of the momenta, in the order of their values.
    const CONSERVED_NAMES: &'static [&'static str];

    /// The conserved momenta at (q, μ).
    fn conserved(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Conserved;
}

/// The values of K conserved momenta, each with its name.
///
/// ```
/// use clebsch::Conserved;
///
/// let momenta = Conserved::new(["about e3, spatial", "about the axis, body"], [0.25, -1.5]);
/// assert_eq!(momenta[1], -1.5);
/// assert_eq!(momenta.get("about e3, spatial"), Some(0.25));
/// assert_eq!(momenta.to_string(), "about e3, spatial = 0.25\nabout the axis, body = -1.5");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conserved<T, const K: usize> {
    names: [&'static str; K],
    values: [T; K],
}

impl<T: Copy, const K: usize> Conserved<T, K> {
    /// Number i of `values` is called by number i of `names`.
    #[inline]
    pub const fn new(names: [&'static str; K], values: [T; K]) -> Self {
        Self { names, values }
    }

    getters! {
        /// The names.
        ref names: [&'static str; K];
        /// The values, in the units of the momentum.
        ref values: [T; K];
    }

    /// The value with this name.
    pub fn get(&self, name: &str) -> Option<T> {
        self.iter().find(|(own, _)| *own == name).map(|(_, value)| value)
    }

    /// All pairs of a name and its value.
    #[inline]
    pub fn iter(&self) -> Zip<core::array::IntoIter<&'static str, K>, core::array::IntoIter<T, K>> {
        self.names.into_iter().zip(self.values)
    }
}

/// The values of momenta with the names of their system, as many as there are values.
#[inline]
pub fn conserved<T, const K: usize>(names: &[&'static str], values: [T; K]) -> Conserved<T, K> {
    // by construction: there are K names
    Conserved { names: names.first_chunk().copied().unwrap_or([""; K]), values }
}

impl<T: Scalar, const K: usize> Conserved<T, K> {
    /// Those of the body in lane `lane`.
    #[inline]
    pub fn lane(&self, lane: usize) -> Conserved<T::Lane, K> {
        Conserved { names: self.names, values: self.values.map(|value| value.lane(lane)) }
    }
}

/// # Panics
/// As an array does, for an index that is not below K.
impl<T, const K: usize> Index<usize> for Conserved<T, K> {
    type Output = T;

    #[inline]
    fn index(&self, index: usize) -> &T {
        &self.values[index]
    }
}

/// One line `name = value` for each.
impl<T: Copy + Display, const K: usize> Display for Conserved<T, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.write_lines(f, T::fmt)
    }
}

impl<T: Copy, const K: usize> Conserved<T, K> {
    fn write_lines(
        &self,
        f: &mut Formatter<'_>,
        number: impl Fn(&T, &mut Formatter<'_>) -> fmt::Result,
    ) -> fmt::Result {
        for (index, (name, value)) in self.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n" };
            write!(f, "{separator}{name} = ")?;
            number(&value, f)?;
        }
        Ok(())
    }
}

/// The same with numbers in scientific form.
///
/// ```
/// use clebsch::Conserved;
///
/// let momenta = Conserved::new(["about e3, spatial"], [0.000_123_4]);
/// assert_eq!(format!("{momenta:.2e}"), "about e3, spatial = 1.23e-4");
/// ```
impl<T: Copy + LowerExp, const K: usize> LowerExp for Conserved<T, K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        self.write_lines(f, T::fmt)
    }
}

#[cfg(test)]
mod tests;
