//! The implementation of the trait `Clebsch` for the user's struct, and further items.

use clebsch_symbolic::{Elements, Group, Property, Role, both};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::ext::IdentExt;

use super::block::{Target, matrix, time_type, types_of_system};
use super::function::{Body, Function, no_words, number};
use super::functions::{CONSERVES, CONSTRAINED, REACTING, SYSTEM, VELOCITY};
use super::scope::{Scope, size};
use super::{Emitter, SystemEmitter, flag};
use crate::derive::{Id, Solution};
use crate::lower::{Code, Kernel, Solve};
use crate::model::LeafSpace;
use crate::parse::Pattern;

impl<'g> Emitter<'_, 'g> {
    /// The impl block.
    pub(super) fn system(&self) -> TokenStream {
        // types that a person reads in the documentation are spelled
        let types = types_of_system(
            &self.types.clone().map(|ty| self.spelled(&ty)),
            &self.input,
            &time_type(self.formulas.is_timed() || self.formulas.monitor.is_some()),
        );
        let names = self.names_of(&self.target.name);
        let stepping = self.stepping(Some(names), &self.program.derivation());
        self.target.derived(
            Some(quote!(runtime::Clebsch)),
            quote! {
                #types
                #stepping
            },
        )
    }

    /// The names of the struct and of its configuration. A configuration `q` has the name that is provided.
    pub(super) fn names_of(&self, name: &str) -> TokenStream {
        let configuration = match &self.model.configuration_names {
            Pattern::Name(name) if name == "q" => None,
            names => Some(written(names)),
        };
        let configuration = configuration.map(|names| quote!(const CONFIGURATION_NAMES: runtime::Names = #names;));
        quote!(const NAME: &'static ::core::primitive::str = #name; #configuration)
    }

    /// The items that depend on how the system is stepped, and for the declared dials those of the system.
    pub(super) fn stepping(&self, name: Option<TokenStream>, derivation: &str) -> TokenStream {
        let (scheme, order) = (self.scheme(), self.model.order.number());
        let free_motion = self.formulas.is_exact.then(|| flag("IS_FREE_MOTION", true));
        let leaves = self.model.configurations.iter().any(|leaf| match leaf.space {
            LeafSpace::Group(group) => group.growth(leaf.symbol).is_some(),
            _ => false,
        });
        let may_leave = (leaves && name.is_some()).then(|| flag("MAY_LEAVE_ORBIT", true));
        let functions = self.functions(SYSTEM, (0, 0), &no_words, |function, kernel| {
            let is_asked = self.method.is_none() || function.is_of_method();
            if is_asked { self.function_of_system(function, kernel) } else { None }
        });
        let is_field = (self.model.field.is_some() && name.is_some()).then(|| flag("IS_FIELD", true));
        quote! {
            type Constants = C;
            type Scheme = #scheme;

            #name
            #is_field
            const ORDER: ::core::primitive::u32 = #order;
            #free_motion
            #may_leave
            const DERIVATION: &'static ::core::primitive::str = #derivation;

            #functions
        }
    }

    fn function_of_system<'k>(&'k self, function: &Function, kernel: Option<&'k Kernel>) -> Option<Body<'k>> {
        let scope = self.scope_of_system();
        Some(match function.name {
            "constants" => Body::new(kernel?, self.constants(kernel?)),
            "legendre" | "legendre_next" => function.computes(&scope, kernel?).after(self.free_momenta()),
            // the trait documents these for other systems
            "potential" if self.formulas.potential_energy.is_zero() => return None,
            "orbit_defect" if self.model.configurations.iter().all(|leaf| leaf.space == LeafSpace::Vectors) => {
                return None;
            }
            "orbit_defect" => Body::from(self.orbit_defect()),
            "isotropy_defect" => Body::from(self.isotropy(kernel?, ["distance_of_projection", "annihilator_defect"])),
            "project_momentum" => Body::from(self.isotropy(kernel?, ["projection", "annihilator_projection"])),
            "kinetic_energy" => Body::from(self.kinetic_energy()),
            // that of a constant inertia is among the constants
            "check_kinetic_energy" if self.formulas.inertia_moves() && self.formulas.is_definite() => {
                let inertia = self.inertia(&scope);
                Body::new(kernel?, quote!(runtime::check_definite_at(&{ #inertia })))
            }
            "check_kinetic_energy" => return None,
            "check_place" | "constraint_defect" | "constrained" | "placed" => {
                let scope = self.scope(self.receiver(), Some(quote!(c)));
                function.written(&scope, kernel, &|word| match word {
                    "System" => Some(self.receiver()),
                    "PartsOf" => {
                        let (system, parts) = (self.target.of_type(), self.trait_of_parts("Parts", &[]));
                        Some(quote!(<#system as #parts>))
                    }
                    _ => matrix_of_kernel(&scope, kernel?, word),
                })?
            }
            _ => function.computes(&scope, kernel?),
        })
    }

    /// The implementation of `Conserves`, where something is conserved; of a power by sums over its sites, along motions that move all of
    /// them alike.
    pub(super) fn conserves(&self) -> TokenStream {
        let Some(kernel) = self.program.find(Id::ConservedMomenta) else { return TokenStream::new() };
        let conserved = &self.formulas.symmetries.conserved;
        let (names, count) = (conserved.iter().map(|momentum| momentum.name.as_str()), size(conserved.len()));
        let scope = self.scope_of_system();
        let (locals, entries) = (scope.locals(kernel), &kernel.outputs[0].1);
        let spelled = entries.iter().map(|entry| scope.code(entry, false));
        let is_power = self.power.is_some();
        let words = |word: &str| match word {
            "Q" if is_power => Some(quote!(Self::Configuration)),
            "Mu" if is_power => Some(quote!(Self::Momentum)),
            _ => None,
        };
        let code = if is_power {
            let places = (0..entries.len()).map(size);
            quote! {
                let mut sum = [<T as runtime::Zero>::zero(); #count];
                for (q, mu) in ::core::iter::zip(q, mu) {
                    #locals
                    #(sum[#places] += #spelled;)*
                }
                runtime::conserved(Self::CONSERVED_NAMES, sum)
            }
        } else {
            // all components of a long momentum are that momentum
            let is_component = |(k, entry): (usize, &Code)| matches!(entry, Code::Read(input) if input.role == Role::Momentum(0) && input.row == k);
            let is_whole =
                self.keeps_matrices && entries.len() == self.dimension && entries.iter().enumerate().all(is_component);
            let values = if is_whole { quote!((*mu).into()) } else { quote!([#(#spelled),*]) };
            quote!(#locals runtime::conserved(Self::CONSERVED_NAMES, #values))
        };
        let title = is_power.then_some("The momenta that no step changes, sums over all sites.");
        let cost = (!is_power).then_some(kernel);
        let functions =
            self.functions(CONSERVES, (0, 0), &words, |_, _| Some(Body { title, cost, ..Body::from(code.clone()) }));
        self.declared().derived(
            Some(quote!(runtime::Conserves)),
            quote! {
                type Conserved = runtime::Conserved<T, #count>;
                const CONSERVED_NAMES: &'static [&'static ::core::primitive::str] = &[#(#names),*];
                #functions
            },
        )
    }

    /// The implementation of `Constrained`, where there is a constraint.
    pub(super) fn constrained(&self) -> TokenStream {
        if self.formulas.constraint.is_none() {
            return TokenStream::new();
        }
        let functions = self.written(CONSTRAINED, &self.scope_of_system(), &no_words);
        let rows = size(self.formulas.constraint.as_ref().map_or(0, |constraint| constraint.rows.shape().rows));
        let reactions = quote!(type Reactions = runtime::SVector<T, #rows>;);
        self.declared().derived(Some(quote!(runtime::Constrained)), quote!(#reactions #functions))
    }

    /// The implementation of `Reacting`, where there is a constraint.
    pub(super) fn reacting(&self) -> TokenStream {
        if self.formulas.constraint.is_none() {
            return TokenStream::new();
        }
        let scope = self.scope_of_step();
        let functions = self.functions(REACTING, (0, 0), &no_words, |function, kernel| {
            let kernel = Some(kernel?);
            function.written(&scope, kernel, &|word| matrix_of_kernel(&scope, kernel?, word))
        });
        self.implementation("Reacting", &[], functions)
    }

    /// The momenta of the free motions that make F, for the Legendre transforms of free motions.
    fn free_momenta(&self) -> Option<TokenStream> {
        let solves = || self.program.steps[0].solves.iter().filter(|solve| solve.solution == Solution::FreeRotation);
        solves().next()?;
        let scope = self.scope_of_system();
        let inertia = self.inertia(&scope);
        let dimension = size(self.dimension);
        let momentum = |solve: &Solve| {
            let factor = &self.model.factors[self.factor_of(solve)];
            let (access, inertia, is_left) = (&factor.accessor, self.block_of_inertia(solve), self.is_left(solve));
            let sign = is_left.then(|| quote!(-));
            let momentum = if self.formulas.turns_whole() {
                let back = is_left.then(|| quote!(.transpose()));
                quote!(runtime::free_momentum_4d(&#inertia, h, &f #access #back))
            } else if factor.group == Group::UnitQuaternions {
                quote!(runtime::free_momentum(&#inertia, h, &#sign runtime::gibbs_vector_of_quaternion(&f #access)))
            } else {
                quote!(runtime::free_momentum(&#inertia, h, &#sign runtime::gibbs_vector_of_matrix(&f #access)))
            };
            if is_left { quote!((-#momentum)) } else { momentum }
        };
        if self.dimension == 3 || self.formulas.turns_whole() {
            let momentum = solves().map(momentum);
            return Some(quote!(let inertia = { #inertia }; let mu = &#(#momentum)*;));
        }
        let blocks = solves().map(|solve| {
            let (start, momentum) = (size(solve.components[0]), momentum(solve));
            quote!(mu.fixed_rows_mut::<3>(#start).copy_from(&#momentum);)
        });
        Some(quote! {
            let inertia = { #inertia };
            let mut mu = <runtime::SVector<T, #dimension> as runtime::Space<T>>::origin();
            #(#blocks)*
            let mu = &mu;
        })
    }

    /// ½ (μ − A)·Σ⁻¹(μ − A), with Σ⁻¹ from the constants where it does not change.
    fn kinetic_energy(&self) -> TokenStream {
        let scope = self.scope_of_system();
        if self.program.find(Id::Lagrangian).is_some() {
            let (velocity, system) = (self.names.free("Velocity"), self.receiver());
            return quote!(runtime::legendre_fenchel(&#velocity { system: #system, t, q }, mu));
        }
        let slope = self.program.find(Id::Gyroscopic).map(|kernel| scope.body(kernel));
        let mu = if slope.is_some() { quote!(&mu) } else { quote!(mu) };
        let shift = slope.map(|slope| quote!(let mu = *mu - { #slope };));
        let energy = if self.formulas.inertia_moves() {
            let inertia = self.inertia(&scope);
            quote!(runtime::kinetic_energy_at(&{ #inertia }, #mu))
        } else if self.has_uniform_inertia() {
            quote!(runtime::kinetic_energy_uniform(&c.inertia_inverse, #mu))
        } else if self.keeps_matrices {
            quote!(c.inertia_inverse.energy(#mu))
        } else {
            quote!(runtime::kinetic_energy(&c.inertia_inverse, #mu))
        };
        quote!(#shift #energy)
    }

    /// The equation of the velocity that has a momentum, of a Lagrangian that is not quadratic.
    pub(super) fn velocity(&self) -> TokenStream {
        if self.program.find(Id::Lagrangian).is_none() {
            return TokenStream::new();
        }
        let system = self.target.of_type();
        let (lifetime, name) = (self.names.lifetime(), self.names.free("Velocity"));
        let dimension = size(self.dimension);
        let words = |word: &str| (word == "Algebra").then(|| matrix(self.dimension, 1));
        let linearize = self.written(VELOCITY, &self.scope(quote!(self.system), None), &words);
        let target = self.borrowed(&name);
        let implementation = target.implementation(Some(quote!(runtime::VelocityEquation<T, #dimension>)), linearize);
        let Target { parameters, predicates, .. } = &target;
        quote! {
            #[doc = " The velocity that has a momentum: ∂ℓ/∂ξ = μ."]
            struct #name #parameters #predicates {
                system: &#lifetime #system,
                t: T,
                q: &#lifetime Q,
            }
            #implementation
        }
    }

    /// A property of a momentum where motions fix the configuration: by a function of the projection, or of the motions
    /// ξ_Q(q).
    fn isotropy(&self, kernel: &Kernel, [of_projection, of_motions]: [&str; 2]) -> TokenStream {
        let scope = self.scope_of_system();
        let [of_projection, of_motions] = both([of_projection, of_motions], |name| format_ident!("{name}"));
        if self.keeps_matrices && self.formulas.projection.is_some() {
            let projection = scope.body(kernel);
            return quote!(runtime::#of_projection(mu, |mu| { #projection }));
        }
        let (locals, (shape, entries)) = (scope.locals(kernel), &kernel.outputs[0]);
        let entries: Vec<_> = entries.each(|entry| scope.code(entry, false));
        let rows = entries.chunks(shape.columns).map(|row| quote!([#(#row),*]));
        quote!(#locals runtime::#of_motions(&[#(#rows),*], mu))
    }
}

/// Names as the runtime reads them.
fn written(names: &Pattern) -> TokenStream {
    match names {
        Pattern::Name(name) => {
            let name = name.unraw().to_string();
            quote!(runtime::Names::One(#name))
        }
        Pattern::Tuple(parts, _) => {
            let parts = parts.iter().map(written);
            quote!(runtime::Names::Each(&[#(#parts),*]))
        }
    }
}

/// The output of a kernel that a word `Matrix0` means, as a matrix.
pub(super) fn matrix_of_kernel(scope: &Scope<'_, '_>, kernel: &Kernel, word: &str) -> Option<TokenStream> {
    Some(scope.whole_matrix(kernel, number(word, "Matrix")?))
}

impl SystemEmitter<'_, '_> {
    /// By how much q violates the promise of the declaration.
    pub(super) fn orbit_defect(&self) -> TokenStream {
        let scope = self.scope_of_system();
        let defects = self.model.configurations.iter().filter_map(|leaf| {
            let access = &leaf.accessor;
            Some(match leaf.space {
                LeafSpace::Group(group) if group.element_property() == Property::Orthogonal => {
                    quote!(runtime::orthogonality_defect(&q #access))
                }
                LeafSpace::Group(Group::SpecialEuclidean(_) | Group::Similarity(_)) => {
                    quote!(runtime::orientation_defect(&q #access))
                }
                LeafSpace::Group(Group::UnitQuaternions) => quote!(runtime::length_defect(&q #access.coords)),
                LeafSpace::Unit => quote!(runtime::length_defect(&q #access)),
                LeafSpace::Symmetric => quote!(runtime::symmetry_defect(&q #access)),
                LeafSpace::Orthonormal => quote!(runtime::orthonormality_defect(&q #access)),
                LeafSpace::Projector(rank) => {
                    let rank = size(rank);
                    quote!(runtime::projector_defect(&q #access, #rank))
                }
                LeafSpace::Vectors | LeafSpace::Group(_) => return None,
            })
        });
        let membership = self.kernels.find(Id::Membership);
        let locals = membership.map(|kernel| scope.locals(kernel));
        let entries = membership.iter().flat_map(|kernel| &kernel.outputs[0].1);
        let defects = defects.chain(entries.map(|entry| scope.code(entry, false)));
        quote!(#locals runtime::largest([#(#defects),*]))
    }
}
