//! Price, bounds and the price of the end, each with its derivatives.

use clebsch_symbolic::{Expr, Shape};

/// The direction in which symbols move.
pub(super) type Direction<'g> = Vec<(Expr<'g>, Expr<'g>)>;

/// What the inputs are chosen with.
pub struct Steering<'g> {
    /// ℓ(t, h, q, u).
    pub price: Jet<'g>,
    /// The derivatives of ℓ with respect to h and t.
    pub price_of_time: [Expr<'g>; 2],
    /// a(t, q, u), one after the other.
    pub bounds: Vec<Jet<'g>>,
    /// The weights of the bounds.
    pub weights: Expr<'g>,
    /// What separates q from q⁺: J(q, q⁺ − q).
    pub approach: Vec<Expr<'g>>,
}

/// The price of the end.
pub struct Endpoint<'g> {
    /// φ(t, q).
    pub price: Jet<'g>,
    /// ∂φ/∂t.
    pub by_time: Expr<'g>,
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
    /// The derivatives of a scalar: gradients with respect to the symbols that move, each gradient differentiated along each direction
    /// once, and paired with the velocities of all.
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
            (0..=i).map(entry).collect()
        });
        Jet { value, curvature: curvature.collect(), slope: slope.collect() }
    }
}
