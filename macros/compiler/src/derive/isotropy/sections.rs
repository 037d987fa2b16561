//! Polynomial sections of the isotropy algebras: functions q ↦ Z(q) with Z(q) in 𝔤_q for every q.

use clebsch_symbolic::{Elements, Expr, IntoList, Rational, Shape, identity};

use super::super::SystemFormulas;
use super::super::symbols::of_columns;
use super::super::system::is_invariant;
use super::{Form, Own};

/// The largest degree of a section in the entries of q.
const DEGREE: usize = 2;
/// The most coefficients of a section that are solved for.
const COEFFICIENTS: usize = 260;
/// The most sections whose Gram matrix is inverted.
const BASIS: usize = 6;

/// The entries of a symmetric form that are not zero, with their rows and columns.
type InnerProduct = Vec<(usize, usize, Rational)>;

/// The form V of the component along 𝔤_q, orthogonal in an inner product b of 𝔤.
///
/// If the sections Z are a basis of 𝔤_q, V = bZ(ZᵀbZ)⁻¹Zᵀb. If there are more of them, V = bZZᵀb dim 𝔤_q/tr(ZᵀbZ).
pub(super) fn form<'g>(own: &Own<'_, 'g>, system: &SystemFormulas<'g>, kinetic: Expr<'g>) -> Option<Form<'g>> {
    let nullity = own.columns.len() - identity::rank(own.map);
    let sections = sections(own, nullity)?;
    let is_basis = sections.shape().columns == nullity;
    let with = |b: InnerProduct| {
        let along = lowered(&b, sections);
        (along, gram(sections, along))
    };
    // where the kinetic energy is invariant under the group, its isotropy is compact, and −tr(ζ²) positive
    let invariant = if is_basis && is_invariant(own.model, kinetic, &system.symbols.algebra) {
        invariant_product(own).map(with)
    } else {
        None
    };
    let is_regular = |(_, products): &(Expr<'g>, Expr<'g>)| identity::rank(*products) == nullity;
    let (along, products) = invariant.filter(is_regular).unwrap_or_else(|| with(inner_product(own, |a, b| a.dot(b))));
    let weight = match nullity {
        1 if is_basis => products.entry(0, 0).powi(-1),
        2..=BASIS if is_basis => products.inverse(),
        _ => own.model.graph.integer(nullity as i64) / products.trace().expand(),
    };
    Some(Form::Sections { along, weight })
}

/// Sections that span 𝔤_q for general q, those of the least degree, as columns.
fn sections<'g>(own: &Own<'_, 'g>, nullity: usize) -> Option<Expr<'g>> {
    let graph = own.model.graph;
    let entries = own.leaves.iter().flat_map(|&leaf| own.model.configurations[leaf].symbol.entries()).into_list();
    let variables = independent(own, entries);
    let mut monomials = vec![graph.integer(1)];
    for degree in 0..=DEGREE {
        if degree > 0 {
            let products = monomials.iter().flat_map(|a| variables.iter().map(|b| *a * *b));
            let mut longer = monomials.clone();
            products.for_each(|product| {
                if !longer.contains(&product) {
                    longer.push(product)
                }
            });
            monomials = independent(own, longer);
        }
        if monomials.len() * own.columns.len() > COEFFICIENTS {
            return None;
        }
        let terms = monomials.iter().flat_map(|monomial| (0..own.columns.len()).map(move |j| (*monomial, j)));
        let terms = terms.into_list();
        let images = terms.each(|(monomial, j)| own.columns[*j].each(|entry| *monomial * *entry));
        let found = identity::null_space(of_columns(graph, &images));
        let section = |coefficients: &Vec<Rational>| {
            let mut section = vec![graph.integer(0); own.columns.len()];
            for ((monomial, j), coefficient) in terms.iter().zip(coefficients) {
                section[*j] = section[*j] + graph.number(coefficient.clone()) * *monomial;
            }
            section
        };
        if found.len() < nullity {
            continue;
        }
        let sections = of_columns(graph, &found.each(section));
        if identity::rank(sections) == nullity {
            return Some(sections);
        }
    }
    None
}

/// Those of some functions on the space that are no combinations of those before them.
fn independent<'g>(own: &Own<'_, 'g>, functions: Vec<Expr<'g>>) -> Vec<Expr<'g>> {
    let row = own.model.graph.stack(Shape::new(1, functions.len()), functions.clone());
    let last = |relation: &Vec<Rational>| relation.iter().rposition(|coefficient| !coefficient.is_zero());
    let combined = identity::null_space(row).iter().filter_map(last).into_list();
    functions.into_iter().enumerate().filter(|(k, _)| !combined.contains(k)).map(|(_, function)| function).into_list()
}

/// −tr(E_i E_j), which is invariant under the group, where the factors are groups of matrices.
fn invariant_product(own: &Own<'_, '_>) -> Option<InnerProduct> {
    let is_of_matrices = |k: &usize| own.model.factors[*k].group.element_shape().is_square();
    own.factors.iter().all(is_of_matrices).then(|| inner_product(own, |a, b| -a.transpose().dot(b)))
}

/// The entries of ⟨E_i, E_j⟩ that are not zero, in the components of the factors.
fn inner_product<'g>(own: &Own<'_, 'g>, product: fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> InnerProduct {
    let mut entries = InnerProduct::new();
    let mut offset = 0;
    for &k in own.factors {
        let basis = own.model.graph.matrices(own.model.factors[k].group);
        for (i, a) in basis.iter().enumerate() {
            for (j, b) in basis.iter().enumerate() {
                let value = product(*a, *b).as_number().filter(|value| !value.is_zero());
                entries.extend(value.map(|value| (offset + i, offset + j, value)));
            }
        }
        offset += basis.len();
    }
    entries
}

/// bZ.
fn lowered<'g>(b: &InnerProduct, sections: Expr<'g>) -> Expr<'g> {
    let (graph, shape) = (sections.graph(), sections.shape());
    let entry = |(i, k): (usize, usize)| {
        let own = b.iter().filter(|(row, ..)| *row == i);
        let terms = own.map(|(_, j, value)| graph.number(value.clone()) * sections.entry(*j, k));
        graph.total(Shape::scalar(), terms).expand()
    };
    graph.stack(shape, shape.positions().map(entry).into_list())
}

/// ZᵀbZ.
fn gram<'g>(sections: Expr<'g>, lowered: Expr<'g>) -> Expr<'g> {
    let (graph, rows, count) = (sections.graph(), sections.shape().rows, sections.shape().columns);
    let entry = |(k, l): (usize, usize)| {
        let terms = (0..rows).map(|i| sections.entry(i, k.min(l)) * lowered.entry(i, k.max(l)));
        graph.total(Shape::scalar(), terms).expand()
    };
    let square = Shape::square(count);
    graph.stack(square, square.positions().map(entry).into_list())
}
