//! Powers: `0..N`, `(0..N).map(|i| …)`, sums over sites, `q[(i + 1) % N]`.

use clebsch_symbolic::{Expr, IntoElements, IntoList, Property, Role, Shape};
use syn::{BinOp, Expr as Syntax, ExprBinary, ExprIndex, ExprMethodCall, ExprRange, RangeLimits};

use super::super::power::{Length, Linear, Range, SiteIndex, Term, index_name, sites_for};
use super::super::sites::of_all_sites;
use super::super::value::{Each, Value};
use super::Elaborator;
use super::operators::division_by_zero;
use crate::diagnostic::refuse;
use crate::parse::{shortened, spell};

/// Sums inside each other.
const SUMS: usize = 4;

/// All terms, times a factor.
pub(super) fn scaled<'g>(terms: Vec<Term<'g>>, factor: Expr<'g>) -> Vec<Term<'g>> {
    terms.into_each(|term| Term { value: factor * term.value, ..term })
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// `a..b` in a power, where the ends may depend on N and on the indices of the sums around.
    pub(super) fn range_of_power(&mut self, range: &ExprRange, start: &Syntax, end: &Syntax) -> Option<Value<'g>> {
        let (from, to) = (self.scalar(start), self.scalar(end));
        let (from, to) = from.zip(to)?;
        if from.as_number().is_some() && to.as_number().is_some() {
            return self.range_of_numbers(range, start, end);
        }
        for (syntax, expr) in [(start, from), (end, to)] {
            if !Linear::is_declarable(expr) {
                refuse!(self, syntax, "`{}` is no end of a range", spell(syntax);
                    help "write a whole number, `N`, an index, or sums of these, as in `i + 1..N`");
            }
        }
        let closed = matches!(range.limits, RangeLimits::Closed(_));
        let to = if closed { to + self.graph().integer(1) } else { to };
        Some(Value::Range(from, to))
    }

    /// `.map(|i| …)` of a range: the closure is read once, for all indices.
    pub(super) fn map_of_range(&mut self, call: &ExprMethodCall, range: Range<'g>) -> Option<Value<'g>> {
        let value = self.for_each(call, range, Self::elaborate)?;
        Some(Value::Sequence(range, Box::new(value)))
    }

    /// The range of some numbers in a power by a number; `None` elsewhere.
    pub(super) fn range_by_number(&self, parts: &[Value<'g>]) -> Option<Range<'g>> {
        let power = self.context.power.as_ref()?;
        matches!(power.length, Length::Number(_)).then(|| self.range_of_sites(parts))?
    }

    /// `(0..4).map(|i| …)` in a power by a number. Where its closure cannot be read once for all indices, it is read for each,
    /// as of the components of a vector.
    pub(super) fn map_of_sites(
        &mut self,
        call: &ExprMethodCall,
        range: Range<'g>,
        parts: Vec<Value<'g>>,
    ) -> Option<Value<'g>> {
        let (diagnostics, known) = (self.context.diagnostics, self.context.power.as_ref()?.known());
        let reported = diagnostics.len();
        let of_range = self.map_of_range(call, range);
        if of_range.is_some() {
            return of_range;
        }
        let errors = diagnostics.since(reported);
        self.context.power.as_mut()?.forget(known);
        let of_each = diagnostics.quietly(|| self.map_each(call, parts));
        if of_each.is_none() {
            diagnostics.extend(errors);
        }
        of_each
    }

    /// The range of numbers that follow each other.
    fn range_of_sites(&self, all: &[Value<'g>]) -> Option<Range<'g>> {
        let number = |value: &Value<'g>| if let Value::Matrix(number) = value { Some(*number) } else { None };
        let first = number(all.first()?)?;
        let at = |i: usize| (first + self.graph().integer(i as i64)).expand();
        let follow = all.iter().enumerate().all(|(i, value)| number(value) == Some(at(i)));
        (first.as_number().is_some() && follow).then(|| (first, at(all.len())))
    }

    /// `(1..N).map(|i| …)`, where `read` reads the body of the closure.
    pub fn of_range<V>(
        &mut self,
        call: &ExprMethodCall,
        read: impl FnOnce(&mut Self, &Syntax) -> Option<V>,
    ) -> Option<(Range<'g>, V)> {
        let range = match self.elaborate(&call.receiver)? {
            Value::Range(from, to) => (from, to),
            // by its numbers, `1..4` is a range of sites too
            Value::Array(all) => match self.range_of_sites(&all) {
                Some(range) => range,
                None => {
                    refuse!(self, &call.receiver, "`{}` is an array of {}, no range of sites", spell(&call.receiver), all.len();
                    help "write each equation for itself, or a range, as in `(1..{}).map(|i| …)`", self.context.power.as_ref()?.length)
                }
            },
            other => {
                refuse!(self, &call.receiver, "`{}` is {}, no range of sites", spell(&call.receiver), other.describe();
                    help "write a range, as in `(1..{}).map(|i| …)`", self.context.power.as_ref()?.length)
            }
        };
        Some((range, self.for_each(call, range, read)?))
    }

    /// The body of the closure of `map`, read once for all indices of a range.
    fn for_each<V>(
        &mut self,
        call: &ExprMethodCall,
        range: Range<'g>,
        read: impl FnOnce(&mut Self, &Syntax) -> Option<V>,
    ) -> Option<V> {
        let (pattern, closure) = self.closure_of_map(call)?;
        let graph = self.graph();
        let power = self.context.power.as_mut()?;
        if power.ranges.len() == SUMS {
            refuse!(self, call, "more than {SUMS} ranges inside each other";
                note "the terms of such a sum are too many for any N");
        }
        let depth = power.ranges.len();
        let index = graph.symbol(&index_name(depth), Shape::scalar(), Role::Site(depth), Property::General);
        power.ranges.push(range);
        let value = self.applied(&pattern, Value::Matrix(index), |this| read(this, &closure.body));
        self.context.power.as_mut()?.ranges.pop();
        value
    }

    /// `.sum()` of a value for each index of a range.
    pub(super) fn sum_over_sites(
        &mut self,
        call: &ExprMethodCall,
        range: Range<'g>,
        body: Value<'g>,
    ) -> Option<Value<'g>> {
        let Some(mut terms) = body.terms() else {
            refuse!(self, &call.receiver, "the terms of this sum over sites are {}, not scalars", body.describe();
                help "add scalars, as in `(0..N).map(|i| self.field.dot(&q[i])).sum()`");
        };
        terms.iter_mut().for_each(|term| term.ranges.insert(0, range));
        Some(Value::Sum(terms))
    }

    /// Sums over sites are added, and multiplied and divided by scalars.
    pub(super) fn sums(&mut self, link: &ExprBinary, left: Value<'g>, right: Value<'g>) -> Option<Value<'g>> {
        let graph = self.graph();
        let sign = graph.integer(if matches!(link.op, BinOp::Sub(_)) { -1 } else { 1 });
        let (terms, factor) = match (&link.op, left, right) {
            (BinOp::Add(_) | BinOp::Sub(_), left, right) => {
                let mut terms = self.terms(&link.left, left)?;
                terms.extend(scaled(self.terms(&link.right, right)?, sign));
                return Some(Value::Sum(terms));
            }
            (BinOp::Mul(_), Value::Sum(terms), factor) => (terms, self.factor(&link.right, factor)?),
            (BinOp::Mul(_), factor, Value::Sum(terms)) => (terms, self.factor(&link.left, factor)?),
            (BinOp::Div(_), Value::Sum(terms), divisor) => {
                let divisor = self.factor(&link.right, divisor)?;
                if divisor.is_zero() {
                    return self.refuse(division_by_zero(&link.right));
                }
                (terms, divisor.powi(-1))
            }
            (_, Value::Sum(_), _) => return self.refuse(super::open_sum(&link.left)),
            _ => return self.refuse(super::open_sum(&link.right)),
        };
        Some(Value::Sum(scaled(terms, factor)))
    }

    /// The terms of a sum, or a scalar as its only one.
    fn terms(&mut self, syntax: &Syntax, value: Value<'g>) -> Option<Vec<Term<'g>>> {
        match value {
            Value::Sum(terms) => Some(terms),
            other => Some(vec![Term { ranges: Vec::new(), value: self.factor(syntax, other)? }]),
        }
    }

    /// A scalar factor of a sum.
    fn factor(&mut self, syntax: &Syntax, value: Value<'g>) -> Option<Expr<'g>> {
        let expr = self.as_matrix(syntax, value)?;
        if !expr.shape().is_scalar() {
            let text = shortened(syntax);
            refuse!(self, syntax, "`{text}` is {}, and a sum over sites is a scalar", expr.shape();
                note "sums over sites are added, and multiplied by scalars");
        }
        Some(expr)
    }

    /// `q[i]`: the value of a site.
    pub(super) fn site(&mut self, index: &ExprIndex, of: Each, own: Value<'g>) -> Option<Value<'g>> {
        let place = match self.elaborate(&index.index)? {
            Value::Wrapped(expr) => SiteIndex { index: expr, wraps: true },
            value => SiteIndex { index: self.as_matrix(&index.index, value)?, wraps: false },
        };
        let text = spell(&index.index);
        if !place.index.shape().is_scalar() || !Linear::is_declarable(place.index) {
            refuse!(self, &index.index, "`{text}` is no index of a site";
                help "write a whole number, an index, or sums of these, as in `q[(i + 1) % N]`");
        }
        let fields = self.context.fields;
        let power = self.context.power.as_mut()?;
        let name = power.length.clone();
        let least = if place.wraps { Some(1) } else { sites_for(place.index, power.count, &power.ranges) };
        if let Some(least) = least {
            power.least = power.least.max(least);
        } else {
            refuse!(self, &index.index, "`{}` leaves the sites 0..{name}", spell(&Syntax::Index(index.clone()));
                help "write `({text}) % {name}` for a ring, or let the range end earlier, as `0..{name} - 1` does");
        }
        let is_index =
            || power.ranges.len() == 1 && place.index.as_symbol().is_some_and(|data| data.role == Role::Site(0));
        let mut is_own = !place.wraps && is_index();
        if let Some((site, is_read)) = &mut power.entry_of
            && place.index == place.index.graph().integer(*site as i64)
        {
            *is_read = true;
            is_own = true;
        }
        match (of, ["potential", "constraint"].contains(&self.key)) {
            (_, false) if is_own => Some(own),
            (Each::Configuration, true) => {
                let number = power.place(place);
                let configuration = power.configuration_at(number);
                configuration.members().for_each(|(leaf, group)| self.members.insert(leaf, group));
                Some(configuration.value())
            }
            (Each::Field(field), true) => {
                let parameter = &fields.parameters[field];
                let number = power.place(place);
                let leaves = power.entry(field, number, parameter).into_iter().map(Value::Matrix);
                Some(Value::nested(&parameter.structure, &leaves.into_list()))
            }
            _ => {
                let (key, text) = (self.key, spell(&Syntax::Index(index.clone())));
                refuse!(self, index, "the {key} of a site depends on that site alone, and `{text}` is of another";
                    help "{}", of_all_sites(key, &name);
                    note "the equation of a step is solved site by site; in the potential and in the constraint, sites may meet")
            }
        }
    }
}
