//! Tokens of operations on whole matrices: nalgebra's, and calls of the runtime's for those that it has not.

use clebsch_symbolic::{Analytic, Rational, Role, Shape, integer};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{self, Scope, accessor, nested};
use crate::lower::{Callee, Code, Kernel, MatrixOperation, Whole};
use crate::model::{Access, Layout};

impl Scope<'_, '_> {
    /// An operation on whole matrices.
    pub(super) fn whole(&self, whole: &Whole) -> TokenStream {
        let Whole { operation, operands, shape, .. } = whole;
        let private = &self.paths.private;
        let call = |name: &str| {
            let name = format_ident!("{name}");
            let operands = operands.iter().map(|operand| self.by_reference(operand));
            quote!(#private::#name(#(#operands),*))
        };
        // operands are names: each operation is a statement
        let method = |name: &str| {
            let (name, receiver) = (format_ident!("{name}"), self.receiver(&operands[0]));
            let others = operands[1..].iter().map(|operand| self.by_reference(operand));
            quote!(#receiver.#name(#(#others),*))
        };
        match operation {
            MatrixOperation::Argument(input) => match self.place(input.role, *shape) {
                Reached::Reference(name) => quote!(*#name),
                Reached::Value(value) => value,
            },
            MatrixOperation::Zero => {
                let (scalar, matrix) = (&self.paths.scalar, self.paths.matrix(shape.rows, shape.columns));
                quote!(<#matrix as #private::Space<#scalar>>::origin())
            }
            MatrixOperation::Entries => code::grid(self, *shape, operands, false),
            MatrixOperation::Sum(weights) => self.weighted_sum(weights, operands),
            MatrixOperation::Scaled => {
                let (matrix, number) = (self.operand(&operands[0], Binding::Product), self.code(&operands[1], true));
                quote!(#matrix * #number)
            }
            MatrixOperation::Shifted => {
                let (matrix, number) = (self.by_reference(&operands[0]), self.code(&operands[1], false));
                quote!(#private::shifted(#matrix, #number))
            }
            MatrixOperation::Product => {
                let (a, b) = (self.factor(&operands[0], Binding::Product), self.factor(&operands[1], Binding::Atom));
                quote!(#a * #b)
            }
            MatrixOperation::InertiaTimes => {
                let (constants, vector) = (&self.constants, self.by_reference(&operands[0]));
                quote!(#constants.inertia_inverse.times(#vector))
            }
            MatrixOperation::Transpose => method("transpose"),
            MatrixOperation::Inverse => call("inverse"),
            MatrixOperation::Analytic(Analytic::Exponential) => call("exponential"),
            MatrixOperation::Analytic(Analytic::Phi) => call("phi"),
            MatrixOperation::Analytic(Analytic::Logarithm) => call("logarithm"),
            MatrixOperation::Value => self.opaque(&Callee::Value(String::new()), operands),
            MatrixOperation::Gradient(leaf) => self.opaque_gradient(*leaf, operands),
            MatrixOperation::Block(i, j) => self.block(&self.by_reference(&operands[0]), *shape, (*i, *j)),
            MatrixOperation::Embedded(i, j) => {
                let matrix = self.by_reference(&operands[0]);
                let (i, j) = (Literal::usize_unsuffixed(*i), Literal::usize_unsuffixed(*j));
                quote!(#private::embedded(#matrix, #i, #j))
            }
            MatrixOperation::Hadamard => method("component_mul"),
            MatrixOperation::DiagonalMatrix => {
                let (matrix, diagonal) =
                    (self.paths.matrix(shape.rows, shape.columns), self.by_reference(&operands[0]));
                quote!(<#matrix>::from_diagonal(#diagonal))
            }
            MatrixOperation::Diagonal => method("diagonal"),
            MatrixOperation::Hat => call("hat"),
            MatrixOperation::Axial => call("axial"),
            MatrixOperation::Skew => call("skew"),
            MatrixOperation::SkewComponents => call("skew_components"),
            MatrixOperation::SkewTimes => call("skew_times"),
            MatrixOperation::SkewOuter => call("skew_outer"),
            MatrixOperation::Pairing => method("dot"),
            MatrixOperation::Trace => method("trace"),
            MatrixOperation::Determinant => call("determinant"),
            MatrixOperation::Largest => {
                let (scalar, matrix) = (&self.paths.scalar, self.by_reference(&operands[0]));
                quote!(#private::Space::<#scalar>::max_abs(#matrix))
            }
            MatrixOperation::Entry(i, j) => {
                let matrix = self.receiver(&operands[0]);
                let is_column = matches!(&operands[0], Code::Whole(whole) if whole.shape.is_column());
                let (i, j) = (Literal::usize_unsuffixed(*i), Literal::usize_unsuffixed(*j));
                if is_column { quote!(#matrix[#i]) } else { quote!(#matrix[(#i, #j)]) }
            }
        }
    }

    /// The type of a shared term, where what is called does not say it.
    pub(super) fn type_of(&self, code: &Code) -> Option<TokenStream> {
        let Code::Whole(whole) = code else { return None };
        let matrix = self.paths.matrix(whole.shape.rows, whole.shape.columns);
        code.needs_name().then(|| quote!(: #matrix))
    }

    /// A matrix as an argument of a function.
    fn by_reference(&self, operand: &Code) -> TokenStream {
        match self.argument(operand) {
            Some(Reached::Reference(name)) => name,
            Some(Reached::Value(value)) => quote!(&#value),
            None => {
                let value = self.operand(operand, Binding::Atom);
                quote!(&#value)
            }
        }
    }

    /// A matrix that is multiplied: names are borrowed, values are not.
    fn factor(&self, operand: &Code, least: Binding) -> TokenStream {
        match operand {
            Code::Whole(whole) if !matches!(whole.operation, MatrixOperation::Argument(_)) => {
                self.operand(operand, least)
            }
            _ => self.by_reference(operand),
        }
    }

    /// A matrix that is added or multiplied by a number, in brackets unless it binds as much as is asked.
    fn operand(&self, operand: &Code, least: Binding) -> TokenStream {
        if let Some(Reached::Reference(name)) = self.argument(operand) {
            return name;
        }
        let value = self.code(operand, true);
        if Binding::of(operand) < least { quote!((#value)) } else { value }
    }

    /// A matrix whose method is called.
    fn receiver(&self, operand: &Code) -> TokenStream {
        match self.argument(operand) {
            Some(Reached::Reference(name)) => name,
            Some(Reached::Value(value)) => value,
            None => self.operand(operand, Binding::Atom),
        }
    }

    /// A matrix among the arguments of a function.
    fn argument(&self, operand: &Code) -> Option<Reached> {
        let Code::Whole(whole) = operand else { return None };
        let MatrixOperation::Argument(input) = &whole.operation else { return None };
        Some(self.place(input.role, whole.shape))
    }

    /// Σ c_i A_i.
    fn weighted_sum(&self, weights: &[Rational], operands: &[Code]) -> TokenStream {
        let (one, zero) = (integer(1), integer(0));
        let mut tokens = TokenStream::new();
        for (position, (weight, operand)) in weights.iter().zip(operands).enumerate() {
            let size = weight.abs();
            let least = if position == 0 && *weight < zero { Binding::Atom } else { Binding::Product };
            let operand = self.operand(operand, least);
            let term = if size == one {
                operand
            } else {
                let size = self.number(&size);
                quote!(#operand * #size)
            };
            tokens = match (position, *weight < zero) {
                (0, false) => term,
                (0, true) => quote!(-#term),
                (_, false) => quote!(#tokens + #term),
                (_, true) => quote!(#tokens - #term),
            };
        }
        tokens
    }

    /// Where a matrix among the arguments of a function stands.
    fn place(&self, role: Role, shape: Shape) -> Reached {
        let leaf = |name: &str, access: &Access| {
            let name = format_ident!("{name}");
            if access.is_whole() {
                return Reached::Reference(quote!(#name));
            }
            let access = accessor(access);
            Reached::Value(quote!(#name #access))
        };
        let factor = |k: usize| &self.model.factors[k].accessor;
        match role {
            Role::Parameter(leaf) => Reached::Value(self.parameter(leaf, quote!())),
            Role::Configuration(i) => leaf("q", &self.model.configurations[i].accessor),
            Role::Image(i) => leaf("next", &self.model.configurations[i].accessor),
            Role::Input(i) => leaf("u", &self.model.inputs[i].accessor),
            Role::Covector(i) => leaf("p", &self.model.configurations[i].accessor),
            Role::Element(k) => leaf("f", factor(k)),
            Role::Increment(k) => leaf("d", factor(k)),
            Role::Following(k) => leaf("second", factor(k)),
            Role::MomentumMatrix(k) => leaf("m", factor(k)),
            Role::Momentum(k) => self.part(self.momentum, &self.momenta, self.model.offset(k), shape),
            Role::Chart(block) => self.part("x", &self.coordinates, self.blocks[block], shape),
            Role::Algebra(k) | Role::Logarithm(k) | Role::Cayley(k) => {
                self.part("x", &self.coordinates, self.model.offset(k), shape)
            }
            Role::InertiaInverse => {
                let constants = &self.constants;
                Reached::Reference(quote!(#constants.inertia_inverse.matrix()))
            }
            Role::Direction(block) => self.part("delta", &self.coordinates, self.blocks[block], shape),
            // by construction: the other roles are numbers, or of systems that are written out
            _ => Reached::Value(quote!()),
        }
    }

    /// The part of a flat vector, which holds some of all components, that begins with one of them.
    fn part(&self, vector: &str, held: &[usize], first: usize, shape: Shape) -> Reached {
        let private = &self.paths.private;
        let name = format_ident!("{vector}");
        if held.iter().copied().eq(first..first + shape.rows) {
            return Reached::Reference(quote!(#name));
        }
        // by construction: kernels read what their vectors hold
        let of = |component: usize| held.iter().position(|&other| other == component).unwrap_or(0);
        let positions: Vec<usize> = (first..first + shape.rows).map(of).collect();
        let start = positions.first().copied().unwrap_or(0);
        if positions.iter().copied().eq(start..start + shape.rows) {
            return Reached::Value(self.block(&quote!(#name), shape, (start, 0)));
        }
        let entries = positions.into_iter().map(Literal::usize_unsuffixed);
        Reached::Value(quote!(#private::vector([#(#name[#entries]),*])))
    }

    /// The block of a matrix, given by reference, from a place on.
    fn block(&self, matrix: &TokenStream, shape: Shape, (i, j): (usize, usize)) -> TokenStream {
        let private = &self.paths.private;
        let [rows, columns, i, j] = [shape.rows, shape.columns, i, j].map(Literal::usize_unsuffixed);
        quote!(#private::Blocks::block::<#rows, #columns>(#matrix, #i, #j))
    }

    /// The value of an opaque potential, or its gradient.
    fn opaque(&self, callee: &Callee, operands: &[Code]) -> TokenStream {
        let (method, system) = (self.method(callee), &self.system);
        let timed = self.opaque.is_some_and(|opaque| opaque.takes_time);
        let time = timed.then(|| self.code(&operands[0], false)).map(|time| quote!(#time,));
        let leaves = &operands[usize::from(timed)..];
        let configuration = match &self.model.configuration {
            Layout::Leaf(leaf) => self.by_reference(&leaves[*leaf]),
            several => {
                let configuration = nested(several, &mut |leaf| self.code(&leaves[leaf], false));
                quote!(&#configuration)
            }
        };
        quote!(#method(#system, #time #configuration))
    }

    fn opaque_gradient(&self, argument: usize, operands: &[Code]) -> TokenStream {
        let timed = self.opaque.is_some_and(|opaque| opaque.takes_time);
        let gradient = self.opaque(&Callee::Gradient(String::new()), operands);
        let access = accessor(&self.model.configurations[argument - usize::from(timed)].accessor);
        quote!(#gradient #access)
    }
}

/// How much an expression binds, as Rust reads it.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

impl Binding {
    fn of(code: &Code) -> Binding {
        let Code::Whole(whole) = code else { return Binding::Atom };
        match &whole.operation {
            MatrixOperation::Sum(weights) if weights.len() > 1 || weights.iter().any(Rational::is_negative) => {
                Binding::Sum
            }
            MatrixOperation::Sum(_) | MatrixOperation::Scaled | MatrixOperation::Product => Binding::Product,
            _ => Binding::Atom,
        }
    }
}

/// How a matrix among the arguments is reached.
enum Reached {
    /// By a reference of this name.
    Reference(TokenStream),
    /// By value.
    Value(TokenStream),
}

/// The matrix of a linear map: columns of the values of a kernel at the unit vectors of `argument`; terms that do not depend on it stand
/// before.
pub(super) fn matrix_of(
    scope: &Scope<'_, '_>,
    kernel: &Kernel,
    output: usize,
    argument: &str,
    is_argument: impl Fn(Role) -> bool,
) -> (TokenStream, TokenStream) {
    let (private, depends, needed) = (&scope.paths.private, kernel.depends_on(is_argument), kernel.needed_by(output));
    let (before, within) = (
        code::locals_where(scope, kernel, |k| !depends[k]),
        code::locals_where(scope, kernel, |k| depends[k] && needed[k]),
    );
    let (shape, entries) = &kernel.outputs[output];
    let value = code::grid(scope, *shape, entries, false);
    let (argument, vector) = (format_ident!("{argument}"), scope.paths.matrix(scope.coordinates.len(), 1));
    (before, quote!(#private::matrix_of(|#argument: &#vector| { #within #value })))
}
