//! Powers: the site as a system of its own, and the implementation for all of them, a loop over sites for each method.

use clebsch_symbolic::{Expr, Group, Property, Rational, Role, Shape, integer};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::code::{Scope, accessor, grid, locals, nested_type};
use super::{Emitter, Generics, docs};
use crate::derive::{Home, Link};
use crate::lower::{Code, Gathered, Kernel, LinkKernels};
use crate::model::{Configuration, Order, Parameter, Place, Power, Promise, Space};

/// How the term is found that has a site at a place.
struct Head {
    /// The place, where it is one of the term's.
    own: Option<usize>,
    /// The index `i0` of the term, from that of the site.
    index: TokenStream,
    /// What leaves where there is no such term.
    guard: Option<TokenStream>,
}

impl<'g> Emitter<'_, 'g> {
    /// The struct of a site and the implementation for all sites, where the declaration is a power.
    pub(super) fn power(&self) -> TokenStream {
        let Some(power) = &self.model.power else { return TokenStream::new() };
        let generics = Generics::of(&power.item, &self.paths);
        let (site, sites, whole) = (self.site(), self.sites(power, &generics), self.whole_power(power, &generics));
        let conserves = self.conserves_of_power(power, &generics);
        quote!(#site #sites #whole #conserves)
    }

    /// The struct of a site: the fields that it reads.
    fn site(&self) -> TokenStream {
        let Generics { parameters, predicates, .. } = &self.generics;
        let ident = &self.model.item.ident;
        let fields = self.model.parameters.iter().map(|parameter| {
            let (field, ty) = (&parameter.field, self.type_of(parameter));
            quote!(#field: #ty,)
        });
        let scalar = matches!(self.model.item.scalar, crate::model::ScalarType::Parameter(_)).then(|| {
            let scalar = &self.paths.scalar;
            quote!(scalar: ::core::marker::PhantomData<#scalar>,)
        });
        let documentation = docs::lines(&["One site: what moves it while the others do nothing to it.".to_string()]);
        quote! {
            #documentation
            #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct #ident<#parameters> #predicates { #(#fields)* #scalar }
        }
    }

    /// The type of a field, or of its entry for one site.
    fn type_of(&self, parameter: &Parameter<'g>) -> TokenStream {
        let scalar = &self.paths.scalar;
        nested_type(&parameter.structure, &|leaf| {
            // the nesting of a field counts its leaves from 0
            let leaf = &parameter.leaves[leaf];
            if leaf.is_scalar { quote!(#scalar) } else { self.paths.leaf(leaf.shape, false) }
        })
    }

    /// What ties sites together.
    fn sites(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let (ident, length, site) = (&power.item.ident, &power.length, &self.model.item.ident);
        let site_type = self.item_type();
        let fields = self.model.parameters.iter().zip(&power.copied).map(|(parameter, field)| {
            let (name, index) = (&parameter.field, parameter.per_site.then(|| quote!([i])));
            quote!(#name: self.#field #index,)
        });
        let marker = matches!(self.model.item.scalar, crate::model::ScalarType::Parameter(_))
            .then(|| quote!(scalar: ::core::marker::PhantomData,));
        let is_uniform = power.is_uniform;
        let point = self.configuration_type();
        let potential = self.potential_of_power(power);
        let gathers = self.program.gathered.is_some();
        let is_orthogonal = |group: Group| group.element_property() == Property::Orthogonal;
        let is_bounded = self.model.configurations.iter().all(|leaf| match leaf.space {
            Space::Unit => true,
            Space::Group(group) => is_orthogonal(group),
            Space::Vectors => false,
        });
        let gradient = match &self.program.gathered {
            Some(gathered) => self.gathered_gradient(power, gathered, &point),
            None => self.added_gradient(power, &point),
        };
        let formulas = self.program.formulas.formulas_of_terms();
        let of_potential = docs::formulas("The potential energy, a sum over sites.", &formulas, None);
        quote! {
            #[automatically_derived]
            impl<#parameters> #private::Power<#length> for #ident<#arguments> #predicates {
                type Site = #site_type;

                const IS_UNIFORM: ::core::primitive::bool = #is_uniform;
                const GATHERS: ::core::primitive::bool = #gathers;
                const IS_BOUNDED: ::core::primitive::bool = #is_bounded;

                /// The site with this index, which is below the number of sites.
                #[inline]
                fn site(&self, i: ::core::primitive::usize) -> Self::Site {
                    let _ = i;
                    #site { #(#fields)* #marker }
                }
                #[inline]
                fn constants_of_sites(constants: &<Self as #krate::Clebsch>::Constants) -> &<Self as #krate::Clebsch>::Constants {
                    constants
                }
                #of_potential
                fn potential_of_sites(&self, t: #scalar, q: &[#point; #length]) -> #scalar {
                    let _ = (t, q);
                    let mut sum = <#scalar as #private::Zero>::zero();
                    #potential
                    sum
                }
                #gradient
            }
        }
    }

    fn potential_of_power(&self, power: &Power<'g>) -> TokenStream {
        let scope = self.scope_of_system();
        let terms = self.program.links.iter().zip(&self.program.formulas.links).map(|(kernels, link)| {
            let (locals, value) = (locals(&scope, &kernels.value), scope.code(&kernels.value.outputs[0].1[0], false));
            let places: Vec<usize> = link.gradient.iter().map(|(place, _)| *place).collect();
            self.loops(power, &link.term.ranges, &places, &kernels.value, quote!(#locals sum += #value;))
        });
        quote!(#(#terms)*)
    }

    /// The method that goes through the terms and adds what each has for its sites.
    fn added_gradient(&self, power: &Power<'g>, point: &TokenStream) -> TokenStream {
        let (scalar, length, scope) = (&self.paths.scalar, &power.length, self.scope_of_system());
        let term = |(LinkKernels { gradient, .. }, link): (&LinkKernels, &Link<'g>)| {
            let places: Vec<usize> = link.gradient.iter().map(|(place, _)| *place).collect();
            let (locals, leaves) = (locals(&scope, gradient), self.model.configurations.len());
            let sites = link.gradient.iter().zip(gradient.outputs.chunks(leaves));
            let added = sites.map(|((place, slopes), outputs)| {
                let site = format_ident!("at{place}");
                let added = self.added(&scope, slopes, outputs, quote!((*gradient)), quote!(+=));
                (!added.is_empty()).then(|| {
                    quote! {
                        if let ::core::option::Option::Some(gradient) = gradient.get_mut(#site) {
                            #(#added)*
                        }
                    }
                })
            });
            let added = added.flatten();
            self.loops(power, &link.term.ranges, &places, gradient, quote!(#locals #(#added)*))
        };
        let terms = self.program.links.iter().zip(&self.program.formulas.links).map(term);
        quote! {
            /// Adds the gradient of the potential, a covector for each site.
            fn add_gradient(&self, t: #scalar, q: &[#point; #length], gradient: &mut [#point; #length]) {
                let _ = (t, q, &gradient);
                #(#terms)*
            }
        }
    }

    /// The method that gathers the gradient of one site from the terms that read it.
    fn gathered_gradient(&self, power: &Power<'g>, gathered: &Gathered<'g>, point: &TokenStream) -> TokenStream {
        let (private, scalar, length) = (&self.paths.private, &self.paths.scalar, &power.length);
        let (scope, Gathered { stencil, whole, rest }) = (self.scope_of_system(), gathered);
        let places = [power.places.as_slice(), &stencil.places].concat();
        let whole = {
            let (locals, added) = (
                locals(&scope, whole),
                self.added(&scope, &stencil.gradient, &whole.outputs, quote!(gradient), quote!(=)),
            );
            let head = Head { own: None, index: quote!(let i0 = site as ::core::primitive::isize;), guard: None };
            (!added.is_empty()).then(|| self.at_site(power, &places, head, whole, quote!(#locals #(#added)*)))
        };
        let rest = stencil.rest.iter().zip(rest).filter_map(|(&(term, number), kernel)| {
            let link = &self.program.formulas.links[term];
            let (place, slopes) = &link.gradient[number];
            let (locals, added) =
                (locals(&scope, kernel), self.added(&scope, slopes, &kernel.outputs, quote!(gradient), quote!(+=)));
            let home = link.homes(power)?.into_iter().nth(number).filter(|_| !added.is_empty())?;
            let head = self.head(power, *place, &home, &link.term.ranges);
            Some(self.at_site(power, &places, head, kernel, quote!(#locals #(#added)*)))
        });
        quote! {
            /// The gradient of the potential at a site, from all terms that read it.
            #[inline]
            fn gradient_at(&self, t: #scalar, q: &[#point; #length], site: ::core::primitive::usize) -> #point {
                let _ = (t, q, site);
                let mut gradient: #point = #private::Space::<#scalar>::origin();
                #whole
                #(#rest)*
                gradient
            }
        }
    }

    /// Where the term is found that has a site at a place.
    fn head(&self, power: &Power<'g>, own: usize, home: &Home<'g>, ranges: &[(Expr<'g>, Expr<'g>)]) -> Head {
        let (private, length) = (&self.paths.private, &power.length);
        let (Some(index), [(from, to), ..]) = (home.index, ranges) else {
            let (name, place) = (format_ident!("at{own}"), self.index_of(&power.places, power, own));
            let guard = quote!(#place if site != #name { break 'term; });
            return Head { own: Some(own), index: TokenStream::new(), guard: Some(guard) };
        };
        let (from, to) = (linear(*from, power), linear(*to, power));
        let moved = match (home.wraps, index.as_symbol(), linear(index, power)) {
            (true, _, moved) => quote!(let i0 = #private::wrapped::<#length>(#moved) as ::core::primitive::isize;),
            (false, Some(_), _) => quote!(),
            (false, None, moved) => quote!(let i0 = #moved;),
        };
        let guard = (!home.is_everywhere).then(|| quote!(if !(#from..#to).contains(&i0) { break 'term; }));
        Head { own: Some(own), index: quote!(let i0 = site as ::core::primitive::isize; #moved), guard }
    }

    /// A statement for one site, with the configurations that it reads.
    fn at_site(
        &self,
        power: &Power<'g>,
        places: &[Place<'g>],
        head: Head,
        kernel: &Kernel,
        body: TokenStream,
    ) -> TokenStream {
        let Head { own, index, guard } = head;
        let length = &power.length;
        let is_read =
            |place: &usize| kernel.inputs().iter().any(|input| matches!(input.role, Role::At(at, _) if at == *place));
        let sites: Vec<usize> = (0..places.len()).filter(is_read).collect();
        let mut fields = self.places_of_fields(power, kernel);
        fields.retain(|place| !sites.contains(place));
        let asks = |place: &usize| Some(*place) != own;
        let is_asked = guard.is_some()
            || sites.iter().chain(&fields).any(asks)
            || kernel.inputs().iter().any(|input| matches!(input.role, Role::Site(_)));
        let index = is_asked.then_some(index);
        let indices = sites.iter().chain(&fields).map(|&place| match Some(place) == own {
            true => {
                let name = format_ident!("at{place}");
                quote!(let #name = site;)
            }
            false => self.index_of(places, power, place),
        });
        let fields = fields.iter().map(|place| {
            let name = format_ident!("at{place}");
            quote!(if #name >= #length { break 'term; })
        });
        let sites = sites.iter().map(|place| {
            let (name, site) = (format_ident!("q{place}"), format_ident!("at{place}"));
            quote!(let ::core::option::Option::Some(#name) = q.get(#site) else { break 'term };)
        });
        quote! {
            'term: {
                #index
                #guard
                #(#indices)* #(#fields)* #(#sites)*
                #body
            }
        }
    }

    /// Adds the slopes of a place to `target`, or sets it to them, leaf by leaf.
    fn added(
        &self,
        scope: &Scope<'_, 'g>,
        slopes: &[Expr<'g>],
        outputs: &[(Shape, Vec<Code>)],
        target: TokenStream,
        operator: TokenStream,
    ) -> Vec<TokenStream> {
        let leaves = self.model.configurations.iter().zip(slopes).zip(outputs);
        let leaves = leaves.filter(|((_, slope), _)| !slope.is_zero());
        let add = |((leaf, _), (shape, entries)): ((&Configuration<'g>, _), &(Shape, Vec<Code>))| {
            let (access, value) = (accessor(&leaf.accessor), grid(scope, *shape, entries, leaf.is_quaternion));
            quote!(#target #access #operator #value;)
        };
        leaves.map(add).collect()
    }

    /// The places whose entries of fields a kernel reads.
    fn places_of_fields(&self, power: &Power<'g>, kernel: &Kernel) -> Vec<usize> {
        let of_fields = power.parameters.iter().filter(|parameter| parameter.per_site).filter_map(|parameter| {
            let read = |leaf: &crate::model::Leaf<'g>| {
                let role = leaf.symbol.as_symbol().map(|data| data.role);
                kernel.inputs().iter().any(|input| Some(input.role) == role)
            };
            parameter.leaves.iter().any(read).then(|| place_of(parameter))?
        });
        of_fields.collect()
    }

    /// The statement that computes the index of a place.
    fn index_of(&self, places: &[Place<'g>], power: &Power<'g>, place: usize) -> TokenStream {
        let (private, length) = (&self.paths.private, &power.length);
        let (name, Place { index, wraps }) = (format_ident!("at{place}"), &places[place]);
        let index = linear(*index, power);
        match wraps {
            true => quote!(let #name = #private::wrapped::<#length>(#index);),
            false => quote!(let #name = (#index) as ::core::primitive::usize;),
        }
    }

    /// A statement for all indices of a term, with the configurations that it reads.
    fn loops(
        &self,
        power: &Power<'g>,
        ranges: &[(Expr<'g>, Expr<'g>)],
        places: &[usize],
        kernel: &Kernel,
        body: TokenStream,
    ) -> TokenStream {
        let length = &power.length;
        let mut read: Vec<usize> = places.iter().copied().chain(self.places_of_fields(power, kernel)).collect();
        read.sort_unstable();
        read.dedup();
        let indices = read.iter().map(|&place| self.index_of(&power.places, power, place));
        // a field of an array is read by an index that is known to be inside; sites are asked for
        let fields = read.iter().filter(|place| !places.contains(place)).map(|place| {
            let name = format_ident!("at{place}");
            quote!(if #name >= #length { continue; })
        });
        let sites = places.iter().map(|place| {
            let (name, site) = (format_ident!("q{place}"), format_ident!("at{place}"));
            quote!(let ::core::option::Option::Some(#name) = q.get(#site) else { continue };)
        });
        let mut statement = quote!(#(#indices)* #(#fields)* #(#sites)* #body);
        for (depth, (from, to)) in ranges.iter().enumerate().rev() {
            let (index, from, to) = (format_ident!("i{depth}"), linear(*from, power), linear(*to, power));
            statement = quote!(for #index in #from..#to { #statement });
        }
        match ranges.is_empty() {
            // what is read is asked for in a loop
            true => quote!(for _ in 0..1 { #statement }),
            false => statement,
        }
    }

    /// The implementation of the trait `Clebsch` for all sites together.
    fn whole_power(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let (ident, name, length) = (&power.item.ident, power.item.ident.to_string(), &power.length);
        let (point, element, momentum) = (self.configuration_type(), self.element_type(), self.momentum_type());
        let is_second = self.model.order == Order::Second && !power.terms.is_empty();
        let impulse = if is_second { quote!([#momentum; #length]) } else { quote!(()) };
        let is_timed = self.is_timed();
        let time = if is_timed { quote!(#private::Clock<#scalar>) } else { quote!(()) };
        let order = self.model.order.number();
        let derivation = super::derivation(self.program);
        let checks = self.checks_of_terms(power);
        let (kick, step) = match (power.terms.is_empty(), is_second) {
            (true, _) => {
                (quote!(), quote!(#private::Power::power_drift(self, constants, t, q, mu).map(|(q, mu)| (q, mu, ()))))
            }
            (false, true) => (
                quote!(#private::Power::power_kick(self, t, q, constants.part(-0.5))),
                quote!(#private::Power::power_step_of_second_order(self, constants, t, q, mu, impulse)),
            ),
            (false, false) => (quote!(), quote!(#private::Power::power_step_of_first_order(self, constants, t, q, mu))),
        };
        let (start, end) = match (power.terms.is_empty(), is_second) {
            (true, _) => (quote!(0.0), quote!(0.0)),
            (false, true) => (quote!(-0.5), quote!(-0.5)),
            (false, false) => (quote!(0.0), quote!(-1.0)),
        };
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Clebsch for #ident<#arguments> #predicates {
                type Scalar = #scalar;
                type Configuration = [#point; #length];
                type Element = [#element; #length];
                type Momentum = [#momentum; #length];
                type MomentumMatrix = [#element; #length];
                type Impulse = #impulse;
                type Input = ();
                type Time = #time;
                type Constants = #private::PowerConstants<#scalar, <<Self as #private::Power<#length>>::Site as #krate::Clebsch>::Constants>;

                const NAME: &'static ::core::primitive::str = #name;
                const ORDER: ::core::primitive::u32 = #order;
                const DERIVATION: &'static ::core::primitive::str = #derivation;

                /// Checks the parameters and computes what no step changes.
                fn constants(&self, h: #scalar) -> ::core::result::Result<Self::Constants, #krate::Error> {
                    #checks
                    #private::Power::power_constants(self, h)
                }
                /// The action, site by site.
                fn act(&self, f: &Self::Element, q: &Self::Configuration) -> Self::Configuration {
                    #private::Power::act_on_sites(self, f, q)
                }
                /// The momentum map of the cotangent lift, site by site.
                fn momentum_map(&self, q: &Self::Configuration, p: &Self::Configuration) -> Self::Momentum {
                    #private::Power::momenta_of(self, q, p)
                }
                /// The coadjoint action, site by site.
                fn coadjoint(&self, f: &Self::Element, mu: &Self::Momentum) -> Self::Momentum {
                    #private::Power::coadjoint_of_sites(self, f, mu)
                }
                /// The discrete Legendre transform: that of each site, less its kick at the start.
                fn legendre(&self, h: #scalar, t: #scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum {
                    #private::Power::power_legendre(self, h, t, q, f, #start)
                }
                /// The discrete Legendre transform: that of each site, and its kick at the end.
                fn legendre_next(&self, h: #scalar, t: #scalar, q: &Self::Configuration, f: &Self::Element) -> Self::Momentum {
                    #private::Power::power_legendre_next(self, h, t, q, f, #end)
                }
                /// The group elements that are connected to the identity and have this momentum.
                fn inverse_legendre(
                    &self,
                    constants: &Self::Constants,
                    t: #scalar,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                ) -> ::core::result::Result<Self::Element, #krate::Error> {
                    #private::Power::power_inverse_legendre(self, constants, t, q, mu, #start)
                }
                /// The kick that the end of a step and the start of the next share.
                fn impulse(
                    &self,
                    constants: &Self::Constants,
                    t: #scalar,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                ) -> Self::Impulse {
                    let _ = (constants, t, q, mu);
                    #kick
                }
                /// By how much the momentum of a state is ahead of the momentum at its configuration.
                fn stagger(&self, h: #scalar, t: #scalar, q: &Self::Configuration) -> Self::Momentum {
                    #private::Power::power_stagger(self, h, t, q, #start, #end)
                }
                /// One step of the discrete Euler–Poincaré representation.
                #[inline]
                fn step(
                    &self,
                    constants: &Self::Constants,
                    t: #scalar,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                    impulse: &Self::Impulse,
                    u: &Self::Input,
                ) -> ::core::result::Result<(Self::Configuration, Self::Momentum, Self::Impulse), #krate::Error> {
                    #step
                }
                /// One step of the discrete symmetric representation.
                fn step_symmetric(
                    &self,
                    constants: &Self::Constants,
                    t: #scalar,
                    q: &Self::Configuration,
                    p: &Self::Configuration,
                ) -> ::core::result::Result<(Self::Configuration, Self::Configuration), #krate::Error> {
                    #private::Power::power_step_symmetric(self, constants, t, q, p, #start, #end)
                }
                /// The potential energy, a sum over sites.
                fn potential(&self, t: #scalar, q: &Self::Configuration) -> #scalar {
                    #private::Power::potential_of_sites(self, t, q)
                }
                /// The kinetic energy of all sites.
                fn kinetic_energy(
                    &self,
                    constants: &Self::Constants,
                    t: #scalar,
                    q: &Self::Configuration,
                    mu: &Self::Momentum,
                ) -> #scalar {
                    #private::Power::power_kinetic_energy(self, constants, t, q, mu)
                }
                /// The representing matrices of a momentum, site by site.
                fn momentum_matrix(mu: &Self::Momentum) -> Self::MomentumMatrix {
                    <Self as #private::Power<#length>>::matrices_of(mu)
                }
                /// The components of a momentum, site by site.
                fn momentum_components(m: &Self::MomentumMatrix) -> Self::Momentum {
                    <Self as #private::Power<#length>>::components_of(m)
                }
                /// By how much q violates what the declaration promises, at the site where it does most.
                fn orbit_defect(&self, q: &Self::Configuration) -> #scalar {
                    #private::Power::power_orbit_defect(self, q)
                }
                /// The size of the component of μ that no motion of q can have.
                fn isotropy_defect(&self, q: &Self::Configuration, mu: &Self::Momentum) -> #scalar {
                    #private::Power::power_isotropy_defect(self, q, mu)
                }
                /// The momentum without that component.
                fn project_momentum(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Momentum {
                    #private::Power::projected(self, q, mu)
                }
            }
        }
    }

    /// The implementation of `Conserves` for all sites: sums of what each has, along motions that move all of them alike.
    fn conserves_of_power(&self, power: &Power<'g>, generics: &Generics) -> TokenStream {
        let Some(kernel) = &self.program.conserved else { return TokenStream::new() };
        let (krate, private, scalar) = (&self.paths.krate, &self.paths.private, &self.paths.scalar);
        let Generics { parameters, arguments, predicates } = generics;
        let ident = &power.item.ident;
        let names = self.program.formulas.symmetries.conserved.iter().map(|momentum| momentum.name.as_str());
        let count = Literal::usize_unsuffixed(self.program.formulas.symmetries.conserved.len());
        let scope = self.scope_of_system();
        let (locals, entries) = (locals(&scope, kernel), &kernel.outputs[0].1);
        let added = entries.iter().enumerate().map(|(k, entry)| {
            let (k, value) = (Literal::usize_unsuffixed(k), scope.code(entry, false));
            quote!(sum[#k] += #value;)
        });
        let formulas = self.program.formulas.formulas_of_conserved();
        let documentation = docs::formulas("The momenta that no step changes, sums over all sites.", &formulas, None);
        quote! {
            #[automatically_derived]
            impl<#parameters> #krate::Conserves for #ident<#arguments> #predicates {
                type Conserved = #private::Conserved<#scalar, #count>;

                #documentation
                fn conserved(&self, q: &Self::Configuration, mu: &Self::Momentum) -> Self::Conserved {
                    let mut sum = [<#scalar as #private::Zero>::zero(); #count];
                    for (q, mu) in ::core::iter::zip(q, mu) {
                        #locals
                        #(#added)*
                    }
                    #private::Conserved::new([#(#names),*], sum)
                }
            }
        }
    }

    /// Checks of the fields that terms read.
    fn checks_of_terms(&self, power: &Power<'g>) -> TokenStream {
        let private = &self.paths.private;
        let mut checked: Vec<&str> = Vec::new();
        let mut checks = Vec::new();
        // sites check what they have copies of, but for what differs from site to site
        let of_sites = self.model.parameters.iter().zip(&power.copied).filter(|(parameter, _)| parameter.per_site);
        let of_terms = power.parameters.iter().map(|parameter| (parameter, &parameter.field));
        for (parameter, field) in of_terms.chain(of_sites) {
            if checked.contains(&parameter.name.as_str()) {
                continue;
            }
            checked.push(&parameter.name);
            let name = &parameter.name;
            checks.push(quote!(#private::check_finite(#name, &self.#field)?;));
            let Some(promise) = parameter.promise else { continue };
            let leaves = parameter.leaves.iter().map(|leaf| {
                // the place of an entry is every site here
                let access = leaf.accessor.strip_prefix('[').filter(|rest| rest.starts_with("at"));
                let access =
                    accessor(access.and_then(|rest| rest.split_once(']')).map_or(&leaf.accessor, |(_, rest)| rest));
                match promise {
                    Promise::Symmetric => quote!(#private::check_symmetric(#name, &entry #access)?;),
                    Promise::Diagonal => quote!(#private::check_diagonal(#name, &entry #access)?;),
                    Promise::Unit => quote!(#private::check_unit(#name, &entry #access)?;),
                }
            });
            let entries =
                if parameter.per_site { quote!(&self.#field) } else { quote!(::core::slice::from_ref(&self.#field)) };
            checks.push(quote!(for entry in #entries { #(#leaves)* }));
        }
        quote!(#(#checks)*)
    }
}

/// The place whose entry of a field a term reads.
fn place_of(parameter: &Parameter<'_>) -> Option<usize> {
    let accessor = &parameter.leaves.first()?.accessor;
    accessor.strip_prefix("[at")?.split_once(']')?.0.parse().ok()
}

/// A linear expression in the indices and N, as a signed number.
fn linear(expr: Expr<'_>, power: &Power<'_>) -> TokenStream {
    let graph = expr.graph();
    let number = |value: Rational| {
        let value = value.parts().map_or(0, |(numerator, _)| numerator);
        Literal::isize_unsuffixed(value as isize)
    };
    let (mut rest, mut terms) = (expr, Vec::new());
    for symbol in expr.symbols() {
        let name = match symbol.as_symbol().map(|data| data.role) {
            Some(Role::Site(depth)) => {
                let index = format_ident!("i{depth}");
                quote!(#index)
            }
            _ => {
                let length = &power.length;
                quote!((#length as ::core::primitive::isize))
            }
        };
        let coefficient = expr.gradient(symbol).as_number().unwrap_or_else(|| integer(0));
        terms.push(match coefficient == integer(1) {
            true => name,
            false => {
                let coefficient = number(coefficient);
                quote!(#coefficient * #name)
            }
        });
        rest = rest.substitute(&[(symbol, graph.integer(0))]);
    }
    let constant = rest.as_number().unwrap_or_else(|| integer(0));
    if terms.is_empty() || constant != integer(0) {
        let constant = number(constant);
        terms.push(quote!(#constant));
    }
    quote!(#(#terms)+*)
}
