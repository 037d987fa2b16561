//! Second derivatives of a discrete Lagrangian: its Legendre transforms differentiated along the motions of both ends of an edge, and
//! with respect to everything that is fixed during a step.

use clebsch_symbolic::{Expr, Property};

use super::prices::Direction;
use super::{Bend, DiscreteLagrangian, EdgeForce, SystemFormulas, cayley, control, trivialisation};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Mechanics, Side, System};

/// ℓd of an edge with its first and second derivatives, as functions of q, F and q⁺. Components are those of all factors.
pub struct EdgeDerivatives<'g> {
    /// ℓd = K(t, h, q, F) + U₀(t, q) + U₁(t + h, q⁺).
    pub lagrangian: Expr<'g>,
    /// F⁻ℓd.
    pub before: Expr<'g>,
    /// F⁺ℓd.
    pub after: Expr<'g>,
    /// ∂F⁻ℓd/∂η η for the motion Φ_{exp η} of q, as all derivatives here a vector that is linear in η, the symbols of the algebra.
    pub before_by_start: Expr<'g>,
    /// ∂F⁻ℓd/∂η′ η′ for the motion of q⁺.
    pub before_by_end: Expr<'g>,
    /// ∂F⁺ℓd/∂η η, where forces act; else that of −(∂F⁻ℓd/∂η′)ᵀ.
    pub after_by_start: Option<Expr<'g>>,
    /// ∂F⁺ℓd/∂η′ η′.
    pub after_by_end: Expr<'g>,
    /// The same along motions that leave F as it is.
    pub carried: Carried<'g>,
    /// What a choice of inputs needs, where there is one.
    pub bend: Option<Bend<'g>>,
    /// The derivatives of both Legendre transforms with respect to each of the [`Quantity`]s, where they are asked for.
    pub slopes: Option<Slopes<'g>>,
}

/// The derivatives along the motions η of q that carry q⁺ along, by η′ = Ad_F η for a left action and Ad_{F⁻¹} η for a right one, and leave F
/// as it is. Where the cost does not couple only potentials and forces are left of them.
pub struct Carried<'g> {
    /// η′.
    pub adjoint: Expr<'g>,
    /// ∂F⁻ℓd η.
    pub before: Expr<'g>,
    /// ∂F⁺ℓd η.
    pub after: Expr<'g>,
}

/// What becomes of the momenta at both ends of an edge when a quantity changes that is fixed during a step.
pub struct Slopes<'g> {
    /// ∂F⁻ℓd.
    pub before: Vec<Expr<'g>>,
    /// ∂F⁺ℓd.
    pub after: Vec<Expr<'g>>,
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
    let of_leaf = |(name, symbol, is_scalar): (String, Expr<'g>, bool)| {
        let property = symbol.as_symbol().map_or(Property::General, |symbol| symbol.property);
        // not where another entry or a promise determines an entry
        let is_free = move |(i, j): &(usize, usize)| match property {
            Property::Symmetric => i <= j,
            Property::Diagonal => i == j,
            _ => true,
        };
        symbol.shape().positions().filter(is_free).map(move |(i, j)| {
            let unit = |i: usize, j: usize| symbol.graph().unit(symbol.shape(), i, j);
            let index = match symbol.shape().columns {
                _ if is_scalar => String::new(),
                1 => format!("[{i}]"),
                _ => format!("[({i}, {j})]"),
            };
            let mirrored = i != j && property == Property::Symmetric;
            let direction = if mirrored { unit(i, j) + unit(j, i) } else { unit(i, j) };
            Quantity { name: format!("{name}{index}"), symbol, direction }
        })
    };
    let parameters = model.parameters.iter().flat_map(|parameter| {
        let name = |accessor| format!("{}{accessor}", parameter.name);
        parameter.leaves.iter().map(move |leaf| (name(&leaf.accessor), leaf.symbol, leaf.is_scalar))
    });
    let step = [("h".to_string(), model.step_size, true)];
    let time = is_timed.then(|| ("t".to_string(), model.time, true));
    let inputs = model.inputs.iter().map(|leaf| (leaf.name.clone(), leaf.symbol, false));
    parameters.chain(step).chain(time).chain(inputs).flat_map(of_leaf).collect()
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

/// What variations are made for.
pub(super) struct Source<'a, 'g> {
    pub system: &'a SystemFormulas<'g>,
    /// What to differentiate with respect to; empty if nothing is asked for.
    pub quantities: &'a [Quantity<'g>],
}

impl<'g> Source<'_, 'g> {
    /// The variation of a discrete Lagrangian whose step starts `begins` and ends `ends` after the whole step.
    pub fn variation(
        &self,
        lagrangian: &DiscreteLagrangian<'g>,
        (begins, ends): (Expr<'g>, Expr<'g>),
        force: Option<&EdgeForce<'g>>,
    ) -> EdgeDerivatives<'g> {
        let (system, model) = (self.system, &*self.system.model);
        let rational = cayley::replacements(model);
        let lagrangian = &DiscreteLagrangian { kinetic: lagrangian.kinetic.substitute(&rational), ..*lagrangian };
        let (before, after) = trivialisation::of_all(model, lagrangian.kinetic);
        let (start, end) = (self.later(lagrangian.start, begins), self.at_image(self.later(lagrangian.end, ends)));
        let stack = |parts: &[Expr<'g>]| model.graph.below(parts);
        let mut first = stack(&trivialisation::components(model, &before));
        if lagrangian.couples {
            first = first + stack(&system.coupling(lagrangian.kinetic));
        }
        if let Some(kick) = system.impulse(self.later(lagrangian.start, begins)) {
            first = first - stack(&kick);
        }
        let mut last = stack(&trivialisation::components(model, &after));
        if let Some(kick) = system.impulse(self.later(lagrangian.end, ends)) {
            last = last + self.at_image(stack(&kick));
        }
        if let Some(force) = force {
            if let Some(start) = force.whole_start() {
                first = first - self.later(stack(&start), begins).substitute(&rational);
            }
            last = last + self.at_image(self.later(stack(&force.end), ends)).substitute(&rational);
        }
        let (at_start, at_end) = (self.at_start(), self.at_end());
        EdgeDerivatives {
            lagrangian: lagrangian.kinetic + start + end,
            before_by_start: first.differential(&at_start),
            before_by_end: first.differential(&at_end),
            after_by_start: force.map(|_| last.differential(&at_start)),
            after_by_end: last.differential(&at_end),
            carried: self.carried(first, last),
            slopes: (!self.quantities.is_empty())
                .then(|| Slopes { before: self.slopes(first), after: self.slopes(last) }),
            before: first,
            after: last,
            bend: model.control.as_ref().map(|_| self.bend((first, last))),
        }
    }

    fn bend(&self, momenta: (Expr<'g>, Expr<'g>)) -> Bend<'g> {
        let along = |motions: &[(Expr<'g>, Expr<'g>)]| -> Vec<Direction<'g>> {
            let motion = |element: &Direction<'g>| {
                motions.iter().map(|(symbol, velocity)| (*symbol, velocity.substitute(element))).collect()
            };
            self.system.symbols.basis().iter().map(motion).collect()
        };
        let ends = [along(&self.carried_motions()), along(&self.at_end())].concat();
        control::bend(self.system, momenta, ends)
    }

    fn carried(&self, before: Expr<'g>, after: Expr<'g>) -> Carried<'g> {
        let motions = self.carried_motions();
        let adjoint = self.system.model.graph.below(&self.moved_along());
        Carried { adjoint, before: before.differential(&motions), after: after.differential(&motions) }
    }

    /// Ad η for each factor, what q⁺ moves by when F stays as it is.
    fn moved_along(&self) -> Vec<Expr<'g>> {
        (0..self.system.model.factors.len()).map(|k| self.system.adjoint(k)).collect()
    }

    /// How q and q⁺ move with η at q while F stays as it is.
    fn carried_motions(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let (symbols, moved) = (&self.system.symbols, self.moved_along());
        let along: Vec<_> = symbols.algebra.iter().copied().zip(moved).collect();
        let images = self.system.generator.iter().map(|part| self.at_image(*part).substitute(&along));
        self.leaves_by_generator().chain(symbols.images.iter().copied().zip(images)).collect()
    }

    fn slopes(&self, momentum: Expr<'g>) -> Vec<Expr<'g>> {
        let slope = |quantity: &Quantity<'g>| momentum.differential(&[(quantity.symbol, quantity.direction)]);
        self.quantities.iter().map(slope).collect()
    }

    fn later(&self, part: Expr<'g>, by: Expr<'g>) -> Expr<'g> {
        part.substitute(&[(self.system.model.time, self.system.model.time + by)])
    }

    /// A function of q at q⁺.
    fn at_image(&self, part: Expr<'g>) -> Expr<'g> {
        let leaves = self.system.model.configurations.iter().zip(&self.system.symbols.images);
        part.substitute(&leaves.map(|(leaf, image)| (leaf.symbol, *image)).collect::<Vec<_>>())
    }

    /// How q moves with η.
    fn leaves_by_generator(&self) -> impl Iterator<Item = (Expr<'g>, Expr<'g>)> {
        let leaves = self.system.model.configurations.iter().map(|leaf| leaf.symbol);
        leaves.zip(self.system.generator.iter().copied())
    }

    /// How q and F move with η at q: F exp(−η) for a left action, exp(−η) F for a right one.
    fn at_start(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let elements = (0..self.system.model.factors.len()).flat_map(|k| self.motion(k, true));
        self.leaves_by_generator().chain(elements).collect()
    }

    /// How q⁺ and F move with η′ at q⁺: exp(η′) F for a left action, F exp(η′) for a right one.
    fn at_end(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let generator = self.system.generator.iter().map(|part| self.at_image(*part));
        let images = self.system.symbols.images.iter().copied().zip(generator);
        images.chain((0..self.system.model.factors.len()).flat_map(|k| self.motion(k, false))).collect()
    }

    /// δF = ηF or Fη, and how log F moves with it: by dexp_y⁻¹ η or dexp_{−y}⁻¹ η; at the start of a step with −η.
    fn motion(&self, k: usize, at_start: bool) -> impl Iterator<Item = (Expr<'g>, Expr<'g>)> + use<'g> {
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
        [(f, moved), (y, slope.inverse() * eta)].into_iter().chain(rational)
    }
}
