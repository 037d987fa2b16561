//! Tables of states, and the files that they are written to. Readers of this test read the files, and NumPy where it is installed.

mod readers;

use crate::arbitrary::{attitude, cases, unit, vector};
use crate::bodies::{H, satellites, tops};
use crate::runner::proptest;
use clebsch::record::{Npz, RecordError, Recorder};
use clebsch::{
    Clebsch, Columns, Conserves, Declared, Error, Event, Form, Method, Names, Quantities, Sample, Space, State, Stepper,
};
use clebsch_tests::fixtures::flying_body::FlyingBody;
use clebsch_tests::fixtures::quaternion_top::QuaternionTop;
use clebsch_tests::fixtures::spin_chain::SpinChain;
use clebsch_tests::fixtures::watched_top::WatchedTop;
use nalgebra::{Matrix2x3, Matrix3, Quaternion, SVector, UnitQuaternion, Vector3};
use proptest::prelude::*;
use readers::{Array, entries, lines};
use std::io::{Cursor, Error as IoError, Write};

/// The names of the columns of a table.
macro_rules! names {
    ($table:expr) => {
        $table.columns().map(|column| column.to_string()).collect::<Vec<String>>()
    };
}

/// The count of the numbers behind those of a state.
fn width_of<S: Clebsch, M: Method<S>, L: Quantities<S, M>>(
    of: &L,
    stepper: &Stepper<S, M>,
    state: &State<S, M>,
) -> usize {
    let values = of.values(stepper, state);
    (0..).map_while(|k| values.entry(k)).count()
}

/// A writer that takes so many bytes.
#[derive(Debug)]
struct Short(usize);

impl Write for Short {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, IoError> {
        if self.0 == 0 {
            return Err(IoError::other("the disk is full"));
        }
        let taken = bytes.len().min(self.0);
        self.0 -= taken;
        Ok(taken)
    }

    fn flush(&mut self) -> Result<(), IoError> {
        Ok(())
    }
}

proptest! {
    #![proptest_config(cases(8))]

    /// Numbers follow each other by rows, and columns have the names of closures.
    #[test]
    fn rows_have_the_numbers_of_their_columns(r in attitude(), q in unit(), mu in vector::<3>(1.0), more in vector::<6>(1.0), top in tops()) {
        let by_rows = |m: &Matrix3<f64>| m.transpose().as_slice().to_vec();
        let stepper = top.into_stepper(H)?;
        let state = stepper.state(r, mu)?;
        let table = stepper.table().energy().conserved();
        let of_matrix = (0..9).map(|k| format!("R[{},{}]", k / 3, k % 3));
        let expected: Vec<String> =
            ["t".to_string()].into_iter().chain(of_matrix).chain((0..3).map(|k| format!("N[{k}]"))).collect();
        let mut found = names!(table);
        let conserved: Vec<String> = WatchedTop::CONSERVED_NAMES.iter().map(ToString::to_string).collect();
        prop_assert_eq!(found.split_off(14), conserved.clone());
        prop_assert_eq!(found.pop(), Some("energy".to_string()));
        prop_assert_eq!(found, expected);
        let row: Vec<f64> = table.row(2.5, &state).collect();
        let values = stepper.conserved(&state);
        let numbers = [vec![2.5], by_rows(&r), mu.as_slice().to_vec(), vec![stepper.energy(&state)], values.values().to_vec()];
        prop_assert_eq!(row, numbers.concat());
        prop_assert_eq!(values.names().to_vec(), conserved);
        let of_values: Vec<&str> = table.columns().map(|column| column.value()).collect();
        let expected = [&["t"][..], &["R"; 9], &["N"; 3], &["energy"], WatchedTop::CONSERVED_NAMES].concat();
        prop_assert_eq!(of_values, expected);
        prop_assert_eq!(table.stepper().step_size(), H);
        let energy = table.stepper().table().energy();
        prop_assert_eq!(energy.row(0.0, &state).last(), Some(stepper.energy(&state)));
        // a table of a state alone has no columns behind it
        prop_assert_eq!(Quantities::<WatchedTop, Declared>::quantity(&(), 0), None);
        prop_assert_eq!(width_of::<_, Declared, _>(&(), &stepper, &state), 0);

        // a tuple of names, and a power
        let body = FlyingBody { mass: 1.0, mass_matrix: Matrix3::identity(), hook: Vector3::zeros(), stiffness: 1.0 };
        prop_assert_eq!(FlyingBody::CONFIGURATION_NAMES, Names::Each(&[Names::One("x"), Names::One("R")]));
        let stepper = body.into_stepper(0.1)?;
        let state = stepper.state((q.cast(), Matrix3::identity()), more.cast())?;
        let (table, f32s) = (stepper.table(), |v: &[f64]| v.iter().map(|x| *x as f32).collect::<Vec<f32>>());
        let found = names!(table);
        prop_assert_eq!(&found[..6], &["t", "x.x", "x.y", "x.z", "R[0,0]", "R[0,1]"]);
        prop_assert_eq!(&found[13..], &["N[0]", "N[1]", "N[2]", "N[3]", "N[4]", "N[5]"]);
        let row: Vec<f32> = table.row(0.0, &state).collect();
        prop_assert_eq!((&row[1..4], &row[13..]), (&f32s(q.as_slice())[..], &f32s(more.as_slice())[..]));
        let stepper = SpinChain::<3> { exchange: 1.0, field: Vector3::z() }.into_stepper(0.1)?;
        let state = stepper.state([q; 3], [q.cross(&mu); 3])?;
        let (found, row): (_, Vec<f64>) = (names!(stepper.table()), stepper.table().row(0.0, &state).collect());
        prop_assert_eq!((found[6].as_str(), found[18].as_str()), ("q[1].z", "N[2][2]"));
        prop_assert_eq!((row[6], row[18]), (q.z, q.cross(&mu).z));

        // quaternions, and values of one's own
        let turn = UnitQuaternion::from_matrix(&r).into_inner();
        let stepper = QuaternionTop { inertia: Matrix3::identity(), moment: Vector3::zeros() }.into_stepper(0.1)?;
        let state = stepper.state(turn, mu)?;
        let table = stepper.table().with("own", |_| (more, [Matrix2x3::from_row_slice(more.as_slice()); 2]));
        let (found, row): (_, Vec<f64>) = (names!(table), table.row(0.0, &state).collect());
        prop_assert_eq!(&found[..5], &["t", "Q.w", "Q.i", "Q.j", "Q.k"]);
        prop_assert_eq!(&row[1..5], &[turn.w, turn.i, turn.j, turn.k]);
        prop_assert_eq!((found[13].as_str(), found[25].as_str()), ("own.0[5]", "own.1[1][1,2]"));
        prop_assert_eq!((row[13], row[25], row.len()), (more[5], more[5], 26));
        prop_assert_eq!((turn.entry(4), more.entry(6), ().entry(0)), (None::<f64>, None::<f64>, None::<f64>));
        prop_assert_eq!(<(Quaternion<f64>, SVector<f64, 6>) as Columns<f64>>::FORM.width(), Form::Quaternion.width() + 6);
    }

    /// A row gives its state back: of a matrix, a tuple, an array, a quaternion, and with a time.
    #[test]
    fn rows_are_read_back(r in attitude(), q in unit(), mu in vector::<3>(0.5), more in vector::<6>(1.0), satellite in satellites()) {
        let body = FlyingBody { mass: 1.0, mass_matrix: Matrix3::identity(), hook: Vector3::zeros(), stiffness: 1.0 };
        let stepper = body.into_stepper(0.1)?;
        let state = stepper.state((q.cast(), Matrix3::identity()), more.cast())?;
        prop_assert_eq!(stepper.table().state(stepper.table().row(0.0, &state)), Some(Ok(state)));
        let stepper = SpinChain::<3> { exchange: 1.0, field: Vector3::z() }.into_stepper(0.1)?;
        let state = stepper.state([q; 3], [q.cross(&mu); 3])?;
        prop_assert_eq!(stepper.table().state(stepper.table().row(0.0, &state)), Some(Ok(state)));
        // a momentum along q is none of a point on a sphere: the nearest one is without it
        let row = [0.0].into_iter().chain([q; 3].into_iter().flat_map(|q| [q.x, q.y, q.z])).chain([mu; 3].into_iter().flat_map(|m| [m.x, m.y, m.z]));
        prop_assert_eq!(stepper.table().project(row), Some(stepper.project([q; 3], [mu; 3])));
        let turn = UnitQuaternion::from_matrix(&r).into_inner();
        let stepper = QuaternionTop { inertia: Matrix3::identity(), moment: Vector3::zeros() }.into_stepper(0.1)?;
        let state = stepper.state(turn, mu)?;
        prop_assert_eq!(stepper.table().state(stepper.table().energy().row(7.5, &state)), Some(Ok(state)));
        prop_assert_eq!(state.clock(), ());

        let stepper = satellite.into_stepper(H)?;
        let state = stepper.state_at(1.5, r, mu)?;
        prop_assert_eq!(state.clock().now(), 1.5);
        let row: Vec<f64> = stepper.table().row(1.5, &state).collect();
        prop_assert_eq!(<(f64, Matrix3<f64>, Vector3<f64>)>::from_columns(&mut row.iter().copied()), Some((1.5, r, mu)));
        prop_assert_eq!(stepper.table().state(row.iter().copied()), Some(Ok(state)));
        prop_assert_eq!(stepper.table().state(row[..12].iter().copied()), None);
        let no_time = [f64::NAN].into_iter().chain(row[1..].iter().copied());
        prop_assert_eq!(stepper.table().state(no_time), Some(Err(Error::NotFinite { name: "the time" })));
    }

    /// The two other kinds of samples, and the times of states.
    #[test]
    fn samples_know_their_times(satellite in satellites(), r in attitude(), mu in vector::<3>(0.2)) {
        let stepper = satellite.into_stepper(H)?;
        let start = stepper.state_at(1.5, r, mu)?;
        for (k, pair) in stepper.trajectory(start).every(0.4 * H).with_times().take(5).enumerate() {
            let pair = pair?;
            let time = 1.5 + 0.4 * H * k as f64;
            prop_assert!((Sample::time(&pair) - time).abs() < 1e-15 && (Sample::time(&pair.1) - time).abs() < 1e-15);
            let event = Event { number: 0, time: pair.0, state: pair.1 };
            prop_assert_eq!((Sample::time(&event), Sample::state(&event)), (pair.0, Sample::state(&pair.1)));
        }
    }

    /// A reader that knows the formats alone reads the bits that were written.
    #[test]
    fn files_are_read_back(r in attitude(), mu in vector::<3>(1.0), top in tops(), q in unit()) {
        let stepper = top.into_stepper(H)?;
        let start = stepper.state(r, mu)?;
        let table = stepper.table().conserved().units(&[("t", "s")]);
        let samples = || stepper.trajectory(start).every(0.3 * H).with_times().take(7);
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for sample in samples() {
            let (time, state) = sample?;
            rows.push(table.row(time, &state).collect());
        }
        let bits = |rows: &[Vec<f64>]| rows.iter().flatten().map(|x| x.to_bits()).collect::<Vec<u64>>();

        // text, whose first names need quotes
        let mut recorder = Recorder::csv(Vec::new(), table)?;
        recorder.record_all(samples())?;
        prop_assert_eq!(recorder.rows(), 7);
        let text = String::from_utf8(recorder.finish()?)?;
        let mut read = lines(&text).into_iter();
        let titles: Vec<String> = table.columns().map(|column| match column.unit() {
            Some(unit) => format!("{column} ({unit})"),
            None => column.to_string(),
        }).collect();
        prop_assert_eq!((titles[0].as_str(), read.next()), ("t (s)", Some(titles.clone())));
        let numbers: Result<Vec<Vec<f64>>, _> = read.map(|line| line.iter().map(|x| x.parse()).collect()).collect();
        prop_assert_eq!(bits(&numbers?), bits(&rows));

        // an array, behind other bytes, complete before its end too
        let mut file = Cursor::new(b"before".to_vec());
        file.set_position(6);
        let mut recorder = Recorder::npy(file, table)?;
        recorder.record_all(samples().take(3))?;
        recorder.flush()?;
        recorder.record_all(samples().skip(3))?;
        let bytes = recorder.finish()?.into_inner();
        let array = Array::read(&bytes[6..]);
        prop_assert_eq!((array.version, array.rows, bits(&array.numbers())), (1, 7, bits(&rows)));
        prop_assert_eq!(array.fields[1].clone(), ("R".to_string(), vec![3, 3]));
        prop_assert_eq!(array.fields.last().map(|field| field.1.len()), Some(0));

        // an archive of two runs, the second one dropped before its end
        let chain = SpinChain::<3> { exchange: 1.0, field: Vector3::z() }.into_stepper(0.1)?;
        let spins = chain.state([q; 3], [q.cross(&mu); 3])?;
        let mut archive = Npz::new(Cursor::new(Vec::new()))?;
        let mut recorder = Recorder::npz(&mut archive, "top", table)?;
        recorder.record_all(samples())?;
        recorder.finish()?;
        let pairs = chain.table().with("pair ξ", |_| [(1.0, mu); 2]);
        let mut recorder = Recorder::npz(&mut archive, "chain", pairs)?;
        recorder.record((0.5, spins))?;
        drop(recorder);
        let again = Recorder::npz(&mut archive, "top", table).err();
        assert!(matches!(again, Some(RecordError::SameName { name }) if name == "top"));
        let long = Recorder::npz(&mut archive, &"n".repeat(65_532), table).err();
        assert!(matches!(long, Some(RecordError::LongName { bytes: 65_532 })));
        let bytes = archive.finish()?.into_inner();
        let entries = entries(&bytes);
        prop_assert_eq!(entries.iter().map(|entry| entry.0.as_str()).collect::<Vec<_>>(), ["top.npy", "chain.npy"]);
        prop_assert_eq!(bits(&Array::read(entries[0].1).numbers()), bits(&rows));
        let chained = Array::read(entries[1].1);
        prop_assert_eq!((chained.version, chained.rows), (3, 1));
        prop_assert_eq!(&chained.fields[1..3], &[("q".to_string(), vec![3, 3]), ("N".to_string(), vec![3, 3])]);
        prop_assert_eq!(chained.text.contains("('pair ξ', [('0', '<f8'), ('1', '<f8', (3, )), ], (2, ))"), true);
        prop_assert_eq!(chained.numbers()[0][1..4].to_vec(), q.as_slice().to_vec());
    }

    /// Each failure has its error, and leaves the rows before it.
    #[test]
    fn failures_of_recordings_are_told(top in tops(), r in attitude(), mu in vector::<3>(1.0)) {
        let stepper = top.into_stepper(H)?;
        let start = stepper.state(r, mu)?;
        let mut recorder = Recorder::npy(Cursor::new(Vec::new()), stepper.table())?;
        let samples = [Ok((0.0, start)), Err(Error::NotFinite { name: "it" }), Ok((1.0, start))];
        let failed = recorder.record_all(samples);
        assert!(matches!(failed, Err(RecordError::Step(Error::NotFinite { name: "it" }))));
        prop_assert_eq!(Array::read(&recorder.finish()?.into_inner()).rows, 1);
        let unknown = Recorder::csv(Vec::new(), stepper.table().units(&[("Q", "m")]));
        assert!(matches!(unknown, Err(RecordError::UnknownName { name }) if name == "Q"));
        let twice = Recorder::csv(Vec::new(), stepper.table().energy().energy());
        assert!(matches!(twice, Err(RecordError::SameName { name }) if name == "energy"));
        let mut recorder = Recorder::csv(Short(100), stepper.table())?;
        recorder.record((0.0, start))?;
        let full = recorder.finish();
        assert!(matches!(full, Err(RecordError::Io(error)) if error.to_string() == "the disk is full"));
    }
}

/// NumPy reads arrays and archives: names, shapes and numbers.
#[test]
#[ignore = "it needs Python with NumPy: `.ci/all` runs it"]
fn numpy_reads_recordings() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::temp_dir().join(format!("clebsch-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let (array, archive, table) = (folder.join("body.npy"), folder.join("runs.npz"), folder.join("body.csv"));
    let body = WatchedTop { mass: Vector3::new(1.0, 2.0, 3.0), weight: 1.0 };
    let stepper = body.into_stepper(0.125)?;
    let start = stepper.state(Matrix3::identity(), Vector3::new(0.5, 0.25, 2.0))?;
    let columns = stepper.table().conserved();
    let samples = || stepper.trajectory(start).every(0.125).with_times().take(4);
    let mut recorder = Recorder::npy(std::fs::File::create(&array)?, columns)?;
    recorder.record_all(samples())?;
    recorder.finish()?;
    let mut recorder = Recorder::csv(std::fs::File::create(&table)?, columns)?;
    recorder.record_all(samples())?;
    recorder.finish()?;
    let chain = SpinChain::<3> { exchange: 1.0, field: Vector3::z() }.into_stepper(0.1)?;
    let spins = chain.state([Vector3::x(); 3], [Vector3::y(); 3])?;
    let mut runs = Npz::new(std::fs::File::create(&archive)?)?;
    let mut recorder = Recorder::npz(&mut runs, "top", columns)?;
    recorder.record_all(samples())?;
    recorder.finish()?;
    let pairs = chain.table().with("pair ξ", |_| [(1.0, Vector3::new(1.0, 2.0, 3.0)); 2]);
    Recorder::npz(&mut runs, "chain", pairs)?.record((0.5, spins))?;
    runs.finish()?;
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    let script = format!("{}/tests/properties/recording/read.py", env!("CARGO_MANIFEST_DIR"));
    let status = std::process::Command::new(&python).arg(script).args([&array, &table, &archive]).status()?;
    std::fs::remove_dir_all(&folder)?;
    assert!(status.success(), "`{python}` has another opinion");
    Ok(())
}
