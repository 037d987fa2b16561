//! Where a body is, and how it is turned.

use crate::Point;
use clebsch::Real;
use nalgebra::{Matrix2, Matrix3, Matrix4, Quaternion, SMatrix, Unit, Vector2, Vector3};

/// The place and the attitude of a body. Configurations and their parts give it:
///
/// | from | is |
/// |---|---|
/// | `Matrix3` | an attitude R, which turns the body frame into space |
/// | `Matrix4` | an element of `SE<3>`: attitude and place |
/// | `(Vector3, Matrix3)`, `(Vector3, Quaternion)` | place and attitude |
/// | `Quaternion`, `UnitQuaternion` | an attitude |
/// | `Vector3`, `Vector2` | a place |
/// | `Matrix2` | a turn in the plane of the first two axes |
///
/// ```
/// use clebsch_plot::Pose;
/// use nalgebra::{Matrix3, UnitQuaternion, Vector3};
///
/// let turned = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
/// let pose = Pose::from((Vector3::new(5.0, 0.0, 0.0), turned));
/// assert_eq!(pose.point([1.0, 0.0, 0.0]), [5.0, 1.0, 0.0]);
/// assert_eq!(Pose::from(UnitQuaternion::<f64>::identity()), Pose::from(Matrix3::<f64>::identity()));
/// assert_eq!(Pose::in_plane(5.0, 0.0, std::f64::consts::FRAC_PI_2).axes()[0][1], 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    place: [f64; 3],
    /// The axes of the body in space.
    axes: [[f64; 3]; 3],
}

impl Pose {
    /// A body in the plane of the first two axes: its place, and its turn in radians.
    pub fn in_plane(x: f64, y: f64, angle: f64) -> Self {
        let (sine, cosine) = angle.sin_cos();
        Self { place: [x, y, 0.0], axes: [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]] }
    }

    /// Where the origin of the body is.
    pub fn place(&self) -> [f64; 3] {
        self.place
    }

    /// The axes of the body in space: the columns of its attitude.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        self.axes
    }

    /// Where a point of the body is in space.
    pub fn point(&self, in_body: [f64; 3]) -> [f64; 3] {
        let turned = [0, 1, 2].map(|i| (0..3).map(|k| self.axes[k][i] * in_body[k]).sum::<f64>());
        [0, 1, 2].map(|i| self.place[i] + turned[i])
    }

    fn at(self, place: [f64; 3]) -> Self {
        Self { place, ..self }
    }
}

/// The columns of a matrix.
fn columns<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> [[f64; N]; N] {
    std::array::from_fn(|k| std::array::from_fn(|i| matrix[(i, k)].to_f64()))
}

impl<T: Real> From<Matrix3<T>> for Pose {
    fn from(attitude: Matrix3<T>) -> Self {
        Self { place: [0.0; 3], axes: columns(&attitude) }
    }
}

impl<T: Real> From<Matrix2<T>> for Pose {
    fn from(attitude: Matrix2<T>) -> Self {
        let [[a, b], [c, d]] = columns(&attitude);
        Self { place: [0.0; 3], axes: [[a, b, 0.0], [c, d, 0.0], [0.0, 0.0, 1.0]] }
    }
}

impl<T: Real> From<Matrix4<T>> for Pose {
    fn from(place: Matrix4<T>) -> Self {
        let [axes @ .., place] = columns(&place).map(|[x, y, z, _]| [x, y, z]);
        Self { place, axes }
    }
}

impl<T: Real> From<Quaternion<T>> for Pose {
    /// Divided by its length, but for zero.
    fn from(quaternion: Quaternion<T>) -> Self {
        let [[x, y, z, w]] = quaternion.coords.data.0.map(|column| column.map(T::to_f64));
        let square = w * w + x * x + y * y + z * z;
        let s = if square > 0.0 { 2.0 / square } else { 0.0 };
        let axes = [
            [1.0 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)],
            [s * (x * y - w * z), 1.0 - s * (x * x + z * z), s * (y * z + w * x)],
            [s * (x * z + w * y), s * (y * z - w * x), 1.0 - s * (x * x + y * y)],
        ];
        Self { place: [0.0; 3], axes }
    }
}

impl<T: Real> From<Unit<Quaternion<T>>> for Pose {
    fn from(quaternion: Unit<Quaternion<T>>) -> Self {
        quaternion.into_inner().into()
    }
}

impl<T: Real> From<Vector3<T>> for Pose {
    fn from(place: Vector3<T>) -> Self {
        Self::in_plane(0.0, 0.0, 0.0).at(place.coordinates())
    }
}

impl<T: Real> From<Vector2<T>> for Pose {
    fn from(place: Vector2<T>) -> Self {
        Self::in_plane(0.0, 0.0, 0.0).at(place.coordinates())
    }
}

impl<T: Real, R: Into<Pose>> From<(Vector3<T>, R)> for Pose {
    fn from((place, attitude): (Vector3<T>, R)) -> Self {
        attitude.into().at(place.coordinates())
    }
}
