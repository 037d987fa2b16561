//! Indices are linear, and inside of the sites for every N.

use super::{Linear, is_inside};
use clebsch_symbolic::{Expr, Graph, Property, Role, Shape};

fn symbol<'g>(graph: &'g Graph, name: &str, role: Role) -> Expr<'g> {
    graph.symbol(name, Shape::scalar(), role, Property::General)
}

#[test]
fn indices_are_linear() {
    let graph = Graph::new();
    let (i, n) = (symbol(&graph, "i", Role::Site(0)), symbol(&graph, "N", Role::Sites));
    let found = Linear::of(2 * i + n - graph.integer(3));
    assert_eq!(found, Some(Linear { constant: -3, sites: 1, indices: vec![2] }));
    assert_eq!(Linear::of(i * i), None);
    assert_eq!(Linear::of(i / 2), None);
}

#[test]
fn what_leaves_the_sites_is_seen() {
    let graph = Graph::new();
    let (i, j, n) =
        (symbol(&graph, "i", Role::Site(0)), symbol(&graph, "j", Role::Site(1)), symbol(&graph, "N", Role::Sites));
    let (zero, one) = (graph.integer(0), graph.integer(1));
    let all = [(zero, n)];
    assert!(is_inside(i, n, &all));
    assert!(is_inside(n - one - i, n, &all), "backwards");
    assert!(!is_inside(i + one, n, &all));
    assert!(!is_inside(i - one, n, &all));
    assert!(is_inside(i + one, n, &[(zero, n - one)]), "an open chain");
    assert!(is_inside(i - one, n, &[(one, n)]));
    assert!(is_inside(zero, n, &[]) && is_inside(n - one, n, &[]));
    assert!(!is_inside(one, n, &[]), "one site has no second");
    let pairs = [(zero, n), (i + one, n)];
    assert!(is_inside(i, n, &pairs) && is_inside(j, n, &pairs));
    assert!(is_inside(j - i - one, n, &pairs), "a distance less one");
    assert!(!is_inside(i + j, n, &pairs));
}
