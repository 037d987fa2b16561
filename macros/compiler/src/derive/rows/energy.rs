//! The rows of the energies, as functions of the velocity and of the momentum, and of the discrete Lagrangian.

use clebsch_symbolic::{Elements, Expr, IntoList, Property, Role, Shape, identity};

use super::{Names, tuple};
use crate::derive::formula::Wording;
use crate::derive::symbols::moved_on;
use crate::derive::{ConstraintFormulas, Formula, Id, MechanicsFormulas, PlaceFormulas, exact};
use crate::model::Kinetic;

impl<'g> MechanicsFormulas<'g> {
    /// The energies, as functions of the velocity and of the momentum.
    pub(super) fn rows_of_energy(&self, names: &Names) -> [Formula<'g>; 10] {
        let Names { q, xi, mu, .. } = names;
        let slopes = self.symbols.algebra.iter().map(|xi| self.energy.kinetic.gradient(*xi).expand());
        let slopes: Vec<Expr<'g>> = slopes.into_list();
        let general: Vec<Expr<'g>> = self.energy.general.into_iter().into_list();
        let gradient: Vec<_> = general.each(|lagrangian| self.symbols.slope(*lagrangian));
        let hessian: Vec<_> = gradient.each(|gradient| self.symbols.slopes(*gradient));
        let linear = self.symbols.slope(self.energy.gyroscopic);
        let gyroscopic = if identity::vanishes(linear) { Vec::new() } else { vec![linear] };
        let parts = [Some(self.energy.kinetic), Some(self.energy.gyroscopic), self.energy.general];
        let moves = parts.into_iter().flatten().any(|part| self.model.reads_configuration(part));
        let kinetic = if moves { format!("T({q}, {mu})") } else { format!("T({mu})") };
        [
            Formula::new(Id::Inertia, format!("Σ{xi}"), slopes),
            Formula::new(Id::KineticEnergy, format!("T({xi})"), [self.energy.kinetic + self.energy.gyroscopic]),
            Formula::new(Id::Lagrangian, format!("ℓ({xi})"), general),
            Formula::new(Id::LagrangianGradient, format!("∂ℓ/∂{xi}"), gradient),
            Formula::new(Id::LagrangianHessian, format!("∂²ℓ/∂{xi}²"), hessian),
            Formula::new(Id::Gyroscopic, "A", gyroscopic),
            Formula::new(Id::PotentialEnergy, format!("V({q})"), [self.potential_energy]),
            self.row_of_energy(names, Id::Hamiltonian, format!("H({q}, {mu})"), self.potential_energy),
            self.row_of_energy(names, Id::KineticEnergyOfMomentum, kinetic, self.model.graph.integer(0)),
            Formula::new(Id::Force, "f", self.covector.clone().unwrap_or_default()),
        ]
    }

    /// The constraint, and that of a step; the momentum of a velocity.
    pub(super) fn rows_of_constraint(&self, Names { q, f, xi, mu, x, .. }: &Names) -> Vec<Formula<'g>> {
        let Some(constraint) = &self.constraint else { return Vec::new() };
        let ConstraintFormulas { rows, values, velocity, metric, between, momentum, ref places, along, lag, .. } =
            *constraint;
        let row = Formula::new(Id::Constraint, format!("(A, b)({q}), A {xi} = b"), [rows, values]);
        let of_places = |&PlaceFormulas { value, rows, metric, moved }: &PlaceFormulas<'g>| {
            let correction = Formula::new(Id::PlaceCorrection, x, [value, rows, metric, moved])
                .in_words("−s·Σ⁻¹·Aᵀ·S⁻¹·φ".into(), "-s\\,\\Sigma^{-1} A^T S^{-1} \\varphi".into());
            [Formula::new(Id::Places, format!("0 = φ({q})"), [value]).computed_as(vec![value, rows]), correction]
        };
        let places = places.as_ref().map(of_places);
        let multipliers = Formula::new(Id::Multipliers, format!("κ({q}, p), Aᵀκ = p"), [metric, along])
            .in_words("S⁻¹·A·Σ⁻¹·p".into(), "S^{-1} A \\Sigma^{-1} p".into());
        let reactions = Formula::new(Id::Reactions, format!("λ({q}, {mu})"), [metric, lag]).in_words(
            format!("−S⁻¹·d/dt (A·{xi} − b) where λ = 0, {xi} = Σ⁻¹{mu}"),
            format!("-S^{{-1}} \\frac{{d}}{{dt}} (A\\,{xi} - b) \\text{{ where }} \\lambda = 0,\\quad {xi} = \\Sigma^{{-1}} {mu}"),
        );
        let known = [
            row.computed_as(vec![rows, values, velocity, metric]),
            Formula::new(Id::DiscreteConstraint, format!("ψ({q}, {f})"), [between]),
            Formula::new(Id::MomentumOfVelocity, format!("Σ{xi} + A"), [momentum]),
            multipliers,
            reactions,
        ];
        places.into_iter().flatten().chain(known).into_list()
    }

    /// ½ (μ − A)·Σ⁻¹(μ − A), or μ·ξ − ℓ(ξ) where ℓ is not quadratic, and a potential energy added to it.
    fn row_of_energy(&self, names: &Names, id: Id, symbol: String, potential: Expr<'g>) -> Formula<'g> {
        let (Names { xi, mu, .. }, graph) = (names, self.model.graph);
        if let Some(lagrangian) = self.energy.general {
            let pairs = self.symbols.momenta.iter().zip(&self.symbols.algebra);
            let pairing = graph.total(Shape::scalar(), pairs.map(|(mu, xi)| mu.dot(*xi)));
            return Formula::new(id, format!("{symbol}, with {mu} = ∂ℓ/∂{xi}"), [pairing - lagrangian + potential]);
        }
        let shape = self.inertia.shape();
        let momentum = graph.symbol(mu, Shape::vector(shape.rows), Role::Letter, Property::General);
        let inertia = graph.symbol("Σ", shape, Role::Letter, Property::Symmetric);
        let momentum = momentum - self.symbols.slope(self.energy.gyroscopic);
        let kinetic = momentum.dot(inertia.inverse() * momentum) / 2;
        Formula::new(id, symbol, [kinetic + potential])
    }

    /// The vertical term: a part of K, or of a declared Lagrangian.
    fn row_of_vertical_term(&self, Names { q, f, .. }: &Names) -> Formula<'g> {
        let term: Vec<Expr<'g>> = self.vertical.iter().map(|vertical| vertical.term).into_list();
        let symbol = match &self.model.kinetic {
            Kinetic::Cost(_) => format!("W(h, {q}, {f})"),
            Kinetic::Lagrangian { name, .. } => format!("W({q}, {name})"),
        };
        Formula::new(Id::VerticalTerm, symbol, term)
    }

    /// The discrete Lagrangian, part by part, and its Legendre transforms.
    pub(super) fn rows_of_lagrangian(&self, names: &Names) -> [Formula<'g>; 6] {
        let Names { q, f, .. } = names;
        // as a function of (t⁺, q⁺)
        let mut moved = self.images_of_leaves();
        moved.push((self.model.time, self.model.graph.symbol("t⁺", Shape::scalar(), Role::Letter, Property::General)));
        let end = self.lagrangian.end.substitute(&moved);
        let next = tuple(self.symbols.images.iter().map(Expr::to_string));
        // the factors that move freely, with the symbols of their momenta and of their elements
        let free = (0..self.model.factors.len()).filter(|&k| exact::is_free_rotation(&self.model, k));
        let free: Vec<_> = free.map(|k| (k, self.symbols.momenta[k], self.model.factors[k].symbol)).into_list();
        let legendre = Formula::shorter(Id::Legendre, format!("F⁻ℓd({q}, {f})"), self.legendre.clone());
        let mut legendre_next = Formula::new(Id::LegendreNext, format!("F⁺ℓd({q}, {f})"), self.legendre_next.clone());
        let mut after = self.legendre_next.clone();
        if let Some(kick) = &self.legendre_kick {
            let is_timed = kick.iter().any(|part| part.depends_on(self.model.time));
            let place = if is_timed { format!("(t⁺, {q}⁺)") } else { format!("{q}⁺") };
            legendre_next.wording = Wording::AndKick(place, kick.clone());
            // the computed expression has its last kick at q⁺ = Φ_F(q)
            let end = moved_on(&self.model);
            after.iter_mut().zip(kick).for_each(|(after, kick)| *after = *after + kick.substitute(&end));
        }
        let after = self.with_inverses(&after);
        let time = |part: Expr<'g>, name| if part.depends_on(self.model.time) { name } else { "" };
        let place = if self.lagrangian.couples { format!("{q}, ") } else { String::new() };
        let symbol = format!("K({}h, {place}{f})", time(self.lagrangian.kinetic, "t, "));
        let mut lagrangian = Formula::new(Id::DiscreteLagrangian, symbol, [self.lagrangian.kinetic]);
        if !free.is_empty() {
            lagrangian = lagrangian.in_words(
                format!("∫₀ʰ T dt along the free motion from I to {f}"),
                format!("\\int_0^h T\\,dt \\text{{ along the free motion from }} I \\text{{ to }} {f}"),
            );
        }
        let start = format!("U₀({}h, {q})", time(self.lagrangian.start, "t, "));
        [
            lagrangian,
            self.row_of_vertical_term(names),
            Formula::new(Id::StartPotential, start, [self.lagrangian.start]),
            Formula::new(Id::EndPotential, format!("U₁({}h, {next})", time(self.lagrangian.end, "t⁺, ")), [end]),
            Formula { free: free.clone(), ..legendre }.computed_as(self.with_inverses(&self.legendre)),
            Formula { free, ..legendre_next }.computed_as(after),
        ]
    }
}
