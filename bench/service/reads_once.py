#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures reads that no cache has: reads_once.py PROGRAM DOCUMENT [--solids N] [--clients C] [--seconds S]

DOCUMENT is copied until it has N solids and stored as a job. wrk then asks for features in an order in which none
comes twice, as blobs of their first solids and as CityJSON. Prints the rate of the job, and for each kind of request
requests a second, the 99th percentile of the time, and answers other than 2xx.
"""
import argparse
import json
import pathlib
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "siege"))
from ingest import Template, feed, sequence  # noqa: E402
from load import wrk  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

SCRIPT = """
local ids = {{}}
for line in io.lines("{ids}") do ids[#ids + 1] = line end
local number = 0
function setup(thread) thread:set("first", number); number = number + 1 end
local at = 0
function request()
  local id = ids[(at * 2 + first) % #ids + 1]
  at = at + 1
  return wrk.format("GET", "/collections/city/items/" .. id .. "{query}")
end
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("document", type=pathlib.Path)
    parser.add_argument("--solids", type=int, default=60_000)
    parser.add_argument("--clients", type=int, default=64)
    parser.add_argument("--seconds", type=float, default=5)
    options = parser.parse_args()
    options.seconds = int(options.seconds)
    program = str(pathlib.Path(options.program).resolve())
    header, *lines = sequence(program, options.document)
    with temporary_folder("reads") as folder, Service(program, folder) as service, \
            tempfile.TemporaryDirectory() as own:
        file = pathlib.Path(own) / "copies.city.jsonl"
        feed(open(file, "w"), header, [Template(line) for line in lines], options.solids)
        ids = pathlib.Path(own) / "ids"
        with open(file) as copies, open(ids, "w") as names:
            next(copies)
            names.writelines(json.loads(line)["id"] + "\n" for line in copies)
        start = time.monotonic()
        with open(file, "rb") as body:
            _, made = service.request("POST", "/jobs?collection=city&invalid=keep", body, timeout=600,
                                      headers={"Content-Length": str(file.stat().st_size)})
        job = json.loads(made)
        while job["status"] in ("accepted", "running"):
            time.sleep(0.2)
            job = json.loads(service.request("GET", f"/jobs/{job['jobID']}")[1])
        seconds = time.monotonic() - start
        print(f"job: {job['message']}; {options.solids / seconds:.0f} solids/s with the upload of "
              f"{file.stat().st_size / 1e6:.0f} MB", flush=True)
        for name, query in (("blob", "?f=blob&solid=0"), ("CityJSON", "?f=cityjson")):
            script = pathlib.Path(own) / "reads.lua"
            script.write_text(SCRIPT.format(ids=ids, query=query))
            rate, late, bad = wrk(service, "/", options, script)
            print(f"{name:10} {rate:8.0f}/s  p99 {late:6.1f} ms  other than 2xx: {bad}", flush=True)
        status = pathlib.Path(f"/proc/{service.process.pid}/status").read_text()
        print(f"most memory of the service: {int(status.split('VmHWM:')[1].split()[0]) // 1024} MiB")


if __name__ == "__main__":
    main()
