//! Maps and interners whose order is that of insertion, so that results are the same in every process.
//!
//! Editors run the compiler unoptimised at every keystroke. There the maps of the standard library take a third of its
//! time. They are made to be optimised, and hash with care for hostile keys.

use std::hash::{Hash, Hasher};

/// Distinct values with their positions, in the order of insertion.
#[derive(Clone, Debug)]
pub struct Interner<K> {
    values: Vec<K>,
    hashes: Vec<u64>,
    /// 1 + the position of a value, or 0; a power of two of them, at most half of them taken.
    slots: Vec<u32>,
}

impl<K> Default for Interner<K> {
    fn default() -> Interner<K> {
        Interner { values: Vec::new(), hashes: Vec::new(), slots: Vec::new() }
    }
}

impl<K: Hash + Eq> Interner<K> {
    /// The position of a value, where it is known.
    pub fn position(&self, value: &K) -> Option<usize> {
        if self.is_empty() {
            return None;
        }
        let slot = self.slot(hash_of(value), |known| known == value);
        (self.slots[slot] as usize).checked_sub(1)
    }

    /// The position of a value, and whether it is new.
    pub fn intern(&mut self, value: K) -> (usize, bool) {
        let hash = hash_of(&value);
        match self.find(hash, |known| *known == value) {
            Ok(known) => (known, false),
            Err(slot) => (self.insert(slot, hash, value), true),
        }
    }

    /// All values, in the order of their positions.
    pub fn into_values(self) -> Vec<K> {
        self.values
    }
}

impl<K> Interner<K> {
    /// The position of the value with a hash that passes a test, or the slot that it would take.
    pub(crate) fn find(&mut self, hash: u64, is_same: impl Fn(&K) -> bool) -> Result<usize, usize> {
        if 2 * (self.values.len() + 1) > self.slots.len() {
            self.grow();
        }
        let slot = self.slot(hash, is_same);
        match self.slots[slot] {
            0 => Err(slot),
            taken => Ok(taken as usize - 1),
        }
    }

    /// Puts a new value into the slot that is said to be its own, and gives its position.
    pub(crate) fn insert(&mut self, slot: usize, hash: u64, value: K) -> usize {
        self.values.push(value);
        self.hashes.push(hash);
        self.slots[slot] = self.values.len() as u32;
        self.values.len() - 1
    }

    /// The slot of the value that passes a test, or the one that it would take.
    fn slot(&self, hash: u64, is_same: impl Fn(&K) -> bool) -> usize {
        // slices: without optimisation the index of a vector is five calls
        let (slots, hashes) = (self.slots.as_slice(), self.hashes.as_slice());
        let values = self.values.as_slice();
        let mask = slots.len() - 1;
        let mut slot = hash as usize & mask;
        while slots[slot] != 0 {
            let position = slots[slot] as usize - 1;
            if hashes[position] == hash && is_same(&values[position]) {
                break;
            }
            slot = (slot + 1) & mask;
        }
        slot
    }

    fn grow(&mut self) {
        let mut slots = vec![0; (2 * self.slots.len()).max(16)];
        let (hashes, mask) = (self.hashes.as_slice(), slots.len() - 1);
        let mut position = 0;
        while position < hashes.len() {
            // all values are distinct
            let mut slot = hashes[position] as usize & mask;
            while slots.as_slice()[slot] != 0 {
                slot = (slot + 1) & mask;
            }
            position += 1;
            slots.as_mut_slice()[slot] = position as u32;
        }
        self.slots = slots;
    }

    /// The value at a position.
    pub fn value(&self, position: usize) -> &K {
        &self.values[position]
    }

    /// All values, in the order of insertion.
    pub fn values(&self) -> &[K] {
        &self.values
    }

    /// The number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }
}

/// A map without removal.
#[derive(Clone, Debug)]
pub struct Table<K, V> {
    keys: Interner<K>,
    values: Vec<V>,
}

impl<K, V> Default for Table<K, V> {
    fn default() -> Table<K, V> {
        Table { keys: Interner::default(), values: Vec::new() }
    }
}

impl<K: Hash + Eq, V> Table<K, V> {
    /// The value of a key.
    pub fn get(&self, key: &K) -> Option<&V> {
        self.keys.position(key).map(|position| &self.values[position])
    }

    /// Sets the value of a key.
    pub fn insert(&mut self, key: K, value: V) {
        match self.keys.intern(key) {
            (_, true) => self.values.push(value),
            (position, false) => self.values[position] = value,
        }
    }

    /// The value of a key, to be changed; the default where it has none.
    pub fn entry(&mut self, key: K) -> &mut V
    where
        V: Default,
    {
        let (position, is_new) = self.keys.intern(key);
        if is_new {
            self.values.push(V::default());
        }
        &mut self.values[position]
    }

    /// Whether no key has a value.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Whether a key has a value.
    pub fn contains(&self, key: &K) -> bool {
        self.keys.position(key).is_some()
    }

    /// Keys and values, in the order of insertion of the keys.
    pub fn iter(&self) -> impl Iterator<Item = (&K, &V)> {
        self.keys.values().iter().zip(&self.values)
    }
}

impl<K: Hash + Eq, V> std::ops::Index<&K> for Table<K, V> {
    type Output = V;
    fn index(&self, key: &K) -> &V {
        // by construction: as with every index, the caller knows that it is there
        self.get(key).expect("a key of the table")
    }
}

pub(crate) fn hash_of(value: &impl Hash) -> u64 {
    let mut mixer = Mixer(0);
    value.hash(&mut mixer);
    mixer.finish()
}

/// One multiplication for each word.
struct Mixer(u64);

impl Mixer {
    #[inline(always)]
    fn mix(&mut self, word: u64) {
        self.0 = mixed(self.0, word);
    }
}

/// A hash with one more word.
#[allow(clippy::manual_rotate, reason = "without optimisation `rotate_left` is a call")]
#[inline(always)]
pub(crate) fn mixed(hash: u64, word: u64) -> u64 {
    (((hash << 5) | (hash >> 59)) ^ word).wrapping_mul(0x517c_c1b7_2722_0a95)
}

/// Words are mixed in one piece.
macro_rules! words {
    ($($write:ident: $word:ty),*) => {$(
        #[inline(always)]
        fn $write(&mut self, word: $word) {
            self.mix(word as u64);
        }
    )*};
}

impl Hasher for Mixer {
    /// The upper bits are the better mixed ones.
    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.mix(u64::from(*byte)));
    }
    words!(write_u8: u8, write_u32: u32, write_u64: u64, write_usize: usize, write_isize: isize, write_i64: i64);
}
