//! The degree of a map to the sphere: how often it covers the sphere, with signs.

use super::Grid;
#[cfg(feature = "alloc")]
use super::Mesh;
use crate::{Error, Real};
use nalgebra::Vector3;

/// The signed area of the triangle of three unit vectors on the sphere, between −2π and 2π.
///
/// Source: Van Oosterom and Strackee, *The solid angle of a plane triangle*, IEEE Transactions on Biomedical Engineering 30 (1983).
fn area<T: Real>([a, b, c]: [&Vector3<T>; 3]) -> T {
    let (y, x) = (a.cross(b).dot(c), T::one() + a.dot(b) + b.dot(c) + c.dot(a));
    // twice the angle of (x, y), by that of a half of it
    let length = (x * x + y * y).sqrt();
    if length.is_zero() {
        return T::zero();
    }
    let half = if x > T::zero() { y / (length + x) } else { (length - x) / y };
    half.atan() * T::from_ratio(4, 1)
}

/// The areas of the triangles that the corners of a face make with the first one.
fn area_of_face<T: Real>(q: &[Vector3<T>], mut corners: impl Iterator<Item = usize>) -> T {
    let mut at = move || q.get(corners.next()?);
    let (mut total, Some(first), Some(mut last)) = (T::zero(), at(), at()) else { return T::zero() };
    while let Some(next) = at() {
        total += area([first, last, next]);
        last = next;
    }
    total
}

/// The areas of all faces, over that of the sphere.
fn degree<T: Real>(areas: impl Iterator<Item = T>) -> T {
    areas.fold(T::zero(), |sum, area| sum + area) / (T::from_ratio(4, 1) * T::PI)
}

/// There is a unit vector for each site.
fn check<T: Real>(q: &[Vector3<T>], sites: usize) -> Result<(), Error> {
    let found = q.len();
    if found == sites { Ok(()) } else { Err(Error::NumberOfSites { found, sites }) }
}

impl<T: Real> Grid<T, 2> {
    /// The degree of a map to the sphere, one unit vector for each site: the signed areas of the images of all squares, over 4π. An
    /// integer where the grid is periodic.
    ///
    /// It jumps where a square covers half of the sphere.
    ///
    /// ```
    /// use clebsch::{Error, Grid};
    /// use nalgebra::Vector3;
    ///
    /// // a half of the sphere: once around in the second direction, from the pole to the equator in the first
    /// let grid: Grid<f64, 2> = Grid::new([9, 12]);
    /// let turn = |site: usize| (site / 12) as f64 * core::f64::consts::FRAC_PI_2 / 8.0;
    /// let around = |site: usize| (site % 12) as f64 * core::f64::consts::TAU / 11.0;
    /// let place = |i: usize| Vector3::new(turn(i).sin() * around(i).cos(), turn(i).sin() * around(i).sin(), turn(i).cos());
    /// let degree = grid.degree(&(0..108).map(place).collect::<Vec<_>>())?;
    /// assert!((degree - 0.5).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NumberOfSites`].
    pub fn degree(&self, q: &[Vector3<T>]) -> Result<T, Error> {
        check(q, self.sites())?;
        let square = |site: usize| {
            let [down, right] = [0, 1].map(|d| self.around(site, &self.split(site), d)[1]);
            let (down, right) = (down?, right?);
            let across = self.around(down, &self.split(down), 1)[1]?;
            Some(area_of_face(q, [site, down, across, right].into_iter()))
        };
        Ok(degree((0..self.sites()).filter_map(square)))
    }
}

#[cfg(feature = "alloc")]
impl<T: Real> Mesh<T> {
    /// The degree of a map to the sphere, one unit vector for each site: the signed areas of the images of all faces, over 4π. An
    /// integer where the mesh has no border.
    ///
    /// It jumps where a face covers half of the sphere.
    ///
    /// ```
    /// use clebsch::{Error, Mesh};
    /// use nalgebra::Vector3;
    ///
    /// let (x, y, z) = (Vector3::<f64>::x(), Vector3::y(), Vector3::z());
    /// let octahedron = [x, y, z, -x, -y, -z];
    /// let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    /// let mesh = Mesh::new(&octahedron, &faces)?;
    /// assert!((mesh.degree(&octahedron)? - 1.0).abs() < 1e-15);
    /// assert!((mesh.degree(&octahedron.map(|v| -v))? + 1.0).abs() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::NumberOfSites`].
    pub fn degree(&self, q: &[Vector3<T>]) -> Result<T, Error> {
        check(q, self.sites())?;
        Ok(degree(self.faces().map(|corners| area_of_face(q, corners.iter().copied()))))
    }
}
