//! Methods: several ways to step one system, each in a block of its own behind what is emitted of the system.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::block::{Block, Target};

impl Emitter<'_, '_> {
    /// The blocks of all methods. The names of types are those of the block around; what is of the steps has names of its own.
    pub(super) fn methods(&self) -> TokenStream {
        let blocks = self.program.methods.iter().map(|method| {
            let emitter = self.of_method(method);
            let stepping = emitter.stepping(None, &emitter.program.derivation_by(&method.name));
            let (constants, method) =
                (emitter.constants_type(), emitter.implementation_of_method(&method.name, &stepping));
            let (edges, parts) = (emitter.edges(), emitter.parts());
            let (equations, velocity) = (emitter.equations(), emitter.velocity());
            quote!(const _: () = { #constants #method #edges #parts #equations #velocity };)
        });
        blocks.collect()
    }

    /// An implementation of a hidden trait of the runtime.
    pub(super) fn implementation(&self, name: &str, sizes: &[Literal], items: TokenStream) -> TokenStream {
        self.target.implementation(Some(self.trait_of_parts(name, sizes)), items)
    }

    /// A trait of the parts of a step: by its sizes, and by the method that is emitted where there are several.
    pub(super) fn trait_of_parts(&self, name: &str, sizes: &[Literal]) -> TokenStream {
        let declared = || (!self.program.methods.is_empty()).then(|| quote!(runtime::Declared));
        let method = self.method.map(|method| self.names.of_user(quote!(#method))).or_else(declared);
        let (name, mut arguments) =
            (format_ident!("{name}"), sizes.iter().map(|size| quote!(#size)).chain(method).peekable());
        if arguments.peek().is_none() { quote!(runtime::#name) } else { quote!(runtime::#name::<#(#arguments),*>) }
    }
}

impl Block<'_> {
    /// What depends on how the system is stepped, by a unit struct of the user.
    pub(super) fn implementation_of_method(&self, name: &Ident, stepping: &TokenStream) -> TokenStream {
        let Target { parameters, predicates, .. } = &self.target;
        let (system, name) = (self.target.of_type(), self.names.of_user(quote!(#name)));
        quote! {
            #[automatically_derived]
            impl #parameters runtime::Method<#system> for #name #predicates { #stepping }
        }
    }
}
