#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sends mutated requests to a service and looks at every answer.

    mutations.py PROGRAM [--requests N] [--seed S]

Each request is a valid one of any route with some of its bytes changed, lost, doubled, swapped or
replaced by words of a dictionary, on a connection of its own. Requires that each answer is HTTP with
a status other than 500, or none; that the service still answers at the end, with no message of a
sanitizer in its log; and that its memory in the second half of the run grows by less than a tenth.
Prints the statuses; exit code 1 after a violation, with the request.
"""
import argparse
import collections
import multiprocessing
import pathlib
import random
import re
import socket
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from service import Service, box_document, box_feature, temporary_folder  # noqa: E402

WORDS = [b"\r\n", b"\0", b"\x80", b"\xff\xfe", b"%00", b"%2e%2e", b"../", b"%", b"?", b"#", b"Host: a\r\n",
         b"Content-Length: 5\r\n", b"Content-Length: -1\r\n", b"Content-Length: 99999999999999999999\r\n",
         b"Transfer-Encoding: chunked\r\n", b"Transfer-Encoding: gzip\r\n", b"Expect: 100-continue\r\n",
         b"Range: bytes=0-1\r\n", b"If-Match: \"1-blob\"\r\n", b"If-None-Match: *\r\n", b"Origin: http://a\r\n",
         b"HTTP/1.0", b"HTTP/2.0", b"1e999", b"NaN", b"-0", b"{", b"[", b"]", b"\"", b"null", b"9" * 40,
         b"\xed\xa0\x80", b"&limit=18446744073709551616", b"&bbox=1,2,3,4", b"ffffffffffffffff\r\n", b"0\r\n\r\n"]


SENDERS = 8
SILENCE = 0.1  # seconds without an answer after which a client closes its side


def request(method, target, fields=(), body=b""):
    lines = [f"{method} {target} HTTP/1.1", "Host: localhost", *fields]
    if body or method in ("POST", "PATCH"):
        lines.append(f"Content-Length: {len(body)}")
    return "\r\n".join(lines).encode() + b"\r\n\r\n" + body


def seeds():
    document = box_document(2, "m")
    item = "/collections/town/items/b1"
    json_type = ["Content-Type: application/city+json-seq"]
    found = [request("GET", target) for target in (
        "/", "/api", "/healthz", "/readyz", "/collections?limit=2&after=a", "/collections/town",
        "/collections/town/items?limit=3&after=b0", "/collections/town/export?f=wt", "/collections/town/export?f=cityjsonseq",
        "/collections/town/items?bbox=0,0,9,9&bbox-crs=http://www.opengis.net/def/crs/EPSG/0/7415",
        item, item + "?f=obj", item + "?f=wt", item + "?f=blob&solid=0", item + "?f=cityjsonseq")]
    found += [request("GET", item, [field]) for field in (
        "Range: bytes=2-9", "If-None-Match: \"1-cityjson\", W/\"2-wt\"", "If-Match: *", "Accept: model/obj;q=0.5, */*;q=0.1")]
    found += [request("POST", "/collections/town/items", json_type, document),
              request("POST", "/collections/town/items?invalid=skip", json_type + ["If-None-Match: *"], document),
              request("POST", "/validate?planarity=0.1&strict=true", json_type, document),
              request("POST", "/collections/town/items", ["Content-Type: application/json"], box_feature("m9", 9).encode()),
              request("POST", "/collections/town/recount"),
              request("PATCH", "/collections/other", [], b'{"id":"another"}'),
              request("DELETE", "/collections/town/items/m1", ["If-Match: \"3-blob\""]),
              request("DELETE", "/collections/gone"), request("OPTIONS", "/validate"), request("HEAD", item)]
    chunks = b"".join(b"%x\r\n%s\r\n" % (len(document[i:i + 300]), document[i:i + 300])
                      for i in range(0, len(document), 300)) + b"0\r\n\r\n"
    found.append(b"POST /validate HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n" + chunks)
    return found


def mutated(choice, pool):
    data = bytearray(choice.choice(pool))
    # Half of the requests stay whole in their first line, so that they come past the parser.
    first = data.index(b"\r\n") + 2 if choice.random() < 0.5 else 0
    first = data.index(b" ") + 2 if first and len(data) < 300 else first
    for _ in range(choice.choice((1, 1, 2, 3, 8))):
        if len(data) <= first:
            break
        at = choice.randrange(first, len(data))
        kind = choice.randrange(7)
        if kind == 0:
            data[at] = choice.randrange(256)
        elif kind == 1:
            data[at] ^= 1 << choice.randrange(8)
        elif kind == 2:
            del data[at:at + choice.choice((1, 2, 10, 200))]
        elif kind == 3:
            data[at:at] = choice.choice(WORDS)
        elif kind == 4:
            word = choice.choice(WORDS)
            data[at:at + len(word)] = word
        elif kind == 5:
            end = at + choice.randrange(40)
            data[at:at] = data[at:end]
        else:
            other = choice.choice(pool)
            data[at:] = other[choice.randrange(len(other)):]
    return bytes(data)


def is_whole(received):
    """Whether the first answer has come as a whole, as far as its header tells."""
    head, end, body = received.partition(b"\r\n\r\n")
    if not end:
        return False
    length = re.search(rb"\r\nContent-Length: (\d+)", head)
    if length:
        return len(body) >= int(length[1]) or data_less(head)
    return body.endswith(b"0\r\n\r\n") if b"chunked" in head else data_less(head)


def data_less(head):
    return head[9:12] in (b"204", b"304", b"100")


def answer_to(port, data):
    """The first bytes of the answer; none if the connection was closed without one. The client closes its
    side when it has the answer, or after a moment of silence, as the request may lack its end."""
    with socket.create_connection(("127.0.0.1", port), timeout=60) as connection:
        received = b""
        try:
            connection.sendall(data)
            connection.settimeout(SILENCE)
            is_open = True
            while True:
                try:
                    piece = connection.recv(65536)
                except TimeoutError:
                    if not is_open:
                        raise
                    is_open = False
                    connection.shutdown(socket.SHUT_WR)
                    connection.settimeout(60)
                    continue
                received += piece
                if not piece or is_whole(received):
                    break
        except (ConnectionResetError, BrokenPipeError):
            pass
    return received


def send_many(port, seed, count, results):
    choice = random.Random(seed)
    pool = seeds()
    statuses = collections.Counter()
    for number in range(count):
        data = mutated(choice, pool)
        try:
            received = answer_to(port, data)
        except OSError as failure:
            results.put((statuses, f"request {number}: {failure}: {data[:2000]!r}"))
            return
        status = received[9:12].decode("latin-1") if received.startswith(b"HTTP/1.") else "none" if not received else "odd"
        statuses[status] += 1
        if status in ("500", "odd"):
            results.put((statuses, f"request {number}: {received[:600]!r} to {data[:2000]!r}"))
            return
    results.put((statuses, None))


def resident_megabytes(pid):
    """The resident memory of a process."""
    status = pathlib.Path(f"/proc/{pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+) kB", status)[1]) // 1024


def run(options, folder):
    statuses = collections.Counter()
    memory = []
    with Service(options.program, folder) as service:
        for name in ("town", "other", "gone"):
            service.post(name, box_document(5))
        for half in range(2):
            results = multiprocessing.Queue()
            senders = [multiprocessing.Process(target=send_many, args=(
                service.port, options.seed * 100 + half * 10 + n, options.requests // (2 * SENDERS), results)) for n in range(SENDERS)]
            for sender in senders:
                sender.start()
            for _ in senders:
                counted, complaint = results.get()
                statuses += counted
                if complaint:
                    print(f"mutations: {complaint}", file=sys.stderr)
                    return 1
            for sender in senders:
                sender.join()
            if service.request("GET", "/healthz")[0] != 200:
                print("mutations: the service is not healthy at the end", file=sys.stderr)
                return 1
            memory.append(resident_megabytes(service.process.pid))
        service.stop()
        log = (folder / "log").read_text(errors="replace")
    print(f"{sum(statuses.values())} requests: {dict(sorted(statuses.items()))}; "
          f"memory after each half {memory[0]} and {memory[1]} MB")
    for sign in ("ERROR: AddressSanitizer", "runtime error:", "LeakSanitizer", "terminate called"):
        if sign in log:
            print(f"mutations: the log has: {log[log.index(sign) - 200:][:3000]}", file=sys.stderr)
            return 1
    if memory[1] > memory[0] * 1.1 + 10:
        print("mutations: the memory grows", file=sys.stderr)
        return 1
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--requests", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with temporary_folder("mutations") as folder:
        return run(options, folder)


if __name__ == "__main__":
    sys.exit(main())
