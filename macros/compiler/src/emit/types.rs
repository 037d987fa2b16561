//! The types that generated code names, of the runtime and of the user. The other side of this file is the runtime's module `__private`.

use clebsch_symbolic::{Group, Shape};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use syn::{Lifetime, parse_quote};

use super::names::Names;
use super::scope::{nested_type, size};
use super::{Emitter, SystemEmitter};
use crate::model::{Item, ScalarType};

impl ScalarType {
    /// Whether it is a type parameter.
    pub(super) fn is_parameter(&self) -> bool {
        matches!(self, ScalarType::Parameter(_))
    }
}

/// The paths of the runtime for one expansion.
pub struct Paths {
    /// The runtime crate.
    pub krate: TokenStream,
    /// Its module for generated code.
    pub private: TokenStream,
    /// The scalar type.
    pub scalar: TokenStream,
}

impl Paths {
    /// The paths for a scalar.
    pub fn new(krate: &TokenStream, scalar: &ScalarType) -> Paths {
        let scalar = match scalar {
            ScalarType::F32 => quote!(::core::primitive::f32),
            ScalarType::F64 => quote!(::core::primitive::f64),
            ScalarType::Parameter(ident) => quote!(#ident),
        };
        Paths { krate: krate.clone(), private: quote!(#krate::__private), scalar }
    }

    /// The same in an expansion that gives the module and the scalar names of its own.
    pub fn named(&self, item: &Item, names: &Names) -> Paths {
        let (runtime, scalar) = (names.free("runtime"), names.free("T"));
        let scalar = if item.scalar.is_parameter() { self.scalar.clone() } else { quote!(#scalar) };
        Paths { krate: self.krate.clone(), private: quote!(#runtime), scalar }
    }

    /// The type of an array of this shape, or of a quaternion.
    pub fn leaf(&self, shape: Shape, is_quaternion: bool) -> TokenStream {
        let (private, scalar) = (&self.private, &self.scalar);
        if is_quaternion { quote!(#private::Quaternion<#scalar>) } else { self.matrix(shape.rows, shape.columns) }
    }

    /// `SVector<T, r>`, or a matrix.
    pub fn matrix(&self, rows: usize, columns: usize) -> TokenStream {
        let (private, scalar, length) = (&self.private, &self.scalar, size(rows));
        if columns == 1 { quote!(#private::SVector<#scalar, #length>) } else { self.matrix_of_any_shape(rows, columns) }
    }

    /// `SMatrix<T, r, c>`, of columns too.
    pub fn matrix_of_any_shape(&self, rows: usize, columns: usize) -> TokenStream {
        let (private, scalar) = (&self.private, &self.scalar);
        let [rows, columns] = [rows, columns].map(size);
        quote!(#private::SMatrix<#scalar, #rows, #columns>)
    }
}

/// A struct that code is generated for.
pub struct Target {
    /// Its name.
    pub ident: Ident,
    /// Its generics, with the bound of the scalar.
    pub generics: syn::Generics,
}

impl Target {
    /// The struct of an item.
    pub fn new(ident: &Ident, generics: &syn::Generics, scalar: &ScalarType, private: &TokenStream) -> Target {
        let mut generics = generics.clone();
        if let ScalarType::Parameter(scalar) = scalar {
            generics.make_where_clause().predicates.push(parse_quote!(#scalar: #private::Scalar));
        }
        Target { ident: ident.clone(), generics }
    }

    /// A struct of this name that borrows it.
    pub fn borrowed(&self, ident: &Ident, lifetime: &Lifetime) -> Target {
        let mut generics = self.generics.clone();
        generics.params.insert(0, parse_quote!(#lifetime));
        Target { ident: ident.clone(), generics }
    }

    /// Its type.
    pub fn of_type(&self) -> TokenStream {
        let (ident, (_, arguments, _)) = (&self.ident, self.generics.split_for_impl());
        quote!(#ident #arguments)
    }

    /// An implementation of a trait, or of functions of its own.
    pub fn implementation(&self, of: Option<TokenStream>, items: TokenStream) -> TokenStream {
        let (ident, of) = (&self.ident, of.map(|of| quote!(#of for)));
        let (parameters, arguments, predicates) = self.generics.split_for_impl();
        quote!(impl #parameters #of #ident #arguments #predicates { #items })
    }

    /// The same, where documentation shows it.
    pub fn derived(&self, of: Option<TokenStream>, items: TokenStream) -> TokenStream {
        let implementation = self.implementation(of, items);
        quote!(#[automatically_derived] #implementation)
    }
}

impl SystemEmitter<'_, '_> {
    /// Short names for what signatures are made of.
    pub(super) fn aliases(&self) -> TokenStream {
        let (Paths { private, scalar, .. }, module, spelled) =
            (&self.paths, &self.spelled.private, &self.spelled.scalar);
        let scalar = (!self.model.item.scalar.is_parameter()).then(|| quote!(type #scalar = #spelled;));
        let names = ["Q", "F", "Mu"].map(|name| self.alias(name));
        let types = self.types(&self.paths);
        quote!(use #module as #private; #scalar #(type #names = #types;)*)
    }

    /// The types of q, F and μ.
    pub(super) fn types(&self, paths: &Paths) -> [TokenStream; 3] {
        let configuration = nested_type(&self.model.configuration, |leaf| {
            let configuration = &self.model.configurations[leaf];
            paths.leaf(configuration.shape, configuration.is_quaternion)
        });
        let element = nested_type(&self.model.element, |factor| {
            let group = self.model.factors[factor].group;
            paths.leaf(group.element_shape(), group == Group::UnitQuaternions)
        });
        [configuration, element, paths.matrix(self.model.dimension(), 1)]
    }

    /// The scalar as the argument of a type, where it is a parameter.
    pub(super) fn scalar_parameter(&self) -> Option<TokenStream> {
        let scalar = &self.paths.scalar;
        self.model.item.scalar.is_parameter().then(|| quote!(<#scalar>))
    }

    /// A type by its name in signatures: `Q`, `F`, `Mu`, or `C` for the constants.
    pub(super) fn alias(&self, name: &str) -> TokenStream {
        // momenta that are stepped alone have no configuration
        let has_scalar = name != "Q" || !self.model.configurations.is_empty();
        let (name, parameter) = (if name == "C" { "Constants" } else { name }, self.scalar_parameter());
        let (name, parameter) = (self.names.free(name), parameter.filter(|_| has_scalar));
        quote!(#name #parameter)
    }

    pub(super) fn input_type(&self) -> TokenStream {
        nested_type(&self.model.input, |leaf| self.paths.leaf(self.model.inputs[leaf].shape, false))
    }

    /// The type of a vector, by its name where it has one.
    pub(super) fn vector_type(&self, rows: usize) -> TokenStream {
        if rows == self.model.dimension() { self.alias("Mu") } else { self.paths.matrix(rows, 1) }
    }
}

impl Emitter<'_, '_> {
    /// What steps are told of the time.
    pub(super) fn time_type(&self) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        if self.formulas.is_timed() { quote!(#private::Clock<#scalar>) } else { quote!(()) }
    }

    /// The chart coordinates of all factors, with the weights of those that are given up to a factor; F − I where a motion gives that at once.
    pub(super) fn coordinates_type(&self) -> TokenStream {
        if self.formulas.turns_whole() {
            return self.alias("F");
        }
        let (momentum, scalar) = (self.alias("Mu"), &self.paths.scalar);
        match self.formulas.weighted().len() {
            0 => momentum,
            count => {
                let count = size(count);
                quote!((#momentum, [#scalar; #count]))
            }
        }
    }
}
