"""Dymola's SpringFrictionPendulumExtForce1D, as in `friction_pendulum.py`. Hidden: a spring that hardens."""

from common import main
from friction_pendulum import *

HIDDEN = dict(cubic=6.0)  # N/m3

if __name__ == "__main__":
    main(__name__)
