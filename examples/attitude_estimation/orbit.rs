//! The motion of the satellite, and its measurements.
//!
//! Orbit, rate, noise and initial errors are those of Crassidis and Markley, *Unscented filtering for spacecraft attitude estimation* (2003).
//! The field of the Earth is a tilted dipole here.

use crate::declaration::Satellite;
use crate::{Flags, Place};
use clebsch_examples::noise::Noise;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Steps of h, s.
pub struct Orbit {
    pub h: f64,
    /// The places at the start of each step, and at the end.
    pub places: Vec<Place>,
    /// The gyro in each step.
    pub gyro: Vec<Vector3<f64>>,
    /// The field in space, and as it is measured, at each place.
    pub field: Vec<(Vector3<f64>, Vector3<f64>)>,
    pub satellite: Satellite,
}

/// Standard deviations: of the gyro in rad/√s, of its bias in rad/s per √s, of the magnetometer in μT.
const GYRO: f64 = 3.162_3e-7;
const WALK: f64 = 3.162_3e-10;
const FIELD: f64 = 0.05;
/// The rate that points at the Earth, rad/s.
const RATE: Vector3<f64> = Vector3::new(0.0, -0.0011, 0.0);
/// The bias at the start, °/h.
const BIAS: f64 = 0.1;

/// rad/s in a degree per hour.
pub const PER_HOUR: f64 = std::f64::consts::PI / 180.0 / 3600.0;

pub fn turned(by: &Vector3<f64>) -> Matrix3<f64> {
    Rotation3::new(*by).into_inner()
}

impl Orbit {
    pub fn new(flags: &Flags) -> Self {
        let (h, steps) = (flags.run.step_size, flags.run.steps as usize);
        let satellite = Satellite {
            gyro_variance: GYRO * GYRO / h + WALK * WALK * h / 12.0,
            drift_variance: WALK * WALK / h,
            field_variance: FIELD * FIELD,
        };
        let mut random = Noise::new(flags.seed);
        let mut noise = |size: f64| Vector3::from_fn(|_, _| size * random.normal());
        let measure = |t: f64, attitude: &Matrix3<f64>, noise: Vector3<f64>| {
            let known = field(t);
            (known, attitude.transpose() * known + noise)
        };
        let mut place = (turned(&Vector3::new(0.3, 0.2, 0.1)), Vector3::repeat(BIAS * PER_HOUR));
        let mut orbit = Self { h, places: vec![place], gyro: Vec::new(), field: Vec::new(), satellite };
        orbit.field.push(measure(0.0, &place.0, noise(FIELD)));
        for k in 0..steps {
            orbit.gyro.push(RATE + place.1 + noise(orbit.satellite.gyro_variance.sqrt()));
            place = (place.0 * turned(&(RATE * h)), place.1 + noise(WALK * h.sqrt()));
            orbit.field.push(measure((k + 1) as f64 * h, &place.0, noise(FIELD)));
            orbit.places.push(place);
        }
        orbit
    }
}

/// The field of a dipole at the satellite, μT, in axes that do not turn. The orbit is a circle 350 km high, inclined by 35°.
fn field(t: f64) -> Vector3<f64> {
    let (earth, radius, inclination) = (6.3712e6_f64, 6.7212e6_f64, 35.0_f64.to_radians());
    let along = (3.986_004_418e14 / radius.powi(3)).sqrt() * t;
    let at = Vector3::new(along.cos(), along.sin() * inclination.cos(), along.sin() * inclination.sin());
    // 11° off the axis of the Earth, at 71° west, and turning with it
    let (tilt, longitude) = (11.0_f64.to_radians(), -71.0_f64.to_radians() + 7.292_115e-5 * t);
    let pole = -Vector3::new(tilt.sin() * longitude.cos(), tilt.sin() * longitude.sin(), tilt.cos());
    30.0 * (earth / radius).powi(3) * (3.0 * pole.dot(&at) * at - pole)
}
