//! The trivialised derivatives T*_id L_F ∂_F K and T*_id R_F ∂_F K.

use clebsch_symbolic::{Expr, Group, IntoList, Property, Role};

use super::cayley;
use super::symbols::logarithm;
use crate::model::{Side, System};

/// A trivialised derivative T* ∂_F K of a factor.
#[derive(Copy, Clone)]
pub(super) struct Covector<'g> {
    /// An array whose components are those of ∂_F K.
    pub array: Expr<'g>,
    /// dexp_y^T of the components that come from log F, and dexp_y itself: `None` where K does not depend on log F.
    pub logarithmic: Option<(Expr<'g>, Expr<'g>)>,
    /// log F, or −log F: the argument of this dexp.
    pub along: Expr<'g>,
    /// The components that come from Cayley coordinates; `None` where K does not depend on them.
    pub rational: Option<Rational<'g>>,
}

/// The components ⟨∂K/∂z, δz⟩ that come from Cayley coordinates z, as a linear map of ∂K/∂z.
#[derive(Copy, Clone)]
pub(super) struct Rational<'g> {
    /// The map, of z and of the letter.
    pub map: Expr<'g>,
    /// The letter for ∂K/∂z.
    pub letter: Expr<'g>,
    /// ∂K/∂z.
    pub gradient: Expr<'g>,
}

impl<'g> Covector<'g> {
    /// The components.
    pub fn components(&self, group: Group) -> Expr<'g> {
        let plain = group.components(self.array);
        let plain = self
            .rational
            .map_or(plain, |rational| plain + rational.map.substitute(&[(rational.letter, rational.gradient)]));
        self.logarithmic.map_or(plain, |(gradient, slope)| plain + slope.transpose().inverse() * gradient)
    }

    /// The components where dexp_y⁻¹ has a formula.
    pub fn closed_components(&self, group: Group) -> Expr<'g> {
        let logarithmic =
            self.logarithmic.and_then(|(gradient, _)| Some((gradient, group.logarithm_slope(self.along)?)));
        match logarithmic {
            Some((gradient, slope)) => {
                Covector { logarithmic: None, ..*self }.components(group) + slope.transpose() * gradient
            }
            None => self.components(group),
        }
    }
}

/// T* ∂_F K of each factor before the step and after it. For a left action these are T*_id L_F and R_F, for a right one
/// R_F and L_F.
pub(super) fn of_all<'g>(model: &System<'g>, kinetic: Expr<'g>) -> (Vec<Covector<'g>>, Vec<Covector<'g>>) {
    (0..model.factors.len()).map(|k| of_factor(model, kinetic, k)).unzip()
}

fn of_factor<'g>(model: &System<'g>, kinetic: Expr<'g>, k: usize) -> (Covector<'g>, Covector<'g>) {
    let factor = &model.factors[k];
    let gradient = kinetic.gradient(factor.symbol);
    let y = logarithm(model, k);
    // δF = ηF moves log F by dexp_y⁻¹ η, and δF = Fη by dexp_{−y}⁻¹ η
    let along = |y: Expr<'g>, sign: i64| {
        kinetic.depends_on(y).then(|| (kinetic.gradient(y), factor.group.exponential_slope(sign * y)))
    };
    let left = factor.group.cotangent_left(factor.symbol, gradient).expand();
    let right = factor.group.cotangent_right(factor.symbol, gradient).expand();
    let xi = model.graph.symbol("ξ", y.shape(), Role::Algebra(k), Property::General);
    // ⟨∂K/∂z, δz⟩ is linear in the motion
    let rational = |from_left: bool| {
        let (z, moved) = cayley::motion(model, k, xi, from_left)?;
        let letter = model.graph.symbol("∂K/∂z", z.shape(), Role::Following(k), Property::General);
        let map = || letter.dot(moved).gradient(xi).expand();
        kinetic.depends_on(z).then(|| Rational { map: map(), letter, gradient: kinetic.gradient(z) })
    };
    let left = Covector { array: left, logarithmic: along(y, -1), along: -y, rational: rational(false) };
    let right = Covector { array: right, logarithmic: along(y, 1), along: y, rational: rational(true) };
    if factor.side == Side::Left { (left, right) } else { (right, left) }
}

/// The components of the covectors of all factors, by formulas for dexp⁻¹.
pub(super) fn closed_components<'g>(model: &System<'g>, covectors: &[Covector<'g>]) -> Vec<Expr<'g>> {
    model.factors.iter().zip(covectors).map(|(factor, covector)| covector.closed_components(factor.group)).into_list()
}

pub(super) fn components<'g>(model: &System<'g>, covectors: &[Covector<'g>]) -> Vec<Expr<'g>> {
    model.factors.iter().zip(covectors).map(|(factor, covector)| covector.components(factor.group)).into_list()
}
