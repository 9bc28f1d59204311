"""A system of FMUs in a master that others have written, against the monolithic reference.

    python connected.py fmpy|libcosimpy|ecos SYSTEM FOLDER

All three are Jacobi masters with a fixed step, so they must agree with the example's to the last digits, and
with the reference up to the coupling error. How large that is follows without the reference, from the same
scheme with half the step: the error is proportional to the step, so it is twice the difference of the two.
"""

import sys
from pathlib import Path

import numpy as np
from connected_systems import Reference, System, compose

# Between masters: rounding only, amplified by the system's dynamics.
AGREEMENT = 1e-9
# On the estimate of the coupling error, which is exact only in the limit of small steps.
MARGIN = 1.1


class ExchangedAfterwards(System):
    """The same scheme, exchanging at the end of a step: rows are read with the new inputs set."""

    def initialize(self):
        super().initialize()
        self.exchange()

    def step(self, time, size):
        for component in self.components.values():
            component.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        self.exchange()


def fmpy(path, step, count, signals):
    """FMPy 0.3.32.

    Its first exchange comes after the first step, which is taken with zero inputs: nothing else
    where everything starts at rest with zero. Parameter bindings are not applied. Only what the system declares as
    connectors is recorded. A row bears the time at which its step began; the clock is added up, which may make
    for one step more than was asked for.
    """
    from fmpy.ssp.simulation import simulate_ssp

    # Half a step less: the number of steps is then certain.
    result = simulate_ssp(str(path), stop_time=(count - 0.5) * step, step_size=step)
    assert len(result) == count, len(result)
    # Rows of the ends of the steps, after a row for the start that is never used.
    declared = [name for name in signals if name in result.dtype.names]
    columns = {name: np.concatenate([[np.nan], result[name]]) for name in declared}
    return {"time": np.concatenate([[0.0], result["time"] + step])} | columns


def libcosimpy(path, step, count, signals):
    """libcosimpy 0.0.6.

    It exchanges at the end of a step, but what is set takes effect with the next, so rows are read with the
    old inputs. The step is the one that the system's annotation gives. It does not know enumerations: such
    parameters keep their start values.
    """
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_ssp_file(str(path))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    slaves = {}
    for name in dict.fromkeys(signal.split(".", 1)[0] for signal in signals):
        index = execution.slave_index_from_instance_name(name)
        references = {v.name.decode(): v.reference for v in execution.slave_variables(index)}
        wanted = [signal for signal in signals if signal.startswith(f"{name}.")]
        slaves[index] = wanted, [references[signal.split(".", 1)[1]] for signal in wanted]

    def take():
        for index, (wanted, references) in slaves.items():
            for signal, value in zip(wanted, observer.last_real_values(index, references)):
                columns[signal].append(value)
        columns["time"].append(execution.status().current_time * 1e-9)

    # The last-value observer has nothing before the first step.
    columns = {"time": [0.0]} | {signal: [np.nan] for signal in signals}
    for _ in range(count):
        assert execution.step(), "a step failed"
        take()
    return {name: np.array(values) for name, values in columns.items()}


def ecos(path, step, count, signals):
    """ecospy 0.7.2.

    After a step it exchanges, sets the inputs and reads once more: outputs with feed-through show the new inputs.
    What it passes on is what it has read before. Its clock is added up. It applies parameter sets if told their name.
    """
    from ecospy import EcosSimulation

    columns = {name: [] for name in ("time", *signals)}
    with EcosSimulation(step, ssp_path=str(path)) as simulation:
        simulation.init(parameter_set="defaults")
        for index in range(count + 1):
            if index:
                simulation.step()
            columns["time"].append(simulation.get_time())
            for name in signals:
                columns[name].append(simulation.get_real(name.replace(".", "::", 1)))
        simulation.terminate()
    return {name: np.array(values) for name, values in columns.items()}


MASTERS = {"fmpy": (fmpy, System), "libcosimpy": (libcosimpy, System), "ecos": (ecos, ExchangedAfterwards)}


def main():
    name, system, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    master, scheme = MASTERS[name]
    reference = Reference(system)
    # One step more than the reference: it shows the force of the last tick.
    count = round(reference.stop / reference.step) + 1

    def own(step):
        with compose(system, folder, scheme) as composed:
            result = composed.run(count * reference.step, step, reference.signals)
        return reference.at_rows(result, step)

    result = master(folder / f"{system}.ssp", reference.step, count, reference.signals)
    found = reference.at_rows(result, reference.step)
    same, half = own(reference.step), own(reference.step / 2)
    print(f"{name}, {system}, steps of {1e3 * reference.step:g} ms; relative to each signal's scale")
    print(f"{'signal':<28}{'error':>10}{'estimate':>10}{'from the same scheme':>22}")
    failures = []
    for signal in found:
        error = reference.scaled(signal, found[signal] - reference.values[signal])
        estimate = 2 * reference.scaled(signal, same[signal] - half[signal])
        apart = reference.scaled(signal, found[signal] - same[signal])
        print(f"{signal:<28}{error:>10.1e}{estimate:>10.1e}{apart:>22.1e}")
        if not (error <= MARGIN * estimate + AGREEMENT and apart <= AGREEMENT):
            failures.append(signal)
    assert not failures, f"not within the coupling error or not this scheme: {failures}"


if __name__ == "__main__":
    main()
