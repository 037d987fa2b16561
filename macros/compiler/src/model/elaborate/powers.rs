//! Powers, roots and norms, and the other methods that are no plain maps of matrices.

use clebsch_symbolic::{Expr, Function, Group, Rational, Shape, integer, rational};
use syn::ExprMethodCall;

use super::super::value::Value;
use super::methods::{no_real_value, wrong_receiver};
use super::operators::parenthesized;
use super::tables::{Rule, Special};
use super::{Elaborator, Growth};
use crate::diagnostic::{Diagnostic, Location};
use crate::parse::spell;

/// The largest exponent of `powi`.
const EXPONENT: i64 = 64;

impl<'g> Elaborator<'_, '_, 'g> {
    /// A method of a matrix that has a function of its own.
    pub(super) fn special_of_matrix(
        &mut self,
        special: Special,
        call: &ExprMethodCall,
        a: Expr<'g>,
    ) -> Option<Value<'g>> {
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
                let error = Diagnostic::new(
                    call.method.span(),
                    format!("`{}` is a scalar: its norm has no derivative at 0", spell(&call.receiver)),
                );
                self.error(error.help("smooth it, `(x * x + self.width * self.width).sqrt()`"))
            }
            Special::Norm => self.build(call, &[a, a], Growth::Power(2), || a.norm()).map(Value::Matrix),
            Special::Matrix => self.velocity_matrix(call, a),
            Special::Rotation | Special::Translation => self.of_affine(special, call, a),
            _ => self.part(special, call, a),
        }
    }

    /// `x.powi(2)`.
    fn powi(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        let syntax = &call.args[0];
        let number = self.scalar(syntax)?.as_number().filter(Rational::is_integer);
        let exponent = number.and_then(|number| number.parts()).map(|(exponent, _)| exponent);
        match exponent {
            Some(exponent) if exponent < 0 && a.is_zero() => self.error(no_real_value(call)),
            Some(exponent) if exponent.abs() <= EXPONENT => self
                .build(call, &[a], Growth::Power(exponent.unsigned_abs()), || a.powi(exponent as i32))
                .map(Value::Matrix),
            Some(_) => {
                let error = Diagnostic::new(
                    Location::of(syntax),
                    format!("an exponent of `powi` goes from -{EXPONENT} to {EXPONENT}"),
                );
                self.error(error.help("write `(self.exponent * x.ln()).exp()` for a larger one"))
            }
            None => {
                let error =
                    Diagnostic::new(Location::of(syntax), format!("`{}` is no whole number known here", spell(syntax)));
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
        match number.parts() {
            Some((numerator, denominator)) if numerator.abs() <= 1 << 20 && denominator <= 1 << 20 => {
                let zero_to_negative = numerator < 0 && a.is_zero();
                let root_of_negative = denominator > 1 && a.as_number().is_some_and(|number| number < integer(0));
                let whole_but_large = denominator == 1 && numerator.abs() > EXPONENT;
                if zero_to_negative || root_of_negative || whole_but_large {
                    return self.error(no_real_value(call));
                }
                let weight = numerator.unsigned_abs().max(denominator as u64).min(EXPONENT as u64);
                self.build(call, &[a], Growth::Power(weight), || a.power(rational(numerator, denominator)))
                    .map(Value::Matrix)
            }
            _ => self.error(
                Diagnostic::new(Location::of(syntax), "this exponent has too many digits")
                    .help("round it, or make it a field"),
            ),
        }
    }

    /// `xi.matrix()`, for the velocity of one factor.
    fn velocity_matrix(&mut self, call: &ExprMethodCall, a: Expr<'g>) -> Option<Value<'g>> {
        if let Some(group) = self.scope.group_of_velocity(a) {
            let matrix = self.build(call, &[a], Growth::Sum, || group.wedge(a))?;
            return Some(Value::leaf(matrix, group == Group::UnitQuaternions));
        }
        let error = Diagnostic::new(call.method.span(), "`matrix` is of a velocity, the argument of a `lagrangian`");
        let receiver = parenthesized(&call.receiver);
        self.error(match a.shape() == Shape::vector(3) {
            true => error.help(format!("write `{receiver}.cross_matrix()` for the matrix of a cross product")),
            false => error.note("only the velocity of a single factor has a matrix, an element of its Lie algebra"),
        })
    }
}
