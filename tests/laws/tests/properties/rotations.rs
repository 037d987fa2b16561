//! The free motion of rigid bodies: its laws, and the momenta of given rotations.

use crate::arbitrary::{cases, vector};
use crate::runner::proptest;
use clebsch::__private::{FreeRotation, FreeRotation4, free_momentum, free_momentum_4d};
use clebsch_tests::oracle::near::assert_near;
use nalgebra::{Matrix3, Matrix4, SMatrix, SVector, Vector3};
use proptest::prelude::*;

/// A few roundings of angles and momenta of order one.
const NEAR: f64 = 2e-14;

/// The rotation with this Gibbs vector.
fn turn(c: &Vector3<f64>) -> Matrix3<f64> {
    let hat = c.cross_matrix();
    Matrix3::identity() + (hat + hat * hat) * (2.0 / (1.0 + c.norm_squared()))
}

/// Σ of a body in four dimensions whose moments ∫x_i² dm are these: the sums of two, as the basis has |E|² = 2.
fn inertia(mass: &SVector<f64, 4>) -> SMatrix<f64, 6, 6> {
    let planes = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];
    SMatrix::from_diagonal(&SVector::from_fn(|index, _| mass[planes[index].0] + mass[planes[index].1]))
}

proptest! {
    #![proptest_config(cases(24))]

    /// Moments, momentum and time: the motion back undoes it, energy and spatial momentum stay, and the constants of a
    /// motion make the same turn.
    #[test]
    fn free_bodies_turn_back(moments in prop::array::uniform3(0.3_f64..3.0), mu in vector::<3>(1.0), h in 0.01_f64..0.5) {
        let inertia = Matrix3::from_diagonal(&moments.into());
        let free = FreeRotation::new(&inertia, h)?;
        let c = free.gibbs_vector(&mu)?;
        let (w, x) = free.turn(&mu)?;
        assert_near(&(x / w), &c, NEAR, "the same turn");
        let f = turn(&c);
        let later = f.transpose() * mu;
        let energy = |mu: &Vector3<f64>| (0..3).map(|i| mu[i] * mu[i] / moments[i]).sum::<f64>();
        prop_assert!((energy(&later) - energy(&mu)).abs() <= NEAR * energy(&mu));
        let back = FreeRotation::new(&inertia, -h)?.gibbs_vector(&later)?;
        assert_near(&(f * turn(&back)), &Matrix3::identity(), NEAR, "there and back");
        let kept = free.motion(&mu);
        assert_near(&free.gibbs_vector_of(&kept, &mu)?, &c, NEAR, "what is kept");
        let (w, x) = free.turn_of(&kept, &mu)?;
        assert_near(&(x / w), &c, NEAR, "what is kept");
        // the same quaternion or its negative, with w ≥ 0, for any number of turns
        let long = FreeRotation::new(&inertia, 40.0 * h)?;
        let long_kept = long.motion(&mu);
        for ((w, x), (v, y)) in [(long.turn(&mu)?, long.shorter_turn(&mu)?), (long.turn_of(&long_kept, &mu)?, long.shorter_turn_of(&long_kept, &mu)?)] {
            prop_assert_eq!((v, y), if w < 0.0 { (-w, -x) } else { (w, x) });
        }
        // and of the same motion later
        let (first, second) = (free.gibbs_vector_of(&kept, &later)?, free.gibbs_vector(&later)?);
        assert_near(&first, &second, NEAR, "what is kept later");
        prop_assert_eq!(FreeRotation::to_tolerance(&inertia, h, 0.0)?.gibbs_vector(&mu)?, c);
    }

    /// Rotations of less than half a turn: h ω is at most 3, over which the condition of momenta grows like 1/cos²(θ/2).
    #[test]
    fn momenta_belong_to_their_rotations(moments in prop::array::uniform3(0.5_f64..2.0), mu in vector::<3>(1.0), h in 0.05_f64..0.5) {
        let inertia = Matrix3::from_diagonal(&moments.into());
        let free = FreeRotation::new(&inertia, h)?;
        let c = free.gibbs_vector(&mu)?;
        let near = NEAR * (1.0 + c.norm_squared()) / h;
        assert_near(&free.momentum(&c), &mu, near, "the momentum");
        assert_near(&free_momentum(&inertia, h, &c), &mu, near, "the momentum");
    }

    /// The same in four dimensions, with the step of a motion: F is a rotation, and its momentum is that.
    #[test]
    fn momenta_belong_to_their_rotations_of_four_dimensions(mass in vector::<4>(0.4), mu in vector::<6>(1.0), h in 0.05_f64..0.5) {
        let inertia = inertia(&mass.add_scalar(1.0));
        let free = FreeRotation4::new(&inertia, h)?;
        let (increment, next) = free.turn(&free.motion(&mu), &mu)?;
        let f = Matrix4::identity() + increment;
        assert_near(&(f.transpose() * f), &Matrix4::identity(), NEAR, "a rotation");
        assert_near(&free_momentum_4d(&inertia, h, &f), &mu, 20.0 * NEAR / h, "the momentum");
        // backwards from the momentum at the end
        let back = FreeRotation4::new(&inertia, -h)?;
        let (increment, first) = back.turn(&back.motion(&next), &next)?;
        assert_near(&(f * (Matrix4::identity() + increment)), &Matrix4::identity(), 10.0 * NEAR, "there and back");
        assert_near(&first, &mu, 10.0 * NEAR, "the momentum");
    }
}
