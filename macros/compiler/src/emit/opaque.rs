//! The check of an opaque potential: its gradient method against differences of its value method.

use proc_macro2::TokenStream;
use quote::quote;

use super::scope::size;
use super::{Emitter, docs};
use crate::lower::Callee;

impl Emitter<'_, '_> {
    /// The method `check_potential`, for the user's tests.
    pub(super) fn potential_check(&self) -> TokenStream {
        let Some(opaque) = self.opaque else { return TokenStream::new() };
        let (krate, private) = (&self.paths.krate, &self.paths.private);
        let (configuration, scalar) = (self.alias("Q"), &self.paths.scalar);
        let scope = self.scope_of_system();
        let [value, gradient] =
            [Callee::Value(String::new()), Callee::Gradient(String::new())].map(|callee| scope.method(&callee));
        let time_parameter = opaque.takes_time.then(|| quote!(t: #scalar,));
        let time = opaque.takes_time.then(|| quote!(t,));
        let mut entry = 0;
        let checks = self.model.configurations.iter().map(|leaf| {
            let (access, first, count) = (&leaf.accessor, size(entry), size(leaf.shape.len()));
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
        let documentation = docs::lines(
            "Checks the gradient method of the potential against differences of its value method at a configuration.\n\n\
             For a test: `system.check_potential(&q).unwrap()` at some typical configurations.\n\n\
             # Errors\n\
             `Error::WrongGradient` with the first entry that differs, `Error::NotFinite`.",
        );
        let check = quote! {
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
        };
        self.target.derived(None, check)
    }
}
