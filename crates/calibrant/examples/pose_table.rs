//! Efficiency of the best poses, of random ones and of common habits, for the note on best poses:
//! `cargo run --release -p calibrant --features programs --example pose_table`.

use calibrant::design::DesignSettings;
use calibrant::design::poses::{
    Allowed, DirectionKnowledge, PoseDesign, PoseNuisance, PoseProblem, covariance_of_holds, design_poses,
};
use calibrant::information::Criterion;
use calibrant::information::criterion::{AOptimality, DOptimality, IOptimality};
use calibrant::sensor::{Gauge, ParameterList, SensorModel, SensorParameters};
use calibrant::simulate::{Purpose, stream};
use nalgebra::{DVector, Vector3};
use rand_distr::{Distribution, StandardNormal};
use std::time::Instant;

/// Random sets for each row.
const RANDOM: u64 = 100;

fn main() -> calibrant::Result<()> {
    println!(
        "| directions | criterion | n | best | random, median | random, best of 100 | drift costs | s |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    for (name, knowledge) in KNOWLEDGE {
        for letter in ['A', 'D', 'I'] {
            for poses in [6, 9, 12, 15, 18, 21, 24] {
                row(name, knowledge, letter, poses)?;
            }
        }
    }
    println!("\n| habit | n | directions | A | D | I |\n|---|--:|---|--:|--:|--:|");
    for (habit, directions) in habits() {
        for (name, knowledge) in KNOWLEDGE {
            let mut cells = Vec::new();
            for letter in ['A', 'D', 'I'] {
                let problem = problem(knowledge, letter, directions.len());
                cells.push(match design_poses(&problem, &quick(), &|_| {}) {
                    Ok(design) => percent(efficiency(&problem, &design, &directions)),
                    Err(_) => "–".into(),
                });
            }
            println!("| {habit} | {} | {name} | {} |", directions.len(), cells.join(" | "));
        }
    }
    Ok(())
}

const KNOWLEDGE: [(&str, DirectionKnowledge); 3] = [
    ("unknown", DirectionKnowledge::Unknown),
    ("known", DirectionKnowledge::Known { sd_rad: 0.0 }),
    ("known to 0.5°", DirectionKnowledge::Known { sd_rad: 0.5 * std::f64::consts::PI / 180.0 }),
];

/// A data sheet's spread: 0.1 m/s², 0.5 %, 0.5 %.
fn problem(directions: DirectionKnowledge, letter: char, poses: usize) -> PoseProblem {
    let list = match directions {
        DirectionKnowledge::Unknown => Gauge::Upper.parameter_list(SensorModel::Full),
        DirectionKnowledge::Known { .. } => ParameterList::new(3, SensorModel::Full),
    };
    let at = SensorParameters::identity();
    let scale = DVector::from_fn(list.len(), |k, _| if k < 3 { 0.1 } else { 0.005 });
    let criterion = match letter {
        'A' => Criterion::A(AOptimality { scale }),
        'D' => Criterion::D(DOptimality { scale }),
        _ => Criterion::I(IOptimality::new(&list, &at, 20.0).expect("a regular matrix")),
    };
    PoseProblem {
        list,
        at,
        gravity_mps2: 9.80665,
        mean_sd: Vector3::repeat(1e-3),
        directions,
        allowed: Allowed::Anywhere,
        criterion,
        prior: None,
        poses,
        nuisance: PoseNuisance { drift_sd: Vector3::repeat(0.02), ..PoseNuisance::none() },
    }
}

fn quick() -> DesignSettings {
    DesignSettings { starts: 1, ..DesignSettings::default() }
}

fn row(name: &str, knowledge: DirectionKnowledge, letter: char, poses: usize) -> calibrant::Result<()> {
    let problem = problem(knowledge, letter, poses);
    let started = Instant::now();
    let design = match design_poses(&problem, &DesignSettings::default(), &|_| {}) {
        Ok(design) => design,
        Err(error) if error.is_not_identifiable() => {
            println!("| {name} | {letter} | {poses} | too few | | | | |");
            return Ok(());
        }
        Err(error) => return Err(error),
    };
    let seconds = started.elapsed().as_secs_f64();
    let mut random: Vec<f64> = (0..RANDOM)
        .map(|number| {
            let mut rng = stream(7, Purpose::Motion, number);
            let mut draw = || Vector3::<f64>::from_fn(|_, _| StandardNormal.sample(&mut rng)).normalize();
            let set: Vec<Vector3<f64>> = (0..poses).map(|_| draw()).collect();
            efficiency(&problem, &design, &set)
        })
        .collect();
    random.sort_by(f64::total_cmp);
    let median = 0.5 * (random[RANDOM as usize / 2 - 1] + random[RANDOM as usize / 2]);
    // what is left of the information of the holds beside a drift
    let parameters = problem.list.len();
    let with_drift = design.bound.efficiency_of(
        &problem.criterion,
        problem.criterion.value(&design.covariance),
        parameters,
    );
    let found = design.efficiency(&problem.criterion);
    println!(
        "| {name} | {letter} | {poses} | {} | {} | {} | {} | {seconds:.2} |",
        percent(found),
        percent(median),
        percent(random[RANDOM as usize - 1]),
        percent(1.0 - with_drift / found)
    );
    Ok(())
}

/// Efficiency of these directions, against the bound of a design; 0 where they leave parameters undetermined.
fn efficiency(problem: &PoseProblem, design: &PoseDesign, directions: &[Vector3<f64>]) -> f64 {
    covariance_of_holds(problem, directions).map_or(0.0, |covariance| {
        let value = problem.criterion.value(&covariance);
        design.bound.efficiency_of(&problem.criterion, value, problem.list.len())
    })
}

fn percent(share: f64) -> String {
    if share <= 0.0 { "0".into() } else { format!("{:.1} %", 100.0 * share) }
}

fn habits() -> Vec<(&'static str, Vec<Vector3<f64>>)> {
    let cube = |edges, corners| match Allowed::cube(edges, corners) {
        Allowed::Of(list) => list,
        _ => Vec::new(),
    };
    let faces = cube(false, false);
    // each face, and the face tilted by 45° towards the next one
    let tilted = [(0, 1), (1, 2), (2, 0)].map(|(up, towards)| {
        let between = (Vector3::ith(up, 1.0) + Vector3::ith(towards, 1.0)).normalize();
        [between, -between]
    });
    let twelve = [faces.clone(), tilted.concat()].concat();
    vec![
        ("six faces", faces.clone()),
        ("six faces twice", [faces.clone(), faces].concat()),
        ("six faces, six tilted by 45°", twelve),
        ("18 of a cube", cube(true, false)),
        ("26 of a cube", cube(true, true)),
    ]
}
