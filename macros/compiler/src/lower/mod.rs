//! The fourth stage: from matrix formulas to kernels of straight-line scalar code.
//!
//! A kernel is one small function of generated code. Three rates decide where a value is computed: once per stepper (the
//! constants), once per solve (the terms), or where it is used.

mod balance;
mod code;
mod control;
mod cost;
mod entry;
mod factors;
mod fixed_point;
mod form;
mod grid;
mod kernel;
mod made;
mod matrices;
mod names;
mod pairs;
mod print;
mod rare;
mod scalar;
mod signs;
mod stepping;
mod sums;
mod told;
mod variation;

use clebsch_symbolic::{Expr, Shape};

use crate::MethodProgram;
use crate::derive::{self, Formulas, Id, Stencil};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{CodeForm, Isotropy};

use made::{entries, grids, plain, stack};
use rare::Rare;

pub use code::{Code, Kernel, MatrixOperation, Whole, is_in_brackets};
pub use control::{BendKernels, ControlKernels, EndpointKernels, StepOfInputs};
pub use cost::Cost;
pub use entry::{Grid, Scalar};
pub use form::{Form, LARGEST_UNROLLED, MOST_UNKNOWNS};
pub use grid::Lowering;
pub use kernel::{Hoisted, Hoisting};
pub(crate) use matrices::is_direction;
pub use scalar::{Callee, Input, Output, Rate, ScalarNode, Scalars};
pub use stepping::{CollocationKernels, Solve, SplittingKernels, StepKernels};
pub use variation::{EdgeKernels, VariationKernels};

/// More operations than this in one expansion are refused: unrolled code of that size helps nobody.
const LARGEST_PROGRAM: usize = 60_000;

/// More operations than this in one function are refused: optimising compilers take minutes for them, or give up.
const LARGEST_KERNEL: usize = 20_000;

/// All kernels of a system.
pub struct Program<'g> {
    /// The formulas that it computes.
    pub formulas: Formulas<'g>,
    /// Whether kernels are written out or keep whole matrices, and why.
    pub form: Form,
    /// Φ_F(q), from F and q.
    pub act: Kernel,
    /// J(q, p).
    pub momentum_map: Kernel,
    /// J(q, p) as a step computes it, where one does: steps of order 16 map covectors.
    pub momentum_of_step: Option<Kernel>,
    /// Ad*_F μ.
    pub coadjoint: Kernel,
    /// F⁻ℓd, from h, q and F.
    pub legendre: Kernel,
    /// F⁺ℓd, from h, q and F.
    pub legendre_next: Kernel,
    /// ½J(q, ∂(U₁ − U₀)), from h, t and q; `None` if it vanishes.
    pub stagger: Option<Kernel>,
    /// V(q).
    pub potential: Kernel,
    /// κ of an inertia κI, else Σ, or Σξ as a function of ξ where matrices are kept.
    pub inertia: Kernel,
    /// The coefficients of ξ_i ξ_j, i ≤ j, in the kinetic energy: what its print in coordinates is made of, where it is written out.
    pub energy_coefficients: Option<Kernel>,
    /// The representing matrices of μ.
    pub momentum_matrix: Kernel,
    /// The components of momentum matrices.
    pub momentum_components: Kernel,
    /// ℓ(ξ), its gradient and its Hessian, where the Lagrangian is not quadratic.
    pub velocity: Option<Kernel>,
    /// The slope A of a kinetic energy that is linear in the velocity too; `None` if there is none.
    pub gyroscopic: Option<Kernel>,
    /// The conserved momenta, from q and μ; `None` if there is none.
    pub conserved: Option<Kernel>,
    /// What vanishes where the leaves of the configuration lie on their groups, apart from rotations and unit vectors.
    pub membership: Option<Kernel>,
    /// The matrix of ξ ↦ ξ_Q(q), unless the action is free, or motions that fix q are asked for; where matrices are kept the projection of μ
    /// to the momenta of motions.
    pub generator: Option<Kernel>,
    /// The kernels of each substep.
    pub steps: Vec<StepKernels>,
    /// The kicks of a splitting, where a step is one.
    pub splitting: Option<SplittingKernels>,
    /// Hamilton's equations, where a step collocates them.
    pub collocation: Option<CollocationKernels>,
    /// What variations need, where they are asked for.
    pub variations: Option<VariationKernels>,
    /// What the choice of inputs needs, where there is one.
    pub control: Option<ControlKernels>,
    /// The price of the end, where there is one.
    pub endpoint: Option<EndpointKernels>,
    /// (TΦ_F)^{-*} p, from the increment of F, q⁺ and p.
    pub cotangent_lift: Kernel,
    /// The terms of a power.
    pub links: Vec<LinkKernels>,
    /// The gradient of one site of a power, where it is gathered from the terms that read it.
    pub gathered: Option<Gathered<'g>>,
    /// Computes the constants, one output each.
    pub constants: Kernel,
    /// A short name for each constant.
    pub constant_names: Vec<String>,
    /// Further ways to step the system, none behind this stage alone.
    pub methods: Vec<MethodProgram<'g>>,
}

/// The kernels of a term of a power.
pub struct LinkKernels {
    /// The term.
    pub value: Kernel,
    /// Its gradient: for each place that it reads, one output for each leaf of the configuration.
    pub gradient: Kernel,
}

/// The gradient of one site of a power.
pub struct Gathered<'g> {
    /// Its formulas.
    pub stencil: Stencil<'g>,
    /// What every site has, one output for each leaf of the configuration.
    pub common: Kernel,
    /// The others, a kernel for each place of a term.
    pub others: Vec<Kernel>,
}

/// Lowers formulas to kernels.
///
/// # Errors
/// A system whose unrolled code would be too large.
pub fn lower(formulas: Formulas<'_>) -> Result<Program<'_>, Diagnostics> {
    let form = form::choose(&formulas)?;
    // rounding decides where plans go that start from a saddle: what they are made of is computed as it is written
    let mut scalars = Scalars::default();
    scalars.keeps_sums = formulas.model.is_steered();
    scalars.keeps_matrices = form.keeps_matrices();
    let mut hoisted = Hoisted::default();
    let steps = stepping::steps(&formulas, &mut scalars, &mut hoisted);
    let splitting = stepping::splitting(&formulas, &mut scalars, &mut hoisted);
    let collocation = stepping::collocation(&formulas, &mut scalars, &mut hoisted);
    let rare = Rare::of(&formulas);
    // steps of order 16 carry covectors along
    let lift = match formulas.collocation {
        Some(_) => made::of_row(&formulas, Id::Lift, &mut scalars),
        None => rare.kernel(&mut scalars, formulas.value(Id::Lift).unwrap_or_default()),
    };
    let variations = variation::variations(&formulas, &mut scalars, &mut hoisted);
    let control = control::control(&formulas, &mut scalars);
    let endpoint = control::endpoint(&formulas, &mut scalars);
    let names = names::constants(&scalars, &hoisted);
    let constants = hoisted.kernel(&mut scalars, Hoisting::Nothing);
    let links = formulas.links.iter().map(|link| {
        let slopes: Vec<Expr<'_>> = link.gradient.iter().flat_map(|(_, leaves)| leaves.iter().copied()).collect();
        LinkKernels { value: plain(&mut scalars, &[link.term.value]), gradient: plain(&mut scalars, &slopes) }
    });
    let links: Vec<LinkKernels> = links.collect();
    let gathered = gathered(&formulas, &links, |expressions| plain(&mut scalars, expressions));
    let asked = |id: Id, scalars: &mut Scalars| rare.kernel(scalars, formulas.value(id).unwrap_or_default());
    let stacked = |id: Id, scalars: &mut Scalars| rare.stack(scalars, formulas.value(id).unwrap_or_default());
    let program = Program {
        methods: Vec::new(),
        links,
        gathered,
        act: asked(Id::Action, &mut scalars),
        // steps of sites map covectors
        momentum_map: if formulas.model.power.is_some() {
            stack(&mut scalars, &formulas.momentum_map, Hoisting::Nothing)
        } else {
            stacked(Id::MomentumMap, &mut scalars)
        },
        momentum_of_step: formulas
            .collocation
            .as_ref()
            .map(|_| stack(&mut scalars, &formulas.momentum_map, Hoisting::Nothing)),
        coadjoint: stacked(Id::Coadjoint, &mut scalars),
        legendre: stacked(Id::Legendre, &mut scalars),
        legendre_next: stacked(Id::LegendreNext, &mut scalars),
        stagger: formulas
            .value(Id::SynchronizedMomentum)
            .map(|stagger| stack(&mut scalars, stagger, Hoisting::Nothing)),
        potential: plain(&mut scalars, formulas.value(Id::PotentialEnergy).unwrap_or_default()),
        inertia: inertia(&formulas, &mut scalars),
        energy_coefficients: (!form.keeps_matrices()).then(|| energy_coefficients(&formulas, &mut scalars)),
        momentum_matrix: asked(Id::MomentumMatrix, &mut scalars),
        momentum_components: stacked(Id::MomentumComponents, &mut scalars),
        velocity: velocity(&formulas, &mut scalars),
        gyroscopic: formulas.value(Id::Gyroscopic).map(|slope| stack(&mut scalars, slope, Hoisting::Nothing)),
        conserved: formulas.value(Id::ConservedMomenta).map(|values| rare.list(&mut scalars, values)),
        membership: membership(&formulas, &mut scalars),
        generator: generator(&formulas, &mut scalars),
        cotangent_lift: lift,
        splitting,
        collocation,
        variations,
        control,
        endpoint,
        constants,
        constant_names: names,
        steps,
        form,
        formulas,
    };
    if program.form.keeps_matrices() {
        return Ok(program);
    }
    let lengths: Vec<usize> = program.kernels().into_iter().map(|(_, kernel)| kernel.length()).collect();
    let (whole, kernel) = (lengths.iter().sum(), lengths.iter().copied().max().unwrap_or(0));
    for (operations, most, of) in [(whole, LARGEST_PROGRAM, ""), (kernel, LARGEST_KERNEL, " in one function")] {
        if operations > most {
            return Err(too_large(
                &program.formulas,
                program.form.code,
                format!("{operations} scalar operations{of} when it is written out, {most} is the most"),
            ));
        }
    }
    Ok(program)
}

/// The error for a system whose code would be too large in a form, with what is too large of it.
fn too_large(formulas: &Formulas<'_>, code: CodeForm, size: String) -> Diagnostics {
    let groups: Vec<String> =
        formulas.model.factors.iter().map(|factor| factor.group.name(formulas.model.graph)).collect();
    let error = Diagnostic::new(
        formulas.model.spans.action.place,
        format!("`{}` is too large: {size}", groups.join(" × ")),
    )
    .help(
        "use a smaller group or fewer factors; for a Lagrangian, `discretization = exponential` is often much smaller",
    );
    match (code, form::without_matrices(formulas)) {
        (CodeForm::Matrices, _) => error,
        (CodeForm::Unrolled, None) => error.help("or write `code = matrices`, whose code grows less with the size"),
        (CodeForm::Unrolled, Some(what)) => {
            error.note(format!("{} has no code with whole matrices yet, which grows less with the size", what.words()))
        }
    }
    .into()
}

/// The gradient of one site, where each site is read by few terms and gathering takes no more operations than adding up what each term has for its sites.
fn gathered<'g>(
    formulas: &Formulas<'g>,
    links: &[LinkKernels],
    mut kernel: impl FnMut(&[Expr<'g>]) -> Kernel,
) -> Option<Gathered<'g>> {
    let stencil = derive::stencil(&formulas.model, &formulas.links)?;
    let common = kernel(&stencil.gradient);
    let others = stencil.others.iter().map(|&(term, place)| kernel(&formulas.links[term].gradient[place].1));
    let others: Vec<Kernel> = others.collect();
    let gathered = others.iter().chain([&common]).map(|kernel| kernel.cost().total()).sum::<usize>();
    // what is added up is read and written once more for each place of a term
    let entries = |kernel: &Kernel| kernel.outputs.iter().map(|(_, entries)| entries.len()).sum::<usize>();
    let added = links.iter().map(|link| link.gradient.cost().total() + 2 * entries(&link.gradient)).sum::<usize>();
    (!links.is_empty() && gathered <= added).then_some(Gathered { stencil, common, others })
}

/// κ of an inertia κI, else Σ; where matrices are kept Σξ.
fn inertia(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    match formulas.uniform_inertia {
        Some(kappa) => plain(scalars, &[kappa]),
        None if !scalars.keeps_matrices => plain(scalars, &[formulas.inertia]),
        None => stack(scalars, formulas.value(Id::Inertia).unwrap_or_default(), Hoisting::Nothing),
    }
}

/// The matrix of ξ ↦ ξ_Q(q) where motions that fix q are not free; where matrices are kept the projection to the momenta of motions.
fn generator(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<Kernel> {
    if formulas.is_free || formulas.model.isotropy != Isotropy::Fixed {
        return None;
    }
    Some(match formulas.projection.as_ref().filter(|_| scalars.keeps_matrices) {
        Some(projection) => stack(scalars, projection, Hoisting::Nothing),
        None => plain(scalars, &[formulas.generator_matrix()]),
    })
}

/// Σ with its diagonal halved.
fn energy_coefficients(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Kernel {
    let (shape, mut entries) = grids(scalars, &[formulas.inertia]).remove(0);
    for i in 0..shape.rows {
        let diagonal = i * shape.columns + i;
        let halved = match scalars.node(entries[diagonal]).clone() {
            ScalarNode::Sum(constant, terms) => {
                let half = clebsch_symbolic::rational(1, 2);
                let terms: Vec<_> = terms.into_iter().map(|(term, weight)| (term, weight * &half)).collect();
                scalars.sum(constant * &half, terms)
            }
            _ => scalars.scale(entries[diagonal], clebsch_symbolic::rational(1, 2)),
        };
        entries[diagonal] = halved;
    }
    kernel::kernel(scalars, &[(shape, entries)], Hoisting::Nothing)
}

/// ℓ(ξ) with its gradient and its Hessian.
fn velocity(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<Kernel> {
    let parts = [Id::Lagrangian, Id::LagrangianGradient, Id::LagrangianHessian].map(|id| formulas.value(id));
    let parts: Vec<Expr<'_>> = parts.into_iter().flatten().flatten().copied().collect();
    (!parts.is_empty()).then(|| plain(scalars, &parts))
}

/// The equations of the groups that leaves of the configuration are promised to lie on, in one vector, without those that always hold.
fn membership(formulas: &Formulas<'_>, scalars: &mut Scalars) -> Option<Kernel> {
    let equations = formulas.value(Id::Membership)?;
    if scalars.keeps_matrices {
        return Some(matrices::largest(equations));
    }
    let all = entries(scalars, equations).into_iter();
    let entries: Vec<Scalar> = all.filter(|&entry| !scalars.is_zero(entry)).collect();
    (!entries.is_empty())
        .then(|| kernel::kernel(scalars, &[(Shape::vector(entries.len()), entries)], Hoisting::Nothing))
}

impl Program<'_> {
    /// Whether steps of a point on a sphere are made in the point and its velocity, without the matrices of the group.
    pub fn turns_in_plane(&self) -> bool {
        self.form.keeps_matrices() && self.formulas.follows_great_circles()
    }

    /// The operations of all kernels together.
    pub fn cost(&self) -> Cost {
        self.kernels().into_iter().map(|(_, kernel)| kernel.cost()).fold(Cost::default(), Cost::plus)
    }
}
