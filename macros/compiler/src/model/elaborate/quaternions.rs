//! Quaternions in formulas: `Quaternion::new(w, i, j, k)`, `Q * v`, `Q * Q`, `Q.imag()`, `.w`.

use clebsch_symbolic::{Expr, Role, Shape};
use syn::{BinOp, ExprBinary, ExprCall, ExprField, ExprMethodCall, Ident};

use super::super::quaternion as algebra;
use super::errors::verb;
use super::operators::{combined, division_by_zero};
use super::{Elaborator, Growth, Value};
use crate::diagnostic::{Diagnostic, error, meant, refuse};
use crate::parse::{listed, parenthesized, spell};

/// A method of a quaternion q: how many operands it counts as, how it grows, its value, and whether that is a quaternion.
type QuaternionRule = (usize, Growth, for<'g> fn(Expr<'g>) -> Expr<'g>, bool);

/// The methods of quaternions without an argument, each with its value; `dot` has one.
#[rustfmt::skip]
pub(super) const METHODS: [(&str, QuaternionRule, &str); 7] = [
    ("scalar",       (1, Growth::Sum,      algebra::scalar,       false), "the scalar part w"),
    ("imag",         (1, Growth::Sum,      algebra::imaginary,    false), "the vector part (i, j, k)"),
    ("conjugate",    (1, Growth::Sum,      algebra::conjugate,    true), "w − i − j − k"),
    ("inverse",      (2, Growth::Product,  algebra::inverse,      true), "q⁻¹"),
    ("norm_squared", (2, Growth::Product,  |q| q.norm_squared(),  false), "w² + i² + j² + k²"),
    ("norm",         (2, Growth::Power(2), |q| q.norm(),          false), "the length"),
    ("normalize",    (2, Growth::Power(2), |q| q.normalize(),     true), "q/|q|"),
];

/// Methods of matrices and of nalgebra's quaternions, and their replacements.
#[rustfmt::skip]
const SYNONYMS: [(&str, &str); 9] = [
    ("transpose", "conjugate"), ("adjoint", "conjugate"), ("vector", "imag"), ("as_vector", "imag"), ("real", "scalar"),
    ("w", "scalar"), ("try_inverse", "inverse"), ("magnitude", "norm"), ("magnitude_squared", "norm_squared"),
];

impl<'g> Elaborator<'_, '_, 'g> {
    /// An operator with a quaternion on at least one side.
    pub(super) fn quaternions(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        use BinOp::{Add, Div, Mul, Sub};
        let graph = self.graph();
        let coordinates = |value: &Value<'g>| match value {
            Value::Quaternion(q) => Some(*q),
            Value::Identity(s) => Some(algebra::real(graph, *s)),
            _ => None,
        };
        if let (Add(_) | Sub(_), Some((a, b))) = (&link.op, coordinates(&left).zip(coordinates(&right))) {
            return self.grow(link, &[a, b], Growth::Sum, || combined(link, a, b)).map(Value::Quaternion);
        }
        match (&link.op, left, right) {
            (Mul(_), Value::Quaternion(a), Value::Quaternion(b)) => {
                let product = self.grow(link, &[a, b], Growth::Pairs, || algebra::product(a, b))?;
                self.note_product(a, b, product);
                Some(Value::Quaternion(product))
            }
            (Mul(_), Value::Quaternion(a), Value::Matrix(s)) | (Mul(_), Value::Matrix(s), Value::Quaternion(a))
                if s.shape().is_scalar() =>
            {
                self.grow(link, &[a, s], Growth::Sum, || s * a).map(Value::Quaternion)
            }
            (Mul(_), Value::Quaternion(a), Value::Matrix(v)) if v.shape() == Shape::vector(3) => {
                // a quaternion on a group has length one
                let turn = if self.group_of(a).is_some() { algebra::turn } else { algebra::turn_by_any };
                self.build(link, &[a, a, v], Growth::Pairs, || turn(a, v))
            }
            (Div(_), Value::Quaternion(a), Value::Matrix(s)) if s.shape().is_scalar() => {
                if s.is_zero() {
                    return self.refuse(division_by_zero(&link.right).note("it simplifies to 0"));
                }
                self.grow(link, &[a, s], Growth::Product, || a / s).map(Value::Quaternion)
            }
            (_, left, right) => self.refuse(misfit(link, &left, &right)),
        }
    }

    /// `Quaternion::new(w, i, j, k)`.
    pub(super) fn quaternion_constructor(&mut self, call: &ExprCall, method: &Ident) -> Option<Value<'g>> {
        if method == "identity" && call.args.is_empty() {
            return Some(Value::Quaternion(algebra::real(self.graph(), self.graph().integer(1))));
        }
        if method != "new" || call.args.len() != algebra::COORDINATES {
            let error = if method == "new" {
                error!(method, "`Quaternion::new` has 4 coordinates, not {}", call.args.len())
            } else {
                error!(method, "unknown constructor `{method}` of a quaternion")
            };
            return self.refuse(error.help("write `Quaternion::new(w, i, j, k)`, the scalar part first"));
        }
        let mut coordinates = self.scalars(&call.args)?;
        coordinates.rotate_left(1);
        let stacked = self.stack(call, Shape::vector(algebra::COORDINATES), coordinates)?;
        stacked.matrix().map(Value::Quaternion)
    }

    /// `Q.w`.
    pub(super) fn coordinate(&mut self, field: &ExprField, q: Expr<'g>, name: &Ident) -> Option<Value<'g>> {
        if let Some(index) = algebra::NAMES.iter().position(|known| name == known) {
            return self.build(field, &[q], Growth::Sum, || q.entry(index, 0));
        }
        let error = error!(name, "the quaternion `{}` has no coordinate `{name}`", spell(&field.base));
        let position = ["x", "y", "z"].iter().position(|other| name == other);
        let help = position.map(|index| format!("write `.{}`", algebra::NAMES[index]));
        self.refuse(error.maybe_help(help).note("its coordinates are `.i`, `.j`, `.k` and `.w`, the scalar part"))
    }

    pub(super) fn quaternion_method(&mut self, call: &ExprMethodCall, q: Expr<'g>) -> Option<Value<'g>> {
        let name = call.method.to_string();
        if name == "dot" && call.args.len() == 1 {
            return self.quaternion_dot(call, q);
        }
        let rule = METHODS.iter().find(|(method, ..)| *method == name && call.args.is_empty());
        let Some(&(_, (operands, growth, make, is_quaternion), _)) = rule else {
            return self.refuse(no_method(call, &name));
        };
        // q⁻¹ is q̄ where |q| = 1
        let is_conjugate = name == "conjugate" || (name == "inverse" && self.group_of(q).is_some());
        if is_conjugate {
            let conjugate = self.grow(call, &[q], Growth::Sum, || algebra::conjugate(q))?;
            if let Some(group) = self.group_of(q) {
                self.members.insert(conjugate, group);
            }
            return Some(Value::Quaternion(conjugate));
        }
        let value = self.grow(call, &vec![q; operands], growth, || make(q))?;
        Some(Value::leaf(value, is_quaternion))
    }

    fn quaternion_dot(&mut self, call: &ExprMethodCall, q: Expr<'g>) -> Option<Value<'g>> {
        match self.elaborate(&call.args[0])? {
            Value::Quaternion(other) => self.build(call, &[q, other], Growth::Pairs, || q.dot(other)),
            Value::Identity(s) => self.build(call, &[q, s], Growth::Product, || s * algebra::scalar(q)),
            other => {
                let (a, b) = (spell(&call.receiver), spell(super::access::strip(&call.args[0])));
                refuse!(self, call, "`{a}` is a quaternion and `{b}` is {}: `dot` needs two of a kind", other.describe();
                    help "write `{}.imag()` for a vector", parenthesized(&call.receiver))
            }
        }
    }
}

fn no_method(call: &ExprMethodCall, name: &str) -> Diagnostic {
    let (method, receiver) = (&call.method, parenthesized(&call.receiver));
    let names = METHODS.iter().map(|&(method, ..)| method).chain(["dot"]);
    if names.clone().any(|method| method == name) {
        let arity = usize::from(name == "dot");
        return error!(method, "`{name}` has {arity} arguments, not {}", call.args.len(); help "write `{receiver}.{name}()`");
    }
    let error = error!(method, "`{}` is a quaternion and has no `{name}`", spell(&call.receiver));
    match meant(name, &SYNONYMS, names.clone()) {
        Some(meant) => error.help(format!("write `{receiver}.{meant}()`")),
        None => error.note(format!("the methods of quaternions are {}", listed(names))),
    }
}

/// Operands that do not fit a quaternion.
fn misfit(link: &ExprBinary, left: &Value, right: &Value) -> Diagnostic {
    let (a, b, verb) = (spell(&link.left), spell(&link.right), verb(&link.op));
    let error = error!(link, "`{a}` is {} and `{b}` is {}: they cannot be {verb}", left.describe(), right.describe());
    let vector = |value: &Value| value.matrix().is_some_and(|expr| expr.shape() == Shape::vector(3));
    let (a, b) = (parenthesized(&link.left), parenthesized(&link.right));
    match (&link.op, left, right) {
        (BinOp::Mul(_), left, Value::Quaternion(_)) if vector(left) => {
            error.help(format!("write the quaternion first, `{b} * {a}`, to turn the vector"))
        }
        (BinOp::Div(_), _, Value::Quaternion(_)) => error.help(format!("multiply by `{b}.inverse()`")),
        (BinOp::Add(_) | BinOp::Sub(_), Value::Quaternion(_), right) if vector(right) => {
            error.help(format!("take the vector part, `{a}.imag()`"))
        }
        (BinOp::Add(_) | BinOp::Sub(_), Value::Quaternion(_), Value::Matrix(right)) if is_four(right) => {
            error.help(as_four(&a, &b, *right))
        }
        (BinOp::Add(_) | BinOp::Sub(_), Value::Matrix(left), Value::Quaternion(_)) if is_four(left) => {
            error.help(as_four(&b, &a, *left))
        }
        _ => error.note("a quaternion is added to a quaternion or to `I`, and multiplies a quaternion, a scalar or a vector of three components"),
    }
}

fn is_four(vector: &Expr) -> bool {
    vector.shape() == Shape::vector(algebra::COORDINATES)
}

/// The replacement of the sum of a quaternion and a vector of four components: shifts of four numbers act on a
/// `Vector4`.
fn as_four(quaternion: &str, vector: &str, value: Expr) -> String {
    if matches!(value.role(), Some(Role::Element(_))) {
        format!("write `Vector4` for the type of `{quaternion}`: it is the space that `Translation<4>` moves")
    } else {
        format!("make a quaternion of the vector, `Quaternion::new({vector}.w, {vector}.x, {vector}.y, {vector}.z)`")
    }
}
