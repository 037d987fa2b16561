//! Whether the kernels of a system are unrolled, entry by entry, or are matrix code.

use clebsch_symbolic::{Expr, Group, Interner, IntoList, Operation, View};

use super::{too_large, written_out_too_large};
use crate::derive::{MechanicsFormulas, Solution};
use crate::diagnostic::Diagnostics;
use crate::model::features::{self, Feature, Found};
use crate::model::{CodeForm, Steered, System};

/// The most multiplications of a linearisation that is unrolled, by estimate.
///
/// Steps of systems on either side of it were measured in both forms (`cargo bench -p clebsch-tests --bench large`).
pub const LARGEST_UNROLLED: usize = 10_000;

/// Systems with fewer unknowns are unrolled, unless they are bodies or points. This holds for long formulas too: loops
/// over so few unknowns gain nothing.
const FEWEST_UNKNOWNS: usize = 15;

/// Bodies on SO(n) keep matrices from as many unknowns on, those of SO(5): there the same products take six tenths of the time.
const FEWEST_OF_BODIES: usize = 10;

/// Points on spheres turn in (q, w) from so many components of the momentum on: those of S⁷. In a long run a step then
/// takes two thirds of the time on S⁷ and a third on S¹⁰. A single step takes eight tenths on S⁷ and half on S¹⁰. On S³
/// it would take twice as long.
const FEWEST_OF_SPHERES: usize = 28;

/// The most unknowns of an equation that Newton's method eliminates, and the most components of an inertia that is inverted.
pub const MOST_UNKNOWNS: usize = 64;

/// How kernels are written, and why.
#[derive(Clone, Debug)]
pub struct Form {
    /// Unrolled, or matrix code.
    pub code: CodeForm,
    /// The multiplications of a step that is unrolled, by estimate.
    pub estimate: usize,
    /// Whether the declaration asks for it.
    pub is_asked: bool,
    /// Whether its size alone decides for matrix code: a body on SO(5) or larger, or a point on S⁷ or larger.
    pub is_body_or_point: bool,
    /// The feature of the system that has no matrix code.
    pub missing: Option<&'static str>,
    /// Whether it is matrix code because unrolled code is beyond a limit.
    pub is_beyond: bool,
    /// Whether some code is left as it is, as it takes too much work to shorten it.
    pub is_plain: bool,
}

impl Form {
    /// Whether kernels are matrix code.
    pub fn keeps_matrices(&self) -> bool {
        self.code == CodeForm::Matrices
    }

    /// This form and a simpler one, in the order in which they are tried, with the quarters for each of the work that is left. Matrix code
    /// stands in for code that is too long.
    pub(super) fn simpler(self, has_matrices: bool) -> Vec<(Form, u64)> {
        let stands_in = has_matrices && !self.is_asked && !self.keeps_matrices();
        let matrices = Form { code: CodeForm::Matrices, is_beyond: true, ..self.clone() };
        if stands_in { vec![(self, 3), (matrices, 4)] } else { vec![(self, 4)] }
    }
}

/// The form of a system. A declaration may ask for one; otherwise it is matrix code if unrolled code would exceed the
/// budget.
///
/// # Errors
/// A system too large for the only form that it has, or a form that is asked for and not there.
pub(super) fn choose(formulas: &MechanicsFormulas<'_>) -> Result<Form, Diagnostics> {
    let estimate = estimate(formulas);
    let asked = formulas.model.dials.code.as_ref();
    let dimension = formulas.inertia.shape().rows;
    let is_long = estimate > LARGEST_UNROLLED && dimension >= FEWEST_UNKNOWNS;
    let is_point = dimension >= FEWEST_OF_SPHERES && formulas.follows_great_circles();
    let is_body_or_point = is_point || is_body(formulas);
    let is_large = is_long || is_body_or_point || dimension > MOST_UNKNOWNS;
    let missing = without_matrices(formulas);
    let code = match asked {
        Some(asked) => asked.value,
        None if is_large && missing.is_none() => CodeForm::Matrices,
        None => CodeForm::Unrolled,
    };
    match (code, asked, missing) {
        (CodeForm::Matrices, Some(asked), Some(missing)) => {
            let asked = (Feature::Matrices, Found::at(asked.span));
            return Err(features::refusal(asked, (missing, Found::somewhere())).into());
        }
        (CodeForm::Unrolled, ..) => check_unknowns(&formulas.model, missing)?,
        _ => {}
    }
    let largest = largest_system(formulas);
    if code == CodeForm::Matrices && largest > MOST_UNKNOWNS {
        let size = format!("a linear system of {largest} unknowns, {MOST_UNKNOWNS} is the most");
        return Err(too_large(&formulas.model, size).into());
    }
    let missing = missing.map(Feature::words);
    Ok(Form { code, estimate, is_asked: asked.is_some(), is_body_or_point, missing, is_beyond: false, is_plain: false })
}

/// Steps of inputs are unrolled.
///
/// # Errors
/// A system too large for that, or a request for matrix code.
pub(super) fn check_steered(model: &Steered<'_>) -> Result<(), Diagnostics> {
    if let Some(asked) = model.dials.code.as_ref().filter(|asked| asked.value == CodeForm::Matrices) {
        let asked = (Feature::Matrices, Found::at(asked.span));
        return Err(features::refusal(asked, (Feature::Inputs, Found::somewhere())).into());
    }
    check_unknowns(model, Some(Feature::Inputs))
}

/// Unrolled code has few unknowns.
fn check_unknowns(model: &System<'_>, missing: Option<Feature>) -> Result<(), Diagnostics> {
    let dimension = model.dimension();
    if dimension <= MOST_UNKNOWNS {
        return Ok(());
    }
    let size = format!("{dimension} unknowns, {MOST_UNKNOWNS} is the most for unrolled code");
    Err(written_out_too_large(model, missing, true, size))
}

/// Whether an equation is that of a body on SO(n), whose Jacobian is Sylvester's map.
fn is_body(formulas: &MechanicsFormulas<'_>) -> bool {
    let mut equations = formulas.substeps.iter().flat_map(|substep| &substep.equations);
    equations.any(|equation| {
        let is_iterated = equation.solution == Solution::Newton && equation.components.len() >= FEWEST_OF_BODIES;
        is_iterated && equation.sylvester_factor(formulas).is_some()
    })
}

fn largest_system(formulas: &MechanicsFormulas<'_>) -> usize {
    let equations = formulas.substeps.iter().flat_map(|substep| &substep.equations);
    let solved = equations.filter(|equation| matches!(equation.solution, Solution::Newton | Solution::Linear));
    let inertia = if formulas.uniform_inertia.is_some() { 0 } else { formulas.inertia.shape().rows };
    solved.map(|equation| equation.components.len()).chain([inertia]).max().unwrap_or(0)
}

/// The feature of a system that has no matrix code.
pub(super) fn without_matrices(formulas: &MechanicsFormulas<'_>) -> Option<Feature> {
    let model = &formulas.model;
    let is_quaternion = has_quaternions(model);
    let has = |feature: &Feature| match feature {
        Feature::Inputs => model.control.is_some(),
        Feature::Constraint => model.constraint.is_some(),
        Feature::Power => model.power.is_some(),
        Feature::Quaternions => is_quaternion,
        Feature::ExactDrifts => formulas.splitting.is_some() || formulas.turns_whole(),
        Feature::FreeRotation => formulas.turns_freely(),
        Feature::Collocation => formulas.collocation.is_some(),
        Feature::GeneralLagrangian => formulas.energy.general.is_some(),
        _ => false,
    };
    features::refused_beside(Feature::Matrices).find(has)
}

/// Whether configurations or group elements are quaternions, which are no matrices.
pub(super) fn has_quaternions(model: &System<'_>) -> bool {
    model.configurations.iter().any(|leaf| leaf.is_quaternion)
        || model.factors.iter().any(|factor| factor.group == Group::UnitQuaternions)
}

/// About the multiplications of a linearisation of each momentum equation, unrolled. Each column of the Jacobian is a
/// directional derivative.
fn estimate(formulas: &MechanicsFormulas<'_>) -> usize {
    let equations = formulas.substeps.iter().flat_map(|substep| &substep.equations);
    let iterated = equations.filter(|equation| matches!(equation.solution, Solution::Newton | Solution::Linear));
    let solves: usize = iterated.map(|equation| products(&[equation.directional]) * equation.components.len()).sum();
    let moves: Vec<Expr<'_>> = formulas.model.action.iter().chain(&formulas.coadjoint).copied().into_list();
    solves + products(&moves)
}

/// The multiplications in the products of some expressions, entry by entry.
fn products(expressions: &[Expr<'_>]) -> usize {
    let mut known = Interner::default();
    let mut open: Vec<Expr<'_>> = expressions.to_vec();
    let mut count = 0;
    while let Some(expr) = open.pop() {
        if !known.intern(expr.position()).1 {
            continue;
        }
        let of_word = |word: &[Expr<'_>]| -> usize {
            let pairs = word.windows(2);
            pairs.map(|pair| word[0].shape().rows.min(pair[1].shape().columns) * pair[0].shape().len()).sum()
        };
        let view = expr.view();
        count += match &view {
            View::Sum(terms) => terms.iter().map(|term| of_word(&term.word)).sum::<usize>(),
            View::Word(word) | View::Trace(word) => of_word(word),
            View::Of(Operation::Inverse | Operation::Determinant | Operation::Analytic(_), a) => {
                a.shape().rows * a.shape().len()
            }
            _ => 0,
        };
        view.each_child(|child| open.push(child));
    }
    count
}
