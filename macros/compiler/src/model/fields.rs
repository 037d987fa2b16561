//! Fields that closures read: their types, their scalar, their symbols.

use std::collections::BTreeMap;

use clebsch_symbolic::{Graph, Property, Role, Shape};
use proc_macro2::{Span, TokenStream, TokenTree};
use quote::ToTokens;
use syn::ext::IdentExt;
use syn::{Generics, Type};

use super::power;
use super::scalar::Agreement;
use super::sizes::{ENTRIES, size, type_parameter};
use super::value::{Each, PerSite, Value};
use super::vectors::{hint, last_segment, vectors};
use super::{Access, Layout, Leaf, Parameter, Promise, ScalarType};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{Declaration, Field, spell_type};

/// What closures can read.
pub(super) struct Fields<'g> {
    /// Each field by name; `None` if no closure reads it, or if its type has an error that was reported.
    known: BTreeMap<String, Option<Value<'g>>>,
    /// The fields that are read.
    pub parameters: Vec<Parameter<'g>>,
    /// The scalar of the system.
    pub scalar: ScalarType,
}

impl<'g> Fields<'g> {
    /// No fields at all.
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

    /// The names of all fields.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.known.keys().map(String::as_str)
    }
}

/// The type of a field that is read.
struct FieldType<'t> {
    structure: Layout,
    leaves: usize,
    shape: Shape,
    is_scalar: bool,
    scalar: Option<&'t Type>,
    /// Whether there is one for each site of a power.
    per_site: bool,
}

/// Reads the fields that closures use, and settles the scalar of the system.
pub(super) fn read<'g>(
    graph: &'g Graph,
    declaration: &Declaration,
    spaces: &[Option<&Type>],
    sites: Option<&syn::Ident>,
    diagnostics: &mut Diagnostics,
) -> Fields<'g> {
    let used = first_uses(declaration);
    let mut scalar = Agreement::new(declaration, diagnostics);
    for ty in spaces.iter().flatten() {
        scalar.meet(ty, "the configuration", diagnostics);
    }
    let (mut known, mut parameters, mut leaf_count) = (BTreeMap::new(), Vec::new(), 0);
    for field in &declaration.fields {
        let name = field.name();
        let Some(&first_use) = used.get(&name) else {
            known.insert(name, None);
            continue;
        };
        let entry = power::array(&field.ty, &declaration.generics)
            .filter(|(length, _)| Some(*length) == sites)
            .map(|(_, entry)| entry);
        let parameter = match field_type(entry.unwrap_or(&field.ty), &declaration.generics) {
            Ok(ty) => {
                if let Some(written) = ty.scalar {
                    scalar.meet(written, &format!("`{name}`"), diagnostics);
                }
                let ty = FieldType { per_site: entry.is_some(), ..ty };
                parameter(graph, field, ty, first_use, leaf_count).map_err(|error| diagnostics.push(error)).ok()
            }
            Err(error) => {
                diagnostics.push(explain(field, error));
                None
            }
        };
        let value = parameter.as_ref().map(|parameter| {
            let leaves: Vec<Value<'g>> = parameter.leaves.iter().map(|leaf| Value::Matrix(leaf.symbol)).collect();
            let value = Value::nested(&parameter.structure, &leaves);
            match parameter.per_site {
                true => Value::PerSite(PerSite { of: Each::Field(parameters.len()), own: Box::new(value) }),
                false => value,
            }
        });
        leaf_count += parameter.as_ref().map_or(0, |parameter| parameter.leaves.len());
        parameters.extend(parameter);
        known.insert(name, value);
    }
    Fields { known, parameters, scalar: scalar.settle() }
}

/// The shape of a field's type.
fn field_type<'t>(ty: &'t Type, generics: &Generics) -> Result<FieldType<'t>, Option<Diagnostic>> {
    match ty {
        Type::Array(array) => {
            let element = field_type(&array.elem, generics)?;
            let length = size(&array.len, generics).map_err(Some)?;
            let leaves = length * element.leaves;
            if leaves * element.shape.len() > ENTRIES {
                let message =
                    format!("`{}` has {} numbers, more than {ENTRIES}", spell_type(ty), leaves * element.shape.len());
                let note = "the code of a step is written out at compile time and grows with the size";
                return Err(Some(Diagnostic::new(Location::of(ty), message).note(note)));
            }
            let parts = (0..length).map(|i| element.structure.shifted(i * element.leaves)).collect();
            Ok(FieldType { structure: Layout::Array(parts), leaves, ..element })
        }
        Type::Group(group) => field_type(&group.elem, generics),
        Type::Paren(paren) => field_type(&paren.elem, generics),
        _ => {
            let leaf = |shape, is_scalar, scalar| FieldType {
                structure: Layout::Leaf(0),
                leaves: 1,
                shape,
                is_scalar,
                scalar,
                per_site: false,
            };
            if is_float(ty) || type_parameter(ty, generics).is_some() {
                return Ok(leaf(Shape::scalar(), true, Some(ty)));
            }
            match vectors(ty, generics) {
                Some(found) => found.map(|found| leaf(found.shape, false, found.scalar)).map_err(Some),
                None => Err(None),
            }
        }
    }
}

fn is_float(ty: &Type) -> bool {
    last_segment(ty)
        .is_some_and(|segment| segment.arguments.is_empty() && (segment.ident == "f64" || segment.ident == "f32"))
}

/// The error for a type that no closure can read.
fn explain(field: &Field, error: Option<Diagnostic>) -> Diagnostic {
    if let Some(error) = error {
        return error;
    }
    let text = spell_type(&field.ty);
    let name = last_segment(&field.ty).map(|segment| segment.ident.to_string()).unwrap_or_default();
    let help = match name.as_str() {
        "usize" | "u8" | "u16" | "u32" | "u64" | "i8" | "i16" | "i32" | "i64" | "isize" => {
            Some("write `f64`".to_string())
        }
        "Unit" => Some("write `#[clebsch(unit)]` before the field, and the vector itself as its type".to_string()),
        "Quaternion" | "UnitQuaternion" => {
            let field = field.name();
            Some(format!(
                "write `Vector4<f64>`, and `Quaternion::new(self.{field}.w, self.{field}.x, self.{field}.y, self.{field}.z)` in the closure"
            ))
        }
        _ if matches!(field.ty, Type::Reference(_)) => Some("keep the value itself, without `&`".to_string()),
        _ => hint(&name),
    };
    Diagnostic::new(
        Location::of(&field.ty),
        format!("a closure reads `self.{}`, and its type `{text}` has no meaning there", field.name()),
    )
    .maybe_help(help)
    .note("a field that a closure reads is a scalar, a vector, a matrix, or an array of these")
}

/// The symbols of a field.
fn parameter<'g>(
    graph: &'g Graph,
    field: &Field,
    ty: FieldType,
    first_use: Span,
    first_leaf: usize,
) -> Result<Parameter<'g>, Diagnostic> {
    let promise = field.promise.map(|(promise, _)| promise);
    if let Some((promise, span)) = field.promise {
        check_promise(promise, span, ty.shape, field)?;
    }
    let name = field.name();
    // by itself a number would be one in formulas
    let symbol_name = if name.starts_with(|c: char| c.is_ascii_digit()) { format!("self.{name}") } else { name };
    let property = match promise {
        None => Property::General,
        Some(Promise::Symmetric) => Property::Symmetric,
        Some(Promise::Diagonal) => Property::Diagonal,
        Some(Promise::Unit) => Property::Unit,
    };
    let leaf = |(position, accessor): (usize, Access)| {
        let symbol = graph.symbol(
            &format!("{symbol_name}{accessor}"),
            ty.shape,
            Role::Parameter(first_leaf + position),
            property,
        );
        Leaf { symbol, accessor, shape: ty.shape, is_scalar: ty.is_scalar }
    };
    let leaves = ty.structure.accessors().into_iter().enumerate().map(leaf).collect();
    Ok(Parameter {
        field: field.member.clone(),
        name: symbol_name,
        first_use,
        promise,
        per_site: ty.per_site,
        structure: ty.structure,
        leaves,
    })
}

/// A promise must make sense for the field's shape.
fn check_promise(promise: Promise, span: Span, shape: Shape, field: &Field) -> Result<(), Diagnostic> {
    let (fits, needs) = match promise {
        Promise::Symmetric => (shape.is_square() && !shape.is_scalar(), "only a square matrix can be symmetric"),
        Promise::Diagonal => (shape.is_square() && !shape.is_scalar(), "only a square matrix can be diagonal"),
        Promise::Unit => (shape.is_column() && !shape.is_scalar(), "only a vector can be a unit vector"),
    };
    match fits {
        true => Ok(()),
        false => {
            Err(Diagnostic::new(span, format!("`{}` is {shape}: {needs}", field.name())).help("remove the promise"))
        }
    }
}

/// Where each field is first read: `self.name` anywhere in a closure, macros included.
fn first_uses(declaration: &Declaration) -> BTreeMap<String, Span> {
    let mut uses = BTreeMap::new();
    for closure in declaration.closures() {
        collect_uses(closure.body.to_token_stream(), &mut uses);
    }
    uses
}

fn collect_uses(stream: TokenStream, uses: &mut BTreeMap<String, Span>) {
    let tokens: Vec<TokenTree> = stream.into_iter().collect();
    for (position, token) in tokens.iter().enumerate() {
        if let TokenTree::Group(group) = token {
            collect_uses(group.stream(), uses);
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
