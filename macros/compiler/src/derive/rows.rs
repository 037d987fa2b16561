//! The rows of the table of formulas, made of what was derived.

mod energy;
mod lagrangian;
mod motions;
mod steps;

use clebsch_symbolic::{Expr, Property};

use super::increments::inverse_by;
use super::{Formula, FormulaTable, Id, MechanicsFormulas, SteeredFormulas, SystemFormulas};
use crate::model::{Factor, LeafSpace, Motion};

/// More conserved momenta are told by the first and the last of them.
pub(super) const MOST_LISTED: usize = 16;

impl<'g> SystemFormulas<'g> {
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

    /// The user's name for the input.
    fn u(&self) -> String {
        tuple(self.model.inputs.iter().map(|leaf| leaf.name.clone()))
    }

    /// The action and what follows from it alone.
    fn rows_of_action(&self) -> Vec<Formula<'g>> {
        let (q, f) = (self.q(), self.f());
        let xi = self.letter(&self.symbols.algebra);
        let action = Formula::new(Id::Action, format!("Φ_{f}({q})"), &self.model.action);
        vec![
            action.computed_as(self.with_inverses(&self.model.action)),
            Formula::new(Id::Generator, format!("{xi}_Q({q})"), &self.generator),
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
        Formula::new(Id::Membership, "0", &equations.collect::<Vec<_>>())
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
}

impl<'g> SteeredFormulas<'g> {
    /// All formulas.
    pub fn table(&self) -> &FormulaTable<'g> {
        self.table.get_or_init(|| FormulaTable::new(self.rows()))
    }

    /// What inputs move, what they cost, and what binds them.
    fn rows(&self) -> Vec<Formula<'g>> {
        let (q, u, d) = (self.q(), self.u(), self.letter(&self.symbols.increments));
        let mut rows = self.rows_of_action();
        rows.push(self.row_of_membership());
        rows.push(self.row_of_orbit_metric());
        rows.push(Formula::new(Id::Increment, d, &self.step.increment));
        rows.push(Formula::new(Id::Advance, format!("{q}⁺"), &self.at_increments(&self.model.action)));
        rows.push(match &self.model.motion {
            Motion::Controls { velocity, .. } => {
                let symbol = format!("{}({u})", self.letter(&self.symbols.algebra));
                Formula::new(Id::Controls, symbol, velocity)
            }
            Motion::Dynamics(next) => Formula::new(Id::Controls, format!("{q}⁺"), next),
        });
        rows.extend(self.rows_of_choice());
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
        let mut rows = self.rows_of_action();
        rows.extend(self.rows_of_momentum_map());
        rows.extend(self.rows_of_momenta());
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
        rows.extend(self.rows_of_motions());
        let stepped = self.stepped;
        let serves_inversion = |row: &&mut Formula<'g>| row.id.substep().is_some_and(|index| index >= stepped);
        rows.iter_mut().filter(serves_inversion).for_each(|row| row.is_listed = false);
        rows
    }

    /// How momenta are made of covectors, and how both are carried along.
    fn rows_of_momentum_map(&self) -> Vec<Formula<'g>> {
        let (q, f) = (self.q(), self.f());
        let mu = self.letter(&self.symbols.momenta);
        let p = self.letter(&self.symbols.covectors);
        let coadjoint = Formula::new(Id::Coadjoint, format!("Ad*_{f} {mu}"), &self.coadjoint);
        vec![
            Formula::new(Id::MomentumMap, format!("J({q}, {p})"), &self.momentum_map),
            coadjoint.computed_as(self.with_inverses(&self.coadjoint)),
            Formula::new(Id::CotangentLift, format!("(TΦ_{f})^-* {p} at {q}⁺"), &self.cotangent_lift),
        ]
    }

    /// Momenta as matrices, and what lies on a group.
    fn rows_of_momenta(&self) -> Vec<Formula<'g>> {
        let (factors, symbols) = (&self.model.factors, &self.symbols);
        let [mu, matrix] = [&symbols.momenta, &symbols.momentum_matrices].map(|letters| self.letter(letters));
        let matrices = factors.iter().zip(&symbols.momenta).map(|(factor, mu)| factor.group.momentum_matrix(*mu));
        let components = factors.iter().zip(&symbols.momentum_matrices).map(|(factor, m)| factor.group.components(*m));
        vec![
            self.row_of_membership(),
            Formula::new(Id::MomentumMatrix, matrix.as_str(), &matrices.collect::<Vec<_>>()),
            Formula::new(Id::MomentumComponents, mu, &components.collect::<Vec<_>>()),
        ]
    }

    /// The terms of the potential of a power, and their gradients.
    fn rows_of_terms(&self) -> Vec<Formula<'g>> {
        let Some(power) = &self.model.power else { return Vec::new() };
        let term = |(number, link): (usize, &super::SiteTerm<'g>)| {
            let symbol = format!("V_{}, for each {}", number + 1, link.term.indices());
            let symbol = symbol.trim_end_matches(", for each ").to_string();
            Formula::shorter(Id::Term(number), symbol, &[link.term.value])
        };
        let gradients = |(number, link): (usize, &super::SiteTerm<'g>)| {
            let gradient = |(place, slopes): &(usize, Vec<Expr<'g>>)| {
                let symbol = format!("∂V_{}/∂{}[{}]", number + 1, self.q(), power.places[*place].text());
                Formula::shorter(Id::TermGradient(number, *place), symbol, slopes)
            };
            link.gradient.iter().map(gradient).collect::<Vec<_>>()
        };
        let terms = self.links.iter().enumerate().map(term);
        terms.chain(self.links.iter().enumerate().flat_map(gradients)).collect()
    }

    /// The conserved momenta by their names.
    fn rows_of_conserved(&self) -> Vec<Formula<'g>> {
        let conserved = &self.symmetries.conserved;
        let row = |number: usize, before: &str| {
            let momentum = &conserved[number];
            Formula::shorter(Id::Conserved(number), format!("{before}{}", momentum.name), &[momentum.value])
        };
        let mut rows: Vec<_> = match conserved.len() {
            count if count > MOST_LISTED => vec![row(0, ""), row(count - 1, "… ")],
            count => (0..count).map(|number| row(number, "")).collect(),
        };
        rows.push(self.row_of_conserved_momenta());
        rows
    }

    /// The values of all conserved momenta, with the inverses of configurations by the formulas of their groups.
    fn row_of_conserved_momenta(&self) -> Formula<'g> {
        let leaves = self.model.configurations.iter().filter_map(|leaf| match leaf.space {
            LeafSpace::Group(group) => Some(inverse_by(group, leaf.symbol, leaf.symbol)),
            _ => None,
        });
        let inverses: Vec<_> = leaves.flatten().collect();
        let values = self.symmetries.conserved.iter().map(|momentum| momentum.value.substitute(&inverses));
        Formula::new(Id::ConservedMomenta, "conserved", &values.collect::<Vec<_>>())
    }
}

fn tuple(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
}
