//! Records as a table for other programs.

mod columns;
mod write;
