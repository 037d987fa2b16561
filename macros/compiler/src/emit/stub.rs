//! What is emitted beside an error: an implementation with the right types, so that the user sees that error alone and the
//! editor keeps working. It is never run, because the error is there.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::scope::{nested_type, size};
use super::system::types_of_system;
use super::types::{Paths, Target};
use crate::model::Outline;
use crate::parse::Declaration;

/// The implementation of the trait for a declaration with an error.
pub fn stub(declaration: &Declaration, outline: &Outline) -> TokenStream {
    let krate = declaration.dials.krate.as_ref().map_or(quote!(::clebsch), |path| quote!(#path));
    let paths = Paths::new(&krate, &outline.scalar);
    let target = Target::new(&declaration.ident, &declaration.generics, &outline.scalar, &paths.private);
    let Paths { private, scalar, .. } = &paths;
    let [configuration, element, input] =
        [&outline.configuration, &outline.element, &outline.input].map(|(layout, leaves)| {
            nested_type(layout, |leaf| match leaves[leaf] {
                (shape, true) => paths.leaf(shape, true),
                (shape, false) => paths.matrix_of_any_shape(shape.rows, shape.columns),
            })
        });
    let dimension = outline.dimension;
    let momentum = paths.matrix_of_any_shape(dimension, 1);
    let of_sites = |ty: TokenStream| match &outline.sites {
        Some(length) => quote!([#ty; #length]),
        None => ty,
    };
    let places = [configuration, element, momentum].map(of_sites);
    let [configuration, _, momentum] = &places;
    let is_steered = declaration.kinetic.is_steered();
    let place = if is_steered {
        (configuration.clone(), dimension)
    } else {
        (quote!((#configuration, #momentum)), 2 * dimension)
    };
    let inputs = outline.input.1.iter().map(|(shape, _)| shape.len()).sum();
    let controlled = controlled(declaration, &paths, place, inputs);
    let controlled = controlled.map(|(of, items)| unread(&target.implementation(Some(of), items)));
    if is_steered {
        return quote!(#controlled);
    }
    let name = target.ident.to_string();
    let time = if outline.takes_time { quote!(#private::Clock<#scalar>) } else { quote!(()) };
    let types = types_of_system(scalar, &places, &input, &time);
    let formulas = formulas(&krate, scalar);
    let items = quote! {
        #types
        type Constants = ();
        type Scheme = #private::Unstepped;
        const NAME: &'static ::core::primitive::str = #name;
        const ORDER: ::core::primitive::u32 = 0;
        const DERIVATION: &'static ::core::primitive::str = "";
        #formulas
    };
    let system = unread(&target.implementation(Some(quote!(#krate::Clebsch)), items));
    let methods = methods(&paths, declaration, &target);
    quote!(#controlled #system #methods)
}

/// An implementation whose functions read none of their arguments.
fn unread(implementation: &TokenStream) -> TokenStream {
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, reason = "no body reads its arguments")]
        #implementation
    }
}

/// Functions that are never called.
fn uncalled(signatures: &[TokenStream]) -> TokenStream {
    quote!(#(fn #signatures { ::core::unreachable!("the declaration has an error") })*)
}

/// The declared methods, as the unit structs of the user implement them.
fn methods(Paths { krate, private, scalar }: &Paths, declaration: &Declaration, target: &Target) -> TokenStream {
    let (system, (parameters, _, predicates)) = (target.of_type(), target.generics.split_for_impl());
    let [configuration, element, momentum] = ["Configuration", "Element", "Momentum"].map(|name| {
        let name = format_ident!("{name}");
        quote!(<#system as #krate::Clebsch>::#name)
    });
    let functions = uncalled(&[
        quote!(constants(system: &#system, h: #scalar) -> ::core::result::Result<(), #krate::Error>),
        quote!(legendre(system: &#system, h: #scalar, t: #scalar, q: &#configuration, f: &#element) -> #momentum),
        quote!(legendre_next(system: &#system, h: #scalar, t: #scalar, q: &#configuration, f: &#element) -> #momentum),
        quote!(kinetic_energy(system: &#system, constants: &(), t: #scalar, q: &#configuration, mu: &#momentum) -> #scalar),
    ]);
    let methods = declaration.methods.iter().map(|method| {
        let name = &method.name;
        unread(&quote! {
            impl #parameters #krate::Method<#system> for #name #predicates {
                type Constants = ();
                type Scheme = #private::Unstepped;
                const ORDER: ::core::primitive::u32 = 0;
                const DERIVATION: &'static ::core::primitive::str = "";
                #functions
            }
        })
    });
    methods.collect()
}

/// All methods of the trait, none of which is ever called.
fn formulas(krate: &TokenStream, scalar: &TokenStream) -> TokenStream {
    let configuration = quote!(Self::Configuration);
    let result = |value: TokenStream| quote!(::core::result::Result<#value, #krate::Error>);
    let constants = result(quote!(()));
    uncalled(&[
        quote!(constants(&self, h: #scalar) -> #constants),
        quote!(act(&self, f: &Self::Element, q: &#configuration) -> #configuration),
        quote!(momentum_map(&self, q: &#configuration, p: &#configuration) -> Self::Momentum),
        quote!(coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum),
        quote!(legendre(&self, h: #scalar, t: #scalar, q: &#configuration, f: &Self::Element) -> Self::Momentum),
        quote!(legendre_next(&self, h: #scalar, t: #scalar, q: &#configuration, f: &Self::Element) -> Self::Momentum),
        quote!(potential(&self, t: #scalar, q: &#configuration) -> #scalar),
        quote!(kinetic_energy(&self, constants: &(), t: #scalar, q: &#configuration, mu: &Self::Momentum) -> #scalar),
        quote!(momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix),
        quote!(momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum),
        quote!(orbit_defect(&self, q: &#configuration) -> #scalar),
        quote!(isotropy_defect(&self, q: &#configuration, mu: &Self::Momentum) -> #scalar),
        quote!(project_momentum(&self, q: &#configuration, mu: &Self::Momentum) -> Self::Momentum),
    ])
}

/// The trait `Controlled` with its sizes, and its items, where the declaration chooses inputs.
fn controlled(
    declaration: &Declaration,
    Paths { krate, scalar, private }: &Paths,
    (place, dimension): (TokenStream, usize),
    inputs: usize,
) -> Option<(TokenStream, TokenStream)> {
    let bounds = match declaration.control.as_ref()?.bounds.as_ref().map(|closure| &closure.body) {
        Some(syn::Expr::Array(list)) => list.elems.len(),
        _ => 0,
    };
    let name = declaration.ident.to_string();
    let [d, u, c] = [dimension, inputs, bounds].map(size);
    let [costate, input, values] = [&d, &u, &c].map(|size| quote!(#private::SVector<#scalar, #size>));
    let result = |value: TokenStream| quote!(::core::result::Result<#value, #krate::Error>);
    let (done, reached, time) = (result(quote!(())), result(quote!(#place)), result(quote!(#scalar)));
    let expansion = result(quote!(#krate::Expansion<#place, #scalar, #d, #u>));
    let functions = uncalled(&[
        quote!(prepare(&self, h: #scalar) -> #done),
        quote!(check_place(&self, x: &#place) -> #done),
        quote!(follow(&self, constants: &(), t: #scalar, x: &#place, u: &#input) -> #reached),
        quote!(price(&self, constants: &(), t: #scalar, x: &#place, u: &#input) -> #scalar),
        quote!(expand(&self, constants: &(), t: #scalar, x: &#place, u: &#input, costate: &#costate) -> #expansion),
        quote!(price_of_time(&self, constants: &(), t: #scalar, k: #scalar, x: &#place, u: &#input, costate: &#costate) -> #time),
        quote!(bounds(&self, t: #scalar, x: &#place, u: &#input) -> #values),
        quote!(bounds_expanded(&self, t: #scalar, x: &#place, u: &#input, z: &#values) -> #krate::BoundsExpansion<#scalar, #d, #u, #c>),
        quote!(endpoint(&self, t: #scalar, x: &#place) -> #scalar),
        quote!(endpoint_expanded(&self, t: #scalar, x: &#place) -> #krate::EndpointExpansion<#scalar, #d>),
        quote!(arrival(&self, x: &#place, target: &#place) -> #krate::Arrival<#scalar, #d>),
        quote!(displacement(&self, x: &#place, y: &#place) -> #costate),
    ]);
    let items = quote! {
        type Scalar = #scalar;
        type Place = #place;
        type Constants = ();
        const NAME: &'static ::core::primitive::str = #name;
        const BOUNDS: [&'static ::core::primitive::str; #c] = [""; #c];
        const MOTIONS: ::core::primitive::usize = #d;
        #functions
    };
    Some((quote!(#krate::Controlled<#d, #u, #c>), items))
}
