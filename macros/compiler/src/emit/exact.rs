//! Exact drifts: what one free motion keeps, and the kicks of splittings.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::function::Body;
use super::functions::{FREE_MOTION, SPLIT_KICKS};
use super::scope::size;

impl Emitter<'_, '_> {
    /// Whether the free motions of several steps are the same, so that what they keep is computed once.
    pub(super) fn keeps_motions(&self) -> bool {
        self.formulas.is_exact && self.free_rotations().next().is_some()
    }

    pub(super) fn kind_of_free_rotation(&self) -> Ident {
        if self.formulas.turns_whole() { format_ident!("FreeRotation4") } else { format_ident!("FreeRotation") }
    }

    /// The implementation of `FreeMotion`: what one motion keeps, and how a step follows it.
    pub(super) fn free_motion(&self) -> TokenStream {
        let (private, scalar, kind) = (&self.paths.private, &self.paths.scalar, self.kind_of_free_rotation());
        let kept = if self.formulas.turns_whole() { quote!(KeptRotation4) } else { quote!(KeptRotation) };
        let functions = self.functions(FREE_MOTION, (0, 0), &[("X", self.coordinates_type())], |function, _| {
            if function.name == "follow" {
                return Some(Body::from(self.followed()));
            }
            let motions = self.free_rotations().map(|(name, solve)| {
                let target = self.momentum_of_free_rotation(solve);
                quote!(#private::#kind::motion(&c.#name, #target))
            });
            Some(Body::from(quote!([#(#motions),*])).inlined(quote!()))
        });
        let count = size(self.free_rotations().count());
        self.implementation("FreeMotion", &[], quote!(type Kept = [#private::#kept<#scalar>; #count]; #functions))
    }

    /// F − I and the next momentum at once, or the chart coordinates of all factors.
    fn followed(&self) -> TokenStream {
        let private = &self.paths.private;
        if !self.formulas.turns_whole() {
            let (solutions, result) = self.solved(&self.program.steps[0], true);
            return quote!(#solutions #private::Ok((#result, *mu)));
        }
        let Some((name, solve)) = self.free_rotations().next() else { return TokenStream::new() };
        // spatial momenta move as those of the body that turns back
        if self.is_left(solve) {
            return quote! {
                let (d, mu) = #private::FreeRotation4::turn(&c.#name, &kept[0], &-*mu)?;
                #private::Ok((d.transpose(), -mu))
            };
        }
        quote!(#private::FreeRotation4::turn(&c.#name, &kept[0], mu))
    }

    pub(super) fn split_kicks(&self) -> TokenStream {
        let functions = self.functions(SPLIT_KICKS, (0, 0), &[], |function, kernel| match function.name {
            "step_size" => Some(Body::from(quote!(c.step_size))),
            _ => Some(function.computes(&self.scope_of_step(), kernel?)),
        });
        self.implementation("SplitKicks", &[], functions)
    }
}
