//! The step in which an encoder, or the decimals of a file, round the values of a log.

/// Changes that tell a step: the smallest ones, since over many steps the rounding of decimals adds up.
const FEWEST: usize = 50;
/// All changes of fewer steps than this are looked at,
const SMALL: f64 = 30.0;
/// and none of more.
const LARGEST: f64 = 1e5;
/// A change is a multiple of the step where it is this near to one, in steps.
const TOLERANCE: f64 = 0.05;
/// Share of the changes that are multiples where values have steps. Of other values a tenth is, by chance.
const MULTIPLES: f64 = 0.9;

/// The step of which all changes of these values are multiples; 0 where there is none. Values that are not finite are left out.
///
/// # Examples
/// ```
/// use calibrant_machine::log::step_of;
/// let angle = |k: i32| (0.01 * f64::from(k)).sin();
/// let rounded = (0..500).map(|k| (angle(k) / 0.002).round() * 0.002);
/// assert!((step_of(rounded) - 0.002).abs() < 1e-12);
/// assert_eq!(step_of((0..500).map(angle)), 0.0);
/// ```
#[must_use]
pub fn step_of(values: impl IntoIterator<Item = f64>) -> f64 {
    let finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
    let changes: Vec<f64> =
        finite.array_windows().map(|[one, next]| (next - one).abs()).filter(|change| *change > 0.0).collect();
    let step = changes.iter().copied().fold(f64::INFINITY, f64::min);
    let mut ratios: Vec<f64> = changes.iter().map(|change| change / step).collect();
    ratios.sort_by(f64::total_cmp);
    let farthest = ratios.get(FEWEST - 1).map_or(0.0, |ratio| ratio.clamp(SMALL, LARGEST));
    let near = &ratios[..ratios.partition_point(|ratio| *ratio <= farthest)];
    let multiples = near.iter().filter(|n| (**n - n.round()).abs() < TOLERANCE).count();
    let has_steps = near.len() >= FEWEST && multiples as f64 >= MULTIPLES * near.len() as f64;
    if has_steps { step } else { 0.0 }
}

/// Standard deviation of the error of values that are rounded to this step: even over it, `q/√12`.
#[must_use]
pub(crate) fn rounding_sd(step: f64) -> f64 {
    step / 12.0_f64.sqrt()
}
