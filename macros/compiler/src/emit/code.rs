//! Tokens of straight-line code.

use std::cell::RefCell;

use clebsch_symbolic::{Function, Group, Rational, Role, Shape, Table, Zero, integer, work};
use proc_macro2::{Delimiter, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use quote::{TokenStreamExt, format_ident, quote};

use super::path::Paths;
use crate::lower::{Code, Input, Kernel, is_in_brackets};
use crate::model::{Access, Layout, Opaque, Part, Power, ScalarType, System};

/// Where a function finds its inputs.
pub struct Scope<'a, 'g> {
    /// The model, for the fields and accessors.
    pub model: &'a System<'g>,
    /// What ties the sites of a power to each other.
    pub power: Option<&'a Power<'g>>,
    /// The methods behind an opaque potential.
    pub opaque: Option<&'a Opaque>,
    /// The paths of the runtime.
    pub paths: &'a Paths,
    /// The user's struct: `self` or `self.system`.
    pub system: TokenStream,
    /// The constants: `self.constants`, or nothing while they are being made.
    pub constants: Option<TokenStream>,
    /// The names of the constants.
    pub constant_names: &'a [String],
    /// Which of all components of the momentum `mu` holds, in order.
    pub momenta: Vec<usize>,
    /// Which of all components `x` holds, in order.
    pub coordinates: Vec<usize>,
    /// The index of the first component of each chart block among those of all factors.
    pub blocks: Vec<usize>,
    /// The name of the momentum argument.
    pub momentum: &'static str,
    /// The user's struct as a type, for the methods behind an opaque potential.
    pub item: TokenStream,
    /// Whether the program keeps whole matrices.
    pub keeps_matrices: bool,
    /// What has been spelled.
    pub spelled: Spelled,
}

/// The tokens of entries and numbers, which stand in code many times.
#[derive(Default)]
pub struct Spelled {
    reads: RefCell<Table<Input, TokenStream>>,
    numbers: RefCell<Table<Rational, TokenStream>>,
}

/// The nesting of what a kernel returns.
#[derive(Copy, Clone, PartialEq, Eq)]
pub enum Nesting {
    /// That of the configuration.
    Configuration,
    /// That of the group element.
    Element,
}

/// The entry of a flat vector, which holds some of all components, that belongs to one of them.
fn entry(vector: &str, held: &[usize], wanted: usize) -> TokenStream {
    // by construction: kernels read what their vectors hold
    let position = held.iter().position(|&component| component == wanted).unwrap_or(wanted);
    let (vector, position) = (format_ident!("{vector}"), Literal::usize_unsuffixed(position));
    quote!(#vector[#position])
}

/// Tokens that reach a leaf: `.0[1]`.
pub fn accessor(access: &Access) -> TokenStream {
    let parts = access.parts().iter().map(|part| match part {
        Part::Field(position) => {
            let position = Literal::usize_unsuffixed(*position);
            quote!(.#position)
        }
        Part::Index(position) => {
            let position = Literal::usize_unsuffixed(*position);
            quote!([#position])
        }
        Part::Site(place) => {
            let index = format_ident!("at{place}");
            quote!([#index])
        }
    });
    parts.collect()
}

impl Scope<'_, '_> {
    pub(super) fn read(&self, input: &Input) -> TokenStream {
        if let Some(known) = self.spelled.reads.borrow().get(input) {
            return known.clone();
        }
        let spelled = self.spell_read(input);
        self.spelled.reads.borrow_mut().insert(input.clone(), spelled.clone());
        spelled
    }

    fn spell_read(&self, input: &Input) -> TokenStream {
        let (row, column) = (Literal::usize_unsuffixed(input.row), Literal::usize_unsuffixed(input.column));
        let index = if input.is_vector { quote!([#row]) } else { quote!([(#row, #column)]) };
        let leaf = |name: &str, access: &Access| {
            let (name, access) = (format_ident!("{name}"), accessor(access));
            quote!(#name #access #index)
        };
        let factor = |k: usize| &self.model.factors[k].accessor;
        match input.role {
            Role::StepSize => match &self.constants {
                // what is written out has taken all that depends on h into its constants
                Some(constants) => quote!(#constants.step_size),
                None => quote!(h),
            },
            Role::Time => quote!(t),
            Role::Parameter(leaf) => self.parameter(leaf, index),
            Role::Constant(index) => self.constant_of_crate(index),
            Role::Configuration(i) => leaf("q", &self.model.configurations[i].accessor),
            Role::Image(i) => leaf("next", &self.model.configurations[i].accessor),
            Role::Input(i) => leaf("u", &self.model.inputs[i].accessor),
            Role::At(place, i) => leaf(&format!("q{place}"), &self.model.configurations[i].accessor),
            Role::Site(depth) => {
                let (private, scalar, index) = (&self.paths.private, &self.paths.scalar, format_ident!("i{depth}"));
                quote!(<#scalar as #private::Scalar>::from_f64(#index as ::core::primitive::f64))
            }
            Role::Sites => {
                let (private, scalar) = (&self.paths.private, &self.paths.scalar);
                let length = self.power.map(|power| &power.length);
                quote!(<#scalar as #private::Scalar>::from_f64(#length as ::core::primitive::f64))
            }
            Role::Covector(i) => leaf("p", &self.model.configurations[i].accessor),
            Role::Element(k) => leaf("f", factor(k)),
            Role::Increment(k) => leaf("d", factor(k)),
            Role::Following(k) => leaf("second", factor(k)),
            Role::MomentumMatrix(k) => leaf("m", factor(k)),
            Role::Multiplier => quote!(kappa #index),
            Role::Weight => quote!(z #index),
            Role::ChartWeight(number) => {
                let number = Literal::usize_unsuffixed(number);
                quote!(w[#number])
            }
            Role::Kick => quote!(weight),
            Role::KickGradient => quote!(gradient),
            Role::Momentum(k) => entry(self.momentum, &self.momenta, self.model.offset(k) + input.row),
            Role::Chart(block) => entry("x", &self.coordinates, self.blocks[block] + input.row),
            Role::Algebra(k) | Role::Logarithm(k) | Role::Cayley(k) => {
                entry("x", &self.coordinates, self.model.offset(k) + input.row)
            }
            Role::Direction(block) => entry("delta", &self.coordinates, self.blocks[block] + input.row),
            Role::InertiaInverse => match &self.constants {
                Some(constants) if self.keeps_matrices => quote!(#constants.inertia_inverse.matrix() #index),
                Some(constants) => quote!(#constants.inertia_inverse #index),
                None => quote!(inertia_inverse #index),
            },
            // by construction: nothing that is computed reads the symbols of checks and of print
            Role::Composed(..) | Role::OfferedElement(_) | Role::DeclaredElement | Role::Unknown | Role::Letter => {
                TokenStream::new()
            }
        }
    }

    pub(super) fn parameter(&self, leaf: usize, index: TokenStream) -> TokenStream {
        let of_terms = self.power.into_iter().flat_map(|power| &power.parameters);
        let all = self
            .model
            .parameters
            .iter()
            .chain(of_terms)
            .flat_map(|parameter| parameter.leaves.iter().map(move |leaf| (parameter, leaf)));
        let is_leaf = |symbol: clebsch_symbolic::Expr<'_>| {
            symbol.as_symbol().is_some_and(|data| data.role == Role::Parameter(leaf))
        };
        // by construction: the role of a parameter's symbol is that of one leaf
        let Some((parameter, leaf)) = all.into_iter().find(|(_, leaf)| is_leaf(leaf.symbol)) else { return quote!() };
        let mut field = parameter.field.clone();
        if let syn::Member::Named(ident) = &mut field {
            ident.set_span(parameter.first_use);
        }
        let (system, access) = (&self.system, accessor(&leaf.accessor));
        let index = if leaf.is_scalar { quote!() } else { index };
        quote!(#system.#field #access #index)
    }

    fn constant_of_crate(&self, index: usize) -> TokenStream {
        let path = &self.model.constants[index].path;
        match self.model.item.scalar {
            ScalarType::Parameter(_) => {
                let (private, scalar) = (&self.paths.private, &self.paths.scalar);
                quote!(<#scalar as #private::Scalar>::from_f64(#path))
            }
            _ => quote!(#path),
        }
    }

    /// Tokens of a code; `tight` where it stands beside a multiplication.
    pub fn code(&self, code: &Code, tight: bool) -> TokenStream {
        let mut tokens = TokenStream::new();
        self.write(&mut tokens, code, tight);
        tokens
    }

    /// Appends the tokens of a code: sums and products are long, and would be copied at each level.
    fn write(&self, tokens: &mut TokenStream, code: &Code, tight: bool) {
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
                word(tokens, &self.constant_names[*index]);
            }
            Code::Term(index) if self.keeps_matrices => {
                // behind the target
                let index = Literal::usize_unsuffixed(*index + 1);
                tokens.extend(quote!(terms.#index));
            }
            Code::Term(index) => {
                word(tokens, "terms");
                let index = TokenTree::from(Literal::usize_unsuffixed(*index));
                group(tokens, Delimiter::Bracket, index.into());
            }
            Code::Local(index) => word(tokens, &format!("t{index}")),
            Code::Sum(constant, terms) if tight && is_in_brackets(constant, terms) => {
                let mut inner = TokenStream::new();
                self.write_sum(&mut inner, constant, terms);
                group(tokens, Delimiter::Parenthesis, inner);
            }
            Code::Sum(constant, terms) => self.write_sum(tokens, constant, terms),
            Code::Product(factors) => match Code::quotient(factors) {
                None => self.write_product(tokens, factors.iter()),
                Some((above, below)) => {
                    match above.is_empty() {
                        true => tokens.extend(self.number(&integer(1))),
                        false => self.write_product(tokens, above.into_iter()),
                    }
                    for divisor in below {
                        operator(tokens, '/');
                        tokens.extend(self.divisor(divisor));
                    }
                }
            },
            Code::Pi => {
                let (private, scalar) = (&self.paths.private, &self.paths.scalar);
                tokens.extend(quote!(<#scalar as #private::Scalar>::PI));
            }
            Code::Reciprocal(x) => tokens.extend(self.reciprocal(x, tight)),
            Code::Root(x, exponent) => tokens.extend(self.root(x, *exponent)),
            Code::PerOnePlusCosine(x) => {
                let (private, x) = (&self.paths.private, self.code(x, false));
                tokens.extend(quote!(#private::per_one_plus_cosine(#x)));
            }
            Code::Call(callee, arguments) => tokens.extend(self.call(callee, arguments)),
            Code::Output(local, callee, output) => tokens.extend(self.output(*local, callee, *output)),
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
        let (private, x) = (&self.paths.private, self.code(x, false));
        if (numerator, denominator) == (1, 2) {
            return quote!(#private::Scalar::sqrt(#x));
        }
        let exponent = self.number(&clebsch_symbolic::rational(numerator, denominator));
        quote!(#private::Scalar::powf(#x, #exponent))
    }

    fn function(&self, function: Function, x: &Code) -> TokenStream {
        let (private, x) = (&self.paths.private, self.code(x, false));
        match function {
            Function::Stumpff(k) => {
                let k = Literal::u8_unsuffixed(k);
                quote!(#private::stumpff(#k, #x))
            }
            _ => {
                let name = format_ident!("{}", function.name());
                quote!(#private::Scalar::#name(#x))
            }
        }
    }

    /// Whether a leaf of a nesting is a quaternion.
    pub fn is_quaternion(&self, nesting: Nesting, leaf: usize) -> bool {
        match nesting {
            Nesting::Configuration => self.model.configurations[leaf].is_quaternion,
            Nesting::Element => self.model.factors[leaf].group == Group::UnitQuaternions,
        }
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
        if let Some(known) = self.spelled.numbers.borrow().get(value) {
            return known.clone();
        }
        let spelled = self.spell_number(value);
        self.spelled.numbers.borrow_mut().insert(value.clone(), spelled.clone());
        spelled
    }

    fn spell_number(&self, value: &Rational) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        match (&self.model.item.scalar, value.parts()) {
            (ScalarType::Parameter(_), Some((0, 1))) => quote!(<#scalar as #private::Zero>::zero()),
            (ScalarType::Parameter(_), Some((1, 1))) => quote!(<#scalar as #private::One>::one()),
            (ScalarType::Parameter(_), Some((numerator, denominator))) => {
                let (numerator, denominator) =
                    (Literal::i64_unsuffixed(numerator), Literal::i64_unsuffixed(denominator));
                quote!(<#scalar as #private::Scalar>::from_ratio(#numerator, #denominator))
            }
            (ScalarType::Parameter(_), _) => {
                let literal = float(value);
                quote!(<#scalar as #private::Scalar>::from_f64(#literal))
            }
            _ => float(value),
        }
    }
}

fn operator(tokens: &mut TokenStream, symbol: char) {
    tokens.append(Punct::new(symbol, Spacing::Alone));
}

fn word(tokens: &mut TokenStream, name: &str) {
    tokens.append(Ident::new(name, Span::call_site()));
}

fn group(tokens: &mut TokenStream, delimiter: Delimiter, inner: TokenStream) {
    tokens.append(proc_macro2::Group::new(delimiter, inner));
}

/// `[a, b, c]`.
fn list(parts: impl IntoIterator<Item = TokenStream>) -> TokenTree {
    let mut inner = TokenStream::new();
    for (position, part) in parts.into_iter().enumerate() {
        if position > 0 {
            operator(&mut inner, ',');
        }
        inner.extend(part);
    }
    proc_macro2::Group::new(Delimiter::Bracket, inner).into()
}

/// A floating-point literal: the decimal fraction where it ends, a quotient where it does not.
fn float(value: &Rational) -> TokenStream {
    let negative = *value < integer(0);
    let magnitude = if negative { -value.clone() } else { value.clone() };
    let tokens = match decimal(&magnitude) {
        Some(text) => text.parse().unwrap_or_default(),
        None => {
            let part = |text: String| -> TokenStream { format!("{text}.0").parse().unwrap_or_default() };
            let (numerator, denominator) = (part(magnitude.numer().to_string()), part(magnitude.denom().to_string()));
            quote!((#numerator / #denominator))
        }
    };
    if negative { quote!((-#tokens)) } else { tokens }
}

/// The decimal fraction of a positive rational whose denominator divides a power of ten, in at most 40 digits.
fn decimal(value: &Rational) -> Option<String> {
    let mut scaled = value.clone();
    for digits in 0..=40_usize {
        if scaled.is_integer() {
            let text = scaled.numer().to_string();
            if text.len() > 60 {
                return None;
            }
            return Some(match digits {
                0 => format!("{text}.0"),
                7.. => format!("{text}e-{digits}"),
                _ => {
                    let padded = format!("{text:0>width$}", width = digits + 1);
                    let point = padded.len() - digits;
                    format!("{}.{}", &padded[..point], &padded[point..])
                }
            });
        }
        scaled *= integer(10);
    }
    None
}

/// The body of a kernel that returns its outputs nested as configuration or element, or its only output.
pub fn body(scope: &Scope<'_, '_>, kernel: &Kernel, nesting: Option<Nesting>) -> TokenStream {
    let (locals, value) = (locals(scope, kernel), value(scope, kernel, nesting));
    quote!(#locals #value)
}

/// What a kernel returns, behind its shared terms.
pub fn value(scope: &Scope<'_, '_>, kernel: &Kernel, nesting: Option<Nesting>) -> TokenStream {
    match nesting {
        Some(nesting) => {
            let structure = match nesting {
                Nesting::Configuration => &scope.model.configuration,
                Nesting::Element => &scope.model.element,
            };
            nested(structure, &mut |leaf| {
                let (shape, entries) = &kernel.outputs[leaf];
                grid(scope, *shape, entries, scope.is_quaternion(nesting, leaf))
            })
        }
        None => grid(scope, kernel.outputs[0].0, &kernel.outputs[0].1, false),
    }
}

/// The shared terms of a kernel.
pub fn locals(scope: &Scope<'_, '_>, kernel: &Kernel) -> TokenStream {
    let mut tokens = TokenStream::new();
    for (index, code) in kernel.locals.iter().enumerate() {
        word(&mut tokens, "let");
        word(&mut tokens, &format!("t{index}"));
        tokens.extend(scope.type_of(code));
        operator(&mut tokens, '=');
        scope.write(&mut tokens, code, false);
        operator(&mut tokens, ';');
    }
    tokens
}

/// Those of the shared terms whose index passes a test.
pub fn locals_where(scope: &Scope<'_, '_>, kernel: &Kernel, test: impl Fn(usize) -> bool) -> TokenStream {
    let locals = kernel.locals.iter().enumerate().filter(|(index, _)| test(*index));
    let locals = locals.map(|(index, code)| {
        let (name, matrix, value) = (format_ident!("t{index}"), scope.type_of(code), scope.code(code, false));
        quote!(let #name #matrix = #value;)
    });
    quote!(#(#locals)*)
}

/// A matrix of entries, row by row, whatever its shape; the entries that are not zero one by one, with their places, where rows are long and most are.
pub fn matrix(scope: &Scope<'_, '_>, shape: Shape, entries: &[Code]) -> TokenStream {
    let private = &scope.paths.private;
    let is_zero = |entry: &Code| matches!(entry, Code::Number(value) if value.is_zero());
    let zeros = entries.iter().filter(|entry| is_zero(entry)).count();
    if shape.columns > LONGEST_ROW && 2 * zeros > entries.len() {
        let [rows, columns] = [shape.rows, shape.columns].map(Literal::usize_unsuffixed);
        let zero = scope.code(&Code::Number(Rational::zero()), false);
        let kept = entries.iter().enumerate().filter(|(_, entry)| !is_zero(entry)).map(|(place, entry)| {
            let [i, j] = [place / shape.columns, place % shape.columns].map(Literal::usize_unsuffixed);
            let entry = scope.code(entry, false);
            quote!(matrix[(#i, #j)] = #entry;)
        });
        return quote!({
            let mut matrix = #private::matrix([[#zero; #columns]; #rows]);
            #(#kept)*
            matrix
        });
    }
    let rows = entries.chunks(shape.columns.max(1)).map(|row| entries_of(scope, row).into());
    let rows = list(rows);
    quote!(#private::matrix(#rows))
}

/// More entries are no longer told apart in a row.
const LONGEST_ROW: usize = 8;

/// A matrix, vector or quaternion of entries.
pub fn grid(scope: &Scope<'_, '_>, shape: Shape, entries: &[Code], is_quaternion: bool) -> TokenStream {
    let private = &scope.paths.private;
    if let [whole] = entries
        && !shape.is_scalar()
    {
        return scope.code(whole, false);
    }
    match shape.columns {
        _ if is_quaternion => {
            let entries = entries_of(scope, entries);
            quote!(#private::quaternion(#entries))
        }
        1 => {
            let entries = entries_of(scope, entries);
            quote!(#private::vector(#entries))
        }
        _ => matrix(scope, shape, entries),
    }
}

fn entries_of(scope: &Scope<'_, '_>, entries: &[Code]) -> TokenTree {
    list(entries.iter().map(|entry| scope.code(entry, false)))
}

/// Tuples and arrays of leaves.
pub fn nested(structure: &Layout, leaf: &mut impl FnMut(usize) -> TokenStream) -> TokenStream {
    match structure {
        Layout::Leaf(index) => leaf(*index),
        Layout::Tuple(parts) => {
            let parts: Vec<_> = parts.iter().map(|part| nested(part, leaf)).collect();
            quote!((#(#parts,)*))
        }
        Layout::Array(parts) => {
            let parts: Vec<_> = parts.iter().map(|part| nested(part, leaf)).collect();
            quote!([#(#parts),*])
        }
    }
}

/// A sum or difference of two configurations, leaf by leaf. Quaternions over a type parameter add through their coordinates alone.
pub fn combined(
    model: &System<'_>,
    a: &TokenStream,
    operator: TokenStream,
    b: &TokenStream,
    paths: &Paths,
) -> TokenStream {
    let private = &paths.private;
    nested(&model.configuration, &mut |leaf| {
        let configuration = &model.configurations[leaf];
        let access = accessor(&configuration.accessor);
        match configuration.is_quaternion {
            true => quote!(#private::Quaternion { coords: #a #access.coords #operator #b #access.coords }),
            false => quote!(#a #access #operator #b #access),
        }
    })
}

/// The type of a nesting of leaves.
pub fn nested_type(structure: &Layout, leaf: &impl Fn(usize) -> TokenStream) -> TokenStream {
    match structure {
        Layout::Leaf(index) => leaf(*index),
        Layout::Tuple(parts) => {
            let parts = parts.iter().map(|part| nested_type(part, leaf));
            quote!((#(#parts,)*))
        }
        Layout::Array(parts) => {
            let count = Literal::usize_unsuffixed(parts.len());
            let part = parts.first().map(|part| nested_type(part, leaf));
            quote!([#part; #count])
        }
    }
}
