//! The kernels of a program, called in the order in which emitted code calls them.

use std::cell::RefCell;

use clebsch::__private::{Equation, LinearEquation, solve, solve_linear_equation};
use clebsch_compiler::derive::{Id, Solution};
use clebsch_compiler::lower::{Kernel, MechanicsProgram, Solve};
use clebsch_symbolic::{Property, Role, Shape};
use nalgebra::{SMatrix, SVector};

use crate::kernels::Values;

/// A program with the values of its parameters.
pub struct Stepper<'a, 'g> {
    program: &'a MechanicsProgram<'g>,
    values: Values,
    constants: Vec<f64>,
    /// The multipliers of the pushes of a constraint in the last step.
    pub impulses: Vec<Vec<f64>>,
}

/// The leaves of a configuration as the program sees them, row by row, and the components of all momenta.
#[derive(Clone, Debug)]
pub struct Seen {
    pub q: Vec<Vec<f64>>,
    pub mu: Vec<f64>,
}

impl Seen {
    /// The state with increments added.
    pub fn with(&self, increments: &Seen) -> Seen {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        let leaves = self.q.iter().zip(&increments.q).map(|(a, b)| sum(a, b)).collect();
        Seen { q: leaves, mu: sum(&self.mu, &increments.mu) }
    }
}

impl<'a, 'g> Stepper<'a, 'g> {
    /// As `stepper(h)`; parameters in the order of the fields.
    pub fn new(program: &'a MechanicsProgram<'g>, fields: &[Vec<f64>], h: f64) -> Stepper<'a, 'g> {
        let model = &program.formulas.model;
        let mut values = Values::default();
        values.set(model.step_size, &[h]);
        for parameter in &model.parameters {
            let number = parameter.name.trim_start_matches("field_");
            let index: usize = number.parse().expect("a field of ours");
            for leaf in &parameter.leaves {
                values.set(leaf.symbol, &fields[index]);
            }
        }
        if !program.formulas.inertia_moves() {
            let inverse = values.inertia(program).inverse().0;
            values.0.insert("inertia_inverse".into(), inverse);
        }
        let constants = values.run(program.kernel(Id::Constants), &[], &[]).concat();
        // coordinates that a constraint leaves at zero have no equation
        for block in &program.formulas.symbols.blocks {
            values.set(block.coordinates, &vec![0.0; block.dimension()]);
        }
        Stepper { program, values, constants, impulses: Vec::new() }
    }

    fn place(&mut self, t: f64, state: &Seen) {
        let formulas = &self.program.formulas;
        self.values.set(formulas.model.time, &[t]);
        for (leaf, entries) in formulas.model.configurations.iter().zip(&state.q) {
            self.values.set(leaf.symbol, entries);
        }
        self.impel(&state.mu);
    }

    fn impel(&mut self, mu: &[f64]) {
        let mut from = 0;
        for symbol in &self.program.formulas.symbols.momenta {
            let to = from + symbol.shape().rows;
            self.values.set(*symbol, &mu[from..to]);
            from = to;
        }
    }

    /// The outputs of a kernel, where the program has it.
    fn found(&self, id: Id) -> Option<Vec<Vec<f64>>> {
        self.program.find(id).map(|kernel| self.run(kernel))
    }

    fn run(&self, kernel: &Kernel) -> Vec<Vec<f64>> {
        self.values.run(kernel, &self.constants, &[])
    }

    /// One step from time t, or why there is none.
    pub fn step(&mut self, t: f64, state: &Seen) -> Result<Seen, String> {
        let mut state = state.clone();
        self.impulses.clear();
        for index in 0..self.program.formulas.stepped {
            state = self.substep(t, &state, index)?;
        }
        Ok(state)
    }

    fn substep(&mut self, t: f64, state: &Seen, index: usize) -> Result<Seen, String> {
        let program = self.program;
        let step = &program.steps[index];
        let h = self.values.get(program.formulas.model.step_size)[0];
        let mut state = state.clone();
        self.place(t, &state);
        self.kick(Id::StartKick(index), &mut state.mu);
        let mut solved_for = state.mu.clone();
        if self.program.formulas.is_compensated() {
            self.kick(Id::RestKick(index), &mut solved_for);
        }
        for solve in &step.solves {
            self.solve(solve, &solved_for)?;
        }
        self.impel(&state.mu);
        let increments = self.found(Id::Increment).unwrap_or_default();
        for (symbol, increment) in self.program.formulas.symbols.increments.iter().zip(&increments) {
            self.values.set(*symbol, increment);
        }
        self.push(Id::Reaction(index), &mut state.mu, t);
        let updated = self.found(Id::MomentumAfter(index)).map(|mut update| update.remove(0));
        let moved = self.moved();
        state = match self.program.formulas.is_compensated() {
            true => state.with(&Seen { q: moved, mu: updated.unwrap_or_else(|| vec![0.0; state.mu.len()]) }),
            false => Seen { q: moved, mu: updated.unwrap_or(state.mu) },
        };
        self.place(t, &state);
        let end = if step.end_is_start { Id::StartKick(index) } else { Id::EndKick(index) };
        if program.find(Id::EndKick(index)).is_some() {
            self.kick(end, &mut state.mu);
        }
        self.push(Id::Projection(index), &mut state.mu, t + h);
        Ok(state)
    }

    /// The data that moves the configuration: the chart coordinates or the increments.
    fn moved(&self) -> Vec<Vec<f64>> {
        self.found(Id::Displacement).or_else(|| self.found(Id::Advance)).unwrap_or_default()
    }

    /// The increments of (q, N) by the move of a step without kicks, where sums are compensated; a step of one part.
    pub fn increments(&mut self, t: f64, state: &Seen) -> Result<Seen, String> {
        let (program, step) = (self.program, &self.program.steps[0]);
        self.place(t, state);
        let mut mu = state.mu.clone();
        self.kick(Id::RestKick(0), &mut mu);
        for solve in &step.solves {
            self.solve(solve, &mu)?;
        }
        self.impel(&state.mu);
        let increments = self.found(Id::Increment).unwrap_or_default();
        for (symbol, increment) in program.formulas.symbols.increments.iter().zip(&increments) {
            self.values.set(*symbol, increment);
        }
        let q = self.moved();
        let mu = self.found(Id::MomentumAfter(0)).map_or(vec![0.0; mu.len()], |mut update| update.remove(0));
        Ok(Seen { q, mu })
    }

    /// (q′, N′) by Hamilton's equations at a covector of N, and by how much the momentum of that covector misses N.
    pub fn slopes(&mut self, t: f64, state: &Seen) -> Option<(Seen, f64)> {
        self.place(t, state);
        let p = self.found(Id::Covector)?;
        let found = self.momentum_map(&state.q, &p);
        let missed = found.iter().zip(&state.mu).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        self.momentum_map(&state.q, &p);
        let terms = self.run(self.program.kernel(Id::TermsOfTime)).concat();
        let slopes = self.values.run(self.program.kernel(Id::HamiltonEquations), &self.constants, &terms);
        let (q, slope) = slopes.split_at(state.q.len());
        let origin: Vec<Vec<f64>> = state.q.iter().map(|leaf| vec![0.0; leaf.len()]).collect();
        let [along, at_origin, pushed] =
            [self.momentum_map(q, &p), self.momentum_map(&origin, &p), self.momentum_map(&state.q, slope)];
        let mu = along.iter().zip(&at_origin).zip(&pushed).map(|((along, origin), pushed)| along - origin + pushed);
        Some((Seen { q: q.to_vec(), mu: mu.collect() }, missed))
    }

    /// J(q, p), which leaves q and p in their places.
    pub fn momentum_map(&mut self, q: &[Vec<f64>], p: &[Vec<f64>]) -> Vec<f64> {
        let formulas = &self.program.formulas;
        for (leaf, entries) in formulas.model.configurations.iter().zip(q) {
            self.values.set(leaf.symbol, entries);
        }
        for (symbol, entries) in formulas.symbols.covectors.iter().zip(p) {
            self.values.set(*symbol, entries);
        }
        self.run(self.program.kernel(Id::MomentumMap)).concat()
    }

    /// A push of the constraint, whose multipliers are noted. The formulas of a step are of the time at its start, and multipliers of that of the push.
    fn push(&mut self, id: Id, mu: &mut [f64], t: f64) {
        let Some(mut push) = self.found(id) else { return };
        let push = push.remove(0);
        self.impel(&push);
        self.values.set(self.program.formulas.model.time, &[t]);
        let found = self.run(self.program.kernel(Id::Multipliers));
        self.impulses.push(solution(&found[0], &found[1]));
        mu.iter_mut().zip(push).for_each(|(mu, push)| *mu += push);
        self.impel(mu);
    }

    /// λ of the motion through a state.
    pub fn reactions(&mut self, t: f64, state: &Seen) -> Vec<f64> {
        self.place(t, state);
        let found = self.run(self.program.kernel(Id::Reactions));
        solution(&found[0], &found[1])
    }

    /// φ of the places, and A ξ − b at the velocity ξ of the momentum.
    pub fn defects(&mut self, t: f64, state: &Seen) -> [Vec<f64>; 2] {
        self.place(t, state);
        let places = self.found(Id::Places).map(|mut found| found.remove(0)).unwrap_or_default();
        let found = self.run(self.program.kernel(Id::Constraint));
        let (rows, values, xi) = (&found[0], &found[1], &found[2]);
        let row = |(i, value): (usize, &f64)| {
            let row = &rows[i * xi.len()..(i + 1) * xi.len()];
            row.iter().zip(xi).map(|(a, xi)| a * xi).sum::<f64>() - value
        };
        [places, values.iter().enumerate().map(row).collect()]
    }

    /// Σξ + A.
    pub fn momentum_of(&mut self, t: f64, q: &Seen, xi: &[f64]) -> Vec<f64> {
        self.place(t, q);
        let mut from = 0;
        for symbol in &self.program.formulas.symbols.algebra {
            let to = from + symbol.shape().rows;
            self.values.set(*symbol, &xi[from..to]);
            from = to;
        }
        self.run(self.program.kernel(Id::MomentumOfVelocity)).concat()
    }

    fn kick(&mut self, id: Id, mu: &mut [f64]) {
        let Some(mut kick) = self.found(id) else { return };
        let kick = kick.remove(0);
        mu.iter_mut().zip(kick).for_each(|(mu, kick)| *mu += kick);
        self.impel(mu);
    }

    /// Sets the chart coordinates of the factors that an equation is for.
    fn solve(&mut self, solve: &Solve, mu: &[f64]) -> Result<(), String> {
        if matches!(solve.solution, Solution::Explicit | Solution::ClosedForm) {
            let is_closed = solve.solution == Solution::ClosedForm;
            let solution = self.found(solve.id(if is_closed { Id::ClosedForm } else { Id::Explicit }));
            let x = solution.ok_or("no formula for the solution")?.remove(0);
            self.turn(solve, &x);
            let sine_squared = self.found(solve.id(Id::SineSquared)).map_or(0.0, |sine_squared| sine_squared[0][0]);
            return if sine_squared < 1.0 { Ok(()) } else { Err(format!("sin² = {sine_squared}")) };
        }
        let equation = Interpreted { stepper: RefCell::new(self), solve, mu };
        let solution = solved(&equation)?;
        self.turn(solve, &solution);
        Ok(())
    }

    /// Gives an equation's unknowns their values.
    fn turn(&mut self, solve: &Solve, x: &[f64]) {
        // x itself, where the program takes it with a weight
        let graph = self.program.formulas.model.graph;
        let weight = graph.symbol("w", Shape::scalar(), Role::ChartWeight(0), Property::General);
        self.values.set(weight, &[1.0]);
        // F − I = c·D with the D of `Increment`, which has c in it
        let count = self.program.formulas.scaled().len();
        for number in 0..count {
            let scale = graph.symbol("c", Shape::scalar(), Role::IncrementScale(number), Property::General);
            self.values.set(scale, &[1.0]);
        }
        for block in &self.program.formulas.symbols.blocks {
            let known = self.values.0.get(&block.coordinates.as_symbol().expect("a symbol").name);
            let mut entries = known.map_or(vec![0.0; block.dimension()], |known| known.entries.clone());
            for (&component, value) in solve.components.iter().zip(x) {
                if block.components().contains(&component) {
                    entries[component - block.offset] = *value;
                }
            }
            self.values.set(block.coordinates, &entries);
        }
    }

    /// Kinetic and potential energy as the program has them; `None` where no velocity is found.
    pub fn energy(&mut self, t: f64, state: &Seen) -> Option<f64> {
        self.place(t, state);
        let program = self.program;
        let potential = self.values.run(program.kernel(Id::PotentialEnergy), &[], &[])[0][0];
        if let Some(kernel) = program.find(Id::Lagrangian) {
            return Some(self.fenchel(kernel, &state.mu)? + potential);
        }
        let slope = program.find(Id::Gyroscopic).map(|kernel| self.values.run(kernel, &[], &[]).remove(0));
        let mut mu = state.mu.clone();
        mu.iter_mut().zip(slope.unwrap_or_default()).for_each(|(mu, slope)| *mu -= slope);
        let inertia = self.values.inertia(program).entries;
        let xi = solution(&inertia, &mu);
        Some(mu.iter().zip(xi).map(|(mu, xi)| mu * xi).sum::<f64>() / 2.0 + potential)
    }

    /// max_ξ ⟨μ, ξ⟩ − ℓ(ξ) by Newton's method.
    fn fenchel(&mut self, kernel: &Kernel, mu: &[f64]) -> Option<f64> {
        let mut xi = vec![0.0; mu.len()];
        for _ in 0..60 {
            let mut from = 0;
            for symbol in &self.program.formulas.symbols.algebra {
                let to = from + symbol.shape().rows;
                self.values.set(*symbol, &xi[from..to]);
                from = to;
            }
            let outputs = self.values.run(kernel, &[], &[]);
            let defect: Vec<f64> = mu.iter().zip(&outputs[1]).map(|(mu, gradient)| mu - gradient).collect();
            let correction = solution(&outputs[2], &defect);
            xi.iter_mut().zip(&correction).for_each(|(xi, correction)| *xi += correction);
            if correction.iter().all(|c| c.abs() < 1e-13) {
                return Some(mu.iter().zip(&xi).map(|(mu, xi)| mu * xi).sum::<f64>() - outputs[0][0]);
            }
        }
        None
    }

    /// The momenta that the program calls conserved.
    pub fn conserved(&mut self, t: f64, state: &Seen) -> Vec<f64> {
        self.place(t, state);
        let values = self.program.find(Id::ConservedMomenta).map(|kernel| self.values.run(kernel, &[], &[]).concat());
        values.unwrap_or_default()
    }
}

/// An equation of a program, for the solvers of the runtime.
struct Interpreted<'a, 'b, 'g> {
    stepper: RefCell<&'a mut Stepper<'b, 'g>>,
    solve: &'a Solve,
    /// All momenta; the equation has some of them.
    mu: &'a [f64],
}

/// More momenta than any equation of these tests holds: those behind its own are not read.
const MOMENTA: usize = 12;

impl Interpreted<'_, '_, '_> {
    /// Runs something where the equation's momenta have other values.
    fn aimed<R>(&self, target: &SVector<f64, MOMENTA>, run: impl Fn(&Stepper<'_, '_>) -> R) -> R {
        let mut mu = self.mu.to_vec();
        self.solve.momenta.iter().zip(target).for_each(|(&component, value)| mu[component] = *value);
        let mut stepper = self.stepper.borrow_mut();
        stepper.impel(&mu);
        let result = run(&stepper);
        stepper.impel(self.mu);
        result
    }
}

impl Interpreted<'_, '_, '_> {
    /// Whether the program has no linearisation, as the runtime finds one scalar. Here it is Newton's method for x.
    fn is_rotation(&self) -> bool {
        matches!(self.solve.solution, Solution::Rotation(_))
    }

    /// ρ and Dρ by their formulas, for the momentum in the terms.
    fn linearized_by_formulas<const M: usize>(
        &self,
        terms: &[f64],
        x: &SVector<f64, M>,
    ) -> (SVector<f64, M>, SMatrix<f64, M, M>) {
        self.stepper.borrow_mut().turn(self.solve, x.as_slice());
        self.aimed(&SVector::from_column_slice(terms), |stepper| {
            let formulas = &stepper.program.formulas;
            let equation = &formulas.substeps[self.solve.substep].equations[self.solve.number];
            let columns = equation.columns(&formulas.symbols);
            let columns: Vec<f64> =
                columns.into_iter().flat_map(|column| stepper.values.evaluate(column).entries).collect();
            let residual = stepper.values.evaluate(equation.residual).entries;
            (SVector::from_column_slice(&residual), SMatrix::from_column_slice(&columns))
        })
    }
}

impl<const M: usize> Equation<f64, M, MOMENTA> for Interpreted<'_, '_, '_> {
    type Terms = Vec<f64>;
    type Jacobian = SMatrix<f64, M, M>;

    fn prepare(&self, target: &SVector<f64, MOMENTA>) -> Vec<f64> {
        if self.is_rotation() {
            return target.as_slice().to_vec();
        }
        self.aimed(target, |stepper| stepper.run(stepper.program.kernel(self.solve.id(Id::Preparation))).concat())
    }

    fn extent(&self) -> f64 {
        let stepper = self.stepper.borrow();
        let formulas = &stepper.program.formulas;
        let substep = &formulas.substeps[self.solve.substep];
        let has_extent = formulas.has_extent(substep, &substep.equations[self.solve.number]);
        let entries = formulas.model.configurations.iter().flat_map(|leaf| stepper.values.get(leaf.symbol));
        if has_extent { entries.fold(1.0, |sum: f64, entry| sum.max(1.0 + entry.abs())) } else { 0.0 }
    }

    fn predict(&self, target: &SVector<f64, MOMENTA>) -> SVector<f64, M> {
        let found = self.aimed(target, |stepper| stepper.found(self.solve.id(Id::Predictor)));
        found.map_or(SVector::zeros(), |predicted| SVector::from_column_slice(&predicted[0]))
    }

    fn linearize(&self, terms: &Vec<f64>, x: &SVector<f64, M>) -> (SVector<f64, M>, SMatrix<f64, M, M>) {
        if self.is_rotation() {
            return self.linearized_by_formulas(terms, x);
        }
        let mut stepper = self.stepper.borrow_mut();
        stepper.turn(self.solve, x.as_slice());
        let outputs = stepper.values.run(stepper.program.linearization(self.solve), &stepper.constants, terms);
        (SVector::from_column_slice(&outputs[0]), SMatrix::from_row_slice(&outputs[1]))
    }
}

impl<const M: usize> LinearEquation<f64, M, MOMENTA> for Interpreted<'_, '_, '_> {
    fn system(&self, target: &SVector<f64, MOMENTA>) -> (SMatrix<f64, M, M>, SVector<f64, M>) {
        let outputs = self.aimed(target, |stepper| stepper.run(stepper.program.linearization(self.solve)));
        (SMatrix::from_row_slice(&outputs[1]), SVector::from_column_slice(&outputs[0]))
    }
}

/// The solution on the branch of the identity, by the solvers that emitted code calls.
fn solved(equation: &Interpreted<'_, '_, '_>) -> Result<Vec<f64>, String> {
    let mut target = SVector::<f64, MOMENTA>::zeros();
    let momenta = equation.solve.momenta.iter().map(|&component| equation.mu[component]);
    target.iter_mut().zip(momenta).for_each(|(target, mu)| *target = mu);
    let is_linear = equation.solve.solution == Solution::Linear;
    macro_rules! of_dimension {
        ($($m:literal)*) => {
            match equation.solve.dimension {
                $($m => {
                    let x: Result<SVector<f64, $m>, _> =
                        if is_linear { solve_linear_equation(equation, &target) } else { solve(equation, &target) };
                    x.map(|x| x.as_slice().to_vec())
                })*
                other => return Err(format!("an equation for {other} unknowns")),
            }
        };
    }
    of_dimension!(1 2 3 4 5 6 7 8 9 10).map_err(|error| format!("no step: {error:?}"))
}

/// A⁻¹ b.
fn solution(a: &[f64], b: &[f64]) -> Vec<f64> {
    use clebsch_tests::oracle::precise::matrix::Matrix;
    Matrix::of(b.len(), b.len(), a).solve(&Matrix::vector(b)).entries().to_vec()
}
