//! The table of the built-in groups: one row for each.

use super::{Chart, Group};
use crate::Shape;

/// What is known of a group by its sizes alone.
pub(super) struct Row {
    /// The letters.
    pub name: &'static str,
    /// The sizes that a declaration writes behind them.
    pub sizes: [Option<usize>; 2],
    /// The shape of the arrays that represent elements.
    pub shape: Shape,
    /// The dimension m.
    pub dimension: usize,
    /// The chart in which the implicit equation is solved, unless a declaration chooses another.
    pub chart: Chart,
}

impl Group {
    /// The row of a group; that of a declared one has its sizes, and its graph knows the rest.
    #[rustfmt::skip]
    pub(super) fn row(self) -> Row {
        let turns = |n: usize| n * (n - 1) / 2;
        let (square, vector) = (Shape::square, Shape::vector);
        match self {
            Group::SpecialOrthogonal(n)   => row("SO", n,          square(n),     turns(n),         Chart::Cayley),
            Group::PseudoOrthogonal(p, q) => Row { sizes: [Some(p), Some(q)], ..row("SO", p, square(p + q), turns(p + q), Chart::Cayley) },
            Group::SpecialEuclidean(n)    => row("SE", n,          square(n + 1), turns(n) + n,     Chart::Product),
            Group::Translation(n)         => row("Translation", n, vector(n),     n,                Chart::Identity),
            Group::GeneralLinear(n)       => row("GL", n,          square(n),     n * n,            Chart::Affine),
            Group::SpecialLinear(2)       => row("SL", 2,          square(2),     3,                Chart::Cayley),
            Group::SpecialLinear(n)       => row("SL", n,          square(n),     n * n - 1,        Chart::Root),
            Group::Symplectic(n)          => row("Sp", n,          square(n),     n * (n + 1) / 2,  Chart::Cayley),
            Group::Unitary(n)             => row("U", n,           square(2 * n), n * n,            Chart::Cayley),
            Group::SpecialUnitary(n)      => row("SU", n,          square(2 * n), n * n - 1,        Chart::Exponential),
            Group::UnitQuaternions        => row("SU", 2,          vector(4),     3,                Chart::Cayley),
            Group::Heisenberg(n)          => row("Heisenberg", n,  square(n + 2), 2 * n + 1,        Chart::Affine),
            Group::Affine(n)              => row("Aff", n,         square(n + 1), n * n + n,        Chart::Affine),
            Group::Similarity(n)          => row("Sim", n,         square(n + 1), turns(n) + 1 + n, Chart::Product),
            Group::Declared(declared) => {
                let (shape, dimension) = (square(declared.size), declared.dimension);
                Row { name: "", sizes: [None, None], shape, dimension, chart: Chart::Exponential }
            }
        }
    }
}

fn row(name: &'static str, size: usize, shape: Shape, dimension: usize, chart: Chart) -> Row {
    Row { name, sizes: [Some(size), None], shape, dimension, chart }
}
