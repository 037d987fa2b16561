//! The types of the momentum equations: closed forms, and the input of Newton's method.

use clebsch_symbolic::{Role, Shape, both};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::block::{Target, matrix};
use super::constants::{is_in_four_space, tensor};
use super::function::{self, Body, Function, Words};
use super::functions::{EQUATION, SOLVER};
use super::scope::{Scope, index, size};
use super::{Emitter, flag};
use crate::derive::{Id, RotatingBody, Solution, Structure};
use crate::lower::{Kernel, Solve};

/// The type of an equation, while it is made.
pub(super) struct EquationType<'e, 'a, 'g> {
    emitter: &'e Emitter<'a, 'g>,
    solve: &'e Solve,
    /// In its methods `mu` holds its momenta, and `x` its unknowns, or the coordinates that are given.
    scope: Scope<'e, 'g>,
    /// The type of its unknowns.
    vector: TokenStream,
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

    /// The fields of an equation, by the names that its methods call them, with the types.
    pub(super) fn held_by_equation(&self, solve: &Solve) -> Vec<(&'static str, TokenStream)> {
        let lifetime = self.names.lifetime();
        let reference = |name, ty: TokenStream| (name, quote!(&#lifetime #ty));
        let mut held = vec![reference("system", self.target.of_type()), reference("c", quote!(C))];
        held.extend((solve.moves && self.formulas.is_timed()).then(|| ("t", quote!(T))));
        held.extend(solve.moves.then(|| reference("q", quote!(Q))));
        held.extend(solve.reads_input.then(|| reference("u", self.input.clone())));
        held
    }
}

impl<'e, 'a, 'g> EquationType<'e, 'a, 'g> {
    fn new(emitter: &'e Emitter<'a, 'g>, solve: &'e Solve) -> EquationType<'e, 'a, 'g> {
        let mut scope = emitter.scope(quote!(system), Some(quote!(c)));
        scope.momenta = solve.momenta.clone();
        scope.coordinates = if solve.given.is_empty() { solve.components.clone() } else { solve.given.clone() };
        let [vector, target] = both([solve.dimension, solve.momenta.len()], |rows| emitter.vector_type(rows));
        EquationType { emitter, solve, scope, vector, target }
    }

    /// The struct, with the equation as its documentation, and its implementation.
    fn tokens(&self) -> TokenStream {
        let EquationType { emitter, solve, .. } = self;
        let mut sizes = vec![size(solve.dimension)];
        // the number of momenta is that of unknowns unless it is said
        sizes.extend((solve.momenta.len() != solve.dimension).then(|| size(solve.momenta.len())));
        let of = match solve.solution {
            Solution::Newton => Some(quote!(runtime::Equation<T, #(#sizes),*>)),
            Solution::Linear => Some(quote!(runtime::LinearEquation<T, #(#sizes),*>)),
            Solution::Rotation(RotatingBody::FourSpace) => Some(quote!(runtime::RotationEquation4<T>)),
            Solution::Rotation(_) => Some(quote!(runtime::RotationEquation<T>)),
            _ => None,
        };
        let types = if solve.solution == Solution::Newton { Some(self.types()) } else { self.types_of_rotation() };
        let (functions, solver) = (self.functions(EQUATION), self.functions(SOLVER));
        let target = emitter.borrowed(&emitter.equation_name(solve));
        let implementation = target.implementation(of, quote!(#types #functions #solver));
        let Target { ident, parameters, predicates, .. } = &target;
        let formulas = emitter.rows.titled(solve.id(Id::Equation));
        let documentation = function::documentation("The momentum equation in the chart.", formulas, None);
        let held = emitter.held_by_equation(solve).into_iter().map(|(_, ty)| ty);
        quote! {
            #documentation
            struct #ident #parameters(#(#held,)*) #predicates;
            #implementation
        }
    }

    fn functions(&self, table: &[Function]) -> TokenStream {
        let (vector, target, given) = (&self.vector, &self.target, self.emitter.vector_type(self.solve.given.len()));
        let given = if self.solve.given.is_empty() { quote!() } else { quote!(, x: &#given) };
        let prepared = if self.prepares() { quote!(terms: &Self::Terms) } else { quote!(mu: &#target) };
        let words = |word: &str| match word {
            "Vector" => Some(vector.clone()),
            "Momenta" => Some(target.clone()),
            "Given" => Some(given.clone()),
            "Prepared" => Some(prepared.clone()),
            "ByReference" if self.emitter.keeps_matrices => Some(quote!(let x = &x;)),
            "ByReference" => Some(quote!()),
            "SineSquared" => {
                let kernel = self.emitter.program.find(self.solve.id(Id::SineSquared));
                kernel.map(|kernel| self.scope.body_of_scalar(kernel))
            }
            "Body" if is_in_four_space(self.solve.solution) => Some(quote!(&runtime::RotatingBody4<T>)),
            "Body" => Some(quote!(&runtime::RotatingBody<T, Self::Tensor>)),
            "Square" => Some(matrix(self.solve.dimension, self.solve.dimension)),
            _ => None,
        };
        let place = (self.solve.substep, self.solve.number);
        self.emitter.functions(table, place, &words, |function, kernel| {
            let body = self.function(function, kernel, &words)?;
            let held = self.emitter.held_by_equation(self.solve).into_iter().map(|(name, _)| format_ident!("{name}"));
            let reads = match function.name {
                "prepare" => self.prepares(),
                name => !["orientation", "extent", "body"].contains(&name) && function.arguments.contains("self"),
            };
            Some(body.after(reads.then(|| quote!(let &Self(#(#held),*) = self;))))
        })
    }

    /// The body of one of them, if the equation has it.
    fn function(&self, function: &Function, kernel: Option<&'e Kernel>, words: &Words<'_>) -> Option<Body<'e>> {
        let EquationType { emitter, solve, scope, .. } = self;
        let is_newton = solve.solution == Solution::Newton;
        let is_rotation = matches!(solve.solution, Solution::Rotation(_));
        // in matrix code the terms contain the momenta
        let target = (is_newton && emitter.keeps_matrices).then(|| quote!(let mu = &terms.0;));
        Some(match function.name {
            "closed_form" if solve.has_multipliers => return None,
            "constrained_form" if !solve.has_multipliers => return None,
            "closed_form" | "constrained_form" => function.written(scope, kernel, words)?,
            "closed_form_or_nan" if emitter.drifts_alone().is_none() && !solve.has_multipliers => return None,
            "closed_form_or_nan" => Body { cost: None, ..function.written(scope, kernel, words)? },
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
                Body::from(quote!(runtime::Some(self.1.#orientation)))
            }
            "prepare" if is_newton => Body { cost: None, ..Body::new(kernel?, self.prepare(kernel?)) },
            "correct" if !is_newton && solve.solution != Solution::Linear => return None,
            "correct" => match &solve.structure {
                Structure::Symmetric if function.code.is_empty() => return None,
                Structure::Symmetric => function.written(scope, None, words)?,
                Structure::Triangular(blocks) if function.code.is_empty() => Body::from(self.by_blocks(blocks)),
                _ => return None,
            },
            "has_poles" if is_newton && solve.has_poles => function.written(scope, None, words)?,
            "extent" if is_newton => Body::from({
                let substep = &emitter.formulas.substeps[solve.substep];
                emitter.formulas.has_extent(substep, &substep.equations[solve.number]).then_some(())?;
                match emitter.held_by_equation(solve).iter().position(|(name, _)| *name == "q").map(syn::Index::from) {
                    Some(place) => quote!(runtime::extent(self.#place)),
                    None => quote!(runtime::extent(&())),
                }
            }),
            "body" if is_rotation => {
                let body = emitter.constant_of(solve);
                Body::from(quote!(&self.1.#body))
            }
            "tolerance" if is_newton => Body::from({
                let tolerance = emitter.tolerance()?;
                quote!(runtime::tolerance(#tolerance))
            }),
            "limit" if is_newton => Body::from({
                let most = emitter.iterations()?;
                quote!(runtime::Some(#most))
            }),
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
        let scope = &self.scope;
        let (locals, value) = (|| scope.locals(kernel), scope.output(kernel, 0));
        if let Structure::Sylvester(_) = self.solve.structure {
            let factor = scope.output(kernel, 1);
            return (locals(), value, quote!(runtime::Sylvester::new(#factor)));
        }
        if self.emitter.keeps_matrices {
            let is_direction = |role| matches!(role, Role::Direction(_));
            let (locals, jacobian) = scope.matrix_of(kernel, 1, "delta", is_direction);
            return (locals, value, jacobian);
        }
        let square = (Shape::square(self.solve.dimension), kernel.outputs[1].1.clone());
        (locals(), value, scope.grid(&square, false))
    }

    /// The types of the terms that Newton's method computes once, and of its Jacobian.
    fn types(&self) -> TokenStream {
        let EquationType { emitter, solve, target, .. } = self;
        let dimension = size(match solve.structure {
            Structure::Sylvester(n) => n,
            _ => solve.dimension,
        });
        let jacobian = match solve.structure {
            Structure::Sylvester(_) => quote!(runtime::Sylvester<T, #dimension>),
            _ => matrix(solve.dimension, solve.dimension),
        };
        let outputs = &emitter.program.kernel(solve.id(Id::Preparation)).outputs;
        let (count, types) = (
            size(outputs.len()),
            outputs.iter().map(
                |(shape, _)| {
                    if shape.is_scalar() { quote!(T) } else { matrix(shape.rows, shape.columns) }
                },
            ),
        );
        let terms = if !self.prepares() {
            target.clone()
        } else if emitter.keeps_matrices {
            quote!((#target, #(#types,)*))
        } else {
            quote!([T; #count])
        };
        quote!(type Terms = #terms; type Jacobian = #jacobian;)
    }

    /// The type of the inertia of a rotating body, and whether it turns back.
    fn types_of_rotation(&self) -> Option<TokenStream> {
        let Solution::Rotation(_) = self.solve.solution else { return None };
        let tensor = tensor(self.solve.solution).map(|tensor| quote!(type Tensor = #tensor;));
        let is_left = self.emitter.is_left(self.solve).then(|| flag("IS_LEFT", true));
        let is_cayley = matches!(self.solve.solution, Solution::Rotation(RotatingBody::Space { is_cayley: true, .. }));
        let is_cayley = is_cayley.then(|| flag("IS_CAYLEY", true));
        Some(quote!(#tensor #is_left #is_cayley))
    }

    /// The terms that Newton's method computes once.
    fn prepare(&self, kernel: &Kernel) -> TokenStream {
        let (scope, locals) = (&self.scope, self.scope.locals(kernel));
        let values = (0..kernel.outputs.len()).map(|index| scope.scalar(kernel, index));
        if !self.prepares() {
            quote!(#locals *mu)
        } else if self.emitter.keeps_matrices {
            quote!(#locals (*mu, #(#values,)*))
        } else {
            quote!(#locals [#(#values),*])
        }
    }

    /// One small system for each block, with the unknowns of those before it put in.
    fn by_blocks(&self, blocks: &[Vec<usize>]) -> TokenStream {
        let systems = blocks.iter().enumerate().map(|(number, block)| {
            let known = blocks[..number].concat();
            let rows = block.iter().map(|&i| {
                let entries = block.iter().map(|&j| index(false, (i, j)));
                quote!([#(a #entries),*])
            });
            let right = block.iter().map(|&i| {
                let known = known.iter().filter(|&&j| !self.emitter.program.is_zero(self.solve, i, j));
                let terms = known.map(|&j| {
                    let (a, x) = (index(false, (i, j)), format_ident!("x{j}"));
                    quote!(- a #a * #x)
                });
                let i = size(i);
                quote!(b[#i] #(#terms)*)
            });
            let (x, sign) = (format_ident!("solution{number}"), format_ident!("sign{number}"));
            let names = block.iter().map(|i| format_ident!("x{i}"));
            let positions = (0..block.len()).map(size);
            quote! {
                let (#x, #sign) = runtime::solve_dense(
                    &runtime::matrix([#(#rows),*]),
                    &runtime::vector([#(#right),*]),
                )?;
                let [#(#names),*] = [#(#x[#positions]),*];
            }
        });
        let names = (0..self.solve.dimension).map(|i| format_ident!("x{i}"));
        let signs = (1..blocks.len()).map(|number| format_ident!("sign{number}"));
        let sign = signs.fold(quote!(sign0), |product, sign| quote!(#product * #sign));
        quote! {
            #(#systems)*
            runtime::Some((runtime::vector([#(#names),*]), #sign))
        }
    }
}
