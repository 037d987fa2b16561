//! The struct of a declaration, as its library needs it.

use crate::mistake::{self, Mistake};
use clebsch_compiler::{Graph, compile, emit, parse};
use proc_macro2::Span;
use pyo3::prelude::*;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{Attribute, Fields, GenericParam, Item, ItemStruct};

/// What the library of a declaration needs to know.
#[derive(Clone, Debug, IntoPyObject)]
pub struct Declaration {
    /// The name of the struct.
    pub name: String,
    /// The fields, each with its type.
    pub fields: Vec<(String, String)>,
    /// The parameters of types and of constants, each with whether it is a constant.
    pub generics: Vec<(String, bool)>,
    /// The methods besides that of the declared dials.
    pub methods: Vec<String>,
}

impl Declaration {
    /// Reads and checks a text with one declaration.
    ///
    /// # Errors
    /// All mistakes of the stage that finds some.
    pub fn read(text: &str) -> Result<Self, Vec<Mistake>> {
        let item = item(text)?;
        let declaration = parse::parse(item.to_token_stream()).map_err(mistake::all)?;
        let graph = Graph::new();
        let program = compile(&graph, item.to_token_stream()).map_err(mistake::all)?;
        if !declaration.spaces.is_empty() {
            return Err(vec![refused(&item, FIELD)]);
        }
        if program.mechanics().is_none() {
            return Err(vec![refused(&item, STEERED)]);
        }
        let generic = |parameter: &GenericParam| match parameter {
            GenericParam::Type(own) => Some((own.ident.to_string(), false)),
            GenericParam::Const(own) => Some((own.ident.to_string(), true)),
            GenericParam::Lifetime(_) => None,
        };
        Ok(Self {
            name: item.ident.to_string(),
            fields: fields(&item)?,
            generics: item.generics.params.iter().filter_map(generic).collect(),
            methods: declaration.methods.iter().map(|method| method.name.to_string()).collect(),
        })
    }
}

/// The formulas of a declaration as an appendix in LaTeX.
///
/// # Errors
/// As [`Declaration::read`].
pub fn appendix(text: &str) -> Result<String, Vec<Mistake>> {
    let item = item(text)?;
    let graph = Graph::new();
    let program = compile(&graph, item.to_token_stream()).map_err(mistake::all)?;
    Ok(emit::appendix(&program))
}

const FIELD: &str = "a declaration with `space` is a field, and Python steps systems without sites on a grid

help: step it in Rust, by `field.grid([64]).spacing([0.1]).stepper(h)`";

const STEERED: &str = "a declaration with `dynamics` or `controls` has no momentum, and Python steps mechanical systems

help: plan it in Rust, by `system.control(h)`";

const NONE: &str = "the text has no struct with `#[derive(Clebsch)]`

help: write `#[derive(Clebsch)] #[clebsch(action = …, cost = …)] pub struct Name { … }`";

const SEVERAL: &str = "the text has more than one struct with `#[derive(Clebsch)]`

help: compile each by itself";

const UNNAMED: &str = "this struct has fields without names, and Python gives parameters by name

help: write `pub struct Name { mass: f64 }`";

/// A mistake about the struct.
fn refused(item: &ItemStruct, message: &str) -> Mistake {
    Mistake::new(message, item.ident.span(), item.ident.span())
}

/// The struct of a text that derives `Clebsch`.
fn item(text: &str) -> Result<ItemStruct, Vec<Mistake>> {
    let file = syn::parse_file(text).map_err(|error| vec![Mistake::from(error)])?;
    let derived: Vec<Item> = file.items.into_iter().filter(|item| attributes(item).iter().any(derives)).collect();
    match derived.as_slice() {
        [] => Err(vec![Mistake::new(NONE, Span::call_site(), Span::call_site())]),
        [Item::Struct(item)] => Ok(item.clone()),
        [item] => Err(parse::parse(item.to_token_stream()).map_or_else(mistake::all, |_| Vec::new())),
        [_, item, ..] => Err(vec![Mistake::new(SEVERAL, item.span(), item.span())]),
    }
}

/// The attributes of an item that `Clebsch` may stand on.
fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Struct(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        _ => &[],
    }
}

/// Whether an attribute is `#[derive(…, Clebsch, …)]`.
fn derives(attribute: &Attribute) -> bool {
    let mut found = false;
    if attribute.path().is_ident("derive") {
        // a list that does not parse is an error of rustc
        let _ = attribute.parse_nested_meta(|meta| {
            found |= meta.path.segments.last().is_some_and(|last| last.ident == "Clebsch");
            Ok(())
        });
    }
    found
}

/// The fields with their types.
fn fields(item: &ItemStruct) -> Result<Vec<(String, String)>, Vec<Mistake>> {
    match &item.fields {
        Fields::Unit => Ok(Vec::new()),
        Fields::Named(fields) => {
            let pair = |field: &syn::Field| Some((field.ident.as_ref()?.to_string(), parse::spell_type(&field.ty)));
            Ok(fields.named.iter().filter_map(pair).collect())
        }
        Fields::Unnamed(fields) => Err(vec![Mistake::new(UNNAMED, fields.span(), fields.span())]),
    }
}
