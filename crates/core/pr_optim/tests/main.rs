//! The solver against other methods: one binary, one module for each.

mod block_against_faer;
mod damped_steps;
mod kept_between_solves;
mod marginals_against_dense;
mod promise;
mod properties;
mod session;
