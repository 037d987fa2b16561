//! Quaternions in formulas: `Quaternion::new(w, i, j, k)`, `Q * v`, `Q * Q`, `Q.imag()`, `.w`.

use clebsch_symbolic::{Expr, Shape};
use syn::{ExprBinary, ExprCall, ExprField, ExprMethodCall, Ident};

use super::super::quaternion as algebra;
use super::super::value::Value;
use super::operators::{Operator, parenthesized};
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::parse::spell;

/// The methods of quaternions with their number of arguments.
#[rustfmt::skip]
const METHODS: [(&str, usize); 8] = [
    ("scalar", 0), ("imag", 0), ("conjugate", 0), ("inverse", 0), ("norm_squared", 0), ("norm", 0), ("normalize", 0), ("dot", 1),
];

/// Methods of matrices and of nalgebra's quaternions, and what to write instead.
#[rustfmt::skip]
const SYNONYMS: [(&str, &str); 9] = [
    ("transpose", "conjugate()"), ("adjoint", "conjugate()"), ("vector", "imag()"), ("as_vector", "imag()"), ("real", "scalar()"),
    ("w", "scalar()"), ("try_inverse", "inverse()"), ("magnitude", "norm()"), ("magnitude_squared", "norm_squared()"),
];

/// Whether only quaternions have a method of this name.
pub(super) fn is_of_quaternions(name: &str) -> bool {
    ["scalar", "imag", "conjugate"].contains(&name)
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// Whether a quaternion is known to have length one.
    fn is_unit_quaternion(&self, q: Expr<'g>) -> bool {
        self.group_of(q).is_some()
    }

    /// An operator of which at least one side is a quaternion.
    pub(super) fn quaternions(
        &mut self,
        operator: Operator,
        link: &ExprBinary,
        left: Value<'g>,
        right: Value<'g>,
    ) -> Option<Value<'g>> {
        let graph = self.graph();
        let fitted = |scale: Expr<'g>| algebra::real(graph, scale);
        let vector = |expr: Expr<'g>| expr.shape() == Shape::vector(3);
        match (operator, left, right) {
            (Operator::Add | Operator::Subtract, Value::Quaternion(a), Value::Quaternion(b)) => {
                self.quaternion_sum(operator, link, a, b)
            }
            (Operator::Add | Operator::Subtract, Value::Quaternion(a), Value::Identity(scale)) => {
                self.quaternion_sum(operator, link, a, fitted(scale))
            }
            (Operator::Add | Operator::Subtract, Value::Identity(scale), Value::Quaternion(b)) => {
                self.quaternion_sum(operator, link, fitted(scale), b)
            }
            (Operator::Multiply, Value::Quaternion(a), Value::Quaternion(b)) => self.quaternion_product(link, a, b),
            (Operator::Multiply, Value::Quaternion(a), Value::Identity(s))
            | (Operator::Multiply, Value::Identity(s), Value::Quaternion(a)) => self.scaled(link, a, s),
            (Operator::Multiply, Value::Quaternion(a), Value::Matrix(s))
            | (Operator::Multiply, Value::Matrix(s), Value::Quaternion(a))
                if s.shape().is_scalar() =>
            {
                self.scaled(link, a, s)
            }
            (Operator::Multiply, Value::Quaternion(a), Value::Matrix(v)) if vector(v) => {
                let turn = if self.is_unit_quaternion(a) { algebra::turn } else { algebra::turn_by_any };
                self.build(link, &[a, a, v], Growth::Pairs, || turn(a, v)).map(Value::Matrix)
            }
            (Operator::Divide, Value::Quaternion(a), Value::Matrix(s)) if s.shape().is_scalar() => {
                if s.is_zero() {
                    let message = format!("`{}` is zero: nothing can be divided by it", spell(&link.right));
                    return self.error(Diagnostic::new(Location::of(&link.right), message).note("it simplifies to 0"));
                }
                self.build(link, &[a, s], Growth::Product, || a / s).map(Value::Quaternion)
            }
            (operator, left, right) => self.error(misfit(operator, link, &left, &right)),
        }
    }

    fn quaternion_sum(&mut self, operator: Operator, link: &ExprBinary, a: Expr<'g>, b: Expr<'g>) -> Option<Value<'g>> {
        let combine = || if operator == Operator::Subtract { a - b } else { a + b };
        self.build(link, &[a, b], Growth::Sum, combine).map(Value::Quaternion)
    }

    fn quaternion_product(&mut self, link: &ExprBinary, a: Expr<'g>, b: Expr<'g>) -> Option<Value<'g>> {
        let product = self.build(link, &[a, b], Growth::Pairs, || algebra::product(a, b))?;
        self.note_product(a, b, product);
        Some(Value::Quaternion(product))
    }

    fn scaled(&mut self, link: &ExprBinary, a: Expr<'g>, scale: Expr<'g>) -> Option<Value<'g>> {
        self.build(link, &[a, scale], Growth::Sum, || scale * a).map(Value::Quaternion)
    }

    /// `Quaternion::new(w, i, j, k)`.
    pub(super) fn quaternion_constructor(&mut self, call: &ExprCall, method: &Ident) -> Option<Value<'g>> {
        if method == "identity" && call.args.is_empty() {
            return Some(Value::Quaternion(algebra::real(self.graph(), self.graph().integer(1))));
        }
        let new = "write `Quaternion::new(w, i, j, k)`, the scalar part first";
        if method != "new" {
            let error = Diagnostic::new(method.span(), format!("unknown constructor `{method}` of a quaternion"));
            return self.error(error.help(new));
        }
        if call.args.len() != algebra::COORDINATES {
            let message = format!("`Quaternion::new` has 4 coordinates, not {}", call.args.len());
            return self.error(Diagnostic::new(method.span(), message).help(new));
        }
        let found: Vec<Option<Expr<'g>>> = call.args.iter().map(|entry| self.scalar(entry)).collect();
        let mut coordinates: Vec<Expr<'g>> = found.into_iter().collect::<Option<_>>()?;
        coordinates.rotate_left(1);
        let stacked = self.stack(call, Shape::vector(algebra::COORDINATES), coordinates)?;
        stacked.matrix().map(Value::Quaternion)
    }

    /// `Q.w`.
    pub(super) fn coordinate(&mut self, field: &ExprField, q: Expr<'g>, name: &Ident) -> Option<Value<'g>> {
        if let Some(&(_, index)) = algebra::NAMES.iter().find(|(known, _)| name == known) {
            return self.build(field, &[q], Growth::Sum, || q.entry(index, 0)).map(Value::Matrix);
        }
        let base = spell(&field.base);
        let error = Diagnostic::new(name.span(), format!("the quaternion `{base}` has no coordinate `{name}`"));
        let position = ["x", "y", "z"].iter().position(|other| name == other);
        let help = position.map(|index| format!("write `.{}`", algebra::NAMES[index].0));
        self.error(error.maybe_help(help).note("its coordinates are `.i`, `.j`, `.k` and `.w`, the scalar part"))
    }

    /// A method of a quaternion.
    pub(super) fn quaternion_method(&mut self, call: &ExprMethodCall, q: Expr<'g>) -> Option<Value<'g>> {
        let name = call.method.to_string();
        if !METHODS.iter().any(|&(method, arity)| method == name && arity == call.args.len()) {
            return self.error(no_method(call, &name));
        }
        match name.as_str() {
            "scalar" => self.build(call, &[q], Growth::Sum, || algebra::scalar(q)).map(Value::Matrix),
            "imag" => self.build(call, &[q], Growth::Sum, || algebra::imaginary(q)).map(Value::Matrix),
            "conjugate" => self.conjugate(call, q),
            "inverse" if self.is_unit_quaternion(q) => self.conjugate(call, q),
            "inverse" => self.build(call, &[q, q], Growth::Product, || algebra::inverse(q)).map(Value::Quaternion),
            "norm_squared" => self.build(call, &[q, q], Growth::Product, || q.norm_squared()).map(Value::Matrix),
            "norm" => self.build(call, &[q, q], Growth::Power(2), || q.norm()).map(Value::Matrix),
            "normalize" => self.build(call, &[q, q], Growth::Power(2), || q.normalize()).map(Value::Quaternion),
            _ => match self.elaborate(&call.args[0])? {
                Value::Quaternion(other) => {
                    self.build(call, &[q, other], Growth::Pairs, || q.dot(other)).map(Value::Matrix)
                }
                Value::Identity(scale) => {
                    self.build(call, &[q, scale], Growth::Product, || scale * algebra::scalar(q)).map(Value::Matrix)
                }
                other => {
                    let (a, b) = (spell(&call.receiver), spell(super::access::strip(&call.args[0])));
                    let message =
                        format!("`{a}` is a quaternion and `{b}` is {}: `dot` needs two of a kind", other.describe());
                    self.error(
                        Diagnostic::new(Location::of(call), message)
                            .help(format!("write `{}.imag()` for a vector", parenthesized(&call.receiver))),
                    )
                }
            },
        }
    }

    fn conjugate(&mut self, call: &ExprMethodCall, q: Expr<'g>) -> Option<Value<'g>> {
        let conjugate = self.build(call, &[q], Growth::Sum, || algebra::conjugate(q))?;
        self.note_inverse(q, conjugate);
        Some(Value::Quaternion(conjugate))
    }
}

fn no_method(call: &ExprMethodCall, name: &str) -> Diagnostic {
    let receiver = parenthesized(&call.receiver);
    if let Some((_, arity)) = METHODS.iter().find(|(method, _)| *method == name) {
        let message = format!("`{name}` has {arity} arguments, not {}", call.args.len());
        return Diagnostic::new(call.method.span(), message).help(format!("write `{receiver}.{name}()`"));
    }
    let error =
        Diagnostic::new(call.method.span(), format!("`{}` is a quaternion and has no `{name}`", spell(&call.receiver)));
    let names = METHODS.iter().map(|&(method, _)| method);
    let synonym = SYNONYMS.iter().find(|(other, _)| *other == name).map(|&(_, meant)| meant.to_string());
    let meant = synonym.or_else(|| nearest(name, names.clone()).map(|method| format!("{method}()")));
    let list: Vec<String> = names.map(|method| format!("`{method}`")).collect();
    match meant {
        Some(meant) => error.help(format!("write `{receiver}.{meant}`")),
        None => error.note(format!("the methods of quaternions are {}", list.join(", "))),
    }
}

/// Operands that do not fit a quaternion.
fn misfit(operator: Operator, link: &ExprBinary, left: &Value, right: &Value) -> Diagnostic {
    let (a, b) = (spell(&link.left), spell(&link.right));
    let message =
        format!("`{a}` is {} and `{b}` is {}: they cannot be {}", left.describe(), right.describe(), operator.verb());
    let error = Diagnostic::new(Location::of(link), message);
    let vector = |value: &Value| value.shape() == Some(Shape::vector(3));
    match (operator, left, right) {
        (Operator::Multiply, left, Value::Quaternion(_)) if vector(left) => {
            error.help(format!("write the quaternion first, `{} * {}`, to turn the vector", parenthesized(&link.right), parenthesized(&link.left)))
        }
        (Operator::Divide, _, Value::Quaternion(_)) => {
            error.help(format!("multiply by `{}.inverse()`", parenthesized(&link.right)))
        }
        (Operator::Add | Operator::Subtract, Value::Quaternion(_), right) if vector(right) => {
            error.help(format!("take the vector part, `{}.imag()`", parenthesized(&link.left)))
        }
        _ => error.note("a quaternion is added to a quaternion or to `I`, and multiplies a quaternion, a scalar or a vector of three components"),
    }
}
