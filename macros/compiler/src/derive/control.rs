//! The formulas for the choice of inputs: the step that inputs make, price, bounds and the price of the end, all with
//! their derivatives.
//!
//! Small changes of a configuration are motions η, q ↦ Φ_{exp η}(q). A step by F(t, h, q, u) takes them to η′, with w =
//! (η, u). For a right action exp η′ = (F⁻¹ exp(η) F)(F⁻¹ F(w)), for a left one exp η′ = (F(w) F⁻¹)(F exp(η) F⁻¹). To
//! first order η′ = Ad η + b(w). To second order ½ b″ + ½ [Ad η, b] or ½ [b, Ad η] is added (Baker, Campbell,
//! Hausdorff).

use clebsch_symbolic::{Block, Chart, Elements, Expr, IntoList, Property, Role, Shape, both, indexed};

use super::SystemFormulas;
use super::choice::{Direction, EndTarget, Endpoint, Jet, OnEdge, Steering};
use super::exact::{by_inertia, inertia_inverse};
use super::variation::{ReactionTerms, Source};
use super::{Energy, cayley, force};
use crate::model::{Discretization, EndPrice, Factor, Motion, Side, Steered, System};

/// The step F(t, h, q, u), as a function of F too where it stands for its value.
pub struct InputStep<'g> {
    /// F − I for each factor, F itself for translations.
    pub increment: Vec<Expr<'g>>,
    /// η′ along each motion η of q.
    pub by_place: Vec<Expr<'g>>,
    /// η′ along each input.
    pub by_input: Vec<Expr<'g>>,
    /// The second derivatives of λ·η′ along all of them, λ standing for momenta.
    pub curvature: Vec<Vec<Expr<'g>>>,
    /// λ·η′ along h and along t.
    pub by_time: [Expr<'g>; 2],
}

impl<'g> SystemFormulas<'g> {
    /// Each entry of the input that is chosen.
    fn inputs(&self) -> Vec<Direction<'g>> {
        let mut inputs = Vec::new();
        for leaf in self.model.chosen() {
            let units = leaf.shape.positions().map(|(i, j)| self.model.graph.unit(leaf.shape, i, j));
            inputs.extend(units.map(|unit| vec![(leaf.symbol, unit)]));
        }
        inputs
    }

    /// The derivatives with respect to h and t.
    fn by_time(&self, value: Expr<'g>) -> [Expr<'g>; 2] {
        let one = self.model.graph.integer(1);
        both([self.model.step_size, self.model.time], |symbol| value.differential(&[(symbol, one)]))
    }

    /// Everything that a declared choice of inputs needs.
    pub(super) fn chosen_by(&self) -> Option<Steering<'g>> {
        let control = self.model.control.as_ref()?;
        let all = [self.symbols.along_basis(&self.leaves_by_generator()), self.inputs()].concat();
        let apart = self.images_of_leaves().into_iter().map(|(q, image)| image - q);
        Some(Steering {
            price: Jet::of(control.price, &all),
            price_of_time: self.by_time(control.price),
            bounds: control.bounds.each(|bound| Jet::of(bound.value, &all)),
            on_edge: OnEdge::default(),
            weights: self.weights(control.bounds.len()),
            approach: self.momenta_of(apart),
        })
    }

    pub(super) fn price_of_end(&self) -> Option<Endpoint<'g>> {
        let price = self.model.endpoint.as_ref()?.value;
        Some(self.priced(price, &self.directions_of_end(false)))
    }

    fn priced(&self, price: Expr<'g>, directions: &[Direction<'g>]) -> Endpoint<'g> {
        Endpoint { price: Jet::of(price, directions), by_time: self.by_time_alone(price) }
    }

    fn by_time_alone(&self, value: Expr<'g>) -> Expr<'g> {
        value.differential(&[(self.model.time, self.model.graph.integer(1))])
    }

    /// Motions of the end, and the entries of its momentum where that is read.
    fn directions_of_end(&self, reads_momentum: bool) -> Vec<Direction<'g>> {
        let motions = self.symbols.along_basis(&self.leaves_by_generator());
        let momenta = self.symbols.momenta.iter().filter(|_| reads_momentum).flat_map(|mu| {
            let units = mu.shape().positions().map(|(i, j)| mu.graph().unit(mu.shape(), i, j));
            units.map(|unit| vec![(*mu, unit)]).into_list()
        });
        [motions, momenta.into_list()].concat()
    }

    /// The conditions of the end. Where they take the velocity, the other symbols are replaced, as by Σ⁻¹(N − A).
    fn conditions_of_end(&self, moving: &[(Expr<'g>, Expr<'g>)]) -> Option<EndTarget<'g>> {
        let target = self.model.target.as_ref()?;
        let directions = self.directions_of_end(!moving.is_empty());
        let sides =
            target.conditions.each(|condition| both([condition.left, condition.right], |side| side.substitute(moving)));
        let differences: Vec<_> = sides.each(|[left, right]| *left - *right);
        Some(EndTarget {
            by_time: differences.each(|difference| self.by_time_alone(*difference)),
            differences: differences.each(|difference| Jet::of(*difference, &directions)),
            weights: self.weights(target.conditions.len()),
            sides,
        })
    }

    pub(super) fn target(&self) -> Option<EndTarget<'g>> {
        self.conditions_of_end(&[])
    }

    /// The same conditions where they take the velocity Σ⁻¹(N − A), as functions of q and N.
    pub(super) fn target_of_velocity(&self, energy: &Energy<'g>, inertia: Expr<'g>) -> Option<EndTarget<'g>> {
        let velocities = &self.model.target.as_ref()?.velocities;
        if velocities.is_empty() {
            return None;
        }
        self.conditions_of_end(&self.velocities_of_momentum(velocities, energy, inertia))
    }

    /// The symbols of so many weights.
    fn weights(&self, count: usize) -> Expr<'g> {
        self.model.graph.symbol("z", Shape::vector(count.max(1)), Role::Weight, Property::General)
    }

    /// The same price where it takes the velocity Σ⁻¹(N − A), as a function of q and N.
    pub(super) fn price_of_end_velocity(&self, energy: &Energy<'g>, inertia: Expr<'g>) -> Option<Endpoint<'g>> {
        let EndPrice { value, velocities, .. } = self.model.endpoint.as_ref()?;
        if velocities.is_empty() {
            return None;
        }
        let price = value.substitute(&self.velocities_of_momentum(velocities, energy, inertia));
        Some(self.priced(price, &self.directions_of_end(true)))
    }

    /// The velocities as functions of the momentum.
    fn velocities_of_momentum(
        &self,
        velocities: &[Expr<'g>],
        energy: &Energy<'g>,
        inertia: Expr<'g>,
    ) -> Vec<(Expr<'g>, Expr<'g>)> {
        let graph = self.model.graph;
        let momentum = graph.below(&self.symbols.momenta) - self.symbols.slope(energy.gyroscopic);
        let entries = momentum.entries();
        let inverse = || match self.is_moving(inertia) {
            true => inertia.inverse(),
            false => inertia_inverse(graph, inertia.shape()),
        };
        let velocity = graph.stack(momentum.shape(), by_inertia(inertia, inverse, &entries));
        let part = |(k, xi): (usize, &Expr<'g>)| (*xi, velocity.block(self.model.offset(k), 0, xi.shape()));
        velocities.iter().enumerate().map(part).into_list()
    }
}

impl<'g> Source<'_, 'g> {
    /// The choice of inputs where price or bounds take the velocity ξ(F)/h of a step; `None` where none does.
    pub(super) fn chosen_by_velocity(&self) -> Option<Steering<'g>> {
        let (system, model) = (self.system, self.model);
        let control = model.control.as_ref()?;
        let on_edge = OnEdge {
            price: control.velocities.iter().any(|xi| control.price.depends_on(*xi)),
            bounds: control.velocities.iter().any(|xi| control.bounds.iter().any(|bound| bound.value.depends_on(*xi))),
        };
        if !on_edge.price && !on_edge.bounds {
            return None;
        }
        let steering = system.chosen_by()?;
        let of_step = force::velocities_of_step(model, model.step_size);
        let moving: Vec<_> = control.velocities.iter().copied().zip(of_step).into_list();
        let rational = cayley::replacements(model);
        let moved = |value: Expr<'g>| value.substitute(&moving).substitute(&rational);
        let all = [self.ends(), system.inputs()].concat();
        let price = moved(control.price);
        Some(Steering {
            price: if on_edge.price { Jet::of(price, &all) } else { steering.price },
            price_of_time: system.by_time(price),
            bounds: match on_edge.bounds {
                true => control.bounds.each(|bound| Jet::of(moved(bound.value), &all)),
                false => steering.bounds,
            },
            on_edge,
            ..steering
        })
    }
}

/// F − I for each factor, made of inputs.
fn element<'g>(model: &Steered<'g>) -> Vec<Expr<'g>> {
    let (velocity, discretization) = match &model.motion {
        Motion::Controls { velocity, discretization } => (velocity, *discretization),
        Motion::Dynamics { next, .. } => {
            let leaves = model.configurations.iter().zip(next);
            return leaves.map(|(leaf, next)| *next - leaf.symbol).into_list();
        }
    };
    let increment = |(factor, xi): (&Factor<'g>, &Expr<'g>)| {
        let chart = match discretization {
            _ if factor.group.is_translation() => Chart::Identity,
            Discretization::Exponential => Chart::Exponential,
            _ => Chart::Cayley,
        };
        let coordinates = |block: &Block| {
            let (numerator, denominator) = chart.slope_at_identity(block);
            let part = xi.block(block.offset, 0, Shape::vector(block.algebra.dimension));
            model.graph.rational(numerator, denominator) * model.step_size * part
        };
        let coordinates: Vec<_> = model.graph.blocks(factor.group).each(coordinates);
        chart.increment(factor.group, &coordinates)
    };
    model.factors.iter().zip(velocity).map(increment).into_list()
}

/// The coordinates of the logarithmic derivative b along a direction: of F⁻¹δF for a right action, of δF F⁻¹ for a left one.
fn logarithmic<'g>(factor: &Factor<'g>, change: Expr<'g>) -> Expr<'g> {
    if factor.group.is_translation() { change } else { factor.group.projected_coordinates(divided(factor, change)) }
}

/// F⁻¹δF for a right action, δF F⁻¹ for a left one, as an element of the Lie algebra.
fn divided<'g>(factor: &Factor<'g>, change: Expr<'g>) -> Expr<'g> {
    let (group, inverse) = (factor.group, factor.group.inverse(factor.symbol));
    if factor.side == Side::Right { group.compose(inverse, change) } else { group.compose(change, inverse) }
}

/// The step that inputs make, with its derivatives.
pub(super) fn step<'g>(model: &Steered<'g>, formulas: &SystemFormulas<'g>) -> InputStep<'g> {
    let (graph, dimension) = (model.graph, model.dimension());
    let directions = [formulas.symbols.along_basis(&formulas.leaves_by_generator()), formulas.inputs()].concat();
    let increment = element(model);
    let factored = |(k, factor): (usize, &'_ Factor<'g>)| {
        let basis = formulas.symbols.basis();
        let moved = basis.each(|element| formulas.adjoint(k).substitute(element));
        let changes = directions.each(|direction| increment[k].differential(direction));
        Factored { factor: factor.clone(), costate: formulas.symbols.momenta[k], moved, changes }
    };
    let parts: Vec<Factored<'g>> = model.factors.iter().enumerate().map(factored).into_list();
    let column = |i: usize| {
        let of_factor = parts.iter().map(|part| {
            let change = logarithmic(&part.factor, part.changes[i]);
            if i < dimension { part.moved[i] + change } else { change }
        });
        graph.below(&of_factor.into_list())
    };
    let second =
        |i: usize, j: usize| graph.total(Shape::scalar(), parts.iter().map(|part| part.curvature(&directions, i, j)));
    let by_time = both([model.step_size, model.time], |symbol| {
        let slope = |(part, increment): (&Factored<'g>, &Expr<'g>)| {
            let change = increment.differential(&[(symbol, graph.integer(1))]);
            part.costate.dot(logarithmic(&part.factor, change))
        };
        graph.total(Shape::scalar(), parts.iter().zip(&increment).map(slope))
    });
    InputStep {
        by_place: indexed(dimension, column),
        by_input: (dimension..directions.len()).map(column).into_list(),
        curvature: indexed(directions.len(), |i| (0..=i).map(|j| second(i, j)).into_list()),
        by_time,
        increment,
    }
}

/// A factor of a step with its motion.
struct Factored<'g> {
    factor: Factor<'g>,
    costate: Expr<'g>,
    /// Ad η for each motion.
    moved: Vec<Expr<'g>>,
    /// δF along each direction.
    changes: Vec<Expr<'g>>,
}

impl<'g> Factored<'g> {
    /// λ · (b″ along two directions, with the brackets).
    fn curvature(&self, directions: &[Direction<'g>], i: usize, j: usize) -> Expr<'g> {
        let group = self.factor.group;
        let second = (self.changes[i].differential(&directions[j]) + self.changes[j].differential(&directions[i])) / 2;
        let mut sum = logarithmic(&self.factor, second);
        if !group.is_translation() {
            let [a, b] = both([i, j], |i| divided(&self.factor, self.changes[i]));
            let product = (group.compose(a, b) + group.compose(b, a)) / 2;
            sum = sum - group.projected_coordinates(product) + self.bracket(i, b) + self.bracket(j, a);
        }
        self.costate.dot(sum)
    }

    /// ½ [Ad η, b] for a right action, ½ [b, Ad η] for a left one; 0 along an input.
    fn bracket(&self, i: usize, b: Expr<'g>) -> Expr<'g> {
        let group = self.factor.group;
        let Some(moved) = self.moved.get(i) else { return self.costate.graph().zero(self.costate.shape()) };
        let bracket = group.ad(*moved) * group.projected_coordinates(b) / 2;
        if self.factor.side == Side::Right { bracket } else { -bracket }
    }
}

/// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along an edge and the input, and the effect of the input on both ends.
///
/// An edge changes by the motions η of q that leave F as it is, and by the motions ζ of q⁺ alone. For a right action
/// exp η′ = exp(Ad η) exp ζ, for a left one exp ζ exp(Ad η). So ± ½ [Ad η, ζ] joins η′ to second order.
pub struct Bend<'g> {
    /// Along η, ζ and the inputs.
    pub curvature: Vec<Vec<Expr<'g>>>,
    /// ± ½ μ·[E_i, E_j], with the sign of the side of each factor.
    pub bracket: Vec<Vec<Expr<'g>>>,
    /// ∂F⁻ℓd along each input.
    pub before_by_input: Vec<Expr<'g>>,
    /// ∂F⁺ℓd along each input.
    pub after_by_input: Vec<Expr<'g>>,
    /// β·∂F⁺ℓd + κ·∂F⁻ℓd along h and t.
    pub by_time: [Expr<'g>; 2],
    /// Where a constraint acts, the derivatives along η and ζ of the slopes with respect to its multipliers λ and ν and to N⁺.
    pub crossed: Vec<Expr<'g>>,
}

/// The derivatives of an edge for a choice of the inputs of forces. A constraint adds its terms to β·F⁺ℓd + κ·F⁻ℓd.
pub(super) fn bend<'g>(
    formulas: &SystemFormulas<'g>,
    (before, after): (Expr<'g>, Expr<'g>),
    ends: Vec<Direction<'g>>,
    constraint: Option<ReactionTerms<'g>>,
) -> Bend<'g> {
    let (symbols, inputs) = (&formulas.symbols, formulas.inputs());
    let costate = formulas.model.graph.below(&symbols.momenta);
    let mut function = costate.dot(after) + symbols.multiplier.dot(before);
    let mut crossed = Vec::new();
    if let Some(ReactionTerms { terms, slopes }) = constraint {
        function = function + terms;
        crossed = ends.each(|direction| slopes.differential(direction));
    }
    let columns = |momentum: Expr<'g>| inputs.each(|input| momentum.differential(input));
    Bend {
        bracket: bracket(&formulas.model, costate),
        curvature: Jet::of(function, &[ends, inputs.clone()].concat()).curvature,
        before_by_input: columns(before),
        after_by_input: columns(after),
        by_time: formulas.by_time(function),
        crossed,
    }
}

/// ½ μ·[E_i, E_j] for a right action, −½ μ·[E_i, E_j] for a left one.
fn bracket<'g>(model: &System<'g>, mu: Expr<'g>) -> Vec<Vec<Expr<'g>>> {
    let dimension = model.dimension();
    let mut entries = vec![vec![model.graph.integer(0); dimension]; dimension];
    for (k, factor) in model.factors.iter().enumerate() {
        let (offset, shape) = (model.offset(k), Shape::vector(factor.group.dimension()));
        let part = mu.block(offset, 0, shape);
        for i in 0..shape.rows {
            let row = factor.group.ad(model.graph.unit(shape, i, 0)).transpose() * part / 2;
            let row = if factor.side == Side::Right { row } else { -row };
            (0..shape.rows).for_each(|j| entries[offset + i][offset + j] = row.entry(j, 0));
        }
    }
    entries
}
