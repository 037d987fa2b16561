//! A group by an equation: the identity satisfies it, its Lie algebra is the kernel of the derivative there, and the equation holds
//! along the group that this algebra generates.

use clebsch_symbolic::{Expr, Graph, Group, Rational, Shape, Sparse, Zero, reduce};

use super::super::closures::tail;
use super::super::elaborate::shortened;
use super::super::scope::{Scope, check_reserved};
use super::super::value::Value;
use super::super::vectors::vectors;
use super::kernel::kernel;
use super::{bracket_with, check_size, elaborate, empty_scope, fields_in, follow, not_literal, sparse, spell_matrix};
use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::parse::{Closure, Pattern, spell, spell_type};

/// Reads `|F: Matrix4| a == b`.
pub(super) fn read(graph: &Graph, name: &str, closure: &Closure) -> Result<Group, Vec<Diagnostic>> {
    let n = size(name, closure)?;
    let key = format!("equation of `{name}`");
    if let Some((place, field)) = fields_in(&closure.body) {
        return Err(vec![not_literal(place, &key, &format!("`{field}`"))]);
    }
    let pattern = &closure.arguments[0].pattern;
    let symbol = graph.element_symbol(&pattern.spell(), n);
    let scope = scope(pattern, symbol)?;
    let sides = elaborate(graph, &key, scope, |elaborator| elaborator.equation(&closure.body))?;
    let equation =
        GroupEquation { graph, name, symbol, place: tail(&closure.body).0, text: spell(tail(&closure.body).1) };
    let sides = equation.sides(&sides.0, &sides.1).map_err(|error| vec![error])?;
    equation.group(&sides).map_err(|error| vec![error])
}

/// The size of the matrices that the only argument stands for.
fn size(name: &str, closure: &Closure) -> Result<usize, Vec<Diagnostic>> {
    let help = "write `|F: Matrix3| F.transpose() * F == I`";
    let [argument] = closure.arguments.as_slice() else {
        let message = format!("the equation of `{name}` has {} arguments, not one", closure.arguments.len());
        return Err(vec![Diagnostic::new(closure.head, message).help(help)]);
    };
    let Some(ty) = &argument.ty else {
        let message = format!("`{}` has no type in the equation of `{name}`", argument.pattern.spell());
        return Err(vec![Diagnostic::new(argument.pattern.place(), message).help(help)]);
    };
    match vectors(ty, &syn::Generics::default()) {
        Some(Ok(found)) if found.shape.is_square() => {
            check_size(name, found.shape.rows, Location::of(ty).start())?;
            Ok(found.shape.rows)
        }
        Some(Err(error)) => Err(vec![error]),
        _ => {
            let message = format!("`{}` is no space of square matrices", spell_type(ty));
            Err(vec![Diagnostic::new(Location::of(ty), message).help("write `Matrix3` or `SMatrix<8, 8>`")])
        }
    }
}

/// The scope with the matrix alone.
fn scope<'g>(pattern: &Pattern, symbol: Expr<'g>) -> Result<Scope<'g>, Vec<Diagnostic>> {
    let mut diagnostics = Diagnostics::new();
    let mut scope = empty_scope();
    pattern.names().iter().for_each(|ident| {
        check_reserved(ident, "an argument", &mut diagnostics);
    });
    scope.add_argument(pattern, Some(Value::Matrix(symbol)), &mut diagnostics);
    if diagnostics.is_empty() { Ok(scope) } else { Err(diagnostics.into_vec()) }
}

/// An equation between expressions in the symbol.
struct GroupEquation<'a, 'g> {
    graph: &'g Graph,
    name: &'a str,
    symbol: Expr<'g>,
    place: Location,
    text: String,
}

impl<'g> GroupEquation<'_, 'g> {
    /// The pairs of matrices that are to be equal.
    fn sides(&self, left: &Value<'g>, right: &Value<'g>) -> Result<Vec<(Expr<'g>, Expr<'g>)>, Diagnostic> {
        let identity = |scale: Expr<'g>, shape: Shape| scale * self.graph.identity(shape.rows);
        let square = |shape: Shape| shape.is_square() && !shape.is_scalar();
        match (left, right) {
            (Value::Matrix(a), Value::Matrix(b)) if a.shape() == b.shape() => Ok(vec![(*a, *b)]),
            (Value::Matrix(a), Value::Identity(scale)) if square(a.shape()) => {
                Ok(vec![(*a, identity(*scale, a.shape()))])
            }
            (Value::Identity(scale), Value::Matrix(b)) if square(b.shape()) => {
                Ok(vec![(identity(*scale, b.shape()), *b)])
            }
            (Value::Tuple(a), Value::Tuple(b)) | (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
                let parts: Result<Vec<_>, Diagnostic> = a.iter().zip(b).map(|(a, b)| self.sides(a, b)).collect();
                parts.map(|parts| parts.into_iter().flatten().collect())
            }
            (left, right) => {
                let message =
                    format!("the left side is {} and the right side is {}", left.describe(), right.describe());
                let error = Diagnostic::new(self.place, format!("{message}: they cannot be equal"));
                let is_number = |value: &Value<'g>| value.matrix().is_some_and(|expr| expr.as_number().is_some());
                let identity = (is_number(right) || is_number(left)).then_some("write `I` for the identity matrix");
                Err(error
                    .maybe_help(identity)
                    .note("both sides of an equation have one shape; `I` takes that of the other side"))
            }
        }
    }

    /// The group, unless something is wrong with the equation.
    fn group(&self, sides: &[(Expr<'g>, Expr<'g>)]) -> Result<Group, Diagnostic> {
        let expressions: Vec<Expr<'g>> = sides.iter().map(|(left, right)| *left - *right).collect();
        self.is_rational(&expressions)?;
        self.holds_at_identity(sides)?;
        let derivative = follow::derivative(&expressions, self.symbol).ok_or_else(|| self.no_value())?;
        let basis = self.algebra(&derivative)?;
        self.is_closed(&derivative, &basis)?;
        self.holds_along(&expressions, &derivative, &basis)?;
        Ok(Group::by_equation(self.graph, self.name, self.joined(&expressions), self.symbol, basis))
    }

    fn error(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(self.place, message)
    }

    fn not_rational(&self) -> Diagnostic {
        self.error(format!("the equation of `{}` is not rational", self.name)).note(
            "its Lie algebra is found exactly, over the rational numbers, so roots, functions and π cannot stand in it",
        )
    }

    fn no_value(&self) -> Diagnostic {
        self.error(format!("the equation of `{}` has no value at the identity", self.name))
            .help("write it without quotients and inverses")
            .note(format!("with {} = I it divides by 0, or its numbers have more than 38 digits", self.symbol))
    }

    fn is_rational(&self, expressions: &[Expr<'g>]) -> Result<(), Diagnostic> {
        if !expressions.iter().any(|expr| expr.depends_on(self.symbol)) {
            let error = self.error(format!("the equation of `{}` does not depend on `{}`", self.name, self.symbol));
            return Err(
                error.help(format!("write an equation for `{0}`, as in `{0}.transpose() * {0} == I`", self.symbol))
            );
        }
        if expressions.iter().all(|expr| expr.is_rational()) { Ok(()) } else { Err(self.not_rational()) }
    }

    fn holds_at_identity(&self, sides: &[(Expr<'g>, Expr<'g>)]) -> Result<(), Diagnostic> {
        for (left, right) in sides {
            let value = |side: &Expr<'g>| follow::at_identity(*side, self.symbol).ok_or_else(|| self.no_value());
            let (a, b) = (value(left)?, value(right)?);
            if a != b {
                let shape = left.shape();
                let spell = |entries: &[Rational]| match shape.is_scalar() {
                    true => entries[0].to_string(),
                    false => spell_matrix(shape, entries),
                };
                let error = self.error(format!("the identity is not in `{}`", self.name));
                let error = error.help(format!("write an equation that `{} = I` solves", self.symbol));
                return Err(error.note(format!(
                    "with {} = I the left side of `{}` is {} and the right side {}",
                    self.symbol,
                    shortened(&self.text),
                    spell(&a),
                    spell(&b)
                )));
            }
        }
        Ok(())
    }

    /// The kernel of the derivative. Entries are taken column by column: one that those before do not determine is a coordinate.
    fn algebra(&self, derivative: &[Vec<Rational>]) -> Result<Vec<Sparse>, Diagnostic> {
        let n = self.symbol.shape().rows;
        let kernel = kernel(derivative, n * n);
        if kernel.is_empty() {
            let error = self.error(format!("`{}` has no element near the identity but the identity itself", self.name));
            return Err(
                error.note("the derivative of its equation at the identity has full rank, so its Lie algebra is 0")
            );
        }
        let by_rows = |columns: &Vec<Rational>| -> Vec<Rational> {
            self.symbol.shape().positions().map(|(i, j)| columns[j * n + i].clone()).collect()
        };
        Ok(kernel.iter().map(|element| sparse(self.symbol.shape(), &by_rows(element))).collect())
    }

    /// Brackets of the kernel stay in the kernel.
    fn is_closed(&self, derivative: &[Vec<Rational>], basis: &[Sparse]) -> Result<(), Diagnostic> {
        let shape = self.symbol.shape();
        // the rows without their zeros; a column is an entry of the matrix, column by column
        let place = |k: usize| (k % shape.rows) * shape.columns + k / shape.rows;
        let sparse_row = |row: &Vec<Rational>| -> Vec<(usize, Rational)> {
            let slopes = row.iter().enumerate().filter(|(_, slope)| !slope.is_zero());
            slopes.map(|(k, slope)| (place(k), slope.clone())).collect()
        };
        let rows: Vec<Vec<(usize, Rational)>> = derivative.iter().map(sparse_row).collect();
        let slope = |row: &Vec<(usize, Rational)>, bracket: &[Rational]| -> Rational {
            let terms = row.iter().filter(|(entry, _)| !bracket[*entry].is_zero());
            terms.map(|(entry, slope)| slope * &bracket[*entry]).sum()
        };
        let outside = |bracket: &[Rational]| rows.iter().any(|row| !slope(row, bracket).is_zero());
        let Some((i, j, bracket)) = bracket_with(self.graph, shape, basis, outside) else { return Ok(()) };
        let dense = |element: &Sparse| {
            let mut entries = vec![Rational::zero(); shape.len()];
            element.iter().for_each(|(row, column, value)| entries[row * shape.columns + column] = value.clone());
            spell_matrix(shape, &entries)
        };
        let (e, f) = (dense(&basis[i]), dense(&basis[j]));
        Err(self.error(format!("the matrices with `{}` are no group", shortened(&self.text))).note(format!(
            "near the identity they move along E{} = {e} and E{} = {f}, but not along [E{0}, E{1}] = {}",
            i + 1,
            j + 1,
            spell_matrix(shape, &bracket)
        )))
    }

    /// The equation holds on the group of the algebra.
    fn holds_along(
        &self,
        expressions: &[Expr<'g>],
        derivative: &[Vec<Rational>],
        basis: &[Sparse],
    ) -> Result<(), Diagnostic> {
        let alone = (0..basis.len()).map(|k| vec![(1, &basis[k])]);
        // integers without a pattern stand for a general direction
        let general =
            basis.iter().enumerate().map(|(k, element)| ((k as i64 * k as i64 * 7 + 3 * k as i64) % 23 - 11, element));
        let directions = alone.chain([general.collect()]);
        let leaves = directions.filter_map(|direction| {
            follow::leaves_at(expressions, self.symbol, &direction).map(|order| (direction, order))
        });
        let Some((direction, order)) = leaves.into_iter().next() else { return Ok(()) };
        let rank = reduce(&mut derivative.to_vec()).len();
        let general_rank = follow::general_rank(expressions, self.symbol);
        let shape = self.symbol.shape();
        let mut entries = vec![Rational::zero(); shape.len()];
        for (scale, element) in &direction {
            element.iter().for_each(|(i, j, value)| {
                entries[i * shape.columns + j] += value * &clebsch_symbolic::integer(*scale);
            });
        }
        let along = spell_matrix(shape, &entries);
        let (f, text) = (self.symbol, shortened(&self.text));
        Err(match rank < general_rank {
            true => self
                .error(format!("the equation of `{}` is not regular at the identity", self.name))
                .help("write each condition once and not squared, as in `F.determinant() == 1`")
                .note(format!(
                    "its derivative there has rank {rank}, at other matrices {general_rank}; it vanishes along E = {along}, but {f} = exp(s*E) leaves the solutions at order s^{order}"
                )),
            false => self.error(format!("the matrices with `{text}` are no group")).note(format!(
                "near the identity they move along E = {along}, but {f} = exp(s*E) leaves them at order s^{order}"
            )),
        })
    }

    /// All expressions as one.
    fn joined(&self, expressions: &[Expr<'g>]) -> Expr<'g> {
        if let [single] = expressions {
            return *single;
        }
        let entries: Vec<Expr<'g>> = expressions
            .iter()
            .flat_map(|expr| expr.shape().positions().map(|(i, j)| expr.entry(i, j)).collect::<Vec<_>>())
            .collect();
        self.graph.stack(Shape::vector(entries.len()), entries)
    }
}
