//! The check of an opaque potential: its gradient method against differences of its value method.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::{Emitter, Generics, code, docs};
use crate::lower::Callee;

impl Emitter<'_, '_> {
    /// The method `check_potential`, for the user's tests.
    pub(super) fn potential_check(&self) -> TokenStream {
        let Some(opaque) = &self.model.opaque else { return TokenStream::new() };
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, krate, private) = (&self.model.item.ident, &self.paths.krate, &self.paths.private);
        let (configuration, scalar) = (self.configuration_type(), &self.paths.scalar);
        let scope = self.scope_of_system();
        let (value, gradient) =
            (scope.method(&Callee::Value(String::new())), scope.method(&Callee::Gradient(String::new())));
        let (time_parameter, time) = match opaque.takes_time {
            true => (quote!(t: #scalar,), quote!(t,)),
            false => (quote!(), quote!()),
        };
        let mut entry = 0;
        let checks = self.model.configurations.iter().map(|leaf| {
            let access = code::accessor(&leaf.accessor);
            let (first, count) = (Literal::usize_unsuffixed(entry), Literal::usize_unsuffixed(leaf.shape.len()));
            entry += leaf.shape.len();
            quote! {
                for index in 0..#count {
                    let along = |x: #scalar| {
                        let mut moved = *q;
                        moved #access [index] = x;
                        #value(self, #time &moved)
                    };
                    #private::check_slope(along, q #access [index], gradient #access [index], #first + index)?;
                }
            }
        });
        let documentation = docs::lines(&[
            "Checks the gradient method of the potential against differences of its value method at a configuration."
                .into(),
            String::new(),
            "For a test: `system.check_potential(&q).unwrap()` at some typical configurations.".into(),
            String::new(),
            "# Errors".into(),
            "`Error::WrongGradient` with the first entry that differs, `Error::NotFinite`.".into(),
        ]);
        quote! {
            #[automatically_derived]
            impl<#parameters> #ident<#arguments> #predicates {
                #documentation
                pub fn check_potential(
                    &self,
                    #time_parameter
                    q: &#configuration,
                ) -> ::core::result::Result<(), #krate::Error> {
                    let gradient = #gradient(self, #time q);
                    #(#checks)*
                    ::core::result::Result::Ok(())
                }
            }
        }
    }
}
