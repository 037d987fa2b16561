//! The sites of a power while closures are read: the places and fields that closures meet. At the end the model becomes
//! that of one site.

use clebsch_symbolic::{Elements, Expr, Graph, Group, IntoList, Role};
use syn::Expr as Syntax;

use super::features::{self, Feature, Found};
use super::power::{Joints, Length, Range, SiteIndex, Term};
use super::space::Space;
use super::spaces::Product;
use super::value::Value;
use super::{Configuration, Item, Leaf, Order, Parameter, Part, Power, ScalarType, System};
use crate::diagnostic::{Diagnostic, Diagnostics, error};
use crate::parse::{Declaration, tail};

/// The data of a power that closures need, and the data that they find.
pub(super) struct Sites<'g> {
    /// N
    pub length: Length,
    pub count: Expr<'g>,
    /// The configuration of a site.
    space: Space<'g>,
    pub pattern: String,
    /// The ranges of the sums around the expression that is read, the outermost first.
    pub ranges: Vec<Range<'g>>,
    /// The places that have been met.
    pub places: Vec<SiteIndex<'g>>,
    /// The fields with one entry for each site that terms have read: the field, the place, and its leaves.
    pub entries: Vec<(usize, usize, Vec<Expr<'g>>)>,
    /// The number of the next leaf of a field.
    pub next_leaf: usize,
    /// Whether each site has an input of its own.
    pub has_own_inputs: bool,
    /// The least N that has all sites that closures name.
    pub least: i64,
    /// The site whose entry of an array is read, `[q[0] * F[0], …]`, and whether the entry has read it.
    pub entry_of: Option<(usize, bool)>,
}

impl<'g> Sites<'g> {
    pub fn new(graph: &'g Graph, length: Length, space: Space<'g>, pattern: String, next_leaf: usize) -> Sites<'g> {
        let count = length.count(graph);
        let (ranges, places, entries) = (Vec::new(), Vec::new(), Vec::new());
        Sites {
            length,
            count,
            space,
            pattern,
            ranges,
            places,
            entries,
            next_leaf,
            has_own_inputs: false,
            least: 1,
            entry_of: None,
        }
    }

    /// How many places, entries and leaves there are, and the ranges around.
    pub fn known(&self) -> [usize; 4] {
        [self.places.len(), self.entries.len(), self.next_leaf, self.ranges.len()]
    }

    /// Forgets all that were met since.
    pub fn forget(&mut self, [places, entries, next_leaf, ranges]: [usize; 4]) {
        self.places.truncate(places);
        self.entries.truncate(entries);
        self.next_leaf = next_leaf;
        self.ranges.truncate(ranges);
    }

    pub fn place(&mut self, place: SiteIndex<'g>) -> usize {
        self.places.iter().position(|known| *known == place).unwrap_or_else(|| {
            self.places.push(place);
            self.places.len() - 1
        })
    }

    /// The configuration of the site at a place.
    pub fn configuration_at(&self, place: usize) -> Space<'g> {
        let text = self.places[place].text(&self.length);
        let leaf = |(number, leaf): (usize, &Configuration<'g>)| {
            let name = format!("{}[{text}]{}", self.pattern, leaf.accessor);
            Configuration { symbol: like(leaf.symbol, &name, Role::At(place, number)), name, ..leaf.clone() }
        };
        let leaves = self.space.leaves.iter().enumerate().map(leaf).into_list();
        Space { layout: self.space.layout.clone(), leaves }
    }

    /// The value of a field at a place. When it is first met it gets new symbols, like those of the site itself.
    pub fn entry(&mut self, field: usize, place: usize, parameter: &Parameter<'g>) -> Vec<Expr<'g>> {
        if let Some((.., leaves)) = self.entries.iter().find(|(of, at, _)| (*of, *at) == (field, place)) {
            return leaves.clone();
        }
        let text = self.places[place].text(&self.length);
        let first = self.next_leaf;
        self.next_leaf += parameter.leaves.len();
        let leaf = |(number, leaf): (usize, &super::Leaf<'g>)| {
            let name = format!("{}[{text}]{}", parameter.name, leaf.accessor);
            like(leaf.symbol, &name, Role::Parameter(first + number))
        };
        let leaves: Vec<Expr<'g>> = parameter.leaves.iter().enumerate().map(leaf).into_list();
        self.entries.push((field, place, leaves.clone()));
        leaves
    }
}

/// A symbol of the shape and the property of another one.
fn like<'g>(symbol: Expr<'g>, name: &str, role: Role) -> Expr<'g> {
    let property = symbol.property();
    symbol.graph().symbol(name, symbol.shape(), role, property)
}

/// Whether a product by a number is a power, if its closures are formulas of one site.
///
/// Measured: from four sites on a step of a power takes 0.2 to 0.9 of the time of unrolled code. For three bodies on `SE<3>`
/// it takes half of it, and for two or three others 0.6 to 2 of it.
pub(super) fn are_many(count: usize, site: &Product<Group>) -> bool {
    const SITES: usize = 4;
    const UNKNOWNS: usize = 18;
    let dimension: usize = site.leaves.iter().map(|(group, _)| group.dimension()).sum();
    count >= SITES || count * dimension >= UNKNOWNS
}

/// The value of a closure at each site, as that of one site; any other value as it is, where there are no sites.
///
/// # Errors
/// A value that is not one for each site.
pub(super) fn at_each<'g>(
    sites: Option<&Sites<'g>>,
    (value, body): (Value<'g>, &Syntax),
    gives: &str,
) -> Result<Value<'g>, Diagnostic> {
    let Some(Sites { length, count, .. }) = sites else { return Ok(value) };
    match value {
        Value::Sequence(range, each) if range == (count.graph().integer(0), *count) => Ok(*each),
        other => Err(error!(tail(body), "{gives} {}, but it has to give a value for each site", other.describe();
            help "write `(0..{length}).map(|i| …)`")),
    }
}

/// Whether a value of a site is the same formula at every site.
///
/// # Errors
/// The symbol of an index, of N, or of another site.
pub(super) fn of_every_site(value: Expr<'_>) -> Result<(), String> {
    let of_sites = |symbol: &Expr<'_>| matches!(symbol.role(), Some(Role::Site(_) | Role::Sites | Role::At(..)));
    value
        .symbols()
        .iter()
        .find(|symbol| of_sites(symbol))
        .map_or(Ok(()), |symbol| Err(format!("it depends on `{symbol}`")))
}

/// The cure of a formula that is not that of one site, with the word for its key.
pub(super) fn unrolled(key: &str, length: &Length) -> String {
    match length {
        Length::Generic(name) => format!(
            "write a number in place of `{name}`: then all sites are unrolled, and the {key} may be any formula of them"
        ),
        Length::Number(count) => {
            format!("write the {key} site by site: {count} sites are too many to unroll")
        }
    }
}

/// The cure of a formula that is another one at some sites, with the word for its key.
pub(super) fn of_all_sites(key: &str, length: &Length) -> String {
    match length {
        Length::Generic(_) => unrolled(key, length),
        Length::Number(count) => format!(
            "write the same {key} for all sites, `(0..{count}).map(|i| …)`, with a field `[…; {count}]` for the numbers that differ"
        ),
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
        of_every_site(term.value)?;
        sum = sum + term.value;
    }
    Ok(sum)
}

/// Reports features that a power cannot have yet.
pub(super) fn check(declaration: &Declaration, diagnostics: &Diagnostics) {
    let power = (Feature::Power, Found::somewhere());
    diagnostics.extend(features::refusals_of(power, |feature| features::declared(declaration, feature)));
}

/// The terms that tie sites to each other; the system becomes that of one site, whose kinetic energy and forces are `of_site`.
pub(super) fn power_of<'g>(
    system: &mut System<'g>,
    of_site: &[Expr<'g>],
    (sites, order): (Sites<'g>, Order),
    (terms, joints): (Vec<Term<'g>>, Option<Joints<'g>>),
) -> Power<'g> {
    let reads = |expr: Expr<'g>, field: &Parameter<'g>| field.leaves.iter().any(|leaf| expr.depends_on(leaf.symbol));
    let by_site = |field: &&Parameter<'g>| of_site.iter().chain(&system.action).any(|image| reads(*image, field));
    let of_joints = joints.iter().flat_map(|joints| joints.all.iter().map(|joint| joint.term.value));
    let tied: Vec<Expr<'g>> = terms.iter().map(|term| term.value).chain(of_joints).into_list();
    let by_terms = |field: &&Parameter<'g>| !field.per_site && tied.iter().any(|value| reads(*value, field));
    let mut parameters: Vec<Parameter<'g>> = system.parameters.iter().filter(by_terms).cloned().into_list();
    for (field, place, leaves) in &sites.entries {
        let field = &system.parameters[*field];
        let leaf = |(leaf, symbol): (&Leaf<'g>, &Expr<'g>)| Leaf {
            symbol: *symbol,
            accessor: leaf.accessor.within(Part::Site(*place)),
            ..leaf.clone()
        };
        let leaves = field.leaves.iter().zip(leaves).map(leaf).into_list();
        parameters.push(Parameter { leaves, ..field.clone() });
    }
    let mut copies: Vec<Parameter<'g>> = system.parameters.iter().filter(by_site).cloned().into_list();
    let copied = copies.each(|parameter| parameter.field.clone());
    for parameter in &mut copies {
        if let syn::Member::Unnamed(index) = &parameter.field {
            parameter.field = syn::Member::Named(quote::format_ident!("field_{}", index.index));
        }
    }
    let is_uniform = copies.iter().all(|parameter| !parameter.per_site);
    let site = Item {
        ident: quote::format_ident!("{}Site", system.item.ident),
        // the scalar alone
        generics: match &system.item.scalar {
            ScalarType::Parameter(ident) => syn::parse_quote!(<#ident>),
            _ => syn::Generics::default(),
        },
        scalar: system.item.scalar.clone(),
        krate: system.item.krate.clone(),
    };
    let item = std::mem::replace(&mut system.item, site);
    let Sites { length, count, places, has_own_inputs, least, .. } = sites;
    system.parameters = copies;
    Power {
        item,
        length,
        sites: count,
        places,
        terms,
        joints,
        parameters,
        copied,
        is_uniform,
        has_own_inputs,
        least,
        order,
    }
}
