//! The rows of the table of formulas, made of what was derived.

mod energy;
mod lagrangian;
mod motions;
mod steps;

use clebsch_symbolic::{Expr, Property};

use super::increments::inverse_by;
use super::{Formula, FormulaTable, Id, MechanicsFormulas, SiteTerm, SteeredFormulas, SystemFormulas};
use crate::model::{Factor, InputChoice, LeafSpace, Motion};

/// More conserved momenta are told by the first and the last of them.
pub(super) const MOST_LISTED: usize = 16;

/// What formulas call things: the user's names, and the letters of symbols that differ in their subscripts.
struct Names {
    q: String,
    f: String,
    u: String,
    xi: String,
    mu: String,
    p: String,
    d: String,
    x: String,
    delta: String,
}

impl<'g> SystemFormulas<'g> {
    fn names(&self) -> Names {
        let symbols = &self.symbols;
        let letter = |symbol: Option<&Expr<'g>>| {
            let name = symbol.map(Expr::to_string).unwrap_or_default();
            name.trim_end_matches(|c: char| ('₀'..='₉').contains(&c)).to_string()
        };
        Names {
            q: tuple(self.model.configurations.iter().map(|leaf| leaf.name.as_str())),
            f: tuple(self.model.factors.iter().map(|factor| factor.name.as_str())),
            u: tuple(self.model.inputs.iter().map(|leaf| leaf.name.as_str())),
            xi: letter(symbols.algebra.first()),
            mu: letter(symbols.momenta.first()),
            p: letter(symbols.covectors.first()),
            d: letter(symbols.increments.first()),
            x: letter(symbols.blocks.first().map(|block| &block.coordinates)),
            delta: letter(symbols.blocks.first().map(|block| &block.direction)),
        }
    }

    /// The action and what follows from it alone.
    fn rows_of_action(&self, Names { q, f, xi, .. }: &Names) -> [Formula<'g>; 2] {
        let action = Formula::new(Id::Action, format!("Φ_{f}({q})"), self.model.action.clone());
        [
            action.computed_as(self.with_inverses(&self.model.action)),
            Formula::new(Id::Generator, format!("{xi}_Q({q})"), self.generator.clone()),
        ]
    }

    /// Expressions with the formula that each group has for F⁻¹, and with log F.
    fn with_inverses(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let explicit = |(factor, y): (&Factor<'g>, &Expr<'g>)| {
            let logarithm = (*y, factor.group.logarithm(factor.symbol));
            inverse_by(factor.group, factor.symbol, factor.symbol).into_iter().chain([logarithm])
        };
        let factors = self.model.factors.iter().zip(&self.symbols.logarithms);
        let inverses: Vec<_> = factors.flat_map(explicit).collect();
        parts.iter().map(|part| part.substitute(&inverses)).collect()
    }

    /// What vanishes where q lies on its groups. Those of SO(n) and of the unit sphere are the runtime's.
    fn row_of_membership(&self) -> Formula<'g> {
        let equations = self.model.configurations.iter().flat_map(|leaf| match leaf.space {
            LeafSpace::Group(group) if group.element_property() != Property::Orthogonal => group.equations(leaf.symbol),
            _ => Vec::new(),
        });
        Formula::new(Id::Membership, "0", equations.collect::<Vec<_>>())
    }

    /// Price, bounds and the price of the end.
    fn rows_of_choice(&self, Names { q, u, .. }: &Names) -> Vec<Formula<'g>> {
        let control = self.model.control.as_ref();
        let price = control.map(|control| Formula::new(Id::Price, format!("ℓ(h, {u})"), [control.price]));
        let values = |control: &InputChoice<'g>| control.bounds.iter().map(|bound| bound.value).collect::<Vec<_>>();
        let bounds = control.map(|control| Formula::new(Id::Bounds, "0 ≥ a", values(control)));
        let of_end = self.model.endpoint.map(|price| Formula::new(Id::PriceOfEnd, format!("φ({q})"), [price]));
        [price, bounds, of_end].into_iter().flatten().collect()
    }
}

impl<'g> SteeredFormulas<'g> {
    /// All formulas.
    pub fn table(&self) -> &FormulaTable<'g> {
        self.table.get_or_init(|| FormulaTable::new(self.rows()))
    }

    /// What inputs move, what they cost, and what binds them.
    fn rows(&self) -> Vec<Formula<'g>> {
        let names = self.names();
        let Names { q, u, xi, d, .. } = &names;
        let mut rows = Vec::from(self.rows_of_action(&names));
        rows.push(self.row_of_membership());
        rows.push(self.row_of_orbit_metric(&names));
        rows.push(Formula::new(Id::Increment, d, self.step.increment.clone()));
        rows.push(Formula::new(Id::Advance, format!("{q}⁺"), self.at_increments(&self.model.action)));
        rows.push(match &self.model.motion {
            Motion::Controls { velocity, .. } => Formula::new(Id::Controls, format!("{xi}({u})"), velocity.clone()),
            Motion::Dynamics(next) => Formula::new(Id::Controls, format!("{q}⁺"), next.clone()),
        });
        rows.extend(self.rows_of_choice(&names));
        rows
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// All formulas.
    pub fn table(&self) -> &FormulaTable<'g> {
        self.table.get_or_init(|| FormulaTable::new(self.rows()))
    }

    /// The formula with an id, or none where a system does not have it.
    pub fn titled(&self, id: Id) -> &[Formula<'g>] {
        self.table().titled(id)
    }

    /// The right sides of a formula; `None` where a system does not have it.
    pub fn value(&self, id: Id) -> Option<&[Expr<'g>]> {
        self.table().value(id)
    }

    fn rows(&self) -> Vec<Formula<'g>> {
        let names = self.names();
        let mut rows = Vec::from(self.rows_of_action(&names));
        rows.extend(self.rows_of_momenta(&names));
        rows.extend(self.rows_of_energy(&names));
        rows.extend(self.rows_of_lagrangian(&names));
        rows.extend(self.rows_of_terms(&names));
        rows.extend(self.rows_of_choice(&names));
        rows.extend(self.rows_of_conserved());
        for index in 0..self.substeps.len() {
            // what serves the inverse Legendre transform alone is not listed
            let of_substep = self.rows_of_substep(&names, index).into_iter();
            rows.extend(of_substep.map(|row| row.listed_if(index < self.stepped)));
        }
        rows.extend(self.rows_of_move(&names));
        rows.extend(self.rows_of_scheme(&names));
        rows.extend(self.rows_of_motions(&names));
        rows
    }

    /// How momenta are made of covectors, how both are carried along, and momenta as matrices; what lies on a group.
    fn rows_of_momenta(&self, Names { q, f, mu, p, .. }: &Names) -> [Formula<'g>; 6] {
        let (factors, symbols) = (&self.model.factors, &self.symbols);
        let coadjoint = Formula::new(Id::Coadjoint, format!("Ad*_{f} {mu}"), self.coadjoint.clone());
        let coadjoint = coadjoint.computed_as(self.with_inverses(&self.coadjoint));
        let lift = Formula::new(Id::CotangentLift, format!("(TΦ_{f})^-* {p} at {q}⁺"), self.cotangent_lift.clone());
        let membership = self.row_of_membership();
        let matrices = factors.iter().zip(&symbols.momenta).map(|(factor, mu)| factor.group.momentum_matrix(*mu));
        let matrices: Vec<_> = matrices.collect();
        let components = factors.iter().zip(&symbols.momentum_matrices).map(|(factor, m)| factor.group.components(*m));
        [
            Formula::new(Id::MomentumMap, format!("J({q}, {p})"), self.momentum_map.clone()),
            coadjoint,
            lift,
            membership,
            Formula::new(Id::MomentumMatrix, "M", matrices),
            Formula::new(Id::MomentumComponents, mu, components.collect::<Vec<_>>()),
        ]
    }

    /// The terms of the potential of a power, and their gradients.
    fn rows_of_terms(&self, Names { q, .. }: &Names) -> Vec<Formula<'g>> {
        let Some(power) = &self.model.power else { return Vec::new() };
        let links = || self.links.iter().enumerate();
        let term = |(number, link): (usize, &SiteTerm<'g>)| {
            let symbol = format!("V_{}, for each {}", number + 1, link.term.indices());
            Formula::shorter(Id::Term(number), symbol.trim_end_matches(", for each "), [link.term.value])
        };
        let gradient = |(number, place, slopes): (usize, usize, &Vec<Expr<'g>>)| {
            let symbol = format!("∂V_{}/∂{q}[{}]", number + 1, power.places[place].text());
            Formula::shorter(Id::TermGradient(number, place), symbol, slopes.clone())
        };
        let gradients = links()
            .flat_map(|(number, link)| link.gradient.iter().map(move |(place, slopes)| (number, *place, slopes)));
        links().map(term).chain(gradients.map(gradient)).collect()
    }

    /// The conserved momenta by their names, and the values of all of them, with the inverses of configurations by the formulas of their groups.
    fn rows_of_conserved(&self) -> Vec<Formula<'g>> {
        let conserved = &self.symmetries.conserved;
        let row = |number: usize, before: &str| {
            let momentum = &conserved[number];
            Formula::shorter(Id::Conserved(number), format!("{before}{}", momentum.name), [momentum.value])
        };
        let mut rows: Vec<_> = match conserved.len() {
            count if count > MOST_LISTED => vec![row(0, ""), row(count - 1, "… ")],
            count => (0..count).map(|number| row(number, "")).collect(),
        };
        let inverses = self.model.configurations.iter().flat_map(|leaf| match leaf.space {
            LeafSpace::Group(group) => inverse_by(group, leaf.symbol, leaf.symbol),
            _ => Vec::new(),
        });
        let inverses: Vec<_> = inverses.collect();
        let values: Vec<_> = conserved.iter().map(|momentum| momentum.value.substitute(&inverses)).collect();
        rows.push(Formula::new(Id::ConservedMomenta, "conserved", values));
        rows
    }
}

fn tuple<'n>(names: impl Iterator<Item = &'n str>) -> String {
    let names: Vec<&str> = names.collect();
    if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
}
