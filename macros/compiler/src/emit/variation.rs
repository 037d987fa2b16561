//! The implementations of `Variational` and `Sensitive`: motions, edges, and their derivatives.

use clebsch_symbolic::Role;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::Nesting;
use super::{Emitter, Generics, code, docs, matrices};
use crate::derive::Id;
use crate::lower::Kernel;

impl Emitter<'_, '_> {
    /// The implementations of `Variational` and of `VariedSubstep` for each edge, where they are asked for.
    pub(super) fn variational(&self) -> TokenStream {
        if !self.model.has_variations() {
            return TokenStream::new();
        }
        let krate = &self.paths.krate;
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, scalar) = (&self.model.item.ident, &self.paths.scalar);
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let motions = self.motions();
        let end = self.endpoint_expanded().map(|body| {
            quote! {
                /// The price of the end with its derivatives.
                fn endpoint(&self, t: #scalar, q: &Self::Configuration) -> #krate::EndpointExpansion<#scalar, #dimension> {
                    #body
                }
            }
        });
        let slopes = if self.is_sensitive() {
            let slopes = self.slopes_type();
            quote!((#slopes, #slopes))
        } else {
            quote!(())
        };
        let varied = self.implementation("Varied", &[&dimension], quote!(type Slopes = #slopes;));
        let edges = (0..self.program.formulas.stepped).map(|index| self.edge(index));
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Variational<#dimension> for #ident<#arguments> #predicates {
                #motions
                #end
            }
            #varied
            #(#edges)*
        }
    }

    /// Whether derivatives with respect to what is fixed during a step are asked for.
    fn is_sensitive(&self) -> bool {
        (0..self.program.formulas.stepped).any(|index| self.program.find(Id::EdgeSlopes(index)).is_some())
    }

    /// Retraction, composition, advance, and the geometry of the orbit.
    fn motions(&self) -> TokenStream {
        let formulas = &self.program.formulas;
        let method = |(documentation, id): (&str, Id), signature: TokenStream, nesting| {
            let kernel = self.program.kernel(id);
            let documentation = docs::formulas(documentation, formulas.titled(id), Some(kernel));
            let body = code::body(&self.scope_of_system(), kernel, nesting);
            quote! {
                #documentation
                #[inline]
                fn #signature {
                    #body
                }
            }
        };
        let compose = method(
            ("The increment of the motion by I + d and after it by I + second.", Id::Composition),
            quote!(compose(&self, d: &Self::Element, second: &Self::Element) -> Self::Element),
            Some(Nesting::Element),
        );
        let advance = self.advance_of_motions();
        let motion = method(
            ("The infinitesimal motion ξ_Q(q).", Id::Generator),
            quote!(infinitesimal_motion(&self, q: &Self::Configuration, x: &Self::Momentum) -> Self::Configuration),
            Some(Nesting::Configuration),
        );
        let retractions = self.retractions();
        let (matrix, orbit_metric) = (self.block_type(), self.program.kernel(Id::OrbitMetric));
        let title = "GᵀG of the infinitesimal motion G: ξ ↦ ξ_Q(q).";
        let signature = quote!(orbit_metric(&self, q: &Self::Configuration) -> #matrix);
        let metric = match self.program.form.keeps_matrices() {
            true => {
                let along = |role| matches!(role, Role::Algebra(_));
                let (terms, metric) = matrices::matrix_of(&self.scope_of_system(), orbit_metric, 0, "x", along);
                let documentation = docs::formulas(title, formulas.titled(Id::OrbitMetric), Some(orbit_metric));
                quote! {
                    #documentation
                    #[inline]
                    fn #signature {
                        #terms
                        #metric
                    }
                }
            }
            false => method((title, Id::OrbitMetric), signature, None),
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
        let kernel = self.program.kernel(Id::Advance);
        let formulas = self.program.formulas.titled(Id::Advance);
        let documentation = docs::formulas("The configuration that F = I + D moves q to.", formulas, Some(kernel));
        let moves_by_increments = self.program.find(Id::Displacement).is_none();
        let moved = if self.is_compensated() {
            let added = code::body(&self.scope_of_system(), kernel, Some(Nesting::Configuration));
            let sum = code::combined(self.model, &quote!(q), quote!(+), &quote!(added), &self.paths);
            quote!(let added = { #added }; #sum)
        } else if moves_by_increments {
            {
                let parts = self.call_of_parts("Parts", &[]);
                quote!(#parts::advance(self, q, d))
            }
        } else {
            code::body(&self.scope_of_system(), kernel, Some(Nesting::Configuration))
        };
        quote! {
            #documentation
            #[inline]
            fn advance(&self, q: &Self::Configuration, d: &Self::Element) -> Self::Configuration {
                #moved
            }
        }
    }

    /// τ(η) and τ(−η), side by side.
    fn retractions(&self) -> TokenStream {
        let (kernel, scope) = (self.program.kernel(Id::Retraction), self.scope_of_system());
        let (coordinates, locals) =
            (self.chart_coordinates(&self.program.formulas.slopes_of_retraction()), code::locals(&scope, kernel));
        let [ahead, back] = [0, kernel.outputs.len() / 2].map(|first| {
            code::nested(&self.model.element, &mut |leaf| {
                let (shape, entries) = &kernel.outputs[first + leaf];
                code::grid(&scope, *shape, entries, scope.is_quaternion(Nesting::Element, leaf))
            })
        });
        let formulas = self.program.formulas.titled(Id::Retraction);
        let title = "The increments τ(η) − I and τ(−η) − I of a small motion.";
        let documentation = docs::formulas(title, formulas, Some(kernel));
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

    /// The implementation of `Sensitive`, where it is asked for.
    pub(super) fn sensitive(&self) -> TokenStream {
        if !self.is_sensitive() {
            return TokenStream::new();
        }
        let (krate, private) = (&self.paths.krate, &self.paths.private);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let ident = &self.model.item.ident;
        let quantities = &self.program.formulas.quantities;
        let (dimension, count) =
            (Literal::usize_unsuffixed(self.dimension()), Literal::usize_unsuffixed(quantities.len()));
        let names = quantities.iter().map(|quantity| quantity.name.as_str());
        // a composed step asks which columns are those of its size and of its time
        let column = |constant: &str, name: &str| {
            let (constant, column) =
                (format_ident!("{constant}"), quantities.iter().position(|quantity| quantity.name == name)?);
            let column = Literal::usize_unsuffixed(column);
            Some(quote!(const #constant: #private::Option<::core::primitive::usize> = #private::Some(#column);))
        };
        let columns = self.program.formulas.stages().map(|_| {
            let (size, time) = (column("STEP_SIZE", "h"), column("TIME", "t"));
            quote!(#size #time)
        });
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Sensitive<#dimension, #count> for #ident<#arguments> #predicates {
                const QUANTITIES: [&'static ::core::primitive::str; #count] = [#(#names),*];
                #columns
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

    /// The implementation of `VariedSubstep` for one edge.
    fn edge(&self, index: usize) -> TokenStream {
        let (number, dimension) = (Literal::usize_unsuffixed(index), Literal::usize_unsuffixed(self.dimension()));
        let (momenta, edge) = (self.momenta_of(index), self.edge_of(index));
        let (carried, slopes) = (self.carried_of(index), self.slopes_of(index));
        self.implementation("VariedSubstep", &[&number, &dimension], quote!(#momenta #edge #carried #slopes))
    }

    /// A method of `VariedSubstep`.
    fn at_edge(
        &self,
        title: &str,
        (name, output): (&str, TokenStream),
        kernel: Option<&Kernel>,
        body: TokenStream,
    ) -> TokenStream {
        let (scalar, constants, name) = (&self.paths.scalar, self.constants_of_step(), format_ident!("{name}"));
        let (configuration, element, input) = (self.configuration_type(), self.element_type(), self.input_type());
        let documentation = kernel.map(|kernel| docs::formulas(title, &[], Some(kernel)));
        quote! {
            #documentation
            #[inline]
            fn #name(
                &self,
                c: &#constants,
                t: #scalar,
                q: &#configuration,
                d: &#element,
                next: &#configuration,
                u: &#input,
            ) -> #output {
                #body
            }
        }
    }

    /// The type of what an edge gives.
    fn of_edge(&self, name: &str) -> TokenStream {
        let (krate, scalar, name) = (&self.paths.krate, &self.paths.scalar, format_ident!("{name}"));
        let dimension = Literal::usize_unsuffixed(self.dimension());
        quote!(#krate::#name<#scalar, #dimension>)
    }

    fn momenta_of(&self, index: usize) -> TokenStream {
        let (krate, kernel, scope) =
            (&self.paths.krate, self.program.kernel(Id::EdgeMomenta(index)), self.scope_of_step());
        let (locals, lagrangian) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
        let vector = |index: usize| code::grid(&scope, kernel.outputs[index].0, &kernel.outputs[index].1, false);
        let (before, after) = (vector(1), vector(2));
        let body = quote!(#locals #krate::Momenta { lagrangian: #lagrangian, before: #before, after: #after });
        let title = "ℓd with both Legendre transforms.";
        self.at_edge(title, ("momenta", self.of_edge("Momenta")), Some(kernel), body)
    }

    /// A matrix of an edge.
    fn matrix_of_edge(&self, kernel: &Kernel, index: usize) -> TokenStream {
        let scope = self.scope_of_step();
        if self.program.form.keeps_matrices() {
            return matrices::matrix_of(&scope, kernel, index, "x", along_motion).1;
        }
        let (shape, entries) = &kernel.outputs[index];
        code::matrix(&scope, *shape, entries)
    }

    /// The shared terms of an edge; what derivatives along motions are made of stands with them.
    fn locals_of_edge(&self, kernel: &Kernel) -> TokenStream {
        let scope = self.scope_of_step();
        if !self.program.form.keeps_matrices() {
            return code::locals(&scope, kernel);
        }
        let depends = kernel.depends_on(along_motion);
        code::locals_where(&scope, kernel, |k| !depends[k])
    }

    fn edge_of(&self, index: usize) -> TokenStream {
        let (krate, scope, kernel) = (&self.paths.krate, self.scope_of_step(), self.program.kernel(Id::Edge(index)));
        let (terms, lagrangian) = (self.locals_of_edge(kernel), scope.code(&kernel.outputs[0].1[0], false));
        let vector = |index: usize| code::grid(&scope, kernel.outputs[index].0, &kernel.outputs[index].1, false);
        let (before, after) = (vector(1), vector(2));
        let [by_start, by_end, after_by_end] = [3, 4, 5].map(|index| self.matrix_of_edge(kernel, index));
        let after_by_start = match kernel.outputs.len() {
            7 => self.matrix_of_edge(kernel, 6),
            _ => quote!(-before_by_end.transpose()),
        };
        let body = quote! {
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
        };
        let title = "ℓd with both Legendre transforms and their derivatives along the motions of both ends.";
        self.at_edge(title, ("edge", self.of_edge("Edge")), Some(kernel), body)
    }

    fn carried_of(&self, index: usize) -> TokenStream {
        let (krate, scope, kernel) = (&self.paths.krate, self.scope_of_step(), self.program.kernel(Id::Carried(index)));
        let locals = self.locals_of_edge(kernel);
        let momentum = code::grid(&scope, kernel.outputs[0].0, &kernel.outputs[0].1, false);
        let [adjoint, before, after, before_by_end, after_by_end] =
            [1, 2, 3, 4, 5].map(|index| self.matrix_of_edge(kernel, index));
        let body = quote! {
            #locals
            #krate::Carried {
                momentum: #momentum,
                adjoint: #adjoint,
                before: #before,
                after: #after,
                before_by_end: #before_by_end,
                after_by_end: #after_by_end,
            }
        };
        let title = "F⁺ℓd with the derivatives of both momenta, along motions that leave F as it is and along those of q⁺ alone.";
        self.at_edge(title, ("carried", self.of_edge("Carried")), Some(kernel), body)
    }

    fn slopes_of(&self, index: usize) -> TokenStream {
        let scope = self.scope_of_step();
        let Some(kernel) = self.program.find(Id::EdgeSlopes(index)) else {
            return self.at_edge("", ("slopes", quote!(())), None, quote!());
        };
        let matrix = |index: usize| code::matrix(&scope, kernel.outputs[index].0, &kernel.outputs[index].1);
        let (locals, before, after) = (code::locals(&scope, kernel), matrix(0), matrix(1));
        let (dimension, private) = (Literal::usize_unsuffixed(self.dimension()), &self.paths.private);
        let output = quote!(<Self as #private::Varied<#dimension>>::Slopes);
        let title = "∂F⁻ℓd and ∂F⁺ℓd with respect to what is fixed during a step.";
        self.at_edge(title, ("slopes", output), Some(kernel), quote!(#locals (#before, #after)))
    }
}

/// Whether something is the direction of a motion.
fn along_motion(role: Role) -> bool {
    matches!(role, Role::Algebra(_))
}
