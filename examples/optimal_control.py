"""The best force on a bump: optimal control with the FMU's exact derivatives.

    python optimal_control.py fmus/TumQuarterVehicle.fmu

CasADi takes the FMU as a function with exact Jacobians (model exchange), and IPOPT finds the force over time that keeps the
body's acceleration least. The Jacobians are compared with differences, the result with the FMU's own co-simulation.
Packages: casadi, fmpy.
"""

import sys
import tempfile
import zipfile

import casadi as ca
import fmpy
import numpy as np

STEP, COUNT, LIMIT = 5e-3, 120, 600.0  # s, steps, N
time = STEP * np.arange(COUNT + 1)
phase = np.clip((time - 0.1) / 0.1, 0.0, 1.0) * 2.0 * np.pi
# A bump of 20 mm in 0.1 s.
ROAD = {"road.position": 0.01 * (1.0 - np.cos(phase)), "road.velocity": 0.01 * 2.0 * np.pi / 0.1 * np.sin(phase)}
SIGNAL = "body.acceleration"


def optimum(fmu):
    """The function, its states and inputs over time, and the root mean square of the body's acceleration."""
    folder = tempfile.mkdtemp()
    zipfile.ZipFile(fmu).extractall(folder)
    model = ca.DaeBuilder("car", folder)
    car = model.create("car", ["x", "u"], ["ode", "y"])
    start, size = (np.array([of(name) for name in model.x()]) for of in (model.start, model.nominal))
    start = start.ravel()
    problem = ca.Opti()
    x, force = problem.variable(len(size), COUNT + 1), problem.variable(1, COUNT + 1)
    u = ca.vertcat(*(ca.DM(ROAD[name]).T if name in ROAD else LIMIT * force for name in model.u()))
    rates, y = car.map(COUNT + 1)(ca.diag(size) @ x, u)
    acceleration = y[model.y().index(SIGNAL), :]
    # The trapezoidal rule, each state in its own size.
    problem.subject_to(x[:, 1:] == x[:, :-1] + STEP / 2.0 * (rates[:, 1:] + rates[:, :-1]) / size)
    problem.subject_to(x[:, 0] == start / size)
    problem.subject_to(problem.bounded(-1.0, force, 1.0))
    problem.minimize(ca.sumsqr(acceleration) / COUNT + 1e-3 * ca.sumsqr(force))
    problem.set_initial(x, np.tile(start / size, (COUNT + 1, 1)).T)
    quiet = {"print_level": 0, "sb": "yes", "hessian_approximation": "limited-memory", "tol": 1e-6}
    problem.solver("ipopt", {"print_time": False}, quiet)
    solution = problem.solve()
    rms = float(np.sqrt(np.mean(np.square(solution.value(acceleration)))))
    return car, solution.value(ca.diag(size) @ x), solution.value(u), model.u(), rms


def apart(car, x, u, share=1e-4):
    """How far the exact Jacobian is from differences, in shares of its largest entry."""
    exact = np.array(car.factory("jacobian", ["x", "u"], ["jac:ode:x"])(x, u))
    steps = share * np.maximum(np.abs(x), 1e-3)
    columns = [(car(x + d, u)[0] - car(x - d, u)[0]) / (2.0 * h) for d, h in zip(np.diag(steps), steps)]
    return float(np.abs(np.hstack([np.array(column) for column in columns]) - exact).max() / np.abs(exact).max())


def co_simulated(fmu, names, u):
    """The root mean square of the body's acceleration in co-simulation."""
    table = np.zeros(COUNT + 1, dtype=[("time", float)] + [(name, float) for name in names])
    table["time"] = time
    for name, values in zip(names, u):
        table[name] = values
    result = fmpy.simulate_fmu(fmu, fmi_type="CoSimulation", input=table, output=[SIGNAL], stop_time=time[-1], step_size=1e-4,
                               output_interval=1e-3)  # fmt: skip
    return np.sqrt(np.mean(np.square(result[SIGNAL])))


def main(fmu):
    car, x, u, names, best = optimum(fmu)
    print(f"rms of {SIGNAL} with the best force: {best:.3f} m/s2")
    print(f"Jacobians: {max(apart(car, x[:, k], u[:, k]) for k in range(0, COUNT, 10)):.1e} from differences")
    without = np.where(np.array(names)[:, None] == "actuator.force", 0.0, u)
    print(f"in co-simulation: {co_simulated(fmu, names, u):.3f} m/s2, without a force {co_simulated(fmu, names, without):.3f} m/s2")


if __name__ == "__main__":
    main(sys.argv[1])
