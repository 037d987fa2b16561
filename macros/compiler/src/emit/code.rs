//! Tokens of straight-line code.

use clebsch_symbolic::{Function, Rational, both, integer, work};
use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use quote::{TokenStreamExt, format_ident, quote};

use super::scope::{Scope, size, spelled};
use crate::lower::{Code, is_in_brackets};

impl Scope<'_, '_> {
    /// Tokens of a code; `tight` if it is an operand of a multiplication.
    pub fn code(&self, code: &Code, tight: bool) -> TokenStream {
        let mut tokens = TokenStream::new();
        self.write(&mut tokens, code, tight);
        tokens
    }

    /// Appends the tokens of a code: sums and products are long, and would be copied at each level.
    pub(super) fn write(&self, tokens: &mut TokenStream, code: &Code, tight: bool) {
        work::spend(4);
        match code {
            Code::Read(input) => tokens.extend(self.read(input)),
            Code::Number(value) if value.is_negative() && !tight => {
                operator(tokens, '-');
                tokens.extend(self.number(&value.abs()));
            }
            Code::Number(value) => tokens.extend(self.number(value)),
            Code::Constant(index) => {
                tokens.extend(self.constants.clone());
                operator(tokens, '.');
                word(tokens, &self.kernels.constant_names[*index]);
            }
            Code::Term(index) if self.keeps_matrices => {
                // behind the target
                let index = size(*index + 1);
                tokens.extend(quote!(terms.#index));
            }
            Code::Term(index) => {
                word(tokens, "terms");
                tokens.append(Group::new(Delimiter::Bracket, TokenTree::from(size(*index)).into()));
            }
            Code::Local(index) => word(tokens, &format!("t{index}")),
            Code::Sum(constant, terms) if tight && is_in_brackets(constant, terms) => {
                let mut inner = TokenStream::new();
                self.write_sum(&mut inner, constant, terms);
                tokens.append(Group::new(Delimiter::Parenthesis, inner));
            }
            Code::Sum(constant, terms) => self.write_sum(tokens, constant, terms),
            Code::Product(factors) => match Code::quotient(factors) {
                None => self.write_product(tokens, factors.iter()),
                Some((above, below)) => {
                    if above.is_empty() {
                        tokens.extend(self.number(&integer(1)));
                    }
                    self.write_product(tokens, above.into_iter());
                    for divisor in below {
                        operator(tokens, '/');
                        tokens.extend(self.divisor(divisor));
                    }
                }
            },
            Code::Pi => {
                tokens.extend(quote!(<T as runtime::Scalar>::PI));
            }
            Code::Reciprocal(x) => tokens.extend(self.reciprocal(x, tight)),
            Code::Root(x, exponent) => tokens.extend(self.root(x, *exponent)),
            Code::PerOnePlusCosine(x) => {
                let x = self.code(x, false);
                let name = if self.is_of_field { "quotient_per_one_plus_cosine" } else { "per_one_plus_cosine" };
                let name = format_ident!("{name}");
                tokens.extend(quote!(runtime::#name(#x)));
            }
            Code::Call(callee, arguments) => tokens.extend(self.call(callee, arguments)),
            Code::Output(local, callee, output) => tokens.extend(self.output_of_call(*local, callee, *output)),
            Code::Function(function, x) => tokens.extend(self.function(*function, x)),
            Code::Whole(whole) => tokens.extend(self.whole(whole)),
        }
    }

    fn write_product<'c>(&self, tokens: &mut TokenStream, factors: impl Iterator<Item = &'c Code>) {
        for (position, factor) in factors.enumerate() {
            if position > 0 {
                operator(tokens, '*');
            }
            self.write(tokens, factor, true);
        }
    }

    fn reciprocal(&self, x: &Code, tight: bool) -> TokenStream {
        let (one, x) = (self.number(&integer(1)), self.divisor(x));
        if tight { quote!((#one / #x)) } else { quote!(#one / #x) }
    }

    fn divisor(&self, x: &Code) -> TokenStream {
        // `1 / a * b` would divide by a alone
        let compound = matches!(x, Code::Product(_) | Code::Sum(..) | Code::Reciprocal(_));
        let x = self.code(x, !compound);
        if compound { quote!((#x)) } else { x }
    }

    fn root(&self, x: &Code, (numerator, denominator): (i64, i64)) -> TokenStream {
        let x = self.code(x, false);
        if (numerator, denominator) == (1, 2) {
            return quote!(runtime::Scalar::sqrt(#x));
        }
        let exponent = self.number(&clebsch_symbolic::rational(numerator, denominator));
        quote!(runtime::Scalar::powf(#x, #exponent))
    }

    fn function(&self, function: Function, x: &Code) -> TokenStream {
        let x = self.code(x, false);
        if let Function::Stumpff(k) = function {
            let k = Literal::u8_unsuffixed(k);
            return quote!(runtime::stumpff(#k, #x));
        }
        let name = format_ident!("{}", function.name());
        quote!(runtime::Scalar::#name(#x))
    }

    fn write_sum(&self, tokens: &mut TokenStream, constant: &Rational, terms: &[(Rational, Code)]) {
        let zero = integer(0);
        let mut is_first = *constant == zero;
        if !is_first {
            self.write(tokens, &Code::Number(constant.clone()), false);
        }
        for (coefficient, term) in terms {
            match (is_first, *coefficient < zero) {
                (true, false) => {}
                (_, true) => operator(tokens, '-'),
                (false, false) => operator(tokens, '+'),
            }
            let magnitude = coefficient.abs();
            if magnitude != integer(1) {
                tokens.extend(self.number(&magnitude));
                operator(tokens, '*');
            }
            // (a + b) + c is a + b + c
            let leads = is_first && *coefficient == integer(1) && matches!(term, Code::Sum(..));
            self.write(tokens, term, !leads);
            is_first = false;
        }
    }

    /// A number, rounded once to the scalar.
    pub fn number(&self, value: &Rational) -> TokenStream {
        spelled(&self.numbers, value, || self.spell_number(value))
    }

    fn spell_number(&self, value: &Rational) -> TokenStream {
        match value.parts() {
            _ if !self.is_generic() => float(value),
            Some((0, 1)) => quote!(<T as runtime::Zero>::zero()),
            Some((1, 1)) => quote!(<T as runtime::One>::one()),
            Some((numerator, denominator)) => {
                let [numerator, denominator] = both([numerator, denominator], Literal::i64_unsuffixed);
                quote!(<T as runtime::Scalar>::from_ratio(#numerator, #denominator))
            }
            None => self.rounded(float(value)),
        }
    }
}

pub(super) fn operator(tokens: &mut TokenStream, symbol: char) {
    tokens.append(Punct::new(symbol, Spacing::Alone));
}

pub(super) fn word(tokens: &mut TokenStream, name: &str) {
    tokens.append(Ident::new(name, Span::call_site()));
}

/// `[a, b, c]`.
pub(super) fn list(parts: impl IntoIterator<Item = TokenStream>) -> TokenTree {
    let mut inner = TokenStream::new();
    for (position, part) in parts.into_iter().enumerate() {
        if position > 0 {
            operator(&mut inner, ',');
        }
        inner.extend(part);
    }
    Group::new(Delimiter::Bracket, inner).into()
}

/// A floating-point literal: the decimal fraction where it ends, a quotient where it does not.
fn float(value: &Rational) -> TokenStream {
    let magnitude = value.abs();
    let part = |text: String| -> TokenStream { text.parse().unwrap_or_default() };
    let tokens = match decimal(&magnitude) {
        Some(text) => part(text),
        None => {
            let [above, below] = both([magnitude.numer(), magnitude.denom()], |number| part(format!("{number}.0")));
            quote!((#above / #below))
        }
    };
    if value.is_negative() { quote!((-#tokens)) } else { tokens }
}

/// The decimal fraction of a positive rational whose denominator divides a power of ten, in at most 40 digits.
fn decimal(value: &Rational) -> Option<String> {
    let powers = std::iter::successors(Some(value.clone()), |scaled| Some(scaled * &integer(10)));
    let (digits, scaled) = powers.take(41).enumerate().find(|(_, scaled)| scaled.is_integer())?;
    let text = scaled.numer().to_string();
    if text.len() > 60 {
        return None;
    }
    Some(match digits {
        0 => format!("{text}.0"),
        7.. => format!("{text}e-{digits}"),
        _ => {
            let padded = format!("{text:0>width$}", width = digits + 1);
            let (whole, fraction) = padded.split_at(padded.len() - digits);
            format!("{whole}.{fraction}")
        }
    })
}
