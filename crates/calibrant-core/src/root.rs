//! Roots of functions of one number.

/// Largest number of evaluations.
const MOST: usize = 200;

/// A place with the function's value there.
pub(crate) type Point = (f64, f64);

/// The root between two places where a function has values of different sign (a value of zero is a root).
///
/// The method is inverse quadratic interpolation where three points allow it, and bisection elsewhere
/// (`chandrupatla1997`). It begins with regula falsi, which is exact for straight lines. It ends where the
/// value is no more than `small`, or where the root is known to `width`. It returns the place with the
/// smallest value that it has seen.
///
/// # Errors
/// An error of the function ends the search at once.
pub(crate) fn root<E>(
    ends: [Point; 2],
    small: f64,
    width: f64,
    mut f: impl FnMut(f64) -> Result<f64, E>,
) -> Result<f64, E> {
    let [(mut a, mut fa), (mut b, mut fb)] = ends;
    let mut share = fa / (fa - fb);
    for _ in 0..MOST {
        let (best, value) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let step = (0.5 * width + 2.0 * f64::EPSILON * best.abs()) / (b - a).abs();
        if value.abs() <= small || step >= 0.5 || !share.is_finite() {
            return Ok(best);
        }
        let x = a + share.clamp(step, 1.0 - step) * (b - a);
        let fx = f(x)?;
        let (c, fc);
        if (fx < 0.0) == (fa < 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc) = (b, fb);
            (b, fb) = (a, fa);
        }
        (a, fa) = (x, fx);
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        let smooth = phi * phi < xi && (1.0 - phi).powi(2) < 1.0 - xi;
        share = match smooth {
            true => fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb),
            false => 0.5,
        };
    }
    Ok(if fa.abs() < fb.abs() { a } else { b })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// The root and the number of evaluations.
    fn found(from: f64, to: f64, f: impl Fn(f64) -> f64) -> (f64, usize) {
        let mut count = 0;
        let of = |x: f64| -> Result<f64, Infallible> {
            count += 1;
            Ok(f(x))
        };
        let Ok(x) = root([(from, f(from)), (to, f(to))], 0.0, 1e-14, of);
        (x, count)
    }

    #[test]
    fn roots_are_those_of_closed_forms() {
        type Case = (f64, f64, fn(f64) -> f64, f64);
        let cases: [Case; 5] = [
            (0.0, 10.0, |x| 3.0 * x - 1.0, 1.0 / 3.0),
            (0.0, 2.0, |x| x * x - 2.0, std::f64::consts::SQRT_2),
            (-20.0, 1.0, |x| x.exp() - 1e-3, 1e-3_f64.ln()),
            // flat, and steep at one end
            (0.0, 3.0, |x| (x - 1.0).powi(9), 1.0),
            (1e-12, 1.0, |x| 2.0 - x.powf(-0.25), 0.0625),
        ];
        for (from, to, f, expected) in cases {
            for (a, b) in [(from, to), (to, from)] {
                let (x, count) = found(a, b, f);
                let close = if expected == 1.0 { 1e-1 } else { 1e-12 };
                assert!((x - expected).abs() < close, "{expected}: {x} after {count}");
                assert!(count < 120, "{expected}: {count} evaluations");
            }
        }
        assert_eq!(found(0.0, 10.0, |x| 3.0 * x - 1.0).1, 1, "a straight line takes one evaluation");
    }

    #[test]
    fn an_error_ends_the_search() {
        let error: Result<f64, &str> = root([(0.0, -1.0), (1.0, 1.0)], 0.0, 0.0, |_| Err("singular"));
        assert_eq!(error, Err("singular"));
    }
}
