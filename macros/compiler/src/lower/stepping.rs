//! The kernels of a step: kick, solve, move, update.

use std::collections::BTreeSet;

use clebsch_symbolic::{Role, Zero};

use super::fixed_point;
use super::kernel::kernel;
use super::made::{of_matrices, of_row, plain, separate, stack};
use super::matrices;
use super::{Code, Cost, Hoisted, Hoisting, Kernel, Scalars};
use crate::derive::{Formulas, Id, Solution, Structure};

/// The kernels of one substep.
pub struct StepKernels {
    /// J(q, ∂U₀), from q.
    pub start: Option<Kernel>,
    /// J(q, ∂U₁), from q⁺; `None` if there is none.
    pub end: Option<Kernel>,
    /// The impulse of the force before the solve, from t, q and u; `None` if there is none.
    pub start_force: Option<Kernel>,
    /// The rest of that impulse, which depends on the velocity, from t, q, x and u; `None` if there is none or if it is of no use.
    pub start_moving: Option<Kernel>,
    /// The impulse of the force after the move, from t, q⁺, x and u; `None` if there is none.
    pub end_force: Option<Kernel>,
    /// Whether the end kick of a step is the start kick of the next.
    pub end_is_start: bool,
    /// ∂U₀ for each leaf, for the symmetric representation.
    pub start_gradient: Option<Kernel>,
    /// ∂U₁ for each leaf.
    pub end_gradient: Option<Kernel>,
    /// The momentum equations.
    pub solves: Vec<Solve>,
    /// The increment F − I of each factor, from the chart coordinates.
    pub increment: Kernel,
    /// q⁺, from q and the increments; q⁺ − q where sums keep their rests.
    pub advance: Kernel,
    /// The same from q and the chart coordinates, where that costs less than by the increments.
    pub displace: Option<Kernel>,
    /// M⁺, from M and the increments, or M⁺ − M where sums keep their rests; from q and the increments where the cost couples them; `None` if
    /// M does not change.
    pub update: Option<Kernel>,
    /// Whether M⁺ is made from q and the increments.
    pub couples: bool,
    /// −r(q, I) of a cost that couples or has a term that is linear in the velocity, from q.
    pub rest: Option<Kernel>,
    /// ∂_q K of a coupled cost for each leaf, from q and the increments.
    pub coupled_gradient: Option<Kernel>,
}

/// The kernels of the kicks of a splitting, functions of their weights b and g.
pub struct SplittingKernels {
    /// J(q, ∂U), from t and q.
    pub kick: Kernel,
    /// ∂U for each leaf, for the symmetric representation.
    pub gradient: Kernel,
}

/// What a step of order 16 collocates.
pub struct CollocationKernels {
    /// q′ and p′ for each leaf, from t, q and p.
    pub slope: Kernel,
    /// A covector for each leaf, from q and μ.
    pub lift: Kernel,
    /// The chart coordinates of the motion by the velocity of the start, to first order in h, from t, q and μ.
    pub guess: Kernel,
}

/// The kernels of a momentum equation.
pub struct Solve {
    /// The number of unknowns.
    pub dimension: usize,
    /// The unknowns by their indices among the components of all factors.
    pub components: Vec<usize>,
    /// The components of the momentum that it holds: those of its unknowns, and behind them those of coordinates that were put in.
    pub momenta: Vec<usize>,
    /// The coordinates of equations before it that it holds.
    pub given: Vec<usize>,
    /// The coordinates that were put in and have inertia in common with its own.
    pub coupled: Vec<usize>,
    /// How it is solved.
    pub solution: Solution,
    /// What is known of its Jacobian.
    pub structure: Structure,
    /// What is computed once per solve, one output each.
    pub prepare: Kernel,
    /// The starting point, or the solution where there is a formula for it; `None` where the inertia changes with the configuration.
    pub predict: Option<Kernel>,
    /// |a|² of the closed form, which has to be below one.
    pub sine_squared: Option<Kernel>,
    /// ρ(x) alone, where x ← x − s·h·Σ⁻¹ρ(x) is tried before Newton's method.
    pub residual: Option<Kernel>,
    /// ρ(x) and Dρ(x); of a linear equation −ρ(0) and Dρ.
    pub linearize: Kernel,
    /// Whether the equation depends on the configuration, on the time or on the input.
    pub moves: bool,
    /// Whether ρ has poles in the chart, near which no correction is seen.
    pub has_poles: bool,
    /// Whether it depends on the input.
    pub reads_input: bool,
}

impl StepKernels {
    /// Whether a step makes the increments, and does not move by the chart coordinates alone.
    pub fn makes_increments(&self) -> bool {
        self.displace.is_none() || self.update.is_some()
    }

    /// The operations of a step apart from those of iterations.
    pub fn cost_of_moves(&self) -> Cost {
        let solves = self.solves.iter().flat_map(|solve| solve.predict.iter().chain(&solve.sine_squared));
        let kicks = [&self.start, &self.end, &self.start_force, &self.end_force, &self.update].into_iter().flatten();
        let moves = match &self.displace {
            Some(displace) => displace,
            None => &self.advance,
        };
        let increment = self.makes_increments().then_some(&self.increment);
        let kernels = solves.chain(kicks).chain(increment).chain([moves]);
        kernels.map(Kernel::cost).fold(Cost::default(), Cost::plus)
    }
}

/// The kernels of all substeps.
pub(super) fn steps(formulas: &Formulas<'_>, scalars: &mut Scalars, hoisted: &mut Hoisted) -> Vec<StepKernels> {
    let mut steps: Vec<StepKernels> =
        (0..formulas.substeps.len()).map(|index| step(formulas, index, scalars, hoisted)).collect();
    // what serves the inverse Legendre transform alone is never stepped
    for step in steps.iter_mut().skip(formulas.stepped) {
        (step.start_force, step.start_moving, step.end_force) = (None, None, None);
        (step.end, step.start_gradient, step.end_gradient, step.update) = (None, None, None, None);
        (step.rest, step.coupled_gradient) = (None, None);
    }
    steps
}

/// The kicks of a splitting.
pub(super) fn splitting(
    formulas: &Formulas<'_>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Option<SplittingKernels> {
    let splitting = formulas.splitting.as_ref()?;
    let gradient = formulas.value(Id::SplittingGradient)?;
    Some(SplittingKernels {
        kick: stack(scalars, &splitting.kick, Hoisting::Constants(hoisted)),
        gradient: separate(scalars, gradient, Hoisting::Constants(hoisted)),
    })
}

/// Hamilton's equations, and the covector of a momentum.
pub(super) fn collocation(
    formulas: &Formulas<'_>,
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Option<CollocationKernels> {
    let collocation = formulas.collocation.as_ref()?;
    let slopes: Vec<_> = collocation.velocity.iter().chain(&collocation.force).copied().collect();
    Some(CollocationKernels {
        guess: stack(scalars, formulas.value(Id::Guess)?, Hoisting::Constants(hoisted)),
        slope: separate(scalars, &slopes, Hoisting::Constants(hoisted)),
        lift: separate(scalars, &collocation.lift, Hoisting::Constants(hoisted)),
    })
}

fn step(formulas: &Formulas<'_>, index: usize, scalars: &mut Scalars, hoisted: &mut Hoisted) -> StepKernels {
    let substep = &formulas.substeps[index];
    let numbers = 0..substep.equations.len();
    let solves = numbers.map(|number| solve(formulas, (index, number), scalars, hoisted)).collect();
    let mut stacked = |id: Id| formulas.value(id).map(|parts| stack(scalars, parts, Hoisting::Constants(hoisted)));
    let start_force = stacked(Id::StartForce(index));
    let start_moving = stacked(Id::MovingForce(index));
    let end_force = stacked(Id::EndForce(index));
    let start = stacked(Id::StartKick(index));
    let end = stacked(Id::EndKick(index));
    let mut separated = |id: Id| formulas.value(id).map(|parts| separate(scalars, parts, Hoisting::Constants(hoisted)));
    let start_gradient = separated(Id::StartGradient(index));
    let end_gradient = separated(Id::EndGradient(index));
    let rest = formulas.value(Id::RestKick(index)).map(|rest| stack(scalars, rest, Hoisting::Constants(hoisted)));
    let coupled_gradient = formulas.value(Id::CoupledGradient(index));
    let coupled_gradient = coupled_gradient.map(|gradients| separate(scalars, gradients, Hoisting::Constants(hoisted)));
    let couples = substep.other.is_some();
    let advance = of_row(formulas, Id::Advance, scalars);
    // where F − I and the next momentum are found at once, none is made of the other
    let increment = of_row(formulas, Id::Increment, scalars);
    let update = formulas.value(Id::MomentumAfter(index)).map(|after| {
        if couples {
            stack(scalars, after, Hoisting::Constants(hoisted))
        } else {
            stack(scalars, after, Hoisting::Nothing)
        }
    });
    let by_increments = match update.is_some() {
        // the increments are made in any case
        true => advance.cost().total(),
        false => increment.cost().total() + advance.cost().total(),
    };
    let displace = formulas.value(Id::Displacement).map(|images| plain(scalars, images));
    let displace = displace.filter(|_| formulas.weighted().is_empty() && !formulas.turns_whole());
    let displace = displace.filter(|displace| displace.cost().total() < by_increments);
    StepKernels {
        end_is_start: substep.start == substep.end && !formulas.is_timed(),
        start,
        end,
        start_force,
        start_moving,
        end_force,
        start_gradient,
        end_gradient,
        solves,
        increment,
        advance,
        displace,
        update,
        couples,
        rest,
        coupled_gradient,
    }
}

fn solve<'g>(
    formulas: &Formulas<'g>,
    (index, number): (usize, usize),
    scalars: &mut Scalars,
    hoisted: &mut Hoisted,
) -> Solve {
    let substep = &formulas.substeps[index];
    let equation = &substep.equations[number];
    let start = match (equation.formula, equation.solution) {
        (Some(formula), _) => Some(vec![formula]),
        (None, Solution::Linear | Solution::FreeRotation) => None,
        (None, _) if scalars.keeps_matrices => formulas.whole_predictor(index, number),
        (None, _) => formulas.value(Id::Predictor(index, number)).map(<[_]>::to_vec),
    };
    let predict = start.map(|start| stack(scalars, &start, Hoisting::Constants(hoisted)));
    let sine_squared =
        equation.sine_squared.map(|sine_squared| stack(scalars, &[sine_squared], Hoisting::Constants(hoisted)));
    let mut residual = None;
    let system = match equation.solution {
        Solution::Linear => formulas.linear_system(equation, scalars.keeps_matrices).to_vec(),
        Solution::Newton => formulas.newton_system(equation, scalars.keeps_matrices).to_vec(),
        Solution::Explicit | Solution::ClosedForm | Solution::FreeRotation => Vec::new(),
    };
    let (prepare, linearize) = match equation.solution {
        Solution::Explicit | Solution::ClosedForm | Solution::FreeRotation => {
            (kernel(scalars, &[], Hoisting::Nothing), kernel(scalars, &[], Hoisting::Nothing))
        }
        Solution::Linear | Solution::Newton if scalars.keeps_matrices => {
            let linearize = of_matrices(scalars, &system, Hoisting::Nothing);
            match fixed_point::residual_of_matrices(formulas, equation, predict.as_ref()) {
                Some(alone) => {
                    let (prepare, alone) = matrices::hoisted(alone);
                    residual = Some(alone);
                    (prepare, linearize)
                }
                None if equation.solution == Solution::Newton => matrices::hoisted(linearize),
                None => (kernel(scalars, &[], Hoisting::Nothing), linearize),
            }
        }
        Solution::Linear => {
            let linearize = of_matrices(scalars, &system, Hoisting::Constants(hoisted));
            (kernel(scalars, &[], Hoisting::Nothing), linearize)
        }
        Solution::Newton => {
            let mut terms = Hoisted::default();
            let mut linearize = of_matrices(scalars, &system, Hoisting::Terms(hoisted, &mut terms));
            let newton = fixed_point::Newton { linearize: &linearize, predict: predict.as_ref() };
            residual = fixed_point::residual(formulas, equation, &newton, scalars, (hoisted, &mut terms));
            let mut prepare = terms.kernel(scalars, Hoisting::Constants(hoisted));
            // what is there already needs no preparation
            if let Some(reads) = prepare.reads() {
                (prepare, linearize) = (Kernel::default(), linearize.with_terms(&reads));
                residual = residual.map(|alone| alone.with_terms(&reads));
            }
            (prepare, linearize)
        }
    };
    let mut solve = Solve {
        dimension: equation.components.len(),
        components: equation.components.clone(),
        momenta: equation.components.clone(),
        given: Vec::new(),
        coupled: equation.coupled.clone(),
        solution: equation.solution,
        structure: match formulas.value(Id::JacobianFactor(index, number)).filter(|_| scalars.keeps_matrices) {
            Some(factor) => Structure::Sylvester(factor[0].shape().rows),
            None => equation.structure.clone(),
        },
        prepare,
        predict,
        sine_squared,
        residual,
        linearize,
        moves: equation.moves,
        has_poles: {
            let blocks = formulas.symbols.blocks.iter().map(|block| block.coordinates);
            equation.residual.has_poles_in(&blocks.collect::<Vec<_>>())
        },
        reads_input: formulas.model.inputs.iter().any(|leaf| equation.residual.depends_on(leaf.symbol)),
    };
    let (momenta, coordinates) = solve.read(formulas);
    solve.momenta.extend(momenta.into_iter().filter(|component| !equation.components.contains(component)));
    solve.given.extend(coordinates.into_iter().filter(|component| !equation.components.contains(component)));
    // Σ⁻¹ρ takes the components of its own unknowns alone
    solve.residual = solve.residual.filter(|_| solve.momenta.len() == solve.dimension && solve.given.is_empty());
    solve
}

impl Solve {
    /// Whether an entry of Dρ is zero, whatever the numbers are.
    pub fn is_zero(&self, i: usize, j: usize) -> bool {
        // of a matrix that is kept as a whole no entry is known
        let entry = self.linearize.outputs[1].1.get(i * self.dimension + j);
        matches!(entry, Some(Code::Number(value)) if value.is_zero())
    }

    /// The components of the momentum and the chart coordinates that its kernels read, by their indices among those of all factors.
    fn read(&self, formulas: &Formulas<'_>) -> (BTreeSet<usize>, BTreeSet<usize>) {
        let (mut momenta, mut coordinates) = (BTreeSet::new(), BTreeSet::new());
        let kernels = [&self.prepare, &self.linearize].into_iter().chain(&self.predict).chain(&self.sine_squared);
        for input in kernels.flat_map(Kernel::inputs) {
            match input.role {
                Role::Momentum(k) => momenta.insert(formulas.model.offset(k) + input.row),
                Role::Chart(block) => coordinates.insert(formulas.symbols.blocks[block].offset + input.row),
                _ => false,
            };
        }
        let kernels = [&self.prepare, &self.linearize].into_iter().chain(&self.predict).chain(&self.sine_squared);
        for (input, shape) in kernels.flat_map(Kernel::arguments) {
            match input.role {
                Role::Momentum(k) => momenta.extend((0..shape.rows).map(|row| formulas.model.offset(k) + row)),
                Role::Chart(block) => coordinates.extend(formulas.symbols.blocks[block].components()),
                _ => {}
            }
        }
        (momenta, coordinates)
    }
}
