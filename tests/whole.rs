//! The tests of the whole, in one program: what takes long on one core runs beside the others, and the FMUs are packed
//! once. `cargo test --test whole masters` runs those of one file.

mod batches;
mod check;
mod check_mutations;
mod check_systems;
mod check_values;
mod diagnosis;
mod examples;
mod fmus;
mod masters;
#[path = "check/mutations/mod.rs"]
mod mutations;
mod packages;
mod platforms;
mod prebuilt;
#[path = "check/ssp.rs"]
mod ssp;
#[path = "check/subject.rs"]
mod subject;
mod systems;
#[path = "check/tables.rs"]
mod tables;
mod third_party;
