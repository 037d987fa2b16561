//! Random powers: sites with a const generic, which random terms tie to each other.
//!
//! The oracle has no sites. It solves a problem of three factors, with a formula for each site and each term.

use clebsch_compiler::derive::{Home, Id, Stencil};
use clebsch_compiler::lower::{Kernel, MechanicsProgram};
use clebsch_compiler::model::SiteIndex;
use clebsch_symbolic::{Expr, Matrix as Numbers, Role, Shape};
use clebsch_tests::oracle::precise::equation::{Equation, NoSolution};
use clebsch_tests::oracle::precise::matrix::Matrix;
use clebsch_tests::oracle::precise::problem::{Factor, Problem};
use clebsch_tests::oracle::precise::real::Real;
use clebsch_tests::oracle::precise::step::{State, composed_step};
use clebsch_tests::oracle::random::Random;

use crate::formula::{Formula, Place};
use crate::generator::{element, problem};
use crate::groups::pick;
use crate::kernels::Values;
use crate::problem::{Declared, Field, Kind, Kinetic, head};
use crate::stepping::{Seen, Stepper};

/// The number of sites that the oracle has.
pub const SITES: usize = 3;

/// The sums of terms that tie sites to each other.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Sum {
    /// Each site and the next, the last and the first too.
    Ring,
    /// Each site and the next.
    Chain,
    /// Each site and each later one.
    Pairs,
}

/// A random power.
#[derive(Clone, Debug)]
pub struct Power {
    /// One site, with the potential of a site.
    site: Declared,
    /// Whether each site has a value of its own of a field.
    own: Vec<bool>,
    /// A term of two sites, which are points 0 and 1.
    link: Formula,
    sum: Sum,
    /// The site with this index, as the oracle has it.
    fields: [Vec<Matrix<f64>>; SITES],
    starts: [Matrix<f64>; SITES],
}

impl Power {
    /// The power of a seed: the first problem from there on that has one factor and one leaf.
    pub fn random(seed: u64) -> Power {
        let serves = |declared: &Declared| declared.factors.len() == 1 && declared.leaves.len() == 1;
        let seeds = (0..).map(|k| seed.wrapping_mul(64).wrapping_add(700_000 + k));
        let mut site = seeds.map(problem).find(serves).expect("one factor is common");
        let random = &mut Random::new(seed ^ 0x9e37);
        let link = link(&mut site, random);
        let of_link = |k: usize| link.mentions(&|part| matches!(part, Formula::Field(field) if *field == k));
        // the cost that the oracle has of Moser and Veselov's step has the numbers of its field
        let may_differ = !matches!(site.kinetic, Kinetic::MoserVeselov(..));
        let own: Vec<bool> =
            (0..site.fields.len()).map(|k| may_differ && !of_link(k) && pick(random, 2) == 0).collect();
        let fields = std::array::from_fn(|_| {
            let mut near = |value: &Matrix<f64>| value * random.between(0.8, 1.2);
            let value = |(field, own): (&Field, &bool)| if *own { near(&field.value) } else { field.value.clone() };
            site.fields.iter().zip(&own).map(value).collect()
        });
        let starts = std::array::from_fn(|_| {
            let (f, q) = ([element(random, &site.factors[0].group, 0.3)], [site.leaves[0].start.clone()]);
            site.leaves[0].image.value(&Place { fields: &[], t: 0.0, h: 0.0, q: &q, f: &f, xi: &[] })
        });
        let sum = [Sum::Ring, Sum::Chain, Sum::Pairs][pick(random, 3)];
        Power { site, own, link, sum, fields, starts }
    }

    /// The struct with its attribute.
    pub fn text(&self) -> String {
        let mut names = self.site.names();
        for (name, own) in names.fields.iter_mut().zip(&self.own) {
            *name = if *own { format!("{name}[i]") } else { name.clone() };
        }
        (names.points, names.elements, names.velocities) =
            (vec!["q[i]".into(), "q[i]".into()], vec!["F[i]".into()], vec!["v[i]".into()]);
        let (factor, leaf) = (&self.site.factors[0], &self.site.leaves[0]);
        let mut keys: Vec<String> = factor.group.declaration.iter().cloned().collect();
        let each = |formula: &Formula| format!("(0..N).map(|i| {})", formula.text(&names));
        keys.push(format!(
            "action = |F: [{}; N], q: [{}; N]| {}",
            factor.group.name,
            leaf.type_name,
            each(&leaf.image)
        ));
        let closure = |key: &str, formula: &Formula, body: String| {
            let arguments = head(key, formula, ["q".into(), "F".into(), "v".into()]);
            format!("{key} = |{arguments}| {body}")
        };
        let summed = |key: &str, formula: &Formula| closure(key, formula, format!("{}.sum()", each(formula)));
        keys.extend(self.site.kinetic.keys(summed));
        let (next, range) = match self.sum {
            Sum::Ring => ("q[(i + 1) % N]", "(0..N).map(|i| "),
            Sum::Chain => ("q[i + 1]", "(0..N - 1).map(|i| "),
            Sum::Pairs => ("q[j]", "(0..N).map(|i| (i + 1..N).map(|j| "),
        };
        let mut pair = names.clone();
        pair.points[1] = next.into();
        let end = if self.sum == Sum::Pairs { ").sum()).sum()" } else { ").sum()" };
        let links = format!("{range}{}{end}", self.link.text(&pair));
        let (all, body) = match &self.site.potential {
            None => (self.link.clone(), links),
            Some(potential) => (self.link.clone() + potential.clone(), format!("{}.sum() + {links}", each(potential))),
        };
        keys.push(closure("potential", &all, body));
        if self.site.order == 1 {
            keys.push("order = 1".into());
        }
        keys.extend(self.site.dials.iter().map(ToString::to_string));
        let scalar = if self.site.fields.is_empty() { "    scalar = f64,\n" } else { "" };
        let field = |(k, (field, own)): (usize, (&Field, &bool))| field.text(&format!("field_{k}"), own.then_some("N"));
        let fields: String = self.site.fields.iter().zip(&self.own).enumerate().map(field).collect();
        let keys = keys.join(",\n    ");
        format!("#[clebsch(\n    {keys},\n{scalar})]\npub struct Problem<const N: usize> {{\n{fields}}}\n")
    }

    /// The pairs of sites of all terms.
    fn pairs(&self) -> Vec<[usize; 2]> {
        let all = (0..SITES).flat_map(|i| (0..SITES).map(move |j| [i, j]));
        let is_term = |[i, j]: &[usize; 2]| match self.sum {
            Sum::Ring => *j == (i + 1) % SITES,
            Sum::Chain => *j == i + 1,
            Sum::Pairs => j > i,
        };
        all.filter(is_term).collect()
    }

    /// The same motion as a problem of three factors.
    pub fn unrolled(&self) -> Declared {
        let count = self.site.fields.len();
        let mut made = Declared { array: true, ..self.site.clone() };
        (made.factors, made.leaves, made.fields) = (Vec::new(), Vec::new(), Vec::new());
        for (k, (values, start)) in self.fields.iter().zip(&self.starts).enumerate() {
            made.factors.extend(self.site.factors.iter().cloned());
            let mut leaf = self.site.leaves[0].clone();
            (leaf.start, leaf.image) = (start.clone(), leaf.image.moved(&[k], 0));
            made.leaves.push(leaf);
            let attributes = self.site.fields.iter().map(|field| field.attribute);
            made.fields
                .extend(attributes.zip(values).map(|(attribute, value)| Field { attribute, value: value.clone() }));
        }
        let each = |formula: &Formula| {
            let sites = (0..SITES).map(|k| formula.moved(&[k, k], k * count));
            sites.reduce(|a, b| a + b).expect("a site")
        };
        made.kinetic = match &self.site.kinetic {
            Kinetic::Cost(cost) => Kinetic::Cost(each(cost)),
            Kinetic::Lagrangian(lagrangian, discretization) => Kinetic::Lagrangian(each(lagrangian), *discretization),
            Kinetic::MoserVeselov(lagrangian, cost) => Kinetic::MoserVeselov(each(lagrangian), each(cost)),
        };
        let links = self.pairs().into_iter().map(|pair| self.link.moved(&pair, 0));
        let links = links.reduce(|a, b| a + b).expect("a term");
        made.potential = Some(match &self.site.potential {
            Some(potential) => each(potential) + links,
            None => links,
        });
        made
    }
}

/// A random term of two sites, and its field if it has one.
fn link(site: &mut Declared, random: &mut Random) -> Formula {
    let (kind, shape) = (site.leaves[0].kind, site.leaves[0].start.shape());
    let is_quaternion = kind == Kind::Quaternion;
    let (rows, columns) = if is_quaternion { (4, 1) } else { shape };
    let entry = |random: &mut Random, point: usize| {
        let (i, j, point) = (pick(random, rows), pick(random, columns), Formula::Point(point));
        match is_quaternion {
            true if i == 3 => point.method("scalar"),
            true => Formula::Coordinate(Box::new(point.method("imag")), i),
            false => Formula::Entry(Box::new(point), i, j),
        }
    };
    match pick(random, 3) {
        0 if !is_quaternion => {
            let value = Matrix::from_fn(rows, columns, |_, _| random.number());
            site.fields.push(Field { attribute: "", value });
            let stretch = Formula::Point(0) - Formula::Point(1);
            Formula::Field(site.fields.len() - 1).dot(stretch).power(2)
        }
        1 => entry(random, 0) * entry(random, 1) * (Formula::Number(1.0) + entry(random, 1)),
        _ => {
            let apart = entry(random, 0) - entry(random, 1);
            apart.clone().power(2) + apart.power(4) * Formula::Number(0.25)
        }
    }
}

/// The potential of a problem as a function of F, whose derivative at F = I is J(q, ∂V/∂q).
struct Moved<'a>(&'a Declared);

impl Problem for Moved<'_> {
    fn factors(&self) -> Vec<Factor> {
        self.0.factors()
    }
    fn act<R: Real>(&self, f: &[Matrix<R>], q: &[Matrix<R>]) -> Vec<Matrix<R>> {
        self.0.act(f, q)
    }
    fn cost<R: Real>(&self, t: R, _h: R, q: &[Matrix<R>], f: &[Matrix<R>]) -> R {
        self.0.potential(t, &self.0.act(f, q))
    }
}

/// Half a kick, both halves of a composed step without potential, and half a kick: the steps of sites whose cost has another adjoint.
///
/// # Errors
/// The equation of some step has no solution.
pub fn kicked<R: Real>(problem: &Declared, h: R, start: &State<R>, steps: usize) -> Result<Vec<State<R>>, NoSolution> {
    let free = Declared { potential: None, ..problem.clone() };
    let (moved, factors) = (Moved(problem), problem.factors());
    let one: Vec<Matrix<R>> = factors.iter().map(|factor| Matrix::identity(factor.group.size())).collect();
    let kick = |t: R, state: &mut State<R>| {
        let gradient = Equation { problem: &moved, factors: &factors, t, h, q: &state.q }.next_momentum(&one);
        state.n.iter_mut().zip(gradient).for_each(|(n, slope)| *n = *n - h * slope * 0.5);
    };
    let mut states = vec![start.clone()];
    for k in 0..steps {
        let (t, mut state) = (h * k as f64, states[k].clone());
        kick(t, &mut state);
        state = composed_step(&free, h, t, &state)?;
        kick(t + h, &mut state);
        states.push(state);
    }
    Ok(states)
}

/// The program of a power, whose kernels are called as emitted code calls them.
pub struct Sites<'a, 'g> {
    program: &'a MechanicsProgram<'g>,
    steppers: Vec<Stepper<'a, 'g>>,
    power: &'a Power,
    h: f64,
}

impl<'a, 'g> Sites<'a, 'g> {
    pub fn new(power: &'a Power, program: &'a MechanicsProgram<'g>, h: f64) -> Sites<'a, 'g> {
        let fields = |site: usize| -> Vec<Vec<f64>> {
            power.fields[site].iter().map(|field| field.entries().to_vec()).collect()
        };
        let steppers = (0..SITES).map(|site| Stepper::new(program, &fields(site), h)).collect();
        Sites { program, steppers, power, h }
    }

    /// One step of all sites from time t, or why there is none.
    pub fn step(&mut self, t: f64, state: &Seen) -> Result<Seen, String> {
        let (start, end) = if self.power.site.order == 1 { (0.0, 1.0) } else { (0.5, 0.5) };
        let mut sites = self.apart(state);
        self.kick(t, &mut sites, start);
        for (stepper, site) in self.steppers.iter_mut().zip(&mut sites) {
            *site = stepper.step(t, site)?;
        }
        self.kick(t + self.h, &mut sites, end);
        Ok(Seen {
            q: sites.iter().flat_map(|site| site.q.clone()).collect(),
            mu: sites.iter().flat_map(|site| site.mu.clone()).collect(),
        })
    }

    /// Σ V
    pub fn potential(&self, t: f64, state: &Seen) -> f64 {
        let (sites, mut sum) = (self.apart(state), 0.0);
        for (number, link) in self.program.formulas.links.iter().enumerate() {
            for indices in self.indices(&link.term.ranges) {
                let values = self.values(t, &sites, self.program.kernel(Id::Term(number)), &self.places(&indices));
                sum += values.run(self.program.kernel(Id::Term(number)), &[], &[])[0][0];
            }
        }
        sum
    }

    /// The states of the sites.
    fn apart(&self, state: &Seen) -> Vec<Seen> {
        let dimension = state.mu.len() / SITES;
        let site = |k: usize| Seen { q: vec![state.q[k].clone()], mu: state.mu[k * dimension..][..dimension].to_vec() };
        (0..SITES).map(site).collect()
    }

    /// N ← N − w h J(q, ∂V/∂q) at each site.
    fn kick(&mut self, t: f64, sites: &mut [Seen], weight: f64) {
        let gradients = match &self.program.gathered {
            Some(stencil) => (0..SITES).map(|site| self.gathered(t, sites, stencil, site)).collect(),
            None => self.added(t, sites),
        };
        for ((stepper, site), gradient) in self.steppers.iter_mut().zip(sites).zip(gradients) {
            let change = stepper.momentum_map(&site.q, &[gradient]);
            site.mu.iter_mut().zip(change).for_each(|(mu, change)| *mu -= weight * self.h * change);
        }
    }

    /// The gradients of all sites, term by term.
    fn added(&self, t: f64, sites: &[Seen]) -> Vec<Vec<f64>> {
        let mut gradients: Vec<Vec<f64>> = sites.iter().map(|site| vec![0.0; site.q[0].len()]).collect();
        for (number, link) in self.program.formulas.links.iter().enumerate() {
            let kernel = self.program.kernel(Id::TermGradients(number));
            for indices in self.indices(&link.term.ranges) {
                let places = self.places(&indices);
                let outputs = self.values(t, sites, kernel, &places).run(kernel, &[], &[]);
                for ((place, _), output) in link.gradient.iter().zip(outputs) {
                    let site = places[*place].expect("a site");
                    gradients[site].iter_mut().zip(output).for_each(|(sum, slope)| *sum += slope);
                }
            }
        }
        gradients
    }

    /// The gradient of one site: the share that every site has, and that of each term that has it at some place.
    fn gathered(&self, t: f64, sites: &[Seen], stencil: &Stencil<'g>, site: usize) -> Vec<f64> {
        let power = self.program.formulas.model.power.as_ref().expect("a power");
        let all = [power.places.as_slice(), &stencil.places].concat();
        let common = self.program.kernel(Id::SiteGradient);
        let at = |index: i64| -> Vec<Option<usize>> { all.iter().map(|place| self.place(place, &[index])).collect() };
        let mut gradient = self.values(t, sites, common, &at(site as i64)).run(common, &[], &[]).remove(0);
        for &(term, number) in &stencil.others {
            let link = &self.program.formulas.links[term];
            let (place, home) = (link.gradient[number].0, link.homes(power).expect("homes").remove(number));
            let Some(index) = self.home(&home, &all[place], &link.term.ranges, site) else { continue };
            let kernel = self.program.kernel(Id::TermGradient(term, place));
            let slopes = self.values(t, sites, kernel, &at(index)).run(kernel, &[], &[]).remove(0);
            gradient.iter_mut().zip(slopes).for_each(|(sum, slope)| *sum += slope);
        }
        gradient
    }

    /// The index of the term that has a site at a place.
    fn home(
        &self,
        home: &Home<'g>,
        place: &SiteIndex<'g>,
        ranges: &[(Expr<'g>, Expr<'g>)],
        site: usize,
    ) -> Option<i64> {
        let (Some(index), [(from, to), ..]) = (home.index, ranges) else {
            return (self.place(place, &[]) == Some(site)).then_some(0);
        };
        let moved = self.number(index, &[site as i64]);
        let moved = if home.wraps { moved.rem_euclid(SITES as i64) } else { moved };
        let is_inside = self.number(*from, &[]) <= moved && moved < self.number(*to, &[]);
        (home.is_everywhere || is_inside).then_some(moved)
    }

    /// An expression in N and the indices of sums.
    fn number(&self, expr: Expr<'g>, indices: &[i64]) -> i64 {
        let value = expr.evaluate(&mut |symbol: Expr<'g>| {
            let number = match symbol.role() {
                Some(Role::Site(depth)) => indices[depth],
                _ => SITES as i64,
            };
            Numbers::new(Shape::scalar(), vec![number as f64])
        });
        value.entries[0] as i64
    }

    /// All indices of the sums of a term.
    fn indices(&self, ranges: &[(Expr<'g>, Expr<'g>)]) -> Vec<Vec<i64>> {
        let mut all = vec![Vec::new()];
        for (from, to) in ranges {
            let longer = |indices: Vec<i64>| {
                let range = self.number(*from, &indices)..self.number(*to, &indices);
                range.map(|index| [indices.as_slice(), &[index]].concat()).collect::<Vec<_>>()
            };
            all = all.into_iter().flat_map(longer).collect();
        }
        all
    }

    fn place(&self, place: &SiteIndex<'g>, indices: &[i64]) -> Option<usize> {
        let depth = |symbol: &Expr<'g>| if let Some(Role::Site(depth)) = symbol.role() { depth + 1 } else { 0 };
        if place.index.symbols().iter().any(|symbol| depth(symbol) > indices.len()) {
            return None;
        }
        let index = self.number(place.index, indices);
        let index = if place.wraps { index.rem_euclid(SITES as i64) } else { index };
        usize::try_from(index).ok().filter(|&index| index < SITES)
    }

    /// The sites of all places of the power, for these indices.
    fn places(&self, indices: &[i64]) -> Vec<Option<usize>> {
        let power = self.program.formulas.model.power.as_ref().expect("a power");
        power.places.iter().map(|place| self.place(place, indices)).collect()
    }

    /// The numbers of the symbols of a kernel.
    fn values(&self, t: f64, sites: &[Seen], kernel: &Kernel, places: &[Option<usize>]) -> Values {
        let formulas = &self.program.formulas;
        let power = formulas.model.power.as_ref().expect("a power");
        let mut values = Values::default();
        values.set(formulas.model.time, &[t]);
        for (input, _) in kernel.inputs() {
            if let Role::At(place, _) = input.role {
                let site = places[place].expect("a site");
                values.0.insert(input.name.clone(), Numbers::new(input.shape, sites[site].q[0].clone()));
            }
        }
        for leaf in power.parameters.iter().flat_map(|parameter| &parameter.leaves) {
            let name = leaf.symbol.as_symbol().expect("a symbol").name;
            let digits = name.trim_start_matches("field_").split('[').next().unwrap_or_default();
            let field: usize = digits.parse().expect("a field of ours");
            let site = leaf.accessor.site().map_or(Some(0), |place| places[place]);
            if let Some(site) = site {
                values.set(leaf.symbol, self.power.fields[site][field].entries());
            }
        }
        values
    }
}
