# SPDX-License-Identifier: GPL-3.0-or-later
"""A service with a private database in a folder, as the programs of this folder start it."""
import contextlib
import http.client
import json
import os
import pathlib
import pwd
import shutil
import signal
import subprocess
import tempfile
import time

HEADER = {"type": "CityJSON", "version": "2.0", "transform": {"scale": [0.001] * 3, "translate": [0, 0, 0]},
          "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/7415"},
          "CityObjects": {}, "vertices": []}
CORNERS = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
FACETS = [[[0, 3, 2, 1]], [[4, 5, 6, 7]], [[0, 1, 5, 4]], [[1, 2, 6, 5]], [[2, 3, 7, 6]], [[3, 0, 4, 7]]]


def box_feature(name, number):
    """A line of a sequence: a box of its own size at a place of its own."""
    size = [5000 + number % 997, 6000 + number % 499, 3000 + number % 251]
    place = [20_000 * (number % 1000), 20_000 * (number // 1000), 0]
    vertices = [[place[axis] + corner[axis] * size[axis] for axis in range(3)] for corner in CORNERS]
    return json.dumps({"type": "CityJSONFeature", "id": name, "CityObjects": {name: {
        "type": "Building", "geometry": [{"type": "Solid", "lod": "1", "boundaries": [FACETS]}]}},
        "vertices": vertices}, separators=(",", ":"))


def sequence(features):
    return ("\n".join([json.dumps(HEADER, separators=(",", ":")), *features]) + "\n").encode()


def box_document(count, prefix="b"):
    return sequence(box_feature(f"{prefix}{n}", n) for n in range(count))


def unprivileged():
    """The words before a command that run it without root's rights, as PostgreSQL demands."""
    if os.getuid() != 0:
        return [], None
    for name in ("postgres", "nobody"):
        try:
            user = pwd.getpwnam(name)
        except KeyError:
            continue
        return ["setpriv", f"--reuid={user.pw_uid}", f"--regid={user.pw_gid}", "--clear-groups"], user
    raise SystemExit("there is no user other than root to run a database")


@contextlib.contextmanager
def temporary_folder(name):
    """A folder that other users can enter, for as long as the block lasts."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix=f"watertight-{name}-"))
    folder.chmod(0o755)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


class Service:
    """A running `watertight serve`; the end of the block kills what is left of it."""

    def __init__(self, program, folder, arguments=()):
        self.program = os.path.abspath(program)
        self.folder = pathlib.Path(folder)
        self.arguments = list(arguments)
        self.prefix, user = unprivileged()
        if user:
            os.chown(self.folder, user.pw_uid, user.pw_gid)
        self.process = None
        self.port = 0

    def __enter__(self):
        self.start()
        return self

    def refusal(self):
        """What a service says on standard error that does not start."""
        done = subprocess.run(self.serve_command(), capture_output=True, cwd=self.folder, text=True, timeout=60, check=False)
        if done.returncode != 2:
            raise SystemExit(f"the service ended with status {done.returncode}: {done.stderr[-2000:]}")
        return done.stderr

    def __exit__(self, *_):
        if self.process and self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        for pid in self.database_processes():
            with contextlib.suppress(ProcessLookupError):  # it may end by itself
                os.kill(pid, signal.SIGKILL)

    def serve_command(self):
        return [*self.prefix, "env", f"HOME={self.folder}", self.program, "serve", "--data-dir", str(self.folder / "data"),
                "--listen", f"127.0.0.1:{self.port}", *self.arguments]

    def start(self):
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen(self.serve_command(), stdout=subprocess.PIPE, stderr=log, cwd=self.folder, text=True)
        line = self.process.stdout.readline()
        if "://" not in line:
            raise SystemExit(f"the service did not start: {(self.folder / 'log').read_text()[-2000:]}")
        self.port = int(line.strip().rsplit(":", 1)[1])

    def stop(self):
        """Ends it gracefully; the seconds that took."""
        start = time.monotonic()
        self.process.terminate()
        self.process.wait(timeout=120)
        return time.monotonic() - start

    def request(self, method, path, body=None, timeout=60, headers=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            connection.request(method, path, body, headers or {"Content-Type": "application/city+json-seq"})
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def post(self, collection, document):
        status, body = self.request("POST", f"/collections/{collection}/items", document)
        if status != 201:
            raise SystemExit(f"storing gave {status}: {body[:500]!r}")

    def postmaster(self):
        """The number of the database's first process."""
        return int((self.folder / "data" / "postgres" / "postmaster.pid").read_text().split()[0])

    def database_processes(self):
        """The numbers of all processes of the database, its first one included; none if it is down."""
        try:
            first = self.postmaster()
            os.kill(first, 0)
        except (FileNotFoundError, ProcessLookupError, IndexError, ValueError):
            return []
        pids = [first]
        for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                fields = stat.read_text().rsplit(")", 1)[1].split()
            except (OSError, IndexError):
                continue
            if int(fields[1]) == first:
                pids.append(int(stat.parent.name))
        return pids

    def psql(self, statements):
        return subprocess.Popen(
            [*self.prefix, "psql", "-q", "-h", str(self.folder / "data" / "socket"), "-d", "watertight", "-c", statements],
            stdout=subprocess.DEVNULL, cwd=self.folder)

    def ask(self, statements, file=None):
        """What psql prints for statements, or for those of a file: a line a row, a bar between columns."""
        words = ["-f", str(file)] if file else ["-c", statements]
        done = subprocess.run(
            [*self.prefix, "psql", "-X", "-q", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-h",
             str(self.folder / "data" / "socket"), "-d", "watertight", *words],
            capture_output=True, text=True, check=False, cwd=self.folder)
        if done.returncode != 0:
            raise SystemExit(f"psql: {done.stderr[-1000:]}")
        return done.stdout.strip()

    def command(self, *words):
        """A command of the program that is running with the service's folder."""
        return subprocess.Popen(
            [*self.prefix, "env", f"HOME={self.folder}", self.program, *words, "--data-dir", str(self.folder / "data")],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=self.folder, text=True)

    def run(self, *words, code=0):
        """What a command printed, or its errors if it is to fail."""
        process = self.command(*words)
        output, error = process.communicate()
        if process.returncode != code:
            raise SystemExit(f"{words}: exit code {process.returncode}: {error[-1000:]}")
        return output if code == 0 else error
