//! Does the gyroscope change from a hold on? Its bias shows in the holds, its gains and axes in the rotations.

use crate::diagnostic::{Change, Changed};
use crate::estimate::change::Series;
use crate::estimate::hold_result::HoldCalibration;
use crate::estimate::imu::model::{Fit, GravityResidual, ImuModel};
use crate::motion::Hold;
use crate::sensor::{Axis, Condition, ImuQuantity, MeanReading, SensorKind};
use nalgebra::{DMatrix, DVector, Matrix2x3, Matrix3, Vector2, Vector3};

/// The gyroscope of a fitted problem.
pub(crate) struct Changing<'a> {
    pub(crate) model: &'a ImuModel<'a>,
    pub(crate) fit: &'a Fit,
    /// Its means in the holds of the problem, also in those in which it is taken to turn.
    pub(crate) readings: &'a [Option<MeanReading>],
    /// Its scatter between holds.
    pub(crate) between: Vector3<f64>,
    pub(crate) holds: &'a HoldCalibration,
    /// Numbers of the holds of the problem.
    pub(crate) numbers: &'a [usize],
}

impl Changing<'_> {
    /// The changes of both sensors, that of the accelerometer being known. An accelerometer that changes gives directions with which rotations miss gravity: that is no change of the gyroscope.
    pub(crate) fn changes(&self) -> Vec<Change> {
        let rotations = || self.holds.change.is_none().then(|| self.in_rotations()).flatten();
        self.holds.change.as_deref().copied().into_iter().chain(self.at_rest()).chain(rotations()).collect()
    }

    fn hold(&self, place: usize) -> &Hold {
        &self.holds.holds[self.numbers[place]].hold
    }

    /// The mean rates in the holds, each axis by itself: its scatter is its own.
    fn at_rest(&self) -> Option<Change> {
        let places: Vec<usize> = (0..self.readings.len()).filter(|&j| self.readings[j].is_some()).collect();
        let series: Vec<Series> = Axis::ALL.into_iter().map(|axis| self.rates(&places, axis)).collect();
        let found = series.iter().filter_map(|of_axis| of_axis.change(series.len()));
        let mut found = found.min_by(|one, other| one.p_value.total_cmp(&other.p_value))?;
        for (axis, of_axis) in series.iter().enumerate() {
            if let Some((amount, sd)) = of_axis.amount(Changed::Bias, found.when) {
                (found.amount[axis], found.sd[axis]) = (amount[axis], sd[axis]);
            }
        }
        let step = |last: usize, first: usize| {
            let (last, first) = (places[last], places[first]);
            let time_s = 0.5 * (self.hold(last).end_s + self.hold(first).start_s);
            (self.numbers[last], self.numbers[first], time_s)
        };
        Some(Change::of(SensorKind::Gyroscope, found, step))
    }

    /// What the holds leave unexplained of the mean rate of an axis.
    fn rates(&self, places: &[usize], axis: Axis) -> Series {
        let (model, axis) = (self.model, axis.index());
        let quantities: Vec<ImuQuantity> =
            model.gyroscope_places().into_iter().map(|k| model.quantities[k]).collect();
        let (rows, imu) = (places.len(), &self.fit.state.imu);
        let gain = imu[SensorKind::Gyroscope].matrix.row(axis).norm();
        let mut errors = DVector::zeros(rows);
        let (mut parameters, mut bias) = (DMatrix::zeros(rows, quantities.len()), DMatrix::zeros(rows, 3));
        for (row, (&place, still)) in
            places.iter().zip(places.iter().filter_map(|&place| self.readings[place])).enumerate()
        {
            let (force, temperature_c) = (self.fit.state.forces[place], model.holds[place].temperature_c);
            let at = Condition { imu, stimulus: model.earth.rate(place, &force), force, temperature_c };
            let of_noise = model.gyroscope_noise.variance(still.samples)[axis];
            let sd = (of_noise + self.between[axis].powi(2)).max(f64::MIN_POSITIVE).sqrt();
            let expected = model.at_rest(place, &imu.at(temperature_c), &force);
            errors[row] = (still.mean - expected)[axis] / sd;
            for (k, quantity) in quantities.iter().enumerate() {
                parameters[(row, k)] = quantity.derivative(&at)[axis] / sd;
            }
            bias[(row, axis)] = gain / sd;
        }
        Series {
            times_s: places.iter().map(|&place| middle(self.hold(place))).collect(),
            left_out: places.iter().map(|&place| model.holds[place].gyroscope.is_none()).collect(),
            errors,
            parameters,
            kinds: vec![(Changed::Bias, bias)],
        }
    }

    /// What the rotations leave unexplained of gravity.
    fn in_rotations(&self) -> Option<Change> {
        let (model, imu) = (self.model, &self.fit.state.imu);
        let seen: Vec<(usize, &GravityResidual)> = self
            .fit
            .residuals
            .iter()
            .enumerate()
            .filter_map(|(i, residual)| Some((i, residual.as_ref()?)))
            .collect();
        // the holds alone know bias and g-sensitivity far better
        let of_turns = |k: &usize| {
            let quantity = model.quantities[*k];
            !quantity.is_of_bias() && !matches!(quantity, ImuQuantity::GSensitivity(..))
        };
        let matrix: Vec<usize> = model.gyroscope_places().into_iter().filter(of_turns).collect();
        let rows = 2 * seen.len();
        let mut errors = DVector::zeros(rows);
        let mut parameters = DMatrix::zeros(rows, matrix.len());
        let (mut gain, mut axes) = (DMatrix::zeros(rows, 3), DMatrix::zeros(rows, 3));
        for (number, (i, residual)) in seen.iter().enumerate() {
            let variance = model.rotation_scatter.covariance(*i, residual);
            let white = variance.cholesky()?.l().try_inverse()?;
            let put = |into: &mut DMatrix<f64>, column: usize, value: Vector2<f64>| {
                into.fixed_view_mut::<2, 1>(2 * number, column).copy_from(&value);
            };
            errors.fixed_rows_mut::<2>(2 * number).copy_from(&(white * residual.error));
            let (mut by_gain, mut by_axes) = (Matrix2x3::zeros(), Matrix2x3::zeros());
            for (column, &k) in matrix.iter().enumerate() {
                let by = white * residual.by_parameters.column(k);
                put(&mut parameters, column, by);
                let Some((of_gain, of_axes)) = entry(model.quantities[k], &imu[SensorKind::Gyroscope].matrix)
                else {
                    continue;
                };
                // what the estimate lacks of the truth
                by_gain -= by * of_gain.transpose();
                by_axes -= by * of_axes.transpose();
            }
            for axis in 0..3 {
                put(&mut gain, axis, by_gain.column(axis).into_owned());
                put(&mut axes, axis, by_axes.column(axis).into_owned());
            }
        }
        let between = |i: usize| {
            let data = &model.rotations[i];
            0.5 * (self.hold(data.from).end_s + self.hold(data.from + 1).start_s)
        };
        let series = Series {
            times_s: seen.iter().map(|(i, _)| between(*i)).collect(),
            left_out: seen.iter().map(|(i, _)| !model.rotations[*i].counts).collect(),
            errors,
            parameters,
            kinds: vec![(Changed::Gain, gain), (Changed::Axes, axes)],
        };
        let step = |last: usize, first: usize| {
            let (last, first) = (model.rotations[seen[last].0].from + 1, model.rotations[seen[first].0].from);
            let time_s = 0.5 * (self.hold(last).start_s + self.hold(first).end_s);
            (self.numbers[last], self.numbers[first], time_s)
        };
        Some(Change::of(SensorKind::Gyroscope, series.change(1)?, step))
    }
}

/// How an entry of the gyroscope's matrix `M` changes with shares of its rows, and with a turn `ω` of its axes, `M [ω]×`; `None` for what is no entry of it.
fn entry(quantity: ImuQuantity, matrix: &Matrix3<f64>) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let ImuQuantity::Of(SensorKind::Gyroscope, of) = quantity else { return None };
    let (row, column) = of.entry().map(|(row, column)| (row.index(), column.index()))?;
    let turn = |axis: usize| (matrix * Vector3::ith(axis, 1.0).cross_matrix())[(row, column)];
    Some((Vector3::ith(row, matrix[(row, column)]), Vector3::from_fn(|axis, _| turn(axis))))
}

fn middle(hold: &Hold) -> f64 {
    0.5 * (hold.start_s + hold.end_s)
}
