//! Which entries of a Jacobian vanish, are constant, and agree with those on the other side of its diagonal.

use clebsch_symbolic::identity::{self, Point, Residue};
use clebsch_symbolic::{Elements, Expr, IntoList, Matrix, Number, Shape};

use crate::derive::equation::{MomentumEquation, Sources, Structure};

/// The values of a Jacobian at a random point, and at two others with the same parameters. The first of these has other
/// coordinates. The second has other momenta, another configuration, time and input.
pub(super) struct Pattern([Matrix<Residue>; 3]);

/// Whether Dρ at x = 0 and μ = 0 is Σ/(s·h).
pub(super) fn is_inertial<'g>(
    sources: &Sources<'_, 'g>,
    equation: &MomentumEquation<'g>,
    columns: &[Expr<'g>],
) -> bool {
    let (graph, symbols, components) = (sources.model.graph, &sources.symbols, &equation.components);
    let shape = Shape::square(columns.len());
    let entry = |(i, j): (usize, usize)| {
        let inertia = sources.inertia.entry(components[i], components[j]);
        inertia / sources.chart_step(symbols.blocks_of(&[components[j]])[0], sources.divisor)
    };
    let expected = graph.stack(shape, shape.positions().map(entry).into_list());
    let at_rest = symbols.at_rest();
    identity::vanishes_where(graph.beside(columns) - expected, &|point| {
        for (symbol, zero) in &at_rest {
            let value = point.evaluate(*zero);
            point.set(*symbol, value);
        }
    })
}

/// The same of the products with a direction of all unknowns, without the entries of the matrices.
pub(super) fn is_inertial_as_a_whole(sources: &Sources<'_, '_>, equation: &MomentumEquation<'_>) -> bool {
    let symbols = &sources.symbols;
    let blocks = symbols.blocks_of(&equation.components);
    // the unknowns are those of all factors, in their order
    if blocks.len() != symbols.blocks.len() {
        return false;
    }
    let direction = |&i: &usize| symbols.blocks[i].direction / sources.chart_step(i, sources.divisor);
    let direction = sources.model.graph.below(&blocks.each(direction));
    let slope = equation.directional.substitute(&symbols.at_rest());
    identity::equal(&[slope], &[sources.inertia * direction])
}

impl Pattern {
    pub(super) fn of<'g>(sources: &Sources<'_, 'g>, equation: &MomentumEquation<'g>, columns: &[Expr<'g>]) -> Pattern {
        let (model, symbols) = (sources.model, &sources.symbols);
        let shape = Shape::square(columns.len());
        let jacobian = model.graph.beside(columns);
        let coordinates = symbols.blocks_of(&equation.components).into_iter().map(|i| symbols.blocks[i].coordinates);
        let coordinates: Vec<Expr<'g>> = coordinates.into_list();
        let places = model.configurations.iter().chain(&model.inputs).map(|leaf| leaf.symbol).chain([model.time]);
        let others: Vec<Expr<'g>> = symbols.momenta.iter().copied().chain(places).into_list();
        let at = |moved: &[Expr<'g>]| {
            let (mut point, mut other) = (Point::new(0), Point::new(1));
            moved.iter().for_each(|symbol| point.set(*symbol, other.evaluate(*symbol)));
            point.evaluate(jacobian)
        };
        let (here, there) = (at(&[]), at(&coordinates));
        // most Jacobians are full, and every entry changes with x: then nothing else is of use
        let may_serve = |(i, j): (usize, usize)| here.at(i, j) == there.at(i, j);
        let elsewhere = if shape.positions().any(may_serve) { at(&others) } else { here.clone() };
        Pattern([here, there, elsewhere])
    }

    fn count(&self) -> usize {
        self.0[0].shape.rows
    }

    /// Whether ∂ρ_i/∂x_j = 0.
    pub(super) fn is_zero(&self, i: usize, j: usize) -> bool {
        let zero = Residue::from_rational(&clebsch_symbolic::integer(0));
        self.0.iter().all(|matrix| matrix.at(i, j) == zero)
    }

    /// Whether ρ_i holds no other coordinate than x_i.
    pub(super) fn is_alone(&self, i: usize) -> bool {
        (0..self.count()).all(|j| i == j || self.is_zero(i, j))
    }

    /// Whether ∂ρ_i/∂x_i is made of parameters alone.
    pub(super) fn is_constant(&self, i: usize) -> bool {
        self.0.iter().all(|matrix| matrix.at(i, i) == self.0[0].at(i, i))
    }

    /// Whether no entry depends on the coordinates.
    pub(super) fn is_linear(&self) -> bool {
        self.0[0] == self.0[1]
    }

    /// Whether the determinant is made of parameters alone.
    pub(super) fn has_constant_determinant(&self) -> bool {
        let [here, there, elsewhere] = self.0.each_ref().map(|matrix| matrix.inverse().1);
        here == there && here == elsewhere
    }

    fn is_symmetric(&self) -> bool {
        self.0.iter().all(|matrix| matrix.shape.positions().all(|(i, j)| matrix.at(i, j) == matrix.at(j, i)))
    }

    /// The sets of unknowns that depend on each other, one way or the other.
    pub(super) fn connected(&self) -> Vec<Vec<usize>> {
        connected(self.count(), |i, j| !self.is_zero(i, j) || !self.is_zero(j, i))
    }

    /// The structure by which linear systems with this Jacobian are solved.
    pub(super) fn structure(&self) -> Structure {
        let count = self.count();
        let needs = closure(count, |i, j| !self.is_zero(i, j));
        let mut blocks = classes(count, |i, j| needs[i][j] && needs[j][i]);
        let regular = (0..count).all(|i| !self.is_zero(i, i));
        match blocks.len() {
            // a block needs more unknowns than each of those that it needs
            2.. if regular => {
                blocks.sort_by_key(|block| needs[block[0]].iter().filter(|needed| **needed).count());
                Structure::Triangular(blocks)
            }
            _ if count > 1 && self.is_symmetric() => Structure::Symmetric,
            _ => Structure::Dense,
        }
    }
}

/// The sets of related indices, directly or by way of others.
pub(in crate::derive) fn connected(count: usize, relates: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let reaches = closure(count, relates);
    classes(count, |i, j| reaches[i][j])
}

/// The reflexive and transitive closure of a relation.
fn closure(count: usize, relates: impl Fn(usize, usize) -> bool) -> Vec<Vec<bool>> {
    let mut closed = vec![vec![false; count]; count];
    Shape::square(count).positions().for_each(|(i, j)| closed[i][j] = i == j || relates(i, j));
    for k in 0..count {
        let through = closed[k].clone();
        for row in closed.iter_mut().filter(|row| row[k]) {
            row.iter_mut().zip(&through).for_each(|(reached, next)| *reached |= *next);
        }
    }
    closed
}

/// The classes of an equivalence, in the order of their first members.
fn classes(count: usize, same: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut classes: Vec<Vec<usize>> = Vec::new();
    for i in 0..count {
        match classes.iter_mut().find(|class| same(i, class[0])) {
            Some(class) => class.push(i),
            None => classes.push(vec![i]),
        }
    }
    classes
}
