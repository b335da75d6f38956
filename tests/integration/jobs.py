#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Uploads files to a running service as jobs: jobs.py WATERTIGHT EXAMPLES [--rounds N] [--seed S] [--boxes N]

Files of every kind are stored as `watertight ingest` stores them; clients follow a job, end it, and ask twice with
one key. Then, in N rounds, the service, its database or the helper processes that prove hard solids are killed while
jobs are uploaded and run: each job that was accepted is successful in the end, with each of its features once. Exit
code 1 after a difference.
"""
import argparse
import gzip
import http.client
import io
import json
import os
import pathlib
import random
import signal
import sys
import threading
import time
import urllib.parse
import zipfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../siege"))
from checks import check, failures  # noqa: E402
from service import Service, box_document, sequence, temporary_folder  # noqa: E402
from hard_solid import hard_feature  # noqa: E402

OCTETS = {"Content-Type": "application/octet-stream"}
OVER = ("successful", "failed", "dismissed")


def start_job(service, body, headers=None, **parameters):
    query = urllib.parse.urlencode(parameters)
    status, answer = service.request("POST", f"/jobs?{query}", body, headers={**OCTETS, **(headers or {})})
    return status, json.loads(answer)


def job_of(service, job):
    return json.loads(service.request("GET", f"/jobs/{job}")[1])


def finished(service, job, seconds=120):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        state = job_of(service, job)
        if state["status"] in OVER:
            return state
        time.sleep(0.05)
    raise SystemExit(f"the job is not over after {seconds} s: {state}")


def lines_of(service, job):
    status, body = service.request("GET", f"/jobs/{job}/results")
    assert status == 200, (status, body)
    return [json.loads(line) for line in body.decode().splitlines()]


def features_of(service, collection):
    status, body = service.request("GET", f"/collections/{collection}")
    return json.loads(body)["features"] if status == 200 else 0


def archive(members):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, body in members.items():
            packed.writestr(name, body)
    return file.getvalue()


def check_kinds(service, examples):
    """Files of each kind, and what becomes of bad ones."""
    town = (examples / "delft.city.jsonl").read_bytes()
    count = len(town.splitlines()) - 1
    for kind, body in {"sequence": town, "gzip": gzip.compress(town), "zip": archive({"a.city.jsonl": town}),
                       "file": pathlib.Path(service.folder / "town.wt").read_bytes()}.items():
        status, made = start_job(service, body, collection=kind, invalid="keep", name="town")
        done = finished(service, made["jobID"])
        check(status == 201 and done["status"] == "successful" and done["counts"]["stored"] == count
              and features_of(service, kind) == count, f"{kind}: {done['message']}")
        lines = lines_of(service, made["jobID"])
        not_valid = [line for line in lines if line.get("verdict") != "valid" and "id" in line]
        check(len(lines) == count + 1 and len(not_valid) == done["counts"]["invalid"] + done["counts"]["undecided"]
              and all(line["solids"] for line in not_valid), f"{kind}: a line for each feature, findings in those of bad ones")
    exports = {kind: service.request("GET", f"/collections/{kind}/export?f=cityjsonseq")[1] for kind in ("sequence", "gzip")}
    service.run("ingest", "--collection", "direct", "--invalid", "keep", "--quiet", str(examples / "delft.city.jsonl"), code=1)
    exports["direct"] = service.request("GET", "/collections/direct/export?f=cityjsonseq")[1]
    check(len(set(exports.values())) == 1, "a job stores the bytes that ingest stores")
    gml = next(examples.parent.glob("tests/data/gml/*.gml")).read_bytes()
    done = finished(service, start_job(service, gml, collection="gml", invalid="keep", name="b.gml")[1]["jobID"])
    check(done["counts"]["features"] > 0 and done["documents"]["all"] == 1, f"GML: {done['message']}")
    check_bad(service, town)


def check_bad(service, town):
    refused = finished(service, start_job(service, town, collection="refused", invalid="refuse")[1]["jobID"])
    check(refused["status"] == "failed" and "not valid" in refused["message"] and features_of(service, "refused") == 0,
          f"a document with invalid features is refused: {refused['message']}")
    cut = town[: len(town) // 2]
    half = finished(service, start_job(service, cut, collection="half", invalid="keep")[1]["jobID"])
    check(half["status"] == "failed" and "line" in half["message"] and features_of(service, "half") == 0,
          f"half a file is refused with its place: {half['message']}")
    mixed = archive({"a.city.jsonl": box_document(20, "m"), "b.city.jsonl": cut, "c.city.jsonl": box_document(5, "n")})
    done = finished(service, start_job(service, mixed, collection="mixed", name="mixed.zip")[1]["jobID"])
    check(done["status"] == "failed" and done["documents"] == {"all": 3, "done": 3, "failed": 1}
          and features_of(service, "mixed") == 25 and "mixed.zip/b.city.jsonl" in done["message"],
          f"a bad document leaves the others of an archive: {done['message']}")
    bomb = finished(service, start_job(service, gzip.compress(b" " * (600 << 20), 9), collection="bomb")[1]["jobID"])
    check(bomb["status"] == "failed" and "expand" in bomb["message"], f"a bomb is refused: {bomb['message']}")
    for body, parameters, status in ((b"", {"collection": "a"}, 400), (town, {}, 400), (town, {"collection": "a/b"}, 400),
                                     (town, {"collection": "a", "invalid": "maybe"}, 400),
                                     (town, {"collection": "a", "colour": "red"}, 400),
                                     (town, {"collection": "a", "name": "../a"}, 400)):
        got, problem = start_job(service, body, **parameters)
        check(got == status, f"{parameters}: {got} {problem.get('detail')}")
    check(service.request("GET", "/jobs/none")[0] == 404 and service.request("DELETE", "/jobs/none")[0] == 404,
          "no job, no answer")


def events_of(service, job):
    """The statuses that a client sees who follows a job, and whether they came one by one."""
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=60)
    connection.request("GET", f"/jobs/{job}/events")
    answer = connection.getresponse()
    assert answer.getheader("Content-Type") == "text/event-stream", answer.getheaders()
    seen = []
    for line in answer:
        if line.startswith(b"data: "):
            seen.append((time.monotonic(), json.loads(line[6:])))
    connection.close()
    return seen


def check_following(service, boxes):
    """Clients follow a long job, end it, and ask twice."""
    long_document = box_document(boxes, "l")
    _, made = start_job(service, long_document, collection="long", name="long.city.jsonl")
    job = made["jobID"]
    _, later = start_job(service, box_document(10, "q"), collection="queue")
    waiting = job_of(service, later["jobID"])["status"]
    seen = events_of(service, job)
    states = [state["status"] for _, state in seen]
    shares = [state["progress"] for _, state in seen if state["status"] == "running"]
    check(states[-1] == "successful" and shares == sorted(shares) and len(seen) >= 3 and seen[-1][0] > seen[0][0] + 0.5,
          f"{len(seen)} events, progress {shares}")
    check(any(state.get("featuresPerSecond", 0) > 0 and "secondsLeft" in state for _, state in seen), "rate and time left")
    check(waiting == "accepted" and finished(service, later["jobID"])["status"] == "successful", "jobs run one after the other")
    _, made = start_job(service, long_document, collection="ended")
    while job_of(service, made["jobID"])["status"] == "accepted":
        time.sleep(0.01)
    check(service.request("GET", f"/jobs/{made['jobID']}/results")[0] == 404, "no results before the end")
    service.request("DELETE", f"/jobs/{made['jobID']}")
    done = finished(service, made["jobID"])
    check(done["status"] == "dismissed" and features_of(service, "ended") == 0, f"an ended job: {done['message']}")
    check(service.request("DELETE", f"/jobs/{made['jobID']}")[0] == 200
          and service.request("GET", f"/jobs/{made['jobID']}")[0] == 404, "a job that is over can be removed")
    key = {"Idempotency-Key": "a 1".replace(" ", "-")}
    first = start_job(service, box_document(3, "k"), key, collection="keyed")
    again = start_job(service, box_document(3, "k"), key, collection="keyed")
    other = start_job(service, box_document(3, "k"), key, collection="other")
    check((first[0], again[0], other[0]) == (201, 200, 422) and first[1]["jobID"] == again[1]["jobID"],
          "a key makes one job")
    listed = json.loads(service.request("GET", "/jobs?limit=2")[1])
    following = next(link["href"] for link in listed["links"] if link["rel"] == "next")
    older = json.loads(service.request("GET", following[following.index("/jobs"):])[1])
    check(len(listed["jobs"]) == 2 and older["jobs"][0]["created"] <= listed["jobs"][1]["created"], "jobs are listed in pages")


def check_cut_upload(service):
    """A client that leaves within its upload leaves nothing."""
    before = {entry.name for entry in (service.folder / "data" / "jobs").iterdir()}
    connection = http.client.HTTPConnection("127.0.0.1", service.port, timeout=10)
    connection.putrequest("POST", "/jobs?collection=cut")
    connection.putheader("Content-Length", "100000000")
    connection.endheaders()
    connection.send(b"{" * 3_000_000)
    time.sleep(0.3)
    connection.close()
    end = time.monotonic() + 10
    while time.monotonic() < end and {e.name for e in (service.folder / "data" / "jobs").iterdir()} != before:
        time.sleep(0.1)
    check({entry.name for entry in (service.folder / "data" / "jobs").iterdir()} == before, "a cut upload leaves nothing")


class Uploader(threading.Thread):
    """Uploads small archives one after the other until told to end, each with a key, and waits for their ends. It
    asks again after an answer that did not come."""

    def __init__(self, service, number):
        super().__init__(daemon=True)
        self.service, self.number, self.is_over = service, number, threading.Event()
        self.states = {}  # by name: the id and the last status of the job

    def persistently(self, ask):
        """What `ask` returns, again until it does; nothing after five minutes. A job waits for others, and each
        begins anew after a kill; with sanitizers its hard solid takes 15 s."""
        end = time.monotonic() + 300
        while time.monotonic() < end:
            try:
                answer = ask()
                if answer is not None:
                    return answer
            except (OSError, http.client.HTTPException, ValueError):
                pass
            time.sleep(0.05)
        return None

    def run(self):
        count = 0
        while not self.is_over.is_set():
            count += 1
            name = f"u{self.number}-{count}"
            members = {f"{part}.city.jsonl": box_document(60, f"{name}-{part}-") for part in range(3)}
            members["hard.city.jsonl"] = sequence([hard_feature(f"{name}-hard")])
            body = archive(members)

            def upload():
                status, made = start_job(self.service, body, {"Idempotency-Key": name}, collection="siege", name=name,
                                         invalid="keep")
                return made["jobID"] if status in (200, 201) else None

            def end_of(job):
                state = job_of(self.service, job)
                return state["status"] if state["status"] in OVER else None

            job = self.persistently(upload)
            self.states[name] = (job, self.persistently(lambda: end_of(job)) if job else None)


def kill_helpers(service):
    """Kills the helper processes of a service, as soon as there is one; how many there were. The service may have
    been started just before, and reads two documents again before a solid needs a helper."""
    end = time.monotonic() + 120
    while time.monotonic() < end:
        killed = 0
        for status in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                name, _, rest = status.read_text().partition("(")[2].rpartition(")")
                if name.startswith("watertight-work") and int(rest.split()[1]) == service.process.pid:
                    os.kill(int(status.parent.name), signal.SIGKILL)
                    killed += 1
            except (OSError, ValueError):
                pass  # it has ended
        if killed:
            return killed
        time.sleep(0.01)
    return 0


def check_kills(service, rounds, seed):
    chance = random.Random(seed)
    uploaders = [Uploader(service, number) for number in range(2)]
    for uploader in uploaders:
        uploader.start()
    kinds = ("service", "helpers", "database", "stop")
    deeds = dict.fromkeys(kinds, 0)
    for number in range(rounds):
        time.sleep(chance.uniform(0.3, 1.5))
        deed = kinds[number % len(kinds)]
        deeds[deed] += kill_helpers(service) if deed == "helpers" else 1
        if deed == "database":
            try:
                os.kill(service.postmaster(), signal.SIGKILL)
            except (ProcessLookupError, FileNotFoundError, ValueError, IndexError):
                pass  # it is starting
        elif deed == "helpers":
            pass  # done
        elif deed == "service":
            service.process.kill()
            service.process.wait()
            service.start()
        else:
            service.stop()
            service.start()
    for uploader in uploaders:
        uploader.is_over.set()
    for uploader in uploaders:
        uploader.join()
    jobs = {name: state for uploader in uploaders for name, state in uploader.states.items()}
    states = {state for _, state in jobs.values()}
    check(states == {"successful"}, f"{len(jobs)} jobs after {deeds}: {states}")
    check(len({job for job, _ in jobs.values()}) == len(jobs), "each key made one job")
    status, body = service.request("GET", "/collections/siege/export?f=cityjsonseq", timeout=300)
    ids = [json.loads(line)["id"] for line in body.decode().splitlines()[1:]]
    wanted = {f"{name}-{part}-{n}" for name in jobs for part in range(3) for n in range(60)}
    wanted |= {f"{name}-hard" for name in jobs}
    check(rounds < len(kinds) or deeds["helpers"] > 0, f"helper processes were killed: {deeds['helpers']}")
    hard = [json.loads(service.request("GET", f"/collections/siege/items/{name}-hard?f=proof")[1]) for name in jobs]
    proven = sum(solid["proven"] for proof in hard for solid in proof["solids"])
    check(all(len(proof["solids"]) == 1 for proof in hard) and proven > 0,
          f"of {len(hard)} hard solids {proven} are proven; the others are kept as they came")
    check(len(ids) == len(set(ids)) and wanted == set(ids), f"{len(ids)} features, each once; {len(wanted - set(ids))} lost")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("examples", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--boxes", type=int, default=60_000, help="features of the long job")
    options = parser.parse_args()
    examples = options.examples.resolve()
    with temporary_folder("jobs") as folder, Service(options.program, folder) as service:
        service.run("ingest", "--collection", "first", "--invalid", "keep", "--quiet", str(examples / "delft.city.jsonl"), code=1)
        status, body = service.request("GET", "/collections/first/export?f=wt")
        (service.folder / "town.wt").write_bytes(body)
        check_kinds(service, examples)
        check_following(service, options.boxes)
        check_cut_upload(service)
        check_kills(service, options.rounds, options.seed)
        log = (service.folder / "log").read_text()
        check("status=500" not in log, "nothing was a defect of the service")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
