#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The bytes of whole documents as Watertight files, beside those of general compressors.

    whole_files.py WATERTIGHT FILE...

Each document is encoded with everything kept (`encode --invalid keep`), decoded and compared. Prints a
table in Markdown, the sums by kind of document, and the documents that did not come back. Documents of at
most 4,000 bytes, and those that encode refuses, are left out. Exit status: 1 if one did not come back.
"""
import pathlib
import subprocess
import sys
import tempfile

SMALLEST = 4000


def compressed(command, path):
    return len(subprocess.run([*command, path], capture_output=True, check=True).stdout)


def measure(watertight, path, folder):
    """Bytes of the document, gzip, zstd, xz and .wt, and whether it came back; None if refused."""
    packed = folder / "x.wt"
    packed.unlink(missing_ok=True)
    subprocess.run([watertight, "encode", path, "-o", packed, "--invalid", "keep"], capture_output=True)
    if not packed.exists():
        return None
    back = folder / ("back" + "".join(path.suffixes[-2:]))
    back.unlink(missing_ok=True)
    decoded = subprocess.run([watertight, "decode", packed, "-o", back], capture_output=True)
    is_same = decoded.returncode == 0 and back.read_bytes() == path.read_bytes()
    sizes = [path.stat().st_size] + [compressed(command, path) for command in
                                     (["gzip", "-9c"], ["zstd", "-19", "-qc"], ["xz", "-9ec"])]
    return sizes + [packed.stat().st_size, is_same]


def main():
    watertight, *names = sys.argv[1:]
    rows, refused = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            path = pathlib.Path(name)
            if path.stat().st_size <= SMALLEST:
                continue
            measured = measure(watertight, path, pathlib.Path(folder))
            if measured is None:
                refused.append(path.name)
            else:
                rows.append((path, measured))
    rows.sort(key=lambda row: -row[1][3])
    print("| document | bytes | gzip -9 | zstd -19 | xz -9e | .wt | of xz |")
    print("|---|---|---|---|---|---|---|")
    for path, (size, gzip, zstd, xz, packed, _) in rows:
        print(f"| {path.name} | {size:,} | {gzip:,} | {zstd:,} | {xz:,} | {packed:,} | {100 * packed / xz:.1f} % |")
    print()
    for kind in ("json", "xml"):
        chosen = [row for path, row in rows if ("json" in path.suffix) == (kind == "json")]
        if not chosen:
            continue
        sums = [sum(row[i] for row in chosen) for i in range(5)]
        worst = max(row[4] / row[3] for row in chosen)
        print(f"{kind}: {len(chosen)} documents, {sums[0]:,} bytes; gzip {sums[1]:,}, zstd {sums[2]:,}, xz {sums[3]:,}, "
              f".wt {sums[4]:,} = {100 * sums[4] / sums[3]:.1f} % of xz; worst {100 * worst:.1f} %")
    different = [path.name for path, row in rows if not row[5]]
    print("refused:", ", ".join(refused) or "none")
    print("did not come back:", ", ".join(different) or "none")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
