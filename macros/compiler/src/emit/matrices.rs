//! Tokens of operations on matrices: nalgebra's, and calls of the runtime for those that nalgebra does not have.

use clebsch_symbolic::{IntoList, Operation, Rational, Role, Shape, integer};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::block::matrix;
use super::scope::{Place, Scope, index, nested, size};
use crate::lower::{Callee, Code, Kernel, MatrixOperation, Whole};
use crate::model::Layout;

impl Scope<'_, '_> {
    /// An operation on matrices.
    pub(super) fn whole(&self, whole: &Whole) -> TokenStream {
        let Whole { operation, operands, shape, .. } = whole;
        let matrix = || matrix(shape.rows, shape.columns);
        let reference = |position: usize| self.by_reference(&operands[position]);
        let call = |name: &str| {
            let (name, operands) = (format_ident!("{name}"), operands.iter().map(|operand| self.by_reference(operand)));
            quote!(runtime::#name(#(#operands),*))
        };
        // operands are names: each operation is a statement
        let method = |name: &str| {
            let (name, receiver) = (format_ident!("{name}"), self.operand(&operands[0], Binding::Atom));
            let others = operands[1..].iter().map(|operand| self.by_reference(operand));
            quote!(#receiver.#name(#(#others),*))
        };
        match operation {
            MatrixOperation::Argument(input) => match self.reached(input.role, *shape) {
                Reached::Reference(name) => quote!(*#name),
                Reached::Value(value) => value,
            },
            MatrixOperation::Zero => {
                let matrix = matrix();
                quote!(<#matrix as runtime::Space<T>>::origin())
            }
            MatrixOperation::Entries => self.grid(&(*shape, operands.clone()), false),
            MatrixOperation::Sum(weights) => self.weighted_sum(weights, operands),
            MatrixOperation::Scaled => {
                let (matrix, number) = (self.operand(&operands[0], Binding::Product), self.code(&operands[1], true));
                quote!(#matrix * #number)
            }
            MatrixOperation::Shifted => {
                let (matrix, number) = (reference(0), self.code(&operands[1], false));
                quote!(runtime::shifted(#matrix, #number))
            }
            MatrixOperation::Product => {
                let (a, b) = (self.factor(&operands[0], Binding::Product), self.factor(&operands[1], Binding::Atom));
                quote!(#a * #b)
            }
            MatrixOperation::InertiaTimes => {
                let (constants, vector) = (&self.constants, reference(0));
                quote!(#constants.inertia_inverse.times(#vector))
            }
            MatrixOperation::Of(Operation::Transpose) => method("transpose"),
            MatrixOperation::Of(Operation::Inverse) => call("inverse"),
            MatrixOperation::Of(Operation::Analytic(function)) => call(&Callee::Analytic(*function).to_string()),
            MatrixOperation::Value => self.opaque(false, operands),
            MatrixOperation::Gradient(argument) => {
                let gradient = self.opaque(true, operands);
                let access = &self.model.configurations[argument - usize::from(self.takes_time())].accessor;
                quote!(#gradient #access)
            }
            MatrixOperation::Of(Operation::Block(i, j)) => self.block(&reference(0), *shape, (*i, *j)),
            MatrixOperation::Of(Operation::Embed(i, j)) => {
                let (matrix, i, j) = (reference(0), size(*i), size(*j));
                quote!(runtime::embedded(#matrix, #i, #j))
            }
            MatrixOperation::Hadamard => method("component_mul"),
            MatrixOperation::Of(Operation::DiagonalMatrix) => {
                let (matrix, diagonal) = (matrix(), reference(0));
                quote!(<#matrix>::from_diagonal(#diagonal))
            }
            MatrixOperation::Of(Operation::Diagonal) => method("diagonal"),
            MatrixOperation::Hat => call("hat"),
            MatrixOperation::Axial => call("axial"),
            MatrixOperation::Skew => call("skew"),
            MatrixOperation::SkewComponents => call("skew_components"),
            MatrixOperation::SkewTimes => call("skew_times"),
            MatrixOperation::SkewOuter => call("skew_outer"),
            MatrixOperation::Pairing => method("dot"),
            MatrixOperation::Trace => method("trace"),
            MatrixOperation::Of(Operation::Determinant) => call("determinant"),
            MatrixOperation::Largest => {
                let matrix = reference(0);
                quote!(runtime::Space::<T>::max_abs(#matrix))
            }
            MatrixOperation::Entry(i, j) => {
                let is_column = matches!(&operands[0], Code::Whole(whole) if whole.shape.is_column());
                let (matrix, index) = (self.operand(&operands[0], Binding::Atom), index(is_column, (*i, *j)));
                quote!(#matrix #index)
            }
            // by construction: bases have operations of their own, and functions are of numbers
            MatrixOperation::Of(_) => TokenStream::new(),
        }
    }

    /// The type of a shared term, unless the called function says it.
    pub(super) fn type_of(&self, code: &Code) -> Option<TokenStream> {
        let Code::Whole(whole) = code else { return None };
        let matrix = matrix(whole.shape.rows, whole.shape.columns);
        code.needs_name().then(|| quote!(: #matrix))
    }

    /// A matrix as an argument of a function.
    fn by_reference(&self, operand: &Code) -> TokenStream {
        if let Some(Reached::Reference(name)) = self.argument(operand) {
            return name;
        }
        let value = self.operand(operand, Binding::Atom);
        quote!(&#value)
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

    /// A matrix that is added, multiplied by a number or asked for more, in brackets unless it binds as much as is needed.
    fn operand(&self, operand: &Code, least: Binding) -> TokenStream {
        if let Some(Reached::Reference(tokens) | Reached::Value(tokens)) = self.argument(operand) {
            return tokens;
        }
        let value = self.code(operand, true);
        if Binding::of(operand) < least { quote!((#value)) } else { value }
    }

    /// A matrix among the arguments of a function.
    fn argument(&self, operand: &Code) -> Option<Reached> {
        let Code::Whole(whole) = operand else { return None };
        let MatrixOperation::Argument(input) = &whole.operation else { return None };
        Some(self.reached(input.role, whole.shape))
    }

    /// Σ c_i A_i.
    fn weighted_sum(&self, weights: &[Rational], operands: &[Code]) -> TokenStream {
        let mut tokens = TokenStream::new();
        for (position, (weight, operand)) in weights.iter().zip(operands).enumerate() {
            let leads_negative = position == 0 && weight.is_negative();
            let mut term = self.operand(operand, if leads_negative { Binding::Atom } else { Binding::Product });
            if weight.abs() != integer(1) {
                let size = self.number(&weight.abs());
                term = quote!(#term * #size);
            }
            tokens = match (position, weight.is_negative()) {
                (0, false) => term,
                (_, true) => quote!(#tokens - #term),
                (_, false) => quote!(#tokens + #term),
            };
        }
        tokens
    }

    /// How a matrix among the arguments of a function is reached.
    fn reached(&self, role: Role, shape: Shape) -> Reached {
        match (role, self.place(role)) {
            (_, Some(Place::Leaf(name, access))) => {
                let name = format_ident!("{name}");
                if access.is_whole() {
                    Reached::Reference(quote!(#name))
                } else {
                    Reached::Value(quote!(#name #access))
                }
            }
            (_, Some(Place::Vector(name, held, first))) => self.part(name, held, first, shape),
            (Role::Parameter(leaf), _) => Reached::Value(self.parameter(leaf, quote!())),
            (Role::InertiaInverse, _) => {
                let constants = &self.constants;
                Reached::Reference(quote!(#constants.inertia_inverse.matrix()))
            }
            // by construction: the other roles are numbers, or belong to unrolled systems
            _ => Reached::Value(quote!()),
        }
    }

    /// The part of a flat vector, which holds some of all components, that begins with one of them.
    fn part(&self, vector: &str, held: &[usize], first: usize, shape: Shape) -> Reached {
        let name = format_ident!("{vector}");
        if held.iter().copied().eq(first..first + shape.rows) {
            return Reached::Reference(quote!(#name));
        }
        // by construction: kernels read entries that their vectors have
        let of = |component: usize| held.iter().position(|&other| other == component).unwrap_or(0);
        let positions: Vec<usize> = (first..first + shape.rows).map(of).into_list();
        let start = positions.first().copied().unwrap_or(0);
        if positions.iter().copied().eq(start..start + shape.rows) {
            return Reached::Value(self.block(&quote!(#name), shape, (start, 0)));
        }
        let entries = positions.into_iter().map(size);
        Reached::Value(quote!(runtime::vector([#(#name[#entries]),*])))
    }

    /// The block of a matrix, given by reference, from a place on.
    fn block(&self, matrix: &TokenStream, shape: Shape, (i, j): (usize, usize)) -> TokenStream {
        let [rows, columns, i, j] = [shape.rows, shape.columns, i, j].map(size);
        quote!(runtime::Blocks::block::<#rows, #columns>(#matrix, #i, #j))
    }

    /// The value of an opaque potential, or its gradient.
    fn opaque(&self, is_gradient: bool, operands: &[Code]) -> TokenStream {
        let leaves = &operands[usize::from(self.takes_time())..];
        let configuration = match &self.model.configuration {
            Layout::Leaf(leaf) => self.by_reference(&leaves[*leaf]),
            several => {
                let configuration = nested(several, &mut |leaf| self.code(&leaves[leaf], false));
                quote!(&#configuration)
            }
        };
        self.call_of_method(is_gradient, &operands[0], configuration)
    }

    /// The matrix of a linear map: columns of the values of a kernel at the unit vectors of `argument`. Terms that do
    /// not depend on it come first.
    pub(super) fn matrix_of(
        &self,
        kernel: &Kernel,
        output: usize,
        argument: &str,
        is_argument: impl Fn(Role) -> bool,
    ) -> (TokenStream, TokenStream) {
        let argument = format_ident!("{argument}");
        let (depends, needed) = (kernel.depends_on(is_argument), kernel.needed_by(output));
        let within = self.locals_where(kernel, |k| depends[k] && needed[k]);
        let (value, vector) = (self.output(kernel, output), matrix(self.coordinates.len(), 1));
        let matrix = quote!(runtime::matrix_of(|#argument: &#vector| { #within #value }));
        (self.locals_where(kernel, |k| !depends[k]), matrix)
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
