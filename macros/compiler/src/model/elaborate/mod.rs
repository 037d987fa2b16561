//! From the syntax of a closure's body to matrix expressions: one function for each construct, shapes checked on the way.

mod access;
mod block;
mod constructors;
mod element;
mod errors;
mod markdown;
mod methods;
mod names;
mod operators;
mod parts;
mod powers;
mod quaternions;
mod sequences;
mod sites;
mod tables;
#[cfg(test)]
mod tests;

use clebsch_symbolic::{Elements, Expr, Graph, Group, Shape, Table};
use quote::ToTokens;
use syn::{Expr as Syntax, Generics};

pub(crate) use markdown::functions_as_markdown;

use super::fields::Fields;
use super::scope::Scope;
use super::sites::Sites;
use super::value::Value;
use super::{Constant, Written};
use crate::diagnostic::{Diagnostic, Diagnostics, error, refuse};
use crate::parse::{Closure, parenthesized, shortened, spell};
pub(super) use names::reserved;

/// Operators and methods inside each other.
const DEPTH: usize = 200;
/// The most expressions of one closure, with ranges expanded.
const WORK: usize = 100_000;
/// The weight of one expression: factors, terms and digits together.
const WEIGHT: u64 = 1 << 14;
/// Functions of functions, products of sums of products.
const NESTING: u32 = 512;

/// A term max(a, 0) of a price.
pub(super) struct Kink<'g> {
    /// The symbol that stands for it.
    pub symbol: Expr<'g>,
    /// a.
    pub value: Expr<'g>,
    pub written: Written,
}

/// The data that the elaboration of all closures shares.
pub(super) struct Context<'c, 'g> {
    pub graph: &'g Graph,
    pub fields: &'c Fields<'g>,
    /// The generics of the struct.
    pub generics: &'c Generics,
    pub constants: Vec<Constant<'g>>,
    /// The sites of a power; `None` where the declaration is none.
    pub power: Option<Sites<'g>>,
    /// The kinks of a price, where one is read.
    pub kinks: Option<Vec<Kink<'g>>>,
    /// The squares in the potential, each with the number or vector that is squared.
    pub squares: Vec<(Written, Expr<'g>)>,
    pub diagnostics: &'c Diagnostics,
}

impl<'c, 'g> Context<'c, 'g> {
    pub fn new(
        graph: &'g Graph,
        fields: &'c Fields<'g>,
        generics: &'c Generics,
        power: Option<Sites<'g>>,
        diagnostics: &'c Diagnostics,
    ) -> Self {
        Context { graph, fields, generics, constants: Vec::new(), power, squares: Vec::new(), kinks: None, diagnostics }
    }

    /// The value of a closure with these names; `None` if it has an error, which was reported.
    pub fn value(&mut self, closure: &Closure, scope: Scope<'g>) -> Option<Value<'g>> {
        Elaborator::new(self, &closure.key.to_string(), scope).elaborate(&closure.body)
    }
}

/// Elaborates the body of one closure.
pub(super) struct Elaborator<'e, 'c, 'g> {
    pub context: &'e mut Context<'c, 'g>,
    /// The key of the closure, `potential`.
    pub key: &'e str,
    scope: Scope<'g>,
    /// Expressions whose values lie on a group.
    members: Table<Expr<'g>, Group>,
    sizes: Table<Expr<'g>, Size>,
    depth: usize,
    work: usize,
}

/// How large an expression may have become at most.
#[derive(Copy, Clone)]
struct Size {
    weight: u64,
    nesting: u32,
}

/// How an operation makes expressions grow.
#[derive(Copy, Clone)]
enum Growth {
    /// By its operands together.
    Sum,
    /// As a sum, one level deeper.
    Product,
    /// Every term meets every other.
    Pairs,
    /// A power, with the sizes of its numerator and denominator.
    Power(u64),
}

impl<'e, 'c, 'g> Elaborator<'e, 'c, 'g> {
    /// An elaborator for the closure of a key, with the names that its arguments introduce.
    pub fn new(context: &'e mut Context<'c, 'g>, key: &'e str, scope: Scope<'g>) -> Elaborator<'e, 'c, 'g> {
        let mut members = Table::default();
        scope.elements.iter().for_each(|(element, group)| members.insert(*element, *group));
        Elaborator { context, key, scope, members, sizes: Table::default(), depth: 0, work: 0 }
    }

    /// The matrix that an argument stands for.
    pub fn named(&self, name: &str) -> Option<Expr<'g>> {
        self.scope.value(name)?.as_ref()?.matrix()
    }

    /// The group on which an expression is known to lie.
    fn group_of(&self, expr: Expr<'g>) -> Option<Group> {
        self.members.get(&expr).copied()
    }

    /// The product of two elements of a group is one.
    fn note_product(&mut self, left: Expr<'g>, right: Expr<'g>, product: Expr<'g>) {
        if let Some(group) = self.group_of(left).filter(|group| self.group_of(right) == Some(*group)) {
            self.members.insert(product, group);
        }
    }

    fn graph(&self) -> &'g Graph {
        self.context.graph
    }

    /// Reports an error; the expression then has no value.
    fn refuse<T>(&mut self, diagnostic: Diagnostic) -> Option<T> {
        self.context.diagnostics.push(diagnostic);
        None
    }

    /// The potential need not be a formula: the way out where one is hard to write.
    fn opaque(&self) -> Option<&'static str> {
        let is_free = self.key == "potential" && self.context.power.is_none();
        is_free.then_some("or give two methods of the struct, `potential = opaque(Self::value, Self::gradient)`")
    }

    /// The value of an expression; `None` if it has an error, which is then reported.
    pub fn elaborate(&mut self, syntax: &Syntax) -> Option<Value<'g>> {
        self.work += 1;
        if self.work == WORK + 1 {
            refuse!(self, syntax, "the {} has more than {WORK} operations", self.key;
                note "ranges are expanded at compile time");
        }
        if self.work > WORK {
            // one message is enough
            return None;
        }
        if self.depth == DEPTH {
            refuse!(self, syntax, "more than {DEPTH} operations inside each other"; help "give names to parts with `let`");
        }
        self.depth += 1;
        let value = self.dispatch(syntax);
        self.depth -= 1;
        value
    }

    fn dispatch(&mut self, syntax: &Syntax) -> Option<Value<'g>> {
        match syntax {
            Syntax::Array(array) => self.array(array),
            Syntax::Binary(binary) => self.binary(binary),
            Syntax::Block(block) if block.label.is_none() => self.with_names(|this| this.statements(&block.block)),
            Syntax::Call(call) => self.call(call),
            Syntax::Field(field) => self.field(field),
            Syntax::Group(group) => self.elaborate(&group.expr),
            Syntax::Index(index) => self.index(index),
            Syntax::Lit(literal) => self.literal(literal),
            Syntax::Macro(written) => self.macro_call(&written.mac),
            Syntax::MethodCall(call) => self.method_call(call),
            Syntax::Paren(inner) => self.elaborate(&inner.expr),
            Syntax::Path(path) => self.path(path),
            Syntax::Range(range) => self.range(range),
            Syntax::Reference(reference) if reference.mutability.is_none() => self.elaborate(&reference.expr),
            Syntax::Repeat(repeat) => self.repeat(repeat),
            Syntax::Tuple(tuple) => self.all(&tuple.elems).map(Value::Tuple),
            Syntax::Unary(unary) => self.unary(unary),
            other => self.refused(other),
        }
    }

    fn matrix(&mut self, syntax: &Syntax) -> Option<Expr<'g>> {
        let value = self.elaborate(syntax)?;
        self.as_matrix(syntax, value)
    }

    fn as_matrix(&mut self, syntax: &Syntax, value: Value<'g>) -> Option<Expr<'g>> {
        match value {
            Value::Matrix(expr) => Some(expr),
            Value::Identity(_) => self.refuse(open_identity(syntax)),
            Value::Sum(_) => self.refuse(open_sum(syntax)),
            other => {
                let (text, is) = (spell(syntax), other.describe());
                refuse!(self, syntax, "`{text}` is {is}, not a matrix or a scalar";
                    help "take a part of it, as in `{text}{}`", first_part(&other))
            }
        }
    }

    /// The value as a matrix of this shape, which an open identity takes.
    fn shaped(&mut self, syntax: &Syntax, shape: Shape) -> Option<Expr<'g>> {
        match self.elaborate(syntax)? {
            Value::Identity(scale) if shape.is_square() => {
                let identity = self.graph().identity(shape.rows);
                self.grow(syntax, &[scale, identity], Growth::Sum, || scale * identity)
            }
            value => self.as_matrix(syntax, value),
        }
    }

    fn scalar(&mut self, syntax: &Syntax) -> Option<Expr<'g>> {
        let expr = self.matrix(syntax)?;
        if !expr.shape().is_scalar() {
            let entry = if expr.shape().is_column() { "[0]" } else { "[(0, 0)]" };
            refuse!(self, syntax, "`{}` is {}, where a scalar is needed", spell(syntax), expr.shape();
                help "take an entry, as in `{}{entry}`", parenthesized(syntax));
        }
        Some(expr)
    }

    fn size(&self, expr: Expr<'g>) -> Size {
        let weight = || 1 + expr.as_number().map_or(0, |number| number.bits() as u64 / 16);
        self.sizes.get(&expr).copied().unwrap_or_else(|| Size { weight: weight(), nesting: 0 })
    }

    /// Makes a matrix, unless it would become too large to work with.
    fn build(
        &mut self,
        at: &dyn ToTokens,
        operands: &[Expr<'g>],
        growth: Growth,
        make: impl FnOnce() -> Expr<'g>,
    ) -> Option<Value<'g>> {
        self.grow(at, operands, growth, make).map(Value::Matrix)
    }

    /// Makes an expression, unless it would become too large to work with.
    fn grow(
        &mut self,
        at: &dyn ToTokens,
        operands: &[Expr<'g>],
        growth: Growth,
        make: impl FnOnce() -> Expr<'g>,
    ) -> Option<Expr<'g>> {
        let size = self.grown(at, operands, growth)?;
        let expr = make();
        // a number is as large as its digits, however it was made
        if expr.as_number().is_none() {
            self.sizes.insert(expr, size);
        }
        Some(expr)
    }

    /// The size of the result of some operands, unless it is too large.
    fn grown(&mut self, at: &dyn ToTokens, operands: &[Expr<'g>], growth: Growth) -> Option<Size> {
        let sizes: Vec<Size> = operands.each(|&operand| self.size(operand));
        let nesting = sizes.iter().map(|size| size.nesting).max().unwrap_or(0);
        let weights = sizes.iter().map(|size| size.weight);
        let sum = weights.clone().fold(0, u64::saturating_add);
        let size = match growth {
            Growth::Sum => Size { weight: sum, nesting },
            Growth::Product => Size { weight: sum, nesting: nesting + 1 },
            Growth::Pairs => Size { weight: weights.fold(1, u64::saturating_mul), nesting: nesting + 1 },
            Growth::Power(exponent) => Size { weight: sum.saturating_mul(exponent.max(1)), nesting: nesting + 1 },
        };
        if size.weight > WEIGHT || size.nesting > NESTING {
            refuse!(self, at, "this expression grows too large";
                note "its expansion has more terms, factors or digits than a formula should have");
        }
        Some(size)
    }
}

/// The error for an `I` that meets nothing that has a size.
fn open_identity(syntax: &Syntax) -> Diagnostic {
    error!(syntax, "the size of `I` is not known here";
        help "write `Matrix3::identity()`";
        note "`I` takes its size from the other side of `+`, `-` or `*`")
}

/// The error for a sum over sites within another function.
fn open_sum(syntax: &Syntax) -> Diagnostic {
    error!(syntax, "`{}` is a sum over sites: it can be added and scaled alone", shortened(syntax);
        note "each term is differentiated once, for all sites, and a function of the sum would tie all of them to each other")
}

/// How a part of a tuple or an array is reached.
fn first_part(value: &Value) -> &'static str {
    match value {
        Value::PerSite(..) => "[i]",
        Value::Quaternion(_) => ".imag()",
        Value::Tuple(_) => ".0",
        _ => "[0]",
    }
}
