#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""check_report.py WRITE_REPORTS ROOT

Opens the HTML report of golden samples in headless Chromium, works it with a script, and compares
what the page then holds with the JSON report of the same files. Exit status 77: no Chromium.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# The script that runs in the page after the page's own; it leaves its observations in the title.
PROBE = """<script>
window.addEventListener('load', function () {
  var seen = {}, search = document.getElementById('search'), code = document.getElementById('code');
  function rows() { return document.querySelectorAll('.findings tbody tr:not([hidden])').length; }
  seen.rows = rows();
  seen.pictures = document.querySelectorAll('figure[data-scene] svg').length;
  seen.paths = document.querySelectorAll('figure[data-scene] svg path').length;
  code.value = '306'; code.dispatchEvent(new Event('change')); seen.filtered = rows();
  code.value = ''; search.value = 'no such words'; search.dispatchEvent(new Event('input'));
  seen.none = rows();
  search.value = ''; search.dispatchEvent(new Event('input')); seen.all = rows();
  document.querySelector('th button[data-key=code]').click();
  document.querySelector('th button[data-key=code]').click();
  seen.first = document.querySelector('.findings tbody tr').dataset.code;
  document.querySelector('figure[data-scene]').click();
  var dialog = document.querySelector('dialog');
  seen.open = dialog.open; seen.drawn = dialog.querySelectorAll('svg path').length;
  seen.overflow = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  document.title = 'SEEN' + JSON.stringify(seen);
});
</script>"""


def main():
    program, root = sys.argv[1], pathlib.Path(sys.argv[2])
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if browser is None:
        print("no chromium")
        return 77
    samples = sorted((root / "tests/golden/findings").glob("[1-4]*.city.json"))

    def report(kind):
        return subprocess.run([program, kind, *map(str, samples)], capture_output=True,
                              check=True).stdout.decode("utf-8")

    findings = [finding for line in report("json").splitlines()
                for feature in json.loads(line)["features"]
                for finding in feature["errors"] + feature["warnings"]]
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "report.html"
        page.write_text(report("html").replace("</body>", PROBE + "</body>"), encoding="utf-8")
        for width in (1280, 500):
            dom = subprocess.run(
                [browser, "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom",
                 f"--user-data-dir={folder}/profile", f"--window-size={width},900",
                 "--virtual-time-budget=5000", page.as_uri()],
                capture_output=True, timeout=120, check=False).stdout.decode("utf-8")
            found = re.search(r"<title>SEEN(.*?)</title>", dom)
            if found is None:
                failures.append(f"{width}: the page's script did not finish")
                continue
            seen = json.loads(found.group(1).replace("&quot;", '"').replace("&amp;", "&"))
            expected = {
                "rows": len(findings), "all": len(findings), "none": 0,
                "filtered": sum(finding["code"] == 306 for finding in findings),
                "first": str(max(finding["code"] for finding in findings)),
                "open": True, "overflow": False}
            failures += [f"{width}: {name} is {seen[name]}, not {value}"
                         for name, value in expected.items() if seen[name] != value]
            if seen["pictures"] < 0.8 * len(findings):
                failures.append(f"{width}: {seen['pictures']} pictures of {len(findings)} findings")
            if seen["paths"] < 4 * seen["pictures"] or seen["drawn"] < 4:
                failures.append(f"{width}: pictures are empty")
    print("\n".join(failures) or f"{len(findings)} findings shown")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
