"""Piecewise linear characteristics: the mode of a table is the number of its piece."""

from bisect import bisect_right


class Table:
    """Through the points (x, y). Beyond the ends it goes on with the slope of the last piece, or is held."""

    def __init__(self, x, y, held=False):
        self.x, self.y, self.held = list(x), list(y), held
        # The kinks: between two pieces, and at the ends if the ends are held.
        self.kinks = self.x if held else self.x[1:-1]
        self.guard_count = len(self.kinks)

    def piece(self, x):
        return bisect_right(self.kinks, x)

    def value(self, x, piece):
        if self.held:
            if piece == 0 or piece == len(self.x):
                return self.y[0 if piece == 0 else -1]
            piece -= 1
        (x0, x1), (y0, y1) = self.x[piece:piece + 2], self.y[piece:piece + 2]
        return y0 + (y1 - y0) * (x - x0) / (x1 - x0)

    def guards(self, x):
        return [x - kink for kink in self.kinks]

    def watched(self, piece):
        below = [(piece - 1, -1)] if piece > 0 else []
        return below + ([(piece, 1)] if piece < len(self.kinks) else [])

    def after(self, piece, guard):
        """The piece on the other side of a kink."""
        return guard if piece == guard + 1 else guard + 1


def array(parameters, name, count):
    """An array among parameters: name[1] to name[count]."""
    return [parameters[f"{name}[{index}]"] for index in range(1, count + 1)]


def indexed(name, values):
    """The same, the other way round."""
    return {f"{name}[{index}]": value for index, value in enumerate(values, 1)}
