//! The formulas as text: what `DERIVATION`, the generated documentation and the snapshots show.

use std::fmt;

use clebsch_symbolic::{Expr, Property, Role, Shape};

use super::{Equation, Formulas, Reference, Solution, Substep, reference};
use crate::model::Kinetic;

/// A derived formula, `symbol = expression`.
#[derive(Clone)]
pub struct Formula {
    /// What it is, in words.
    pub title: &'static str,
    /// The left side, `J(q, p)`.
    pub symbol: String,
    /// The right side; one text for each factor or leaf, in Unicode.
    pub text: Vec<String>,
    /// The same in LaTeX.
    pub latex: Vec<String>,
    /// The shapes of the right sides.
    pub shapes: Vec<Shape>,
    /// Where it comes from.
    pub source: Option<Reference>,
}

impl Formula {
    fn new(title: &'static str, symbol: impl Into<String>, expressions: &[Expr<'_>]) -> Formula {
        let expressions: Vec<_> = expressions.iter().map(|expression| without_embeddings(*expression)).collect();
        Formula {
            title,
            symbol: symbol.into(),
            text: expressions.iter().map(|expression| expression.to_string()).collect(),
            latex: expressions.iter().map(|expression| expression.latex()).collect(),
            shapes: expressions.iter().map(|expression| expression.shape()).collect(),
            source: reference::of(title),
        }
    }

    /// `symbol = expression`, tuples in parentheses.
    pub fn equation(&self) -> String {
        match self.text.as_slice() {
            [only] => format!("{} = {only}", self.symbol),
            several => format!("{} = ({})", self.symbol, several.join(", ")),
        }
    }
}

impl Formula {
    /// The kick of a splitting, with its weights b and g.
    pub fn of_splitting(formulas: &Formulas<'_>) -> Vec<Formula> {
        let Some(splitting) = &formulas.splitting else { return Vec::new() };
        let q = formulas.q();
        let mut kick = Formula::new("kick", format!("M⁺ − M at {q}"), &splitting.kick);
        let gradient = |plain: &str, with: &str| format!("{plain}{}", if splitting.has_gradient { with } else { "" });
        kick.text =
            vec![gradient(&format!("J({q}, ∂U), U = −h·b·V({q})"), &format!(" + h³·g·Gᵀ·Σ⁻¹·G, G = J({q}, ∂V)"))];
        kick.latex = vec![gradient(
            &format!("J({q}, \\partial U),\\quad U = -h b V({q})"),
            &format!(" + h^3 g\\, G^T \\Sigma^{{-1}} G,\\quad G = J({q}, \\partial V)"),
        )];
        vec![kick]
    }

    /// Hamilton's equations, which a step of order 16 collocates.
    pub fn of_collocation(formulas: &Formulas<'_>) -> Vec<Formula> {
        let Some(collocation) = &formulas.collocation else { return Vec::new() };
        let (q, xi) = (formulas.q(), formulas.letter(&formulas.symbols.algebra));
        let p = formulas.letter(&formulas.symbols.covectors);
        let mut slope = Formula::new("Hamilton's equations", format!("({q}′, {p}′)"), &collocation.velocity);
        let slopes = !formulas.energy.gyroscopic.is_zero();
        let (a, less) = if slopes { (" − A", format!(" − A·{xi}")) } else { ("", String::new()) };
        let v = if formulas.potential_energy.is_zero() { "" } else { " + V" };
        slope.text = vec![format!("({xi}_Q({q}), −∂_{q}(⟨{p}, {xi}_Q({q})⟩{less}{v})), {xi} = Σ⁻¹(J({q}, {p}){a})")];
        slope.latex = vec![format!(
            "({xi}_Q({q}),\\, -\\partial_{{{q}}}(\\langle {p}, {xi}_Q({q})\\rangle{} {v})),\\quad {xi} = \\Sigma^{{-1}}(J({q}, {p}){})",
            if slopes { format!(" - A\\cdot {xi}") } else { String::new() },
            if slopes { " - A" } else { "" },
        )];
        vec![slope]
    }
}

impl fmt::Display for Formula {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<24} {}", self.title, self.equation())
    }
}

/// More conserved momenta are told by the first and the last of them.
pub(crate) const MOST_LISTED: usize = 16;

impl<'g> Formulas<'g> {
    /// The user's name for the configuration: `q`, or `(p, q)`.
    pub fn q(&self) -> String {
        tuple(self.model.configurations.iter().map(|leaf| leaf.name.clone()))
    }

    /// The user's name for the group element.
    pub fn f(&self) -> String {
        tuple(self.model.factors.iter().map(|factor| factor.name.clone()))
    }

    /// The letter of symbols that differ in their subscripts.
    fn letter(&self, symbols: &[Expr<'g>]) -> String {
        symbols
            .first()
            .map(|symbol| symbol.to_string().trim_end_matches(|c: char| ('₀'..='₉').contains(&c)).to_string())
            .unwrap_or_default()
    }

    /// All formulas, in the order of the derivation.
    pub fn listing(&self) -> &[Formula] {
        self.listing.get_or_init(|| self.list())
    }

    /// The formulas with a title.
    pub fn titled(&self, title: &str) -> Vec<Formula> {
        self.listing().iter().filter(|formula| formula.title == title).cloned().collect()
    }

    fn list(&self) -> Vec<Formula> {
        let (q, f) = (self.q(), self.f());
        if self.model.is_steered() {
            return self.list_of_control();
        }
        let mut formulas = vec![
            Formula::new("action", format!("Φ_{f}({q})"), &self.model.action),
            Formula::new("generator", format!("{}_Q({q})", self.letter(&self.symbols.algebra)), &self.generator),
            self.formula_of_momentum_map(),
            self.formula_of_coadjoint(),
            Formula::new(
                "cotangent lift",
                format!("(TΦ_{f})^-* {} at {q}⁺", self.letter(&self.symbols.covectors)),
                &self.cotangent_lift,
            ),
            Formula::new(
                "inertia",
                format!("Σ{}", self.letter(&self.symbols.algebra)),
                &self.symbols.algebra.iter().map(|xi| self.energy.kinetic.gradient(*xi).expand()).collect::<Vec<_>>(),
            ),
            Formula::new(
                "kinetic energy",
                format!("T({})", self.letter(&self.symbols.algebra)),
                &[self.energy.kinetic + self.energy.gyroscopic],
            ),
            Formula::new(
                "Lagrangian",
                format!("ℓ({})", self.letter(&self.symbols.algebra)),
                &self.energy.general.into_iter().collect::<Vec<_>>(),
            ),
            self.formula_of_potential(),
            self.formula_of_hamiltonian(),
            Formula::new("force", "f", self.covector.as_deref().unwrap_or_default()),
            self.formula_of_kinetic(),
            Formula::new("", format!("U₀(h, {q})"), &[self.lagrangian.start]),
            Formula::new("", format!("U₁(h, {q}⁺)"), &[self.lagrangian.end]),
            self.formula_of_legendre(),
            self.formula_of_legendre_next(),
        ];
        formulas.extend(self.formulas_of_terms());
        formulas.extend(self.formulas_of_gradients());
        formulas.extend(self.formulas_of_choice());
        formulas.extend(self.formulas_of_conserved());
        for substep in self.substeps.iter().take(self.parts) {
            formulas.extend(self.formulas_of_substep(substep));
        }
        formulas.extend(self.formula_of_stagger());
        formulas.extend(Formula::of_splitting(self));
        formulas.extend(Formula::of_collocation(self));
        formulas.retain(|formula| formula.text.iter().any(|text| text != "0"));
        formulas
    }

    /// What inputs move, what they cost, and what binds them.
    fn list_of_control(&self) -> Vec<Formula> {
        let (q, f) = (self.q(), self.f());
        let u = tuple(self.model.inputs.iter().map(|leaf| leaf.name.clone()));
        let mut formulas = vec![
            Formula::new("action", format!("Φ_{f}({q})"), &self.model.action),
            Formula::new("generator", format!("{}_Q({q})", self.letter(&self.symbols.algebra)), &self.generator),
        ];
        match &self.model.kinetic {
            Kinetic::Controls { velocity, .. } => {
                formulas.push(Formula::new(
                    "controls",
                    format!("{}({u})", self.letter(&self.symbols.algebra)),
                    velocity,
                ));
            }
            Kinetic::Dynamics(next) => formulas.push(Formula::new("controls", format!("{q}⁺"), next)),
            Kinetic::Cost(_) | Kinetic::Lagrangian { .. } => {}
        }
        formulas.extend(self.formulas_of_choice());
        formulas
    }

    /// Price, bounds and the price of the end.
    fn formulas_of_choice(&self) -> Vec<Formula> {
        let endpoint =
            self.model.endpoint.map(|price| Formula::new("price of the end", format!("φ({})", self.q()), &[price]));
        let Some(control) = &self.model.control else { return endpoint.into_iter().collect() };
        let u = tuple(self.model.inputs.iter().map(|leaf| leaf.name.clone()));
        let bounds: Vec<Expr<'g>> = control.bounds.iter().map(|bound| bound.value).collect();
        let price = Formula::new("price", format!("ℓ(h, {u})"), &[control.price]);
        let bounds = (!bounds.is_empty()).then(|| Formula::new("bounds", "0 ≥ a", &bounds));
        [price].into_iter().chain(bounds).chain(endpoint).collect()
    }

    fn chart_symbols(&self) -> Vec<Expr<'g>> {
        self.symbols.blocks.iter().map(|block| block.coordinates).collect()
    }

    fn direction_symbols(&self) -> Vec<Expr<'g>> {
        self.symbols.blocks.iter().map(|block| block.direction).collect()
    }

    /// K(h, F), with what else it depends on.
    fn kinetic_symbol(&self) -> String {
        let timed = self.lagrangian.kinetic.depends_on(self.model.time);
        let (time, q) =
            (if timed { "t, " } else { "" }, if self.lagrangian.couples { self.q() + ", " } else { String::new() });
        format!("K({time}h, {q}{})", self.f())
    }

    /// K(h, F).
    fn formula_of_kinetic(&self) -> Formula {
        let mut formula = Formula::new("discrete Lagrangian", self.kinetic_symbol(), &[self.lagrangian.kinetic]);
        if (0..self.model.factors.len()).any(|k| self.is_free_rotation(k)) {
            formula.text = vec![format!("∫₀ʰ T dt along the free motion from I to {}", self.f())];
            formula.latex =
                vec![format!("\\int_0^h T\\,dt \\text{{ along the free motion from }} I \\text{{ to }} {}", self.f())];
        }
        formula
    }

    /// J(q, p).
    pub fn formula_of_momentum_map(&self) -> Formula {
        Formula::new(
            "momentum map",
            format!("J({}, {})", self.q(), self.letter(&self.symbols.covectors)),
            &self.momentum_map,
        )
    }

    /// Ad*_F μ.
    pub fn formula_of_coadjoint(&self) -> Formula {
        Formula::new(
            "coadjoint action",
            format!("Ad*_{} {}", self.f(), self.letter(&self.symbols.momenta)),
            &self.coadjoint,
        )
    }

    /// V(q).
    pub fn formula_of_potential(&self) -> Formula {
        Formula::new("potential energy", format!("V({})", self.q()), &[self.potential_energy])
    }

    /// H(q, μ) = ½ (μ − A)·Σ⁻¹(μ − A) + V(q), or μ·ξ − ℓ(ξ) + V(q) where ℓ is not quadratic.
    pub fn formula_of_hamiltonian(&self) -> Formula {
        let mu = self.letter(&self.symbols.momenta);
        let title = format!("H({}, {mu})", self.q());
        if let Some(lagrangian) = self.energy.general {
            let pairs = self.symbols.momenta.iter().zip(&self.symbols.algebra);
            let pairing = pairs.fold(self.model.graph.integer(0), |sum, (mu, xi)| sum + mu.dot(*xi));
            let at = format!("{title}, with {mu} = ∂ℓ/∂{}", self.letter(&self.symbols.algebra));
            return Formula::new("Hamiltonian", at, &[pairing - lagrangian + self.potential_energy]);
        }
        let (graph, shape) = (self.model.graph, self.inertia.shape());
        let momentum = graph.symbol(&mu, Shape::vector(shape.rows), Role::Letter, Property::General);
        let inertia = graph.symbol("Σ", shape, Role::Letter, Property::Symmetric);
        let momentum = momentum - self.symbols.slope(self.energy.gyroscopic);
        let kinetic = momentum.dot(inertia.inverse() * momentum) / 2;
        Formula::new("Hamiltonian", title, &[kinetic + self.potential_energy])
    }

    /// The conserved momenta by their names.
    pub fn formulas_of_conserved(&self) -> Vec<Formula> {
        let formula = |momentum: &super::ConservedMomentum<'g>| {
            Formula::new("conserved", momentum.name.clone(), &readable(&[momentum.value]))
        };
        match self.symmetries.conserved.as_slice() {
            [first, .., last] if self.symmetries.conserved.len() > MOST_LISTED => {
                let mut last = formula(last);
                last.symbol.insert_str(0, "… ");
                vec![formula(first), last]
            }
            few => few.iter().map(formula).collect(),
        }
    }

    /// The terms of the potential of a power.
    pub fn formulas_of_terms(&self) -> Vec<Formula> {
        let terms = self.links.iter().enumerate().map(|(number, link)| {
            let symbol = format!("V_{}, for each {}", number + 1, link.term.indices());
            Formula::new("term", symbol.trim_end_matches(", for each ").to_string(), &readable(&[link.term.value]))
        });
        terms.collect()
    }

    /// The gradients of the terms of a power.
    fn formulas_of_gradients(&self) -> Vec<Formula> {
        let Some(power) = &self.model.power else { return Vec::new() };
        let of_link = |(number, link): (usize, &super::Link<'g>)| {
            let gradient = |(place, slopes): &(usize, Vec<Expr<'g>>)| {
                let symbol = format!("∂V_{}/∂{}[{}]", number + 1, self.q(), power.places[*place].text());
                Formula::new("gradient of a term", symbol, &readable(slopes))
            };
            link.gradient.iter().map(gradient).collect::<Vec<_>>()
        };
        self.links.iter().enumerate().flat_map(of_link).collect()
    }

    /// N − π, of a step of first order.
    pub fn formula_of_stagger(&self) -> Option<Formula> {
        let stagger = self.stagger.as_ref()?;
        Some(Formula::new("synchronized momentum", format!("N − π, at {}", self.q()), &readable(stagger)))
    }

    /// F⁻ℓd(q, F).
    pub fn formula_of_legendre(&self) -> Formula {
        let mut formula =
            Formula::new("Legendre transform", format!("F⁻ℓd({}, {})", self.q(), self.f()), &readable(&self.legendre));
        self.explain_free_momenta(&mut formula);
        formula
    }

    /// F⁺ℓd(q, F).
    pub fn formula_of_legendre_next(&self) -> Formula {
        let mut formula =
            Formula::new("next Legendre transform", format!("F⁺ℓd({}, {})", self.q(), self.f()), &self.legendre_next);
        if let Some(end) = &self.legendre_kick {
            formula
                .text
                .iter_mut()
                .zip(readable(end))
                .for_each(|(text, end)| *text = format!("{text} + [{end}] at {}⁺", self.q()));
            let kicks = readable(end).into_iter().map(|end| end.latex());
            formula
                .latex
                .iter_mut()
                .zip(kicks)
                .for_each(|(latex, end)| *latex += &format!(" + \\left[{end}\\right]_{{q^+}}"));
        }
        self.explain_free_momenta(&mut formula);
        formula
    }

    /// Says what the symbol μ means where a factor moves freely.
    fn explain_free_momenta(&self, formula: &mut Formula) {
        let texts = formula.text.iter_mut().zip(&mut formula.latex).enumerate();
        for (k, (text, latex)) in texts.filter(|(k, _)| self.is_free_rotation(*k)) {
            let (mu, f) = (self.symbols.momenta[k], self.model.factors[k].symbol);
            *text += &format!(", {mu} the momentum of the free motion from I to {f} in h, by less than half a turn");
            let (mu, f) = (mu.latex(), f.latex());
            *latex += &format!(
                ",\\quad {mu} \\text{{ the momentum of the free motion from }} I \\text{{ to }} {f} \\text{{ in }} h, \\text{{ by less than half a turn}}"
            );
        }
    }

    fn formulas_of_substep(&self, substep: &Substep<'g>) -> Vec<Formula> {
        let mut formulas = Vec::new();
        if let Some(start) = &substep.start {
            formulas.push(Formula::new("kick", "M − N", &readable(start)));
        }
        for equation in &substep.equations {
            formulas.push(self.formula_of_equation(equation));
            formulas.push(self.formula_of_jacobian(equation));
            formulas.extend(self.formula_of_solution(equation));
        }
        formulas.push(self.formula_of_update(substep));
        if let Some(end) = &substep.end {
            formulas.push(Formula::new("kick", format!("N⁺ − M⁺, at {}⁺", self.q()), &readable(end)));
        }
        formulas
    }

    /// ρ(x) = 0.
    pub fn formula_of_equation(&self, equation: &Equation<'g>) -> Formula {
        let title = if equation.solution == Solution::Explicit { "equation (explicit)" } else { "equation" };
        Formula::new(title, format!("0 = ρ({})", self.letter(&self.chart_symbols())), &[equation.residual])
    }

    /// Dρ(x)·δ.
    pub fn formula_of_jacobian(&self, equation: &Equation<'g>) -> Formula {
        let (x, direction) = (self.letter(&self.chart_symbols()), self.letter(&self.direction_symbols()));
        Formula::new("Jacobian", format!("Dρ({x})·{direction}"), &[equation.directional])
    }

    /// B(x) with Dρ(x)·δ = ⟨δ^·B, E⟩, where there is one.
    pub fn formula_of_sylvester_factor(&self, equation: &Equation<'g>) -> Option<Formula> {
        let (x, direction) = (self.letter(&self.chart_symbols()), self.letter(&self.direction_symbols()));
        let left = format!("Dρ({x})·{direction} = ⟨{direction}^·B, E⟩ with B({x})");
        Some(Formula::new("factor of the Jacobian", left, &[equation.sylvester_factor(self)?]))
    }

    /// x(μ), where there is a formula for it.
    pub fn formula_of_solution(&self, equation: &Equation<'g>) -> Option<Formula> {
        Some(Formula::new("solution", self.coordinates_of(equation), &[equation.formula?]))
    }

    /// The coordinates of an equation by their names: `x₁`, and `x[0], x[1]` where it holds not all of a vector.
    pub fn coordinates_of(&self, equation: &Equation<'g>) -> String {
        let name = |i: usize| {
            let block = &self.symbols.blocks[i];
            let held: Vec<usize> = block.components().filter(|c| equation.components.contains(c)).collect();
            let entry = |component: &usize| format!("{}[{}]", block.coordinates, component - block.offset);
            match held.len() == block.dimension() {
                true => block.coordinates.to_string(),
                false => held.iter().map(entry).collect::<Vec<_>>().join(", "),
            }
        };
        let names = self.symbols.blocks_of(&equation.components).into_iter().map(name);
        names.collect::<Vec<_>>().join(", ")
    }

    fn formula_of_update(&self, substep: &Substep<'g>) -> Formula {
        if let Some(other) = &substep.other {
            return Formula::new("momentum update", "M⁺", &readable(other));
        }
        let update = |k: usize| {
            let mu = self.symbols.momenta[k];
            let mu = substep.rest.as_ref().map_or(mu, |rest| mu - rest[k]);
            if substep.unchanged[k] { mu } else { self.carried(k, mu) }
        };
        let updates: Vec<_> = (0..self.model.factors.len()).map(update).collect();
        Formula::new("momentum update", "M⁺", &updates)
    }
}

/// The expression with matrices of blocks multiplied block by block, where it has such and that is shorter.
fn without_embeddings(expression: Expr<'_>) -> Expr<'_> {
    let text = expression.to_string();
    if !text.contains("embed(") {
        return expression;
    }
    let blockwise = expression.expand().blockwise().expand();
    if blockwise.to_string().chars().count() < text.chars().count() { blockwise } else { expression }
}

/// Each expression as it is or expanded, whichever is shorter.
fn readable<'g>(expressions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let length = |expression: &Expr<'g>| expression.to_string().chars().count();
    expressions
        .iter()
        .flat_map(|expression| [expression.expand(), *expression].into_iter().min_by_key(length))
        .collect()
}

fn tuple(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
}

impl fmt::Display for Formulas<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for formula in self.listing() {
            writeln!(f, "{}", formula.to_string().trim_end())?;
        }
        Ok(())
    }
}
