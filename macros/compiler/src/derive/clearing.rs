//! Residuals freed of denominators, by maps that are regular near the identity: components of the result vanish where those of the
//! residual do.

use clebsch_symbolic::{Chart, Expr, Fraction, Graph, Group, Operation, View, WordTerm, both, integer};

use super::{ChartBlock, SystemFormulas};
use crate::model::{Factor, Side};

/// The residual of a factor, the components of `array` less μ, by the congruence with I ∓ Z of a Cayley chart. `None`
/// if denominators remain, or if there are none.
pub(super) fn by_congruence<'g>(
    system: &SystemFormulas<'g>,
    k: usize,
    (array, mu, plain): (Expr<'g>, Expr<'g>, Expr<'g>),
) -> Option<Expr<'g>> {
    let Factor { group, side, .. } = system.model.factors[k];
    let coordinates = system.symbols.coordinates(k);
    let (left, right) = system.symbols.charts[k].clearing(group, &coordinates, side == Side::Left)?;
    let array = group.components((left * array * right).expand());
    let cleared = array - momentum(group, (left, right), &coordinates, mu);
    (plain.has_inverse() && !cleared.has_inverse()).then_some(cleared)
}

/// The components of (I ∓ Z) M (I ± Z) = M ∓ (Z M − M Z) − Z M Z. In the plane and in space Z M Z = −(x·μ) Z, which is cheaper, and its
/// derivative too.
fn momentum<'g>(group: Group, (left, right): (Expr<'g>, Expr<'g>), coordinates: &[Expr<'g>], mu: Expr<'g>) -> Expr<'g> {
    let matrix = group.momentum_matrix(mu);
    let whole = left * matrix * right;
    match (group, coordinates) {
        (Group::SpecialOrthogonal(2 | 3), [x]) => {
            let z = group.wedge(*x);
            group.components((whole + z * matrix * z).expand()) + (x.dot(mu) * *x).expand()
        }
        _ => group.components(whole.expand()),
    }
}

/// The rows of the rotation in a chart of rotation and translation, by the same congruence on matrices of the size of
/// the rotation. `None` if denominators remain, or if there are none.
pub(super) fn of_rotation<'g>(system: &SystemFormulas<'g>, block: &ChartBlock<'g>, rows: Expr<'g>) -> Option<Expr<'g>> {
    let (factor, graph) = (&system.model.factors[block.factor], system.model.graph);
    let n = factor.group.linear_part()?;
    if system.symbols.charts[block.factor] != Chart::Product || block.block != 0 || !rows.has_inverse() {
        return None;
    }
    let turn = Group::SpecialOrthogonal(n);
    let (left, right) = Chart::Cayley.clearing(turn, &[block.coordinates], factor.side == Side::Left)?;
    let congruent = |term: WordTerm<'g>| turn.components((left * skew_matrix(graph, turn, term) * right).expand());
    let cleared = graph.total(rows.shape(), rows.word_terms().into_iter().map(congruent)).expand();
    (!cleared.has_inverse()).then_some(cleared)
}

/// The skew matrix with components that are a term: ½(A − Aᵀ) for ⟨A, E⟩.
fn skew_matrix<'g>(graph: &'g Graph, turn: Group, mut term: WordTerm<'g>) -> Expr<'g> {
    let matrix_of = |letter: Expr<'g>| match letter.view() {
        View::Of(Operation::Components(_), inner) => Some((inner - inner.transpose()) / 2),
        _ => None,
    };
    // one component is a scalar among others
    let known = match term.word.as_slice() {
        [letter] => matrix_of(*letter),
        [] => {
            let linear = |(base, exponent): &(Expr<'g>, Fraction)| exponent.is_one() && matrix_of(*base).is_some();
            let found = term.scalars.iter().position(linear);
            found.and_then(|position| matrix_of(term.scalars.remove(position).0))
        }
        _ => None,
    };
    let scale = term.scale(graph);
    let product = || term.word.into_iter().reduce(|a, b| a * b).unwrap_or(graph.integer(1));
    scale * known.unwrap_or_else(|| turn.momentum_matrix(product()))
}

/// The rows of a rotation in the plane or in space, times 1 + |x|². It frees (I ∓ Z)⁻¹ = I ± (Z ± Z²)/(1 + |x|²) of
/// fractions, and mixes no rows. The rows as they are if fractions remain.
pub(super) fn by_square<'g>(system: &SystemFormulas<'g>, block: &ChartBlock<'g>, rows: Expr<'g>) -> Expr<'g> {
    let (group, graph, x) = (system.model.factors[block.factor].group, system.model.graph, block.coordinates);
    if !matches!(group, Group::SpecialOrthogonal(2 | 3)) || system.symbols.charts[block.factor] != Chart::Cayley {
        return rows;
    }
    let (identity, square) = (group.identity(graph), graph.integer(1) + x.norm_squared());
    let inverse = |z: Expr<'g>| ((identity - z).inverse(), identity + (z + z * z) / square);
    let scaled = rows.substitute(&both([x, -x], |x| inverse(group.wedge(x)))).expand();
    freed(scaled, square, 1).filter(|scaled| !scaled.has_inverse()).unwrap_or(rows)
}

/// The residual of unit quaternions, times the power of 1 + |x|² that frees it of fractions.
pub(super) fn of_quaternions<'g>(coordinates: &[Expr<'g>], group: Group, plain: Expr<'g>) -> Expr<'g> {
    if group != Group::UnitQuaternions {
        return plain;
    }
    let square = coordinates[0].graph().integer(1) + coordinates[0].norm_squared();
    freed(plain, square, 2).unwrap_or(plain)
}

/// The rows times the least power of a sum, up to `most`, that leaves none of its fractions. `None` if fractions remain.
fn freed<'g>(rows: Expr<'g>, sum: Expr<'g>, most: i32) -> Option<Expr<'g>> {
    let mut scaled = (1..=most).map(|power| rows.times_each(sum.powi(power)).expand());
    scaled.find(|scaled| scaled.least_exponent(sum).is_none_or(|least| least >= integer(0)))
}
