//! The implicit equation in the chart: both trivialisations of ∂_F K, denominators cleared, coupled factors together.

use clebsch_symbolic::{Chart, Expr, Group, Shape, identity};

use super::Symbols;
use crate::model::{Model, Side};

/// The momentum equation of factors that depend on each other.
pub struct Equation<'g> {
    /// The factors, by index.
    pub factors: Vec<usize>,
    /// ρ(x), the components of all its factors, with μ standing for the momentum after the kick.
    pub residual: Expr<'g>,
    /// Dρ(x)·δ.
    pub directional: Expr<'g>,
    /// Whether the congruence with I ∓ Z has freed it of denominators, for each of its factors.
    pub cleared: Vec<bool>,
    /// How it is solved.
    pub solution: Solution,
    /// The closed form, where there is one.
    pub closed_form: Option<ClosedForm<'g>>,
}

/// x = a/(1 + √(1 − |a|²)) with a = hμ/Σ: the equation hM = ½κ(F − Fᵀ) of a bi-invariant kinetic energy, whose rotation by θ
/// in one plane has sin θ = |a| and tan(θ/2) = |x|.
#[derive(Copy, Clone)]
pub struct ClosedForm<'g> {
    /// x(μ).
    pub coordinates: Expr<'g>,
    /// |a|², which has to be below one.
    pub sine_squared: Expr<'g>,
}

/// How an equation is solved.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Solution {
    /// The residual is affine: the predictor x = s·h·Σ⁻¹μ solves it.
    Explicit,
    /// By a formula with one square root.
    ClosedForm,
    /// By Newton's method from the predictor.
    Newton,
}

/// Arrays whose components are T* ∂_F K before the step and after it: T*_id L_F then R_F for a left action, R_F then L_F for a right one.
pub(super) fn trivialisations<'g>(model: &Model<'g>, kinetic: Expr<'g>, k: usize) -> (Expr<'g>, Expr<'g>) {
    let factor = &model.factors[k];
    let gradient = kinetic.gradient(factor.symbol);
    let left = factor.group.cotangent_left(factor.symbol, gradient).expand();
    let right = factor.group.cotangent_right(factor.symbol, gradient).expand();
    match factor.side {
        Side::Left => (left, right),
        Side::Right => (right, left),
    }
}

/// For each factor, whether both trivialisations have the same components.
pub(super) fn agreement<'g>(model: &Model<'g>, before: &[Expr<'g>], after: &[Expr<'g>]) -> Vec<bool> {
    let same = |k: usize| {
        let algebra = model.factors[k].group.algebra();
        identity::equal(&[before[k].components(algebra)], &[after[k].components(algebra)])
    };
    (0..model.factors.len()).map(same).collect()
}

/// What an equation is derived from.
pub(super) struct Sources<'a, 'g> {
    pub(super) model: &'a Model<'g>,
    pub(super) symbols: &'a Symbols<'g>,
    pub(super) momentum_map: &'a [Expr<'g>],
    pub(super) inertia: Expr<'g>,
    /// The number of substeps in a step.
    pub(super) parts: i64,
}

/// The equations of all factors, coupled ones in one.
pub(super) fn equations<'g>(sources: &Sources<'_, 'g>, before: &[Expr<'g>]) -> Vec<Equation<'g>> {
    let (model, symbols) = (sources.model, sources.symbols);
    let residuals: Vec<(Expr<'g>, bool)> =
        (0..model.factors.len()).map(|k| residual(model, symbols, before, k)).collect();
    let depends = |k: usize, j: usize| residuals[k].0.depends_on(symbols.charts[j]);
    let groups = groups(model.factors.len(), depends);
    groups.into_iter().map(|group| equation(sources, before, &residuals, group)).collect()
}

/// The closed form for a factor in SO(n) with kinetic energy ½κ|ξ|² whose momenta turn one plane: n ≤ 3, or spheres.
fn closed_form<'g>(sources: &Sources<'_, 'g>, before: &[Expr<'g>], k: usize) -> Option<ClosedForm<'g>> {
    let (model, mu) = (sources.model, sources.symbols.momenta[k]);
    let factor = &model.factors[k];
    let Group::SpecialOrthogonal(n) = factor.group else { return None };
    let algebra = factor.group.algebra();
    let offset: usize = model.factors[..k].iter().map(|factor| factor.group.dimension()).sum();
    let kappa = sources.inertia.entry(offset, offset);
    let step = model.step_size / sources.parts;
    let isotropic = kappa * factor.symbol.components(algebra) / (2 * step);
    if !identity::equal(&[before[k].components(algebra)], &[isotropic]) {
        return None;
    }
    let momentum = sources.momentum_map[k];
    let matrix = momentum.wedge(algebra);
    let one_plane = || identity::vanishes(matrix * matrix * matrix + momentum.dot(momentum) * matrix);
    if n > 3 && !one_plane() {
        return None;
    }
    let sine = step * mu / kappa;
    let sine_squared = sine.dot(sine);
    let one = model.graph.integer(1);
    Some(ClosedForm { coordinates: sine / (one + (one - sine_squared).sqrt()), sine_squared })
}

/// ρ_k(x) = A (T* ∂_F K − M) Aᵀ in components, and whether A is anything but the identity.
fn residual<'g>(model: &Model<'g>, symbols: &Symbols<'g>, before: &[Expr<'g>], k: usize) -> (Expr<'g>, bool) {
    let factor = &model.factors[k];
    let algebra = factor.group.algebra();
    let charts = model.factors.iter().zip(&symbols.charts);
    let elements: Vec<_> =
        charts.map(|(factor, x)| (factor.symbol, factor.group.chart().element(factor.group, *x))).collect();
    let momentum = factor.group.momentum_matrix(symbols.momenta[k]);
    let plain = before[k].substitute(&elements).expand();
    let cleared =
        factor.group.chart().clearing(factor.group, symbols.charts[k], factor.side == Side::Left).map(|clearing| {
            let congruent = |matrix: Expr<'g>| (clearing * matrix * clearing.transpose()).expand().components(algebra);
            congruent(plain) - congruent(momentum)
        });
    let plain = plain.components(algebra).expand() - symbols.momenta[k];
    match cleared {
        Some(cleared) if plain.has_inverse() && !cleared.has_inverse() => (cleared, true),
        _ => (plain, false),
    }
}

/// The finest partition of 0..count in which what depends on each other is together.
fn groups(count: usize, depends: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let mut label: Vec<usize> = (0..count).collect();
    for k in 0..count {
        for j in 0..count {
            if depends(k, j) && label[k] != label[j] {
                let (keep, merge) = (label[k].min(label[j]), label[k].max(label[j]));
                label.iter_mut().filter(|entry| **entry == merge).for_each(|entry| *entry = keep);
            }
        }
    }
    let members = |leader: usize| (0..count).filter(|&k| label[k] == leader).collect::<Vec<_>>();
    (0..count).map(members).filter(|group| !group.is_empty()).collect()
}

fn equation<'g>(
    sources: &Sources<'_, 'g>,
    before: &[Expr<'g>],
    residuals: &[(Expr<'g>, bool)],
    factors: Vec<usize>,
) -> Equation<'g> {
    let (model, symbols) = (sources.model, sources.symbols);
    let dimension = factors.iter().map(|&k| model.factors[k].group.dimension()).sum();
    let shape = Shape::vector(dimension);
    let mut residual = model.graph.zero(shape);
    let mut row = 0;
    for &k in &factors {
        residual = residual + residuals[k].0.embed(shape, row, 0);
        row += model.factors[k].group.dimension();
    }
    let directions: Vec<_> = factors.iter().map(|&k| (symbols.charts[k], symbols.directions[k])).collect();
    let directional = residual.differential(&directions).expand();
    let affine = !factors
        .iter()
        .any(|&k| directional.depends_on(symbols.charts[k]) || directional.depends_on(symbols.momenta[k]));
    let identity_charts = factors.iter().all(|&k| model.factors[k].group.chart() == Chart::Identity);
    let closed_form = match factors.as_slice() {
        [only] => closed_form(sources, before, *only),
        _ => None,
    };
    let solution = match closed_form {
        Some(_) => Solution::ClosedForm,
        None if affine && identity_charts => Solution::Explicit,
        None => Solution::Newton,
    };
    let cleared = factors.iter().map(|&k| residuals[k].1).collect();
    Equation { factors, residual, directional, cleared, solution, closed_form }
}
