//! A turn of known angle: `∫ (y_g − b_g − Γ f − S_g κ f) dt − S_g φ e`, at the temperature of the turn.

use crate::estimate::imu::model::{ImuModel, TurnData};
use crate::estimate::imu::terms::term::{At, Derivatives, Place, Residual, Term, Weight, by_quantities};
use crate::sensor::{Condition, ImuParameters, ImuQuantity, SensorKind};
use nalgebra::{Matrix3xX, Vector3};

#[derive(Debug)]
pub(crate) struct Turn;

impl ImuModel<'_> {
    /// The residual of a turn.
    pub(crate) fn turn_residual(&self, turn: &TurnData, imu: &ImuParameters) -> Vector3<f64> {
        let imu = imu.at(turn.temperature_c);
        turn.integral
            - imu[SensorKind::Gyroscope].bias * turn.duration_s
            - imu.g_sensitivity * turn.force
            - imu[SensorKind::Gyroscope].matrix * self.turned(turn)
    }

    /// The rotation of a turn, with the Earth's about the vertical, rad.
    fn turned(&self, turn: &TurnData) -> Vector3<f64> {
        turn.angle + turn.force * self.earth.vertical_rate()
    }
}

impl Term for Turn {
    fn rows(&self) -> usize {
        3
    }

    fn place(&self) -> Place {
        Place::Alone
    }

    fn count(&self, model: &ImuModel<'_>) -> usize {
        model.turns.len()
    }

    fn residual(&self, at: &At<'_>, k: usize) -> Option<Residual> {
        let turn = &at.model.turns[k];
        let r = at.model.turn_residual(turn, &at.state.imu);
        Some(Residual { r, weight: Weight::Rows(turn.weight) })
    }

    fn derivatives(&self, at: &At<'_>, k: usize) -> Derivatives {
        let turn = &at.model.turns[k];
        let (stimulus, force, temperature_c) = (at.model.turned(turn), turn.force, turn.temperature_c);
        let added_up = Condition { imu: &at.state.imu, stimulus, force, temperature_c };
        let derivative =
            |of: ImuQuantity| of.derivative(&added_up) * if of.is_of_bias() { turn.duration_s } else { 1.0 };
        Derivatives {
            by_directions: [None; 2],
            by_quantities: by_quantities(at.model, SensorKind::Gyroscope, derivative),
        }
    }

    fn by_earth(&self, at: &At<'_>, k: usize) -> Matrix3xX<f64> {
        let turn = &at.model.turns[k];
        at.model.earth.of_turn(&at.state.imu.at(turn.temperature_c), &turn.force)
    }

    fn tells(&self, model: &ImuModel<'_>, quantity: ImuQuantity, imu: &ImuParameters) -> bool {
        model.turns.iter().any(|turn| {
            let (stimulus, force, temperature_c) = (turn.angle, turn.force, turn.temperature_c);
            quantity.derivative(&Condition { imu, stimulus, force, temperature_c }).amax() > 0.0
        })
    }
}
