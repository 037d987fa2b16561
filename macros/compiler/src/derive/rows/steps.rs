//! The rows of a step: kicks, the momentum equation, the momentum after the move, splittings and collocation.

use clebsch_symbolic::Expr;

use crate::derive::{Formula, Id, MechanicsFormulas, MomentumEquation, Solution, Substep};

impl<'g> MechanicsFormulas<'g> {
    /// Kicks are functions of the time at which the step starts, as their methods are.
    pub(super) fn rows_of_substep(&self, index: usize) -> Vec<Formula<'g>> {
        let (substep, q) = (&self.substeps[index], self.q());
        let mut rows = Vec::new();
        if let Some(start) = &substep.start {
            rows.push(Formula::shorter(Id::StartKick(index), "M − N", &self.as_of_start(substep.begins, start)));
        }
        for number in 0..substep.equations.len() {
            rows.extend(self.rows_of_equation(index, number));
        }
        rows.push(self.row_of_update(index, substep));
        if let Some(after) = self.momentum_after(substep).filter(|_| !self.turns_whole()) {
            let symbol = if self.is_compensated() { "M⁺ − μ" } else { "M⁺" };
            rows.push(Formula::shorter(Id::MomentumAfter(index), symbol, &after));
        }
        if let Some(end) = &substep.end {
            let end = self.as_of_start(substep.ends, end);
            rows.push(Formula::shorter(Id::EndKick(index), format!("N⁺ − M⁺, at {q}⁺"), &end));
        }
        if let Some(rest) = &substep.rest {
            rows.push(Formula::shorter(Id::RestKick(index), format!("−r({q}, I)"), rest));
        }
        rows.extend(self.rows_of_covectors(index, substep));
        rows.extend(self.rows_of_forces(index, substep));
        rows
    }

    /// The kicks of the covector.
    fn rows_of_covectors(&self, index: usize, substep: &Substep<'g>) -> Vec<Formula<'g>> {
        let (q, lagrangian) = (self.q(), &substep.lagrangian);
        let start = self.covector_kick(lagrangian.start, substep.begins);
        let end = self.covector_kick(lagrangian.end, substep.ends);
        let table = [
            (Id::StartGradient(index), format!("∂U₀/∂{q}"), start),
            (Id::EndGradient(index), format!("∂U₁/∂{q}, at {q}⁺"), end),
            (Id::CoupledGradient(index), format!("∂K/∂{q}"), self.coupled_kick(substep)),
        ];
        let row =
            |(id, symbol, value): (Id, String, Option<Vec<Expr<'g>>>)| Some(Formula::shorter(id, symbol, &value?));
        table.into_iter().filter_map(row).collect()
    }

    /// The impulses of a force; what depends on the velocity, in the chart.
    fn rows_of_forces(&self, index: usize, substep: &Substep<'g>) -> Vec<Formula<'g>> {
        let Some(force) = &substep.force else { return Vec::new() };
        let moving = force.start_moving.as_ref().filter(|_| substep.other.is_none());
        let start = force.start.as_ref().map(|start| self.as_of_start(substep.begins, start));
        let moving = moving.map(|moving| self.in_chart(&self.as_of_start(substep.begins, moving)));
        let end = self.in_chart(&self.as_of_start(substep.ends, &force.end));
        let table = [
            (Id::StartForce(index), "M − N by f".to_string(), start),
            (Id::MovingForce(index), "M − N by f".to_string(), moving),
            (Id::EndForce(index), format!("N⁺ − M⁺ by f, at {}⁺", self.q()), Some(end)),
        ];
        let row =
            |(id, symbol, value): (Id, String, Option<Vec<Expr<'g>>>)| Some(Formula::shorter(id, symbol, &value?));
        table.into_iter().filter_map(row).collect()
    }

    /// The move of a configuration and of a covector, by the increments D = F − I.
    pub(super) fn rows_of_move(&self) -> Vec<Formula<'g>> {
        let q = self.q();
        let after = if self.is_compensated() { format!("{q}⁺ − {q}") } else { format!("{q}⁺") };
        let x = self.letter(&self.symbols.blocks.iter().map(|block| block.coordinates).collect::<Vec<_>>());
        let d = self.letter(&self.symbols.increments);
        let p = self.letter(&self.symbols.covectors);
        let lift = self.at_increments(&self.cotangent_lift);
        let mut rows = Vec::new();
        if !self.turns_whole() {
            rows.push(Formula::shorter(Id::Increment, format!("{d}({x})"), &self.chart_increments()));
        }
        rows.push(Formula::shorter(Id::Advance, after.as_str(), &self.advance()));
        rows.extend(self.displaced().map(|displaced| Formula::shorter(Id::Displacement, after, &displaced)));
        rows.push(Formula::shorter(Id::Lift, format!("(TΦ_{})^-* {p} at {q}⁺", self.f()), &lift));
        rows
    }

    /// An equation with its Jacobian, and its solution where there is a formula for it.
    fn rows_of_equation(&self, index: usize, number: usize) -> Vec<Formula<'g>> {
        let equation = &self.substeps[index].equations[number];
        let x = self.letter(&self.symbols.blocks.iter().map(|block| block.coordinates).collect::<Vec<_>>());
        let delta = self.letter(&self.symbols.blocks.iter().map(|block| block.direction).collect::<Vec<_>>());
        let row = Formula::new(Id::Equation(index, number), format!("0 = ρ({x})"), &[equation.residual]);
        let is_explicit = equation.solution == Solution::Explicit;
        let symbol = format!("Dρ({x})·{delta}");
        let mut rows = vec![
            if is_explicit { row.with_title("equation (explicit)") } else { row },
            Formula::new(Id::Jacobian(index, number), symbol.as_str(), &[equation.directional]),
        ];
        let factor = equation.large_jacobian_factor(self).map(|factor| {
            let symbol = format!("{symbol} = ⟨{delta}^·B, E⟩ with B({x})");
            Formula::new(Id::JacobianFactor(index, number), symbol, &[factor])
        });
        let solution = equation
            .formula
            .map(|solution| Formula::new(Id::Solution(index, number), self.coordinates_of(equation), &[solution]));
        rows.extend(factor.into_iter().chain(solution));
        rows.extend(self.row_of_predictor(index, number));
        rows
    }

    /// What iterations of an equation start from.
    fn row_of_predictor(&self, index: usize, number: usize) -> Option<Formula<'g>> {
        let substep = &self.substeps[index];
        let equation = substep.equations.get(number).filter(|equation| self.is_predicted(equation))?;
        let printed = self.printed_predictor(substep, equation).unwrap_or_default();
        let row = Formula::shorter(Id::Predictor(index, number), self.coordinates_of(equation), &printed);
        Some(row.computed_as(self.predictor(substep, equation)))
    }

    /// The coordinates of an equation by their names: `x₁`, and `x[0], x[1]` where it holds not all of a vector.
    pub fn coordinates_of(&self, equation: &MomentumEquation<'g>) -> String {
        let name = |i: usize| {
            let block = &self.symbols.blocks[i];
            let held: Vec<usize> = block.components().filter(|c| equation.components.contains(c)).collect();
            let entry = |component: &usize| format!("{}[{}]", block.coordinates, component - block.offset);
            if held.len() == block.dimension() {
                return block.coordinates.to_string();
            }
            held.iter().map(entry).collect::<Vec<_>>().join(", ")
        };
        let names = self.symbols.blocks_of(&equation.components).into_iter().map(name);
        names.collect::<Vec<_>>().join(", ")
    }

    fn row_of_update(&self, index: usize, substep: &Substep<'g>) -> Formula<'g> {
        if let Some(other) = &substep.other {
            return Formula::shorter(Id::MomentumUpdate(index), "M⁺", other);
        }
        let update = |k: usize| {
            let mu = self.symbols.momenta[k];
            let mu = substep.rest.as_ref().map_or(mu, |rest| mu - rest[k]);
            if substep.unchanged[k] { mu } else { self.carried(k, mu) }
        };
        let updates: Vec<_> = (0..self.model.factors.len()).map(update).collect();
        Formula::new(Id::MomentumUpdate(index), "M⁺", &updates)
    }

    /// N − π, of a step of first order.
    pub(super) fn row_of_stagger(&self) -> Option<Formula<'g>> {
        let stagger = self.stagger.as_ref()?;
        Some(Formula::shorter(Id::SynchronizedMomentum, format!("N − π, at {}", self.q()), stagger))
    }

    /// The kicks of a splitting, with their weights b and g.
    pub(super) fn rows_of_splitting(&self) -> Vec<Formula<'g>> {
        let Some(splitting) = &self.splitting else { return Vec::new() };
        let q = self.q();
        let gradient = |plain: String, with: String| if splitting.has_gradient { plain + &with } else { plain };
        let energy = gradient(format!("−h·b·V({q})"), format!(" + h³·g·Gᵀ·Σ⁻¹·G, G = J({q}, ∂V)"));
        let latex = gradient(
            format!("-h b V({q})"),
            format!(" + h^3 g\\, G^T \\Sigma^{{-1}} G,\\quad G = J({q}, \\partial V)"),
        );
        let kick = Formula::new(Id::SplittingKick, format!("M⁺ − M at {q}"), &splitting.kick);
        let gradients = self.gradients(splitting.potential);
        let covector = Formula::new(Id::SplittingGradient, format!("∂U/∂{q} with U"), &gradients);
        vec![
            kick.in_words(format!("J({q}, ∂U), U = {energy}"), format!("J({q}, \\partial U),\\quad U = {latex}")),
            covector.in_words(energy, latex),
        ]
    }

    /// Hamilton's equations, which a step of order 16 collocates, and what its sweeps start from.
    pub(super) fn rows_of_collocation(&self) -> Vec<Formula<'g>> {
        let x = self.letter(&self.symbols.blocks.iter().map(|block| block.coordinates).collect::<Vec<_>>());
        let guess = self.guess().map(|guess| Formula::new(Id::Guess, x, &guess));
        self.row_of_collocation().into_iter().chain(guess).collect()
    }

    fn row_of_collocation(&self) -> Option<Formula<'g>> {
        let collocation = self.collocation.as_ref()?;
        let (q, xi) = (self.q(), self.letter(&self.symbols.algebra));
        let p = self.letter(&self.symbols.covectors);
        let row = Formula::new(Id::HamiltonEquations, format!("({q}′, {p}′)"), &collocation.velocity);
        let is_linear = !self.energy.gyroscopic.is_zero();
        let (a, less) = if is_linear { (" − A", format!(" − A·{xi}")) } else { ("", String::new()) };
        let v = if self.potential_energy.is_zero() { "" } else { " + V" };
        let (a_latex, less_latex) = if is_linear { (" - A", format!(" - A\\cdot {xi}")) } else { ("", String::new()) };
        Some(row.in_words(
            format!("({xi}_Q({q}), −∂_{q}(⟨{p}, {xi}_Q({q})⟩{less}{v})), {xi} = Σ⁻¹(J({q}, {p}){a})"),
            format!("({xi}_Q({q}),\\, -\\partial_{{{q}}}(\\langle {p}, {xi}_Q({q})\\rangle{less_latex} {v})),\\quad {xi} = \\Sigma^{{-1}}(J({q}, {p}){a_latex})"),
        ))
    }
}
