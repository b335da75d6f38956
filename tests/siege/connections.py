#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps many connections open at once: connections.py PROGRAM [--connections N] [--rounds R]

Each connection sends a request in each round, all rounds over the same connections, and is answered with what it
asked for; no connection is reset. Prints the memory of the service and the times. Exit code 1 otherwise.
"""
import argparse
import asyncio
import pathlib
import resource
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from service import Service, box_document, temporary_folder  # noqa: E402

REQUESTS = ("/healthz", "/collections/town/items/b0?f=cityjson", "/collections/town/items?limit=1")


async def ask(reader, writer, path):
    """The status of an answer whose body came whole."""
    writer.write(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
    await writer.drain()
    head = await reader.readuntil(b"\r\n\r\n")
    length = int(head.lower().split(b"content-length: ")[1].split(b"\r\n")[0])
    await reader.readexactly(length)
    return int(head.split()[1])


async def run(port, count, rounds):
    # A moment between connections: the queue of the system for new ones is 4,096 long.
    pairs = []
    for number in range(count):
        pairs.append(await asyncio.open_connection("127.0.0.1", port))
        if number % 500 == 499:
            await asyncio.sleep(0.05)
    wrong = {}
    for turn in range(rounds):
        answers = await asyncio.gather(*(ask(*pair, REQUESTS[(turn + n) % len(REQUESTS)]) for n, pair in enumerate(pairs)),
                                       return_exceptions=True)
        for answer in answers:
            if answer != 200:
                wrong[str(answer)] = wrong.get(str(answer), 0) + 1
    for _, writer in pairs:
        writer.close()
    return wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--connections", type=int, default=5000)
    parser.add_argument("--rounds", type=int, default=6)
    options = parser.parse_args()
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if hard < options.connections + 100:
        print(f"a process may have {hard} files open, which is too few")
        return 77
    resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
    with temporary_folder("connections") as folder, Service(options.program, folder) as service:
        service.post("town", box_document(10))
        start = time.monotonic()
        wrong = asyncio.run(run(service.port, options.connections, options.rounds))
        seconds = time.monotonic() - start
        status = pathlib.Path(f"/proc/{service.process.pid}/status").read_text()
        memory = int(status.split("VmHWM:")[1].split()[0]) / 1024
        print(f"{options.connections} connections, {options.rounds} requests each in {seconds:.1f} s, "
              f"{memory:.0f} MiB at most, other than 200: {wrong or 'none'}")
        return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
