"""How a master can take coupled FMUs over a step. A method is called with the system, the time and the step's size.

`y` are the outputs at the step's start, one number a connection; a path holds the inputs' derivatives, see `coupled`.
"""

import numpy as np
from coupled import Part
from scipy.linalg import expm

# When an iteration ends: the change of all inputs, by their scales; and when it is given up.
TOLERANCE, ITERATIONS = 1e-5, 50


class NotConverged(Exception):
    """An iteration has come to no end."""


def constant(system, time, size):
    """Jacobi: inputs are held at what the outputs are."""
    system.steer(time, system.gather(Part.read)[None])
    system.advance(time, size)


def extrapolated(system, time, size):
    """Inputs go on with the slopes that the outputs have."""
    y, slope = start(system, time)
    system.steer(time, np.stack([y, slope]))
    system.advance(time, size)


def start(system, time):
    """Outputs and their slopes, which depend on the inputs: these come first."""
    y = system.gather(Part.read)
    system.steer(time, y[None])
    return y, system.gather(Part.slopes)


class GaussSeidel:
    """One after the other: who comes later has the values from the end of the step of those before."""

    def __init__(self, *order):
        self.order = order

    def __call__(self, system, time, size):
        y = system.gather(Part.read)
        for name in self.order:
            part = system.parts[name]
            part.steer(time, y[None])
            part.advance(time, size)
            y[part.made] = part.read()


def parabola(y, end, slope, size):
    """The paths from `y` to `end`, arriving there with `slope`."""
    curvature = 2.0 * (y - end + size * slope) / size**2
    return np.stack([y, slope - size * curvature, curvature])


class FixedPoint:
    """Steps are repeated from their start until the inputs end where the outputs do, in value and slope.

    Components go one after the other, so what is iterated are only the connections that lead back, to components
    that come earlier. `relaxation` makes of all guesses and what came of them the next guess.
    """

    def __init__(self, relaxation, *order):
        self.order, self.relaxation = order, relaxation

    def back(self, system):
        place = {name: index for index, name in enumerate(self.order)}
        made = {j: place[name] for name in self.order for j in system.parts[name].made}
        taken = {j: place[name] for name in self.order for j in system.parts[name].taken}
        return [j for j in made if made[j] >= taken[j]]

    def __call__(self, system, time, size):
        (y, slope), back = start(system, time), self.back(system)
        end = y + size * slope
        system.each(Part.save)
        # In multiples of the scales: the values at the step's end, and their slopes.
        scale = np.concatenate([system.scales[back], system.scales[back] / size])
        guess, guesses, answers = np.concatenate([end[back], slope[back]]) / scale, [], []
        for _ in range(ITERATIONS):
            end[back], slope[back] = np.split(guess * scale, 2)
            for name in self.order:
                part = system.parts[name]
                part.steer(time, parabola(y, end, slope, size))
                part.advance(time, size, final=False)
                end[part.made], slope[part.made] = part.read(), part.slopes()
            guesses.append(guess)
            answers.append(np.concatenate([end[back], slope[back]]) / scale)
            if np.abs(answers[-1] - guess).max() < TOLERANCE:
                return
            guess = self.relaxation(guesses, answers)
            system.each(Part.rewind)
        raise NotConverged(f"{ITERATIONS} iterations at {time:g} s; a shorter step needs fewer")


class Aitken:
    """Under-relaxation with a factor that follows from the last two residuals (Küttler and Wall 2008, eq. 44)."""

    def __init__(self, first=0.5):
        self.first = self.factor = first

    def __call__(self, guesses, answers):
        if len(guesses) == 1:
            self.factor = self.first
        else:
            last, present = answers[-2] - guesses[-2], answers[-1] - guesses[-1]
            change = present - last
            self.factor *= -(last @ change) / (change @ change)
        return guesses[-1] + self.factor * (answers[-1] - guesses[-1])


def anderson(guesses, answers, depth=5):
    """The mixture of the last answers whose residual is least (Anderson 1965; Walker and Ni 2011)."""
    guesses, answers = np.array(guesses[-depth - 1 :]), np.array(answers[-depth - 1 :])
    residuals = answers - guesses
    changes, of_answers = np.diff(residuals, axis=0), np.diff(answers, axis=0)
    weights = np.linalg.lstsq(changes.T, residuals[-1], rcond=None)[0]
    return answers[-1] - weights @ of_answers


class Newton:
    """The same equations for value and slope at the step's end, solved with interface Jacobians.

    The Jacobian, what the end of each component's step becomes if its inputs' paths change, is that of the linearised
    components: their equations propagated over the step by a matrix exponential. The first guess solves the linearised
    equations; steps are only repeated for what they leave (Sicklinger et al. 2014).
    """

    def __call__(self, system, time, size):
        y = system.gather(Part.read)
        system.steer(time, y[None])
        linear, width = system.linear(time), len(y)
        # Columns: inputs that are 1, s and s²/2 in turn; the rates; the stimulus.
        n = len(linear.rates)
        forces = np.column_stack([linear.b, linear.rates, linear.moved])
        chain = np.zeros((n + 3 * (width + 2),) * 2)
        chain[:n, :n], chain[:n, n : n + width + 2] = linear.a, forces
        chain[n : -width - 2, n + width + 2 :] = np.eye(2 * (width + 2))
        grown = expm(chain * size)[:n, n:].reshape(n, 3, width + 2)
        # By the paths' first and second derivative, and what comes without them.
        by_path = np.hstack([grown[:, 1, :width], grown[:, 2, :width]])
        free = grown[:, 0, width] + grown[:, 1, width + 1]
        line = np.hstack([size * np.eye(width), 0.5 * size**2 * np.eye(width)])
        incline = np.hstack([np.eye(width), size * np.eye(width)])
        end_by_path = linear.c @ by_path + linear.d @ line
        slope_by_path = linear.c @ (linear.a @ by_path + linear.b @ line) + linear.d @ incline
        jacobian = np.vstack([end_by_path - line, (slope_by_path - incline) * size])
        end = linear.c @ free + linear.seen * size
        slope = linear.c @ (linear.rates + linear.a @ free + linear.moved * size) + linear.seen
        moves = -np.linalg.solve(jacobian, np.concatenate([end, slope * size]))
        scale = np.tile(system.scales, 2)
        system.each(Part.save)
        for _ in range(ITERATIONS):
            system.steer(time, np.vstack([y, moves.reshape(2, width)]))
            system.advance(time, size, final=False)
            end, slope = system.gather(Part.read) - y, system.gather(Part.slopes)
            residual = np.concatenate([end - line @ moves, (slope - incline @ moves) * size])
            if np.abs(residual / scale).max() < TOLERANCE:
                return
            moves = moves - np.linalg.solve(jacobian, residual)
            system.each(Part.rewind)
        raise NotConverged(f"{ITERATIONS} iterations at {time:g} s; a shorter step needs fewer")


class Foreseen:
    """The connected linearised components are solved over the step, exactly; each input gets the polynomial that fits
    its course best. Every component takes one step, and nothing is repeated.
    """

    # Intervals of Simpson's rule for the fit's integrals.
    INTERVALS = 16

    def __init__(self, order):
        self.order = order

    def __call__(self, system, time, size):
        y = system.gather(Part.read)
        system.steer(time, y[None])
        linear, width = system.linear(time), len(y)
        # Inputs are the outputs: u = c x + d u + seen s.
        closed = np.linalg.solve(np.eye(width) - linear.d, np.column_stack([linear.c, linear.seen]))
        by_state, by_time = closed[:, :-1], closed[:, -1]
        n = len(linear.rates)
        # x, 1 and s.
        matrix = np.zeros((n + 2, n + 2))
        matrix[:n, :n] = linear.a + linear.b @ by_state
        matrix[:n, n], matrix[:n, n + 1] = linear.rates, linear.moved + linear.b @ by_time
        matrix[n + 1, n] = 1.0
        ahead = expm(matrix * (size / self.INTERVALS))
        state = np.eye(n + 2)[n]
        course = np.zeros((self.INTERVALS + 1, width))
        for index in range(1, self.INTERVALS + 1):
            state = ahead @ state
            course[index] = by_state @ state[:n] + by_time * state[n + 1]
        system.steer(time, self.fit(y, course, size))
        system.advance(time, size)

    def fit(self, y, course, size):
        """Least squares over the step, by Legendre's polynomials."""
        share = np.linspace(0.0, 1.0, self.INTERVALS + 1)
        weights = np.where(np.arange(self.INTERVALS + 1) % 2, 4.0, 2.0) / (3.0 * self.INTERVALS)
        weights[[0, -1]] /= 2.0
        mean = weights @ course
        tilt = 3.0 * (weights * (2.0 * share - 1.0)) @ course
        bend = 5.0 * (weights * (6.0 * share**2 - 6.0 * share + 1.0)) @ course
        if self.order == 0:
            return (y + mean)[None]
        if self.order == 1:
            return np.stack([y + mean - tilt, 2.0 * tilt / size])
        return np.stack([y + mean - tilt + bend, (2.0 * tilt - 6.0 * bend) / size, 12.0 * bend / size**2])
