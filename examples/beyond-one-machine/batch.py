"""Many independent pieces of work on Dask, so that nothing is lost.

Every result is a row. Rows are written in parts, a Parquet file each, as soon as a part is complete; what was interrupted
goes on where it stopped. A worker that dies loses the parts that it had in hand, which others then do; a piece of work that
fails, or kills its worker again and again, is a row with its error.
"""

import json
import os
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import cloudpickle
import dask
import pyarrow as pa
import pyarrow.parquet as pq
from distributed import Client, LocalCluster

# Workers need not have this project's files: what is in them goes along with the work.
cloudpickle.register_pickle_by_value(sys.modules[__name__])

# Workers that may die of one and the same part before it is suspected itself.
DEATHS = 2

# How long a worker of this machine's cluster may take to start again. Dask gives it up after 15 s, which a busy machine may
# need, starts no other in its place, and a batch that has lost all its workers would wait for ever.
RESTART = "1 hour"

# Seconds after which a result that does not come, with nobody at work on it, counts as lost.
PATIENCE = 30


@contextmanager
def client(scheduler=None, workers=None):
    """A client of the scheduler at an address, or of a cluster on this machine: processes with one thread each, as an FMU's
    instance is used by one thread at a time."""
    settings = {"distributed.scheduler.allowed-failures": DEATHS, "distributed.deploy.lost-worker-timeout": RESTART}
    with dask.config.set(settings):
        if scheduler:
            with Client(scheduler) as connected:
                yield connected
        else:
            cluster = LocalCluster(
                n_workers=workers or os.cpu_count(), threads_per_worker=1, dashboard_address=None, silence_logs="CRITICAL"
            )
            with cluster, Client(cluster) as connected:
                yield connected


class Batch:
    """A folder of results and what they are results of."""

    def __init__(self, out, plan, count, part):
        """`plan` says what is computed, in plain values: results of another plan are not mixed in."""
        self.out, self.count, self.part = Path(out), count, part
        self.out.mkdir(parents=True, exist_ok=True)
        plan = json.loads(json.dumps({**plan, "count": count, "part": part}))
        path = self.out / "plan.json"
        if path.exists() and (other := json.loads(path.read_text())) != plan:
            differs = sorted(key for key in plan.keys() | other.keys() if plan.get(key) != other.get(key))
            sys.exit(f"{self.out} holds results of another batch ({', '.join(differs)} differ): choose another --out")
        write(path, lambda temporary: temporary.write_text(json.dumps(plan, indent=1)))

    def path(self, number):
        return self.out / f"part-{number:05}.parquet"

    def missing(self):
        """Numbers of the parts that are not there yet."""
        return [number for number in range(-(-self.count // self.part)) if not self.path(number).exists()]

    def indices(self, number):
        return range(number * self.part, min((number + 1) * self.part, self.count))

    def table(self):
        """All rows."""
        return pa.concat_tables([pq.read_table(path) for path in sorted(self.out.glob("part-*.parquet"))])

    def run(self, connected, work, task, schema, done=lambda number: None):
        """Does what is missing: `work(task(index))` is a row without its index and error. Returns the number of rows with an
        error. `done` is called after each part."""
        schema = pa.schema([("index", pa.int64()), *schema, ("error", pa.string())])
        missing = self.missing()
        progress = Progress(self.count, self.count - sum(len(self.indices(number)) for number in missing))

        def submit(part):
            tasks = [(index, task(index)) for index in part[1]]
            return connected.submit(rows, work, tasks, pure=False)

        waiting = {submit(part): part for part in ((number, self.indices(number)) for number in missing)}
        suspects = []
        parts = {number: [] for number in missing}
        for future, alone in self.completed(connected, waiting, suspects, submit):
            number, indices = waiting.pop(future)
            try:
                parts[number] += future.result(timeout=PATIENCE)
            except TimeoutError:
                # It was lost with its worker before it was fetched.
                waiting[submit((number, indices))] = (number, indices)
            except Exception as error:
                if alone:
                    parts[number].append({"index": indices[0], "error": sentence(error)})
                else:
                    # It, or what waited beside it for the same workers, kills them: each piece by itself shows which.
                    suspects += [(number, [index]) for index in indices]
            future.release()
            if len(parts[number]) == len(self.indices(number)):
                complete = sorted(parts.pop(number), key=lambda row: row["index"])
                table = pa.Table.from_pylist(complete, schema=schema)
                write(self.path(number), lambda temporary, table=table: pq.write_table(table, temporary))
                progress.add(complete)
                done(number)
        progress.end()
        return sum(error is not None for error in self.table()["error"].to_pylist())

    @staticmethod
    def completed(connected, waiting, suspects, submit):
        """The futures as they end, and whether it was a suspect's: suspects come last, and one after the other, as Dask blames
        the death of a worker on all that waits for it.

        Dask may lose a future for ever if workers die in quick succession: where nothing has ended for a while and no worker
        has anything to do, what is waited for is submitted again."""
        last, alone = time.monotonic(), False
        while waiting or suspects:
            if not waiting:
                alone, suspect = True, suspects.pop(0)
                waiting[submit(suspect)] = suspect
            ended = next((future for future in waiting if future.done()), None)
            if ended is not None:
                yield ended, alone
                last = time.monotonic()
            elif time.monotonic() - last < PATIENCE:
                time.sleep(0.02)
            else:
                last = time.monotonic()
                if connected.scheduler_info()["workers"] and not any(connected.processing().values()):
                    for future, part in list(waiting.items()):
                        del waiting[future]
                        future.cancel()
                        waiting[submit(part)] = part


def rows(work, tasks):
    """On a worker: the rows of a part. Work that knows more of its failure than the message gives a row with an error itself."""
    result = []
    for index, task in tasks:
        try:
            result.append({"index": index, "error": None, **work(task)})
        except Exception as error:  # whatever it is, it is this row's and nobody else's
            result.append({"index": index, "error": sentence(error)})
    return result


def sentence(error):
    return f"{type(error).__name__}: {error}"


def write(path, put):
    """Writes under another name first: readers, and who goes on after an interruption, see a file whole or not at all."""
    temporary = path.with_name(f".{path.name}.{os.getpid()}")
    put(temporary)
    temporary.replace(path)


class Progress:
    """A line on stderr: rewritten on a terminal, now and then a new one elsewhere."""

    def __init__(self, count, done):
        self.count, self.done, self.failed = count, done, 0
        self.before, self.start, self.shown = done, time.monotonic(), 0.0
        if done:
            print(f"{done} of {count} are there already", file=sys.stderr)

    def add(self, complete):
        self.done += len(complete)
        self.failed += sum(row["error"] is not None for row in complete)
        now = time.monotonic()
        if now - self.shown > (0.2 if sys.stderr.isatty() else 10.0):
            self.shown = now
            self.show("\r" if sys.stderr.isatty() else "\n")

    def show(self, end):
        seconds = time.monotonic() - self.start
        left = seconds / max(self.done - self.before, 1) * (self.count - self.done)
        failed = f", {self.failed} with an error" if self.failed else ""
        print(f"{self.done} of {self.count}{failed}, {seconds:.0f} s, {left:.0f} s to go    ", end=end, file=sys.stderr)

    def end(self):
        self.show("\n")
