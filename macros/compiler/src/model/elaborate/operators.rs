//! The operators `+ - * / %`, unary minus, and the shapes that they need.

use clebsch_symbolic::{Expr, Group, Rational, integer};
use syn::{BinOp, Expr as Syntax, ExprBinary, ExprUnary, UnOp};

use super::super::value::Value;
use super::mismatch::{no_product, point_moved, unequal_shapes};
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

/// The operators of closures.
#[derive(Copy, Clone, PartialEq, Eq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
}

impl Operator {
    fn of(operator: &BinOp) -> Option<Operator> {
        match operator {
            BinOp::Add(_) => Some(Operator::Add),
            BinOp::Sub(_) => Some(Operator::Subtract),
            BinOp::Mul(_) => Some(Operator::Multiply),
            BinOp::Div(_) => Some(Operator::Divide),
            BinOp::Rem(_) => Some(Operator::Remainder),
            _ => None,
        }
    }

    /// What it does, for messages.
    pub(super) fn verb(self) -> &'static str {
        match self {
            Operator::Add => "added",
            Operator::Subtract => "subtracted",
            Operator::Multiply => "multiplied",
            Operator::Divide => "divided",
            Operator::Remainder => "divided with remainder",
        }
    }
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// A chain of binary operators. Chains may be long, so their left side is followed in a loop.
    pub(super) fn binary(&mut self, binary: &ExprBinary) -> Option<Value<'g>> {
        let mut chain = vec![binary];
        while let Syntax::Binary(left) = &*chain[chain.len() - 1].left {
            chain.push(left);
        }
        let first = &chain[chain.len() - 1].left;
        let mut value = self.elaborate(first);
        for link in chain.into_iter().rev() {
            let right = self.elaborate(&link.right);
            value = match Operator::of(&link.op) {
                Some(operator) => value.zip(right).and_then(|(left, right)| self.apply(operator, link, left, right)),
                None => self.refused_operator(&link.op),
            };
        }
        value
    }

    fn refused_operator(&mut self, operator: &BinOp) -> Option<Value<'g>> {
        let text = crate::parse::spell_tokens(operator);
        let error = Diagnostic::new(
            Location::of(operator),
            format!("the operator `{}` has no meaning in the {}", text.trim(), self.key),
        );
        self.error(match operator {
            BinOp::Eq(_) | BinOp::Le(_) | BinOp::Ge(_) | BinOp::Lt(_) | BinOp::Gt(_) | BinOp::Ne(_) => {
                error.note("an equation or an inequality stands only where a key asks for one")
            }
            BinOp::BitXor(_) => error.help("write `x.powi(2)` for a power, `a.cross(&b)` for a cross product"),
            _ => error.note("the operators are `+`, `-`, `*`, `/`, and `%` on indices"),
        })
    }

    fn apply(&mut self, operator: Operator, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        match (operator, left, right) {
            (Operator::Remainder, Value::Matrix(left), Value::Matrix(right)) if self.is_number_of_sites(right) => {
                Some(Value::Wrapped(left))
            }
            (_, left @ Value::Sum(_), right) | (_, left, right @ Value::Sum(_)) => {
                self.sums(operator, link, left, right)
            }
            (_, left @ (Value::PerSite(_) | Value::Range(..) | Value::Wrapped(_) | Value::Sequence(..)), _) => {
                self.no_matrix(operator, &link.left, &left)
            }
            (_, _, right @ (Value::PerSite(_) | Value::Range(..) | Value::Wrapped(_) | Value::Sequence(..))) => {
                self.no_matrix(operator, &link.right, &right)
            }
            (_, left @ (Value::Tuple(_) | Value::Array(_)), _) => self.no_matrix(operator, &link.left, &left),
            (_, _, right @ (Value::Tuple(_) | Value::Array(_))) => self.no_matrix(operator, &link.right, &right),
            (_, left @ Value::Quaternion(_), right) | (_, left, right @ Value::Quaternion(_)) => {
                self.quaternions(operator, link, left, right)
            }
            (Operator::Add, left, right) => self.sum(link, left, right, false),
            (Operator::Subtract, left, right) => self.sum(link, left, right, true),
            (Operator::Multiply, left, right) => self.product(link, left, right),
            (Operator::Divide, left, right) => self.quotient(link, left, right),
            (Operator::Remainder, left, right) => self.remainder(link, left, right),
        }
    }

    fn no_matrix(&mut self, operator: Operator, syntax: &Syntax, value: &Value<'g>) -> Option<Value<'g>> {
        let text = spell(syntax);
        let message = format!("`{text}` is {} and cannot be {}", value.describe(), operator.verb());
        let help = format!("take its parts, as in `{text}{}`", super::first_part(value));
        self.error(Diagnostic::new(Location::of(syntax), message).help(help))
    }

    fn sum(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>, minus: bool) -> Option<Value<'g>> {
        let at = link;
        let combine = |a: Expr<'g>, b: Expr<'g>| if minus { a - b } else { a + b };
        let (left, right) = match (left, right) {
            (Value::Identity(a), Value::Identity(b)) => {
                return self.build(at, &[a, b], Growth::Sum, || combine(a, b)).map(Value::Identity);
            }
            (Value::Identity(scale), Value::Matrix(matrix)) => (self.fitted(&link.right, scale, matrix)?, matrix),
            (Value::Matrix(matrix), Value::Identity(scale)) => (matrix, self.fitted(&link.left, scale, matrix)?),
            (Value::Matrix(left), Value::Matrix(right)) => (left, right),
            // by construction: quaternions, tuples and arrays have been dealt with
            _ => return None,
        };
        if left.shape() != right.shape() {
            return self.error(unequal_shapes(link, left, right, minus));
        }
        self.build(at, &[left, right], Growth::Sum, || combine(left, right)).map(Value::Matrix)
    }

    /// The identity that fits a matrix, times a scalar.
    fn fitted(&mut self, other: &Syntax, scale: Expr<'g>, matrix: Expr<'g>) -> Option<Expr<'g>> {
        let shape = matrix.shape();
        if shape.is_square() && !shape.is_scalar() {
            return Some(scale * self.graph().identity(shape.rows));
        }
        // an element of GL(1) is 1×1, and so is its identity
        if self.group_of(matrix).is_some() && shape.is_scalar() {
            return Some(scale);
        }
        let text = spell(other);
        let error = match shape.is_scalar() {
            true => {
                Diagnostic::new(Location::of(other), format!("`I` is an identity matrix, but `{text}` is a scalar"))
                    .help("write `1` for the number, or multiply the scalar by `I`")
            }
            false => Diagnostic::new(
                Location::of(other),
                format!("`I` is square, but `{text}` is {shape}: they cannot be added"),
            )
            .help("leave `I` out")
            .note("the identity of a group of translations is the zero vector"),
        };
        self.error(error)
    }

    fn product(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let at = link;
        let (left, right) = match (left, right) {
            (Value::Identity(a), Value::Identity(b)) => {
                return self.build(at, &[a, b], Growth::Sum, || a * b).map(Value::Identity);
            }
            (Value::Identity(scale), Value::Matrix(other)) | (Value::Matrix(other), Value::Identity(scale)) => {
                let product = self.build(at, &[scale, other], Growth::Sum, || scale * other)?;
                return Some(if other.shape().is_scalar() { Value::Identity(product) } else { Value::Matrix(product) });
            }
            (Value::Matrix(left), Value::Matrix(right)) => (left, right),
            // by construction: quaternions, tuples and arrays have been dealt with
            _ => return None,
        };
        let scales = left.shape().is_scalar() || right.shape().is_scalar();
        if !scales && left.shape().columns != right.shape().rows {
            let affine = self.group_of(left).and_then(Group::linear_part);
            return self.error(match affine == Some(right.shape().rows) && right.shape().is_column() {
                true => point_moved(link, left, right),
                false => no_product(link, left, right),
            });
        }
        let product = self.build(at, &[left, right], Growth::Product, || left * right)?;
        self.note_product(left, right, product);
        Some(Value::Matrix(product))
    }

    fn quotient(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let at = link;
        let divisor = self.as_matrix(&link.right, right)?;
        if !divisor.shape().is_scalar() {
            let text = spell(&link.right);
            let message = format!("`{text}` is {}: only scalars divide", divisor.shape());
            let error = Diagnostic::new(Location::of(&link.right), message);
            let help =
                divisor.shape().is_square().then(|| format!("multiply by `{}.inverse()`", parenthesized(&link.right)));
            return self.error(match help {
                Some(help) => error.help(help),
                None => error.note("a quotient is a product with a reciprocal, which only scalars have"),
            });
        }
        if divisor.is_zero() {
            let message = format!("`{}` is zero: nothing can be divided by it", spell(&link.right));
            return self.error(Diagnostic::new(Location::of(&link.right), message).note("it simplifies to 0"));
        }
        match left {
            Value::Identity(scale) => {
                self.build(at, &[scale, divisor], Growth::Sum, || scale / divisor).map(Value::Identity)
            }
            Value::Matrix(left) => {
                self.build(at, &[left, divisor], Growth::Product, || left / divisor).map(Value::Matrix)
            }
            // by construction: quaternions, tuples and arrays have been dealt with
            _ => None,
        }
    }

    /// `%` is for indices, so both sides are whole numbers.
    fn remainder(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let whole = |value: Value<'g>| value.matrix()?.as_number().filter(Rational::is_integer);
        match (whole(left), whole(right)) {
            (Some(left), Some(right)) if right > integer(0) => {
                let floor = (&left / &right).floor();
                Some(Value::Matrix(self.graph().number(left - floor * right)))
            }
            _ => {
                let error = Diagnostic::new(
                    Location::of(link),
                    format!("`{}` is no remainder of whole numbers", spell_link(link)),
                );
                self.error(error.note("`%` is for indices, as in `q[(i + 1) % 4]`"))
            }
        }
    }

    /// Unary minus.
    pub(super) fn unary(&mut self, unary: &ExprUnary) -> Option<Value<'g>> {
        match unary.op {
            UnOp::Neg(_) => match self.elaborate(&unary.expr)? {
                Value::Identity(scale) => Some(Value::Identity(-scale)),
                Value::Quaternion(q) => self.build(unary, &[q], Growth::Sum, || -q).map(Value::Quaternion),
                Value::Sum(terms) => Some(Value::Sum(super::sites::scaled(terms, self.graph().integer(-1)))),
                value => {
                    let matrix = self.as_matrix(&unary.expr, value)?;
                    self.build(unary, &[matrix], Growth::Sum, || -matrix).map(Value::Matrix)
                }
            },
            UnOp::Deref(_) => {
                let error = Diagnostic::new(Location::of(&unary.op), "there is nothing to dereference");
                self.error(error.help(format!("write `{}`", spell(&unary.expr))).note("every value is copied"))
            }
            _ => {
                let error = Diagnostic::new(
                    Location::of(&unary.op),
                    format!("this operator has no meaning in the {}", self.key),
                );
                self.error(error.note("the only sign is `-`"))
            }
        }
    }
}

fn spell_link(link: &ExprBinary) -> String {
    spell(&Syntax::Binary(link.clone()))
}

/// The text of an operand, in parentheses where a method needs them.
pub(super) fn parenthesized(syntax: &Syntax) -> String {
    match syntax {
        Syntax::Binary(_) | Syntax::Unary(_) | Syntax::Reference(_) | Syntax::Range(_) => {
            format!("({})", spell(syntax))
        }
        _ => spell(syntax),
    }
}
