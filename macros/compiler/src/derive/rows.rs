//! The rows of the table of formulas, made of what was derived.

mod steps;

use clebsch_symbolic::{Expr, Property, Role, Shape};

use super::{Formula, Formulas, Id};
use crate::model::Kinetic;

/// More conserved momenta are told by the first and the last of them.
pub(super) const MOST_LISTED: usize = 16;

impl<'g> Formulas<'g> {
    /// All formulas, in the order of the derivation.
    pub fn table(&self) -> &[Formula<'g>] {
        self.table.get_or_init(|| self.rows())
    }

    /// The formulas that prints and `DERIVATION` show: those that are listed, unless they say that something vanishes.
    pub fn listing(&self) -> impl Iterator<Item = &Formula<'g>> {
        let is_shown = |id: Id| id.substep().is_none_or(|index| index < self.parts);
        self.table().iter().filter(move |row| row.id.entry().is_listed && is_shown(row.id) && !row.is_trivial())
    }

    /// The formula with an id, or none where a system does not have it.
    pub fn titled(&self, id: Id) -> &[Formula<'g>] {
        self.titled_all(|other| other == id)
    }

    /// The right sides of a formula; `None` where a system does not have it.
    pub fn value(&self, id: Id) -> Option<&[Expr<'g>]> {
        self.titled(id).first().map(|row| row.value.as_slice())
    }

    /// The formulas whose ids are of a kind; they stand together in the table.
    pub fn titled_all(&self, is_meant: impl Fn(Id) -> bool) -> &[Formula<'g>] {
        let (table, is_meant) = (self.table(), |row: &Formula<'g>| is_meant(row.id));
        let Some(first) = table.iter().position(&is_meant) else { return &[] };
        let count = table[first..].iter().take_while(|row| is_meant(row)).count();
        &table[first..first + count]
    }

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

    fn rows(&self) -> Vec<Formula<'g>> {
        if self.model.is_steered() {
            return self.rows_of_steered();
        }
        let mut rows = self.rows_of_action();
        rows.extend(self.rows_of_energy());
        rows.extend(self.rows_of_lagrangian());
        rows.extend(self.rows_of_terms());
        rows.extend(self.rows_of_choice());
        rows.extend(self.rows_of_conserved());
        for index in 0..self.substeps.len() {
            rows.extend(self.rows_of_substep(index));
        }
        rows.extend(self.rows_of_move());
        rows.extend(self.row_of_stagger());
        rows.extend(self.rows_of_splitting());
        rows.extend(self.rows_of_collocation());
        rows.retain(|row| !row.value.is_empty());
        rows
    }

    /// What inputs move, what they cost, and what binds them.
    fn rows_of_steered(&self) -> Vec<Formula<'g>> {
        let (q, u) = (self.q(), self.u());
        let mut rows = self.rows_of_action();
        rows.truncate(2);
        match &self.model.kinetic {
            Kinetic::Controls { velocity, .. } => {
                let symbol = format!("{}({u})", self.letter(&self.symbols.algebra));
                rows.push(Formula::new(Id::Controls, symbol, velocity));
            }
            Kinetic::Dynamics(next) => rows.push(Formula::new(Id::Controls, format!("{q}⁺"), next)),
            Kinetic::Cost(_) | Kinetic::Lagrangian { .. } => {}
        }
        rows.extend(self.rows_of_choice());
        rows.retain(|row| !row.value.is_empty());
        rows
    }

    /// The user's name for the input.
    fn u(&self) -> String {
        tuple(self.model.inputs.iter().map(|leaf| leaf.name.clone()))
    }

    /// The action and what follows from it alone.
    fn rows_of_action(&self) -> Vec<Formula<'g>> {
        let (q, f) = (self.q(), self.f());
        let xi = self.letter(&self.symbols.algebra);
        let mu = self.letter(&self.symbols.momenta);
        let p = self.letter(&self.symbols.covectors);
        vec![
            Formula::new(Id::Action, format!("Φ_{f}({q})"), &self.model.action),
            Formula::new(Id::Generator, format!("{xi}_Q({q})"), &self.generator),
            Formula::new(Id::MomentumMap, format!("J({q}, {p})"), &self.momentum_map),
            Formula::new(Id::Coadjoint, format!("Ad*_{f} {mu}"), &self.coadjoint),
            Formula::new(Id::CotangentLift, format!("(TΦ_{f})^-* {p} at {q}⁺"), &self.cotangent_lift),
        ]
    }

    /// The energies, as functions of the velocity and of the momentum.
    fn rows_of_energy(&self) -> Vec<Formula<'g>> {
        let xi = self.letter(&self.symbols.algebra);
        let slopes = self.symbols.algebra.iter().map(|xi| self.energy.kinetic.gradient(*xi).expand());
        let slopes: Vec<Expr<'g>> = slopes.collect();
        let general: Vec<Expr<'g>> = self.energy.general.into_iter().collect();
        let mu = self.letter(&self.symbols.momenta);
        let kinetic = if self.kinetic_energy_moves() { format!("T({}, {mu})", self.q()) } else { format!("T({mu})") };
        vec![
            Formula::new(Id::Inertia, format!("Σ{xi}"), &slopes),
            Formula::new(Id::KineticEnergy, format!("T({xi})"), &[self.energy.kinetic + self.energy.gyroscopic]),
            Formula::new(Id::Lagrangian, format!("ℓ({xi})"), &general),
            Formula::new(Id::PotentialEnergy, format!("V({})", self.q()), &[self.potential_energy]),
            self.row_of_energy(Id::Hamiltonian, format!("H({}, {mu})", self.q()), self.potential_energy),
            self.row_of_energy(Id::KineticEnergyOfMomentum, kinetic, self.model.graph.integer(0)),
            Formula::new(Id::Force, "f", self.covector.as_deref().unwrap_or_default()),
        ]
    }

    /// ½ (μ − A)·Σ⁻¹(μ − A), or μ·ξ − ℓ(ξ) where ℓ is not quadratic, and a potential energy added to it.
    fn row_of_energy(&self, id: Id, symbol: String, potential: Expr<'g>) -> Formula<'g> {
        let mu = self.letter(&self.symbols.momenta);
        if let Some(lagrangian) = self.energy.general {
            let pairs = self.symbols.momenta.iter().zip(&self.symbols.algebra);
            let pairing = pairs.fold(self.model.graph.integer(0), |sum, (mu, xi)| sum + mu.dot(*xi));
            let symbol = format!("{symbol}, with {mu} = ∂ℓ/∂{}", self.letter(&self.symbols.algebra));
            return Formula::new(id, symbol, &[pairing - lagrangian + potential]);
        }
        let (graph, shape) = (self.model.graph, self.inertia.shape());
        let momentum = graph.symbol(&mu, Shape::vector(shape.rows), Role::Letter, Property::General);
        let inertia = graph.symbol("Σ", shape, Role::Letter, Property::Symmetric);
        let momentum = momentum - self.symbols.slope(self.energy.gyroscopic);
        let kinetic = momentum.dot(inertia.inverse() * momentum) / 2;
        Formula::new(id, symbol, &[kinetic + potential])
    }

    /// Whether the kinetic energy depends on the configuration.
    fn kinetic_energy_moves(&self) -> bool {
        let parts = [Some(self.energy.kinetic), Some(self.energy.gyroscopic), self.energy.general];
        let depends = |part: Expr<'g>| self.model.configurations.iter().any(|leaf| part.depends_on(leaf.symbol));
        parts.into_iter().flatten().any(depends)
    }

    /// The discrete Lagrangian, part by part, and its Legendre transforms.
    fn rows_of_lagrangian(&self) -> Vec<Formula<'g>> {
        let (q, f, end) = (self.q(), self.f(), self.end_of_step(self.lagrangian.end));
        let next = tuple(self.symbols.images.iter().map(|image| image.to_string()));
        let legendre = Formula::shorter(Id::Legendre, format!("F⁻ℓd({q}, {f})"), &self.legendre);
        let legendre_next = Formula::new(Id::LegendreNext, format!("F⁺ℓd({q}, {f})"), &self.legendre_next);
        let legendre_next = match &self.legendre_kick {
            Some(kick) => legendre_next.and_kick(self.place_of_end(kick), kick),
            None => legendre_next,
        };
        vec![
            self.row_of_discrete_lagrangian(),
            Formula::new(
                Id::StartPotential,
                format!("U₀({}h, {q})", self.time(self.lagrangian.start, "t")),
                &[self.lagrangian.start],
            ),
            Formula::new(Id::EndPotential, format!("U₁({}h, {next})", self.time(self.lagrangian.end, "t⁺")), &[end]),
            legendre.of_free_motions(self.free_motions()),
            legendre_next.of_free_motions(self.free_motions()),
        ]
    }

    /// `t, ` where a part of the discrete Lagrangian depends on the time.
    fn time(&self, part: Expr<'g>, name: &str) -> String {
        if part.depends_on(self.model.time) { format!("{name}, ") } else { String::new() }
    }

    /// A function of (t, q) at the end of a step: of (t⁺, q⁺).
    fn end_of_step(&self, function: Expr<'g>) -> Expr<'g> {
        let time = self.model.graph.symbol("t⁺", Shape::scalar(), Role::Letter, Property::General);
        let leaves = self.model.configurations.iter().zip(&self.symbols.images);
        let mut moved: Vec<(Expr<'g>, Expr<'g>)> = leaves.map(|(leaf, image)| (leaf.symbol, *image)).collect();
        moved.push((self.model.time, time));
        function.substitute(&moved)
    }

    /// `q⁺`, or `(t⁺, q⁺)` for what depends on the time.
    fn place_of_end(&self, parts: &[Expr<'g>]) -> String {
        let is_timed = parts.iter().any(|part| part.depends_on(self.model.time));
        if is_timed { format!("(t⁺, {}⁺)", self.q()) } else { format!("{}⁺", self.q()) }
    }

    /// K(h, F), with what else it depends on.
    fn row_of_discrete_lagrangian(&self) -> Formula<'g> {
        let time = self.time(self.lagrangian.kinetic, "t");
        let q = if self.lagrangian.couples { self.q() + ", " } else { String::new() };
        let symbol = format!("K({time}h, {q}{})", self.f());
        let row = Formula::new(Id::DiscreteLagrangian, symbol, &[self.lagrangian.kinetic]);
        if self.free_motions().is_empty() {
            return row;
        }
        row.in_words(
            format!("∫₀ʰ T dt along the free motion from I to {}", self.f()),
            format!("\\int_0^h T\\,dt \\text{{ along the free motion from }} I \\text{{ to }} {}", self.f()),
        )
    }

    /// The factors that move freely, with the symbols of their momenta and of their elements.
    fn free_motions(&self) -> Vec<(usize, Expr<'g>, Expr<'g>)> {
        let free = (0..self.model.factors.len()).filter(|&k| self.is_free_rotation(k));
        free.map(|k| (k, self.symbols.momenta[k], self.model.factors[k].symbol)).collect()
    }

    /// The terms of the potential of a power, and their gradients.
    fn rows_of_terms(&self) -> Vec<Formula<'g>> {
        let Some(power) = &self.model.power else { return Vec::new() };
        let term = |(number, link): (usize, &super::Link<'g>)| {
            let symbol = format!("V_{}, for each {}", number + 1, link.term.indices());
            let symbol = symbol.trim_end_matches(", for each ").to_string();
            Formula::shorter(Id::Term(number), symbol, &[link.term.value])
        };
        let gradients = |(number, link): (usize, &super::Link<'g>)| {
            let gradient = |(place, slopes): &(usize, Vec<Expr<'g>>)| {
                let symbol = format!("∂V_{}/∂{}[{}]", number + 1, self.q(), power.places[*place].text());
                Formula::shorter(Id::TermGradient(number, *place), symbol, slopes)
            };
            link.gradient.iter().map(gradient).collect::<Vec<_>>()
        };
        let terms = self.links.iter().enumerate().map(term);
        terms.chain(self.links.iter().enumerate().flat_map(gradients)).collect()
    }

    /// Price, bounds and the price of the end.
    fn rows_of_choice(&self) -> Vec<Formula<'g>> {
        let price_of_end = |price| Formula::new(Id::PriceOfEnd, format!("φ({})", self.q()), &[price]);
        let mut rows = Vec::new();
        if let Some(control) = &self.model.control {
            let bounds: Vec<Expr<'g>> = control.bounds.iter().map(|bound| bound.value).collect();
            rows.push(Formula::new(Id::Price, format!("ℓ(h, {})", self.u()), &[control.price]));
            rows.push(Formula::new(Id::Bounds, "0 ≥ a", &bounds));
        }
        rows.extend(self.model.endpoint.map(price_of_end));
        rows
    }

    /// The conserved momenta by their names.
    fn rows_of_conserved(&self) -> Vec<Formula<'g>> {
        let conserved = &self.symmetries.conserved;
        let row = |number: usize, before: &str| {
            let momentum = &conserved[number];
            Formula::shorter(Id::Conserved(number), format!("{before}{}", momentum.name), &[momentum.value])
        };
        if conserved.len() > MOST_LISTED {
            return vec![row(0, ""), row(conserved.len() - 1, "… ")];
        }
        (0..conserved.len()).map(|number| row(number, "")).collect()
    }
}

fn tuple(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
}
