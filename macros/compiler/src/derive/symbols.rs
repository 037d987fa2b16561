//! The symbols of the derivation: covectors, momenta, algebra elements, chart coordinates, increments.

use clebsch_symbolic::{Chart, Expr, Property, Role, Shape};

use crate::model::{ChartChoice, Discretization, System};

/// One symbol for each leaf of the configuration, or for each factor of the group.
pub struct Symbols<'g> {
    /// p, for each leaf of the configuration.
    pub covectors: Vec<Expr<'g>>,
    /// ξ in components, for each factor.
    pub algebra: Vec<Expr<'g>>,
    /// μ in components, for each factor.
    pub momenta: Vec<Expr<'g>>,
    /// κ, the multipliers of the momentum equation of a step.
    pub multiplier: Expr<'g>,
    /// The chart of each factor.
    pub charts: Vec<Chart>,
    /// The chart coordinates of all factors, one vector for each block of their algebras.
    pub blocks: Vec<ChartBlock<'g>>,
    /// The increment F − I (F itself for translations), for each factor.
    pub increments: Vec<Expr<'g>>,
    /// The increment of a motion that follows another, for each factor.
    pub following: Vec<Expr<'g>>,
    /// q⁺ = Φ_F(q), for each leaf of the configuration.
    pub images: Vec<Expr<'g>>,
    /// The coordinates of log F, for each factor: what a Lagrangian that is discretised by the exponential depends on.
    pub logarithms: Vec<Expr<'g>>,
    /// The representing matrix of the momentum, for each factor.
    pub momentum_matrices: Vec<Expr<'g>>,
}

/// The chart coordinates in a block of a factor's Lie algebra.
#[derive(Copy, Clone)]
pub struct ChartBlock<'g> {
    /// The factor, by index.
    pub factor: usize,
    /// The index of the block among those of its factor.
    pub block: usize,
    /// The index of its first component among the components of all factors.
    pub offset: usize,
    /// The coordinates x.
    pub coordinates: Expr<'g>,
    /// A direction in which they move.
    pub direction: Expr<'g>,
}

impl ChartBlock<'_> {
    /// The number of coordinates.
    pub fn dimension(&self) -> usize {
        self.coordinates.shape().rows
    }

    /// The indices of its components among those of all factors.
    pub fn components(&self) -> std::ops::Range<usize> {
        self.offset..self.offset + self.dimension()
    }
}

impl<'g> Symbols<'g> {
    /// The chart coordinates of a factor, one vector for each of its blocks.
    pub fn coordinates(&self, factor: usize) -> Vec<Expr<'g>> {
        self.blocks.iter().filter(|block| block.factor == factor).map(|block| block.coordinates).collect()
    }

    /// The blocks that some components lie in, by index.
    pub fn blocks_of(&self, components: &[usize]) -> Vec<usize> {
        let holds_one = |i: &usize| components.iter().any(|component| self.blocks[*i].components().contains(component));
        (0..self.blocks.len()).filter(holds_one).collect()
    }

    /// The chart coordinates of a factor in one vector.
    pub(super) fn stacked_coordinates(&self, factor: usize) -> Expr<'g> {
        let shape = self.logarithms[factor].shape();
        let blocks = self.blocks.iter().filter(|block| block.factor == factor);
        let start = self.blocks.iter().find(|block| block.factor == factor).map_or(0, |block| block.offset);
        let parts = blocks.map(|block| block.coordinates.embed(shape, block.offset - start, 0));
        parts.fold(self.logarithms[factor].graph().zero(shape), |sum, part| sum + part)
    }

    /// The replacement of all coordinates and momenta by zero: the motion that rests.
    pub fn at_rest(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let moving = self.blocks.iter().map(|block| &block.coordinates).chain(&self.momenta);
        moving.map(|symbol| (*symbol, symbol.graph().zero(symbol.shape()))).collect()
    }

    /// The replacements of ξ by each element of the basis, factor after factor.
    pub fn basis(&self) -> Vec<Vec<(Expr<'g>, Expr<'g>)>> {
        let element = |k: usize, i: usize| {
            let part = |(j, xi): (usize, &Expr<'g>)| {
                let graph = xi.graph();
                (*xi, if j == k { graph.unit(xi.shape(), i, 0) } else { graph.zero(xi.shape()) })
            };
            self.algebra.iter().enumerate().map(part).collect()
        };
        let factors = self.algebra.iter().enumerate();
        factors.flat_map(|(k, xi)| (0..xi.shape().rows).map(move |i| (k, i))).map(|(k, i)| element(k, i)).collect()
    }

    /// The gradient with respect to the velocities of all factors, in one vector.
    pub fn slope(&self, function: Expr<'g>) -> Expr<'g> {
        let shape = Shape::vector(self.algebra.iter().map(|xi| xi.shape().rows).sum());
        let mut row = 0;
        self.algebra.iter().fold(function.graph().zero(shape), |sum, xi| {
            let placed = function.gradient(*xi).embed(shape, row, 0);
            row += xi.shape().rows;
            sum + placed
        })
    }

    /// The derivative of a vector with respect to the velocities of all factors, as a matrix.
    pub fn slopes(&self, vector: Expr<'g>) -> Expr<'g> {
        let columns = self.algebra.iter().map(|xi| xi.shape().rows).sum();
        let shape = Shape::new(vector.shape().rows, columns);
        let mut column = 0;
        self.algebra.iter().fold(vector.graph().zero(shape), |sum, xi| {
            let placed = vector.jacobian(*xi).embed(shape, 0, column);
            column += xi.shape().rows;
            sum + placed
        })
    }

    /// The element of a factor in its chart.
    pub(super) fn chart_element(&self, model: &System<'g>, factor: usize) -> Expr<'g> {
        self.charts[factor].element(model.factors[factor].group, &self.coordinates(factor))
    }

    /// The increment F − I of a factor in its chart, without cancellation.
    pub(super) fn chart_increment(&self, model: &System<'g>, factor: usize) -> Expr<'g> {
        let (numerator, denominator) =
            self.charts[factor].increment(model.factors[factor].group, &self.coordinates(factor));
        numerator / denominator
    }

    pub(super) fn new(model: &System<'g>, discretization: Option<Discretization>) -> Symbols<'g> {
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
            multiplier: graph.symbol(
                fresh(&["κ", "χ", "ϰ"], &taken),
                Shape::vector(model.dimension()),
                Role::Multiplier,
                Property::General,
            ),
            charts: model.factors.iter().map(|factor| chart(model, factor, discretization)).collect(),
            blocks: blocks(model, [fresh(&["x", "c", "z"], &taken), fresh(&["δ", "ε", "γ"], &taken)]),
            logarithms: (0..model.factors.len()).map(|k| logarithm(model, k)).collect(),
            increments: factor(&["D", "Δ", "B"], Role::Increment, true),
            following: factor(&["D⁺"], Role::Following, true),
            images: model.configurations.iter().enumerate().map(|(i, leaf)| image(model, i, leaf)).collect(),
            momentum_matrices: factor(&["M", "N", "P"], Role::MomentumMatrix, true),
        }
    }
}

/// The symbol of a leaf of q⁺, which lies in the same space as that of q.
fn image<'g>(model: &System<'g>, i: usize, leaf: &crate::model::Configuration<'g>) -> Expr<'g> {
    let property = leaf.symbol.as_symbol().map_or(Property::General, |symbol| symbol.property);
    model.graph.symbol(&format!("{}⁺", leaf.name), leaf.shape, Role::Image(i), property)
}

/// The symbol of the coordinates of log F.
pub(super) fn logarithm<'g>(model: &System<'g>, k: usize) -> Expr<'g> {
    let factor = &model.factors[k];
    let name = format!("log({})", factor.name);
    let shape = Shape::vector(factor.group.dimension());
    model.graph.symbol(&name, shape, Role::Logarithm(k), Property::General)
}

/// The chart of a factor: what the velocity is made with, for then ξ is a multiple of x; else the user's choice, or that of the
/// group.
fn chart(model: &System<'_>, factor: &crate::model::Factor<'_>, discretization: Option<Discretization>) -> Chart {
    if factor.group.is_translation() {
        return Chart::Identity;
    }
    match (discretization, model.dials.chart.as_ref().map(|chart| chart.value)) {
        (Some(Discretization::Exponential), _) | (_, Some(ChartChoice::Exponential)) => Chart::Exponential,
        (_, Some(ChartChoice::Cayley)) => Chart::Cayley,
        (Some(Discretization::Cayley), None) if factor.group.has_cayley_chart(model.graph) => Chart::Cayley,
        _ => factor.group.chart(model.graph),
    }
}

/// The chart coordinates and their directions, numbered through all factors.
fn blocks<'g>(model: &System<'g>, letters: [&'static str; 2]) -> Vec<ChartBlock<'g>> {
    let graph = model.graph;
    let shapes: Vec<(usize, usize, usize)> = model
        .factors
        .iter()
        .enumerate()
        .flat_map(|(factor, data)| {
            let blocks = graph.blocks(data.group);
            let sizes: Vec<usize> = blocks.iter().map(|block| block.algebra.dimension()).collect();
            sizes.into_iter().enumerate().map(move |(block, size)| (factor, block, size))
        })
        .collect();
    let mut offset = 0;
    let mut made = Vec::new();
    for (index, &(factor, block, size)) in shapes.iter().enumerate() {
        let symbol = |letter: &str, role: Role| {
            graph.symbol(&subscripted(letter, index, shapes.len()), Shape::vector(size), role, Property::General)
        };
        let (coordinates, direction) =
            (symbol(letters[0], Role::Chart(index)), symbol(letters[1], Role::Direction(index)));
        made.push(ChartBlock { factor, block, offset, coordinates, direction });
        offset += size;
    }
    made
}

/// The first letters of the user's own names, which the derivation does not take.
fn taken(model: &System<'_>) -> Vec<String> {
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
