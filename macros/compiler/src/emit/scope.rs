//! Where functions find their inputs, and the code of kernels there.

use std::cell::RefCell;
use std::hash::Hash;
use std::ops::Deref;

use clebsch_symbolic::{Elements, Group, Rational, Role, Shape, Symbol, Table, both};
use proc_macro2::{Literal, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};

use super::SystemEmitter;
use super::code::{list, operator, word};
use crate::lower::{Code, Input, Kernel};
use crate::model::{Access, Layout, Part};

/// Where a function finds its inputs.
pub(super) struct Scope<'a, 'g> {
    pub emitter: &'a SystemEmitter<'a, 'g>,
    /// The user's struct: `self` or `self.system`.
    pub system: TokenStream,
    /// The constants: `self.constants`, or nothing while they are being made.
    pub constants: Option<TokenStream>,
    /// Which of all components of the momentum `mu` holds, in order.
    pub momenta: Vec<usize>,
    /// Which of all components `x` holds, in order.
    pub coordinates: Vec<usize>,
    /// The tokens of entries, which stand in code many times.
    pub reads: RefCell<Table<Input, TokenStream>>,
    /// The tokens of numbers.
    pub numbers: RefCell<Table<Rational, TokenStream>>,
}

impl<'a, 'g> Deref for Scope<'a, 'g> {
    type Target = SystemEmitter<'a, 'g>;

    fn deref(&self) -> &SystemEmitter<'a, 'g> {
        self.emitter
    }
}

/// Where an argument of a function stands.
pub(super) enum Place<'s> {
    /// A leaf of the argument of this name.
    Leaf(String, &'s Access),
    /// In the flat vector of this name, which holds some of all components: those from this one on.
    Vector(&'static str, &'s [usize], usize),
}

/// The size of an array, or an index.
pub fn size(number: usize) -> Literal {
    Literal::usize_unsuffixed(number)
}

/// The index of an entry.
pub fn index(is_vector: bool, (row, column): (usize, usize)) -> TokenStream {
    let (row, column) = (size(row), size(column));
    if is_vector { quote!([#row]) } else { quote!([(#row, #column)]) }
}

/// Tokens that reach a leaf: `.0[1]`.
impl ToTokens for Access {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        for part in self.parts() {
            tokens.extend(match part {
                Part::Field(position) => {
                    let position = size(*position);
                    quote!(.#position)
                }
                Part::Index(position) => index(true, (*position, 0)),
                Part::Site(place) => {
                    let index = format_ident!("at{place}");
                    quote!([#index])
                }
            });
        }
    }
}

/// The tokens of a key, spelled once.
pub(super) fn spelled<K: Hash + Eq + Clone>(
    known: &RefCell<Table<K, TokenStream>>,
    key: &K,
    spell: impl FnOnce() -> TokenStream,
) -> TokenStream {
    if let Some(tokens) = known.borrow().get(key) {
        return tokens.clone();
    }
    let tokens = spell();
    known.borrow_mut().insert(key.clone(), tokens.clone());
    tokens
}

impl Scope<'_, '_> {
    /// The place of the argument with a role; `None` if the role is no argument.
    pub(super) fn place(&self, role: Role) -> Option<Place<'_>> {
        let leaf = |name: &str, access| Place::Leaf(name.to_string(), access);
        let configuration = |name: &str, i: usize| leaf(name, &self.model.configurations[i].accessor);
        let factor = |name: &str, k: usize| leaf(name, &self.model.factors[k].accessor);
        Some(match role {
            Role::Configuration(i) => configuration("q", i),
            Role::Image(i) => configuration("next", i),
            Role::At(place, i) => configuration(&format!("q{place}"), i),
            Role::Covector(i) => configuration("p", i),
            Role::Input(i) => leaf("u", &self.model.inputs[i].accessor),
            Role::Reference(i) => leaf("reference", &self.model.reference.1[i].accessor),
            Role::EndReference(i) => leaf("end_reference", &self.model.end_reference.1[i].accessor),
            Role::Element(k) => factor("f", k),
            Role::Increment(k) => factor("d", k),
            Role::Following(k) => factor("second", k),
            Role::MomentumMatrix(k) => factor("m", k),
            Role::Momentum(k) => Place::Vector("mu", &self.momenta, self.model.offset(k)),
            Role::Chart(block) => Place::Vector("x", &self.coordinates, self.symbols.blocks[block].offset),
            Role::Algebra(k) | Role::Cayley(k) => Place::Vector("x", &self.coordinates, self.model.offset(k)),
            Role::Logarithm(k) => Place::Vector("y", &self.coordinates, self.model.offset(k)),
            Role::Motion(0, k) => Place::Vector("motion", &self.coordinates, self.model.offset(k)),
            Role::Motion(_, k) => Place::Vector("next_motion", &self.coordinates, self.model.offset(k)),
            Role::Direction(block) => Place::Vector("delta", &self.coordinates, self.symbols.blocks[block].offset),
            _ => return None,
        })
    }

    pub(super) fn read(&self, input: &Input) -> TokenStream {
        spelled(&self.reads, input, || self.spell_read(input))
    }

    fn spell_read(&self, input: &Input) -> TokenStream {
        let index = index(input.shape.is_column(), (input.row, input.column));
        match self.place(input.role) {
            Some(Place::Leaf(name, access)) => {
                let name = format_ident!("{name}");
                return quote!(#name #access #index);
            }
            Some(Place::Vector(name, held, first)) => {
                let wanted = first + input.row;
                // by construction: kernels read entries that their vectors have
                let position = held.iter().position(|&component| component == wanted).unwrap_or(wanted);
                let (name, position) = (format_ident!("{name}"), size(position));
                return quote!(#name[#position]);
            }
            None => {}
        }
        match input.role {
            Role::StepSize => match &self.constants {
                // terms of h alone are constants of unrolled code, and terms of h and t read h itself
                Some(constants) => quote!(#constants.step_size),
                None => quote!(h),
            },
            Role::Time => quote!(t),
            Role::Parameter(leaf) => self.parameter(leaf, index),
            Role::Constant(index) => self.constant_of_crate(index),
            Role::Site(depth) => {
                let index = format_ident!("i{depth}");
                self.rounded(quote!(#index as ::core::primitive::f64))
            }
            Role::Sites => {
                let length = &self.length;
                self.rounded(quote!(#length as ::core::primitive::f64))
            }
            Role::Spacing(direction) => {
                let direction = size(direction);
                quote!(spacing[#direction])
            }
            Role::Multiplier => quote!(kappa #index),
            Role::Reaction(number) => {
                // by construction: there are as many
                let name = REACTIONS.get(number).map(|name| format_ident!("{name}"));
                quote!(#name #index)
            }
            Role::Weight => quote!(z #index),
            Role::ChartWeight(number) => {
                let number = size(number);
                quote!(w[#number])
            }
            Role::IncrementScale(number) => {
                let number = size(number);
                quote!(scale[#number])
            }
            Role::Kick => quote!(weight),
            Role::KickGradient => quote!(gradient),
            Role::InertiaInverse => match &self.constants {
                Some(constants) if self.keeps_matrices => quote!(#constants.inertia_inverse.matrix() #index),
                Some(constants) => quote!(#constants.inertia_inverse #index),
                None => quote!(inertia_inverse #index),
            },
            // by construction: nothing that is computed reads the symbols of checks and of print
            _ => TokenStream::new(),
        }
    }

    pub(super) fn parameter(&self, leaf: usize, index: TokenStream) -> TokenStream {
        let of_terms = self.power.into_iter().flat_map(|power| &power.parameters);
        let all = self.model.parameters.iter().chain(of_terms);
        let mut all = all.flat_map(|parameter| parameter.leaves.iter().map(move |leaf| (parameter, leaf)));
        let is_leaf = |data: Symbol| data.role == Role::Parameter(leaf);
        // by construction: the role of a parameter's symbol is that of one leaf
        let Some((parameter, leaf)) = all.find(|(_, leaf)| leaf.symbol.as_symbol().is_some_and(is_leaf)) else {
            return quote!();
        };
        let mut field = parameter.field.clone();
        if let syn::Member::Named(ident) = &mut field {
            ident.set_span(parameter.first_use);
        }
        let (system, access) = (&self.system, &leaf.accessor);
        let index = (!leaf.is_scalar).then_some(index);
        quote!(#system.#field #access #index)
    }

    fn constant_of_crate(&self, index: usize) -> TokenStream {
        let path = &self.model.constants[index].path;
        let path = self.names.of_user(quote!(#path));
        quote!(runtime::constant::<T>(#path))
    }

    /// A number in the precision of the scalar.
    pub(super) fn rounded(&self, value: TokenStream) -> TokenStream {
        quote!(<T as runtime::Scalar>::from_f64(#value))
    }

    /// The shared terms of a kernel.
    pub fn locals(&self, kernel: &Kernel) -> TokenStream {
        self.locals_where(kernel, |_| true)
    }

    /// Those of the shared terms whose index passes a test.
    pub fn locals_where(&self, kernel: &Kernel, test: impl Fn(usize) -> bool) -> TokenStream {
        let mut tokens = TokenStream::new();
        for (index, code) in kernel.locals.iter().enumerate().filter(|(index, _)| test(*index)) {
            word(&mut tokens, "let");
            word(&mut tokens, &format!("t{index}"));
            tokens.extend(self.type_of(code));
            operator(&mut tokens, '=');
            self.write(&mut tokens, code, false);
            operator(&mut tokens, ';');
        }
        tokens
    }

    /// The shared terms of a kernel and its only output, a vector or a matrix.
    pub fn body(&self, kernel: &Kernel) -> TokenStream {
        let (locals, value) = (self.locals(kernel), self.output(kernel, 0));
        quote!(#locals #value)
    }

    /// The outputs of a kernel nested as the configuration.
    pub fn configuration(&self, kernel: &Kernel) -> TokenStream {
        nested(&self.model.configuration, &mut |leaf| {
            self.grid(&kernel.outputs[leaf], self.model.configurations[leaf].is_quaternion)
        })
    }

    /// The outputs of a kernel from one on, nested as the group element.
    pub fn element(&self, kernel: &Kernel, first: usize) -> TokenStream {
        nested(&self.model.element, &mut |k| {
            self.grid(&kernel.outputs[first + k], self.model.factors[k].group == Group::UnitQuaternions)
        })
    }

    /// An output of a kernel, a vector or a matrix even where it has one entry.
    pub fn output(&self, kernel: &Kernel, index: usize) -> TokenStream {
        self.grid(&kernel.outputs[index], false)
    }

    /// An output of a kernel, a matrix even where it has one row, column or entry.
    pub fn whole_matrix(&self, kernel: &Kernel, index: usize) -> TokenStream {
        self.matrix(&kernel.outputs[index])
    }

    /// An output of a kernel that is a scalar.
    pub fn scalar(&self, kernel: &Kernel, index: usize) -> TokenStream {
        self.code(&kernel.outputs[index].1[0], false)
    }

    /// The shared terms of a kernel and its only output, a scalar.
    pub fn body_of_scalar(&self, kernel: &Kernel) -> TokenStream {
        let (locals, value) = (self.locals(kernel), self.scalar(kernel, 0));
        quote!(#locals #value)
    }

    /// A matrix, vector or quaternion of entries.
    pub fn grid(&self, output: &(Shape, Vec<Code>), is_quaternion: bool) -> TokenStream {
        let (shape, entries) = output;
        if entries.len() == 1 && !shape.is_scalar() {
            return self.code(&entries[0], false);
        }
        if shape.columns != 1 && !is_quaternion {
            return self.matrix(output);
        }
        let (function, entries) = (if is_quaternion { quote!(quaternion) } else { quote!(vector) }, self.list(entries));
        quote!(runtime::#function(#entries))
    }

    /// A matrix of entries, row by row, whatever its shape. If rows are long and most entries are zero, only the others
    /// are written, each with its place.
    fn matrix(&self, (shape, entries): &(Shape, Vec<Code>)) -> TokenStream {
        let is_zero = |entry: &Code| matches!(entry, Code::Number(value) if value.is_zero());
        let zeros = entries.iter().filter(|entry| is_zero(entry)).count();
        if shape.columns > LONGEST_ROW && 2 * zeros > entries.len() {
            let [rows, columns] = both([shape.rows, shape.columns], size);
            let zero = self.number(&Rational::zero());
            let kept = entries.iter().enumerate().filter(|(_, entry)| !is_zero(entry)).map(|(place, entry)| {
                let index = index(false, (place / shape.columns, place % shape.columns));
                let entry = self.code(entry, false);
                quote!(matrix #index = #entry;)
            });
            return quote!({
                let mut matrix = runtime::matrix([[#zero; #columns]; #rows]);
                #(#kept)*
                matrix
            });
        }
        let rows = list(entries.chunks(shape.columns.max(1)).map(|row| self.list(row).into()));
        quote!(runtime::matrix(#rows))
    }

    fn list(&self, entries: &[Code]) -> TokenTree {
        list(entries.iter().map(|entry| self.code(entry, false)))
    }
}

/// The names of the multipliers of a constraint.
pub(super) const REACTIONS: [&str; 5] = ["lambda", "nu", "landed", "sigma", "rho"];

/// More entries are no longer told apart in a row.
const LONGEST_ROW: usize = 8;

/// Tuples and arrays of leaves.
pub fn nested(structure: &Layout, leaf: &mut impl FnMut(usize) -> TokenStream) -> TokenStream {
    laid_out(structure, leaf, |parts| quote!([#(#parts),*]))
}

/// The type of a nesting of leaves.
pub fn nested_type(structure: &Layout, mut leaf: impl FnMut(usize) -> TokenStream) -> TokenStream {
    laid_out(structure, &mut leaf, |parts| {
        let (part, count) = (parts.first(), size(parts.len()));
        quote!([#part; #count])
    })
}

fn laid_out(
    structure: &Layout,
    leaf: &mut dyn FnMut(usize) -> TokenStream,
    array: fn(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let mut each = |parts: &[Layout]| parts.each(|part| laid_out(part, leaf, array));
    match structure {
        Layout::Leaf(index) => leaf(*index),
        Layout::Tuple(parts) => {
            let parts = each(parts);
            quote!((#(#parts,)*))
        }
        Layout::Array(parts) => array(&each(parts)),
    }
}
