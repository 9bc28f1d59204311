"""OpenModelica's HelloWorldWithInput, as in `hello.py`. Hidden: a lag of the sensor."""

from common import main
from hello import *

HIDDEN = dict(lag=0.1)  # s

if __name__ == "__main__":
    main(__name__)
