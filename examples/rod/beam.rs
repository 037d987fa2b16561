//! Numbers of rods, and those of the flying rod of Simo and Vu-Quoc.

/// A uniform rod without curvature.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    /// Metres.
    pub length: f64,
    /// EI in both directions, N·m².
    pub bending: f64,
    /// GJ, N·m².
    pub torsion: f64,
    /// GA, N.
    pub shear: f64,
    /// EA, N.
    pub axial: f64,
    /// ρA, kg/m.
    pub mass: f64,
    /// ρI about each axis, kg·m.
    pub inertia: f64,
}

/// That of Simo and Vu-Quoc.
pub const FLYING: Beam =
    Beam { length: 10.0, bending: 500.0, torsion: 500.0, shear: 1e4, axial: 1e4, mass: 1.0, inertia: 10.0 };
/// Its lower end and its upper end at the start, metres.
pub const ENDS: [[f64; 2]; 2] = [[6.0, 0.0], [0.0, 8.0]];

impl Beam {
    /// The length of one of so many edges.
    pub fn spacing(&self, edges: usize) -> f64 {
        self.length / edges as f64
    }
}
