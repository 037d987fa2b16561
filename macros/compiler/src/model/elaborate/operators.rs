//! The operators `+ - * / %`, unary minus, and the shapes that they need.

use clebsch_symbolic::{Expr, Group, Rational, Role, integer};
use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::{BinOp, Expr as Syntax, ExprBinary, ExprUnary, UnOp};

use super::errors::{no_product, not_added, point_moved, unequal_shapes, verb};
use super::{Elaborator, Growth, Value};
use crate::diagnostic::{Diagnostic, error, refuse};
use crate::parse::{joined, parenthesized, spell, spell_tokens};

/// Whether a name stands in some tokens.
fn mentions(tokens: TokenStream, name: &str) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Group(group) => mentions(group.stream(), name),
        TokenTree::Ident(ident) => ident == name,
        _ => false,
    })
}

/// A sum or a difference.
pub(super) fn combined<'g>(link: &ExprBinary, a: Expr<'g>, b: Expr<'g>) -> Expr<'g> {
    if matches!(link.op, BinOp::Sub(_)) { a - b } else { a + b }
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
            if let (BinOp::Mul(_), Some(power)) = (&link.op, power(&link.right)) {
                let base = base(&link.left);
                refuse!(self, &link.op, "there is no operator `**`";
                    help "write `{}.powi({1})` for a whole number, `.powf({1})` for another one", parenthesized(base), spell(power));
            }
            let right = self.elaborate(&link.right);
            value = match &link.op {
                BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_) | BinOp::Rem(_) => {
                    value.zip(right).and_then(|(left, right)| self.apply(link, left, right))
                }
                other => {
                    let is_scalar = value.and_then(|left| left.matrix()).is_some_and(|left| left.shape().is_scalar());
                    self.refused_operator(other, link, is_scalar)
                }
            };
        }
        value
    }

    fn refused_operator(&mut self, operator: &BinOp, link: &ExprBinary, is_scalar: bool) -> Option<Value<'g>> {
        let text = spell_tokens(operator);
        let error = error!(operator, "the operator `{}` has no meaning in the {}", text.trim(), self.key);
        self.refuse(match operator {
            BinOp::Eq(_) if self.key == "endpoint" => {
                let square = if is_scalar { "powi(2)" } else { "norm_squared()" };
                let (left, right) = (spell(&link.left), parenthesized(&link.right));
                error
                    .help(format!("write the price of the distance, as in `self.price * ({left} - {right}).{square}`"))
                    .note("the endpoint is a price, and a plan ends where it is small; for an equation that holds at the end write it in `target`")
            }
            BinOp::Eq(_) if self.key == "potential" => {
                let equation = spell(&Syntax::Binary(link.clone()));
                let names = self.scope.arguments().filter(|name| mentions(link.to_token_stream(), name));
                error
                    .help(format!(
                        "for an equation that every motion obeys write `constraint = |{}| [{equation}]`",
                        joined(names)
                    ))
                    .note("a potential is an energy; the force of a constraint is found without one")
            }
            BinOp::Eq(_) | BinOp::Le(_) | BinOp::Ge(_) | BinOp::Lt(_) | BinOp::Gt(_) | BinOp::Ne(_) => {
                error.note("an equation or an inequality stands only where a key asks for one")
            }
            BinOp::BitXor(_) => error.help("write `x.powi(2)` for a power, `a.cross(&b)` for a cross product"),
            _ => error.note("the operators are `+`, `-`, `*`, `/`, and `%` on indices"),
        })
    }

    fn apply(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let sites = self.context.power.as_ref().map(|power| power.count);
        match (&link.op, left, right) {
            (BinOp::Rem(_), Value::Matrix(left), Value::Matrix(n))
                if sites == Some(n) && (n.as_number().is_none() || left.as_number().is_none()) =>
            {
                Some(Value::Wrapped(left))
            }
            (_, left @ Value::Sum(_), right) | (_, left, right @ Value::Sum(_)) => self.sums(link, left, right),
            (_, left, _) if !left.is_operand() => self.no_matrix(link, &link.left, &left),
            (_, _, right) if !right.is_operand() => self.no_matrix(link, &link.right, &right),
            (BinOp::Mul(_), Value::Identity(scale), other) | (BinOp::Mul(_), other, Value::Identity(scale)) => {
                self.scaled(link, scale, other)
            }
            (_, left @ Value::Quaternion(_), right) | (_, left, right @ Value::Quaternion(_)) => {
                self.quaternions(link, left, right)
            }
            // by construction: identities, quaternions, tuples and arrays have been dealt with
            (BinOp::Mul(_), left, right) => self.product(link, left.matrix()?, right.matrix()?),
            (BinOp::Div(_), left, right) => self.quotient(link, left, right),
            (BinOp::Rem(_), left, right) => self.remainder(link, left, right),
            (_, left, right) => self.sum(link, left, right),
        }
    }

    /// A multiple of the identity, whose size is open, times anything.
    fn scaled(&mut self, at: &ExprBinary, scale: Expr<'g>, other: Value<'g>) -> Option<Value<'g>> {
        let (expr, make): (_, fn(Expr<'g>) -> Value<'g>) = match other {
            Value::Matrix(expr) if !expr.shape().is_scalar() => (expr, Value::Matrix),
            Value::Quaternion(expr) => (expr, Value::Quaternion),
            Value::Matrix(expr) | Value::Identity(expr) => (expr, Value::Identity),
            // by construction: tuples and arrays have been dealt with
            _ => return None,
        };
        self.grow(at, &[scale, expr], Growth::Sum, || scale * expr).map(make)
    }

    fn no_matrix(&mut self, link: &ExprBinary, syntax: &Syntax, value: &Value<'g>) -> Option<Value<'g>> {
        let text = spell(syntax);
        let error = error!(syntax, "`{text}` is {} and cannot be {}", value.describe(), verb(&link.op));
        let paths = [&link.left, &link.right].map(|side| matches!(&**side, Syntax::Path(_)).then(|| spell(side)));
        let help = match (value, paths, &link.op) {
            (Value::Array(parts), [Some(left), Some(right)], BinOp::Add(_)) if parts.len() <= 4 => {
                let part = |i: usize| format!("{left}[{i}] + {right}[{i}]");
                format!("write `[{}]`", joined((0..parts.len()).map(part)))
            }
            _ => format!("take its parts, as in `{text}{}`", super::first_part(value)),
        };
        self.refuse(error.help(help))
    }

    fn sum(&mut self, at: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let (left, right) = match (left, right) {
            (Value::Identity(a), Value::Identity(b)) => {
                return self.grow(at, &[a, b], Growth::Sum, || combined(at, a, b)).map(Value::Identity);
            }
            (Value::Identity(scale), Value::Matrix(matrix)) => (self.fitted(&at.right, scale, matrix)?, matrix),
            (Value::Matrix(matrix), Value::Identity(scale)) => (matrix, self.fitted(&at.left, scale, matrix)?),
            // by construction: quaternions, tuples and arrays have been dealt with
            (left, right) => (left.matrix()?, right.matrix()?),
        };
        if left.shape() != right.shape() {
            let of_constant = self.of_constant([(left, &at.left), (right, &at.right)]);
            let error = match of_constant.or_else(|| self.of_translation([left, right])) {
                Some(help) => not_added(at, left, right).help(help),
                None => unequal_shapes(at, left, right),
            };
            return self.refuse(error);
        }
        self.build(at, &[left, right], Growth::Sum, || combined(at, left, right))
    }

    /// The advice for an action that adds an element of a group of matrices to a column.
    fn of_translation(&self, operands: [Expr<'g>; 2]) -> Option<String> {
        let group = operands.iter().find_map(|operand| self.group_of(*operand))?;
        let column = operands.iter().find(|operand| operand.shape().is_column())?;
        let n = column.shape().rows;
        (self.key == "action").then(|| {
            format!("elements of `{}` multiply; `Translation<{n}>` is the group that adds", group.name(self.graph()))
        })
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
        if shape.is_scalar() {
            refuse!(self, other, "`I` is an identity matrix, but `{text}` is a scalar";
                help "write `1` for the number, or multiply the scalar by `I`");
        }
        refuse!(self, other, "`I` is square, but `{text}` is {shape}: they cannot be added";
            help "leave `I` out";
            note "the identity of a group of translations is the zero vector")
    }

    fn product(&mut self, at: &ExprBinary, left: Expr<'g>, right: Expr<'g>) -> Option<Value<'g>> {
        let (l, r) = (left.shape(), right.shape());
        if !l.is_scalar() && !r.is_scalar() && l.columns != r.rows {
            let is_point = r.is_column() && self.group_of(left).and_then(Group::linear_part) == Some(r.rows);
            if is_point {
                return self.refuse(point_moved(at, left, right));
            }
            if let Some(error) = self.shifted(at, [left, right]) {
                return self.refuse(error);
            }
            let meant = self.meant_group(at, left, right).or_else(|| self.meant_matrix(at, [left, right]));
            return self.refuse(no_product(at, left, right, meant));
        }
        let product = self.grow(at, &[left, right], Growth::Product, || left * right)?;
        self.note_product(left, right, product);
        Some(Value::Matrix(product))
    }

    /// The error for an action that multiplies a point by an element of translations.
    fn shifted(&self, at: &ExprBinary, operands: [Expr<'g>; 2]) -> Option<Diagnostic> {
        let is_shift =
            |operand: &Expr<'g>| matches!(operand.role(), Some(Role::Element(_))) && operand.shape().is_column();
        let shift = operands.iter().position(is_shift)?;
        let sides = [&at.left, &at.right];
        let (a, x) = (spell(sides[shift]), spell(sides[1 - shift]));
        (self.key == "action" && operands[0].shape() == operands[1].shape()).then(|| {
            error!(at, "`{a}` is an element of `Translation<{}>`, which adds", operands[0].shape().rows;
                help "write `{x} + {a}`")
        })
    }

    /// The product with the matrix of a velocity, where its components stand in its place: `xi.matrix() * P`.
    fn meant_matrix(&self, at: &ExprBinary, operands: [Expr<'g>; 2]) -> Option<String> {
        let group = |operand: &Expr<'g>| self.scope.velocities.iter().find(|(velocity, _)| velocity == operand);
        let (position, (velocity, group)) =
            operands.iter().enumerate().find_map(|(position, operand)| Some((position, group(operand)?)))?;
        let (n, other) = (group.element_shape().rows, operands[1 - position].shape());
        let fits = velocity.shape().rows != n && n == if position == 0 { other.rows } else { other.columns };
        let mut sides = [&at.left, &at.right].map(|side| parenthesized(side));
        sides[position] += ".matrix()";
        fits.then(|| sides.join(" * "))
    }

    /// The argument of the action with the group that it most likely has, `R: SO<3>`. It serves where the groups of two
    /// arguments do not fit each other, or one does not fit a vector.
    fn meant_group(&self, at: &ExprBinary, left: Expr<'g>, right: Expr<'g>) -> Option<String> {
        let argument = |expr: Expr<'g>, syntax: &Syntax| {
            let Syntax::Path(path) = syntax else { return None };
            Some((path.path.get_ident()?.to_string(), expr.as_symbol()?.role, self.group_of(expr)?))
        };
        match (argument(left, &at.left), argument(right, &at.right)) {
            (Some((_, Role::Element(_), group)), Some((other, Role::Configuration(_), _)))
            | (Some((other, Role::Configuration(_), _)), Some((_, Role::Element(_), group))) => {
                Some(format!("{other}: {}", group.name(self.graph())))
            }
            (Some((element, Role::Element(_), group)), None) if right.shape().is_column() => {
                let acts =
                    matches!(group, Group::SpecialOrthogonal(_) | Group::GeneralLinear(_) | Group::SpecialLinear(_));
                acts.then(|| format!("{element}: {}<{}>", group.symbol().0, right.shape().rows))
            }
            _ => None,
        }
    }

    fn quotient(&mut self, at: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let syntax = &at.right;
        let divisor = self.as_matrix(syntax, right)?;
        if !divisor.shape().is_scalar() {
            let error = error!(syntax, "`{}` is {}: only scalars divide", spell(syntax), divisor.shape());
            return self.refuse(if divisor.shape().is_square() {
                error.help(format!("multiply by `{}.inverse()`", parenthesized(syntax)))
            } else {
                error.note("a quotient is a product with a reciprocal, which only scalars have")
            });
        }
        if divisor.is_zero() {
            return self.refuse(division_by_zero(syntax).note("it simplifies to 0"));
        }
        match left {
            Value::Identity(scale) => {
                self.grow(at, &[scale, divisor], Growth::Sum, || scale / divisor).map(Value::Identity)
            }
            // by construction: quaternions, tuples and arrays have been dealt with
            left => {
                let left = left.matrix()?;
                self.build(at, &[left, divisor], Growth::Product, || left / divisor)
            }
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
            _ => refuse!(self, link, "`{}` is no remainder of whole numbers", spell(&Syntax::Binary(link.clone()));
                note "`%` is for indices, as in `q[(i + 1) % 4]`"),
        }
    }

    pub(super) fn unary(&mut self, unary: &ExprUnary) -> Option<Value<'g>> {
        match unary.op {
            UnOp::Neg(_) => match self.elaborate(&unary.expr)? {
                Value::Identity(scale) => Some(Value::Identity(-scale)),
                Value::Quaternion(q) => self.grow(unary, &[q], Growth::Sum, || -q).map(Value::Quaternion),
                Value::Sum(terms) => Some(Value::Sum(super::sites::scaled(terms, self.graph().integer(-1)))),
                value => {
                    let matrix = self.as_matrix(&unary.expr, value)?;
                    self.build(unary, &[matrix], Growth::Sum, || -matrix)
                }
            },
            UnOp::Deref(_) => refuse!(self, &unary.op, "there is nothing to dereference";
                help "write `{}`", spell(&unary.expr); note "every value is copied"),
            _ => refuse!(self, &unary.op, "this operator has no meaning in the {}", self.key;
                note "the only sign is `-`"),
        }
    }
}

/// The number in `* 2`, the second half of `x**2`.
fn power(right: &Syntax) -> Option<&Syntax> {
    match right {
        Syntax::Unary(ExprUnary { op: UnOp::Deref(_), expr, .. }) if matches!(**expr, Syntax::Lit(_)) => Some(expr),
        _ => None,
    }
}

/// The last factor before it, which it is a power of: without a sign.
fn base(left: &Syntax) -> &Syntax {
    match left {
        Syntax::Binary(product) => &product.right,
        Syntax::Unary(ExprUnary { op: UnOp::Neg(_), expr, .. }) => expr,
        other => other,
    }
}

pub(super) fn division_by_zero(divisor: &Syntax) -> Diagnostic {
    error!(divisor, "`{}` is zero: nothing can be divided by it", spell(divisor))
}
