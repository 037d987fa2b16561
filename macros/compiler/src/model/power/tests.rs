//! Indices are linear, and inside of the sites for every N.

use super::{Linear, sites_for};
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
    assert_eq!(sites_for(i, n, &all), Some(1));
    assert_eq!(sites_for(n - one - i, n, &all), Some(1), "backwards");
    assert_eq!(sites_for(i + one, n, &all), None);
    assert_eq!(sites_for(i - one, n, &all), None);
    assert_eq!(sites_for(i + one, n, &[(zero, n - one)]), Some(1), "an open chain");
    assert_eq!(sites_for(i - one, n, &[(one, n)]), Some(1));
    assert_eq!(sites_for(zero, n, &[]), Some(1));
    assert_eq!(sites_for(n - one, n, &[]), Some(1));
    assert_eq!(sites_for(one, n, &[]), Some(2), "one site has no second");
    assert_eq!(sites_for(i + one, n, &[(zero, one + one)]), Some(3));
    assert_eq!(sites_for(zero - one, n, &[]), None);
    let pairs = [(zero, n), (i + one, n)];
    assert_eq!(sites_for(i, n, &pairs), Some(1));
    assert_eq!(sites_for(j, n, &pairs), Some(1));
    assert_eq!(sites_for(j - i - one, n, &pairs), Some(1), "a distance less one");
    assert_eq!(sites_for(i + j, n, &pairs), None);
}
