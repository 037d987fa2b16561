//! The implementation of the trait `Controlled`, for the choice of inputs.

use clebsch_symbolic::{Elements, Role, Shape, both};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::block::{Block, leaf, matrix};
use super::function::{Function, Words};
use super::functions::{
    BOUNDED, BOUNDED_ON_EDGE, ENDED, EXPANDED, EXPANDED_ON_EDGE, FORCED, PRICED, PRICED_ON_EDGE, SOFT, STEERED,
};
use super::scope::{REACTIONS, nested_type, size};
use super::{SystemEmitter, flag};
use crate::derive::Id;
use crate::lower::Input;

/// The data for the types of `Controlled`.
pub(super) struct ControlTypes<'a> {
    pub is_steered: bool,
    /// The number of inputs.
    pub inputs: usize,
    /// The declared bounds, and the number of equations among them.
    pub bounds: (Vec<&'a str>, usize),
    /// The conditions of the end, and the number of equations among them.
    pub target: (Vec<&'a str>, usize),
    /// The types of the references of a step and of the end, where there are any.
    pub references: Option<[TokenStream; 2]>,
    /// Whether a constraint acts in steps.
    pub is_constrained: bool,
    /// Whether steps read references.
    pub refers_in_steps: bool,
}

impl ControlTypes<'_> {
    /// The implementation of `Controlled` with its functions, from the words of their signatures.
    pub(super) fn implementation(
        &self,
        block: &Block<'_>,
        functions: impl FnOnce(&Words<'_>) -> TokenStream,
    ) -> TokenStream {
        let ControlTypes { is_steered, inputs, bounds: (bounds, equal), references, .. } = self;
        let (target, equations) = &self.target;
        let is_constrained = self.is_constrained.then(|| flag("IS_CONSTRAINED", true));
        let refers = (references.is_some() && !self.refers_in_steps).then(|| flag("REFERS_IN_STEPS", false));
        let equal = (*equal > 0).then(|| {
            let equal = size(*equal);
            quote!(const EQUAL_BOUNDS: ::core::primitive::usize = #equal;)
        });
        let target = (!target.is_empty()).then(|| {
            let equations = size(*equations);
            quote! {
                const TARGET: &'static [&'static ::core::primitive::str] = &[#(#target),*];
                const EQUATIONS: ::core::primitive::usize = #equations;
            }
        });
        let (motions, name) = (block.dimension, &block.target.name);
        let (dimension, point, constants) =
            if *is_steered { (motions, quote!(Q), quote!(T)) } else { (2 * motions, quote!((Q, Mu)), quote!((C, T))) };
        let [d, u, c, motions] = [dimension, *inputs, bounds.len(), motions].map(size);
        let constants = match references {
            Some([of_step, of_end]) => quote!(runtime::Referring<#constants, #of_step, #of_end>),
            None => constants,
        };
        let functions = functions(&|word| {
            Some(match word {
                "Constants" => constants.clone(),
                "Expansion" => quote!(runtime::Expansion<#point, T, #d, #u>),
                "Arrival" => quote!(runtime::Arrival<T, #d>),
                "BoundsExpansion" => quote!(runtime::BoundsExpansion<T, #d, #u, #c>),
                "EndpointExpansion" => quote!(runtime::EndpointExpansion<T, #d>),
                "TargetExpansion" => quote!(runtime::TargetExpansion<T, #d>),
                "Costates" => matrix(dimension, 1),
                "Changes" => matrix(dimension, dimension),
                "Input" => matrix(*inputs, 1),
                "Bounds" => matrix(bounds.len(), 1),
                _ => return None,
            })
        });
        block.target.derived(
            Some(quote!(runtime::Controlled<#d, #u, #c>)),
            quote! {
                type Scalar = T;

                const NAME: &'static ::core::primitive::str = #name;
                const BOUNDS: [&'static ::core::primitive::str; #c] = [#(#bounds),*];
                #equal
                #is_constrained
                #refers
                const MOTIONS: ::core::primitive::usize = #motions;
                #target

                type Place = #point;
                type Constants = #constants;

                #functions
            },
        )
    }
}

impl SystemEmitter<'_, '_> {
    /// The impl block, where something is chosen.
    pub(super) fn controlled(&self) -> Option<TokenStream> {
        let control = self.model.control.as_ref()?;
        // inputs move the configuration by themselves, or are those of forces
        let is_steered = self.kernels.find(Id::StepExpanded).is_some();
        let types = ControlTypes {
            is_steered,
            inputs: self.model.chosen().iter().map(|leaf| leaf.shape.len()).sum(),
            bounds: (control.bounds.each(|bound| bound.text.as_str()), control.equations()),
            target: self.conditions_as_written(),
            references: self.reference_types(),
            is_constrained: self.reactions.is_some(),
            refers_in_steps: self.moves_by_reference(),
        };
        let scope = self.scope_of_system();
        let functions = |words: &Words<'_>| {
            let words = |word: &str| words(word).or_else(|| self.word_of_control(word, &types));
            let tables = [
                if self.on_edge.price { PRICED_ON_EDGE } else { PRICED },
                if self.on_edge.bounds { BOUNDED_ON_EDGE } else { BOUNDED },
                SOFT,
                ENDED,
                if is_steered { STEERED } else { FORCED },
                match self.on_edge.price {
                    _ if is_steered => &[],
                    true => EXPANDED_ON_EDGE,
                    false => EXPANDED,
                },
            ];
            let written = tables.map(|table| {
                self.functions(table, (0, 0), &words, |function, kernel| {
                    if function.kernel == Id::Crossed && kernel.is_none() {
                        return None;
                    }
                    let body = function.written(&scope, kernel, &words)?;
                    let body = body.after(self.references_of(function, &types));
                    let body = match self.titled_with_constraint(function) {
                        Some(title) => body.titled(title),
                        None => body,
                    };
                    let is_short = ["follow", "price", "bounds"].contains(&function.name);
                    Some(if is_short { body.inlined(quote!(#[inline])) } else { body })
                })
            });
            quote!(#(#written)*)
        };
        Some(types.implementation(self, functions))
    }

    /// The documentation of second derivatives where a constraint acts in steps.
    fn titled_with_constraint(&self, function: &Function) -> Option<&'static str> {
        self.reactions?;
        match function.name {
            "expand" => Some(
                "The forced step with its derivatives, and the second derivatives of ℓ + λ·(η′, N⁺). With the multipliers of all equations of the step \
                 they are those of α·η′ + β·(F⁺ℓd + A⁺ᵀν) + ρ·(A⁺Σ⁻¹N⁺ − b) + κ·(F⁻ℓd − Aᵀλ − N) + σ·ψ. η′ contributes ± ½ α·[Ad η, ζ].",
            ),
            "bounds_expanded" if self.on_edge.bounds => Some(
                "The bounds with their derivatives, and the second derivatives of z·a, those of z·a + κ·(F⁻ℓd − Aᵀλ − N) + σ·ψ with the \
                 multipliers κ and σ of the step.",
            ),
            _ => None,
        }
    }

    /// The conditions of the end, and the number of equations among them.
    fn conditions_as_written(&self) -> (Vec<&str>, usize) {
        let Some(target) = &self.model.target else { return (Vec::new(), 0) };
        (target.conditions.each(|condition| condition.text.as_str()), target.equations)
    }

    /// The types of references, where motion, price, bounds or the price of the end read any.
    fn reference_types(&self) -> Option<[TokenStream; 2]> {
        let all = [&self.model.reference, &self.model.end_reference];
        let are_any = all.iter().any(|(_, leaves)| !leaves.is_empty());
        are_any.then(|| {
            all.map(|(layout, leaves)| nested_type(layout, |k| leaf(leaves[k].shape, leaves[k].is_quaternion)))
        })
    }

    /// The references that a function reads, with the constants that they come with.
    fn references_of(&self, function: &Function, types: &ControlTypes<'_>) -> Option<TokenStream> {
        types.references.as_ref().filter(|_| function.arguments.contains("constants"))?;
        let input = self.input_of_stepper(function);
        let referring = quote!(let runtime::Referring { constants, reference, .. } = constants;);
        Some(match function.name {
            "follow" | "expand" | "price_of_time" if self.moves_by_reference() => {
                quote!(#referring runtime::check_given(reference)?; #input)
            }
            "follow" | "check_constraint" | "constrained_place" | "tangent_projector" | "independent" => {
                quote!(let constants = &constants.constants;)
            }
            "endpoint" | "endpoint_expanded" | "target_expanded" => {
                quote!(let runtime::Referring { constants, end_reference, .. } = constants;)
            }
            _ => quote!(#referring #input),
        })
    }

    /// The input of the stepper: the references that forces read are behind the input of the plan. `None` where they read none.
    fn input_of_stepper(&self, function: &Function) -> Option<TokenStream> {
        let given = &self.model.given;
        if given.is_empty() {
            return None;
        }
        let takes_input = function.arguments.contains("u: &Input");
        let chosen = if takes_input { quote!(*u) } else { quote!(runtime::Space::origin()) };
        let given =
            given.iter().map(|access| if access.is_whole() { quote!(*reference) } else { quote!(reference #access) });
        let input = &self.input;
        Some(quote!(let u: &#input = &(#chosen, #(#given),*);))
    }

    /// Whether the step that inputs make reads references.
    fn moves_by_reference(&self) -> bool {
        let is_reference = |(input, _): (&Input, Shape)| matches!(input.role, Role::Reference(_));
        let is_steered = self.kernels.find(Id::StepExpanded).is_some();
        !self.model.given.is_empty()
            || is_steered && self.kernels.kernel(Id::Increment).inputs().into_iter().any(is_reference)
    }

    /// Further words in the code of `Controlled`.
    fn word_of_control(&self, word: &str, types: &ControlTypes<'_>) -> Option<TokenStream> {
        let [m, u, w] = [self.dimension, types.inputs, 2 * self.dimension + types.inputs].map(size);
        let body = |id: Id| {
            let body = self.scope_of_system().body(self.kernels.kernel(id));
            quote!({ #body })
        };
        Some(match word {
            "Checks" => self.checks(),
            "OrbitDefect" => self.orbit_defect(),
            "OrbitMetric" => body(Id::OrbitMetric),
            "Approach" => body(Id::Approach),
            "Bend" => body(Id::Bend),
            "Bracket" => body(Id::Bracket),
            "Curvature" => quote!(runtime::SMatrix<T, #w, #w>),
            "Prepared" => {
                let constants = match types.is_steered {
                    true => quote!(h),
                    false => quote!((runtime::Clebsch::constants(self, h)?, h)),
                };
                match types.references {
                    Some(_) => quote!(runtime::Referring::new::<T>(#constants)),
                    None => constants,
                }
            }
            "StepSize" if types.is_steered => quote!(*constants),
            "StepSize" => quote!(constants.1),
            "Place" if types.is_steered => quote!(x),
            "Place" => quote!(&x.0),
            "End" => match self.kernels.find(Id::PriceOfEnd) {
                Some(kernel) => {
                    let (state, body) = (self.state_of_price(), self.scope_of_system().body_of_scalar(kernel));
                    quote!(#state #body)
                }
                None => quote!(<T as runtime::Zero>::zero()),
            },
            "EndExpanded" => match self.endpoint_expanded() {
                Some(body) => {
                    let state = self.state_of_price();
                    quote!(#state #body)
                }
                None => quote!(runtime::no_endpoint()),
            },
            "StateAtTarget" => {
                let target = self.model.target.as_ref();
                self.state_at_end(Id::TargetExpanded, target.is_some_and(|target| !target.velocities.is_empty()))
            }
            "Weights" => matrix(self.model.target.as_ref()?.conditions.len(), 1),
            "PriceSlope" => {
                let (scope, kernel) = (self.scope_of_system(), self.kernels.kernel(Id::PriceExpanded));
                let (locals, slope) = (scope.locals(kernel), scope.output(kernel, 1));
                quote!({ #locals #slope })
            }
            "Drifted" => quote! {
                let (constants, h) = (&constants.0, constants.1);
                let (q, n) = x;
                let d = &runtime::Variational::drift(self, constants, 0, t, q, n, u)?;
            },
            "Moved" => {
                let scope = self.scope_of_system();
                let [increment, advance] = both([Id::Increment, Id::Advance], |id| self.kernels.kernel(id));
                let [before, within] = both([increment, advance], |kernel| scope.locals(kernel));
                let (increment, advance) = (scope.element(increment, 0), scope.configuration(advance));
                quote! {
                    let (h, q) = (*constants, x);
                    let d = { #before #increment };
                    let next = { #within #advance };
                }
            }
            "Retracted" => {
                let scope = self.scope_of_system();
                let [retraction, advance] = both([Id::Retraction, Id::Advance], |id| self.kernels.kernel(id));
                let coordinates = self.chart_coordinates();
                let [before, within] = both([retraction, advance], |kernel| scope.locals(kernel));
                let (element, advance) = (scope.element(retraction, 0), scope.configuration(advance));
                quote! {
                    let d = { #coordinates #before #element };
                    #within #advance
                }
            }
            "Crossed" => {
                let drifted = self.word_of_control("Drifted", types);
                let (scope, kernel) = (self.scope_of_system(), self.kernels.kernel(Id::ByInput));
                let (locals, [before, after]) = (scope.locals(kernel), both([0, 1], |k| scope.output(kernel, k)));
                quote! {
                    #drifted
                    let next = &runtime::Variational::advance(self, q, d);
                    let edge = runtime::Variational::carried(self, constants, 0, t, (q, d, next, u));
                    let (before, after): (runtime::SMatrix<T, #m, #u>, runtime::SMatrix<T, #m, #u>) = { #locals (#before, #after) };
                }
            }
            "Linked" => {
                self.linked(types, quote!(new(&edge, &before, &after, costate)), quote!(runtime::Space::origin()))
            }
            "Pushed" => self.linked(types, quote!(priced(&edge, &before, &after, costate, &pushed)), quote!(pushed)),
            // the changes of the multipliers of a constraint, with its own terms
            "Reacting" => match self.kernels.find(Id::Crossed) {
                Some(kernel) if !kernel.vanishes() => {
                    let crossed = body(Id::Crossed);
                    quote!(let link = link.crossed(&#crossed);)
                }
                _ => TokenStream::new(),
            },
            "Rows" => {
                let [equations, quantities, places] = self.reactions?;
                let m = self.dimension;
                let [m, d, r, p, k] = [m, 2 * m, equations, quantities, places].map(size);
                quote!(runtime::Declared, #m, #d, #r, #p, #k)
            }
            "Landed" if self.reactions.is_some() => quote!(landed),
            "Landed" => quote!(edge.momentum),
            _ => return None,
        })
    }

    /// The linearised step over an edge, with the costate at its end and the multipliers of its equation. It is `made` without a constraint.
    fn linked(&self, types: &ControlTypes<'_>, made: TokenStream, pushed: TokenStream) -> TokenStream {
        let refused = quote!(ok_or(runtime::Error::SingularTangent { step_size: runtime::Scalar::to_f64(h) })?);
        let Some([equations, quantities, _]) = self.reactions else {
            return quote! {
                let link = runtime::Link::#made.#refused;
                let (mu, kappa) = (&link.costate, &link.multiplier);
            };
        };
        let m = self.dimension;
        let [r, p, m, d, u] = [equations, quantities, m, 2 * m, types.inputs].map(size);
        let names = REACTIONS.map(|name| format_ident!("{name}"));
        let inverse = self.kernels_read_inverse([Id::Bend, Id::Crossed, Id::PriceOfTime]);
        let inverse = inverse.then(|| quote!(let inertia_inverse = &constants.inertia_inverse;));
        quote! {
            let link = runtime::ConstrainedLink::<T, #m, #d, #u, #r>::new::<Self, runtime::Declared, #p>(
                self, (constants, t), ((q, d, next, u), n), &edge, (&before, &after), (costate, &#pushed),
            ).#refused;
            let (mu, kappa) = (link.costate, link.multiplier);
            let runtime::Reactions { #(#names),* } = link.reactions;
            #inverse
        }
    }

    /// Whether some of these kernels read Σ⁻¹ of the constants.
    fn kernels_read_inverse(&self, kernels: [Id; 3]) -> bool {
        let is_inverse = |(input, _): (&Input, Shape)| input.role == Role::InertiaInverse;
        let found = kernels.into_iter().filter_map(|kernel| self.kernels.find(kernel));
        found.flat_map(|kernel| kernel.inputs()).any(is_inverse)
    }

    /// Whether the price of the end takes the velocity there.
    pub(super) fn prices_velocity_at_end(&self) -> bool {
        self.model.endpoint.as_ref().is_some_and(|price| !price.velocities.is_empty())
    }

    fn state_of_price(&self) -> TokenStream {
        self.state_at_end(Id::PriceOfEndExpanded, self.prices_velocity_at_end())
    }

    /// The momentum at the end, and Σ⁻¹, where a kernel takes the velocity.
    fn state_at_end(&self, kernel: Id, takes_velocity: bool) -> TokenStream {
        if !takes_velocity {
            return TokenStream::new();
        }
        let is_inverse = |(input, _): (&Input, Shape)| input.role == Role::InertiaInverse;
        let kernel = self.kernels.kernel(kernel);
        let constant = kernel.inputs().into_iter().any(is_inverse);
        let constant = constant.then(|| quote!(let inertia_inverse = &constants.0.inertia_inverse;));
        quote!(#constant let mu = &x.1;)
    }

    /// φ with its derivatives, at `q` and `t`.
    pub(super) fn endpoint_expanded(&self) -> Option<TokenStream> {
        let (scope, kernel) = (self.scope_of_system(), self.kernels.find(Id::PriceOfEndExpanded)?);
        let (locals, [price, by_time]) = (scope.locals(kernel), both([0, 1], |k| scope.scalar(kernel, k)));
        let [slope, curvature] = both([2, 3], |k| scope.output(kernel, k));
        Some(quote!(#locals runtime::endpoint(#price, #by_time, &#slope, &#curvature)))
    }
}
