//! The states of a motion as the rows of a table.

use crate::columns::{Column, Columns, Form, Names};
use crate::fields::debug_fields;
use crate::parameters::check_finite;
use crate::{Clebsch, Clock, Conserves, Declared, Error, Event, Method, Space, State, Stepper, Time};
use core::fmt::{self, Debug, Formatter};
use core::marker::PhantomData;

/// The columns of a table whose rows are the states of a [`Stepper`]: the time `t`, the configuration, the momentum `N`.
///
/// Made by [`Stepper::table`]. [`energy`](Self::energy), [`conserved`](Self::conserved) and [`with`](Self::with) put more
/// columns behind. The configuration has the names of the declared action. Its numbers follow each other as
/// [`Columns`] says, and [`Column`] names them. Components of the momentum are in the basis that
/// [`group`](crate::group) documents. If the configuration has the name `N`, the momentum is called `momentum`.
///
/// Neither columns nor rows take memory from the heap. With the feature `record`, `record::Recorder` writes them to files.
///
/// ```
/// use clebsch::Clebsch;
/// use nalgebra::{Vector2, Vector3};
///
/// /// A pendulum of length one and mass one.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
///     potential = |q| self.gravity * q.z,
/// )]
/// struct Bob {
///     /// g, m/s².
///     gravity: f64,
/// }
///
/// let stepper = Bob { gravity: 9.81 }.into_stepper(0.01)?;
/// let table = stepper.table().energy().conserved().with("above", |state| state.configuration().xy());
/// let names: Vec<String> = table.columns().map(|column| column.to_string()).collect();
/// assert_eq!(
///     names,
///     ["t", "q.x", "q.y", "q.z", "N[0]", "N[1]", "N[2]", "energy", "about e3, spatial", "above.x", "above.y"]
/// );
///
/// let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.3, 0.5))?;
/// let row: Vec<f64> = table.row(0.0, &start).collect();
/// assert_eq!(row[..7], [0.0, 1.0, 0.0, 0.0, 0.0, 0.3, 0.5]);
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Table<'a, S: Clebsch, M: Method<S> = Declared, L = ()> {
    stepper: &'a Stepper<S, M>,
    more: L,
    units: &'a [(&'a str, &'a str)],
}

impl<S: Clebsch, M: Method<S>, L: Copy> Copy for Table<'_, S, M, L> {}

impl<S: Clebsch, M: Method<S>, L: Clone> Clone for Table<'_, S, M, L> {
    fn clone(&self) -> Self {
        Self { more: self.more.clone(), ..*self }
    }
}

impl<S: Clebsch, M: Method<S>, L: Quantities<S, M>> Debug for Table<'_, S, M, L> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str("Table ")?;
        f.debug_list().entries(self.columns().map(|column| Shown(column, self.units.is_empty()))).finish()
    }
}

/// A column as a list of columns shows it.
struct Shown<'a>(Column<'a>, bool);

impl Debug for Shown<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.0.unit() {
            Some(unit) if !self.1 => write!(f, "{} ({unit})", self.0),
            _ => write!(f, "{}", self.0),
        }
    }
}

impl<S: Clebsch, M: Method<S>> Stepper<S, M> {
    /// The columns of a table of states: time, configuration and momentum; see [`Table`].
    pub fn table(&self) -> Table<'_, S, M> {
        Table { stepper: self, more: (), units: &[] }
    }
}

impl<'a, S: Clebsch, M: Method<S>, L: Quantities<S, M>> Table<'a, S, M, L> {
    fn and<X>(self, more: X) -> Table<'a, S, M, (L, X)> {
        Table { stepper: self.stepper, more: (self.more, more), units: self.units }
    }

    /// And the `energy`, as [`Stepper::energy`] has it.
    pub fn energy(self) -> Table<'a, S, M, (L, Energy)> {
        self.and(Energy)
    }

    /// And the conserved momenta by their names, as [`Stepper::conserved`] has them.
    pub fn conserved(self) -> Table<'a, S, M, (L, ConservedMomenta)>
    where
        S: Conserves,
    {
        self.and(ConservedMomenta)
    }

    /// And a value of your own: a number, a vector, a matrix, or a tuple or an array of these.
    pub fn with<V, F>(self, name: &'static str, value: F) -> Table<'a, S, M, (L, Own<V, F>)>
    where
        V: Columns<S::Scalar>,
        F: Fn(&State<S, M>) -> V,
    {
        self.and(Own { name, value, of: PhantomData })
    }

    /// The same columns with the units of some values, by name: `&[("t", "s"), ("q", "m")]`.
    ///
    /// All numbers of a value have its unit. Values that are not in the list have none.
    pub fn units(self, units: &'a [(&'a str, &'a str)]) -> Self {
        Self { units, ..self }
    }

    /// The names of t, q and N, with their forms.
    fn of_state(&self) -> [(Names, Form); 3] {
        let momentum = if S::CONFIGURATION_NAMES.contains("N") { "momentum" } else { "N" };
        [
            (Names::One("t"), Form::Number),
            (S::CONFIGURATION_NAMES, <S::Configuration as Columns<S::Scalar>>::FORM),
            (Names::Components(momentum), <S::Momentum as Columns<S::Scalar>>::FORM),
        ]
    }

    /// The values with their names and forms, one after the other.
    pub(crate) fn quantities(&self) -> impl Iterator<Item = (Names, Form)> + '_ {
        self.of_state().into_iter().chain((0..L::COUNT).filter_map(|number| self.more.quantity(number)))
    }

    /// The columns.
    pub fn columns(&self) -> impl Iterator<Item = Column<'a>> + '_ {
        let units = self.units;
        self.quantities()
            .flat_map(move |(names, form)| (0..form.width()).map(move |k| Column::new(names, form, k, units)))
    }

    /// The numbers of a state at a time, one for each column.
    ///
    /// States of a system that does not depend on the time do not know theirs:
    /// [`Timed::with_times`](crate::Timed::with_times) gives both.
    pub fn row(&self, time: S::Scalar, state: &State<S, M>) -> Row<S, L::Values> {
        let of_state = (time, state.configuration, state.momentum());
        Row { of_state, more: self.more.values(self.stepper, state), next: 0 }
    }

    /// The stepper whose states are the rows.
    pub fn stepper(&self) -> &'a Stepper<S, M> {
        self.stepper
    }

    /// The state of a row: its time, its configuration and its momentum, checked as by [`Stepper::state`].
    ///
    /// More columns are not read. `None` if there are fewer than those three have. A system that does not depend on the
    /// time ignores it.
    ///
    /// ```
    /// # use clebsch::Clebsch;
    /// # #[derive(Clebsch, Clone, Debug)]
    /// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
    /// # struct Particle { mass: f64 }
    /// # use nalgebra::Vector1;
    /// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
    /// let read = stepper.table().state([0.0, 0.25, 6.0]);
    /// assert_eq!(read, Some(stepper.state(Vector1::new(0.25), Vector1::new(6.0))));
    /// assert_eq!(stepper.table().state([0.0, 0.25]), None);
    /// # Ok::<(), clebsch::Error>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`Stepper::state`], and [`Error::NotFinite`] for the time.
    pub fn state(&self, row: impl IntoIterator<Item = S::Scalar>) -> Option<Result<State<S, M>, Error>> {
        let (t, q, mu) = of_row::<S>(row)?;
        Some(check_finite("the time", &t).and_then(|()| self.stepper.checked_state(t, q, mu)))
    }

    /// The state nearest to a row, as [`Stepper::project`] finds it; `None` as for [`state`](Self::state).
    ///
    /// # Errors
    /// Those of [`Stepper::project`], and [`Error::NotFinite`] for the time.
    pub fn project(&self, row: impl IntoIterator<Item = S::Scalar>) -> Option<Result<State<S, M>, Error>> {
        let (t, q, mu) = of_row::<S>(row)?;
        Some(check_finite("the time", &t).and_then(|()| self.stepper.projected_at(t, q, mu)))
    }

    #[cfg(feature = "record")]
    pub(crate) fn given_units(&self) -> &'a [(&'a str, &'a str)] {
        self.units
    }
}

/// The time, the configuration and the momentum of a row.
fn of_row<S: Clebsch>(row: impl IntoIterator<Item = S::Scalar>) -> Option<(S::Scalar, S::Configuration, S::Momentum)> {
    Space::from_columns(&mut row.into_iter())
}

/// The numbers of a row, made by [`Table::row`].
///
/// ```
/// # use clebsch::Clebsch;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::new(0.25), Vector1::new(6.0))?;
/// let row = stepper.table().energy().row(0.0, &start);
/// assert!(row.eq([0.0, 0.25, 6.0, 9.0]));
/// # Ok::<(), clebsch::Error>(())
/// ```
pub struct Row<S: Clebsch, V> {
    of_state: (S::Scalar, S::Configuration, S::Momentum),
    more: V,
    next: usize,
}

impl<S: Clebsch, V: Columns<S::Scalar>> Iterator for Row<S, V> {
    type Item = S::Scalar;

    #[inline]
    fn next(&mut self) -> Option<S::Scalar> {
        let width = <(S::Scalar, S::Configuration, S::Momentum) as Columns<S::Scalar>>::FORM.width();
        let entry = if self.next < width { self.of_state.entry(self.next) } else { self.more.entry(self.next - width) };
        self.next += usize::from(entry.is_some());
        entry
    }
}

debug_fields!(Row<S, V> where [S: Clebsch, V: Debug]: of_state, more, next);

/// The columns of a [`Table`] behind those of a state. A function that takes tables has it as a bound.
///
/// [`Table::energy`], [`Table::conserved`] and [`Table::with`] make them, and `()` has none.
///
/// ```
/// use clebsch::{Clebsch, Method, Quantities, Table};
/// # use nalgebra::Vector1;
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
///
/// /// The first line of a table of any system.
/// fn head<S: Clebsch, M: Method<S>, L: Quantities<S, M>>(table: &Table<'_, S, M, L>) -> String {
///     table.columns().map(|column| column.to_string()).collect::<Vec<_>>().join(", ")
/// }
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// assert_eq!(head(&stepper.table().energy()), "t, x.x, N[0], energy");
/// # Ok::<(), clebsch::Error>(())
/// ```
pub trait Quantities<S: Clebsch, M: Method<S>> {
    /// Their values at a state.
    type Values: Columns<S::Scalar>;
    /// How many quantities they are.
    const COUNT: usize;

    /// Quantity i, by its names and its form.
    fn quantity(&self, i: usize) -> Option<(Names, Form)>;
    /// The values of all.
    fn values(&self, stepper: &Stepper<S, M>, state: &State<S, M>) -> Self::Values;
}

impl<S: Clebsch, M: Method<S>> Quantities<S, M> for () {
    type Values = ();
    const COUNT: usize = 0;

    fn quantity(&self, _: usize) -> Option<(Names, Form)> {
        None
    }

    fn values(&self, _: &Stepper<S, M>, _: &State<S, M>) {}
}

impl<S: Clebsch, M: Method<S>, L: Quantities<S, M>, X: Quantities<S, M>> Quantities<S, M> for (L, X) {
    type Values = (L::Values, X::Values);
    const COUNT: usize = L::COUNT + X::COUNT;

    fn quantity(&self, i: usize) -> Option<(Names, Form)> {
        self.0.quantity(i).or_else(|| self.1.quantity(i.checked_sub(L::COUNT)?))
    }

    fn values(&self, stepper: &Stepper<S, M>, state: &State<S, M>) -> Self::Values {
        (self.0.values(stepper, state), self.1.values(stepper, state))
    }
}

/// The energy.
#[derive(Clone, Copy, Debug)]
pub struct Energy;

impl<S: Clebsch, M: Method<S>> Quantities<S, M> for Energy {
    type Values = S::Scalar;
    const COUNT: usize = 1;

    fn quantity(&self, i: usize) -> Option<(Names, Form)> {
        (i == 0).then_some((Names::One("energy"), Form::Number))
    }

    fn values(&self, stepper: &Stepper<S, M>, state: &State<S, M>) -> S::Scalar {
        stepper.energy(state)
    }
}

/// The conserved momenta, each with its name.
#[derive(Clone, Copy, Debug)]
pub struct ConservedMomenta;

impl<S: Conserves, M: Method<S>> Quantities<S, M> for ConservedMomenta {
    type Values = S::Conserved;
    const COUNT: usize = S::CONSERVED_NAMES.len();

    fn quantity(&self, i: usize) -> Option<(Names, Form)> {
        S::CONSERVED_NAMES.get(i).map(|name| (Names::One(name), Form::Number))
    }

    fn values(&self, stepper: &Stepper<S, M>, state: &State<S, M>) -> S::Conserved {
        stepper.conserved(state)
    }
}

/// A value of the user.
#[derive(Clone, Copy)]
pub struct Own<V, F> {
    name: &'static str,
    value: F,
    of: PhantomData<fn() -> V>,
}

impl<S: Clebsch, M: Method<S>, V: Columns<S::Scalar>, F: Fn(&State<S, M>) -> V> Quantities<S, M> for Own<V, F> {
    type Values = V;
    const COUNT: usize = 1;

    fn quantity(&self, i: usize) -> Option<(Names, Form)> {
        (i == 0).then_some((Names::One(self.name), V::FORM))
    }

    fn values(&self, _: &Stepper<S, M>, state: &State<S, M>) -> V {
        (self.value)(state)
    }
}

/// A state with its time: `(time, state)`, an [`Event`], and each state of a system that depends on the time.
///
/// ```
/// # use clebsch::{Clebsch, Sample};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// # use nalgebra::Vector1;
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let start = stepper.state(Vector1::zeros(), Vector1::new(6.0))?;
/// let mut last = None;
/// for sample in stepper.trajectory(start).every(0.25).with_times().take(3) {
///     last = Some(sample?);
/// }
/// let sample = last.expect("three states");
/// assert_eq!((Sample::time(&sample), Sample::state(&sample).configuration().x), (0.5, 1.5));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` does not say its time",
    label = "a state without its time",
    note = "write `(time, state)`, or take states with their times by `trajectory.every(interval).with_times()`"
)]
pub trait Sample<S: Clebsch, M: Method<S> = Declared> {
    /// The time.
    fn time(&self) -> S::Scalar;
    /// The state.
    fn state(&self) -> &State<S, M>;
}

impl<S: Clebsch, M: Method<S>> Sample<S, M> for (S::Scalar, State<S, M>) {
    fn time(&self) -> S::Scalar {
        self.0
    }

    fn state(&self) -> &State<S, M> {
        &self.1
    }
}

impl<S: Clebsch, M: Method<S>> Sample<S, M> for Event<S, M> {
    fn time(&self) -> S::Scalar {
        self.time
    }

    fn state(&self) -> &State<S, M> {
        &self.state
    }
}

impl<S: Clebsch<Time = Clock<<S as Clebsch>::Scalar>>, M: Method<S>> Sample<S, M> for State<S, M> {
    fn time(&self) -> S::Scalar {
        Time::now(&self.time)
    }

    fn state(&self) -> &State<S, M> {
        self
    }
}
