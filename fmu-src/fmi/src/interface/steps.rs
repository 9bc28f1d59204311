//! Steps of a co-simulation.

use strut_model::{Error, Model};

use super::{
    instance::Instance,
    log::Failure,
    state::Version,
    types::{Real, Status},
};

/// Makes a step. One that cannot be integrated is discarded: everything is as before it.
#[inline(always)]
pub fn do_step<M: Model>(
    instance: &mut Instance<M>,
    version: &Version,
    point: Real,
    size: Real,
) -> Result<(), Failure> {
    check_end(instance, version, point, size)?;
    instance.simulation.step(point, size).map_err(|error| failed(instance, version, error))
}

/// Refuses a step past the stop time.
#[inline(always)]
pub fn check_end<M: Model>(
    instance: &Instance<M>,
    version: &Version,
    point: Real,
    size: Real,
) -> Result<(), Failure> {
    if point + size > instance.stop {
        check_stop(version, point, size, instance.stop)?;
    }
    Ok(())
}

/// Lets through a step that passes the stop time by rounding only.
#[cold]
fn check_stop(version: &Version, point: Real, size: Real, stop: Real) -> Result<(), Failure> {
    if size <= 0.0 || point + size <= stop + 1e-6 * size + 4.0 * f64::EPSILON * stop.abs() {
        return Ok(());
    }
    Err(Failure::error(format!(
        "a step of {size} s from {point} s goes past {stop} s, the stop time that {} was given: \
         make a shorter one, or give no stop time",
        version.set_up
    )))
}

#[cold]
fn failed<M: Model>(instance: &Instance<M>, version: &Version, error: Error) -> Failure {
    let Error::Integration(reason) = error else { return error.into() };
    let (time, remedy) = (instance.simulation.time(), version.after_discard);
    let message = format!("the step was not made, time is still {time} s: {reason}; {remedy}");
    Failure { status: Status::Discard, message }
}
