//! Products block by block: the same values, and no zeros multiplied.

use clebsch_symbolic::identity;
use clebsch_symbolic::{Chart, Expr, Graph, Group, Property, Role, Shape};

fn symbol<'g>(graph: &'g Graph, name: &str, shape: Shape) -> Expr<'g> {
    graph.symbol(name, shape, Role::Parameter(0), Property::General)
}

#[test]
fn values_stay_as_they_are() {
    let graph = Graph::new();
    let square = Shape::square(4);
    let [f, m] = ["F", "M"].map(|name| symbol(&graph, name, square));
    let (w, b) = (symbol(&graph, "W", Shape::square(3)), symbol(&graph, "b", Shape::vector(3)));
    let motion = w.embed(square, 0, 0) + b.embed(square, 0, 3) + graph.unit(square, 3, 3);
    let sparse =
        graph.sparse_literal(square, [(0, 2, clebsch_symbolic::integer(2)), (1, 2, clebsch_symbolic::integer(3))]);
    let corner = Shape::square(3);
    for expression in [
        f * w.embed(square, 0, 0),
        w.embed(square, 1, 0) * f * b.embed(square, 0, 3),
        (f * motion * m * motion.transpose()).block(0, 0, corner),
        ((motion - graph.identity(4)) * m * motion.transpose()).block(0, 1, corner),
        motion.inverse() * m * w.embed(square, 1, 1),
        sparse * f * sparse,
        b.embed(square, 0, 3) * b.embed(square, 1, 0),
        (f * w.embed(square, 0, 1) * m).trace() * f,
        graph.unit(Shape::vector(4), 2, 0).transpose() * f * motion,
    ] {
        for form in [expression, expression.expand()] {
            assert!(identity::equal(&[form.blockwise()], &[expression]), "{form} is not {}", form.blockwise());
            assert!(identity::equal(&[form.blockwise().expand()], &[expression]), "{form}");
        }
    }
}

/// (W − I)J_m + b m cᵀ is the rotational part of the momentum of a body in space. It contains the blocks of its mass
/// matrix and nothing else.
#[test]
fn zeros_are_not_multiplied() {
    let graph = Graph::new();
    let m = symbol(&graph, "M", Shape::square(4));
    let group = Group::SpecialEuclidean(3);
    let x = [symbol(&graph, "x", Shape::vector(3)), symbol(&graph, "y", Shape::vector(3))];
    let f = Chart::Product.element(group, &x);
    let block = ((f - graph.identity(4)) * m).block(0, 0, Shape::square(3)).expand();
    assert!(block.to_string().contains("embed"));
    let text = block.blockwise().expand().to_string();
    assert_eq!(text, "y·M[3, 0..3] + 2·(I − x^)⁻¹·M[0..3, 0..3] − 2·M[0..3, 0..3]");
}

/// Blocks of a diagonal matrix have its entries, and are zero off the diagonal.
#[test]
fn blocks_of_diagonal_matrices() {
    let graph = Graph::new();
    let v = symbol(&graph, "v", Shape::vector(4));
    let matrix = v.diagonal_matrix();
    for (rows, columns) in Shape::square(4).positions().map(|(i, j)| (i + 1, j + 1)) {
        for (row, column) in Shape::new(5 - rows, 5 - columns).positions() {
            let block = matrix.block(row, column, Shape::new(rows, columns));
            for (i, j) in block.shape().positions() {
                let zero = graph.integer(0);
                let expected = if row + i == column + j { v.entry(row + i, 0) } else { zero };
                assert!(identity::equal(&[block.entry(i, j)], &[expected]), "{block} at {i}, {j}");
            }
        }
    }
    assert_eq!(matrix.block(0, 0, Shape::square(3)).to_string(), "diag(v[0..3])");
    assert!(matrix.block(0, 2, Shape::square(2)).is_zero());
}

/// A matrix that is promised to be diagonal has blocks of zeros off its diagonal, and others that are its own.
#[test]
fn blocks_of_promised_diagonal_matrices() {
    let graph = Graph::new();
    let matrix = graph.symbol("M", Shape::square(4), Role::Parameter(0), Property::Diagonal);
    for (rows, columns) in Shape::square(4).positions().map(|(i, j)| (i + 1, j + 1)) {
        for (row, column) in Shape::new(5 - rows, 5 - columns).positions() {
            let block = matrix.block(row, column, Shape::new(rows, columns));
            let meets = (row..row + rows).any(|i| (column..column + columns).contains(&i));
            assert_eq!(block.is_zero(), !meets, "{block} from {row}, {column}");
        }
    }
}
