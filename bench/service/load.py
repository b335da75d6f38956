#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how many requests a second a service answers: load.py PROGRAM CITY [--seconds S] [--clients C].

CITY is a CityJSONSeq of real buildings. The service runs in a temporary folder with a private
database; the load comes from wrk on the same machine. Reads are of one building again and again (the
answers come from the cache), and of each building once (they are made). Prints a line for each kind
of request: requests (for batches: features) per second, the 99th percentile of the time, errors.
"""
import argparse
import concurrent.futures
import http.client
import json
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests" / "siege"))
from service import HEADER, Service, box_feature, temporary_folder  # noqa: E402

POST_SCRIPT = """
local header = [[{header}]]
local parts = {{ {parts} }}
local thread_number = 0
function setup(thread) thread:set("number", thread_number); thread_number = thread_number + 1 end
local count = 0
function request()
  local lines = {{ header }}
  for i = 1, {batch} do
    count = count + 1
    lines[#lines + 1] = parts[1] .. number .. "-" .. count .. parts[2] .. number .. "-" .. count .. parts[3]
  end
  return wrk.format("POST", "{path}", {{ ["Content-Type"] = "application/city+json-seq" }}, table.concat(lines, "\\n") .. "\\n")
end
"""


def wrk(service, path, options, script=None):
    """Requests per second, milliseconds of the 99th percentile, number of answers other than 2xx."""
    command = ["wrk", "-t", "2" if script else "1", "-c", str(options.clients), "-d", f"{options.seconds}s", "--latency"]
    if script:
        command += ["-s", str(script)]
    text = subprocess.run([*command, f"http://127.0.0.1:{service.port}{path}"], capture_output=True, text=True,
                          check=True).stdout
    rate = float(re.search(r"Requests/sec:\s+([\d.]+)", text)[1])
    value, unit = re.search(r"99%\s+([\d.]+)(us|ms|s)", text).groups()
    bad = [int(count) for count in re.findall(r"(?:Non-2xx or 3xx responses:|connect|read|write|timeout) (\d+)", text)]
    return rate, float(value) * {"us": 1e-3, "ms": 1, "s": 1e3}[unit], sum(bad)


def post_script(folder, collection, batch):
    line = box_feature("NAME", 7)
    first, second, third = line.split("NAME")
    header = json.dumps(HEADER, separators=(",", ":"))
    script = folder / f"post-{batch}.lua"
    script.write_text(POST_SCRIPT.format(
        header=header, parts=", ".join(f"[=[{part}]=]" for part in (first, second, third)), batch=batch,
        path=f"/collections/{collection}/items"))
    return script


def each_once(service, paths, clients):
    """Requests per second when each path is asked for once, by so many clients with kept connections."""
    local = threading.local()

    def ask(path):
        if not hasattr(local, "connection"):
            local.connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
        local.connection.request("GET", path)
        answer = local.connection.getresponse()
        answer.read()
        return answer.status

    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(clients) as pool:
        statuses = list(pool.map(ask, paths))
    return len(paths) / (time.monotonic() - start), sum(1 for status in statuses if status != 200)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("city")
    parser.add_argument("--seconds", type=int, default=5)
    parser.add_argument("--clients", type=int, default=8)
    options = parser.parse_args()
    if shutil.which("wrk") is None:
        raise SystemExit("load: the program wrk is not installed (Debian: apt install wrk)")
    failures = 0

    def show(kind, rate, p99, bad):
        nonlocal failures
        failures += bad
        print(f"{kind:44} {rate:9.0f} /s   p99 {p99:7.1f} ms   {bad} errors", flush=True)

    with temporary_folder("load") as folder, Service(options.program, folder) as service:
        city = pathlib.Path(options.city).read_bytes()
        status, body = service.request("POST", "/collections/city/items?invalid=skip&f=cityjsonseq", city)
        if status != 201:
            raise SystemExit(f"load: storing gave {status}: {body[:300]!r}")
        items = []
        path = "/collections/city/items?limit=1000&f=summary"
        while path:
            page = json.loads(service.request("GET", path)[1])
            items += [feature["id"] for feature in page["features"] if feature["properties"]["solids"] == 3]
            path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
        base = "/collections/city/items/"
        for name, query in (("blob", "?f=blob&solid=2"), ("CityJSON", "?f=cityjson"), ("f=wt", "?f=wt")):
            rate, bad = each_once(service, [base + item + query for item in items], options.clients)
            print(f"{name + f', each of {len(items)} buildings once':44} {rate:9.0f} /s   {bad} errors")
            show(f"{name}, one building", *wrk(service, base + items[0] + query, options))
        show("page of ten", *wrk(service, "/collections/city/items?limit=10", options))
        show("page of one", *wrk(service, "/collections/city/items?limit=1", options))
        show("POST of one box", *wrk(service, "/", options, post_script(folder, "boxes", 1)))
        rate, p99, bad = wrk(service, "/", options, post_script(folder, "batches", 100))
        show("POST of 100 boxes, boxes", rate * 100, p99, bad)
        show("/healthz", *wrk(service, "/healthz", options))
        service.stop()
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
