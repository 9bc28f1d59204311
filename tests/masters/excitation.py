"""What drives the inputs in checks and benchmarks."""

import math
import zlib

# Amplitudes by unit, so that every effect of every model is at work.
AMPLITUDE = {
    "m": 0.004, "m/s": 0.12, "m/s2": 2.0, "rad": 0.05, "rad/s": 0.2, "rad/s2": 4.0, "N": 150.0, "N.m": 1.5, "Pa": 2e5, "V": 3.0, "A": 3.0,
    "1": 1.0, "Hz": 1.0,
}  # fmt: skip


def excitation(name, unit, time):
    """An input at a time: two sines of its own frequencies."""
    seed = zlib.crc32(name.encode())
    low, high = 0.7 + seed % 7 * 0.3, 4.1 + seed % 11 * 0.7
    # A signal adapter's signals may be anything.
    return AMPLITUDE[unit or "1"] * (math.sin(math.tau * low * time + seed % 5) + 0.4 * math.sin(math.tau * high * time))
