"""Integration of a hybrid model, piece by piece, with located guards."""

from scipy.integrate import solve_ivp

# The reference method and the one it is checked against: an explicit Runge-Kutta pair of
# order 8 and a variable-order multistep code, with different tolerances.
REFERENCE = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16}
CHECK = {"method": "LSODA", "rtol": 1e-13, "atol": 1e-16}


def advance(model, t0, t1, state, input_at, solver):
    """Integrates over [t0, t1], where input_at(t) is smooth. Returns the state at t1."""
    state = list(state)
    mode = model.mode(state, input_at(t0))
    t = t0
    for _ in range(1000):
        state = model.settle(state, mode)
        watched = model.watched(mode)
        solution = solve_ivp(
            lambda s, x: model.derivative(x, input_at(s), mode), (t, t1), state,
            events=[guard_event(model, index, direction, input_at) for index, direction in watched] or None,
            first_step=min(2e-4, t1 - t), **solver)
        if not solution.success:
            raise RuntimeError(f"integration failed at {t}: {solution.message}")
        t, state = float(solution.t[-1]), solution.y[:, -1].tolist()
        if solution.status == 0:
            return model.settle(state, mode)
        fired = next(i for i, times in enumerate(solution.t_events) if len(times))
        mode = model.after(mode, watched[fired][0], state, input_at(t))
        if t >= t1:
            return model.settle(state, mode)
    raise RuntimeError(f"more than 1000 switches before {t1}")


def guard_event(model, index, direction, input_at):
    def event(t, x):
        return model.guards(x, input_at(t))[index]
    event.terminal = True
    event.direction = direction
    return event


def held(model, case, start, inputs_at, solver):
    """Zero-order hold: the input at t_k holds on [t_k, t_k + step].

    Yields (t, state, held input). The row at t_k is read at the end of the step that arrives
    there, with that step's input; the row at 0 is read with the input at 0.
    """
    step, count = case["step"], round(case["stop"] / case["step"])
    state = list(start)

    def vector(k):
        values = inputs_at(case, k * step)
        return [values[name] for name in model.inputs]

    yield 0.0, state, vector(0)
    for k in range(count):
        u = vector(k)
        state = advance(model, k * step, (k + 1) * step, state, lambda _t: u, solver)
        yield (k + 1) * step, state, u
