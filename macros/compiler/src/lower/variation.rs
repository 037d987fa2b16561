//! The kernels of variations: motions of configurations, and edges with their second derivatives.

use clebsch_symbolic::{Expr, Shape};

use super::kernel::kernel;
use super::{Hoisted, Hoisting, Kernel, Scalar, Scalars, grids, matrices, plain};
use crate::derive::{Formulas, Variation, from_increment, increments, inserted, inverse_by};
use crate::model::Side;

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
    let edges = formulas.substeps.iter().take(formulas.parts).filter_map(|substep| substep.variation.as_ref());
    Some(VariationKernels {
        retractions: retractions(formulas, scalars),
        slopes: slopes(formulas),
        compose: compose(formulas, scalars),
        generator: plain(scalars, &formulas.generator),
        orbit_metric: orbit_metric(formulas, scalars),
        edges: edges.map(|variation| edge(formulas, variation, scalars, hoisted)).collect(),
    })
}

fn retractions(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let increment = |k: usize, forward: bool| {
        let group = formulas.model.factors[k].group;
        let coordinates = formulas.symbols.coordinates(k).into_iter();
        let coordinates: Vec<_> = coordinates.map(|x| if forward { x } else { -x }).collect();
        let (numerator, denominator) = formulas.retraction(k).increment(group, &coordinates);
        numerator / denominator
    };
    let factors = 0..formulas.model.factors.len();
    let increments = [true, false].into_iter().flat_map(|forward| factors.clone().map(move |k| (k, forward)));
    let increments: Vec<_> = increments.map(|(k, forward)| increment(k, forward)).collect();
    plain(scalars, &increments)
}

fn slopes(formulas: &Formulas<'_>) -> Vec<(i64, i64)> {
    let graph = formulas.model.graph;
    let of_factor = |k: usize| {
        let blocks = graph.blocks(formulas.model.factors[k].group);
        let chart = formulas.retraction(k);
        let slope = |block: &clebsch_symbolic::Block| {
            std::iter::repeat_n(chart.slope_at_identity(block), block.algebra.dimension())
        };
        blocks.iter().flat_map(slope).collect::<Vec<_>>()
    };
    (0..formulas.model.factors.len()).flat_map(of_factor).collect()
}

/// F₂ F₁ − I for a left action, F₁ F₂ − I for a right one, with F = I + D.
fn compose(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let symbols = &formulas.symbols;
    let product = |k: usize| {
        let factor = &formulas.model.factors[k];
        let [first, second] = [symbols.increments[k], symbols.following[k]].map(|d| from_increment(factor.group, d));
        let product = match factor.side {
            Side::Left => factor.group.compose(second, first),
            Side::Right => factor.group.compose(first, second),
        };
        (product - factor.group.identity(formulas.model.graph)).expand()
    };
    let products: Vec<_> = (0..formulas.model.factors.len()).map(product).collect();
    plain(scalars, &products)
}

/// J(q, (E_j)_Q(q)), column by column; with whole matrices J(q, ξ_Q(q)).
pub(super) fn orbit_metric(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    if scalars.keeps_matrices {
        let generators = formulas.generator.iter().copied();
        let covectors: Vec<_> = formulas.symbols.covectors.iter().copied().zip(generators).collect();
        let momenta = formulas.momentum_map.iter().map(|momentum| momentum.substitute(&covectors));
        return matrices::stack(&momenta.collect::<Vec<_>>());
    }
    let column = |element: &Vec<(Expr<'_>, Expr<'_>)>| {
        let velocities = formulas.generator.iter().map(|velocity| velocity.substitute(element));
        let covectors: Vec<_> = formulas.symbols.covectors.iter().copied().zip(velocities).collect();
        let momenta = formulas.momentum_map.iter().map(|momentum| momentum.substitute(&covectors).expand());
        let grids = grids(scalars, &momenta.collect::<Vec<_>>());
        grids.into_iter().flat_map(|(_, entries)| entries).collect()
    };
    let columns: Vec<Vec<Scalar>> = formulas.symbols.basis().iter().map(column).collect();
    kernel(scalars, &[matrix(&columns)], Hoisting::Nothing)
}

/// A matrix from its columns, with I + D put in for F.
pub(super) fn columns<'g>(
    columns: &[Expr<'g>],
    elements: &[(Expr<'g>, Expr<'g>)],
    scalars: &mut Scalars,
) -> (Shape, Vec<Scalar>) {
    let columns: Vec<_> = columns.iter().map(|column| inserted(*column, elements)).collect();
    let columns: Vec<_> = grids(scalars, &columns).into_iter().map(|(_, entries)| entries).collect();
    matrix(&columns)
}

/// A matrix from its columns.
fn matrix(columns: &[Vec<Scalar>]) -> (Shape, Vec<Scalar>) {
    let shape = Shape::new(columns.first().map_or(0, Vec::len), columns.len());
    (shape, shape.positions().map(|(i, j)| columns[j][i]).collect())
}

fn edge<'g>(
    formulas: &Formulas<'g>,
    variation: &Variation<'g>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> EdgeKernels {
    let elements = elements(formulas);
    if scalars.keeps_matrices {
        return edge_of_matrices(variation, &elements, scalars, hoisted);
    }
    let basis = formulas.symbols.basis();
    let columns_of = |block: Expr<'g>, scalars: &mut Scalars| {
        let block: Vec<_> = basis.iter().map(|element| block.substitute(element)).collect();
        columns(&block, &elements, scalars)
    };
    let values = [variation.lagrangian, variation.before, variation.after];
    let values = values.map(|value| inserted(value, &elements));
    let mut outputs = grids(scalars, &values);
    let momenta = kernel(scalars, &outputs, Hoisting::Constants(hoisted));
    let blocks = [variation.before_by_start, variation.before_by_end, variation.after_by_end];
    for block in blocks.into_iter().chain(variation.after_by_start) {
        outputs.push(columns_of(block, scalars));
    }
    let edge = kernel(scalars, &outputs, Hoisting::Constants(hoisted));
    let carried = &variation.carried;
    let mut outputs = grids(scalars, &[inserted(variation.after, &elements)]);
    let blocks = [carried.adjoint, carried.before, carried.after, variation.before_by_end, variation.after_by_end];
    outputs.extend(blocks.map(|block| columns_of(block, scalars)));
    let carried = kernel(scalars, &outputs, Hoisting::Constants(hoisted));
    EdgeKernels { edge, momenta, carried, slopes: slopes_of(variation, &elements, scalars, hoisted) }
}

/// The derivatives with respect to what is fixed during a step, each by itself.
fn slopes_of<'g>(
    variation: &Variation<'g>,
    elements: &[(Expr<'g>, Expr<'g>)],
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Option<Kernel> {
    variation.slopes.as_ref().map(|slopes| {
        let outputs = [columns(&slopes.before, elements, scalars), columns(&slopes.after, elements, scalars)];
        kernel(scalars, &outputs, Hoisting::Constants(hoisted))
    })
}

/// The same with whole matrices: derivatives along a motion, of which loops make the columns.
fn edge_of_matrices<'g>(
    variation: &Variation<'g>,
    elements: &[(Expr<'g>, Expr<'g>)],
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> EdgeKernels {
    let Variation { lagrangian, before, after, before_by_start, before_by_end, after_by_end, .. } = *variation;
    let carried = &variation.carried;
    let kernel = |values: &[Expr<'g>]| {
        matrices::kernel(&values.iter().map(|value| inserted(*value, elements)).collect::<Vec<_>>())
    };
    let momenta = kernel(&[lagrangian, before, after]);
    let blocks = [lagrangian, before, after, before_by_start, before_by_end, after_by_end];
    let edge = kernel(&blocks.into_iter().chain(variation.after_by_start).collect::<Vec<_>>());
    let carried = kernel(&[after, carried.adjoint, carried.before, carried.after, before_by_end, after_by_end]);
    EdgeKernels { edge, momenta, carried, slopes: slopes_of(variation, elements, scalars, hoisted) }
}

/// The replacements of F by I + D, and of inverses of configurations by the formulas of their groups.
pub(super) fn elements<'g>(formulas: &Formulas<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let leaves = formulas.model.configurations.iter().zip(&formulas.symbols.images);
    let inverses = leaves.flat_map(|(leaf, image)| match leaf.space {
        crate::model::Space::Group(group) => {
            [leaf.symbol, *image].into_iter().flat_map(|q| inverse_by(group, q, q)).collect()
        }
        _ => Vec::new(),
    });
    increments(formulas).into_iter().chain(inverses).collect()
}
