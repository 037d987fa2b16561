//! What is emitted beside an error: an implementation with the right types, so that the user sees that error alone and the
//! editor keeps working. It is never run, because the error is there.

use clebsch_symbolic::Group;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::nested_type;
use crate::model::{Outline, ScalarType};
use crate::parse::Declaration;

/// The implementation of the trait for a declaration with an error.
pub fn stub(declaration: &Declaration, outline: &Outline) -> TokenStream {
    let krate = match &declaration.dials.krate {
        Some(path) => quote!(#path),
        None => quote!(::clebsch),
    };
    let (ident, name) = (&declaration.ident, declaration.ident.to_string());
    let (parameters, arguments, predicates) = declaration.generics.split_for_impl();
    let predicates: Vec<_> = predicates.map(|clause| &clause.predicates).into_iter().flatten().collect();
    let (scalar, bound) = match &outline.scalar {
        ScalarType::F32 => (quote!(::core::primitive::f32), None),
        ScalarType::F64 => (quote!(::core::primitive::f64), None),
        ScalarType::Parameter(ident) => (quote!(#ident), Some(quote!(#ident: #krate::__private::Scalar,))),
    };
    let matrix = |rows: usize, columns: usize| {
        let (rows, columns) = (Literal::usize_unsuffixed(rows), Literal::usize_unsuffixed(columns));
        quote!(#krate::__private::SMatrix<#scalar, #rows, #columns>)
    };
    let configuration = nested_type(&outline.configuration, &|leaf| {
        let shape = outline.shapes[leaf];
        match outline.quaternions[leaf] {
            true => quote!(#krate::__private::Quaternion<#scalar>),
            false => matrix(shape.rows, shape.columns),
        }
    });
    let input = nested_type(&outline.input, &|leaf| matrix(outline.inputs[leaf].rows, outline.inputs[leaf].columns));
    let time = if outline.takes_time { quote!(#krate::__private::Clock<#scalar>) } else { quote!(()) };
    let element = nested_type(&outline.element, &|factor| {
        let shape = outline.groups[factor].element_shape();
        match outline.groups[factor] {
            Group::UnitQuaternions => quote!(#krate::__private::Quaternion<#scalar>),
            _ => matrix(shape.rows, shape.columns),
        }
    });
    let momentum = matrix(outline.groups.iter().map(|group| group.dimension()).sum(), 1);
    let of_sites = |ty: TokenStream| match &outline.sites {
        Some(length) => quote!([#ty; #length]),
        None => ty,
    };
    let [configuration, element, momentum] = [configuration, element, momentum].map(of_sites);
    let dimension: usize = outline.groups.iter().map(|group| group.dimension()).sum();
    let place = match declaration.kinetic.is_steered() {
        true => (configuration.clone(), dimension),
        false => (quote!((#configuration, #momentum)), 2 * dimension),
    };
    let inputs = outline.inputs.iter().map(|shape| shape.len()).sum();
    let controlled = controlled(declaration, &krate, &scalar, place, inputs);
    let controlled = controlled.map(|(name, body)| {
        quote! {
            #[automatically_derived]
            #[allow(unused_variables, reason = "no body reads its arguments")]
            impl #parameters #krate::#name for #ident #arguments where #(#predicates,)* #bound { #body }
        }
    });
    if declaration.kinetic.is_steered() {
        return quote!(#controlled);
    }
    let formulas = formulas(&krate, &scalar);
    let methods = methods(&krate, declaration, &scalar, &bound);
    quote! {
        #controlled
        #[automatically_derived]
        #[allow(unused_variables, reason = "no body reads its arguments")]
        impl #parameters #krate::Clebsch for #ident #arguments where #(#predicates,)* #bound {
            type Scalar = #scalar;
            type Configuration = #configuration;
            type Element = #element;
            type Momentum = #momentum;
            type MomentumMatrix = #element;
            type Input = #input;
            type Time = #time;
            type Constants = ();
            type Scheme = #krate::__private::Unstepped;
            const NAME: &'static ::core::primitive::str = #name;
            const ORDER: ::core::primitive::u32 = 0;
            const DERIVATION: &'static ::core::primitive::str = "";
            #formulas
        }
        #methods
    }
}

/// The declared methods, as the unit structs of the user implement them.
fn methods(
    krate: &TokenStream,
    declaration: &Declaration,
    scalar: &TokenStream,
    bound: &Option<TokenStream>,
) -> TokenStream {
    let (parameters, arguments, predicates) = declaration.generics.split_for_impl();
    let predicates: Vec<_> = predicates.map(|clause| &clause.predicates).into_iter().flatten().collect();
    let ident = &declaration.ident;
    let system = quote!(#ident #arguments);
    let [configuration, element, momentum] = ["Configuration", "Element", "Momentum"].map(|name| {
        let name = format_ident!("{name}");
        quote!(<#system as #krate::Clebsch>::#name)
    });
    let signatures = [
        quote!(constants(system: &#system, h: #scalar) -> ::core::result::Result<(), #krate::Error>),
        quote!(legendre(system: &#system, h: #scalar, t: #scalar, q: &#configuration, f: &#element) -> #momentum),
        quote!(legendre_next(system: &#system, h: #scalar, t: #scalar, q: &#configuration, f: &#element) -> #momentum),
        quote!(kinetic_energy(system: &#system, constants: &(), t: #scalar, q: &#configuration, mu: &#momentum) -> #scalar),
    ];
    let methods = declaration.methods.iter().map(|method| {
        let name = &method.name;
        quote! {
            #[automatically_derived]
            #[allow(unused_variables, reason = "no body reads its arguments")]
            impl #parameters #krate::Method<#system> for #name where #(#predicates,)* #bound {
                type Constants = ();
                type Scheme = #krate::__private::Unstepped;
                const ORDER: ::core::primitive::u32 = 0;
                const DERIVATION: &'static ::core::primitive::str = "";
                #(fn #signatures { ::core::unreachable!("the declaration has an error") })*
            }
        }
    });
    quote!(#(#methods)*)
}

/// All methods of the trait, none of which is ever called.
fn formulas(krate: &TokenStream, scalar: &TokenStream) -> TokenStream {
    let configuration = quote!(Self::Configuration);
    let result = |value: TokenStream| quote!(::core::result::Result<#value, #krate::Error>);
    let constants = result(quote!(()));
    let signatures = [
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
    ];
    quote!(#(fn #signatures { ::core::unreachable!("the declaration has an error") })*)
}

/// The trait `Controlled` with its sizes, and its items, where the declaration chooses inputs.
fn controlled(
    declaration: &Declaration,
    krate: &TokenStream,
    scalar: &TokenStream,
    (place, dimension): (TokenStream, usize),
    inputs: usize,
) -> Option<(TokenStream, TokenStream)> {
    let bounds = match declaration.control.as_ref()?.bounds.as_ref().map(|closure| &closure.body) {
        Some(syn::Expr::Array(list)) => list.elems.len(),
        _ => 0,
    };
    let name = declaration.ident.to_string();
    let [d, u, c] = [dimension, inputs, bounds].map(Literal::usize_unsuffixed);
    let vector = |size: &Literal| quote!(#krate::__private::SVector<#scalar, #size>);
    let (costate, input, values) = (vector(&d), vector(&u), vector(&c));
    let result = |value: TokenStream| quote!(::core::result::Result<#value, #krate::Error>);
    let (done, reached, time) = (result(quote!(())), result(quote!(#place)), result(quote!(#scalar)));
    let expansion = result(quote!(#krate::Expansion<#place, #scalar, #d, #u>));
    let signatures = [
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
    ];
    let body = quote! {
        type Scalar = #scalar;
        type Place = #place;
        type Constants = ();
        const NAME: &'static ::core::primitive::str = #name;
        const BOUNDS: [&'static ::core::primitive::str; #c] = [""; #c];
        const MOTIONS: ::core::primitive::usize = #d;
        #(fn #signatures { ::core::unreachable!("the declaration has an error") })*
    };
    Some((quote!(Controlled<#d, #u, #c>), body))
}
