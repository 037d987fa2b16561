//! Which scheme of the runtime steps a system, and what that scheme calls beside the parts of a step.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::function::Body;
use super::functions::GREAT_CIRCLES;
use super::scope::size;
use crate::derive::Id;

impl Emitter<'_, '_> {
    /// The type of the scheme.
    pub(super) fn scheme(&self) -> TokenStream {
        let private = &self.paths.private;
        let single = self.scheme_of_single_steps();
        let Some(stages) = self.formulas.stages() else { return single };
        let order = match stages {
            5 => quote!(OfOrderFour),
            9 => quote!(OfOrderSix),
            _ => quote!(OfOrderEight),
        };
        // the sizes of a composed step are the same forwards and backwards
        let distinct = size(stages.div_ceil(2));
        quote!(#private::Composed<#single, #private::#order, #distinct>)
    }

    fn scheme_of_single_steps(&self) -> TokenStream {
        let private = &self.paths.private;
        let carry = if self.shares_impulse() { quote!(#private::Shared) } else { quote!(#private::Apart) };
        if let Some(splitting) = &self.formulas.splitting {
            let (kicks, count) = kicks_of_splitting(self.model.order.number(), splitting.has_gradient);
            let count = size(count);
            return quote!(#private::Split<#private::#kicks, #count>);
        }
        if self.formulas.collocation.is_some() {
            let numbers = self.numbers_of_pair();
            return quote!(#private::Collocated<#numbers>);
        }
        if self.program.turns_in_plane() {
            return if self.is_free_on_great_circles() {
                quote!(#private::FreeGreatCircle)
            } else {
                quote!(#private::GreatCircle<#carry>)
            };
        }
        if self.keeps_motions() {
            return quote!(#private::AlongFreeMotion);
        }
        match (self.formulas.stepped, self.program.steps.len()) {
            (2, _) => quote!(#private::AdjointPair<#carry>),
            (_, 1) => quote!(#private::KickDriftKick<#carry>),
            // the declared Lagrangian, without the force that joins its equation, stands last
            (_, _) => quote!(#private::KickDriftKick<#carry, 1>),
        }
    }

    /// Whether the end kick of a step serves as the start kick of the next.
    pub(super) fn shares_impulse(&self) -> bool {
        let (formulas, last) = (self.formulas, self.formulas.stepped - 1);
        formulas.substeps[0].start == formulas.substeps[last].end
            && self.program.find(Id::StartKick(0)).is_some()
            && self.program.find(Id::EndKick(last)).is_some()
            && formulas.splitting.is_none()
            && formulas.collocation.is_none()
    }

    /// Whether steps are made in (q, w) and nothing pushes.
    fn is_free_on_great_circles(&self) -> bool {
        let is_free = |id: Id| self.program.find(id).is_none();
        self.program.turns_in_plane() && is_free(Id::StartGradient(0)) && is_free(Id::EndGradient(0))
    }

    /// What the scheme calls beside the parts of a step.
    pub(super) fn parts_of_scheme(&self) -> TokenStream {
        if self.formulas.splitting.is_some() {
            return self.split_kicks();
        }
        if self.formulas.collocation.is_some() {
            return self.hamilton_equations();
        }
        if self.program.turns_in_plane() {
            let turn = self.functions(GREAT_CIRCLES, (0, 0), &[], |_, _| {
                Some(Body::from(quote!(c.step_size * c.inertia_inverse)))
            });
            return self.implementation("GreatCircles", &[], turn);
        }
        if self.keeps_motions() { self.free_motion() } else { TokenStream::new() }
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
