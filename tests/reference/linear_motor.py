"""The linear motor of the TUM rig's suspension, TUM eq. 10-11 and eq. 1:

    v1' = -320.4019 v1 + 1.2131 u,  v2' = 250 (v1 - v2),  i = 839.4076 v2,  F = 100 i
    q'  = i^2 - i_c^2, not below zero,  Q = (i_p^2 - i_c^2) 1 s
    |i| limit = i_c + (i_p - i_c) clamp((Q - q) / (0.02 Q), 0, 1)

A hybrid model, as the quarter car is: the accumulator does not go below zero.
"""

from integrate import Smooth
from parameter_sets import MOTOR

FREE, HELD = "free", "held"


class LinearMotor(Smooth):
    states = ["current_loop", "delayed", "overload"]
    inputs = ["voltage", "force_reference"]
    outputs = ["current", "force"]
    guard_count = 2

    def __init__(self, parameters=MOTOR, _settings=None):
        p = parameters
        self.pole, self.gain = p["electric_pole"], p["input_gain"]
        self.delay, self.readout = p["delay_pole"], p["current_gain"]
        self.force_constant, self.voltage_limit = p["force_constant"], p["voltage_limit"]
        self.peak, self.continuous = p["peak_current"], p["continuous_current"]
        self.capacity = (self.peak**2 - self.continuous**2) * p["peak_time"]
        self.fade = p["fade"]
        self.static_gain = self.gain * self.readout / self.pole

    def current_limit(self, q):
        share = (self.capacity - q) / (self.fade * self.capacity)
        return self.continuous + (self.peak - self.continuous) * min(1.0, max(0.0, share))

    def command(self, q, u):
        wanted = u[0] + u[1] / (self.static_gain * self.force_constant)
        bound = min(self.voltage_limit, self.current_limit(q) / self.static_gain)
        return min(bound, max(-bound, wanted))

    def derivative(self, state, u, mode):
        v1, v2, q = state
        surplus = (self.readout * v2)**2 - self.continuous**2
        return [-self.pole * v1 + self.gain * self.command(q, u), self.delay * (v1 - v2),
                surplus if mode == FREE else 0.0]

    def output(self, state, _u, _mode):
        current = self.readout * state[1]
        return [current, self.force_constant * current]

    def mode(self, state, u):
        empty, surplus = self.guards(state, u)
        return HELD if empty <= 0.0 and surplus <= 0.0 else FREE

    def guards(self, state, _u):
        """The accumulator's content; the square of the current above the continuous one."""
        return state[2], (self.readout * state[1])**2 - self.continuous**2

    def watched(self, mode):
        return [(0, -1)] if mode == FREE else [(1, 1)]

    def after(self, mode, _guard, _state, _u):
        return HELD if mode == FREE else FREE

    def settle(self, state, mode):
        """In the held mode the accumulator is empty, exactly."""
        return [state[0], state[1], 0.0] if mode == HELD else state
