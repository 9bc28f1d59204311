"""`python -m strut` is the command `strut`."""

from strut._command import strut

strut()
