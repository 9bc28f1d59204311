"""qFMU's GuidedMass, as in `guided_mass.py`. Hidden: a spring that hardens, k e + c e3, e = x - z."""

from common import main
from guided_mass import *

HIDDEN = dict(cubic=2e7)  # N/m3

if __name__ == "__main__":
    main(__name__)
