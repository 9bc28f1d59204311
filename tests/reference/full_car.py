"""The full car, Ajala Fig. 7: a rigid body on four corners, small angles.

Axes x forwards, y to the left from the centre of mass; corner i at (x_i, y_i), x = l_f or -l_r, y = w_l or -w_r.
Roll lifts the left side, pitch the rear:

    z_i = z_H + y_i phi_R - x_i phi_P
    m z_H'' = sum F_i,  I_R phi_R'' = sum y_i F_i,  I_P phi_P'' = -sum x_i F_i,  F_i = F_act,i - F_strut,i - F_bar,i
    m_u z_u,i'' = F_strut,i + F_bar,i - F_act,i + F_tire,i
    F_bar = k_bar (x_left - x_right) on the left, minus that on the right, of the deflections of one axle
    static load F0_i = m_u g + m g (l_opposite / wheelbase) (w_opposite / track)
"""

from corner import Strut, Tire
from integrate import Smooth
from parameter_sets import G

CORNERS = ["front_left", "front_right", "rear_left", "rear_right"]


class FullCar(Smooth):
    states = (["heave.position", "heave.velocity", "roll.angle", "roll.speed", "pitch.angle", "pitch.speed"]
              + [f"wheel.{c}.{what}" for c in CORNERS for what in ("position", "velocity")])
    inputs = ([f"road.{c}.{what}" for c in CORNERS for what in ("position", "velocity")]
              + [f"actuator.{c}.force" for c in CORNERS])
    outputs = (["heave.acceleration", "roll.acceleration", "pitch.acceleration"]
               + [f"{name}.{c}.{what}" for c in CORNERS for name, what in (
                   ("wheel", "acceleration"), ("wheel", "force"), ("suspension", "deflection"),
                   ("suspension", "velocity"), ("tire", "deflection"))])
    guard_count = 4 * Tire.guard_count

    def __init__(self, parameters, settings):
        p = parameters
        self.mass, self.roll, self.pitch = p["sprung_mass"], p["roll_inertia"], p["pitch_inertia"]
        front, rear, left, right = (p[f"geometry.{side}"] for side in ("front", "rear", "left", "right"))
        self.x, self.y = [front, front, -rear, -rear], [left, -right, left, -right]
        self.unsprung, self.struts, self.bars, self.tires = [], [], [], []
        for axle, axle_share in (("front", rear), ("rear", front)):
            self.bars.append(p[f"anti_roll_bar.{axle}.stiffness"])
            for side, side_share in (("left", right), ("right", left)):
                unsprung = p[f"unsprung_mass.{axle}"]
                share = axle_share / (front + rear) * side_share / (left + right)
                self.unsprung.append(unsprung)
                self.struts.append(Strut(p, f"strut.{axle}_{side}."))
                self.tires.append(Tire(p, G * (unsprung + share * self.mass), settings["tire.lift_off"],
                                       f"tire.{axle}_{side}."))

    def motion(self, state, u):
        """Deflection and velocity of each suspension, compression of each tyre and its rate."""
        heave, heave_rate, roll, roll_rate, pitch, pitch_rate, *wheels = state
        suspensions, tires = [], []
        for i in range(4):
            x, y = self.x[i], self.y[i]
            position, velocity = wheels[2 * i], wheels[2 * i + 1]
            suspensions.append((heave + y * roll - x * pitch - position,
                                heave_rate + y * roll_rate - x * pitch_rate - velocity))
            tires.append((u[2 * i] - position, u[2 * i + 1] - velocity))
        return suspensions, tires

    def accelerations(self, state, u, mode):
        suspensions, tires = self.motion(state, u)
        body, wheels, loads = [], [], []
        for i, (deflection, velocity) in enumerate(suspensions):
            other = suspensions[i ^ 1][0]
            between = self.struts[i].force(deflection, velocity) + self.bars[i // 2] * (deflection - other) - u[8 + i]
            load = self.tires[i].force(*tires[i], mode[i])
            body.append(-between)
            wheels.append((between + load) / self.unsprung[i])
            loads.append(load)
        heave = sum(body) / self.mass
        roll = sum(y * force for y, force in zip(self.y, body)) / self.roll
        pitch = -sum(x * force for x, force in zip(self.x, body)) / self.pitch
        return [heave, roll, pitch], wheels, loads, suspensions, tires

    def derivative(self, state, u, mode):
        (heave, roll, pitch), wheels, _, _, _ = self.accelerations(state, u, mode)
        rates = [state[1], heave, state[3], roll, state[5], pitch]
        for i, wheel in enumerate(wheels):
            rates += [state[7 + 2 * i], wheel]
        return rates

    def output(self, state, u, mode):
        body, wheels, loads, suspensions, tires = self.accelerations(state, u, mode)
        return body + [value for i in range(4) for value in (wheels[i], loads[i], *suspensions[i], -tires[i][0])]

    def mode(self, state, u):
        return tuple(tire.mode(*at) for tire, at in zip(self.tires, self.motion(state, u)[1]))

    def guards(self, state, u):
        return [guard for tire, at in zip(self.tires, self.motion(state, u)[1]) for guard in tire.guards(*at)]

    def watched(self, mode):
        return [(2 * i + guard, direction) for i, tire in enumerate(self.tires)
                for guard, direction in tire.watched(mode[i])]

    def after(self, mode, guard, state, u):
        i = guard // 2
        rate = self.motion(state, u)[1][i][1]
        return mode[:i] + (self.tires[i].after(mode[i], guard % 2, rate),) + mode[i + 1:]

    def energy(self, state):
        """Kinetic energy and that of all springs, on a flat road."""
        suspensions, tires = self.motion(state, [0.0] * 12)
        energy = 0.5 * (self.mass * state[1]**2 + self.roll * state[3]**2 + self.pitch * state[5]**2)
        for i, (deflection, _) in enumerate(suspensions):
            tire, c = self.tires[i], tires[i][0]
            energy += 0.5 * self.unsprung[i] * state[7 + 2 * i]**2 + 0.5 * self.struts[i].k * deflection**2
            energy += 0.5 * tire.kt * c**2 + tire.q * c**3 / 3.0
        return energy + sum(0.5 * bar * (suspensions[2 * a][0] - suspensions[2 * a + 1][0])**2
                            for a, bar in enumerate(self.bars))
