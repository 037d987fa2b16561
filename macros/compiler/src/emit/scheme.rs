//! The scheme of the runtime that steps a system. Apart from the parts of a step, a scheme may call the constants of a
//! free motion, or kicks.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::constants::tensor;
use super::function::{Body, no_words};
use super::functions::{FREE_MOTION, GREAT_CIRCLES, SPLIT_KICKS, TIME_TRANSFORMED};
use super::scope::size;
use super::{Emitter, flag};
use crate::derive::{Id, Solution};
use crate::lower::Solve;

impl Emitter<'_, '_> {
    /// The type of the scheme.
    pub(super) fn scheme(&self) -> TokenStream {
        if self.formulas.monitor.is_some() {
            return transformed(self.model.order.stages());
        }
        composed(self.formulas.stages(), self.scheme_of_single_steps())
    }

    fn scheme_of_single_steps(&self) -> TokenStream {
        let carry = if self.shares_impulse() { quote!(runtime::Shared) } else { quote!(runtime::Apart) };
        if let Some(splitting) = &self.formulas.splitting {
            return match (self.model.order.number(), splitting.has_gradient) {
                (6, true) => quote!(runtime::Split<runtime::GradientSix, 7>),
                (6, false) => quote!(runtime::Split<runtime::PlainSix, 10>),
                (_, true) => quote!(runtime::Split<runtime::GradientFour, 4>),
                (_, false) => quote!(runtime::Split<runtime::PlainFour, 7>),
            };
        }
        if self.formulas.collocation.is_some() {
            let (numbers, times) = (self.numbers_of_pair(), self.terms_of_time());
            return quote!(runtime::Collocated<#numbers, #times>);
        }
        if self.program.turns_in_plane() {
            return if self.is_free_on_great_circles() {
                quote!(runtime::FreeGreatCircle)
            } else {
                quote!(runtime::GreatCircle<#carry>)
            };
        }
        if self.keeps_motions() {
            return quote!(runtime::AlongFreeMotion);
        }
        match (self.formulas.stepped, self.program.steps.len()) {
            (2, _) => quote!(runtime::AdjointPair<#carry>),
            (_, 1) => quote!(runtime::KickDriftKick<#carry>),
            // the declared Lagrangian, without the force that joins its equation, stands last
            (_, _) => quote!(runtime::KickDriftKick<#carry, 1>),
        }
    }

    /// Whether the end kick of a step serves as the start kick of the next.
    pub(super) fn shares_impulse(&self) -> bool {
        let (formulas, last) = (self.formulas, self.formulas.stepped - 1);
        formulas.substeps[0].start == formulas.substeps[last].end
            && self.program.find(Id::StartKick(0)).is_some()
            && self.program.find(Id::EndKick(last)).is_some()
            && formulas.splitting.is_none()
            && formulas.monitor.is_none()
            && formulas.collocation.is_none()
    }

    /// Whether steps are made in (q, w) and nothing pushes.
    fn is_free_on_great_circles(&self) -> bool {
        let is_free = |id: Id| self.program.find(id).is_none();
        self.program.turns_in_plane() && is_free(Id::StartGradient(0)) && is_free(Id::EndGradient(0))
    }

    /// The functions that the scheme calls apart from the parts of a step.
    pub(super) fn parts_of_scheme(&self) -> TokenStream {
        if self.formulas.splitting.is_some() {
            return self.split_kicks();
        }
        if let Some(monitor) = &self.formulas.monitor {
            let is_exact = monitor.drifts_exactly.then(|| flag("DRIFTS_ARE_EXACT", true));
            let functions = self.written(TIME_TRANSFORMED, &self.scope_of_step(), &no_words);
            return self.implementation("TimeTransformed", &[], quote!(#is_exact #functions));
        }
        if self.formulas.collocation.is_some() {
            return self.hamilton_equations();
        }
        if self.program.turns_in_plane() {
            let turn = self.written(GREAT_CIRCLES, &self.scope_of_step(), &no_words);
            return self.implementation("GreatCircles", &[], turn);
        }
        if self.keeps_motions() { self.free_motion() } else { TokenStream::new() }
    }

    /// Whether the free motions of several steps are the same, so that their constants are computed once.
    pub(super) fn keeps_motions(&self) -> bool {
        self.formulas.is_exact && self.free_rotations().next().is_some() || self.formulas.keeps_scalars()
    }

    /// The equations whose constants stay the same along a motion.
    pub(super) fn kept(&self) -> impl Iterator<Item = &Solve> {
        let is_kept = |solve: &&Solve| solve.solution == Solution::FreeRotation || tensor(solve.solution).is_some();
        self.program.steps[0].solves.iter().filter(is_kept)
    }

    pub(super) fn kind_of_free_rotation(&self) -> Ident {
        if self.formulas.turns_whole() { format_ident!("FreeRotation4") } else { format_ident!("FreeRotation") }
    }

    /// The implementation of `FreeMotion`: the constants of a motion, and how a step follows it.
    pub(super) fn free_motion(&self) -> TokenStream {
        let kind = self.kind_of_free_rotation();
        let kept = if self.formulas.turns_whole() { quote!(KeptRotation4) } else { quote!(KeptRotation) };
        let functions = self.functions(FREE_MOTION, (0, 0), &|word| self.word_of_step(word), |function, _| {
            if function.name == "follow" {
                let followed = Body::from(self.followed());
                let is_short = self.formulas.keeps_scalars();
                return Some(if is_short { followed.inlined(quote!(#[inline(always)])) } else { followed });
            }
            let motions = self.kept().map(|solve| match self.equation_of_body(solve) {
                Some((equation, target)) => quote!(runtime::scalar_of_motion(&#equation, #target)),
                None => {
                    let (name, target) = (self.constant_of(solve), self.momentum_of_free_rotation(solve));
                    quote!(runtime::#kind::motion(&c.#name, #target))
                }
            });
            Some(Body::from(quote!([#(#motions),*])).inlined(quote!()))
        });
        let count = size(self.kept().count());
        let kept = if self.formulas.keeps_scalars() { quote!(T) } else { quote!(runtime::#kept<T>) };
        self.implementation("FreeMotion", &[], quote!(type Kept = [#kept; #count]; #functions))
    }

    /// F − I and the next momentum at once, or the chart coordinates of all factors.
    fn followed(&self) -> TokenStream {
        if !self.formulas.turns_whole() {
            let (solutions, result) = self.solved(&self.program.steps[0], true);
            return quote!(#solutions runtime::Ok((#result, *mu)));
        }
        let Some((name, solve)) = self.free_rotations().next() else { return TokenStream::new() };
        // spatial momenta move as those of the body that turns back
        if self.is_left(solve) {
            return quote! {
                let (d, mu) = runtime::FreeRotation4::turn(&c.#name, &kept[0], &-*mu)?;
                runtime::Ok((d.transpose(), -mu))
            };
        }
        quote!(runtime::FreeRotation4::turn(&c.#name, &kept[0], mu))
    }

    pub(super) fn split_kicks(&self) -> TokenStream {
        let functions = self.written(SPLIT_KICKS, &self.scope_of_step(), &no_words);
        self.implementation("SplitKicks", &[], functions)
    }
}

/// The scheme of a step of so many single steps; where it is `None`, that of single steps.
pub(super) fn composed(stages: Option<usize>, single: TokenStream) -> TokenStream {
    let Some(stages) = stages else { return single };
    let sizes = sizes(stages);
    quote!(runtime::Composed<#single, #sizes>)
}

/// The scheme of a step of transformed time that is composed of so many.
fn transformed(stages: Option<usize>) -> TokenStream {
    let sizes = sizes(stages.unwrap_or(1));
    quote!(runtime::Transformed<#sizes>)
}

/// The sizes of so many steps, the same forwards and backwards, and how many differ.
fn sizes(stages: usize) -> TokenStream {
    let order = match stages {
        1 => quote!(OfOrderTwo),
        5 => quote!(OfOrderFour),
        11 => quote!(OfOrderSix),
        _ => quote!(OfOrderEight),
    };
    let distinct = size(stages.div_ceil(2));
    quote!(runtime::#order, #distinct)
}
