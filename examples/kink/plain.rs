//! The same steps in plain angles, by hand: no group, no formula of the compiler.

use crate::line::Mesh;
use crate::solitons::Soliton;

/// How angles enter: the kinetic energy and that of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// 1 − cos θ
    Chord,
    /// θ²/2
    Angle,
}

/// u at the end, of steps from a soliton at a time.
pub fn end(form: Form, mesh: &Mesh, soliton: &Soliton, from: f64) -> Vec<f64> {
    let Mesh { dx, h, steps, .. } = *mesh;
    let (mut u, mut rate): (Vec<f64>, Vec<f64>) =
        mesh.places().map(|x| soliton.at(x, from)).map(|[u, rate]| (u, rate)).unzip();
    let last = u.len() - 1;
    let force = |u: &[f64], i: usize| {
        let pull = |a: f64, b: f64| if form == Form::Chord { (b - a).sin() } else { b - a };
        let before = if i > 0 { pull(u[i - 1], u[i]) } else { 0.0 };
        let after = if i < last { pull(u[i], u[i + 1]) } else { 0.0 };
        (after - before) / (dx * dx) - u[i].sin()
    };
    let kick = |u: &[f64], rate: &mut [f64]| {
        for (i, rate) in rate.iter_mut().enumerate() {
            *rate += h / 2.0 * force(u, i);
        }
    };
    for _ in 0..steps {
        kick(&u, &mut rate);
        for (u, rate) in u.iter_mut().zip(&rate) {
            *u += if form == Form::Chord { (h * rate).asin() } else { h * rate };
        }
        kick(&u, &mut rate);
    }
    u
}
