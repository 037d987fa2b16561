//! How a step adds to q and N: as numbers are added, or with the rests that rounding leaves.

use clebsch_symbolic::Group;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{Emitter, code};
use crate::lower::StepKernels;
use crate::model::Space;

impl Emitter<'_, '_> {
    /// What one step leaves to the next.
    pub(super) fn left_type(&self) -> TokenStream {
        let (impulse, rests) = (self.impulse_type(), self.rests_type());
        match self.is_compensated() {
            true => quote!((#impulse, #rests)),
            false => impulse,
        }
    }

    /// The type of what rounding has taken off q and N.
    pub(super) fn rests_type(&self) -> TokenStream {
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        quote!((#configuration, #momentum))
    }

    /// Whether sums keep their rests.
    pub(super) fn is_compensated(&self) -> bool {
        self.program.formulas.is_compensated()
    }

    /// N ↦ N + `increment`.
    pub(super) fn pushed_by(&self, increment: TokenStream) -> TokenStream {
        match self.is_compensated() {
            true => self.accumulated(&quote!(&#increment)),
            false => quote!(let mu = mu + #increment;),
        }
    }

    /// The same by the impulse that the last step has left.
    pub(super) fn pushed_by_impulse(&self) -> TokenStream {
        if self.is_compensated() { self.accumulated(&quote!(impulse)) } else { quote!(let mu = mu + *impulse;) }
    }

    fn accumulated(&self, increment: &TokenStream) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        quote!(let (mu, mu_rest) = #private::accumulate::<#scalar, _>(&mu, &mu_rest, #increment);)
    }

    /// The move of q, by the increments or by the chart coordinates, before a look at its rounding.
    pub(super) fn advanced(&self, step: &StepKernels) -> TokenStream {
        let (private, scalar, moved) = (&self.paths.private, &self.paths.scalar, self.moved(step));
        match self.is_compensated() {
            true => quote!(let (q, q_rest) = #private::accumulate::<#scalar, _>(&q, &q_rest, &#moved);),
            false => quote!(let q = #moved;),
        }
    }

    /// The same where no rests are kept. None is ever taken off: the step on T*Q is symplectic in all directions of T*Rⁿ.
    pub(super) fn advanced_plainly(&self, step: &StepKernels) -> TokenStream {
        let moved = self.moved_to(self.moved(step));
        quote!(let q = #moved;)
    }

    /// Takes the rounding of many moves off rotations, unit vectors and unit quaternions; nothing where there are none. The last that a step does: nothing
    /// else waits for it, nor is kept beside it.
    pub(super) fn kept_on_spaces(&self) -> TokenStream {
        let leaves = self.model.configurations.iter().filter_map(|leaf| {
            let access = code::accessor(&leaf.accessor);
            match leaf.space {
                Space::Group(Group::UnitQuaternions) => Some(self.kept("of_length_one", &quote!(#access.coords))),
                Space::Group(group) if group.is_orthogonal() => Some(self.kept("orthogonal", &access)),
                Space::Unit => Some(self.kept("of_length_one", &access)),
                Space::Vectors | Space::Group(_) => None,
            }
        });
        let leaves: Vec<_> = leaves.collect();
        match (leaves.is_empty(), self.is_compensated()) {
            (true, _) => TokenStream::new(),
            (false, true) => quote!(let (mut q, mut q_rest) = (q, q_rest); #(#leaves)*),
            (false, false) => quote!(let mut q = q; #(#leaves)*),
        }
    }

    fn kept(&self, function: &str, access: &TokenStream) -> TokenStream {
        let private = &self.paths.private;
        if self.is_compensated() {
            let function = format_ident!("{function}_with_rest");
            quote!((q #access, q_rest #access) = #private::#function(q #access, q_rest #access);)
        } else {
            let function = format_ident!("{function}");
            quote!(q #access = #private::#function(q #access);)
        }
    }

    /// q⁺ of what the kernel of the move gives: itself, or what is added to q.
    pub(super) fn moved_to(&self, moved: TokenStream) -> TokenStream {
        let sum = code::combined(self.model, &quote!(q), quote!(+), &quote!(added), &self.paths);
        if self.is_compensated() { quote!({ let added = #moved; #sum }) } else { moved }
    }

    fn moved(&self, step: &StepKernels) -> TokenStream {
        match step.displace {
            Some(_) => quote!(self.displace(&q, &x)),
            None => quote!(self.advance(&q, &d)),
        }
    }

    /// The momentum after the move, where `update` makes it.
    pub(super) fn updated(&self, update: TokenStream) -> TokenStream {
        match self.is_compensated() {
            true => self.pushed_by(update),
            false => quote!(let mu = #update;),
        }
    }

    /// The impulse and the rests that the last step has left, apart.
    pub(super) fn rests_taken(&self, left: &Ident) -> TokenStream {
        match self.is_compensated() {
            true => quote!(let (#left, (q_rest, mu_rest)) = (&#left.0, #left.1);),
            false => quote!(),
        }
    }

    /// An impulse with the rests for the next step.
    pub(super) fn with_rests(&self, impulse: TokenStream) -> TokenStream {
        if self.is_compensated() { quote!((#impulse, (q_rest, mu_rest))) } else { impulse }
    }

    /// An impulse with which sums begin.
    pub(super) fn without_rests(&self, impulse: TokenStream) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        match self.is_compensated() {
            true => quote!((#impulse, #private::Space::<#scalar>::origin())),
            false => impulse,
        }
    }

    /// The method that keeps the rests where the step size changes.
    pub(super) fn impulse_after(&self) -> TokenStream {
        if !self.is_compensated() {
            return TokenStream::new();
        }
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        quote! {
            /// The impulse of a step of another size, with the rests that do not depend on it.
            #[inline]
            fn impulse_after(
                &self,
                constants: &Self::Constants,
                t: #scalar,
                q: &Self::Configuration,
                mu: &Self::Momentum,
                left: &Self::Impulse,
            ) -> Self::Impulse {
                (#krate::Clebsch::impulse(self, constants, t, q, mu).0, left.1)
            }
        }
    }
}
