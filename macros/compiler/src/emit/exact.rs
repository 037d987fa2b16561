//! Exact drifts: how free rotations are found, the steps of one free motion, and splittings.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::code::Nesting;
use crate::derive::{Id, Solution};
use crate::lower::{Solve, SplittingKernels, StepKernels};

impl Emitter<'_, '_> {
    /// The coordinates of a factor that moves freely with the momentum `target`; `kept` are the motions of many steps.
    pub(super) fn found_free_rotation(
        &self,
        (suffix, number, solve): (&str, usize, &Solve),
        solution: &Ident,
        target: &TokenStream,
        kept: bool,
    ) -> TokenStream {
        let (private, rotation) = (&self.paths.private, self.free_rotation(suffix, number));
        let is_weighted = self.weight_of(solve).is_some();
        // spatial momenta move as those of the body that turns back
        let is_left = self.is_left(solve);
        let target = if is_left { quote!(-#target) } else { target.clone() };
        let found = match kept {
            true => {
                let index = Literal::usize_unsuffixed(self.index_of_free_rotation(number));
                let method = if is_weighted { quote!(turn_of) } else { quote!(gibbs_vector_of) };
                quote!(#private::FreeRotation::#method(&self.constants.#rotation, &kept[#index], &#target)?)
            }
            false => {
                let method = if is_weighted { quote!(turn) } else { quote!(gibbs_vector) };
                quote!(#private::FreeRotation::#method(&self.constants.#rotation, &#target)?)
            }
        };
        let turned_back = is_left.then(|| quote!(let #solution = -#solution;));
        match self.weight_of(solve) {
            Some(number) => {
                let weight = format_ident!("w{}", number + 1);
                quote!(let (#weight, #solution) = #found; #turned_back)
            }
            None => quote!(let #solution = #found; #turned_back),
        }
    }

    /// The number of the weight of the chart coordinates of an equation, where they are given up to a factor.
    fn weight_of(&self, solve: &Solve) -> Option<usize> {
        let block = self.program.formulas.symbols.blocks_of(&solve.components)[0];
        let factor = self.program.formulas.symbols.blocks[block].factor;
        self.program.formulas.weighted().iter().position(|&other| other == factor)
    }

    /// The chart coordinates of all factors, with the weights of those that are given up to a factor.
    pub(super) fn coordinates_type(&self) -> TokenStream {
        let (momentum, scalar) = (self.momentum_type(), &self.paths.scalar);
        match self.program.formulas.weighted().len() {
            0 => momentum,
            count => {
                let count = Literal::usize_unsuffixed(count);
                quote!((#momentum, [#scalar; #count]))
            }
        }
    }

    /// Whether the free motions of several steps are the same, so that what they keep is computed once.
    pub(super) fn keeps_motions(&self) -> bool {
        self.program.formulas.is_exact && self.free_rotations().next().is_some()
    }

    /// The number of the free rotation of an equation among those of a step.
    fn index_of_free_rotation(&self, number: usize) -> usize {
        let before = self.program.steps[0].solves.iter().take(number);
        before.filter(|solve| solve.solution == Solution::FreeRotation).count()
    }

    /// The type of the constants of a free rotation.
    pub(super) fn kind_of_free_rotation(&self) -> Ident {
        if self.program.formulas.turns_whole() { format_ident!("FreeRotation4") } else { format_ident!("FreeRotation") }
    }

    /// The type of what the free motions of a step keep.
    pub(super) fn kept_type(&self) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let kind = if self.program.formulas.turns_whole() { quote!(KeptRotation4) } else { quote!(KeptRotation) };
        let count = Literal::usize_unsuffixed(self.free_rotations().count());
        quote!([#private::#kind<#scalar>; #count])
    }

    /// What the free motions from a momentum keep, and several steps of them.
    pub(super) fn kept_steps(&self) -> TokenStream {
        if !self.keeps_motions() {
            return TokenStream::new();
        }
        let (private, krate, kept, kind) =
            (&self.paths.private, &self.paths.krate, self.kept_type(), self.kind_of_free_rotation());
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let motions = self.free_rotations().map(|(name, solve)| {
            let target = self.part_of("mu", &solve.momenta);
            let target = if self.is_left(solve) { quote!(-#target) } else { target };
            quote!(#private::#kind::motion(&self.constants.#name, &#target))
        });
        let step = &self.program.steps[0];
        let (found, advanced, kept_on_spaces) = (self.found_by_kept(step), self.advanced(step), self.kept_on_spaces());
        let updated = step.update.as_ref().map(|_| self.updated(quote!(self.update(&mu, &d))));
        let (left, rests) = (self.left_type(), self.rests_taken(&format_ident!("kept")));
        let state = self.state_of_drifts(&quote!(q), &quote!(mu));
        let (start, kept_on) = (self.state_of_drifts(&quote!(*q), &quote!(*mu)), self.with_rests(quote!(*kept)));
        quote! {
            /// What the free motions with this momentum keep.
            fn kept_motions(&self, mu: &#momentum) -> #kept {
                [#(#motions),*]
            }
            /// (q, N) after several steps of one motion.
            fn euler_poincare_steps(
                &self,
                steps: ::core::primitive::usize,
                q: &#configuration,
                mu: &#momentum,
                kept: &#left,
            ) -> ::core::result::Result<(#configuration, #momentum, #left), #krate::Error> {
                #rests
                let mut state = #start;
                for _ in 0..steps {
                    let #state = state;
                    #found
                    #advanced
                    #updated
                    #kept_on_spaces
                    state = #state;
                }
                let #state = state;
                ::core::result::Result::Ok((q, mu, #kept_on))
            }
        }
    }

    /// How a step of a motion that is known finds F − I.
    pub(super) fn found_by_kept(&self, step: &StepKernels) -> TokenStream {
        if self.program.formulas.turns_whole() {
            return quote!(let (d, mu) = self.turn_kept(kept, &mu)?;);
        }
        let increment = step.makes_increments().then(|| quote!(let d = self.increment(&x);));
        quote!(let x = self.solve_kept(kept, &mu)?; #increment)
    }

    /// The turn of a step, where F − I and the next momentum are found at once.
    pub(super) fn turns(&self) -> TokenStream {
        let Some((name, solve)) = self.free_rotations().next() else { return TokenStream::new() };
        let (private, krate, kept) = (&self.paths.private, &self.paths.krate, self.kept_type());
        let (element, momentum) = (self.element_type(), self.momentum_type());
        // spatial momenta move as those of the body that turns back
        let turned = match self.is_left(solve) {
            true => quote! {
                let (d, mu) = #private::FreeRotation4::turn(&self.constants.#name, &kept[0], &-*mu)?;
                ::core::result::Result::Ok((d.transpose(), -mu))
            },
            false => quote!(#private::FreeRotation4::turn(&self.constants.#name, &kept[0], mu)),
        };
        quote! {
            /// F − I of the free motion with the momentum μ, and the momentum after it.
            #[inline]
            fn turn_kept(&self, kept: &#kept, mu: &#momentum) -> ::core::result::Result<(#element, #momentum), #krate::Error> {
                #turned
            }
        }
    }

    /// The drift and the kicks of a splitting: exact, so that the part a of the step with the momentum μ is the step with a μ.
    pub(super) fn splitting(&self, splitting: &SplittingKernels) -> TokenStream {
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        let (configuration, momentum, time) = (self.configuration_type(), self.momentum_type(), self.time_parameter());
        let step = &self.program.steps[0];
        let increment = step.makes_increments().then(|| quote!(let d = self.increment(&x);));
        let (advanced, updated) =
            (self.advanced(step), step.update.as_ref().map(|_| self.updated(quote!(self.update(&mu, &d)))));
        let (state, advanced_plainly) = (self.state_of_drifts(&quote!(q), &quote!(mu)), self.advanced_plainly(step));
        let kept_on_spaces = self.kept_on_spaces();
        let rests = self.rests_type();
        let state_type = match self.is_compensated() {
            true => quote!((#configuration, #momentum, #rests)),
            false => quote!((#configuration, #momentum)),
        };
        let weights = quote!(#time q: &#configuration, weight: #scalar, gradient: #scalar);
        let formulas = &self.program.formulas;
        let kick = formulas.titled(Id::SplittingKick);
        let kick = self.part("A kick.", kick, quote!(kick(&self, #weights) -> #momentum), &splitting.kick, None);
        let kick_gradient = self.part(
            "The same for the covector.",
            formulas.titled(Id::SplittingGradient),
            quote!(kick_gradient(&self, #weights) -> #configuration),
            &splitting.gradient,
            Some(Nesting::Configuration),
        );
        quote! {
            #kick
            #kick_gradient
            /// (q, M) ↦ (q⁺, M⁺) by the exact drift of a part of the step.
            #[inline]
            fn drift(
                &self,
                part: #scalar,
                #state: #state_type,
            ) -> ::core::result::Result<#state_type, #krate::Error> {
                let x = self.solve(&(mu * part))?;
                #increment
                #advanced
                #updated
                #kept_on_spaces
                ::core::result::Result::Ok(#state)
            }
            /// (q, p) ↦ (q⁺, p⁺) by the same.
            fn drift_symmetric(
                &self,
                part: #scalar,
                (q, p): (#configuration, #configuration),
            ) -> ::core::result::Result<(#configuration, #configuration), #krate::Error> {
                let mu = #krate::Clebsch::momentum_map(self.system, &q, &p);
                let x = self.solve(&(mu * part))?;
                let d = self.increment(&x);
                #advanced_plainly
                let p = self.lift(&q, &p, &d);
                ::core::result::Result::Ok((q, p))
            }
        }
    }

    /// What drifts move: q and N, and what rounding has taken off where sums keep it.
    pub(super) fn state_of_drifts(&self, q: &TokenStream, mu: &TokenStream) -> TokenStream {
        if self.is_compensated() { quote!((#q, #mu, (q_rest, mu_rest))) } else { quote!((#q, #mu)) }
    }
}
