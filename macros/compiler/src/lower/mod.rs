//! The fourth stage: from matrix formulas to kernels of straight-line scalar code.
//!
//! A kernel is one small function of generated code. Three rates decide where a value is computed: once per stepper (the
//! constants), once per solve (the terms), or where it is used.

mod grid;
mod kernel;
mod names;
mod print;
mod scalar;
mod stepping;

use clebsch_symbolic::{Expr, Property, Role, Shape, identity};

use crate::derive::Formulas;
use crate::diagnostic::{Diagnostic, Diagnostics};

pub use grid::{Grid, Lowering};
pub use kernel::{Code, Cost, Hoisted, Hoisting, Kernel};
pub use scalar::{Input, Node, Rate, Scalar, Scalars};
pub use stepping::{Solve, StepKernels};

/// More operations than this in one expansion are refused: unrolled code of that size helps nobody.
const LARGEST_PROGRAM: usize = 60_000;

/// All kernels of a system.
pub struct Program<'g> {
    /// The formulas that it computes.
    pub formulas: Formulas<'g>,
    /// Φ_F(q), from F and q.
    pub act: Kernel,
    /// J(q, p).
    pub momentum_map: Kernel,
    /// Ad*_F μ.
    pub coadjoint: Kernel,
    /// F⁻ℓd, from h, q and F.
    pub legendre: Kernel,
    /// F⁺ℓd, from h, q and F.
    pub legendre_next: Kernel,
    /// V(q).
    pub potential: Kernel,
    /// Σ.
    pub inertia: Kernel,
    /// The representing matrices of μ.
    pub momentum_matrix: Kernel,
    /// The components of momentum matrices.
    pub momentum_components: Kernel,
    /// The matrix of ξ ↦ ξ_Q(q), unless the action is free.
    pub generator: Option<Kernel>,
    /// The kernels of each substep.
    pub steps: Vec<StepKernels>,
    /// (TΦ_F)^{-*} p, from the increment of F, q⁺ and p.
    pub cotangent_lift: Kernel,
    /// Computes the constants, one output each.
    pub constants: Kernel,
    /// A short name for each constant.
    pub constant_names: Vec<String>,
    /// Whether a constant is made of Σ⁻¹.
    pub needs_inertia_inverse: bool,
}

/// Lowers formulas to kernels.
///
/// # Errors
/// A system whose unrolled code would be too large.
pub fn lower(formulas: Formulas<'_>) -> Result<Program<'_>, Diagnostics> {
    let dimension = formulas.inertia.shape().rows;
    if dimension > 64 {
        return Err(too_large(&formulas, format!("{dimension} unknowns")));
    }
    let mut scalars = Scalars::default();
    let mut hoisted = Hoisted::default();
    let steps = stepping::steps(&formulas, &mut scalars, &mut hoisted);
    let lift = stepping::cotangent_lift(&formulas, &mut scalars);
    let outputs = |scalars: &mut Scalars, expressions: &[Expr<'_>]| plain(scalars, expressions);
    let after = legendre_next(&formulas);
    let names = names::constants(&scalars, &hoisted);
    let constants = kernel::kernel(
        &mut scalars,
        &hoisted.scalars.iter().map(|&scalar| (Shape::scalar(), vec![scalar])).collect::<Vec<_>>(),
        Hoisting::Nothing,
    );
    let stacked = |parts: &[Expr<'_>], scalars: &mut Scalars| stack(scalars, parts);
    let program = Program {
        act: outputs(&mut scalars, &formulas.model.action),
        momentum_map: stacked(&formulas.momentum_map, &mut scalars),
        coadjoint: stacked(&formulas.coadjoint, &mut scalars),
        legendre: stacked(&formulas.legendre, &mut scalars),
        legendre_next: stacked(&after, &mut scalars),
        potential: outputs(&mut scalars, &[formulas.potential_energy]),
        inertia: outputs(&mut scalars, &[formulas.inertia]),
        momentum_matrix: outputs(&mut scalars, &momentum_matrices(&formulas)),
        momentum_components: stacked(&momentum_components(&formulas), &mut scalars),
        generator: (!formulas.is_free).then(|| generator(&formulas, &mut scalars)),
        cotangent_lift: lift,
        needs_inertia_inverse: hoisted.scalars.iter().any(|&scalar| uses_inertia_inverse(&scalars, scalar)),
        constants,
        constant_names: names,
        steps,
        formulas,
    };
    let operations = program.cost().total();
    if operations > LARGEST_PROGRAM {
        return Err(too_large(
            &program.formulas,
            format!("{operations} scalar operations, {LARGEST_PROGRAM} is the most"),
        ));
    }
    Ok(program)
}

/// F⁺ℓd with its last kick at q⁺ = Φ_F(q).
fn legendre_next<'g>(formulas: &Formulas<'g>) -> Vec<Expr<'g>> {
    let Some(kick) = &formulas.legendre_kick else { return formulas.legendre_next.clone() };
    let leaves = formulas.model.configurations.iter().zip(&formulas.model.action);
    let moved: Vec<_> = leaves.map(|(leaf, image)| (leaf.symbol, *image)).collect();
    formulas.legendre_next.iter().zip(kick).map(|(kinetic, kick)| *kinetic + kick.substitute(&moved)).collect()
}

fn too_large(formulas: &Formulas<'_>, size: String) -> Diagnostics {
    let groups: Vec<String> = formulas.model.factors.iter().map(|factor| factor.group.name()).collect();
    Diagnostic::new(formulas.model.spans.action.place, format!("{} is too large to unroll: {size}", groups.join(" × ")))
        .help("use a smaller group, or fewer factors")
        .note("code that keeps its matrix operations for large systems comes with a later version of clebsch")
        .into()
}

/// Several expressions, one output each, nothing taken out.
fn plain(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
    let grids = grids(scalars, expressions);
    kernel::kernel(scalars, &grids, Hoisting::Nothing)
}

/// Vectors, one after the other in one output.
fn stack(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Kernel {
    let entries: Vec<Scalar> = grids(scalars, expressions).into_iter().flat_map(|(_, entries)| entries).collect();
    kernel::kernel(scalars, &[(Shape::vector(entries.len()), entries)], Hoisting::Nothing)
}

fn grids(scalars: &mut Scalars, expressions: &[Expr<'_>]) -> Vec<(Shape, Vec<Scalar>)> {
    let mut lowering = Lowering::new(scalars);
    let grid = |expr: &Expr<'_>| expr.shape();
    let shapes: Vec<Shape> = expressions.iter().map(grid).collect();
    expressions.iter().zip(shapes).map(|(&expr, shape)| (shape, lowering.grid(expr).entries)).collect()
}

fn momentum_matrices<'g>(formulas: &Formulas<'g>) -> Vec<Expr<'g>> {
    let factors = formulas.model.factors.iter().zip(&formulas.symbols.momenta);
    factors.map(|(factor, mu)| factor.group.momentum_matrix(*mu)).collect()
}

fn momentum_components<'g>(formulas: &Formulas<'g>) -> Vec<Expr<'g>> {
    let factors = formulas.model.factors.iter().zip(&formulas.symbols.momentum_matrices);
    factors.map(|(factor, matrix)| matrix.components(factor.group.algebra())).collect()
}

/// The rows of ξ ↦ ξ_Q(q) on all components, one row for each entry of the configuration.
fn generator(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let columns = crate::derive::generator_columns(&formulas.symbols, &formulas.generator);
    let graph = formulas.model.graph;
    let shape = Shape::new(columns[0].len(), columns.len());
    let matrix = graph.stack(shape, shape.positions().map(|(i, j)| columns[j][i]).collect());
    plain(scalars, &[matrix])
}

/// Σ⁻¹ as a symbol, which the stepper computes from Σ.
fn inertia_inverse<'g>(formulas: &Formulas<'g>) -> Expr<'g> {
    let shape = formulas.inertia.shape();
    formulas.model.graph.symbol("inertia_inverse", shape, Role::Auxiliary(usize::MAX), Property::Symmetric)
}

fn uses_inertia_inverse(scalars: &Scalars, scalar: Scalar) -> bool {
    match scalars.node(scalar) {
        Node::Input(input) => matches!(input.role, Role::Auxiliary(_)),
        _ => scalars.children(scalar).into_iter().any(|child| uses_inertia_inverse(scalars, child)),
    }
}

/// Whether a matrix is zero off its diagonal for all values of its symbols.
fn is_diagonal(matrix: Expr<'_>) -> bool {
    matrix.shape().positions().filter(|(i, j)| i != j).all(|(i, j)| identity::vanishes(matrix.entry(i, j)))
}

impl Program<'_> {
    /// The operations of all kernels together.
    pub fn cost(&self) -> Cost {
        self.kernels().into_iter().map(|(_, kernel)| kernel.cost()).fold(Cost::default(), Cost::plus)
    }
}
