//! The laws of the action, checked exactly and factor by factor. The identity moves nothing, and products act one after
//! the other. Different factors do not meet, and every factor moves something. The side of each factor is found here.

use clebsch_symbolic::{Chart, Elements, Expr, Graph, Group, IntoList, Operation, Role, View, both, identity, indexed};

use super::{Configuration, Factor, LeafSpace, Side};
use crate::diagnostic::Diagnostics;
use crate::parse::Closure;

/// The action with its arguments.
pub(super) struct Action<'a, 'g> {
    pub graph: &'g Graph,
    pub closure: &'a Closure,
    pub factors: &'a [Factor<'g>],
    pub configurations: &'a [Configuration<'g>],
    /// Φ_F(q), leaf by leaf.
    pub value: &'a [Expr<'g>],
}

/// Checks all laws and returns how each factor acts: from which side, and whether it moves anything.
pub(super) fn check(action: &Action, diagnostics: &Diagnostics) -> Option<Vec<(Side, bool)>> {
    let before = diagnostics.len();
    action.stays_in_space(diagnostics);
    if diagnostics.len() > before {
        return None;
    }
    if !identity::equal(&action.of_identity(), &action.points()) {
        return diagnostics.refuse(action.identity_moves());
    }
    let sides: Vec<_> = indexed(action.factors.len(), |factor| action.side(factor, diagnostics));
    action.factors_commute(diagnostics);
    let sides: Vec<(Option<Side>, bool)> = sides.into_iter().collect::<Option<_>>()?;
    // a factor on which both laws hold takes the side of the others, else left; so does one that moves nothing
    let is_of = |side| sides.iter().any(|(found, _)| *found == Some(side));
    let open = if is_of(Side::Right) && !is_of(Side::Left) { Side::Right } else { Side::Left };
    // an offered symmetry has an error of its own
    if let Some(error) = action.unmoved(&sides).filter(|_| action.closure.key == "action") {
        return diagnostics.refuse(error);
    }
    let laws = sides.iter().map(|&(side, moves)| (side.unwrap_or(open), moves));
    (diagnostics.len() == before).then(|| laws.into_list())
}

impl<'g> Action<'_, 'g> {
    fn points(&self) -> Vec<Expr<'g>> {
        self.configurations.each(|leaf| leaf.symbol)
    }

    /// Φ at elements for some factors (the identity for all others) and a point.
    fn at(&self, elements: &[(usize, Expr<'g>)], point: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let at_factor = |(index, factor): (usize, &Factor<'g>)| {
            let given = elements.iter().find(|(other, _)| *other == index).map(|&(_, element)| element);
            (factor.symbol, given.unwrap_or_else(|| factor.group.identity(self.graph)))
        };
        let mut rules: Vec<(Expr<'g>, Expr<'g>)> = self.factors.iter().enumerate().map(at_factor).into_list();
        rules.extend(self.points().into_iter().zip(point.iter().copied()));
        self.value.each(|expr| expr.substitute(&rules))
    }

    pub(super) fn of_identity(&self) -> Vec<Expr<'g>> {
        self.at(&[], &self.points())
    }

    /// A second element of a factor, printed as `F1` or `F2`.
    pub(super) fn element(&self, factor: usize, number: usize) -> Expr<'g> {
        let Factor { group, name, .. } = &self.factors[factor];
        let role = Role::Composed(factor, number);
        self.graph.symbol(&format!("{name}{number}"), group.element_shape(), role, group.element_property())
    }

    /// A promise about the configuration has to survive the action.
    fn stays_in_space(&self, diagnostics: &Diagnostics) {
        for (leaf, &moved) in self.configurations.iter().zip(self.value) {
            let obeys = |law| if law { Verdict::Inside } else { Verdict::Outside };
            let verdict = match leaf.space {
                LeafSpace::Vectors => Verdict::Inside,
                LeafSpace::Unit => obeys(identity::equal(&[moved.norm_squared()], &[self.graph.integer(1)])),
                LeafSpace::Symmetric => obeys(identity::equal(&[moved], &[moved.transpose()])),
                LeafSpace::Projector(rank) => {
                    let (square, trace) = (moved * moved, self.graph.integer(rank as i64));
                    obeys(identity::equal(&[moved.transpose(), square, moved.trace()], &[moved, moved, trace]))
                }
                LeafSpace::Orthonormal => {
                    let identity = self.graph.identity(moved.shape().columns);
                    obeys(identity::equal(&[moved.transpose() * moved], &[identity]))
                }
                LeafSpace::Group(group) => lies_on(moved, group),
            };
            if verdict != Verdict::Inside {
                diagnostics.push(self.leaves_space(leaf, moved, verdict));
            }
        }
    }

    /// The side from which a factor acts, `None` where the composition law holds on both; and whether it moves anything.
    fn side(&self, index: usize, diagnostics: &Diagnostics) -> Option<(Option<Side>, bool)> {
        let Factor { group, symbol, .. } = &self.factors[index];
        let points = self.points();
        if identity::equal(&self.at(&[(index, *symbol)], &points), &points) {
            return Some((None, false));
        }
        let (first, second) = (self.element(index, 1), self.element(index, 2));
        let composed = self.at(&[(index, second)], &self.at(&[(index, first)], &points));
        let is_action_of = |product: Expr<'g>| identity::equal(&composed, &self.at(&[(index, product)], &points));
        let left = is_action_of(group.compose(second, first));
        let right = is_action_of(group.compose(first, second));
        let side = match (left, right) {
            (true, true) => None,
            (true, false) => Some(Side::Left),
            (false, true) => Some(Side::Right),
            (false, false) => {
                let error = self.no_action(Some(index)).note(self.composition(index, &composed));
                return diagnostics.refuse(error.help(self.example(index)));
            }
        };
        Some((side, true))
    }

    /// Any two factors commute, and all together act as one after the other.
    fn factors_commute(&self, diagnostics: &Diagnostics) {
        let count = self.factors.len();
        let points = self.points();
        let moved = |index: usize, point: &[Expr<'g>]| self.at(&[(index, self.factors[index].symbol)], point);
        let before = diagnostics.len();
        for (second, first) in (1..count).flat_map(|second| (0..second).map(move |first| (second, first))) {
            let then_second = moved(second, &moved(first, &points));
            let then_first = moved(first, &moved(second, &points));
            if !identity::equal(&then_second, &then_first) {
                let factors = both([first, second], |index| &self.factors[index]);
                diagnostics.push(self.do_not_commute(factors, [&then_second, &then_first]));
            }
        }
        let one_by_one = (0..count).fold(points.clone(), |point, index| moved(index, &point));
        if diagnostics.len() == before && !identity::equal(&one_by_one, self.value) {
            diagnostics.push(self.no_action(None).note("its factors together act otherwise than one after the other"));
        }
    }
}

/// Whether an expression lies on a group for all values of its symbols, as far as that is known.
#[derive(Copy, Clone, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It does.
    Inside,
    /// It does not.
    Outside,
    /// That is not decided here.
    Open,
}

/// Whether an expression lies on a group: as a product of its elements, or by its equations.
fn lies_on(expr: Expr<'_>, group: Group) -> Verdict {
    if is_product(expr, group) {
        return Verdict::Inside;
    }
    let graph = expr.graph();
    let mut equations = group.equations(expr);
    let by_basis = group.is_declared() && equations.is_empty();
    let affine = by_basis && group.chart(graph) == Chart::Affine;
    if affine {
        // F − I is an element of the algebra
        let increment = expr - graph.identity(expr.shape().rows);
        equations.push(increment - group.wedge(group.projected_coordinates(increment)));
    }
    if !equations.into_iter().all(identity::vanishes) {
        return Verdict::Outside;
    }
    // the equations of SU(n) are those of U(n)
    let is_open = matches!(group, Group::SpecialUnitary(_)) || (by_basis && !affine);
    if is_open { Verdict::Open } else { Verdict::Inside }
}

/// Whether an expression is made of elements of a group by products and inverses.
fn is_product(expr: Expr<'_>, group: Group) -> bool {
    match expr.view() {
        View::Symbol(symbol) => symbol.property == group.element_property() && symbol.shape == group.element_shape(),
        View::Of(Operation::Inverse, inner) => is_product(inner, group),
        View::Of(Operation::Transpose, inner) => group.is_orthogonal() && is_product(inner, group),
        View::Sum(terms) => match terms.as_slice() {
            [term] => {
                let letters = term.word.iter().all(|letter| is_product(*letter, group));
                letters && term.coefficient.is_one() && term.scalars.is_empty()
            }
            _ => false,
        },
        _ => false,
    }
}
