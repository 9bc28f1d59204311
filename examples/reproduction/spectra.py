"""A periodic excitation with many lines, and what a signal has of each."""

import math

import numpy as np

STEP = 1e-3
# One period in s: lines 0.1 Hz apart.
PERIOD = 10.0
LINES = np.arange(3, 251) / PERIOD


def multisine():
    """Times, values and their rates over one period; phases by Schroeder, so that no peak stands out."""
    time = np.arange(round(PERIOD / STEP)) * STEP
    angles = math.tau * np.outer(time, LINES) - math.pi * np.arange(len(LINES)) ** 2 / len(LINES)
    amplitude = 1e-3 / LINES
    return time, np.sin(angles) @ amplitude, np.cos(angles) @ (amplitude * math.tau * LINES)


def lines_of(values, time):
    return np.exp(-1j * math.tau * np.outer(LINES, time)) @ values
