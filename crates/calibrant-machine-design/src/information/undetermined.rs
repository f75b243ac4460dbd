//! What no motion of the machine determines.

use calibrant_core::error::{Error, NotIdentifiable, UndeterminedGroup};
use calibrant_core::sensor::ImuQuantity;
use nalgebra::DMatrix;

/// Information below this part of that of a well determined combination is rounding.
const RELATIVE: f64 = 1e-10;
/// Parameters with at least this part of an undetermined combination are named.
const SHARE: f64 = 0.1;

/// The parameters that a random motion leaves undetermined. Almost every motion determines whatever any motion does.
pub(crate) fn undetermined(information: &DMatrix<f64>, quantities: &[ImuQuantity]) -> Option<Error> {
    let p = information.nrows();
    let largest = information.diagonal().max();
    let (felt, mut places): (Vec<usize>, Vec<usize>) =
        (0..p).partition(|k| information[(*k, *k)] > f64::MIN_POSITIVE.max(1e-30 * largest));
    let mut free = places.len();
    if !felt.is_empty() {
        let scale: Vec<f64> = felt.iter().map(|k| information[(*k, *k)].sqrt()).collect();
        let scaled = DMatrix::from_fn(felt.len(), felt.len(), |i, j| {
            information[(felt[i], felt[j])] / (scale[i] * scale[j])
        });
        let eigen = scaled.symmetric_eigen();
        let without: Vec<usize> = (0..felt.len()).filter(|k| eigen.eigenvalues[*k] < RELATIVE).collect();
        let weight = |row: usize| without.iter().map(|k| eigen.eigenvectors[(row, *k)].powi(2)).sum::<f64>();
        places.extend((0..felt.len()).filter(|row| weight(*row) > SHARE * SHARE).map(|row| felt[row]));
        free += without.len();
    }
    if free == 0 {
        return None;
    }
    places.sort_unstable();
    Some(Error::NotIdentifiable(Box::new(NotIdentifiable {
        groups: vec![UndeterminedGroup {
            parameters: places.iter().map(|place| quantities[*place].name()).collect(),
            free_combinations: free,
            reason: "no motion of this machine changes what they add to a reading".into(),
            remedy:
                "leave them out of the parameters, state what is known of them, or mount the sensor otherwise"
                    .into(),
        }],
    })))
}
