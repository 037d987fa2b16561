//! The velocity of a Lagrangian: one symbol for each factor, under the names that the user gives.

use clebsch_symbolic::{Block, Expr, Graph, Property, Role, Shape};

use super::leaves::leaf_names;
use super::value::Value;
use super::{Factor, Layout};
use crate::diagnostic::Diagnostics;
use crate::parse::Pattern;

/// What velocities are made for.
pub(super) struct Velocity<'a, 'g> {
    pub graph: &'g Graph,
    pub factors: &'a [Factor<'g>],
}

impl<'g> Velocity<'_, 'g> {
    /// The value of a pattern, and the symbols of the factors. One name stands for all that is in its place, a tuple for the parts of a
    /// product or for the blocks of one factor: `(omega, v)` for SE(3).
    pub fn of(
        &self,
        pattern: &Pattern,
        structure: &Layout,
        diagnostics: &Diagnostics,
    ) -> Option<(Value<'g>, Vec<Expr<'g>>)> {
        match (pattern, structure) {
            (Pattern::Tuple(patterns, _), Layout::Tuple(parts)) if patterns.len() == parts.len() => {
                let parts = patterns.iter().zip(parts).map(|(pattern, part)| self.of(pattern, part, diagnostics));
                let (values, symbols): (Vec<_>, Vec<_>) = parts.collect::<Option<Vec<_>>>()?.into_iter().unzip();
                Some((Value::Tuple(values), symbols.concat()))
            }
            (Pattern::Tuple(patterns, _), Layout::Leaf(k)) if self.has_blocks(*k, patterns.len()) => {
                let names: Vec<String> = pattern.names().iter().map(ToString::to_string).collect();
                let symbol = self.symbol(*k, &names.join("_"));
                let part = |block: &Block| symbol.block(block.offset, 0, Shape::vector(block.algebra.dimension()));
                let blocks = self.graph.blocks(self.factors[*k].group);
                let parts = blocks.iter().map(|block| Value::Matrix(part(block)));
                Some((Value::Tuple(parts.collect()), vec![symbol]))
            }
            _ => {
                let names = leaf_names(pattern, structure, diagnostics)?;
                let leaves = leaves(structure);
                let symbols: Vec<Expr<'g>> = leaves.iter().zip(&names).map(|(k, name)| self.symbol(*k, name)).collect();
                // the leaves of a part of a product are numbered as in the whole
                let mut values = vec![Value::Tuple(Vec::new()); self.factors.len()];
                leaves.iter().zip(&symbols).for_each(|(k, symbol)| values[*k] = Value::Matrix(*symbol));
                Some((Value::nested(structure, &values), symbols))
            }
        }
    }

    /// The symbols of a velocity that the closure does not ask for.
    pub fn unnamed(&self) -> Vec<Expr<'g>> {
        (0..self.factors.len()).map(|k| self.symbol(k, "velocity")).collect()
    }

    /// Whether the algebra of a factor has several blocks, and as many as there are names.
    fn has_blocks(&self, factor: usize, names: usize) -> bool {
        names > 1 && self.graph.blocks(self.factors[factor].group).len() == names
    }

    fn symbol(&self, factor: usize, name: &str) -> Expr<'g> {
        let shape = Shape::vector(self.factors[factor].group.dimension());
        self.graph.symbol(name, shape, Role::Algebra(factor), Property::General)
    }
}

/// The numbers of the leaves of a structure, in order.
fn leaves(structure: &Layout) -> Vec<usize> {
    match structure {
        Layout::Leaf(leaf) => vec![*leaf],
        Layout::Tuple(parts) | Layout::Array(parts) => parts.iter().flat_map(leaves).collect(),
    }
}
