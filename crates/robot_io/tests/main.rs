//! What the readers and the grades say of files.

mod evo;
mod recorded;
