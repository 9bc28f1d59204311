"""The matrix as a page."""

from collections import Counter

HEAD = """\
# Every FMU in every master

Made by

```
scripts/long-tests masters
```

which builds the FMUs, makes the Python environments and installs fmi-sim from crates.io; the runs themselves took {minutes}
on two busy cores. `cargo test` runs a part of it: every FMU of FMI 2.0 in FMPy, libcosimpy and ecos; some of each kind, of
both versions, and three systems in fmutool and fmucontainer, too. `tests/masters/matrix.py --help` tells how to run it on FMUs of your own.

**The reference** is our own master (`examples/jacobi.py`), which calls the bare functions of FMI through FMPy's bindings.
Where a master exchanges values at other instants, the same scheme is written down in a few lines (`matrix_jobs.py`,
`connected.py`), so that a difference is an error and not a taste. What the FMUs do is right by other tests: each follows an
independent scipy solution (`tests/reference`).

**A number** is the largest difference of any output in 200 steps of 1 ms (1000 for systems and for what only time moves),
relative to the output's largest value; an FMU by itself has its inputs held at values at which every effect works.

**Tolerance: 1e-9.** Only where kinks and roots are at work it is 1e-7, for ExcitationMotor (dead zone, friction, limits) and
KoniecznyLoadedServoHydraulicActuator (orifices), and 1e-5 for tum-rig, which has that exciter in it: masters add up their
clocks in different ways, and one rounding apart the error control goes in other steps, which it may within its own
tolerance of 1e-7. With that at 1e-11 the masters of both FMUs agree to 2e-12.

✓ is a check without complaints.

| master | version | what it runs | how it exchanges |
|---|---|---|---|
| FMPy | {FMPy} | FMUs; `.ssp` (reads no SSV) | all at once; zeros in the first step |
| libcosimpy | {libcosimpy} | FMUs; `.ssp`; OSP's own format, also with ecco ([below](#ecco)) | all at once |
| ecos | {ecos} (ecospy) | FMUs; `.ssp` | all at once, outputs read again with the new inputs |
| fmutool | {fmutool} | `fmutool -check`: the description by schema and semantics | – |
| fmucontainer | {fmucontainer} | one FMU of a whole `.ssp` (reads no SSV), then in FMPy | all at once |
| cofmupy | {cofmupy} | FMUs and systems by a JSON of its own | loops all at once, what follows from them in turn |
| fmi-sim | {fmi-sim} | FMUs | – |
| fmi (crate) | {fmi (crate)} | `examples/rust-master` | all at once |
"""

NOTES = """\

{summary}

## What masters pass over

| | evidence |
|---|---|
| FMPy and fmucontainer read no start values of a system (`.ssv`). What our systems give there the FMUs have built in, so it is the same system | `connected_parameters.py` shows which masters read them; fmucontainer's `assembly.py` takes components and connections only |
| libcosimpy knows no enumerations: such a start value is not set | its start values are kept |
| fmi (crate) and fmi-sim read no FMU of FMI 3.0 with units or nominal values: they get the FMU without them | fmi-schema 0.8.0: `unknown field "unit" in element "FmiFloat64"` |
| cofmupy, fmi (our example) set numbers of type Real only | `wrappers.py`: `setReal` |
| FMPy ignores factors of connections | `connected_gains.py`; [what to do](../../examples/third-party/README.md) |

## Not run

| master | why | what was done instead |
|---|---|---|
| Simulink, Dymola, CarMaker | licences | [what to click](../../docs/importers.md), from their documents |

## OMSimulator

It is in no registry: PyPI's `OMSimulator` (3.0.0) is a script that downloads binaries from elsewhere when it is installed. Where
a program is, `STRUT_OMSIMULATOR=/path/to/OMSimulator cargo test --test whole masters` runs it with the others. It was last run
in November 2026, as its sources of December 2025 build it (3.0.0.post120): **17 of 17 systems**, by the command line that
[the page for users](../../docs/importers.md) gives.

| what | largest difference of 1000 steps |
|---|--:|
| 14 systems | 5e−12 |
| tum-rig | 8e−11 |
| sas | 2e−10 |
| tum-active | 3e−10 |

Before a step it passes on at once what passes through a component: its inputs all belong to one instant. It gives every
component one tolerance, here 1e-10. `matrix_jobs.py` has the same scheme (`InDependencyOrder`). The systems of
[third-party](../../examples/third-party/README.md) run too, with their adapters; FMUs of PythonFMU load in it only where
Python's own library is loaded before (`LD_PRELOAD`).

Until March 2026 it refused a system with `-` in a name; in the SSD, names have `_` instead. It refuses a connection between
units of other base units, so adapters declare the units of both of their ends.

## fmusim

The tool of the Reference FMUs is in no registry. Where a program is, `STRUT_FMUSIM=/path/to/fmusim` has `cargo test --test whole masters`
and `scripts/long-tests masters` run it with the others. It validates every FMU and runs it in co-simulation, both versions of FMI;
its column is in the tables where it was there. It was built by `cargo build --release` from modelica's repository fmusim (0.8.0 of
August 2026, with CATIA-Systems' fmi-rs as its submodule); its build scripts download SUNDIALS and libxml2.

Model exchange of FMI 3.0 does not start in 0.8.0, with any FMU: `instantiateModelExchange` (`fmi-rs/src/fmi3/mod.rs`) looks at the
instance that it has not stored yet, and reports "FMI call failed". That of FMI 2.0 runs.

## PyFMI

No registry has it built: PyPI's `PyFMI` (2.5) is source code of 2018. Where a Python has it,
`STRUT_PYFMI=/path/to/python cargo test --test whole masters` runs it with the others, and so do `scripts/long-tests masters`
and `scripts/long-tests model-exchange`. It was last run in November 2026: PyFMI 2.21.0 with FMI Library 3.0.4, Assimulo 3.8.0 and
SUNDIALS 6.4.1. Everything that it loads agrees.

| what | FMI | runs | largest difference |
|---|---|--:|--:|
| FMUs in co-simulation, by `simulate` | 2.0 | 85 | 0 |
| systems, by `Master` | 2.0 | 17 | 0 |
| FMUs in model exchange with [moving inputs](model-exchange.md), by `simulate` with CVode at 1e-8 | 2.0 | 60 | 1e−5 |
| the same | 3.0 | 60 | 1e−5 |
| start values before initialization: `load_fmu(…).get("sprung_mass")` | both | 6254 values | 0 |
| `get_directional_derivative`, against differences | both | 1470 functions | 1e−6 |

The 1e−5 is TumExcitationMotor's; all others are within 3e−6. The last two rows are by `pyfmi_checks.py`, which also compares the
matrices of `get_state_space_representation`.

`Master` exchanges at the end of a step. Before the first step it solves for the values of continuous connections, and passes the others
on once: a chain of sampled parts fills tick by tick. It gives every component one tolerance (`local_rtol`), here 1e-10.
`matrix_jobs.py` has the same scheme (`ContinuousFirst`).

| limit of PyFMI 2.21.0 | what to do | evidence |
|---|---|---|
| no co-simulation of FMI 3.0, and so no `Master` | FMI 2.0 | `fmi3.pyx`: "Import of FMI3 Co-Simulation FMUs is not yet supported." |
| no arrays of FMI 3.0, which 35 FMUs have: `simulate` fails where it records all | record others only: `options["filter"] = ["body.*"]` | `fmi3.pyx`: "Array variables are not yet supported" |
| with direct feed-through in a system, `Master` says "matmul: dimension mismatch" if no continuous output or input of the last model is connected, for instance of a controller | give the rig last | `Master.compute_global_D` makes a matrix without its shape |
| the warning "No dependency information for the outputs" for sources and sampled parts | nothing: the results are the same | FMI Library takes `dependencies=""`, which is none, for no information |

This built it on Debian 12 with Python 3.11, from modelon-community's repositories fmi-library (tag 3.0.4), Assimulo (Assimulo-3.8.0) and
PyFMI (PyFMI-2.21.0), in five minutes each on a busy core:

```
apt-get install cmake gfortran libsundials-dev libblas-dev liblapack-dev
python3 -m venv venv && . venv/bin/activate
pip install setuptools==69.1.0 wheel Cython==3.3.1 numpy==2.4.6 scipy==1.17.1 matplotlib==3.11.2
cmake -S fmi-library -B fmil-build -DCMAKE_INSTALL_PREFIX=$PWD/fmil -DCMAKE_BUILD_TYPE=Release -DFMILIB_BUILD_TESTS=OFF
cmake --build fmil-build --target install
libraries=$(dirname $(cc -print-file-name=libblas.so)) fmil=$PWD/fmil
(cd Assimulo && python setup.py install --sundials-home=/usr --blas-home=$libraries --lapack-home=$libraries)
(cd PyFMI && python setup.py install --fmil-home=$fmil)
```

## ecco

libcosim's ecco changes its step by the power that is lost across a coupling. `connected_ecco.py` gives it systems in OSP's
format, with force and velocity of the actuator as a power bond, and compares them with the monolithic references. Its error
must not exceed the fixed step's by more than a tenth:

{ecco}
"""


def cell(value):
    if value == 0.0:
        return "0"
    return f"{value:.0e}".replace("e-0", "e−").replace("e-", "e−")


def page(path, table, masters, minutes, ecco):
    """Writes the page."""
    names = [master.name for master in masters]
    text = HEAD.format(minutes=minutes, **{master.name: master.version for master in masters})
    counts = Counter()
    for kind, title in (("fmu", "Single FMUs"), ("fmi3", "Single FMUs of FMI 3.0"), ("ssp", "Systems")):
        used = [name for name in names if any(row[name] != "one" for (k, _), row in table.items() if k == kind)]
        text += f"\n## {title}\n\n| | " + " | ".join(used) + " |\n|---|" + "--:|" * len(used) + "\n"
        for (row_kind, name), row in sorted(table.items()):
            if row_kind == kind:
                checked = {master: "✓" if master == "fmutool" and row[master] == 0.0 else cell(row[master]) for master in used}
                text += f"| {name} | " + " | ".join(checked[master] for master in used) + " |\n"
                counts[kind] += sum(isinstance(row[master], float) for master in used)
    summary = (
        f"{counts['fmu']} runs of single FMUs, {counts['fmi3']} of FMUs of FMI 3.0 and {counts['ssp']} of systems, all "
        "within the tolerance."
    )
    path.write_text(text + NOTES.format(summary=summary, ecco=ecco), encoding="utf-8")
