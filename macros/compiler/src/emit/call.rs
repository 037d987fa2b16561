//! Tokens of calls: functions of matrices, and the methods behind an opaque potential.

use clebsch_symbolic::{Analytic, Shape};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{Scope, accessor, grid, nested};
use crate::lower::{Callee, Code, Output};

impl Scope<'_, '_> {
    /// A call of a function of matrices, or of a method of the user's.
    pub(super) fn call(&self, callee: &Callee, arguments: &[(Shape, Vec<Code>)]) -> TokenStream {
        let (private, system) = (&self.paths.private, &self.system);
        let function = match callee {
            Callee::Analytic(Analytic::Exponential) => quote!(#private::exponential),
            Callee::Analytic(Analytic::Phi) => quote!(#private::phi),
            Callee::Analytic(Analytic::Logarithm) => quote!(#private::logarithm),
            Callee::Inverse => quote!(#private::inverse),
            Callee::Value(_) | Callee::Gradient(_) => {
                let (method, arguments) = (self.method(callee), self.arguments_of_method(arguments));
                return quote!(#method(#system, #arguments));
            }
        };
        let arguments = arguments.iter().map(|(shape, entries)| {
            let argument = grid(self, *shape, entries, false);
            quote!(&#argument)
        });
        quote!(#function(#(#arguments),*))
    }

    /// The path of the value or of the gradient of an opaque potential, `Self` replaced by the struct.
    pub(super) fn method(&self, callee: &Callee) -> TokenStream {
        // by construction: only an opaque potential makes such calls
        let Some(opaque) = self.opaque else { return TokenStream::new() };
        let path = if matches!(callee, Callee::Gradient(_)) { &opaque.gradient } else { &opaque.value };
        let item = &self.item;
        let is_self = path.leading_colon.is_none() && path.segments.len() > 1 && path.segments[0].ident == "Self";
        match is_self {
            true => {
                let rest = path.segments.iter().skip(1);
                quote!(<#item>::#(#rest)::*)
            }
            false => quote!(#path),
        }
    }

    /// The time, if the methods take it, and the configuration.
    fn arguments_of_method(&self, arguments: &[(Shape, Vec<Code>)]) -> TokenStream {
        let timed = self.opaque.is_some_and(|opaque| opaque.takes_time);
        let time = timed.then(|| self.code(&arguments[0].1[0], false)).map(|time| quote!(#time,));
        let leaves = &arguments[usize::from(timed)..];
        let configuration = nested(&self.model.configuration, &mut |leaf| {
            grid(self, leaves[leaf].0, &leaves[leaf].1, self.model.configurations[leaf].is_quaternion)
        });
        quote!(#time &#configuration)
    }

    /// An entry of what a call has returned.
    pub(super) fn output(&self, local: usize, callee: &Callee, output: Output) -> TokenStream {
        let name = format_ident!("t{local}");
        let (row, column) = (Literal::usize_unsuffixed(output.row), Literal::usize_unsuffixed(output.column));
        let index = if output.shape.is_column() { quote!([#row]) } else { quote!([(#row, #column)]) };
        match callee {
            Callee::Value(_) => quote!(#name),
            Callee::Gradient(_) => {
                let timed = self.opaque.is_some_and(|opaque| opaque.takes_time);
                let access = accessor(&self.model.configurations[output.leaf - usize::from(timed)].accessor);
                quote!(#name #access #index)
            }
            _ => quote!(#name #index),
        }
    }
}
