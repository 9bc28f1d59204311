"""The end of a process in which FMUs of PythonFMU 0.7.0 have been."""

import os
import sys


def leave():
    """Ends the process, all being done, without the destructors of what it has loaded.

    Those of PythonFMU's libraries give back for a second time what the process's end has freed
    (`finalizePythonInterpreter`): now and then it aborts, with "corrupted double-linked list".
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(0)
