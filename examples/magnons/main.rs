//! Magnons: waves of spins on a ring. A spin is a rotor with a momentum along itself, `isotropy = free`.

mod cone;
mod figure;
mod packet;
mod ring;

use clap::Parser;
use clebsch_examples::claims::{Claims, largest};
use clebsch_examples::csv::Csv;
use clebsch_examples::flags::{Run, Scene, count_within, parse, positive};
use clebsch_examples::scene::{Failure, conclude, say};
use clebsch_examples::table::Table;
use cone::{Branch, Cone};
use packet::Packet;
use std::f64::consts::{PI, TAU};
use std::process::ExitCode;

const SCENE: Scene = Scene {
    name: "magnons",
    step_size: "0.05",
    time_unit: "seconds",
    steps: "4000",
    order: "2",
    order_note: "steps of fields have order 2 or more",
    columns_note: "of the packet: energy, total momentum L1,L2,L3 and its centre (spacings)",
};

/// Spins of the ring whose frequencies are measured, and steps.
const RING: usize = 32;
const STEPS: u64 = 100;

/// Magnons on a ring of spins: both frequencies against k, and a packet of waves
#[derive(Parser, Clone, Debug)]
struct Flags {
    /// Spins of the ring that the packet runs around
    #[arg(long, value_name = "N", value_parser = sizes, default_value = "240")]
    sites: usize,
    /// Spin s: momentum of each site along itself
    #[arg(long, value_name = "S", value_parser = positive, allow_hyphen_values = true, default_value = "4")]
    spin: f64,
    /// Exchange energy J
    #[arg(long, value_name = "J", value_parser = positive, allow_hyphen_values = true, default_value = "1")]
    exchange: f64,
    /// Tilt of the spins in waves whose frequencies are measured, degrees
    #[arg(long, value_name = "DEGREES", value_parser = tilt, allow_hyphen_values = true, default_value = "20")]
    tilt: f64,
    /// Waves of the packet have so many spins
    #[arg(long, value_name = "N", value_parser = positive, allow_hyphen_values = true, default_value = "6")]
    wavelength: f64,
    #[command(flatten)]
    run: Run,
}

/// A number of spins that is no surprise for the memory.
fn sizes(text: &str) -> Result<usize, String> {
    count_within(text, 40..=1_000_000)
}

/// Degrees of a cone.
fn tilt(text: &str) -> Result<f64, String> {
    let number = positive(text)?;
    if number < 90.0 { Ok(number) } else { Err(format!("`{number}` is not below 90")) }
}

impl Flags {
    /// With the wave number of the packet.
    fn cone(&self) -> Cone {
        let k = TAU / self.wavelength;
        Cone { exchange: self.exchange, spin: self.spin, tilt: self.tilt.to_radians(), k, h: self.run.step_size }
    }
}

/// A frequency.
#[derive(Clone, Copy, Debug)]
pub struct Measured {
    branch: Branch,
    k: f64,
    found: f64,
    of_steps: f64,
    spin_defect: f64,
}

fn main() -> ExitCode {
    conclude(run(&parse(&SCENE)))
}

fn run(flags: &Flags) -> Result<Claims, Failure> {
    flags.run.refuse_first_order(&SCENE)?;
    let reach = flags.run.step_size * (flags.spin + 4.0 * flags.exchange / flags.spin) / flags.tilt.to_radians().cos();
    if reach > 0.9 {
        let text =
            format!("--step-size: spins turn by {reach:.2} rad in a step, which is too far for waves: reduce it");
        return Err(Failure::Flags(text));
    }
    let measured = measured(flags)?;
    let mut csv = Csv::create(&flags.run, &["energy", "L1", "L2", "L3", "centre"])?;
    let packet = Packet::of(flags, &flags.run, |step, time, energy, total, centre| {
        csv.row(step, time, [energy, total.x, total.y, total.z, centre])
    })?;
    say(format_args!("frequencies of {RING} spins in {STEPS} steps of {} s, 1/s\n", flags.run.step_size));
    say(table(flags, &measured));
    let (found, expected) = (packet.speed(), packet.expected(flags));
    say(format_args!("the packet runs at {found:.5} spacings a second, by dω/dk at {expected:.5}\n"));
    csv.finish()?;
    figure::draw(flags, &measured, &packet)?;

    let mut claims = Claims::new();
    let off = measured.iter().map(|one| (one.found - one.of_steps).abs() * flags.run.step_size * STEPS as f64);
    claims.round_off("frequencies are those of the steps, as an angle at the end", largest(off), STEPS, 1.0);
    let spins = largest(measured.iter().map(|one| one.spin_defect));
    claims.round_off("N·q of each spin is s", spins, STEPS, flags.spin);
    for branch in [Branch::Slow, Branch::Fast] {
        claim_order(flags, branch, &mut claims)?;
    }
    let halved = Packet::of(flags, &flags.run.refined(2), |_, _, _, _, _| Ok(()))?;
    packet.claim(&halved, flags, &mut claims);
    Ok(claims)
}

/// Frequencies of all waves around a ring, by steps.
fn measured(flags: &Flags) -> Result<Vec<Measured>, Failure> {
    let mut all = Vec::new();
    for branch in [Branch::Slow, Branch::Fast] {
        for n in 1..=RING / 2 {
            let cone = Cone { k: TAU * n as f64 / RING as f64, ..flags.cone() };
            let [found, spin_defect] = cone.measured(branch, RING, STEPS)?;
            all.push(Measured { branch, k: cone.k, found, of_steps: cone.of_steps(branch), spin_defect });
        }
    }
    Ok(all)
}

fn table(flags: &Flags, measured: &[Measured]) -> Table<7> {
    let headings = ["k / π", "Heisenberg", "slow", "of steps", "measured", "fast", "measured"];
    let mut table = Table::new(headings);
    let (slow, fast) = measured.split_at(measured.len() / 2);
    for (slow, fast) in slow.iter().zip(fast).filter(|(slow, _)| (slow.k / PI * 8.0).fract() == 0.0) {
        let cone = Cone { k: slow.k, ..flags.cone() };
        let numbers = [
            cone.heisenberg(),
            cone.frequency(Branch::Slow),
            slow.of_steps,
            slow.found,
            cone.frequency(Branch::Fast),
            fast.found,
        ];
        let [a, b, c, d, e, f] = numbers.map(|number| format!("{number:.7}"));
        table.row([format!("{:.3}", slow.k / PI), a, b, c, d, e, f]);
    }
    table
}

/// Claims that measured frequencies come to those of continuous time at second order.
fn claim_order(flags: &Flags, branch: Branch, claims: &mut Claims) -> Result<(), Failure> {
    let mut errors = [0.0; 2];
    for (error, part) in errors.iter_mut().zip([1, 2]) {
        let cone = Cone { k: PI / 2.0, h: flags.run.step_size / part as f64, ..flags.cone() };
        *error = (cone.measured(branch, RING, part * STEPS)?[0] - cone.frequency(branch)).abs();
    }
    let name = format!("{branch:?} waves with k = π/2: half the step, a quarter of the error").to_lowercase();
    let reason = format!("to the formula of continuous time; the error with h is {:.1e} 1/s", errors[0]);
    claims.within(&name, errors[0] / errors[1], 3.6..=4.4, 3, &reason);
    Ok(())
}
