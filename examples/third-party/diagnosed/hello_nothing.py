"""OpenModelica's HelloWorldWithInput, as in `hello.py`. Hidden: nothing."""

from common import main
from hello import *

HIDDEN = {}

if __name__ == "__main__":
    main(__name__)
