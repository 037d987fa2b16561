//! The laws of every built-in group and of declared ones, decided over a prime field at random elements: one line for each group.

use clebsch_symbolic::{Chart, Expr, Graph, Group, Matrix, Property, Role, Shape, Sparse, identity, integer};

fn element<'g>(graph: &'g Graph, group: Group, name: &str, index: usize) -> Expr<'g> {
    graph.symbol(name, group.element_shape(), Role::Element(index), group.element_property())
}

fn vector<'g>(graph: &'g Graph, n: usize, name: &str, index: usize) -> Expr<'g> {
    graph.symbol(name, Shape::vector(n), Role::Parameter(index), Property::General)
}

/// The equations of the group hold at random elements, products and inverses; the inverse inverts.
fn group_laws(graph: &Graph, group: Group) {
    let (f, g) = (element(graph, group, "F", 0), element(graph, group, "G", 1));
    for (what, member) in
        [("F", f), ("FG", group.compose(f, g)), ("F⁻¹", group.inverse(f)), ("explicit F⁻¹", group.explicit_inverse(f))]
    {
        for equation in group.equations(member) {
            assert!(identity::vanishes(equation), "{}: {what} is not on the group: {equation}", group.name(graph));
        }
    }
    let one = group.identity(graph);
    for inverse in [group.inverse(f), group.explicit_inverse(f)] {
        assert!(identity::equal(&[group.compose(f, inverse)], &[one]), "{}: F F⁻¹ = I", group.name(graph));
    }
}

/// dim 𝔤 independent matrices, tangent to the group, closed under the bracket.
fn algebra_laws(graph: &Graph, group: Group) {
    let m = group.dimension();
    let f = element(graph, group, "F", 0);
    let basis = graph.matrices(group);
    assert_eq!(basis.len(), m, "{}", group.name(graph));
    let one = group.identity(graph);
    for equation in group.equations(f) {
        for matrix in &basis {
            let slope = equation.differential(&[(f, *matrix)]).substitute(&[(f, one)]);
            assert!(identity::vanishes(slope), "{}: {matrix} is not tangent", group.name(graph));
        }
    }
    if group != Group::UnitQuaternions && !group.is_translation() && graph.blocks(group).len() == 1 {
        let algebra = graph.algebra_of(group);
        let span = graph.span(algebra);
        for i in 0..m {
            for j in 0..i {
                assert!(span.holds(&graph.bracket(algebra, i, j)), "[E{i}, E{j}]");
            }
        }
    }
    let xi = vector(graph, m, "ξ", 0);
    let gram: Vec<Vec<_>> = basis.iter().map(|a| basis.iter().map(|b| a.dot(*b)).collect()).collect();
    let gram = graph.stack(Shape::square(m), gram.into_iter().flatten().collect());
    assert!(identity::equal(&[group.components(group.wedge(xi))], &[gram * xi]), "components of Σ ξ_i E_i are Gξ");
    assert!(identity::equal(&[group.components(group.momentum_matrix(xi))], &[xi]), "momentum matrix and back");
}

/// ⟨Ad*_F μ, ξ⟩ = ⟨μ, Ad_F ξ⟩, Ad*_FG = Ad*_G Ad*_F, and T*L_F D = Ad*_F T*R_F D.
fn coadjoint_laws(graph: &Graph, group: Group) {
    let m = group.dimension();
    let (f, g) = (element(graph, group, "F", 0), element(graph, group, "G", 1));
    let (mu, xi) = (vector(graph, m, "μ", 0), vector(graph, m, "ξ", 1));
    let d = graph.symbol("D", group.element_shape(), Role::Parameter(2), Property::General);
    let name = group.name(graph);
    let moved = group.translate_right(group.inverse(f), group.translate_left(f, group.wedge(xi)));
    let pairing = group.momentum_matrix(mu).dot(moved);
    assert!(identity::equal(&[group.coadjoint(f, mu).dot(xi)], &[pairing]), "{name}: Ad* is the dual of Ad");
    let both = group.coadjoint(group.compose(f, g), mu);
    assert!(identity::equal(&[both], &[group.coadjoint(g, group.coadjoint(f, mu))]), "{name}: Ad*_FG");
    let (left, right) = (group.components(group.cotangent_left(f, d)), group.components(group.cotangent_right(f, d)));
    assert!(identity::equal(&[left], &[group.coadjoint(f, right)]), "{name}: T*L = Ad* T*R");
}

/// The chart starts at the identity with its slope, stays on the group, and its increment is F − I.
fn chart_laws(graph: &Graph, group: Group) {
    let name = group.name(graph);
    let chart = group.chart(graph);
    let blocks = graph.blocks(group);
    let x: Vec<Expr<'_>> = blocks
        .iter()
        .enumerate()
        .map(|(k, block)| vector(graph, block.algebra.dimension, &format!("x{k}"), k))
        .collect();
    let f = chart.element(group, &x);
    let rest: Vec<_> = x.iter().map(|x| (*x, graph.zero(x.shape()))).collect();
    let one = group.identity(graph);
    assert!(identity::equal(&[f.substitute(&rest)], &[one]), "{name}: x = 0 is the identity");
    for (block, x) in blocks.iter().zip(&x) {
        let direction = vector(graph, x.shape().rows, "δ", 9);
        let slope = f.differential(&[(*x, direction)]).substitute(&rest);
        let (numerator, denominator) = chart.slope_at_identity(block);
        let tangent = direction.wedge(block.algebra).embed(group.element_shape(), block.row, block.column);
        assert!(identity::equal(&[numerator * slope], &[denominator * tangent]), "{name}: slope at the identity");
    }
    if chart == Chart::Root || chart == Chart::Exponential || matches!(group, Group::UnitQuaternions) {
        // their roots and series are no rational functions: checked by numbers elsewhere
        return;
    }
    let expected = if group.is_translation() { f } else { f - one };
    let increment = chart.increment(group, &x);
    match group {
        // 2 sinh(d/2) e^{d/2} for eᵈ − 1
        Group::Similarity(_) => assert!(are_near(increment, expected), "{name}: the increment"),
        _ => assert!(identity::equal(&[increment], &[expected]), "{name}: the increment"),
    }
    for equation in group.equations(f) {
        assert!(identity::vanishes(equation), "{name}: the chart leaves the group: {equation}");
    }
}

/// Whether two expressions have the same values, to rounding, at some place.
fn are_near(a: Expr<'_>, b: Expr<'_>) -> bool {
    let value = |expression: Expr<'_>| {
        let mut entries = (1..).map(|k| 0.37 / f64::from(k));
        let mut known: Vec<(String, Matrix<f64>)> = Vec::new();
        let mut symbols = expression.symbols();
        symbols.sort_by_key(|symbol| symbol.as_symbol().expect("a symbol").name);
        for symbol in symbols {
            let numbers = entries.by_ref().take(symbol.shape().len()).collect();
            known.push((symbol.as_symbol().expect("a symbol").name, Matrix::new(symbol.shape(), numbers)));
        }
        let found = |name: &str| known.iter().find(|(other, _)| other == name).expect("a number").1.clone();
        expression.evaluate(&mut |symbol| found(&symbol.as_symbol().expect("a symbol").name)).entries
    };
    let (a, b) = (value(a), value(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-15)
}

/// Elements have the entries of the identity where this is promised, and nowhere else if the group is not a declared one.
fn fixed_entries(graph: &Graph, group: Group) {
    let (f, one, shape) = (element(graph, group, "F", 0), group.identity(graph), group.element_shape());
    for (i, j) in shape.positions().filter(|_| shape.is_square() && shape.rows > 1) {
        let is_fixed = identity::equal(&[f.entry(i, j)], &[one.entry(i, j)]);
        let is_promised = group.has_entry_of_identity(i, j);
        let is_declared = matches!(group, Group::Declared(_));
        assert!(is_promised == is_fixed || is_declared && !is_promised, "{}: {i}, {j}", group.name(graph));
    }
}

fn laws(graph: &Graph, group: Group) {
    group_laws(graph, group);
    fixed_entries(graph, group);
    algebra_laws(graph, group);
    coadjoint_laws(graph, group);
    chart_laws(graph, group);
}

macro_rules! built_in {
    ($($name:ident: $group:expr;)*) => { $(#[test] fn $name() { laws(&Graph::new(), $group); })* };
}

built_in! {
    so2: Group::SpecialOrthogonal(2);
    so3: Group::SpecialOrthogonal(3);
    so4: Group::SpecialOrthogonal(4);
    so5: Group::SpecialOrthogonal(5);
    so_1_1: Group::PseudoOrthogonal(1, 1);
    so_1_2: Group::PseudoOrthogonal(1, 2);
    lorentz: Group::PseudoOrthogonal(1, 3);
    so_2_2: Group::PseudoOrthogonal(2, 2);
    se2: Group::SpecialEuclidean(2);
    se3: Group::SpecialEuclidean(3);
    se4: Group::SpecialEuclidean(4);
    translation1: Group::Translation(1);
    translation3: Group::Translation(3);
    gl1: Group::GeneralLinear(1);
    gl2: Group::GeneralLinear(2);
    gl3: Group::GeneralLinear(3);
    sl2: Group::SpecialLinear(2);
    sl3: Group::SpecialLinear(3);
    sp2: Group::Symplectic(2);
    sp4: Group::Symplectic(4);
    u1: Group::Unitary(1);
    u2: Group::Unitary(2);
    su2: Group::UnitQuaternions;
    su3: Group::SpecialUnitary(3);
    heisenberg1: Group::Heisenberg(1);
    heisenberg2: Group::Heisenberg(2);
    aff1: Group::Affine(1);
    aff2: Group::Affine(2);
    sim2: Group::Similarity(2);
    sim3: Group::Similarity(3);
}

/// The chart with a root, by numbers: F = I + D has determinant one, and is (I + Z) over its root.
#[test]
fn elements_of_the_root_chart_have_determinant_one() {
    let graph = Graph::new();
    for n in [3, 4] {
        let group = Group::SpecialLinear(n);
        let x: Vec<_> = (0..group.dimension()).map(|i| graph.rational(i as i64 - 4, 21 + i as i64)).collect();
        let x = [graph.stack(Shape::vector(x.len()), x)];
        let element = graph.constant_value(Chart::Root.element(group, &x));
        let increment = graph.constant_value(Chart::Root.increment(group, &x));
        for (index, (f, d)) in element.entries.iter().zip(&increment.entries).enumerate() {
            let one = if index % (n + 1) == 0 { 1.0 } else { 0.0 };
            assert!((f - one - d).abs() < 1e-14, "{element:?} and {increment:?}");
        }
        assert!((element.inverse().1 - 1.0).abs() < 1e-14);
    }
}

/// exp(sx) exp(tx) = exp((s + t)x) is beyond a prime field; its closed forms are checked against the power series in numbers.
#[test]
fn closed_exponentials_are_the_series() {
    let graph = Graph::new();
    let groups = [
        Group::SpecialOrthogonal(2),
        Group::SpecialOrthogonal(3),
        Group::PseudoOrthogonal(1, 2),
        Group::SpecialEuclidean(2),
        Group::SpecialEuclidean(3),
        Group::SpecialLinear(2),
    ];
    for group in groups {
        let xi: Vec<_> = (0..group.dimension()).map(|i| graph.rational(2 * i as i64 - 3, 4 + i as i64)).collect();
        let blocks = graph.blocks(group);
        let part = |offset: usize, n: usize| graph.stack(Shape::vector(n), xi[offset..offset + n].to_vec());
        let x: Vec<_> = blocks.iter().map(|block| part(block.offset, block.algebra.dimension)).collect();
        let closed = graph.constant_value(Chart::Exponential.element(group, &x));
        let z = group.wedge(graph.stack(Shape::vector(xi.len()), xi.clone()));
        let series = graph.constant_value(z.exponential());
        for (a, b) in closed.entries.iter().zip(&series.entries) {
            assert!((a - b).abs() < 1e-13, "{}: {closed:?} and {series:?}", group.name(&graph));
        }
    }
}

/// F is a rotation with ½(F − Fᵀ) = x^, at numbers.
#[test]
fn the_chart_of_the_sine_is_half_the_skew_part() {
    let graph = Graph::new();
    for n in [2, 3] {
        let group = Group::SpecialOrthogonal(n);
        let entries = (0..group.dimension()).map(|i| graph.rational(2 * i as i64 - 1, 4));
        let x = graph.stack(Shape::vector(group.dimension()), entries.collect());
        let f = Chart::Sine.element(group, &[x]);
        let (alpha, beta) = Chart::Sine.in_one_plane(&[x]).expect("rotations in one plane");
        let z = group.wedge(x);
        let one = graph.identity(n);
        let zeros = [
            f * f.transpose() - one,
            (f - f.transpose()) / 2 - z,
            one + z.times_each(alpha) + (z * z).times_each(beta) - f,
        ];
        for zero in zeros {
            let value = graph.constant_value(zero);
            assert!(value.entries.iter().all(|entry| entry.abs() < 1e-15), "SO<{n}>: {value:?}");
        }
    }
}

/// dexp against the slope of the exponential in numbers: (exp(ξ + εδ) − exp(ξ − εδ)) exp(−ξ)/2ε.
#[test]
fn slopes_of_exponentials_are_their_differences() {
    let graph = Graph::new();
    let groups = [
        Group::SpecialOrthogonal(3),
        Group::SpecialOrthogonal(4),
        Group::SpecialEuclidean(3),
        Group::SpecialLinear(3),
        Group::Heisenberg(1),
    ];
    for group in groups {
        let m = group.dimension();
        let at = |sign: i64, index: usize| {
            let entry = |i: usize| {
                graph.rational(2 * i as i64 - 3, 7 + i as i64) + graph.rational(sign * (i == index) as i64, 100_000)
            };
            graph.stack(Shape::vector(m), (0..m).map(entry).collect())
        };
        let xi = at(0, 0);
        let slope = group.exponential_slope_by_halves(xi).unwrap_or_else(|| group.exponential_slope(xi));
        let slope = graph.constant_value(slope);
        for column in 0..m {
            let difference = group.wedge(at(1, column)).exponential() - group.wedge(at(-1, column)).exponential();
            let moved = 50_000 * (difference * (-group.wedge(xi)).exponential());
            let expected = graph.constant_value(group.projected_coordinates(moved));
            for row in 0..m {
                let (a, b) = (slope.at(row, column), expected.at(row, 0));
                assert!((a - b).abs() < 1e-8, "{}: ({row}, {column}): {a} and {b}", group.name(&graph));
            }
        }
    }
}

/// exp Z₊ exp Z₋ by four Stumpff functions against the power series of exp Z, with the increment. Simple rotations, and
/// such with one half at rest, are among them.
#[test]
fn rotations_in_four_dimensions_are_two_in_three() {
    let graph = Graph::new();
    let group = Group::SpecialOrthogonal(4);
    for entries in [[1, 2, -3, 4, -1, 2], [1, 0, 0, 0, 0, 0], [1, 2, 3, 3, -2, 1], [0; 6]] {
        let x = graph.stack(Shape::vector(6), entries.map(|entry| graph.rational(entry, 5)).to_vec());
        let series = graph.constant_value(group.wedge(x).exponential() - graph.identity(4));
        let increment = graph.constant_value(Chart::Exponential.increment(group, &[x]));
        let element = graph.constant_value(Chart::Exponential.element(group, &[x]) - graph.identity(4));
        for (k, expected) in series.entries.iter().enumerate() {
            let found = [increment.entries[k], element.entries[k]];
            assert!(
                found.iter().all(|found| (found - expected).abs() < 1e-14),
                "{entries:?}: {found:?} and {expected}"
            );
        }
    }
}

#[test]
fn dimensions_are_those_of_the_literature() {
    let graph = Graph::new();
    let dimensions = [
        (Group::SpecialOrthogonal(5), 10),
        (Group::PseudoOrthogonal(1, 3), 6),
        (Group::SpecialEuclidean(3), 6),
        (Group::SpecialLinear(3), 8),
        (Group::Symplectic(4), 10),
        (Group::Unitary(2), 4),
        (Group::SpecialUnitary(3), 8),
        (Group::Heisenberg(2), 5),
        (Group::Affine(2), 6),
        (Group::Similarity(3), 7),
    ];
    for (group, dimension) in dimensions {
        assert_eq!((group.dimension(), graph.matrices(group).len()), (dimension, dimension), "{}", group.name(&graph));
    }
}

#[test]
fn a_declared_group_finds_its_chart() {
    let graph = Graph::new();
    let unit = |i: usize, j: usize| -> Sparse { vec![(i, j, integer(1))] };
    let nil = Group::declare(&graph, "Nil", Shape::square(3), vec![unit(0, 1), unit(1, 2), unit(0, 2)], None);
    assert_eq!(nil.chart(&graph), Chart::Affine);
    laws(&graph, nil);
    let f = graph.symbol("F", Shape::square(3), Role::DeclaredElement, Property::General);
    let turns: Vec<Sparse> =
        [(0, 1), (0, 2), (1, 2)].map(|(i, j)| vec![(j, i, integer(1)), (i, j, integer(-1))]).to_vec();
    let so3 = Group::declare(&graph, "Turns", f.shape(), turns, Some((f.transpose() * f - graph.identity(3), f)));
    assert_eq!(so3.chart(&graph), Chart::Cayley);
    laws(&graph, so3);
    let diagonal = vec![(0, 0, integer(1)), (1, 1, integer(-2)), (2, 2, integer(1))];
    let mixed = Group::declare(&graph, "Scaling", Shape::square(3), vec![diagonal], None);
    assert_eq!(mixed.chart(&graph), Chart::Exponential);
    laws(&graph, mixed);
}
