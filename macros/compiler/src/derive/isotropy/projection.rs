//! Projections to the isotropy algebras that are polynomials in ξ ↦ J(q, ξ_Q(q)). Spheres, Grassmann and Stiefel
//! manifolds have them.

use clebsch_symbolic::{Expr, Group, IntoList, Role, Shape, identity};

use super::super::trivialisation;
use super::{Form, Own, Part, Term};
use crate::model::{LeafSpace, Side};

impl<'g> Own<'_, 'g> {
    /// The form of A: ξ ↦ J(q, ξ_Q(q)), where A has one or two eigenvalues that are not 0.
    ///
    /// With one of them, a, it is a − A. With two, a and b, it is ab/(a + b) (1 − A/a)(1 − A/b).
    pub(super) fn difference(&self, rank: usize) -> Option<(Form<'g>, Expr<'g>)> {
        let graph = self.model.graph;
        let square = self.map.transpose() * self.map;
        let length = graph.total(
            Shape::scalar(),
            self.leaves.iter().map(|&leaf| self.model.configurations[leaf].symbol.norm_squared()),
        );
        let weights = [1, 2, 3, 4].map(|weight| graph.integer(weight)).into_iter().chain([length]).into_list();
        let vanishes = |root: Expr<'g>, other: Option<Expr<'g>>| {
            let once = square * square - root * square;
            identity::vanishes(other.map_or(once, |other| square * once - other * once))
        };
        if let Some(&weight) = weights.iter().find(|weight| vanishes(**weight, None)) {
            let scale = self.scale_of_displacement(rank as i64 * weight, square.trace());
            return Some((Form::Difference { weight, square: None, sphere: None }, scale));
        }
        let pairs = (1..=4_i64).flat_map(|b| (1..b).map(move |a| (a, b)));
        let (a, b) = pairs.into_iter().find(|(a, b)| vanishes(graph.integer(*a), Some(graph.integer(*b))))?;
        let weight = graph.integer(a * b) / (a + b);
        let square_weight = Some(graph.integer(1) / (a + b));
        let scale = self.scale_of_displacement(square.trace(), square.trace());
        Some((Form::Difference { weight, square: square_weight, sphere: None }, scale))
    }

    /// The only leaf, where it is a vector of three or more components that SO(n) turns, and |q|².
    pub(super) fn sphere(&self) -> Option<(usize, Expr<'g>)> {
        let ([k], [leaf]) = (self.factors, self.leaves) else { return None };
        let (factor, configuration) = (&self.model.factors[*k], &self.model.configurations[*leaf]);
        let (f, q) = (factor.symbol, configuration.symbol);
        let Group::SpecialOrthogonal(n) = factor.group else { return None };
        let turned = if factor.side == Side::Left { f * q } else { f.transpose() * q };
        let is_turned =
            n > 2 && configuration.shape == Shape::vector(n) && identity::equal(&[self.model.action[*leaf]], &[turned]);
        is_turned.then(|| (*leaf, q.norm_squared()))
    }
}

impl<'g> Part<'_, 'g> {
    /// Whether W and its derivatives vanish for the products F = s_m s_q of two reflections. Such an F moves q along the geodesic through m,
    /// and reaches all points near q.
    pub(super) fn vanishes_on_reflections(&self, term: &Term<'g>) -> bool {
        let ([k], [leaf]) = (self.factors.as_slice(), self.leaves.as_slice()) else { return false };
        let (factor, configuration) = (&self.model.factors[*k], &self.model.configurations[*leaf]);
        let is_turned = matches!(factor.group, Group::SpecialOrthogonal(n) if n == configuration.shape.rows);
        if !is_turned || !matches!(configuration.space, LeafSpace::Projector(_)) {
            return false;
        }
        let (graph, group, q) = (self.model.graph, factor.group, configuration.symbol);
        let other = graph.symbol("G", group.element_shape(), Role::Composed(*k, 1), group.element_property());
        let reflection = |p: Expr<'g>| 2 * p - graph.identity(configuration.shape.rows);
        let next = self.model.action[*leaf].substitute(&[(factor.symbol, other)]);
        let turn = match factor.side {
            Side::Left => reflection(next) * reflection(q),
            Side::Right => reflection(q) * reflection(next),
        };
        let w = term.motion - term.displacement;
        let slope = trivialisation::of_all(self.model, w).0[*k].components(group);
        [w, slope].iter().all(|part| identity::vanishes(part.substitute(&[(factor.symbol, turn)])))
    }
}
