//! The kernels of a choice of inputs: the step that inputs make, price, bounds and the price of the end, each with its derivatives.

use super::made::{of_matrices, of_row, plain, stack};
use super::variation::orbit_metric;
use super::{Hoisting, Kernel, Scalars};
use crate::derive::{Bend, Choice, Formulas, Id, MatrixForm};

/// The kernels of a choice of inputs.
pub struct ControlKernels {
    /// The step that inputs make by themselves; `None` where they are those of forces.
    pub step: Option<StepOfInputs>,
    /// What choosing the inputs of forces needs of an edge.
    pub bend: Option<BendKernels>,
    /// GᵀG of G: ξ ↦ ξ_Q(q).
    pub orbit_metric: Kernel,
    /// J(q, q⁺ − q).
    pub approach: Kernel,
    /// ℓ.
    pub price: Kernel,
    /// Where forces take the inputs: ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives.
    pub price_expanded: Option<Kernel>,
    /// What price and step gain with h and with t.
    pub price_of_time: Kernel,
    /// a.
    pub bounds: Kernel,
    /// a, ∂a/∂η, ∂a/∂u and the second derivatives of z·a.
    pub bounds_expanded: Kernel,
}

/// The kernels of the price of the end.
pub struct EndpointKernels {
    /// φ.
    pub price: Kernel,
    /// φ, ∂φ/∂t, ∂φ/∂η, ∂²φ/∂η².
    pub expanded: Kernel,
}

/// The kernels of F(t, h, q, u).
pub struct StepOfInputs {
    /// F − I.
    pub increment: Kernel,
    /// Φ_F(q).
    pub advance: Kernel,
    /// A, B, ℓ, ∂ℓ/∂η, ∂ℓ/∂u and the second derivatives of ℓ + λ·η′.
    pub expand: Kernel,
}

/// The kernels of an edge with forces.
pub struct BendKernels {
    /// ∂F⁻ℓd/∂u and ∂F⁺ℓd/∂u.
    pub by_input: Kernel,
    /// The second derivatives of β·F⁺ℓd + κ·F⁻ℓd along the motions that leave F as it is, those of q⁺ alone, and the inputs.
    pub curvature: Kernel,
    /// ± ½ μ·[E_i, E_j].
    pub bracket: Kernel,
}

/// The kernels of a choice, where there is one.
pub(super) fn control(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<ControlKernels> {
    let choice = formulas.choice()?;
    let (steering, bend) = (choice.steering, choice.bend);
    let step = steering.step.as_ref().map(|step| step_of_inputs(formulas, &choice.step_expanded(step), scalars));
    let bend = bend.map(|bend| bend_kernels(&choice, bend, scalars));
    let orbit_metric = orbit_metric(formulas, scalars);
    let approach = stack(scalars, &steering.approach, Hoisting::Nothing);
    let price = plain(scalars, &[steering.price.value]);
    let price_expanded = bend.as_ref().map(|_| made(scalars, &choice.price_expanded()));
    let price_of_time = made(scalars, &[choice.price_of_time()]);
    let bounds = stack(scalars, formulas.value(Id::Bounds).unwrap_or_default(), Hoisting::Nothing);
    let bounds_expanded = made(scalars, &choice.bounds_expanded());
    Some(ControlKernels {
        step,
        bend,
        orbit_metric,
        approach,
        price,
        price_expanded,
        price_of_time,
        bounds,
        bounds_expanded,
    })
}

/// The kernels of the price of the end, where there is one.
pub(super) fn endpoint(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<EndpointKernels> {
    let endpoint = formulas.endpoint.as_ref()?;
    let expanded = made(scalars, &formulas.endpoint_expanded(endpoint));
    Some(EndpointKernels { price: plain(scalars, &[endpoint.price.value]), expanded })
}

fn made(scalars: &mut Scalars, matrices: &[MatrixForm<'_>]) -> Kernel {
    of_matrices(scalars, matrices, Hoisting::Nothing)
}

fn step_of_inputs(formulas: &Formulas<'_>, expanded: &[MatrixForm<'_>], scalars: &mut Scalars) -> StepOfInputs {
    let expand = made(scalars, expanded);
    let increment = of_row(formulas, Id::Increment, scalars);
    StepOfInputs { increment, advance: of_row(formulas, Id::Advance, scalars), expand }
}

fn bend_kernels<'g>(choice: &Choice<'_, 'g>, bend: &Bend<'g>, scalars: &mut Scalars) -> BendKernels {
    let by_input = made(scalars, &choice.by_input(bend));
    let curvature = made(scalars, &[choice.bend_curvature(bend)]);
    BendKernels { by_input, curvature, bracket: made(scalars, &[choice.bracket(bend)]) }
}
