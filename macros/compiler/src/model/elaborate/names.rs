//! Names and numbers: arguments, `let`s, `I`, `PI`, constants of the user's crate, and literals, which are exact rationals.

use clebsch_symbolic::{IntoList, Property, Rational, Role, Shape, integer, rational};
use syn::ext::IdentExt;
use syn::{ExprLit, ExprPath, Ident, Lit, Path};

use super::super::Constant;
use super::super::scalar::spell_scalar;
use super::super::shapes::const_generic;
use super::{Elaborator, Value};
use crate::diagnostic::{error, nearest, refuse};
use crate::parse::{listed, spell_tokens};

/// Digits of a literal, and the size of its decimal exponent: f64 ends at 1e308.
const DIGITS: usize = 400;

/// Usual names of the time and of the step, with those in closures.
const RESERVED: [(&[&str], &str); 2] = [(&["time", "now"], "t"), (&["dt", "step", "timestep", "time_step"], "h")];

/// The reserved name that other programs replace by this one.
pub(in crate::model) fn reserved(name: &str) -> Option<&'static str> {
    RESERVED.iter().find(|(others, _)| others.contains(&name)).map(|&(_, reserved)| reserved)
}

impl<'g> Elaborator<'_, '_, 'g> {
    /// A name, or the path of a constant.
    pub(super) fn path(&mut self, path: &ExprPath) -> Option<Value<'g>> {
        if path.qself.is_some() {
            refuse!(self, path, "a type in angle brackets has no meaning here";
                help "write the path of a constant, or a field");
        }
        match path.path.get_ident() {
            Some(ident) => self.name(ident),
            // `std::f64::consts::PI` and the like
            None if format!("::{}", spell_tokens(&path.path)).ends_with("::consts::PI") => {
                Some(Value::Matrix(self.graph().pi()))
            }
            None => self.constant(&path.path),
        }
    }

    fn name(&mut self, ident: &Ident) -> Option<Value<'g>> {
        let name = ident.unraw().to_string();
        if let Some(value) = self.scope.value(&name) {
            // a name whose definition has an error has no value, and the error was reported
            return value.clone();
        }
        if let Some(power) = self.context.power.as_ref().filter(|power| power.length.is_named(&name)) {
            return Some(Value::Matrix(power.count));
        }
        match name.as_str() {
            "I" => Some(Value::Identity(self.graph().integer(1))),
            "PI" => Some(Value::Matrix(self.graph().pi())),
            "self" => refuse!(self, ident, "`self` alone is no quantity"; help "read a field, as in `self.mass`"),
            _ if is_constant_name(&name) || const_generic(&name, self.context.generics).is_some() => {
                self.constant(&ident.clone().into())
            }
            _ => self.unknown_name(ident, &name),
        }
    }

    /// The symbol of a constant, the same for every use.
    fn constant(&mut self, path: &Path) -> Option<Value<'g>> {
        if path.segments.iter().any(|segment| !segment.arguments.is_empty()) {
            refuse!(self, path, "a constant has no generic arguments"; help "write the path of a scalar constant");
        }
        let first = path.segments.first().map(|segment| segment.ident.to_string()).unwrap_or_default();
        let is_of_struct = first == "Self" || const_generic(&first, self.context.generics).is_some();
        if is_of_struct && self.context.power.is_some() && self.key != "potential" {
            let text = spell_tokens(path);
            refuse!(self, path, "`{text}` belongs to all sites together, and the {} is that of one site", self.key;
                help "write a constant outside of the struct, or a field, as in `self.{}`", text.to_lowercase().replace("self::", ""));
        }
        let known =
            self.context.constants.iter().position(|constant| spell_tokens(&constant.path) == spell_tokens(path));
        let index = known.unwrap_or(self.context.constants.len());
        let name: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).into_list();
        let symbol = self.graph().symbol(&name.join("::"), Shape::scalar(), Role::Constant(index), Property::General);
        if known.is_none() {
            self.context.constants.push(Constant { path: path.clone(), symbol });
        }
        Some(Value::Matrix(symbol))
    }

    fn unknown_name(&mut self, ident: &Ident, name: &str) -> Option<Value<'g>> {
        let error = error!(ident.span(), "cannot find `{name}` in the {}", self.key);
        let names = || self.scope.names.iter().map(|(name, _)| name.as_str());
        let advice =
            |name: &str| self.scope.missing.iter().find(|(known, _)| known == name).map(|(_, help)| help.clone());
        let of_reserved = reserved(name).map(|reserved| match advice(reserved) {
            Some(help) => format!("the name is `{reserved}`; {help}"),
            None => format!("write `{reserved}`"),
        });
        let is_field = self.context.fields.names().into_list().contains(&name);
        let missing = advice(name).or(of_reserved.filter(|_| !is_field));
        self.refuse(match missing.or_else(|| self.similar(name, names())) {
            Some(help) => error.help(help),
            None if name == "pi" => error.help("write `core::f64::consts::PI`"),
            None if name.chars().all(char::is_uppercase) => error
                .help(format!("if it is a constant, write `self::{name}`, or its path"))
                .note("a single letter is taken for an argument, a longer name in capitals for a constant"),
            None => error
                .maybe_help(self.as_field(name))
                .note(format!("known here are {}", listed(names().chain(["I", "self"])))),
        })
    }

    /// How a parameter is declared; `None` in a group, whose definition reads none.
    fn as_field(&self, name: &str) -> Option<String> {
        let scalar = spell_scalar(&self.context.fields.scalar);
        let advice =
            format!("if it is a parameter, write `self.{name}`, with a field `{name}: {scalar}` of the struct");
        let is_of_group = ["equation of ", "basis of "].iter().any(|key| self.key.starts_with(key));
        (!is_of_group).then_some(advice)
    }

    fn similar<'s>(&self, name: &str, names: impl Iterator<Item = &'s str>) -> Option<String> {
        let fields: Vec<&str> = self.context.fields.names().into_list();
        if fields.contains(&name) {
            return Some(format!("write `self.{name}` for the field"));
        }
        if let Some(similar) = nearest(name, names) {
            return Some(format!("a similar name exists: `{similar}`"));
        }
        nearest(name, fields).map(|similar| format!("a field with a similar name exists: `self.{similar}`"))
    }

    pub(super) fn literal(&mut self, literal: &ExprLit) -> Option<Value<'g>> {
        let (digits, suffix) = match &literal.lit {
            Lit::Int(number) => (number.base10_digits(), number.suffix()),
            Lit::Float(number) => (number.base10_digits(), number.suffix()),
            other => refuse!(self, other, "the only literals are numbers"; help "remove it"),
        };
        if !suffix.is_empty() {
            refuse!(self, literal, "the suffix `{suffix}` has no meaning here";
                help "write `{digits}`";
                note "numbers are exact; the scalar of the system is that of its fields");
        }
        let Some(value) = decimal(digits) else {
            refuse!(self, literal, "this number is beyond the range of `f64`"; help "choose units in which it is smaller");
        };
        Some(Value::Matrix(self.graph().number(value)))
    }
}

/// A single name is a constant if it is written like one: `GRAVITY`, `G0`.
fn is_constant_name(name: &str) -> bool {
    name.len() > 1 && name.starts_with(|c: char| c.is_ascii_uppercase()) && !name.contains(|c: char| c.is_lowercase())
}

/// The exact value of a decimal number, `6.67e-11`.
pub(super) fn decimal(text: &str) -> Option<Rational> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let exponent = exponent.checked_sub(fraction.len() as i64)?;
    if mantissa.len() > DIGITS || exponent.unsigned_abs() > 2 * DIGITS as u64 {
        return None;
    }
    let ten = integer(10);
    let mut value = integer(0);
    for digit in whole.chars().chain(fraction.chars()) {
        value = value * &ten + integer(i64::from(digit.to_digit(10)?));
    }
    let step = if exponent < 0 { rational(1, 10) } else { ten };
    Some((0..exponent.unsigned_abs()).fold(value, |value, _| value * &step))
}
