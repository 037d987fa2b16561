//! The ranks of a communicator: what they agree on, and what neighbours send each other.

use crate::Error;
use crate::numbers::{count, read, write};
use clebsch::{Scalar, Slab, Space};
use mpi::Count;
use mpi::collective::SystemOperation;
use mpi::point_to_point::send_receive_into;
use mpi::topology::SimpleCommunicator;
use mpi::traits::{Communicator, CommunicatorCollectives, Destination, Equivalence, Root, Source};
use std::ops::Range;

/// The rank that gathers.
const ROOT: usize = 0;

/// The numbers of one message, where values are gathered.
const MESSAGE: usize = 1 << 16;

/// The most numbers of a message.
pub const LONGEST: usize = Count::MAX as usize;

/// The failure of a rank: when it occurred, in parts of steps, the site, and the text of its error.
pub type Failure = (u64, Option<usize>, String);

/// All ranks of a communicator, which is a copy for the messages of one field.
pub struct Ranks {
    world: SimpleCommunicator,
    /// The rows of each rank.
    rows: Vec<Range<usize>>,
}

impl Ranks {
    /// The ranks of a communicator, which share so many rows evenly.
    pub fn new(world: &impl Communicator, rows: usize) -> Self {
        let world = world.duplicate();
        let ranks = world.size() as u128;
        // by construction: the quotients are at most `rows`
        let end = |rank: u128| (rows as u128 * rank / ranks) as usize;
        let rows = (0..ranks).map(|rank| end(rank)..end(rank + 1)).collect();
        Self { world, rows }
    }

    /// The number of this rank.
    pub fn rank(&self) -> usize {
        self.world.rank() as usize
    }

    /// The number of ranks.
    pub fn count(&self) -> usize {
        self.rows.len()
    }

    /// The rows of this rank.
    pub fn own(&self) -> Range<usize> {
        self.rows.get(self.rank()).cloned().unwrap_or(0..0)
    }

    /// All ranks have been given the same numbers.
    pub fn agree(&self, numbers: &[(&'static str, f64)]) -> Result<(), Error> {
        let own: Vec<f64> = numbers.iter().map(|(_, number)| *number).collect();
        let mut all = vec![0.0_f64; own.len() * self.count()];
        self.world.all_gather_into(&own[..], &mut all[..]);
        let (first, others) = all.split_at(own.len());
        for (rank, own) in (1..).zip(others.chunks(first.len().max(1))) {
            for (&(name, _), (&found, &expected)) in numbers.iter().zip(own.iter().zip(first)) {
                if found.to_bits() != expected.to_bits() {
                    return Err(Error::Differs { name, rank, found, expected });
                }
            }
        }
        Ok(())
    }

    /// No rank has failed. The error is that of the rank which failed first; of the lowest one, if several did.
    pub fn passed(&self, failure: Option<Failure>) -> Result<(), Error> {
        let mut times = vec![0_u64; self.count()];
        let own = failure.as_ref().map_or(u64::MAX, |(time, ..)| *time);
        self.world.all_gather_into(&own, &mut times[..]);
        let first = times.iter().enumerate().min_by_key(|(_, time)| **time);
        let Some((rank, _)) = first.filter(|(_, time)| **time < u64::MAX) else { return Ok(()) };
        let (_, site, text) = failure.unwrap_or_default();
        let root = self.world.process_at_rank(rank as i32);
        // the site, or none; and the length of the text
        let mut head = [site.map_or(u64::MAX, |site| site as u64), text.len() as u64];
        root.broadcast_into(&mut head[..]);
        let mut text = text.into_bytes();
        text.resize(head[1] as usize, 0);
        root.broadcast_into(&mut text[..]);
        let site = (head[0] < u64::MAX).then_some(head[0] as usize);
        Err(Error::Field { rank, site, text: String::from_utf8_lossy(&text).into_owned() })
    }

    /// The value of this rank where no rank has failed, and otherwise the error of [`passed`](Self::passed).
    pub fn common<V>(&self, own: Result<V, Failure>) -> Result<V, Error> {
        match own {
            Ok(value) => self.passed(None).map(|()| value),
            Err((time, site, text)) => {
                self.passed(Some((time, site, text.clone())))?;
                Err(Error::Field { rank: self.rank(), site, text })
            }
        }
    }

    /// Whether any rank says so.
    pub fn any(&self, own: bool) -> bool {
        let (own, mut all) = (u8::from(own), 0_u8);
        self.world.all_reduce_into(&own, &mut all, SystemOperation::max());
        all > 0
    }

    /// The values of all ranks in their order, on the root.
    pub fn gather<T, V>(&self, own: Vec<V>, counts: impl Fn(&Range<usize>) -> usize) -> Option<Vec<V>>
    where
        T: Scalar + Equivalence,
        V: Space<T>,
    {
        let numbers = count::<T, V>(&V::origin()).max(1);
        let chunk = (MESSAGE / numbers).max(1);
        let mut message = vec![T::zero(); chunk * numbers];
        if self.rank() != ROOT {
            let root = self.world.process_at_rank(ROOT as i32);
            for values in own.chunks(chunk) {
                write(values, &mut message);
                root.send(&message[..values.len() * numbers]);
            }
            return None;
        }
        let mut all = own;
        for (rank, rows) in self.rows.iter().enumerate().skip(1) {
            let process = self.world.process_at_rank(rank as i32);
            let first = all.len();
            all.resize(first + counts(rows), V::origin());
            for values in all.get_mut(first..).unwrap_or_default().chunks_mut(chunk) {
                process.receive_into(&mut message[..values.len() * numbers]);
                read(values, &message);
            }
        }
        Some(all)
    }

    /// Values of the root on all ranks.
    pub fn told<T: Equivalence + Copy, const K: usize>(&self, mut values: [T; K]) -> [T; K] {
        self.world.process_at_rank(ROOT as i32).broadcast_into(&mut values[..]);
        values
    }

    /// The rank that moves the first of some rows, if it is another one.
    fn of(&self, mut rows: impl Iterator<Item = usize>) -> Option<usize> {
        let row = rows.next()?;
        self.rows.iter().position(|rows| rows.contains(&row)).filter(|rank| *rank != self.rank())
    }
}

/// The messages between neighbours.
pub struct Halo<T> {
    sent: Vec<T>,
    received: Vec<T>,
}

impl<T: Scalar + Equivalence> Halo<T> {
    /// Room for so many numbers.
    pub fn new(numbers: usize) -> Self {
        Self { sent: vec![T::zero(); numbers], received: vec![T::zero(); numbers] }
    }

    /// How many numbers it has room for.
    pub fn numbers(&self) -> usize {
        self.sent.len()
    }

    /// Sends rows of this rank to its neighbours, and writes those of neighbours.
    pub fn exchange<V: Space<T>, const D: usize>(
        &mut self,
        ranks: &Ranks,
        slab: &Slab<T, D>,
        reach: usize,
        q: &mut [V],
    ) {
        let [before, after] = [ranks.of(slab.rows_before()), ranks.of(slab.rows_after())];
        let rows = slab.rows();
        self.shift(ranks, slab, [after, before], rows.end.saturating_sub(reach)..rows.end, slab.rows_before(), q);
        self.shift(ranks, slab, [before, after], rows.start..rows.start + reach, slab.rows_after(), q);
    }

    /// Sends some rows to a rank, and writes those that come from another one.
    fn shift<V: Space<T>, const D: usize>(
        &mut self,
        ranks: &Ranks,
        slab: &Slab<T, D>,
        [to, from]: [Option<usize>; 2],
        own: impl Iterator<Item = usize>,
        others: impl Iterator<Item = usize>,
        q: &mut [V],
    ) {
        let Self { sent, received } = self;
        let process = |rank: usize| ranks.world.process_at_rank(rank as i32);
        let numbers = count::<T, V>(&V::origin());
        let mut message = &mut sent[..];
        for values in own.filter_map(|row| q.get(slab.row(row)?)) {
            write(values, message);
            message = message.split_at_mut_checked(values.len() * numbers).map_or(&mut [], |(_, others)| others);
        }
        match (to, from) {
            (Some(to), Some(from)) => {
                send_receive_into(&sent[..], &process(to), &mut received[..], &process(from));
            }
            (Some(to), None) => process(to).send(&sent[..]),
            (None, Some(from)) => {
                process(from).receive_into(&mut received[..]);
            }
            (None, None) => {}
        }
        if from.is_none() {
            return;
        }
        let mut message = &received[..];
        for row in others {
            let Some(values) = slab.row(row).and_then(|sites| q.get_mut(sites)) else { continue };
            read(values, message);
            message = message.get(values.len() * numbers..).unwrap_or_default();
        }
    }
}
