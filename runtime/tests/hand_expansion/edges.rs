//! The derivatives of an edge against differences of the Legendre transforms, and these against differences of the Lagrangian.

use crate::driven_pendulum::DrivenPendulum;
use crate::{HeavyTop, assert_near, attitude, top};
use clebsch::__private::Scheme;
use clebsch::{Clebsch, Edge, Error, Variational};
use nalgebra::{Matrix3, Vector3};

/// The edge after motions of its ends; its momenta alone are the same.
fn moved<S>(
    system: &S,
    h: f64,
    q: &S::Configuration,
    d: &S::Element,
    start: Vector3<f64>,
    end: Vector3<f64>,
) -> Edge<f64, 3>
where
    S: Variational<3, Scalar = f64, Momentum = Vector3<f64>, Input = ()>,
{
    let constants = S::Scheme::constants(system, h).expect("a good step size");
    let q = system.advance(q, &system.retraction(&start));
    let d = system.compose(&system.compose(&system.retraction(&-start), d), &system.retraction(&end));
    let next = system.advance(&q, &d);
    let edge = system.edge(&constants, 0, 0.3, (&q, &d, &next, &()));
    let momenta = system.momenta(&constants, 0, 0.3, (&q, &d, &next, &()));
    assert!((momenta.lagrangian - edge.lagrangian).abs() < 1e-14);
    assert_near!(momenta.before, edge.before, 1e-14);
    assert_near!(momenta.after, edge.after, 1e-14);
    edge
}

fn check_edge<S>(system: &S, q: &S::Configuration, d: &S::Element)
where
    S: Variational<3, Scalar = f64, Momentum = Vector3<f64>, Input = ()>,
{
    let (h, step) = (0.1, 1e-5);
    let zero = Vector3::zeros();
    let edge = moved(system, h, q, d, zero, zero);
    for j in 0..3 {
        let eta = Vector3::ith(j, step);
        let (up, down) = (moved(system, h, q, d, eta, zero), moved(system, h, q, d, -eta, zero));
        assert!((edge.before[j] + (up.lagrangian - down.lagrangian) / (2.0 * step)).abs() < 1e-8);
        assert_near!(edge.before_by_start.column(j), (up.before - down.before) / (2.0 * step), 1e-8);
        assert_near!(edge.after_by_start.column(j), (up.after - down.after) / (2.0 * step), 1e-8);
        let (up, down) = (moved(system, h, q, d, zero, eta), moved(system, h, q, d, zero, -eta));
        assert!((edge.after[j] - (up.lagrangian - down.lagrangian) / (2.0 * step)).abs() < 1e-8);
        assert_near!(edge.before_by_end.column(j), (up.before - down.before) / (2.0 * step), 1e-8);
        assert_near!(edge.after_by_end.column(j), (up.after - down.after) / (2.0 * step), 1e-8);
    }
    // motions of q with q⁺, and motions of q⁺ alone, make up all of them
    let carried = system.carried(
        &S::Scheme::constants(system, h).expect("a good step size"),
        0,
        0.3,
        (q, d, &system.advance(q, d), &()),
    );
    assert_near!(carried.before, edge.before_by_start + edge.before_by_end * carried.adjoint, 1e-13);
    assert_near!(carried.after, edge.after_by_start + edge.after_by_end * carried.adjoint, 1e-13);
}

#[test]
fn an_edge_of_the_top_is_differentiated() -> Result<(), Error> {
    let top = top();
    let d = top.retraction(&Vector3::new(0.2, -0.3, 0.1));
    check_edge(&top, &attitude(), &d);
    let edge = top.edge(&top.constants(0.1)?, 0, 0.0, (&attitude(), &d, &top.advance(&attitude(), &d), &()));
    let f = Matrix3::identity() + d;
    assert_near!(edge.before, HeavyTop::legendre(&top, 0.1, 0.0, &attitude(), &f), 1e-14);
    assert_near!(edge.after, HeavyTop::legendre_next(&top, 0.1, 0.0, &attitude(), &f), 1e-14);
    Ok(())
}

#[test]
fn an_edge_of_the_pendulum_is_differentiated() -> Result<(), Error> {
    let pendulum = DrivenPendulum { mass: 0.5, length: 0.7, gravity: 9.81, shake: 4.0, rate: 3.0 };
    let (q, d) = (Vector3::new(0.36, 0.48, -0.8), pendulum.retraction(&Vector3::new(0.2, -0.3, 0.1)));
    check_edge(&pendulum, &q, &d);
    let edge = pendulum.edge(&pendulum.constants(0.1)?, 0, 0.3, (&q, &d, &pendulum.advance(&q, &d), &()));
    let f = Matrix3::identity() + d;
    assert_near!(edge.before, pendulum.legendre(0.1, 0.3, &q, &f), 1e-14);
    assert_near!(edge.after, pendulum.legendre_next(0.1, 0.3, &q, &f), 1e-14);
    Ok(())
}
