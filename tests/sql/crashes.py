#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Kills servers, backends and helpers while solids come in by COPY: crashes.py BUILD [ROUNDS]

Each COPY has 40 solids, some of which need a helper, and is acknowledged or not as a whole. After each kill the
table must have what was acknowledged, the COPY that was under way wholly or not at all, and nothing else; each
value must be judged valid again.
"""
import pathlib
import random
import subprocess
import sys
import threading
import time

from postgres_servers import expect, servers_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "siege"))
from service import temporary_folder  # noqa: E402

SOLIDS = 40  # of a COPY


def children(process):
    return subprocess.run(["pgrep", "-P", str(process)], capture_output=True, text=True, check=False).stdout.split()


def kill_soon(server, target, pause):
    """Kills the server, or the backend that copies, or its helpers, after a pause. What is gone by then is not killed."""
    time.sleep(pause)
    if target == "server":
        server.kill()
        return
    postmaster = (server.folder / "postmaster.pid").read_text().split()[0]
    for backend in children(postmaster):
        name = pathlib.Path(f"/proc/{backend}/cmdline")
        if name.exists() and b"COPY" in name.read_bytes():
            subprocess.run(["kill", "-9", *(children(backend) if target == "helper" else [backend])], check=False, capture_output=True)


def wait_for(server):
    """Until the server answers again; it restarts its backends by itself after one was killed."""
    if subprocess.run(["pgrep", "-F", str(server.folder / "postmaster.pid")], capture_output=True, check=False).returncode != 0:
        server.start()
    for _ in range(100):
        if server.psql("SELECT 1", check=False).returncode == 0:
            return
        time.sleep(0.1)
    raise SystemExit("the server does not come back")


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 12
    chance = random.Random(19)
    rows = subprocess.run([f"{build}/bin/watertight", "rows", ROOT / "examples" / "delft.city.jsonl"], check=True, capture_output=True, text=True).stdout
    ewkb = [line.split("\t")[3].replace("\\\\x", "\\x") for line in rows.splitlines()]
    with temporary_folder("crashes") as folder, servers_in(folder, build, ("db",)) as servers:
        server = servers["db"]
        server.ask("CREATE EXTENSION watertight", "CREATE TABLE raw (number int, ewkb bytea)")
        server.run("psql", "-X", "-q", "-h", str(server.folder), "-U", "watertight", "-d", "postgres", "-c", "COPY raw FROM STDIN",
                   input="".join(f"{i}\t\\{value}\n" for i, value in enumerate(ewkb)))
        server.ask("DELETE FROM raw WHERE NOT wt_is_valid(ewkb)", "CREATE TABLE city (batch int, number int, shape solid, PRIMARY KEY (batch, number))",
                   "CREATE INDEX ON city USING gist (shape)")
        valid = [int(number) for number in server.ask("SELECT number FROM raw").split()]
        acknowledged = set()
        interrupted = 0
        for batch in range(rounds):
            target = ("server", "backend", "helper")[batch % 3]
            killer = threading.Thread(target=kill_soon, args=(server, target, chance.uniform(0.02, 0.15)))
            killer.start()
            text = "".join(f"{batch}\t{number}\t\\{ewkb[number]}\n" for number in chance.sample(valid, SOLIDS))
            done = server.run("psql", "-X", "-q", "-h", str(server.folder), "-U", "watertight", "-d", "postgres", "-c", "COPY city FROM STDIN",
                              check=False, input=text)
            killer.join()
            wait_for(server)
            found = {int(line) for line in server.ask("SELECT batch FROM city GROUP BY batch").split()}
            expect("COPYs that are there in part", server.ask(f"SELECT count(*) FROM (SELECT FROM city GROUP BY batch HAVING count(*) <> {SOLIDS}) x"), "0")
            if done.returncode == 0:
                acknowledged.add(batch)
            else:
                interrupted += 1
            expect("acknowledged COPYs that are lost", acknowledged - found, set())
            expect("COPYs that came from nowhere", found - acknowledged - {batch}, set())
            acknowledged = found
        expect("solids that are not what they were", server.ask(
            "SELECT count(*) FROM city JOIN raw USING (number) WHERE shape <> wt_solid(ewkb)"), "0")
        expect("values that are not valid", server.ask("SELECT count(*) FROM wt_recheck('city', 'shape')"), "0")
        expect("rows by the index", server.ask("SET enable_seqscan = off", "SELECT count(*) FROM city WHERE shape && wt_box(-1e9, -1e9, -1e9, 1e9, 1e9, 1e9)"),
               str(SOLIDS * len(acknowledged)))
        if interrupted == 0:
            raise SystemExit("no kill met a COPY")
    print(f"{rounds} kills, {interrupted} of them during a COPY: no row lost, halved or invented")


if __name__ == "__main__":
    main()
