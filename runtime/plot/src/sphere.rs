//! Paths on a sphere.

use crate::error::{at_step, finite};
use crate::figure::{self, Area, Drawn, Globe, INK, Pointer, Track, View};
use crate::picture::{Page, colour, picture, short};
use crate::{PlotError, Point};
use nalgebra::Vector3;

/// The path of a point on a sphere: `point` gives it for each state. See [`Sphere`].
///
/// # Errors
/// [`PlotError::Step`] where a state was not reached, [`PlotError::NotFinite`] and [`PlotError::NoDirection`] of a point.
pub fn sphere<A, P: Point>(
    states: impl IntoIterator<Item = Result<A, clebsch::Error>>,
    point: impl Fn(&A) -> P,
) -> Result<Sphere, PlotError> {
    let points = states.into_iter().enumerate();
    let points: Result<Vec<P>, PlotError> =
        points.map(|(index, state)| state.map(|state| point(&state)).map_err(at_step(index))).collect();
    Sphere::new().path("path", points?)
}

/// Paths on a sphere, seen from far away: the far side is paler than the near one.
///
/// A point is shown by its direction from the origin, so the path of an angular momentum may have any length.
/// A single path is coloured by time, and several have a colour each. The third axis points up.
///
/// ```
/// use clebsch::Clebsch;
/// use clebsch_plot::sphere;
/// use nalgebra::Vector3;
///
/// /// A pendulum of length one and mass one.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action    = |F: SO<3>, q: Unit<Vector3>| F * q,
///     cost      = |h, F| (F - I).norm_squared() / (4 * h),
///     potential = |q| self.gravity * q.z,
/// )]
/// struct Bob {
///     /// g, m/s².
///     gravity: f64,
/// }
///
/// let stepper = Bob { gravity: 9.81 }.into_stepper(0.01)?;
/// let start = stepper.state(Vector3::x(), Vector3::new(0.0, 0.3, 0.5))?;
/// let path = sphere(stepper.trajectory(start).take(1000), |state| *state.configuration())?;
/// # let folder = std::env::temp_dir().join(format!("clebsch-plot-sphere-{}", std::process::id()));
/// # let file = |name: &str| folder.join(name);
/// path.title("A pendulum").save(file("bob.svg"))?;
/// # std::fs::remove_dir_all(folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sphere {
    page: Page,
    paths: Vec<(String, Vec<[f64; 3]>)>,
    axes: Vec<(String, [f64; 3])>,
    view: Option<View>,
}

picture!(Sphere);

/// Points that lie nearer to each other, in radii, are one point of the drawing.
const NEAR: f64 = 5e-4;

impl Default for Sphere {
    fn default() -> Self {
        Self::new()
    }
}

impl Sphere {
    /// No paths yet.
    pub fn new() -> Self {
        let up = ("e3".to_owned(), [0.0, 0.0, 1.0]);
        Self { page: Page::new("", (520, 560)), paths: Vec::new(), axes: vec![up], view: None }
    }

    /// And a path with a name: its points in the order of time.
    ///
    /// # Errors
    /// [`PlotError::NotFinite`] and [`PlotError::NoDirection`] with the number of the point.
    pub fn path<P: Point>(mut self, name: &str, points: impl IntoIterator<Item = P>) -> Result<Self, PlotError> {
        let mut path: Vec<[f64; 3]> = Vec::new();
        let mut last = None;
        for (index, point) in points.into_iter().enumerate() {
            let point = direction(&point, name, index)?;
            if path.last().is_none_or(|before| distance(before, &point) > NEAR) {
                path.push(point);
                last = None;
            } else {
                last = Some(point);
            }
        }
        path.extend(last);
        self.paths.push((name.to_owned(), path));
        Ok(self)
    }

    /// And an axis with a name at its tip. The first call replaces the third axis.
    ///
    /// # Errors
    /// [`PlotError::NotFinite`] and [`PlotError::NoDirection`].
    pub fn axis(mut self, name: &str, axis: Vector3<f64>) -> Result<Self, PlotError> {
        let axis = direction(&axis, name, 0)?;
        self.axes.retain(|(name, _)| name != "e3");
        self.axes.push((name.to_owned(), axis));
        Ok(self)
    }

    /// The same sphere from another side, in degrees: turned about the third axis from the first, and above the plane of both.
    #[must_use]
    pub fn view(mut self, azimuth: f64, elevation: f64) -> Self {
        self.view = Some(View { azimuth, elevation });
        self
    }

    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError::Nothing`] without a point, and [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        if self.paths.iter().all(|(_, points)| points.is_empty()) {
            return Err(PlotError::Nothing);
        }
        self.page.svg(|area| self.paint(area))
    }

    fn paint(&self, area: &Area<'_>) -> Drawn {
        let is_single = self.paths.len() == 1;
        let paths: Vec<Vec<[f64; 3]>> = self.paths.iter().map(|(_, points)| visible(points)).collect();
        let tracks: Vec<Track<'_>> = paths
            .iter()
            .enumerate()
            .map(|(index, points)| Track { points, colour: (!is_single).then(|| colour(index)), width: 1.5 })
            .collect();
        let pointers: Vec<Pointer<'_>> =
            self.axes.iter().map(|(label, direction)| Pointer { label, direction: *direction, colour: INK }).collect();
        let view = self.view.unwrap_or_else(|| self.facing());
        Globe { view, pointers: &pointers, tracks: &tracks }.draw(area)?;
        if is_single {
            return figure::colour_bar(area, "start", "end");
        }
        let names: Vec<String> = self.paths.iter().map(|(name, _)| short(name, 24)).collect();
        figure::legend(area, names.iter().enumerate().map(|(index, name)| (name.as_str(), colour(index))))
    }

    /// The side that shows the most of the paths.
    fn facing(&self) -> View {
        let points = || self.paths.iter().flat_map(|(_, points)| points);
        let count = points().count().max(1) as f64;
        let mean = points().fold([0.0; 3], |sum, point| [0, 1, 2].map(|i| sum[i] + point[i] / count));
        let azimuth = if mean[0].hypot(mean[1]) > 0.1 { mean[1].atan2(mean[0]).to_degrees() } else { 30.0 };
        View { azimuth, elevation: if mean[2] < -0.2 { -25.0 } else { 25.0 } }
    }
}

/// A path that stays where it is, is a small ring.
fn visible(points: &[[f64; 3]]) -> Vec<[f64; 3]> {
    const RADIUS: f64 = 0.015;
    let Some(&middle) = points.first().filter(|first| points.iter().all(|point| distance(first, point) <= NEAR)) else {
        return points.to_vec();
    };
    // the axis that is farthest from the point gives two directions across it
    let least = (0..3).min_by(|&i, &j| middle[i].abs().total_cmp(&middle[j].abs())).unwrap_or(0);
    let middle = Vector3::from(middle);
    let across = middle.cross(&Vector3::ith(least, 1.0)).normalize();
    let other = middle.cross(&across);
    let angles = (0..=12).map(|i| f64::from(i) * std::f64::consts::TAU / 12.0);
    angles.map(|angle| (middle + (across * angle.cos() + other * angle.sin()) * RADIUS).normalize().into()).collect()
}

/// The unit vector towards a point.
fn direction(point: &impl Point, name: &str, index: usize) -> Result<[f64; 3], PlotError> {
    let point = finite(point.coordinates(), name, index)?;
    // a square of a large number overflows, and that of a small one is zero
    let largest = point.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
    if largest == 0.0 {
        return Err(PlotError::NoDirection { name: name.to_owned(), index });
    }
    let scaled = point.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Ok(scaled.map(|x| x / length))
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}
