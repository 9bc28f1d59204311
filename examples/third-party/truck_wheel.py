"""One wheel of a truck and its tyre, as others write a model: in mm, kN and t, positive downwards."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Wheel(Fmi2Slave):
    MASS, STIFFNESS = 0.3, 1.0  # t, kN/mm
    STEP = 2e-5

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.height = self.speed = self.push = self.road = 0.0
        output, given = Fmi2Causality.output, Fmi2Causality.input
        self.register_variable(Real("wheel.z[1]", causality=output, getter=lambda: self.height))
        self.register_variable(Real("wheel.v[1]", causality=output, getter=lambda: self.speed))
        self.register_variable(Real("axle.F[1]", causality=given, getter=lambda: self.push,
                                    setter=lambda value: setattr(self, "push", value)))
        self.register_variable(Real("road.z[1]", causality=given, getter=lambda: self.road,
                                    setter=lambda value: setattr(self, "road", value)))

    def do_step(self, current_time, step_size):
        count = max(1, round(step_size / self.STEP))
        step = step_size / count
        for _ in range(count):
            self.speed += step * 1000.0 * (self.push - self.STIFFNESS * (self.height - self.road)) / self.MASS
            self.height += step * self.speed
        return True
