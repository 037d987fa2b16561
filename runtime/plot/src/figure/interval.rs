//! A computed number against a published interval.

use super::canvas::{Area, Drawn};
use super::theme::{BLUE, INK, ORANGE, PAPER, SOFT_INK, blend, px, stroke, text, unit, write};
use plotters::prelude::{Circle, Rectangle};
use plotters::style::Color;
use plotters::style::text_anchor::{HPos, VPos};

/// A published value with its uncertainty, and the computed one.
///
/// ```
/// use clebsch_plot::figure::{self, Interval};
///
/// let period = Interval { title: "Period (days)", published: 7.40, uncertainty: 0.03, computed: 7.4116 };
/// let svg = figure::svg((500, 90), |area| period.draw(area))?;
/// assert!(svg.contains("7.412"));
/// # Ok::<(), figure::Broken>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Interval<'a> {
    /// Its name, with its unit.
    pub title: &'a str,
    /// The published value.
    pub published: f64,
    /// Its uncertainty, to both sides.
    pub uncertainty: f64,
    /// The computed value.
    pub computed: f64,
}

impl Interval<'_> {
    /// Draws one line: a bar for the published interval, a dot for the computed value.
    pub fn draw(&self, area: &Area<'_>) -> Drawn {
        let (left, right) = (px(64.0), area.dim_in_pixel().0 as i32 - px(18.0));
        let (low, high) = (self.published - 2.0 * self.uncertainty, self.published + 2.0 * self.uncertainty);
        let place = |value: f64| left + unit((value - low) / (high - low) * f64::from(right - left));
        write(area, self.title, (left, px(12.0)), text(13.5, INK, HPos::Left, VPos::Center))?;
        let y = px(44.0);
        let corners = [
            (place(self.published - self.uncertainty), y - px(6.0)),
            (place(self.published + self.uncertainty), y + px(6.0)),
        ];
        area.draw(&Rectangle::new(corners, blend(ORANGE, PAPER, 0.72).filled()))?;
        stroke(area, vec![(left, y), (right, y)], SOFT_INK, 0.8)?;
        for tick in -2_i32..=2 {
            let value = self.published + f64::from(tick) * self.uncertainty;
            stroke(area, vec![(place(value), y - px(3.0)), (place(value), y + px(3.0))], SOFT_INK, 0.8)?;
            let colour = if tick == 0 { ORANGE } else { SOFT_INK };
            write(
                area,
                &format!("{value:.2}"),
                (place(value), y + px(18.0)),
                text(12.0, colour, HPos::Center, VPos::Center),
            )?;
        }
        let dot = place(self.computed.max(low).min(high));
        area.draw(&Circle::new((dot, y), px(4.5), BLUE.filled()))?;
        write(area, &format!("{:.3}", self.computed), (dot, y - px(15.0)), text(13.0, BLUE, HPos::Center, VPos::Center))
    }
}
