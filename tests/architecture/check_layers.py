#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The layer check: fails on anything that breaks the layout docs/architecture.md describes.

    check_layers.py ROOT          checks the tree and prints one line per violation
    check_layers.py --self-test   breaks a small tree in every way there is a rule for, and fails
                                  unless each break is found

Rules, one function each:
  layers       a folder includes only itself, base, and the folders its CMakeLists.txt DEPENDS on
  modes        no mode of the codec includes another, nor a header that does
  existence    a quoted include of the product names a file from the repository's root (tests and
               benches may also name a header beside them)
  homes        third-party headers stay in their folders
  cgal         a header that (transitively) includes CGAL is included by its own folder only
  licence      every source file states its SPDX licence in its first two lines
  places       no file names a path of one machine, or the host of a package registry
  unfinished   no word that marks unfinished work
  length       no source file of the product is longer than 600 lines
  rooms        no folder holds more than 20 headers and sources, no subfolder of codec/ more than 16
  pairs        a source of a subfolder of codec/ has the name of a header beside it, or begins with it
  namespaces   a file of a folder puts its names into the folder's namespace, a file of a mode of the
               codec into the mode's; namespace watertight has base/ and the names that headers
               export to it, which docs/architecture.md lists
  families     the codec's enumerations of model families are in no anonymous namespace
               (codec/entropy/model_layout.h says why)
  names        no two files of the product define one qualified type, constant or function
"""
import collections
import os
import pathlib
import re
import subprocess
import sys
import tempfile

FOLDERS = ["base", "workers", "geometry", "tessellate", "surfaces", "delaunay", "validate", "fill", "spline", "repair", "codec",
           "columns", "archives", "projection", "tiles", "formats", "packing", "store", "cql2", "pipeline", "geopackage", "files", "report", "web", "server", "cli", "sql"]
MAX_LINES = 600
MAX_SOURCES = 20
MAX_SOURCES_OF_CODEC = 16  # the most sources in one subfolder of codec/

# For each pattern of an include: the library it stands for, and patterns of the paths that may
# include it. The first match decides.
HOMES = [
    (r"boost/(?!multiprecision)", "Boost", [r"server/", r"tests/builds/"]),
    (r"spdlog/", "spdlog", [r"server/"]),
    (r"prometheus/", "prometheus-cpp", [r"server/metrics/"]),
    (r"openssl/", "OpenSSL", [r"server/access/"]),
    (r"(postgresql/)?(libpq-fe|libpq-events)\.h", "libpq",
     [r"store/", r"tests/unit/store/", r"tests/integration/", r"bench/"]),
    (r"nlohmann/", "nlohmann-json",
     [r"formats/", r"tiles/", r"cql2/", r"geopackage/", r"server/", r"cli/", r"validate/report_json", r"report/stored_findings", r"tests/", r"bench/"]),
    (r"CGAL/", "CGAL",
     [r"geometry/", r"tessellate/", r"delaunay/", r"spline/", r"tests/", r"bench/"]),
    (r"Eigen/", "Eigen", [r"spline/", r"tests/unit/spline/", r"bench/"]),
    (r"tetgen\.h", "TetGen", [r"delaunay/", r"bench/"]),
    (r"CLI/", "CLI11", [r"cli/", r"bench/"]),
    (r"lzma\.h", "liblzma", [r"columns/"]),
    (r"sqlite3\.h", "SQLite", [r"geopackage/", r"tests/unit/geopackage/"]),
    (r"(zstd|zstd_errors)\.h", "zstd",
     [r"archives/", r"columns/", r"formats/", r"packing/", r"tests/unit/(archives|cli|server)/", r"bench/"]),
    (r"zlib\.h", "zlib", [r"archives/", r"tests/unit/(archives|cli|server)/"]),
    (r"minizip/", "minizip", [r"archives/"]),
    (r"expat\.h", "expat", [r"formats/"]),
    (r"curl/", "libcurl", [r"cli/remote/"]),
    (r"proj\.h", "PROJ", [r"projection/"]),
    (r"meshoptimizer\.h", "meshoptimizer", [r"tiles/", r"tests/unit/tiles/", r"bench/"]),
    (r"draco/", "Draco", [r"bench/"]),
    (r"(postgres|fmgr|funcapi|miscadmin|varatt)\.h|(utils|catalog|executor|access|lib|mb|port|storage|parser|"
     r"nodes|commands|common|tcop|libpq)/[a-z_]+\.h", "the PostgreSQL server", [r"sql/module/"]),
]

SOURCE = re.compile(r"\.(h|cpp|c)$")
LICENSED = re.compile(r"(\.(h|cpp|c|css|js|cmake|sh|py|sql\.in|toml|ya?ml)|CMakeLists\.txt|Dockerfile|"
                      r"^scripts/[a-z-]+|^\.ci/run)$")
TEXT = re.compile(r"(\.(h|cpp|c|css|js|cmake|sh|py|sql|in|toml|ya?ml|md|json|txt)|Dockerfile|^scripts/[a-z-]+|"
                  r"^\.ci/run)$")
# The patterns are written in pieces, so that this file does not match them itself.
MACHINE = re.compile(r"(?<![\w.])/" + r"(work/(main|shared)|root/|home/[a-z]+/|tmp/build-)"
                     r"|https?://" + r"(deb|registry|snapshot|ftp)\.")
UNFINISHED = re.compile(r"\b(TO" + r"DO|FIX" + r"ME|XX" + r"X|HA" + r"CK)\b")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.M)


def repository_files(root):
    """Paths relative to root: files that git tracks or would track; without git, every file outside
    of builds."""
    try:
        out = subprocess.run(
            ["git", "-c", f"safe.directory={root}", "-C", str(root), "ls-files", "-z", "--cached",
             "--others", "--exclude-standard"],
            capture_output=True, check=True).stdout.decode()
        names = [name for name in out.split("\0") if name]
    except (OSError, subprocess.CalledProcessError):
        names = []
    if not names:
        for directory, subdirectories, files in os.walk(root):
            subdirectories[:] = [d for d in subdirectories
                                 if d not in (".git", "data") and not d.startswith("build")]
            names += [os.path.relpath(os.path.join(directory, file), root) for file in files]
    return sorted(name for name in set(names) if (root / name).is_file())


def declared_depends(root):
    """For each folder, the set of folders it may include, from watertight_folder(... DEPENDS
    ...)."""
    depends = {}
    for folder in FOLDERS:
        path = root / folder / "CMakeLists.txt"
        if not path.is_file():
            continue
        text = re.sub(r"#.*", "", path.read_text())
        call = re.search(r"watertight_folder\(\s*(\w+)([^)]*)\)", text)
        if not call or call.group(1) != folder:
            depends[folder] = None
            continue
        declared = re.search(r"\bDEPENDS\b([^A-Z]*)", call.group(2))
        depends[folder] = set(declared.group(1).split()) if declared else set()
    return depends


class Tree:
    def __init__(self, root):
        self.root = root
        self.files = repository_files(root)
        self.text = {}
        for name in self.files:
            if TEXT.search(name) or SOURCE.search(name) or LICENSED.search(name):
                self.text[name] = (root / name).read_text(encoding="utf-8", errors="replace")
        self.includes = {name: INCLUDE.findall(text) for name, text in self.text.items()
                         if SOURCE.search(name)}
        self.depends = declared_depends(root)


def folder_of(name):
    head = name.split("/", 1)[0]
    return head if head in FOLDERS else None


def check_layers(tree):
    for folder, allowed in tree.depends.items():
        if allowed is None:
            yield f"{folder}/CMakeLists.txt: layers: does not call watertight_folder({folder} ...)"
            continue
        for other in sorted(allowed - set(FOLDERS)):
            yield f"{folder}/CMakeLists.txt: layers: DEPENDS on unknown folder '{other}'"
    for name, includes in tree.includes.items():
        folder = folder_of(name)
        if folder is None or tree.depends.get(folder) is None:
            continue
        allowed = tree.depends[folder] | {folder, "base"}
        for _, path in includes:
            target = folder_of(path) if "/" in path else None
            # A third-party header may be in a folder of the same name (e.g. <server/...>): only
            # files of this repository count.
            if target and path in tree.text and target not in allowed:
                yield f"{name}: layers: includes \"{path}\", but {folder} does not declare {target}"


MODE = re.compile(r"codec/(mode_\w+)/")


def check_modes(tree):
    for name in tree.includes:
        own = MODE.match(name)
        seen, pending = {name}, [name] if own else []
        while pending:
            for _, path in tree.includes[pending.pop()]:
                if path in seen or path not in tree.includes:
                    continue
                seen.add(path)
                pending.append(path)
                other = MODE.match(path)
                if other and own.group(1) != other.group(1):
                    yield f"{name}: modes: includes \"{path}\" of another mode, at least through a header"


def check_existence(tree):
    for name, includes in tree.includes.items():
        if folder_of(name) is None:
            continue
        for quote, path in includes:
            if quote != '"' or path in tree.text or path.endswith((".inc", ".ipp")):
                continue
            if name.startswith("sql/module/") and is_home_header(path):
                continue
            yield f"{name}: existence: \"{path}\" is not a file of the repository (paths start at its root)"


def is_home_header(path):
    return any(re.match(pattern, path) for pattern, _, _ in HOMES)


def check_homes(tree):
    for name, includes in tree.includes.items():
        for _, path in includes:
            if path in tree.text:
                continue
            for pattern, what, homes in HOMES:
                if re.match(pattern, path):
                    if not any(re.match(home, name) for home in homes):
                        yield f"{name}: homes: includes <{path}>, but {what} has its home elsewhere"
                    break


def check_cgal(tree):
    tainted = {name for name, includes in tree.includes.items()
               if any(path.startswith("CGAL/") for _, path in includes)}
    while True:
        more = {name for name, includes in tree.includes.items()
                if name not in tainted and any(path in tainted for _, path in includes)}
        if not more:
            break
        tainted |= more
    for name, includes in tree.includes.items():
        if folder_of(name) is None:
            continue
        for _, path in includes:
            if path in tainted and path.endswith(".h") and folder_of(path) != folder_of(name):
                yield f"{name}: cgal: includes \"{path}\", which brings CGAL out of its folder"


def check_licence(tree):
    for name in tree.files:
        if name.startswith("web/dist/"):
            continue  # made of web/src and of parts of others (web/THIRD-PARTY.md)
        if LICENSED.search(name) and name in tree.text and tree.text[name].strip():
            if not any("SPDX-License-Identifier:" in line
                       for line in tree.text[name].split("\n", 2)[:2]):
                yield f"{name}: licence: no SPDX-License-Identifier in the first two lines"


def check_places(tree):
    for name, text in tree.text.items():
        for number, line in enumerate(text.split("\n"), 1):
            found = MACHINE.search(line)
            if found:
                yield f"{name}:{number}: places: names '{found.group(0)}'"


def check_unfinished(tree):
    for name, text in tree.text.items():
        if not (SOURCE.search(name) or LICENSED.search(name)):
            continue
        for number, line in enumerate(text.split("\n"), 1):
            found = UNFINISHED.search(line)
            if found:
                yield f"{name}:{number}: unfinished: says '{found.group(0)}'"


def check_length(tree):
    for name in tree.includes:
        lines = tree.text[name].count("\n")
        if lines > MAX_LINES:
            yield f"{name}: length: {lines} lines, at most {MAX_LINES}"


def check_rooms(tree):
    rooms = collections.Counter(os.path.dirname(name) for name in tree.includes)
    for room, sources in sorted(rooms.items()):
        most = MAX_SOURCES_OF_CODEC if room.startswith("codec/") else MAX_SOURCES
        if sources > most:
            yield f"{room}: rooms: {sources} headers and sources, at most {most}"


PAIRED = re.compile(r"(codec/\w+)/(\w+)\.cpp$")
# the sources whose functions are declared elsewhere: codec/page/modes.h declares those of each
# mode.cpp
OF_MODES_H = {"mode"}


def check_pairs(tree):
    for name in tree.includes:
        source = PAIRED.match(name)
        if not source or source.group(2) in OF_MODES_H:
            continue
        words = source.group(2).split("_")
        stems = ("_".join(words[:count]) for count in range(1, len(words) + 1))
        if not any(f"{source.group(1)}/{stem}.h" in tree.text for stem in stems):
            yield f"{name}: pairs: no header beside it has its name, or the first words of it"


NAMESPACE = re.compile(r"^(?:inline )?namespace(?: ([\w:]+))? \{")
EXPORT = re.compile(r"^using ([\w:]+)::(\w+);$")
FORWARD = re.compile(r"^(class|struct|enum class) \w+;")
TYPE = re.compile(r"^(?:class|struct|union|enum class|enum)\s+(?:\[\[\w+\]\]\s*)?([\w:]+)(?:\s+final)?\s*[{:]")
ALIAS = re.compile(r"^using (\w+) =")
CONSTANT = re.compile(r"^(?:inline )?constexpr [^({]*?\b(k[A-Z]\w*)\s*(?:\[[^\]]*\]\s*)?[={;]")
NO_FUNCTION = re.compile(r"(#|//|}|template\b|using\b|typedef\b|static\b|extern\b|friend\b|static_assert\b|"
                         r"class\b|struct\b|union\b|enum\b|namespace\b)")
FUNCTION = re.compile(r"^[^=;{]*?((?:\w+::)*(?:operator[^\s\w(]+(?=\()|[a-z_]\w*(?:<[^<>]*>)?))(\(.*)\{$")
LAYERED = re.compile(r"\.(h|cpp)$")


def namespace_of(name):
    """The namespace to which the names of a file belong."""
    parts = name.split("/")
    if parts[0] == "base":
        return "watertight"
    mode = re.match(r"mode_(\w+)$", parts[1]) if parts[0] == "codec" and len(parts) > 2 else None
    return "::".join(["watertight", parts[0]] + ([mode.group(1)] if mode else []))


def namespace_blocks(text):
    """For each namespace block, its name and the lines at the left margin with their numbers;
    nested blocks are listed on their own."""
    stack, blocks = [], []
    for number, line in enumerate(text.split("\n"), 1):
        opened = NAMESPACE.match(line)
        if opened and not line.rstrip().endswith("}"):
            own = opened.group(1) or "(anonymous)"
            path = f"{stack[-1][0]}::{own}" if stack else own
            stack.append((path, []))
            blocks.append(stack[-1])
        elif line.startswith("}") and "namespace" in line and stack:
            stack.pop()
        elif stack:
            stack[-1][1].append((number, line))
    return blocks


def check_namespaces(tree):
    vocabulary = tree.text.get("docs/architecture.md", "")
    for name, text in tree.text.items():
        if folder_of(name) is None or not LAYERED.search(name):
            continue
        expected = namespace_of(name)
        for path, lines in namespace_blocks(text):
            if not path.startswith("watertight") or (path + "::").startswith(expected + "::"):
                continue
            code = [(number, line) for number, line in lines
                    if line.strip() and not line.startswith(("//", " ", "}"))]
            exports = [EXPORT.match(line) for _, line in code]
            if path == "watertight" and name.endswith(".h") and all(exports):
                for export in exports:
                    if f"`{export.group(2)}`" not in vocabulary:
                        yield (f"{name}: namespaces: exports {export.group(2)}, which the vocabulary of "
                               "docs/architecture.md does not list")
            elif name == "codec/page/modes.h" and path.startswith("watertight::codec::"):
                continue  # the functions that every mode must define
            elif not all(FORWARD.match(line) for _, line in code):
                yield f"{name}:{lines[0][0]}: namespaces: {path}, but its names belong to {expected}"


def head_of_definition(lines, start):
    """The lines from `start` up to the brace that opens a body, as one; "" for a declaration."""
    head, depth = "", 0
    for _, line in lines[start:start + 12]:
        for character in line.split("//")[0].rstrip() + " ":
            head += character
            depth += (character in "([") - (character in ")]")
            if depth == 0 and character in "{;":
                return head if character == "{" else ""
    return ""


def types_of(parameters):
    """The types in a list of parameters, without names and default values."""
    parameters = re.sub(r"\s*=[^,)]*", "", re.sub(r"\s+", " ", parameters)).strip()
    return re.sub(r"\s*\b\w+(?=[,)])", "", parameters)


def definitions(text):
    """Qualified names that a file defines outside of anonymous namespaces; functions with types."""
    for path, lines in namespace_blocks(text):
        if "(anonymous)" in path:
            continue
        for at, (number, line) in enumerate(lines):
            found = TYPE.match(line) or ALIAS.match(line) or CONSTANT.match(line)
            if found:
                yield f"{path}::{found.group(1)}", number
                continue
            if not line or line.startswith(" ") or NO_FUNCTION.match(line):
                continue
            found = FUNCTION.match(head_of_definition(lines, at))
            if found:
                yield f"{path}::{found.group(1)}{types_of(found.group(2))}", number


# Each engine is a program of its own that defines this function (delaunay/engines/engine.h).
ONE_IN_EACH_PROGRAM = {"watertight::delaunay::constrained_delaunay(const CdtJob&)"}


def check_names(tree):
    seen = {}
    for name, text in sorted(tree.text.items()):
        if folder_of(name) is None or not LAYERED.search(name):
            continue
        for defined, number in definitions(text):
            other = seen.setdefault(defined, name)
            if other != name and defined not in ONE_IN_EACH_PROGRAM:
                yield f"{name}:{number}: names: {defined} is defined in {other} too"


ENUMERATION = re.compile(r"enum (?:class )?\w*(?:Family|Number)\b")


def check_families(tree):
    for name, text in tree.text.items():
        if not name.startswith("codec/") or name not in tree.includes:
            continue
        for path, lines in namespace_blocks(text):
            for number, line in lines:
                if "(anonymous)" in path and ENUMERATION.match(line):
                    yield f"{name}:{number}: families: in an anonymous namespace, where the linker merges templates"


RULES = [check_layers, check_families, check_modes, check_existence, check_homes, check_cgal, check_licence, check_places,
         check_unfinished, check_length, check_rooms, check_pairs,
         check_namespaces, check_names]


def violations(root):
    tree = Tree(pathlib.Path(root).resolve())
    return [line for rule in RULES for line in rule(tree)]


SPDX = "// SPDX-License-Identifier: GPL-3.0-or-later\n"
GOOD_TREE = {
    "base/CMakeLists.txt": "# SPDX-License-Identifier: X\nwatertight_folder(base SOURCES a.cpp)\n",
    "base/result.h": SPDX + "#pragma once\n#include <string>\n",
    "geometry/CMakeLists.txt":
        "# SPDX-License-Identifier: X\nwatertight_folder(geometry\n  SOURCES b.cpp\n  DEPENDS base\n"
        "  PRIVATE watertight_cgal)\n",
    "geometry/solid.h": SPDX + '#include "base/result.h"\n',
    "geometry/kernel.h": SPDX + "#include <CGAL/Kernel.h>\n",
    "geometry/solid.cpp": SPDX + '#include "geometry/kernel.h"\n#include "geometry/solid.h"\n',
    "store/CMakeLists.txt": "# SPDX-License-Identifier: X\nwatertight_folder(store DEPENDS base)\n",
    "store/store.cpp": SPDX + "#include <libpq-fe.h>\n",
    "codec/CMakeLists.txt": "# SPDX-License-Identifier: X\nwatertight_folder(codec DEPENDS base geometry)\n",
    "codec/blob.cpp": SPDX + '#include "geometry/solid.h"\n',
    "formats/CMakeLists.txt": "# SPDX-License-Identifier: X\nwatertight_folder(formats DEPENDS base)\n",
    "formats/texts.cpp": SPDX + "#include <zstd.h>\n",
    "sql/CMakeLists.txt": "# SPDX-License-Identifier: X\nwatertight_folder(sql DEPENDS base)\n",
    "sql/module/bridge.c": SPDX + '#include "postgres.h"\n#include "utils/builtins.h"\n',
    "docs/architecture.md": "The vocabulary: `Solid`.\n",
    "geometry/named.h": SPDX + "namespace watertight::geometry {\nclass Solid {\n};\n"
        "constexpr int kSides = 3;\ninline double unit(const Solid& a) {\n}\n"
        "template <class T>\n[[nodiscard]] T half(T a, int b = 2) {\n}\nvoid declared(int);\n"
        "inline bool operator<(const Solid& a, const Solid& b) {\n}\n"
        "}  // namespace watertight::geometry\n\nnamespace watertight {\nusing geometry::Solid;\n}  // namespace watertight\n",
    "codec/mode_walk/front.h": SPDX + "namespace watertight::codec::walk {\nstruct Gate {\n};\n"
        "}  // namespace watertight::codec::walk\n",
    "codec/mode_walk/front_ring.cpp": SPDX,
    "codec/mode_polygon/front.h": SPDX + "namespace watertight::codec::polygon {\nstruct Gate {\n};\n"
        "}  // namespace watertight::codec::polygon\n",
    "scripts/test": "#!/bin/sh\n# SPDX-License-Identifier: X\n",
}
# For each break: a file, its text, the rule that must report it, words that must be in the line.
GOOD_TREE.update({f"tests/unit/base/a{i}.cpp": SPDX for i in range(MAX_SOURCES)})
GOOD_TREE.update({f"codec/page/a{i}.h": SPDX for i in range(MAX_SOURCES_OF_CODEC)})
BREAKS = [
    ("store/store.cpp", SPDX + '#include "geometry/solid.h"\n', "layers", "does not declare geometry"),
    ("geometry/solid.h", SPDX + '#include "codec/blob.h"\n', "existence", "codec/blob.h"),
    ("codec/CMakeLists.txt", "# SPDX-License-Identifier: X\nadd_library(codec)\n", "layers",
     "watertight_folder"),
    ("codec/CMakeLists.txt", "# SPDX-License-Identifier: X\nwatertight_folder(codec DEPENDS geometri)\n",
     "layers", "geometri"),
    ("codec/blob.cpp", SPDX + '#include "geometry/kernel.h"\n', "cgal", "out of its folder"),
    ("geometry/solid.h", SPDX + '#include "geometry/kernel.h"\n', "cgal", "geometry/solid.h"),
    ("codec/blob.cpp", SPDX + "#include <CGAL/Kernel.h>\n", "homes", "CGAL"),
    ("codec/blob.cpp", SPDX + "#include <boost/asio.hpp>\n", "homes", "Boost"),
    ("codec/blob.cpp", SPDX + "#include <spdlog/spdlog.h>\n", "homes", "spdlog"),
    ("codec/blob.cpp", SPDX + "#include <libpq-fe.h>\n", "homes", "libpq"),
    ("codec/blob.cpp", SPDX + "#include <nlohmann/json.hpp>\n", "homes", "nlohmann"),
    ("codec/blob.cpp", SPDX + "#include <CLI/CLI.hpp>\n", "homes", "CLI11"),
    ("codec/blob.cpp", SPDX + "#include <tetgen.h>\n", "homes", "TetGen"),
    ("codec/blob.cpp", SPDX + "#include <curl/curl.h>\n", "homes", "libcurl"),
    ("store/store.cpp", SPDX + "#include <zstd.h>\n", "homes", "zstd"),
    ("sql/bridge.cpp", SPDX + "#include <postgres.h>\n", "homes", "PostgreSQL"),
    ("geometry/solid.h", "#pragma once\n", "licence", "geometry/solid.h"),
    ("scripts/test", "#!/bin/sh\necho\n", "licence", "scripts/test"),
    ("report/html/page.js", "draw();\n", "licence", "report/html/page.js"),
    ("report/html/page.css", "figure {\n}\n", "licence", "report/html/page.css"),
    ("scripts/test", "#!/bin/sh\n# SPDX-License-Identifier: X\ncd /" + "work/main\n", "places", "scripts/test:3"),
    ("docs/build.md", "get it from http://" + "deb.example.org\n", "places", "docs/build.md:1"),
    ("geometry/solid.cpp", SPDX + "// TO" + "DO: later\n", "unfinished", "geometry/solid.cpp:2"),
    ("geometry/solid.cpp", SPDX + "\n" * MAX_LINES, "length", "601 lines"),
    ("tests/unit/base/b.cpp", SPDX, "rooms", "21 headers"),
    ("codec/page/b.h", SPDX, "rooms", "17 headers"),
    ("codec/mode_walk/gates.cpp", SPDX, "pairs", "no header beside it"),
    ("geometry/solid.cpp", SPDX + "namespace watertight {\nint f();\n}  // namespace watertight\n",
     "namespaces", "watertight::geometry"),
    ("codec/mode_walk/mode.cpp", SPDX + "namespace watertight::codec {\nint f();\n}  // namespace watertight::codec\n",
     "namespaces", "watertight::codec::walk"),
    ("codec/mode_walk/mode.cpp", SPDX + '#include "codec/mode_polygon/front.h"\n', "modes", "another mode"),
    ("geometry/kernel.h", SPDX + "namespace watertight {\nusing geometry::Kernel;\n}  // namespace watertight\n",
     "namespaces", "exports Kernel"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\nstruct Solid {\n};\n"
     "}  // namespace watertight::geometry\n", "names", "watertight::geometry::Solid"),
    ("geometry/solid.cpp", SPDX + "namespace watertight::geometry {\nclass Solid final {\n};\n"
     "}  // namespace watertight::geometry\n", "names", "watertight::geometry::Solid"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\nusing Solid = int;\n"
     "}  // namespace watertight::geometry\n", "names", "watertight::geometry::Solid"),
    ("geometry/solid.cpp", SPDX + "namespace watertight::geometry {\ndouble unit(const Solid& b) {\n}\n"
     "}  // namespace watertight::geometry\n", "names", "unit(const Solid&)"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\ntemplate <class T>\nT half(T x,\n    int y) {\n}\n"
     "}  // namespace watertight::geometry\n", "names", "half(T, int)"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\n[[nodiscard]] inline bool operator<(const Solid& x,\n"
     "    const Solid& y) {\n}\n}  // namespace watertight::geometry\n", "names", "operator<"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\nconstexpr std::array<int, kCount> kSides{};\n"
     "}  // namespace watertight::geometry\n", "names", "kSides"),
    ("geometry/kernel.h", SPDX + "namespace watertight::geometry {\nclass [[nodiscard]] Solid {\n};\n"
     "}  // namespace watertight::geometry\n", "names", "watertight::geometry::Solid"),
    ("codec/blob.cpp", SPDX + "namespace watertight::codec {\nnamespace {\nenum Family : int { kA };\n}  // namespace\n"
     "}  // namespace watertight::codec\n", "families", "anonymous"),
    ("codec/mode_walk/shapes.h", SPDX + "namespace watertight::codec::walk {\nstruct Gate {\n};\n"
     "}  // namespace watertight::codec::walk\n", "names", "watertight::codec::walk::Gate"),
]


def write_tree(root, tree):
    for name, text in tree.items():
        path = pathlib.Path(root) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def self_test():
    failures = 0
    with tempfile.TemporaryDirectory() as root:
        write_tree(root, GOOD_TREE)
        for line in violations(root):
            print(f"self-test: a good tree is refused: {line}")
            failures += 1
    for name, text, rule, words in BREAKS:
        with tempfile.TemporaryDirectory() as root:
            write_tree(root, {**GOOD_TREE, name: text})
            if not any(f" {rule}: " in line and words in line for line in violations(root)):
                print(f"self-test: rule '{rule}' does not see the break in {name} ({words})")
                failures += 1
    print(f"self-test: {len(BREAKS)} broken trees, {failures} failures")
    return failures


def main(arguments):
    if arguments == ["--self-test"]:
        return 1 if self_test() else 0
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    found = violations(arguments[0])
    for line in found:
        print(line)
    print(f"layer check: {len(found)} violations")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
