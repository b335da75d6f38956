#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses the access keys of a running service as clients and administrators do: access.py WATERTIGHT

Without keys it does not start on an address that other machines reach. With them curl and GDAL read and write
as their keys allow, and a key that is taken back counts no more. Prometheus' own parser reads the metrics.
Exit code 1 after a difference.
"""
import os
import subprocess
import sys
import time
import urllib.request

from prometheus_client.parser import text_string_to_metric_families

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, box_document, temporary_folder  # noqa: E402

PROGRAM = os.path.abspath(sys.argv[1])


def watertight(*words):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=60, check=False)


def new_key(name, scope, file):
    return run(PROGRAM, "key", name, "--scope", scope, "--keys", str(file)).strip()


def status(service, method, path, key=None, body=None):
    headers = {"Content-Type": "application/city+json-seq"}
    if key:
        headers["Authorization"] = f"Bearer {key}"
    return service.request(method, path, body, headers=headers)[0]


def soon(is_so):
    """Whether it is so within five seconds."""
    end = time.monotonic() + 5
    while not is_so() and time.monotonic() < end:
        time.sleep(0.1)
    return is_so()


def check_start(folder):
    open_to_all = watertight("serve", "--data-dir", str(folder / "none"), "--listen", "0.0.0.0:0")
    check(open_to_all.returncode == 2 and "--keys" in open_to_all.stderr and "--open" in open_to_all.stderr,
          "without keys a service for other machines does not start, and says why")
    both = watertight("serve", "--data-dir", str(folder / "none"), "--open", "--keys", "k")
    check(both.returncode == 2, "--open and --keys exclude each other")
    check(not (folder / "none").exists(), "a service that does not start makes no database")


def check_metrics(log):
    """Reads the metrics on the address of the probes, which the log names."""
    probes = next(line.split("url=")[1] for line in log.splitlines() if "event=probes" in line)
    with urllib.request.urlopen(f"{probes}/metrics", timeout=10) as answer:
        families = text_string_to_metric_families(answer.read().decode())
    found = {(sample.name, *sorted(sample.labels.values())): sample.value
             for family in families for sample in family.samples}
    items = "/collections/{collectionId}/items"
    check(found[("watertight_requests_total", items, "201", "POST")] == 1
          and found[("watertight_requests_total", items, "403", "POST")] == 1
          and found[("watertight_solids_total", "valid")] == 3 and found[("watertight_database_ready",)] == 1,
          "Prometheus reads metrics without key on the address of the probes")


def check_keys(folder):
    file = folder / "keys"
    reader, writer, admin = (new_key(scope, scope, file) for scope in ("read", "write", "admin"))
    again = watertight("key", "read", "--scope", "read", "--keys", str(file))
    check(again.returncode == 2 and "read" in again.stderr, "a name has one key")
    check(not any(key in file.read_text() for key in (reader, writer, admin)), "the file holds no key")
    with Service(PROGRAM, folder, ["--keys", str(file), "--probes", "127.0.0.1:0"]) as service:
        url = f"http://127.0.0.1:{service.port}"
        check(status(service, "GET", "/readyz") == 200, "probes need no key")
        check(status(service, "GET", "/collections") == 401, "reading needs a key")
        check(status(service, "POST", "/collections/town/items", reader, box_document(3)) == 403,
              "a key to read writes nothing")
        check(status(service, "POST", "/collections/town/items", writer, box_document(3)) == 201,
              "a key to write does")
        counted = run("ogrinfo", "-ro", "-so", f"OAPIF:{url}", "town", "--config", "GDAL_HTTP_USERPWD", f":{reader}")
        check("Feature Count: 3" in counted, "GDAL reads with a key as password")
        page = run("curl", "-s", "-i", "-u", f"anyone:{reader}", f"{url}/collections/town?f=html")
        check(page.startswith("HTTP/1.1 200 "), "so do curl and browsers")
        check_metrics((folder / "log").read_text())
        check(status(service, "GET", "/metrics") == 401, "and with one on the other")
        check(status(service, "DELETE", "/collections/town", writer) == 403, "a key to write deletes no collection")
        check("key=\"write\"" in (folder / "log").read_text() and writer not in (folder / "log").read_text(),
              "the log names the key and does not have it")
        kept = [line for line in file.read_text().splitlines() if not line.startswith("write ")]
        file.write_text("\n".join(kept) + "\n")
        check(soon(lambda: status(service, "GET", "/", writer) == 401), "a key that is taken back counts no more")
        with open(file, "a", encoding="ascii") as more:
            more.write("nonsense\n")
        check(soon(lambda: "line 3: a key is NAME SCOPE DIGEST" in (folder / "log").read_text()),
              "an error in the file is in the log")
        check(status(service, "DELETE", "/collections/town", admin) == 204, "the keys from before count on")
        service.stop()
    broken = Service(PROGRAM, folder, ["--keys", str(file)])
    try:
        broken.start()
        check(False, "a service does not start with a broken file")
    except SystemExit as failure:
        check("line 3" in str(failure), "a service does not start with a broken file, and names the line")


def main():
    with temporary_folder("access") as folder:
        check_start(folder)
        check_keys(folder)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
