# SPDX-License-Identifier: GPL-3.0-or-later
"""The packed texts in a Watertight file, from docs/format-file.md."""
from entropy import crc32c, varint
from mixer import require

HEAD = b"\x89WTF\r\n\x1a\n\x03"
BLOCK, DOCUMENTS, INDEX, COMMIT = range(4)


def records(data):
    """The kinds and payloads of the records of a file."""
    require(data[:9] == HEAD, "the head of a file")
    at = 9
    while at < len(data):
        begin = at
        head, at = varint(data, at)
        payload = data[at:at + head // 4]
        at += len(payload)
        checksum = int.from_bytes(data[at:at + 4], "little")
        require(crc32c(HEAD + data[begin:at]) == checksum, "the checksum of a record")
        at += 4
        if head % 4 == COMMIT:
            size = len(data[begin:at])
            length = bytearray()
            while True:
                length.append(size & 127 | (128 if size > 127 else 0))
                size >>= 7
                if not size:
                    break
            require(data[at:at + len(length)] == bytes(reversed(length)), "the length of a commit")
            at += len(length)
        yield head % 4, payload


def packed_texts(data):
    """The packed texts of all blocks of a file, and of its documents."""
    found = []
    for kind, payload in records(data):
        if kind in (BLOCK, DOCUMENTS):
            size, at = varint(payload, 0)
            found.append(payload[at:at + size])
    return found
