# SPDX-License-Identifier: GPL-3.0-or-later
"""PostgreSQL servers with the extensions, for tests: servers_in(FOLDER, BUILD, NAMES)."""
import contextlib
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import unprivileged  # noqa: E402


class Server:
    """A PostgreSQL server with the extensions. Its socket is in the folder."""

    def __init__(self, bin_folder, folder):
        self.bin = bin_folder
        self.folder = folder
        self.prefix = unprivileged()[0]
        self.run("initdb", "-D", str(folder), "-N", "--username=watertight", "--encoding=UTF8", "--no-locale", "--auth=trust")
        self.start()

    def run(self, name, *words, check=True, **options):
        done = subprocess.run([*self.prefix, f"{self.bin}/{name}", *words], check=False, capture_output=True, text=True, **options)
        if check and done.returncode != 0:
            raise SystemExit(f"{self.folder.name}: {' '.join(words)}\n{done.stderr}")
        return done

    def start(self):
        self.run("pg_ctl", "-D", str(self.folder), "-w", "-s", "-l", str(self.folder / "log"), "-o",
                 f"-c listen_addresses= -c unix_socket_directories={self.folder}", "start")

    def kill(self):
        """Ends the server and all its backends at once, as a failure of its machine would."""
        postmaster = (self.folder / "postmaster.pid").read_text().split()[0]
        backends = subprocess.run(["pgrep", "-P", postmaster], capture_output=True, text=True, check=False).stdout.split()
        subprocess.run(["kill", "-9", postmaster, *backends], check=False)
        while subprocess.run(["kill", "-0", postmaster], capture_output=True, check=False).returncode == 0:
            time.sleep(0.05)

    def stop(self):
        self.run("pg_ctl", "-D", str(self.folder), "-s", "-m", "immediate", "stop", check=False)

    def psql(self, *statements, check=True):
        words = [word for statement in statements for word in ("-c", statement)]
        return self.run("psql", "-X", "-q", "-At", "-v", "ON_ERROR_STOP=1", "-h", str(self.folder), "-U", "watertight",
                        "-d", "postgres", *words, check=check)

    def ask(self, *statements):
        return self.psql(*statements).stdout.strip()


def expect(what, found, wanted):
    if found != wanted:
        raise SystemExit(f"{what}: {found}, not {wanted}")


@contextlib.contextmanager
def servers_in(folder, build, names):
    """Servers by their names, which end with the block."""
    bin_folder = subprocess.run([ROOT / "scripts" / "relocated-postgres", build, str(folder / "prefix")], check=True,
                                capture_output=True, text=True).stdout.strip()
    user = unprivileged()[1]
    if user:
        subprocess.run(["chown", "-R", user.pw_name, str(folder)], check=True)
    servers = {}
    try:
        for name in names:
            servers[name] = Server(bin_folder, folder / name)
        yield servers
    finally:
        for server in servers.values():
            server.stop()
