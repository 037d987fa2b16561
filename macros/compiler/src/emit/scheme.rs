//! Which scheme of the runtime steps a system, and what that scheme calls beside the parts of a step.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;

impl Emitter<'_, '_> {
    /// The type of the scheme.
    pub(super) fn scheme(&self) -> TokenStream {
        let private = &self.paths.private;
        let single = self.scheme_of_single_steps();
        let Some(stages) = self.program.formulas.stages() else { return single };
        let order = match stages {
            5 => quote!(OfOrderFour),
            9 => quote!(OfOrderSix),
            _ => quote!(OfOrderEight),
        };
        // the sizes of a composed step are the same forwards and backwards
        let distinct = Literal::usize_unsuffixed(stages.div_ceil(2));
        quote!(#private::Composed<#single, #private::#order, #distinct>)
    }

    fn scheme_of_single_steps(&self) -> TokenStream {
        let private = &self.paths.private;
        let carry = if self.shares_impulse() { quote!(#private::Shared) } else { quote!(#private::Apart) };
        if let Some(splitting) = &self.program.formulas.splitting {
            let (kicks, count) = kicks_of_splitting(self.model.order.number(), splitting.has_gradient);
            let count = Literal::usize_unsuffixed(count);
            return quote!(#private::Split<#private::#kicks, #count>);
        }
        if self.program.formulas.collocation.is_some() {
            let numbers = self.numbers_of_pair();
            return quote!(#private::Collocated<#numbers>);
        }
        if self.follows_great_circles() {
            return if self.is_free_on_great_circles() {
                quote!(#private::FreeGreatCircle)
            } else {
                quote!(#private::GreatCircle<#carry>)
            };
        }
        if self.keeps_motions() {
            return quote!(#private::AlongFreeMotion);
        }
        match (self.program.formulas.stepped, self.program.steps.len()) {
            (2, _) => quote!(#private::AdjointPair<#carry>),
            (_, 1) => quote!(#private::KickDriftKick<#carry>),
            // the declared Lagrangian, without the force that joins its equation, stands last
            (_, _) => quote!(#private::KickDriftKick<#carry, 1>),
        }
    }

    /// What the scheme calls beside the parts of a step.
    pub(super) fn parts_of_scheme(&self) -> TokenStream {
        if self.program.formulas.splitting.is_some() {
            return self.split_kicks();
        }
        if self.program.formulas.collocation.is_some() {
            return self.hamilton_equations();
        }
        if self.follows_great_circles() {
            let (scalar, constants) = (&self.paths.scalar, self.constants_of_step());
            let turn = quote! {
                #[inline]
                fn turn(c: &#constants) -> #scalar {
                    c.step_size * c.inertia_inverse
                }
            };
            return self.implementation("GreatCircles", &[], turn);
        }
        if self.keeps_motions() { self.free_motion() } else { TokenStream::new() }
    }

    /// The size of a step, where that is a constant by itself.
    pub(super) fn size_of_step(&self) -> TokenStream {
        let (scalar, constants) = (&self.paths.scalar, self.constants_of_step());
        quote! {
            #[inline]
            fn step_size(c: &#constants) -> #scalar {
                c.step_size
            }
        }
    }
}

/// The kicks of a splitting, and how many there are.
fn kicks_of_splitting(order: u32, has_gradient: bool) -> (Ident, usize) {
    let (name, count) = match (order, has_gradient) {
        (6, true) => ("GradientSix", 5),
        (6, false) => ("PlainSix", 10),
        (_, true) => ("GradientFour", 4),
        (_, false) => ("PlainFour", 6),
    };
    (format_ident!("{name}"), count)
}
