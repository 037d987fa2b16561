//! Pages that play a motion in a browser.

mod page;
mod pose;
mod shape;
#[cfg(test)]
mod tests;

pub use pose::Pose;
pub use shape::Shape;

use crate::error::{at_step, finite};
use crate::{PlotError, Point};
use clebsch::Real;
use std::path::Path;

/// A motion on a page of its own: an HTML file without a network, a server or another file.
///
/// The page plays the states in a loop. Drag the picture to turn it, and move the slider to a time. It has a button, a
/// choice of speeds, and keys: space plays and pauses, arrows turn, `+` and `-` zoom. `motion.html#t=2.5` opens at that time.
///
/// Each part of the picture is a function of the state: [`body`](Self::body), [`point`](Self::point), [`link`](Self::link),
/// [`arrow`](Self::arrow), [`frame`](Self::frame) and [`sphere`](Self::sphere). A thousand states play smoothly.
///
/// ```
/// use clebsch::Clebsch;
/// use clebsch_plot::{Motion, Shape};
/// use nalgebra::{Matrix3, Vector3};
///
/// /// A rigid body turning about a fixed pivot in uniform gravity.
/// #[derive(Clebsch, Clone, Debug)]
/// #[clebsch(
///     action     = |F: SO<3>, R: SO<3>| R * F,
///     lagrangian = |omega| omega.dot(&self.moments.component_mul(&omega)) / 2,
///     potential  = |R| self.weight * R[(2, 2)],
/// )]
/// struct Top {
///     /// Principal moments of inertia, kg·m².
///     moments: Vector3<f64>,
///     /// Weight times the distance from the pivot to the centre of mass, N·m.
///     weight: f64,
/// }
///
/// let stepper = Top { moments: Vector3::new(1.0, 1.0, 0.5), weight: 1.0 }.into_stepper(0.01)?;
/// let start = stepper.state(Matrix3::identity(), Vector3::new(0.3, 0.0, 2.0))?;
/// # let path = std::env::temp_dir().join(format!("clebsch-play-{}.html", std::process::id()));
/// // let path = "motion.html";
///
/// Motion::new(stepper.trajectory(start).every(0.05).with_times().take(400))?
///     .body("top", Shape::cuboid([0.6, 0.6, 1.0]).at([0.0, 0.0, 0.5]), |state| *state.configuration())?
///     .point("axis", |state| state.configuration().column(2).into_owned())?
///     .sphere(1.0)
///     .save(&path)?;
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Motion<A> {
    title: String,
    time_unit: String,
    times: Vec<f64>,
    states: Vec<A>,
    parts: Vec<Part>,
    sphere: Option<f64>,
}

/// A part of the picture: its vectors at each state.
#[derive(Clone, Debug)]
struct Part {
    kind: Kind,
    name: String,
    /// For each state the place, and the vectors of the kind behind it.
    vectors: Vec<Vec<[f64; 3]>>,
}

/// How the vectors of a part are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A centre and three half axes.
    Cuboid,
    /// A centre and three half axes.
    Ellipsoid,
    /// An origin and three arrows.
    Frame,
    /// A place.
    Point,
    /// Two places.
    Link,
    /// A foot and an arrow.
    Arrow,
}

impl<A> Motion<A> {
    /// The states of a motion with their times, such as `trajectory.every(interval).with_times().take(n)`.
    ///
    /// # Errors
    /// [`PlotError::Step`] where a state was not reached, [`PlotError::Nothing`] without one, [`PlotError::NotFinite`] and
    /// [`PlotError::TimeOrder`] of times.
    pub fn new<T: Real>(samples: impl IntoIterator<Item = Result<(T, A), clebsch::Error>>) -> Result<Self, PlotError> {
        let mut times: Vec<f64> = Vec::new();
        let mut states = Vec::new();
        for (index, sample) in samples.into_iter().enumerate() {
            let (time, state) = sample.map_err(at_step(index))?;
            let [time] = finite([time.to_f64()], "time", index)?;
            // times of steps back in time fall
            let goes_on = match times[..] {
                [] => true,
                [first] => time != first,
                [first, second, ..] => {
                    let last = times[index - 1];
                    if second > first { time > last } else { time < last }
                }
            };
            if !goes_on {
                return Err(PlotError::TimeOrder { index });
            }
            times.push(time);
            states.push(state);
        }
        if states.is_empty() {
            return Err(PlotError::Nothing);
        }
        let (title, time_unit) = ("Motion".to_owned(), String::new());
        Ok(Self { title, time_unit, times, states, parts: Vec::new(), sphere: None })
    }

    /// And a body with its [`Shape`]. Its [`Pose`] comes from an attitude, a place, or both.
    ///
    /// A matrix that is no rotation deforms the body, as a drop of fluid.
    ///
    /// # Errors
    /// [`PlotError::NoBody`] for a shape that cannot be, and [`PlotError::NotFinite`] with the number of the state.
    pub fn body<P: Into<Pose>>(self, name: &str, shape: Shape, pose: impl Fn(&A) -> P) -> Result<Self, PlotError> {
        let half = shape.half_sides().ok_or_else(|| PlotError::NoBody { name: name.to_owned() })?;
        let kind = if shape.is_round() { Kind::Ellipsoid } else { Kind::Cuboid };
        self.part(kind, name, |state| {
            let pose: Pose = pose(state).into();
            let axes = [0, 1, 2].map(|k| pose.axes()[k].map(|x| x * half[k]));
            vec![pose.point(shape.centre()), axes[0], axes[1], axes[2]]
        })
    }

    /// And a point with its path.
    ///
    /// # Errors
    /// [`PlotError::NotFinite`] with the number of the state.
    pub fn point<P: Point>(self, name: &str, point: impl Fn(&A) -> P) -> Result<Self, PlotError> {
        self.part(Kind::Point, name, |state| vec![point(state).coordinates()])
    }

    /// And a line between two points: a rod, a spring, a thread.
    ///
    /// # Errors
    /// [`PlotError::NotFinite`] with the number of the state.
    pub fn link<P: Point>(self, name: &str, ends: impl Fn(&A) -> [P; 2]) -> Result<Self, PlotError> {
        self.part(Kind::Link, name, |state| ends(state).map(|end| end.coordinates()).to_vec())
    }

    /// And an arrow: its foot and its vector, such as an angular momentum. The vector has the lengths of the picture.
    ///
    /// # Errors
    /// [`PlotError::NotFinite`] with the number of the state.
    pub fn arrow<P: Point>(self, name: &str, arrow: impl Fn(&A) -> [P; 2]) -> Result<Self, PlotError> {
        self.part(Kind::Arrow, name, |state| arrow(state).map(|end| end.coordinates()).to_vec())
    }

    /// And a frame: three arrows of a length, along the axes of a [`Pose`].
    ///
    /// # Errors
    /// [`PlotError::Range`] for a length that is not above zero and finite, and [`PlotError::NotFinite`] with the number of the state.
    pub fn frame<P: Into<Pose>>(self, name: &str, length: f64, pose: impl Fn(&A) -> P) -> Result<Self, PlotError> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(PlotError::Range { name: "length of a frame", value: length });
        }
        self.part(Kind::Frame, name, |state| {
            let pose: Pose = pose(state).into();
            let axes = pose.axes().map(|axis| axis.map(|x| x * length));
            vec![pose.place(), axes[0], axes[1], axes[2]]
        })
    }

    /// And a sphere about the origin, with circles of latitude and longitude. One that is not above zero and finite is left out.
    #[must_use]
    pub fn sphere(mut self, radius: f64) -> Self {
        self.sphere = Some(radius).filter(|radius| *radius > 0.0 && radius.is_finite());
        self
    }

    /// The same motion with another title.
    #[must_use]
    pub fn title(mut self, title: &str) -> Self {
        self.title = title.to_owned();
        self
    }

    /// The unit of the time, such as `s`.
    #[must_use]
    pub fn time_unit(mut self, unit: &str) -> Self {
        self.time_unit = unit.to_owned();
        self
    }

    /// The page as a text.
    ///
    /// # Errors
    /// [`PlotError::Nothing`] where there is no part to draw.
    pub fn html(&self) -> Result<String, PlotError> {
        if self.parts.is_empty() {
            return Err(PlotError::Nothing);
        }
        Ok(page::write(&self.title, &self.time_unit, &self.times, &self.parts, self.sphere))
    }

    /// Writes the page to a file. A folder that is not there is made.
    ///
    /// # Errors
    /// Those of [`html`](Self::html), and [`PlotError::File`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), PlotError> {
        crate::picture::write(path.as_ref(), &self.html()?)
    }

    fn part(mut self, kind: Kind, name: &str, vectors: impl Fn(&A) -> Vec<[f64; 3]>) -> Result<Self, PlotError> {
        let checked = self.states.iter().enumerate().map(|(index, state)| {
            let vectors = vectors(state);
            vectors.iter().try_for_each(|vector| finite(*vector, name, index).map(|_| ()))?;
            Ok(vectors)
        });
        let vectors = checked.collect::<Result<Vec<_>, PlotError>>()?;
        self.parts.push(Part { kind, name: name.to_owned(), vectors });
        Ok(self)
    }
}

impl Part {
    /// The outermost points of the part, at one state.
    fn reach(&self, vectors: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let Some((&place, others)) = vectors.split_first() else { return Vec::new() };
        // sums of the largest numbers overflow
        const FARTHEST: f64 = 1e308;
        let moved = |vector: &[f64; 3]| [0, 1, 2].map(|i| (place[i] + vector[i]).clamp(-FARTHEST, FARTHEST));
        match self.kind {
            // corners, or more than the ends of the axes
            Kind::Cuboid | Kind::Ellipsoid => {
                let share = if self.kind == Kind::Cuboid { 1.0 } else { 0.75 };
                let sign = |corner: u8, k: usize| if corner >> k & 1 == 1 { share } else { -share };
                let sum = |corner: u8, i: usize| (0..3).map(|k| others[k][i] * sign(corner, k)).sum::<f64>();
                (0..8).map(|corner| moved(&[0, 1, 2].map(|i| sum(corner, i)))).collect()
            }
            Kind::Frame | Kind::Arrow => [place].into_iter().chain(others.iter().map(moved)).collect(),
            Kind::Point | Kind::Link => vectors.to_vec(),
        }
    }
}

impl Kind {
    /// The name on the page.
    fn name(self) -> &'static str {
        match self {
            Self::Cuboid => "cuboid",
            Self::Ellipsoid => "ellipsoid",
            Self::Frame => "frame",
            Self::Point => "point",
            Self::Link => "link",
            Self::Arrow => "arrow",
        }
    }

    /// Whether vector k is a place, not a direction.
    fn is_place(self, k: usize) -> bool {
        k == 0 || self == Self::Link
    }
}
