//! Random elements of groups over a prime field, and what they decide about charts.

use super::Group;
use crate::algebra::Sparse;
use crate::evaluate::{Matrix, Number, negative, one, zero};
use crate::identity::{Residue, rank_of};
use crate::{Graph, Shape, integer, rational};

type Field = Matrix<Residue>;

/// A random element, or `None` where the group has no rational parametrisation that is known here.
pub(crate) fn element(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Option<Field> {
    let n = group.element_shape().rows;
    Some(match group {
        Group::SpecialLinear(_) => unimodular(n, random),
        Group::GeneralLinear(_) => Matrix::from_fn(Shape::square(n), |_| random()),
        Group::SpecialEuclidean(_) | Group::Similarity(_) => {
            let inner = n - 1;
            let turn = cayley(graph, Group::SpecialOrthogonal(inner), random);
            let scale = if matches!(group, Group::Similarity(_)) { random() } else { one() };
            Matrix::from_fn(Shape::square(n), |(i, j)| match (i < inner, j < inner) {
                (true, true) => turn.at(i, j).multiply(scale),
                (true, false) => random(),
                (false, true) => zero(),
                (false, false) => one(),
            })
        }
        Group::Affine(_) | Group::Heisenberg(_) => identity_plus(algebra_element(graph, group, random), one()),
        Group::Declared(_) => match group.chart(graph) {
            super::Chart::Affine => identity_plus(algebra_element(graph, group, random), one()),
            super::Chart::Cayley => cayley(graph, group, random),
            _ => product_of_exponentials(graph, group, random)?,
        },
        Group::SpecialUnitary(_) => product_of_exponentials(graph, group, random)?,
        _ => cayley(graph, group, random),
    })
}

/// Σ r_i E_i with random r.
fn algebra_element(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Field {
    let shape = group.element_shape();
    let mut sum = Matrix::from_fn(shape, |_| zero::<Residue>());
    for block in graph.blocks(group).iter() {
        for element in &graph.basis(block.algebra).elements {
            let scale = random();
            for (i, j, value) in element {
                let position = (i + block.row) * shape.columns + j + block.column;
                let term = scale.multiply(Residue::from_rational(value));
                sum.entries[position] = sum.entries[position].add(term);
            }
        }
    }
    sum
}

/// I + s Z.
fn identity_plus(z: Field, s: Residue) -> Field {
    Matrix::from_fn(z.shape, |(i, j)| {
        let unit = if i == j { one() } else { zero() };
        s.multiply(z.at(i, j)).add(unit)
    })
}

/// (I − Z)⁻¹(I + Z).
fn cayley(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Field {
    let z = algebra_element(graph, group, random);
    identity_plus(z.clone(), negative(one())).inverse().0.multiply(&identity_plus(z, one()))
}

/// A random matrix whose first row is divided by its determinant.
fn unimodular(n: usize, random: &mut impl FnMut() -> Residue) -> Field {
    let matrix = Matrix::from_fn(Shape::square(n), |_| random());
    let scale = matrix.inverse().1.reciprocal();
    Matrix::from_fn(matrix.shape, |(i, j)| if i == 0 { matrix.at(i, j).multiply(scale) } else { matrix.at(i, j) })
}

/// Whether dF F⁻¹ stays in the algebra along the Cayley map: (I − Z)⁻¹ E_i (I + Z)⁻¹ in the span of the basis, for a random Z.
pub(super) fn is_cayley_tangent(graph: &Graph, group: Group) -> bool {
    let mut seed = 0;
    let mut random = || {
        seed += 1;
        Residue::mixed(&[6, seed])
    };
    let z = algebra_element(graph, group, &mut random);
    let left = identity_plus(z.clone(), negative(one())).inverse().0;
    let right = identity_plus(z, one()).inverse().0;
    let shape = group.element_shape();
    let basis: Vec<Field> = graph
        .blocks(group)
        .iter()
        .flat_map(|block| {
            let place = (block.row, block.column);
            graph.basis(block.algebra).elements.iter().map(|element| dense(shape, element, place)).collect::<Vec<_>>()
        })
        .collect();
    let rows = |matrices: &[Field]| {
        let entries: Vec<Residue> = matrices.iter().flat_map(|matrix| matrix.entries.clone()).collect();
        Matrix::new(Shape::new(matrices.len(), shape.len()), entries)
    };
    let moved: Vec<Field> = basis.iter().map(|element| left.multiply(element).multiply(&right)).collect();
    rank_of(rows(&[basis.clone(), moved].concat())) == basis.len()
}

fn dense(shape: Shape, element: &Sparse, (row, column): (usize, usize)) -> Field {
    let mut matrix = Matrix::from_fn(shape, |_| zero::<Residue>());
    for (i, j, value) in element {
        matrix.entries[(i + row) * shape.columns + j + column] = Residue::from_rational(value);
    }
    matrix
}

/// Π exp(t_i E_i), each factor by a formula that is rational in a parameter: E nilpotent, E³ = ∓c²E, or E diagonal with integers.
fn product_of_exponentials(graph: &Graph, group: Group, random: &mut impl FnMut() -> Residue) -> Option<Field> {
    let shape = group.element_shape();
    let mut product = Matrix::scaled_identity(shape.rows, one());
    for block in graph.blocks(group).iter() {
        for element in &graph.basis(block.algebra).elements {
            let factor = exponential(dense(shape, element, (block.row, block.column)), element, random())?;
            product = product.multiply(&factor);
        }
    }
    Some(product)
}

fn exponential(e: Field, element: &Sparse, t: Residue) -> Option<Field> {
    let n = e.shape.rows;
    let square = e.multiply(&e);
    let cube = square.multiply(&e);
    for c in 1..=4_i64 {
        let quarter = Residue::from_rational(&integer(c * c));
        let with = |sine: Residue, versine: Residue| {
            let linear = scale(&e, sine.multiply(Residue::from_rational(&rational(1, c))));
            let quadratic = scale(&square, versine.multiply(quarter.reciprocal()));
            sum(&identity_plus(linear, one()), &quadratic)
        };
        if cube == scale(&e, negative(quarter)) {
            // sin = 2t/(1 + t²), 1 − cos = 2t²/(1 + t²)
            let denominator = one::<Residue>().add(t.multiply(t)).reciprocal();
            let double = t.add(t).multiply(denominator);
            return Some(with(double, double.multiply(t)));
        }
        if cube == scale(&e, quarter) {
            // sinh = (s − 1/s)/2, cosh − 1 = (s + 1/s)/2 − 1
            let half = Residue::from_rational(&rational(1, 2));
            let (plus, minus) = (t.add(t.reciprocal()), t.add(negative(t.reciprocal())));
            return Some(with(half.multiply(minus), half.multiply(plus).add(negative(one()))));
        }
    }
    nilpotent(&e, n, t).or_else(|| diagonal(element, n, t))
}

/// Σ tᵏEᵏ/k! of a nilpotent matrix.
fn nilpotent(e: &Field, n: usize, t: Residue) -> Option<Field> {
    let mut sum_of_powers: Field = Matrix::scaled_identity(n, one());
    let mut power = sum_of_powers.clone();
    for k in 1..=n {
        power = scale(&power.multiply(e), t.multiply(Residue::from_rational(&rational(1, k as i64))));
        sum_of_powers = sum(&sum_of_powers, &power);
    }
    power.entries.iter().all(|entry| *entry == zero()).then_some(sum_of_powers)
}

/// diag(s^d) of a diagonal matrix of integers d, with s = exp t.
fn diagonal(element: &Sparse, n: usize, s: Residue) -> Option<Field> {
    let integral = element.iter().all(|(i, j, value)| i == j && value.is_integer());
    let power = |exponent: i64| {
        let base = if exponent < 0 { s.reciprocal() } else { s };
        (0..exponent.unsigned_abs()).fold(one(), |product: Residue, _| product.multiply(base))
    };
    let exponent = |i: usize| -> Option<i64> {
        let found = element.iter().find(|(row, ..)| *row == i);
        found.map_or(Some(0), |(_, _, value)| value.parts().map(|(d, _)| d).filter(|d| d.abs() < 64))
    };
    let exponents: Vec<i64> = (0..n).map(exponent).collect::<Option<_>>()?;
    integral.then(|| Matrix::from_fn(Shape::square(n), |(i, j)| if i == j { power(exponents[i]) } else { zero() }))
}

fn scale(matrix: &Field, factor: Residue) -> Field {
    Matrix::from_fn(matrix.shape, |(i, j)| matrix.at(i, j).multiply(factor))
}

fn sum(a: &Field, b: &Field) -> Field {
    Matrix::from_fn(a.shape, |(i, j)| a.at(i, j).add(b.at(i, j)))
}
