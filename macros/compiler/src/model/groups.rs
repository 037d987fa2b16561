//! The groups by name.

use clebsch_symbolic::Group;
use syn::{Generics, Type};

use super::sizes::size_argument;
use super::vectors::{arguments, last_segment, named_shape};
use crate::diagnostic::{Diagnostic, Place, nearest};
use crate::parse::spell_type;

/// How a group is made from its sizes.
#[derive(Copy, Clone)]
enum Maker {
    /// From one n, at least the first number.
    OneSize(usize, fn(usize) -> Group),
    /// Part of the language, but not of this version.
    Later,
}

/// All groups.
const GROUPS: [(&str, Maker); 11] = [
    ("SO", Maker::OneSize(2, Group::SpecialOrthogonal)),
    ("Translation", Maker::OneSize(1, Group::Translation)),
    ("SE", Maker::Later),
    ("GL", Maker::Later),
    ("SL", Maker::Later),
    ("Sp", Maker::Later),
    ("U", Maker::Later),
    ("SU", Maker::Later),
    ("Heisenberg", Maker::Later),
    ("Aff", Maker::Later),
    ("Sim", Maker::Later),
];

/// Reads a group by its name; `None` if the type has another name.
pub(super) fn group(ty: &Type, generics: &Generics) -> Option<Result<Group, Diagnostic>> {
    let segment = last_segment(ty)?;
    let &(name, maker) = GROUPS.iter().find(|(name, _)| segment.ident == name)?;
    let sizes = arguments(segment);
    let place = Place::of(ty);
    Some(match (maker, sizes.as_slice()) {
        (Maker::Later, _) => Err(later(place, &spell_type(ty))),
        (Maker::OneSize(..), [_, _]) if name == "SO" => Err(later(place, &spell_type(ty))),
        (Maker::OneSize(least, make), [size]) => size_argument(size, generics).and_then(|n| match n >= least {
            true => Ok(make(n)),
            false => Err(Diagnostic::new(place, format!("`{}` has only one element", spell_type(ty)))
                .help(format!("`{name}<n>` needs n ≥ {least}"))),
        }),
        (Maker::OneSize(..), _) => {
            Err(Diagnostic::new(place, format!("`{}` needs one size", spell_type(ty)))
                .help(format!("write `{name}<3>`")))
        }
    })
}

fn later(place: Place, text: &str) -> Diagnostic {
    Diagnostic::later(place, format!("the group `{text}`"))
        .help("the groups of this version are `SO<n>` and `Translation<n>`")
}

/// The error for a type that is no group, where a group is expected.
pub(super) fn unknown_group(ty: &Type) -> Diagnostic {
    let text = spell_type(ty);
    let place = Place::of(ty);
    let name = last_segment(ty).map(|segment| segment.ident.to_string()).unwrap_or_default();
    if let Some(shape) = named_shape(&name) {
        return match shape.is_column() {
            true => Diagnostic::new(
                place,
                format!("`{text}` is a space, but the first argument of the action is a group element"),
            )
            .help(format!("write `Translation<{}>` to shift by a vector", shape.rows)),
            false => Diagnostic::new(
                place,
                format!("`{text}` is a space, but the first argument of the action is a group element"),
            )
            .help(format!("write `SO<{}>` for rotations", shape.rows)),
        };
    }
    let error = Diagnostic::new(place, format!("unknown group `{text}`"));
    match suggestion(&name) {
        Some(suggestion) => error.help(format!("write `{suggestion}`")),
        None => error.help("the groups of this version are `SO<n>` and `Translation<n>`"),
    }
}

/// The group that a name like `SO3`, `So` or `Rotation3` most likely means.
pub(super) fn suggestion(name: &str) -> Option<String> {
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &name[base.len()..];
    let size = if digits.is_empty() { "3" } else { digits };
    let synonym = match base {
        "Rotation" | "Rot" | "Orthogonal" | "SpecialOrthogonal" => Some("SO"),
        "Isometry" => Some("SE"),
        "UnitQuaternion" => return Some("SU<2>".into()),
        "Translate" | "Shift" => Some("Translation"),
        _ => None,
    };
    let known =
        synonym.or_else(|| GROUPS.iter().map(|&(group, _)| group).find(|group| group.eq_ignore_ascii_case(base)));
    let similar = known.or_else(|| nearest(base, GROUPS.iter().map(|&(group, _)| group)).filter(|_| base.len() > 2));
    similar.map(|group| format!("{group}<{size}>"))
}
