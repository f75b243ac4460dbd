//! Tests of the pages on the noise of a sensor.

use super::super::noise_sheet;
use super::{about, assert_sound};
use calibrant_core::noise::{PowerLaw, Segment, SensorNoise};
use calibrant_core::sensor::{ReadingUnit, Recording, SensorKind};
use calibrant_core::simulate::{Purpose, simulate_noise, stream};
use nalgebra::Vector3;

fn noise(sensor_kind: SensorKind, unit: ReadingUnit, drift: f64) -> SensorNoise {
    let (n, interval) = (6000, 0.01);
    let mut rng = stream(3, Purpose::Sensor, 0);
    let mut axis = |walk: f64| {
        let mut values = simulate_noise(PowerLaw::White, 1e-3, interval, n, &mut rng);
        let walk = simulate_noise(PowerLaw::RandomWalk, walk, interval, n, &mut rng);
        values.iter_mut().zip(walk).for_each(|(value, walk)| *value += walk);
        values
    };
    of_axes(sensor_kind, unit, &[axis(0.0), axis(5e-3), axis(0.0)], drift)
}

fn of_axes(sensor_kind: SensorKind, unit: ReadingUnit, axes: &[Vec<f64>; 3], drift: f64) -> SensorNoise {
    let (n, interval) = (axes[0].len(), 0.01);
    let times_s = (0..n).map(|k| k as f64 * interval).collect();
    let reading = |k: usize| Vector3::new(axes[0][k], axes[1][k], axes[2][k] + drift * k as f64);
    let readings = (0..n).map(reading).collect();
    let recording = Recording::new(times_s, readings, 3, unit).expect("samples in order");
    let segment = Segment::between(&recording, 0.0, 1e3).expect("long enough");
    SensorNoise::of(sensor_kind, &recording, segment).expect("noisy")
}

#[test]
fn a_page_shows_the_plot_the_coefficients_and_what_is_not_determined() {
    let accelerometer = noise(SensorKind::Accelerometer, ReadingUnit::MetrePerSecondSquared, 0.0);
    let gyroscope = noise(SensorKind::Gyroscope, ReadingUnit::Counts, 0.0);
    let html = noise_sheet(&[accelerometer, gyroscope], None, &about()).html();
    assert_sound(&html);
    for text in [
        "Allan deviation of the accelerometer",
        "Allan deviation of the gyroscope",
        "velocity random walk N z",
        "rate random walk K y",
        "µg/√Hz",
        "counts/√Hz",
        "not determined",
        "record for longer",
        "cluster time τ (s)",
    ] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn a_drift_is_told_apart() {
    // 40 standard deviations of the slope that white noise makes; a random walk as large as the recording
    // permits makes 10 of them
    let html =
        noise_sheet(&[noise(SensorKind::Gyroscope, ReadingUnit::RadianPerSecond, 3e-6)], None, &about())
            .html();
    assert_sound(&html);
    assert!(
        html.contains("gyroscope z drifts by") && html.contains("linear drift") && html.contains("deg/√h")
    );
}

/// The contribution of a filter with a resonance to short cluster times has the slope of quantisation, but is
/// none.
#[test]
fn a_filters_share_is_not_called_quantisation() {
    let mut rng = stream(4, Purpose::Sensor, 0);
    // two poles at 0.7 and 60 degrees
    let mut axis = || {
        let mut before = [0.0; 2];
        let white = simulate_noise(PowerLaw::White, 1e-3, 0.01, 6000, &mut rng);
        let resonance = |x: &f64| {
            before = [0.79 * x + 0.7 * before[0] - 0.49 * before[1], before[0]];
            before[0]
        };
        white.iter().map(resonance).collect::<Vec<f64>>()
    };
    let (sensor_kind, unit) = (SensorKind::Accelerometer, ReadingUnit::MetrePerSecondSquared);
    let resonant = of_axes(sensor_kind, unit, &[axis(), axis(), axis()], 0.0);
    let page = |noise: &SensorNoise| noise_sheet(std::slice::from_ref(noise), None, &about()).html();
    let filtered = resonant.axes.iter().filter(|axis| axis.fit.filtered).count();
    assert!(filtered > 0, "{:?}", resonant.warnings);
    let html = page(&resonant);
    assert_sound(&html);
    assert!(html.contains("share of a filter") && html.contains("not from quantisation"));
    assert!(!page(&noise(sensor_kind, unit, 0.0)).contains("share of a filter"));
}
