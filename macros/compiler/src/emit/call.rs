//! Tokens of calls: functions of matrices, and the methods behind an opaque potential with their check against each other.

use clebsch_symbolic::{Shape, both};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::Emitter;
use super::scope::{Scope, index, nested, size};
use crate::lower::{Callee, Code, Output};

impl Scope<'_, '_> {
    /// A call of a function of matrices, or of a method of the user's.
    pub(super) fn call(&self, callee: &Callee, arguments: &[(Shape, Vec<Code>)]) -> TokenStream {
        if let Callee::Value(_) | Callee::Gradient(_) = callee {
            let leaves = &arguments[usize::from(self.takes_time())..];
            let configuration = nested(&self.model.configuration, &mut |leaf| {
                self.grid(&leaves[leaf], self.model.configurations[leaf].is_quaternion)
            });
            let is_gradient = matches!(callee, Callee::Gradient(_));
            return self.call_of_method(is_gradient, &arguments[0].1[0], quote!(&#configuration));
        }
        if *callee == Callee::SineAndCosine {
            let angle = self.code(&arguments[0].1[0], false);
            return quote!(runtime::Scalar::sin_cos(#angle));
        }
        let function = format_ident!("{callee}");
        let arguments = arguments.iter().map(|argument| self.grid(argument, false));
        quote!(runtime::#function(#(&#arguments),*))
    }

    /// Whether the methods of an opaque potential take the time.
    pub(super) fn takes_time(&self) -> bool {
        self.opaque.is_some_and(|opaque| opaque.takes_time)
    }

    /// A call of the value or of the gradient of an opaque potential.
    pub(super) fn call_of_method(&self, is_gradient: bool, time: &Code, configuration: TokenStream) -> TokenStream {
        let (method, system, time) = (self.method(is_gradient), &self.system, self.code(time, false));
        let time = self.takes_time().then(|| quote!(#time,));
        quote!(#method(#system, #time #configuration))
    }

    /// The path of the value or of the gradient of an opaque potential, `Self` replaced by the struct.
    pub(super) fn method(&self, is_gradient: bool) -> TokenStream {
        // by construction: only an opaque potential makes such calls
        let Some(opaque) = self.opaque else { return TokenStream::new() };
        let path = if is_gradient { &opaque.gradient } else { &opaque.value };
        let (item, behind) = (self.target.of_type(), path.segments.iter().skip(1));
        let is_self = path.leading_colon.is_none() && path.segments.len() > 1 && path.segments[0].ident == "Self";
        if is_self { quote!(<#item>::#(#behind)::*) } else { self.names.of_user(quote!(#path)) }
    }

    /// An entry of the result of a call.
    pub(super) fn output_of_call(&self, local: usize, callee: &Callee, output: Output) -> TokenStream {
        let name = format_ident!("t{local}");
        let index = index(output.shape.is_column(), (output.row, output.column));
        match callee {
            Callee::Value(_) => quote!(#name),
            Callee::Gradient(_) => {
                let access = &self.model.configurations[output.leaf - usize::from(self.takes_time())].accessor;
                quote!(#name #access #index)
            }
            Callee::SineAndCosine => {
                let place = syn::Index::from(output.row);
                quote!(#name.#place)
            }
            _ => quote!(#name #index),
        }
    }
}

impl Emitter<'_, '_> {
    /// The method `check_potential`, for the user's tests.
    pub(super) fn potential_check(&self) -> TokenStream {
        let Some(opaque) = self.opaque else { return TokenStream::new() };
        let scope = self.scope_of_system();
        let [value, gradient] = both([false, true], |is_gradient| scope.method(is_gradient));
        let time_parameter = opaque.takes_time.then(|| quote!(t: T,));
        let time = opaque.takes_time.then(|| quote!(t,));
        let mut entry = 0;
        let checks = self.model.configurations.iter().map(|leaf| {
            let (access, first, count) = (&leaf.accessor, size(entry), size(leaf.shape.len()));
            entry += leaf.shape.len();
            quote! {
                for index in 0..#count {
                    let along = |x: T| {
                        let mut moved = *q;
                        moved #access [index] = x;
                        #value(self, #time &moved)
                    };
                    runtime::check_slope(along, q #access [index], gradient #access [index], #first + index)?;
                }
            }
        });
        let check = quote! {
            /// Checks the gradient method of the potential against differences of its value method at a configuration.
            ///
            /// For a test: `system.check_potential(&q).unwrap()` at some typical configurations.
            ///
            /// # Errors
            /// `Error::WrongGradient` with the first entry that differs, `Error::NotFinite`.
            pub fn check_potential(
                &self,
                #time_parameter
                q: &Q,
            ) -> ::core::result::Result<(), runtime::Error> {
                let gradient = #gradient(self, #time q);
                #(#checks)*
                runtime::Ok(())
            }
        };
        self.target.derived(None, check)
    }
}
