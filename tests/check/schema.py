"""Validates descriptions by the standards' own schemas, which come with FMPy: the files of a folder, by their endings."""

import json
import sys
from pathlib import Path

import fmpy
from lxml import etree

HOME = Path(fmpy.__file__).parent
SCHEMAS = {
    ".xml": HOME / "schema" / "fmi2" / "fmi2ModelDescription.xsd",
    ".ssd": HOME / "ssp" / "schema" / "SystemStructureDescription.xsd",
    ".ssv": HOME / "ssp" / "schema" / "SystemStructureParameterValues.xsd",
}

schemas = {ending: etree.XMLSchema(etree.parse(str(path))) for ending, path in SCHEMAS.items()}
valid = {path.name: schemas[path.suffix].validate(etree.parse(str(path))) for path in Path(sys.argv[1]).iterdir()}
json.dump(valid, sys.stdout)
