"""qFMU's GuidedMass, as in `guided_mass.py`. Hidden: nothing."""

from common import main
from guided_mass import *

HIDDEN = {}

if __name__ == "__main__":
    main(__name__)
