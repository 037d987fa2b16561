//! Hashes of numbers, bit for bit.

use clebsch::{Scalar, Space};
use clebsch_tests::oracle::bits::Bits;
use std::cell::{Cell, RefCell};

/// How many numbers are printed of the first and of the last record.
const SHOWN: usize = 6;

/// The computed values of one quantity.
pub struct Record {
    /// Of all bits, and of those with 0 for −0.
    hashes: [Cell<u64>; 2],
    first: RefCell<Vec<f64>>,
    last: RefCell<Vec<f64>>,
    notes: RefCell<String>,
}

impl Record {
    pub fn new() -> Self {
        // Fowler, Noll and Vo, 64 bits
        let start = || Cell::new(0xcbf2_9ce4_8422_2325);
        Self {
            hashes: [start(), start()],
            first: RefCell::default(),
            last: RefCell::default(),
            notes: RefCell::default(),
        }
    }

    fn hash(&self, which: usize, bits: u64) {
        let hash = &self.hashes[which];
        for byte in bits.to_le_bytes() {
            hash.set((hash.get() ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
        }
    }

    /// All scalars of a space, those of all lanes.
    pub fn add<T: Scalar<Lane: Bits>>(&self, space: &impl Space<T>) {
        let shown = RefCell::new(Vec::new());
        space.all(|entry| {
            for lane in 0..T::LANES {
                let number = entry.lane(lane);
                self.hash(0, number.bits());
                self.hash(1, if number == num_traits::Zero::zero() { 0 } else { number.bits() });
                if shown.borrow().len() < SHOWN {
                    shown.borrow_mut().push(number.to_f64());
                }
            }
            true
        });
        let shown = shown.into_inner();
        if shown.is_empty() {
            return;
        }
        if self.first.borrow().is_empty() {
            *self.first.borrow_mut() = shown.clone();
        }
        *self.last.borrow_mut() = shown;
    }

    /// A text, such as that of an error. Numbers in it are printed with all digits.
    pub fn note(&self, text: &str) {
        text.bytes().for_each(|byte| self.hash(0, byte.into()));
        text.replace("-0.0", "0.0").bytes().for_each(|byte| self.hash(1, byte.into()));
        let mut notes = self.notes.borrow_mut();
        if notes.len() < 200 {
            *notes += text;
        }
    }

    /// A space, or the error in its place.
    pub fn result<T: Scalar<Lane: Bits>>(&self, result: Result<impl Space<T>, clebsch::Error>) {
        match result {
            Ok(value) => self.add(&value),
            Err(error) => self.note(&format!("{error:?}")),
        }
    }

    /// A line with the name of the system and that of the quantity.
    pub fn line(&self, name: &str, quantity: &str) -> String {
        let [all, unsigned] = &self.hashes;
        let numbers = |numbers: &[f64]| {
            let texts: Vec<String> = numbers.iter().map(|x| format!("{x:?}")).collect();
            texts.join(",")
        };
        let (first, last) = (numbers(&self.first.borrow()), numbers(&self.last.borrow()));
        let notes = self.notes.borrow().replace([' ', '\n'], "_");
        format!("{name} {quantity} {:016x} {:016x} [{first}] [{last}] {notes}", all.get(), unsigned.get())
    }
}
