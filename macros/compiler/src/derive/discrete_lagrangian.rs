//! The discrete Lagrangian ℓd(t, h, q, F) = K(t, h, q, F) + U₀(t, q) + U₁(t + h, Φ_F q). It is separated, tested for
//! time symmetry, and composed with its adjoint if the test fails.

use clebsch_symbolic::{Elements, Expr, IntoList, identity};

use super::symbols::{identities, images, logarithm, moved, moved_on};
use super::{exact, system, trivialisation, velocity};
use crate::diagnostic::Diagnostics;
use crate::model::{Discretization, Factor, Kinetic, Mechanics, Order, System};

/// ℓd = K(t, h, q, F) + U₀(t, q) + U₁(t + h, Φ_F q), with U₀ and U₁ written as functions of a configuration and of its time.
#[derive(Copy, Clone, PartialEq, Eq)]
pub struct DiscreteLagrangian<'g> {
    /// K, a function of F (and of h and t) alone unless it couples.
    pub kinetic: Expr<'g>,
    /// K as a function of both ends, with q⁺ as symbols where it reads Φ_F(q).
    pub by_ends: Expr<'g>,
    /// U₀(t, q), at the start of the step.
    pub start: Expr<'g>,
    /// U₁(t, q), at its end.
    pub end: Expr<'g>,
    /// Whether K depends on the configuration.
    pub couples: bool,
}

/// A cost K(t, h, q, F), and the same with symbols for q⁺ = Φ_F(q).
#[derive(Copy, Clone, PartialEq, Eq)]
pub(super) struct Cost<'g> {
    /// K(t, h, q, F).
    pub kinetic: Expr<'g>,
    /// K(t, h, q, q⁺, F).
    pub by_ends: Expr<'g>,
}

impl<'g> Cost<'g> {
    fn plain(kinetic: Expr<'g>) -> Cost<'g> {
        Cost { kinetic, by_ends: kinetic }
    }
}

/// The cost K(t, h, q, F), as declared or from a Lagrangian. The latter gives h ℓ(ξ) or h/2 (ℓ(q, ξ) + ℓ(Φ_F q, ξ)),
/// with the velocity ξ computed from F and h. If the group leaves ℓ invariant, both are h ℓ(q, ξ), as Ad_F ξ = ξ.
pub(super) fn cost<'g>(model: &Mechanics<'g>) -> Result<Cost<'g>, Diagnostics> {
    let (energy, velocities, discretization) = match &model.kinetic {
        Kinetic::Cost(cost) => return Ok(Cost::plain(*cost)),
        Kinetic::Lagrangian { energy, velocities, discretization, .. } => (*energy, velocities, *discretization),
    };
    let h = model.step_size;
    if discretization == Discretization::Exact {
        exact::check(model, energy, velocities)?;
    }
    let mut discrete = Vec::new();
    for (k, symbol) in velocities.iter().enumerate() {
        discrete.push((*symbol, velocity::of_element(model, k, h, exact::stand_in(model, k, discretization))));
    }
    let at = |energy: Expr<'g>| match discretization {
        Discretization::MoserVeselov => velocity::moser_veselov(model, energy, velocities),
        _ => Ok(h * energy.substitute(&discrete)),
    };
    let is_steady = !energy.depends_on(model.time);
    let is_same_at_both_ends = || {
        let commutes = matches!(discretization, Discretization::Cayley | Discretization::Exponential);
        commutes && system::is_invariant(model, energy, velocities)
    };
    if is_steady && (!model.reads_configuration(energy) || is_same_at_both_ends()) {
        return at(energy).map(Cost::plain);
    }
    let start = at(energy)?;
    let mut arrived: Vec<_> = model.configurations.iter().map(|leaf| leaf.symbol).zip(images(model)).into_list();
    arrived.push((model.time, model.time + h));
    let kinetic = (start + at(energy.substitute(&moved_on(model)))?) / 2;
    Ok(Cost { kinetic, by_ends: (start + at(energy.substitute(&arrived))?) / 2 })
}

/// Separates the cost into a part of F and a part of q where it is such a sum, and places the potential.
pub(super) fn separate<'g>(model: &Mechanics<'g>, cost: Cost<'g>) -> DiscreteLagrangian<'g> {
    let Cost { kinetic: cost, by_ends } = cost;
    let static_part = cost.substitute(&identities(model));
    let difference = cost - static_part;
    let kinetic = if model.reads_configuration(difference) { difference.expand() } else { difference };
    // −h/2 V at both ends of a step of second order, −h V at the end of one of first order
    let (h, zero) = (model.step_size, model.graph.integer(0));
    let (start, end) = match (model.potential, model.order) {
        (None, _) => (zero, zero),
        (Some(potential), Order::First) => (zero, -(h * potential)),
        (Some(potential), _) => (-(h * potential / 2), -(h * potential / 2)),
    };
    if model.reads_configuration(kinetic) {
        return DiscreteLagrangian { kinetic: cost, by_ends, start, end, couples: true };
    }
    let start = if model.reads_configuration(static_part) { start + static_part } else { start };
    DiscreteLagrangian { kinetic, by_ends: kinetic, start, end, couples: false }
}

impl<'g> DiscreteLagrangian<'g> {
    /// −ℓd(t + h, −h, Φ_F q, F⁻¹), whose scheme is the adjoint.
    pub fn adjoint(&self, model: &System<'g>) -> DiscreteLagrangian<'g> {
        let h = model.step_size;
        let inverse = |factor: &Factor<'g>| (factor.symbol, factor.group.inverse(factor.symbol));
        let mut reversed: Vec<_> = model.factors.each(inverse);
        reversed.extend((0..model.factors.len()).map(|k| logarithm(model, k)).map(|y| (y, -y)));
        reversed.extend([(h, -h), (model.time, model.time + h)]);
        let leaves = model.configurations.iter().map(|leaf| leaf.symbol).zip(images(model));
        let exchanged = leaves.flat_map(|(q, image)| [(q, image), (image, q)]);
        let by_ends: Vec<_> = reversed.iter().copied().chain(exchanged).into_list();
        reversed.extend(moved(model));
        let reversed = -self.kinetic.substitute(&reversed);
        // it is often the same function at the other end of the step, as it was written
        let later = self.kinetic.substitute(&[(model.time, model.time + h)]);
        let is_same = self.couples && identity::equal(&[reversed], &[later]);
        let kinetic = if is_same { later } else { reversed };
        // in a cost of q and F alone, F⁻¹ cancels in F⁻¹ Φ_F(q), and does not with a symbol for q⁺
        let is_plain = self.by_ends == self.kinetic;
        DiscreteLagrangian {
            kinetic,
            by_ends: if is_plain { kinetic } else { -self.by_ends.substitute(&by_ends) },
            start: -self.end.substitute(&[(h, -h)]),
            end: -self.start.substitute(&[(h, -h)]),
            couples: self.couples,
        }
    }

    /// The Lagrangian with half of U₀ + U₁ at each end. Its step is that of ℓd between two shifts of the momentum by
    /// ½J(q, ∂(U₁ − U₀)). The shifts cancel from one step to the next, so both make the same configurations.
    pub(super) fn balanced(&self) -> DiscreteLagrangian<'g> {
        let half = (self.start + self.end) / 2;
        DiscreteLagrangian { start: half, end: half, ..*self }
    }

    /// Whether ℓd is its own adjoint, up to terms that no variation sees: K(h, F) = −K(−h, F⁻¹), and likewise for the
    /// potentials.
    pub fn is_time_symmetric(&self, model: &System<'g>) -> bool {
        let adjoint = self.adjoint(model);
        let leaves = || model.configurations.iter().map(|leaf| leaf.symbol);
        let potentials = |lagrangian: &DiscreteLagrangian<'g>| -> Vec<Expr<'g>> {
            leaves().flat_map(|q| [lagrangian.start.gradient(q), lagrangian.end.gradient(q)]).into_list()
        };
        let variations = |kinetic: Expr<'g>| -> Vec<Expr<'g>> {
            let (before, _) = trivialisation::of_all(model, kinetic);
            let factors = trivialisation::components(model, &before).into_iter();
            factors.chain(leaves().map(|q| kinetic.gradient(q))).into_list()
        };
        // log F = Ad_F log F, which functions of log F and F do not know
        let carry = |(factor, k): (&Factor<'g>, usize)| {
            let y = logarithm(model, k);
            (y, system::adjoint(factor, y))
        };
        let carried: Vec<_> = model.factors.iter().zip(0..).map(carry).into_list();
        let kinetic = identity::equal(&[self.kinetic], &[adjoint.kinetic])
            || identity::equal(&[self.kinetic], &[adjoint.kinetic.substitute(&carried)])
            || identity::equal(&variations(self.kinetic), &variations(adjoint.kinetic));
        kinetic && identity::equal(&potentials(self), &potentials(&adjoint))
    }

    /// The Lagrangian of a part of the step. Its step size is `step` in place of `h`, and it starts `later` than the
    /// step.
    fn of_part(&self, model: &System<'g>, step: Expr<'g>, later: Expr<'g>) -> DiscreteLagrangian<'g> {
        let scaled = |part: Expr<'g>| part.substitute(&[(model.step_size, step)]);
        let at_part = |part: Expr<'g>| part.substitute(&[(model.step_size, step), (model.time, model.time + later)]);
        DiscreteLagrangian {
            kinetic: at_part(self.kinetic),
            by_ends: at_part(self.by_ends),
            start: scaled(self.start),
            end: scaled(self.end),
            couples: self.couples,
        }
    }
}

/// The discrete Lagrangians whose steps make one step, with the number of parts of the step. If ℓd has the required
/// order, it is ℓd itself. Otherwise the parts are half a step of ℓd and half a step of its adjoint. ℓd itself follows
/// them, since its Legendre transform is inverted.
///
/// The order is a property of the motion of q, so it is that of the declared Lagrangian, without a vertical term.
pub(super) fn substeps<'g>(
    model: &Mechanics<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    declared: &DiscreteLagrangian<'g>,
) -> Vec<(i64, DiscreteLagrangian<'g>)> {
    if model.order == Order::First || declared.is_time_symmetric(model) {
        return vec![(1, *lagrangian)];
    }
    let (half, now) = (model.step_size / 2, model.graph.integer(0));
    let first = lagrangian.of_part(model, half, now);
    let second = lagrangian.adjoint(model).of_part(model, half, half);
    vec![(2, first), (2, second), (1, *lagrangian)]
}
