"""Which masters honour the factor of a connection, which SSP calls a LinearTransformation.

    python connected_gains.py FOLDER

What examples/third-party/README.md tells about it is this.
"""

import sys
import tempfile
import zipfile
from pathlib import Path

from connected import ecos, fmpy, libcosimpy

SYSTEM, STEP, COUNT = "quanser-lqr", 1e-3, 300
END = 'endElement="rig" endConnector="road.position"'
FACTOR, OFFSET = 3.0, 0.001
HONOURED = {fmpy: False, libcosimpy: True, ecos: True}


def change(source, target):
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            content = old.read(name)
            if name == "SystemStructure.ssd":
                text = content.decode()
                assert text.count(f"{END}/>") == 1, text
                gain = f'<ssc:LinearTransformation factor="{FACTOR}" offset="{OFFSET}"/>'
                content = text.replace(f"{END}/>", f"{END}>{gain}</ssd:Connection>").encode()
            new.writestr(name, content)


def main():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{SYSTEM}.ssp"
        change(Path(sys.argv[1]) / f"{SYSTEM}.ssp", path)
        for master, honoured in HONOURED.items():
            result = master(path, STEP, COUNT, ["road.position", "rig.road.position"])
            given, taken = (result[name][-1] for name in ("road.position", "rig.road.position"))
            assert given == 0.01, given
            expected = FACTOR * given + OFFSET if honoured else given
            assert abs(taken - expected) < 1e-15, (master.__name__, taken, expected)
            print(f"{master.__name__}: {given} becomes {taken:g}, the factor is {'' if honoured else 'not '}honoured")


if __name__ == "__main__":
    main()
