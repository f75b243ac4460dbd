//! The certificate: how much better any admissible motion could be.

// Clarabel's semidefinite cone calls BLAS and LAPACK by their Fortran names: the linker finds them here
use lapack_over_nalgebra as _;

#[cfg(test)]
mod tests {
    use clarabel::algebra::CscMatrix;
    use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

    #[test]
    fn a_semidefinite_program_is_solved() {
        // the largest t with A − t I ⪰ 0 is the smallest eigenvalue of A; size 5 takes the general code path
        let size = 5;
        let (mut rows, mut values, mut b) = (Vec::new(), Vec::new(), Vec::new());
        for j in 0..size {
            for i in 0..=j {
                let scale = if i == j { 1.0 } else { std::f64::consts::SQRT_2 };
                if i == j {
                    rows.push(b.len());
                    values.push(1.0);
                }
                b.push(scale * (1.0 / (1.0 + (i + j) as f64)));
            }
        }
        let column = rows.len();
        let a = CscMatrix::new(b.len(), 1, vec![0, column], rows, values);
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let cones = [SupportedConeT::PSDTriangleConeT(size)];
        let mut solver =
            DefaultSolver::new(&CscMatrix::zeros((1, 1)), &[-1.0], &a, &b, &cones, settings).expect("valid");
        solver.solve();
        assert_eq!(solver.solution.status, SolverStatus::Solved);
        assert!((solver.solution.x[0] - 3.287_928_772_171_575e-6).abs() < 1e-8, "{}", solver.solution.x[0]);
    }
}
