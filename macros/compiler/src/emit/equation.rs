//! The types of the momentum equations: closed forms, and what Newton's method needs.

use clebsch_symbolic::Shape;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::names::Names;
use super::{Emitter, Generics, code, docs};
use crate::derive::{Equation, Formula, Solution};
use crate::lower::Solve;

impl Emitter<'_, '_> {
    /// The types of the equations.
    pub(super) fn equations(&self) -> TokenStream {
        let mut types = TokenStream::new();
        for (index, step) in self.program.steps.iter().enumerate() {
            for (number, solve) in step.solves.iter().enumerate() {
                types.extend(match solve.solution {
                    Solution::Newton => self.equation(index, number, solve),
                    Solution::ClosedForm | Solution::Explicit => self.solved(index, number, solve),
                });
            }
        }
        types
    }

    /// The struct of an equation: the system and the constants, with the equation as its documentation.
    fn equation_structure(&self, name: &Ident, derived: &Equation<'_>, moves: bool) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, (_, constants)) = (&self.model.item.ident, self.constants_generics());
        let Names { lifetime, constants: constants_name, .. } = &self.names;
        let formula = self.program.formulas.formula_of_equation(derived);
        let documentation = docs::formulas("The momentum equation in the chart.", &[formula], None);
        let (time, configuration) = (self.time_parameter(), self.configuration_type());
        let place = moves.then(|| quote!(#time q: &#lifetime #configuration,));
        quote! {
            #documentation
            struct #name<#lifetime, #parameters> #predicates {
                system: &#lifetime #ident<#arguments>,
                constants: &#lifetime #constants_name #constants,
                #place
            }
        }
    }

    /// The type of an equation that is solved by a formula.
    fn solved(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, krate) = (&self.paths.private, &self.paths.krate);
        let lifetime = &self.names.lifetime;
        let name = self.names.equation(self.program.suffix(index), number);
        let mut scope = self.scope_of_step();
        scope.components = solve.components.clone();
        scope.momentum = "target";
        let vector = self.paths.matrix(solve.dimension, 1);
        let derived = &self.program.formulas.substeps[index].equations[number];
        let structure = self.equation_structure(&name, derived, false);
        let body = solve.predict.as_ref().map(|kernel| code::body(&scope, kernel, None));
        let method = match &solve.sine_squared {
            Some(kernel) => {
                let (locals, sine) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
                let solved: Vec<Formula> = self.program.formulas.formula_of_solution(derived).into_iter().collect();
                let documentation = docs::formulas(
                    "The solution: the rotation by θ in one plane with sin θ = |a|, |a|² < 1.",
                    &solved,
                    solve.predict.as_ref(),
                );
                quote! {
                    #documentation
                    #[inline]
                    fn closed_form(&self, target: &#vector) -> ::core::result::Result<#vector, #krate::Error> {
                        #private::check_sine_squared({ #locals #sine })?;
                        ::core::result::Result::Ok({ #body })
                    }
                }
            }
            None => {
                let documentation =
                    docs::formulas("The solution, h Σ⁻¹μ in the units of the chart.", &[], solve.predict.as_ref());
                quote! {
                    #documentation
                    #[inline]
                    fn explicit(&self, target: &#vector) -> #vector {
                        #body
                    }
                }
            }
        };
        quote! {
            #structure

            impl<#lifetime, #parameters> #name<#lifetime, #arguments> #predicates {
                #method
            }
        }
    }

    fn equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        let lifetime = &self.names.lifetime;
        let suffix = self.program.suffix(index);
        let dimension = Literal::usize_unsuffixed(solve.dimension);
        let name = self.names.equation(suffix, number);
        let mut scope = self.scope_of_step();
        scope.components = solve.components.clone();
        scope.momentum = "target";
        let (vector, jacobian) =
            (self.paths.matrix(solve.dimension, 1), quote!(#private::SMatrix<#scalar, #dimension, #dimension>));
        let terms = Literal::usize_unsuffixed(solve.prepare.outputs.len());
        let prepared = solve.prepare.outputs.iter().map(|(_, entries)| scope.code(&entries[0], false));
        let prepare_locals = code::locals(&scope, &solve.prepare);
        let predict = solve.predict.as_ref().map(|kernel| {
            let body = code::body(&scope, kernel, None);
            quote! {
                /// The solution to first order in h.
                #[inline]
                fn predict(&self, target: &#vector) -> #vector {
                    #body
                }
            }
        });
        let place = solve.moves.then(|| {
            let time = self.is_timed().then(|| quote!(let t = self.t;));
            quote!(#time let q = self.q;)
        });
        let locals = code::locals(&scope, &solve.linearize);
        let square = Shape::square(solve.dimension);
        let residual = code::grid(&scope, solve.linearize.outputs[0].0, &solve.linearize.outputs[0].1, false);
        let rows = code::grid(&scope, square, &solve.linearize.outputs[1].1, false);
        let derived = &self.program.formulas.substeps[index].equations[number];
        let formulas =
            [self.program.formulas.formula_of_equation(derived), self.program.formulas.formula_of_jacobian(derived)];
        let structure = self.equation_structure(&name, derived, solve.moves);
        let linearized = docs::formulas("The residual and its Jacobian.", &formulas, Some(&solve.linearize));
        let orientation = self.has_orientation(solve).then(|| {
            let field = format_ident!("orientation{suffix}_{}", number + 1);
            quote! {
                #[inline]
                fn orientation(&self) -> ::core::option::Option<#private::Orientation> {
                    ::core::option::Option::Some(self.constants.#field)
                }
            }
        });
        quote! {
            #structure

            impl<#lifetime, #parameters> #private::Equation<#scalar, #dimension> for #name<#lifetime, #arguments> #predicates {
                type Terms = [#scalar; #terms];

                #[inline]
                fn prepare(&self, target: &#vector) -> Self::Terms {
                    #place
                    #prepare_locals
                    [#(#prepared),*]
                }

                #predict

                #linearized
                #[inline]
                fn linearize(&self, terms: &Self::Terms, x: &#vector) -> (#vector, #jacobian) {
                    #place
                    #locals
                    (#residual, #rows)
                }

                #orientation
            }
        }
    }
}
