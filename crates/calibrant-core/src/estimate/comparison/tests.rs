use super::*;
use crate::estimate::{gravity_source, shared_gravity};
use crate::motion::Gravity;
use crate::sensor::{ImuParameters, ReadingUnit};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// An IMU against a gravity that is off by `error` standard deviations, with noise, and with gains of the accelerometer times `gain`.
fn against_gravity(gravity: Gravity, error: f64, gain: f64, rng: &mut ChaCha8Rng) -> CalibratedImu {
    let noise = 3e-5;
    let mut imu = imu();
    imu.parameters[SensorKind::Accelerometer].matrix *= gain;
    let size = imu.quantities.len();
    let slope = shared_gravity(&imu.quantities, &[], &imu.parameters, &gravity).expect("uncertain");
    for (k, quantity) in imu.quantities.iter().enumerate() {
        let drawn: f64 = StandardNormal.sample(rng);
        quantity.add_to(&mut imu.parameters, noise * drawn + slope.root[(k, 0)] * error);
    }
    imu.covariance =
        Some(DMatrix::identity(size, size) * noise * noise + &slope.root * slope.root.transpose());
    imu.shared = Some(slope);
    imu
}

#[test]
fn at_one_place_gravity_hides_no_change_and_makes_none() {
    let mut places = ChaCha8Rng::seed_from_u64(5);
    let mut noise = ChaCha8Rng::seed_from_u64(6);
    let (mut p_values, mut of_gain) = (Vec::new(), Vec::new());
    for pair in 0..300 {
        let of_place = StandardNormal.sample(&mut places);
        let a = against_gravity(Gravity::SOMEWHERE, of_place, 1.0, &mut noise);
        let b = against_gravity(Gravity::SOMEWHERE, of_place, 1.0, &mut noise);
        // in another frame, the errors of the place turn with the covariance
        let b = if pair % 2 == 0 { b } else { b.in_gauge(Gauge::Symmetric).expect("right-handed") };
        let one = Comparison::at(Place::One, &a, &b);
        p_values.push(one.overall.expect("covariances").p_value);
        of_gain.push(one.quantities[3].p_value.expect("covariances"));
        assert_eq!(one.overall_at_one_place, None);
    }
    for mut p_values in [p_values, of_gain] {
        p_values.sort_by(f64::total_cmp);
        // the distance of Kolmogorov and Smirnov that chance exceeds in 0.1 % of the cases
        let n = p_values.len() as f64;
        let apart =
            p_values.iter().enumerate().map(|(k, p)| (p - (k as f64 + 0.5) / n).abs()).fold(0.0, f64::max);
        assert!(apart < 1.95 / n.sqrt(), "{apart}");
    }
    let a = against_gravity(Gravity::SOMEWHERE, 1.3, 1.0, &mut noise);
    let b = against_gravity(Gravity::SOMEWHERE, 1.3, 1.003, &mut noise);
    let unknown = Comparison::of(&a, &b);
    let at_one = Comparison::at(Place::One, &a, &b);
    assert!(unknown.quantities[3].p_value.expect("known") > 0.05, "hidden");
    assert!(at_one.quantities[3].in_sd.expect("known").abs() > 50.0, "{:?}", at_one.quantities[3]);
    assert_eq!(unknown.overall_at_one_place, at_one.overall);
    assert!(unknown.notes.iter().any(|note| note.code().name() == "place-unknown"), "{:?}", unknown.notes);
    assert_eq!(Comparison::at(Place::Two, &a, &b).overall, unknown.overall);
    assert_eq!(Comparison::at(Place::Two, &a, &b).overall_at_one_place, None);
    // a gravity that somebody states tells the place; two that differ have errors of their own
    let stated = Gravity { magnitude_mps2: 9.81, sd_mps2: 0.019 };
    let [c, d] = [1.0, 1.003].map(|gain| against_gravity(stated, 0.4, gain, &mut noise));
    assert!(Comparison::of(&c, &d).quantities[3].in_sd.expect("known").abs() > 50.0);
    assert_eq!(Comparison::at(Place::One, &a, &d).overall, Comparison::at(Place::Two, &a, &d).overall);
    assert_ne!(gravity_source(&stated), gravity_source(&Gravity::SOMEWHERE));
}

fn imu() -> CalibratedImu {
    let mut parameters = ImuParameters::identity();
    for (k, quantity) in ImuQuantity::full_list(true, true, true).into_iter().enumerate() {
        quantity.add_to(&mut parameters, 1e-3 * ((5 * k % 13) as f64 - 6.0));
    }
    let quantities = ImuQuantity::full_list(true, true, true);
    let n = quantities.len();
    let root = DMatrix::from_fn(n, n, |i, j| if i == j { 1e-3 } else { 1e-5 * ((i * 3 + j * 5) % 7) as f64 });
    CalibratedImu {
        parameters,
        units: [Some(ReadingUnit::MetrePerSecondSquared), Some(ReadingUnit::RadianPerSecond)].into(),
        counts_per_unit: Default::default(),
        quantities,
        covariance: Some(&root * root.transpose()),
        degrees_of_freedom: None,
        shared: None,
        frame: String::new(),
    }
}

#[test]
fn one_sensor_in_two_gauges_does_not_differ() {
    let other = imu().in_gauge(Gauge::Upper).expect("regular");
    let comparison = Comparison::of(&imu(), &other);
    let overall = comparison.overall.expect("covariances");
    assert!(overall.chi2 < 1e-15 && overall.p_value > 0.999, "{overall:?}");
    assert_eq!(overall.degrees_of_freedom, 30, "3 of 33 are the frame");
    assert!(comparison.quantities.iter().all(|row| row.in_sd.is_none_or(|in_sd| in_sd.abs() < 1e-8)));
}

#[test]
fn the_overall_difference_does_not_depend_on_the_gauge() {
    let mut other = imu();
    for quantity in ImuQuantity::full_list(true, true, true) {
        let step = if quantity.name().contains('x') { 2e-5 } else { -1e-5 };
        quantity.add_to(&mut other.parameters, step);
    }
    let one = Comparison::of(&imu(), &other).overall.expect("covariances");
    let turned = other.in_gauge(Gauge::Symmetric).expect("regular");
    let two = Comparison::of(&imu(), &turned).overall.expect("covariances");
    assert!((one.chi2 / two.chi2 - 1.0).abs() < 1e-6, "{one:?} {two:?}");
    assert!(one.chi2 > 1e-3);
}

#[test]
fn biases_that_are_not_known_are_not_compared() {
    let mut other = CalibratedImu { covariance: None, ..imu() };
    for sensor_kind in SensorKind::ALL {
        let shift = if sensor_kind == SensorKind::Accelerometer { 0.0 } else { 1.0 };
        ImuQuantity::Of(sensor_kind, Quantity::Bias(crate::sensor::Axis::X))
            .add_to(&mut other.parameters, shift);
    }
    let far = Comparison::of(&imu(), &other).overall.expect("a covariance");
    assert!(far.chi2 > 1e5, "{far:?}");
    let of_gyroscope = |quantity: &ImuQuantity| {
        matches!(quantity, ImuQuantity::Of(SensorKind::Gyroscope, Quantity::Bias(_)))
    };
    other.quantities.retain(|quantity| !of_gyroscope(quantity));
    for comparison in [Comparison::of(&imu(), &other), Comparison::of(&other, &imu())] {
        let overall = comparison.overall.expect("a covariance");
        assert!(overall.chi2 < 1e-15, "{overall:?}");
        assert_eq!(overall.degrees_of_freedom, 27, "3 biases fewer");
        let names = comparison.quantities.iter().map(|row| row.invariant.name());
        assert_eq!(names.filter(|name| name.contains("bias")).count(), 3);
        let note = "does not say the biases of the gyroscope: they are not compared";
        assert!(
            comparison.notes.iter().any(|stated| stated.message().contains(note)),
            "{:?}",
            comparison.notes
        );
    }
}

#[test]
fn what_cannot_be_compared_is_said() {
    let exact = CalibratedImu { covariance: None, ..imu() };
    let stated = |a: &CalibratedImu, b: &CalibratedImu| format!("{:?}", Comparison::of(a, b).notes);
    assert!(stated(&imu(), &exact).contains("B has no covariance"));
    assert!(stated(&exact, &exact).contains("neither has a covariance"));
    assert_eq!(Comparison::of(&exact, &exact).overall, None);
    let counts = CalibratedImu {
        units: [Some(ReadingUnit::MetrePerSecondSquared), Some(ReadingUnit::Counts)].into(),
        ..imu()
    };
    let comparison = Comparison::of(&imu(), &counts);
    let note = comparison.notes[0].message();
    assert!(note.contains("in rad/s in A and in counts in B"), "{note}");
    let gain = comparison.quantities.iter().find(|row| row.invariant.name() == "gyroscope.gain.x");
    assert_eq!(gain.expect("shown").difference, None);
    let alone = CalibratedImu { units: [Some(ReadingUnit::MetrePerSecondSquared), None].into(), ..imu() };
    assert!(stated(&imu(), &alone).contains("B has no gyroscope"));
}
