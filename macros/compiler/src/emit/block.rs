//! The block that generated items stand in: its names, its types, and the struct that they are generated for.

use clebsch_symbolic::{IntoList, Shape};
use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, quote};
use syn::parse_quote;

use super::names::{self, Names};
use super::scope::size;
use crate::model::ScalarType;

/// The names and types in signatures of an expansion. The other side of its paths is the runtime's module `__private`.
#[derive(Clone)]
pub(super) struct Block<'a> {
    /// The runtime crate.
    pub krate: TokenStream,
    pub scalar: &'a ScalarType,
    /// The types of q, F and μ.
    pub types: [TokenStream; 3],
    pub input: TokenStream,
    /// The components of a momentum.
    pub dimension: usize,
    /// The method that is emitted, where it is not that of the declared dials.
    pub method: Option<&'a Ident>,
    /// The user's struct; of a power that of a site.
    pub target: Target,
    pub names: Names,
}

impl Block<'_> {
    /// Items under the names that they are written with.
    pub(super) fn named(&self, items: &TokenStream) -> TokenStream {
        let Block { krate, types: [q, f, mu], .. } = self;
        let scalar = (!self.is_generic()).then(|| self.spelled(&quote!(T)));
        let scalar = scalar.map(|scalar| quote!(type T = #scalar;));
        let krate = self.names.of_user(krate.clone());
        self.names.put_in(quote! {
            use #krate::__private as runtime;
            #scalar
            type Q = #q;
            type F = #f;
            type Mu = #mu;
            #items
        })
    }

    /// A type as it is spelled where no name of the expansion is in scope.
    pub(super) fn spelled(&self, ty: &TokenStream) -> TokenStream {
        let krate = self.names.of_user(self.krate.clone());
        names::put_in(ty.clone(), &|name, _| match (name, self.scalar) {
            ("runtime", _) => Some(quote!(#krate::__private)),
            ("T", ScalarType::F32) => Some(quote!(::core::primitive::f32)),
            ("T", ScalarType::F64) => Some(quote!(::core::primitive::f64)),
            _ => None,
        })
    }

    /// Whether the scalar is a type parameter.
    pub(super) fn is_generic(&self) -> bool {
        self.scalar.is_parameter()
    }

    /// How the system is called where it is stepped: `self`, but in the implementation of `Method`.
    pub(super) fn receiver(&self) -> TokenStream {
        if self.method.is_some() { quote!(system) } else { quote!(self) }
    }

    /// The type of a vector, by its name where it has one.
    pub(super) fn vector_type(&self, rows: usize) -> TokenStream {
        if rows == self.dimension { quote!(Mu) } else { matrix(rows, 1) }
    }
}

/// Items that are compiled where they stand. The lints of straight-line code are ours to mind, not the user's.
/// Signatures are the same for every system, and not every body reads all of its arguments.
pub(super) fn anonymous(items: &TokenStream) -> TokenStream {
    quote! {
        #[allow(clippy::all, clippy::pedantic, unused_imports, unused_mut, unused_parens, unused_variables, dead_code)]
        const _: () = {
            #items
        };
    }
}

/// The types that `Clebsch` asks for, apart from those of steps.
pub(super) fn types_of_system([q, f, mu]: &[TokenStream; 3], input: &TokenStream, time: &TokenStream) -> TokenStream {
    quote! {
        type Scalar = T;
        type Configuration = #q;
        type Element = #f;
        type Momentum = #mu;
        type MomentumMatrix = #f;
        type Input = #input;
        type Time = #time;
    }
}

/// The type by which steps know the time.
pub(super) fn time_type(is_timed: bool) -> TokenStream {
    if is_timed { quote!(runtime::Clock<T>) } else { quote!(()) }
}

/// The type of an array of this shape, or of a quaternion.
pub(super) fn leaf(shape: Shape, is_quaternion: bool) -> TokenStream {
    if is_quaternion { quote!(runtime::Quaternion<T>) } else { matrix(shape.rows, shape.columns) }
}

/// `SVector<T, r>`, or a matrix.
pub(super) fn matrix(rows: usize, columns: usize) -> TokenStream {
    let (length, width) = (size(rows), size(columns));
    if columns == 1 { quote!(runtime::SVector<T, #length>) } else { quote!(runtime::SMatrix<T, #length, #width>) }
}

impl ScalarType {
    /// Whether it is a type parameter.
    pub(super) fn is_parameter(&self) -> bool {
        matches!(self, ScalarType::Parameter(_))
    }
}

/// A struct that code is generated for.
#[derive(Clone)]
pub(super) struct Target {
    /// Its name.
    pub name: String,
    /// The same in code.
    pub ident: TokenStream,
    /// Its parameters, as it declares them and as arguments, and their bounds, with the bound of the scalar.
    pub parameters: TokenStream,
    arguments: TokenStream,
    pub predicates: Option<TokenStream>,
    generics: syn::Generics,
}

impl Target {
    /// The struct with this name.
    pub(super) fn new(ident: &Ident, generics: &syn::Generics, scalar: &ScalarType, names: &Names) -> Target {
        let (name, (parameters, arguments, _)) = (ident.to_string(), generics.split_for_impl());
        let [ident, parameters, arguments] =
            [quote!(#ident), quote!(#parameters), quote!(#arguments)].map(|tokens| names.of_user(tokens));
        let predicates = generics.where_clause.iter().flat_map(|clause| &clause.predicates);
        let predicates = predicates.map(|predicate| names.of_user(predicate.to_token_stream()));
        let predicates = predicates.chain(scalar.is_parameter().then(|| quote!(T: runtime::Scalar)));
        let predicates: Vec<TokenStream> = predicates.into_list();
        let predicates = (!predicates.is_empty()).then(|| quote!(where #(#predicates),*));
        Target { name, ident, parameters, arguments, predicates, generics: generics.clone() }
    }

    /// Its type.
    pub(super) fn of_type(&self) -> TokenStream {
        let Target { ident, arguments, .. } = self;
        quote!(#ident #arguments)
    }

    /// An implementation of a trait, or of functions of its own.
    pub(super) fn implementation(&self, of: Option<TokenStream>, items: TokenStream) -> TokenStream {
        let Target { ident, parameters, arguments, predicates, .. } = self;
        let of = of.map(|of| quote!(#of for));
        quote!(impl #parameters #of #ident #arguments #predicates { #items })
    }

    /// The same, where documentation shows it.
    pub(super) fn derived(&self, of: Option<TokenStream>, items: TokenStream) -> TokenStream {
        let implementation = self.implementation(of, items);
        quote!(#[automatically_derived] #implementation)
    }
}

impl Block<'_> {
    /// A struct of this name that borrows the user's.
    pub(super) fn borrowed(&self, ident: &Ident) -> Target {
        let (mut generics, lifetime) = (self.target.generics.clone(), self.names.lifetime());
        generics.params.insert(0, parse_quote!(#lifetime));
        Target::new(ident, &generics, self.scalar, &self.names)
    }

    /// The items that depend on how the system is stepped, by a unit struct of the user.
    pub(super) fn implementation_of_method(&self, name: &Ident, stepping: &TokenStream) -> TokenStream {
        let Target { parameters, predicates, .. } = &self.target;
        let (system, name) = (self.target.of_type(), self.names.of_user(quote!(#name)));
        quote! {
            #[automatically_derived]
            impl #parameters runtime::Method<#system> for #name #predicates { #stepping }
        }
    }
}
