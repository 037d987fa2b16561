//! Derivatives and simplification, as aligned one-liners: name, input, expected text.

use clebsch_symbolic::{Chart, Expr, Graph, Group, Matrix, Property, Role, Shape, identity};

struct Symbols<'g> {
    f: Expr<'g>,
    s: Expr<'g>,
    a: Expr<'g>,
    q: Expr<'g>,
    u: Expr<'g>,
    v: Expr<'g>,
    h: Expr<'g>,
    x: Expr<'g>,
}

fn symbols(graph: &Graph) -> Symbols<'_> {
    let matrix = |name, property, index| graph.symbol(name, Shape::square(3), Role::Parameter(index), property);
    let vector = |name, index| graph.symbol(name, Shape::vector(3), Role::Parameter(index), Property::General);
    Symbols {
        f: matrix("F", Property::Orthogonal, 0),
        s: matrix("S", Property::Symmetric, 1),
        a: matrix("A", Property::General, 2),
        q: graph.symbol("q", Shape::vector(3), Role::Parameter(3), Property::Unit),
        u: vector("u", 4),
        v: vector("v", 5),
        h: graph.symbol("h", Shape::scalar(), Role::StepSize, Property::General),
        x: vector("x", 6),
    }
}

#[test]
fn common_factors_stand_before_sums_and_linear_operations() {
    let graph = Graph::new();
    let Symbols { f, s, a, q, u, v, h, x } = symbols(&graph);
    let scalar = |name, index| graph.symbol(name, Shape::scalar(), Role::Parameter(index), Property::General);
    let (m, n) = (scalar("m", 7), scalar("n", 8));
    let i = graph.identity(3);
    let table = [
        ("a number of all terms stays in an open sum", (u + v) / 2, "u/2 + v/2"),
        ("in a product it does not", f * (u / 2 + v / 2), "F·(u + v)/2"),
        ("numbers over several denominators stay", f * (u / 2 + v), "F·(u/2 + v)"),
        ("a scalar of all terms", h * u + h * v, "h·(u + v)"),
        ("scalars of one vector", h * (m * u + n * u), "h·(m + n)·u"),
        ("scalars of some terms", m * u + m * v - x, "m·(u + v) − x"),
        ("signs", -(f * (-h * u - h * v)), "h·F·(u + v)"),
        ("a transpose", (m * a + m * s).transpose() * q, "m·(S + Aᵀ)·q"),
        ("a denominator that is a sum", u / (u.dot(u) / 2 + i.trace() / 6), "2·u/(uᵀ·u + 1)"),
        ("an entry", (m * a * u + m * v).block(1, 0, Shape::scalar()), "m·((A·u)[1] + v[1])"),
    ];
    for (name, input, expected) in table {
        assert_eq!(input.to_string(), expected, "{name}");
    }
}

#[test]
fn simplification_on_construction() {
    let graph = Graph::new();
    let Symbols { f, s, a, q, u, v, h, x: _ } = symbols(&graph);
    let i = graph.identity(3);
    let table = [
        ("rotation times its transpose", f * f.transpose(), "I"),
        ("transpose of a product", (f * s).transpose(), "S·Fᵀ"),
        ("like terms", f + s + f, "2·F + S"),
        ("cancellation", f - f, "0"),
        ("unit vector", q.dot(q), "1"),
        ("cross with itself", u.cross(u), "u^·u"),
        ("trace of skew part", (a - a.transpose()).trace(), "0"),
        ("cyclic trace", (a * s - s * a).trace(), "0 of size"),
        ("scalars commute", h * (f * h) / h, "h·F"),
        ("outer product", (u * v.transpose()) * (u * v.transpose()), "vᵀ·u·u·vᵀ"),
        ("trace of an outer product", (u * v.transpose()).trace() - u.dot(v), "0"),
        ("square root squared", u.norm() * u.norm(), "uᵀ·u"),
        ("half of an identity", i / 2, "I/2"),
        ("inverse of a scaled rotation", (2 * f).inverse(), "Fᵀ/2"),
    ];
    for (name, input, expected) in table {
        if expected != "0 of size" {
            assert_eq!(input.to_string(), expected, "{name}");
        } else {
            assert!(input.is_zero(), "{name}: {input}");
        }
    }
}

#[test]
fn gradients_agree_with_directional_derivatives_and_differences() {
    let graph = Graph::new();
    let Symbols { s, a, q, u, v, h, x, .. } = symbols(&graph);
    let f = graph.symbol("G", Shape::square(3), Role::Parameter(7), Property::General);
    let i = graph.identity(3);
    let scalars = [
        (s * (f - i) * (f - i).transpose()).trace() / (2 * h),
        (f * u).cross(v).dot(x),
        (f * u).norm() * (a * f).trace().powi(3),
        (f * a).determinant() / (u.dot(f * v)).powi(2),
        (f + i).inverse().dot(a).function(clebsch_symbolic::Function::Sin),
        f.hadamard(a).trace() * f.entry(1, 2) + f.block(0, 1, Shape::new(2, 2)).norm_squared(),
        f.diagonal().dot(u) + (f * v).diagonal_matrix().dot(a) + q.dot(f * q),
    ];
    for scalar in scalars {
        let gradient = scalar.gradient(f);
        let directional = scalar.differential(&[(f, a)]);
        assert!(identity::equal(&[gradient.dot(a)], &[directional]), "{scalar}");
        let value = |e: f64| at(scalar, f, a, e);
        let difference = (value(1e-5) - value(-1e-5)) / 2e-5;
        let exact = at(directional, f, a, 0.0);
        assert!((difference - exact).abs() <= 1e-7 * (1.0 + exact.abs()), "{scalar}: {difference} against {exact}");
    }
}

/// The value at a fixed pseudo-random point, F moved by `e` in the direction A.
fn at<'g>(scalar: Expr<'g>, f: Expr<'g>, a: Expr<'g>, e: f64) -> f64 {
    let base = |symbol: Expr<'g>| {
        Matrix::from_fn(symbol.shape(), |(i, j)| {
            let seed = symbol.as_symbol().map_or(0, |s| s.name.bytes().next().unwrap_or(0)) as f64;
            let entry =
                |i: usize, j: usize| (seed * 1.7 + 2.3 * i as f64 + 3.1 * j as f64).sin() + (i == j) as u8 as f64;
            let symmetric = symbol.as_symbol().is_some_and(|s| s.property == Property::Symmetric);
            if symmetric { entry(i, j) + entry(j, i) } else { entry(i, j) }
        })
    };
    let mut values = |symbol: Expr<'g>| {
        let moved = base(symbol);
        let direction = base(a);
        let shift = |(i, j)| moved.at(i, j) + e * direction.at(i, j);
        if symbol == f { Matrix::from_fn(symbol.shape(), shift) } else { moved.clone() }
    };
    scalar.evaluate(&mut values).entries[0]
}

#[test]
fn moser_veselov_equation_clears_to_a_quadratic() {
    let graph = Graph::new();
    let Symbols { f, s, h, x, .. } = symbols(&graph);
    let group = Group::SpecialOrthogonal(3);
    let i = graph.identity(3);
    let cost = (s * (f - i) * (f - i).transpose()).trace() / (2 * h);
    let d = cost.gradient(f);
    let residual = group.cotangent_right(f, d).expand();
    let element = Chart::Cayley.element(group, &[x]);
    let (before, after) = Chart::Cayley.clearing(group, &[x], false).unwrap();
    let cleared = (before * residual.substitute(&[(f, element)]) * after).expand();
    let components = group.components(cleared);
    assert_eq!(components.to_string(), "2·⟨S·x^, E⟩/h");
}

#[test]
fn increments_are_the_chart_minus_the_identity() {
    for n in 2..=5 {
        let graph = Graph::new();
        let group = Group::SpecialOrthogonal(n);
        let x = graph.symbol("x", Shape::vector(group.dimension()), Role::Chart(0), Property::General);
        let element = Chart::Cayley.element(group, &[x]);
        assert!(identity::equal(&[element - graph.identity(n)], &[Chart::Cayley.increment(group, &[x])]), "SO<{n}>");
        assert!(identity::equal(&[element * element.transpose()], &[graph.identity(n)]), "SO<{n}>");
    }
}

#[test]
fn expansion_keeps_the_value() {
    let graph = Graph::new();
    let Symbols { f, s, a, u, v, h, .. } = symbols(&graph);
    let i = graph.identity(3);
    let expressions = [
        (f - i) * (a + s) * (f + i).inverse() * f,
        (u.dot(v) + h).powi(3) * (f - a).transpose(),
        ((f + i).inverse() * (2 * f + i).inverse()) * a,
        (i - a).inverse() * (i + a) * (i + a).inverse() * (a - i),
    ];
    for expression in expressions {
        assert!(identity::equal(&[expression], &[expression.expand()]), "{expression} became {}", expression.expand());
    }
}
