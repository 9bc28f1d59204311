"""The texts of a modelDescription.xml as FMPy and lxml read them, a line each: description, licence, each variable's name
and description, start values of strings. FMPy checks against the standard's XSD.

    python description_read_back.py FOLDER
"""

import sys
from pathlib import Path

from fmpy import read_model_description
from lxml import etree

folder = Path(sys.argv[1])
description = read_model_description(str(folder), validate=True)
texts = [description.description, description.license]
texts += [text for variable in description.modelVariables for text in (variable.name, variable.description)]
texts += [variable.start for variable in description.modelVariables if variable.type == "String"]
for text in texts:
    print(f"FMPy: {text}")

root = etree.parse(folder / "modelDescription.xml").getroot()
texts = [root.get("description"), root.get("license")]
texts += [text for node in root.iter("ScalarVariable") for text in (node.get("name"), node.get("description"))]
texts += [node.get("start") for node in root.iter("String")]
for text in texts:
    print(f"lxml: {text}")
