"""MapleSim's CoupledClutches, as in `coupled_clutches.py`. Hidden: nothing."""

from common import main
from coupled_clutches import *

HIDDEN = {}

if __name__ == "__main__":
    main(__name__)
