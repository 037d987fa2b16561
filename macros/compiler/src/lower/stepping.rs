//! The kernels of a step: kick, solve, move, update.

use std::collections::BTreeSet;

use clebsch_symbolic::{Elements, IntoList, Role};

use super::made::{Maker, of_matrices, plain, separate};
use super::{Code, Hoisted, Hoisting, Kernel, MechanicsProgram, Step, TooLong, matrices};
use crate::derive::{Id, MechanicsFormulas, MomentumEquation, Solution, Structure, SystemFormulas};
use crate::model::Solver;

/// The data of a momentum equation other than its kernels.
pub struct Solve {
    /// Its substep.
    pub substep: usize,
    /// Its number in the substep.
    pub number: usize,
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
    /// Whether its closed form has the multipliers of a constraint in it.
    pub has_multipliers: bool,
    /// The known structure of its Jacobian.
    pub structure: Structure,
    /// Whether the equation depends on the configuration, on the time or on the input.
    pub moves: bool,
    /// Whether ρ has poles in the chart, near which no correction is seen.
    pub has_poles: bool,
    /// Whether it depends on the input.
    pub reads_input: bool,
}

impl<'g> Maker<'_, 'g> {
    /// The kernels of all substeps, and of the moves that they have in common.
    ///
    /// # Errors
    /// Unrolled code that is too long.
    pub(super) fn steps(&mut self, formulas: &MechanicsFormulas<'g>) -> Result<Vec<Step>, TooLong> {
        let steps: Vec<Step> =
            (0..formulas.substeps.len()).map(|index| self.step(formulas, index)).collect::<Result<_, _>>()?;
        // the inverse Legendre transform alone is kicked and solved, and never stepped
        self.table.retain(|(id, _)| {
            let is_solved = id.equation().is_some() || matches!(id, Id::StartKick(_));
            is_solved || id.substep().is_none_or(|index| index < formulas.stepped)
        });
        Ok(steps)
    }

    fn step(&mut self, formulas: &MechanicsFormulas<'g>, index: usize) -> Result<Step, TooLong> {
        let substep = &formulas.substeps[index];
        let mut solves = Vec::with_capacity(substep.equations.len());
        for number in 0..substep.equations.len() {
            solves.push(self.solve(formulas, index, number));
            self.check_length()?;
        }
        self.known_rows(
            [Id::StartForce, Id::MovingForce, Id::EndForce, Id::StartKick, Id::EndKick].map(|id| id(index)),
        );
        self.known_rows([Id::Reaction, Id::Projection].map(|id| id(index)));
        self.known_rows([Id::StartGradient, Id::EndGradient, Id::RestKick, Id::CoupledGradient].map(|id| id(index)));
        // where F − I and the next momentum are found at once, none is made of the other
        if index == 0 {
            self.rows([Id::Advance]);
            self.known_rows([Id::Increment, Id::ScaledIncrement, Id::ScaledAdvance]);
        }
        self.known_rows([Id::MomentumAfter(index)]);
        if index == 0 {
            self.displacement(formulas);
        }
        Ok(Step { end_is_start: substep.start == substep.end && !formulas.is_timed(), solves })
    }

    /// q⁺ by the chart coordinates, where that costs less than by the increments.
    fn displacement(&mut self, formulas: &MechanicsFormulas<'g>) {
        let Some(images) = self.rows.value(Id::Displacement) else { return };
        let displacement = plain(&mut self.scalars, images);
        // where the momentum changes, the increments are made in any case
        let makes_increments = self.has(Id::MomentumAfter(0));
        let moves = self.table.iter().filter(|(id, _)| match id {
            Id::Advance => true,
            Id::Increment => !makes_increments,
            _ => false,
        });
        let by_increments = moves.map(|(_, kernel)| kernel.cost().total()).sum::<usize>();
        let serves = formulas.weighted().is_empty() && !formulas.turns_whole();
        if serves && displacement.cost().total() < by_increments {
            self.add(Id::Displacement, |_, _| displacement);
        }
    }

    /// Hamilton's equations, q′ and p′ for each leaf, and the covector of a momentum.
    pub(super) fn collocation(&mut self, formulas: &MechanicsFormulas<'g>) {
        let Some(collocation) = &formulas.collocation else { return };
        let slopes: Vec<_> = collocation.velocity.iter().chain(&collocation.force).copied().into_list();
        self.known_rows([Id::Guess]);
        let mut terms = Hoisted::default();
        self.add(Id::HamiltonEquations, |scalars, hoisted| match scalars.keeps_matrices {
            true => separate(scalars, &slopes, Hoisting::Constants(hoisted)),
            false => separate(scalars, &slopes, Hoisting::Times(hoisted, &mut terms)),
        });
        self.add(Id::Covector, |scalars, hoisted| separate(scalars, &collocation.lift, Hoisting::Constants(hoisted)));
        if terms.kept().next().is_some() {
            self.add(Id::TermsOfTime, |scalars, hoisted| terms.kernel(scalars, Hoisting::Constants(hoisted)));
        }
    }

    fn solve(&mut self, formulas: &MechanicsFormulas<'g>, index: usize, number: usize) -> Solve {
        let keeps_matrices = self.scalars.keeps_matrices;
        let equation = &formulas.substeps[index].equations[number];
        let start = match (equation.formula, equation.solution) {
            (Some(formula), _) => Some(vec![formula]),
            (None, Solution::Linear | Solution::FreeRotation | Solution::Rotation(_)) => None,
            (None, _) if keeps_matrices => formulas.whole_predictor(index, number),
            (None, _) => formulas.table().value(Id::Predictor(index, number)).map(<[_]>::to_vec),
        };
        let solved = match equation.solution {
            Solution::ClosedForm => Id::ClosedForm(index, number),
            Solution::Explicit => Id::Explicit(index, number),
            Solution::Newton | Solution::Linear | Solution::FreeRotation | Solution::Rotation(_) => {
                Id::Predictor(index, number)
            }
        };
        let predict = start.map(|start| self.stack(&start));
        let sine_squared = equation.sine_squared.map(|square| (Id::SineSquared(index, number), self.stack(&[square])));
        let mut kernels: Vec<(Id, Kernel)> = sine_squared.into_iter().into_list();
        let mut residual = None;
        match equation.solution {
            Solution::Explicit | Solution::ClosedForm | Solution::FreeRotation | Solution::Rotation(_) => {}
            Solution::Linear => {
                let system = formulas.linear_system(equation, keeps_matrices);
                let system = of_matrices(&mut self.scalars, &system, Hoisting::Constants(&mut self.hoisted));
                kernels.push((Id::System(index, number), system));
            }
            Solution::Newton => {
                let (prepare, linearize, alone) = self.iteration(formulas, equation, predict.as_ref());
                kernels.push((Id::Preparation(index, number), prepare));
                kernels.push((Id::Linearization(index, number), linearize));
                residual = alone;
            }
        }
        kernels.extend(predict.map(|kernel| (solved, kernel)));
        let (momenta, given) = read(formulas, &kernels);
        let is_other = |component: &usize| !equation.components.contains(component);
        let given: Vec<usize> = given.into_iter().filter(is_other).into_list();
        let momenta = equation.components.iter().copied().chain(momenta.into_iter().filter(is_other));
        let momenta: Vec<usize> = momenta.into_list();
        // Σ⁻¹ρ takes the components of its own unknowns alone
        let residual = residual.filter(|_| momenta.len() == equation.components.len() && given.is_empty());
        kernels.extend(residual.map(|kernel| (Id::Residual(index, number), kernel)));
        self.table.extend(kernels);
        let blocks: Vec<_> = formulas.symbols.blocks.each(|block| block.coordinates);
        Solve {
            substep: index,
            number,
            dimension: equation.components.len(),
            components: equation.components.clone(),
            momenta,
            given,
            coupled: equation.coupled.clone(),
            solution: equation.solution,
            has_multipliers: equation.solution == Solution::ClosedForm && formulas.substeps[index].reaction.is_some(),
            structure: match formulas.table().value(Id::JacobianFactor(index, number)).filter(|_| keeps_matrices) {
                Some(factor) => Structure::Sylvester(factor[0].shape().rows),
                None => equation.structure.clone(),
            },
            moves: equation.moves,
            has_poles: equation.residual.has_poles_in(&blocks),
            reads_input: formulas.model.inputs.iter().any(|leaf| equation.residual.depends_on(leaf.symbol)),
        }
    }

    /// The part of Newton's method that is computed once, and the part that it linearises. If the residual is tried
    /// alone first, its kernel is there too.
    fn iteration(
        &mut self,
        formulas: &MechanicsFormulas<'g>,
        equation: &MomentumEquation<'g>,
        predict: Option<&Kernel>,
    ) -> (Kernel, Kernel, Option<Kernel>) {
        let system = formulas.newton_system(equation, self.scalars.keeps_matrices);
        let predict = predict.filter(|_| serves(formulas, equation));
        if self.scalars.keeps_matrices {
            let linearize = of_matrices(&mut self.scalars, &system, Hoisting::Nothing);
            // a linear system costs more than many residuals
            if predict.is_some() {
                let (prepare, alone) = matrices::hoisted(matrices::kernel(&[equation.residual]));
                return (prepare, linearize, Some(alone));
            }
            let (prepare, linearize) = matrices::hoisted(linearize);
            return (prepare, linearize, None);
        }
        let mut terms = Hoisted::default();
        let linearize = of_matrices(&mut self.scalars, &system, Hoisting::Terms(&mut self.hoisted, &mut terms));
        let residual = predict.and_then(|predict| {
            let (mut constants, mut more) = (self.hoisted.clone(), terms.clone());
            let residual = [formulas.residual_by_halves(equation)];
            let residual = separate(&mut self.scalars, &residual, Hoisting::Terms(&mut constants, &mut more));
            let unknowns = equation.components.len();
            let iteration = operations(&residual) + operations(predict) + 4 * unknowns;
            let linearization = operations(&linearize) + 2 * unknowns * unknowns * (unknowns + 3) / 3;
            let is_asked = solver(formulas) == Some(Solver::FixedPoint);
            (is_asked || linearization >= RESIDUALS * iteration).then(|| {
                (self.hoisted, terms) = (constants, more);
                residual
            })
        });
        let prepare = terms.kernel(&mut self.scalars, Hoisting::Constants(&mut self.hoisted));
        // a term that is there already needs no preparation
        match prepare.reads() {
            Some(reads) => {
                (Kernel::default(), linearize.with_terms(&reads), residual.map(|alone| alone.with_terms(&reads)))
            }
            None => (prepare, linearize, residual),
        }
    }
}

/// The components of the momentum and the chart coordinates that some kernels read, by their indices among those of all factors.
fn read(formulas: &SystemFormulas<'_>, kernels: &[(Id, Kernel)]) -> (BTreeSet<usize>, BTreeSet<usize>) {
    let (mut momenta, mut coordinates) = (BTreeSet::new(), BTreeSet::new());
    for (input, shape) in kernels.iter().flat_map(|(_, kernel)| kernel.inputs()) {
        let rows = input.row..input.row + shape.rows;
        match input.role {
            Role::Momentum(k) => momenta.extend(rows.map(|row| formulas.model.offset(k) + row)),
            Role::Chart(block) => coordinates.extend(rows.map(|row| formulas.symbols.blocks[block].offset + row)),
            _ => {}
        }
    }
    (momenta, coordinates)
}

impl Solve {
    /// The id of one of its kernels.
    pub fn id(&self, of: fn(usize, usize) -> Id) -> Id {
        of(self.substep, self.number)
    }
}

impl MechanicsProgram<'_> {
    /// Whether an entry of the Jacobian of an equation is zero, whatever the numbers are.
    pub fn is_zero(&self, solve: &Solve, i: usize, j: usize) -> bool {
        // the entries of a matrix in matrix code are not known
        let entry = self.linearization(solve).outputs[1].1.get(i * solve.dimension + j);
        matches!(entry, Some(Code::Number(value)) if value.is_zero())
    }
}

// Some momentum equations are solved by x ← x − s·h·Σ⁻¹ρ(x), a step of Newton's method with the Jacobian at the
// identity. The iteration contracts like h|ω|. For h|ω| from 0.001 to 0.05 it takes five to eight residuals. Newton's
// method takes two linearisations with their linear systems, whose code is long.

/// A linearisation with its linear system has to cost as many residuals, or Newton's method is taken.
const RESIDUALS: usize = 3;

/// A function of a matrix counts for as many operations.
const MATRIX_FUNCTION: usize = 1000;

/// Whether ρ alone may be tried: Newton's method is not asked for, and the predictor is s·h·Σ⁻¹ in the unknowns themselves.
fn serves(formulas: &MechanicsFormulas<'_>, equation: &MomentumEquation<'_>) -> bool {
    let is_asked = solver(formulas) != Some(Solver::Newton);
    is_asked && equation.is_inertial && !equation.moves && equation.coupled.is_empty()
}

fn solver(formulas: &MechanicsFormulas<'_>) -> Option<Solver> {
    formulas.model.dials.solver.as_ref().map(|solver| solver.value)
}

/// The operations of a kernel, with those of the functions of matrices that it calls.
fn operations(kernel: &Kernel) -> usize {
    let calls = kernel.locals.iter().filter(|code| matches!(code, Code::Call(..))).count();
    kernel.cost().total() + MATRIX_FUNCTION * calls
}
