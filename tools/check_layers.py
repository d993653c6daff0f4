#!/usr/bin/env python3
"""Checks that every include follows the table in tools/layers.txt, that no includes go in a circle, and that no file is too long.

check_layers.py [--root FOLDER]   prints one line per violation; exit status 1 when there is any
check_layers.py --self-test       plants violations in scratch trees and checks that each is found
"""
import argparse
import dataclasses
import pathlib
import re
import sys
import tempfile

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
SOURCE_ENDINGS = {".h", ".cpp"}
COUNTED_ENDINGS = {".h", ".cpp", ".py", ".sh", ".cmake"}
INCLUDE_FOLDERS = ["include", "src", "bench/rivals", "tests"]
TOP_FOLDERS = ["include", "src", "apps", "bench", "bindings", "examples", "tests", "tools", "cmake"]


@dataclasses.dataclass
class Rules:
    folders: dict  # stage -> stages it may include
    outside: dict  # folder outside the library -> outside folders it may include
    umbrellas: dict  # public header that includes the others -> the ones it leaves out
    alone: list  # folders under src whose files are one algorithm each
    libraries: dict  # prefix of an angle-bracket include -> folders that may have it
    never: list  # prefixes of angle-bracket includes that the library may not have
    lines: int


def read_rules(path):
    """Parses layers.txt; a line that is not understood is an error, so that no rule is lost to a typing mistake."""
    rules = Rules({}, {}, {}, [], {}, [], 0)
    tables = {"folder": rules.folders, "outside": rules.outside, "umbrella": rules.umbrellas, "library": rules.libraries}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split("#", 1)[0].split()
        if not words:
            continue
        kind, rest = words[0], words[1:]
        if kind in tables and rest and rest[0].endswith(":"):
            tables[kind][rest[0][:-1]] = rest[1:]
        elif kind in ("alone", "never") and rest:
            getattr(rules, kind).extend(rest)
        elif kind == "lines" and len(rest) == 1 and rest[0].isdigit():
            rules.lines = int(rest[0])
        else:
            raise SystemExit(f"{path}:{number}: not understood: {line.strip()}")
    for table in (rules.folders, rules.libraries):
        for name, others in table.items():
            for other in others:
                if other not in rules.folders:
                    raise SystemExit(f"{path}: '{name}' names the folder '{other}', which has no line of its own")
    return rules


def find_files(root, endings):
    for top in TOP_FOLDERS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in endings or path.name == "CMakeLists.txt" and "CMakeLists.txt" in endings:
                yield path.relative_to(root)


def without_comments(text):
    """Blanks comments and keeps line ends; string contents survive well enough to find include lines."""
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.DOTALL)
    return re.sub(r"//[^\n]*", "", text)


def includes_of(root, path):
    """Yields (line number, is quoted, name as written, file meant or None)."""
    text = without_comments((root / path).read_text(encoding="utf-8", errors="replace"))
    for match in INCLUDE.finditer(text):
        name = match.group(2)
        line = text.count("\n", 0, match.start(1)) + 1
        places = [folder / name for folder in path.parents] if match.group(1) == '"' else []
        places += [pathlib.Path(folder) / name for folder in INCLUDE_FOLDERS]
        meant = next((p for p in places if (root / p).is_file()), None)
        if meant:
            meant = (root / meant).resolve().relative_to(root)
        yield line, match.group(1) == '"', name, meant


def stage_of(path):
    """The library folder a file counts to: src/X/... and include/boxwood/X.h are both X. None outside the library."""
    parts = path.parts
    if parts[0] == "src" and len(parts) > 2:
        return parts[1]
    if parts[:2] == ("include", "boxwood") and len(parts) == 3:
        return path.stem
    return None


def outside_of(path, rules):
    """The outside folder a file belongs to, the longest name first, so that bench/rivals is not bench."""
    for folder in sorted(rules.outside, key=len, reverse=True):
        if path.is_relative_to(folder):
            return folder
    return None


def check_library_include(path, meant, rules):
    stage, other = stage_of(path), stage_of(meant)
    if other is None:
        return "the library includes only its own folders"
    if other in rules.umbrellas and stage not in rules.umbrellas:
        return f"the library never includes {meant.name}"
    if stage in rules.umbrellas:
        return f"{path.name} leaves {other} out" if other in rules.umbrellas[stage] else None
    if other != stage and other not in rules.folders[stage]:
        return f"{stage} may not include {other}"
    for folder in rules.alone:
        home = pathlib.Path("src") / folder
        if not meant.is_relative_to(home):
            continue
        is_own = path.parent == meant.parent and path.stem == meant.stem
        is_registry = path.parent == home.parent
        if not is_own and not is_registry:
            return f"{meant.name} is an algorithm of its own; only its .cpp and the files of {home.parent} include it"
    return None


def check_outside_include(path, meant, rules):
    folder = outside_of(path, rules)
    if folder is None or meant.parts[:2] == ("include", "boxwood"):
        return None
    other = outside_of(meant, rules)
    if other == folder or other in rules.outside[folder]:
        return None
    return f"{folder} may include only public headers and its own files"


def check_angle_include(path, name, rules):
    stage = stage_of(path)
    if stage is None:
        return None
    if any(name.startswith(prefix) for prefix in rules.never):
        return "the library may not include this"
    for prefix, folders in rules.libraries.items():
        if name.startswith(prefix) and stage not in folders:
            return f"only {', '.join(folders)} may include {prefix}"
    return None


def find_cycle(graph):
    """One cycle of a graph {node: set of nodes} as a list that ends where it began, or None. Iterative."""
    done = set()
    for start in sorted(graph):
        if start in done:
            continue
        path, on_path = [start], {start}
        waiting = [(start, iter(sorted(graph[start])))]
        while waiting:
            node, successors = waiting[-1]
            following = next(successors, None)
            if following is None:
                waiting.pop()
                on_path.discard(path.pop())
                done.add(node)
            elif following in on_path:
                return path[path.index(following):] + [following]
            elif following not in done:
                waiting.append((following, iter(sorted(graph.get(following, ())))))
                on_path.add(following)
                path.append(following)
    return None


def check_umbrellas(root, rules, graph):
    for umbrella, left_out in rules.umbrellas.items():
        path = pathlib.Path("include/boxwood") / f"{umbrella}.h"
        wanted = {p.relative_to(root) for p in (root / "include/boxwood").glob("*.h")} - {path}
        wanted = {p for p in wanted if p.stem not in left_out}
        for missing in sorted(wanted - graph.get(path, set())):
            yield f"{path}: does not include {missing.name}"


def check_tree(root):
    """All violations in the tree, one sentence each."""
    root = root.resolve()
    rules = read_rules(root / "tools" / "layers.txt")
    violations = []
    graph = {}
    for path in find_files(root, SOURCE_ENDINGS):
        graph[path] = set()
        stage = stage_of(path)
        if stage is not None and stage not in rules.folders and stage not in rules.umbrellas:
            violations.append(f"{path}: the folder {stage} has no line in tools/layers.txt")
            continue
        if path.parts[0] == "src" and stage is None:
            violations.append(f"{path}: a source belongs into a folder of src")
            continue
        for line, is_quoted, name, meant in includes_of(root, path):
            if meant:
                graph[path].add(meant)
                check = check_library_include if stage else check_outside_include
                problem = check(path, meant, rules)
            elif is_quoted:
                problem = "there is no such file in the project"
            else:
                problem = check_angle_include(path, name, rules)
            if problem:
                violations.append(f"{path}:{line}: {name}: {problem}")
    violations += check_umbrellas(root, rules, graph)
    for what, edges in (("folders in tools/layers.txt", {k: set(v) for k, v in rules.folders.items()}), ("files", graph)):
        cycle = find_cycle(edges)
        if cycle:
            violations.append(f"{what} include each other in a circle: {' -> '.join(map(str, cycle))}")
    for path in find_files(root, COUNTED_ENDINGS | {"CMakeLists.txt"}):
        length = len((root / path).read_text(encoding="utf-8", errors="replace").splitlines())
        if length > rules.lines:
            violations.append(f"{path}: {length} lines, more than {rules.lines}")
    return violations


# What a planted tree starts from; it has no violation. Each case below adds files and names the words it must be found by.
CLEAN_TREE = {
    "include/boxwood/boxwood.h": '#include "boxwood/base.h"\n#include "boxwood/tree.h"\n#include "boxwood/builders.h"\n',
    "include/boxwood/base.h": "#include <vector>\n",
    "include/boxwood/tree.h": '#include "boxwood/base.h"\n',
    "include/boxwood/builders.h": '#include "boxwood/tree.h"\n// #include "boxwood/layouts.h" in a comment is no include\n',
    "src/builders/registry.cpp": '#include "builders/top_down/middle.h"\n#include "builders/parts/sah.h"\n',
    "src/builders/parts/sah.h": '#include "boxwood/tree.h"\n',
    "src/builders/top_down/middle.h": '#include "builders/parts/sah.h"\n',
    "src/builders/top_down/middle.cpp": '#include "builders/top_down/middle.h"\n',
    "src/parallel/executor.cpp": '#include "boxwood/base.h"\n#include <tbb/task_arena.h>\n',
    "apps/boxwood/main.cpp": '#include "command.h"\n#include "boxwood/boxwood.h"\n#include "embree/embree_rival.h"\n',
    "apps/boxwood/command.h": "#include <CLI/CLI.hpp>\n#include <iostream>\n",
    "bench/rivals/embree/embree_rival.h": '#include <boxwood/boxwood.h>\n',
    "examples/01_first.cpp": "#include <boxwood/boxwood.h>\n",
    "tests/unit/builders/middle.cpp": '#include "builders/top_down/middle.h"\n',
}
PLANTED = [
    ({"src/tree/tree.cpp": '#include "boxwood/mesh.h"\n', "include/boxwood/mesh.h": ""}, "tree may not include mesh"),
    ({"include/boxwood/base.h": '#include "boxwood/tree.h"\n'}, "base may not include tree"),
    ({"src/builders/morton/lbvh.cpp": '#include "../../layouts/wide.h"\n', "src/layouts/wide.h": ""}, "builders may not include layouts"),
    ({"src/builders/morton/lbvh.cpp": '#include "builders/top_down/middle.h"\n'}, "an algorithm of its own"),
    ({"src/builders/parts/leaf.cpp": '#include "builders/top_down/middle.h"\n'}, "an algorithm of its own"),
    ({"src/tree/tree.cpp": '#include "boxwood/boxwood.h"\n'}, "never includes boxwood.h"),
    ({"include/boxwood/metrics.h": ""}, "does not include metrics.h"),
    ({"src/novel/new.cpp": ""}, "has no line in tools/layers.txt"),
    ({"src/stray.cpp": ""}, "belongs into a folder of src"),
    ({"src/tree/tree.cpp": '#include "tree/nowhere.h"\n'}, "no such file"),
    ({"src/tree/a.h": '#include "tree/b.h"\n', "src/tree/b.h": '#include "tree/a.h"\n'}, "in a circle"),
    ({"apps/boxwood/main.cpp": '#include "builders/parts/sah.h"\n'}, "apps may include only public headers"),
    ({"examples/01_first.cpp": '#include "../src/builders/parts/sah.h"\n'}, "examples may include only public"),
    ({"bench/rivals/embree/embree_rival.h": '#include "../../../apps/boxwood/command.h"\n'}, "bench/rivals may include only public"),
    ({"src/tree/tree.cpp": "#include <tbb/parallel_for.h>\n"}, "only parallel may include tbb/"),
    ({"src/tree/tree.cpp": "#include <iostream>\n"}, "may not include this"),
    ({"tests/unit/tree/long.cpp": "\n" * 501}, "501 lines, more than 500"),
]


def plant(root, files):
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content, encoding="utf-8")


def self_test():
    rules_text = (pathlib.Path(__file__).parent / "layers.txt").read_text(encoding="utf-8")
    circular = rules_text.replace("folder base:", "folder base: accel", 1)
    cases = [({}, None)] + PLANTED + [({"tools/layers.txt": circular}, "in a circle: accel")]
    failures = 0
    for files, words in cases:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            plant(root, {"tools/layers.txt": rules_text} | CLEAN_TREE | files)
            violations = check_tree(root)
        is_right = not violations if words is None else any(words in v for v in violations)
        if not is_right:
            failures += 1
            print(f"planted {list(files)}: expected {words!r}, found {violations}")
    print(f"{len(cases) - failures} of {len(cases)} planted trees judged rightly")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent)
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        return 1 if self_test() else 0
    violations = check_tree(arguments.root)
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of tools/layers.txt" if violations else "All includes follow tools/layers.txt.")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
