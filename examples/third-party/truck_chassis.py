"""The chassis over one wheel of a truck and its strut, as others write a model: in mm, kN and t, positive downwards.

PythonFMU makes an FMU of it. It tells no units and puts out no velocity, and its names have brackets.
"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Chassis(Fmi2Slave):
    MASS, STIFFNESS, DAMPING = 2.0, 0.15, 0.005  # t, kN/mm, kN s/mm
    STEP = 2e-5

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.height = self.speed = self.stretch = self.wheel_speed = self.push = 0.0
        output, given = Fmi2Causality.output, Fmi2Causality.input
        self.register_variable(Real("chassis.z[1]", causality=output, getter=lambda: self.height))
        self.register_variable(Real("strut.F[1]", causality=output, getter=self.strut))
        self.register_variable(Real("wheel.v[1]", causality=given, getter=lambda: self.wheel_speed,
                                    setter=lambda value: setattr(self, "wheel_speed", value)))
        self.register_variable(Real("F[1]", causality=given, getter=lambda: self.push,
                                    setter=lambda value: setattr(self, "push", value)))

    def strut(self):
        """What the strut does to the wheel."""
        return self.STIFFNESS * self.stretch + self.DAMPING * (self.speed - self.wheel_speed)

    def do_step(self, current_time, step_size):
        count = max(1, round(step_size / self.STEP))
        step = step_size / count
        for _ in range(count):
            self.speed += step * 1000.0 * (self.push - self.strut()) / self.MASS
            self.height += step * self.speed
            self.stretch += step * (self.speed - self.wheel_speed)
        return True
