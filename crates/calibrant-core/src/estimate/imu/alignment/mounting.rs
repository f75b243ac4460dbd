//! The mounting: a gyroscope that is rotated against the accelerometer by any angle, as on its own board.
//!
//! The search is needed if no order of the axes propagates gravity correctly.
//!
//! Its starts are all orders and signs of the axes, each rotated by up to 30° about the three axes. Every attitude, mirrored or not, is within 30° of a
//! start. Ever smaller rotations improve the best starts.

use crate::estimate::imu::alignment::axes::orders;
use crate::estimate::imu::alignment::coarse_rotations::CoarseRotations;
use nalgebra::{Matrix3, Rotation3, Vector3};
use rayon::prelude::*;

/// Fewest rotations for the search. Fewer fit some attitude by chance: half of twelve, within 0.2 rad of one of some 5000 attitudes, once in 10⁵ times.
const ENOUGH_ROTATIONS: usize = 12;

/// Angle between starts, rad.
const MESH_RAD: f64 = 0.52;

/// Number of starts that are improved.
const KNOTS_IMPROVED: usize = 8;

/// Angles of the rotations that improve a start, rad.
const TURNS_RAD: [f64; 4] = [0.3, 0.15, 0.07, 0.03];

/// Factors of an unknown gain that improve a start.
const GAIN_FACTORS: [f64; 2] = [0.93, 1.0 / 0.93];

/// Largest number of improvements with each angle.
const ROUNDS: usize = 6;

/// The matrix with the smallest median rotation error, rad, over all attitudes. `None` if the rotations are too few.
///
/// `is_scaled`: are the gains guesses?
pub(crate) fn find_mounting(
    look: &CoarseRotations,
    gains: &[Matrix3<f64>],
    is_scaled: bool,
) -> Option<(f64, Matrix3<f64>)> {
    if look.len() < ENOUGH_ROTATIONS {
        return None;
    }
    let judged = |matrix: Matrix3<f64>| Some((look.judge(&matrix)?.median_rad, matrix));
    let by_error = |one: &(f64, Matrix3<f64>), other: &(f64, Matrix3<f64>)| one.0.total_cmp(&other.0);
    // −1, 0 or 1 along each axis
    let digit = |k: i32, place: u32| f64::from(k / 3_i32.pow(place) % 3 - 1);
    let offsets = (0..27).map(|k| turned_by(MESH_RAD * Vector3::new(digit(k, 0), digit(k, 1), digit(k, 2))));
    let offsets: Vec<Matrix3<f64>> = offsets.collect();
    let orders = orders();
    let attitudes: Vec<Matrix3<f64>> =
        orders.iter().flat_map(|order| offsets.iter().map(move |offset| order * offset)).collect();
    let knot =
        |attitude: &Matrix3<f64>| gains.iter().filter_map(|gain| judged(gain * attitude)).min_by(by_error);
    let mut knots: Vec<(f64, Matrix3<f64>)> = attitudes.par_iter().filter_map(knot).collect();
    knots.sort_by(by_error);
    knots.truncate(KNOTS_IMPROVED);
    let improved = |(mut least, mut matrix): (f64, Matrix3<f64>)| {
        for angle in TURNS_RAD {
            let turns = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis * angle);
            let turns = turns.into_iter().flat_map(|turn| [turned_by(turn), turned_by(-turn)]);
            let scales = GAIN_FACTORS.into_iter().filter(|_| is_scaled).map(Matrix3::from_diagonal_element);
            let changes: Vec<Matrix3<f64>> = turns.chain(scales).collect();
            for _ in 0..ROUNDS {
                let tries = changes.iter().filter_map(|change| judged(matrix * change));
                match tries.min_by(by_error) {
                    Some(better) if better.0 < least => (least, matrix) = better,
                    _ => break,
                }
            }
        }
        (least, matrix)
    };
    knots.into_par_iter().map(improved).min_by(by_error)
}

fn turned_by(vector: Vector3<f64>) -> Matrix3<f64> {
    Rotation3::from_scaled_axis(vector).into_inner()
}
