//! Arrays, tuples, ranges, and what is done to them: `[a, b]`, `(0..3).map(|i| …).sum()`.

use syn::{Expr as Syntax, ExprArray, ExprClosure, ExprMethodCall, ExprRange, ExprRepeat, ExprTuple, RangeLimits};

use super::super::sizes::TERMS;
use super::super::value::Value;
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::{Pattern, spell};

/// The largest number in a range.
const RANGE: usize = 1 << 32;

impl<'g> Elaborator<'_, '_, 'g> {
    /// `[a, b]`.
    pub(super) fn array(&mut self, array: &ExprArray) -> Option<Value<'g>> {
        self.all(array.elems.iter()).map(Value::Array)
    }

    /// `(a, b)`.
    pub(super) fn tuple(&mut self, tuple: &ExprTuple) -> Option<Value<'g>> {
        self.all(tuple.elems.iter()).map(Value::Tuple)
    }

    /// The values of all expressions, or all of their errors.
    fn all<'s>(&mut self, parts: impl Iterator<Item = &'s Syntax>) -> Option<Vec<Value<'g>>> {
        let values: Vec<Option<Value<'g>>> = parts.map(|part| self.elaborate(part)).collect();
        values.into_iter().collect()
    }

    /// `[a; 3]`.
    pub(super) fn repeat(&mut self, repeat: &ExprRepeat) -> Option<Value<'g>> {
        let value = self.elaborate(&repeat.expr);
        let length = self.position(&repeat.len, TERMS + 1, "lengths")?;
        Some(Value::Array(vec![value?; length]))
    }

    /// `a..b`, an array of whole numbers.
    pub(super) fn range(&mut self, range: &ExprRange) -> Option<Value<'g>> {
        let (Some(start), Some(end)) = (&range.start, &range.end) else {
            let error = Diagnostic::new(Location::of(range), "a range has a start and an end");
            return self.error(error.help("write `0..3`"));
        };
        if self.context.power.is_some() {
            return self.range_of_power(range, start, end);
        }
        self.range_of_numbers(range, start, end)
    }

    /// A range whose ends are known here, written out.
    pub(super) fn range_of_numbers(&mut self, range: &ExprRange, start: &Syntax, end: &Syntax) -> Option<Value<'g>> {
        let start = self.position(start, RANGE, "ends of ranges");
        let end = self.position(end, RANGE, "ends of ranges");
        let (start, end) = start.zip(end)?;
        let end = if matches!(range.limits, RangeLimits::Closed(_)) { end.saturating_add(1) } else { end };
        if end.saturating_sub(start) > TERMS {
            let message = format!(
                "the range `{}` has {} terms, more than {TERMS}",
                spell(&Syntax::Range(range.clone())),
                end - start
            );
            return self
                .error(Diagnostic::new(Location::of(range), message).note("ranges are written out at compile time"));
        }
        let graph = self.graph();
        Some(Value::Array((start..end).map(|i| Value::Matrix(graph.integer(i as i64))).collect()))
    }

    /// `.map(|i| …)`.
    pub(super) fn map(&mut self, call: &ExprMethodCall, parts: Vec<Value<'g>>) -> Option<Value<'g>> {
        let (pattern, closure) = self.closure_of_map(call)?;
        let mut values = Vec::with_capacity(parts.len());
        for part in parts {
            let mark = self.scope.mark();
            let errors = self.context.diagnostics.len();
            self.bind(&pattern, Some(part), "an argument");
            let value = match self.context.diagnostics.len() == errors {
                true => self.elaborate(&closure.body),
                false => None,
            };
            self.scope.release(mark);
            // what is wrong in one term is wrong in all
            values.push(value?);
        }
        Some(Value::Array(values))
    }

    /// The closure of `.map(…)`, with its argument.
    pub(super) fn closure_of_map<'s>(&mut self, call: &'s ExprMethodCall) -> Option<(Pattern, &'s ExprClosure)> {
        let Some(Syntax::Closure(closure)) = call.args.first().filter(|_| call.args.len() == 1) else {
            let error = Diagnostic::new(Location::of(&call.args), "`map` takes a closure");
            return self.error(error.help("write `.map(|i| …)`"));
        };
        Some((self.only_argument(closure)?, closure))
    }

    fn only_argument(&mut self, closure: &ExprClosure) -> Option<Pattern> {
        match closure.inputs.len() {
            1 => Pattern::read(&closure.inputs[0], &mut self.context.diagnostics),
            _ => {
                let error = Diagnostic::new(Location::of(closure), "the closure of `map` has one argument");
                self.error(error.help("write `.map(|i| …)`"))
            }
        }
    }

    /// `.sum()`.
    pub(super) fn total(&mut self, call: &ExprMethodCall, parts: Vec<Value<'g>>) -> Option<Value<'g>> {
        let at = &Syntax::MethodCall(call.clone());
        let mut terms = Vec::with_capacity(parts.len());
        for part in parts {
            terms.push(self.as_matrix(at, part)?);
        }
        let Some(&first) = terms.first() else {
            return Some(Value::Matrix(self.graph().integer(0)));
        };
        if let Some(other) = terms.iter().find(|term| term.shape() != first.shape()) {
            let message = format!(
                "the terms of `{}` are {} and {}: they cannot be added",
                spell(&call.receiver),
                first.shape(),
                other.shape()
            );
            return self.error(
                Diagnostic::new(Location::of(&call.receiver), message).note("only terms of one shape have a sum"),
            );
        }
        let mut sum = first;
        for &term in &terms[1..] {
            sum = self.build(at, &[sum, term], Growth::Sum, || sum + term)?;
        }
        Some(Value::Matrix(sum))
    }
}
