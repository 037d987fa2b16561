//! Values of sites as the numbers of a message, and back.

use clebsch::{Scalar, Space};
use std::cell::Cell;

/// How many numbers a value has.
pub fn count<T: Scalar, V: Space<T>>(value: &V) -> usize {
    let count = Cell::new(0);
    visit(value, |x| {
        count.set(count.get() + 1);
        x
    });
    count.get()
}

/// Writes the numbers of values to the start of a message.
pub fn write<T: Scalar, V: Space<T>>(values: &[V], message: &mut [T]) {
    let places = Cell::from_mut(message).as_slice_of_cells();
    let next = Cell::new(0);
    for value in values {
        visit(value, |x| {
            if let Some(place) = places.get(next.replace(next.get() + 1)) {
                place.set(x);
            }
            x
        });
    }
}

/// Reads values from the start of a message, in the order in which they were written.
pub fn read<T: Scalar, V: Space<T>>(values: &mut [V], message: &[T]) {
    let next = Cell::new(0);
    for value in values {
        *value = visit(value, |x| message.get(next.replace(next.get() + 1)).copied().unwrap_or(x));
    }
}

/// The value of which each number is that of `number`: one way through a value for all three functions.
fn visit<T: Scalar, V: Space<T>>(value: &V, number: impl Fn(T) -> T + Copy) -> V {
    value.zip_map(value, |x, _| number(x))
}

#[cfg(test)]
mod tests {
    use super::{count, read, write};
    use nalgebra::{Matrix2x3, Quaternion, Vector2};

    type Value = (Matrix2x3<f64>, [Vector2<f64>; 2], Quaternion<f64>, f64, ());

    fn value(first: f64) -> Value {
        let x = |i: u32| first + f64::from(i);
        let matrix = Matrix2x3::new(x(0), x(1), x(2), x(3), x(4), x(5));
        (
            matrix,
            [Vector2::new(x(6), x(7)), Vector2::new(x(8), x(9))],
            Quaternion::new(x(10), x(11), x(12), x(13)),
            x(14),
            (),
        )
    }

    #[test]
    fn values_are_read_as_they_were_written() {
        assert_eq!(count(&value(0.0)), 15);
        let values = [value(1.0), value(20.0)];
        let mut message = [0.0; 30];
        write(&values, &mut message);
        // each number once
        let mut sorted = message;
        sorted.sort_by(f64::total_cmp);
        let expected: Vec<f64> = (1..16).chain(20..35).map(f64::from).collect();
        assert_eq!(sorted[..], expected[..]);
        let mut found = [value(0.0); 2];
        read(&mut found, &message);
        assert_eq!(found, values);
    }
}
