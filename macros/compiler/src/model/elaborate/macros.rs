//! `vector![a, b, c]` and `matrix![a, b; c, d]`.

use clebsch_symbolic::{Expr, Shape};
use syn::parse::ParseStream;
use syn::{Expr as Syntax, ExprMacro, Macro, Token};

use super::super::sizes::LARGEST;
use super::super::value::Value;
use super::Elaborator;
use crate::diagnostic::{Diagnostic, Location};

impl<'g> Elaborator<'_, '_, 'g> {
    /// `vector![…]` and `matrix![…]`.
    pub(super) fn macro_call(&mut self, written: &ExprMacro) -> Option<Value<'g>> {
        self.macro_tokens(&written.mac)
    }

    pub(super) fn macro_tokens(&mut self, written: &Macro) -> Option<Value<'g>> {
        let name = written.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
        match name.as_str() {
            "vector" => self.rows(written, true),
            "matrix" => self.rows(written, false),
            _ => {
                let error = Diagnostic::new(
                    Location::of(&written.path),
                    format!("unknown macro `{name}!` in the {}", self.key),
                );
                self.error(error.help("the macros are `vector![a, b, c]` and `matrix![a, b; c, d]`"))
            }
        }
    }

    fn rows(&mut self, written: &Macro, vector: bool) -> Option<Value<'g>> {
        let rows = match read_rows(written, vector) {
            Ok(rows) => rows,
            Err(error) => return self.error(error.into()),
        };
        let columns = rows.first().map_or(0, Vec::len);
        if columns == 0 || rows.iter().any(|row| row.len() != columns) || rows.len().max(columns) > LARGEST {
            let error = Diagnostic::new(Location::of(written), "the rows have no common length between 1 and 64");
            return self.error(error.help("write `vector![a, b, c]` or `matrix![a, b; c, d]`"));
        }
        let shape = if vector { Shape::vector(columns) } else { Shape::new(rows.len(), columns) };
        let found: Vec<Option<Expr<'g>>> = rows.iter().flatten().map(|entry| self.scalar(entry)).collect();
        let found: Vec<Expr<'g>> = found.into_iter().collect::<Option<_>>()?;
        self.stack(written, shape, found)
    }
}

/// Rows separated by semicolons, entries by commas.
fn read_rows(written: &Macro, single: bool) -> syn::Result<Vec<Vec<Syntax>>> {
    let parser = |stream: ParseStream| {
        let mut rows = vec![Vec::new()];
        while !stream.is_empty() {
            let row: &mut Vec<Syntax> = rows.last_mut().ok_or_else(|| stream.error("a row"))?;
            row.push(stream.parse()?);
            match single || !stream.peek(Token![;]) {
                true if stream.is_empty() => {}
                true => drop(stream.parse::<Token![,]>()?),
                false => {
                    stream.parse::<Token![;]>()?;
                    rows.push(Vec::new());
                }
            }
        }
        rows.retain(|row| !row.is_empty());
        Ok(rows)
    };
    written.parse_body_with(parser)
}
