//! A group by an equation. The identity satisfies it, its Lie algebra is the kernel of the derivative there, and the
//! equation holds along the group that this algebra generates.

use clebsch_symbolic::{
    Elements, Expr, Graph, Group, IntoList, Property, Rational, Role, Shape, Sparse, both, indexed, reduce,
};
use quote::ToTokens;
use syn::Expr as Syntax;

use super::super::scope::check_reserved;
use super::super::shapes::vectors;
use super::super::value::Value;
use super::{check_literal, check_size, dense, elaborate, empty_scope, follow, open_bracket, sparse, spell_matrix};
use crate::diagnostic::{Diagnostic, Diagnostics, Location, bail, error};
use crate::parse::{Closure, shortened, spell_type, tail};

/// Reads `|F: Matrix4| a == b`.
pub(super) fn read(graph: &Graph, name: &str, closure: &Closure) -> Result<Group, Diagnostics> {
    let n = size(name, closure)?;
    let key = format!("equation of `{name}`");
    check_literal(&key, closure.body.to_token_stream())?;
    let pattern = &closure.arguments[0].pattern;
    let symbol = graph.symbol(&pattern.spell(), Shape::square(n), Role::DeclaredElement, Property::General);
    let diagnostics = Diagnostics::new();
    let mut scope = empty_scope();
    for ident in pattern.names() {
        check_reserved(ident, "an argument", &diagnostics);
    }
    scope.add_argument(pattern, Some(Value::Matrix(symbol)), &diagnostics);
    diagnostics.propagate(())?;
    let (left, right) = elaborate(graph, &key, scope, |elaborator| elaborator.equation(&closure.body))?;
    let body = tail(&closure.body);
    let equation = GroupEquation { graph, name, symbol, body };
    Ok(equation.group(&equation.sides(&left, &right)?)?)
}

/// The size of the matrices that the only argument stands for.
fn size(name: &str, closure: &Closure) -> Result<usize, Diagnostics> {
    let [argument] = closure.arguments.as_slice() else {
        bail!(closure.head, "the equation of `{name}` has {} arguments, not one", closure.arguments.len();
            help "write `|F: Matrix3| F.transpose() * F == I`");
    };
    let Some(ty) = &argument.ty else {
        let pattern = &argument.pattern;
        bail!(pattern.place(), "`{}` has no type in the equation of `{name}`", pattern.spell();
            help "write `|F: Matrix3| F.transpose() * F == I`");
    };
    match vectors(ty, &syn::Generics::default()).transpose()? {
        Some((shape, _)) if shape.is_square() => {
            check_size(name, shape.rows, Location::from(ty).start)?;
            Ok(shape.rows)
        }
        _ => {
            bail!(ty, "`{}` is no space of square matrices", spell_type(ty); help "write `Matrix3` or `SMatrix<8, 8>`")
        }
    }
}

/// An equation between expressions in the symbol.
struct GroupEquation<'a, 'g> {
    graph: &'g Graph,
    name: &'a str,
    symbol: Expr<'g>,
    body: &'a Syntax,
}

impl<'g> GroupEquation<'_, 'g> {
    /// The pairs of matrices that are to be equal.
    fn sides(&self, left: &Value<'g>, right: &Value<'g>) -> Result<Vec<(Expr<'g>, Expr<'g>)>, Diagnostic> {
        let square = |value: &Expr<'g>| value.shape().is_square() && !value.shape().is_scalar();
        let identity = |scale: Expr<'g>, other: &Expr<'g>| scale * self.graph.identity(other.shape().rows);
        match (left, right) {
            (Value::Matrix(a), Value::Matrix(b)) if a.shape() == b.shape() => Ok(vec![(*a, *b)]),
            (Value::Matrix(a), Value::Identity(scale)) if square(a) => Ok(vec![(*a, identity(*scale, a))]),
            (Value::Identity(scale), Value::Matrix(b)) if square(b) => Ok(vec![(identity(*scale, b), *b)]),
            (Value::Tuple(a), Value::Tuple(b)) | (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
                let parts: Vec<_> = a.iter().zip(b).map(|(a, b)| self.sides(a, b)).collect::<Result<_, _>>()?;
                Ok(parts.concat())
            }
            (left, right) => {
                let is_number = |value: &Value<'g>| value.matrix().is_some_and(|expr| expr.as_number().is_some());
                let (a, b) = (left.describe(), right.describe());
                let error = error!(self.body, "the left side is {a} and the right side is {b}: they cannot be equal");
                let identity = (is_number(right) || is_number(left)).then_some("write `I` for the identity matrix");
                Err(error
                    .maybe_help(identity)
                    .note("both sides of an equation have one shape; `I` takes that of the other side"))
            }
        }
    }

    /// The group, unless something is wrong with the equation.
    fn group(&self, sides: &[(Expr<'g>, Expr<'g>)]) -> Result<Group, Diagnostic> {
        let expressions: Vec<Expr<'g>> = sides.each(|(left, right)| *left - *right);
        let equation = self.joined(&expressions);
        self.is_rational(equation)?;
        self.holds_at_identity(sides)?;
        let derivative = follow::derivative(equation, self.symbol).ok_or_else(|| self.no_value())?;
        let basis = self.algebra(&derivative)?;
        self.is_closed(&basis)?;
        self.holds_along(equation, &derivative, &basis)?;
        Ok(Group::declare(self.graph, self.name, self.symbol.shape(), basis, Some((equation, self.symbol))))
    }

    fn no_value(&self) -> Diagnostic {
        error!(self.body, "the equation of `{}` has no value at the identity", self.name;
            help "write it without quotients and inverses";
            note "with {} = I it divides by 0, or its numbers have more than 38 digits", self.symbol)
    }

    fn is_rational(&self, equation: Expr<'g>) -> Result<(), Diagnostic> {
        let (name, symbol) = (self.name, self.symbol);
        if !equation.depends_on(symbol) {
            bail!(self.body, "the equation of `{name}` does not depend on `{symbol}`";
                help "write an equation for `{symbol}`, as in `{symbol}.transpose() * {symbol} == I`");
        }
        if !equation.is_rational() {
            bail!(self.body, "the equation of `{name}` is not rational";
                note "its Lie algebra is found exactly, over the rational numbers, so roots, functions and π cannot stand in it");
        }
        Ok(())
    }

    fn holds_at_identity(&self, sides: &[(Expr<'g>, Expr<'g>)]) -> Result<(), Diagnostic> {
        let symbol = self.symbol;
        for (left, right) in sides {
            let value = |side: &Expr<'g>| follow::at_identity(*side, symbol).ok_or_else(|| self.no_value());
            let (a, b) = (value(left)?, value(right)?);
            if a != b {
                let shape = left.shape();
                let [a, b] =
                    both(
                        [a, b],
                        |side| if shape.is_scalar() { side[0].to_string() } else { spell_matrix(shape, &side) },
                    );
                bail!(self.body, "the identity is not in `{}`", self.name;
                    help "write an equation that `{symbol} = I` solves";
                    note "with {symbol} = I the left side of `{}` is {a} and the right side {b}", shortened(self.body));
            }
        }
        Ok(())
    }

    /// The kernel of the derivative. Entries are taken column by column: one that those before do not determine is a coordinate.
    fn algebra(&self, derivative: &[Vec<Rational>]) -> Result<Vec<Sparse>, Diagnostic> {
        let shape = self.symbol.shape();
        let kernel = kernel(derivative, shape.len());
        if kernel.is_empty() {
            bail!(self.body, "`{}` has no element near the identity but the identity itself", self.name;
                note "the derivative of its equation at the identity has full rank, so its Lie algebra is 0");
        }
        let by_rows = |columns: &Vec<Rational>| -> Vec<Rational> {
            shape.positions().map(|(i, j)| columns[j * shape.rows + i].clone()).into_list()
        };
        Ok(kernel.each(|element| sparse(shape, &by_rows(element))))
    }

    /// Brackets of the kernel stay in the kernel.
    fn is_closed(&self, basis: &[Sparse]) -> Result<(), Diagnostic> {
        let shape = self.symbol.shape();
        let Some((i, j, bracket)) = open_bracket(self.graph, shape, basis) else { return Ok(()) };
        let [e, f] = both([i, j], |k| spell_matrix(shape, &dense(shape, &[(1, &basis[k])])));
        let (i, j, bracket) = (i + 1, j + 1, spell_matrix(shape, &bracket));
        bail!(self.body, "the matrices with `{}` are no group", shortened(self.body);
            note "near the identity they move along E{i} = {e} and E{j} = {f}, but not along [E{i}, E{j}] = {bracket}")
    }

    /// The equation holds on the group of the algebra.
    fn holds_along(&self, equation: Expr<'g>, slopes: &[Vec<Rational>], basis: &[Sparse]) -> Result<(), Diagnostic> {
        let alone = (0..basis.len()).map(|k| vec![(1, &basis[k])]);
        // integers without a pattern stand for a general direction
        let general =
            basis.iter().enumerate().map(|(k, element)| ((k as i64 * k as i64 * 7 + 3 * k as i64) % 23 - 11, element));
        let leaves = |direction: Vec<(i64, &Sparse)>| {
            let order = follow::leaves_at(equation, self.symbol, &direction)?;
            Some((spell_matrix(self.symbol.shape(), &dense(self.symbol.shape(), &direction)), order))
        };
        let Some((along, order)) = alone.chain([general.into_list()]).find_map(leaves) else { return Ok(()) };
        let rank = reduce(&mut slopes.to_vec()).len();
        let general_rank = follow::general_rank(equation, self.symbol);
        let f = self.symbol;
        if rank < general_rank {
            bail!(self.body, "the equation of `{}` is not regular at the identity", self.name;
                help "write each condition once and not squared, as in `F.determinant() == 1`";
                note "its derivative there has rank {rank}, at other matrices {general_rank}; it vanishes along E = {along}, but {f} = exp(s*E) leaves the solutions at order s^{order}");
        }
        bail!(self.body, "the matrices with `{}` are no group", shortened(self.body);
            note "near the identity they move along E = {along}, but {f} = exp(s*E) leaves them at order s^{order}")
    }

    fn joined(&self, expressions: &[Expr<'g>]) -> Expr<'g> {
        if let [single] = expressions {
            return *single;
        }
        let entries_of = |&expr: &Expr<'g>| expr.shape().positions().map(move |(i, j)| expr.entry(i, j));
        let entries: Vec<Expr<'g>> = expressions.iter().flat_map(entries_of).into_list();
        self.graph.stack(Shape::vector(entries.len()), entries)
    }
}

/// A basis of all x of the given length with ⟨row, x⟩ = 0. Each entry that those before do not determine is one in a vector of its own,
/// and zero in the others.
pub(super) fn kernel(rows: &[Vec<Rational>], length: usize) -> Vec<Vec<Rational>> {
    // a pivot is determined by the entries behind it, so entries are taken from the last to the first
    let mut reversed: Vec<Vec<Rational>> = rows.each(|row| row.iter().rev().cloned().into_list());
    let pivots = reduce(&mut reversed);
    let row_of = |entry: usize| pivots.iter().position(|&pivot| pivot == length - 1 - entry);
    let vector = |one: usize| {
        let entry = |entry: usize| match row_of(entry) {
            Some(row) => -reversed[row][length - 1 - one].clone(),
            None if entry == one => Rational::one(),
            None => Rational::zero(),
        };
        indexed(length, entry)
    };
    (0..length).filter(|&entry| row_of(entry).is_none()).map(vector).into_list()
}
