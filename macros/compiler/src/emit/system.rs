//! The implementation of the trait `Clebsch` for the user's struct.

use clebsch_symbolic::{Group, Property, Role};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::code::Nesting;
use super::names::Names;
use super::{Emitter, Generics, SystemEmitter, code, docs};
use crate::derive::{Formula, Id, Solution};
use crate::lower::{Code, Kernel, Solve};
use crate::model::LeafSpace;

impl Emitter<'_, '_> {
    /// The impl block.
    pub(super) fn system(&self) -> TokenStream {
        let (krate, scalar) = (&self.paths.krate, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (ident, name) = (&self.model.item.ident, self.model.item.ident.to_string());
        // what a person reads in the documentation is spelled
        let [configuration, element, momentum] = self.types(&self.spelled);
        let (input, private) = (self.input_type(), &self.paths.private);
        let time = if self.is_timed() { quote!(#private::Clock<#scalar>) } else { quote!(()) };
        let order = self.model.order.number();
        let free_motion = self.is_free_motion();
        let (constants_type, scheme) = (self.constants_of_step(), self.scheme());
        let derivation = self.program.derivation();
        let (constants, formulas, checks) = (self.constants(), self.formulas(), self.space_checks());
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Clebsch for #ident<#arguments> #predicates {
                type Scalar = #scalar;
                type Configuration = #configuration;
                type Element = #element;
                type Momentum = #momentum;
                type MomentumMatrix = #element;
                type Input = #input;
                type Time = #time;
                type Constants = #constants_type;
                type Scheme = #scheme;

                const NAME: &'static ::core::primitive::str = #name;
                const ORDER: ::core::primitive::u32 = #order;
                #free_motion
                const DERIVATION: &'static ::core::primitive::str = #derivation;

                #constants
                #formulas
                #checks
            }
        }
    }

    /// The constant that says so where a step is the free motion itself.
    pub(super) fn is_free_motion(&self) -> Option<TokenStream> {
        self.program.formulas.is_exact.then(|| {
            quote!(
                const IS_FREE_MOTION: ::core::primitive::bool = true;
            )
        })
    }

    /// The implementation of `Conserves`, where something is conserved.
    pub(super) fn conserves(&self) -> TokenStream {
        let [configuration, _, momentum] = self.names_of_types();
        // what is conserved of a power is a sum over its sites
        let conserved = self.program.find(Id::ConservedMomenta).filter(|_| self.model.power.is_none());
        let Some(kernel) = conserved else { return TokenStream::new() };
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = &self.generics;
        let ident = &self.model.item.ident;
        let names = self.program.formulas.symmetries.conserved.iter().map(|momentum| momentum.name.as_str());
        let count = Literal::usize_unsuffixed(self.program.formulas.symmetries.conserved.len());
        let scope = self.scope_of_system();
        let (locals, entries) = (code::locals(&scope, kernel), &kernel.outputs[0].1);
        // all components of a long momentum are that momentum
        let is_component = |(k, entry): (usize, &Code)| matches!(entry, Code::Read(input) if input.role == Role::Momentum(0) && input.row == k);
        let is_whole = self.program.form.keeps_matrices()
            && entries.len() == self.dimension()
            && entries.iter().enumerate().all(is_component);
        let values = match is_whole {
            true => quote!((*mu).into()),
            false => {
                let entries = entries.iter().map(|entry| scope.code(entry, false));
                quote!([#(#entries),*])
            }
        };
        let formulas = self.program.formulas.table().titled_all(|id| matches!(id, Id::Conserved(_)));
        let documentation = docs::formulas("The momenta that no step changes.", formulas, Some(kernel));
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Conserves for #ident<#arguments> #predicates {
                type Conserved = #private::Conserved<#scalar, #count>;

                #documentation
                fn conserved(&self, q: &#configuration, mu: &#momentum) -> Self::Conserved {
                    #locals
                    #private::Conserved::new([#(#names),*], #values)
                }
            }
        }
    }

    /// The momenta of the free motions that make F, for the Legendre transforms of what moves freely.
    fn free_momenta(&self) -> Option<TokenStream> {
        let solves = || self.program.steps[0].solves.iter().filter(|solve| solve.solution == Solution::FreeRotation);
        solves().next()?;
        let (private, scalar, scope) = (&self.paths.private, &self.paths.scalar, self.scope_of_system());
        let inertia = code::body(&scope, self.program.kernel(Id::Inertia), None);
        let dimension = Literal::usize_unsuffixed(self.dimension());
        let momentum = |solve: &Solve| {
            let block = self.program.formulas.symbols.blocks_of(&solve.components)[0];
            let factor = &self.model.factors[self.program.formulas.symbols.blocks[block].factor];
            let access = code::accessor(&factor.accessor);
            let of_block = self.block_of_inertia(solve);
            if self.program.formulas.turns_whole() {
                return match self.is_left(solve) {
                    true => quote!((-#private::free_momentum_4d(&#of_block, h, &f #access.transpose()))),
                    false => quote!(#private::free_momentum_4d(&#of_block, h, &f #access)),
                };
            }
            let rotation = match factor.group {
                Group::UnitQuaternions => quote!(#private::gibbs_vector_of_quaternion(&f #access)),
                _ => quote!(#private::gibbs_vector_of_matrix(&f #access)),
            };
            match self.is_left(solve) {
                true => quote!((-#private::free_momentum(&#of_block, h, &-#rotation))),
                false => quote!(#private::free_momentum(&#of_block, h, &#rotation)),
            }
        };
        if self.dimension() == 3 || self.program.formulas.turns_whole() {
            let momentum = solves().map(momentum);
            return Some(quote!(let inertia = { #inertia }; let mu = &#(#momentum)*;));
        }
        let blocks = solves().map(|solve| {
            let (start, momentum) = (Literal::usize_unsuffixed(solve.components[0]), momentum(solve));
            quote!(mu.fixed_rows_mut::<3>(#start).copy_from(&#momentum);)
        });
        Some(quote! {
            let inertia = { #inertia };
            let mut mu = <#private::SVector<#scalar, #dimension> as #private::Space<#scalar>>::origin();
            #(#blocks)*
            let mu = &mu;
        })
    }

    /// A method that is one kernel.
    fn method(
        &self,
        documentation: (&str, &[Formula<'_>]),
        signature: TokenStream,
        kernel: &Kernel,
        nesting: Option<Nesting>,
    ) -> TokenStream {
        self.method_after(None, documentation, signature, kernel, nesting)
    }

    /// A method that is one kernel, behind what makes its inputs.
    fn method_after(
        &self,
        inputs: Option<&TokenStream>,
        documentation: (&str, &[Formula<'_>]),
        signature: TokenStream,
        kernel: &Kernel,
        nesting: Option<Nesting>,
    ) -> TokenStream {
        let documentation = docs::formulas(documentation.0, documentation.1, Some(kernel));
        let body = code::body(&self.scope_of_system(), kernel, nesting);
        quote! {
            #documentation
            fn #signature {
                #inputs
                #body
            }
        }
    }

    fn formulas(&self) -> TokenStream {
        let (program, formulas) = (self.program, &self.program.formulas);
        let [configuration, element, momentum] = self.names_of_types();
        let mechanics = [
            self.method(
                ("The action.", formulas.titled(Id::Action)),
                quote!(act(&self, f: &#element, q: &#configuration) -> #configuration),
                program.kernel(Id::Action),
                Some(Nesting::Configuration),
            ),
            self.method(
                (
                    "The momentum map of the cotangent lift, ⟨A, E⟩ standing for the components tr(AᵀE_i).",
                    formulas.titled(Id::MomentumMap),
                ),
                quote!(momentum_map(&self, q: &#configuration, p: &#configuration) -> #momentum),
                program.kernel(Id::MomentumMap),
                None,
            ),
            self.method(
                ("The coadjoint action.", formulas.titled(Id::Coadjoint)),
                quote!(coadjoint(&self, f: &#element, mu: &#momentum) -> #momentum),
                program.kernel(Id::Coadjoint),
                None,
            ),
        ];
        let matrices = [
            self.method(
                ("The representing matrices M = Σ G^{ij} μ_j E_i of a momentum.", &[]),
                quote!(momentum_matrix(mu: &#momentum) -> #element),
                program.kernel(Id::MomentumMatrix),
                Some(Nesting::Element),
            ),
            self.method(
                ("The components μ_i = tr(MᵀE_i) of a momentum.", &[]),
                quote!(momentum_components(m: &#element) -> #momentum),
                program.kernel(Id::MomentumComponents),
                None,
            ),
        ];
        let (legendre, stagger) = (self.legendre_transforms(), self.stagger());
        let (potential, kinetic_energy) = (self.potential(), self.kinetic_energy_of_momentum());
        quote!(#(#mechanics)* #legendre #(#matrices)* #stagger #potential #kinetic_energy)
    }

    /// Both discrete Legendre transforms.
    pub(super) fn legendre_transforms(&self) -> TokenStream {
        let (program, formulas, scalar) = (self.program, &self.program.formulas, &self.paths.scalar);
        let (free, receiver) = (self.free_momenta(), self.receiver_parameter());
        let [configuration, element, momentum] = self.names_of_types();
        let arguments = quote!(#receiver, h: #scalar, t: #scalar, q: &#configuration, f: &#element);
        let legendre = self.method_after(
            free.as_ref(),
            (
                "The discrete Legendre transform: the momentum N before the step that moves q by F.",
                formulas.titled(Id::Legendre),
            ),
            quote!(legendre(#arguments) -> #momentum),
            program.kernel(Id::Legendre),
            None,
        );
        let legendre_next = self.method_after(
            free.as_ref(),
            (
                "The discrete Legendre transform: the momentum N⁺ after the step that moves q by F.",
                formulas.titled(Id::LegendreNext),
            ),
            quote!(legendre_next(#arguments) -> #momentum),
            program.kernel(Id::LegendreNext),
            None,
        );
        quote!(#legendre #legendre_next)
    }

    /// V, where there is one; the trait says what it is elsewhere.
    fn potential(&self) -> Option<TokenStream> {
        if self.program.formulas.potential_energy.is_zero() {
            return None;
        }
        let (scalar, kernel) = (&self.paths.scalar, self.program.kernel(Id::PotentialEnergy));
        let [configuration, ..] = self.names_of_types();
        let formulas = self.program.formulas.titled(Id::PotentialEnergy);
        let signature = quote!(potential(&self, t: #scalar, q: &#configuration) -> #scalar);
        let documentation = docs::formulas("The potential energy.", formulas, Some(kernel));
        let scope = self.scope_of_system();
        let (locals, value) = (code::locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
        Some(quote! {
            #documentation
            fn #signature {
                #locals
                #value
            }
        })
    }

    /// The kinetic energy of a momentum.
    pub(super) fn kinetic_energy_of_momentum(&self) -> TokenStream {
        let (scalar, constants) = (&self.paths.scalar, self.constants_of_step());
        let [configuration, _, momentum] = self.names_of_types();
        let formulas = self.program.formulas.titled(Id::KineticEnergyOfMomentum);
        let documentation = docs::formulas("The kinetic energy.", formulas, None);
        let (energy, receiver) = (self.kinetic_energy(), self.receiver_parameter());
        quote! {
            #documentation
            fn kinetic_energy(#receiver, c: &#constants, t: #scalar, q: &#configuration, mu: &#momentum) -> #scalar {
                #energy
            }
        }
    }

    /// ½ (μ − A)·Σ⁻¹(μ − A), with Σ⁻¹ from the constants where it does not change.
    fn kinetic_energy(&self) -> TokenStream {
        let private = &self.paths.private;
        if self.program.find(Id::Lagrangian).is_some() {
            let (velocity, system) = (&self.names.velocity, self.receiver());
            return quote!(#private::legendre_fenchel(&#velocity { system: #system, t, q }, mu));
        }
        let scope = self.scope_of_system();
        let (shift, mu) = match self.program.find(Id::Gyroscopic) {
            Some(kernel) => {
                let slope = code::body(&scope, kernel, None);
                (quote!(let mu = *mu - { #slope };), quote!(&mu))
            }
            None => (quote!(), quote!(mu)),
        };
        let energy = match self.program.formulas.inertia_moves() {
            true => {
                let inertia = self.inertia(&scope);
                quote!(#private::kinetic_energy_at(&{ #inertia }, #mu))
            }
            false => match (self.has_uniform_inertia(), self.program.form.keeps_matrices()) {
                (true, _) => quote!(#private::kinetic_energy_uniform(&c.inertia_inverse, #mu)),
                (false, true) => quote!(c.inertia_inverse.energy(#mu)),
                (false, false) => quote!(#private::kinetic_energy(&c.inertia_inverse, #mu)),
            },
        };
        quote!(#shift #energy)
    }

    /// The equation of the velocity that has a momentum, of a Lagrangian that is not quadratic.
    pub(super) fn velocity(&self) -> TokenStream {
        let Some(kernel) = self.program.find(Id::Lagrangian) else { return TokenStream::new() };
        let Generics { parameters, arguments, predicates } = &self.generics;
        let (private, scalar, ident) = (&self.paths.private, &self.paths.scalar, &self.model.item.ident);
        let Names { lifetime, velocity: name, .. } = &self.names;
        let (configuration, dimension) = (self.configuration_type(), Literal::usize_unsuffixed(self.dimension()));
        let scope = self.scope(quote!(self.system), None);
        let locals = code::locals(&scope, kernel);
        let value = scope.code(&kernel.outputs[0].1[0], false);
        let grid = |index: usize| code::grid(&scope, kernel.outputs[index].0, &kernel.outputs[index].1, false);
        let (gradient, hessian) = (grid(1), grid(2));
        let documentation = docs::formulas(
            "The Lagrangian of a velocity, its gradient and its Hessian.",
            self.program.formulas.titled(Id::Lagrangian),
            Some(kernel),
        );
        quote! {
            #[doc = " The velocity that has a momentum: ∂ℓ/∂ξ = μ."]
            struct #name<#lifetime, #parameters> #predicates {
                system: &#lifetime #ident<#arguments>,
                t: #scalar,
                q: &#lifetime #configuration,
            }

            impl<#lifetime, #parameters> #private::VelocityEquation<#scalar, #dimension> for #name<#lifetime, #arguments> #predicates {
                #documentation
                fn linearize(
                    &self,
                    x: &#private::SVector<#scalar, #dimension>,
                ) -> (#scalar, #private::SVector<#scalar, #dimension>, #private::SMatrix<#scalar, #dimension, #dimension>) {
                    let (t, q) = (self.t, self.q);
                    #locals
                    (#value, #gradient, #hessian)
                }
            }
        }
    }

    /// By how much the momentum of a step of first order is ahead; where it is not, the trait says so.
    pub(super) fn stagger(&self) -> Option<TokenStream> {
        let (receiver, [configuration, _, momentum]) = (self.receiver_parameter(), self.names_of_types());
        let (kernel, scalar) = (self.program.find(Id::SynchronizedMomentum)?, &self.paths.scalar);
        let formulas = self.program.formulas.titled(Id::SynchronizedMomentum);
        Some(self.method(
            ("By how much the momentum N of a state is ahead of the momentum π at its configuration.", formulas),
            quote!(stagger(#receiver, h: #scalar, t: #scalar, q: &#configuration) -> #momentum),
            kernel,
            None,
        ))
    }

    /// `orbit_defect`, `isotropy_defect` and `project_momentum`, where they are not those of vectors and free actions.
    fn space_checks(&self) -> TokenStream {
        let (orbit, isotropy) = (self.check_of_orbit(), self.checks_of_isotropy());
        quote!(#orbit #isotropy)
    }

    fn check_of_orbit(&self) -> Option<TokenStream> {
        let [configuration, _, _] = self.names_of_types();
        let scalar = &self.paths.scalar;
        let is_promised = self.model.configurations.iter().any(|leaf| leaf.space != LeafSpace::Vectors);
        let defect = is_promised.then(|| self.orbit_defect())?;
        Some(quote! {
            fn orbit_defect(&self, q: &#configuration) -> #scalar {
                #defect
            }
        })
    }

    fn checks_of_isotropy(&self) -> Option<TokenStream> {
        let [configuration, _, momentum] = self.names_of_types();
        let (private, scalar, scope) = (&self.paths.private, &self.paths.scalar, self.scope_of_system());
        let kernel = self.program.find(Id::Isotropy)?;
        let (defect, projection) = if self.program.form.keeps_matrices() {
            let projection = code::body(&scope, kernel, None);
            (
                quote!(#private::distance_of_projection(mu, |mu| { #projection })),
                quote!(#private::projection(mu, |mu| { #projection })),
            )
        } else {
            let (locals, (shape, entries)) = (code::locals(&scope, kernel), &kernel.outputs[0]);
            let entries: Vec<_> = entries.iter().map(|entry| scope.code(entry, false)).collect();
            let rows = entries.chunks(shape.columns).map(|row| quote!([#(#row),*]));
            let rows = quote!(&[#(#rows),*]);
            (
                quote!(#locals #private::annihilator_defect(#rows, mu)),
                quote!(#locals #private::annihilator_projection(#rows, mu)),
            )
        };
        Some(quote! {
            fn isotropy_defect(&self, q: &#configuration, mu: &#momentum) -> #scalar {
                #defect
            }
            fn project_momentum(&self, q: &#configuration, mu: &#momentum) -> #momentum {
                #projection
            }
        })
    }
}

impl SystemEmitter<'_, '_> {
    /// By how much q violates what the declaration promises.
    pub(super) fn orbit_defect(&self) -> TokenStream {
        let private = &self.paths.private;
        let defects = self.model.configurations.iter().filter_map(|leaf| {
            let access = code::accessor(&leaf.accessor);
            match leaf.space {
                LeafSpace::Group(group) if group.element_property() == Property::Orthogonal => {
                    Some(quote!(#private::orthogonality_defect(&q #access)))
                }
                LeafSpace::Group(Group::SpecialEuclidean(_) | Group::Similarity(_)) => {
                    Some(quote!(#private::orientation_defect(&q #access)))
                }
                LeafSpace::Group(Group::UnitQuaternions) => Some(quote!(#private::length_defect(&q #access.coords))),
                LeafSpace::Unit => Some(quote!(#private::length_defect(&q #access))),
                LeafSpace::Vectors | LeafSpace::Group(_) => None,
            }
        });
        let mut defects: Vec<_> = defects.collect();
        let scope = self.scope_of_system();
        let membership = self.kernels.find(Id::Membership).map(|kernel| {
            let (locals, (_, entries)) = (code::locals(&scope, kernel), &kernel.outputs[0]);
            defects.extend(entries.iter().map(|entry| scope.code(entry, false)));
            locals
        });
        quote! {
            #membership
            #private::largest([#(#defects),*])
        }
    }
}
