//! The types of the momentum equations: closed forms, and what Newton's method needs.

use clebsch_symbolic::Shape;
use proc_macro2::{Ident, Literal, TokenStream, TokenTree};
use quote::{format_ident, quote};

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

    /// The struct of an equation: the system and the constants, and where it is; with the equation as its documentation.
    fn equation_structure(&self, name: &Ident, id: Id, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, (_, constants)) = (&self.model.item.ident, self.constants_generics());
        let Names { lifetime, constants: constants_name, .. } = &self.names;
        let formulas = self.program.formulas.titled(id);
        let documentation = docs::formulas("The momentum equation in the chart.", formulas, None);
        let (scalar, configuration, input) = (&self.paths.scalar, self.configuration_type(), self.input_type());
        let time = (solve.moves && self.is_timed()).then(|| quote!(#scalar,));
        let configuration = solve.moves.then(|| quote!(&#lifetime #configuration,));
        let input = solve.reads_input.then(|| quote!(&#lifetime #input,));
        quote! {
            #documentation
            struct #name<#lifetime, #parameters>(
                &#lifetime #ident<#arguments>,
                &#lifetime #constants_name #constants,
                #time #configuration #input
            ) #predicates;
        }
    }

    /// What an equation holds, by the names that its methods call it.
    pub(super) fn held_by_equation(&self, solve: &Solve) -> Vec<&'static str> {
        let mut held = vec!["system", "c"];
        held.extend((solve.moves && self.is_timed()).then_some("t"));
        held.extend(solve.moves.then_some("q"));
        held.extend(solve.reads_input.then_some("u"));
        held
    }

    /// What of it some code reads, as names of its own.
    fn read_by(&self, solve: &Solve, code: &TokenStream) -> Option<TokenStream> {
        let held = self.held_by_equation(solve);
        let read: Vec<bool> = held.iter().map(|name| mentions(code, name)).collect();
        let last = read.iter().rposition(|&is_read| is_read)?;
        let names = held.iter().zip(&read).take(last + 1).map(|(name, is_read)| {
            let name = if *is_read { format_ident!("{name}") } else { format_ident!("_") };
            quote!(#name)
        });
        let names: Vec<TokenStream> = names.collect();
        let rest = (last + 1 < held.len()).then(|| quote!(..));
        Some(quote!(let &Self(#(#names,)* #rest) = self;))
    }

    /// The body of a method of an equation.
    fn body_of_equation(&self, solve: &Solve, code: TokenStream) -> TokenStream {
        let read = self.read_by(solve, &code);
        quote!(#read #code)
    }

    /// The type of an equation that is solved by a formula.
    fn solved_equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let private = &self.paths.private;
        let lifetime = &self.names.lifetime;
        let name = self.names.equation(self.program.suffix(index), number);
        let scope = self.scope_of_solve(solve);
        let (vector, target) = (self.vector_type(solve.dimension), self.vector_type(solve.momenta.len()));
        let structure = self.equation_structure(&name, Id::Equation(index, number), solve);
        let (solution, predictor) = (Id::Solution(index, number), Id::Predictor(index, number));
        let solved = self.program.formulas.table().titled_all(|id| id == solution || id == predictor);
        let is_closed = solve.solution == Solution::ClosedForm;
        let kernel = self.program.find(solve.id(if is_closed { Id::ClosedForm } else { Id::Explicit }));
        let body = kernel.map(|kernel| code::body(&scope, kernel, None));
        let method = match self.program.find(solve.id(Id::SineSquared)) {
            Some(sine) => {
                let by_reference = self.program.form.keeps_matrices().then(|| quote!(let x = &x;));
                let (locals, sine) = (code::locals(&scope, sine), scope.code(&sine.outputs[0].1[0], false));
                let documentation = docs::formulas(
                    "The solution: the rotation by θ in one plane with sin θ = |a|, |a|² < 1.",
                    solved,
                    kernel,
                );
                let body = self.body_of_equation(
                    solve,
                    quote! {
                        let x = { #body };
                        #private::below_right_angle(x, { #by_reference #locals #sine })
                    },
                );
                quote! {
                    #documentation
                    #[inline]
                    fn closed_form(&self, mu: &#target) -> #private::Solved<#vector> {
                        #body
                    }
                }
            }
            None => {
                let is_predicted = solved.iter().any(|row| row.id == predictor);
                let title = match (is_predicted, solve.given.is_empty()) {
                    (true, _) => "The solution, h Σ⁻¹μ in the units of the chart.",
                    (false, true) => "The solution, coordinate after coordinate.",
                    (false, false) => "The solution where the coordinates of equations before this one are x.",
                };
                let documentation = docs::formulas(title, solved, kernel);
                let given = (!solve.given.is_empty()).then(|| {
                    let given = self.vector_type(solve.given.len());
                    quote!(, x: &#given)
                });
                let body = self.body_of_equation(solve, quote!(#body));
                quote! {
                    #documentation
                    #[inline]
                    fn explicit(&self, mu: &#target #given) -> #vector {
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

    /// The scope of an equation's methods: `mu` holds its momenta, and `x` its unknowns, or those that are given.
    fn scope_of_solve(&self, solve: &Solve) -> code::Scope<'_, 'g> {
        let mut scope = self.scope_of_equation();
        scope.momenta = solve.momenta.clone();
        scope.coordinates = if solve.given.is_empty() { solve.components.clone() } else { solve.given.clone() };
        scope
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
        let kernel = self.program.linearization(solve);
        let [vector, matrix] = [0, 1].map(|k| &kernel.outputs[k]);
        let value = code::grid(scope, vector.0, &vector.1, false);
        if let Structure::Sylvester(_) = solve.structure {
            let (private, factor) = (&self.paths.private, code::grid(scope, matrix.0, &matrix.1, false));
            return (code::locals(scope, kernel), value, quote!(#private::Sylvester::new(#factor)));
        }
        if self.program.form.keeps_matrices() {
            let (locals, jacobian) = matrices::matrix_of(scope, kernel, 1, "delta", is_direction);
            return (locals, value, jacobian);
        }
        let square = Shape::square(solve.dimension);
        (code::locals(scope, kernel), value, code::grid(scope, square, &matrix.1, false))
    }

    fn linear_equation(&self, index: usize, number: usize, solve: &Solve) -> TokenStream {
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, lifetime) = (&self.paths.private, &self.names.lifetime);
        let name = self.names.equation(self.program.suffix(index), number);
        let scope = self.scope_of_solve(solve);
        let (vector, target) = (self.vector_type(solve.dimension), self.vector_type(solve.momenta.len()));
        let matrix = self.paths.matrix(solve.dimension, solve.dimension);
        let structure = self.equation_structure(&name, Id::Equation(index, number), solve);
        let jacobian = self.program.formulas.titled(Id::Jacobian(index, number));
        let documentation = docs::formulas("Dρ and −ρ(0).", jacobian, Some(self.program.linearization(solve)));
        let (locals, right, left) = self.linearized(&scope, solve);
        let body = self.body_of_equation(solve, quote!(#locals (#left, #right)));
        let (dimensions, correct, orientation) =
            (self.dimensions(solve), self.correct(solve), self.orientation(index, number, solve));
        quote! {
            #structure

            impl<#lifetime, #parameters> #private::LinearEquation<#dimensions> for #name<#lifetime, #arguments> #predicates {
                #documentation
                #[inline]
                fn system(&self, mu: &#target) -> (#matrix, #vector) {
                    #body
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
        let (vector, target) = (self.vector_type(solve.dimension), self.vector_type(solve.momenta.len()));
        let jacobian_type = self.jacobian_type(solve);
        let keeps = self.program.form.keeps_matrices();
        let prepare = self.program.kernel(solve.id(Id::Preparation));
        let terms = Literal::usize_unsuffixed(prepare.outputs.len());
        let prepares = keeps || !prepare.outputs.is_empty();
        let (terms, target_again) = match keeps {
            _ if !prepares => (target.clone(), quote!()),
            true => {
                let types = prepare.outputs.iter().map(|(shape, _)| match shape.is_scalar() {
                    true => quote!(#scalar),
                    false => self.paths.matrix(shape.rows, shape.columns),
                });
                (quote!((#target, #(#types,)*)), quote!(let mu = &terms.0;))
            }
            false => (quote!([#scalar; #terms]), quote!()),
        };
        let prepared = prepare.outputs.iter().map(|(_, entries)| scope.code(&entries[0], false));
        let prepare_locals = code::locals(&scope, prepare);
        let prepared = if !prepares {
            quote!(*mu)
        } else if keeps {
            quote!((*mu, #(#prepared,)*))
        } else {
            quote!([#(#prepared),*])
        };
        let given = if prepares { quote!(terms: &Self::Terms) } else { quote!(mu: &#target) };
        let predict = self.program.find(solve.id(Id::Predictor)).map(|kernel| {
            let body = self.body_of_equation(solve, code::body(&scope, kernel, None));
            let predictor = self.program.formulas.titled(Id::Predictor(index, number));
            let documentation = docs::formulas("The solution to first order in h.", predictor, None);
            quote! {
                #documentation
                #[inline]
                fn predict(&self, mu: &#target) -> #vector {
                    #body
                }
            }
        });
        let prepared = self.body_of_equation(solve, quote!(#prepare_locals #prepared));
        let (locals, residual, jacobian) = self.linearized(&scope, solve);
        let linearization = self.body_of_equation(solve, quote!(#target_again #locals (#residual, #jacobian)));
        let equation = Id::Equation(index, number);
        let is_shown = |id: Id| match id {
            Id::JacobianFactor(..) => {
                id == Id::JacobianFactor(index, number) && matches!(solve.structure, Structure::Sylvester(_))
            }
            _ => id == equation || id == Id::Jacobian(index, number),
        };
        let formulas = self.program.formulas.table().titled_all(is_shown);
        let structure = self.equation_structure(&name, equation, solve);
        let linearized =
            docs::formulas("The residual and its Jacobian.", formulas, Some(self.program.linearization(solve)));
        let alone = self.program.find(solve.id(Id::Residual)).map(|kernel| {
            let documentation = docs::formulas("The residual alone.", &formulas[..1], Some(kernel));
            let body = code::body(&scope, kernel, None);
            let body = self.body_of_equation(solve, quote!(#target_again #body));
            quote! {
                #documentation
                #[inline]
                fn residual(&self, #given, x: &#vector) -> #vector {
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
                fn limit() -> #private::Option<u32> {
                    #private::Some(#most)
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
                fn prepare(&self, mu: &#target) -> Self::Terms {
                    #prepared
                }

                #predict

                #alone

                #linearized
                #[inline]
                fn linearize(&self, #given, x: &#vector) -> (#vector, Self::Jacobian) {
                    #linearization
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

/// Whether a name stands among some tokens, not as a field or a method.
fn mentions(tokens: &TokenStream, name: &str) -> bool {
    let mut is_member = false;
    tokens.clone().into_iter().any(|token| {
        let was_member =
            std::mem::replace(&mut is_member, matches!(&token, TokenTree::Punct(dot) if dot.as_char() == '.'));
        match token {
            TokenTree::Ident(ident) => !was_member && ident == name,
            TokenTree::Group(group) => mentions(&group.stream(), name),
            TokenTree::Punct(_) | TokenTree::Literal(_) => false,
        }
    })
}
