//! Arrays, tuples, ranges, and the operations on them: `[a, b]`, `(0..3).map(|i| …).sum()`.

use clebsch_symbolic::{Expr, IntoList};
use syn::{Expr as Syntax, ExprArray, ExprClosure, ExprMethodCall, ExprRange, ExprRepeat, RangeLimits};

use super::super::power::Length;
use super::super::shapes::TERMS;
use super::super::sites::Sites;
use super::{Elaborator, Growth, Value};
use crate::diagnostic::refuse;
use crate::parse::{Pattern, spell};

/// The largest number in a range.
const RANGE: usize = 1 << 32;

impl<'g> Elaborator<'_, '_, 'g> {
    /// The values of all expressions, or all of their errors.
    pub(super) fn all<'s>(&mut self, parts: impl IntoIterator<Item = &'s Syntax>) -> Option<Vec<Value<'g>>> {
        let values: Vec<Option<Value<'g>>> = parts.into_iter().map(|part| self.elaborate(part)).into_list();
        values.into_iter().collect()
    }

    /// `[a, b]`.
    pub(super) fn array(&mut self, array: &ExprArray) -> Option<Value<'g>> {
        let count = array.elems.len();
        let is_of_sites = |sites: &Sites<'g>| sites.length == Length::Number(count) && sites.entry_of.is_none();
        if !self.context.power.as_ref().is_some_and(is_of_sites) {
            return self.all(&array.elems).map(Value::Array);
        }
        let mut is_read = true;
        let mut entries = Vec::new();
        for (site, entry) in array.elems.iter().enumerate() {
            self.context.power.as_mut()?.entry_of = Some((site, false));
            entries.push(self.elaborate(entry));
            is_read &= self.context.power.as_mut()?.entry_of.take().is_some_and(|(_, is_read)| is_read);
        }
        let entries: Vec<Value<'g>> = entries.into_iter().collect::<Option<_>>()?;
        let whole = (self.graph().integer(0), self.graph().integer(count as i64));
        // the same formula at each site
        match entries.first().filter(|first| is_read && entries.iter().all(|entry| entry == *first)) {
            Some(each) => Some(Value::Sequence(whole, Box::new(each.clone()))),
            None => Some(Value::Array(entries)),
        }
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
            refuse!(self, range, "a range has a start and an end"; help "write `0..3`");
        };
        let is_power = self.context.power.is_some();
        if is_power { self.range_of_power(range, start, end) } else { self.range_of_numbers(range, start, end) }
    }

    /// A range with numbers for ends, expanded.
    pub(super) fn range_of_numbers(&mut self, range: &ExprRange, start: &Syntax, end: &Syntax) -> Option<Value<'g>> {
        let start = self.position(start, RANGE, "ends of ranges");
        let end = self.position(end, RANGE, "ends of ranges");
        let (start, end) = start.zip(end)?;
        let end = if matches!(range.limits, RangeLimits::Closed(_)) { end.saturating_add(1) } else { end };
        let count = end.saturating_sub(start);
        if count > TERMS {
            let text = spell(&Syntax::Range(range.clone()));
            refuse!(self, range, "the range `{text}` has {count} terms, more than {TERMS}";
                note "ranges are expanded at compile time");
        }
        let graph = self.graph();
        Some(Value::Array((start..end).map(|i| Value::Matrix(graph.integer(i as i64))).into_list()))
    }

    /// `.map(|i| …)`.
    pub(super) fn map(&mut self, call: &ExprMethodCall, parts: Vec<Value<'g>>) -> Option<Value<'g>> {
        match self.range_by_number(&parts) {
            Some(range) => self.map_of_sites(call, range, parts),
            None => self.map_each(call, parts),
        }
    }

    /// The values of the closure for all parts.
    pub(super) fn map_each(&mut self, call: &ExprMethodCall, parts: Vec<Value<'g>>) -> Option<Value<'g>> {
        let (pattern, closure) = self.closure_of_map(call)?;
        // a mistake in one term is a mistake in all
        let values = parts.into_iter().map(|part| self.applied(&pattern, part, |this| this.elaborate(&closure.body)));
        values.collect::<Option<_>>().map(Value::Array)
    }

    /// The results for each element of the sequence of `….map(|i| …)`, one after the other.
    pub fn each_of_map<T>(
        &mut self,
        call: &ExprMethodCall,
        mut read: impl FnMut(&mut Self, &Syntax) -> Option<Vec<T>>,
    ) -> Option<Vec<T>> {
        let parts = match self.elaborate(&call.receiver)? {
            Value::Array(parts) => parts,
            other => {
                let (text, found) = (spell(&call.receiver), other.describe());
                refuse!(self, &call.receiver, "`{text}` is {found}, and `map` is of a range or an array"; help "write `(0..3).map(|i| …)`")
            }
        };
        let (pattern, closure) = self.closure_of_map(call)?;
        let mut all = Vec::new();
        for part in parts {
            let errors = self.context.diagnostics.len();
            all.extend(self.with_names(|this| {
                this.bind(&pattern, Some(part), "an argument");
                let is_bound = this.context.diagnostics.len() == errors;
                if is_bound { read(this, &closure.body) } else { None }
            })?);
        }
        Some(all)
    }

    /// The value of a closure with one argument.
    pub(super) fn applied<V>(
        &mut self,
        pattern: &Pattern,
        argument: Value<'g>,
        read: impl FnOnce(&mut Self) -> Option<V>,
    ) -> Option<V> {
        let errors = self.context.diagnostics.len();
        self.with_names(|this| {
            this.bind(pattern, Some(argument), "an argument");
            let is_bound = this.context.diagnostics.len() == errors;
            is_bound.then(|| read(this)).flatten()
        })
    }

    /// The closure of `.map(…)`, with its argument.
    pub(super) fn closure_of_map<'s>(&mut self, call: &'s ExprMethodCall) -> Option<(Pattern, &'s ExprClosure)> {
        let Some(Syntax::Closure(closure)) = call.args.first().filter(|_| call.args.len() == 1) else {
            refuse!(self, &call.args, "`map` takes a closure"; help "write `.map(|i| …)`");
        };
        if closure.inputs.len() != 1 {
            refuse!(self, closure, "the closure of `map` has one argument"; help "write `.map(|i| …)`");
        }
        Some((Pattern::read(&closure.inputs[0], self.context.diagnostics)?, closure))
    }

    /// `.sum()`.
    pub(super) fn total(&mut self, call: &ExprMethodCall, parts: Vec<Value<'g>>) -> Option<Value<'g>> {
        let at = &Syntax::MethodCall(call.clone());
        let terms: Vec<Expr<'g>> = parts.into_iter().map(|part| self.as_matrix(at, part)).collect::<Option<_>>()?;
        let Some((&first, others)) = terms.split_first() else {
            return Some(Value::Matrix(self.graph().integer(0)));
        };
        if let Some(other) = others.iter().find(|term| term.shape() != first.shape()) {
            let (text, one, other) = (spell(&call.receiver), first.shape(), other.shape());
            refuse!(self, &call.receiver, "the terms of `{text}` are {one} and {other}: they cannot be added";
                note "only terms of one shape have a sum");
        }
        let sum = others.iter().try_fold(first, |sum, &term| self.grow(at, &[sum, term], Growth::Sum, || sum + term));
        sum.map(Value::Matrix)
    }
}
