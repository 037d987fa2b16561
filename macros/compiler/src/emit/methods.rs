//! Methods: several ways to step one system, each in a block of its own behind what is emitted of the system.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Emitter, SystemEmitter};

impl<'g> Emitter<'_, 'g> {
    /// The blocks of all methods. The names of types are those of the block around; what is of the steps has names of its own.
    pub(super) fn methods(&self) -> TokenStream {
        let blocks = self.program.methods.iter().map(|method| {
            let emitter = Emitter::of_method(self.program, method);
            let (constants, method) = (emitter.constants_type(), emitter.implementation_of_method(&method.name));
            let (edges, parts) = (emitter.edges(), emitter.parts());
            let (equations, velocity) = (emitter.equations(), emitter.velocity());
            quote!(const _: () = { #constants #method #edges #parts #equations #velocity };)
        });
        blocks.collect()
    }

    /// What depends on how the system is stepped.
    fn implementation_of_method(&self, name: &Ident) -> TokenStream {
        let (krate, system) = (&self.paths.krate, self.target.of_type());
        let (parameters, _, predicates) = self.target.generics.split_for_impl();
        let stepping = self.stepping(None, &self.program.derivation_by(name));
        quote! {
            #[automatically_derived]
            impl #parameters #krate::Method<#system> for #name #predicates { #stepping }
        }
    }

    /// An implementation of a hidden trait of the runtime.
    pub(super) fn implementation(&self, name: &str, sizes: &[Literal], items: TokenStream) -> TokenStream {
        self.target.implementation(Some(self.trait_of_parts(name, sizes)), items)
    }

    /// A trait of the parts of a step, as a type names it. That of the declared dials is its default.
    pub(super) fn trait_of_parts(&self, name: &str, sizes: &[Literal]) -> TokenStream {
        let (private, name, arguments) =
            (&self.paths.private, format_ident!("{name}"), self.arguments_of_parts(sizes, None));
        quote!(#private::#name #arguments)
    }

    /// The same, as a call names it. What has one method has no other parts.
    pub(super) fn call_of_parts(&self, name: &str, sizes: &[Literal]) -> TokenStream {
        let (private, name) = (&self.paths.private, format_ident!("{name}"));
        let declared = (!self.program.methods.is_empty()).then(|| quote!(#private::Declared));
        let arguments = self.arguments_of_parts(sizes, declared).map(|arguments| quote!(::#arguments));
        quote!(#private::#name #arguments)
    }

    /// Sizes, and the method that is emitted or the declared one.
    fn arguments_of_parts(&self, sizes: &[Literal], declared: Option<TokenStream>) -> Option<TokenStream> {
        let method = self.method.map(|method| quote!(#method)).or(declared);
        let arguments: Vec<TokenStream> = sizes.iter().map(|size| quote!(#size)).chain(method).collect();
        (!arguments.is_empty()).then(|| quote!(<#(#arguments),*>))
    }
}

impl SystemEmitter<'_, '_> {
    /// How the system is called where it is stepped: `self`, but in the implementation of `Method`.
    pub(super) fn receiver(&self) -> TokenStream {
        if self.method.is_some() { quote!(system) } else { quote!(self) }
    }

    /// The same as a parameter.
    pub(super) fn receiver_parameter(&self) -> TokenStream {
        let system = self.target.of_type();
        if self.method.is_some() { quote!(system: &#system) } else { quote!(&self) }
    }
}
