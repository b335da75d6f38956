# SPDX-License-Identifier: GPL-3.0-or-later
"""What the programs of this folder share that compare the product with other programs."""
import subprocess

failures = []


def check(is_right, message):
    print(("ok: " if is_right else "WRONG: ") + message, flush=True)
    if not is_right:
        failures.append(message)


def run(*words, **options):
    """What a program prints; the end if it fails."""
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, check=False, **options)
    if done.returncode != 0:
        raise SystemExit(f"{words[0]} failed: {done.stderr[-2000:]} {done.stdout[-500:]}")
    return done.stdout
