//! The rows of the discrete Lagrangian and of its Legendre transforms.

use clebsch_symbolic::{Expr, Property, Role, Shape};

use super::tuple;
use crate::derive::{Formula, Id, MechanicsFormulas};

impl<'g> MechanicsFormulas<'g> {
    /// The discrete Lagrangian, part by part, and its Legendre transforms.
    pub(super) fn rows_of_lagrangian(&self) -> Vec<Formula<'g>> {
        let (q, f, end) = (self.q(), self.f(), self.end_of_step(self.lagrangian.end));
        let next = tuple(self.symbols.images.iter().map(|image| image.to_string()));
        let legendre = Formula::shorter(Id::Legendre, format!("F⁻ℓd({q}, {f})"), &self.legendre);
        let legendre_next = Formula::new(Id::LegendreNext, format!("F⁺ℓd({q}, {f})"), &self.legendre_next);
        let legendre_next = match &self.legendre_kick {
            Some(kick) => legendre_next.and_kick(self.place_of_end(kick), kick),
            None => legendre_next,
        };
        let after = self.with_inverses(&self.legendre_with_last_kick());
        vec![
            self.row_of_discrete_lagrangian(),
            Formula::new(
                Id::StartPotential,
                format!("U₀({}h, {q})", self.time(self.lagrangian.start, "t")),
                &[self.lagrangian.start],
            ),
            Formula::new(Id::EndPotential, format!("U₁({}h, {next})", self.time(self.lagrangian.end, "t⁺")), &[end]),
            legendre.of_free_motions(self.free_motions()).computed_as(self.with_inverses(&self.legendre)),
            legendre_next.of_free_motions(self.free_motions()).computed_as(after),
        ]
    }

    /// F⁺ℓd with its last kick at q⁺ = Φ_F(q).
    fn legendre_with_last_kick(&self) -> Vec<Expr<'g>> {
        let Some(kick) = &self.legendre_kick else { return self.legendre_next.clone() };
        let leaves = self.model.configurations.iter().zip(&self.model.action);
        let mut moved: Vec<_> = leaves.map(|(leaf, image)| (leaf.symbol, *image)).collect();
        moved.push((self.model.time, self.model.time + self.model.step_size));
        self.legendre_next.iter().zip(kick).map(|(kinetic, kick)| *kinetic + kick.substitute(&moved)).collect()
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
}
