//! Price, bounds and the price of the end, each with its derivatives. The kernels of a choice of inputs compute matrices over the motions
//! of a configuration and the entries of the input.

use clebsch_symbolic::{Expr, IntoList, Shape, both};

use super::matrices::Inserted;
use super::{Bend, Id, InputStep, MatrixForm, MechanicsFormulas, SteeredFormulas, SystemFormulas};

/// The direction in which symbols move.
pub(super) type Direction<'g> = Vec<(Expr<'g>, Expr<'g>)>;

/// The data for the choice of inputs. Price and bounds have derivatives along the motions of q and the inputs. If they
/// take the velocity of the step, they are functions of an edge, with derivatives along the motions of both its ends.
pub struct Steering<'g> {
    /// ℓ(t, h, q, u) or ℓ(t, h, q, F, u).
    pub price: Jet<'g>,
    /// The derivatives of ℓ with respect to h and t.
    pub price_of_time: [Expr<'g>; 2],
    /// a(t, q, u) or a(t, h, q, F, u), one after the other.
    pub bounds: Vec<Jet<'g>>,
    /// Whether the price is a function of an edge, and whether bounds are.
    pub on_edge: OnEdge,
    /// The weights of the bounds.
    pub weights: Expr<'g>,
    /// The distance from q to q⁺: J(q, q⁺ − q).
    pub approach: Vec<Expr<'g>>,
}

/// The functions of inputs that take the velocity of a step.
#[derive(Clone, Copy, Default)]
pub struct OnEdge {
    /// The price.
    pub price: bool,
    /// The bounds.
    pub bounds: bool,
}

/// The price of the end. If it takes the velocity, its derivatives are along motions and along momenta.
pub struct Endpoint<'g> {
    /// φ(t, q) or φ(t, q, N).
    pub price: Jet<'g>,
    /// ∂φ/∂t.
    pub by_time: Expr<'g>,
}

/// The conditions of the end, the equations first. Where they take the velocity, their derivatives are along motions and along momenta.
pub struct EndTarget<'g> {
    /// a and b of each.
    pub sides: Vec<[Expr<'g>; 2]>,
    /// a − b.
    pub differences: Vec<Jet<'g>>,
    /// ∂(a − b)/∂t.
    pub by_time: Vec<Expr<'g>>,
    /// The weights of the conditions.
    pub weights: Expr<'g>,
}

/// A scalar with its derivatives along the directions of a list.
pub struct Jet<'g> {
    /// f.
    pub value: Expr<'g>,
    /// ∂_i f.
    pub slope: Vec<Expr<'g>>,
    /// ½ (∂_i ∂_j + ∂_j ∂_i) f, along the motions of a group the second derivative along exponentials.
    pub curvature: Vec<Vec<Expr<'g>>>,
}

impl<'g> Jet<'g> {
    /// The derivatives of a scalar. Gradients are taken with respect to the symbols that move. Each gradient is
    /// differentiated once along each direction, and paired with the velocities of all.
    pub(super) fn of(value: Expr<'g>, directions: &[Direction<'g>]) -> Jet<'g> {
        let mut gradients: Vec<(Expr<'g>, Expr<'g>)> = Vec::new();
        for (symbol, _) in directions.iter().flatten() {
            if value.depends_on(*symbol) && !gradients.iter().any(|(known, _)| known == symbol) {
                gradients.push((*symbol, value.gradient(*symbol)));
            }
        }
        let paired = |direction: &Direction<'g>, other: &dyn Fn(Expr<'g>, Expr<'g>) -> Expr<'g>| {
            value.graph().total(
                Shape::scalar(),
                direction.iter().filter_map(|(symbol, velocity)| {
                    let (_, gradient) = gradients.iter().find(|(known, _)| known == symbol)?;
                    Some(other(*gradient, *velocity))
                }),
            )
        };
        let slope = directions.iter().map(|direction| paired(direction, &|gradient, velocity| gradient.dot(velocity)));
        // ∂_j ∂_i f
        let second = |i: usize, j: usize| {
            paired(&directions[i], &|gradient, velocity| {
                gradient.differential(&directions[j]).dot(velocity)
                    + gradient.dot(velocity.differential(&directions[j]))
            })
        };
        let curvature = (0..directions.len()).map(|i| {
            let entry = |j: usize| if i == j { second(i, i) } else { (second(i, j) + second(j, i)) / 2 };
            (0..=i).map(entry).into_list()
        });
        Jet { value, curvature: curvature.into_list(), slope: slope.into_list() }
    }
}

/// Makes the matrices of a choice.
pub struct Choice<'a, 'g> {
    /// The formulas of the system.
    pub formulas: &'a SystemFormulas<'g>,
    at: Inserted<'g>,
    /// The data for the choice of inputs.
    pub steering: &'a Steering<'g>,
    /// The effect of the inputs.
    pub step: StepOfChoice<'a, 'g>,
}

/// The effect of inputs in a step.
#[derive(Copy, Clone)]
pub enum StepOfChoice<'a, 'g> {
    /// They move the configuration by themselves.
    Steered(&'a InputStep<'g>),
    /// They are those of forces, which act at both ends of an edge.
    Forced(&'a Bend<'g>),
}

/// An entry of a symmetric matrix, from its lower triangle.
fn symmetric<'g>(lower: &[Vec<Expr<'g>>], i: usize, j: usize) -> Expr<'g> {
    if i >= j { lower[i][j] } else { lower[j][i] }
}

impl<'g> SteeredFormulas<'g> {
    /// The formulas for the choice of inputs.
    pub fn choice(&self) -> Option<Choice<'_, 'g>> {
        Choice::of(self, StepOfChoice::Steered(&self.step))
    }
}

impl<'g> MechanicsFormulas<'g> {
    /// The formulas for a choice of inputs, if there is one.
    pub fn choice(&self) -> Option<Choice<'_, 'g>> {
        let bend = self.substeps.first()?.variation.as_ref()?.bend.as_ref()?;
        Choice::of(self, StepOfChoice::Forced(bend))
    }
}

impl<'g> SystemFormulas<'g> {
    /// φ, ∂φ/∂t, ∂φ/∂δ, ∂²φ/∂δ², where δ is η or (η, ν).
    pub fn endpoint_expanded(&self, endpoint: &Endpoint<'g>) -> Vec<MatrixForm<'g>> {
        let (at, jet, m) = (Inserted::of(self), &endpoint.price, endpoint.price.slope.len());
        vec![
            MatrixForm::Whole(jet.value),
            MatrixForm::Whole(endpoint.by_time),
            at.entries(Shape::vector(m), |i, _| jet.slope[i]),
            at.entries(Shape::square(m), |i, j| symmetric(&jet.curvature, i, j)),
        ]
    }
}

impl<'g> SystemFormulas<'g> {
    /// Both sides of the conditions of the end, ∂g/∂t, ∂g/∂δ, ∂²(z·g)/∂δ².
    pub fn target_expanded(&self, target: &EndTarget<'g>) -> Vec<MatrixForm<'g>> {
        let (at, n) = (Inserted::of(self), target.differences.len());
        let m = target.differences.first().map_or(0, |jet| jet.slope.len());
        let weighted = weighted(&target.differences, target.weights);
        vec![
            at.entries(Shape::vector(n), |i, _| target.sides[i][0]),
            at.entries(Shape::vector(n), |i, _| target.sides[i][1]),
            at.entries(Shape::vector(n), |i, _| target.by_time[i]),
            at.entries(Shape::new(n, m), |i, j| target.differences[i].slope[j]),
            at.entries(Shape::square(m), weighted),
        ]
    }
}

/// The second derivatives of z·a.
fn weighted<'j, 'g>(jets: &'j [Jet<'g>], weights: Expr<'g>) -> impl Fn(usize, usize) -> Expr<'g> + 'j {
    move |i, j| {
        let weighted = jets.iter().enumerate();
        let weighted = weighted.map(|(k, jet)| weights.entry(k, 0) * symmetric(&jet.curvature, i, j));
        weights.graph().total(Shape::scalar(), weighted)
    }
}

impl<'a, 'g> Choice<'a, 'g> {
    fn of(formulas: &'a SystemFormulas<'g>, step: StepOfChoice<'a, 'g>) -> Option<Choice<'a, 'g>> {
        Some(Choice { at: Inserted::of(formulas), steering: formulas.steering.as_ref()?, formulas, step })
    }

    /// The matrices of a kernel of a choice, as the catalogue lists them; none of other kernels.
    pub fn matrices(&self, id: Id) -> Vec<MatrixForm<'g>> {
        let (at, price, m) = (&self.at, &self.steering.price, self.formulas.model.dimension());
        let u: usize = self.formulas.model.chosen().iter().map(|leaf| leaf.shape.len()).sum();
        // the three blocks of a symmetric matrix over motions and inputs
        let curvature = |entry: &dyn Fn(usize, usize) -> Expr<'g>| {
            [
                at.entries(Shape::square(m), entry),
                at.entries(Shape::new(u, m), |i, j| entry(m + i, j)),
                at.entries(Shape::square(u), |i, j| entry(m + i, m + j)),
            ]
        };
        let price_and_slopes = || {
            [
                MatrixForm::Whole(price.value),
                at.entries(Shape::vector(m), |i, _| price.slope[i]),
                at.entries(Shape::vector(u), |i, _| price.slope[m + i]),
            ]
        };
        let of_price = |i, j| symmetric(&price.curvature, i, j);
        match (id, self.step) {
            (Id::StepExpanded, StepOfChoice::Steered(step)) => {
                let curvature = curvature(&|i, j| of_price(i, j) + symmetric(&step.curvature, i, j));
                let slopes = both([&step.by_place, &step.by_input], |columns| at.columns(columns));
                [&slopes, price_and_slopes().as_slice(), &curvature].concat()
            }
            (Id::ByInput, StepOfChoice::Forced(bend)) => {
                [&bend.before_by_input, &bend.after_by_input].map(|columns| at.columns(columns)).to_vec()
            }
            (Id::Bend, StepOfChoice::Forced(bend)) => {
                vec![at.entries(Shape::square(2 * m + u), |i, j| symmetric(&bend.curvature, i, j))]
            }
            (Id::Crossed, StepOfChoice::Forced(bend)) if !bend.crossed.is_empty() => vec![at.columns(&bend.crossed)],
            (Id::Bracket, StepOfChoice::Forced(bend)) => {
                vec![at.entries(Shape::square(m), |i, j| bend.bracket[i][j])]
            }
            (Id::PriceExpanded, _) if self.steering.on_edge.price => {
                let w = price.slope.len();
                vec![
                    at.whole(price.value),
                    at.entries(Shape::vector(w), |i, _| price.slope[i]),
                    at.entries(Shape::square(w), of_price),
                ]
            }
            (Id::PriceExpanded, _) => {
                let curvature = curvature(&of_price);
                [price_and_slopes(), curvature].concat()
            }
            (Id::PriceOfTime, step) => {
                let of_step = match step {
                    StepOfChoice::Steered(step) => step.by_time,
                    StepOfChoice::Forced(bend) => bend.by_time,
                };
                vec![at.entries(Shape::vector(2), |i, _| self.steering.price_of_time[i] + of_step[i])]
            }
            (Id::BoundsExpanded, _) => {
                let bounds = &self.steering.bounds;
                let weighted = weighted(bounds, self.steering.weights);
                let c = bounds.len();
                if self.steering.on_edge.bounds {
                    let w = 2 * m + u;
                    return vec![
                        at.entries(Shape::vector(c), |i, _| bounds[i].value),
                        at.entries(Shape::new(c, w), |i, j| bounds[i].slope[j]),
                        at.entries(Shape::square(w), weighted),
                    ];
                }
                let curvature = curvature(&weighted);
                let values = [
                    at.entries(Shape::vector(c), |i, _| bounds[i].value),
                    at.entries(Shape::new(c, m), |i, j| bounds[i].slope[j]),
                    at.entries(Shape::new(c, u), |i, j| bounds[i].slope[m + j]),
                ];
                [values, curvature].concat()
            }
            _ => Vec::new(),
        }
    }
}
