//! Fields that closures read: their types, their scalar, their symbols.

use std::collections::BTreeMap;

use clebsch_symbolic::{Elements, Graph, IntoList, Property, Role, Shape, indexed};
use proc_macro2::{Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::{Generics, Type};

use super::arguments::sites_of;
use super::power::Length;
use super::scalar::Agreement;
use super::shapes::{ENTRIES, GROWS, hint, last_name, last_segment, plain, size, type_parameter, vectors};
use super::value::{Each, Value};
use super::{Access, Layout, Leaf, Parameter, Promise, ScalarType};
use crate::diagnostic::{Diagnostic, Diagnostics, bail, error};
use crate::parse::{Declaration, Field, spell_type};

/// The fields that closures can read.
pub(super) struct Fields<'g> {
    /// Each field by name; `None` if no closure reads it, or if its type has an error that was reported.
    known: BTreeMap<String, Option<Value<'g>>>,
    pub parameters: Vec<Parameter<'g>>,
    pub scalar: ScalarType,
}

impl<'g> Fields<'g> {
    pub fn none() -> Fields<'g> {
        Fields { known: BTreeMap::new(), parameters: Vec::new(), scalar: ScalarType::F64 }
    }

    /// The value of a field: `None` if there is no such field, `Some(None)` if it has an error of its own.
    pub fn value(&self, name: &str) -> Option<&Option<Value<'g>>> {
        self.known.get(name)
    }

    /// The number of scalars, vectors and matrices in all fields that are read.
    pub fn leaf_count(&self) -> usize {
        self.parameters.iter().map(|parameter| parameter.leaves.len()).sum()
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.known.keys().map(String::as_str)
    }
}

/// The type of a field that is read.
struct FieldType<'t> {
    structure: Layout,
    shape: Shape,
    is_scalar: bool,
    scalar: Option<&'t Type>,
}

/// Reads the fields that closures use, and settles the scalar of the system.
pub(super) fn read<'g>(
    graph: &'g Graph,
    declaration: &Declaration,
    spaces: &[&Type],
    sites: Option<&Length>,
    diagnostics: &Diagnostics,
) -> Fields<'g> {
    let bounds = declaration.control.as_ref().and_then(|control| control.bounds.as_ref());
    let (mut used, mut used_elsewhere) = (BTreeMap::new(), BTreeMap::new());
    for closure in declaration.closures() {
        let body = closure.body.to_token_stream();
        if !bounds.is_some_and(|bounds| std::ptr::eq(bounds, closure)) {
            first_uses(body.clone(), &mut used_elsewhere);
        }
        first_uses(body, &mut used);
    }
    let mut scalar = Agreement::new(declaration, diagnostics);
    spaces.iter().for_each(|ty| scalar.meet(ty, "the configuration"));
    let (mut known, mut parameters, mut leaf_count) = (BTreeMap::new(), Vec::new(), 0);
    for field in &declaration.fields {
        let name = field.name();
        let Some(&first_use) = used.get(&name) else {
            known.insert(name, None);
            continue;
        };
        let of_sites = sites_of(&field.ty, &declaration.generics).filter(|(length, _)| Some(length) == sites);
        let entry = of_sites.map(|(_, entry)| entry);
        let ty = field_type(entry.unwrap_or(&field.ty), &declaration.generics);
        let ty = diagnostics.take(ty.map_err(|error| error.unwrap_or_else(|| explain(field))));
        if let Some(written) = ty.as_ref().and_then(|ty| ty.scalar) {
            scalar.meet(written, &format!("`{name}`"));
        }
        let parameter = ty.and_then(|ty| {
            let parameter = diagnostics.take(parameter(graph, field, ty, first_use, leaf_count))?;
            let is_limit = !used_elsewhere.contains_key(&name);
            Some(Parameter { per_site: entry.is_some(), is_limit, ..parameter })
        });
        let value = parameter.as_ref().map(|parameter| {
            let leaves: Vec<Value<'g>> = parameter.leaves.each(|leaf| Value::Matrix(leaf.symbol));
            let value = Value::nested(&parameter.structure, &leaves);
            value.of_each(Each::Field(parameters.len()), parameter.per_site)
        });
        leaf_count += parameter.as_ref().map_or(0, |parameter| parameter.leaves.len());
        parameters.extend(parameter);
        known.insert(name, value);
    }
    Fields { known, parameters, scalar: scalar.found.map_or(ScalarType::F64, |(scalar, _)| scalar) }
}

/// The shape of a field's type; an error without a message for a type that no closure can read.
fn field_type<'t>(ty: &'t Type, generics: &Generics) -> Result<FieldType<'t>, Option<Diagnostic>> {
    match plain(ty) {
        Type::Array(array) => {
            let element = field_type(&array.elem, generics)?;
            let length = size(&array.len, generics).map_err(Some)?;
            let leaves = element.structure.leaves();
            let numbers = length * leaves * element.shape.len();
            if numbers > ENTRIES {
                bail!(ty, "`{}` has {numbers} numbers, more than {ENTRIES}", spell_type(ty); note "{GROWS}");
            }
            let parts = indexed(length, |i| element.structure.shifted(i * leaves));
            Ok(FieldType { structure: Layout::Array(parts), ..element })
        }
        ty => {
            let is_float = last_segment(ty).is_some_and(|segment| {
                segment.arguments.is_empty() && (segment.ident == "f64" || segment.ident == "f32")
            });
            let is_scalar = is_float || type_parameter(ty, generics).is_some();
            let (shape, scalar) = if is_scalar {
                (Shape::scalar(), Some(ty))
            } else {
                vectors(ty, generics).ok_or(None)?.map_err(Some)?
            };
            Ok(FieldType { structure: Layout::Leaf(0), shape, is_scalar, scalar })
        }
    }
}

/// The error for a type that no closure can read.
fn explain(field: &Field) -> Diagnostic {
    let (text, ty, name) = (spell_type(&field.ty), last_name(&field.ty), field.name());
    let help = match ty.as_str() {
        "usize" | "u8" | "u16" | "u32" | "u64" | "i8" | "i16" | "i32" | "i64" | "isize" => Some("write `f64`".into()),
        "Unit" => Some("write `#[clebsch(unit)]` before the field, and the vector itself as its type".into()),
        "Quaternion" | "UnitQuaternion" => Some(format!(
            "write `Vector4<f64>`, and `Quaternion::new(self.{name}.w, self.{name}.x, self.{name}.y, self.{name}.z)` in the closure"
        )),
        "Option" => Some("write the number itself, with a value that stands for none, as 0".into()),
        "bool" => Some("write `f64`, with the values 0 and 1".into()),
        "String" | "str" => Some("write a number".into()),
        _ if matches!(field.ty, Type::Reference(_)) => Some("keep the value itself, without `&`".into()),
        _ => hint(&ty).or_else(|| {
            Some(format!("write the numbers of `{text}` as fields of this struct; if it is another name of a type, write that type, as `f64`"))
        }),
    };
    error!(&field.ty, "a closure reads `self.{name}`, and its type `{text}` has no meaning there")
        .maybe_help(help)
        .note("a field that a closure reads is a scalar, a vector, a matrix, or an array of these")
}

fn parameter<'g>(
    graph: &'g Graph,
    field: &Field,
    ty: FieldType,
    first_use: Span,
    first_leaf: usize,
) -> Result<Parameter<'g>, Diagnostic> {
    let shape = ty.shape;
    let name = field.name();
    let property = match field.promise {
        None => Property::General,
        Some((promise, span)) => {
            let (property, fits, needs) = match promise {
                Promise::Symmetric => (Property::Symmetric, shape.is_square(), "square matrix can be symmetric"),
                Promise::Diagonal => (Property::Diagonal, shape.is_square(), "square matrix can be diagonal"),
                Promise::Unit => (Property::Unit, shape.is_column(), "vector can be a unit vector"),
            };
            if !fits || shape.is_scalar() {
                bail!(span, "`{name}` is {shape}: only a {needs}"; help "remove the promise");
            }
            property
        }
    };
    // by itself a number would be one in formulas
    let name = if name.starts_with(|c: char| c.is_ascii_digit()) { format!("self.{name}") } else { name };
    let leaf = |(position, accessor): (usize, Access)| {
        let role = Role::Parameter(first_leaf + position);
        let symbol = graph.symbol(&format!("{name}{accessor}"), shape, role, property);
        Leaf { symbol, accessor, shape, is_scalar: ty.is_scalar }
    };
    let leaves = ty.structure.accessors().into_iter().enumerate().map(leaf).into_list();
    Ok(Parameter {
        field: field.member.clone(),
        name,
        first_use,
        promise: field.promise.map(|(promise, _)| promise),
        per_site: false,
        is_limit: false,
        structure: ty.structure,
        leaves,
    })
}

/// Where each field is first read: `self.name` anywhere in a closure, macros included.
fn first_uses(stream: TokenStream, uses: &mut BTreeMap<String, Span>) {
    let tokens: Vec<TokenTree> = stream.into_iter().into_list();
    for (position, token) in tokens.iter().enumerate() {
        if let TokenTree::Group(group) = token {
            first_uses(group.stream(), uses);
            continue;
        }
        let [TokenTree::Ident(this), TokenTree::Punct(dot), field, ..] = &tokens[position..] else { continue };
        if this != "self" || dot.as_char() != '.' {
            continue;
        }
        let name = match field {
            TokenTree::Ident(ident) => ident.unraw().to_string(),
            // `self.0.1` is `self` `.` `0.1`
            TokenTree::Literal(number) => number.to_string().split('.').next().unwrap_or_default().to_string(),
            _ => continue,
        };
        uses.entry(name).or_insert(field.span());
    }
}
