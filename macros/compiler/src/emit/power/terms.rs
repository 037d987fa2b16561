//! The terms that tie sites together: their sum, and its gradient, added up term by term or gathered site by site.

use clebsch_symbolic::{Expr, Role, Shape};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use crate::derive::{Home, Id, SiteTerm, Stencil};
use crate::emit::Emitter;
use crate::emit::code::{Scope, accessor, grid, locals};
use crate::lower::{Code, Kernel};
use crate::model::{Configuration, Leaf, Linear, Parameter, Power, SiteIndex};

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
    /// The statements that sum up the terms of the potential.
    pub(super) fn potential_of_power(&self, power: &Power<'g>) -> TokenStream {
        let scope = self.scope_of_system();
        let terms = self.program.formulas.links.iter().enumerate().map(|(number, link)| {
            let kernel = self.program.kernel(Id::Term(number));
            let (locals, value) = (locals(&scope, kernel), scope.code(&kernel.outputs[0].1[0], false));
            let places: Vec<usize> = link.gradient.iter().map(|(place, _)| *place).collect();
            self.loops(power, &link.term.ranges, &places, kernel, quote!(#locals sum += #value;))
        });
        quote!(#(#terms)*)
    }

    /// The method that goes through the terms and adds what each has for its sites.
    pub(super) fn added_gradient(&self, power: &Power<'g>, point: &TokenStream) -> TokenStream {
        let (scalar, length, scope) = (&self.paths.scalar, &power.length, self.scope_of_system());
        let term = |(number, link): (usize, &SiteTerm<'g>)| {
            let gradient = self.program.kernel(Id::TermGradients(number));
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
        let terms = self.program.formulas.links.iter().enumerate().map(term);
        quote! {
            /// Adds the gradient of the potential, a covector for each site.
            fn add_gradient(&self, t: #scalar, q: &[#point; #length], gradient: &mut [#point; #length]) {
                let _ = (t, q, &gradient);
                #(#terms)*
            }
        }
    }

    /// The method that gathers the gradient of one site from the terms that read it.
    pub(super) fn gathered_gradient(
        &self,
        power: &Power<'g>,
        stencil: &Stencil<'g>,
        point: &TokenStream,
    ) -> TokenStream {
        let (private, scalar, length) = (&self.paths.private, &self.paths.scalar, &power.length);
        let (scope, common) = (self.scope_of_system(), self.program.kernel(Id::SiteGradient));
        let places = [power.places.as_slice(), &stencil.places].concat();
        let of_all = {
            let (locals, added) = (
                locals(&scope, common),
                self.added(&scope, &stencil.gradient, &common.outputs, quote!(gradient), quote!(=)),
            );
            let head = Head { own: None, index: quote!(let i0 = site as ::core::primitive::isize;), guard: None };
            (!added.is_empty()).then(|| self.at_site(power, &places, head, common, quote!(#locals #(#added)*)))
        };
        let others = stencil.others.iter().filter_map(|&(term, number)| {
            let link = &self.program.formulas.links[term];
            let (place, slopes) = &link.gradient[number];
            let kernel = self.program.kernel(Id::TermGradient(term, *place));
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
                #of_all
                #(#others)*
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
        places: &[SiteIndex<'g>],
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
            let read = |leaf: &Leaf<'g>| {
                let role = leaf.symbol.as_symbol().map(|data| data.role);
                kernel.inputs().iter().any(|input| Some(input.role) == role)
            };
            parameter.leaves.iter().any(read).then(|| place_of(parameter))?
        });
        of_fields.collect()
    }

    /// The statement that computes the index of a place.
    fn index_of(&self, places: &[SiteIndex<'g>], power: &Power<'g>, place: usize) -> TokenStream {
        let (private, length) = (&self.paths.private, &power.length);
        let (name, SiteIndex { index, wraps }) = (format_ident!("at{place}"), &places[place]);
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
}

/// The place whose entry of a field a term reads.
fn place_of(parameter: &Parameter<'_>) -> Option<usize> {
    parameter.leaves.first()?.accessor.site()
}

/// A linear expression in the indices and N, as a signed number.
fn linear(expr: Expr<'_>, power: &Power<'_>) -> TokenStream {
    // by construction: what is not linear is refused where it is declared
    let Some(Linear { constant, sites, indices }) = Linear::of(expr) else { return quote!(0) };
    let length = &power.length;
    let index = |(depth, weight): (usize, i64)| {
        let name = format_ident!("i{depth}");
        (weight, Some(quote!(#name)))
    };
    let mut terms: Vec<(i64, Option<TokenStream>)> = indices.into_iter().enumerate().map(index).collect();
    terms.push((sites, Some(quote!((#length as ::core::primitive::isize)))));
    terms.retain(|(weight, _)| *weight != 0);
    if terms.is_empty() || constant != 0 {
        terms.push((constant, None));
    }
    terms.into_iter().fold(TokenStream::new(), |sum, (weight, name)| {
        let number = Literal::u64_unsuffixed(weight.unsigned_abs());
        let term = match name {
            Some(name) if weight.unsigned_abs() == 1 => name,
            Some(name) => quote!(#number * #name),
            None => quote!(#number),
        };
        match (sum.is_empty(), weight < 0) {
            (true, false) => term,
            (true, true) => quote!(-#term),
            (false, false) => quote!(#sum + #term),
            (false, true) => quote!(#sum - #term),
        }
    })
}
