//! One start: sequential convex programming, with a program for each kind of motion and criterion.

pub(crate) mod chain_rounds;
pub(crate) mod criterion_hessian;
pub(crate) mod eigenvalue_program;
pub(crate) mod epigraph_program;
pub(crate) mod linear_limits;
pub(crate) mod long_program;
pub(crate) mod model_bend;
pub(crate) mod part;
pub(crate) mod sequential_programming;
pub(crate) mod short_program;
pub(crate) mod stage_rows;
