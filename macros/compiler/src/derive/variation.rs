//! Second derivatives of a discrete Lagrangian. Its Legendre transforms are differentiated along the motions of both
//! ends of an edge, and with respect to everything that is fixed during a step.

mod constraint;

use clebsch_symbolic::{Elements, Expr, IntoList, Property, both, indexed};

use super::choice::Direction;
use super::force::total;
use super::{Bend, ConstraintFormulas, DiscreteLagrangian, EdgeForce, SystemFormulas, cayley, control, trivialisation};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Mechanics, Side, System};
pub use constraint::ConstraintDerivatives;
pub(super) use constraint::ReactionTerms;

/// ℓd of an edge with its first and second derivatives, as functions of q, F and q⁺. Components are those of all factors, and each
/// derivative is a vector that is linear in η, the symbols of the algebra.
pub struct EdgeDerivatives<'g> {
    /// ℓd = K(t, h, q, F) + U₀(t, q) + U₁(t + h, q⁺), F⁻ℓd and F⁺ℓd.
    pub momenta: [Expr<'g>; 3],
    /// ∂F⁻ℓd/∂η η for the motion Φ_{exp η} of q, ∂F⁻ℓd/∂η′ η′ and ∂F⁺ℓd/∂η′ η′ for that of q⁺. Where forces act ∂F⁺ℓd/∂η η follows, else
    /// that is −(∂F⁻ℓd/∂η′)ᵀ.
    pub derivatives: Vec<Expr<'g>>,
    /// η′, ∂F⁻ℓd η and ∂F⁺ℓd η for the motions η of q that leave F as it is. They carry q⁺ along, by η′ = Ad_F η for a left action and
    /// η′ = Ad_{F⁻¹} η for a right one. Where the cost does not couple only potentials and forces are left of the derivatives.
    pub carried: [Expr<'g>; 3],
    /// The formulas for a choice of inputs, if there is one.
    pub bend: Option<Bend<'g>>,
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to each of the [`Quantity`]s, where they are asked for.
    pub slopes: Option<[Vec<Expr<'g>>; 2]>,
    /// The derivatives of the constraint, if there is one.
    pub constraint: Option<ConstraintDerivatives<'g>>,
}

/// A scalar that is fixed during a step: an entry of a parameter, the step size, the time.
pub struct Quantity<'g> {
    /// As the user would write it: `inertia[(0, 1)]`, `gravity`, `h`.
    pub name: String,
    symbol: Expr<'g>,
    direction: Expr<'g>,
}

/// The parameters, entry by entry, the step size, the time where it matters, and the input. Both entries of a symmetric matrix are one.
pub(super) fn quantities<'g>(model: &System<'g>, is_timed: bool) -> Vec<Quantity<'g>> {
    let mut symbols = Vec::new();
    for parameter in &model.parameters {
        let leaves = parameter.leaves.iter();
        symbols
            .extend(leaves.map(|leaf| (format!("{}{}", parameter.name, leaf.accessor), leaf.symbol, leaf.is_scalar)));
    }
    symbols.push(("h".to_string(), model.step_size, true));
    if is_timed {
        symbols.push(("t".to_string(), model.time, true));
    }
    symbols.extend(model.inputs.iter().map(|leaf| (leaf.name.clone(), leaf.symbol, false)));
    let mut quantities = Vec::new();
    for (name, symbol, is_scalar) in symbols {
        let (shape, property) = (symbol.shape(), symbol.property());
        for (i, j) in shape.positions() {
            let unit = |i: usize, j: usize| symbol.graph().unit(shape, i, j);
            let direction = match property {
                // another entry or a promise determines this one
                Property::Symmetric if i > j => continue,
                Property::Diagonal if i != j => continue,
                Property::Symmetric if i < j => unit(i, j) + unit(j, i),
                _ => unit(i, j),
            };
            let index = match shape.columns {
                _ if is_scalar => String::new(),
                1 => format!("[{i}]"),
                _ => format!("[({i}, {j})]"),
            };
            quantities.push(Quantity { name: format!("{name}{index}"), symbol, direction });
        }
    }
    quantities
}

/// Second derivatives need a potential that can be differentiated twice.
pub(super) fn check(model: &Mechanics<'_>) -> Result<(), Diagnostics> {
    let Some(opaque) = model.opaque.as_ref().filter(|_| model.has_variations()) else { return Ok(()) };
    features::check((Feature::OpaquePotential, Found::at(opaque.place)), |feature| match feature {
        Feature::Effort => Found::when(model.control.is_some()),
        Feature::Tangent => Found::when(model.emit.tangent),
        Feature::Boundary => Found::when(model.emit.boundary),
        _ => None,
    })
}

/// The data for variations.
pub(super) struct Source<'a, 'g> {
    pub model: &'a Mechanics<'g>,
    pub system: &'a SystemFormulas<'g>,
    /// The quantities to differentiate with respect to; empty if the declaration asks for none.
    pub quantities: &'a [Quantity<'g>],
}

impl<'g> Source<'_, 'g> {
    /// The variation of a discrete Lagrangian whose step starts `begins` and ends `ends` after the full step.
    pub fn variation(
        &self,
        lagrangian: &DiscreteLagrangian<'g>,
        (begins, ends): (Expr<'g>, Expr<'g>),
        (force, constraint): (Option<&EdgeForce<'g>>, Option<&ConstraintFormulas<'g>>),
    ) -> EdgeDerivatives<'g> {
        let (system, model) = (self.system, &*self.system.model);
        let rational = cayley::replacements(model);
        let lagrangian = &DiscreteLagrangian { kinetic: lagrangian.kinetic.substitute(&rational), ..*lagrangian };
        let (before, after) = trivialisation::of_all(model, lagrangian.kinetic);
        let (start, end) = (system.later(lagrangian.start, begins), system.later(lagrangian.end, ends));
        let end_at_image = self.at_image(end);
        let stack = |parts: &[Expr<'g>]| model.graph.below(parts);
        let mut first = stack(&trivialisation::components(model, &before));
        if lagrangian.couples {
            first = first + stack(&system.coupling(lagrangian.kinetic));
        }
        if let Some(kick) = system.impulse(start) {
            first = first - stack(&kick);
        }
        let mut last = stack(&trivialisation::components(model, &after));
        if let Some(kick) = system.impulse(end) {
            last = last + self.at_image(stack(&kick));
        }
        if let Some(force) = force {
            if let Some(start) = total(force.start.clone(), force.start_moving.clone()) {
                first = first - system.later(stack(&start), begins).substitute(&rational);
            }
            last = last + self.at_image(system.later(stack(&force.end), ends)).substitute(&rational);
        }
        let (at_start, at_end) = (self.at_start(), self.at_end());
        let momenta = [lagrangian.kinetic + start + end_at_image, first, last];
        let mut derivatives = vec![first.differential(&at_start), first.differential(&at_end)];
        let after_by_start = force.map(|_| last.differential(&at_start));
        derivatives.push(last.differential(&at_end));
        derivatives.extend(after_by_start);
        let adjoint: Vec<_> = indexed(model.factors.len(), |k| system.adjoint(k));
        let together = self.together();
        let along = |quantity: &Quantity<'g>, momentum: Expr<'g>| {
            momentum.differential(&[(quantity.symbol, quantity.direction)])
        };
        let slopes = |momentum| self.quantities.each(|quantity| along(quantity, momentum));
        EdgeDerivatives {
            momenta,
            derivatives,
            carried: [model.graph.below(&adjoint), first.differential(&together), last.differential(&together)],
            constraint: constraint.map(|constraint| self.constraint(constraint, &together, ends)),
            slopes: (!self.quantities.is_empty()).then(|| both([first, last], slopes)),
            bend: model.control.as_ref().map(|_| {
                let reactions = constraint.map(|constraint| self.reactions(constraint, ends));
                control::bend(system, (first, last), self.ends(), reactions)
            }),
        }
    }

    /// How q and q⁺ move with η at q while F stays as it is: q⁺ by Ad η for each factor.
    fn together(&self) -> Direction<'g> {
        let system = self.system;
        let adjoint = indexed(system.model.factors.len(), |k| system.adjoint(k));
        let by_adjoint: Vec<_> = system.symbols.algebra.iter().copied().zip(adjoint).into_list();
        let images = self.images_by_generator().into_iter();
        let mut together = system.leaves_by_generator();
        together.extend(images.map(|(image, part)| (image, part.substitute(&by_adjoint))));
        together
    }

    /// The motions η of q that leave F as it is, and then the motions of q⁺ alone, along each element of the basis.
    pub(super) fn ends(&self) -> Vec<Direction<'g>> {
        let ends = [self.together(), self.at_end()];
        both(ends.each_ref(), |motions| self.system.symbols.along_basis(motions)).concat()
    }

    /// A function of q at q⁺.
    fn at_image(&self, part: Expr<'g>) -> Expr<'g> {
        part.substitute(&self.system.images_of_leaves())
    }

    /// How q⁺ moves with η.
    fn images_by_generator(&self) -> Direction<'g> {
        let images = self.system.symbols.images.iter().zip(&self.system.generator);
        images.map(|(image, part)| (*image, self.at_image(*part))).into_list()
    }

    /// How q and F move with η at q: F exp(−η) for a left action, exp(−η) F for a right one.
    fn at_start(&self) -> Direction<'g> {
        let mut motions = self.system.leaves_by_generator();
        (0..self.system.model.factors.len()).for_each(|k| motions.extend(self.motion(k, true)));
        motions
    }

    /// How q⁺ and F move with η′ at q⁺: exp(η′) F for a left action, F exp(η′) for a right one.
    fn at_end(&self) -> Direction<'g> {
        let mut motions = self.images_by_generator();
        (0..self.system.model.factors.len()).for_each(|k| motions.extend(self.motion(k, false)));
        motions
    }

    /// δF = ηF or Fη, and how log F moves with it: by dexp_y⁻¹ η or dexp_{−y}⁻¹ η; at the start of a step with −η.
    fn motion(&self, k: usize, at_start: bool) -> Direction<'g> {
        let (model, symbols) = (&self.system.model, &self.system.symbols);
        let (group, f, y) = (model.factors[k].group, model.factors[k].symbol, symbols.logarithms[k]);
        let eta = if at_start { -symbols.algebra[k] } else { symbols.algebra[k] };
        let from_left = (model.factors[k].side == Side::Left) != at_start;
        let wedge = group.wedge(eta);
        let (moved, slope) = if from_left {
            (group.translate_right(f, wedge), group.exponential_slope(y))
        } else {
            (group.translate_left(f, wedge), group.exponential_slope(-y))
        };
        let rational = cayley::motion(model, k, eta, from_left);
        [(f, moved), (y, slope.inverse() * eta)].into_iter().chain(rational).into_list()
    }
}
