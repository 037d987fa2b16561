//! The chain of three links, in the frames of the links.

use super::{ByHand, newton};
use crate::systems::Chain;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use std::array::from_fn;

pub struct Links {
    pub system: Chain,
    pub h: f64,
}

type Vectors = [Vector3<f64>; 3];
type Frames = [Matrix3<f64>; 3];

/// R_iᵀR_j
fn relative(r: &Frames) -> [Frames; 3] {
    let identity = Matrix3::identity();
    let to_second = r[0].tr_mul(&r[1]);
    let to_third = r[0].tr_mul(&r[2]);
    let between = r[1].tr_mul(&r[2]);
    [
        [identity, to_second, to_third],
        [to_second.transpose(), identity, between],
        [to_third.transpose(), between.transpose(), identity],
    ]
}

fn part(x: &SVector<f64, 9>, k: usize) -> Vector3<f64> {
    x.fixed_rows::<3>(3 * k).into_owned()
}

impl Links {
    /// The mass that hangs from both links.
    fn weight(&self, i: usize, j: usize) -> f64 {
        self.system.mass * (3 - i.max(j)) as f64
    }

    fn kick(&self, r: &Frames, k: usize) -> Vector3<f64> {
        let down = r[k].row(2).transpose() * (-0.5 * self.h * self.system.weight * (3 - k) as f64);
        self.system.link.cross(&down)
    }

    /// The momenta of the links in their frames, for velocities u of their ends.
    fn pushed(&self, relative: &[Frames; 3], u: &Vectors) -> Vectors {
        from_fn(|i| (0..3).map(|j| relative[i][j] * u[j] * self.weight(i, j)).sum())
    }

    /// A block of the mass matrix.
    fn mass(&self, relative: &[Frames; 3], link: &Matrix3<f64>, i: usize, j: usize) -> Matrix3<f64> {
        let coupled = link * relative[i][j] * link * -self.weight(i, j);
        if i == j { coupled + self.system.inertia } else { coupled }
    }

    fn velocities(&self, z: &Vectors) -> Vectors {
        from_fn(|k| (z[k] * (2.0 / self.h)).cross(&self.system.link))
    }

    /// Twice the mean of ∂ℓ/∂ξ at both ends.
    fn momentum(&self, z: &Vector3<f64>, pushed: &Vector3<f64>) -> Vector3<f64> {
        self.system.inertia * z * (4.0 / self.h) + self.system.link.cross(pushed)
    }
}

fn moved(r: &Frames, z: &Vectors) -> Frames {
    from_fn(|k| {
        let hat = z[k].cross_matrix();
        r[k] + r[k] * (hat + hat * hat) * (2.0 / (1.0 + z[k].norm_squared()))
    })
}

impl ByHand for Links {
    type State = (Frames, SVector<f64, 9>);

    fn step(&self, (r, n): Self::State) -> Self::State {
        let h = self.h;
        let link = self.system.link.cross_matrix();
        let identity = Matrix3::identity();
        let mu: Vectors = from_fn(|k| part(&n, k) + self.kick(&r, k));
        let here = relative(&r);
        let metric: [Frames; 3] = from_fn(|i| from_fn(|j| self.mass(&here, &link, i, j)));
        let x = newton(|x: &SVector<f64, 9>| {
            let z: Vectors = from_fn(|k| part(x, k));
            let there = relative(&moved(&r, &z));
            let u = self.velocities(&z);
            let first = self.pushed(&here, &u);
            let last = self.pushed(&there, &u);
            let turns: Frames = from_fn(|k| (identity - z[k].cross_matrix()) * (2.0 / (1.0 + z[k].norm_squared())));
            let mut residual = SVector::<f64, 9>::zeros();
            let mut jacobian = SMatrix::<f64, 9, 9>::zeros();
            for i in 0..3 {
                let zi = z[i];
                let g = self.momentum(&zi, &(first[i] + last[i]));
                let moved = 0.5 * (g - g.cross(&zi) + zi.dot(&g) * zi);
                residual.fixed_rows_mut::<3>(3 * i).copy_from(&(moved - 0.5 * h * u[i].cross(&first[i]) - mu[i]));
                let hat = zi.cross_matrix();
                for j in 0..3 {
                    let mut dg = (metric[i][j] + self.mass(&there, &link, i, j)) * (2.0 / h);
                    if i == j {
                        let others = last[i] - u[i] * self.weight(i, i);
                        dg += link * others.cross_matrix() * turns[i];
                    } else {
                        dg -= link * there[i][j] * u[j].cross_matrix() * turns[j] * self.weight(i, j);
                    }
                    let mut block = 0.5 * (dg + hat * dg + zi * dg.tr_mul(&zi).transpose());
                    block += u[i].cross_matrix() * here[i][j] * link * self.weight(i, j);
                    if i == j {
                        block += 0.5 * (-g.cross_matrix() + zi * g.transpose() + identity * zi.dot(&g));
                        block -= first[i].cross_matrix() * link;
                    }
                    jacobian.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&block);
                }
            }
            (residual, jacobian)
        });
        let z: Vectors = from_fn(|k| part(&x, k));
        let next = moved(&r, &z);
        let there = relative(&next);
        let u = self.velocities(&z);
        let first = self.pushed(&here, &u);
        let last = self.pushed(&there, &u);
        let mut momentum = SVector::<f64, 9>::zeros();
        for i in 0..3 {
            let zi = z[i];
            let g = self.momentum(&zi, &(first[i] + last[i]));
            let moved = 0.5 * (g + g.cross(&zi) + zi.dot(&g) * zi);
            let end = moved + 0.5 * h * u[i].cross(&last[i]) + self.kick(&next, i);
            momentum.fixed_rows_mut::<3>(3 * i).copy_from(&end);
        }
        (next, momentum)
    }
}
