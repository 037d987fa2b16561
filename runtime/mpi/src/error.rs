//! Errors, the same ones on all ranks.

use core::fmt::{self, Display, Formatter};

/// Why a field does not step on these ranks. All ranks have the same error.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// There are more ranks than the grid has rows for.
    Ranks {
        /// The ranks of the communicator.
        ranks: usize,
        /// The sites in the first direction of the grid.
        rows: usize,
        /// The rows that each rank needs: those that forces reach.
        needed: usize,
    },
    /// Ranks were given different numbers.
    Differs {
        /// The number.
        name: &'static str,
        /// The first rank whose number is not that of rank 0.
        rank: usize,
        /// Its number.
        found: f64,
        /// The number of rank 0.
        expected: f64,
    },
    /// The rows that neighbours exchange are too large for one message.
    Message {
        /// The numbers in them.
        numbers: usize,
        /// The most numbers of a message.
        most: usize,
    },
    /// An error of the field on some rank: the first one that occurs.
    Field {
        /// The rank.
        rank: usize,
        /// The site in the grid of all ranks, if it is that of a site.
        site: Option<usize>,
        /// The text of the `clebsch::Error`.
        text: String,
    },
}

impl Display for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Error::Ranks { ranks, rows, needed } => write!(
                f,
                "{ranks} ranks share a grid of {rows} rows, and each needs {needed}: start fewer ranks, or put the longest direction first"
            ),
            Error::Differs { name, rank, found, expected } => {
                write!(f, "rank {rank} has {found} as {name}, and rank 0 has {expected}: give all ranks the same")
            }
            Error::Message { numbers, most } => write!(
                f,
                "neighbours exchange {numbers} numbers, and a message has {most} at most: put the longest direction first"
            ),
            Error::Field { rank, site: Some(site), text } => write!(f, "site {site}, on rank {rank}: {text}"),
            Error::Field { rank, site: None, text } => write!(f, "rank {rank}: {text}"),
        }
    }
}

impl core::error::Error for Error {}
