"""A law with many kinks, written once: with its branches taken as they come it tells the guards, with a mode it is
smooth within the mode."""

from integrate import Switched


class Pieces:
    def __init__(self, mode=None):
        self.sides, self.guards = None if mode is None else iter(mode), []

    def positive(self, guard):
        self.guards.append(guard)
        return guard > 0.0 if self.sides is None else next(self.sides)

    def clamp(self, value, low, high):
        above, below = self.positive(value - high), self.positive(low - value)
        return high if above else low if below else value


class Pieced(Switched):
    """A model with `law(state, u, pieces)`, which returns rates and outputs and takes every branch by `pieces`,
    always all of them."""

    def guards(self, state, u):
        pieces = Pieces()
        self.law(state, u, pieces)
        return pieces.guards

    def derivative(self, state, u, mode):
        return self.law(state, u, Pieces(mode))[0]

    def output(self, state, u, mode):
        return self.law(state, u, Pieces(mode))[1]
