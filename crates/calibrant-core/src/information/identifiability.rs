//! The covariance of parameters is the inverse of their information; identifiability says which combinations carry none.

use nalgebra::{DMatrix, DVector};

/// Parameters that are involved in combinations on which there is no information.
#[derive(Debug, Clone, PartialEq)]
pub struct Undetermined {
    /// Positions of the parameters involved, ascending.
    pub parameters: Vec<usize>,
    /// Number of independent combinations of them that the data leave free.
    pub free_combinations: usize,
}

/// Size of an eigenvalue that counts as zero, for each parameter: rounding of the reference, with a margin.
const RANK_TOLERANCE: f64 = 5e-15;
/// A smallest eigenvalue above this is certainly not zero.
const SAFE: f64 = 1e-9;
/// Share of a null direction above which a parameter counts as involved.
const INVOLVED: f64 = 1e-6;

/// Groups of parameters that the information `F` leaves undetermined; empty where `F` has full rank.
///
/// The null space of `F`, scaled by `reference`, is split into groups that share no parameter. With the
/// projector `Π` on it, parameter i is involved where `Π_ii > 0`. Parameters i and j belong together where
/// `Π_ij ≠ 0`.
///
/// # Shapes and units
/// `information`: p × p. `reference`: the diagonal of the information before anything was marginalised, in
/// the same units. It is the scale of the rounding errors, however little is left of it. `eliminated`: number
/// of nodes that were marginalised, 0 for none. Each rounds what is left once more.
///
/// # Examples
/// An axis that stands still at 2 m/s²: only one combination of bias and scale factor is determined.
/// ```
/// use calibrant_core::information::undetermined;
/// use nalgebra::DMatrix;
/// let f = DMatrix::from_row_slice(2, 2, &[10.0, 20.0, 20.0, 40.0]);
/// let groups = undetermined(&f, &f.diagonal(), 0);
/// assert_eq!(groups[0].parameters, [0, 1]);
/// assert_eq!(groups[0].free_combinations, 1);
/// ```
#[must_use]
pub fn undetermined(
    information: &DMatrix<f64>,
    reference: &DVector<f64>,
    eliminated: usize,
) -> Vec<Undetermined> {
    let size = reference.len();
    let scale = reference.map(|r| if r > 0.0 { 1.0 / r.sqrt() } else { 1.0 });
    let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
    // the common case at a fraction of the cost: the smallest eigenvalue is at least 1/trace of the inverse
    if let Some(cholesky) = scaled.clone().cholesky()
        && cholesky.inverse().trace() < 1.0 / SAFE
    {
        return Vec::new();
    }
    let eigen = scaled.symmetric_eigen();
    // the reference has the size 1: what is left of it may all be rounding
    let rounding = (RANK_TOLERANCE * size as f64).max(f64::EPSILON * eliminated as f64);
    let floor = rounding * eigen.eigenvalues.amax().max(1.0);
    let null: Vec<_> = (0..size)
        .filter(|&k| eigen.eigenvalues[k].partial_cmp(&floor) != Some(std::cmp::Ordering::Greater))
        .map(|k| eigen.eigenvectors.column(k).into_owned())
        .collect();
    if null.is_empty() {
        return Vec::new();
    }
    let null = DMatrix::from_columns(&null);
    let projector = &null * null.transpose();

    let mut groups = Vec::new();
    let mut placed = vec![false; size];
    for seed in 0..size {
        if placed[seed] || projector[(seed, seed)] <= INVOLVED {
            continue;
        }
        let mut members = vec![seed];
        placed[seed] = true;
        let mut next = 0;
        while next < members.len() {
            let member = members[next];
            next += 1;
            for other in 0..size {
                if !placed[other]
                    && projector[(other, other)] > INVOLVED
                    && projector[(member, other)].abs() > INVOLVED
                {
                    placed[other] = true;
                    members.push(other);
                }
            }
        }
        members.sort_unstable();
        let share: f64 = members.iter().map(|&i| projector[(i, i)]).sum();
        groups.push(Undetermined { parameters: members, free_combinations: share.round().max(1.0) as usize });
    }
    groups
}

/// Covariance `C = F⁻¹` of parameters with information `F`.
///
/// # Shapes and units
/// p × p; entry (i, j) of `F` in 1/(unit of θᵢ · unit of θⱼ), of `C` in unit of θᵢ · unit of θⱼ.
///
/// Returns `None` where `F` is not positive definite: then [`undetermined`](super::undetermined) names the
/// parameters at fault.
///
/// # Numerics
/// It takes the Cholesky factor of `F` scaled to unit diagonal, so that the units of the parameters do not
/// matter.
///
/// # Examples
/// ```
/// use calibrant_core::information::covariance;
/// use nalgebra::DMatrix;
/// let information = DMatrix::from_row_slice(2, 2, &[4.0, 2.0, 2.0, 2.0]);
/// let c = covariance(&information).unwrap();
/// assert!((c[(0, 0)] - 0.5).abs() < 1e-15 && (c[(0, 1)] + 0.5).abs() < 1e-15);
/// ```
#[must_use]
pub fn covariance(information: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let scale = information.diagonal().map(|diagonal| 1.0 / diagonal.sqrt());
    if !scale.iter().all(|s| s.is_finite()) {
        return None;
    }
    let size = scale.len();
    let scaled = DMatrix::from_fn(size, size, |i, j| information[(i, j)] * scale[i] * scale[j]);
    let inverse = scaled.cholesky()?.inverse();
    Some(DMatrix::from_fn(size, size, |i, j| inverse[(i, j)] * scale[i] * scale[j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_rank_leaves_nothing_undetermined() {
        let f = DMatrix::from_row_slice(2, 2, &[1e20, 1e3, 1e3, 1e-10]);
        assert!(undetermined(&f, &f.diagonal(), 0).is_empty(), "units alone do not make a rank deficiency");
    }

    #[test]
    fn separate_groups_are_reported_separately() {
        let mut f = DMatrix::zeros(5, 5);
        f.view_mut((0, 0), (2, 2)).copy_from_slice(&[1.0, 3.0, 3.0, 9.0]);
        f[(2, 2)] = 4.0;
        f.view_mut((3, 3), (2, 2)).copy_from_slice(&[2.0, -2.0, -2.0, 2.0]);
        let groups = undetermined(&f, &f.diagonal(), 0);
        let members: Vec<_> = groups.iter().map(|group| group.parameters.clone()).collect();
        assert_eq!(members, [vec![0, 1], vec![3, 4]]);
    }

    /// Where all information was marginalised, what is left is rounding, and its largest eigenvalue no scale.
    #[test]
    fn rounding_is_measured_by_the_reference() {
        let f = DMatrix::from_row_slice(2, 2, &[1e-3, 2e-17, 2e-17, 4e-17]);
        let reference = DVector::from_vec(vec![1.0, 1.0]);
        assert_eq!(undetermined(&f, &reference, 0)[0].parameters, [1]);
        assert!(undetermined(&f, &f.diagonal(), 0).is_empty(), "by itself it would be of full rank");
        // more nodes round more
        let f = DMatrix::from_row_slice(2, 2, &[1e-3, 0.0, 0.0, 1e-13]);
        assert!(undetermined(&f, &reference, 20).is_empty());
        assert_eq!(undetermined(&f, &reference, 2000)[0].parameters, [1]);
    }

    #[test]
    fn a_parameter_without_any_information_stands_alone() {
        let f = DMatrix::from_diagonal(&DVector::from_vec(vec![1.0, 0.0]));
        assert_eq!(
            undetermined(&f, &f.diagonal(), 0),
            [Undetermined { parameters: vec![1], free_combinations: 1 }]
        );
    }
}
