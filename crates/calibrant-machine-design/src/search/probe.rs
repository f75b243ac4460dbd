//! Looks at the pointwise limits in an interval of a motion.

use crate::limits::{PointRows, PointWork, Pointwise};
use crate::motion::{Grid, Knots};
use nalgebra::DMatrix;

/// Places of an interval at which the limits are looked at: from its end on, where a new control point moves the machine most.
const PLACES: [f64; 4] = [0.999, 0.8, 0.5, 0.2];
/// Room of each row. Of a distance it is about 5 mm.
const ROOM: f64 = 0.05;

/// The pointwise limits of a motion on these knots.
pub(crate) struct Probe<'a> {
    pointwise: Pointwise<'a>,
    grid: Grid,
    work: PointWork,
    values: Vec<f64>,
}

impl<'a> Probe<'a> {
    pub(crate) fn new(pointwise: Pointwise<'a>, knots: Knots) -> Self {
        let work = pointwise.work();
        let values = vec![1.0; pointwise.rows()];
        Self { grid: Grid::at(knots, PLACES), pointwise, work, values }
    }

    /// Does interval `i` keep them with some room, at the places that are looked at?
    pub(crate) fn interval_is_free(&mut self, controls: &DMatrix<f64>, i: usize) -> bool {
        (0..PLACES.len()).all(|place| {
            let rows = PointRows {
                values: &mut self.values,
                by_position: &mut [],
                by_state: &mut [],
                with_slopes: false,
            };
            self.pointwise.at(&mut self.work, &self.grid, i * PLACES.len() + place, controls, rows);
            self.values.iter().all(|value| *value > ROOM)
        })
    }
}
