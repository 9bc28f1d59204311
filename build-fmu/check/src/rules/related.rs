//! FMI-LS-REF in its draft 1.0.0-beta.1, and the experiments that it refers to.

use super::{Rule, Table, rules};

rules! { "FMI-LS-REF 1.0.0-beta.1, ";
checked {
    HEAD "related.manifest" "2.1" "The manifest is XML in UTF-8, and names the layered standard with its version and description."
    SCHEMA "related.schema" "2.1" "The manifest has the elements, attributes and values of its schema."
    FILE "related.file" "2.2" "A related file is where its source says, in the archive."
    ROLE "related.role" "2.2" "A role is one of the table, with a sub-role that the table allows."
    PARAMETERS "related.parameters" "2.5.1" "A parameter set can be read, and gives values of variables that take them."
    EXPERIMENT "related.experiment" "2.5.2" "A file of experiments can be read, and has the elements and attributes of its schema."
    DATA "related.experiment.data" "2.5.2" "The files of an experiment are in the archive, can be read, and are of the FMU's variables."
    REPLAY "related.replay" "2.5.2" "An experiment runs from its start to its stop."
    AGREEMENT "related.replay.agreement" "2.5.2" "An experiment comes out with the errors that it states."
}
uncheckable {
    "2.2" "A role and a description say what a file is for." "what a file is for is no question of form"
    "2.2" "Absolute addresses lead to a file." "what another machine has changes, and is not asked"
    "2.2.1" "Labels categorise files." "any text is a label"
}
open {
    "2.5.2" "Experiments with tables in HDF5, or with values other than Reals, are run." "none has been seen yet; they are reported as skipped"
}
}
