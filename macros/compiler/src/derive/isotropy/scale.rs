//! The scale κ of a vertical term: a mass of the declared kinetic energy.

use clebsch_symbolic::{Elements, Expr, Graph, IntoList, Shape, identity};

use super::super::symbols::at_zero;
use super::Own;
use crate::model::{Configuration, LeafSpace};

impl<'g> Own<'_, 'g> {
    /// The mass κ of a kinetic energy like ½ κ |ξ_Q(q)|²: means over points of the space, tr Σ by tr A.
    /// Where Σ is not defined there, both are taken at q itself.
    pub(super) fn scale_of_displacement(&self, trace: Expr<'g>, function: Expr<'g>) -> Expr<'g> {
        let is_bounded = |space| matches!(space, LeafSpace::Orthonormal | LeafSpace::Projector(_));
        if self.leaves.iter().any(|&leaf| is_bounded(self.model.configurations[leaf].space)) {
            self.scale(trace, self.over_points(function).0, |inertia| self.over_points(inertia).0)
        } else {
            self.scale(trace, self.over_units(function), |inertia| self.over_units(inertia))
        }
    }

    /// The same on a sphere in n dimensions: tr A is (n − 1)|q|².
    pub(super) fn scale_on_sphere(&self, trace: Expr<'g>, sum: i64) -> Expr<'g> {
        self.scale(trace, self.model.graph.integer(sum), |inertia| self.over_units(inertia))
    }

    fn scale(&self, trace: Expr<'g>, sum: Expr<'g>, over: impl Fn(Expr<'g>) -> Expr<'g>) -> Expr<'g> {
        let inertia = self.inertia_along(|_| true);
        let mean = over(inertia) / sum;
        if mean.is_defined() && !identity::vanishes(mean) { mean } else { inertia / trace }
    }

    /// The mean of tr Σ/rank over points of the space, a constant. Where Σ is not defined there, it is that at q itself.
    pub(super) fn scale_at_points(&self, rank: usize) -> Expr<'g> {
        let inertia = self.inertia_along(|_| true);
        let (sum, count) = self.over_points(inertia);
        let mean = sum / (count * rank) as i64;
        if mean.is_defined() && !identity::vanishes(mean) { mean } else { inertia / rank as i64 }
    }

    /// The sum of the values of a function at points of the space, and their number.
    fn over_points(&self, function: Expr<'g>) -> (Expr<'g>, usize) {
        let points = self.leaves.each(|&leaf| points(self.model.graph, &self.model.configurations[leaf]));
        let count = points.iter().map(Vec::len).max().unwrap_or(1);
        let value = |number: usize| {
            let at = |(leaf, points): (&usize, &Vec<Expr<'g>>)| {
                (self.model.configurations[*leaf].symbol, points[number % points.len()])
            };
            function.substitute(&self.leaves.iter().zip(&points).map(at).into_list())
        };
        (self.model.graph.total(Shape::scalar(), (0..count).map(value)).expand(), count)
    }

    /// The sum of the values of a function of the leaves at their unit vectors.
    fn over_units(&self, function: Expr<'g>) -> Expr<'g> {
        let graph = self.model.graph;
        let leaves = || self.leaves.iter().map(|&leaf| &self.model.configurations[leaf]);
        let mut values = Vec::new();
        for (number, leaf) in leaves().enumerate() {
            for (i, j) in leaf.shape.positions() {
                let mut point = at_zero(leaves().map(|leaf| leaf.symbol));
                point[number].1 = graph.unit(leaf.shape, i, j);
                values.push(function.substitute(&point));
            }
        }
        graph.total(Shape::scalar(), values).expand()
    }
}

/// Points of the space of a leaf.
fn points<'g>(graph: &'g Graph, leaf: &Configuration<'g>) -> Vec<Expr<'g>> {
    match leaf.space {
        LeafSpace::Vectors | LeafSpace::Unit => {
            leaf.shape.positions().map(|(i, j)| graph.unit(leaf.shape, i, j)).into_list()
        }
        LeafSpace::Symmetric => vec![graph.identity(leaf.shape.rows)],
        LeafSpace::Orthonormal => vec![graph.identity(leaf.shape.rows).block(0, 0, leaf.shape)],
        LeafSpace::Projector(rank) => {
            vec![graph.identity(rank).embed(leaf.shape, 0, 0)]
        }
        LeafSpace::Group(group) => vec![group.identity(graph)],
    }
}
