"""Importers that integrate an FMU themselves and set its inputs whenever they ask for rates."""

import warnings

import numpy as np
from fmpy.fmi2 import FMU2Model
from fmpy_checks import events, instance_double, set_states
from other_python import OtherPython
from rig import STEP
from scipy.integrate import solve_ivp


def integrated(rates, begin, end, x):
    return solve_ivp(rates, (begin, end), x, method="DOP853", rtol=1e-10, atol=1e-13, dense_output=True)


class Scipy:
    """scipy's DOP853, restarted where an event indicator changes its sign."""

    name = "scipy"

    def __init__(self, tolerance):
        self.tolerance = tolerance

    def cannot(self, job):
        return None

    def run(self, job):
        fmu, n, nz = job.fmu, len(job.fmu.states), job.fmu.description.numberOfEventIndicators
        references = [v.valueReference for v in fmu.inputs]
        buffer, indicators = instance_double(max(n, 1))(), instance_double(nz)()
        rows, self.found = [], 0
        with fmu.running(FMU2Model) as model:

            def go(time, x):
                model.setTime(time)
                set_states(model, x)
                if references:
                    model.setReal(references, job.at(time))

            def rates(time, x):
                go(time, x)
                model.getDerivatives(buffer, n)
                return np.array(buffer[:n])

            def signs(time, x):
                go(time, x)
                model.getEventIndicators(indicators, nz)
                return np.array(indicators) > 0.0

            def event():
                model.enterEventMode()
                due = events(model)
                model.enterContinuousTimeMode()
                return due

            if references:
                model.setReal(references, job.at(0.0))
            next_event = events(model)
            model.enterContinuousTimeMode()
            model.getContinuousStates(buffer, n)
            time, x = 0.0, np.array(buffer[:n])
            side = signs(time, x)
            for index in range(len(job.times) - 1):
                end = job.times[index + 1]
                while time < end:
                    if next_event is not None and next_event <= time + 1e-9:
                        go(time, x)
                        next_event = event()
                        side = signs(time, x)
                    until = end if next_event is None or next_event > end - 1e-9 else next_event
                    step = integrated(rates, time, until, x)
                    # At points between, too: a sign may change twice.
                    points = np.linspace(time, until, 17)
                    changed = [(signs(point, step.sol(point)) != side).any() for point in points]
                    low, high = time, until
                    if any(changed):
                        first = max(changed.index(True), 1)
                        low, high = points[first - 1], points[first]
                        # Just before the first instant at which a sign has changed, and just after it.
                        while high - low > 1e-11:
                            middle = 0.5 * (low + high)
                            if (signs(middle, step.sol(middle)) != side).any():
                                high = middle
                            else:
                                low = middle
                        self.found += 1
                        # Once more, as far as it is smooth, and then across.
                        x = integrated(rates, time, low, x).y[:, -1] if low > time else x
                        x = x + (high - low) * rates(low, x)
                        go(high, x)
                        event()
                    else:
                        x = step.y[:, -1]
                    time = high
                    side = signs(time, x)
                go(time, x)
                model.completedIntegratorStep()
                rows.append(model.getReal([v.valueReference for v in job.outputs]))
        return np.array(rows)


class Casadi:
    """CasADi's CVODES, with the FMU's exact Jacobians."""

    name = "CasADi"

    def __init__(self, tolerance):
        self.tolerance = tolerance

    def cannot(self, job):
        if not job.fmu.states:
            return "no states"
        # It says so itself: "Next event time not implemented".
        with job.fmu.running(FMU2Model) as model:
            return None if events(model) is None else "samples"

    def run(self, job):
        import casadi as ca

        fmu = job.fmu
        model = ca.DaeBuilder("fmu", str(fmu.folder))
        x, u = ca.MX.sym("x", model.nx()), ca.MX.sym("u", model.nu())
        slope = ca.MX.sym("slope", model.nu())
        function = model.create("function", ["x", "u"], ["ode", "y"])
        rates, _ = function(x, u)
        whole = {"x": ca.vertcat(x, u), "p": slope, "ode": ca.vertcat(rates, slope)}
        # Rosenbrock or not: it is the tolerance that decides here.
        integrator = ca.integrator("integrator", "cvodes", whole, 0.0, STEP, {"reltol": 1e-10, "abstol": 1e-12})
        order = [[v.name for v in fmu.inputs].index(name) for name in model.u()]
        places = [model.y().index(v.name) for v in job.outputs]
        state, rows = np.array(model.start(model.x())), []
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for index in range(len(job.times) - 1):
                given, then = job.inputs[index][order], job.inputs[index + 1][order]
                end = integrator(x0=ca.vertcat(state, given), p=(then - given) / STEP)["xf"]
                state = np.array(end)[: model.nx(), 0]
                rows.append(np.array(function(state, then)[1])[places, 0])
        return np.array(rows)


class PyFmi:
    """PyFMI's own simulation with Assimulo's CVode, of an FMU of FMI 2.0 or of the same one of FMI 3.0."""

    def __init__(self, tolerance, python, fmi):
        self.name, self.tolerance, self.fmi = f"PyFMI, FMI {fmi}.0", tolerance, fmi
        self.python = OtherPython(python, "model_exchange_pyfmi.py", "PyFMI")

    def cannot(self, job):
        return None

    def run(self, job):
        path, count = job.fmu.path, len(job.times) - 1
        if self.fmi == 3:
            path = path.parent / "fmi3" / path.name
        return self.python.run({
            "path": str(path.resolve()), "step": STEP, "count": count, "tolerance": 1e-8,
            "inputs": [v.name for v in job.fmu.inputs], "outputs": [v.name for v in job.outputs],
            "table": np.column_stack([job.times, job.inputs]).tolist(),
        })  # fmt: skip
