//! What the dials `tolerance` and `iterations` say to those that solve.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::Emitter;

impl Emitter<'_, '_> {
    /// The body of a function of an equation that tells a dial, where it is declared.
    pub(super) fn dial_of_solver(&self, function: &str) -> Option<TokenStream> {
        let private = &self.paths.private;
        if function == "tolerance" {
            let part = self.tolerance()?;
            return Some(quote!(#private::tolerance(#part)));
        }
        let most = self.iterations()?;
        Some(quote!(#private::Some(#most)))
    }

    /// The constants of a step that sweeps over its stages.
    pub(super) fn dials_of_sweeps(&self) -> TokenStream {
        let tolerance = self.tolerance().map(|part| quote!(const TOLERANCE: ::core::primitive::f64 = #part;));
        let most = self.iterations().map(|most| quote!(const SWEEPS: ::core::primitive::u32 = #most;));
        quote!(#tolerance #most)
    }

    /// The constants of a free rotation, from its inertia.
    pub(super) fn constants_of_free_rotation(&self, inertia: &TokenStream) -> TokenStream {
        let (private, kind) = (&self.paths.private, self.kind_of_free_rotation());
        match self.tolerance() {
            Some(part) => quote!(#private::#kind::to_tolerance(&#inertia, h, #part)?),
            None => quote!(#private::#kind::new(&#inertia, h)?),
        }
    }

    fn tolerance(&self) -> Option<Literal> {
        Some(Literal::f64_unsuffixed(self.model.dials.tolerance.as_ref()?.value))
    }

    fn iterations(&self) -> Option<Literal> {
        Some(Literal::u32_unsuffixed(self.model.dials.limit()?))
    }
}
