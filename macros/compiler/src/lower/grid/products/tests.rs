use clebsch_symbolic::{Expr, Graph, Group, Property, Role, Shape};

use crate::lower::kernel::kernel;
use crate::lower::{Hoisted, Hoisting, Scalars};

/// A rotation R, vectors u and v that change, a constant symmetric matrix J and a constant k.
struct Letters<'g> {
    r: Expr<'g>,
    u: Expr<'g>,
    v: Expr<'g>,
    j: Expr<'g>,
    k: Expr<'g>,
}

impl<'g> Letters<'g> {
    fn of(graph: &'g Graph) -> Letters<'g> {
        let square = Shape::square(3);
        let vector = |name, i| graph.symbol(name, Shape::vector(3), Role::Momentum(i), Property::General);
        Letters {
            r: graph.symbol("R", square, Role::Configuration(0), Property::General),
            u: vector("u", 0),
            v: vector("v", 1),
            j: graph.symbol("J", square, Role::Parameter(0), Property::Symmetric),
            k: graph.symbol("k", Shape::scalar(), Role::Parameter(1), Property::General),
        }
    }
}

/// Additions and multiplications of outputs, constants taken out.
fn operations(outputs: &[Expr<'_>]) -> (usize, usize) {
    let mut scalars = Scalars::default();
    scalars.searches = 10_000_000;
    let grids: Vec<_> = outputs.iter().map(|output| (*scalars.grid(*output)).clone()).collect();
    let cost = kernel(&mut scalars, &grids, Hoisting::Constants(&mut Hoisted::default())).cost();
    (cost.additions, cost.multiplications)
}

/// ⟨A, E⟩ of so(3).
fn moment(a: Expr<'_>) -> Expr<'_> {
    a.components(a.graph().algebra_of(Group::SpecialOrthogonal(3)))
}

/// The moment of k (Rᵀu)·J Rᵀu/2 is k y × J y with y = Rᵀu: 9, 9 and 6 multiplications, where J takes k.
#[test]
fn a_moment_of_rank_one_is_made_of_vectors() {
    let graph = Graph::new();
    let Letters { r, u, j, k, .. } = Letters::of(&graph);
    let found = moment(r.transpose() * u * (u.transpose() * r * j) * k);
    assert_eq!(operations(&[found]), (15, 24));
}

/// With the potential itself, y·J y, k is no part of J y: three multiplications by k, and three for the product.
#[test]
fn a_multiple_of_a_sum_is_one_multiplication() {
    let graph = Graph::new();
    let Letters { r, u, j, k, .. } = Letters::of(&graph);
    let found = moment(r.transpose() * u * (u.transpose() * r * j) * k);
    let potential = u.transpose() * r * j * r.transpose() * u;
    assert_eq!(operations(&[found, potential]), (17, 30));
}

/// xᵀR J Rᵀx is y·J y with y = Rᵀx.
#[test]
fn a_quadratic_form_has_one_vector() {
    let graph = Graph::new();
    let Letters { r, u, j, .. } = Letters::of(&graph);
    assert_eq!(operations(&[u.transpose() * r * j * r.transpose() * u]), (14, 21));
}

/// The moments of u aᵀ + u bᵀ + … are those of u (a + b + …)ᵀ: y × (a + b + …) with y = Rᵀu, however many there are.
#[test]
fn a_common_column_is_taken_out_of_a_sum() {
    let graph = Graph::new();
    let Letters { r, u, v, j, .. } = Letters::of(&graph);
    let rows = [r, j, j * r, r * j];
    let sum = graph.total(Shape::square(3), rows.map(|matrix| u * v.transpose() * matrix));
    // y, vᵀR, vᵀJ, vᵀR J and vᵀJ R, three sums, and a product of vectors.
    assert_eq!(operations(&[moment(r.transpose() * sum)]), (42, 51));
}

/// The moments of u aᵀ + v bᵀ are y × a + z × b. Here y = Rᵀu and z = Rᵀv.
#[test]
fn a_sum_of_columns_times_rows_is_distributed() {
    let graph = Graph::new();
    let Letters { r, u, v, j, .. } = Letters::of(&graph);
    let sum = u * u.transpose() * r * j + v * u.transpose();
    // y, z and J y, two products of vectors and their sum
    assert_eq!(operations(&[moment(r.transpose() * sum)]), (27, 39));
}

/// a + k b and k a + k b are no multiples of each other.
#[test]
fn sums_with_other_ratios_stay() {
    let graph = Graph::new();
    let Letters { u, v, k, .. } = Letters::of(&graph);
    let (a, b) = (u.entry(0, 0), v.entry(0, 0));
    assert_eq!(operations(&[a + k * b, k * a + k * b]), (2, 2));
}
