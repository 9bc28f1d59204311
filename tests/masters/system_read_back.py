"""A system's .ssp as FMPy and lxml read it, as JSON: title, components, connectors, connections, units, and the parameters
of the .ssv files. FMPy checks against the standard's XSD; lxml also tells what FMPy passes over.

    python system_read_back.py FILE.ssp
"""

import json
import sys
import zipfile

from fmpy.ssp.ssd import ns, read_ssd
from lxml import etree

BASES = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")


def by_fmpy(path):
    description = read_ssd(path, validate=True)
    system = description.system
    parameters = [
        (component.name, parameter.name, parameter.type, parameter.value, parameter.unit)
        for component in system.elements
        for binding in component.parameterBindings
        for values in binding.parameterValues
        for parameter in values.parameters
    ]
    ends = ("startElement", "startConnector", "endElement", "endConnector")
    return {
        "names": [description.name, system.name, system.description],
        "components": [(component.name, component.source) for component in system.elements],
        "connectors": [
            (component.name, connector.name, connector.kind)
            for component in system.elements
            for connector in component.connectors
        ],
        "connections": [[getattr(connection, end) for end in ends] for connection in system.connections],
        "parameters": parameters,
        "units": [
            (unit.name, {base: getattr(unit, base) for base in BASES if getattr(unit, base)}, unit.factor, unit.offset)
            for unit in description.units
        ],
    }


def by_lxml(path):
    with zipfile.ZipFile(path) as archive:
        root = etree.fromstring(archive.read("SystemStructure.ssd"))
        system = root.find("ssd:System", ns)
        components = system.findall("ssd:Elements/ssd:Component", ns)
        missing = [component.get("source") for component in components if component.get("source") not in archive.namelist()]
        assert not missing, missing
        parameters = []
        for component in components:
            for binding in component.findall("ssd:ParameterBindings/ssd:ParameterBinding", ns):
                values = etree.fromstring(archive.read(binding.get("source")))
                for parameter in values.findall("ssv:Parameters/ssv:Parameter", ns):
                    value = parameter[0]
                    kind = etree.QName(value).localname
                    told = (component.get("name"), parameter.get("name"), kind, value.get("value"), value.get("unit"))
                    parameters.append(told)
    connectors = [
        (component.get("name"), connector)
        for component in components
        for connector in component.findall("ssd:Connectors/ssd:Connector", ns)
    ]
    connections = system.findall("ssd:Connections/ssd:Connection", ns)
    ends = ("startElement", "startConnector", "endElement", "endConnector")
    units = []
    for unit in root.findall("ssd:Units/ssc:Unit", ns):
        base = unit.find("ssc:BaseUnit", ns)
        exponents = {name: int(base.get(name)) for name in BASES if base.get(name)}
        units.append((unit.get("name"), exponents, float(base.get("factor", 1)), float(base.get("offset", 0))))
    return {
        "names": [root.get("name"), system.get("name"), system.get("description")],
        "components": [(component.get("name"), component.get("source")) for component in components],
        "connectors": [(element, connector.get("name"), connector.get("kind")) for element, connector in connectors],
        "connections": [[connection.get(end) for end in ends] for connection in connections],
        "parameters": parameters,
        "units": units,
        "description": root.get("description"),
        "descriptions": [component.get("description") for component in components],
        "types": [(etree.QName(connector[0]).localname, connector[0].get("unit")) for _, connector in connectors],
        "ways": [
            [(etree.QName(way).localname, way.get("factor"), way.get("offset")) for way in connection]
            for connection in connections
        ],
    }


if __name__ == "__main__":
    print(json.dumps({"FMPy": by_fmpy(sys.argv[1]), "lxml": by_lxml(sys.argv[1])}))
