//! The columns of a table against time.

use crate::PlotError;
use crate::figure::{self, Area, Drawn, Panel, Series, along};
use crate::picture::{Page, colour, picture};
use crate::rows::{Column, read};
use crate::thin::thin;
use clebsch::{Clebsch, Method, Real, Sample, Table};

/// The values of a table against time, one chart each. See [`Quantities`].
///
/// # Errors
/// [`PlotError::Step`] where a state was not reached, [`PlotError::NotFinite`] with the column, and [`PlotError::Nothing`] without a state.
pub fn quantities<S, M, L, A>(
    table: Table<'_, S, M, L>,
    samples: impl IntoIterator<Item = Result<A, clebsch::Error>>,
) -> Result<Quantities, PlotError>
where
    S: Clebsch<Scalar: Real>,
    M: Method<S>,
    L: clebsch::Quantities<S, M>,
    A: Sample<S, M>,
{
    let mut columns = read(&table, samples, |_| ())?.into_iter();
    let Some(time) = columns.next() else { return Err(PlotError::Nothing) };
    let mut values: Vec<Vec<Column>> = Vec::new();
    for column in columns {
        match values.last_mut().filter(|value| value[0].value == column.value) {
            Some(value) => value.push(column),
            None => values.push(vec![column]),
        }
    }
    let mut quantities = Quantities { page: Page::new("", (800, 0)), time, values };
    quantities.fit();
    Ok(quantities)
}

/// Values against time: a chart for each value of a table, with a curve for each of its numbers.
///
/// Names and units are those of the [`Table`]: the configuration by the names of the declaration, the momentum, and the
/// values behind them. Runs of a million states draw as fast as short ones: a curve has no more points than the eye can see.
///
/// ```
/// use clebsch::Clebsch;
/// use clebsch_plot::quantities;
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
/// let table = stepper.table().energy().units(&[("t", "s"), ("q", "m"), ("energy", "J")]);
/// let picture = quantities(table, stepper.trajectory(start).every(0.05).with_times().take(200))?;
/// let svg = picture.only(&["q", "energy"])?.title("A pendulum").svg()?; // or .save("bob.svg")
/// assert!(svg.contains("q.z") && svg.contains("t (s)") && !svg.contains("N[0]"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Quantities {
    page: Page,
    time: Column,
    /// The columns of each value.
    values: Vec<Vec<Column>>,
}

picture!(Quantities);

/// Heights of the title, of a chart, and of the axis of the time, pixels.
const HEIGHTS: [f64; 3] = [30.0, 150.0, 30.0];

/// So many curves have a name and a colour of their own.
const NAMED: usize = 9;

impl Quantities {
    /// The charts of these values alone, in this order. A value has the name of its table: `R`, `N`, `energy`.
    ///
    /// # Errors
    /// [`PlotError::UnknownName`].
    pub fn only(mut self, names: &[&str]) -> Result<Self, PlotError> {
        let find = |name: &&str| self.values.iter().find(|value| value[0].value == *name).cloned();
        let chosen: Vec<_> = names.iter().map(|name| find(name).ok_or(*name)).collect();
        let known = || self.values.iter().map(|value| value[0].value.to_owned()).collect();
        let chosen: Result<Vec<_>, &str> = chosen.into_iter().collect();
        self.values = chosen.map_err(|name| PlotError::UnknownName { name: name.to_owned(), known: known() })?;
        self.fit();
        Ok(self)
    }

    /// The height of all charts.
    fn fit(&mut self) {
        let [title, chart, axis] = HEIGHTS;
        self.page.resize(self.page.size.0, (title + chart * self.values.len() as f64 + axis) as u32);
    }

    /// The picture as the text of an SVG file.
    ///
    /// # Errors
    /// [`PlotError::Nothing`] without a value, and [`PlotError::Drawing`].
    pub fn svg(&self) -> Result<String, PlotError> {
        if self.values.is_empty() {
            return Err(PlotError::Nothing);
        }
        self.page.svg(|area| self.paint(area))
    }

    fn paint(&self, area: &Area<'_>) -> Drawn {
        let label = |name: &str, unit: &str| if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") };
        let time = label(&self.time.name, &self.time.unit);
        let (_, height) = area.dim_in_pixel();
        let axis = HEIGHTS[2] * 10.0;
        let each = (f64::from(height) - axis) / self.values.len() as f64 / 10.0;
        let mut area = area.clone();
        for (index, value) in self.values.iter().enumerate() {
            let is_last = index + 1 == self.values.len();
            let panel = Panel {
                title: value[0].value,
                unit: &value[0].unit,
                x_label: if is_last { &time } else { "" },
                series: self.curves(value),
            };
            if is_last {
                panel.draw(&area)?;
            } else {
                let (chart, below) = figure::rows(&area, each);
                panel.draw(&chart)?;
                area = below;
            }
        }
        Ok(())
    }

    fn curves<'a>(&'a self, value: &'a [Column]) -> Vec<Series<'a>> {
        let last = (value.len() - 1).max(1) as f64;
        let curve = |(index, column): (usize, &'a Column)| Series {
            label: if (2..=NAMED).contains(&value.len()) { &column.name } else { "" },
            colour: if value.len() > NAMED { along(index as f64 / last) } else { colour(index) },
            points: thin(self.time.numbers.iter().copied().zip(column.numbers.iter().copied()).collect()),
        };
        value.iter().enumerate().map(curve).collect()
    }
}
