"""Checks of every FMU through FMPy. One function, one claim; run by the Rust tests.

    python fmpy_checks.py CHECK FOLDER
"""

import sys
import threading

import numpy as np
from fmpy import read_model_description
from fmpy.fmi2 import FMU2Model
from fmpy.validation import validate_fmu
from lxml import etree
from rig import STEP, Messages, all_fmus
from scipy.integrate import solve_ivp


# What an adapter or a recorded signal passes on may be in any unit; only the parameter set of one in a system tells which.
ANY_UNIT = {
    "SignalAdapter": {"input", "added", "output", "factor", "offset", "initial"},
    "RecordedSource": {"signal"},
}


def validate(fmu):
    """No problem found by FMPy (with the XSD), none by our own rules."""
    problems = validate_fmu(str(fmu.path))
    assert not problems, problems
    read_model_description(str(fmu.path), validate=True)
    root = etree.parse(f"{fmu.folder}/modelDescription.xml").getroot()
    variables = root.findall("ModelVariables/ScalarVariable")
    references = {}
    for variable in variables:
        kind = variable[0].tag.replace("Enumeration", "Integer")
        key = (kind, variable.get("valueReference"))
        assert key not in references, f"{variable.get('name')} shares a reference with {references[key]}"
        references[key] = variable.get("name")
        assert variable.get("description"), f"{variable.get('name')} has no description"
        if kind == "Real" and variable.get("name") not in ANY_UNIT.get(fmu.path.stem, ()):
            assert variable[0].get("unit"), f"{variable.get('name')} has no unit"
    used = {v[0].get("unit") for v in variables if v[0].get("unit")}
    declared = {u.get("name") for u in root.findall("UnitDefinitions/Unit")}
    assert used == declared, (used, declared)
    unknowns = [int(u.get("index")) for u in root.findall("ModelStructure/InitialUnknowns/Unknown")]
    expected = [
        index
        for index, v in enumerate(variables, 1)
        if (v.get("causality") in ("output",) and v.get("initial") != "exact")
        or v.get("causality") == "calculatedParameter"
        or v[0].get("derivative")
    ]
    assert unknowns == expected, (unknowns, expected)
    for unknown in root.findall("ModelStructure/*/Unknown"):
        assert unknown.get("dependencies") is not None, "unknown dependencies mean: on everything"


def starts(fmu):
    """Every start value of the description is what the instance holds."""
    instance = fmu.instantiate()
    try:
        instance.setupExperiment(startTime=0.0)
        instance.enterInitializationMode()
        for variable in fmu.description.modelVariables:
            if variable.start is None:
                continue
            reference = [variable.valueReference]
            if variable.type == "Real":
                assert instance.getReal(reference)[0] == float(variable.start), variable.name
            elif variable.type in ("Integer", "Enumeration"):
                assert instance.getInteger(reference)[0] == int(variable.start), variable.name
            elif variable.type == "Boolean":
                assert instance.getBoolean(reference)[0] == (variable.start in ("true", "1")), variable.name
            else:
                assert instance.getString(reference)[0].decode() == variable.start, variable.name
    finally:
        instance.freeInstance()


def rewind(fmu):
    """A saved state, restored or sent to another instance as bytes, continues bit for bit."""
    with fmu.running() as instance:
        fmu.run(instance, 0, 137)
        state = instance.getFMUState()
        blob = instance.serializeFMUState(state)
        onward = fmu.run(instance, 137, 250)
        instance.setFMUState(state)
        again = fmu.run(instance, 137, 250)
        assert onward.tobytes() == again.tobytes()
        instance.freeFMUState(state)
        with fmu.running(name="other") as other:
            fmu.run(other, 0, 20)
            received = other.deSerializeFMUstate(blob)
            other.setFMUState(received)
            elsewhere = fmu.run(other, 137, 250)
            other.freeFMUState(received)
        assert onward.tobytes() == elsewhere.tobytes()


def reset(fmu):
    """After a reset an instance is as fresh as a new one."""
    with fmu.running() as fresh:
        expected = fmu.run(fresh, 0, 200)
    instance = fmu.instantiate()
    try:
        for variable in fmu.real:
            if variable.causality == "parameter" and variable.variability == "tunable" and variable.min is None:
                instance.setReal([variable.valueReference], [1.01 * float(variable.start)])
        fmu.initialize(instance)
        fmu.run(instance, 0, 77)
        instance.reset()
        fmu.initialize(instance)
        assert fmu.run(instance, 0, 200).tobytes() == expected.tobytes()
    finally:
        instance.freeInstance()


def variable_step(fmu):
    """Uneven communication steps lead to the same states, the inputs being the same in between."""
    if not fmu.states or any(v.causality == "parameter" and v.name == "period" for v in fmu.real):
        return
    assert fmu.description.coSimulation.canHandleVariableCommunicationStepSize
    references = [v.valueReference for v in fmu.states]
    results = []
    for pieces in ([1], [0.13, 0.5, 0.37]):
        with fmu.running() as instance:
            for index in range(300):
                fmu.excite(instance, index * STEP)
                time = index * STEP
                for piece in pieces:
                    instance.doStep(currentCommunicationPoint=time, communicationStepSize=piece * STEP)
                    time += piece * STEP
            results.append(np.array(instance.getReal(references)))
    np.testing.assert_allclose(results[1], results[0], rtol=1e-5, atol=1e-9)


def input_derivatives(fmu):
    """With exact derivatives of its inputs a coarse step is as good as many fine ones."""
    if not fmu.states or not fmu.inputs:
        return
    assert fmu.description.coSimulation.canInterpolateInputs
    references = [v.valueReference for v in fmu.inputs]
    slopes = [0.3 * (value - middle) for value, middle in zip(fmu.excitation(0.01), fmu.middle)]
    states = [v.valueReference for v in fmu.states]
    # An input that is rounded to steps has no slope to follow; an estimate of the load foresees inputs that are held.
    start = {name: value for name, value in (("pwm.bits", 0), ("load.mass", 0.0)) if name in fmu.variables}
    with fmu.running(start=start) as coarse, fmu.running(start=start, name="fine") as fine:
        coarse.setRealInputDerivatives(references, [1] * len(references), slopes)
        coarse.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.05)
        pieces = 5000
        for index in range(pieces):
            time = (index + 0.5) * 0.05 / pieces
            fine.setReal(references, [middle + slope * time for middle, slope in zip(fmu.middle, slopes)])
            fine.doStep(currentCommunicationPoint=index * 0.05 / pieces, communicationStepSize=0.05 / pieces)
        a, b = np.array(coarse.getReal(states)), np.array(fine.getReal(states))
        # The fine steps hold their inputs: second order in the step.
        np.testing.assert_allclose(a, b, rtol=1e-5, atol=1e-5 * np.abs(b).max())
        held = fmu.instantiate(name="held")
        fmu.initialize(held, start)
        moved = np.abs(b - np.array(held.getReal(states))).max()
        held.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.05)
        # Nothing moves at all where an input is at its limit already.
        assert not moved or np.abs(np.array(held.getReal(states)) - b).max() > 1e-3 * moved, "the derivatives do nothing"
        held.freeInstance()


def output_derivatives(fmu):
    """The outputs' time derivatives are the limit of their difference quotients."""
    if not fmu.states:
        return
    assert fmu.description.coSimulation.maxOutputDerivativeOrder == 1
    references = [v.valueReference for v in fmu.outputs]
    with fmu.running(tolerance=1e-11) as instance:
        fmu.run(instance, 0, 211)
        time, size = 211 * STEP, 1e-7
        # Past the tick that may be due: where an output jumps it has no slope.
        instance.doStep(currentCommunicationPoint=time, communicationStepSize=0.1 * STEP)
        time += 0.1 * STEP
        before = np.array(instance.getReal(references))
        slopes = np.array(instance.getRealOutputDerivatives(references, [1] * len(references)))
        instance.doStep(currentCommunicationPoint=time, communicationStepSize=size)
        after = np.array(instance.getReal(references))
        # The quotient has the rounding of its outputs in it.
        floor = 1e-4 * np.abs(slopes).max() + 1e-15 / size * np.abs(before).max()
        np.testing.assert_allclose((after - before) / size, slopes, rtol=2e-3, atol=floor)


def directional(fmu):
    """Directional derivatives are the slopes of the outputs and rates, for every known and unknown."""
    assert fmu.description.coSimulation.providesDirectionalDerivative
    knowns = [v.valueReference for v in fmu.inputs + fmu.states]
    unknowns = [v.valueReference for v in fmu.outputs + fmu.rates]
    if not knowns:
        return
    with fmu.running(FMU2Model) as instance:
        events(instance)
        instance.enterContinuousTimeMode()
        instance.setTime(0.0123)
        nominals = [float(state.nominal or 1.0) for state in fmu.states]
        states = [0.03 * (1 + i) * nominal for i, nominal in enumerate(nominals)]
        values = np.array(fmu.excitation(0.0123) + states)
        scales = np.abs(fmu.excitation(0.0123) + nominals)

        def evaluate(values):
            if fmu.inputs:
                instance.setReal([v.valueReference for v in fmu.inputs], values[: len(fmu.inputs)])
            set_states(instance, values[len(fmu.inputs) :])
            return np.array(instance.getReal(unknowns))

        for column, known in enumerate(knowns):
            size = 1e-5 * max(1e-3, scales[column])
            up, down = values.copy(), values.copy()
            up[column] += size
            down[column] -= size
            slope = (evaluate(up) - evaluate(down)) / (2 * size)
            evaluate(values)
            exact = np.array(instance.getDirectionalDerivative(unknowns, [known], [1.0]))
            scale = np.abs(exact).max() + 1e-9
            np.testing.assert_allclose(exact, slope, rtol=1e-4, atol=1e-5 * scale, err_msg=fmu.name)
            declared = dependencies(fmu, known)
            for unknown, derivative in zip(unknowns, exact):
                assert derivative == 0.0 or unknown in declared, f"undeclared dependency of {unknown} on {known}"


def dependencies(fmu, known):
    """References of the outputs and derivatives that depend on a known according to the description."""
    return {
        unknown.variable.valueReference
        for unknown in fmu.description.outputs + fmu.description.derivatives
        if any(v.valueReference == known for v in unknown.dependencies)
    }


def set_states(instance, values):
    if len(values):
        array = (instance_double(len(values)))(*values)
        instance.setContinuousStates(array, len(values))


def instance_double(count):
    from ctypes import c_double

    return c_double * count


def model_exchange(fmu):
    """An outside integrator on the model-exchange side and the inside one come to the same."""
    count = 250
    with fmu.running(tolerance=1e-9) as slave:
        expected = fmu.run(slave, 0, count)
    n = len(fmu.states)
    rows = []
    with fmu.running(FMU2Model) as model:
        double = instance_double(max(n, 1))
        # The first tick is due at the start, with the inputs that are set then.
        fmu.excite(model, 0.0)
        next_event = events(model)
        model.enterContinuousTimeMode()
        x = np.zeros(n)
        if n:
            buffer = double()
            model.getContinuousStates(buffer, n)
            x = np.array(buffer[:n])

        def rates(t, x):
            model.setTime(t)
            set_states(model, x)
            buffer = double()
            model.getDerivatives(buffer, n)
            return np.array(buffer[:n])

        for index in range(count):
            time, end = index * STEP, (index + 1) * STEP
            model.setTime(time)
            set_states(model, x)
            fmu.excite(model, time)
            if next_event is not None and next_event <= time + 1e-9:
                model.enterEventMode()
                next_event = events(model)
                model.enterContinuousTimeMode()
            if n:
                x = solve_ivp(rates, (time, end), x, method="DOP853", rtol=1e-11, atol=1e-14).y[:, -1]
            model.setTime(end)
            set_states(model, x)
            model.completedIntegratorStep()
            rows.append(fmu.read(model))
    rows = np.array(rows)
    scale = np.abs(expected).max(axis=0) + 1e-12
    assert np.abs((rows - expected) / scale).max() < 1e-6, np.abs((rows - expected) / scale).max(axis=0)


def events(model):
    """Makes the discrete states new until they stay; the time of the next event."""
    while True:
        again, terminate, _, _, defined, time = model.newDiscreteStates()
        assert not terminate
        if not again:
            return time if defined else None


def threads(fmu):
    """Instances in threads do not know of each other."""
    with fmu.running() as alone:
        expected = fmu.run(alone, 0, 100).tobytes()
    # FMPy changes the working directory while it loads, so it loads here.
    instances = [fmu.instantiate(name=f"instance {place}") for place in range(8)]
    results = [None] * len(instances)

    def work(place):
        fmu.initialize(instances[place])
        results[place] = fmu.run(instances[place], 0, 100).tobytes()
        instances[place].terminate()

    workers = [threading.Thread(target=work, args=(place,)) for place in range(len(instances))]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    for instance in instances:
        instance.freeInstance()
    assert all(result == expected for result in results)


def bad_input(fmu):
    """What is wrong is refused with the right status and a message; the instance goes on."""
    messages = Messages()
    with fmu.running(callbacks=messages.callbacks(), loggingOn=True) as instance:
        def refused(part, call, *arguments):
            del messages[:]
            try:
                call(*arguments)
            except Exception:
                assert any(part in message for *_, message in messages), (part, messages)
            else:
                raise AssertionError(f"not refused: {call.__name__}{arguments}")

        refused("999999", instance.getReal, [999999])
        refused("999999", instance.setReal, [999999], [0.0])
        for size in (-1e-3, 0.0, float("nan"), float("inf")):
            refused("step", lambda: instance.doStep(currentCommunicationPoint=0.0, communicationStepSize=size))
        refused("communication point", lambda: instance.doStep(currentCommunicationPoint=3.0, communicationStepSize=STEP))
        refused("output", instance.setReal, [fmu.outputs[0].valueReference], [1.0])
        for value in (float("nan"), float("inf")):
            if fmu.inputs:
                refused(fmu.inputs[0].name, instance.setReal, [fmu.inputs[0].valueReference], [value])
        refused("", instance.exitInitializationMode)
        with fmu.running() as fresh:
            assert fmu.run(fresh, 0, 50).tobytes() == fmu.run(instance, 0, 50).tobytes()


def no_resources(fmu):
    """A null resource location is no obstacle; a wrong GUID is one, and is explained."""
    messages = Messages()

    def instantiate(guid, location):
        instance = fmu.unborn()
        instance.component = instance.fmi2Instantiate(
            b"instance", 1, guid.encode(), location, messages.callbacks(), 0, 1
        )
        return instance

    with fmu.running() as usual:
        expected = fmu.run(usual, 0, 20).tobytes()
    for location in (None, b""):
        instance = instantiate(fmu.description.guid, location)
        assert instance.component, messages
        fmu.initialize(instance)
        assert fmu.run(instance, 0, 20).tobytes() == expected
        instance.freeInstance()
    assert not instantiate("{00000000-0000-0000-0000-000000000000}", None).component
    assert any("GUID" in message for *_, message in messages), messages


CHECKS = [
    validate, starts, rewind, reset, variable_step, input_derivatives, output_derivatives, directional,
    model_exchange, threads, bad_input, no_resources,
]  # fmt: skip


def main():
    check = {check.__name__: check for check in CHECKS}[sys.argv[1]]
    for fmu in all_fmus(sys.argv[2]):
        try:
            check(fmu)
        except Exception as error:
            raise AssertionError(f"{fmu.name}: {check.__doc__}") from error
        finally:
            fmu.close()
        print(f"{check.__name__}: {fmu.name}")


if __name__ == "__main__":
    main()
