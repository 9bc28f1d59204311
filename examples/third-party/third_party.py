"""FMUs that others have made, connected with ours: their plant with our actuator and controller, our rig with theirs.

    python third_party.py [--fmus FOLDER] [--out FOLDER]

The systems lie beside this script. `python fetch.py theirs` brings the FMUs of others, and

    cargo run --release -- --system theirs/their-plant.toml --system theirs/our-rig.toml --system theirs/their-truck.toml

makes SSPs of all. They run here in the master of the examples. Each result is compared with a solution that shares
nothing with the FMUs.
"""

import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from leave import leave  # noqa: E402
from output import folders, plt, save  # noqa: E402
from ssp import open_system  # noqa: E402

# Their FMUs integrate by explicit Euler with the communication step, so that it is their error that falls with it.
STEP, PERIOD = 2e-4, 1e-3

# Their plant, as the system's file has it, and the speed that it starts with.
MASS, STIFFNESS, DAMPING, SPEED = 350.0, 20e3, 1500.0, 1.0
# Our motor: TUM eq. 10 and 11, below its limits.
POLE, GAIN, DELAY_POLE, READOUT, FORCE = 320.4019, 1.2131, 250.0, 839.4076, 100.0
# Our rig: TUM Table 9, measured.
BODY, WHEEL, STRUT, STRUT_DAMPING, TIRE, TIRE_DAMPING = 89.56, 23.92, 8250.0, 758.0, 149693.0, 100.0
# Their seat and their ramp.
SEAT, SEAT_STIFFNESS, SEAT_DAMPING = 80.0, 20e3, 800.0
HEIGHT, DURATION, START = 0.1, 0.5, 0.5
# Their truck, in our units.
CHASSIS, WHEEL_OF_TRUCK, SPRING, DAMPER, TIRE_OF_TRUCK, SKYHOOK = 2000.0, 300.0, 150e3, 5e3, 1e6, 4000.0


def plant_alone(times, damping):
    """m x'' + k x = F, the motor's force for a Skyhook command that is held for its period: exact."""
    to_state = POLE / READOUT / FORCE
    a = np.zeros((5, 5))
    a[0, 1] = 1.0
    a[1, 0], a[1, 3] = -STIFFNESS / MASS, READOUT * FORCE / MASS
    a[2, 2], a[2, 4] = -POLE, to_state
    a[3, 2], a[3, 3] = DELAY_POLE, -DELAY_POLE
    step = times[1] - times[0]
    onward, ticks = expm(step * a), round(PERIOD / step)
    state, rows = np.array([0.0, SPEED, 0.0, 0.0, 0.0]), []
    for index in range(len(times)):
        rows.append(state[0])
        if index % ticks == 0:
            state[4] = -damping * state[1]
        state = onward @ state
    return np.array(rows)


def rig_alone(times):
    """Body and wheel on the ramp, and the seat on the accelerated body: their motion, the seat's against the body."""
    edges = [START, START + DURATION]

    def rates(t, z):
        body, body_speed, wheel, wheel_speed, seat, seat_speed = z
        height = HEIGHT * np.clip((t - START) / DURATION, 0.0, 1.0)
        rise = HEIGHT / DURATION if edges[0] <= t < edges[1] else 0.0
        strut = STRUT * (body - wheel) + STRUT_DAMPING * (body_speed - wheel_speed)
        tire = TIRE * (wheel - height) + TIRE_DAMPING * (wheel_speed - rise)
        lift = -strut / BODY
        pull = -(SEAT_STIFFNESS * seat + SEAT_DAMPING * seat_speed) / SEAT
        return [body_speed, lift, wheel_speed, (strut - tire) / WHEEL, seat_speed, pull - lift]

    state, found = np.zeros(6), np.zeros((6, len(times)))
    # Piece by piece: the ramp has corners.
    for begin, end in zip([0.0, *edges], [*edges, times[-1]]):
        inside = (times >= begin - 1e-9) & (times <= end + 1e-9)
        piece = solve_ivp(rates, (begin, end), state, method="DOP853", t_eval=np.clip(times[inside], begin, end),
                          rtol=1e-10, atol=1e-12)
        found[:, inside], state = piece.y, piece.y[:, -1]
    return found


def truck_alone(times, road, damping):
    """Chassis and wheel in our units and signs, the motor between them: exact for a road that is held for a step."""
    a = np.zeros((8, 8))
    chassis, wheel, motor, given, command = (0, 1), (2, 3), (4, 5), 6, 7
    strut = np.zeros(8)
    strut[[0, 1, 2, 3]] = SPRING, DAMPER, -SPRING, -DAMPER
    force = np.zeros(8)
    force[5] = READOUT * FORCE
    a[chassis], a[wheel] = 1.0, 1.0
    a[1] = (force - strut) / CHASSIS
    a[3] = (strut - force) / WHEEL_OF_TRUCK
    a[3, [2, given]] += -TIRE_OF_TRUCK / WHEEL_OF_TRUCK, TIRE_OF_TRUCK / WHEEL_OF_TRUCK
    a[4, 4], a[4, command] = -POLE, POLE / READOUT / FORCE
    a[5, motor] = DELAY_POLE, -DELAY_POLE
    step = times[1] - times[0]
    onward, ticks = expm(step * a), round(PERIOD / step)
    state, rows = np.zeros(8), []
    for index, height in enumerate(road):
        rows.append(state[0])
        state[given] = height
        if index % ticks == 0:
            state[command] = -damping * state[1]
        state = onward @ state
    return np.array(rows)


def off(found, expected):
    """The largest difference, as a share of the largest value."""
    return float(np.abs(found - expected).max() / np.abs(expected).max())


def their_plant(fmus):
    def run(damping, step):
        with open_system(fmus, "their-plant", {"skyhook.damping": damping}) as system:
            result = system.run(3.0, step, ["plant.x1", "motor.force"])
        return result, off(result["plant.x1"], plant_alone(result["time"], damping))

    free, alone = run(0.0, STEP)
    damped, with_ours = run(DAMPING, STEP)
    _, coarse = run(DAMPING, 2.0 * STEP)
    print(f"their plant alone differs from scipy's by {alone:.5f} of its motion")
    print(f"with our motor and controller by {with_ours:.5f}, with steps twice as long by {coarse:.5f}")
    late = damped["time"] > 2.0
    left = [np.abs(result["plant.x1"][late]).max() for result in (free, damped)]
    print(f"after two seconds it swings by {1e3 * left[0]:.3f} mm alone, by {1e3 * left[1]:.3f} mm with ours")
    return free, damped


def our_rig(fmus):
    signals = ["road.out", "rig.body.position", "rig.body.acceleration", "seat.y"]
    with open_system(fmus, "our-rig") as system:
        result = system.run(4.0, STEP, signals)
    body, _, _, _, seat, _ = rig_alone(result["time"])
    moved = result["seat.y"]
    print(f"our rig on their ramp differs from scipy's by {off(result['rig.body.position'], body):.5f} of its motion")
    print(f"their seat in our rig differs from scipy's by {off(moved, seat):.5f} of its motion")
    print(f"our rig rests at last {1e3 * result['rig.body.position'][-1]:.3f} mm higher")
    return result, moved


def their_truck(fmus):
    results = {}
    for label, damping in (("alone", 0.0), ("under Skyhook", SKYHOOK)):
        with open_system(fmus, "their-truck", {"skyhook.damping": damping}) as system:
            result = results[label] = system.run(3.0, STEP, ["road.position", "chassis.chassis.z[1]"])
        # Theirs counts downwards, in millimetres.
        result["height"] = -1e-3 * result["chassis.chassis.z[1]"]
        expected = truck_alone(result["time"], result["road.position"], damping)
        print(f"their truck {label} differs from scipy's by {off(result['height'], expected):.5f} of its motion")
    over = [1e3 * result["height"].max() for result in results.values()]
    print(f"on a step of 20 mm their truck rises by {over[0]:.3f} mm alone, by {over[1]:.3f} mm with ours")
    return results


def plot(free, damped, result, moved, truck):
    figure, (left, right, last) = plt.subplots(1, 3, figsize=(15, 4), layout="constrained")
    left.plot(free["time"], 1e3 * free["plant.x1"], color="0.6", linewidth=1, label="their plant alone")
    left.plot(damped["time"], 1e3 * damped["plant.x1"], color="tab:blue", label="with our motor under Skyhook")
    left.set_title("Their plant, our actuator and controller", fontsize=11)
    left.set_ylabel("position in mm")
    right.plot(result["time"], result["road.out"], color="0.6", label="their ramp")
    right.plot(result["time"], 1e3 * result["rig.body.position"], color="tab:blue", label="our body")
    right.plot(result["time"], 1e3 * moved, color="tab:orange", label="their seat, against the body")
    right.set_title("Our rig, their road and seat", fontsize=11)
    left.set_ylim(-230, 160)
    right.set_ylim(-50, 122)
    alone, active = truck.values()
    last.plot(alone["time"], 1e3 * alone["road.position"], color="0.6", label="our road")
    last.plot(alone["time"], 1e3 * alone["height"], color="tab:orange", label="their truck alone")
    last.plot(active["time"], 1e3 * active["height"], color="tab:blue", label="with our motor under Skyhook")
    last.set_title("Their truck, our road, actuator and controller", fontsize=11)
    for axes in (left, right, last):
        axes.set_xlabel("time in s")
        axes.legend(loc="lower right")
    return figure


def main():
    fmus, out = folders(__doc__)
    plant, rig, truck = their_plant(fmus), our_rig(fmus), their_truck(fmus)
    save(plot(*plant, *rig, truck), out / "third_party.png")


if __name__ == "__main__":
    main()
    leave()
