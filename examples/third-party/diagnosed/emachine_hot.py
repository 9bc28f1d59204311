"""Dymola's emachine_model, as in `emachine.py`. Hidden, and in no list: a resistance that grows with the current."""

from common import main
from emachine import *

HIDDEN = dict(cubic=0.02)  # V/A3

if __name__ == "__main__":
    main(__name__)
