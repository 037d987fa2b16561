//! The implementations of `Variational` and `Sensitive`: motions, edges, and their derivatives.

use clebsch_symbolic::Role;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::Nesting;
use super::{Emitter, Generics, code, docs, matrices};
use crate::derive::Id;
use crate::lower::{EdgeKernels, Kernel, VariationKernels};

impl Emitter<'_, '_> {
    /// The implementation of `Variational`, where it is asked for.
    pub(super) fn variational(&self) -> TokenStream {
        let Some(variations) = &self.program.variations else { return TokenStream::new() };
        let krate = &self.paths.krate;
        let Generics { parameters, arguments, predicates } = &self.generics;
        let ident = &self.model.item.ident;
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let edges = Literal::usize_unsuffixed(variations.edges.len() * self.program.formulas.stages().unwrap_or(1));
        let (motions, edge, drift) = (self.motions(variations), self.edge(), self.drift());
        let scalar = &self.paths.scalar;
        let end = self.endpoint_expanded().map(|body| {
            quote! {
                /// The price of the end with its derivatives.
                fn endpoint(&self, t: #scalar, q: &Self::Configuration) -> #krate::EndpointExpansion<#scalar, #dimension> {
                    #body
                }
            }
        });
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Variational<#dimension> for #ident<#arguments> #predicates {
                const EDGES: ::core::primitive::usize = #edges;

                #motions
                #drift
                #edge
                #end
            }
        }
    }

    /// Retraction, composition, advance, and the geometry of the orbit.
    fn motions(&self, variations: &VariationKernels) -> TokenStream {
        let method = |documentation: &str, signature: TokenStream, kernel: &Kernel, nesting, before: TokenStream| {
            let documentation = docs::formulas(documentation, &[], Some(kernel));
            let body = code::body(&self.scope_of_system(), kernel, nesting);
            quote! {
                #documentation
                #[inline]
                fn #signature {
                    #before
                    #body
                }
            }
        };
        let compose = method(
            "The increment of the motion by I + d and after it by I + second.",
            quote!(compose(&self, d: &Self::Element, second: &Self::Element) -> Self::Element),
            &variations.compose,
            Some(Nesting::Element),
            quote!(),
        );
        let advance = self.advance_of_motions();
        let motion = method(
            "The infinitesimal motion ξ_Q(q).",
            quote!(infinitesimal_motion(&self, q: &Self::Configuration, x: &Self::Momentum) -> Self::Configuration),
            &variations.generator,
            Some(Nesting::Configuration),
            quote!(),
        );
        let retractions = self.retractions(variations);
        let (matrix, orbit_metric) = (self.block_type(), &variations.orbit_metric);
        let title = "GᵀG of the infinitesimal motion G: ξ ↦ ξ_Q(q).";
        let signature = quote!(orbit_metric(&self, q: &Self::Configuration) -> #matrix);
        let metric = match self.program.form.keeps_matrices() {
            true => {
                let along = |role| matches!(role, Role::Algebra(_));
                let (terms, metric) = matrices::matrix_of(&self.scope_of_system(), orbit_metric, 0, "x", along);
                let documentation = docs::formulas(title, &[], Some(orbit_metric));
                quote! {
                    #documentation
                    #[inline]
                    fn #signature {
                        #terms
                        #metric
                    }
                }
            }
            false => method(title, signature, orbit_metric, None, quote!()),
        };
        let difference = code::combined(self.model, &quote!(target), quote!(-), &quote!(q), &self.paths);
        let krate = &self.paths.krate;
        quote! {
            #retractions
            #compose
            #advance
            #motion
            #metric
            /// J(q, target − q).
            #[inline]
            fn approach(&self, q: &Self::Configuration, target: &Self::Configuration) -> Self::Momentum {
                #krate::Clebsch::momentum_map(self, q, &(#difference))
            }
        }
    }

    /// The move by an increment. Where sums keep their rests, the kernel has what is added.
    fn advance_of_motions(&self) -> TokenStream {
        let kernel = &self.program.steps[0].advance;
        let formulas = self.program.formulas.titled(Id::Advance);
        let documentation = docs::formulas("The configuration that F = I + D moves q to.", formulas, Some(kernel));
        let moved = code::body(&self.scope_of_system(), kernel, Some(Nesting::Configuration));
        let moved = if self.is_compensated() { self.moved_to(quote!({ #moved })) } else { moved };
        quote! {
            #documentation
            #[inline]
            fn advance(&self, q: &Self::Configuration, d: &Self::Element) -> Self::Configuration {
                #moved
            }
        }
    }

    /// τ(η) and τ(−η), side by side.
    fn retractions(&self, variations: &VariationKernels) -> TokenStream {
        let (kernel, scope) = (&variations.retractions, self.scope_of_system());
        let (coordinates, locals) = (self.chart_coordinates(&variations.slopes), code::locals(&scope, kernel));
        let [ahead, back] = [0, kernel.outputs.len() / 2].map(|first| {
            code::nested(&self.model.element, &mut |leaf| {
                let (shape, entries) = &kernel.outputs[first + leaf];
                code::grid(&scope, *shape, entries, scope.is_quaternion(Nesting::Element, leaf))
            })
        });
        let documentation =
            docs::formulas("The increments τ(η) − I and τ(−η) − I of a small motion.", &[], Some(kernel));
        quote! {
            #documentation
            #[inline]
            fn retractions(&self, eta: &Self::Momentum) -> [Self::Element; 2] {
                #coordinates
                #locals
                [#ahead, #back]
            }
        }
    }

    /// The coordinates of exp η in the chart of small motions, to first order.
    fn chart_coordinates(&self, slopes: &[(i64, i64)]) -> TokenStream {
        let private = &self.paths.private;
        if slopes.iter().all(|slope| *slope == (1, 1)) {
            return quote!(let x = eta;);
        }
        let scope = self.scope_of_system();
        let entries = slopes.iter().enumerate().map(|(i, &(numerator, denominator))| {
            let i = Literal::usize_unsuffixed(i);
            let slope = scope.number(&clebsch_symbolic::rational(numerator, denominator));
            if (numerator, denominator) == (1, 1) { quote!(eta[#i]) } else { quote!(#slope * eta[#i]) }
        });
        // operations on whole matrices take references
        let reference = self.program.form.keeps_matrices().then(|| quote!(&));
        quote!(let x = #reference #private::vector([#(#entries),*]);)
    }

    /// The implicit solve of an edge.
    fn drift(&self) -> TokenStream {
        let (krate, scalar, step) = (&self.paths.krate, &self.paths.scalar, &self.names.step);
        let (time, input) = (self.time_argument(), self.input_argument());
        let stage = self.stage_of_edge();
        let call = self.on_edge(&|suffix| {
            let drift = format_ident!("drift{suffix}");
            quote!(step.#drift(#time q, mu, #input))
        });
        quote! {
            /// The increment of the group element of an edge with the momentum μ.
            #[inline]
            fn drift(
                &self,
                constants: &Self::Constants,
                edge: ::core::primitive::usize,
                t: #scalar,
                q: &Self::Configuration,
                mu: &Self::Momentum,
                u: &Self::Input,
            ) -> ::core::result::Result<Self::Element, #krate::Error> {
                #stage
                let step = #step { system: self, constants };
                #call
            }
        }
    }

    /// A call for the edge that is asked for.
    fn on_edge(&self, call: &dyn Fn(&'static str) -> TokenStream) -> TokenStream {
        let first = call(self.program.suffix(0));
        if self.program.formulas.parts == 1 {
            return first;
        }
        let second = call(self.program.suffix(1));
        quote!(if edge == 0 { #first } else { #second })
    }

    /// The edges, handed to the type `Step`.
    fn edge(&self) -> TokenStream {
        let edge = self.handed("edge", "Edge", "An edge with its second derivatives.");
        let momenta = self.handed("momenta", "Momenta", "An edge with its first derivatives.");
        let carried =
            self.handed("carried", "Carried", "The derivatives of an edge along motions that leave F as it is.");
        quote!(#edge #momenta #carried)
    }

    /// A method that the type `Step` has for each edge.
    fn handed(&self, name: &str, answer: &str, documentation: &str) -> TokenStream {
        let (krate, scalar, step) = (&self.paths.krate, &self.paths.scalar, &self.names.step);
        let (time, input) = (self.time_argument(), self.input_argument());
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let (method, answer) = (format_ident!("{name}"), format_ident!("{answer}"));
        let documentation = format!(" {documentation}");
        let stage = self.stage_of_edge();
        let call = self.on_edge(&|suffix| {
            let method = format_ident!("{name}{suffix}");
            quote!(step.#method(#time q, d, next, #input))
        });
        quote! {
            #[doc = #documentation]
            #[inline]
            fn #method(
                &self,
                constants: &Self::Constants,
                edge: ::core::primitive::usize,
                t: #scalar,
                q: &Self::Configuration,
                d: &Self::Element,
                next: &Self::Configuration,
                u: &Self::Input,
            ) -> #krate::#answer<#scalar, #dimension> {
                #stage
                let step = #step { system: self, constants };
                #call
            }
        }
    }

    /// The implementation of `Sensitive`, where it is asked for.
    pub(super) fn sensitive(&self) -> TokenStream {
        let asked = self.program.variations.iter().flat_map(|variations| &variations.edges);
        if !asked.into_iter().any(|edge| edge.slopes.is_some()) {
            return TokenStream::new();
        }
        let (krate, scalar, step) = (&self.paths.krate, &self.paths.scalar, &self.names.step);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let ident = &self.model.item.ident;
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let names = self.program.formulas.quantities.iter().map(|quantity| quantity.name.as_str());
        let count = Literal::usize_unsuffixed(self.program.formulas.quantities.len());
        let (slopes, time, input) = (self.slopes_type(), self.time_argument(), self.input_argument());
        let stage = self.stage_of_edge();
        let call = self.on_edge(&|suffix| {
            let edge = format_ident!("edge_slopes{suffix}");
            quote!(step.#edge(#time q, d, next, #input))
        });
        let slopes_of_step = self.slopes_of_step(call);
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Sensitive<#dimension, #count> for #ident<#arguments> #predicates {
                const QUANTITIES: [&'static ::core::primitive::str; #count] = [#(#names),*];

                /// How the momenta of an edge depend on parameters, step size and time.
                #[inline]
                fn edge_slopes(
                    &self,
                    constants: &Self::Constants,
                    edge: ::core::primitive::usize,
                    t: #scalar,
                    q: &Self::Configuration,
                    d: &Self::Element,
                    next: &Self::Configuration,
                    u: &Self::Input,
                ) -> (#slopes, #slopes) {
                    #stage
                    let step = #step { system: self, constants };
                    #slopes_of_step
                }
            }
        }
    }

    fn block_type(&self) -> TokenStream {
        self.matrix_type(self.dimension())
    }

    fn slopes_type(&self) -> TokenStream {
        self.matrix_type(self.program.formulas.quantities.len())
    }

    /// A matrix with a row for each component of the momentum.
    fn matrix_type(&self, columns: usize) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let (rows, columns) = (Literal::usize_unsuffixed(self.dimension()), Literal::usize_unsuffixed(columns));
        quote!(#private::SMatrix<#scalar, #rows, #columns>)
    }

    /// The methods of `Step` that belong to edges.
    pub(super) fn edges(&self) -> TokenStream {
        let Some(variations) = &self.program.variations else { return TokenStream::new() };
        let edges = variations.edges.iter().enumerate().map(|(index, edge)| {
            let (drift, momenta, edge_with_slopes) =
                (self.drift_of(index), self.momenta_of(index, edge), self.edge_of(index, edge));
            quote!(#drift #momenta #edge_with_slopes)
        });
        quote!(#(#edges)*)
    }

    fn drift_of(&self, index: usize) -> TokenStream {
        let (krate, suffix, step) = (&self.paths.krate, self.program.suffix(index), &self.program.steps[index]);
        let (solve, drift) = (format_ident!("solve{suffix}"), format_ident!("drift{suffix}"));
        let (configuration, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let (time, place) = (self.time_parameter(), self.place_arguments(step));
        let (kicked, pushed, input) =
            (self.kicked_plainly(index, step), self.start_force(index, step), self.input_parameter());
        let pushed = pushed.map(|force| quote!(let mu = mu + #force;));
        quote! {
            /// The increment of the group element whose momentum is μ at q.
            #[inline]
            fn #drift(&self, #time q: &#configuration, mu: &#momentum, #input) -> ::core::result::Result<#element, #krate::Error> {
                let (q, mu) = (*q, *mu);
                #kicked
                #pushed
                let x = self.#solve(#place &mu)?;
                ::core::result::Result::Ok(self.increment(&x))
            }
        }
    }

    fn momenta_of(&self, index: usize, kernels: &EdgeKernels) -> TokenStream {
        let (krate, scalar, kernel) = (&self.paths.krate, &self.paths.scalar, &kernels.momenta);
        let (configuration, element, time) = (self.configuration_type(), self.element_type(), self.time_parameter());
        let (input, dimension) = (self.input_parameter(), Literal::usize_unsuffixed(self.dimension()));
        let scope = self.scope_of_step();
        let (locals, lagrangian) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
        let [before, after] =
            [1, 2].map(|index: usize| code::grid(&scope, kernel.outputs[index].0, &kernel.outputs[index].1, false));
        let documentation = docs::formulas("ℓd with both Legendre transforms.", &[], Some(kernel));
        let name = format_ident!("momenta{}", self.program.suffix(index));
        quote! {
            #documentation
            #[inline]
            fn #name(&self, #time q: &#configuration, d: &#element, next: &#configuration, #input) -> #krate::Momenta<#scalar, #dimension> {
                #locals
                #krate::Momenta { lagrangian: #lagrangian, before: #before, after: #after }
            }
        }
    }

    fn edge_of(&self, index: usize, kernels: &EdgeKernels) -> TokenStream {
        let (krate, scalar, suffix) = (&self.paths.krate, &self.paths.scalar, self.program.suffix(index));
        let (configuration, element, time) = (self.configuration_type(), self.element_type(), self.time_parameter());
        let input = self.input_parameter();
        let place = quote!(#time q: &#configuration, d: &#element, next: &#configuration, #input);
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let scope = self.scope_of_step();
        let along = |role| matches!(role, Role::Algebra(_));
        let keeps_matrices = self.program.form.keeps_matrices();
        let grid = |kernel: &Kernel, index: usize| match keeps_matrices {
            true => matrices::matrix_of(&scope, kernel, index, "x", along).1,
            false => {
                let (shape, entries) = &kernel.outputs[index];
                code::matrix(&scope, *shape, entries)
            }
        };
        // what derivatives along motions are made of stands with them
        let locals = |kernel: &Kernel| match keeps_matrices {
            true => {
                let depends = kernel.depends_on(along);
                code::locals_where(&scope, kernel, |k| !depends[k])
            }
            false => code::locals(&scope, kernel),
        };
        let kernel = &kernels.edge;
        let (terms, lagrangian) = (locals(kernel), scope.code(&kernel.outputs[0].1[0], false));
        let vector = |index: usize| code::grid(&scope, kernel.outputs[index].0, &kernel.outputs[index].1, false);
        let (before, after) = (vector(1), vector(2));
        let (by_start, by_end, after_by_end) = (grid(kernel, 3), grid(kernel, 4), grid(kernel, 5));
        let documentation = docs::formulas(
            "ℓd with both Legendre transforms and their derivatives along the motions of both ends.",
            &[],
            Some(kernel),
        );
        let after_by_start = match kernel.outputs.len() {
            7 => grid(kernel, 6),
            _ => quote!(-before_by_end.transpose()),
        };
        let carried = {
            let kernel = &kernels.carried;
            let documentation = docs::formulas(
                "F⁺ℓd with the derivatives of both momenta, along motions that leave F as it is and along those of q⁺ alone.",
                &[],
                Some(kernel),
            );
            let (name, locals) = (format_ident!("carried{suffix}"), locals(kernel));
            let momentum = code::grid(&scope, kernel.outputs[0].0, &kernel.outputs[0].1, false);
            let [adjoint, before, after, before_by_end, after_by_end] =
                [1, 2, 3, 4, 5].map(|index| grid(kernel, index));
            quote! {
                #documentation
                #[inline]
                fn #name(&self, #place) -> #krate::Carried<#scalar, #dimension> {
                    #locals
                    #krate::Carried {
                        momentum: #momentum,
                        adjoint: #adjoint,
                        before: #before,
                        after: #after,
                        before_by_end: #before_by_end,
                        after_by_end: #after_by_end,
                    }
                }
            }
        };
        let edge = format_ident!("edge{suffix}");
        let slopes = kernels.slopes.as_ref().map(|kernel| {
            let documentation =
                docs::formulas("∂F⁻ℓd and ∂F⁺ℓd with respect to what is fixed during a step.", &[], Some(kernel));
            let (name, slopes) = (format_ident!("edge_slopes{suffix}"), self.slopes_type());
            let matrix = |index: usize| code::matrix(&scope, kernel.outputs[index].0, &kernel.outputs[index].1);
            let (locals, before, after) = (code::locals(&scope, kernel), matrix(0), matrix(1));
            quote! {
                #documentation
                fn #name(&self, #place) -> (#slopes, #slopes) {
                    #locals
                    (#before, #after)
                }
            }
        });
        quote! {
            #documentation
            #[inline]
            fn #edge(&self, #place) -> #krate::Edge<#scalar, #dimension> {
                #terms
                let before_by_end = #by_end;
                #krate::Edge {
                    lagrangian: #lagrangian,
                    before: #before,
                    after: #after,
                    before_by_start: #by_start,
                    before_by_end,
                    after_by_start: #after_by_start,
                    after_by_end: #after_by_end,
                }
            }
            #carried
            #slopes
        }
    }
}
