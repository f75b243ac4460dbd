//! Gauss–Newton with Levenberg–Marquardt damping, on parameters and the nodes that follow them.
//!
//! Each step solves `(F + λ diag F) δp = g` on the border of an arrowhead, and then the nodes for `δp`. Only the border is damped: for given parameters
//! the nodes are nearly a linear problem. λ is zero until a step fails to lower χ².

use super::status::CalibrationStatus;
use crate::arrowhead::Arrowhead;
use nalgebra::{DMatrix, DVector, SVector};

/// χ² may grow by this share: its rounding.
const SLACK: f64 = 1e-9;
/// The damping falls or grows by this factor, and ends below the least.
const FACTOR: f64 = 10.0;
const LEAST_DAMPING: f64 = 1e-6;

/// The normal equations at a point, and the diagonal of the border's information before the nodes were eliminated.
pub(crate) type Equations<const D: usize, const P: usize> = (Arrowhead<D, P>, SVector<f64, P>);

/// A problem with P parameters and nodes of size D.
pub(crate) trait LeastSquares<const D: usize, const P: usize> {
    /// Parameters and nodes, with what χ² and the equations need there.
    type Point;

    fn chi2(&self, at: &Self::Point) -> f64;

    /// `None` where a matrix is singular.
    fn equations(&self, at: &Self::Point) -> Option<Equations<D, P>>;

    /// The point after a step of the parameters. `None` where it leaves the model.
    fn moved(
        &self,
        at: &Self::Point,
        system: &Arrowhead<D, P>,
        step: &SVector<f64, P>,
    ) -> Option<Self::Point>;

    /// The nodes that are best for the parameters of a trial, tried before it is refused.
    fn followed(&self, _trial: Self::Point) -> Option<Self::Point> {
        None
    }
}

/// What differs between problems.
pub(crate) struct LoopSettings<'a> {
    /// Steps at most.
    pub(crate) most: usize,
    /// The loop ends with a step below this length, in standard deviations of the parameters.
    pub(crate) tolerance: f64,
    /// Pairs of a length and a number n: a step shorter than the length counts as rounding once n steps in a row have not halved the shortest one.
    pub(crate) rounding: &'a [(f64, usize)],
    /// A step below this length is not tested by χ².
    pub(crate) untested_below: f64,
    /// The size of χ² below which it is rounding.
    pub(crate) least_chi2: f64,
    /// The damping of the first step that is tried again, and the one with which the loop gives up.
    pub(crate) damping: [f64; 2],
    /// Do the nodes follow a last step once the parameters rest?
    pub(crate) has_last_step: bool,
}

/// Where the loop ended.
pub(crate) struct Minimum<T, const D: usize, const P: usize> {
    pub(crate) point: T,
    pub(crate) system: Arrowhead<D, P>,
    unreduced: SVector<f64, P>,
    pub(crate) chi2: f64,
    pub(crate) status: CalibrationStatus,
    pub(crate) iterations: usize,
    /// Length of the next step, in standard deviations of the parameters.
    pub(crate) gradient_norm: f64,
}

impl<T, const D: usize, const P: usize> Minimum<T, D, P> {
    /// The information of the first parameters, the nodes eliminated.
    pub(crate) fn information(&self, size: usize) -> DMatrix<f64> {
        DMatrix::from_fn(size, size, |i, j| self.system.information[(i, j)])
    }

    /// Diagonal of the information of the first parameters before the nodes were eliminated.
    pub(crate) fn unreduced(&self, size: usize) -> DVector<f64> {
        DVector::from_fn(size, |k, _| self.unreduced[k])
    }

    fn trial<L: LeastSquares<D, P, Point = T>>(&self, problem: &L, damping: f64) -> Option<(f64, T)> {
        let step = self.system.border_step(damping)?;
        let point = problem.moved(&self.point, &self.system, &step)?;
        Some((problem.chi2(&point), point))
    }

    /// Goes to a trial. `None` where its equations are singular.
    fn accept<L: LeastSquares<D, P, Point = T>>(
        &mut self,
        problem: &L,
        (chi2, point): (f64, T),
    ) -> Option<()> {
        (self.system, self.unreduced) = problem.equations(&point)?;
        (self.chi2, self.point) = (chi2, point);
        Some(())
    }
}

/// Iterates from a point with its equations.
pub(crate) fn minimise<L: LeastSquares<D, P>, const D: usize, const P: usize>(
    problem: &L,
    start: L::Point,
    (system, unreduced): Equations<D, P>,
    settings: &LoopSettings<'_>,
) -> Minimum<L::Point, D, P> {
    let mut now = Minimum {
        chi2: problem.chi2(&start),
        point: start,
        system,
        unreduced,
        status: CalibrationStatus::IterationLimit,
        iterations: 0,
        gradient_norm: f64::INFINITY,
    };
    let (mut damping, mut best, mut since) = (0.0_f64, f64::INFINITY, 0);
    while now.iterations < settings.most {
        now.iterations += 1;
        let norm = now.system.gradient_norm();
        now.gradient_norm = norm;
        (best, since) = if norm < 0.5 * best { (norm, 0) } else { (best, since + 1) };
        let is_rounding = |(length, steps): &(f64, usize)| norm < *length && since >= *steps;
        if norm <= settings.tolerance || settings.rounding.iter().any(is_rounding) {
            now.status = CalibrationStatus::Converged;
            if settings.has_last_step
                && let Some(last) = now.trial(problem, 0.0)
            {
                // where the equations of the last step are singular, it is not taken
                now.accept(problem, last);
            }
            break;
        }
        let acceptable = now.chi2 + SLACK * now.chi2.abs().max(settings.least_chi2);
        let is_good = |(chi2, _): &(f64, L::Point)| *chi2 <= acceptable || norm < settings.untested_below;
        let follow = |trial: (f64, L::Point)| {
            if is_good(&trial) {
                return Some(trial);
            }
            let followed = problem.followed(trial.1)?;
            Some((problem.chi2(&followed), followed)).filter(is_good)
        };
        let trial = now.trial(problem, damping).and_then(follow);
        match trial.and_then(|trial| now.accept(problem, trial)) {
            Some(()) => damping = if damping < LEAST_DAMPING { 0.0 } else { damping / FACTOR },
            None => {
                let [first, largest] = settings.damping;
                damping = (damping * FACTOR).max(first);
                (best, since) = (f64::INFINITY, 0);
                if damping > largest {
                    now.status = CalibrationStatus::Stalled;
                    break;
                }
            }
        }
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, Vector1, Vector2};

    const SETTINGS: LoopSettings<'_> = LoopSettings {
        most: 50,
        tolerance: 1e-10,
        rounding: &[(1e-6, 1)],
        untested_below: 0.0,
        least_chi2: 0.0,
        damping: [1e-4, 1e14],
        has_last_step: false,
    };

    type Linearised<const P: usize> = (SVector<f64, P>, SMatrix<f64, P, P>);

    /// Residuals with their derivatives, without nodes.
    struct Residuals<const P: usize>(fn(&SVector<f64, P>) -> Linearised<P>);

    impl<const P: usize> LeastSquares<1, P> for Residuals<P> {
        type Point = SVector<f64, P>;

        fn chi2(&self, at: &Self::Point) -> f64 {
            self.0(at).0.norm_squared()
        }

        fn equations(&self, at: &Self::Point) -> Option<Equations<1, P>> {
            let (r, j) = self.0(at);
            let information = j.tr_mul(&j);
            Some((Arrowhead::rigid(0, information, -j.tr_mul(&r)), information.diagonal()))
        }

        fn moved(&self, at: &Self::Point, _: &Arrowhead<1, P>, step: &Self::Point) -> Option<Self::Point> {
            Some(at + step)
        }
    }

    fn found<const P: usize>(
        problem: Residuals<P>,
        start: SVector<f64, P>,
    ) -> Minimum<SVector<f64, P>, 1, P> {
        let equations = problem.equations(&start).expect("regular");
        minimise(&problem, start, equations, &SETTINGS)
    }

    #[test]
    fn rosenbrocks_valley_ends_at_one() {
        let valley = Residuals(|x: &Vector2<f64>| {
            let r = Vector2::new(10.0 * (x[1] - x[0] * x[0]), 1.0 - x[0]);
            (r, SMatrix::from_row_slice(&[-20.0 * x[0], 10.0, -1.0, 0.0]))
        });
        let end = found(valley, Vector2::new(-1.2, 1.0));
        assert_eq!(end.status, CalibrationStatus::Converged);
        assert!((end.point - Vector2::repeat(1.0)).amax() < 1e-9, "{}", end.point);
    }

    /// From 3 undamped steps for the root of the arc tangent grow without end: −9.5, 124, ….
    #[test]
    fn steps_that_overshoot_are_damped() {
        let arc = Residuals(|x: &Vector1<f64>| {
            (x.map(f64::atan), SMatrix::<f64, 1, 1>::repeat(1.0 / (1.0 + x[0] * x[0])))
        });
        let end = found(arc, Vector1::new(3.0));
        assert_eq!(end.status, CalibrationStatus::Converged);
        assert!(end.point[0].abs() < 1e-9 && end.chi2 < 1e-18, "{} {}", end.point, end.chi2);
    }

    #[test]
    fn a_loop_that_cannot_step_stalls_and_one_without_steps_says_so() {
        struct Wall;
        impl LeastSquares<1, 1> for Wall {
            type Point = f64;
            fn chi2(&self, at: &f64) -> f64 {
                at * at
            }
            fn equations(&self, at: &f64) -> Option<Equations<1, 1>> {
                Some((Arrowhead::rigid(0, Vector1::new(1.0), Vector1::new(-at)), Vector1::new(1.0)))
            }
            fn moved(&self, _: &f64, _: &Arrowhead<1, 1>, _: &Vector1<f64>) -> Option<f64> {
                None
            }
        }
        let end = |settings: &LoopSettings<'_>| {
            minimise(&Wall, 1.0, Wall.equations(&1.0).expect("there"), settings)
        };
        assert_eq!(end(&SETTINGS).status, CalibrationStatus::Stalled);
        let short = end(&LoopSettings { most: 3, ..SETTINGS });
        assert_eq!((short.status, short.iterations), (CalibrationStatus::IterationLimit, 3));
    }
}
