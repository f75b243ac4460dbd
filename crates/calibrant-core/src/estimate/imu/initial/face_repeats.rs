//! Faces that are held more than once.
//!
//! A box that is off square shows the same tilt each time it lies on a face, of variance `τ²`: only what is new at each placement, `w²`, averages out. It is the
//! scatter of the holds on one face across its direction, beyond their noise. The mean of `r` holds has `τ² + w²/r`, and counts as one. Where each hold stays
//! one, as between rotations, it has `r` times that: the information is the same.

use crate::estimate::hold_variance::noise_variance;
use crate::estimate::imu::initial::face_alignment::FaceScatter;
use crate::motion::Hold;
use nalgebra::{Matrix3, Vector3};

/// Cosine of two forces on the same face.
const SAME: f64 = 1.0 - 1e-9;

/// The faces, how often each was held, and the scatter of placements.
#[derive(Debug, Clone, Default)]
pub(crate) struct FaceRepeats {
    faces: Vec<(Vector3<f64>, usize)>,
    /// `w²`, rad².
    pub(crate) placement_rad2: f64,
}

impl FaceRepeats {
    /// Those of holds with these forces.
    pub(crate) fn of(forces: &[Vector3<f64>]) -> Self {
        let mut repeats = Self::default();
        for force in forces {
            let up = force.normalize();
            match repeats.faces.iter_mut().find(|(face, _)| face.dot(&up) > SAME) {
                Some((_, times)) => *times += 1,
                None => repeats.faces.push((up, 1)),
            }
        }
        repeats
    }

    /// The mean of the holds on each face, and its force.
    pub(crate) fn means(&self, holds: &[&Hold], forces: &[Vector3<f64>]) -> (Vec<Hold>, Vec<Vector3<f64>>) {
        let mean = |these: Vec<(&Hold, Vector3<f64>)>| {
            let samples: usize = these.iter().map(|(hold, _)| hold.samples()).sum();
            let (first, force) = *these.first()?;
            let sum =
                these.iter().fold(Vector3::zeros(), |sum, (hold, _)| sum + hold.mean * hold.samples() as f64);
            let sd = Hold::pooled_sd(these.iter().map(|(hold, _)| *hold));
            Some((
                Hold { end: first.first + samples, mean: sum / samples as f64, sd, ..first.clone() },
                force,
            ))
        };
        self.faces.iter().filter_map(|(face, _)| mean(on(face, holds, forces))).unzip()
    }

    /// The same with the scatter of placements that these holds show; `s`: the matrix by which tilts move the readings.
    pub(crate) fn with_placement(
        self,
        holds: &[&Hold],
        forces: &[Vector3<f64>],
        s: &Matrix3<f64>,
        (within, of_mean): (&Vector3<f64>, &Vector3<f64>),
    ) -> Self {
        let Some(to_force) = s.try_inverse() else { return self };
        let (mut squares, mut noise, mut degrees) = (0.0, 0.0, 0.0);
        for (face, times) in self.faces.iter().filter(|(_, times)| *times > 1) {
            let these = on(face, holds, forces);
            let count = *times as f64;
            let mean = these.iter().fold(Vector3::zeros(), |sum, (hold, _)| sum + hold.mean) / count;
            for (hold, force) in &these {
                let gravity = force.norm();
                let off = to_force * (hold.mean - mean) / gravity;
                squares += (off - face * face.dot(&off)).norm_squared();
                let variance = Matrix3::from_diagonal(&noise_variance(hold, within, of_mean));
                let by_noise = to_force * variance * to_force.transpose() / gravity.powi(2);
                noise += (by_noise.trace() - face.dot(&(by_noise * face))) * (count - 1.0) / count;
            }
            degrees += 2.0 * (count - 1.0);
        }
        let placement_rad2 = if degrees > 0.0 { ((squares - noise) / degrees).max(0.0) } else { 0.0 };
        Self { placement_rad2, ..self }
    }

    /// Covariance of the mean of a face, (m/s²)²; `scatter`: what all its holds share.
    pub(crate) fn of_face(&self, scatter: &FaceScatter, force: &Vector3<f64>) -> Matrix3<f64> {
        scatter.covariance(force) + self.placement(force) / self.times(force)
    }

    /// Covariance of one of the holds on a face beside the others.
    pub(crate) fn of_hold(&self, scatter: &FaceScatter, force: &Vector3<f64>) -> Matrix3<f64> {
        scatter.covariance(force) * self.times(force) + self.placement(force)
    }

    /// What is new at each placement.
    fn placement(&self, force: &Vector3<f64>) -> Matrix3<f64> {
        FaceScatter::of(self.placement_rad2.sqrt(), 0.0, self.faces.len()).covariance(force)
    }

    fn times(&self, force: &Vector3<f64>) -> f64 {
        let up = force.normalize();
        self.faces.iter().find(|(face, _)| face.dot(&up) > SAME).map_or(1.0, |(_, times)| *times as f64)
    }
}

/// The holds on a face, with their forces.
fn on<'h>(face: &Vector3<f64>, holds: &[&'h Hold], forces: &[Vector3<f64>]) -> Vec<(&'h Hold, Vector3<f64>)> {
    let all = holds.iter().copied().zip(forces.iter().copied());
    all.filter(|(_, force)| force.normalize().dot(face) > SAME).collect()
}
