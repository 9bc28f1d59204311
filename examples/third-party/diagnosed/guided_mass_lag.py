"""qFMU's GuidedMass, as in `guided_mass.py`. Hidden: a lag of the sensor of the position; the one of the acceleration is right."""

from common import main
from guided_mass import *

HIDDEN = dict(lag=0.006)  # s

if __name__ == "__main__":
    main(__name__)
