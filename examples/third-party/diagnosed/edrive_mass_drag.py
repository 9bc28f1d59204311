"""Dymola's edrive_mass, as in `edrive_mass.py`. Hidden: the drag of a fan."""

from common import main
from edrive_mass import *

HIDDEN = dict(drag=1e-4)  # N.m.s2/rad2

if __name__ == "__main__":
    main(__name__)
