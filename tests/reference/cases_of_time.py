"""Functions of time: roads and sources."""


def times(name, fmu, changed, settings, stop, rows):
    """A function of time, at times that are communication points."""
    return {"case": name, "kind": "times", "fmu": fmu, "package": fmu, "changed": changed, "settings": settings,
            "stop": stop, "rows": rows, "error": 1e-11}


def road(name, kind, changed, stop, rows, **settings):
    return times(f"road-{name}", "Road", changed, {"kind": kind} | settings, stop, rows)


ROADS = [
    road("sine", "Sine", {"amplitude": 0.005, "frequency": 1.7, "start_time": 0.25}, 3.0, 60),
    road("square", "Square", {"amplitude": 0.01, "frequency": 0.3, "edge_time": 0.02}, 6.0, 90),
    road("step", "Step", {"step.height": 0.1, "edge_time": 0.05, "start_time": 0.5}, 1.5, 60),
    road("chirp", "Chirp", {"amplitude": 0.0015, "chirp.start_frequency": 1.0, "chirp.end_frequency": 8.0,
                            "chirp.duration": 25.0}, 30.0, 120),
    road("frequency-ramp", "FrequencyRamp", {"amplitude": 0.0025, "ramp.rate": 0.1}, 40.0, 120),
    road("bump", "Bump", {"bump.height": 0.08, "bump.length": 1.2, "speed": 5.0, "start_time": 0.5}, 1.5, 60),
    road("iso8608", "Iso8608", {"speed": 10.0, "start_time": 0.5}, 20.0, 150, iso_class="D", seed=1),
    road("iso8608-class-a", "Iso8608", {"speed": 25.0}, 10.0, 60, iso_class="A", seed=20260101),
    times("four-wheel-road", "FourWheelRoad",
          {"profile.speed": 14.0, "profile.start_time": 0.3, "wheelbase": 2.9},
          {"kind": "Iso8608", "iso_class": "C", "seed": -7, "same_track": False}, 8.0, 60),
]


def source(name, fmu, shape, stop, changed):
    return times(name, fmu, {"start_time": 0.35, "offset": -0.5} | changed, {"shape": shape}, stop, 60)


LEVELS = [0.5, 1.5, 1.0, 2.5, 2.0, 4.0, 3.5, 6.0, 5.5, 3.0, 1.25, 0.75]

SOURCES = [
    source("voltage-source-constant", "VoltageSource", "Constant", 1.0, {}),
    source("voltage-source-step", "VoltageSource", "Step", 1.0, {"amplitude": -4.0, "edge_time": 0.05}),
    source("voltage-source-sine", "VoltageSource", "Sine", 3.0, {"amplitude": 2.5, "swing_frequency": 1.9}),
    source("voltage-source-square", "VoltageSource", "Square", 3.0,
           {"amplitude": 1.5, "swing_frequency": 1.3, "edge_time": 0.0}),
    # Konieczny 3.1: 0.063 to 40 Hz in 40 s, of 3 V.
    source("voltage-source-chirp", "VoltageSource", "Chirp", 44.0,
           {"amplitude": 3.0, "chirp.start_frequency": 0.063, "chirp.end_frequency": 40.0, "chirp.duration": 40.0}),
    # Kogut 3.2.2: 0.1 Hz a second.
    source("frequency-source-ramp", "FrequencySource", "Ramp", 30.0, {"ramp.rate": 0.1, "ramp.duration": 25.0}),
    source("frequency-source-stairs", "FrequencySource", "Stairs", 14.0,
           {"stairs.duration": 1.0} | {f"stairs.level[{k}]": level for k, level in enumerate(LEVELS, 1)}),
]

CASES = ROADS + SOURCES
