//! Derived figures carry the uncertainty of all parameters that they are made from.

use crate::common::hand::ByHand;
use crate::common::{draw_imu, normal, run_imu};
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::sensor::{ImuParameters, ReadingUnit, SensorKind};
use calibrant::simulate::{Purpose, stream};
use nalgebra::DVector;

#[test]
fn a_derived_figure_scatters_as_its_parameters_do() {
    let mut rng = stream(97, Purpose::Sensor, 0);
    let mut imu = draw_imu(&mut rng);
    // a gain that is poorly known beside a large bias
    imu[SensorKind::Gyroscope].bias.x = 2.0;
    let setup = ByHand { poses: 14, gyroscope_noise: 0.05, ..ByHand::default() };
    let recording = setup.record(&imu, &mut rng);
    let found =
        run_imu(&recording, &unfeeling_gyroscope(), &steady_imu(), ReadingUnit::MetrePerSecondSquared)
            .expect("determined");
    let over_the_gain = |imu: &ImuParameters| {
        imu[SensorKind::Gyroscope].bias.x / imu[SensorKind::Gyroscope].matrix.row(0).norm()
    };
    let (value, sd) = found.propagated(over_the_gain);
    let root = found.covariance.clone().cholesky().expect("a covariance").l();
    let draws: Vec<f64> = (0..4000)
        .map(|_| {
            let off = &root * DVector::from_fn(root.nrows(), |_, _| normal(&mut rng));
            let mut drawn = found.imu;
            found
                .quantities
                .iter()
                .zip(off.iter())
                .for_each(|(quantity, off)| quantity.add_to(&mut drawn, *off));
            over_the_gain(&drawn)
        })
        .collect();
    let scatter = (draws.iter().map(|draw| (draw - value).powi(2)).sum::<f64>() / draws.len() as f64).sqrt();
    // 4000 draws tell a standard deviation to 1.1 %
    assert!((scatter / sd - 1.0).abs() < 0.05, "{scatter} {sd}");
    let place =
        found.quantities.iter().position(|quantity| quantity.name() == "gyroscope.bias.x").expect("there");
    assert!(sd > 1.5 * found.sd()[place], "the gain's share: {sd} {}", found.sd()[place]);
}
