//! Which control points are free, which are equal, and which are given: the linear map between unknowns and control points.
//!
//! `c = E x + c₀`. Control points that are tied share an unknown, so the motion rests there. Control points of a given home posture have none. Unknowns are in
//! units of a joint's own size, so that radians and metres are of one order for the search.

use nalgebra::DMatrix;

/// The map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ties {
    /// The unknown of each control point; `None` where it is given.
    unknown: Vec<Option<usize>>,
    unknowns: usize,
    /// The posture of control points that are given.
    home: Option<Vec<f64>>,
    /// Size of each joint's unknowns, rad or m.
    sizes: Vec<f64>,
}

/// Control points that are equal where the motion begins or ends at rest.
pub(crate) const REST: usize = 3;

impl Ties {
    /// A motion from rest to rest. `dwells` are further runs of equal control points (first, number), in order, which may reach into the ends.
    pub(crate) fn new(
        controls: usize,
        home: Option<&[f64]>,
        sizes: &[f64],
        dwells: &[(usize, usize)],
    ) -> Self {
        let ends = [(0, REST), (controls - REST, REST)];
        let tied = |i: usize| {
            let runs = dwells.iter().chain(&ends);
            i > 0 && runs.into_iter().any(|&(first, number)| first < i && i < first + number)
        };
        let mut unknown: Vec<Option<usize>> = Vec::with_capacity(controls);
        let mut groups = 0;
        for i in 0..controls {
            groups += usize::from(!tied(i));
            unknown.push(Some(groups - 1));
        }
        let mut unknowns = groups;
        if home.is_some() {
            // the first and the last group are at home
            let last = groups - 1;
            unknown = unknown
                .into_iter()
                .map(|group| group.filter(|&group| group > 0 && group < last).map(|group| group - 1))
                .collect();
            unknowns = groups.saturating_sub(2);
        }
        Self { unknown, unknowns, home: home.map(<[f64]>::to_vec), sizes: sizes.to_vec() }
    }

    /// All control points are free.
    pub(crate) fn untied(controls: usize, joints: usize) -> Self {
        let unknown = (0..controls).map(Some).collect();
        Self { unknown, unknowns: controls, home: None, sizes: vec![1.0; joints] }
    }

    /// Number of joints.
    pub(crate) fn joints(&self) -> usize {
        self.sizes.len()
    }

    /// Number of all unknowns.
    pub(crate) fn len(&self) -> usize {
        self.unknowns * self.joints()
    }

    pub(crate) fn controls(&self) -> usize {
        self.unknown.len()
    }

    /// The unknown of a control point.
    pub(crate) fn of(&self, control: usize) -> Option<usize> {
        self.unknown[control]
    }

    /// Size of a joint's unknowns.
    pub(crate) fn size(&self, joint: usize) -> f64 {
        self.sizes[joint]
    }

    /// `c = E x + c₀`; `x` has the joints of each unknown side by side.
    pub(crate) fn controls_of(&self, x: &[f64]) -> DMatrix<f64> {
        let n = self.joints();
        DMatrix::from_fn(self.controls(), n, |i, j| match (self.unknown[i], &self.home) {
            (Some(k), _) => x[k * n + j] * self.sizes[j],
            (None, Some(home)) => home[j],
            (None, None) => 0.0,
        })
    }

    /// The unknowns of a motion that keeps the ties.
    pub(crate) fn unknowns_of(&self, controls: &DMatrix<f64>) -> Vec<f64> {
        let n = self.joints();
        let mut x = vec![0.0; self.len()];
        for (i, unknown) in self.unknown.iter().enumerate() {
            if let Some(k) = unknown {
                for j in 0..n {
                    x[k * n + j] = controls[(i, j)] / self.sizes[j];
                }
            }
        }
        x
    }

    /// `Eᵀ g`: the derivative by the unknowns from that by the control points.
    pub(crate) fn gradient(&self, by_controls: &DMatrix<f64>) -> Vec<f64> {
        let n = self.joints();
        let mut gradient = vec![0.0; self.len()];
        for (i, unknown) in self.unknown.iter().enumerate() {
            if let Some(k) = unknown {
                for j in 0..n {
                    gradient[k * n + j] += by_controls[(i, j)] * self.sizes[j];
                }
            }
        }
        gradient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_rest_and_dwells_hold() {
        let ties = Ties::new(12, None, &[1.0, 0.5], &[(5, 4)]);
        let x: Vec<f64> = (0..ties.len()).map(|k| k as f64).collect();
        let controls = ties.controls_of(&x);
        let first: Vec<f64> = controls.column(0).iter().copied().collect();
        assert_eq!(first, [0.0, 0.0, 0.0, 2.0, 4.0, 6.0, 6.0, 6.0, 6.0, 8.0, 8.0, 8.0]);
        assert_eq!(ties.unknowns_of(&controls), x);
        let home = Ties::new(8, Some(&[3.0]), &[1.0], &[]);
        assert_eq!(home.len(), 2);
        assert_eq!(home.controls_of(&[7.0, 8.0]).as_slice(), [3.0, 3.0, 3.0, 7.0, 8.0, 3.0, 3.0, 3.0]);
    }
}
