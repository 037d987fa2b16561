//! The types of the momentum equations: closed forms, and what Newton's method needs.

use clebsch_symbolic::Shape;
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{format_ident, quote};

use super::function::{Body, Function};
use super::functions::{EQUATION, SOLVER};
use super::scope::{Scope, size};
use super::{Emitter, docs};
use crate::derive::{Id, Solution, Structure};
use crate::lower::{Kernel, Solve, is_direction};

/// The type of an equation, while it is made.
pub(super) struct EquationType<'e, 'a, 'g> {
    pub(super) emitter: &'e Emitter<'a, 'g>,
    pub(super) solve: &'e Solve,
    /// In its methods `mu` holds its momenta, and `x` its unknowns, or the coordinates that are given.
    scope: Scope<'e, 'g>,
    /// The type of its unknowns.
    pub(super) vector: TokenStream,
    /// The type of its momenta.
    target: TokenStream,
}

impl<'g> Emitter<'_, 'g> {
    pub(super) fn equations(&self) -> TokenStream {
        let solves = self.program.steps.iter().flat_map(|step| &step.solves);
        // free rotations are solved by the runtime, in the same way for every body
        let solves = solves.filter(|solve| solve.solution != Solution::FreeRotation);
        solves.map(|solve| EquationType::new(self, solve).tokens()).collect()
    }

    /// The name of the type of an equation.
    pub(super) fn equation_name(&self, solve: &Solve) -> Ident {
        self.names.equation(self.program.suffix(solve.substep), solve.number)
    }

    /// What an equation holds, by the names that its methods call it, with the types.
    pub(super) fn held_by_equation(&self, solve: &Solve) -> Vec<(&'static str, TokenStream)> {
        let (lifetime, scalar) = (self.names.lifetime(), &self.paths.scalar);
        let reference = |name, ty: TokenStream| (name, quote!(&#lifetime #ty));
        let mut held = vec![reference("system", self.target.of_type()), reference("c", self.alias("C"))];
        held.extend((solve.moves && self.formulas.is_timed()).then(|| ("t", scalar.clone())));
        held.extend(solve.moves.then(|| reference("q", self.alias("Q"))));
        held.extend(solve.reads_input.then(|| reference("u", self.input_type())));
        held
    }
}

impl<'e, 'a, 'g> EquationType<'e, 'a, 'g> {
    fn new(emitter: &'e Emitter<'a, 'g>, solve: &'e Solve) -> EquationType<'e, 'a, 'g> {
        let mut scope = emitter.scope(quote!(system), Some(quote!(c)));
        scope.momenta = solve.momenta.clone();
        scope.coordinates = if solve.given.is_empty() { solve.components.clone() } else { solve.given.clone() };
        let [vector, target] = [solve.dimension, solve.momenta.len()].map(|rows| emitter.vector_type(rows));
        EquationType { emitter, solve, scope, vector, target }
    }

    /// The struct, with the equation as its documentation, and its implementation.
    fn tokens(&self) -> TokenStream {
        let EquationType { emitter, solve, .. } = self;
        let (private, scalar, lifetime) = (&emitter.paths.private, &emitter.paths.scalar, emitter.names.lifetime());
        let mut sizes = vec![size(solve.dimension)];
        // the number of momenta is that of unknowns unless it is said
        sizes.extend((solve.momenta.len() != solve.dimension).then(|| size(solve.momenta.len())));
        let of = match solve.solution {
            Solution::Newton => Some(quote!(#private::Equation<#scalar, #(#sizes),*>)),
            Solution::Linear => Some(quote!(#private::LinearEquation<#scalar, #(#sizes),*>)),
            _ => None,
        };
        let prepare = (solve.solution == Solution::Newton).then(|| self.prepare());
        let (functions, correct, solver) = (self.functions(EQUATION), self.correct(), self.functions(SOLVER));
        let target = emitter.target.borrowed(&emitter.equation_name(solve), &lifetime);
        let implementation = target.implementation(of, quote!(#prepare #functions #correct #solver));
        let (name, (parameters, _, predicates)) = (&target.ident, target.generics.split_for_impl());
        let formulas = emitter.rows.titled(solve.id(Id::Equation));
        let documentation = docs::formulas("The momentum equation in the chart.", formulas, None);
        let held = emitter.held_by_equation(solve).into_iter().map(|(_, ty)| ty);
        quote! {
            #documentation
            struct #name #parameters(#(#held,)*) #predicates;
            #implementation
        }
    }

    /// The body of a method, with names for what it reads of the equation.
    fn body(&self, code: TokenStream) -> TokenStream {
        let held = self.emitter.held_by_equation(self.solve);
        let read: Vec<bool> = held.iter().map(|(name, _)| mentions(&code, name)).collect();
        let Some(last) = read.iter().rposition(|&is_read| is_read) else { return code };
        let names = held.iter().zip(&read).take(last + 1);
        let names =
            names.map(|((name, _), is_read)| if *is_read { format_ident!("{name}") } else { format_ident!("_") });
        let rest = (last + 1 < held.len()).then(|| quote!(..));
        quote!(let &Self(#(#names,)* #rest) = self; #code)
    }

    fn functions(&self, table: &[Function]) -> TokenStream {
        let (vector, target, given) = (&self.vector, &self.target, self.emitter.vector_type(self.solve.given.len()));
        let given = if self.solve.given.is_empty() { quote!() } else { quote!(, x: &#given) };
        let prepared = if self.prepares() { quote!(terms: &Self::Terms) } else { quote!(mu: &#target) };
        let words = [
            ("Vector", vector.clone()),
            ("Momenta", target.clone()),
            ("Given", given),
            ("Prepared", prepared),
            ("Square", self.emitter.paths.matrix(self.solve.dimension, self.solve.dimension)),
        ];
        let place = (self.solve.substep, self.solve.number);
        self.emitter.functions(table, place, &words, |function, kernel| {
            let body = self.function(function, kernel)?;
            Some(Body { code: self.body(body.code), ..body })
        })
    }

    /// What one of them does, where the equation has it.
    fn function(&self, function: &Function, kernel: Option<&'e Kernel>) -> Option<Body<'e>> {
        let EquationType { emitter, solve, scope, .. } = self;
        let (private, keeps) = (&emitter.paths.private, emitter.keeps_matrices);
        let is_newton = solve.solution == Solution::Newton;
        // with whole matrices the terms hold the momenta
        let target = (is_newton && keeps && self.prepares()).then(|| quote!(let mu = &terms.0;));
        Some(match function.name {
            "closed_form" => {
                let sine = scope.body_of_scalar(emitter.program.find(solve.id(Id::SineSquared))?);
                let (solution, by_reference) = (scope.body(kernel?), keeps.then(|| quote!(let x = &x;)));
                let code = quote! {
                    let x = { #solution };
                    #private::below_right_angle(x, { #by_reference #sine })
                };
                Body::new(kernel?, code)
            }
            "explicit" => {
                let is_predicted = !emitter.rows.titled(solve.id(Id::Predictor)).is_empty();
                let title = match (is_predicted, solve.given.is_empty()) {
                    (true, _) => Some("The solution, h Σ⁻¹μ in the units of the chart."),
                    (false, true) => None,
                    (false, false) => Some("The solution where the coordinates of equations before this one are x."),
                };
                Body { title, ..function.computes(scope, kernel?) }
            }
            "predict" if is_newton => Body { cost: None, ..function.computes(scope, kernel?) },
            "residual" => function.computes(scope, kernel?).after(target),
            // a Jacobian has a factor in any case, but not every equation is solved by it
            "linearize"
                if function.shows(Id::JacobianFactor(0, 0)) != matches!(solve.structure, Structure::Sylvester(_)) =>
            {
                return None;
            }
            "system" | "linearize" => {
                let (locals, residual, jacobian) = self.linearized(kernel?);
                let both = if is_newton { quote!((#residual, #jacobian)) } else { quote!((#jacobian, #residual)) };
                Body::new(kernel?, quote!(#target #locals #both))
            }
            "orientation" if emitter.has_orientation(solve) => {
                let orientation = emitter.constant_of(solve);
                Body::from(quote!(#private::Some(self.1.#orientation)))
            }
            "has_poles" if is_newton && solve.has_poles => Body::from(quote!(true)),
            "tolerance" | "limit" if is_newton => Body::from(emitter.dial_of_solver(function.name)?),
            _ => return None,
        })
    }

    /// Whether something is computed once per solve.
    fn prepares(&self) -> bool {
        let prepare = self.emitter.program.kernel(self.solve.id(Id::Preparation));
        self.emitter.keeps_matrices || !prepare.outputs.is_empty()
    }

    /// The terms, the vector and the matrix that a kernel gives.
    fn linearized(&self, kernel: &Kernel) -> (TokenStream, TokenStream, TokenStream) {
        let (scope, private) = (&self.scope, &self.emitter.paths.private);
        let (locals, value) = (|| scope.locals(kernel), scope.output(kernel, 0));
        if let Structure::Sylvester(_) = self.solve.structure {
            let factor = scope.output(kernel, 1);
            return (locals(), value, quote!(#private::Sylvester::new(#factor)));
        }
        if self.emitter.keeps_matrices {
            let (locals, jacobian) = scope.matrix_of(kernel, 1, "delta", is_direction);
            return (locals, value, jacobian);
        }
        let square = (Shape::square(self.solve.dimension), kernel.outputs[1].1.clone());
        (locals(), value, scope.grid(&square, false))
    }

    /// What Newton's method computes once, and its types.
    fn prepare(&self) -> TokenStream {
        let EquationType { emitter, solve, scope, target, .. } = self;
        let (private, scalar) = (&emitter.paths.private, &emitter.paths.scalar);
        let jacobian = match solve.structure {
            Structure::Sylvester(n) => {
                let n = size(n);
                quote!(#private::Sylvester<#scalar, #n>)
            }
            _ => emitter.paths.matrix(solve.dimension, solve.dimension),
        };
        let kernel = emitter.program.kernel(solve.id(Id::Preparation));
        let locals = scope.locals(kernel);
        let values = (0..kernel.outputs.len()).map(|index| scope.scalar(kernel, index));
        let (terms, prepared) = if !self.prepares() {
            (target.clone(), quote!(*mu))
        } else if emitter.keeps_matrices {
            let types = kernel.outputs.iter().map(|(shape, _)| {
                if shape.is_scalar() { scalar.clone() } else { emitter.paths.matrix(shape.rows, shape.columns) }
            });
            (quote!((#target, #(#types,)*)), quote!((*mu, #(#values,)*)))
        } else {
            let count = size(kernel.outputs.len());
            (quote!([#scalar; #count]), quote!([#(#values),*]))
        };
        let prepared = self.body(quote!(#locals #prepared));
        quote! {
            type Terms = #terms;
            type Jacobian = #jacobian;

            #[inline]
            fn prepare(&self, mu: &#target) -> Self::Terms {
                #prepared
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
