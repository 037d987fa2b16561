//! Method calls: the table looked up, shapes checked, the expression made.

use clebsch_symbolic::{Expr, Function, Rational, Shape, integer};
use syn::{Expr as Syntax, ExprMethodCall};

use super::super::value::Value;
use super::access::is_self;
use super::operators::parenthesized;
use super::quaternions::is_of_quaternions;
use super::tables::{Binary, METHODS, NEEDLESS, REFUSED, Rule, SYNONYMS, Special, Unary};
use super::{Elaborator, Growth, open_identity};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::parse::spell;

impl<'g> Elaborator<'_, '_, 'g> {
    /// `receiver.method(arguments)`.
    pub(super) fn method_call(&mut self, call: &ExprMethodCall) -> Option<Value<'g>> {
        if is_self(&call.receiver) {
            let error = Diagnostic::later(
                call.method.span(),
                format!("the method `{}` of the struct in a formula", call.method),
            );
            return self.error(error.help("write its formula here"));
        }
        let name = call.method.to_string();
        let receiver = self.elaborate(&call.receiver);
        if let Some(Value::Quaternion(q)) = receiver {
            return self.quaternion_method(call, q);
        }
        let Some(&(_, arity, rule)) = METHODS.iter().find(|(method, ..)| *method == name) else {
            return self.unknown_method(call, &name, receiver);
        };
        if call.args.len() != arity {
            let plural = if arity == 1 { "" } else { "s" };
            let message = format!("`{name}` has {arity} argument{plural}, not {}", call.args.len());
            let form = if arity == 0 { "()" } else { "(…)" };
            return self.error(Diagnostic::new(call.method.span(), message).help(format!("write `.{name}{form}`")));
        }
        let receiver = receiver?;
        match rule {
            Rule::Special(special) => self.special(special, call, receiver),
            _ => self.plain(rule, call, receiver),
        }
    }

    fn unknown_method(&mut self, call: &ExprMethodCall, name: &str, receiver: Option<Value<'g>>) -> Option<Value<'g>> {
        if is_of_quaternions(name) {
            // a receiver with an error of its own may have been a quaternion
            let found = receiver?.describe();
            let message = format!("`{}` is {found}, but `{name}` is of a quaternion", spell(&call.receiver));
            let error = Diagnostic::new(call.method.span(), message);
            return self
                .error(error.note("quaternions are the values of `SU<2>`, of `Quaternion`, and what is made of them"));
        }
        let span = call.method.span();
        let receiver = parenthesized(&call.receiver);
        if let Some((_, reason, help)) = REFUSED.iter().find(|(method, ..)| *method == name) {
            let error = Diagnostic::new(span, format!("`{name}` {reason}, so no {} can use it", self.key));
            return self.error(error.help(help.replace('…', &receiver)));
        }
        let error = Diagnostic::new(span, format!("unknown method `{name}` in the {}", self.key));
        if NEEDLESS.contains(&name) {
            return self.error(
                error
                    .help(format!("write `{receiver}` alone"))
                    .note("every value is copied, and arrays are mapped as they are"),
            );
        }
        let synonym = SYNONYMS.iter().find(|(method, _)| *method == name).map(|&(_, meant)| meant.to_string());
        let similar = || nearest(name, METHODS.iter().map(|&(method, ..)| method)).map(str::to_string);
        self.error(match synonym.or_else(similar) {
            Some(meant) if meant.contains('(') => error.help(format!("write `{receiver}.{meant}`")),
            Some(meant) => error.help(format!("a method with a similar name exists: `{meant}`")),
            None => {
                let known: Vec<String> = METHODS.iter().map(|(method, ..)| format!("`{method}`")).collect();
                error.note(format!("the methods are {}", known.join(", ")))
            }
        })
    }

    /// A method that maps matrices to a matrix.
    fn plain(&mut self, rule: Rule, call: &ExprMethodCall, receiver: Value<'g>) -> Option<Value<'g>> {
        if let Value::Identity(scale) = receiver {
            return self.of_identity(rule, call, scale);
        }
        let a = self.as_matrix(&call.receiver, receiver)?;
        let shape = a.shape();
        let make: Unary = match rule {
            Rule::Pair(make) | Rule::PairOfThree(make) => {
                return self.pair(make, matches!(rule, Rule::PairOfThree(_)), call, a);
            }
            Rule::Scalar(function) if shape.is_scalar() => return self.function(function, call, a),
            Rule::Any(make) => make,
            Rule::Square(make) if shape.is_square() => make,
            Rule::Vector(make) if !shape.is_scalar() => make,
            Rule::Three(make) if shape == Shape::vector(3) => make,
            _ => return self.error(wrong_receiver(rule, call, shape)),
        };
        let inverts = matches!(call.method.to_string().as_str(), "inverse" | "normalize");
        if inverts && a.is_zero() {
            let message = format!("`{}` is zero and has no `{}`", spell(&call.receiver), call.method);
            return self.error(Diagnostic::new(Location::of(&call.receiver), message).note("it would be divided by 0"));
        }
        if let Some(group) = self.group_of(a).filter(|_| call.method == "inverse") {
            let inverse = self.build(call, &[a, a], Growth::Product, || group.inverse(a))?;
            self.note_inverse(a, inverse);
            return Some(Value::Matrix(inverse));
        }
        self.build(call, &[a, a], Growth::Product, || make(a)).map(Value::Matrix)
    }

    /// What methods make of an identity whose size is still open.
    fn of_identity(&mut self, rule: Rule, call: &ExprMethodCall, scale: Expr<'g>) -> Option<Value<'g>> {
        match (call.method.to_string().as_str(), rule) {
            ("transpose" | "symmetric_part", _) => Some(Value::Identity(scale)),
            ("inverse", _) if !scale.is_zero() => Some(Value::Identity(scale.powi(-1))),
            (_, Rule::Pair(make)) => {
                let b = self.matrix(&call.args[0])?;
                if !b.shape().is_square() || b.shape().is_scalar() {
                    return self.error(open_identity(&call.receiver));
                }
                let identity = scale * self.graph().identity(b.shape().rows);
                self.build(call, &[identity, b], Growth::Pairs, || make(identity, b)).map(Value::Matrix)
            }
            _ => self.error(open_identity(&call.receiver)),
        }
    }

    fn pair(&mut self, make: Binary, of_three: bool, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let argument = &call.args[0];
        let b = self.shaped(argument, a.shape())?.matrix()?;
        let (left, right) = (a.shape(), b.shape());
        let three = !of_three || (left == Shape::vector(3) && right == Shape::vector(3));
        if left != right || !three {
            let needs = if of_three {
                "`cross` is of two vectors 3x1".into()
            } else {
                format!("`{}` needs equal shapes", call.method)
            };
            let (receiver, argument) = (spell(&call.receiver), spell(super::access::strip(argument)));
            let message = format!("`{receiver}` is {left} and `{argument}` is {right}: {needs}");
            let error = Diagnostic::new(Location::of(call), message);
            let fits = left == right.transposed();
            let help = fits.then(|| format!("transpose one of them, as in `{argument}.transpose()`"));
            return self.error(match help {
                Some(help) => error.help(help),
                None => error.note(format!("`{}` combines entries of equal position", call.method)),
            });
        }
        self.build(call, &[a, b], Growth::Pairs, || make(a, b)).map(Value::Matrix)
    }

    fn function(&mut self, function: Function, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let outside = |number: Rational| match function {
            Function::Ln => number <= integer(0),
            Function::Asin | Function::Acos => number < integer(-1) || number > integer(1),
            _ => false,
        };
        if a.as_number().is_some_and(outside) {
            return self.error(no_real_value(call));
        }
        self.build(call, &[a], Growth::Power(1), || a.function(function)).map(Value::Matrix)
    }

    fn special(&mut self, special: Special, call: &ExprMethodCall, receiver: Value<'g>) -> Option<Value<'g>> {
        match (special, receiver) {
            (Special::Map, Value::Array(parts)) => self.map(call, parts),
            (Special::Sum, Value::Array(parts)) => self.total(call, parts),
            (Special::Map, Value::Range(from, to)) => self.map_of_range(call, (from, to)),
            (Special::Sum, Value::Sequence(range, body)) => self.sum_over_sites(call, range, *body),
            (Special::Map | Special::Sum, other) => {
                let message = format!(
                    "`{}` is {}: `{}` is of an array or a range",
                    spell(&call.receiver),
                    other.describe(),
                    call.method
                );
                self.error(Diagnostic::new(call.method.span(), message).help(format!(
                    "write `(0..3).{}`",
                    if special == Special::Map { "map(|i| …)" } else { "map(|i| …).sum()" }
                )))
            }
            (_, receiver) => {
                let a = self.as_matrix(&call.receiver, receiver)?;
                self.special_of_matrix(special, call, a)
            }
        }
    }
}

pub(super) fn no_real_value(call: &ExprMethodCall) -> Diagnostic {
    let text = spell(&Syntax::MethodCall(call.clone()));
    Diagnostic::new(Location::of(call), format!("`{}` has no real value", super::shortened(&text)))
        .note("a potential or a cost is a real function, wherever it is evaluated")
}

pub(super) fn wrong_receiver(rule: Rule, call: &ExprMethodCall, shape: Shape) -> Diagnostic {
    let needs = match rule {
        Rule::Square(_) => "a square matrix",
        Rule::Vector(_) => "a vector or a matrix",
        Rule::Three(_) => "a vector 3x1",
        _ => "a scalar",
    };
    let is = if shape.is_scalar() { "a scalar".into() } else { shape.to_string() };
    let message = format!("`{}` is {is}, but `{}` is of {needs}", spell(&call.receiver), call.method);
    let error = Diagnostic::new(call.method.span(), message);
    match rule {
        Rule::Scalar(_) if shape.is_column() => {
            error.help(format!("take a component, as in `{}.x.{}(…)`", parenthesized(&call.receiver), call.method))
        }
        Rule::Scalar(_) => error.help(format!("take an entry, as in `{}[(0, 0)]`", parenthesized(&call.receiver))),
        Rule::Square(_) => {
            error.note("only a square matrix has a trace, a determinant, an inverse and a symmetric part")
        }
        Rule::Three(_) => error.note("the cross product lives in three dimensions"),
        _ => error.help(format!("write `{}` alone: a scalar has no direction", parenthesized(&call.receiver))),
    }
}
