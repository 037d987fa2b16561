//! The momentum equation of a rotating body of any inertia, which has one scalar unknown.
//!
//! In space, with A = Σ/(s·h) it is A x = μ + (μ·x) x ± μ × x for the Gibbs vector x, + for an action from the right. It is linear
//! in x once κ = μ·x is known, and κ is the least root of a polynomial of degree four. By the Cayley map it is (1 + |x|²) A x = μ ± μ × x,
//! which is linear in x once s = 1 + |x|² is known.
//!
//! In four dimensions it is A X = M + (M X − X M) − X M X. That is M = F J − J Fᵀ with J = D/h, and the trace of F J is unknown.

use clebsch_symbolic::{Chart, Expr, Graph, Group, Property, Role, Shape, identity};

use super::equation::{MomentumEquation, RotatingBody, Solution, Sources, is_diagonal};
use super::velocity;
use crate::model::Side;

/// The same equation, if it is that of a rotating body.
///
/// Matrices lead to ρ = A x − μ − (μ·x) x ∓ μ × x, quaternions to ρ = A x ± x × A x − (1 + |x|²) μ. The second is the
/// first times (1 ± x^) from the left, which is regular: the same x solves both.
pub(super) fn rotating<'g>(
    sources: &Sources<'_, 'g>,
    equation: &MomentumEquation<'g>,
    i: usize,
) -> Option<MomentumEquation<'g>> {
    let (model, block) = (sources.model, sources.symbols.blocks[i]);
    let factor = &model.factors[block.factor];
    if equation.moves || sources.is_moving(sources.inertia) {
        return None;
    }
    let dimension = match (factor.group, sources.symbols.charts[block.factor]) {
        (Group::SpecialOrthogonal(3) | Group::UnitQuaternions, Chart::Cayley) => 3,
        (Group::SpecialEuclidean(3), Chart::Product) if block.offset == model.offset(block.factor) => 3,
        (Group::SpecialOrthogonal(4), Chart::Cayley) => 6,
        _ => return None,
    };
    let inertia = sources.inertia.block(block.offset, block.offset, Shape::square(dimension));
    let body = match dimension {
        6 => is_in_four_space(sources, equation, i, inertia).then_some(RotatingBody::FourSpace)?,
        _ => {
            let is_cayley = in_space(sources, equation, i, inertia)?;
            RotatingBody::Space { is_principal: is_diagonal(inertia), is_cayley }
        }
    };
    Some(MomentumEquation { solution: Solution::Rotation(body), ..equation.clone() })
}

/// Whether this is the equation of a body in space by the Cayley map; `None` if it is not that of a body.
fn in_space<'g>(
    sources: &Sources<'_, 'g>,
    equation: &MomentumEquation<'g>,
    i: usize,
    inertia: Expr<'g>,
) -> Option<bool> {
    let (model, block) = (sources.model, sources.symbols.blocks[i]);
    let factor = &model.factors[block.factor];
    let (x, mu) = (block.coordinates, sources.momentum_of_block(i));
    let a = inertia / sources.chart_step(i, sources.divisor);
    let turned = if factor.side == Side::Left { x.cross(mu) } else { mu.cross(x) };
    let by_matrices = a * x - mu - mu.dot(x) * x - turned;
    let back = if factor.side == Side::Left { (a * x).cross(x) } else { x.cross(a * x) };
    let one = model.graph.integer(1);
    let by_quaternions = a * x + back - (one + x.norm_squared()) * mu;
    // the momentum of the Cayley map; quaternions have it times 1 + |x|²
    let by_cayley = a * x + back + x.dot(a * x) * x - mu;
    let is_that = |form: Expr<'g>| identity::equal(&[equation.residual], &[form]);
    if is_that(by_matrices) || is_that(by_quaternions) {
        return Some(false);
    }
    (is_that(by_cayley) || is_that((one + x.norm_squared()) * by_cayley)).then_some(true)
}

/// Whether this is the equation of a body in four dimensions.
fn is_in_four_space<'g>(
    sources: &Sources<'_, 'g>,
    equation: &MomentumEquation<'g>,
    i: usize,
    inertia: Expr<'g>,
) -> bool {
    let block = sources.symbols.blocks[i];
    let factor = &sources.model.factors[block.factor];
    if velocity::mass_matrix(factor.group, inertia).is_none() {
        return false;
    }
    let (x, mu) = (block.coordinates, sources.momentum_of_block(i));
    let [hat, momentum] = [x, mu].map(|vector| factor.group.wedge(vector));
    let commutator = momentum * hat - hat * momentum;
    let turned = if factor.side == Side::Left { -commutator } else { commutator };
    let form = inertia / sources.chart_step(i, sources.divisor) * x
        - mu
        - factor.group.projected_coordinates(turned - hat * momentum * hat);
    identity::equal(&[equation.residual], &[form])
}

/// The scalar equation g(e₁) = 0 of a body in four dimensions, and its solution. The letters are e₁, e₄, S₂, S₄, S₆, N and G.
pub(super) struct FourSpace<'g> {
    /// g(e₁) = 2e₄e₂ − e₃² − S₆ with e₂ = (S₂ + e₁²)/2 and e₃ = (e₂² + 2e₄ − S₄)/(2e₁).
    pub(super) polynomial: Expr<'g>,
    /// x^ = (G + N)⁻¹(G − N).
    pub(super) solution: Expr<'g>,
}

impl<'g> FourSpace<'g> {
    pub(super) fn new(graph: &'g Graph) -> FourSpace<'g> {
        let scalar = |name: &str| graph.symbol(name, Shape::scalar(), Role::Letter, Property::General);
        let [e1, e4, s2, s4, s6] = ["e₁", "e₄", "S₂", "S₄", "S₆"].map(scalar);
        let e2 = (s2 + e1 * e1) / 2;
        let e3 = (e2 * e2 + 2 * e4 - s4) / (2 * e1);
        let [n, g] = ["N", "G"].map(|name| graph.symbol(name, Shape::square(4), Role::Letter, Property::General));
        let coordinates = Group::SpecialOrthogonal(4).projected_coordinates((g + n).inverse() * (g - n));
        FourSpace { polynomial: 2 * e4 * e2 - e3 * e3 - s6, solution: coordinates }
    }
}

/// The scalar equation f(κ) = 0, or f(s) = 0 by the Cayley map, and r and p of its solution x = r/p.
pub(super) struct ScalarEquation<'g> {
    /// f(κ) = μ·r − κp, f(s) = s − 1 − |r|²/p².
    pub(super) polynomial: Expr<'g>,
    /// r = adj(B) μ + |μ|² μ + B μ × μ with B = A − κ, or B = s A.
    pub(super) numerator: Expr<'g>,
    /// p = det B + μ·B μ.
    pub(super) denominator: Expr<'g>,
}

/// The symbols of a scalar equation: A and κ.
pub(super) fn letters(graph: &Graph) -> [Expr<'_>; 2] {
    [
        graph.symbol("A", Shape::square(3), Role::Letter, Property::Symmetric),
        graph.symbol("κ", Shape::scalar(), Role::Letter, Property::General),
    ]
}

impl<'g> ScalarEquation<'g> {
    /// For the momentum μ of an action from the right.
    pub(super) fn new(mu: Expr<'g>) -> ScalarEquation<'g> {
        let [a, kappa] = letters(mu.graph());
        let (numerator, denominator) = solution(a - kappa * Group::SpecialOrthogonal(3).identity(mu.graph()), mu);
        ScalarEquation { polynomial: mu.dot(numerator) - kappa * denominator, numerator, denominator }
    }

    /// The same by the Cayley map.
    pub(super) fn by_cayley(mu: Expr<'g>) -> ScalarEquation<'g> {
        let graph = mu.graph();
        let [a, s] = [letters(graph)[0], graph.symbol("s", Shape::scalar(), Role::Letter, Property::General)];
        let (numerator, denominator) = solution(s * a, mu);
        let polynomial = s - graph.integer(1) - numerator.norm_squared() / (denominator * denominator);
        ScalarEquation { polynomial, numerator, denominator }
    }
}

/// r and p of the solution r/p of B x = μ + μ × x: adj(B) μ + |μ|² μ + B μ × μ and det B + μ·B μ.
fn solution<'g>(b: Expr<'g>, mu: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
    let identity = Group::SpecialOrthogonal(3).identity(b.graph());
    let (trace, square) = (b.trace(), b * b);
    let adjugate = square - trace * b + (trace * trace - square.trace()) / 2 * identity;
    let numerator = adjugate * mu + mu.norm_squared() * mu + (b * mu).cross(mu);
    (numerator, (adjugate * b).trace() / 3 + mu.dot(b * mu))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x = r/p solves the equation of the Cayley map where s = 1 + |x|², and its momentum is that of the velocity 2x/h.
    #[test]
    fn the_equation_of_the_cayley_map_is_linear_for_a_given_scalar() {
        let graph = &Graph::new();
        let mu = graph.symbol("μ", Shape::vector(3), Role::Momentum(0), Property::General);
        let [a, _] = letters(graph);
        let s = graph.symbol("s", Shape::scalar(), Role::Letter, Property::General);
        let ScalarEquation { polynomial, numerator, denominator } = ScalarEquation::by_cayley(mu);
        let x = numerator / denominator;
        assert!(identity::equal(&[s * (a * x)], &[mu + mu.cross(x)]));
        assert!(identity::equal(&[polynomial], &[s - graph.integer(1) - x.norm_squared()]));
        // (I + x^ + xxᵀ)(I − x^) = (1 + |x|²) I
        let y = graph.symbol("y", Shape::vector(3), Role::Letter, Property::General);
        let momentum = a * y + y.cross(a * y) + y.dot(a * y) * y;
        let square = graph.integer(1) + y.norm_squared();
        assert!(identity::equal(&[momentum - y.cross(momentum)], &[square * (a * y)]));
    }

    /// x = r/p solves the equation but for f(κ): ρ(r/p) = −f(κ)/p x, and f is the polynomial that the runtime evaluates.
    #[test]
    fn the_root_of_the_polynomial_solves_the_equation() {
        let graph = &Graph::new();
        let mu = graph.symbol("μ", Shape::vector(3), Role::Momentum(0), Property::General);
        let [a, kappa] = letters(graph);
        let ScalarEquation { polynomial, numerator, denominator } = ScalarEquation::new(mu);
        let x = numerator / denominator;
        let residual = a * x - mu - mu.dot(x) * x - mu.cross(x);
        assert!(identity::equal(&[residual], &[-((polynomial / denominator) * x)]));
        let (square, m) = (a * a, mu.norm_squared());
        let e1 = a.trace();
        let e2 = (e1 * e1 - square.trace()) / 2;
        let adjugate = square - e1 * a + e2 * Group::SpecialOrthogonal(3).identity(graph);
        let e3 = (adjugate * a).trace() / 3;
        let quartic = kappa.powi(4) - e1 * kappa.powi(3) + (e2 + 2 * m) * kappa.powi(2) - (e3 + e1 * m) * kappa
            + m * m
            + mu.dot(adjugate * mu);
        assert!(identity::equal(&[polynomial], &[quartic]));
        // the quaternions' form is the first times 1 + x^
        let by_quaternions = a * x + x.cross(a * x) - (graph.integer(1) + x.norm_squared()) * mu;
        assert!(identity::equal(&[by_quaternions], &[residual + x.cross(residual)]));
    }
}
