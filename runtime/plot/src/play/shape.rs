//! The looks of a body.

/// The shape of a body: a cuboid or an ellipsoid, with its sides along the axes of the body.
///
/// ```
/// use clebsch_plot::Shape;
///
/// let book = Shape::cuboid([0.2, 0.3, 0.04]);
/// let asteroid = Shape::ellipsoid([2.4, 1.2, 1.0]);
/// // of homogeneous bodies with these moments of inertia: a cube of side 1 and mass 6, and a ball of radius 1 and mass 5
/// assert_eq!(Shape::cuboid_of([1.0, 1.0, 1.0], 6.0), Shape::cuboid([1.0, 1.0, 1.0]));
/// assert_eq!(Shape::ellipsoid_of([2.0, 2.0, 2.0], 5.0), Shape::ellipsoid([2.0, 2.0, 2.0]));
/// // its centre one unit above the origin of the body
/// let top = Shape::cuboid_of([1.0, 1.2, 0.6], 1.0).at([0.0, 0.0, 1.0]);
/// # assert!(book != asteroid && top != book);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    sides: [f64; 3],
    centre: [f64; 3],
    is_round: bool,
}

impl Shape {
    /// A cuboid with these sides.
    pub fn cuboid(sides: [f64; 3]) -> Self {
        Self { sides, centre: [0.0; 3], is_round: false }
    }

    /// An ellipsoid with these diameters.
    pub fn ellipsoid(diameters: [f64; 3]) -> Self {
        Self { is_round: true, ..Self::cuboid(diameters) }
    }

    /// The homogeneous cuboid of these principal moments and this mass: a² = 6(J₂ + J₃ − J₁)/m, and so on.
    pub fn cuboid_of(moments: [f64; 3], mass: f64) -> Self {
        Self::cuboid(sides(moments, 6.0 / mass))
    }

    /// The homogeneous ellipsoid of these principal moments and this mass. Its diameters have a² = 10(J₂ + J₃ − J₁)/m, and so on.
    pub fn ellipsoid_of(moments: [f64; 3], mass: f64) -> Self {
        Self::ellipsoid(sides(moments, 10.0 / mass))
    }

    /// The same shape with its centre there, in the frame of the body.
    #[must_use]
    pub fn at(self, centre: [f64; 3]) -> Self {
        Self { centre, ..self }
    }

    pub(super) fn centre(&self) -> [f64; 3] {
        self.centre
    }

    pub(super) fn is_round(&self) -> bool {
        self.is_round
    }

    /// Half of the sides, none of them too thin to be seen. `None` if no body has these sides.
    pub(super) fn half_sides(&self) -> Option<[f64; 3]> {
        const THINNEST: f64 = 0.02;
        let largest = self.sides.iter().fold(0.0, |largest: f64, side| largest.max(*side));
        let exists = self.sides.iter().all(|side| *side >= 0.0 && side.is_finite());
        (exists && largest > 0.0).then(|| self.sides.map(|side| side.max(THINNEST * largest) / 2.0))
    }
}

/// √(factor (J₂ + J₃ − J₁)), and so on. A flat body has a side of zero, and rounding may put its square below that.
fn sides(moments: [f64; 3], factor: f64) -> [f64; 3] {
    const ROUNDING: f64 = 1e-9;
    let sum: f64 = moments.iter().sum();
    moments.map(|moment| {
        let square = factor * (sum - 2.0 * moment);
        if square < 0.0 && square > -ROUNDING * factor * sum { 0.0 } else { square.sqrt() }
    })
}
