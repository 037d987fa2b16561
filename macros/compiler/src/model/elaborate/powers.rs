//! Powers, roots and norms, and the other methods that are no plain maps of matrices.

use clebsch_symbolic::{Expr, Function, Group, Rational, Shape, integer, rational};
use syn::{Expr as Syntax, ExprMethodCall};

use super::methods::no_real_value;
use super::{Elaborator, Growth, Value};
use crate::diagnostic::{Location, error, refuse};
use crate::model::Written;
use crate::parse::{parenthesized, shortened, spell};

/// The largest exponent of `powi`.
const EXPONENT: i64 = 64;

impl<'g> Elaborator<'_, '_, 'g> {
    pub(super) fn sqrt(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if is_negative(a) {
            return self.refuse(no_real_value(call));
        }
        self.build(call, &[a], Growth::Power(2), || a.sqrt())
    }

    pub(super) fn recip(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if a.is_zero() {
            return self.refuse(no_real_value(call));
        }
        self.build(call, &[a], Growth::Power(1), || a.powi(-1))
    }

    pub(super) fn norm(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if a.shape().is_scalar() {
            refuse!(self, &call.method, "`{}` is a scalar: its norm has no derivative at 0", spell(&call.receiver);
                help "smooth it, `(x * x + self.width * self.width).sqrt()`");
        }
        self.build(call, &[a, a], Growth::Power(2), || a.norm())
    }

    /// `x.powi(2)`.
    pub(super) fn powi(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let syntax = &call.args[0];
        let number = self.scalar(syntax)?.as_number().filter(Rational::is_integer);
        match number.and_then(|number| number.parts()) {
            Some((exponent, _)) if exponent < 0 && a.is_zero() => self.refuse(no_real_value(call)),
            Some((exponent, _)) if exponent.abs() <= EXPONENT => {
                if exponent > 0 && exponent % 2 == 0 {
                    self.note_square(call, a);
                }
                self.build(call, &[a], Growth::Power(exponent.unsigned_abs()), || a.powi(exponent as i32))
            }
            Some(_) => refuse!(self, syntax, "an exponent of `powi` goes from -{EXPONENT} to {EXPONENT}";
                help "write `(self.exponent * x.ln()).exp()` for a larger one"),
            None => refuse!(self, syntax, "`{}` is no whole number known here", spell(syntax);
                help "write `.powf({})`", spell(syntax)),
        }
    }

    /// Notes a square of the potential: that of an equation of the constraint does nothing.
    pub(super) fn note_square(&mut self, call: &ExprMethodCall, of: Expr<'g>) {
        if self.key == "potential" {
            let syntax = Syntax::MethodCall(call.clone());
            self.context.squares.push((Written { place: Location::from(&syntax), text: shortened(&syntax) }, of));
        }
    }

    /// `x.powf(3 / 2)`, and exp(y ln x) where the exponent is no number.
    pub(super) fn powf(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let syntax = &call.args[0];
        let exponent = self.scalar(syntax)?;
        let Some(number) = exponent.as_number() else {
            if a.as_number().is_some_and(|number| number <= integer(0)) {
                return self.refuse(no_real_value(call));
            }
            let make = || (exponent * a.function(Function::Ln)).function(Function::Exp);
            return self.build(call, &[a, exponent], Growth::Power(1), make);
        };
        match number.parts() {
            Some((numerator, denominator)) if numerator.abs() <= 1 << 20 && denominator <= 1 << 20 => {
                let zero_to_negative = numerator < 0 && a.is_zero();
                let root_of_negative = denominator > 1 && is_negative(a);
                let whole_but_large = denominator == 1 && numerator.abs() > EXPONENT;
                if zero_to_negative || root_of_negative || whole_but_large {
                    return self.refuse(no_real_value(call));
                }
                let weight = numerator.unsigned_abs().max(denominator as u64).min(EXPONENT as u64);
                self.build(call, &[a], Growth::Power(weight), || a.power(rational(numerator, denominator)))
            }
            _ => refuse!(self, syntax, "this exponent has too many digits"; help "round it, or make it a field"),
        }
    }

    /// `xi.matrix()`, for the velocity of one factor.
    pub(super) fn velocity_matrix(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if let Some(&(_, group)) = self.scope.velocities.iter().find(|(velocity, _)| *velocity == a) {
            let matrix = self.grow(call, &[a], Growth::Sum, || group.wedge(a))?;
            return Some(Value::leaf(matrix, group == Group::UnitQuaternions));
        }
        let error = error!(&call.method, "`matrix` is of a velocity, the argument of a `lagrangian`");
        let receiver = parenthesized(&call.receiver);
        self.refuse(if a.shape() == Shape::vector(3) {
            error.help(format!("write `{receiver}.cross_matrix()` for the matrix of a cross product"))
        } else {
            error.note("only the velocity of a single factor has a matrix, an element of its Lie algebra")
        })
    }
}

fn is_negative(a: Expr<'_>) -> bool {
    a.as_number().is_some_and(|number| number < integer(0))
}
