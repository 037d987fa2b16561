//! Bodies that move on a group of 3×3 matrices by controlled velocities: x⁺ = x exp(h Σ u_j E_j) at the price h/2 |u|².

use crate::jet::Jet;
use clebsch::{Arrival, BoundsExpansion, Controlled, EndpointExpansion, Error, Expansion};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

/// The first U of the three elements of the basis are driven.
#[derive(Clone, Debug)]
pub struct Group<const U: usize> {
    pub basis: [Matrix3<f64>; 3],
    /// The dual basis: coordinates of an element of the algebra are ⟨dual, ξ⟩ entry by entry.
    pub dual: [Matrix3<f64>; 3],
}

pub fn unit(row: usize, column: usize) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| if (i, j) == (row, column) { 1.0 } else { 0.0 })
}

/// The plane: forward, turn, and sideways, which a wheel does not do.
pub fn unicycle() -> Group<2> {
    let turn = unit(1, 0) - unit(0, 1);
    Group { basis: [unit(0, 2), turn, unit(1, 2)], dual: [unit(0, 2), turn * 0.5, unit(1, 2)] }
}

/// Rotations; those about the first two axes are driven.
pub fn attitude() -> Group<2> {
    let hat = |v: Vector3<f64>| v.cross_matrix();
    let basis = [hat(Vector3::x()), hat(Vector3::y()), hat(Vector3::z())];
    Group { basis, dual: basis.map(|e| e * 0.5) }
}

/// The Heisenberg group: (x, y, z) with z ↦ z + x dy.
pub fn heisenberg() -> Group<2> {
    let basis = [unit(0, 1), unit(1, 2), unit(0, 2)];
    Group { basis, dual: basis }
}

type JetMatrix = [[Jet; 3]; 3];

fn constant(matrix: &Matrix3<f64>) -> JetMatrix {
    core::array::from_fn(|i| core::array::from_fn(|j| Jet::constant(matrix[(i, j)])))
}

/// Such matrices are full of zeros, which take no work.
fn product(a: &JetMatrix, b: &JetMatrix) -> JetMatrix {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let factors = (0..3).map(|k| (&a[i][k], &b[k][j])).filter(|(a, b)| !a.is_zero() && !b.is_zero());
            factors.fold(Jet::constant(0.0), |sum, (a, b)| sum + *a * *b)
        })
    })
}

fn sum(a: &JetMatrix, b: &JetMatrix, factor: f64) -> JetMatrix {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + b[i][j] * factor))
}

impl<const U: usize> Group<U> {
    pub fn algebra(&self, xi: &[f64]) -> Matrix3<f64> {
        self.basis.iter().zip(xi).map(|(e, x)| e * *x).sum()
    }

    pub fn exp(&self, xi: &[f64]) -> Matrix3<f64> {
        let (xi, mut power, mut total) = (self.algebra(xi), Matrix3::identity(), Matrix3::identity());
        for n in 1..40 {
            power = power * xi / f64::from(n);
            if power == Matrix3::zeros() {
                break;
            }
            total += power;
        }
        total
    }

    pub fn coordinates(&self, xi: &Matrix3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|i, _| self.dual[i].dot(xi))
    }

    fn jet_algebra(&self, xi: &[Jet]) -> JetMatrix {
        let zero = constant(&Matrix3::zeros());
        self.basis.iter().zip(xi).fold(zero, |total, (e, x)| {
            core::array::from_fn(|i| core::array::from_fn(|j| total[i][j] + *x * e[(i, j)]))
        })
    }

    fn jet_exp(&self, xi: &[Jet]) -> JetMatrix {
        let xi = self.jet_algebra(xi);
        let mut total = constant(&Matrix3::identity());
        let mut power = total;
        for n in 1..30 {
            power = product(&power, &xi);
            // a nilpotent one, as δ at 0 is in any group, has a finite series
            if power.iter().flatten().all(Jet::is_zero) {
                break;
            }
            power.iter_mut().flatten().for_each(|entry| *entry = *entry * (1.0 / f64::from(n)));
            total = sum(&total, &power, 1.0);
        }
        total
    }

    /// The coordinates of log(exp(−hu) exp δ exp(h(u + du))): variables 0..3 are δ, 3.. are du.
    fn change(&self, h: f64, u: &SVector<f64, U>) -> [Jet; 3] {
        let delta: [Jet; 3] = core::array::from_fn(|i| Jet::variable(0.0, i));
        let input: [Jet; U] = core::array::from_fn(|j| Jet::variable(u[j], 3 + j) * h);
        let back = self.exp((-u * h).as_slice());
        let moved = product(&constant(&back), &product(&self.jet_exp(&delta), &self.jet_exp(&input)));
        let off = sum(&moved, &constant(&Matrix3::identity()), -1.0);
        let log = sum(&off, &product(&off, &off), -0.5);
        core::array::from_fn(|i| {
            let dual = self.dual[i].transpose();
            log.iter().flatten().zip(&dual).fold(Jet::constant(0.0), |total, (entry, dual)| total + *entry * *dual)
        })
    }
}

impl<const U: usize> Controlled<3, U, 0> for Group<U> {
    type Scalar = f64;
    type Place = Matrix3<f64>;
    type Constants = f64;
    const NAME: &'static str = "Group";
    const BOUNDS: [&'static str; 0] = [];
    const MOTIONS: usize = 3;

    fn prepare(&self, h: f64) -> Result<f64, Error> {
        Ok(h)
    }

    fn check_place(&self, x: &Matrix3<f64>) -> Result<(), Error> {
        if x.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Error::NotFinite { name: "the place" }) }
    }

    fn follow(&self, h: &f64, _: f64, x: &Matrix3<f64>, u: &SVector<f64, U>) -> Result<Matrix3<f64>, Error> {
        Ok(x * self.exp((u * *h).as_slice()))
    }

    fn price(&self, h: &f64, _: f64, _: &Matrix3<f64>, u: &SVector<f64, U>) -> Result<f64, Error> {
        Ok(h * u.norm_squared() / 2.0)
    }

    fn expand(
        &self,
        h: &f64,
        t: f64,
        x: &Matrix3<f64>,
        u: &SVector<f64, U>,
        costate: &Vector3<f64>,
    ) -> Result<Expansion<Matrix3<f64>, f64, 3, U>, Error> {
        let change = self.change(*h, u);
        let curvature =
            change[0].curvature * costate.x + change[1].curvature * costate.y + change[2].curvature * costate.z;
        Ok(Expansion {
            next: self.follow(h, t, x, u)?,
            by_place: Matrix3::from_fn(|i, j| change[i].slope[j]),
            by_input: SMatrix::from_fn(|i, j| change[i].slope[3 + j]),
            price: self.price(h, t, x, u)?,
            price_by_place: Vector3::zeros(),
            price_by_input: u * *h,
            place_curvature: curvature.fixed_view::<3, 3>(0, 0).into_owned(),
            mixed_curvature: SMatrix::from_fn(|i, j| curvature[(3 + i, j)]),
            input_curvature: SMatrix::from_fn(|i, j| curvature[(3 + i, 3 + j)] + if i == j { *h } else { 0.0 }),
        })
    }

    fn price_of_time(
        &self,
        _: &f64,
        _: f64,
        _: f64,
        _: &Matrix3<f64>,
        u: &SVector<f64, U>,
        costate: &Vector3<f64>,
    ) -> Result<f64, Error> {
        Ok(u.norm_squared() / 2.0 + (0..U).map(|j| u[j] * costate[j]).sum::<f64>())
    }

    fn bounds(&self, _: &f64, _: f64, _: &Matrix3<f64>, _: &SVector<f64, U>) -> Result<SVector<f64, 0>, Error> {
        Ok(SVector::zeros())
    }

    fn bounds_expanded(
        &self,
        _: &f64,
        _: f64,
        _: &Matrix3<f64>,
        _: &SVector<f64, U>,
        _: &SVector<f64, 0>,
    ) -> Result<BoundsExpansion<f64, 3, U, 0>, Error> {
        Ok(crate::no_bounds())
    }

    fn endpoint(&self, _: &f64, _: f64, _: &Matrix3<f64>) -> f64 {
        0.0
    }

    fn endpoint_expanded(&self, _: &f64, _: f64, _: &Matrix3<f64>) -> EndpointExpansion<f64, 3> {
        EndpointExpansion { price: 0.0, by_time: 0.0, slope: Vector3::zeros(), curvature: Matrix3::zeros() }
    }

    fn arrival(&self, x: &Matrix3<f64>, target: &Matrix3<f64>) -> Arrival<f64, 3> {
        let motions = self.basis.map(|e| x * e);
        Arrival {
            residual: Vector3::from_fn(|i, _| motions[i].dot(&(target - x))),
            slope: Matrix3::from_fn(|i, j| motions[i].dot(&motions[j])),
        }
    }

    fn displacement(&self, x: &Matrix3<f64>, y: &Matrix3<f64>) -> Vector3<f64> {
        let Arrival { residual, slope } = self.arrival(x, y);
        slope.lu().solve(&residual).unwrap_or_default()
    }

    fn moved(&self, x: &Matrix3<f64>, eta: &Vector3<f64>) -> Matrix3<f64> {
        x * self.exp(eta.as_slice())
    }

    fn infinitesimal_motion(&self, x: &Matrix3<f64>, eta: &Vector3<f64>) -> Matrix3<f64> {
        x * self.algebra(eta.as_slice())
    }
}
