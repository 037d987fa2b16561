//! The numbers of a value in the order of the columns of a table, and the names of these columns.

use crate::{Conserved, Scalar};
use core::fmt::{self, Display, Formatter};
use nalgebra::{Quaternion, SMatrix};

/// The numbers of a value, one after the other, as the columns of a table have them.
///
/// Matrices are read by rows, quaternions in the order w, i, j, k. Parts of tuples and arrays follow each other.
/// Every [`Space`](crate::Space) has columns, and so have the values of own columns, by [`Table::with`](crate::Table::with).
///
/// ```
/// use clebsch::{Columns, Form};
/// use nalgebra::{Matrix2, Vector3};
///
/// let pair = (Vector3::new(1.0, 2.0, 3.0), Matrix2::new(4.0, 5.0, 6.0, 7.0));
/// assert_eq!((pair.entry(2), pair.entry(4), pair.entry(7)), (Some(3.0), Some(5.0), None::<f64>));
///
/// /// The number of columns of a type.
/// fn width<V: Columns<f64>>(_: &V) -> usize {
///     V::FORM.width()
/// }
/// assert_eq!(width(&pair), 7);
/// ```
pub trait Columns<T> {
    /// How its numbers are arranged.
    const FORM: Form;

    /// Number k; `None` from their count on.
    fn entry(&self, k: usize) -> Option<T>;
}

/// How the numbers of a value are arranged.
///
/// ```
/// use clebsch::Form;
///
/// let places = Form::Array { length: 5, of: &Form::Matrix { rows: 3, columns: 1 } };
/// assert_eq!(places.width(), 15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// One number.
    Number,
    /// A matrix, or a vector.
    Matrix {
        /// The number of its rows.
        rows: usize,
        /// The number of its columns.
        columns: usize,
    },
    /// A quaternion: w, i, j, k.
    Quaternion,
    /// So many values of one form.
    Array {
        /// How many.
        length: usize,
        /// The form of each.
        of: &'static Form,
    },
    /// Values of several forms.
    Tuple(&'static [&'static Form]),
}

impl Form {
    /// The count of its numbers.
    pub const fn width(&self) -> usize {
        match *self {
            Self::Number => 1,
            Self::Matrix { rows, columns } => rows * columns,
            Self::Quaternion => 4,
            Self::Array { length, of } => length * of.width(),
            Self::Tuple(mut parts) => {
                let mut sum = 0;
                while let [first, others @ ..] = parts {
                    sum += first.width();
                    parts = others;
                }
                sum
            }
        }
    }
}

/// The names of a value and of its parts, as the declaration writes them: a name, or a tuple of names.
///
/// ```
/// # use clebsch::{Clebsch, Names};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// assert_eq!(Particle::CONFIGURATION_NAMES, Names::One("x"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// The name of a value.
    One(&'static str),
    /// The name of a value whose vectors have components by number: `N[0]`.
    Components(&'static str),
    /// The names of the parts of a tuple.
    Each(&'static [Names]),
}

impl Names {
    /// Whether this name is among them.
    pub(crate) fn contains(&self, name: &str) -> bool {
        match self {
            Self::One(own) | Self::Components(own) => *own == name,
            Self::Each(parts) => parts.iter().any(|part| part.contains(name)),
        }
    }

    /// The named value with column k among values of these names and this form, and the number of the column in it.
    pub(crate) fn find(self, form: Form, k: usize) -> (Self, Form, usize) {
        match (self, form) {
            (Self::Each(names), Form::Tuple(forms)) => {
                let (part, k) = part_with(forms, k);
                match (names.get(part), forms.get(part)) {
                    (Some(names), Some(form)) => names.find(**form, k),
                    // by construction: names nest as the configuration does
                    _ => (self, form, k),
                }
            }
            _ => (self, form, k),
        }
    }
}

/// The part of a tuple that has column k, and the number of the column in it.
fn part_with(forms: &[&Form], mut k: usize) -> (usize, usize) {
    for (part, form) in forms.iter().enumerate() {
        if k < form.width() {
            return (part, k);
        }
        k -= form.width();
    }
    (forms.len(), k)
}

/// A column of a table: its name, by [`Display`], and its unit.
///
/// The name of a number in a value `q` is as a closure or [`DERIVATION`](crate::Clebsch::DERIVATION) writes it:
///
/// | in | is called |
/// |---|---|
/// | a number | `q` |
/// | a vector of up to four numbers | `q.x`, `q.y`, `q.z`, `q.w` |
/// | a longer vector, a momentum | `q[0]`, `q[1]`, … |
/// | a matrix, by rows | `q[0,0]`, `q[0,1]`, … |
/// | a quaternion | `q.w`, `q.i`, `q.j`, `q.k` |
/// | an array | `q[0].x`, `q[1][0,2]` |
/// | a tuple with one name | `q.0`, `q.1` |
///
/// ```
/// # use clebsch::{Clebsch, Column};
/// # #[derive(Clebsch, Clone, Debug)]
/// # #[clebsch(action = |a: Translation<1>, x: Vector1| x + a, cost = |h, a| self.mass * a.norm_squared() / (2 * h))]
/// # struct Particle { mass: f64 }
/// let stepper = Particle { mass: 2.0 }.into_stepper(0.5)?;
/// let table = stepper.table().units(&[("x", "m")]);
/// let columns: Vec<Column> = table.columns().collect();
/// assert_eq!((columns[1].to_string(), columns[1].unit()), ("x.x".to_string(), Some("m")));
/// # Ok::<(), clebsch::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Column<'a> {
    names: Names,
    form: Form,
    number: usize,
    unit: Option<&'a str>,
}

impl<'a> Column<'a> {
    /// Column k of the value with these names and this form.
    pub(crate) fn new(names: Names, form: Form, k: usize, units: &[(&str, &'a str)]) -> Self {
        let (names, form, number) = names.find(form, k);
        let unit = units.iter().find(|(name, _)| names.contains(name)).map(|(_, unit)| *unit);
        Self { names, form, number, unit }
    }

    /// The unit, where [`Table::units`](crate::Table::units) gave one.
    ///
    /// A declaration has no units: its formulas hold in all of them.
    pub fn unit(&self) -> Option<&'a str> {
        self.unit
    }

    /// The name of the value that it is a number of: `q` for the column `q.x`.
    ///
    /// All numbers of a value have the same unit, and a plot shows them together.
    pub fn value(&self) -> &'static str {
        match self.names {
            Names::One(name) | Names::Components(name) => name,
            // by construction: names nest as the configuration does
            Names::Each(_) => "",
        }
    }
}

impl Display for Column<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(self.value())?;
        write_place(f, &self.form, self.number, matches!(self.names, Names::Components(_)))
    }
}

/// The place of number k in a value.
fn write_place(f: &mut Formatter<'_>, form: &Form, k: usize, by_number: bool) -> fmt::Result {
    match *form {
        Form::Number => Ok(()),
        Form::Matrix { rows, columns } if rows == 1 || columns == 1 => match ["x", "y", "z", "w"].get(k) {
            Some(letter) if rows.max(columns) <= 4 && !by_number => write!(f, ".{letter}"),
            _ => write!(f, "[{k}]"),
        },
        Form::Matrix { columns, .. } => {
            write!(f, "[{},{}]", k.checked_div(columns).unwrap_or(0), k.checked_rem(columns).unwrap_or(0))
        }
        Form::Quaternion => write!(f, ".{}", ["w", "i", "j", "k"].get(k).unwrap_or(&"")),
        Form::Array { of, .. } => {
            let width = of.width();
            write!(f, "[{}]", k.checked_div(width).unwrap_or(0))?;
            write_place(f, of, k.checked_rem(width).unwrap_or(0), by_number)
        }
        Form::Tuple(forms) => {
            let (part, k) = part_with(forms, k);
            write!(f, ".{part}")?;
            forms.get(part).map_or(Ok(()), |form| write_place(f, form, k, by_number))
        }
    }
}

impl<T: Scalar> Columns<T> for T {
    const FORM: Form = Form::Number;

    #[inline]
    fn entry(&self, k: usize) -> Option<T> {
        (k == 0).then_some(*self)
    }
}

impl<T: Scalar, const R: usize, const C: usize> Columns<T> for SMatrix<T, R, C> {
    const FORM: Form = Form::Matrix { rows: R, columns: C };

    #[inline]
    fn entry(&self, k: usize) -> Option<T> {
        self.get((k.checked_div(C)?, k.checked_rem(C)?)).copied()
    }
}

impl<T: Scalar> Columns<T> for Quaternion<T> {
    const FORM: Form = Form::Quaternion;

    #[inline]
    fn entry(&self, k: usize) -> Option<T> {
        let [[x, y, z, w]] = self.coords.data.0;
        [w, x, y, z].get(k).copied()
    }
}

impl<T: Scalar, V: Columns<T>, const N: usize> Columns<T> for [V; N] {
    const FORM: Form = Form::Array { length: N, of: &V::FORM };

    #[inline]
    fn entry(&self, k: usize) -> Option<T> {
        let width = const { V::FORM.width() };
        self.get(k.checked_div(width)?)?.entry(k.checked_rem(width)?)
    }
}

impl<T: Scalar, const K: usize> Columns<T> for Conserved<T, K> {
    const FORM: Form = Form::Array { length: K, of: &Form::Number };

    #[inline]
    fn entry(&self, k: usize) -> Option<T> {
        self.values().get(k).copied()
    }
}

macro_rules! tuple {
    ($($name:ident . $index:tt),*) => {
        #[allow(unused_assignments, unused_mut, unused_variables, reason = "the tuple without parts")]
        impl<T: Scalar, $($name: Columns<T>),*> Columns<T> for ($($name,)*) {
            const FORM: Form = Form::Tuple(&[$(&$name::FORM),*]);

            #[inline]
            fn entry(&self, mut k: usize) -> Option<T> {
                $(
                    let width = const { $name::FORM.width() };
                    if k < width {
                        return self.$index.entry(k);
                    }
                    k -= width;
                )*
                None
            }
        }
    };
}

tuple!();
tuple!(A.0);
tuple!(A.0, B.1);
tuple!(A.0, B.1, C.2);
tuple!(A.0, B.1, C.2, D.3);
tuple!(A.0, B.1, C.2, D.3, E.4);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5, G.6);
tuple!(A.0, B.1, C.2, D.3, E.4, F.5, G.6, H.7);
