//! The rows of the discrete Lagrangian and of its Legendre transforms.

use clebsch_symbolic::{Expr, Property, Role, Shape};

use super::{Names, tuple};
use crate::derive::formula::Wording;
use crate::derive::symbols::moved_on;
use crate::derive::{Formula, Id, MechanicsFormulas, exact};

impl<'g> MechanicsFormulas<'g> {
    /// The discrete Lagrangian, part by part, and its Legendre transforms.
    pub(super) fn rows_of_lagrangian(&self, Names { q, f, .. }: &Names) -> [Formula<'g>; 5] {
        let end = self.end_of_step(self.lagrangian.end);
        let next = tuple(self.symbols.images.iter().map(Expr::to_string));
        // the factors that move freely, with the symbols of their momenta and of their elements
        let free = (0..self.model.factors.len()).filter(|&k| exact::is_free_rotation(&self.model, k));
        let free: Vec<_> = free.map(|k| (k, self.symbols.momenta[k], self.model.factors[k].symbol)).collect();
        let legendre = Formula::shorter(Id::Legendre, format!("F⁻ℓd({q}, {f})"), self.legendre.clone());
        let mut legendre_next = Formula::new(Id::LegendreNext, format!("F⁺ℓd({q}, {f})"), self.legendre_next.clone());
        if let Some(kick) = &self.legendre_kick {
            let is_timed = kick.iter().any(|part| part.depends_on(self.model.time));
            let place = if is_timed { format!("(t⁺, {q}⁺)") } else { format!("{q}⁺") };
            legendre_next.wording = Wording::AndKick(place, kick.clone());
        }
        let after = self.with_inverses(&self.legendre_with_last_kick());
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
            Formula::new(Id::StartPotential, start, [self.lagrangian.start]),
            Formula::new(Id::EndPotential, format!("U₁({}h, {next})", time(self.lagrangian.end, "t⁺, ")), [end]),
            Formula { free: free.clone(), ..legendre }.computed_as(self.with_inverses(&self.legendre)),
            Formula { free, ..legendre_next }.computed_as(after),
        ]
    }

    /// F⁺ℓd with its last kick at q⁺ = Φ_F(q).
    fn legendre_with_last_kick(&self) -> Vec<Expr<'g>> {
        let Some(kick) = &self.legendre_kick else { return self.legendre_next.clone() };
        let end = moved_on(&self.model);
        self.legendre_next.iter().zip(kick).map(|(kinetic, kick)| *kinetic + kick.substitute(&end)).collect()
    }

    /// A function of (t, q) at the end of a step: of (t⁺, q⁺).
    fn end_of_step(&self, function: Expr<'g>) -> Expr<'g> {
        let time = self.model.graph.symbol("t⁺", Shape::scalar(), Role::Letter, Property::General);
        let mut moved = self.images_of_leaves();
        moved.push((self.model.time, time));
        function.substitute(&moved)
    }
}
