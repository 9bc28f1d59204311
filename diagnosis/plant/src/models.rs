//! The models that can be diagnosed: their equations with derivatives are compiled here and nowhere else.

use strut_physics::actuators::{ExcitationMotor, PumpHydraulicActuator};
use strut_physics::rigs::{ElementDyno, LinearDrive, QuarterCar, SasRig, ServoSuspension};

use crate::Plant;

macro_rules! plants {
    ($($name:ident: $model:ty;)*) => {$(
        #[doc = concat!("`", stringify!($model), "`.")]
        pub fn $name() -> Plant {
            Plant::of::<$model>()
        }
    )*};
}

plants! {
    quarter_car: QuarterCar;
    element_dyno: ElementDyno;
    linear_drive: LinearDrive;
    excitation_motor: ExcitationMotor;
    servo_suspension: ServoSuspension;
    pump_hydraulic_actuator: PumpHydraulicActuator;
    sas_rig: SasRig;
}
