//! Method calls: the table looked up, shapes checked, the expression made.

use clebsch_symbolic::{Expr, Function, Rational, Shape, integer, rational};
use syn::{Expr as Syntax, ExprMethodCall, GenericArgument, Generics};

use super::super::sizes::size_argument;
use super::super::value::Value;
use super::access::is_self;
use super::operators::parenthesized;
use super::tables::{Binary, LATER, METHODS, NEEDLESS, REFUSED, Rule, SYNONYMS, Special, Unary};
use super::{Elaborator, Growth, open_identity};
use crate::diagnostic::{Diagnostic, Place, nearest};
use crate::parse::spell;

/// The largest exponent of `powi`.
const EXPONENT: i64 = 64;

impl<'g> Elaborator<'_, '_, 'g> {
    /// `receiver.method(arguments)`.
    pub(super) fn method_call(&mut self, call: &ExprMethodCall) -> Option<Value<'g>> {
        if is_self(&call.receiver) {
            let error = Diagnostic::later(call.method.span(), format!("the method `{}` of the struct in a formula", call.method));
            return self.error(error.help("write its formula here"));
        }
        let name = call.method.to_string();
        let Some(&(_, arity, rule)) = METHODS.iter().find(|(method, ..)| *method == name) else {
            return self.unknown_method(call, &name);
        };
        let receiver = self.elaborate(&call.receiver);
        if call.args.len() != arity {
            let plural = if arity == 1 { "" } else { "s" };
            let message = format!("`{name}` has {arity} argument{plural}, not {}", call.args.len());
            return self.error(Diagnostic::new(call.method.span(), message));
        }
        let receiver = receiver?;
        match rule {
            Rule::Special(special) => self.special(special, call, receiver),
            _ => self.plain(rule, call, receiver),
        }
    }

    fn unknown_method(&mut self, call: &ExprMethodCall, name: &str) -> Option<Value<'g>> {
        // its own errors first
        let _ = self.elaborate(&call.receiver);
        let span = call.method.span();
        let receiver = parenthesized(&call.receiver);
        if let Some((_, reason, help)) = REFUSED.iter().find(|(method, ..)| *method == name) {
            let error = Diagnostic::new(span, format!("`{name}` {reason}, so no {} can use it", self.key));
            return self.error(error.help(help.replace('…', &receiver)));
        }
        if LATER.contains(&name) {
            return self.error(Diagnostic::later(span, format!("the method `{name}`, of groups that come later,")));
        }
        let error = Diagnostic::new(span, format!("unknown method `{name}` in the {}", self.key));
        if NEEDLESS.contains(&name) {
            return self.error(error.help(format!("write `{receiver}` alone")).note("every value is copied, and arrays are mapped as they are"));
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
            Rule::Pair(make) | Rule::PairOfThree(make) => return self.pair(make, matches!(rule, Rule::PairOfThree(_)), call, a),
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
            return self.error(Diagnostic::new(Place::of(&call.receiver), message));
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

    fn pair(
        &mut self,
        make: Binary,
        of_three: bool,
        call: &ExprMethodCall,
        a: Expr<'g>,
    ) -> Option<Value<'g>> {
        let argument = &call.args[0];
        let b = self.shaped(argument, a.shape())?.matrix()?;
        let (left, right) = (a.shape(), b.shape());
        let three = !of_three || (left == Shape::vector(3) && right == Shape::vector(3));
        if left != right || !three {
            let needs = if of_three { "`cross` is of two vectors 3x1".into() } else { format!("`{}` needs equal shapes", call.method) };
            let (receiver, argument) = (spell(&call.receiver), spell(super::access::strip(argument)));
            let message = format!("`{receiver}` is {left} and `{argument}` is {right}: {needs}");
            return self.error(Diagnostic::new(Place::of(call), message));
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
            (Special::Map | Special::Sum, other) => {
                let message = format!("`{}` is {}: `{}` is of an array or a range", spell(&call.receiver), other.describe(), call.method);
                self.error(Diagnostic::new(call.method.span(), message).help(format!("write `(0..3).{}`", if special == Special::Map { "map(|i| …)" } else { "map(|i| …).sum()" })))
            }
            (_, receiver) => {
                let a = self.as_matrix(&call.receiver, receiver)?;
                self.special_of_matrix(special, call, a)
            }
        }
    }

    fn special_of_matrix(&mut self, special: Special, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        match special {
            Special::Sqrt | Special::Powi | Special::Powf | Special::Recip if !a.shape().is_scalar() => {
                self.error(wrong_receiver(Rule::Scalar(Function::Exp), call, a.shape()))
            }
            Special::Sqrt if a.as_number().is_some_and(|number| number < integer(0)) => self.error(no_real_value(call)),
            Special::Sqrt => self.build(call, &[a], Growth::Power(2), || a.sqrt()).map(Value::Matrix),
            Special::Powi => self.powi(call, a),
            Special::Powf => self.powf(call, a),
            Special::Recip if a.is_zero() => self.error(no_real_value(call)),
            Special::Recip => self.build(call, &[a], Growth::Power(1), || a.powi(-1)).map(Value::Matrix),
            Special::Norm if a.shape().is_scalar() => {
                let error = Diagnostic::new(call.method.span(), format!("`{}` is a scalar: its norm has no derivative at 0", spell(&call.receiver)));
                self.error(error.help("smooth it, `(x * x + self.width * self.width).sqrt()`"))
            }
            Special::Norm => self.build(call, &[a, a], Growth::Power(2), || a.norm()).map(Value::Matrix),
            Special::Matrix => self.velocity_matrix(call, a),
            _ => self.part(special, call, a),
        }
    }

    /// `x.powi(2)`.
    fn powi(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let syntax = &call.args[0];
        let number = self.scalar(syntax)?.as_number().filter(Rational::is_integer);
        let exponent = number.and_then(|number| number.to_integer().to_string().parse::<i64>().ok());
        match exponent {
            Some(exponent) if exponent < 0 && a.is_zero() => self.error(no_real_value(call)),
            Some(exponent) if exponent.abs() <= EXPONENT => self
                .build(call, &[a], Growth::Power(exponent.unsigned_abs()), || a.powi(exponent as i32))
                .map(Value::Matrix),
            Some(_) => {
                self.error(Diagnostic::new(Place::of(syntax), format!("an exponent of `powi` goes from -{EXPONENT} to {EXPONENT}")))
            }
            None => {
                let error = Diagnostic::new(Place::of(syntax), format!("`{}` is no whole number known here", spell(syntax)));
                self.error(error.help(format!("write `.powf({})`", spell(syntax))))
            }
        }
    }

    /// `x.powf(3 / 2)`, and exp(y ln x) where the exponent is no number.
    fn powf(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let syntax = &call.args[0];
        let exponent = self.scalar(syntax)?;
        let Some(number) = exponent.as_number() else {
            if a.as_number().is_some_and(|number| number <= integer(0)) {
                return self.error(no_real_value(call));
            }
            let make = || (exponent * a.function(Function::Ln)).function(Function::Exp);
            return self.build(call, &[a, exponent], Growth::Power(1), make).map(Value::Matrix);
        };
        let size = number.numer().to_string().parse::<i64>().ok().zip(number.denom().to_string().parse::<i64>().ok());
        match size {
            Some((numerator, denominator)) if numerator.abs() <= 1 << 20 && denominator <= 1 << 20 => {
                let zero_to_negative = numerator < 0 && a.is_zero();
                let root_of_negative = denominator > 1 && a.as_number().is_some_and(|number| number < integer(0));
                let whole_but_large = denominator == 1 && numerator.abs() > EXPONENT;
                if zero_to_negative || root_of_negative || whole_but_large {
                    return self.error(no_real_value(call));
                }
                let weight = numerator.unsigned_abs().max(denominator as u64).min(EXPONENT as u64);
                self.build(call, &[a], Growth::Power(weight), || a.power(rational(numerator, denominator))).map(Value::Matrix)
            }
            _ => self.error(Diagnostic::new(Place::of(syntax), "this exponent has too many digits").help("round it, or make it a field")),
        }
    }

    /// `xi.matrix()`, for a velocity of SO(3).
    fn velocity_matrix(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if self.scope.is_velocity(a) {
            return self.build(call, &[a], Growth::Sum, || a.hat()).map(Value::Matrix);
        }
        let error = Diagnostic::new(call.method.span(), "`matrix` is of a velocity, the argument of a `lagrangian`");
        self.error(error.help(format!("write `{}.cross_matrix()` for the matrix of a cross product", parenthesized(&call.receiver))))
    }

    /// Rows, columns, blocks.
    fn part(&mut self, special: Special, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let Shape { rows, columns } = a.shape();
        let name = call.method.to_string();
        let sizes = self.turbofish(special, call)?;
        let size = |position: usize| sizes.get(position).copied().unwrap_or(1);
        let shape = match special {
            Special::Row => Shape::new(1, columns),
            Special::Column => Shape::new(rows, 1),
            Special::FixedRows => Shape::new(size(0), columns),
            Special::FixedColumns => Shape::new(rows, size(0)),
            Special::FixedView => Shape::new(size(0), size(1)),
            Special::FirstTwo => Shape::vector(2),
            _ => Shape::vector(3),
        };
        if shape.rows > rows || shape.columns > columns || (columns > 1 && matches!(special, Special::FirstTwo | Special::FirstThree)) {
            let message = format!("`{}` is {}: `{name}` is {shape}", spell(&call.receiver), a.shape());
            return self.error(Diagnostic::new(call.method.span(), message));
        }
        let of = format!("`{name}` of `{}`", spell(&call.receiver));
        let (row, column) = match special {
            Special::Row | Special::FixedRows => (self.start(&call.args[0], rows - shape.rows, &of)?, 0),
            Special::Column | Special::FixedColumns => (0, self.start(&call.args[0], columns - shape.columns, &of)?),
            Special::FixedView => {
                let row = self.start(&call.args[0], rows - shape.rows, &of);
                let column = self.start(&call.args[1], columns - shape.columns, &of);
                row.zip(column)?
            }
            _ => (0, 0),
        };
        self.build(call, &[a], Growth::Sum, || a.block(row, column, shape)).map(Value::Matrix)
    }

    fn start(&mut self, syntax: &Syntax, last: usize, of: &str) -> Option<usize> {
        self.position(syntax, last + 1, &format!("the start in {of}"))
    }

    /// The sizes in `fixed_view::<2, 2>`.
    fn turbofish(&mut self, special: Special, call: &ExprMethodCall) -> Option<Vec<usize>> {
        let expected = match special {
            Special::FixedRows | Special::FixedColumns => 1,
            Special::FixedView => 2,
            _ => 0,
        };
        let given: Vec<&GenericArgument> = call.turbofish.iter().flat_map(|turbofish| turbofish.args.iter()).collect();
        if given.len() != expected {
            let sizes = ["", "::<2>", "::<2, 2>"][expected];
            let error = Diagnostic::new(call.method.span(), format!("`{}` needs {expected} sizes", call.method));
            return self.error(error.help(format!("write `{}{sizes}(…)`", call.method)));
        }
        let mut sizes = Vec::new();
        for argument in given {
            match size_argument(argument, &Generics::default()) {
                Ok(size) => sizes.push(size),
                Err(error) => return self.error(error),
            }
        }
        Some(sizes)
    }
}

fn no_real_value(call: &ExprMethodCall) -> Diagnostic {
    let text = spell(&Syntax::MethodCall(call.clone()));
    Diagnostic::new(Place::of(call), format!("`{}` has no real value", super::shortened(&text)))
}

fn wrong_receiver(rule: Rule, call: &ExprMethodCall, shape: Shape) -> Diagnostic {
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
        Rule::Scalar(_) if shape.is_column() => error.help(format!("take a component, as in `{}.x.{}(…)`", parenthesized(&call.receiver), call.method)),
        _ => error,
    }
}
