//! Compiled declarations with random numbers in them.

use std::collections::HashMap;

use clebsch_compiler::lower::{MechanicsProgram, Program};
use clebsch_compiler::{Graph, compile};
use clebsch_symbolic::{Expr, Group, Matrix, Property, Role, Shape};
use clebsch_tests::oracle::random::Random;
use quote::ToTokens;

pub use crate::kernels::Values;

/// The first four stages of the struct in a fixture's text; `None` where inputs move it.
pub fn program<'g>(graph: &'g Graph, text: &str) -> Option<MechanicsProgram<'g>> {
    let file = syn::parse_file(text).expect("a Rust file");
    let structs = file.items.iter().filter(|item| matches!(item, syn::Item::Struct(_)));
    let item = structs.map(ToTokens::to_token_stream).next().expect("a struct");
    match compile(graph, item) {
        Ok(Program::Mechanics(program)) => Some(*program),
        Ok(Program::Steered(_)) => None,
        Err(errors) => panic!("{errors}"),
    }
}

impl Values {
    /// Random numbers that keep the promises about each symbol; the step is 0.1.
    pub fn random(program: &MechanicsProgram<'_>, random: &mut Random) -> Values {
        let formulas = &program.formulas;
        let (model, symbols) = (&formulas.model, &formulas.symbols);
        let mut all: Vec<Expr<'_>> = vec![model.step_size, model.time];
        all.extend(model.parameters.iter().flat_map(|parameter| parameter.leaves.iter().map(|leaf| leaf.symbol)));
        all.extend(model.constants.iter().map(|constant| constant.symbol));
        all.extend(model.factors.iter().map(|factor| factor.symbol));
        all.extend(model.configurations.iter().map(|leaf| leaf.symbol));
        for more in [&symbols.covectors, &symbols.momenta, &symbols.algebra] {
            all.extend(more.iter());
        }
        all.extend(symbols.blocks.iter().flat_map(|block| [block.coordinates, block.direction]));
        all.extend(model.inputs.iter().map(|leaf| leaf.symbol));
        let mut values = Values(HashMap::new());
        for symbol in all {
            let data = symbol.as_symbol().expect("a symbol");
            let numbers = match data.property {
                Property::Element(group) => element(program.formulas.model.graph, group, random),
                // charts of groups that are not compact end where det(I + Z) or det(I − Z) is zero. A velocity of one,
                // ten times these coordinates, may be that of light
                _ if matches!(data.role, Role::Chart(_)) => Matrix::from_fn(data.shape, |_| random.number() / 20.0),
                _ => value(data.shape, data.property, random),
            };
            values.0.insert(data.name.clone(), numbers);
        }
        let step = program.formulas.model.step_size.as_symbol().expect("a symbol").name;
        values.0.insert(step, Matrix::new(Shape::scalar(), vec![0.1]));
        let inverse = values.evaluate(formulas.inertia).inverse().0;
        values.0.insert("inertia_inverse".into(), inverse);
        values
    }

    /// Takes over all numbers of `other`.
    pub fn copy(&mut self, other: &Values) {
        self.0.clone_from(&other.0);
    }

    /// The numbers of the symbol with this name, row by row.
    pub fn named(&self, name: &str) -> &[f64] {
        &self.0[name].entries
    }
}

fn value(shape: Shape, property: Property, random: &mut Random) -> Matrix<f64> {
    let plain = Matrix::from_fn(shape, |_| random.number());
    let n = shape.rows;
    match property {
        // regular masses and inertias
        _ if shape.is_scalar() => Matrix::new(shape, vec![random.between(0.5, 1.5)]),
        Property::Symmetric | Property::General if shape.is_square() => {
            Matrix::from_fn(shape, |(i, j)| f64::from(u8::from(i == j)) + (plain.at(i, j) + plain.at(j, i)) / 8.0)
        }
        Property::Diagonal => Matrix::from_fn(shape, |(i, j)| if i == j { 1.0 + plain.at(i, i) / 4.0 } else { 0.0 }),
        Property::Orthogonal => cayley(&Matrix::from_fn(shape, |(i, j)| plain.at(i, j) - plain.at(j, i)), n),
        Property::Unit => {
            let length = plain.entries.iter().map(|x| x * x).sum::<f64>().sqrt();
            Matrix::from_fn(shape, |(i, j)| plain.at(i, j) / length)
        }
        _ => plain,
    }
}

/// (I − Z)⁻¹(I + Z)
fn cayley(z: &Matrix<f64>, n: usize) -> Matrix<f64> {
    let shifted =
        |sign: f64| Matrix::from_fn(Shape::square(n), |(i, j)| f64::from(u8::from(i == j)) + sign * z.at(i, j));
    shifted(-1.0).inverse().0.multiply(&shifted(1.0))
}

/// An element of a group near its identity, in the chart of its exponential map or in that of the group.
fn element(graph: &Graph, group: Group, random: &mut Random) -> Matrix<f64> {
    let coordinates: Vec<Expr<'_>> = (graph.blocks(group).iter().zip(0..))
        .map(|(block, index)| {
            let name = format!("coordinates of a random element {index}");
            let shape = Shape::vector(block.algebra.dimension);
            graph.symbol(&name, shape, Role::Direction(index), Property::General)
        })
        .collect();
    let element = group.chart(graph).element(group, &coordinates);
    element.evaluate(&mut |symbol| Matrix::from_fn(symbol.shape(), |_| random.number() / 4.0))
}
