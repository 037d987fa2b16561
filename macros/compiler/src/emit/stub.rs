//! What is emitted beside an error: an implementation with the right types, so that the user sees that error alone and the
//! editor keeps working. It is never run, because the error is there.

use clebsch_symbolic::Group;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

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
    let predicates = predicates.map(|clause| &clause.predicates).into_iter().flatten();
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
    let methods = methods(&krate, &scalar);
    quote! {
        #[automatically_derived]
        #[allow(unused_variables, reason = "no body reads its arguments")]
        impl #parameters #krate::Clebsch for #ident #arguments where #(#predicates,)* #bound {
            type Scalar = #scalar;
            type Configuration = #configuration;
            type Element = #element;
            type Momentum = #momentum;
            type MomentumMatrix = #element;
            type Impulse = ();
            type Input = #input;
            type Time = #time;
            type Constants = ();
            const NAME: &'static ::core::primitive::str = #name;
            const ORDER: ::core::primitive::u32 = 0;
            const DERIVATION: &'static ::core::primitive::str = "";
            #methods
        }
    }
}

/// All methods of the trait, none of which is ever called.
fn methods(krate: &TokenStream, scalar: &TokenStream) -> TokenStream {
    let configuration = quote!(Self::Configuration);
    let result = |value: TokenStream| quote!(::core::result::Result<#value, #krate::Error>);
    let constants = result(quote!(()));
    let (element, step) = (result(quote!(Self::Element)), result(quote!((#configuration, Self::Momentum, ()))));
    let symmetric = result(quote!((#configuration, #configuration)));
    let signatures = [
        quote!(constants(&self, h: #scalar) -> #constants),
        quote!(act(&self, f: &Self::Element, q: &#configuration) -> #configuration),
        quote!(momentum_map(&self, q: &#configuration, p: &#configuration) -> Self::Momentum),
        quote!(coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum),
        quote!(legendre(&self, h: #scalar, t: #scalar, q: &#configuration, f: &Self::Element) -> Self::Momentum),
        quote!(legendre_next(&self, h: #scalar, t: #scalar, q: &#configuration, f: &Self::Element) -> Self::Momentum),
        quote!(inverse_legendre(&self, constants: &(), t: #scalar, q: &#configuration, mu: &Self::Momentum) -> #element),
        quote!(impulse(&self, constants: &(), t: #scalar, q: &#configuration)),
        quote!(step(&self, constants: &(), t: #scalar, q: &#configuration, mu: &Self::Momentum, impulse: &(), u: &Self::Input) -> #step),
        quote!(step_symmetric(&self, constants: &(), t: #scalar, q: &#configuration, p: &#configuration) -> #symmetric),
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
