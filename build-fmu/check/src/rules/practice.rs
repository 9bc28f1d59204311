//! What no standard demands, and users are hit by.

use super::{Rule, Table, rules};

rules! { "";
checked {
    MARK "description.encoding.mark" "" "There is no mark of the byte order, at which some readers of XML stop."
    XML_VERSION "description.encoding.version" "" "The description is XML 1.0: few readers know 1.1."
    OUTSIDE "archive.path.outside" "" "No path leads out of the archive."
    ENTRY_TWICE "archive.twice" "" "No file is in the archive twice, or beside another that differs only in upper and lower case."
    FILE_NAMES "archive.names" "" "Names of files are ASCII, or are flagged as UTF-8."
    EXPERIMENT "description.experiment" "" "The default experiment ends after its start, with a positive step and tolerance."
    ITEM_NAME "description.twice.item" "" "The names of an enumeration's items are unique."
    FACTOR "variables.unit.factor" "" "A factor of a unit is not zero."
    NAME_CASE "variables.name.case" "" "Names do not differ only in upper and lower case."
    NOMINAL "variables.nominal" "" "A nominal value is not zero: solvers divide by it."
    DERIVATIVE_UNIT "variables.derivative.unit" "" "A derivative has the unit of its variable, divided by that of time."
    DERIVATIVE_NAME "variables.derivative.name" "" "der(x) is the derivative of x, where there is an x."
    UNIT_MISSING "variables.unit.missing" "" "Inputs, outputs and parameters have a unit."
    DESCRIPTION "variables.description" "" "Inputs, outputs and parameters have a description."
    DERIVATIVES_MISSING "structure.derivatives.missing" "" "For model exchange, <Derivatives> lists every derivative that is declared."
    DEPENDENCIES "structure.dependencies" "" "Outputs declare their dependencies, so that no false algebraic loops appear."
    PLATFORM "binary.platform.missing" "" "There are libraries for Windows and Linux."
    BINARY_READ "binary.format" "" "A library's file can be read."
    BINARY_PLATFORM "binary.format.platform" "" "A library is one for the platform of its folder."
    GLIBC "binary.glibc" "" "A library loads with a glibc of 2012 (2.17)."
    LIBRARIES "binary.libraries" "" "A library needs no others than every machine has."
    LOAD "run.load" "" "The library can be loaded on this machine."
    FINITE "run.finite" "" "Outputs are finite numbers while the inputs are near their start values."
    REPEAT "run.repeat" "" "Two runs with the same inputs have the same results."
    FMPY "fmpy" "" "FMPy's validation finds nothing."
    CONNECTOR_TYPE "system.connector.type" "" "A connector's type is its variable's or signal's."
    CONNECTOR_UNIT "system.connector.unit" "" "A connector's unit is its variable's or signal's."
    CONNECTION_TYPE "system.type" "" "The ends of a connection have the same type, or a transformation."
    CONNECTION_UNIT "system.unit" "" "The ends of a connection have units of the same dimension, or a transformation."
    VALUE_BOUNDS "system.parameter.bounds" "" "A value lies within its variable's bounds."
    VALUE_UNIT "system.parameter.unit" "" "A value has its variable's unit."
    PARAMETER_THERE "system.parameter" "" "Values and mappings are for names that are there."
}
uncheckable {}
open {}
}
