//! Method calls: the table looked up, shapes checked, the expression made.

use clebsch_symbolic::{Expr, Function, Property, Rational, Role, Shape, integer};
use syn::{Expr as Syntax, ExprMethodCall, Ident};

use super::access::{is_self, strip};
use super::tables::{Binary, ITERATORS, METHODS, NEEDLESS, REFUSED, Rule, SYNONYMS, Unary};
use super::{Elaborator, Growth, Kink, Value, open_identity};
use crate::diagnostic::{Diagnostic, LATER, Location, error, meant, refuse};
use crate::model::Written;
use crate::parse::{listed, parenthesized, shortened, spell};

/// The methods with a kink that a price of inputs takes, with the number of their arguments.
const KINKS: [(&str, usize); 2] = [("abs", 0), ("max", 1)];

/// The logarithm of a group element, by the names that libraries give it.
const LOGARITHMS: [&str; 6] = ["ln", "log", "logm", "log_map", "logarithm", "scaled_axis"];

impl<'g> Elaborator<'_, '_, 'g> {
    pub(super) fn method_call(&mut self, call: &ExprMethodCall) -> Option<Value<'g>> {
        let name = call.method.to_string();
        if is_self(&call.receiver) {
            let error = error!(&call.method, "the method `{name}` of the struct in a formula is not supported yet";
                help "write its formula here");
            return self.refuse(error.maybe_help(self.opaque()).note(LATER));
        }
        if ITERATORS.contains(&name.as_str()) {
            refuse!(self, &call.method, "`{name}` has no meaning in the {}", self.key;
                help "go over indices, as in `(0..3).map(|i| a[i] * b[i]).sum()`";
                note "the operations on arrays and ranges are `map` and `sum`");
        }
        let receiver = self.elaborate(&call.receiver);
        if let Some(error) = receiver.as_ref().and_then(|receiver| self.function_of_matrix(call, receiver)) {
            return self.refuse(error);
        }
        if let Some(Value::Quaternion(q)) = receiver {
            return self.quaternion_method(call, q);
        }
        if let Some(sides) = KINKS.iter().find(|(kink, _)| *kink == name && self.context.kinks.is_some()) {
            return self.kink(call, receiver?, *sides);
        }
        let Some(&(_, arity, rule, _)) = METHODS.iter().find(|(method, ..)| *method == name) else {
            return self.unknown_method(call, &name, receiver);
        };
        if call.args.len() != arity {
            return self.refuse(wrong_count(&call.method, ".", &name, arity, call.args.len()));
        }
        match (rule, receiver?) {
            (Rule::Map | Rule::Sum, receiver) => self.sequence_method(call, receiver),
            (Rule::Any(_) | Rule::Square(_) | Rule::Vector(_) | Rule::Pair(_), Value::Identity(scale)) => {
                self.of_identity(rule, call, scale)
            }
            (rule, receiver) => {
                let a = self.as_matrix(&call.receiver, receiver)?;
                self.plain(rule, call, a)
            }
        }
    }

    /// |a| = 2 max(a, 0) − a, and max(a, b) = b + max(a − b, 0).
    fn kink(&mut self, call: &ExprMethodCall, receiver: Value<'g>, (name, arity): (&str, usize)) -> Option<Value<'g>> {
        if call.args.len() != arity {
            return self.refuse(wrong_count(&call.method, ".", name, arity, call.args.len()));
        }
        let a = self.as_matrix(&call.receiver, receiver)?;
        let b = match call.args.first() {
            Some(other) => {
                let value = self.elaborate(other)?;
                Some(self.as_matrix(other, value)?)
            }
            None => None,
        };
        if !a.shape().is_scalar() || b.is_some_and(|b| !b.shape().is_scalar()) {
            refuse!(self, &call.method, "`{name}` is of scalars"; help "take it of each component, as in `{}.x.{name}({})`",
                parenthesized(&call.receiver), if arity == 0 { "" } else { "…" });
        }
        let written = Written { place: Location::from(call), text: shortened(&Syntax::MethodCall(call.clone())) };
        let value = b.map_or(a, |b| a - b);
        let graph = self.context.graph;
        let kinks = self.context.kinks.as_mut()?;
        let role = Role::Kink(kinks.len());
        let symbol = graph.symbol(&format!("s{}", kinks.len()), Shape::scalar(), role, Property::General);
        kinks.push(Kink { symbol, value, written });
        Some(Value::Matrix(match b {
            Some(b) => b + symbol,
            None => 2 * symbol - a,
        }))
    }

    /// The error for the logarithm or the exponential of a matrix or of a quaternion.
    fn function_of_matrix(&self, call: &ExprMethodCall, receiver: &Value<'g>) -> Option<Diagnostic> {
        let (a, is_quaternion) = match receiver {
            Value::Matrix(a) => (*a, false),
            Value::Quaternion(q) => (*q, true),
            _ => return None,
        };
        let (method, name) = (&call.method, call.method.to_string());
        let is_logarithm = LOGARITHMS.contains(&name.as_str());
        let is_square = a.shape().is_square() && !a.shape().is_scalar();
        let is_of_edge = self.key == "space" && name == "log" && matches!(a.role(), Some(Role::Element(_)));
        if is_of_edge || !(is_square || is_quaternion) || !(is_logarithm || name == "exp") {
            return None;
        }
        let (text, is) = (parenthesized(&call.receiver), receiver.describe());
        let of = if is_quaternion { "quaternions" } else { "matrices" };
        let error = error!(method, "`{text}` is {is}, and a closure has no `{name}` of {of}");
        let is_fixed = |symbol: &Expr<'g>| matches!(symbol.role(), Some(Role::Parameter(_) | Role::Constant(_)));
        Some(if a.symbols().iter().all(is_fixed) {
            error.help("compute it once, and store the result in a field")
        } else if !is_logarithm || self.group_of(a).is_none() {
            error.note("functions are of scalars: an entry is `x[0]` or `a[(0, 0)]`")
        } else if self.key == "cost" {
            error
                .help("write a `lagrangian` with `discretization = exponential`, as in `lagrangian = |xi| xi.norm_squared() / 2`")
                .note("its step is F = exp(h*xi), so it is a function of the logarithm of F")
        } else if self.key == "space" {
            error.help("write the energy of the element of an edge, `|dx, W| …` with `W.log()`").note(
                "the element moves a site to its neighbour: it is near the identity where both are near each other",
            )
        } else {
            error
                .help(format!("write a function that is smooth everywhere, as in `({text} - I).norm_squared()`"))
                .maybe_help(self.opaque())
                .note("a logarithm jumps, as it does where a rotation turns by half a circle")
        })
    }

    fn unknown_method(&mut self, call: &ExprMethodCall, name: &str, receiver: Option<Value<'g>>) -> Option<Value<'g>> {
        let (method, has_error, elements) = (&call.method, receiver.is_none(), receiver.clone());
        if ["scalar", "imag", "conjugate"].contains(&name) {
            // a receiver with an error of its own may have been a quaternion
            let found = receiver?.describe();
            refuse!(self, method, "`{}` is {found}, but `{name}` is of a quaternion", spell(&call.receiver);
                note "quaternions are the values of `SU<2>`, of `Quaternion`, and what is made of them");
        }
        let receiver = parenthesized(&call.receiver);
        if let Some((_, reason, help)) = REFUSED.iter().find(|(method, ..)| *method == name) {
            let error = error!(method, "`{name}` {reason}, so no {} can use it", self.key;
                help "{}", help.replace('…', &receiver));
            return self.refuse(error.maybe_help(self.opaque()));
        }
        let error = error!(method, "unknown method `{name}` in the {}", self.key);
        if let Some(Value::Array(parts)) = &elements
            && name == "len"
        {
            return self.refuse(error.help(format!("write `{}`", parts.len())));
        }
        if NEEDLESS.contains(&name) {
            // the error of the receiver names the text for both
            if has_error {
                return None;
            }
            let error = error.help(format!("write `{receiver}` alone"));
            return self.refuse(error.note("every value is copied, and arrays are mapped as they are"));
        }
        let names = METHODS.iter().map(|&(method, ..)| method);
        self.refuse(match meant(name, &SYNONYMS, names.clone()) {
            Some(meant) if meant.contains('(') => error.help(format!("write `{receiver}.{meant}`")),
            Some(meant) => error.help(format!("a method with a similar name exists: `{meant}`")),
            // the receiver has an error of its own, which was reported
            None if has_error => return None,
            None => error.note(format!("the methods are {}", listed(names))),
        })
    }

    /// A method that maps matrices to a matrix.
    fn plain(&mut self, rule: Rule, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let shape = a.shape();
        let make: Unary = match rule {
            Rule::Pair(make) => return self.pair(make, false, call, a),
            Rule::PairOfThree(make) => return self.pair(make, true, call, a),
            Rule::Part(part) => return self.part(part, call, a),
            Rule::Special(_, method) => return method(self, call, a),
            Rule::OfScalar(method) if shape.is_scalar() => return method(self, call, a),
            Rule::Scalar(function) if shape.is_scalar() => return self.function(function, call, a),
            Rule::Any(make) => make,
            Rule::Square(make) if shape.is_square() => make,
            Rule::Vector(make) if !shape.is_scalar() => make,
            Rule::Three(make) if shape == Shape::vector(3) => make,
            _ => return self.refuse(wrong_receiver(rule, call, shape)),
        };
        if call.method == "norm_squared" {
            self.note_square(call, a);
        }
        let is_inverse = call.method == "inverse";
        if a.is_zero() && (is_inverse || call.method == "normalize") {
            refuse!(self, &call.receiver, "`{}` is zero and has no `{}`", spell(&call.receiver), call.method;
                note "it would be divided by 0");
        }
        if let Some(group) = self.group_of(a).filter(|_| is_inverse) {
            let inverse = self.grow(call, &[a, a], Growth::Product, || group.inverse(a))?;
            self.members.insert(inverse, group);
            return Some(Value::Matrix(inverse));
        }
        self.build(call, &[a, a], Growth::Product, || make(a))
    }

    /// The results of methods of an identity whose size is still open.
    fn of_identity(&mut self, rule: Rule, call: &ExprMethodCall, scale: Expr<'g>) -> Option<Value<'g>> {
        match (call.method.to_string().as_str(), rule) {
            ("transpose" | "symmetric_part", _) => return Some(Value::Identity(scale)),
            ("inverse", _) if !scale.is_zero() => return Some(Value::Identity(scale.powi(-1))),
            (_, Rule::Pair(make)) => {
                let b = self.matrix(&call.args[0])?;
                if b.shape().is_square() && !b.shape().is_scalar() {
                    let identity = scale * self.graph().identity(b.shape().rows);
                    return self.build(call, &[identity, b], Growth::Pairs, || make(identity, b));
                }
            }
            _ => {}
        }
        self.refuse(open_identity(&call.receiver))
    }

    fn pair(&mut self, make: Binary, of_three: bool, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let b = self.shaped(&call.args[0], a.shape())?;
        let (left, right) = (a.shape(), b.shape());
        if left == right && (!of_three || left == Shape::vector(3)) {
            return self.build(call, &[a, b], Growth::Pairs, || make(a, b));
        }
        let method = &call.method;
        let equal = format!("`{method}` needs equal shapes");
        let needs = if of_three { "`cross` is of two vectors 3x1" } else { &equal };
        let (receiver, argument) = (spell(&call.receiver), spell(strip(&call.args[0])));
        let error = error!(call, "`{receiver}` is {left} and `{argument}` is {right}: {needs}");
        let of_constant = self.of_constant([(a, &*call.receiver), (b, strip(&call.args[0]))]);
        self.refuse(if let Some(help) = of_constant {
            error.help(help)
        } else if left == right.transposed() {
            error.help(format!("transpose one of them, as in `{argument}.transpose()`"))
        } else {
            error.note(format!("`{method}` combines entries of equal position"))
        })
    }

    fn function(&mut self, function: Function, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let outside = |number: Rational| match function {
            Function::Ln => number <= integer(0),
            Function::Asin | Function::Acos => number < integer(-1) || number > integer(1),
            _ => false,
        };
        if a.as_number().is_some_and(outside) {
            return self.refuse(no_real_value(call));
        }
        self.build(call, &[a], Growth::Power(1), || a.function(function))
    }

    fn sequence_method(&mut self, call: &ExprMethodCall, receiver: Value<'g>) -> Option<Value<'g>> {
        let method = &call.method;
        match (method == "map", receiver) {
            (true, Value::Array(parts)) => self.map(call, parts),
            (true, Value::Range(from, to)) => self.map_of_range(call, (from, to)),
            (false, Value::Array(parts)) => self.total(call, parts),
            (false, Value::Sequence(range, body)) => self.sum_over_sites(call, range, *body),
            (is_map, other) => {
                let (text, is, sum) = (spell(&call.receiver), other.describe(), if is_map { "" } else { ".sum()" });
                let sites = self.context.power.as_ref().map_or("3".to_string(), |power| power.length.to_string());
                refuse!(self, method, "`{text}` is {is}: `{method}` is of an array or a range";
                    help "write `(0..{sites}).map(|i| …){sum}`")
            }
        }
    }
}

/// The error for a function or a method with another number of arguments.
pub(super) fn wrong_count(place: &Ident, dot: &str, name: &str, arity: usize, found: usize) -> Diagnostic {
    let plural = if arity == 1 { "" } else { "s" };
    let argument = if arity == 0 { "" } else { "…" };
    error!(place, "`{name}` has {arity} argument{plural}, not {found}"; help "write `{dot}{name}({argument})`")
}

pub(super) fn no_real_value(call: &ExprMethodCall) -> Diagnostic {
    let text = shortened(&Syntax::MethodCall(call.clone()));
    error!(call, "`{text}` has no real value";
        note "a potential or a cost is a real function, wherever it is evaluated")
}

fn wrong_receiver(rule: Rule, call: &ExprMethodCall, shape: Shape) -> Diagnostic {
    let is = if shape.is_scalar() { "a scalar".into() } else { shape.to_string() };
    let (receiver, method) = (parenthesized(&call.receiver), &call.method);
    let error = |needs: &str| error!(method, "`{}` is {is}, but `{method}` is of {needs}", spell(&call.receiver));
    match rule {
        Rule::Square(_) => error("a square matrix")
            .note("only a square matrix has a trace, a determinant, an inverse and a symmetric part"),
        Rule::Three(_) => error("a vector 3x1").note("the cross product lives in three dimensions"),
        Rule::Vector(_) => {
            error("a vector or a matrix").help(format!("write `{receiver}` alone: a scalar has no direction"))
        }
        _ if shape.is_column() => error("a scalar").help(format!("take a component, as in `{receiver}.x.{method}(…)`")),
        _ => error("a scalar").help(format!("take an entry, as in `{receiver}[(0, 0)]`")),
    }
}
