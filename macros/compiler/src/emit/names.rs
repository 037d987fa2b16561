//! The names that an expansion introduces beside the user's: they give way to what the user's item already calls so.

use std::collections::BTreeSet;

use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident};
use syn::Lifetime;

use crate::model::{Opaque, Power, ScalarType, System};

/// Names of generated types and of their lifetime: those of the user's item and what it reads are taken.
pub struct Names(BTreeSet<String>);

impl Names {
    /// The names for a model and its methods.
    pub fn new<'a>(
        model: &System<'_>,
        (power, opaque): (Option<&Power<'_>>, Option<&Opaque>),
        methods: impl Iterator<Item = &'a Ident>,
    ) -> Names {
        let mut taken = BTreeSet::new();
        // of a power the user's struct is another item than that of a site
        for item in [&model.item].into_iter().chain(power.map(|power| &power.item)) {
            collect(item.ident.to_token_stream(), &mut taken);
            collect(item.generics.to_token_stream(), &mut taken);
            collect(item.generics.where_clause.to_token_stream(), &mut taken);
        }
        taken.extend(methods.map(Ident::to_string));
        model.constants.iter().for_each(|constant| collect(constant.path.to_token_stream(), &mut taken));
        if let Some(opaque) = opaque {
            collect(opaque.value.to_token_stream(), &mut taken);
            collect(opaque.gradient.to_token_stream(), &mut taken);
        }
        if let ScalarType::Parameter(ident) = &model.item.scalar {
            taken.insert(ident.to_string());
        }
        Names(taken)
    }

    /// The name, with underscores behind it as long as it is taken.
    pub fn free(&self, name: &str) -> Ident {
        let mut name = name.to_string();
        while self.0.contains(&name) {
            name.push('_');
        }
        format_ident!("{name}")
    }

    /// The lifetime of references to the user's struct.
    pub fn lifetime(&self) -> Lifetime {
        Lifetime { apostrophe: Span::call_site(), ident: self.free("clebsch") }
    }

    /// The struct of an equation.
    pub fn equation(&self, suffix: &str, number: usize) -> Ident {
        let suffix = match suffix {
            "_first" => "First",
            "_adjoint" => "Adjoint",
            "_whole" => "Whole",
            _ => "",
        };
        self.free(&format!("Equation{suffix}{}", number + 1))
    }
}

/// All identifiers of some tokens; those of lifetimes too, without their quote.
fn collect(tokens: TokenStream, taken: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(ident) => drop(taken.insert(ident.to_string())),
            TokenTree::Group(group) => collect(group.stream(), taken),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}
