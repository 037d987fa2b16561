//! Powers: a group Gᴺ that acts site by site on Qᴺ, with a const generic N.
//!
//! The site is a system of its own, which the other stages derive as they derive any other. What ties sites to each other is the potential: a sum of
//! terms, each the same formula at every index that its sums run through. A formula names the sites that it reads by *places*, `q[i]`,
//! `q[(i + 1) % N]`, and is differentiated once.

mod bounds;

use clebsch_symbolic::{Expr, Graph, Property, Role, Shape};
use proc_macro2::Ident;
use syn::{Generics, Type};

use super::features::{self, Feature, Found};
use super::sizes::const_generic;
use super::value::Value;
use super::{Configuration, Item, Kinetic, Leaf, Model, Order, Parameter, ScalarType, Structure};
use crate::diagnostic::{Diagnostic, Diagnostics, Place as Where};
use crate::parse::{Closure, Declaration, Potential};
pub use bounds::Linear;

/// What makes a power of the model of a site.
#[derive(Clone)]
pub struct Power<'g> {
    /// The user's struct; that of the model is the site.
    pub item: Item,
    /// The const generic N.
    pub length: Ident,
    /// The symbol N.
    pub sites: Expr<'g>,
    /// The sites that terms read.
    pub places: Vec<Place<'g>>,
    /// The potential, a sum of terms.
    pub terms: Vec<Term<'g>>,
    /// The fields that terms read; those of the model are what the site reads.
    pub parameters: Vec<Parameter<'g>>,
    /// The user's fields that the site has copies of, in the order of the model's parameters.
    pub copied: Vec<syn::Member>,
    /// Whether all sites have the same kinetic energy.
    pub is_uniform: bool,
}

/// One site that terms read.
#[derive(Clone, PartialEq, Eq)]
pub struct Place<'g> {
    /// Its index, a linear expression in the indices of sums and in N.
    pub index: Expr<'g>,
    /// Whether the index is taken modulo N.
    pub wraps: bool,
}

/// A term of a sum over sites, and the sums around it.
#[derive(Clone, Debug)]
pub struct Term<'g> {
    /// What the index of each sum runs through, the outermost first: from the first expression up to and without the second.
    pub ranges: Vec<(Expr<'g>, Expr<'g>)>,
    /// The formula.
    pub value: Expr<'g>,
}

impl Term<'_> {
    /// What its indices run through, `i in 0..N, j in i + 1..N`; nothing where there is no sum.
    pub fn indices(&self) -> String {
        let of_depth =
            |(depth, (from, to)): (usize, &(Expr<'_>, Expr<'_>))| format!("{} in {from}..{to}", index_name(depth));
        self.ranges.iter().enumerate().map(of_depth).collect::<Vec<_>>().join(", ")
    }
}

/// What the index of a sum inside `depth` others is called.
fn index_name(depth: usize) -> String {
    match depth {
        0..=3 => ["i", "j", "k", "l"][depth].to_string(),
        _ => format!("i{depth}"),
    }
}

impl<'g> Place<'g> {
    /// As a closure writes it, `(i + 1) % N`.
    pub fn text(&self) -> String {
        if !self.wraps {
            return self.index.to_string();
        }
        match self.index.as_symbol() {
            Some(_) => format!("{} % N", self.index),
            None => format!("({}) % N", self.index),
        }
    }
}

/// The types of a site: what stands inside `[…; N]` of both arguments of the action.
pub(super) struct SiteTypes<'d> {
    pub length: &'d Ident,
    pub group: &'d Type,
    pub space: &'d Type,
}

/// The types of a site, where the action is one of a power; `None` where neither type has a const generic for its length.
///
/// # Errors
/// Where only one of them has, or another one.
pub(super) fn site_types<'d>(
    (group, space): (&'d Type, &'d Type),
    generics: &'d Generics,
) -> Result<Option<SiteTypes<'d>>, Diagnostic> {
    let (of_group, of_space) = (array(group, generics), array(space, generics));
    match (of_group, of_space) {
        (None, None) => Ok(None),
        (Some((length, group)), Some((other, space))) if length == other => {
            Ok(Some(SiteTypes { length, group, space }))
        }
        (Some((length, inner)), _) => Err(unequal(space, inner, length)),
        (None, Some((length, inner))) => Err(unequal(group, inner, length)),
    }
}

fn unequal(ty: &Type, inner: &Type, length: &Ident) -> Diagnostic {
    let (text, inner) = (crate::parse::spell_type(ty), crate::parse::spell_type(inner));
    Diagnostic::new(Where::of(ty), format!("`{text}` is no power with {length} sites"))
        .help(format!("write `[…; {length}]` for both, the group and the space that it moves"))
        .note(format!("the other argument has {length} times `{inner}`, and each site is moved by its own element"))
}

/// N and `T` of `[T; N]` with a const generic N.
pub(super) fn array<'t, 'd>(ty: &'t Type, generics: &'d Generics) -> Option<(&'d Ident, &'t Type)> {
    match ty {
        Type::Group(group) => array(&group.elem, generics),
        Type::Paren(paren) => array(&paren.elem, generics),
        Type::Array(array) => Some((const_generic(&crate::parse::spell(&array.len), generics)?, &*array.elem)),
        _ => None,
    }
}

/// What closures need to know of a power, and what they find.
pub(super) struct Sites<'g> {
    /// The name of N.
    pub name: String,
    /// The symbol N.
    pub count: Expr<'g>,
    /// How the configuration of a site nests, and its leaves.
    configuration: (Structure, Vec<Configuration<'g>>),
    /// The configuration's name.
    pattern: String,
    /// What the sums around the expression that is read run through, the outermost first.
    pub ranges: Vec<(Expr<'g>, Expr<'g>)>,
    /// The places that have been met.
    pub places: Vec<Place<'g>>,
    /// The fields with one entry for each site that terms have read: the field, the place, and its leaves.
    pub entries: Vec<Entry<'g>>,
    /// The number of the next leaf of a field.
    pub next_leaf: usize,
}

/// What a field has for the site at a place.
pub(super) struct Entry<'g> {
    pub field: usize,
    pub place: usize,
    pub leaves: Vec<Expr<'g>>,
}

/// A value of which there is one for each site.
#[derive(Clone, Debug)]
pub(super) struct PerSite<'g> {
    /// What it is.
    pub of: Kind,
    /// That of the site itself.
    pub own: Box<Value<'g>>,
}

/// What there is one of for each site.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// The group element or the velocity.
    Motion,
    /// The configuration.
    Configuration,
    /// A field, by its number among those that are read.
    Field(usize),
}

impl<'g> Sites<'g> {
    /// Nothing met so far.
    pub fn new(
        graph: &'g Graph,
        length: &Ident,
        configuration: (Structure, Vec<Configuration<'g>>),
        pattern: String,
        next_leaf: usize,
    ) -> Sites<'g> {
        let name = length.to_string();
        let count = graph.symbol(&name, Shape::scalar(), Role::Sites, Property::General);
        let (ranges, places, entries) = (Vec::new(), Vec::new(), Vec::new());
        Sites { name, count, configuration, pattern, ranges, places, entries, next_leaf }
    }

    /// The symbol of the index of the sum inside those around.
    pub fn index(&self, graph: &'g Graph) -> Expr<'g> {
        let depth = self.ranges.len();
        graph.symbol(&index_name(depth), Shape::scalar(), Role::Site(depth), Property::General)
    }

    /// The number of a place.
    pub fn place(&mut self, place: Place<'g>) -> usize {
        self.places.iter().position(|known| *known == place).unwrap_or_else(|| {
            self.places.push(place);
            self.places.len() - 1
        })
    }

    /// The configuration at a place.
    pub fn configuration_at(&self, graph: &'g Graph, place: usize) -> Value<'g> {
        let (structure, leaves) = &self.configuration;
        let text = self.places[place].text();
        let leaf = |(number, leaf): (usize, &Configuration<'g>)| {
            let name = format!("{}[{text}]{}", self.pattern, leaf.accessor);
            let property = leaf.symbol.as_symbol().map_or(Property::General, |data| data.property);
            let symbol = graph.symbol(&name, leaf.shape, Role::At(place, number), property);
            Value::leaf(symbol, leaf.is_quaternion)
        };
        let leaves: Vec<Value<'g>> = leaves.iter().enumerate().map(leaf).collect();
        Value::nested(structure, &leaves)
    }

    /// What a field has at a place, with new symbols like those of the site itself where it is met first.
    pub fn entry(&mut self, graph: &'g Graph, field: usize, place: usize, parameter: &Parameter<'g>) -> Vec<Expr<'g>> {
        if let Some(known) = self.entries.iter().find(|entry| (entry.field, entry.place) == (field, place)) {
            return known.leaves.clone();
        }
        let text = self.places[place].text();
        let first = self.next_leaf;
        self.next_leaf += parameter.leaves.len();
        let leaf = |(number, leaf): (usize, &super::Leaf<'g>)| {
            let property = leaf.symbol.as_symbol().map_or(Property::General, |data| data.property);
            let name = format!("{}[{text}]{}", parameter.name, leaf.accessor);
            graph.symbol(&name, leaf.shape, Role::Parameter(first + number), property)
        };
        let leaves: Vec<Expr<'g>> = parameter.leaves.iter().enumerate().map(leaf).collect();
        self.entries.push(Entry { field, place, leaves: leaves.clone() });
        leaves
    }

    /// Whether a place is one of the sites 0..N for every N ≥ 1, wherever the sums around it are.
    pub fn is_inside(&self, place: &Place<'g>) -> bool {
        place.wraps || bounds::is_inside(place.index, self.count, &self.ranges)
    }
}

/// The terms of a kinetic energy, which may be of one site each alone.
///
/// # Errors
/// A term that is not, by why.
pub(super) fn of_one_site<'g>(terms: &[Term<'g>], sites: Expr<'g>, graph: &'g Graph) -> Result<Expr<'g>, String> {
    let mut sum = graph.integer(0);
    for term in terms {
        let whole = (graph.integer(0), sites);
        match term.ranges.as_slice() {
            [range] if *range == whole => {}
            [] => return Err(format!("`{}` is no sum over all sites", term.value)),
            [(from, to)] => return Err(format!("its sum runs over {from}..{to}")),
            _ => return Err("it has sums inside each other".to_string()),
        }
        let of_sites = |role: Role| matches!(role, Role::Site(_) | Role::Sites | Role::At(..));
        let symbols = term.value.symbols();
        if let Some(symbol) = symbols.iter().find(|symbol| symbol.as_symbol().is_some_and(|data| of_sites(data.role))) {
            return Err(format!("it depends on `{symbol}`"));
        }
        sum = sum + term.value;
    }
    Ok(sum)
}

/// Reports what a power cannot have yet.
pub(super) fn check(declaration: &Declaration, diagnostics: &mut Diagnostics) {
    let dials = &declaration.dials;
    let key = |closure: &Option<Closure>| closure.as_ref().map(|closure| Found::at(closure.key.span()));
    let emitted = |asked: bool| asked.then(|| Found::at(declaration.ident.span()));
    let order = |fits: fn(Order) -> bool| {
        let order = dials.order.as_ref().filter(|order| fits(order.value))?;
        Some(Found::at(order.span).named(order.value.number()))
    };
    let found = |feature| match feature {
        Feature::OpaquePotential => {
            declaration.potential.as_ref().and_then(Potential::opaque).map(|opaque| Found::at(opaque.place))
        }
        Feature::Force => key(&declaration.force),
        Feature::ForceOn => key(&declaration.force_on),
        Feature::Endpoint => key(&declaration.endpoint),
        Feature::Symmetry => declaration.symmetries.first().map(|closure| Found::at(closure.key.span())),
        Feature::Controls | Feature::Dynamics => {
            let motion = declaration.kinetic.closure();
            (format!("`{}`", motion.key) == feature.words()).then(|| Found::at(motion.key.span()))
        }
        Feature::Effort if !declaration.kinetic.is_steered() => {
            declaration.control.as_ref().map(|control| Found::at(control.price.key.span()))
        }
        Feature::Composition => order(|order| order.stages().is_some()),
        Feature::Sixteenth => order(|order| order == Order::Sixteenth),
        Feature::Summation => dials.summation.as_ref().map(|summation| Found::at(summation.span)),
        Feature::Tangent => emitted(dials.emit.tangent),
        Feature::Boundary => emitted(dials.emit.boundary),
        Feature::Momentum => emitted(dials.emit.momentum),
        _ => None,
    };
    let refused = features::refusals_of((Feature::Power, Found::somewhere()), found);
    refused.for_each(|error| diagnostics.push(error));
}

/// The model of a site with what ties it to others.
pub(super) fn power_of<'g>(mut model: Model<'g>, sites: Sites<'g>, terms: Vec<Term<'g>>, length: &Ident) -> Model<'g> {
    let kinetic = match &model.kinetic {
        Kinetic::Cost(cost) => *cost,
        Kinetic::Lagrangian { energy, .. } => *energy,
        // by construction: `check` has refused them
        Kinetic::Controls { .. } | Kinetic::Dynamics(_) => model.graph.integer(0),
    };
    let is_read = |leaf: &Leaf<'g>, expr: Expr<'g>| expr.depends_on(leaf.symbol);
    let by_site = |parameter: &&Parameter<'g>| {
        let of_site =
            |leaf: &Leaf<'g>| is_read(leaf, kinetic) || model.action.iter().any(|image| is_read(leaf, *image));
        parameter.leaves.iter().any(of_site)
    };
    let by_terms = |parameter: &&Parameter<'g>| {
        !parameter.per_site && parameter.leaves.iter().any(|leaf| terms.iter().any(|term| is_read(leaf, term.value)))
    };
    let mut parameters: Vec<Parameter<'g>> = model.parameters.iter().filter(by_terms).cloned().collect();
    for entry in &sites.entries {
        let field = &model.parameters[entry.field];
        let leaf = |(leaf, symbol): (&Leaf<'g>, &Expr<'g>)| Leaf {
            symbol: *symbol,
            accessor: leaf.accessor.at_site(entry.place),
            ..leaf.clone()
        };
        let leaves = field.leaves.iter().zip(&entry.leaves).map(leaf).collect();
        parameters.push(Parameter { leaves, ..field.clone() });
    }
    let mut of_site: Vec<Parameter<'g>> = model.parameters.iter().filter(by_site).cloned().collect();
    let copied = of_site.iter().map(|parameter| parameter.field.clone()).collect();
    for parameter in &mut of_site {
        if let syn::Member::Unnamed(index) = &parameter.field {
            parameter.field = syn::Member::Named(quote::format_ident!("field_{}", index.index));
        }
    }
    let is_uniform = of_site.iter().all(|parameter| !parameter.per_site);
    let site = Item {
        ident: quote::format_ident!("{}Site", model.item.ident),
        vis: syn::Visibility::Public(Default::default()),
        generics: generics_of_site(&model.item),
        scalar: model.item.scalar.clone(),
        krate: model.item.krate.clone(),
    };
    let item = std::mem::replace(&mut model.item, site);
    let Sites { count, places, .. } = sites;
    model.parameters = of_site;
    model.power =
        Some(Power { item, length: length.clone(), sites: count, places, terms, parameters, copied, is_uniform });
    model
}

/// The scalar alone.
fn generics_of_site(item: &Item) -> Generics {
    match &item.scalar {
        ScalarType::Parameter(ident) => syn::parse_quote!(<#ident>),
        _ => Generics::default(),
    }
}
