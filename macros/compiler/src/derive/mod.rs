//! The third stage: from the model to its formulas, by calculus on matrices and groups.
//!
//! Everything is derived from one discrete Lagrangian ℓd(q, F) = K(F) + U₀(q) + U₁(Φ_F q), the cost with the potential placed by
//! the order, in the form of the discrete Clebsch problem that holds for every group: solve T* ∂_F K = N + J(q, ∂U₀) for F, move,
//! and let N⁺ = Ad* of the left side plus J(q⁺, ∂U₁).

mod action;
mod discrete_lagrangian;
mod energy;
mod equation;
mod print;
mod reference;
mod symbols;

use std::cell::OnceCell;

use clebsch_symbolic::Expr;

use crate::diagnostic::Diagnostics;
use crate::model::Model;

pub(crate) use action::generator_columns;
pub use discrete_lagrangian::DiscreteLagrangian;
pub use equation::{ClosedForm, Equation, Solution};
pub use print::Formula;
pub use reference::Reference;
pub use symbols::Symbols;

/// What is derived, as matrix expressions.
pub struct Formulas<'g> {
    /// The model that all of it is derived from.
    pub model: Model<'g>,
    /// The symbols that the derivation adds to those of the model.
    pub symbols: Symbols<'g>,
    /// The infinitesimal generator ξ_Q(q), for each leaf of the configuration.
    pub generator: Vec<Expr<'g>>,
    /// Whether only the identity fixes a general configuration.
    pub is_free: bool,
    /// J(q, p), for each factor.
    pub momentum_map: Vec<Expr<'g>>,
    /// Ad*_F μ, for each factor.
    pub coadjoint: Vec<Expr<'g>>,
    /// (TΦ_F)^{-*} p as a function of F, q⁺ and p, for each leaf of the configuration.
    pub cotangent_lift: Vec<Expr<'g>>,
    /// Σ, the Hessian of ℓ(ξ) in the components of all factors.
    pub inertia: Expr<'g>,
    /// ½ ξ·Σξ.
    pub kinetic_energy: Expr<'g>,
    /// V(q), that of the cost included.
    pub potential_energy: Expr<'g>,
    /// The declared discrete Lagrangian.
    pub lagrangian: DiscreteLagrangian<'g>,
    /// F⁻ℓd(q, F) for each factor: T* ∂_F K − J(q, ∂U₀).
    pub legendre: Vec<Expr<'g>>,
    /// F⁺ℓd(q, F) for each factor without its last kick: the other trivialisation of ∂_F K.
    pub legendre_next: Vec<Expr<'g>>,
    /// J(q, ∂U₁), the last kick of F⁺ℓd, to be taken at q⁺; `None` if there is none.
    pub legendre_kick: Option<Vec<Expr<'g>>>,
    /// The substeps of a step and, behind the two of a composed one, the declared Lagrangian itself, whose Legendre transform is to be
    /// inverted: one of the whole length, or two of half the length where the Lagrangian is not time-symmetric.
    pub substeps: Vec<Substep<'g>>,
    /// All of it as text, made when it is first asked for.
    listing: OnceCell<Vec<Formula>>,
}

/// One discrete Lagrangian with what a step of it needs.
pub struct Substep<'g> {
    /// Its part of the step: h is to be read as h divided by this.
    pub parts: i64,
    /// The discrete Lagrangian, in terms of the whole step h.
    pub lagrangian: DiscreteLagrangian<'g>,
    /// J(q, ∂U₀(q)) for each factor, before the solve; `None` if there is none.
    pub start: Option<Vec<Expr<'g>>>,
    /// J(q, ∂U₁(q)) for each factor, after the move; `None` if there is none.
    pub end: Option<Vec<Expr<'g>>>,
    /// The momentum equations, each for the factors that depend on each other.
    pub equations: Vec<Equation<'g>>,
    /// For each factor: whether N⁺ = M, because both trivialisations of ∂_F K agree.
    pub unchanged: Vec<bool>,
}

/// Derives the formulas of a model.
///
/// # Errors
/// A kinetic part that is degenerate, does not scale like an action, is not quadratic, or couples q and F.
pub fn derive(model: Model<'_>) -> Result<Formulas<'_>, Diagnostics> {
    let symbols = Symbols::new(&model);
    let generator = action::generator(&model, &symbols);
    let momentum_map = action::momentum_map(&symbols, &generator);
    let cost = discrete_lagrangian::kinetic_cost(&model)?;
    let kinetic_energy = energy::kinetic(&model, &symbols, cost)?;
    let lagrangian = discrete_lagrangian::separate(&model, cost)?;
    let potential_energy = energy::potential(&model, &lagrangian)?;
    let inertia = energy::inertia(&symbols, kinetic_energy);
    let sources =
        |parts| equation::Sources { model: &model, symbols: &symbols, momentum_map: &momentum_map, inertia, parts };
    let substeps = discrete_lagrangian::substeps(&model, &lagrangian)
        .into_iter()
        .map(|(parts, lagrangian)| substep(&sources(parts), lagrangian))
        .collect();
    let impulse = |potential| action::impulse(&model, &symbols, &momentum_map, potential);
    let (legendre_kick, start) = (impulse(lagrangian.end), impulse(lagrangian.start));
    let (legendre, legendre_next) = legendre(&model, &lagrangian, start);
    Ok(Formulas {
        legendre,
        legendre_next,
        legendre_kick,
        listing: OnceCell::new(),
        is_free: action::is_free(&model, &symbols, &generator),
        coadjoint: action::coadjoint(&model, &symbols),
        cotangent_lift: action::cotangent_lift(&model, &symbols),
        inertia,
        model,
        symbols,
        generator,
        momentum_map,
        kinetic_energy,
        potential_energy,
        lagrangian,
        substeps,
    })
}

fn substep<'g>(sources: &equation::Sources<'_, 'g>, lagrangian: DiscreteLagrangian<'g>) -> Substep<'g> {
    let model = sources.model;
    let impulse = |potential: Expr<'g>| action::impulse(model, sources.symbols, sources.momentum_map, potential);
    let (before, after): (Vec<_>, Vec<_>) =
        (0..model.factors.len()).map(|k| equation::trivialisations(model, lagrangian.kinetic, k)).unzip();
    Substep {
        parts: sources.parts,
        start: impulse(lagrangian.start),
        end: impulse(lagrangian.end),
        equations: equation::equations(sources, &before),
        unchanged: equation::agreement(model, &before, &after),
        lagrangian,
    }
}

impl Formulas<'_> {
    /// The number of substeps that make a step: two where ℓd is composed with its adjoint.
    pub fn parts(&self) -> usize {
        if self.substeps.len() == 1 { 1 } else { 2 }
    }
}

/// F⁻ℓd, and F⁺ℓd without its last kick, of the declared discrete Lagrangian.
fn legendre<'g>(
    model: &Model<'g>,
    lagrangian: &DiscreteLagrangian<'g>,
    start: Option<Vec<Expr<'g>>>,
) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    let transforms = model.factors.iter().enumerate().map(|(k, factor)| {
        let (before, after) = equation::trivialisations(model, lagrangian.kinetic, k);
        let (before, after) = (before.components(factor.group.algebra()), after.components(factor.group.algebra()));
        (start.as_ref().map_or(before, |start| before - start[k]), after)
    });
    transforms.unzip()
}
