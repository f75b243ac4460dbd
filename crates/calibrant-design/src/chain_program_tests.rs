//! The interior-point method against Clarabel.

use super::*;
use crate::admissible_region::{Region, WatchedIntervals};
use crate::conic_program::{ConicProgram, Row as ConicRow};
use crate::stage_rows::Peaks;
use calibrant_core::motion::{AxisLimits, Rest};

/// One axis with every limit, an uneven slope and two forms.
#[test]
fn the_minimum_is_that_of_clarabel() {
    for nodes in [21, 301] {
        let limits = AxisLimits {
            acceleration: Some(10.0),
            jerk: Some(30.0),
            velocity: Some(0.6),
            displacement: Some(0.1),
            rest: Rest::Both,
            ..AxisLimits::default()
        };
        let tau: Vec<f64> = (0..nodes).map(|i| 0.1 * i as f64).collect();
        let region = Region::new(limits, &tau);
        let slope: Vec<f64> = (0..nodes).map(|i| (1.7 * i as f64).sin() / nodes as f64).collect();
        let forms: [Vec<f64>; 2] =
            [1.1, 0.3].map(|w| (0..nodes).map(|i| (w * i as f64).cos() / (nodes as f64).sqrt()).collect());

        let mut chain = region.chain(&Peaks::default());
        chain.slope.iter_mut().zip(&slope).for_each(|(z, slope)| z[0] = *slope);
        let own = ChainProgram {
            chains: vec![chain],
            forms: forms.iter().map(|b| Form { b: vec![b.clone()], offset: 0.05 }).collect(),
            reached: 0.0025,
        };
        let start = vec![region.stages(&vec![0.0; nodes])];
        let found = own.solve(start, 1.0).expect("the start is inside");
        assert!(found.iterations < 40, "{}", found.iterations);

        let mut program = ConicProgram::default();
        program.add_variables(nodes);
        region.add_to(&mut program, |i| i, &WatchedIntervals::default());
        slope.iter().enumerate().for_each(|(i, slope)| program.add_linear(i, *slope));
        for b in &forms {
            let z = program.add_variables(1);
            program.add_square(z, 1.0);
            let terms = b.iter().copied().enumerate().chain([(z, -1.0)]);
            program.zero(ConicRow::new(-0.05, terms));
        }
        let clarabel = program.solve().expect("a solution");
        let stages =
            vec![region.stages(&clarabel.x[..nodes].iter().map(|x| x * region.size).collect::<Vec<_>>())];
        let least = own.objective(&stages, &own.forms_at(&stages));
        let value = own.reached - found.gained;
        assert!(value < 0.0 && (value - least).abs() <= found.gap + 1e-8, "{value} {least} {}", found.gap);
        assert!(found.gap < 0.011 * found.gained, "{}", found.gap);
    }
}
