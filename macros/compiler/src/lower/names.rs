//! Names of shared values, made from what they are where that is short.

use clebsch_symbolic::{Rational, Role, integer};

use super::{Hoisted, Node, Scalar, Scalars};

const LONGEST_NAME: usize = 24;

/// A distinct identifier for each constant.
pub fn constants(scalars: &Scalars, hoisted: &Hoisted) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for (index, (scalar, _)) in hoisted.kept().enumerate() {
        let name = describe(scalars, scalar).filter(|name| name.len() <= LONGEST_NAME && !names.contains(name));
        names.push(name.unwrap_or_else(|| format!("k{index}")));
    }
    names
}

/// A short description: `h`, `half_h_weight`, `weight_center_0`, `per_mass`.
fn describe(scalars: &Scalars, scalar: Scalar) -> Option<String> {
    match scalars.node(scalar) {
        Node::Input(input) if input.role == Role::StepSize => Some("h".into()),
        Node::Input(input) => {
            let plain = input.name.chars().all(|c| c.is_ascii_alphanumeric() || "_[].".contains(c));
            let base: String = input.name.replace(['[', '.'], "_").replace(']', "");
            let index = match (input.is_vector, input.row, input.column) {
                (true, row, _) => format!("{row}"),
                (false, row, column) => format!("{row}{column}"),
            };
            let single = input.is_vector && input.row == 0 && !scalars.has_other_entries(input);
            plain.then(|| if single { base.to_lowercase() } else { format!("{}_{index}", base.to_lowercase()) })
        }
        Node::Sum(constant, terms) if *constant == integer(0) && terms.len() == 1 => {
            Some(format!("{}_{}", numeral(&terms[0].1)?, describe(scalars, terms[0].0)?))
        }
        Node::Product(factors) if factors.len() <= 3 => {
            let parts: Option<Vec<String>> = factors
                .iter()
                .map(|&(factor, exponent)| {
                    let name = describe(scalars, factor)?;
                    Some(if exponent == 1 { name } else { format!("{name}_{exponent}") })
                })
                .collect();
            Some(parts?.join("_"))
        }
        Node::Reciprocal(x) => Some(format!("per_{}", describe(scalars, *x)?)),
        _ => None,
    }
}

fn numeral(coefficient: &Rational) -> Option<&'static str> {
    let table = [
        (1, 2, "half"),
        (2, 1, "two"),
        (-1, 1, "minus"),
        (1, 4, "quarter"),
        (4, 1, "four"),
        (-1, 2, "minus_half"),
        (-2, 1, "minus_two"),
    ];
    table.iter().find(|(n, d, _)| *coefficient == clebsch_symbolic::rational(*n, *d)).map(|(_, _, name)| *name)
}
