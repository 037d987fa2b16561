//! The energies of a field: the closures `space`, each of an edge from a site to its neighbour in one direction.

use clebsch_symbolic::{Elements, Expr, Group, IntoList, Property, Role, Shape, indexed};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use super::closures::{scalar, written};
use super::features::{self, Feature, Found};
use super::scope::{Scope, check_reserved};
use super::space::{Space, leaf_names};
use super::typed::ActedSystem;
use super::value::Value;
use super::{Configuration, EdgeEnergy, Factor, LeafSpace, System};
use crate::diagnostic::{Diagnostics, refuse, report};
use crate::parse::{Argument, Closure, Declaration, Pattern, Potential, spell_type, tail};

/// The most directions of space.
const DIRECTIONS: usize = 3;

/// The places of an edge: the site itself, and its neighbour.
const ENDS: [usize; 2] = [0, 1];

impl<'g> ActedSystem<'_, '_, 'g> {
    /// The energies of the edges of all directions. `None` with an error, which was reported.
    pub fn edges(&mut self, declaration: &Declaration) -> Option<Vec<EdgeEnergy<'g>>> {
        let closures = &declaration.spaces;
        if let Some(closure) = closures.get(DIRECTIONS) {
            refuse!(self.context.diagnostics, closure.head, "a field has at most {DIRECTIONS} directions of space, and these are {}", closures.len();
                help "leave out the others")
        }
        let edges = closures.iter().enumerate().map(|(direction, closure)| self.edge(direction, closure)).into_list();
        edges.into_iter().collect()
    }

    fn edge(&mut self, direction: usize, closure: &Closure) -> Option<EdgeEnergy<'g>> {
        let diagnostics = self.context.diagnostics;
        let q = self.arguments.names.configuration;
        let example = format!("|dx, {}, next|", q.spell());
        for Argument { pattern, ty, .. } in &closure.arguments {
            if let Some(ty) = ty {
                refuse!(diagnostics, ty, "`{}` has a type again", pattern.spell();
                    help "write `{}` without `: {}`", pattern.spell(), spell_type(ty);
                    note "types stand in the action, which introduces the spaces")
            }
        }
        let spacing = closure.arguments.first().map(|argument| &argument.pattern);
        if let Some(Pattern::Tuple(_, place)) = spacing {
            refuse!(diagnostics, *place, "the spacing of a direction is one number"; help "write `{example}`")
        }
        match (spacing, &closure.arguments[..]) {
            (Some(Pattern::Name(spacing)), [_, Argument { pattern: element, .. }]) => {
                self.edge_of_element(closure, (direction, spacing), element)
            }
            (Some(Pattern::Name(spacing)), [_, site, next]) => {
                self.edge_of_ends(closure, (direction, spacing), [&site.pattern, &next.pattern])
            }
            (_, arguments) => {
                let count = arguments.len();
                let plural = if count == 1 { "" } else { "s" };
                refuse!(diagnostics, closure.head, "the energy of an edge has {count} argument{plural}, not three";
                    help "write `{example} …`";
                    note "they are the spacing of the direction, the configuration of a site, and that of its neighbour; or the spacing and the element that moves one to the other")
            }
        }
    }

    /// `|dx, q, next| …`
    fn edge_of_ends(
        &mut self,
        closure: &Closure,
        (direction, spacing): (usize, &Ident),
        [site, next]: [&Pattern; 2],
    ) -> Option<EdgeEnergy<'g>> {
        let (diagnostics, q) = (self.context.diagnostics, self.arguments.names.configuration);
        if !q.matches(site) {
            refuse!(diagnostics, site.place(), "cannot find `{}` in the {}", site.spell(), closure.key;
                help "the action calls the configuration `{}`: write `|dx, {0}, next|`", q.spell())
        }
        self.check_names(spacing, next)?;
        let own = self.end(ENDS[0], site)?;
        let neighbour = self.end(ENDS[1], next)?;
        let members: Vec<(Expr<'g>, Group)> = own.members().chain(neighbour.members()).into_list();
        let values = [(site, own.value()), (next, neighbour.value())];
        let (symbol, energy) = self.energy_of_edge(closure, (direction, spacing), &members, &values)?;
        for (end, pattern) in [(&own, site), (&neighbour, next)] {
            if !end.leaves.iter().any(|leaf| energy.depends_on(leaf.symbol)) {
                refuse!(diagnostics, tail(&closure.body), "the energy of an edge does not depend on `{}`", pattern.spell();
                    help "compare both ends, as in `({} - {}).norm_squared() / (2 * {spacing})`", next.spell(), q.spell();
                    note "an energy of one site belongs to the `potential`")
            }
        }
        let names = [own, neighbour].map(|end| end.leaves.each(|leaf| leaf.name.clone()));
        Some(EdgeEnergy { value: energy, spacing: symbol, names, element: Vec::new(), written: written(closure) })
    }

    /// `|dx, F| …`, with the element that moves a site to its neighbour.
    fn edge_of_element(
        &mut self,
        closure: &Closure,
        (direction, spacing): (usize, &Ident),
        pattern: &Pattern,
    ) -> Option<EdgeEnergy<'g>> {
        let diagnostics = self.context.diagnostics;
        if !self.arguments.names.element.matches(pattern) {
            self.check_names(spacing, pattern)?;
        }
        let names =
            [String::new(), "⁺".to_string()].map(|mark| self.space.leaves.each(|leaf| format!("{}{mark}", leaf.name)));
        let ends = [0, 1].map(|end| {
            indexed(self.space.leaves.len(), |number| {
                let own = self.space.leaves[number].symbol;
                self.context.graph.symbol(&names[end][number], own.shape(), Role::At(end, number), own.property())
            })
        });
        let between = |factor: (usize, &Factor<'g>)| self.element_between(factor, &ends);
        let element: Option<Vec<Expr<'g>>> = self.factors.iter().enumerate().map(between).collect();
        let Some(element) = element.filter(|element| element.len() == self.space.leaves.len()) else {
            let q = self.arguments.names.configuration.spell();
            refuse!(diagnostics, closure.head, "no element of the group is known that moves a site to its neighbour";
                help "write the energy of both ends, `|{spacing}, {q}, next| …`";
                note "it is q⁻¹·next where the configuration is an element of the group and the action is a product with it")
        };
        let value = self.arguments.element_value.clone()?;
        let (symbol, energy) =
            self.energy_of_edge(closure, (direction, spacing), &self.arguments.members, &[(pattern, value)])?;
        let symbols = energy.symbols();
        let reads = |k: usize| {
            symbols
                .iter()
                .any(|symbol| matches!(symbol.role(), Some(Role::Element(own) | Role::Cayley(own) | Role::Logarithm(own)) if own == k))
        };
        if !(0..self.factors.len()).any(reads) {
            refuse!(diagnostics, tail(&closure.body), "the energy of an edge does not depend on `{}`", pattern.spell();
                help "write an energy of it, as in `({} - I).norm_squared() / (2 * {spacing})`", pattern.spell();
                note "an energy of one site belongs to the `potential`")
        }
        Some(EdgeEnergy { value: energy, spacing: symbol, names, element, written: written(closure) })
    }

    /// The element that moves the configuration of a factor from one end to the other, where it is q⁻¹q⁺, q⁺q⁻¹ or q⁺ − q.
    fn element_between(&self, (k, factor): (usize, &Factor<'g>), ends: &[Vec<Expr<'g>>; 2]) -> Option<Expr<'g>> {
        let (leaf, image) = (self.space.leaves.get(k)?, *self.action.get(k)?);
        let (q, f, [own, next]) = (leaf.symbol, factor.symbol, [ends[0][k], ends[1][k]]);
        if leaf.space == LeafSpace::Group(factor.group) && factor.group != Group::UnitQuaternions {
            let from_left = image == f * q;
            return (from_left || image == q * f).then(|| factor.group.quotient(own, next, from_left));
        }
        (factor.group.is_translation() && image == q + f).then(|| next - own)
    }

    /// The symbol of the spacing, and the value of a closure with these arguments behind it.
    fn energy_of_edge(
        &mut self,
        closure: &Closure,
        (direction, spacing): (usize, &Ident),
        members: &[(Expr<'g>, Group)],
        values: &[(&Pattern, Value<'g>)],
    ) -> Option<(Expr<'g>, Expr<'g>)> {
        let (graph, diagnostics) = (self.context.graph, self.context.diagnostics);
        let symbol = graph.symbol(&spacing.to_string(), Shape::scalar(), Role::Spacing(direction), Property::General);
        let mut scope = Scope::new(members);
        scope.add_argument(&Pattern::Name(spacing.clone()), Some(Value::Matrix(symbol)), diagnostics);
        values.iter().for_each(|(pattern, value)| scope.add_argument(pattern, Some(value.clone()), diagnostics));
        let help = "an edge joins two sites at one time: leave it out".to_string();
        scope.missing = ["h", "t"].map(|name| (name.to_string(), help.clone())).into();
        Some((symbol, scalar(self.context, closure, scope, "an energy is a scalar")?))
    }

    /// The names that a closure of an edge introduces are new, and differ. `None` with an error, which was reported.
    fn check_names(&self, spacing: &Ident, last: &Pattern) -> Option<()> {
        let is_free = [spacing].into_iter().chain(last.names()).map(|name| self.is_free(name)).into_list();
        if is_free.contains(&false) {
            return None;
        }
        if let Some(twice) = last.names().into_iter().find(|name| name.unraw() == spacing.unraw()) {
            refuse!(self.context.diagnostics, twice, "`{twice}` is the name of two arguments"; help "choose another name for one of them")
        }
        Some(())
    }

    /// Whether a closure may introduce a name.
    fn is_free(&self, name: &Ident) -> bool {
        let diagnostics = self.context.diagnostics;
        let of_action = [self.arguments.names.element.names(), self.arguments.names.configuration.names()].concat();
        let is_free = check_reserved(name, "an argument", diagnostics);
        if is_free && of_action.iter().any(|known| known.unraw() == name.unraw()) {
            report!(diagnostics, name, "`{name}` is an argument of the action and cannot be the name of another one";
                help "choose another name");
            return false;
        }
        is_free
    }

    /// The configuration at an end of an edge, by the names of a pattern.
    fn end(&self, place: usize, pattern: &Pattern) -> Option<Space<'g>> {
        let names = leaf_names(pattern, &self.space.layout, self.context.diagnostics)?;
        let leaf = |((number, leaf), name): ((usize, &Configuration<'g>), String)| {
            let role = Role::At(place, number);
            let symbol = self.context.graph.symbol(&name, leaf.shape, role, leaf.symbol.property());
            Configuration { symbol, name, ..leaf.clone() }
        };
        let leaves = self.space.leaves.iter().enumerate().zip(names).map(leaf).into_list();
        Some(Space { layout: self.space.layout.clone(), leaves })
    }
}

/// Reports features that a field cannot have yet. Powers report that they are none.
pub(super) fn check(declaration: &Declaration, diagnostics: &Diagnostics) {
    let words = [(Feature::Connection, "connection"), (Feature::Midpoint, "midpoint")];
    let emitted = words.map(|(feature, word)| (feature, word, features::declared(declaration, feature)));
    let Some(closure) = declaration.spaces.first() else {
        for (feature, word, _) in emitted.iter().filter(|(.., found)| found.is_some()) {
            report!(diagnostics, declaration.ident.span(), "{} is for fields, and this is one system", feature.words();
                help "write `space = |dx, W| …` with the element W from a site to its neighbour, or leave out the word `{word}`");
        }
        return;
    };
    let field = (Feature::Field, Found::at(closure.key.span()));
    let resting = declaration.is_static.then_some((Feature::StaticField, field.1.clone()));
    let potential = declaration.potential.as_ref().and_then(Potential::closure).filter(|_| declaration.is_static);
    if let Some(closure) = potential
        && let [first, second, ..] = &closure.arguments[..]
    {
        report!(diagnostics, closure.head, "a field without a cost has no time, and `{}` reads it", first.pattern.spell();
            help "write `|{}| …`", second.pattern.spell();
            note "nothing moves it in time: `relax` finds where it rests");
    }
    let emitted = emitted.into_iter().filter_map(|(feature, _, found)| Some((feature, found?)));
    let of_ends = |closure: &&Closure| closure.arguments.len() > ENDS.len();
    let ends = declaration.spaces.iter().find(of_ends).map(|closure| Found::at(closure.head));
    let found = |feature| match feature {
        Feature::EndsOfEdges => ends.clone(),
        _ => features::declared(declaration, feature),
    };
    for feature in [field].into_iter().chain(resting).chain(emitted) {
        diagnostics.extend(features::refusals_of(feature, found));
    }
}

/// Whatever moves the elements of edges is known without configurations.
///
/// # Errors
/// A kinetic energy that depends on the configuration.
pub(super) fn check_connection(system: &System<'_>, energy: Expr<'_>) -> Result<(), Diagnostics> {
    let Some(leaf) = system.configurations.iter().find(|leaf| energy.depends_on(leaf.symbol)) else { return Ok(()) };
    let dependent = Found::at(system.spans.kinetic.place).named(&leaf.name);
    Err(features::refusal((Feature::DependsOnConfiguration, dependent), (Feature::Connection, Found::somewhere()))
        .into())
}
