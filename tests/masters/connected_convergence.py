"""How the coupling error falls with the communication step.

    python connected_convergence.py FOLDER [PICTURE]

The error of a connected system against its monolithic reference, for three masters:

held              Jacobi, inputs held through a step: each connection is late by half a step on average.
slopes            Jacobi, each input goes on with the slope of its output. What remains of first order is the
                  controller's force, which is known to the rig one step after the tick that made it.
controller first  slopes, and the controller takes each step before the others, which then have the force of
                  its tick. Nothing of first order remains.

The controller samples every millisecond whatever the step. A step longer than that hides ticks from the others.
"""

import sys
from pathlib import Path

import numpy as np
from connected_systems import COMPOSED, Reference, System, compose

STEPS = [4e-3, 2e-3, 1e-3, 0.5e-3, 0.25e-3]
# The rig's states: what everything else follows from, and free of jumps.
SIGNALS = ["rig.body.position", "rig.body.velocity", "rig.wheel.position", "rig.wheel.velocity"]
# Rows that are communication points of all steps.
INTERVAL = 0.1


class Slopes(System):
    """Inputs go on with the slopes of the outputs that they are connected to."""

    def exchange(self):
        super().exchange()
        if not self.initialized:
            return
        slopes = {}
        for name, variables in self.outputs.items():
            component = self.components[name]
            read = component.fmu.getRealOutputDerivatives(component.references(variables), [1] * len(variables))
            slopes.update((f"{name}.{variable}", value) for variable, value in zip(variables, read))
        for name, inputs in self.inputs.items():
            if inputs:
                component = self.components[name]
                references = component.references([variable for variable, _ in inputs])
                component.fmu.setRealInputDerivatives(
                    references, [1] * len(inputs), [slopes[source] for _, source in inputs]
                )

    initialized = False

    def initialize(self):
        super().initialize()
        self.initialized = True


class ControllerFirst(Slopes):
    """The controller's step comes before the exchange with the others' inputs ends."""

    def step(self, time, size):
        self.exchange()
        controller = self.components["controller"].fmu
        controller.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        for name, inputs in self.inputs.items():
            component = self.components[name]
            for variable, source in inputs:
                if source.startswith("controller."):
                    value = self.read({"controller": [source.split(".", 1)[1]]})[source]
                    component.fmu.setReal(component.references([variable]), [value])
        for component in self.components.values():
            if component.fmu is not controller:
                component.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)


SCHEMES = {"held": System, "slopes": Slopes, "controller first": ControllerFirst}


def error(reference, folder, system, scheme, step):
    """The largest error of the rig's states, relative to their scales."""
    with compose(system, folder, scheme) as composed:
        result = composed.run(reference.stop, step, SIGNALS, every=round(INTERVAL / step))
    # Every row of the result is one of the reference but the first and those that the reference leaves out.
    rows = np.rint(reference.times / INTERVAL).astype(int)
    chosen = np.abs(reference.times / INTERVAL - rows) < 1e-6
    return max(reference.scaled(name, result[name][rows[chosen]] - reference.values[name][chosen]) for name in SIGNALS)


def orders(errors):
    return [np.log2(coarse / fine) for coarse, fine in zip(errors, errors[1:])]


def check(system, table):
    """What the theory says, on the way down from steps that are no longer than the sampling period."""
    fine = slice(STEPS.index(1e-3), None)
    held, slopes, first = (table[scheme] for scheme in SCHEMES)
    assert min(orders(held[fine])) > 0.8, (system, orders(held))
    assert min(orders(slopes[fine])) > 0.8, (system, orders(slopes))
    assert min(orders(first[fine])) > 1.6, (system, orders(first))
    assert all(b < a for a, b in zip(held[fine], slopes[fine])), (system, held, slopes)
    assert all(b < a for a, b in zip(slopes[fine], first[fine])), (system, slopes, first)


def report(system, table):
    print(f"{system}: largest error of the rig's states, relative to their scales (observed order)")
    print(f"{'step in ms':>12}" + "".join(f"{scheme:>24}" for scheme in table))
    for index, step in enumerate(STEPS):
        line = f"{1e3 * step:>12g}"
        for errors in table.values():
            order = f"({orders(errors)[index - 1]:.2f})" if index else ""
            line += f"{errors[index]:>16.1e} {order:>7}"
        print(line)
    print()


def picture(tables, path):
    from output import plt, save

    figure, axes = plt.subplots(1, len(tables), sharey=True, figsize=(9, 3.9), layout="constrained")
    steps = 1e3 * np.array(STEPS)
    titles = {"quanser-lqr": "Quanser with LQR", "tum-active": "TUM with motor and Skyhook"}
    style = {"held": ("o", "tab:blue"), "slopes": ("s", "tab:orange"), "controller first": ("D", "tab:green")}
    labels = {"held": "inputs held", "slopes": "inputs with slopes", "controller first": "slopes, controller first"}
    for panel, (system, table) in zip(axes, tables.items()):
        for scheme, errors in table.items():
            marker, color = style[scheme]
            panel.loglog(steps, errors, marker=marker, color=color, label=labels[scheme])
        # Where the two orders would lead from the first and the last curve's middle.
        for scheme, order in (("held", 1), ("controller first", 2)):
            panel.loglog(steps, 1.35 * table[scheme][2] * steps**order, color="0.5", linewidth=0.8, linestyle=":")
            panel.text(0.25, 1.35 * table[scheme][2] * 0.4**order, f"order {order}", color="0.4", fontsize=9)
        panel.axvspan(1.0, 5.0, color="0.5", alpha=0.08, linewidth=0)
        panel.set_xlim(0.22, 4.6)
        panel.set_xticks(steps, [f"{step:g}" for step in steps])
        panel.minorticks_off()
        panel.set_xlabel("communication step in ms")
        panel.set_title(titles[system])
    axes[0].set_ylabel("largest error of the rig's states,\nrelative to their range")
    axes[0].legend(loc="lower right")
    save(figure, path)


def main():
    folder, tables = Path(sys.argv[1]), {}
    for system in COMPOSED:
        reference = Reference(system)
        tables[system] = {
            name: [error(reference, folder, system, scheme, step) for step in STEPS] for name, scheme in SCHEMES.items()
        }
        report(system, tables[system])
    if len(sys.argv) > 2:
        picture(tables, sys.argv[2])
    for system, table in tables.items():
        check(system, table)


if __name__ == "__main__":
    main()
