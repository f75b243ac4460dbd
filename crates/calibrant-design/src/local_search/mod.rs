//! One start: sequential convex programming, with a program for each kind of motion and criterion.

mod chain_rounds;
mod criterion_hessian;
mod eigenvalue_program;
mod epigraph_program;
mod long_program;
mod model_bend;
mod part;
mod sequential_programming;
mod short_program;
mod stage_rows;

pub(crate) use chain_rounds::Rounds;
pub(crate) use criterion_hessian::SecondOrder;
pub(crate) use eigenvalue_program::EigenvalueProgram;
pub(crate) use epigraph_program::EpigraphProgram;
pub(crate) use long_program::LongProgram;
pub(crate) use model_bend::ModelBend;
pub(crate) use part::{Nodes, Part, PartGravity, mix};
pub(crate) use sequential_programming::{LocalOptimum, SHORT};
pub(crate) use short_program::ShortProgram;
pub(crate) use stage_rows::Peaks;
