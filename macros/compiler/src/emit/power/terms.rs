//! The terms that tie sites together: their sum, and its gradient, added up term by term or gathered site by site.

use std::collections::BTreeSet;

use clebsch_symbolic::{Elements, Expr, IntoList, Role, Shape, joined};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::{Home, Id, JointRows, SiteTerm, Stencil};
use crate::emit::Emitter;
use crate::emit::scope::{Scope, size};
use crate::lower::{Code, Kernel};
use crate::model::{Joint, Leaf, Linear, Power, SiteIndex};

/// The data for the code of all terms.
pub(super) struct Terms<'e, 'a, 'g> {
    emitter: &'e Emitter<'a, 'g>,
    power: &'e Power<'g>,
    scope: Scope<'e, 'g>,
}

impl<'e, 'a, 'g> Terms<'e, 'a, 'g> {
    pub(super) fn new(emitter: &'e Emitter<'a, 'g>, power: &'e Power<'g>) -> Terms<'e, 'a, 'g> {
        Terms { emitter, power, scope: emitter.scope_of_system() }
    }

    /// The statements that sum up the terms of the potential.
    pub(super) fn potential(&self) -> TokenStream {
        let terms = self.emitter.formulas.links.iter().enumerate().map(|(number, link)| {
            let kernel = self.emitter.program.kernel(Id::Term(number));
            let value = self.scope.scalar(kernel, 0);
            self.loops(link, kernel, quote!(sum += #value;))
        });
        terms.collect()
    }

    /// The method that goes through the terms and adds the share of each to the gradients of its sites.
    pub(super) fn added_gradient(&self) -> TokenStream {
        let length = &self.emitter.length;
        let terms = self.emitter.formulas.links.iter().enumerate().map(|(number, link)| {
            let kernel = self.emitter.program.kernel(Id::TermGradients(number));
            let outputs = kernel.outputs.chunks(self.emitter.model.configurations.len());
            let added = link.gradient.iter().zip(outputs).filter_map(|((place, slopes), outputs)| {
                let (site, added) = (site(*place), self.added(slopes, outputs, quote!((*gradient)), quote!(+=))?);
                let gradient = quote!(runtime::Some(gradient));
                Some(quote!(if let #gradient = gradient.get_mut(#site) { #added }))
            });
            self.loops(link, kernel, quote!(#(#added)*))
        });
        quote! {
            /// Adds the gradient of the potential, a covector for each site.
            fn add_gradient(&self, t: T, q: &[Q; #length], gradient: &mut [Q; #length]) {
                let _ = (t, q, &gradient);
                #(#terms)*
            }
        }
    }

    /// The method that gathers the gradient of one site from the terms that read it.
    pub(super) fn gathered_gradient(&self, stencil: &Stencil<'g>) -> TokenStream {
        let length = &self.emitter.length;
        let places = [self.power.places.as_slice(), &stencil.places].concat();
        let common = self.emitter.program.kernel(Id::SiteGradient);
        let index = quote!(let i0 = site as ::core::primitive::isize;);
        let of_all = self.added(&stencil.gradient, &common.outputs, quote!(gradient), quote!(=));
        let of_all = of_all.map(|added| self.at_site((&places, None), &index, common, added));
        let others = stencil.others.iter().filter_map(|&(term, number)| {
            let link = &self.emitter.formulas.links[term];
            let (place, slopes) = &link.gradient[number];
            let kernel = self.emitter.program.kernel(Id::TermGradient(term, *place));
            let added = self.added(slopes, &kernel.outputs, quote!(gradient), quote!(+=))?;
            let home = link.homes(self.power)?.into_iter().nth(number)?;
            let found = self.found(*place, &home, &link.term.ranges);
            Some(self.at_site((&places, Some(*place)), &found, kernel, added))
        });
        quote! {
            /// The gradient of the potential at a site, from all terms that read it.
            #[inline]
            fn gradient_at(&self, t: T, q: &[Q; #length], site: ::core::primitive::usize) -> Q {
                let _ = (t, q, site);
                let mut gradient: Q = runtime::Space::<T>::origin();
                #of_all
                #(#others)*
                gradient
            }
        }
    }

    /// A statement for the site that is the later one of a joint.
    pub(super) fn of_joint(
        &self,
        (joint, rows): (&Joint<'g>, &JointRows<'g>),
        kernel: &Kernel,
        put: TokenStream,
    ) -> TokenStream {
        let found = self.found(joint.own, &rows.home, &joint.term.ranges);
        self.at_site((&self.power.places, Some(joint.own)), &found, kernel, put)
    }

    /// Statements for all indices of a joint that closes a loop: `row` is the first of its rows. Those in `before` know the
    /// indices of its sites, and leave by a label or a word.
    pub(super) fn of_loop(
        &self,
        joint: &Joint<'g>,
        kernel: &Kernel,
        (before, put): (impl Fn(&TokenStream) -> Option<TokenStream>, TokenStream),
    ) -> TokenStream {
        let (all, first, count) = (self.power.places.as_slice(), size(joint.first), size(joint.count()));
        let places: Vec<usize> = [Some(joint.own), joint.before].into_iter().flatten().into_list();
        let indices = || -> TokenStream { places.iter().map(|&place| self.index_of(all, place)).collect() };
        let statement = |leave: TokenStream| {
            let before = before(&leave).map(|before| [indices(), before]);
            let read = self.reading((all, None), &places, kernel, leave, put.clone());
            before.into_iter().flatten().chain([read]).collect::<TokenStream>()
        };
        let Some(&(from, to)) = joint.term.ranges.first() else {
            let statement = statement(quote!(break 'term));
            return quote!('term: { let row = #first; #statement });
        };
        let [start, end] = [from, to].map(|expr| linear(expr, &self.emitter.length));
        let statement = statement(quote!(continue));
        let each = (joint.count() > 1).then(|| quote!(* #count));
        quote! {
            for i0 in #start..#end {
                let row = #first + (i0 - #start) as ::core::primitive::usize #each;
                #statement
            }
        }
    }

    /// A statement that returns the parent of a site, if this joint gives it one.
    pub(super) fn parent(&self, (joint, rows): (&Joint<'g>, &JointRows<'g>)) -> TokenStream {
        let Some(before) = joint.before else { return TokenStream::new() };
        let number = |place: usize| {
            let Linear { constant, .. } = Linear::of(self.power.places[place].index)
                .filter(|linear| linear.sites == 0 && linear.indices.is_empty())?;
            usize::try_from(constant).ok().map(size)
        };
        if let (Some(own), Some(parent)) = (number(joint.own), number(before)) {
            return quote!(if site == #own { return runtime::Some(#parent); });
        }
        let found = self.found(joint.own, &rows.home, &joint.term.ranges);
        let (name, index) = (site(before), self.index_of(&self.power.places, before));
        quote!('term: { #found #index return runtime::Some(#name); })
    }

    /// The entries of an output of a kernel, row by row.
    pub(super) fn entries(&self, kernel: &Kernel, output: usize) -> Vec<TokenStream> {
        let entries = kernel.outputs.get(output).map(|(_, entries)| entries.as_slice()).unwrap_or_default();
        entries.iter().map(|entry| self.scope.code(entry, false)).into_list()
    }

    /// The index `i0` of the term that has a site at a place, from that of the site; leaves where there is no such term.
    fn found(&self, own: usize, home: &Home<'g>, ranges: &[(Expr<'g>, Expr<'g>)]) -> TokenStream {
        let length = &self.emitter.length;
        let (Some(index), [(from, to), ..]) = (home.index, ranges) else {
            let (name, place) = (site(own), self.index_of(&self.power.places, own));
            return quote!(#place if site != #name { break 'term; });
        };
        let [from, to, moved] = [*from, *to, index].map(|expr| linear(expr, length));
        let moved = if home.wraps {
            quote!(let i0 = runtime::wrapped::<#length>(#moved) as ::core::primitive::isize;)
        } else if index.as_symbol().is_some() {
            quote!()
        } else {
            quote!(let i0 = #moved;)
        };
        let guard = (!home.is_everywhere).then(|| quote!(if !(#from..#to).contains(&i0) { break 'term; }));
        quote!(let i0 = site as ::core::primitive::isize; #moved #guard)
    }

    /// A statement for one site, with the configurations that it reads.
    fn at_site(
        &self,
        (places, own): (&[SiteIndex<'g>], Option<usize>),
        found: &TokenStream,
        kernel: &Kernel,
        added: TokenStream,
    ) -> TokenStream {
        let inputs = kernel.inputs();
        let is_read =
            |place: &usize| inputs.iter().any(|(input, _)| matches!(input.role, Role::At(at, _) if at == *place));
        let sites: Vec<usize> = (0..places.len()).filter(is_read).into_list();
        let added = self.reading((places, own), &sites, kernel, quote!(break 'term), added);
        quote!('term: { #found #added })
    }

    /// Statements of a kernel behind those that read the configurations of sites, and that leave where there is no such site. A field of an
    /// array is read by an index that is known to be inside.
    fn reading(
        &self,
        (places, own): (&[SiteIndex<'g>], Option<usize>),
        sites: &[usize],
        kernel: &Kernel,
        leave: TokenStream,
        body: TokenStream,
    ) -> TokenStream {
        let (length, locals) = (&self.emitter.length, self.scope.locals(kernel));
        let fields = self.places_of_fields(kernel).into_iter().filter(|place| !sites.contains(place));
        let fields: BTreeSet<usize> = fields.collect();
        let indices = fields.iter().chain(sites).copied().collect::<BTreeSet<usize>>().into_iter();
        let indices = indices.map(|place| {
            let name = site(place);
            if Some(place) == own { quote!(let #name = site;) } else { self.index_of(places, place) }
        });
        let fields = fields.iter().map(|&place| site(place));
        let names = sites.iter().map(|place| format_ident!("q{place}"));
        let sites = sites.iter().map(|&place| site(place));
        quote! {
            #(#indices)*
            #(if #fields >= #length { #leave; })*
            #(let runtime::Some(#names) = q.get(#sites) else { #leave };)*
            #locals
            #body
        }
    }

    /// Adds the slopes of a place to `target`, or sets it to them, leaf by leaf; `None` where all of them vanish.
    fn added(
        &self,
        slopes: &[Expr<'g>],
        outputs: &[(Shape, Vec<Code>)],
        target: TokenStream,
        operator: TokenStream,
    ) -> Option<TokenStream> {
        let leaves = self.emitter.model.configurations.iter().zip(slopes).zip(outputs);
        let mut leaves = leaves.filter(|((_, slope), _)| !slope.is_zero()).peekable();
        leaves.peek()?;
        let added = leaves.map(|((leaf, _), output)| {
            let (access, value) = (&leaf.accessor, self.scope.grid(output, leaf.is_quaternion));
            quote!(#target #access #operator #value;)
        });
        Some(added.collect())
    }

    /// The places whose entries of fields a kernel reads.
    fn places_of_fields(&self, kernel: &Kernel) -> Vec<usize> {
        let inputs = kernel.inputs();
        let is_read = |leaf: &Leaf<'g>| {
            let role = leaf.symbol.role();
            inputs.iter().any(|(input, _)| Some(input.role) == role)
        };
        let of_sites = self.power.parameters.iter().filter(|parameter| parameter.per_site);
        let read = of_sites.filter(|parameter| parameter.leaves.iter().any(is_read));
        read.filter_map(|parameter| parameter.leaves.first()?.accessor.site()).into_list()
    }

    /// The statement that computes the index of a place.
    fn index_of(&self, places: &[SiteIndex<'g>], place: usize) -> TokenStream {
        let length = &self.emitter.length;
        let (name, SiteIndex { index, wraps }) = (site(place), &places[place]);
        let index = linear(*index, length);
        if *wraps {
            quote!(let #name = runtime::wrapped::<#length>(#index);)
        } else {
            quote!(let #name = (#index) as ::core::primitive::usize;)
        }
    }

    /// A statement for all indices of a term, with the configurations that it reads.
    fn loops(&self, link: &SiteTerm<'g>, kernel: &Kernel, body: TokenStream) -> TokenStream {
        let places: Vec<usize> = link.gradient.each(|(place, _)| *place);
        let statement = self.reading((&self.power.places, None), &places, kernel, quote!(continue), body);
        let ranges = link.term.ranges.iter().enumerate();
        if link.term.ranges.is_empty() {
            // the statement says `continue`, which needs a loop
            return quote!(for _ in 0..1 { #statement });
        }
        ranges.rev().fold(statement, |statement, (depth, (from, to))| {
            let length = &self.emitter.length;
            let (index, from, to) = (format_ident!("i{depth}"), linear(*from, length), linear(*to, length));
            quote!(for #index in #from..#to { #statement })
        })
    }
}

/// The name of the index of the site at a place.
pub(super) fn site(place: usize) -> Ident {
    format_ident!("at{place}")
}

/// A linear expression in the indices and N, as a signed number.
fn linear(expr: Expr<'_>, length: &Option<TokenStream>) -> TokenStream {
    // by construction: an expression that is not linear is refused where it is declared
    let Some(Linear { constant, sites, indices }) = Linear::of(expr) else { return quote!(0) };
    let names = indices.into_iter().enumerate().map(|(depth, weight)| (weight, format!("i{depth}")));
    let names = names.chain([(sites, format!("({} as ::core::primitive::isize)", quote!(#length)))]);
    let mut terms: Vec<(i64, String)> = names.filter(|(weight, _)| *weight != 0).into_list();
    if terms.is_empty() || constant != 0 {
        terms.push((constant, String::new()));
    }
    let written = |(weight, name): (i64, String)| match (weight.unsigned_abs(), name.is_empty()) {
        (size, true) => (weight < 0, size.to_string()),
        (1, false) => (weight < 0, name),
        (size, false) => (weight < 0, format!("{size} * {name}")),
    };
    // by construction: names, numbers and operators are tokens
    joined(terms.into_iter().map(written), '-').parse().unwrap_or_default()
}
