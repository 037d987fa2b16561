//! `vector![a, b, c]` and `matrix![a, b; c, d]`.

use clebsch_symbolic::Shape;
use syn::parse::ParseStream;
use syn::{Expr as Syntax, Macro, Token};

use super::super::sizes::LARGEST;
use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::{Diagnostic, refuse};

impl<'g> Elaborator<'_, '_, 'g> {
    /// `vector![…]` and `matrix![…]`.
    pub(super) fn macro_call(&mut self, written: &Macro) -> Option<Value<'g>> {
        let name = written.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        let is_vector = name == "vector";
        if !is_vector && name != "matrix" {
            refuse!(self, &written.path, "unknown macro `{name}!` in the {}", self.key;
                help "the macros are `vector![a, b, c]` and `matrix![a, b; c, d]`");
        }
        let rows = self.context.diagnostics.take(read_rows(written, is_vector).map_err(Diagnostic::from))?;
        let columns = rows.first().map_or(0, Vec::len);
        if columns == 0 || rows.iter().any(|row| row.len() != columns) || rows.len().max(columns) > LARGEST {
            refuse!(self, written, "the rows have no common length between 1 and 64";
                help "write `vector![a, b, c]` or `matrix![a, b; c, d]`");
        }
        let shape = if is_vector { Shape::vector(columns) } else { Shape::new(rows.len(), columns) };
        let entries = self.scalars(rows.iter().flatten())?;
        self.stack(written, shape, entries)
    }
}

/// Rows separated by semicolons, entries by commas.
fn read_rows(written: &Macro, single: bool) -> syn::Result<Vec<Vec<Syntax>>> {
    let parser = |stream: ParseStream| {
        let mut rows = vec![Vec::new()];
        while !stream.is_empty() {
            let row: &mut Vec<Syntax> = rows.last_mut().ok_or_else(|| stream.error("a row"))?;
            row.push(stream.parse()?);
            if !single && stream.peek(Token![;]) {
                stream.parse::<Token![;]>()?;
                rows.push(Vec::new());
            } else if !stream.is_empty() {
                stream.parse::<Token![,]>()?;
            }
        }
        rows.retain(|row| !row.is_empty());
        Ok(rows)
    };
    written.parse_body_with(parser)
}
