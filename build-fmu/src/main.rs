//! Packs the models of Strut as FMUs and its systems as SSPs.

use std::process::ExitCode;

use build_fmu::{Project, Source};

fn main() -> ExitCode {
    build_fmu::main(&Project {
        catalogue: strut_physics::CATALOGUE,
        parameter_sets: strut_physics::PARAMETER_SETS,
        systems: strut_physics::SYSTEMS,
        source: Source::Workspace { files: "fmu-src/physics/parameters/resources" },
        license: include_str!("../../LICENSE"),
    })
}
