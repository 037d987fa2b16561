//! Directions of Lie algebras in words.

use clebsch_symbolic::{Group, IntoList, Rational, integer, joined};

use crate::model::System;

/// The j-th basis element of all factors together, in words.
pub(super) fn basis_direction(model: &System<'_>, j: usize) -> String {
    let is_within = |k: &usize| j < model.offset(k + 1);
    let Some(k) = (0..model.factors.len()).find(is_within) else { return "a direction of the group".to_string() };
    let factor = &model.factors[k];
    let of = if model.factors.len() > 1 { format!(" of `{}`", factor.name) } else { String::new() };
    format!("the {}{of}", direction_in_words(model, factor.group, j - model.offset(k)))
}

fn direction_in_words(model: &System<'_>, group: Group, j: usize) -> String {
    let turn = |n: usize, j: usize| match n {
        3 => format!("rotation about `e{}`", j + 1),
        _ => {
            // row a of the pairs above the diagonal begins behind those before it
            let (mut a, mut start) = (1, 0);
            while start + n - a <= j {
                (a, start) = (a + 1, start + n - a);
            }
            format!("rotation in the plane of `e{a}` and `e{}`", a + 1 + j - start)
        }
    };
    let shift = |j: usize| format!("translation along `e{}`", j + 1);
    match group {
        Group::SpecialOrthogonal(n) => turn(n, j),
        Group::UnitQuaternions => turn(3, j),
        Group::Translation(_) => shift(j),
        Group::SpecialEuclidean(n) => {
            let turns = n * (n - 1) / 2;
            if j < turns { turn(n, j) } else { shift(j - turns) }
        }
        _ => format!("direction `E{}` of `{}`", j + 1, group.name(model.graph)),
    }
}

/// A basis element, `in the plane of e1 and e2`.
pub(super) fn basis_element(model: &System<'_>, group: Group, index: usize) -> String {
    let words = direction_in_words(model, group, index).replace('`', "");
    words.trim_start_matches("rotation ").trim_start_matches("translation ").to_string()
}

/// A combination of basis elements, `about e3`, `in the plane of e1 and e2`, `along E12 + E21`.
pub(super) fn combination(model: &System<'_>, group: Group, weights: &[Rational]) -> String {
    let single = |index: &usize| weights.iter().enumerate().all(|(i, weight)| weight.is_zero() != (i == *index));
    let in_words = |index: usize| basis_element(model, group, index);
    let named = matches!(
        group,
        Group::SpecialOrthogonal(_) | Group::UnitQuaternions | Group::Translation(_) | Group::SpecialEuclidean(_)
    );
    if named {
        if let Some(index) = (0..weights.len()).find(single) {
            return in_words(index);
        }
        let parts = weights.iter().enumerate().filter(|(_, weight)| !weight.is_zero());
        return signed(parts.map(|(index, weight)| (weight.clone(), in_words(index))));
    }
    let entries = entries(model, group, weights);
    match entries.as_slice() {
        [(i, j, one), (k, l, other)] if (i, j) == (l, k) && *one == -other.clone() => {
            if group.element_shape().rows != 3 {
                return format!("in the plane of e{} and e{}", i.min(j) + 1, i.max(j) + 1);
            }
            // e1^ and e3^ have −1 above the diagonal, e2^ has +1
            let is_positive = one.is_negative() == (j - i == 1);
            format!("about {}e{}", if is_positive { "" } else { "−" }, 3 - i - j + 1)
        }
        _ => {
            let entries = entries.iter().map(|(i, j, value)| (value.clone(), format!("E{}{}", i + 1, j + 1)));
            format!("along {}", signed(entries))
        }
    }
}

/// The entries that are not zero of Σ w_i E_i.
fn entries(model: &System<'_>, group: Group, weights: &[Rational]) -> Vec<(usize, usize, Rational)> {
    let shape = group.element_shape();
    let mut sum = vec![Rational::zero(); shape.len()];
    for (element, weight) in model.graph.elements(group).iter().zip(weights) {
        element.iter().for_each(|(i, j, value)| sum[i * shape.columns + j] += weight * value);
    }
    let entries = shape.positions().zip(sum).filter(|(_, value)| !value.is_zero());
    entries.map(|((i, j), value)| (i, j, value)).into_list()
}

fn signed(parts: impl Iterator<Item = (Rational, String)>) -> String {
    let term = |(weight, name): (Rational, String)| {
        let magnitude = weight.abs();
        (weight.is_negative(), if magnitude == integer(1) { name } else { format!("{magnitude} {name}") })
    };
    joined(parts.map(term), '−')
}
