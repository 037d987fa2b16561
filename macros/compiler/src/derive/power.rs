//! What ties the sites of a power to each other: the gradient of each term, differentiated once for all indices.

use clebsch_symbolic::{Expr, Role};

use crate::model::{Model, Term};

/// A term of the potential of a power with its gradient.
pub struct Link<'g> {
    /// The term.
    pub term: Term<'g>,
    /// ∂/∂q for each place that the term reads, by its number: one expression for each leaf of the configuration there.
    pub gradient: Vec<(usize, Vec<Expr<'g>>)>,
}

/// The terms of a power, with their gradients; nothing else has any.
pub(super) fn links<'g>(model: &Model<'g>) -> Vec<Link<'g>> {
    let Some(power) = &model.power else { return Vec::new() };
    let link = |term: &Term<'g>| {
        let symbols = term.value.symbols();
        let at = |place: usize, leaf: usize| symbol_at(&symbols, place, leaf);
        let slope = |place: usize, leaf: usize| match at(place, leaf) {
            Some(symbol) => term.value.gradient(symbol),
            None => model.graph.zero(model.configurations[leaf].shape),
        };
        let leaves = 0..model.configurations.len();
        let read = (0..power.places.len()).filter(|&place| leaves.clone().any(|leaf| at(place, leaf).is_some()));
        let gradient = read.map(|place| (place, leaves.clone().map(|leaf| slope(place, leaf)).collect())).collect();
        Link { term: term.clone(), gradient }
    };
    power.terms.iter().map(link).collect()
}

/// The symbol of a leaf of the configuration at a place, if it is among some.
fn symbol_at<'g>(symbols: &[Expr<'g>], place: usize, leaf: usize) -> Option<Expr<'g>> {
    let role = Role::At(place, leaf);
    symbols.iter().copied().find(|symbol| symbol.as_symbol().is_some_and(|data| data.role == role))
}

/// The change of each term where all of its sites move alike: by `motion`, given for the site itself.
pub(super) fn moved<'g>(model: &Model<'g>, links: &[Link<'g>], motion: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let of_link = |link: &Link<'g>| {
        let symbols = link.term.value.symbols();
        let mut change = model.graph.integer(0);
        for (place, gradient) in &link.gradient {
            let there: Vec<(Expr<'g>, Expr<'g>)> = (model.configurations.iter().enumerate())
                .filter_map(|(leaf, configuration)| Some((configuration.symbol, symbol_at(&symbols, *place, leaf)?)))
                .collect();
            for (slope, motion) in gradient.iter().zip(motion) {
                change = change + slope.pairing(motion.substitute(&there));
            }
        }
        change
    };
    links.iter().map(of_link).collect()
}
