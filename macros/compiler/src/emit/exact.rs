//! Exact drifts: how free rotations are found, what one motion keeps, and the kicks of splittings.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Emitter;
use super::code::Nesting;
use crate::derive::{Id, Solution};
use crate::lower::Solve;

impl Emitter<'_, '_> {
    /// The coordinates of a factor that moves freely with the momentum `target`; `kept` are the motions of many steps.
    pub(super) fn found_free_rotation(
        &self,
        index: usize,
        number: usize,
        solve: &Solve,
        target: &TokenStream,
        kept: bool,
    ) -> TokenStream {
        let (private, rotation) = (&self.paths.private, self.free_rotation(self.program.suffix(index), number));
        let solution = format_ident!("x{}", number + 1);
        let weight = self.weight_of(solve);
        // spatial momenta move as those of the body that turns back
        let is_left = self.is_left(solve);
        let target = if is_left { quote!(&-#target) } else { target.clone() };
        let found = if kept {
            let index = Literal::usize_unsuffixed(self.index_of_free_rotation(number));
            let method = if weight.is_some() { quote!(turn_of) } else { quote!(gibbs_vector_of) };
            quote!(#private::FreeRotation::#method(&c.#rotation, &kept[#index], #target)?)
        } else {
            let method = if weight.is_some() { quote!(turn) } else { quote!(gibbs_vector) };
            quote!(#private::FreeRotation::#method(&c.#rotation, #target)?)
        };
        let turned_back = is_left.then(|| quote!(let #solution = -#solution;));
        match weight {
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

    /// The implementation of `FreeMotion`: what one motion keeps, and how a step follows it.
    pub(super) fn free_motion(&self) -> TokenStream {
        let (private, scalar, constants) = (&self.paths.private, &self.paths.scalar, self.constants_of_step());
        let (momentum, kind) = (self.momentum_type(), self.kind_of_free_rotation());
        let coordinates = self.coordinates_type();
        let kept = if self.program.formulas.turns_whole() { quote!(KeptRotation4) } else { quote!(KeptRotation) };
        let count = Literal::usize_unsuffixed(self.free_rotations().count());
        let motions = self.free_rotations().map(|(name, solve)| {
            let target = self.part_of("mu", &solve.momenta);
            let target = if self.is_left(solve) { quote!(&-#target) } else { target };
            quote!(#private::#kind::motion(&c.#name, #target))
        });
        let followed = self.followed();
        self.implementation(
            "FreeMotion",
            &[],
            quote! {
                type Kept = [#private::#kept<#scalar>; #count];

                /// What the free motions with this momentum keep.
                fn kept(&self, c: &#constants, mu: &#momentum) -> Self::Kept {
                    [#(#motions),*]
                }

                /// The coordinates of these motions.
                #[inline]
                fn follow(
                    &self,
                    c: &#constants,
                    kept: &Self::Kept,
                    mu: &#momentum,
                ) -> #private::Result<(#coordinates, #momentum), #private::Error> {
                    #followed
                }
            },
        )
    }

    /// F − I and the next momentum at once, or the chart coordinates of all factors.
    fn followed(&self) -> TokenStream {
        let private = &self.paths.private;
        if !self.program.formulas.turns_whole() {
            let (solutions, result) = self.solved(0, &self.program.steps[0], true);
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

    /// The implementation of `SplitKicks`.
    pub(super) fn split_kicks(&self) -> TokenStream {
        let (scalar, constants) = (&self.paths.scalar, self.constants_of_step());
        let (configuration, momentum) = (self.configuration_type(), self.momentum_type());
        let arguments =
            quote!(&self, c: &#constants, t: #scalar, q: &#configuration, weight: #scalar, gradient: #scalar);
        let formulas = &self.program.formulas;
        let formula = formulas.titled(Id::SplittingKick);
        let size = self.size_of_step();
        let kernel = self.program.kernel(Id::SplittingKick);
        let kick = self.part("A kick.", formula, quote!(kick(#arguments) -> #momentum), kernel, None);
        let kick_gradient = self.part(
            "The same for the covector.",
            formulas.titled(Id::SplittingGradient),
            quote!(kick_gradient(#arguments) -> #configuration),
            self.program.kernel(Id::SplittingGradient),
            Some(Nesting::Configuration),
        );
        self.implementation("SplitKicks", &[], quote!(#size #kick #kick_gradient))
    }
}
