"""Reference solutions for the tests, by scipy's Radau method at its tightest tolerance.

    python reference.py > reference.csv

One line per problem: name, end time, the states there. The right-hand sides repeat those of
tests/common/mod.rs. Where the literature has an end value (Hairer & Wanner, Solving ODEs II;
the test set for IVP solvers, archimede.uniba.it/~testset), this one agrees with it to all but
the last few digits.
"""

import numpy as np
from scipy.integrate import solve_ivp


def van_der_pol(mu):
    return lambda t, x: [x[1], mu * (1 - x[0] ** 2) * x[1] - x[0]]


def robertson(t, x):
    slow, fast, square = 0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] ** 2
    return [fast - slow, slow - fast - square, square]


def hires(t, y):
    return [
        -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007,
        1.71 * y[0] - 8.75 * y[1],
        -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4],
        8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3],
        -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6],
        -280 * y[5] * y[7] + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6],
        280 * y[5] * y[7] - 1.81 * y[6],
        -280 * y[5] * y[7] + 1.81 * y[6],
    ]


def friction(t, x):
    """Mass on a spring with dry friction tanh(125 v), driven by a force."""
    return [x[1], 20 * np.sin(5 * t) - 100 * x[0] - 5 * np.tanh(125 * x[1])]


PROBLEMS = [
    ("van der pol, mu 1", van_der_pol(1.0), 20.0, [2.0, 0.0]),
    ("van der pol, mu 1000", van_der_pol(1e3), 2000.0, [2.0, 0.0]),
    ("robertson", robertson, 4e5, [1.0, 0.0, 0.0]),
    ("hires", hires, 321.8122, [1.0, 0, 0, 0, 0, 0, 0, 0.0057]),
    ("friction", friction, 3.0, [0.0, 0.0]),
]

for name, rates, end, start in PROBLEMS:
    # The friction's slope changes within milliseconds: longer steps would miss it.
    longest = 1e-3 if name == "friction" else np.inf
    solution = solve_ivp(
        rates, (0.0, end), start, method="Radau", rtol=1e-12, atol=1e-15, max_step=longest
    )
    assert solution.success, name
    print(name.replace(",", ""), end, *(f"{x:.14e}" for x in solution.y[:, -1]), sep=",")
