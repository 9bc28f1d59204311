//! SSP 1.0, section by section.

use super::{Rule, Table, rules};

rules! { "SSP 1.0.1, ";
checked {
    SOURCE "system.source" "5.4" "A component's source is in the archive, and can be read."
    SOURCE_VERSION "system.version" "5.1" "The version of a description, set, mapping or dictionary is 1.0."
    ENDING "system.archive.ending" "3" "The file's name ends in .ssp."
    COMPRESSION "system.archive.compression" "3" "Files are deflated or stored."
    ENCRYPTION "system.archive.encryption" "3" "No file is encrypted."
    ZIP_VERSION "system.archive.version" "3" "No more than version 2.0 of the zip format is needed to extract a file."
    SEPARATOR "system.archive.path" "3" "Paths in the archive have forward slashes."
    NAMES_ENCODING "system.archive.names" "3" "Names beyond ASCII are encoded in UTF-8, with the flag set."
    PREFIX "system.archive.prefix" "3" "Beside descriptions there is nothing but resources/, extra/ and documentation/."
    DOCUMENTATION "system.archive.documentation" "3" "Documentation has an index.html."
    ID_TWICE "system.twice.id" "4.1" "The id of an entity is unique in its file."
    ENUMERATION_TWICE "system.twice.enumeration" "4.4.1" "The name of an enumeration is unique in its file."
    ENUMERATION_DECLARED "system.enumeration" "4.5.1.5" "An enumeration that is referred to is declared in the file."
    UNIT_TWICE "system.twice.unit" "4.4.2" "The name of a unit is unique in its file."
    UNIT_DECLARED "system.unit.declared" "4.5.1.1" "A unit that is referred to is declared in the file."
    TRANSFORMATION "system.transformation" "4.5.2" "A transformation is one for the type of the value."
    MAP_TWICE "system.transformation.twice" "4.5.2" "A mapping of values has one entry for each value."
    ENCODING "system.encoding" "5" "Descriptions, sets, mappings and dictionaries are XML 1.0, encoded in UTF-8."
    SCHEMA_ELEMENT "system.schema.element" "5" "An element is one that the schema knows at its place, in its namespace."
    SCHEMA_ORDER "system.schema.order" "5" "Elements stand in the order of the schema, as often as it allows."
    SCHEMA_MISSING "system.schema.missing" "5" "Elements that the schema wants are there; a list that is there is not empty."
    SCHEMA_ATTRIBUTE "system.schema.attribute" "5" "An attribute is one that the schema knows of its element."
    SCHEMA_REQUIRED "system.schema.required" "5" "Attributes that the schema requires are there."
    SCHEMA_VALUE "system.schema.value" "5" "An attribute's value is one of its type."
    SCHEMA_TEXT "system.schema.text" "5" "There is no text between elements."
    NAME_TWICE "system.name" "5.2" "The name of an element is unique in its system."
    CONNECTOR_TWICE "system.name.connector" "5.2.1" "The name of a connector is unique in its element."
    CONNECTOR_VARIABLE "system.connector" "5.2.1" "A connector has the name of a variable of the component, or of a signal of the dictionary."
    CONNECTOR_KIND "system.connector.kind" "5.2.1" "A connector's kind is its variable's causality."
    VALUES_READ "system.parameters" "5.2.3" "Values and mappings are where they are said to be, and can be read."
    VALUES_BOTH "system.parameters.both" "5.2.3" "Values are given in a file or in place: one of both."
    VALUE_TAKEN "system.parameter.taken" "5.2.3" "A value is for a variable that takes one: an input, or one that is initialised exactly or approximately."
    VALUE_TYPE "system.parameter.type" "5.2.3" "A value is of its variable's type."
    CONNECTION_END "system.connection" "5.3.2" "The ends of a connection are there."
    CONNECTION_KINDS "system.connection.kinds" "5.3.2.1" "A connection leads from what gives a value to what takes one, and no signal leads to a parameter."
    CONNECTION_TWICE "system.twice" "5.3.2.1" "An input is connected once."
    DICTIONARY "system.dictionary" "5.3.3" "A signal dictionary is where it is said to be, once, and can be read."
    DICTIONARY_TWICE "system.name.dictionary" "5.3.3" "The name of a signal dictionary is unique in its system."
    GEOMETRY "system.geometry" "5.3.4" "A system's canvas has its lower left corner first."
    IMPLEMENTATION "system.implementation" "5.4" "A component's FMU has the interface that it is to be used by."
    REFERENCE "system.dictionary.reference" "5.5" "A reference names a signal dictionary of the systems around it."
    VALUE_TWICE "system.parameter.twice" "6.2" "A set has one value for each name."
    TARGET_TWICE "system.parameter.mapped" "7.1" "A mapping maps one parameter to a name."
    SIGNAL_TWICE "system.name.signal" "8.1.1" "The name of a signal is unique in its dictionary."
}
uncheckable {
    "2.1.3" "A namespace is a domain of who defines the extension." "domains are registered elsewhere"
    "2.2" "Only layered standards of the project use org.modelica and org.ssp-standard." "who has written a file does not stand in it"
    "5.2.1.1" "Geometry is drawn as defined." "the importer draws it"
    "5.3.2" "The linear transformation is applied after units are converted." "it is the importer that transforms"
}
open {
    "4.5.1.6" "A MIME type is a valid one." "no file with Binary connectors has been seen yet"
    "4.5.2.3" "Mapped values of an enumeration are values of its items." "it takes both ends' enumerations, which FMUs declare in ways of their own"
    "5.4" "Components that are systems themselves (SSD, SSP) are checked." "none of the tools that this project runs with takes them"
}
}
