#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A static file server with byte ranges (RFC 9110) that counts its requests and the bytes of its
answers. For the tests and benches of files that are read in ranges."""
import http.server
import pathlib
import re
import threading


class RangeServer:
    """Serves a folder on a free port of the loopback address.

    kind  "ranges": like any server of static files; "whole": it knows no ranges;
          "other": it answers with another range than the one that was asked for
    """

    def __init__(self, folder, kind="ranges"):
        self.folder = pathlib.Path(folder)
        self.kind = kind
        self.requests = 0
        self.bytes = 0
        self.on_request = None  # called with the number of the request before it is answered
        self.tags = {}          # the tag of a file, if it is not that of its bytes

    def __enter__(self):
        outer = self

        class Handler(http.server.BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self):
                outer.answer(self)

            def log_message(self, *_):
                pass

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.server.handle_error = lambda *_: None  # a client that hangs up
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.server.server_address[1]}/"
        return self

    def __exit__(self, *_):
        self.server.shutdown()
        self.server.server_close()

    def reset(self):
        self.requests = self.bytes = 0

    def answer(self, handler):
        self.requests += 1
        if self.on_request:
            self.on_request(self.requests)
        name = handler.path.lstrip("/")
        if name.startswith("moved/"):
            handler.send_response(302)
            handler.send_header("Location", "/" + name[len("moved/"):])
            handler.send_header("Content-Length", "0")
            handler.end_headers()
            return
        path = self.folder / name
        if not path.is_file():
            handler.send_error(404)
            return
        data = path.read_bytes()
        tag = self.tags.get(name, f'"{hash(data):x}"')
        status, body, place = self.part(data, handler.headers, tag)
        handler.send_response(status)
        handler.send_header("Content-Length", str(len(body)))
        handler.send_header("ETag", tag)
        if place:
            handler.send_header("Content-Range", place)
        handler.end_headers()
        handler.wfile.write(body)
        self.bytes += len(body)

    def part(self, data, headers, tag):
        wanted = re.fullmatch(r"bytes=(\d*)-(\d*)", headers.get("Range", ""))
        if self.kind == "whole" or not wanted or headers.get("If-Range", tag) != tag:
            return 200, data, None
        if wanted[1] == "":
            first, last = max(0, len(data) - int(wanted[2])), len(data) - 1
        else:
            first, last = int(wanted[1]), min(int(wanted[2] or len(data)), len(data) - 1)
        if first > last:
            return 416, b"", f"bytes */{len(data)}"
        if self.kind == "other" and wanted[1] != "":
            first += 1
            last += 1
        return 206, data[first:last + 1], f"bytes {first}-{last}/{len(data)}"
