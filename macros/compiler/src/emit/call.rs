//! Tokens of calls: functions of matrices, and the methods behind an opaque potential.

use clebsch_symbolic::{Analytic, Shape};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::scope::{Scope, index, nested};
use crate::lower::{Callee, Code, Output};

/// The function of the runtime that computes a function of matrices.
pub(super) fn function_of_matrices(function: Analytic) -> &'static str {
    match function {
        Analytic::Exponential => "exponential",
        Analytic::Phi => "phi",
        Analytic::Logarithm => "logarithm",
    }
}

impl Scope<'_, '_> {
    /// A call of a function of matrices, or of a method of the user's.
    pub(super) fn call(&self, callee: &Callee, arguments: &[(Shape, Vec<Code>)]) -> TokenStream {
        let private = &self.paths.private;
        let function = match callee {
            Callee::Analytic(function) => format_ident!("{}", function_of_matrices(*function)),
            Callee::Inverse => format_ident!("inverse"),
            Callee::Value(_) | Callee::Gradient(_) => {
                let time = self.takes_time().then(|| self.code(&arguments[0].1[0], false));
                let leaves = &arguments[usize::from(self.takes_time())..];
                let configuration = nested(&self.model.configuration, &mut |leaf| {
                    self.grid(&leaves[leaf], self.model.configurations[leaf].is_quaternion)
                });
                return self.call_of_method(callee, time, quote!(&#configuration));
            }
        };
        let arguments = arguments.iter().map(|argument| self.grid(argument, false));
        quote!(#private::#function(#(&#arguments),*))
    }

    /// Whether the methods of an opaque potential take the time.
    pub(super) fn takes_time(&self) -> bool {
        self.opaque.is_some_and(|opaque| opaque.takes_time)
    }

    /// A call of the value or of the gradient of an opaque potential.
    pub(super) fn call_of_method(
        &self,
        callee: &Callee,
        time: Option<TokenStream>,
        configuration: TokenStream,
    ) -> TokenStream {
        let (method, system, time) = (self.method(callee), &self.system, time.map(|time| quote!(#time,)));
        quote!(#method(#system, #time #configuration))
    }

    /// The path of the value or of the gradient of an opaque potential, `Self` replaced by the struct.
    pub(super) fn method(&self, callee: &Callee) -> TokenStream {
        // by construction: only an opaque potential makes such calls
        let Some(opaque) = self.opaque else { return TokenStream::new() };
        let path = if matches!(callee, Callee::Gradient(_)) { &opaque.gradient } else { &opaque.value };
        let (item, behind) = (self.target.of_type(), path.segments.iter().skip(1));
        let is_self = path.leading_colon.is_none() && path.segments.len() > 1 && path.segments[0].ident == "Self";
        if is_self { quote!(<#item>::#(#behind)::*) } else { quote!(#path) }
    }

    /// An entry of what a call has returned.
    pub(super) fn output_of_call(&self, local: usize, callee: &Callee, output: Output) -> TokenStream {
        let name = format_ident!("t{local}");
        let index = index(output.shape.is_column(), (output.row, output.column));
        match callee {
            Callee::Value(_) => quote!(#name),
            Callee::Gradient(_) => {
                let access = &self.model.configurations[output.leaf - usize::from(self.takes_time())].accessor;
                quote!(#name #access #index)
            }
            _ => quote!(#name #index),
        }
    }
}
