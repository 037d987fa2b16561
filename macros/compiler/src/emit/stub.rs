//! The code that is emitted with an error: an implementation with the right types. The user sees that error alone, and
//! the editor keeps working. It is never run, because the error is there.

use clebsch_symbolic::IntoList;
use proc_macro2::TokenStream;
use quote::{ToTokens, quote};

use super::block::{Block, Target, anonymous, leaf, matrix, time_type, types_of_system};
use super::control::ControlTypes;
use super::function::{Body, Function, Words, no_words};
use super::functions::{BOUNDED, CONSERVES, ENDED, EXPANDED, FORCED, PRICED, STEERED, SYSTEM};
use super::names::Names;
use super::scope::nested_type;
use crate::model::{Nested, Outline};
use crate::parse::{Declaration, tail};

/// The implementation of the trait for a declaration with an error.
pub fn stub(declaration: &Declaration, outline: &Outline) -> TokenStream {
    let Declaration { ident, generics, .. } = declaration;
    let predicates = &generics.where_clause;
    let users = declaration.methods.iter().map(|method| method.name.to_token_stream());
    let users: Vec<TokenStream> = users.chain([quote!(#ident #generics #predicates)]).into_list();
    let Outline { configuration, element, input, dimension, .. } = outline;
    let names = Names::new(&outline.scalar, !configuration.1.is_empty(), &users);
    let of_sites = |ty: TokenStream| {
        outline.sites.as_ref().map_or(ty.clone(), |length| {
            let length = names.of_user(quote!(#length));
            quote!([#ty; #length])
        })
    };
    let [q, f, input] = [configuration, element, input].map(nested);
    let block = Block {
        krate: declaration.dials.krate.as_ref().map_or(quote!(::clebsch), |path| quote!(#path)),
        scalar: &outline.scalar,
        types: [q, f, matrix(*dimension, 1)].map(of_sites),
        input,
        dimension: *dimension,
        method: None,
        target: Target::new(ident, generics, &outline.scalar, &names),
        names,
    };
    let (controlled, system) = (controlled(&block, declaration, outline), system(&block, declaration, outline));
    // an alias has to use its parameter
    let constants = if block.is_generic() { quote!(::core::marker::PhantomData<T>) } else { quote!(()) };
    anonymous(&block.named(&quote!(type C = #constants; #controlled #system)))
}

/// The type of a product.
fn nested((layout, leaves): &Nested) -> TokenStream {
    nested_type(layout, |k| leaf(leaves[k].0, leaves[k].1))
}

/// Functions of a table that are never called.
fn uncalled<'f>(block: &Block<'_>, table: impl IntoIterator<Item = &'f Function>, words: &Words<'_>) -> TokenStream {
    let code = quote!(::core::unreachable!("the declaration has an error"));
    let function = |function| block.function(function, words, Body::from(code.clone()).inlined(quote!()));
    table.into_iter().map(function).collect()
}

/// The system with the declared methods, as the unit structs of the user implement them, where it is stepped.
fn system(block: &Block<'_>, declaration: &Declaration, outline: &Outline) -> Option<TokenStream> {
    if declaration.kinetic.is_steered() {
        return None;
    }
    let types = types_of_system(&block.types, &block.input, &time_type(outline.takes_time));
    let name = &block.target.name;
    let stepping = quote! {
        type Constants = C;
        type Scheme = runtime::Unstepped;
        const ORDER: ::core::primitive::u32 = 0;
        const DERIVATION: &'static ::core::primitive::str = "";
    };
    let functions = uncalled(block, SYSTEM, &no_words);
    let items = quote!(#types #stepping const NAME: &'static ::core::primitive::str = #name; #functions);
    let system = block.target.derived(Some(quote!(runtime::Clebsch)), items);
    let methods = declaration.methods.iter().map(|method| {
        let block = Block { method: Some(&method.name), ..block.clone() };
        let functions = uncalled(&block, SYSTEM.iter().filter(|function| function.is_of_method()), &no_words);
        block.implementation_of_method(&method.name, &quote!(#stepping #functions))
    });
    let functions = uncalled(block, CONSERVES, &no_words);
    let conserved = quote! {
        type Conserved = runtime::Conserved<T, 1>;
        const CONSERVED_NAMES: &'static [&'static ::core::primitive::str] = &[""];
        #functions
    };
    let conserves = block.target.derived(Some(quote!(runtime::Conserves)), conserved);
    Some(quote!(#system #(#methods)* #conserves))
}

/// The trait `Controlled`, where the declaration chooses inputs.
fn controlled(block: &Block<'_>, declaration: &Declaration, outline: &Outline) -> Option<TokenStream> {
    let bounds = match declaration.control.as_ref()?.bounds.as_ref().map(|closure| tail(&closure.body)) {
        Some(syn::Expr::Array(list)) => list.elems.len(),
        _ => 0,
    };
    let are_any = outline.references.iter().any(|(_, leaves)| !leaves.is_empty());
    let types = ControlTypes {
        is_steered: declaration.kinetic.is_steered(),
        inputs: outline.chosen,
        bounds: (vec![""; bounds], 0),
        target: (Vec::new(), 0),
        references: are_any.then(|| outline.references.each_ref().map(nested)),
        is_constrained: false,
        refers_in_steps: true,
    };
    let step = if types.is_steered { [STEERED, &[]] } else { [FORCED, EXPANDED] };
    let functions = step.into_iter().chain([PRICED, BOUNDED, ENDED]).flatten();
    Some(types.implementation(block, |words| uncalled(block, functions, words)))
}
