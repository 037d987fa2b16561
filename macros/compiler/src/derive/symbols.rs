//! The symbols of the derivation: covectors, momenta, algebra elements, chart coordinates, increments.

use clebsch_symbolic::{Expr, Property, Role, Shape};

use crate::model::Model;

/// One symbol for each leaf of the configuration, or for each factor of the group.
pub struct Symbols<'g> {
    /// p, for each leaf of the configuration.
    pub covectors: Vec<Expr<'g>>,
    /// ξ in components, for each factor.
    pub algebra: Vec<Expr<'g>>,
    /// μ in components, for each factor.
    pub momenta: Vec<Expr<'g>>,
    /// The chart coordinates x of F, for each factor.
    pub charts: Vec<Expr<'g>>,
    /// A direction in which the chart coordinates move, for each factor.
    pub directions: Vec<Expr<'g>>,
    /// The increment F − I (F itself for translations), for each factor.
    pub increments: Vec<Expr<'g>>,
    /// The representing matrix of the momentum, for each factor.
    pub momentum_matrices: Vec<Expr<'g>>,
}

impl<'g> Symbols<'g> {
    pub(super) fn new(model: &Model<'g>) -> Symbols<'g> {
        let graph = model.graph;
        let taken = taken(model);
        let covector = fresh(&["p", "α", "β"], &taken);
        let covectors = model.configurations.iter().enumerate().map(|(i, leaf)| {
            let name = subscripted(covector, i, model.configurations.len());
            graph.symbol(&name, leaf.shape, Role::Covector(i), Property::General)
        });
        let factor = |letters: &[&'static str], role: fn(usize) -> Role, matrix: bool| -> Vec<Expr<'g>> {
            let letter = fresh(letters, &taken);
            let symbol = |(k, factor): (usize, &crate::model::Factor<'g>)| {
                let shape = if matrix { factor.group.element_shape() } else { Shape::vector(factor.group.dimension()) };
                graph.symbol(&subscripted(letter, k, model.factors.len()), shape, role(k), Property::General)
            };
            model.factors.iter().enumerate().map(symbol).collect()
        };
        Symbols {
            covectors: covectors.collect(),
            algebra: factor(&["ξ", "η", "ζ"], Role::Algebra, false),
            momenta: factor(&["μ", "ν", "λ"], Role::Momentum, false),
            charts: factor(&["x", "c", "z"], Role::Chart, false),
            directions: factor(&["δ", "ε", "γ"], Role::Auxiliary, false),
            increments: factor(&["D", "Δ", "B"], Role::Increment, true),
            momentum_matrices: factor(&["M", "N", "P"], Role::MomentumMatrix, true),
        }
    }
}

/// The first letters of the user's own names, which the derivation does not take.
fn taken(model: &Model<'_>) -> Vec<String> {
    let base = |name: &str| name.split('[').next().unwrap_or(name).to_string();
    let leaves = model.configurations.iter().map(|leaf| base(&leaf.name));
    let factors = model.factors.iter().map(|factor| base(&factor.name));
    leaves.chain(factors).chain(model.parameters.iter().map(|parameter| parameter.name.clone())).collect()
}

/// The first letter that the user has not taken; the last one if all are.
fn fresh(letters: &[&'static str], taken: &[String]) -> &'static str {
    let free = letters.iter().find(|letter| !taken.iter().any(|name| name == *letter));
    free.or(letters.last()).copied().unwrap_or("")
}

/// The letter alone if there is one of them, else with a subscript that counts from one.
fn subscripted(letter: &str, index: usize, count: usize) -> String {
    let digits = (index + 1).to_string();
    let subscript: String =
        digits.bytes().filter_map(|digit| char::from_u32('₀' as u32 + (digit - b'0') as u32)).collect();
    if count == 1 { letter.to_string() } else { format!("{letter}{subscript}") }
}
