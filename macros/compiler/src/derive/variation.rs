//! Second derivatives of a discrete Lagrangian: its Legendre transforms differentiated along the motions of both ends of an edge, and
//! with respect to everything that is fixed during a step.

use clebsch_symbolic::{Chart, Expr, Property, Shape};

use super::trivialisation::Covector;
use super::{Bend, DiscreteLagrangian, EdgeForce, Symbols, action, cayley, control};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{Factor, Mechanics, Side};

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
pub(super) fn quantities<'g>(model: &Mechanics<'g>, is_timed: bool) -> Vec<Quantity<'g>> {
    let one = model.graph.integer(1);
    let of_leaf = |name: String, symbol: Expr<'g>, is_scalar: bool| {
        let entries = symbol.shape().positions().filter(move |&entry| is_free(symbol, entry));
        entries.map(move |(i, j)| {
            let unit = |i: usize, j: usize| symbol.graph().unit(symbol.shape(), i, j);
            let mirrored = i != j && property(symbol) == Property::Symmetric;
            let index = match symbol.shape().columns {
                _ if is_scalar => String::new(),
                1 => format!("[{i}]"),
                _ => format!("[({i}, {j})]"),
            };
            let direction = if mirrored { unit(i, j) + unit(j, i) } else { unit(i, j) };
            Quantity { name: format!("{name}{index}"), symbol, direction }
        })
    };
    let leaves = model.parameters.iter().flat_map(|parameter| {
        parameter
            .leaves
            .iter()
            .map(|leaf| (format!("{}{}", parameter.name, leaf.accessor), leaf.symbol, leaf.is_scalar))
    });
    let mut quantities: Vec<_> =
        leaves.flat_map(|(name, symbol, is_scalar)| of_leaf(name, symbol, is_scalar)).collect();
    quantities.push(Quantity { name: "h".into(), symbol: model.step_size, direction: one });
    if is_timed {
        quantities.push(Quantity { name: "t".into(), symbol: model.time, direction: one });
    }
    let inputs = model.inputs.iter().flat_map(|leaf| of_leaf(leaf.name.clone(), leaf.symbol, false));
    quantities.extend(inputs);
    quantities
}

fn property(symbol: Expr<'_>) -> Property {
    symbol.as_symbol().map_or(Property::General, |symbol| symbol.property)
}

/// Whether an entry of a parameter can be changed by itself: not where another entry or a promise determines it.
fn is_free(symbol: Expr<'_>, (i, j): (usize, usize)) -> bool {
    match property(symbol) {
        Property::Symmetric => i <= j,
        Property::Diagonal => i == j,
        _ => true,
    }
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
    pub model: &'a Mechanics<'g>,
    pub symbols: &'a Symbols<'g>,
    pub generator: &'a [Expr<'g>],
    pub momentum_map: &'a [Expr<'g>],
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
        let model = self.model;
        let rational = cayley::replacements(model);
        let lagrangian = &DiscreteLagrangian { kinetic: lagrangian.kinetic.substitute(&rational), ..*lagrangian };
        let (before, after) = super::trivialised(model, lagrangian);
        let (start, end) = (self.later(lagrangian.start, begins), self.at_image(self.later(lagrangian.end, ends)));
        let impulse = |potential| action::impulse(model, self.symbols, self.momentum_map, potential);
        let mut first = self.stacked(&before);
        if lagrangian.couples {
            let coupling = action::coupling(model, self.symbols, self.momentum_map, lagrangian.kinetic);
            first = first + self.stack(&coupling);
        }
        if let Some(kick) = impulse(self.later(lagrangian.start, begins)) {
            first = first - self.stack(&kick);
        }
        let mut last = self.stacked(&after);
        if let Some(kick) = impulse(self.later(lagrangian.end, ends)) {
            last = last + self.at_image(self.stack(&kick));
        }
        if let Some(force) = force {
            if let Some(start) = force.whole_start() {
                first = first - self.later(self.stack(&start), begins).substitute(&rational);
            }
            last = last + self.at_image(self.later(self.stack(&force.end), ends)).substitute(&rational);
        }
        let varied = EdgeDerivatives {
            lagrangian: lagrangian.kinetic + start + end,
            before_by_start: first.differential(&self.at_start()),
            before_by_end: first.differential(&self.at_end()),
            after_by_start: force.map(|_| last.differential(&self.at_start())),
            after_by_end: last.differential(&self.at_end()),
            carried: self.carried(first, last),
            slopes: (!self.quantities.is_empty())
                .then(|| Slopes { before: self.slopes(first), after: self.slopes(last) }),
            before: first,
            after: last,
            bend: None,
        };
        let bend = model.control.as_ref().map(|_| self.bend(&varied));
        EdgeDerivatives { bend, ..varied }
    }

    fn bend(&self, variation: &EdgeDerivatives<'g>) -> Bend<'g> {
        let along = |motions: &[(Expr<'g>, Expr<'g>)]| -> Vec<control::Direction<'g>> {
            let motion = |element: &control::Direction<'g>| {
                motions.iter().map(|(symbol, velocity)| (*symbol, velocity.substitute(element))).collect()
            };
            self.symbols.basis().iter().map(motion).collect()
        };
        let ends = [along(&self.carried_motions()), along(&self.at_end())].concat();
        let costate = self.stack(&self.symbols.momenta);
        control::bend(self.model, variation, (costate, self.symbols.multiplier), &ends)
    }

    fn carried(&self, before: Expr<'g>, after: Expr<'g>) -> Carried<'g> {
        let motions = self.carried_motions();
        let moved = self.stack(&self.moved_along());
        Carried { adjoint: moved, before: before.differential(&motions), after: after.differential(&motions) }
    }

    /// Ad η for each factor, what q⁺ moves by when F stays as it is.
    fn moved_along(&self) -> Vec<Expr<'g>> {
        let moved = |(k, factor): (usize, &Factor<'g>)| action::adjoint_of(factor, self.symbols.algebra[k]);
        self.model.factors.iter().enumerate().map(moved).collect()
    }

    /// How q and q⁺ move with η at q while F stays as it is.
    fn carried_motions(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let (symbols, moved) = (self.symbols, self.moved_along());
        let along: Vec<_> = symbols.algebra.iter().copied().zip(moved.iter().copied()).collect();
        let leaves = self.model.configurations.iter().map(|leaf| leaf.symbol);
        let images = self.generator.iter().map(|part| self.at_image(*part).substitute(&along));
        let mut motions: Vec<_> = leaves.zip(self.generator.iter().copied()).collect();
        motions.extend(symbols.images.iter().copied().zip(images));
        motions
    }

    fn slopes(&self, momentum: Expr<'g>) -> Vec<Expr<'g>> {
        let slope = |quantity: &Quantity<'g>| momentum.differential(&[(quantity.symbol, quantity.direction)]);
        self.quantities.iter().map(slope).collect()
    }

    fn later(&self, part: Expr<'g>, by: Expr<'g>) -> Expr<'g> {
        part.substitute(&[(self.model.time, self.model.time + by)])
    }

    fn at_image(&self, part: Expr<'g>) -> Expr<'g> {
        part.substitute(&self.moved())
    }

    /// The replacement of q by q⁺.
    fn moved(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.model.configurations.iter().zip(&self.symbols.images).map(|(leaf, image)| (leaf.symbol, *image)).collect()
    }

    fn stacked(&self, covectors: &[Covector<'g>]) -> Expr<'g> {
        self.stack(&super::components(self.model, covectors))
    }

    /// The components of all factors in one vector.
    fn stack(&self, parts: &[Expr<'g>]) -> Expr<'g> {
        let shape = Shape::vector(parts.iter().map(|part| part.shape().rows).sum());
        let placed = parts.iter().enumerate().map(|(k, part)| part.embed(shape, self.model.offset(k), 0));
        placed.fold(self.model.graph.zero(shape), |sum, part| sum + part)
    }

    /// How q and F move with η at q: F exp(−η) for a left action, exp(−η) F for a right one.
    fn at_start(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let leaves = self.model.configurations.iter().map(|leaf| leaf.symbol);
        let mut motions: Vec<_> = leaves.zip(self.generator.iter().copied()).collect();
        for (k, factor) in self.model.factors.iter().enumerate() {
            let eta = -self.symbols.algebra[k];
            motions.extend(self.motion(k, factor, eta, factor.side == Side::Right));
        }
        motions
    }

    /// How q⁺ and F move with η′ at q⁺: exp(η′) F for a left action, F exp(η′) for a right one.
    fn at_end(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let generator = self.generator.iter().map(|part| self.at_image(*part));
        let mut motions: Vec<_> = self.symbols.images.iter().copied().zip(generator).collect();
        for (k, factor) in self.model.factors.iter().enumerate() {
            motions.extend(self.motion(k, factor, self.symbols.algebra[k], factor.side == Side::Left));
        }
        motions
    }

    /// δF = ηF or Fη, and how log F moves with it: by dexp_y⁻¹ η or dexp_{−y}⁻¹ η.
    fn motion(
        &self,
        k: usize,
        factor: &Factor<'g>,
        eta: Expr<'g>,
        from_left: bool,
    ) -> impl Iterator<Item = (Expr<'g>, Expr<'g>)> + use<'g> {
        let (group, f, y) = (factor.group, factor.symbol, self.symbols.logarithms[k]);
        let wedge = group.wedge(eta);
        let (moved, slope) = match from_left {
            true => (group.translate_right(f, wedge), group.exponential_slope(y)),
            false => (group.translate_left(f, wedge), group.exponential_slope(-y)),
        };
        let rational = cayley::motion(self.model, k, eta, from_left);
        [(f, moved), (y, slope.inverse() * eta)].into_iter().chain(rational)
    }
}

/// The chart in which small motions are written: Cayley's where it stays in the group, for it has no end, else the chart of the solve.
pub(super) fn retraction(model: &Mechanics<'_>, symbols: &Symbols<'_>, k: usize) -> Chart {
    let group = model.factors[k].group;
    match group.has_cayley_chart(model.graph) {
        true => Chart::Cayley,
        false => symbols.charts[k],
    }
}
