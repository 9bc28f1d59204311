"""A system as its .ssp file has it, for the master of jacobi.py."""

import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path, PurePosixPath

from jacobi import System

NAMESPACES = {
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}
# The types of SSP's parameters, and what their text means.
KINDS = {
    "Real": float,
    "Integer": int,
    "Enumeration": int,
    "Boolean": lambda text: text == "true",
    "String": str,
}


def read(path):
    """Components, connections and parameters of a system, as `System` takes them."""
    with zipfile.ZipFile(path) as archive:
        root = ElementTree.fromstring(archive.read("SystemStructure.ssd"))
        components, parameters = {}, {}
        for component in root.iterfind(".//ssd:Component", NAMESPACES):
            name = component.get("name")
            components[name] = PurePosixPath(component.get("source")).stem
            for binding in component.iterfind(".//ssd:ParameterBinding", NAMESPACES):
                values = ElementTree.fromstring(archive.read(binding.get("source")))
                for parameter in values.iterfind(".//ssv:Parameter", NAMESPACES):
                    (value,) = parameter
                    kind = value.tag.rpartition("}")[2]
                    parameters[f"{name}.{parameter.get('name')}"] = KINDS[kind](value.get("value"))
    if root.find(".//ssd:Connection/ssc:LinearTransformation", NAMESPACES) is not None:
        raise ValueError(f"{path}: a connection transforms its signal; build the system with factors = \"component\"")
    connections = [
        (f"{c.get('startElement')}.{c.get('startConnector')}", f"{c.get('endElement')}.{c.get('endConnector')}")
        for c in root.iterfind(".//ssd:Connection", NAMESPACES)
    ]
    return components, connections, parameters


def open_system(folder, name, parameters=None, kind=System):
    """The system `name` of a folder, with the FMUs in it, with parameters other than its own."""
    path = Path(folder) / f"{name}.ssp"
    components, connections, given = read(path)
    with tempfile.TemporaryDirectory() as unpacked, zipfile.ZipFile(path) as archive:
        archive.extractall(unpacked)
        return kind(Path(unpacked) / "resources", components, connections, given | (parameters or {}))
