"""qFMU's GuidedMass, as in `guided_mass.py`. Hidden, and in no list: a guide that is tight in the middle, b exp(-(x / s)2) v."""

from common import main
from guided_mass import *

HIDDEN = dict(tight=150.0, width=0.004)  # N.s/m, m

if __name__ == "__main__":
    main(__name__)
