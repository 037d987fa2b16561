//! The implementations of `Variational` and `Sensitive`: motions, edges, and their derivatives.

use clebsch_symbolic::{Role, both};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::block::matrix;
use super::function::{Body, Function, no_words, number};
use super::functions::{CONSTRAINED_EDGE, EDGE, VARIATIONAL};
use super::scope::{nested, size};
use super::system::matrix_of_kernel;
use super::{Emitter, SystemEmitter, flag};
use crate::derive::Id;
use crate::lower::Kernel;

impl Emitter<'_, '_> {
    /// The implementations of `Variational` and of `VariedSubstep` for each edge, where they are asked for.
    pub(super) fn variational(&self) -> TokenStream {
        if !self.model.has_variations() {
            return TokenStream::new();
        }
        let dimension = size(self.dimension);
        let motions =
            self.functions(VARIATIONAL, (0, 0), &no_words, |function, kernel| self.motion_of(function, kernel));
        let is_constrained = self.has_constrained_edges().then(|| flag("IS_CONSTRAINED", true));
        let variational =
            self.target.derived(Some(quote!(runtime::Variational<#dimension>)), quote!(#is_constrained #motions));
        let slopes = matrix(self.dimension, self.formulas.quantities.len());
        let slopes = if self.is_sensitive() { quote!((#slopes, #slopes)) } else { quote!(()) };
        let varied =
            self.target.implementation(Some(quote!(runtime::Varied<#dimension>)), quote!(type Slopes = #slopes;));
        let edges = self.edges();
        quote!(#variational #varied #edges)
    }

    /// The implementations of `VariedSubstep` for each edge of a step, where derivatives are asked for.
    pub(super) fn edges(&self) -> TokenStream {
        let edges = if self.model.has_variations() { self.formulas.stepped } else { 0 };
        let dimension = size(self.dimension);
        let edges = (0..edges).map(|index| {
            let slopes = match self.program.find(Id::EdgeSlopes(index)) {
                Some(_) => quote!(<Self as runtime::Varied<#dimension>>::Slopes),
                None => quote!(()),
            };
            let words = |word: &str| (word == "Slopes").then(|| slopes.clone());
            let functions =
                self.functions(EDGE, (index, 0), &words, |function, kernel| self.edge(index, function, kernel));
            let edge = self.implementation("VariedSubstep", &[size(index), dimension.clone()], functions);
            let constraint = self.constrained_edge(index);
            quote!(#edge #constraint)
        });
        edges.collect()
    }

    /// Whether edges of steps have the forces of a constraint.
    pub(super) fn has_constrained_edges(&self) -> bool {
        self.model.has_variations() && self.formulas.constraint.is_some()
    }

    /// The sizes of an edge with a constraint: its number, those of motions and equations, and that of quantities.
    fn sizes_of_constrained_edge(&self, index: usize) -> Option<[Literal; 4]> {
        let constraint = self.formulas.constraint.as_ref().filter(|_| self.model.has_variations())?;
        let equations = constraint.rows.shape().rows;
        Some([index, self.dimension, equations, self.formulas.quantities.len()].map(size))
    }

    /// The implementation of `ConstrainedSubstep` for an edge, where there is a constraint.
    fn constrained_edge(&self, index: usize) -> TokenStream {
        let Some(sizes) = self.sizes_of_constrained_edge(index) else { return TokenStream::new() };
        let [_, motions, equations, quantities] = &sizes;
        let words = |word: &str| {
            Some(match word {
                "Multipliers" => quote!(runtime::SVector<T, #equations>),
                "AtStart" => quote!(runtime::ConstraintAtStart<T, #motions, #equations>),
                "AtEnd" => quote!(runtime::ConstraintAtEnd<T, #motions, #equations>),
                "Slopes" => {
                    quote!((runtime::SMatrix<T, #motions, #quantities>, runtime::SMatrix<T, #equations, #quantities>))
                }
                _ => return None,
            })
        };
        let scope = self.scope_of_step();
        let functions = self.functions(CONSTRAINED_EDGE, (index, 0), &words, |function, kernel| {
            function.written(&scope, kernel, &|word| matrix_of_kernel(&scope, kernel?, word))
        });
        self.implementation("ConstrainedSubstep", &sizes, functions)
    }

    /// Whether the declaration asks for derivatives with respect to the quantities that are fixed during a step.
    fn is_sensitive(&self) -> bool {
        (0..self.formulas.stepped).any(|index| self.program.find(Id::EdgeSlopes(index)).is_some())
    }

    /// Retraction, composition, advance, and the geometry of the orbit.
    fn motion_of<'k>(&'k self, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let scope = self.scope_of_system();
        let code = match function.name {
            "retractions" => {
                let (coordinates, locals) = (self.chart_coordinates(), scope.locals(kernel?));
                let middle = kernel?.outputs.len() / 2;
                let (ahead, back) = (scope.element(kernel?, 0), scope.element(kernel?, middle));
                quote!(#coordinates #locals [#ahead, #back])
            }
            // with compensated sums the kernel has the increment
            "advance" if self.formulas.is_compensated() => {
                let (locals, added) = (scope.locals(kernel?), scope.configuration(kernel?));
                let sum = self.combined(&quote!(q), quote!(+), &quote!(added));
                quote!(let added = { #locals #added }; #sum)
            }
            "advance"
                if self.program.find(Id::Displacement).is_none()
                    && self.formulas.scaled().is_empty()
                    && !self.formulas.turns_momenta() =>
            {
                let parts = self.trait_of_parts("Parts", &[]);
                quote!(#parts::advance(self, q, d))
            }
            "orbit_metric" if self.keeps_matrices => {
                let (terms, metric) = scope.matrix_of(kernel?, 0, "x", along_motion);
                quote!(#terms #metric)
            }
            "approach" => {
                let difference = self.combined(&quote!(target), quote!(-), &quote!(q));
                let code = quote!(runtime::Clebsch::momentum_map(self, q, &(#difference)));
                return Some(Body::from(code));
            }
            // a price of the velocity is one of states, and no path is priced by it
            "endpoint" if self.prices_velocity_at_end() => return None,
            "endpoint" => {
                return Some(Body::from(self.endpoint_expanded()?).inlined(quote!()));
            }
            _ => return Some(function.computes(&scope, kernel?)),
        };
        Some(Body::new(kernel?, code))
    }

    /// A sum or difference of two configurations, leaf by leaf. Quaternions over a type parameter add through their coordinates alone.
    fn combined(&self, a: &TokenStream, operator: TokenStream, b: &TokenStream) -> TokenStream {
        nested(&self.model.configuration, &mut |leaf| {
            let configuration = &self.model.configurations[leaf];
            let access = &configuration.accessor;
            if configuration.is_quaternion {
                return quote!(runtime::Quaternion { coords: #a #access.coords #operator #b #access.coords });
            }
            quote!(#a #access #operator #b #access)
        })
    }

    /// The implementation of `Sensitive`, where it is asked for.
    pub(super) fn sensitive(&self) -> TokenStream {
        if !self.is_sensitive() {
            return TokenStream::new();
        }
        let quantities = &self.formulas.quantities;
        let [dimension, count] = both([self.dimension, quantities.len()], size);
        let names = quantities.iter().map(|quantity| quantity.name.as_str());
        // a composed step asks which columns are those of its size and of its time
        let column = |constant: &str, name: &str| {
            let column = size(quantities.iter().position(|quantity| quantity.name == name)?);
            let constant = format_ident!("{constant}");
            Some(quote!(const #constant: runtime::Option<::core::primitive::usize> = runtime::Some(#column);))
        };
        let methods = self.program.methods.iter().map(|method| &method.program.formulas);
        let is_composed = methods.chain([self.formulas]).any(|formulas| formulas.stages().is_some());
        let columns = is_composed.then(|| {
            let (size, time) = (column("STEP_SIZE", "h"), column("TIME", "t"));
            quote!(#size #time)
        });
        self.target.derived(
            Some(quote!(runtime::Sensitive<#dimension, #count>)),
            quote! {
                const QUANTITIES: [&'static ::core::primitive::str; #count] = [#(#names),*];
                #columns
            },
        )
    }

    /// A function of `VariedSubstep`: vectors and matrices of an edge.
    fn edge<'k>(&'k self, index: usize, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let Some(kernel) = kernel else {
            // there is always something that is called the slopes
            return (function.name == "slopes").then(|| Body::from(quote!()).titled(""));
        };
        let words = |word: &str| match number(word, "Matrix") {
            Some(6) if kernel.outputs.len() < 7 => Some(quote!(-before_by_end.transpose())),
            Some(index) => Some(self.matrix_of_edge(kernel, index)),
            None if word == "Sizes" => {
                let (sizes, method) = (self.sizes_of_constrained_edge(index)?, self.own_method());
                Some(quote!(#method, #(#sizes),*))
            }
            None if word == "Varied" => {
                Some(self.trait_of_parts("VariedSubstep", &[size(index), size(self.dimension)]))
            }
            None => (word == "Locals").then(|| self.locals_of_edge(kernel)),
        };
        function.written(&self.scope_of_step(), Some(kernel), &words)
    }

    /// A matrix of an edge.
    fn matrix_of_edge(&self, kernel: &Kernel, index: usize) -> TokenStream {
        let scope = self.scope_of_step();
        if self.keeps_matrices {
            return scope.matrix_of(kernel, index, "x", along_motion).1;
        }
        scope.output(kernel, index)
    }

    /// The shared terms of an edge. In matrix code, terms along motions stand with their derivatives.
    fn locals_of_edge(&self, kernel: &Kernel) -> TokenStream {
        let depends = kernel.depends_on(along_motion);
        self.scope_of_step().locals_where(kernel, |k| !self.keeps_matrices || !depends[k])
    }
}

/// Whether something is the direction of a motion.
fn along_motion(role: Role) -> bool {
    matches!(role, Role::Algebra(_))
}

impl SystemEmitter<'_, '_> {
    /// The coordinates of exp η in the chart of small motions, to first order.
    pub(super) fn chart_coordinates(&self) -> TokenStream {
        let slopes = &self.slopes_of_retraction;
        if slopes.iter().all(|slope| *slope == (1, 1)) {
            return quote!(let x = eta;);
        }
        let scope = self.scope_of_system();
        let entries = slopes.iter().enumerate().map(|(i, &(numerator, denominator))| {
            let i = size(i);
            let slope = scope.number(&clebsch_symbolic::rational(numerator, denominator));
            if (numerator, denominator) == (1, 1) { quote!(eta[#i]) } else { quote!(#slope * eta[#i]) }
        });
        // operations on matrices take references
        let reference = self.keeps_matrices.then(|| quote!(&));
        quote!(let x = #reference runtime::vector([#(#entries),*]);)
    }
}
