//! Constraints, by the discrete principle of Lagrange and d'Alembert: a(t, q) ξ = b(t, q) on the velocity, or φ(t, q) = 0.
//!
//! The rows A of a step are those at q: a itself, or J(q, ∂φ). A step solves r(F) = N + Aᵀλ with ψ(q, F) = 0. For
//! velocities ψ = A ξ(F)/h − b is taken between both ends. For places it is φ(t + h, Φ_F q)/h, and b is −∂φ/∂t. After
//! the move, N⁺ = F⁺ℓd + A(q⁺)ᵀμ with A Σ⁻¹N⁺ = b at q⁺, a linear system for μ.
//!
//! The multipliers λ are no unknowns of the equation. With y = r(F) − N and S = A Σ⁻¹Aᵀ, the residual is
//!
//! ```text
//! ρ = y − Aᵀλ,    λ = S⁻¹(A Σ⁻¹y − ψ)
//! ```
//! A Σ⁻¹ρ = ψ, so ρ = 0 says that ψ vanishes and that y = Aᵀλ. At F = I the slope of ρ is that without a constraint,
//! as A Σ⁻¹ Dr = Dψ there.
//!
//! The multipliers of a push p = Aᵀκ are κ = S⁻¹A Σ⁻¹p. Those of the continuous motion, N′ = N′_free + Aᵀλ, follow from
//! the derivative of the constraint: S λ = −d/dt (A ξ − b) along N′_free.
//!
//! A place comes to φ = 0 by motions with x = −s Σ⁻¹Aᵀ S⁻¹φ, where s = dx/dξ at the identity. This is Newton's method with the
//! motion that is shortest in the kinetic energy.

use clebsch_symbolic::{Elements, Expr, IntoList, Shape, identity};

use super::energy::Energy;
use super::exact::{self, inertia_inverse};
use super::symbols::{Images, after_step, logarithm, moved};
use super::{DiscreteLagrangian, SystemFormulas, force, structure};
use crate::diagnostic::{Diagnostics, bail};
use crate::model::features::{self, Feature, Found};
use crate::model::{Configuration, Constraint, Equation, Factor, Isotropy, LeafSpace, Mechanics, Side, VelocityRows};

/// The formulas of a constraint.
pub struct ConstraintFormulas<'g> {
    /// A(t, q).
    pub rows: Expr<'g>,
    /// b(t, q).
    pub values: Expr<'g>,
    /// ψ(t, q, F), with the time t at which a step starts.
    pub between: Expr<'g>,
    /// A Σ⁻¹.
    pub by_inertia: Expr<'g>,
    /// Σ and Σ⁻¹.
    pub inertia: [Expr<'g>; 2],
    /// S = A Σ⁻¹Aᵀ.
    pub metric: Expr<'g>,
    /// The velocity Σ⁻¹(μ − A_g) of a momentum, with the momentum A_g of velocity zero.
    pub velocity: Expr<'g>,
    /// The momentum Σξ + A_g of a velocity.
    pub momentum: Expr<'g>,
    /// A Σ⁻¹p of a push p, with μ standing for p.
    pub along: Expr<'g>,
    /// −d/dt (A ξ − b) along the motion without the constraint, a function of t, q, μ and the input u.
    pub lag: Expr<'g>,
    /// The part of it that is on places.
    pub places: Option<PlaceFormulas<'g>>,
    /// The equations of velocities that are those of places, by their rows among these; all of them, or single ones.
    pub of_places: Vec<usize>,
    /// The rows of velocities between both ends are the mean of those at the ends, not those at the mean of the ends.
    pub is_mean_of_rows: bool,
}

/// The formulas of a constraint on places alone.
pub struct PlaceFormulas<'g> {
    /// φ(t, q).
    pub value: Expr<'g>,
    /// A = J(q, ∂φ).
    pub rows: Expr<'g>,
    /// S = A Σ⁻¹Aᵀ.
    pub metric: Expr<'g>,
    /// s Σ⁻¹Aᵀ: chart coordinates of the motion that a push makes.
    pub moved: Expr<'g>,
}

impl<'g> PlaceFormulas<'g> {
    fn new(system: &SystemFormulas<'g>, value: Expr<'g>, inverse: Expr<'g>) -> PlaceFormulas<'g> {
        let rows = rows_of_places(system, value);
        let by_inertia = product(rows, inverse);
        let metric = product(by_inertia, rows.transpose());
        PlaceFormulas { value, rows, metric, moved: coordinates_of_motion(system, by_inertia.transpose()) }
    }
}

impl<'g> ConstraintFormulas<'g> {
    /// The formulas of the constraint of a model; `None` if it has none.
    ///
    /// # Errors
    /// A kinetic energy, a discretization or an action that does not go with it.
    pub(super) fn of(
        model: &Mechanics<'g>,
        system: &SystemFormulas<'g>,
        (energy, inertia): (&Energy<'g>, Expr<'g>),
        (potential, force): (Expr<'g>, Option<&[Expr<'g>]>),
    ) -> Result<Option<ConstraintFormulas<'g>>, Diagnostics> {
        let Some(constraint) = &model.constraint else { return Ok(None) };
        check(model, system, energy)?;
        let inverse = inverse(system, inertia);
        let places = constraint.places.map(|value| PlaceFormulas::new(system, value, inverse));
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        if let Some(PlaceFormulas { value, rows: of_places, .. }) = places {
            let later = (model.time, model.graph.integer(1));
            rows.push(of_places);
            values.push(-value.differential(&[later]));
        }
        let mut is_mean = false;
        if let Some(VelocityRows { rows: of_velocities, values: of_rows }) = constraint.velocities {
            is_mean = is_mean_of_rows(model, [of_velocities, of_rows]);
            rows.push(of_velocities);
            values.push(of_rows);
        }
        let [rows, values] = [rows, values].map(|parts| model.graph.below(&parts));
        let between = between(model, constraint, is_mean, &moved(model));
        check_rows(constraint, rows)?;
        let by_inertia = product(rows, inverse);
        let gyroscopic = system.symbols.slope(energy.gyroscopic);
        let momenta = model.graph.below(&system.symbols.momenta);
        let velocity = inverse * (momenta - gyroscopic);
        let pushing = if system.is_moving(inertia) { energy.kinetic } else { model.graph.integer(0) };
        let free = free_motion(model, system, (pushing + energy.gyroscopic - potential, force), velocity);
        Ok(Some(ConstraintFormulas {
            rows,
            values,
            between,
            by_inertia,
            inertia: [inertia, inverse],
            metric: product(by_inertia, rows.transpose()),
            velocity,
            along: by_inertia * momenta,
            lag: -(rows * velocity - values).differential(&free),
            momentum: system.symbols.slope(energy.kinetic) + gyroscopic,
            places,
            of_places: constraint.velocities.map_or_else(Vec::new, |rows| of_places(model, system, rows)),
            is_mean_of_rows: is_mean,
        }))
    }

    /// ψ(t, q, F), with these images Φ_F(q).
    pub(super) fn between_by(&self, model: &Mechanics<'g>, images: &Images<'g>) -> Expr<'g> {
        model
            .constraint
            .as_ref()
            .map_or(self.between, |constraint| between(model, constraint, self.is_mean_of_rows, images))
    }

    /// y − Aᵀ S⁻¹(A Σ⁻¹y − ψ).
    pub(super) fn residual(&self, difference: Expr<'g>, between: Expr<'g>) -> Expr<'g> {
        difference - self.pushed(self.by_inertia * difference - between)
    }

    /// Aᵀλ = Aᵀ S⁻¹A Σ⁻¹y, the force of the constraint at a solution.
    pub(super) fn reaction(&self, difference: Expr<'g>) -> Expr<'g> {
        self.pushed(self.by_inertia * difference)
    }

    /// Aᵀμ with A Σ⁻¹(N + Aᵀμ − A_g) = b.
    pub(super) fn projection(&self) -> Expr<'g> {
        self.pushed(self.values - self.rows * self.velocity)
    }

    /// Aᵀ S⁻¹ν.
    fn pushed(&self, along: Expr<'g>) -> Expr<'g> {
        let solved = if self.metric.shape().is_scalar() { along / self.metric } else { self.metric.inverse() * along };
        self.rows.transpose() * solved
    }
}

/// The rows of velocities that are those of some φ(q) = c, by Frobenius' theorem. They are all of them if the velocities that
/// they allow are closed under brackets. Else each row is tried alone. Rows with a time or a value are none.
///
/// A row a is a one-form with a(X_i) = a_i on the motions X_i of the basis. Its derivative is
///
/// ```text
/// da(X_i, X_j) = X_i(a_j) − X_j(a_i) − a([X_i, X_j]),    [X_i, X_j] = ± the motion of [E_i, E_j]
/// ```
/// It has to vanish on the velocities with a ξ = 0. Bordered by the R rows, da has the rank 2R then.
fn of_places<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    VelocityRows { rows, values }: VelocityRows<'g>,
) -> Vec<usize> {
    let Shape { rows: count, columns } = rows.shape();
    if rows.depends_on(model.time) || !identity::vanishes(values) {
        return Vec::new();
    }
    let row = |i: usize| rows.block(i, 0, Shape::new(1, columns));
    let derivative = |i: usize| {
        let form = row(i).transpose();
        let moved = system.symbols.slopes(form.differential(&system.leaves_by_generator()));
        let parts = system.parted(form).into_iter().zip(&model.factors).zip(&system.symbols.algebra);
        let brackets = parts.map(|((part, factor), xi)| {
            let bracket = factor.group.ad(*xi).transpose() * part;
            if factor.side == Side::Left { bracket } else { -bracket }
        });
        let brackets = system.symbols.slopes(model.graph.below(&brackets.into_list()));
        (moved + brackets).transpose() - moved
    };
    let is_closed = |own: &[usize]| {
        let all = model.graph.below(&own.each(|&i| row(i)));
        let none = model.graph.zero(Shape::square(own.len()));
        let border = model.graph.beside(&[all, none]);
        own.iter().all(|&i| {
            let bordered = model.graph.below(&[model.graph.beside(&[derivative(i), all.transpose()]), border]);
            identity::rank(bordered) == 2 * own.len()
        })
    };
    let every: Vec<usize> = (0..count).into_list();
    if is_closed(&every) { every } else { every.into_iter().filter(|&i| is_closed(&[i])).into_list() }
}

/// s ξ in the charts, for each column ξ.
pub(super) fn coordinates_of_motion<'g>(system: &SystemFormulas<'g>, velocities: Expr<'g>) -> Expr<'g> {
    let shape = velocities.shape();
    let entry = |(i, j): (usize, usize)| {
        let block = system.symbols.blocks.iter().position(|block| block.components().contains(&i));
        let slope = block.map(|block| system.chart_slope(block));
        slope
            .map_or(velocities.entry(i, j), |(numerator, denominator)| numerator * velocities.entry(i, j) / denominator)
    };
    velocities.graph().stack(shape, shape.positions().map(entry).into_list())
}

/// The changes of t, q and N where no constraint acts, N′ = ± ad*_ξ N + J(q, ∂(T + A·ξ − V)) + f, with this ξ.
pub(super) fn free_motion<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    (pushing, force): (Expr<'g>, Option<&[Expr<'g>]>),
    velocity: Expr<'g>,
) -> Vec<(Expr<'g>, Expr<'g>)> {
    let (symbols, velocities) = (&system.symbols, system.parted(velocity));
    let mut at_velocity: Vec<_> = symbols.algebra.iter().copied().zip(velocities.iter().copied()).into_list();
    let of_force = model.force.iter().flat_map(|force| &force.velocities);
    at_velocity.extend(of_force.copied().zip(velocities.iter().copied()));
    let pushes = system.momenta_of(system.gradients(pushing));
    let change = |(k, factor): (usize, &Factor<'g>)| {
        let carried = factor.group.ad(velocities[k]).transpose() * symbols.momenta[k];
        let carried = if factor.side == Side::Left { -carried } else { carried };
        let pushed = force.map_or(pushes[k], |force| pushes[k] + force[k]);
        (symbols.momenta[k], carried + pushed.substitute(&at_velocity))
    };
    let mut changes: Vec<_> = model.factors.iter().enumerate().map(change).into_list();
    changes.push((model.time, model.graph.integer(1)));
    let leaves = model.configurations.iter().map(|leaf| leaf.symbol);
    changes.extend(leaves.zip(system.motion_by(&velocities)));
    changes
}

/// J(q, ∂φ): the change of φ along a motion of q, a row for each entry.
fn rows_of_places<'g>(system: &SystemFormulas<'g>, places: Expr<'g>) -> Expr<'g> {
    system.symbols.slopes(places.differential(&system.leaves_by_generator())).expand()
}

/// A product, entry by entry: zeros of both factors are left out.
pub(super) fn product<'g>(left: Expr<'g>, right: Expr<'g>) -> Expr<'g> {
    let shape = Shape::new(left.shape().rows, right.shape().columns);
    let entry = |(i, j): (usize, usize)| {
        let terms = (0..left.shape().columns).map(|k| left.entry(i, k) * right.entry(k, j));
        left.graph().total(Shape::scalar(), terms)
    };
    left.graph().stack(shape, shape.positions().map(entry).into_list())
}

/// Σ⁻¹, with the zeros that it has because coordinates uncouple. One that changes with the configuration or the time is a
/// formula; else it is a constant of the stepper.
pub(super) fn inverse<'g>(system: &SystemFormulas<'g>, inertia: Expr<'g>) -> Expr<'g> {
    let (graph, shape) = (inertia.graph(), inertia.shape());
    let moves = system.is_moving(inertia);
    let whole = inertia_inverse(graph, shape);
    let couples = |i: usize, j: usize| !identity::vanishes(inertia.entry(i, j));
    let sets = structure::connected(shape.rows, |i, j| couples(i, j) || couples(j, i));
    let inverses = sets.each(|set| {
        let shape = Shape::square(set.len());
        let own = |(i, j): (usize, usize)| inertia.entry(set[i], set[j]).expand();
        let solved = || graph.stack(shape, shape.positions().map(own).into_list()).inverse();
        (moves && set.len() > 1).then(solved)
    });
    let set = |i: usize| sets.iter().zip(&inverses).find(|(set, _)| set.contains(&i));
    let entry = |(i, j): (usize, usize)| {
        let Some((set, inverse)) = set(i) else { return whole.entry(i, j) };
        let position = |component: usize| set.iter().position(|other| *other == component);
        match (position(i).zip(position(j)), inverse) {
            (None, _) => graph.integer(0),
            (Some(_), _) if set.len() == 1 => graph.integer(1) / inertia.entry(i, i).expand(),
            (Some((row, column)), Some(inverse)) => inverse.entry(row, column),
            (Some(_), None) => whole.entry(i, j),
        }
    };
    graph.stack(shape, shape.positions().map(entry).into_list())
}

/// ψ(t, q, F), with these images Φ_F(q): those of places first.
fn between<'g>(
    model: &Mechanics<'g>,
    constraint: &Constraint<'g>,
    is_mean_of_rows: bool,
    moved: &Images<'g>,
) -> Expr<'g> {
    let places = constraint.places.map(|value| between_places(model, value, moved.clone()));
    let velocities = constraint.velocities.as_ref();
    let velocities = velocities.map(|rows| between_velocities(model, rows, is_mean_of_rows, moved.clone()));
    model.graph.below(&places.into_iter().chain(velocities).into_list())
}

/// ψ(t, q, F) of a constraint on places, φ(t + h, Φ_F q)/h.
fn between_places<'g>(model: &Mechanics<'g>, value: Expr<'g>, moved: Images<'g>) -> Expr<'g> {
    value.substitute(&after_step(model, moved)) / model.step_size
}

/// ψ(t, q, F) of a constraint on the velocity ξ(F)/h of a step, at the mean of both ends.
fn between_velocities<'g>(
    model: &Mechanics<'g>,
    VelocityRows { rows, values }: &VelocityRows<'g>,
    is_mean_of_rows: bool,
    moved: Images<'g>,
) -> Expr<'g> {
    let (graph, h) = (model.graph, model.step_size);
    let velocity = graph.below(&force::velocities_of_step(model, h));
    let at = |places: &[(Expr<'g>, Expr<'g>)]| rows.substitute(places) * velocity - values.substitute(places);
    if is_mean_of_rows {
        return (at(&[]) + at(&after_step(model, moved))) / 2;
    }
    let mean = moved.into_iter().map(|(q, image)| (q, (q + image) / 2));
    at(&mean.chain([(model.time, model.time + h / 2)]).into_list())
}

/// Whether the rows are no polynomial of a configuration that lies on a group or a sphere: the mean of two such
/// configurations does not.
fn is_mean_of_rows<'g>(model: &Mechanics<'g>, parts: [Expr<'g>; 2]) -> bool {
    let is_bent = |leaf: &Configuration<'g>| {
        let mut parts = parts.iter().filter(|part| part.depends_on(leaf.symbol));
        leaf.space != LeafSpace::Vectors && parts.any(|part| part.has_functions() || part.has_poles_in(&[leaf.symbol]))
    };
    model.configurations.iter().any(is_bent)
}

/// Every equation has a row, no row follows from others, and there are no more of them than components of the velocity.
fn check_rows<'g>(constraint: &Constraint<'g>, all: Expr<'g>) -> Result<(), Diagnostics> {
    let Shape { rows, columns } = all.shape();
    let (mut first, mut known) = (0, 0);
    for Equation { written, count, is_of_velocities } in &constraint.equations {
        let variable = if *is_of_velocities { "velocity" } else { "configuration" };
        let (place, text, last) = (written.place, &written.text, first + count);
        let is_zero = |i: &usize| identity::vanishes(all.block(*i, 0, Shape::new(1, columns)));
        if let Some(i) = (first..last).find(is_zero) {
            let which = if *count > 1 { format!("component {} of ", i - first) } else { String::new() };
            bail!(place, "{which}`{text}` does not depend on the {variable}";
                help "leave it out, or write the {variable} that it fixes";
                note "an equation that fixes nothing has no force")
        }
        if rows > columns {
            let places = constraint.equations.first().map_or(place, |first| first.written.place);
            bail!(places, "there are {rows} equations for a velocity of {columns} components";
                help "leave out those that follow from others")
        }
        let rank = identity::rank(all.block(0, 0, Shape::new(last, columns)));
        if rank < known + count {
            bail!(place, "`{text}` follows from the other equations, or contradicts them";
                help "leave it out";
                note "the rows of the constraint have rank {rank}, and there are {last} of them: their forces are not determined")
        }
        (first, known) = (last, rank);
    }
    Ok(())
}

/// The features of the kinetic energy and of the action that do not go with a constraint.
fn check<'g>(model: &Mechanics<'g>, system: &SystemFormulas<'g>, energy: &Energy<'g>) -> Result<(), Diagnostics> {
    let spans = &model.spans;
    check_system(model, system, energy)?;
    features::check((Feature::Constraint, Found::somewhere()), |feature| match feature {
        Feature::ExactDiscretization => exact::is_exact(model).then(|| Found::at(spans.kinetic.place)),
        Feature::OddVelocity if model.constraint.as_ref().is_some_and(|constraint| constraint.velocities.is_some()) => {
            let factor = model.factors.get(uneven(model)?)?;
            Some(Found::at(spans.kinetic.place).named(factor.group.name(model.graph)))
        }
        _ => None,
    })
}

/// The kinetic energies and the actions that go with no constraint, of velocities or of places.
pub(super) fn check_system<'g>(
    model: &Mechanics<'g>,
    system: &SystemFormulas<'g>,
    energy: &Energy<'g>,
) -> Result<(), Diagnostics> {
    let spans = &model.spans;
    let of_kinetic = |found: bool| found.then(|| Found::at(spans.kinetic.place));
    features::check((Feature::Constraint, Found::somewhere()), |feature| match feature {
        Feature::GeneralLagrangian => of_kinetic(energy.general.is_some()),
        Feature::FixedConfigurations => {
            let is_fixed = model.isotropy == Isotropy::Fixed && !system.is_free();
            is_fixed.then(|| Found::at(spans.action.place))
        }
        _ => None,
    })
}

/// A step with a constraint is the same forwards and backwards.
pub(super) fn check_adjoint<'g>(
    model: &Mechanics<'g>,
    substeps: &[(i64, DiscreteLagrangian<'g>)],
) -> Result<(), Diagnostics> {
    let is_joined = model.power.as_ref().is_some_and(|power| power.joints.is_some());
    let is_pair = (model.constraint.is_some() || is_joined) && substeps.len() > 1;
    features::check((Feature::Constraint, Found::somewhere()), |feature| {
        (is_pair && feature == Feature::AdjointPair).then(|| Found::at(model.spans.kinetic.place))
    })
}

/// The first factor whose velocity is not odd, ξ(F⁻¹) ≠ −ξ(F): a step back then obeys another constraint.
fn uneven(model: &Mechanics<'_>) -> Option<usize> {
    let velocities = force::velocities_of_step(model, model.step_size);
    (0..model.factors.len()).find(|&k| {
        let (factor, y) = (&model.factors[k], logarithm(model, k));
        let back = velocities[k].substitute(&[(factor.symbol, factor.group.inverse(factor.symbol)), (y, -y)]);
        !identity::equal(&[back], &[-velocities[k]])
    })
}
