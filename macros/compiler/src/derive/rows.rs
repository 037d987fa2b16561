//! The rows of the table of formulas, from the derived expressions.

mod energy;
mod motions;
mod steps;

use clebsch_symbolic::{Elements, Expr, IntoList, Property, Role, indexed};

use super::constraint::coordinates_of_motion;
use super::midpoint::MidpointFormulas;
use super::moves::inverse_by;
use super::{Formula, FormulaTable, Id, JointRows, MechanicsFormulas, SteeredFormulas, SystemFormulas};
use crate::model::{Bound, Configuration, EdgeEnergy, InputChoice, LeafSpace, Motion};

/// More conserved momenta are told by the first and the last of them.
pub(super) const MOST_LISTED: usize = 16;

/// The names in formulas: those of the user, and the letters of symbols that differ in their subscripts.
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
            q: tuple(self.model.configurations.iter().map(|leaf| leaf.name.clone())),
            f: tuple(self.model.factors.iter().map(|factor| factor.name.clone())),
            u: tuple(self.model.chosen().iter().map(|leaf| leaf.name.clone())),
            xi: letter(symbols.algebra.first()),
            mu: letter(symbols.momenta.first()),
            p: letter(symbols.covectors.first()),
            d: letter(symbols.increments.first()),
            x: letter(symbols.blocks.first().map(|block| &block.coordinates)),
            delta: letter(symbols.blocks.first().map(|block| &block.direction)),
        }
    }

    /// The action and the formulas that follow from it alone.
    fn rows_of_action(&self, Names { q, f, xi, .. }: &Names) -> [Formula<'g>; 2] {
        let action = Formula::new(Id::Action, format!("Φ_{f}({q})"), self.model.action.clone());
        [
            action.computed_as(self.with_inverses(&self.model.action)),
            Formula::new(Id::Generator, format!("{xi}_Q({q})"), self.generator.clone()),
        ]
    }

    /// Expressions with the formula that each group has for F⁻¹, and with log F.
    fn with_inverses(&self, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut inverses = Vec::new();
        for (factor, y) in self.model.factors.iter().zip(&self.symbols.logarithms) {
            let logarithm = (*y, factor.group.logarithm(factor.symbol));
            inverses.extend(inverse_by(factor.group, factor.symbol, factor.symbol));
            inverses.push(logarithm);
        }
        parts.each(|part| part.substitute(&inverses))
    }

    /// The terms that vanish where q lies on its groups, relative to their growth with q. Those of SO(n) and of the unit
    /// sphere are the runtime's.
    fn row_of_membership(&self) -> Formula<'g> {
        let mut equations = Vec::new();
        for leaf in &self.model.configurations {
            match leaf.space {
                LeafSpace::Group(group) if group.element_property() != Property::Orthogonal => {
                    let growth = group.growth(leaf.symbol);
                    let relative = |equation| growth.map_or(equation, |growth| equation / growth);
                    equations.extend(group.equations(leaf.symbol).into_iter().map(relative));
                }
                _ => {}
            }
        }
        Formula::new(Id::Membership, "0", equations)
    }

    /// Price, bounds and the price of the end.
    fn rows_of_choice(&self, Names { q, u, .. }: &Names) -> Vec<Formula<'g>> {
        let mut rows = Vec::new();
        if let (Some(control), Some(steering)) = (&self.model.control, &self.steering) {
            let velocity = tuple(control.velocities.iter().map(Expr::to_string));
            let read = if steering.on_edge.price { format!("{velocity}, {u}") } else { u.clone() };
            let read = referring(read, control.price, &self.model.reference.1);
            let prices: Vec<_> = control.bounds.iter().filter_map(Bound::price).into_list();
            let kinks = if prices.is_empty() { "" } else { " − Σ w max(a, 0)" };
            let symbol = compared(control);
            let price = Formula::new(Id::Price, format!("ℓ(h, {read}){kinks}"), [control.price]);
            let bounds: Vec<_> = control.bounds.each(|bound| bound.value);
            let bounds = Formula::new(Id::Bounds, symbol, bounds);
            let values: Vec<_> = steering.bounds.each(|bound| bound.value);
            rows.push(match steering.on_edge.price {
                true => price.computed_as(self.at_increments(&[steering.price.value])),
                false => price,
            });
            rows.push(match steering.on_edge.bounds {
                true => bounds.computed_as(self.at_increments(&values)),
                false => bounds,
            });
            if !prices.is_empty() {
                rows.push(Formula::new(Id::BoundPrices, "w", prices));
            }
        }
        if let (Some(price), Some(endpoint)) = (&self.model.endpoint, &self.endpoint) {
            let read = match price.velocities.as_slice() {
                [] => q.clone(),
                velocities => format!("{q}, {}", tuple(velocities.iter().map(Expr::to_string))),
            };
            let read = referring(read, price.value, &self.model.end_reference.1);
            let row = Formula::new(Id::PriceOfEnd, format!("φ({read})"), [price.value]);
            rows.push(row.computed_as(vec![endpoint.price.value]));
        }
        if let (Some(declared), Some(target)) = (&self.model.target, &self.target) {
            let values: Vec<_> = declared.conditions.each(|condition| condition.left - condition.right);
            let computed: Vec<_> = target.differences.each(|jet| jet.value);
            let ids = [(Id::TargetEquations, "0 = g"), (Id::TargetInequalities, "0 ≥ g")];
            let (split, count) = (declared.equations, values.len());
            for ((id, symbol), range) in ids.into_iter().zip([0..split, split..count]) {
                if !range.is_empty() {
                    let row = Formula::new(id, symbol, values[range.clone()].to_vec());
                    rows.push(row.computed_as(computed[range].to_vec()));
                }
            }
        }
        rows
    }
}

/// The arguments of a price, with the references that it reads.
fn referring<'g>(read: String, price: Expr<'g>, references: &[Configuration<'g>]) -> String {
    let references = references.iter().filter(|leaf| price.depends_on(leaf.symbol));
    references.fold(read, |read, leaf| format!("{read}, {}", leaf.name))
}

impl<'g> SteeredFormulas<'g> {
    /// All formulas.
    pub fn table(&self) -> &FormulaTable<'g> {
        self.table.get_or_init(|| FormulaTable::new(self.rows()))
    }

    /// The increments, the prices and the bounds of inputs.
    fn rows(&self) -> Vec<Formula<'g>> {
        let names = self.names();
        let Names { q, u, xi, d, .. } = &names;
        let mut rows = Vec::from(self.rows_of_action(&names));
        rows.push(self.row_of_membership());
        rows.push(self.row_of_orbit_metric(&names));
        rows.push(self.row_of_retraction(&names));
        rows.push(Formula::new(Id::Increment, d, self.step.increment.clone()));
        rows.push(Formula::new(Id::Advance, format!("{q}⁺"), self.at_increments(&self.model.action)));
        rows.push(match &self.model.motion {
            Motion::Controls { velocity, .. } => Formula::new(Id::Controls, format!("{xi}({u})"), velocity.clone()),
            Motion::Dynamics { from: Some((rate, _)), .. } => Formula::new(Id::Controls, format!("{q}′"), [*rate]),
            Motion::Dynamics { next, .. } => Formula::new(Id::Controls, format!("{q}⁺"), next.clone()),
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

    /// Whether it is a field without a cost.
    pub(super) fn rests(&self) -> bool {
        self.field.as_ref().is_some_and(|field| field.is_static)
    }

    fn rows(&self) -> Vec<Formula<'g>> {
        let names = self.names();
        let mut rows = Vec::from(self.rows_of_action(&names));
        rows.extend(self.rows_of_momenta(&names));
        rows.extend(self.rows_of_energy(&names));
        rows.extend(self.rows_of_constraint(&names));
        rows.extend(self.rows_of_lagrangian(&names));
        rows.extend(self.rows_of_terms(&names));
        rows.extend(self.rows_of_joints(&names));
        rows.extend(self.rows_of_field(&names));
        rows.extend(self.rows_of_choice(&names));
        rows.extend(self.rows_of_conserved());
        for index in 0..self.substeps.len() {
            for mut row in self.rows_of_substep(&names, index) {
                // formulas for the inverse Legendre transform alone are not listed
                row.is_listed &= index < self.stepped;
                rows.push(row);
            }
        }
        rows.extend(self.rows_of_move(&names));
        rows.extend(self.rows_of_scheme(&names));
        rows.extend(self.rows_of_motions(&names));
        // a field at rest has no momenta, and makes no steps
        let is_of_rest = |row: &Formula<'g>| {
            use Id::{Action, EdgeElement, EdgeEnergy, EdgeForces, Generator, MomentumMap, PotentialEnergy, SiteForce};
            matches!(
                row.id,
                Action
                    | Generator
                    | MomentumMap
                    | PotentialEnergy
                    | EdgeEnergy(_)
                    | EdgeForces(_)
                    | EdgeElement
                    | SiteForce
            )
        };
        if self.rests() {
            rows.iter_mut().for_each(|row| row.is_listed &= is_of_rest(row));
        }
        rows
    }

    /// The formulas of momenta: how they are computed from covectors, how both are carried along, and momenta as
    /// matrices. Also the membership of groups.
    fn rows_of_momenta(&self, Names { q, f, mu, p, .. }: &Names) -> [Formula<'g>; 6] {
        let (factors, symbols) = (&self.model.factors, &self.symbols);
        let coadjoint = Formula::new(Id::Coadjoint, format!("Ad*_{f} {mu}"), self.coadjoint.clone());
        let coadjoint = coadjoint.computed_as(self.with_inverses(&self.coadjoint));
        let membership = self.row_of_membership();
        let matrices = factors.iter().zip(&symbols.momenta).map(|(factor, mu)| factor.group.momentum_matrix(*mu));
        let matrices: Vec<_> = matrices.into_list();
        let components = factors.iter().zip(&symbols.momentum_matrices).map(|(factor, m)| factor.group.components(*m));
        [
            Formula::new(Id::MomentumMap, format!("J({q}, {p})"), self.momentum_map.clone()),
            coadjoint,
            Formula::new(Id::CotangentLift, format!("(TΦ_{f})^-* {p} at {q}⁺"), self.cotangent_lift.clone()),
            membership,
            Formula::new(Id::MomentumMatrix, "M", matrices),
            Formula::new(Id::MomentumComponents, mu, components.into_list()),
        ]
    }

    /// The terms of the potential of a power, and their gradients.
    fn rows_of_terms(&self, Names { q, .. }: &Names) -> Vec<Formula<'g>> {
        let Some(power) = &self.model.power else { return Vec::new() };
        let (mut terms, mut gradients) = (Vec::new(), Vec::new());
        for (number, link) in self.links.iter().enumerate() {
            let symbol = format!("V_{}, for each {}", number + 1, link.term.indices());
            terms.push(Formula::shorter(Id::Term(number), symbol.trim_end_matches(", for each "), [link.term.value]));
            for (place, slopes) in &link.gradient {
                let symbol = format!("∂V_{}/∂{q}[{}]", number + 1, power.places[*place].text(&power.length));
                gradients.push(Formula::shorter(Id::TermGradient(number, *place), symbol, slopes.clone()));
            }
        }
        terms.extend(gradients);
        terms
    }

    /// The joints of a power with their rows, and the velocity of a site.
    fn rows_of_joints(&self, Names { q, xi, mu, .. }: &Names) -> Vec<Formula<'g>> {
        let Some(joints) = &self.joints else { return Vec::new() };
        let (mut equations, mut rows, mut bends) = (Vec::new(), Vec::new(), Vec::new());
        let declared = self.model.power.iter().flat_map(|power| &power.joints).flat_map(|joints| &joints.all);
        for (number, (joint, declared)) in joints.all.iter().zip(declared).enumerate() {
            let JointRows { places, own, before, velocity, bend, .. } = *joint;
            let symbol = format!("0 = φ_{}({q}), for each {}", number + 1, declared.term.indices());
            let symbol = symbol.trim_end_matches(", for each ");
            equations.push(Formula::new(Id::JointPlaces(number), symbol, [places]));
            let row = Formula::shorter(Id::Joint(number), format!("(A, B)_{}", number + 1), [own, before]);
            rows.push(row.computed_as(vec![own, before, velocity]));
            bends.push(Formula::new(Id::JointBend(number), format!("φ_{}″", number + 1), [bend]));
        }
        let mut rows: Vec<_> = equations.into_iter().chain(rows).chain(bends).into_list();
        let shape = joints.mobility.shape();
        let inertia = self.model.graph.symbol("Σ", self.inertia.shape(), Role::Letter, Property::Symmetric);
        let momentum = self.model.graph.symbol(mu, shape, Role::Letter, Property::General);
        let velocity = Formula::new(Id::Mobility, xi.clone(), [inertia.inverse() * momentum]);
        rows.push(velocity.computed_as(vec![joints.mobility]));
        rows.push(Formula::new(Id::Acceleration, format!("{xi}′"), [joints.acceleration]));
        rows.push(Formula::new(Id::SmallMotion, "x", [self.small_motion()]));
        rows.push(Formula::new(Id::MomentumOfVelocity, format!("Σ{xi} + A"), [joints.momentum]));
        rows
    }

    /// Chart coordinates of a small motion ξ of a site, in the charts of its steps.
    fn small_motion(&self) -> Expr<'g> {
        coordinates_of_motion(&self.system, self.model.graph.below(&self.symbols.algebra))
    }

    /// The energies and the forces of a field.
    fn rows_of_field(&self, names: &Names) -> Vec<Formula<'g>> {
        let Names { q, f, xi, .. } = names;
        let Some((field, declared)) = self.field.as_ref().zip(self.model.field.as_ref()) else { return Vec::new() };
        let (mut energies, mut forces, mut changes) = (Vec::new(), Vec::new(), Vec::new());
        for (number, (edge, EdgeEnergy { names: [own, next], .. })) in
            field.edges.iter().zip(&declared.edges).enumerate()
        {
            let [own, next] = [own, next].map(|names| tuple(names.iter().cloned()));
            let index = if field.edges.len() > 1 { format!("_{}", number + 1) } else { String::new() };
            let read = if edge.element.is_empty() { format!("{own}, {next}") } else { f.clone() };
            energies.push(Formula::shorter(Id::EdgeEnergy(number), format!("U{index}({read})"), [edge.energy]));
            let both = [edge.on_site.as_slice(), &edge.on_neighbour].concat();
            forces.push(Formula::shorter(Id::EdgeForces(number), format!("f{index}, f{index}⁺"), both));
            let along = edge.along.concat();
            changes.push(Formula::new(Id::EdgeForcesAlong(number), format!("δf{index}, δf{index}⁺"), along));
        }
        energies.extend(forces.into_iter().chain(changes));
        if let Some(edge) = field.edges.iter().find(|edge| !edge.element.is_empty()) {
            energies.push(Formula::new(Id::EdgeElement, f, edge.element.clone()));
            energies.push(Formula::new(Id::EdgeCoordinates, "z", edge.coordinates.clone()));
        }
        if let Some(edge) = field.edges.iter().find(|edge| !edge.logarithm.is_empty()) {
            energies.push(Formula::new(Id::EdgeLogarithm, "y", edge.logarithm.clone()));
        }
        energies.extend(field.midpoint.iter().flat_map(|midpoint| rows_of_midpoint(midpoint, names)));
        energies.push(Formula::shorter(Id::SiteForce, format!("f({q})"), field.force_of_site.clone()));
        energies.push(Formula::new(Id::SiteForceAlong, "δf", field.force_of_site_along.clone()));
        let momentum = self.symbols.slope(self.energy.general.unwrap_or(self.energy.kinetic + self.energy.gyroscopic));
        energies.push(Formula::new(Id::MomentumOfVelocity, format!("Σ{xi} + A"), [momentum]));
        energies.push(Formula::new(Id::SmallMotion, "x", [self.small_motion()]));
        energies.extend(field.force_inside.clone().map(|force| Formula::new(Id::ForceInside, "f", force)));
        energies
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
            count => indexed(count, |number| row(number, "")),
        };
        let mut inverses = Vec::new();
        for leaf in &self.model.configurations {
            if let LeafSpace::Group(group) = leaf.space {
                inverses.extend(inverse_by(group, leaf.symbol, leaf.symbol));
            }
        }
        let values: Vec<_> = conserved.each(|momentum| momentum.value.substitute(&inverses));
        rows.push(Formula::new(Id::ConservedMomenta, "conserved", values));
        rows
    }
}

/// The equation of an implicit step, and the momentum after it.
fn rows_of_midpoint<'g>(midpoint: &MidpointFormulas<'g>, Names { q, mu, .. }: &Names) -> Vec<Formula<'g>> {
    let half = Formula::new(Id::HalfStep, "G(z)", midpoint.element.clone())
        .in_words("(I − z^)⁻¹(I + z^)".into(), r"(I - \hat z)^{-1}(I + \hat z)".into());
    let equation = Formula::new(Id::MidpointEquation, format!("h f(Φ_G({q}))"), midpoint.residual.clone()).in_words(
        format!("s + C·s with s = T*∂K(G²) − {mu}, C = Ad* along G, {mu}⁺ = C·(C·{mu} + h f)"),
        format!(
            r"s + C\,s \text{{ with }} s = T^*\partial K(G^2) - {mu},\quad C = \mathrm{{Ad}}^* \text{{ along }} G,\quad {mu}^+ = C\,(C\,{mu} + h f)"
        ),
    );
    let motion = Formula::new(Id::HalfStepMotion, "δz^", midpoint.motion.clone())
        .in_words("½ (I ± z^)·η^·(I ∓ z^)".into(), r"\tfrac12 (I \pm \hat z)\,\hat\eta\,(I \mp \hat z)".into());
    let carried = Formula::new(Id::HalfCarried, format!("C {mu}"), midpoint.carried.clone());
    let force = midpoint.force.as_ref();
    let force = force.map(|(force, _)| Formula::new(Id::MidpointForce, format!("f({q}, 4z/h)"), force.clone()));
    [half, equation, motion, carried].into_iter().chain(force).into_list()
}

fn tuple(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.into_list();
    if names.len() == 1 { names.concat() } else { format!("({})", names.join(", ")) }
}

/// The left side of a: `0 ≥ a`, with the numbers of equations and of soft bounds.
fn compared(control: &InputChoice<'_>) -> String {
    let (soft, equations) = (control.soft_bounds(), control.equations());
    if equations == control.bounds.len() && equations > 0 {
        return "0 = a".into();
    }
    let mut text = "0 ≥ a".to_string();
    match equations {
        0 => {}
        1 => text += ", the first equal",
        count => text += &format!(", the first {count} equal"),
    }
    if soft > 0 {
        text += &format!(", the last {soft} soft");
    }
    text
}
