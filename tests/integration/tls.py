#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Speaks HTTPS with a running service, as curl and OpenSSL do: tls.py WATERTIGHT DOCUMENT.city.jsonl

A certificate that does not fit stops the service before it makes a database. Old versions of TLS, plain HTTP and
clients that stay silent get nothing and stop nobody. Exit code 1 after a difference.
"""
import json
import os
import pathlib
import socket
import subprocess
import sys
import time

PROGRAM, DOCUMENT = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../siege"))
from checks import check, failures, run  # noqa: E402
from service import Service, temporary_folder  # noqa: E402

SILENT = 300


def new_certificate(folder, name):
    key, certificate = folder / f"{name}.key", folder / f"{name}.pem"
    run("openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
        "-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost,IP:127.0.0.1", "-keyout", str(key), "-out",
        str(certificate))
    key.chmod(0o644)  # the service of this test is not root
    return certificate, key


def check_refusals(folder, certificate, key):
    other = new_certificate(folder, "other")[1]
    for words, message in (
            (["--tls-certificate", certificate], "--tls-key"), (["--tls-key", key], "--tls-certificate"),
            (["--tls-certificate", certificate, "--tls-key", folder / "none"], "none"),
            (["--tls-certificate", key, "--tls-key", key], "certificate"),
            (["--tls-certificate", certificate, "--tls-key", other], "key")):
        error = Service(PROGRAM, folder, [str(word) for word in words]).refusal()
        check(message in error, f"the service does not start: {error.strip()}")


class Client:
    """curl, which trusts the certificate."""

    def __init__(self, certificate, port):
        self.words = ["curl", "-sS", "--max-time", "240", "--cacert", str(certificate)]
        self.base = f"https://localhost:{port}"

    def ask(self, path, *words):
        return run(*self.words, *words, self.base + path)

    def status(self, path, *words):
        return int(self.ask(path, "-o", "/dev/null", "-w", "%{http_code}", *words))


def check_requests(client, folder):
    check(client.status("/collections/town/items?invalid=keep", "--data-binary", f"@{DOCUMENT}", "-H",
                        "Content-Type: application/city+json-seq") == 201, "a document is stored")
    landing = json.loads(client.ask("/?f=json"))
    check(all(link["href"].startswith("https://localhost:") for link in landing["links"]), "links begin with https")
    target = folder / "town.jsonl"
    client.ask("/collections/town/export?f=cityjsonseq", "-o", str(target))
    lines = target.read_text().splitlines()
    check(len(lines) == len(DOCUMENT.read_text().splitlines()), f"an export in parts has all {len(lines)} lines")
    again = client.ask("/healthz", "-w", "%{num_connects}\n", client.base + "/readyz").splitlines()
    check("0" in again[-1], "a second request uses the connection of the first")
    check(client.status("/", "--tls-max", "1.2") == 200, "TLS 1.2 is spoken")
    check(client.status("/collections/town/items/none") == 404, "a problem arrives")


def check_strangers(client, port):
    old = subprocess.run(["openssl", "s_client", "-connect", f"127.0.0.1:{port}", "-tls1_1", "-cipher", "ALL:@SECLEVEL=0"],
                         input="", capture_output=True, text=True, timeout=30, check=False)
    check("Cipher is (NONE)" in old.stdout, "TLS 1.1 is not spoken")
    with socket.create_connection(("127.0.0.1", port), timeout=30) as plain:
        plain.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
        answer = plain.recv(4096)
        check(b"HTTP/1.1" not in answer, "plain HTTP gets no answer")
    silent = [socket.create_connection(("127.0.0.1", port), timeout=30) for _ in range(SILENT)]
    for number, connection in enumerate(silent):
        connection.sendall(b"\x16\x03\x01\x02\x00" if number % 2 else b"\x16")  # the start of a greeting
    start = time.monotonic()
    check(client.status("/healthz") == 200 and time.monotonic() - start < 2, f"{SILENT} silent clients keep nobody waiting")
    ended = 0
    for connection in silent:
        connection.settimeout(20)
        try:
            while connection.recv(4096):
                pass
            ended += 1
        except ConnectionResetError:
            ended += 1
        except TimeoutError:
            pass
        connection.close()
    check(ended == SILENT and time.monotonic() - start < 20, f"{ended} silent clients were given up after {time.monotonic() - start:.0f} s")


def main():
    with temporary_folder("tls") as folder:
        certificate, key = new_certificate(folder, "own")
        check_refusals(folder, certificate, key)
        check(not (folder / "data").exists(), "a service that does not start makes no database")
        with Service(PROGRAM, folder, ["--tls-certificate", str(certificate), "--tls-key", str(key)]) as service:
            client = Client(certificate, service.port)
            check_requests(client, folder)
            check_strangers(client, service.port)
            follower = subprocess.Popen([*client.words, "--limit-rate", "100K", "-o", "/dev/null",
                                         client.base + "/collections/town/export?f=cityjsonseq"])
            time.sleep(2)
            seconds = service.stop()
            check(follower.wait(timeout=60) == 0 and seconds < 30, f"a stop waits for the answers in work ({seconds:.1f} s)")
    print(f"{len(failures)} differences")
    sys.exit(1 if failures else 0)


main()
