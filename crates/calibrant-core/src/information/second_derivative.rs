//! The second derivative of the information with respect to the motion, for short motions.
//!
//! Once the motion is marginalised, the readings at the nodes have the weight
//!
//! `U = (M⁻¹ + T diag(q) Tᵀ)⁻¹`, `F = Gᵀ U G`
//!
//! `M` is the weight of the samples, block tridiagonal in the nodes. `T` adds up the increments of the motion
//! and takes the sum through the sensor's matrix: row (j, r), column (i, d) is `S_rd` for `i < j`. `q` are the
//! variances of the increments. `G` is linear in the nodes. With the costate `H = Tᵀ U G` and `K = Tᵀ U T`,
//!
//! - `dF = dGᵀ U G + Gᵀ U dG − Hᵀ dq H`
//! - `d²F = 2 dGᵀ U dG − 2 (dGᵀ U T dq H + Hᵀ dq Tᵀ U dG) + 2 Hᵀ dq K dq H − Hᵀ d²q H`
//!
//! The derivative of `G` touches one node, that of `q` one increment. So each entry of the second derivative
//! of `⟨Ω, F⟩` is a sum of a few products.
//!
//! `U` follows from the pivot `I + diag(√q) Γ diag(√q)`, `Γ = Tᵀ M T`. Nothing is divided by a vanishing `q`.
//! Where the end is known as well, a reading of the last node's acceleration with a large weight stands for
//! it. The differences lose digits where the increments are much noisier than the readings, and it does no
//! harm: the second derivative tells the solver how far to go, not where the optimum is.
//!
//! The second derivative leaves out how the clock's part changes. The first derivative has all of it.
//!
//! # Cost
//! `O((N D)³)` for `U`, and `O((N D)² D)` for each `Ω`: meant for motions of up to some hundred unknowns.

use super::motion_information::{Linearised, PartInformation};
use crate::motion::{KnownEnds, Trust};
use nalgebra::{DMatrix, SMatrix, SVector};

/// Weight of the reading that stands for a known end, relative to what the increments tell of it.
const KNOWN_END: f64 = 1e8;

/// First and second derivatives of the information at a motion.
#[derive(Debug, Clone)]
pub struct InformationCurvature<const D: usize, const P: usize> {
    /// `∂F/∂a` for coordinate k of node i, at `i D + k`.
    pub first: Vec<SMatrix<f64, P, P>>,
    /// `U`.
    weight: DMatrix<f64>,
    noise: Option<Noise<P>>,
}

/// What the noise of the increments adds.
#[derive(Debug, Clone)]
struct Noise<const P: usize> {
    /// `Tᵀ U`.
    force: DMatrix<f64>,
    /// `K`.
    stiffness: DMatrix<f64>,
    /// `H`, by increment and coordinate: the costate with the other sign.
    costate: Vec<SVector<f64, P>>,
    /// `dq` per change of the increment.
    slope: Vec<f64>,
    /// `d²q` per square of it, halved.
    bend: f64,
}

impl<const D: usize, const P: usize> PartInformation<D, P> {
    /// The derivatives of the information at a motion. `signs` tell on which side each increment lies where
    /// its noise has a kink. `None` where trust is `unknown`, or a pivot fails.
    #[must_use]
    pub fn curvature(
        &self,
        a: &[SVector<f64, D>],
        at: &Linearised<D, P>,
        signs: &[SVector<f64, D>],
    ) -> Option<InformationCurvature<D, P>> {
        let nodes = a.len();
        let mut weight = self.sample_weight();
        let noise: Option<Noise<P>> = match self.trust {
            Trust::Unknown => return None,
            Trust::Known => None,
            Trust::Noisy(noise) => {
                let size = (nodes - 1) * D;
                let sd = |place: usize| {
                    let (i, d) = (place / D, place % D);
                    let step = (a[i + 1][d] - a[i][d]) * signs[i][d];
                    noise.floor_mps3 * self.interval_s(i) + noise.ratio * step.max(0.0)
                };
                let (samples_on_increments, mut gamma) = self.increment_weight();
                if self.known_ends == KnownEnds::Both {
                    for d in 0..D {
                        let own = || (d..size).step_by(D);
                        let total: f64 = own().map(|place| sd(place).powi(2)).sum();
                        for (i, j) in own().flat_map(|i| own().map(move |j| (i, j))) {
                            gamma[(i, j)] += KNOWN_END / total;
                        }
                    }
                }
                let pivot = DMatrix::from_fn(size, size, |i, j| {
                    f64::from(u8::from(i == j)) + sd(i) * gamma[(i, j)] * sd(j)
                });
                let factor = pivot.cholesky()?.unpack();
                let taken = |of: &DMatrix<f64>| {
                    let mut scaled = of.clone();
                    scaled.row_iter_mut().enumerate().for_each(|(i, mut row)| row *= sd(i));
                    factor.solve_lower_triangular(&scaled)
                };
                let (on_samples, on_increments) =
                    (taken(&samples_on_increments.transpose())?, taken(&gamma)?);
                weight -= on_samples.transpose() * &on_samples;
                Some(Noise {
                    force: samples_on_increments.transpose() - on_increments.transpose() * &on_samples,
                    stiffness: gamma - on_increments.transpose() * &on_increments,
                    costate: (0..size).map(|i| -at.costate[i / D].row(i % D).transpose()).collect(),
                    slope: (0..size).map(|i| 2.0 * sd(i) * noise.ratio * signs[i / D][i % D]).collect(),
                    bend: noise.ratio * noise.ratio,
                })
            }
        };
        let first = self.first_derivatives(a, at, signs);
        Some(InformationCurvature { first, weight, noise })
    }

    /// `∂F/∂a` for coordinate k of node i, at `i D + k`, on the sides of the kinks of the noise that `signs` tell.
    #[must_use]
    pub fn first_derivatives(
        &self,
        a: &[SVector<f64, D>],
        at: &Linearised<D, P>,
        signs: &[SVector<f64, D>],
    ) -> Vec<SMatrix<f64, P, P>> {
        let mut felt = vec![SMatrix::<f64, D, P>::zeros(); a.len()];
        for (i, m) in self.sums.iter().enumerate() {
            let [one, other] = at.ends(i);
            felt[i] += one * m.m00 + other * m.m01;
            felt[i + 1] += one * m.m01 + other * m.m11;
        }
        let mut first = vec![SMatrix::<f64, P, P>::zeros(); a.len() * D];
        for (place, derivative) in first.iter_mut().enumerate() {
            for reading in 0..D {
                let row = reading * (D + 1) + 1 + place % D;
                for p in 0..P {
                    let part = self.weight[reading] * felt[place / D][(reading, p)];
                    derivative[(row, p)] += part;
                    derivative[(p, row)] += part;
                }
            }
        }
        if let Some(clock) = &at.clock {
            let sw = self.s.tr_mul(&SMatrix::<f64, D, D>::from_diagonal(&self.weight));
            for (i, m) in self.sums.iter().enumerate() {
                let felt = at.ends(i).map(|r| sw * r);
                for d in 0..D {
                    let rows = [felt[0].row(d).into_owned(), felt[1].row(d).into_owned()];
                    let form = clock.form(i, rows, [m.m00, m.m01, m.m11]) / self.interval_s(i);
                    let both = form + form.transpose();
                    first[i * D + d] += both;
                    first[(i + 1) * D + d] -= both;
                }
            }
        }
        if let Some((floor, ratio)) = self.input_noise() {
            for (i, (costate, sign)) in at.costate.iter().zip(signs).enumerate() {
                for d in 0..D {
                    let step = ((a[i + 1][d] - a[i][d]) * sign[d]).max(0.0);
                    let slope = 2.0 * (floor * self.interval_s(i) + ratio * step) * ratio * sign[d];
                    let force = costate.row(d);
                    let part = force.tr_mul(&force) * slope;
                    first[i * D + d] += part;
                    first[(i + 1) * D + d] -= part;
                }
            }
        }
        first
    }

    /// `M`.
    fn sample_weight(&self) -> DMatrix<f64> {
        let size = (self.intervals() + 1) * D;
        let mut weight = DMatrix::zeros(size, size);
        for (i, m) in self.sums.iter().enumerate() {
            for r in 0..D {
                let (one, two) = (i * D + r, (i + 1) * D + r);
                weight[(one, one)] += self.weight[r] * m.m00;
                weight[(two, two)] += self.weight[r] * m.m11;
                weight[(one, two)] += self.weight[r] * m.m01;
                weight[(two, one)] += self.weight[r] * m.m01;
            }
        }
        weight
    }

    /// `M T` and `Γ = Tᵀ M T`.
    fn increment_weight(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let n = self.intervals();
        // with the scalar weights m of the nodes: Σ over nodes after i of m_jj'
        let mut after = DMatrix::<f64>::zeros(n + 1, n);
        for (k, m) in self.sums.iter().enumerate() {
            for i in 0..=k {
                let first = if i < k { 1.0 } else { 0.0 };
                after[(k, i)] += first * m.m00 + m.m01;
                after[(k + 1, i)] += first * m.m01 + m.m11;
            }
        }
        let mut both = DMatrix::<f64>::zeros(n, n);
        for column in 0..n {
            let mut sum = 0.0;
            for row in (0..n).rev() {
                sum += after[(row + 1, column)];
                both[(row, column)] = sum;
            }
        }
        let ws = SMatrix::<f64, D, D>::from_diagonal(&self.weight) * self.s;
        let sws = self.s.tr_mul(&ws);
        (
            DMatrix::from_fn((n + 1) * D, n * D, |i, j| ws[(i % D, j % D)] * after[(i / D, j / D)]),
            DMatrix::from_fn(n * D, n * D, |i, j| sws[(i % D, j % D)] * both[(i / D, j / D)]),
        )
    }
}

impl<const D: usize, const P: usize> InformationCurvature<D, P> {
    /// Second derivative of `⟨Ω, F⟩` with respect to the nodes, `Ω` symmetric.
    #[must_use]
    pub fn second(&self, omega: &SMatrix<f64, P, P>) -> DMatrix<f64> {
        let size = self.first.len();
        let place = |reading: usize, coordinate: usize| reading * (D + 1) + 1 + coordinate;
        let mut hessian = DMatrix::from_fn(size, size, |j, k| {
            let mut sum = 0.0;
            for one in 0..D {
                for other in 0..D {
                    sum += self.weight[(j / D * D + one, k / D * D + other)]
                        * omega[(place(one, j % D), place(other, k % D))];
                }
            }
            2.0 * sum
        });
        let Some(noise) = &self.noise else { return hessian };
        let pulled: Vec<SVector<f64, P>> = noise.costate.iter().map(|h| omega * h).collect();
        for (i, pulled_i) in pulled.iter().enumerate() {
            for node in 0..size {
                let force: f64 =
                    (0..D).map(|r| noise.force[(i, node / D * D + r)] * pulled_i[place(r, node % D)]).sum();
                let part = 2.0 * force * noise.slope[i];
                for (increment, sign) in [(i, 1.0), (i + D, -1.0)] {
                    hessian[(node, increment)] += sign * part;
                    hessian[(increment, node)] += sign * part;
                }
            }
            for (j, h) in noise.costate.iter().enumerate() {
                let product = h.dot(pulled_i);
                let mut part = 2.0 * product * noise.stiffness[(i, j)] * noise.slope[i] * noise.slope[j];
                if i == j {
                    part -= 2.0 * noise.bend * product;
                }
                hessian[(i, j)] += part;
                hessian[(i + D, j + D)] += part;
                hessian[(i + D, j)] -= part;
                hessian[(i, j + D)] -= part;
            }
        }
        hessian
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::information::MotionInformation;
    use crate::motion::{InputNoise, JerkControlledMotion};
    use crate::sensor::{Sensor, SensorModel, SensorParameters};
    use nalgebra::{Matrix3, Vector3};

    fn motion() -> JerkControlledMotion {
        let node = |i: usize| {
            Vector3::new(1.3 * i as f64, 2.1 * i as f64 + 1.0, 0.7 * i as f64 + 2.0).map(f64::sin) * 3.0
        };
        JerkControlledMotion::uniform(0.7, (0..6).map(node).collect()).expect("valid")
    }

    /// Differences of the first derivatives, which the arrowhead gives.
    fn check<const D: usize, const P: usize>(part: &PartInformation<D, P>) {
        let a = part.nodes(&motion());
        let signs: Vec<_> = a.windows(2).map(|pair| (pair[1] - pair[0]).map(f64::signum)).collect();
        let root = SMatrix::<f64, P, P>::from_fn(|i, j| ((i * P + 2 * j) as f64).cos());
        let omega = root * root.transpose();
        let at = part.linearise(&a).expect("determined");
        let curvature = part.curvature(&a, &at, &signs).expect("regular");
        let gradient = |a: &[SVector<f64, D>]| {
            let at = part.linearise(a).expect("determined");
            part.total(a, &part.derivative(&at, &omega))
        };
        let exact = gradient(&a);
        let second = curvature.second(&omega);
        let largest = second.amax();
        for place in 0..a.len() * D {
            let slope = curvature.first[place].dot(&omega);
            let expected = exact[place / D][place % D];
            assert!((slope / expected - 1.0).abs() < 1e-6, "{place}: {slope} {expected}");
            let moved = |by: f64| {
                let mut moved = a.clone();
                moved[place / D][place % D] += by;
                gradient(&moved)
            };
            let step = 4e-3;
            let near = [moved(step), moved(-step), moved(2.0 * step), moved(-2.0 * step)];
            for other in 0..a.len() * D {
                let [p, m, pp, mm] = near.each_ref().map(|gradient| gradient[other / D][other % D]);
                let difference = (8.0 * (p - m) - (pp - mm)) / (12.0 * step);
                let own = second[(place, other)];
                assert!((own - difference).abs() < 1e-5 * largest, "{place} {other}: {own} {difference}");
            }
        }
    }

    #[test]
    fn the_second_derivative_is_that_of_differences() {
        let noise = InputNoise { floor_mps3: 0.01, ratio: 0.02 };
        let matrix = Matrix3::new(1.1, 0.1, -0.05, 0.02, 0.9, 0.03, 0.04, -0.02, 1.05);
        let at = SensorParameters::linear(Vector3::new(0.1, 0.2, 0.3), matrix);
        for (trust, ends) in [
            (Trust::Known, KnownEnds::Start),
            (Trust::Noisy(noise), KnownEnds::Start),
            (Trust::Noisy(noise), KnownEnds::Both),
        ] {
            let noise_mps2 = Some(Vector3::repeat(0.01));
            let full = Sensor { model: SensorModel::Full, noise_mps2, ..Sensor::memsic_mxd2020u() };
            let setting = MotionInformation::new(&full, at, trust, ends, 10.0).expect("complete");
            check(&setting.full(&motion()));
            check(&setting.single(1, &motion()));
        }
    }

    #[test]
    fn an_unknown_motion_has_none() {
        let sensor = Sensor::memsic_mxd2020u();
        let setting = MotionInformation::new(
            &sensor,
            SensorParameters::identity(),
            Trust::Unknown,
            KnownEnds::Both,
            10.0,
        )
        .expect("complete");
        let part = setting.single(0, &motion());
        let a = part.nodes(&motion());
        let at = part.linearise(&a).expect("determined");
        assert!(part.curvature(&a, &at, &[]).is_none());
    }
}
