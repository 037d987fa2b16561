//! The periods from the integration next to those from elsewhere.

use crate::Flags;
use crate::closed_form::{Tumbling, as_stepped};
use crate::periods::{Period, Periods};
use crate::watch::Watch;
use clebsch_examples::claims::Claims;
use clebsch_examples::round_off;
use clebsch_examples::table::Table;
use nalgebra::Vector3;

/// Value and uncertainty, days. Zhao and Ji (2015), from the flyby of Chang'e-2.
pub const PUBLISHED: Periods<(f64, f64)> = Periods { rotation: (5.38, 0.03), precession: (7.40, 0.03) };
/// Another integration of the same data, days.
const INDEPENDENT: Periods<f64> = Periods { rotation: 5.369, precession: 7.412 };
/// The angle of a step, radians, above which the leading terms of a series in h say nothing reliable.
const LONGEST_STEP: f64 = 0.5;

/// Both periods in days, from several sources; none where the motion has none, or is too short to show them.
pub struct Comparison {
    /// From the trajectory.
    pub measured: Option<Periods<f64>>,
    /// From elliptic integrals.
    exact: Tumbling,
    /// From elliptic integrals, for the body whose exact motion the steps follow.
    stepped: Tumbling,
    turn_of_a_step: f64,
    steps: u64,
    is_toutatis: bool,
}

impl Comparison {
    /// After a run that started with this body momentum.
    pub fn new(flags: &Flags, watch: &Watch, moments: &Vector3<f64>, momentum: &Vector3<f64>) -> Self {
        Self {
            measured: watch.periods(),
            exact: Tumbling::new(moments, momentum),
            stepped: Tumbling::new(&as_stepped(moments, momentum, flags.run.step_size), momentum),
            turn_of_a_step: watch.turn_of_a_step,
            steps: flags.run.steps,
            is_toutatis: flags.is_toutatis(),
        }
    }

    /// All of them side by side.
    pub fn table(&self) -> Table<5> {
        let mut table = Table::new(["period / days", "integration", "closed form", "published", "independent"]);
        let days = |periods: Option<Periods<f64>>, period: Period| match periods {
            Some(periods) => format!("{:.4}", periods.get(period)),
            None => "-".to_owned(),
        };
        let about = if self.exact.is_about_long_axis() {
            "rotation about the long axis"
        } else {
            "body momentum about the short axis"
        };
        for (name, period) in [(about, Period::Rotation), ("mean precession of the long axis", Period::Precession)] {
            let (value, uncertainty) = PUBLISHED.get(period);
            let published = [format!("{value:.2} ± {uncertainty}"), format!("{:.3}", INDEPENDENT.get(period))];
            let [published, independent] = if self.is_toutatis { published } else { ["-", "-"].map(str::to_owned) };
            let (measured, exact) = (days(self.measured, period), days(self.exact.periods(), period));
            table.row([name.to_owned(), measured, exact, published, independent]);
        }
        table
    }

    /// Claims that the measured periods are those of the closed form and lie in the published intervals.
    pub fn claim(&self, claims: &mut Claims) {
        for (name, period) in [("the rotation period", Period::Rotation), ("the precession period", Period::Precession)]
        {
            let (closed, published) = (format!("{name} is the closed form's"), format!("{name} is the published one"));
            match (self.measured, self.exact.periods(), self.stepped.periods()) {
                (Some(measured), Some(exact), Some(stepped)) => {
                    let (measured, exact, stepped) = (measured.get(period), exact.get(period), stepped.get(period));
                    self.claim_closed_form(&closed, measured, stepped, claims);
                    self.claim_published(&published, measured, stepped - exact, PUBLISHED.get(period), claims);
                }
                _ => {
                    let reason = "the motion has no such period, or was too short to show it";
                    claims.skip(&closed, reason);
                    claims.skip(&published, reason);
                }
            }
        }
    }

    /// The steps follow the exact motion of another body, [`as_stepped`], up to terms that are smaller by (h|ω|)⁴; the
    /// interpolation between steps is as good. Rounding of the momentum moves the phase. Near the separatrix, where the parameter
    /// m of the elliptic functions goes to 1, periods magnify both by 1/(1 − m).
    fn claim_closed_form(&self, name: &str, measured: f64, stepped: f64, claims: &mut Claims) {
        if self.turn_of_a_step > LONGEST_STEP {
            let angle = self.turn_of_a_step;
            return claims.skip(
                name,
                &format!("h|ω| = {angle:.2} is above {LONGEST_STEP}: a step too long for the series in h"),
            );
        }
        let relative = self.turn_of_a_step.powi(4) + round_off::worst_case(self.steps, 1.0);
        let bound = stepped * relative / (1.0 - self.stepped.parameter());
        claims.at_most(
            name,
            (measured - stepped).abs(),
            bound,
            "days, of the body that the steps follow; left out: (h|ω|)⁴",
        );
    }

    fn claim_published(&self, name: &str, measured: f64, shift: f64, published: (f64, f64), claims: &mut Claims) {
        let (value, uncertainty) = published;
        if !self.is_toutatis {
            claims.skip(name, "another body, or another spin");
        } else if shift.abs() > uncertainty / 10.0 {
            claims.skip(name, "the step moves the period by more than a tenth of the published uncertainty");
        } else {
            let interval = value - uncertainty..=value + uncertainty;
            claims.within(name, measured, interval, 4, "days, Zhao and Ji from Chang'e-2's flyby");
        }
    }
}
