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
        let covectors = model.configurations.iter().enumerate().map(|(i, leaf)| {
            let name = subscripted("p", i, model.configurations.len());
            graph.symbol(&name, leaf.shape, Role::Covector(i), Property::General)
        });
        let factor = |letter: &str, role: fn(usize) -> Role, matrix: bool| -> Vec<Expr<'g>> {
            let symbol = |(k, factor): (usize, &crate::model::Factor<'g>)| {
                let shape = if matrix { factor.group.element_shape() } else { Shape::vector(factor.group.dimension()) };
                graph.symbol(&subscripted(letter, k, model.factors.len()), shape, role(k), Property::General)
            };
            model.factors.iter().enumerate().map(symbol).collect()
        };
        Symbols {
            covectors: covectors.collect(),
            algebra: factor("ξ", Role::Algebra, false),
            momenta: factor("μ", Role::Momentum, false),
            charts: factor("x", Role::Chart, false),
            directions: factor("δ", Role::Auxiliary, false),
            increments: factor("D", Role::Increment, true),
            momentum_matrices: factor("M", Role::MomentumMatrix, true),
        }
    }
}

/// The letter alone if there is one of them, else with a subscript that counts from one.
fn subscripted(letter: &str, index: usize, count: usize) -> String {
    let digits = (index + 1).to_string();
    let subscript: String = digits.bytes().filter_map(|digit| char::from_u32('₀' as u32 + (digit - b'0') as u32)).collect();
    if count == 1 { letter.to_string() } else { format!("{letter}{subscript}") }
}
