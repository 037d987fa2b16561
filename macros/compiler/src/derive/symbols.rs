//! The symbols of the derivation: covectors, momenta, algebra elements, chart coordinates, increments.

use clebsch_symbolic::{Block, Chart, Elements, Expr, Graph, IntoList, Property, Role, Shape, indexed};

use crate::model::{ChartChoice, Configuration, Discretization, Factor, System};

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
    /// The coordinates of log F, for each factor: a Lagrangian that is discretised by the exponential depends on them.
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
        self.blocks.iter().filter(|block| block.factor == factor).map(|block| block.coordinates).into_list()
    }

    /// The blocks that some components lie in, by index.
    pub fn blocks_of(&self, components: &[usize]) -> Vec<usize> {
        let holds_one = |i: &usize| components.iter().any(|component| self.blocks[*i].components().contains(component));
        (0..self.blocks.len()).filter(holds_one).into_list()
    }

    /// The chart coordinates of a factor in one vector.
    pub(super) fn stacked_coordinates(&self, factor: usize) -> Expr<'g> {
        self.logarithms[factor].graph().below(&self.coordinates(factor))
    }

    /// The replacement of all coordinates and momenta by zero: the motion that rests.
    pub fn at_rest(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        at_zero(self.blocks.iter().map(|block| block.coordinates).chain(self.momenta.iter().copied()))
    }

    /// The replacements of ξ by each element of the basis, factor after factor.
    pub fn basis(&self) -> Vec<Vec<(Expr<'g>, Expr<'g>)>> {
        let zero = at_zero(self.algebra.iter().copied());
        let mut elements = Vec::new();
        for (k, xi) in self.algebra.iter().enumerate() {
            for i in 0..xi.shape().rows {
                let mut element = zero.clone();
                element[k].1 = xi.graph().unit(xi.shape(), i, 0);
                elements.push(element);
            }
        }
        elements
    }

    /// Motions that are linear in ξ, along each element of the basis.
    pub(super) fn along_basis(&self, motions: &[(Expr<'g>, Expr<'g>)]) -> Vec<Vec<(Expr<'g>, Expr<'g>)>> {
        let along = |element: &Vec<(Expr<'g>, Expr<'g>)>| {
            motions.each(|(symbol, velocity)| (*symbol, velocity.substitute(element)))
        };
        self.basis().each(along)
    }

    /// The gradient with respect to the velocities of all factors, in one vector.
    pub fn slope(&self, function: Expr<'g>) -> Expr<'g> {
        let gradients: Vec<_> = self.algebra.each(|xi| function.gradient(*xi));
        function.graph().below(&gradients)
    }

    /// The derivative of a vector with respect to the velocities of all factors, as a matrix.
    pub fn slopes(&self, vector: Expr<'g>) -> Expr<'g> {
        let jacobians: Vec<_> = self.algebra.each(|xi| vector.jacobian(*xi));
        vector.graph().beside(&jacobians)
    }

    /// κ, the multipliers of so many equations of a constraint.
    pub(super) fn multiplier_of(&self, count: usize) -> Expr<'g> {
        let (letter, shape) = (self.multiplier.to_string(), Shape::vector(count));
        self.multiplier.graph().symbol(&letter, shape, Role::Multiplier, Property::General)
    }

    pub(super) fn new(model: &System<'g>, discretization: Option<Discretization>) -> Symbols<'g> {
        let (graph, taken) = (model.graph, taken(model));
        let promised =
            |letters: &[&'static str], role: fn(usize) -> Role, values: &[(Shape, Property)]| -> Vec<Expr<'g>> {
                let letter = fresh(letters, &taken);
                let symbol = |(index, (shape, property)): (usize, &(Shape, Property))| {
                    graph.symbol(&subscripted(letter, index, values.len()), *shape, role(index), *property)
                };
                values.iter().enumerate().map(symbol).into_list()
            };
        let numbered = |letters: &[&'static str], role: fn(usize) -> Role, shapes: &[Shape]| {
            promised(letters, role, &shapes.each(|shape| (*shape, Property::General)))
        };
        let leaves: Vec<Shape> = model.configurations.each(|leaf| leaf.shape);
        let groups = || model.factors.iter().map(|factor| factor.group);
        let vectors: Vec<Shape> = groups().map(|group| Shape::vector(group.dimension())).into_list();
        let matrices: Vec<Shape> = groups().map(|group| group.element_shape()).into_list();
        let increments: Vec<_> = groups().map(|group| (group.element_shape(), Property::Increment(group))).into_list();
        Symbols {
            covectors: numbered(&["p", "α", "β"], Role::Covector, &leaves),
            algebra: numbered(&["ξ", "η", "ζ"], Role::Algebra, &vectors),
            momenta: numbered(&["μ", "ν", "λ"], Role::Momentum, &vectors),
            multiplier: graph.symbol(
                fresh(&["κ", "χ", "ϰ"], &taken),
                Shape::vector(model.dimension()),
                Role::Multiplier,
                Property::General,
            ),
            charts: model.factors.each(|factor| chart(model, factor, discretization)),
            blocks: blocks(model, [fresh(&["x", "c", "z"], &taken), fresh(&["δ", "ε", "γ"], &taken)]),
            logarithms: indexed(model.factors.len(), |k| logarithm(model, k)),
            increments: promised(&["D", "Δ", "B"], Role::Increment, &increments),
            following: promised(&["D⁺"], Role::Following, &increments),
            images: images(model),
            momentum_matrices: numbered(&["M", "N", "P"], Role::MomentumMatrix, &matrices),
        }
    }
}

/// The symbols of q⁺, which lies in the same space as q.
pub(super) fn images<'g>(model: &System<'g>) -> Vec<Expr<'g>> {
    let image = |(i, leaf): (usize, &Configuration<'g>)| {
        model.graph.symbol(&format!("{}⁺", leaf.name), leaf.shape, Role::Image(i), leaf.symbol.property())
    };
    model.configurations.iter().enumerate().map(image).into_list()
}

/// The replacement of every group element by the identity, and of its logarithm by zero.
pub(super) fn identities<'g>(model: &System<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let elements = model.factors.iter().map(|factor| (factor.symbol, factor.group.identity(model.graph)));
    let logarithms = (0..model.factors.len()).map(|k| logarithm(model, k));
    elements.chain(logarithms.map(|y| (y, model.graph.zero(y.shape())))).into_list()
}

/// The replacement of q by q⁺, for each leaf of the configuration.
pub(super) type Images<'g> = Vec<(Expr<'g>, Expr<'g>)>;

/// The replacement of q by Φ_F(q).
pub(super) fn moved<'g>(model: &System<'g>) -> Images<'g> {
    model.configurations.iter().zip(&model.action).map(|(leaf, image)| (leaf.symbol, *image)).into_list()
}

/// The replacement of (t, q) by (t + h, Φ_F(q)).
pub(super) fn moved_on<'g>(model: &System<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    after_step(model, moved(model))
}

/// The replacement of (t, q) by (t + h, q⁺).
pub(super) fn after_step<'g>(model: &System<'g>, images: Images<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    images.into_iter().chain([(model.time, model.time + model.step_size)]).into_list()
}

/// Some rows of a vector.
pub(super) fn rows_at<'g>(vector: Expr<'g>, positions: &[usize]) -> Expr<'g> {
    let shape = Shape::vector(positions.len());
    match positions {
        [first, .., last] if last - first + 1 == positions.len() => vector.block(*first, 0, shape),
        _ => vector.graph().stack(shape, positions.each(|&i| vector.entry(i, 0))),
    }
}

pub(super) fn of_columns<'g>(graph: &'g Graph, columns: &[Vec<Expr<'g>>]) -> Expr<'g> {
    let shape = Shape::new(columns[0].len(), columns.len());
    graph.stack(shape, shape.positions().map(|(i, j)| columns[j][i]).into_list())
}

/// The entries of vectors, one after the other.
pub(super) fn entries<'g>(vectors: &[Expr<'g>]) -> Vec<Expr<'g>> {
    vectors.iter().flat_map(|vector| vector.entries()).into_list()
}

/// The replacement of symbols by zero.
pub(super) fn at_zero<'g>(symbols: impl IntoIterator<Item = Expr<'g>>) -> Vec<(Expr<'g>, Expr<'g>)> {
    symbols.into_iter().map(|symbol| (symbol, symbol.graph().zero(symbol.shape()))).into_list()
}

/// The symbol of the coordinates of log F.
pub(super) fn logarithm<'g>(model: &System<'g>, k: usize) -> Expr<'g> {
    let factor = &model.factors[k];
    let name = format!("log({})", factor.name);
    let shape = Shape::vector(factor.group.dimension());
    model.graph.symbol(&name, shape, Role::Logarithm(k), Property::General)
}

/// The chart of a factor. It is that of the velocity, if there is one, for then ξ is a multiple of x. Else it is the
/// user's choice, or that of the group.
fn chart(model: &System<'_>, factor: &Factor<'_>, discretization: Option<Discretization>) -> Chart {
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
    let count: usize = model.factors.iter().map(|factor| graph.blocks(factor.group).len()).sum();
    let (mut made, mut offset) = (Vec::new(), 0);
    for (factor, data) in model.factors.iter().enumerate() {
        for (block, Block { algebra, .. }) in graph.blocks(data.group).iter().enumerate() {
            let shape = Shape::vector(algebra.dimension);
            let symbol = |letter: &str, role: Role| {
                graph.symbol(&subscripted(letter, made.len(), count), shape, role, Property::General)
            };
            let coordinates = symbol(letters[0], Role::Chart(made.len()));
            let direction = symbol(letters[1], Role::Direction(made.len()));
            made.push(ChartBlock { factor, block, offset, coordinates, direction });
            offset += algebra.dimension;
        }
    }
    made
}

/// The first letters of the user's own names, which the derivation does not take.
fn taken(model: &System<'_>) -> Vec<String> {
    let leaves = model.configurations.iter().map(|leaf| &leaf.name);
    let factors = model.factors.iter().map(|factor| &factor.name);
    let variables = leaves.chain(factors).map(|name| name.split('[').next().unwrap_or(name).to_string());
    variables.chain(model.parameters.iter().map(|parameter| parameter.name.clone())).into_list()
}

/// The first letter that the user has not taken; the last one if all are.
fn fresh(letters: &[&'static str], taken: &[String]) -> &'static str {
    let free = letters.iter().find(|letter| !taken.iter().any(|name| name == *letter));
    free.or(letters.last()).copied().unwrap_or("")
}

/// The letter alone if there is one of them, else with a subscript that counts from one.
fn subscripted(letter: &str, index: usize, count: usize) -> String {
    if count == 1 { letter.to_string() } else { format!("{letter}{}", subscript(index + 1)) }
}

/// A number below the line.
pub(super) fn subscript(number: usize) -> String {
    number.to_string().bytes().filter_map(|digit| char::from_u32('₀' as u32 + u32::from(digit - b'0'))).collect()
}
