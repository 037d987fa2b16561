//! Points on large spheres, stepped in (q, w): w is the covector perpendicular to q with the momentum J(q, w).

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{Emitter, docs};
use crate::lower::Kernel;

impl Emitter<'_, '_> {
    /// Steps along great circles in (q, w): kick, turn, kick, each in n numbers.
    pub(super) fn along_great_circles(&self) -> TokenStream {
        let (krate, private) = (&self.paths.krate, &self.paths.private);
        let (configuration, held, impulse) = (self.configuration_type(), self.held_type(), self.impulse_type());
        let symmetric = self.symmetric_along_great_circles();
        let [one, two] = [1.0, 2.0].map(|weight| quote!(#private::Scalar::from_f64(#weight)));
        let push = |gradient: TokenStream, weight: &TokenStream| quote!(#private::push(q, w, &#gradient, #weight););
        let [start, end] = self.gradients_of_great_circles();
        let turned = quote!(#private::turn_great_circle(a, q, w)?;);
        let steps = match (start, end) {
            _ if self.shares_impulse() => {
                let (half, whole) = (push(quote!(*gradient), &one), push(quote!(*gradient), &two));
                let gradient = quote!(*gradient = self.start_gradient(q););
                // between two steps both kicks are one
                quote! {
                    if steps > 0 {
                        #half
                        for _ in 1..steps {
                            #turned
                            #gradient
                            #whole
                        }
                        #turned
                        #gradient
                        #half
                    }
                }
            }
            (start, end) => {
                let [start, end] = [start, end].map(|name| name.map(|name| push(quote!(self.#name(q)), &one)));
                quote!(for _ in 0..steps { #start #turned #end })
            }
        };
        let (plane, turns) = match self.is_free_on_great_circles() {
            true => (quote!(plane), quote!(for _ in 0..steps { #private::turn_freely(a, plane, q)?; })),
            false => (quote!(w), steps),
        };
        let documentation: &[&str] = match self.is_free_on_great_circles() {
            true => &[
                "q ↦ q⁺, as many times as there are steps, with N = vuᵀ − uvᵀ, which stays.",
                "",
                "q⁺ = cq + aw with w = Nq, a = h/κ and c² = 1 − a²|w|².",
            ],
            false => &[
                "(q, w) ↦ (q⁺, w⁺), as many times as there are steps, with N = wqᵀ − qwᵀ.",
                "",
                "w + ∂U₀, q⁺ = cq + aw and w⁺ = cw − a|w|²q with a = h/κ and c² = 1 − a²|w|², w + ∂U₁; what is not perpendicular to q is taken off w in each",
                "step, which rounding makes necessary.",
            ],
        };
        let documentation = docs::lines(&documentation.iter().map(ToString::to_string).collect::<Vec<_>>());
        quote! {
            #documentation
            #[inline]
            fn euler_poincare_steps(
                &self,
                steps: ::core::primitive::usize,
                q: &mut #configuration,
                #plane: &mut #held,
                gradient: &mut #impulse,
            ) -> ::core::result::Result<(), #krate::Error> {
                let a = self.constants.step_size * self.constants.inertia_inverse;
                #turns
                ::core::result::Result::Ok(())
            }
            #symmetric
        }
    }

    /// A step along a great circle on T*Rⁿ, with what p has along q.
    fn symmetric_along_great_circles(&self) -> TokenStream {
        let (krate, private, configuration) = (&self.paths.krate, &self.paths.private, self.configuration_type());
        let kicked = |name: Ident| quote!(let p = p + self.#name(&q););
        let [start, end] = self.gradients_of_great_circles().map(|name| name.map(kicked));
        quote! {
            /// (q, p) ↦ (q⁺, p⁺), with the momentum J(q, p): both are turned in their plane.
            fn symmetric(
                &self,
                q: &#configuration,
                p: &#configuration,
            ) -> ::core::result::Result<(#configuration, #configuration), #krate::Error> {
                let (q, p) = (*q, *p);
                #start
                let (q, p) = #private::turned_in_plane(self.constants.step_size * self.constants.inertia_inverse, &q, &p)?;
                #end
                ::core::result::Result::Ok((q, p))
            }
        }
    }

    /// The methods that give the gradients at the start and at the end of a step along a great circle; where both are the same, one stands for both.
    fn gradients_of_great_circles(&self) -> [Option<Ident>; 2] {
        let step = &self.program.steps[0];
        let end = if step.end_is_start { "start_gradient" } else { "end_gradient" };
        let named = |gradient: &Option<Kernel>, name: &str| gradient.as_ref().map(|_| format_ident!("{name}"));
        [named(&step.start_gradient, "start_gradient"), named(&step.end_gradient, end)]
    }

    /// A step, or those that it is composed of, in (q, w).
    pub(super) fn great_circles_taken(&self) -> TokenStream {
        let private = &self.paths.private;
        let turned = self.turned_in_place(&quote!(1));
        match self.program.formulas.stages() {
            None => quote!(#private::in_place((*q, *mu, *impulse), #turned)),
            Some(_) => quote! {
                #private::compose(constants, t, (*q, *mu, *impulse), |constants, t, state| {
                    #private::in_place(state, #turned)
                })
            },
        }
    }

    /// What makes as many steps in (q, w) where they stand.
    pub(super) fn turned_in_place(&self, steps: &TokenStream) -> TokenStream {
        let step = &self.names.step;
        quote! {
            |(q, held, impulse)| {
                #step::euler_poincare_steps(&#step { system: self, constants }, #steps, q, held, impulse)
            }
        }
    }

    /// The method that makes a step into the place of another state, where it is made in (q, w).
    pub(super) fn step_into_taken(&self) -> Option<TokenStream> {
        if !self.follows_great_circles() || self.program.formulas.stages().is_some() {
            return None;
        }
        let step = &self.names.step;
        Some(self.step_into(&quote! {
            *next = *q;
            *held = *mu;
            *left = *impulse;
            #step::euler_poincare_steps(&#step { system: self, constants }, 1, next, held, left)
        }))
    }
}
