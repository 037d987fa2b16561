//! The terms that tie the sites of a power to each other: the gradient of each term, differentiated once for all
//! indices.

use clebsch_symbolic::{Elements, Expr, IntoList, Role};

use crate::model::{Configuration, Linear, Mechanics, Power, SiteIndex, Term};

/// A term of the potential of a power with its gradient.
pub struct SiteTerm<'g> {
    /// The term.
    pub term: Term<'g>,
    /// ∂/∂q for each place that the term reads, by its number: one expression for each leaf of the configuration there.
    pub gradient: Vec<(usize, Vec<Expr<'g>>)>,
}

/// The index of the term whose place is a given site.
pub struct Home<'g> {
    /// The index of its sum, where it has one, with the symbol of that index standing for the site.
    pub index: Option<Expr<'g>>,
    /// Whether it is taken modulo N.
    pub wraps: bool,
    /// Whether there is such a term for every site.
    pub is_everywhere: bool,
}

impl<'g> SiteTerm<'g> {
    /// For each place of the gradient, the term that has a given site there. A sum over one index, or over none, has at
    /// most one. `None` where there are more.
    pub fn homes(&self, power: &Power<'g>) -> Option<Vec<Home<'g>>> {
        self.gradient.iter().map(|(place, _)| self.home(power, &power.places[*place])).collect()
    }

    fn home(&self, power: &Power<'g>, place: &SiteIndex<'g>) -> Option<Home<'g>> {
        home(&self.term, power, place)
    }
}

/// The term that has a given site at a place.
pub(super) fn home<'g>(term: &Term<'g>, power: &Power<'g>, place: &SiteIndex<'g>) -> Option<Home<'g>> {
    let SiteIndex { index, wraps } = *place;
    match (term.ranges.as_slice(), Linear::of(index)?.indices.as_slice()) {
        ([], _) => Some(Home { index: None, wraps, is_everywhere: false }),
        ([range], [1]) => {
            let site = index.symbols().into_iter().find(|symbol| symbol.role() == Some(Role::Site(0)))?;
            let own = (2 * site - index).expand();
            let whole = (site.graph().integer(0), power.sites);
            Some(Home { index: Some(own), wraps, is_everywhere: *range == whole && (wraps || own == site) })
        }
        _ => None,
    }
}

/// The gradient of one site, of all terms that read it.
pub struct Stencil<'g> {
    /// The sites that it reads, whose numbers go on from those of the power; the symbol of the index stands for the site.
    pub places: Vec<SiteIndex<'g>>,
    /// The part that every site has: one expression for each leaf of its configuration.
    pub gradient: Vec<Expr<'g>>,
    /// The parts that only some sites have, or that depend on the index of the term. Each is given by the number of the
    /// term, and that of the place in its gradient.
    pub others: Vec<(usize, usize)>,
}

/// The gradient of one site; `None` where terms cannot be told by the sites that they read, such as those of sums over pairs.
pub fn stencil<'g>(model: &Mechanics<'g>, links: &[SiteTerm<'g>]) -> Option<Stencil<'g>> {
    let power = model.power.as_ref()?;
    let zero = |leaf: &Configuration<'g>| model.graph.zero(leaf.shape);
    let gradient = model.configurations.each(zero);
    let mut stencil = Stencil { places: Vec::new(), gradient, others: Vec::new() };
    for (term, link) in links.iter().enumerate() {
        for (number, (home, (_, slopes))) in link.homes(power)?.iter().zip(&link.gradient).enumerate() {
            let symbols: Vec<Expr<'g>> = slopes.iter().flat_map(|slope| slope.symbols()).into_list();
            let moved =
                home.index.filter(|_| home.is_everywhere && !symbols.iter().any(|symbol| is_of_term(power, *symbol)));
            let Some(own) = moved else {
                stencil.others.push((term, number));
                continue;
            };
            let moved: Vec<(Expr<'g>, Expr<'g>)> = symbols
                .iter()
                .filter_map(|symbol| Some((*symbol, stencil.moved(model, *symbol, (own, home.wraps))?)))
                .into_list();
            for (sum, slope) in stencil.gradient.iter_mut().zip(slopes) {
                *sum = *sum + slope.substitute(&moved);
            }
        }
    }
    Some(stencil)
}

impl<'g> Stencil<'g> {
    /// The symbol of a configuration at a place of a term, as that of a site relative to the one whose gradient this is.
    fn moved(&mut self, model: &Mechanics<'g>, symbol: Expr<'g>, (own, wraps): (Expr<'g>, bool)) -> Option<Expr<'g>> {
        let (power, Some(Role::At(place, leaf))) = (model.power.as_ref()?, symbol.role()) else { return None };
        let there = &power.places[place];
        let site = own.symbols().into_iter().find(|symbol| symbol.role() == Some(Role::Site(0)))?;
        let index = there.index.substitute(&[(site, own)]).expand();
        let place = SiteIndex { index, wraps: (wraps || there.wraps) && index != site };
        let known = self.places.iter().position(|known| *known == place);
        let number = known.unwrap_or(self.places.len());
        let text = place.text(&power.length);
        if known.is_none() {
            self.places.push(place);
        }
        let name = format!("{}[{text}]", model.configurations[leaf].name);
        Some(model.graph.symbol(&name, symbol.shape(), Role::At(power.places.len() + number, leaf), symbol.property()))
    }
}

/// Whether a symbol is another one for each index of a term: the index itself, or the value of a field there.
fn is_of_term<'g>(power: &Power<'g>, symbol: Expr<'g>) -> bool {
    let mut entries =
        power.parameters.iter().filter(|parameter| parameter.per_site).flat_map(|parameter| &parameter.leaves);
    matches!(symbol.role(), Some(Role::Site(_))) || entries.any(|leaf| leaf.symbol == symbol)
}

/// The terms of a power, with their gradients; nothing else has any.
pub(super) fn links<'g>(model: &Mechanics<'g>) -> Vec<SiteTerm<'g>> {
    model.power.as_ref().map_or(Vec::new(), |power| of_terms(model, power.places.len(), &power.terms))
}

/// Terms with their gradients at so many places.
pub(super) fn of_terms<'g>(model: &Mechanics<'g>, places: usize, terms: &[Term<'g>]) -> Vec<SiteTerm<'g>> {
    let link = |term: &Term<'g>| {
        let symbols = term.value.symbols();
        let at = |place: usize, leaf: usize| symbol_at(&symbols, place, leaf);
        let slope = |place: usize, leaf: usize| match at(place, leaf) {
            Some(symbol) => term.value.gradient(symbol),
            None => model.graph.zero(model.configurations[leaf].shape),
        };
        let leaves = 0..model.configurations.len();
        let read = (0..places).filter(|&place| leaves.clone().any(|leaf| at(place, leaf).is_some()));
        let gradient = read.map(|place| (place, leaves.clone().map(|leaf| slope(place, leaf)).into_list())).into_list();
        SiteTerm { term: term.clone(), gradient }
    };
    terms.each(link)
}

/// The symbol of a leaf of the configuration at a place, if it is among some.
pub(super) fn symbol_at<'g>(symbols: &[Expr<'g>], place: usize, leaf: usize) -> Option<Expr<'g>> {
    let role = Role::At(place, leaf);
    symbols.iter().copied().find(|symbol| symbol.role() == Some(role))
}

/// The change of each term where all of its sites move alike: by `motion`, given for the site itself.
pub(super) fn moved<'g>(model: &Mechanics<'g>, links: &[SiteTerm<'g>], motion: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let of_link = |link: &SiteTerm<'g>| {
        let symbols = link.term.value.symbols();
        let mut change = model.graph.integer(0);
        for (place, gradient) in &link.gradient {
            let there: Vec<(Expr<'g>, Expr<'g>)> = (model.configurations.iter().enumerate())
                .filter_map(|(leaf, configuration)| Some((configuration.symbol, symbol_at(&symbols, *place, leaf)?)))
                .into_list();
            for (slope, motion) in gradient.iter().zip(motion) {
                change = change + slope.pairing(motion.substitute(&there));
            }
        }
        change
    };
    links.each(of_link)
}
