"""What a model is to the references, and its integration piece by piece with located guards.

A model has

    states, inputs, outputs     names; states and outputs are the columns of a case, states if they are `shown`
    derivative(state, u, mode)  the rates, smooth within a mode
    output(state, u, mode)      values of `outputs`
    mode, guards, watched, after, settle    which piece of the equations holds, and what ends it
    guard_count, max_step       how many guards there are, how long they surely stay on one side

and a sampled one in addition `period` and `tick(memory, state, u, k)`. What the tick k leaves is held till the next:
`derivative` and `output` get it at the end of u.
"""

from scipy.integrate import solve_ivp

# The reference method and the one it is checked against: an explicit Runge-Kutta pair of
# order 8 and a variable-order multistep code, with different tolerances.
REFERENCE = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16}
CHECK = {"method": "LSODA", "rtol": 1e-13, "atol": 1e-16}


class Smooth:
    """A model without guards."""

    states, outputs = [], []
    # Whether the states are columns of a case.
    shown = True
    period = None
    guard_count = 0
    # Shorter than any guard stays on its other side: what changes twice within a solver's step is not seen.
    max_step = float("inf")

    def mode(self, _state, _u):
        return ()

    def guards(self, _state, _u):
        return ()

    def watched(self, _mode):
        return []

    def settle(self, state, _mode):
        return state

    def derivative(self, _state, _u, _mode):
        return []

    def before(self, state, u):
        """What outputs at the start are made with: what the first tick will leave."""
        return self.tick(None, state, u, 0)


class Switched(Smooth):
    """A model whose mode is the side of each guard: true where the guard is positive."""

    def mode(self, state, u):
        return tuple(guard > 0.0 for guard in self.guards(state, u))

    def watched(self, mode):
        return [(index, -1 if positive else 1) for index, positive in enumerate(mode)]

    def after(self, mode, guard, _state, _u):
        return tuple(positive != (index == guard) for index, positive in enumerate(mode))


def advance(model, t0, t1, state, input_at, solver):
    """Integrates over [t0, t1], where input_at(t) is smooth. Returns the state at t1."""
    state = list(state)
    if not state:
        return state
    mode = model.mode(state, input_at(t0))
    t, first = t0, 2e-4
    for _ in range(1000):
        state = model.settle(state, mode)
        watched = model.watched(mode)
        solution = solve_ivp(
            lambda s, x: model.derivative(x, input_at(s), mode), (t, t1), state,
            events=guard_events(model, watched, input_at) or None,
            first_step=min(first, t1 - t), max_step=model.max_step, **solver)
        if not solution.success:
            raise RuntimeError(f"integration failed at {t}: {solution.message}")
        t, state = float(solution.t[-1]), solution.y[:, -1].tolist()
        if solution.status == 0:
            return model.settle(state, mode)
        fired = next(i for i, times in enumerate(solution.t_events) if len(times))
        mode = model.after(mode, watched[fired][0], state, input_at(t))
        # Off the guard first: from there a return is seen.
        first = 1e-6
        if t >= t1:
            return model.settle(state, mode)
    raise RuntimeError(f"more than 1000 switches before {t1}")


def guard_events(model, watched, input_at):
    """One event function a guard; all guards are evaluated together, once a point."""
    at, values = None, None

    def guards(t, x):
        nonlocal at, values
        point = (t, *x)
        if point != at:
            at, values = point, model.guards(x, input_at(t))
        return values

    def event_of(index, direction):
        def event(t, x):
            return guards(t, x)[index]
        event.terminal = True
        event.direction = direction
        return event

    return [event_of(index, direction) for index, direction in watched]


def held(model, case, start, inputs_at, solver):
    """Zero-order hold: the input at t_k holds on [t_k, t_k + step].

    Yields (t, state, u). The row at t_k is read at the end of the step that arrives there, with that step's input;
    the row at 0 with the input at 0. A tick at t_k sees the input at t_k and shows in the row at t_k + step; before
    the first tick there is what it would leave.
    """
    step, count = case["step"], round(case["stop"] / case["step"])
    state, memory, ticks = list(start), [], 0

    def vector(k):
        values = inputs_at(case, k * step)
        return [values[name] for name in model.inputs]

    if model.period:
        every = round(model.period / step)
        assert abs(every * step / model.period - 1.0) < 1e-12, "a period is a multiple of the step"
        yield 0.0, state, vector(0) + model.before(state, vector(0))
    else:
        yield 0.0, state, vector(0)
    for k in range(count):
        u = vector(k)
        if model.period and k % every == 0:
            memory = model.tick(memory or None, state, u, ticks)
            ticks += 1
        u = u + memory
        state = advance(model, k * step, (k + 1) * step, state, lambda _t: u, solver)
        yield (k + 1) * step, state, u
