//! Random elements of groups over a prime field, and the decisions about charts that they allow.

use super::{Chart, Group};
use crate::algebra::Sparse;
use crate::evaluate::{Matrix, Number, negative, one, power, zero};
use crate::identity::Residue;
use crate::node::Exponent;
use crate::{Elements, Graph, IntoList, Shape, rational};

type Field = Matrix<Residue>;

/// A random element, or `None` where the group has no rational parametrisation that is known here.
pub(crate) fn element(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Option<Field> {
    match group.chart(graph) {
        Chart::Affine => Some(identity_plus(&algebra_element(graph, group, random), one())),
        Chart::Cayley => Some(cayley_map(&algebra_element(graph, group, random))),
        _ => product_of_exponentials(graph, group, random),
    }
}

/// Σ r_i E_i with random r.
fn algebra_element(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Field {
    let mut sum = Matrix::zeros(group.element_shape());
    graph.elements(group).iter().for_each(|element| sum.add_sparse(element, random()));
    sum
}

/// I + s Z.
fn identity_plus(z: &Field, s: Residue) -> Field {
    let mut sum = Matrix::scaled_identity(z.shape.rows, one());
    sum.add_scaled(z, s);
    sum
}

/// (I − Z)⁻¹(I + Z).
fn cayley_map(z: &Field) -> Field {
    identity_plus(z, negative(one())).inverse().0.multiply(&identity_plus(z, one()))
}

/// Whether dF F⁻¹ stays in the algebra along the Cayley map. The test is whether (I − Z)⁻¹ E_i (I + Z)⁻¹ is in the span
/// of the basis, for a random Z.
pub(super) fn is_cayley_tangent(graph: &Graph, group: Group) -> bool {
    let mut seed = 0;
    let mut random = || {
        seed += 1;
        Residue::mixed(&[6, seed])
    };
    let z = algebra_element(graph, group, &mut random);
    let left = identity_plus(&z, negative(one())).inverse().0;
    let right = identity_plus(&z, one()).inverse().0;
    let shape = group.element_shape();
    let basis: Vec<Field> = graph.elements(group).each(|element| dense(shape, element));
    let moved = basis.iter().map(|element| left.multiply(element).multiply(&right));
    let entries: Vec<Residue> = basis.iter().cloned().chain(moved).flat_map(|matrix| matrix.entries).into_list();
    let mut rows = Matrix::new(Shape::new(2 * basis.len(), shape.len()), entries);
    rows.reduce(shape.len()).0.len() == basis.len()
}

fn dense(shape: Shape, element: &Sparse) -> Field {
    let mut matrix = Matrix::zeros(shape);
    matrix.add_sparse(element, one());
    matrix
}

/// Π exp(t_i E_i), each factor by a formula that is rational in a parameter: E³ = λE, E nilpotent, or E diagonal with integers.
fn product_of_exponentials(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Option<Field> {
    let shape = group.element_shape();
    let mut product = Matrix::scaled_identity(shape.rows, one());
    for element in graph.elements(group) {
        product = product.multiply(&exponential(&dense(shape, &element), &element, random())?);
    }
    Some(product)
}

fn exponential(e: &Field, element: &Sparse, t: Residue) -> Option<Field> {
    let cube = e.multiply(e).multiply(e);
    let first = e.entries.iter().position(|entry| *entry != zero())?;
    if cube.scale(e.entries[first]) == e.scale(cube.entries[first]) {
        // the powers of E are I, E and E²: Cayley's map of tE is the exponential of a multiple of E
        return Some(cayley_map(&e.scale(t)));
    }
    nilpotent(e, t).or_else(|| diagonal(element, e.shape.rows, t))
}

/// Σ tᵏEᵏ/k! of a nilpotent matrix.
fn nilpotent(e: &Field, t: Residue) -> Option<Field> {
    let n = e.shape.rows;
    let mut sum: Field = Matrix::scaled_identity(n, one());
    let mut power = sum.clone();
    for k in 1..=n {
        power = power.multiply(e).scale(t.multiply(Residue::from_rational(&rational(1, k as i64))));
        sum.add_scaled(&power, one());
    }
    power.entries.iter().all(|entry| *entry == zero()).then_some(sum)
}

/// diag(s^d) of a diagonal matrix of integers d, with s = exp t.
fn diagonal(element: &Sparse, n: usize, s: Residue) -> Option<Field> {
    let mut matrix = Matrix::scaled_identity(n, one());
    for (i, j, value) in element {
        let is_small = |exponent: &Exponent| exponent.is_integer() && exponent.parts().0.abs() < 64;
        let exponent = value.as_fraction().filter(|exponent| i == j && is_small(exponent))?;
        matrix.entries[i * n + j] = power(s, exponent);
    }
    Some(matrix)
}
