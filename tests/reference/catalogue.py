"""The reference models by the names of the models that they are references of; all single-model cases."""

import cases
import cases_ajala
import cases_drive
import cases_dyno
import cases_effects
import cases_full_car
import cases_kogut
import cases_konieczny
import cases_of_time
import cases_pneumatic
import cases_sensors
import cases_sprung_mass
import cases_tum
from controllers import LqrController, ModalSkyhook, Skyhook
from eccentric import EccentricDrive, ExcitationSpeedController
from effects import QuarterCarWithEffects
from element_dyno import ElementDyno
from excitation import ExcitationMotor
from force_controllers import ForcePid, ForceTwoDof, ForceTwoDofLpv
from full_car import FullCar
from linear_drive import LinearDrive, RotaryDrive
from linear_motor import LinearMotor
from pneumatic import PneumaticCylinder
from pump import PumpHydraulicActuator, PumpHydraulicActuatorLinear
from quarter_car import QuarterCar
from roads import FourWheelRoad, Road
from sas import MrRotaryBrake, SasRig
from sensors import AngleSensorChain, SensorChain, SignalAdapter, VelocityEstimator
from servo import ServoHydraulicActuator, ServoSuspension, ServoSuspensionIdentified
from sources import FrequencySource, VoltageSource
from sprung_mass import SprungMass

MODELS = {model.__name__: model for model in (
    AngleSensorChain,
    EccentricDrive,
    ElementDyno,
    ExcitationMotor,
    ExcitationSpeedController,
    ForcePid,
    ForceTwoDof,
    ForceTwoDofLpv,
    FourWheelRoad,
    FrequencySource,
    FullCar,
    LinearDrive,
    LinearMotor,
    LqrController,
    ModalSkyhook,
    MrRotaryBrake,
    PneumaticCylinder,
    PumpHydraulicActuator,
    PumpHydraulicActuatorLinear,
    QuarterCar,
    QuarterCarWithEffects,
    Road,
    RotaryDrive,
    SasRig,
    SensorChain,
    ServoHydraulicActuator,
    ServoSuspension,
    ServoSuspensionIdentified,
    SignalAdapter,
    Skyhook,
    SprungMass,
    VelocityEstimator,
    VoltageSource,
)}

CASES = [case for module in (cases, cases_ajala, cases_drive, cases_dyno, cases_effects, cases_full_car, cases_kogut,
                             cases_konieczny, cases_of_time, cases_pneumatic, cases_sensors, cases_sprung_mass, cases_tum) for case in module.CASES]


def model_of(case):
    """The model of a single-model case, with its parameters and settings."""
    return MODELS[case.get("reference", case["fmu"])](case.get("parameters", {}) | case.get("changed", {}), case.get("settings", {}))
