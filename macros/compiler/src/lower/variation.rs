//! The kernels of variations: motions of configurations, and edges with their second derivatives.

use super::made::{of_matrices, of_row};
use super::{Hoisted, Hoisting, Kernel, Scalars, matrices};
use crate::derive::{EdgeDerivatives, EdgeMatrices, Formulas, Id, MatrixForm};

/// The kernels that variations need beside those of the step.
pub struct VariationKernels {
    /// τ(x) − I of each factor, from chart coordinates, then τ(−x) − I of each.
    pub retractions: Kernel,
    /// For each component of ξ, the chart coordinate of exp ξ to first order.
    pub slopes: Vec<(i64, i64)>,
    /// The increment of a motion by F and then by another.
    pub compose: Kernel,
    /// ξ_Q(q).
    pub generator: Kernel,
    /// GᵀG of G: ξ ↦ ξ_Q(q).
    pub orbit_metric: Kernel,
    /// The edges of a step.
    pub edges: Vec<EdgeKernels>,
}

/// The kernels of an edge.
pub struct EdgeKernels {
    /// ℓd, F⁻ℓd, F⁺ℓd, ∂F⁻ℓd/∂η, ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′, and ∂F⁺ℓd/∂η where it is not −(∂F⁻ℓd/∂η′)ᵀ: matrices, or with whole matrices what they make of one motion.
    pub edge: Kernel,
    /// ℓd, F⁻ℓd, F⁺ℓd.
    pub momenta: Kernel,
    /// F⁺ℓd; Ad, ∂F⁻ℓd and ∂F⁺ℓd for motions that leave F as it is; ∂F⁻ℓd/∂η′, ∂F⁺ℓd/∂η′.
    pub carried: Kernel,
    /// The derivatives of F⁻ℓd and of F⁺ℓd with respect to the quantities that are fixed during a step.
    pub slopes: Option<Kernel>,
}

/// The kernels of variations, where they are asked for.
pub(super) fn variations(
    formulas: &Formulas<'_>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Option<VariationKernels> {
    if !formulas.model.has_variations() {
        return None;
    }
    let edges = formulas.substeps.iter().take(formulas.stepped).filter_map(|substep| substep.variation.as_ref());
    Some(VariationKernels {
        retractions: of_row(formulas, Id::Retraction, scalars),
        slopes: formulas.slopes_of_retraction(),
        compose: of_row(formulas, Id::Composition, scalars),
        generator: of_row(formulas, Id::Generator, scalars),
        orbit_metric: orbit_metric(formulas, scalars),
        edges: edges.map(|variation| edge(formulas, variation, scalars, hoisted)).collect(),
    })
}

/// J(q, (E_j)_Q(q)), column by column; with whole matrices J(q, ξ_Q(q)).
pub(super) fn orbit_metric(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    match formulas.value(Id::OrbitMetric).filter(|_| scalars.keeps_matrices) {
        Some(momenta) => matrices::stack(momenta),
        None => of_matrices(scalars, &[formulas.orbit_metric()], Hoisting::Nothing),
    }
}

fn edge<'g>(
    formulas: &Formulas<'g>,
    variation: &EdgeDerivatives<'g>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> EdgeKernels {
    let EdgeMatrices { momenta, derivatives, carried, slopes } =
        formulas.edge_matrices(variation, scalars.keeps_matrices);
    let mut made = |matrices: &[MatrixForm<'_>]| of_matrices(scalars, matrices, Hoisting::Constants(hoisted));
    EdgeKernels {
        momenta: made(&momenta),
        edge: made(&[momenta, derivatives].concat()),
        carried: made(&carried),
        slopes: slopes.map(|slopes| made(&slopes)),
    }
}
