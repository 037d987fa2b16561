//! The rows of a step: kicks, the momentum equation, the momentum after the move, splittings and collocation.

use clebsch_symbolic::{Elements, Expr, IntoList, Property, Role, both};

use super::Names;
use crate::derive::{Formula, Id, MechanicsFormulas, RotatingBody, Solution, rotation};

impl<'g> MechanicsFormulas<'g> {
    /// Kicks are functions of the time at which the step starts, as their methods are.
    pub(super) fn rows_of_substep(&self, names: &Names, index: usize) -> Vec<Formula<'g>> {
        let (substep, q) = (&self.substeps[index], &names.q);
        let lagrangian = &substep.lagrangian;
        let at = |later: Expr<'g>, parts: &Option<Vec<Expr<'g>>>| {
            self.as_of_start(later, parts.as_deref().unwrap_or_default())
        };
        let mut rows = vec![Formula::shorter(Id::StartKick(index), "M − N", at(substep.begins, &substep.start))];
        for number in 0..substep.equations.len() {
            rows.extend(self.rows_of_equation(names, index, number));
        }
        let update = self.carried_on(substep).unwrap_or_else(|| self.symbols.momenta.clone());
        rows.push(Formula::new(Id::MomentumUpdate(index), "M⁺", update));
        let after = self.momentum_after(substep).filter(|_| !self.turns_whole()).unwrap_or_default();
        let symbol = if self.is_compensated() { "M⁺ − μ" } else { "M⁺" };
        let rest = substep.rest.clone().unwrap_or_default();
        let after = Formula::shorter(Id::MomentumAfter(index), symbol, after);
        let after = match self.turned_in_four_space(substep, &names.mu, &names.x) {
            Some([unicode, latex]) => after.in_words(unicode, latex),
            None => after,
        };
        rows.extend([
            after,
            Formula::shorter(Id::EndKick(index), format!("N⁺ − M⁺, at {q}⁺"), at(substep.ends, &substep.end)),
            Formula::shorter(Id::RestKick(index), format!("−r({q}, I)"), rest),
        ]);
        let start = self.covector_kick(lagrangian.start, substep.begins);
        let end = self.covector_kick(lagrangian.end, substep.ends);
        rows.extend([
            Formula::shorter(Id::StartGradient(index), format!("∂U₀/∂{q}"), start),
            Formula::shorter(Id::EndGradient(index), format!("∂U₁/∂{q}, at {q}⁺"), end),
            Formula::shorter(Id::CoupledGradient(index), format!("∂K/∂{q}"), self.coupled_kick(substep)),
        ]);
        if let Some(force) = &substep.force {
            // the part that depends on the velocity, in the chart
            let moving = force.start_moving.as_deref().unwrap_or_default();
            let start = at(substep.begins, &force.start);
            let moving = self.in_chart(&self.as_of_start(substep.begins, moving));
            let end = self.in_chart(&self.as_of_start(substep.ends, &force.end));
            rows.extend([
                Formula::shorter(Id::StartForce(index), "M − N by f", start),
                Formula::shorter(Id::MovingForce(index), "M − N by f", moving),
                Formula::shorter(Id::EndForce(index), format!("N⁺ − M⁺ by f, at {q}⁺"), end),
            ]);
        }
        rows.extend(self.rows_of_reaction(names, index));
        rows
    }

    /// The force of the constraint, and the projection after the move.
    fn rows_of_reaction(&self, Names { q, f, mu, .. }: &Names, index: usize) -> Vec<Formula<'g>> {
        let substep = &self.substeps[index];
        let mut rows = Vec::new();
        rows.extend(substep.reaction.clone().map(|reaction| {
            let row = Formula::new(Id::Reaction(index), "Aᵀλ", reaction);
            if self.has_no_multiplier(substep) {
                let still = self.coordinates_of(&substep.still);
                return row.in_words(
                    format!("r({f}) − {mu} in {still}, else zero"),
                    format!("r({f}) - {mu} \\text{{ in }} {still},\\text{{ else zero}}"),
                );
            }
            row.in_words(
                format!("Aᵀ·S⁻¹·A·Σ⁻¹·(r({f}) − {mu}), S = A·Σ⁻¹·Aᵀ"),
                format!("A^T S^{{-1}} A \\Sigma^{{-1}} (r({f}) - {mu}),\\quad S = A \\Sigma^{{-1}} A^T"),
            )
        }));
        rows.extend(substep.projection.as_deref().map(|projection| {
            let row = Formula::new(Id::Projection(index), "N⁺ − N", self.as_of_start(substep.ends, projection));
            row.in_words(
                format!("Aᵀ·S⁻¹·(b − A·Σ⁻¹·N), at {q}⁺"),
                format!("A^T S^{{-1}} (b - A \\Sigma^{{-1}} N),\\quad \\text{{at }} {q}^+"),
            )
        }));
        rows
    }

    /// The move of a configuration and of a covector, by the increments D = F − I.
    pub(super) fn rows_of_move(&self, Names { q, f, p, d, x, .. }: &Names) -> [Formula<'g>; 6] {
        let after = if self.is_compensated() { format!("{q}⁺ − {q}") } else { format!("{q}⁺") };
        let lift = self.at_increments(&self.cotangent_lift);
        let increments = if self.turns_whole() { Vec::new() } else { self.chart_increments() };
        [
            Formula::shorter(Id::Increment, format!("{d}({x})"), increments),
            Formula::shorter(Id::ScaledIncrement, format!("({d}, c)({x})"), self.scaled_increments()),
            Formula::shorter(Id::Advance, &after, self.advance()),
            Formula::shorter(Id::ScaledAdvance, &after, self.scaled_advance()),
            Formula::shorter(Id::Displacement, after, self.displaced().unwrap_or_default()),
            Formula::shorter(Id::Lift, format!("(TΦ_{f})^-* {p} at {q}⁺"), lift),
        ]
    }

    /// An equation with its Jacobian, its solution if there is a formula for it, and the start of iterations.
    fn rows_of_equation(&self, Names { x, delta, mu, .. }: &Names, index: usize, number: usize) -> Vec<Formula<'g>> {
        let (substep, equation) = (&self.substeps[index], &self.substeps[index].equations[number]);
        let symbol = format!("Dρ({x})·{delta}");
        let mut row = Formula::new(Id::Equation(index, number), format!("0 = ρ({x})"), [equation.residual]);
        if equation.solution == Solution::Explicit {
            row.title = "equation (explicit)";
        }
        let mut jacobian = Formula::new(Id::Jacobian(index, number), &symbol, [equation.directional]);
        let has_multipliers = substep.reaction.is_some() && !self.has_no_multiplier(substep);
        if self.constraint.is_some() && !has_multipliers && equation.residual.has_inverse() {
            let (own, still) = (self.coordinates_of(&equation.components), self.coordinates_of(&substep.still));
            let [rows, rows_latex] = match substep.still[..] {
                [] => both(["", ""], String::from),
                _ => [
                    format!(" in {own}, with {still} = 0"),
                    format!(" \\text{{ in }} {own},\\text{{ with }} {still} = 0"),
                ],
            };
            row = row.in_words(format!("r({x}) − {mu}{rows}"), format!("r({x}) - {mu}{rows_latex}"));
            jacobian = jacobian.in_words(format!("Dr·{delta}{rows}"), format!("Dr\\,{delta}{rows_latex}"));
        }
        if has_multipliers {
            row = row.in_words(
                format!("y − Aᵀ·S⁻¹·(A·Σ⁻¹·y − ψ), y = r({x}) − {mu}"),
                format!("y - A^T S^{{-1}} (A \\Sigma^{{-1}} y - \\psi),\\quad y = r({x}) - {mu}"),
            );
            jacobian = jacobian.in_words(
                format!("Dr·{delta} − Aᵀ·S⁻¹·(A·Σ⁻¹·Dr·{delta} − Dψ·{delta})"),
                format!("Dr\\,{delta} - A^T S^{{-1}} (A \\Sigma^{{-1}} Dr\\,{delta} - D\\psi\\,{delta})"),
            );
        }
        let mut rows = vec![row, jacobian];
        rows.extend(equation.large_jacobian_factor(self).map(|factor| {
            let symbol = format!("{symbol} = ⟨{delta}^·B, E⟩ with B({x})");
            Formula::new(Id::JacobianFactor(index, number), symbol, [factor])
        }));
        let coordinates = self.coordinates_of(&equation.components);
        match equation.solution {
            Solution::Rotation(RotatingBody::FourSpace) => {
                rows.extend(self.rows_of_rotation_4d(index, number, (mu, &coordinates)));
            }
            Solution::Rotation(RotatingBody::Space { is_cayley: true, .. }) => {
                rows.extend(self.rows_of_cayley_rotation(index, number, (mu, &coordinates)));
            }
            Solution::Rotation(_) => rows.extend(self.rows_of_rotation(index, number, (mu, &coordinates))),
            _ => {}
        }
        rows.extend(equation.formula.map(|solution| {
            let row = Formula::new(Id::Solution(index, number), &coordinates, [solution]);
            if !has_multipliers || equation.solution != Solution::ClosedForm {
                return row;
            }
            row.in_words(
                format!("h·Σ⁻¹·({mu} + Aᵀ·λ), B·Σ⁻¹·Aᵀ·λ = −ψ(0) − B·Σ⁻¹·{mu} with B = h·∂ψ/∂{x}"),
                format!(
                    "h \\Sigma^{{-1}} ({mu} + A^T \\lambda),\\quad B \\Sigma^{{-1}} A^T \\lambda = -\\psi(0) - B \\Sigma^{{-1}} {mu}, \\quad B = h\\,\\partial\\psi/\\partial {x}"
                ),
            )
        }));
        if self.is_predicted(equation) {
            let inertia = self.model.graph.symbol("Σ", self.inertia.shape(), Role::Letter, Property::Symmetric);
            let printed = self.predictor_by_blocks(substep, equation, inertia.inverse());
            let mut row = Formula::shorter(Id::Predictor(index, number), &coordinates, printed);
            if !substep.still.is_empty() {
                let still = self.coordinates_of(&substep.still);
                row = row.in_words(
                    format!("s·h·(Σ without {still})⁻¹·{mu}, s = d{x}/dξ"),
                    format!("s h (\\Sigma \\text{{ without }} {still})^{{-1}} {mu},\\quad s = d{x}/d\\xi"),
                );
            }
            rows.push(row.computed_as(self.predictor(substep, equation)));
        }
        rows
    }

    /// The scalar equation of a rotating body in four dimensions, and its solution.
    fn rows_of_rotation_4d(&self, index: usize, number: usize, (mu, x): (&str, &str)) -> [Formula<'g>; 2] {
        let parts = rotation::FourSpace::new(self.model.graph);
        let scalar = Formula::new(Id::ScalarEquation(index, number), "0 = g(e₁)", [parts.polynomial]).in_words(
            format!("2·e₄·e₂ − e₃² − S₆, e₂ = (S₂ + e₁²)/2, e₃ = (e₂² + 2·e₄ − S₄)/(2·e₁), det(λ² − λ·m − K) = λ⁸ + S₂·λ⁶ + S₄·λ⁴ + S₆·λ² + e₄², m = {mu}^, K = J²"),
            format!("2 e_4 e_2 - e_3^2 - S_6,\\quad e_2 = (S_2 + e_1^2)/2,\\quad e_3 = (e_2^2 + 2 e_4 - S_4)/(2 e_1),\\quad \\det(\\lambda^2 - \\lambda m - K) = \\lambda^8 + S_2 \\lambda^6 + S_4 \\lambda^4 + S_6 \\lambda^2 + e_4^2,\\quad m = {mu}^\\wedge,\\quad K = J^2"),
        );
        let solution = Formula::new(Id::Solution(index, number), x, [parts.solution]).in_words(
            "⟨(G + N)⁻¹·(G − N), E⟩/2, N = m³ + K·m + m·K + e₂·m − e₁·(m² + K) − e₃, G = −(m² + K − e₁·m + e₂ + e₄·K⁻¹)·J".to_string(),
            "\\langle (G + N)^{-1} (G - N), E \\rangle/2,\\quad N = m^3 + K m + m K + e_2 m - e_1 (m^2 + K) - e_3,\\quad G = -(m^2 + K - e_1 m + e_2 + e_4 K^{-1}) J".to_string(),
        );
        [scalar, solution]
    }

    /// The scalar equation of a rotating body, with A = Σ/(s·h), and its solution.
    fn rows_of_rotation(&self, index: usize, number: usize, (mu, x): (&str, &str)) -> [Formula<'g>; 2] {
        let block = self.symbols.blocks_of(&self.substeps[index].equations[number].components)[0];
        let parts = rotation::ScalarEquation::new(self.momentum_of_block(block));
        let scalar = Formula::new(Id::ScalarEquation(index, number), "0 = f(κ)", [parts.polynomial]).in_words(
            format!("κ⁴ − e₁·κ³ + (e₂ + 2·m)·κ² − (e₃ + e₁·m)·κ + m² + {mu}ᵀ·adj(A)·{mu}, m = |{mu}|², e₁, e₂, e₃ of A"),
            format!("\\kappa^4 - e_1 \\kappa^3 + (e_2 + 2 m) \\kappa^2 - (e_3 + e_1 m) \\kappa + m^2 + {mu}^T \\operatorname{{adj}}(A) {mu},\\quad m = |{mu}|^2"),
        );
        let value = [parts.numerator / parts.denominator];
        let solution = Formula::new(Id::Solution(index, number), x, value).in_words(
            format!("(adj(A − κ)·{mu} + m·{mu} ± A·{mu} × {mu})/(det(A − κ) + {mu}ᵀ·(A − κ)·{mu})"),
            format!("\\frac{{\\operatorname{{adj}}(A - \\kappa) {mu} + m {mu} \\pm A {mu} \\times {mu}}}{{\\det(A - \\kappa) + {mu}^T (A - \\kappa) {mu}}}"),
        );
        [scalar, solution]
    }

    /// The same by the Cayley map.
    fn rows_of_cayley_rotation(&self, index: usize, number: usize, (mu, x): (&str, &str)) -> [Formula<'g>; 2] {
        let block = self.symbols.blocks_of(&self.substeps[index].equations[number].components)[0];
        let parts = rotation::ScalarEquation::by_cayley(self.momentum_of_block(block));
        let scalar = Formula::new(Id::ScalarEquation(index, number), "0 = f(s)", [parts.polynomial]).in_words(
            "s − 1 − |r|²/p², r and p of x".to_string(),
            "s - 1 - |r|^2/p^2,\\quad r \\text{ and } p \\text{ of } x".to_string(),
        );
        let value = [parts.numerator / parts.denominator];
        let solution = Formula::new(Id::Solution(index, number), x, value).in_words(
            format!("r/p, r = s²·adj(A)·{mu} ± s·A·{mu} × {mu} + m·{mu}, p = s·(s²·det(A) + {mu}ᵀ·A·{mu}), m = |{mu}|²"),
            format!("r/p,\\quad r = s^2 \\operatorname{{adj}}(A) {mu} \\pm s A {mu} \\times {mu} + m {mu},\\quad p = s (s^2 \\det A + {mu}^T A {mu}),\\quad m = |{mu}|^2"),
        );
        [scalar, solution]
    }

    /// Coordinates by their names: `x₁`, and `x[0], x[1]` where they are not all of a vector.
    pub fn coordinates_of(&self, components: &[usize]) -> String {
        let name = |i: usize| {
            let block = &self.symbols.blocks[i];
            let held: Vec<usize> = block.components().filter(|c| components.contains(c)).into_list();
            let entry = |component: &usize| format!("{}[{}]", block.coordinates, component - block.offset);
            if held.len() == block.dimension() {
                return block.coordinates.to_string();
            }
            held.each(entry).join(", ")
        };
        let names = self.symbols.blocks_of(components).into_iter().map(name);
        names.into_list().join(", ")
    }

    /// The formulas that a scheme needs in addition to its substeps. A step of first order has N − π, and a splitting
    /// has kicks with the weights b and g. A step of order 16 has Hamilton's equations, which it collocates, and the
    /// start of its sweeps.
    pub(super) fn rows_of_scheme(&self, names: &Names) -> Vec<Formula<'g>> {
        let Names { q, x, .. } = names;
        let stagger = self.stagger.clone().unwrap_or_default();
        let mut rows = vec![Formula::shorter(Id::SynchronizedMomentum, format!("N − π, at {q}"), stagger)];
        if let Some(splitting) = &self.splitting {
            let gradient = |plain: String, with: String| if splitting.has_gradient { plain + &with } else { plain };
            let energy = gradient(format!("−h·b·V({q})"), format!(" + h³·g·Gᵀ·Σ⁻¹·G, G = J({q}, ∂V)"));
            let latex = gradient(
                format!("-h b V({q})"),
                format!(" + h^3 g\\, G^T \\Sigma^{{-1}} G,\\quad G = J({q}, \\partial V)"),
            );
            let kick = Formula::new(Id::SplittingKick, format!("M⁺ − M at {q}"), splitting.kick.clone());
            let gradients = self.gradients(splitting.potential);
            let covector = Formula::new(Id::SplittingGradient, format!("∂U/∂{q} with U"), gradients);
            let in_latex = format!("J({q}, \\partial U),\\quad U = {latex}");
            rows.push(kick.in_words(format!("J({q}, ∂U), U = {energy}"), in_latex));
            rows.push(covector.in_words(energy, latex));
        }
        if let Some(monitor) = &self.monitor {
            let slope = Formula::new(Id::MonitorSlope, "γ", monitor.slope.clone());
            rows.push(Formula::new(Id::Monitor, format!("g({q})"), [monitor.value]));
            rows.push(Formula::new(Id::MonitoredKick, format!("M⁺ − M at {q}"), monitor.kick.clone()));
            let by_inertia = "\\Sigma^{-1}";
            rows.push(slope.in_words(
                format!("h·Σ⁻¹J({q}, ∂g)/g, γ·μ = h·ġ/g"),
                format!("h {by_inertia} J({q}, \\partial g)/g,\\quad \\gamma\\cdot\\mu = h \\dot g/g"),
            ));
        }
        rows.extend(self.row_of_collocation(names));
        rows.extend(self.guess().map(|guess| Formula::new(Id::Guess, x, guess)));
        rows
    }

    fn row_of_collocation(&self, Names { q, xi, p, .. }: &Names) -> Option<Formula<'g>> {
        let velocity = self.collocation.as_ref()?.velocity.clone();
        let row = Formula::new(Id::HamiltonEquations, format!("({q}′, {p}′)"), velocity);
        let if_linear = |text: String| if self.energy.gyroscopic.is_zero() { String::new() } else { text };
        let [a, a_latex] = both([" − A", " - A"], |text| if_linear(text.to_string()));
        let [less, less_latex] = both([format!(" − A·{xi}"), format!(" - A\\cdot {xi}")], if_linear);
        let v = if self.potential_energy.is_zero() { "" } else { " + V" };
        Some(row.in_words(
            format!("({xi}_Q({q}), −∂_{q}(⟨{p}, {xi}_Q({q})⟩{less}{v})), {xi} = Σ⁻¹(J({q}, {p}){a})"),
            format!("({xi}_Q({q}),\\, -\\partial_{{{q}}}(\\langle {p}, {xi}_Q({q})\\rangle{less_latex} {v})),\\quad {xi} = \\Sigma^{{-1}}(J({q}, {p}){a_latex})"),
        ))
    }
}
