#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Besieges a service: hostile clients act while its database is well, hangs, dies, is locked or full.

    siege.py PROGRAM SITUATION [--seconds S] [--idle N] [--slow-headers N] [--slow-bodies N]
             [--abandoned N] [--json]

SITUATION is calm, stopped (SIGSTOP), killed (kill -9), locked (a lock on all features) or full (a
disk without space; needs the right to mount, else the exit code is 77). The service and its private
database run in a temporary folder. Three times of S seconds are observed: before, during and after
the event. Prints for each time the 50th and 99th percentile and the largest of the milliseconds that
/healthz, /readyz and honest reads took, each probe on a connection of its own. Exit code 1 unless in
all times 99 % of the probes take at most 50 ms and /healthz is 200, and 99 % of the honest reads of
the times in which the database is there take at most 500 ms and are 200.
"""
import argparse
import asyncio
import contextlib
import http.client
import json
import multiprocessing
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from service import Service, box_document, unprivileged  # noqa: E402

PROBE_MS = 50
READ_MS = 500
KINDS = ("/healthz", "/readyz", "read")
READY_SECONDS = 5  # within which the service is ready after the event


# --- hostile clients ---------------------------------------------------------------------------

async def again(action, pause):
    """Repeats an action for ever, whatever becomes of its connection."""
    while True:
        with contextlib.suppress(OSError, asyncio.IncompleteReadError, asyncio.TimeoutError):
            await action()
        await asyncio.sleep(pause)


async def slowly(port, first, drop, pause):
    """Sends `first`, then `drop` again and again until the service closes the connection."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(first)
        while not reader.at_eof():
            writer.write(drop)
            await writer.drain()
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(reader.read(1), pause)
    finally:
        writer.close()


async def abandon(port, request):
    """Sends a request that takes long and leaves before the answer."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(request)
        await writer.drain()
        await asyncio.wait_for(reader.read(1), random.uniform(0.1, 0.5))
    finally:
        writer.close()


def post_request(path, body, length=None):
    return (f"POST {path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/city+json-seq\r\n"
            f"Content-Length: {length or len(body)}\r\n\r\n").encode() + body


def besiege(port, options, document):
    """The process of the hostile clients."""
    requests = [post_request("/validate", document),
                b"GET /collections/town/export?f=wt HTTP/1.1\r\nHost: localhost\r\n\r\n",
                b"GET /collections/town/items/b7?f=wt HTTP/1.1\r\nHost: localhost\r\n\r\n"]

    async def run():
        clients = [again(lambda: slowly(port, b"", b"", 30), 0.5) for _ in range(options.idle)]
        clients += [again(lambda: slowly(port, b"GET / HTTP/1.1\r\n", b"X-Slow: 1\r\n", 2), 0.5)
                    for _ in range(options.slow_headers)]
        clients += [again(lambda: slowly(port, post_request("/validate", b"", 200 << 20), b"[" * 100, 2), 0.5)
                    for _ in range(options.slow_bodies)]
        clients += [again(lambda i=i: abandon(port, requests[i % len(requests)]), 0.5)
                    for i in range(options.abandoned)]
        await asyncio.gather(*clients)

    asyncio.run(run())


# --- honest clients ----------------------------------------------------------------------------

def ask(port, path, connection=None):
    """One request: its milliseconds and its status, 0 if the connection broke."""
    start = time.monotonic()
    try:
        own = connection or http.client.HTTPConnection("127.0.0.1", port, timeout=30)
        own.request("GET", path)
        answer = own.getresponse()
        answer.read()
        status = answer.status
        if connection is None:
            own.close()
    except (OSError, http.client.HTTPException):
        status = 0
        if connection is not None:
            connection.close()
    return start, path, (time.monotonic() - start) * 1e3, status


def observe(port, paths, pause, keeps, results):
    """The process of an honest client: asks for the paths in turn and reports each answer."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=30) if keeps else None
    while True:
        for path in paths:
            start, path, milliseconds, status = ask(port, path, connection)
            if status == 0 and keeps:  # a kept connection may be closed at any time: RFC 9112, 9.3.1
                _, _, more, status = ask(port, path, connection)
                milliseconds += more
            results.put((start, path, milliseconds, status))
            time.sleep(pause)


# --- the event ---------------------------------------------------------------------------------

@contextlib.contextmanager
def event(service, situation):
    """Holds the situation for as long as the block lasts."""
    if situation == "stopped":
        pids = service.database_processes()
        for pid in pids:
            os.kill(pid, signal.SIGSTOP)
        yield
        for pid in pids:
            with contextlib.suppress(ProcessLookupError):  # the supervisor may have ended it
                os.kill(pid, signal.SIGCONT)
    elif situation == "killed":
        os.kill(service.postmaster(), signal.SIGKILL)
        yield
    elif situation == "locked":
        lock = service.psql("BEGIN; LOCK TABLE watertight.feature_row IN ACCESS EXCLUSIVE MODE; SELECT pg_sleep(3600);")
        yield
        lock.kill()
        service.psql("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE query LIKE '%pg_sleep(3600)%'"
                     " AND pid <> pg_backend_pid();").wait()
    elif situation == "full":
        ballast = service.folder / "data" / "ballast"
        with open(ballast, "wb") as file, contextlib.suppress(OSError):
            while True:
                file.write(b"\0" * (1 << 20))
                file.flush()
        yield
        ballast.unlink()
    else:
        yield


# --- the measurement ---------------------------------------------------------------------------

def percentile(values, part):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(len(ordered) * part))]


def summary(samples):
    times = [sample[2] for sample in samples]
    return {"answers": len(times), "p50": round(percentile(times, 0.5), 1),
            "p99": round(percentile(times, 0.99), 1), "largest": round(max(times), 1),
            "statuses": {str(s): sum(1 for x in samples if x[3] == s) for s in sorted({x[3] for x in samples})}}


def kind_of(sample):
    return "read" if sample[1].startswith("/collections") else sample[1]


def phase_of(sample, phases):
    """The event if the request was under way during any part of it, else the phase it began in, or none."""
    begun, answered = sample[0], sample[0] + sample[2] / 1000
    _, event_begin, event_end = phases[1]
    if begun < event_end and answered >= event_begin:
        return phases[1][0]
    return next((phase for phase, begin, end in phases if begin <= begun < end), None)


def judge(samples, phases, situation):
    """A table of what each kind of request took in each phase, and the complaints."""
    table, complaints = {}, []
    for phase, _, _ in phases:
        for kind in KINDS:
            chosen = [s for s in samples if phase_of(s, phases) == phase and kind_of(s) == kind]
            if not chosen:
                complaints.append(f"{phase}: no answer for {kind}")
                continue
            row = table[f"{phase} {kind}"] = summary(chosen)
            if kind != "read" and row["p99"] > PROBE_MS:
                complaints.append(f"{phase}: {kind} takes {row['p99']} ms (at most {PROBE_MS})")
            if kind == "/healthz" and set(row["statuses"]) != {"200"}:
                complaints.append(f"{phase}: {kind} answers {row['statuses']}")
            is_there = phase != "during" or situation in ("calm", "full")
            failed = sum(count for status, count in row["statuses"].items() if status != "200")
            if kind == "/readyz" and is_there and situation != "full" and failed > 0.01 * row["answers"]:
                complaints.append(f"{phase}: {kind} answers {row['statuses']}")
            if kind == "read" and is_there:
                if row["p99"] > READ_MS or failed > 0.01 * row["answers"]:
                    complaints.append(f"{phase}: reads take {row['p99']} ms (at most {READ_MS}), {row['statuses']}")
    return table, complaints


def wait_until_ready(port, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if ask(port, "/readyz")[3] == 200:
            return time.monotonic()
        time.sleep(0.05)
    return None


def run(options, folder):
    service = Service(options.program, folder)
    with service:
        service.post("town", box_document(400))
        document = box_document(20_000)
        results = multiprocessing.Queue()
        reads = [f"/collections/town/items/b{n}" for n in range(40)] + [
            "/collections/town/items?limit=10", "/collections/town", "/collections/town/items/b3?f=blob"]
        workers = [multiprocessing.Process(target=target, args=args, daemon=True) for target, args in (
            (observe, (service.port, ["/healthz", "/readyz"], 0.02, False, results)),
            (observe, (service.port, reads, 0.02, True, results)),
            (besiege, (service.port, options, document)))]
        for worker in workers:
            worker.start()
        time.sleep(3)  # the hostile clients arrive
        phases, complaints = [], []
        begin = time.monotonic()
        time.sleep(options.seconds)
        middle = time.monotonic()
        with event(service, options.situation):
            phases.append(("before", begin, middle))
            time.sleep(options.seconds)
        over = time.monotonic()
        phases.append(("during", middle, over))
        ready = wait_until_ready(service.port, READY_SECONDS)
        if ready is None:
            complaints.append(f"not ready within {READY_SECONDS} s after the event")
            ready = time.monotonic()
        time.sleep(options.seconds)
        phases.append(("after", ready, time.monotonic()))
        samples = []
        latest = dict.fromkeys(KINDS, 0.0)
        while min(latest.values()) < phases[-1][2] - 0.5:  # until the last ones of each observer have come
            samples.append(results.get(timeout=40))
            latest[kind_of(samples[-1])] = samples[-1][0]
        for worker in workers:
            worker.kill()
        stop = service.stop()
        if stop > 35:
            complaints.append(f"the service took {stop:.1f} s to stop")
    table, more = judge(samples, phases, options.situation)
    return table, complaints + more, {"ready_after": round(ready - over, 2), "stopped_after": round(stop, 2)}


def small_disk(folder):
    """Mounts a small disk on the folder of the data; False without the right to."""
    data = folder / "data"
    data.mkdir()
    user = unprivileged()[1]
    owner = f",uid={user.pw_uid},gid={user.pw_gid}" if user else ""
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size=300m,mode=0700{owner}", "tmpfs", data],
                          capture_output=True, check=False)
    return done.returncode == 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("situation", choices=["calm", "stopped", "killed", "locked", "full"])
    parser.add_argument("--seconds", type=float, default=10)
    for name, number in (("idle", 1000), ("slow-headers", 500), ("slow-bodies", 200), ("abandoned", 50)):
        parser.add_argument(f"--{name}", type=int, default=number)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    folder = pathlib.Path(tempfile.mkdtemp(prefix="watertight-siege-"))
    folder.chmod(0o755)
    is_mounted = False
    try:
        if options.situation == "full":
            is_mounted = small_disk(folder)
            if not is_mounted:
                print("siege: a full disk needs the right to mount one")
                return 77
        table, complaints, times = run(options, folder)
    finally:
        if is_mounted:
            subprocess.run(["umount", "-l", folder / "data"], check=False)
        shutil.rmtree(folder, ignore_errors=True)
    if options.json:
        print(json.dumps({"situation": options.situation, **times, "table": table, "complaints": complaints}))
    else:
        for name, row in table.items():
            print(f"{options.situation:8} {name:18} {row['answers']:6} answers, p50 {row['p50']:8} ms, "
                  f"p99 {row['p99']:8} ms, largest {row['largest']:8} ms, {row['statuses']}")
        print(f"{options.situation:8} ready after {times['ready_after']} s, stopped after {times['stopped_after']} s")
    for complaint in complaints:
        print(f"siege: {options.situation}: {complaint}", file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
