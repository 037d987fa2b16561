//! The fourth stage: from matrix formulas to kernels of straight-line scalar code.
//!
//! A kernel is one small function of generated code. Rates decide where a value is computed: once per stepper (the
//! constants), once per solve (the terms), or where it is used. Steps of order 16 have a fourth: once for the time of a stage.

mod balance;
mod code;
mod collect;
mod cost;
mod entries;
mod factors;
mod form;
mod grid;
mod kernel;
mod made;
mod matrices;
mod names;
mod pairs;
mod print;
mod program;
mod scalar;
mod signs;
mod stepping;
mod sums;
mod variation;

use clebsch_symbolic::work::{self, Exhausted};
use clebsch_symbolic::{Elements, Expr, IntoList};

use crate::derive::{self, Formulas, Id, MatrixForm, MechanicsFormulas, MidpointFormulas, SteeredFormulas, Stencil};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::features::Feature;
use crate::model::{Isotropy, System};

use entries::{Grid, Scalar};
use kernel::{Hoisted, Hoisting};
use made::{Maker, entries, entry_by_entry, of_matrices, plain, stack};
use scalar::{Rate, ScalarNode, Scalars};

pub use code::{Code, Kernel, MatrixOperation, Whole, is_in_brackets};
pub use cost::Cost;
pub use form::{Form, LARGEST_UNROLLED, MOST_UNKNOWNS};
pub use program::{KernelTable, MechanicsProgram, Program, SteeredProgram, Step};
pub use scalar::{Callee, Input, Output};
pub use stepping::Solve;

/// More operations than this in one expansion are refused: unrolled code of that size helps nobody.
const LARGEST_PROGRAM: usize = 60_000;

/// More operations than this in one function are refused: optimising compilers take minutes for them, or give up.
const LARGEST_KERNEL: usize = 20_000;

/// The work of all searches for fewer operations in one program, or as much as is left for its other work. It is not counted with that.
const SEARCHES: u64 = 2_800_000;

/// Lowers formulas to kernels.
///
/// # Errors
/// A system whose unrolled code would be too large.
pub fn lower(formulas: Formulas<'_>) -> Result<Program<'_>, Diagnostics> {
    match formulas {
        Formulas::Mechanics(formulas) => Ok(Program::Mechanics(Box::new(mechanics(*formulas)?))),
        Formulas::Steered(formulas) => Ok(Program::Steered(Box::new(steered(*formulas)?))),
    }
}

fn steered(formulas: SteeredFormulas<'_>) -> Result<SteeredProgram<'_>, Diagnostics> {
    form::check_steered(&formulas.model)?;
    let mut maker = Maker::new(&formulas, formulas.table());
    // rounding decides where plans go that start from a saddle: their sums are computed as they are written
    maker.scalars.keeps_sums = true;
    formulas.choice().iter().for_each(|choice| maker.choice(choice));
    maker.end();
    maker.membership();
    maker
        .check_length()
        .map_err(|TooLong(size)| written_out_too_large(&formulas.model, Some(Feature::Inputs), false, size))?;
    let table = KernelTable { kernels: maker.table, constant_names: Vec::new() };
    Ok(SteeredProgram { formulas, table })
}

fn mechanics(formulas: MechanicsFormulas<'_>) -> Result<MechanicsProgram<'_>, Diagnostics> {
    let form = form::choose(&formulas)?;
    let (form, kernels) = in_some_form(&formulas, form)?;
    let Kernels { table, steps, gathered, is_plain } = kernels;
    let form = Form { is_plain, ..form };
    Ok(MechanicsProgram { formulas, form, table, steps, gathered, methods: Vec::new() })
}

/// The kernels in the form that was chosen, or in the first simpler one in which they are within limits.
fn in_some_form<'g>(formulas: &MechanicsFormulas<'g>, form: Form) -> Result<(Form, Kernels<'g>), Diagnostics> {
    let missing = form::without_matrices(formulas);
    let (is_asked, mut refused) = (form.is_asked, None);
    for (form, quarters) in form.simpler(missing.is_none()) {
        match work::within(work::left() / 4 * quarters, || kernels(formulas, &form)) {
            Ok(Ok(kernels)) => return Ok((form, kernels)),
            Ok(Err(TooLong(size))) => refused = Some(written_out_too_large(&formulas.model, missing, is_asked, size)),
            Err(Exhausted) => refused = None,
        }
    }
    // where no work is left, the closure that takes it is told
    Err(refused.unwrap_or_else(|| work::give_up()))
}

/// The kernels of a mechanical system, and its steps.
struct Kernels<'g> {
    table: KernelTable,
    steps: Vec<Step>,
    gathered: Option<Stencil<'g>>,
    /// Whether some of them are left as they are, as it takes too much work to shorten them.
    is_plain: bool,
}

/// Unrolled code that is beyond a limit: the words for its size.
struct TooLong(String);

/// The kernels of a mechanical system in one form.
fn kernels<'g>(formulas: &MechanicsFormulas<'g>, form: &Form) -> Result<Kernels<'g>, TooLong> {
    let mut maker = Maker::new(formulas, formulas.table());
    maker.of_steps = of_steps(formulas);
    maker.scalars.keeps_matrices = form.keeps_matrices();
    let steps = maker.steps(formulas)?;
    if let Some(splitting) = &formulas.splitting {
        maker.name(&splitting.form);
    }
    maker.known_rows([
        Id::SplittingKick,
        Id::SplittingGradient,
        Id::Monitor,
        Id::MonitoredKick,
        Id::MonitorSlope,
        Id::Mobility,
    ]);
    maker.collocation(formulas);
    maker.rows([Id::Lift]);
    maker.variations(formulas)?;
    formulas.choice().iter().for_each(|choice| maker.choice(choice));
    maker.end();
    let constant_names = names::constants(&maker.scalars, &maker.hoisted);
    let gathered = maker.system(formulas);
    maker.membership();
    maker.isotropy(formulas);
    maker.check_length()?;
    let is_plain = maker.scalars.is_plain;
    Ok(Kernels { table: KernelTable { kernels: maker.table, constant_names }, steps, gathered, is_plain })
}

/// Steps of order 16 carry covectors along, those of sites map them, and the momentum after a step of a coupled cost is made anew.
fn of_steps(formulas: &MechanicsFormulas<'_>) -> Vec<Id> {
    let lift = formulas.collocation.as_ref().map(|_| Id::Lift);
    let map = formulas.model.power.as_ref().map(|_| Id::MomentumMap);
    let coupled = (0..formulas.substeps.len()).filter(|&index| formulas.substeps[index].coupling.is_some());
    lift.into_iter().chain(map).chain(coupled.map(Id::MomentumAfter)).into_list()
}

/// The error for a system whose unrolled code would be too large, with the feature that has no matrix code.
///
/// Matrix code is offered where unrolled code is asked for: otherwise it was tried.
fn written_out_too_large(model: &System<'_>, missing: Option<Feature>, is_asked: bool, size: String) -> Diagnostics {
    let error = too_large(model, size);
    match missing {
        None if !is_asked => error,
        None => error.help("or write `code = matrices`, whose code grows less with the size"),
        Some(what) => error.note(format!("{} has no matrix code yet, which grows less with the size", what.words())),
    }
    .into()
}

/// The error for a system whose code would be too large, with the size that exceeds a limit.
fn too_large(model: &System<'_>, size: String) -> Diagnostic {
    let groups: Vec<String> = model.factors.each(|factor| factor.group.name(model.graph));
    Diagnostic::new(model.spans.action.place, format!("`{}` is too large: {size}", groups.join(" × "))).help(
        "use a smaller group or fewer factors; for a Lagrangian, `discretization = exponential` is often much smaller",
    )
}

impl<'g> Maker<'_, 'g> {
    /// Unrolled code has a limit, in total and in one function. It is checked while kernels are made: no work is done on
    /// further ones once it is too long.
    fn check_length(&self) -> Result<(), TooLong> {
        if self.scalars.keeps_matrices {
            return Ok(());
        }
        let lengths: Vec<usize> = self.table.each(|(_, kernel)| kernel.length());
        let (whole, longest) = (lengths.iter().sum::<usize>(), lengths.iter().copied().max().unwrap_or(0));
        for (operations, most, of) in [(whole, LARGEST_PROGRAM, ""), (longest, LARGEST_KERNEL, " in one function")] {
            if operations > most {
                return Err(TooLong(format!("more than {most} scalar operations{of} when it is unrolled")));
            }
        }
        Ok(())
    }

    /// The kernels of a system that is stepped, apart from its steps, and how the gradient of a site is gathered.
    fn system(&mut self, formulas: &MechanicsFormulas<'g>) -> Option<Stencil<'g>> {
        self.add(Id::Constants, |scalars, hoisted| hoisted.kernel(scalars, Hoisting::Nothing));
        let gathered = self.terms(formulas);
        for number in 0..formulas.joints.as_ref().map_or(0, |joints| joints.all.len()) {
            self.rows([Id::JointPlaces(number), Id::Joint(number), Id::JointBend(number)]);
        }
        self.field(formulas);
        self.rows([Id::Action, Id::MomentumMap]);
        if formulas.collocation.is_some() {
            self.add(Id::MomentumOfStep, |scalars, _| stack(scalars, &formulas.momentum_map, Hoisting::Nothing));
        }
        self.rows([Id::Coadjoint, Id::Legendre, Id::LegendreNext]);
        self.known_rows([Id::SynchronizedMomentum]);
        self.rows([Id::PotentialEnergy]);
        self.inertia(formulas);
        self.rows([Id::MomentumMatrix, Id::MomentumComponents]);
        self.velocity();
        self.known_rows([Id::Gyroscopic, Id::ConservedMomenta, Id::Places, Id::Constraint, Id::MomentumOfVelocity]);
        self.known_rows([Id::PlaceCorrection, Id::Multipliers, Id::Reactions, Id::Acceleration, Id::SmallMotion]);
        gathered
    }

    /// The energies and the forces of a field.
    fn field(&mut self, formulas: &MechanicsFormulas<'g>) {
        let Some(field) = &formulas.field else { return };
        for (direction, edge) in field.edges.iter().enumerate() {
            self.rows([Id::EdgeEnergy(direction)]);
            self.shorter(Id::EdgeForces(direction), &[&edge.on_site, &edge.on_neighbour]);
            self.shorter(Id::EdgeForcesAlong(direction), &edge.along.each_ref());
        }
        if let Some(edge) = field.edges.iter().find(|edge| !edge.element.is_empty()) {
            self.add(Id::EdgeElement, |scalars, _| plain(scalars, &edge.element));
        }
        if let Some(edge) = field.edges.iter().find(|edge| !edge.coordinates.is_empty()) {
            self.add(Id::EdgeCoordinates, |scalars, _| stack(scalars, &edge.coordinates, Hoisting::Nothing));
        }
        if let Some(edge) = field.edges.iter().find(|edge| !edge.logarithm.is_empty()) {
            self.add(Id::EdgeLogarithm, |scalars, _| stack(scalars, &edge.logarithm, Hoisting::Nothing));
        }
        if let Some(midpoint) = &field.midpoint {
            self.midpoint(midpoint);
        }
        let site = [(Id::SiteForce, &field.force_of_site), (Id::SiteForceAlong, &field.force_of_site_along)];
        let inside = field.force_inside.as_ref().map(|force| (Id::ForceInside, force));
        for (id, force) in site.into_iter().chain(inside).filter(|(_, force)| !force.is_empty()) {
            self.shorter(id, &[force]);
        }
    }

    /// The implicit steps of a field.
    fn midpoint(&mut self, midpoint: &MidpointFormulas<'g>) {
        self.add(Id::HalfStep, |scalars, _| plain(scalars, &midpoint.element));
        let read = [(Id::HalfStepDoubled, &midpoint.coordinates), (Id::HalfStepLogarithm, &midpoint.logarithm)];
        for (id, value) in read.into_iter().filter(|(_, value)| !value.is_empty()) {
            self.add(id, |scalars, _| stack(scalars, value, Hoisting::Nothing));
        }
        let equation = [MatrixForm::Columns(vec![midpoint.residual.clone()]), midpoint.slope.clone()];
        self.add(Id::MidpointEquation, |scalars, _| of_matrices(scalars, &equation, Hoisting::Nothing));
        if let Some((force, slope)) = &midpoint.force {
            let force = [MatrixForm::Columns(vec![force.clone()]), slope.clone()];
            self.add(Id::MidpointForce, |scalars, _| of_matrices(scalars, &force, Hoisting::Nothing));
        }
        self.add(Id::HalfCarried, |scalars, _| stack(scalars, &midpoint.carried, Hoisting::Nothing));
        self.add(Id::HalfStepMotion, |scalars, _| stack(scalars, &midpoint.motion, Hoisting::Nothing));
    }

    /// The kernel of vectors, each of several parts: as they are or expanded, whichever takes fewer operations.
    fn shorter(&mut self, id: Id, vectors: &[&Vec<Expr<'g>>]) {
        let scalars = &mut self.scalars;
        let mut of = |vectors: &[Vec<Expr<'g>>]| {
            let outputs: Vec<Grid> = vectors.each(|parts| Grid::vector(entries(scalars, parts)));
            kernel::kernel(scalars, &outputs, Hoisting::Nothing)
        };
        let plain = of(&vectors.each(|parts| (*parts).clone()));
        let expanded = derive::expanded(vectors).map(|expanded| of(&expanded));
        let kernel = match expanded {
            Some(expanded) if expanded.cost().total() < plain.cost().total() => expanded,
            _ => plain,
        };
        self.table.push((id, kernel));
    }

    /// The terms of a power with their gradients. The gradients are gathered by site if few terms read each site. The
    /// other condition is that this takes no more operations than adding the shares of each term for its sites.
    fn terms(&mut self, formulas: &MechanicsFormulas<'g>) -> Option<Stencil<'g>> {
        let mut gradients = Vec::new();
        for (number, link) in formulas.links.iter().enumerate() {
            self.rows([Id::Term(number)]);
            let slopes: Vec<Expr<'_>> = link.gradient.iter().flat_map(|(_, leaves)| leaves.iter().copied()).into_list();
            gradients.push((Id::TermGradients(number), plain(&mut self.scalars, &slopes)));
        }
        let stencil = derive::stencil(&formulas.model, &formulas.links);
        let gathered = stencil.as_ref().map_or(Vec::new(), |stencil| self.gathered(formulas, stencil));
        let total = |kernels: &[(Id, Kernel)]| kernels.iter().map(|(_, kernel)| kernel.cost().total()).sum::<usize>();
        // each addition is read and written once more for each place of a term
        let entries = |kernel: &Kernel| kernel.outputs.iter().map(|(_, entries)| entries.len()).sum::<usize>();
        let moved = gradients.iter().map(|(_, kernel)| 2 * entries(kernel)).sum::<usize>();
        let serves = !gradients.is_empty() && total(&gathered) <= total(&gradients) + moved;
        let stencil = stencil.filter(|_| serves);
        self.table.extend(if stencil.is_some() { gathered } else { gradients });
        stencil
    }

    /// The gradient of one site: the share that every site has, and a kernel for each other place of a term.
    fn gathered(&mut self, formulas: &MechanicsFormulas<'g>, stencil: &Stencil<'g>) -> Vec<(Id, Kernel)> {
        let common = plain(&mut self.scalars, &stencil.gradient);
        let other = |&(term, number): &(usize, usize)| {
            let (place, slopes) = &formulas.links[term].gradient[number];
            (Id::TermGradient(term, *place), plain(&mut self.scalars, slopes))
        };
        let others = stencil.others.each(other);
        [(Id::SiteGradient, common)].into_iter().chain(others).into_list()
    }

    /// κ of an inertia κI, else Σ, with half of its diagonal for prints; in matrix code Σξ.
    fn inertia(&mut self, formulas: &MechanicsFormulas<'g>) {
        match formulas.uniform_inertia {
            None if self.scalars.keeps_matrices => self.rows([Id::Inertia]),
            uniform => self.add(Id::Inertia, |scalars, _| plain(scalars, &[uniform.unwrap_or(formulas.inertia)])),
        }
        if !self.scalars.keeps_matrices {
            self.add(Id::EnergyCoefficients, |scalars, _| energy_coefficients(formulas, scalars));
        }
    }

    /// ℓ(ξ) with its gradient and its Hessian, where the Lagrangian is not quadratic.
    fn velocity(&mut self) {
        let parts = [Id::Lagrangian, Id::LagrangianGradient, Id::LagrangianHessian].map(|id| self.rows.value(id));
        let parts: Vec<Expr<'_>> = parts.into_iter().flatten().flatten().copied().into_list();
        if !parts.is_empty() {
            self.add(Id::Lagrangian, |scalars, _| plain(scalars, &parts));
        }
    }

    /// The equations of the groups that leaves of the configuration are promised to lie on, in one vector, without those that always hold.
    fn membership(&mut self) {
        let Some(equations) = self.rows.value(Id::Membership) else { return };
        if self.scalars.keeps_matrices {
            return self.add(Id::Membership, |_, _| matrices::largest(equations));
        }
        let all = entries(&mut self.scalars, equations).into_iter();
        let entries: Vec<Scalar> = all.filter(|&entry| !self.scalars.is_zero(entry)).into_list();
        if !entries.is_empty() {
            let equations = [Grid::vector(entries)];
            self.add(Id::Membership, |scalars, _| kernel::kernel(scalars, &equations, Hoisting::Nothing));
        }
    }

    /// The matrix of ξ ↦ ξ_Q(q) where motions that fix q are not free. In matrix code it is the projection to the momenta
    /// of motions, where that is a formula.
    fn isotropy(&mut self, formulas: &MechanicsFormulas<'g>) {
        if formulas.is_free || formulas.model.isotropy != Isotropy::Fixed {
            return;
        }
        self.add(Id::Isotropy, |scalars, _| match &formulas.projection {
            Some(projection) if scalars.keeps_matrices => stack(scalars, projection, Hoisting::Nothing),
            _ => entry_by_entry(scalars, formulas.generator_matrix()),
        });
    }
}

/// Σ with its diagonal halved.
fn energy_coefficients(formulas: &MechanicsFormulas<'_>, scalars: &mut Scalars) -> Kernel {
    let mut grid = (*scalars.grid(formulas.inertia)).clone();
    let half = clebsch_symbolic::rational(1, 2);
    for i in 0..grid.shape.rows {
        let diagonal = i * grid.shape.columns + i;
        grid.entries[diagonal] = match scalars.node(grid.entries[diagonal]).clone() {
            ScalarNode::Sum(constant, terms) => {
                scalars.sum(constant * &half, terms.into_iter().map(|(term, weight)| (term, weight * &half)))
            }
            _ => scalars.scale(grid.entries[diagonal], half.clone()),
        };
    }
    kernel::kernel(scalars, &[grid], Hoisting::Nothing)
}
