//! The types of the momentum equations: closed forms, and what Newton's method needs.

use clebsch_symbolic::Shape;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::names::Names;
use super::{Emitter, Generics, code, docs, matrices};
use crate::derive::{Id, Solution, Structure};
use crate::lower::{Solve, is_direction};

impl<'g> Emitter<'_, 'g> {
    /// The types of the equations.
    pub(super) fn equations(&self) -> TokenStream {
        let mut types = TokenStream::new();
        for (index, step) in self.program.steps.iter().enumerate() {
            for (number, solve) in step.solves.iter().enumerate() {
                types.extend(match solve.solution {
                    Solution::Newton => self.equation(index, number, solve),
                    // the runtime's, the same for every body
                    Solution::FreeRotation => TokenStream::new(),
                    Solution::Linear => self.linear_equation(index, number, solve),
                    Solution::ClosedForm | Solution::Explicit => self.solved_equation(index, number, solve),
                });
            }
        }
        types
    }

    /// The struct of an equation: the system and the constants, with the equation as its documentation.
    fn equation_structure(&self, name: &Ident, id: Id, place: Option<&Solve>) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, (_, constants)) = (&self.model.item.ident, self.constants_generics());
        let Names { lifetime, constants: constants_name, .. } = &self.names;
        let formulas = self.program.formulas.titled(id);
        let documentation = docs::formulas("The momentum equation in the chart.", formulas, None);
        let (time, configuration, input) = (self.time_parameter(), self.configuration_type(), self.input_type());
        let place = place.filter(|solve| solve.moves).map(|solve| {
            let input = solve.reads_input.then(|| quote!(u: &#lifetime #input,));
            quote!(#time q: &#lifetime #configuration, #input)
        });
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
    fn solved_equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, krate) = (&self.paths.private, &self.paths.krate);
        let lifetime = &self.names.lifetime;
        let name = self.names.equation(self.program.suffix(index), number);
        let scope = self.scope_of_solve(solve);
        let (vector, target) = (self.paths.matrix(solve.dimension, 1), self.paths.matrix(solve.momenta.len(), 1));
        let structure = self.equation_structure(&name, Id::Equation(index, number), None);
        let solved = self.program.formulas.titled(Id::Solution(index, number));
        let body = solve.predict.as_ref().map(|kernel| code::body(&scope, kernel, None));
        let method = match &solve.sine_squared {
            Some(kernel) => {
                let by_reference = self.program.form.keeps_matrices().then(|| quote!(let x = &x;));
                let (locals, sine) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
                let documentation = docs::formulas(
                    "The solution: the rotation by θ in one plane with sin θ = |a|, |a|² < 1.",
                    solved,
                    solve.predict.as_ref(),
                );
                quote! {
                    #documentation
                    #[inline]
                    fn closed_form(&self, target: &#target) -> ::core::result::Result<#vector, #krate::Error> {
                        let x = { #body };
                        #private::below_right_angle(x, { #by_reference #locals #sine })
                    }
                }
            }
            None => {
                let title = match (solved.is_empty(), solve.given.is_empty()) {
                    (true, _) => "The solution, h Σ⁻¹μ in the units of the chart.",
                    (false, true) => "The solution, coordinate after coordinate.",
                    (false, false) => "The solution where the coordinates of equations before this one are x.",
                };
                let documentation = docs::formulas(title, solved, solve.predict.as_ref());
                let given = (!solve.given.is_empty()).then(|| {
                    let given = self.paths.matrix(solve.given.len(), 1);
                    quote!(, x: &#given)
                });
                quote! {
                    #documentation
                    #[inline]
                    fn explicit(&self, target: &#target #given) -> #vector {
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

    /// The scope of an equation's methods: `target` holds its momenta, and `x` its unknowns, or those that are given.
    fn scope_of_solve(&self, solve: &Solve) -> code::Scope<'_, 'g> {
        let mut scope = self.scope_of_equation();
        scope.momentum = "target";
        scope.momenta = solve.momenta.clone();
        scope.coordinates = if solve.given.is_empty() { solve.components.clone() } else { solve.given.clone() };
        scope
    }

    /// The time and the configuration of an equation that depends on them, as names of their own.
    fn place(&self, solve: &Solve) -> Option<TokenStream> {
        solve.moves.then(|| {
            let time = self.is_timed().then(|| quote!(let t = self.t;));
            let input = solve.reads_input.then(|| quote!(let u = self.u;));
            quote!(#time let q = self.q; #input)
        })
    }

    /// The parameters of the traits: the scalar, the number of unknowns, and that of momenta where it is another.
    fn dimensions(&self, solve: &Solve) -> TokenStream {
        let (scalar, unknowns) = (&self.paths.scalar, Literal::usize_unsuffixed(solve.dimension));
        let momenta = Literal::usize_unsuffixed(solve.momenta.len());
        match solve.momenta.len() == solve.dimension {
            true => quote!(#scalar, #unknowns),
            false => quote!(#scalar, #unknowns, #momenta),
        }
    }

    /// The type of the Jacobian.
    fn jacobian_type(&self, solve: &Solve) -> TokenStream {
        let (private, scalar) = (&self.paths.private, &self.paths.scalar);
        match solve.structure {
            Structure::Sylvester(n) => {
                let n = Literal::usize_unsuffixed(n);
                quote!(#private::Sylvester<#scalar, #n>)
            }
            _ => self.paths.matrix(solve.dimension, solve.dimension),
        }
    }

    /// The terms, the vector and the matrix that a kernel gives.
    fn linearized(&self, scope: &code::Scope<'_, '_>, solve: &Solve) -> (TokenStream, TokenStream, TokenStream) {
        let [vector, matrix] = [0, 1].map(|k| &solve.linearize.outputs[k]);
        let value = code::grid(scope, vector.0, &vector.1, false);
        if let Structure::Sylvester(_) = solve.structure {
            let (private, factor) = (&self.paths.private, code::grid(scope, matrix.0, &matrix.1, false));
            return (code::locals(scope, &solve.linearize), value, quote!(#private::Sylvester::new(#factor)));
        }
        if self.program.form.keeps_matrices() {
            let (locals, jacobian) = matrices::matrix_of(scope, &solve.linearize, 1, "delta", is_direction);
            return (locals, value, jacobian);
        }
        let square = Shape::square(solve.dimension);
        (code::locals(scope, &solve.linearize), value, code::grid(scope, square, &matrix.1, false))
    }

    fn linear_equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, lifetime) = (&self.paths.private, &self.names.lifetime);
        let name = self.names.equation(self.program.suffix(index), number);
        let scope = self.scope_of_solve(solve);
        let (vector, target) = (self.paths.matrix(solve.dimension, 1), self.paths.matrix(solve.momenta.len(), 1));
        let matrix = self.paths.matrix(solve.dimension, solve.dimension);
        let structure = self.equation_structure(&name, Id::Equation(index, number), Some(solve));
        let jacobian = self.program.formulas.titled(Id::Jacobian(index, number));
        let documentation = docs::formulas("Dρ and −ρ(0).", jacobian, Some(&solve.linearize));
        let (place, (locals, right, left)) = (self.place(solve), self.linearized(&scope, solve));
        let (dimensions, correct, orientation) =
            (self.dimensions(solve), self.correct(solve), self.orientation(index, number, solve));
        quote! {
            #structure

            impl<#lifetime, #parameters> #private::LinearEquation<#dimensions> for #name<#lifetime, #arguments> #predicates {
                #documentation
                #[inline]
                fn system(&self, target: &#target) -> (#matrix, #vector) {
                    #place
                    #locals
                    (#left, #right)
                }

                #correct
                #orientation
            }
        }
    }

    fn equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, scalar, lifetime) = (&self.paths.private, &self.paths.scalar, &self.names.lifetime);
        let name = self.names.equation(self.program.suffix(index), number);
        let scope = self.scope_of_solve(solve);
        let (vector, target) = (self.paths.matrix(solve.dimension, 1), self.paths.matrix(solve.momenta.len(), 1));
        let jacobian_type = self.jacobian_type(solve);
        let keeps = self.program.form.keeps_matrices();
        let terms = Literal::usize_unsuffixed(solve.prepare.outputs.len());
        let (terms, target_again) = match keeps {
            true => {
                let types = solve.prepare.outputs.iter().map(|(shape, _)| match shape.is_scalar() {
                    true => quote!(#scalar),
                    false => self.paths.matrix(shape.rows, shape.columns),
                });
                (quote!((#target, #(#types,)*)), quote!(let target = &terms.0;))
            }
            false => (quote!([#scalar; #terms]), quote!()),
        };
        let prepared = solve.prepare.outputs.iter().map(|(_, entries)| scope.code(&entries[0], false));
        let prepare_locals = code::locals(&scope, &solve.prepare);
        let prepared = if keeps { quote!((*target, #(#prepared,)*)) } else { quote!([#(#prepared),*]) };
        let predict = solve.predict.as_ref().map(|kernel| {
            let body = code::body(&scope, kernel, None);
            quote! {
                /// The solution to first order in h.
                #[inline]
                fn predict(&self, target: &#target) -> #vector {
                    #body
                }
            }
        });
        let (place, (locals, residual, jacobian)) = (self.place(solve), self.linearized(&scope, solve));
        let equation = Id::Equation(index, number);
        let is_shown = |id: Id| match id {
            Id::JacobianFactor(..) => {
                id == Id::JacobianFactor(index, number) && matches!(solve.structure, Structure::Sylvester(_))
            }
            _ => id == equation || id == Id::Jacobian(index, number),
        };
        let formulas = self.program.formulas.titled_all(is_shown);
        let structure = self.equation_structure(&name, equation, Some(solve));
        let linearized = docs::formulas("The residual and its Jacobian.", formulas, Some(&solve.linearize));
        let alone = solve.residual.as_ref().map(|kernel| {
            let documentation = docs::formulas("The residual alone.", &formulas[..1], Some(kernel));
            let body = code::body(&scope, kernel, None);
            quote! {
                #documentation
                #[inline]
                fn residual(&self, terms: &Self::Terms, x: &#vector) -> #vector {
                    #target_again
                    #body
                }
            }
        });
        let tolerance = self.model.dials.tolerance.as_ref().map(|tolerance| {
            let part = Literal::f64_unsuffixed(tolerance.value);
            quote! {
                /// The declared tolerance.
                #[inline]
                fn tolerance() -> #scalar {
                    #private::tolerance(#part)
                }
            }
        });
        let poles = solve.has_poles.then(|| {
            quote! {
                #[inline]
                fn has_poles() -> ::core::primitive::bool {
                    true
                }
            }
        });
        let limit = self.model.dials.iterations.as_ref().map(|iterations| {
            let most = Literal::u32_unsuffixed(iterations.value);
            quote! {
                /// The declared number of iterations.
                #[inline]
                fn limit() -> ::core::option::Option<u32> {
                    ::core::option::Option::Some(#most)
                }
            }
        });
        let (dimensions, correct, orientation) =
            (self.dimensions(solve), self.correct(solve), self.orientation(index, number, solve));
        quote! {
            #structure

            impl<#lifetime, #parameters> #private::Equation<#dimensions> for #name<#lifetime, #arguments> #predicates {
                type Terms = #terms;
                type Jacobian = #jacobian_type;

                #[inline]
                fn prepare(&self, target: &#target) -> Self::Terms {
                    #place
                    #prepare_locals
                    #prepared
                }

                #predict

                #alone

                #linearized
                #[inline]
                fn linearize(&self, terms: &Self::Terms, x: &#vector) -> (#vector, Self::Jacobian) {
                    #target_again
                    #place
                    #locals
                    (#residual, #jacobian)
                }

                #correct
                #orientation
                #poles
                #tolerance
                #limit
            }
        }
    }
}
