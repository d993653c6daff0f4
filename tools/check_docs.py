#!/usr/bin/env python3
"""Keeps the documentation true to the registry of builders.

check_docs.py --program BOXWOOD [--root FOLDER] [--write]
Checks that every builder has a page docs/builders/<id>.md and every page a builder, that docs/presplits.md names
every pre-split, that every paper key stands in docs/references.bib, that every relative link leads somewhere, and that
each table between the lines
    <!-- builders:begin -->   and   <!-- builders:end -->
is what the program tells; with --write those tables are renewed. One line per fault; exit status 1 when there is any.
check_docs.py --self-test plants faults in a scratch tree and checks that each is found.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

TABLE = re.compile(r"(<!-- builders:begin -->\n)(.*?)(<!-- builders:end -->)", re.DOTALL)
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
KEY = re.compile(r"^\s*@\w+\s*\{\s*([^,\s]+)", re.MULTILINE)


def ask(program, registry):
    """A registry ("builders", "presplits") as the program tells it."""
    answer = subprocess.run([program, registry, "--json", "-", "--quiet"], check=True, capture_output=True, text=True)
    return json.loads(answer.stdout)


def table_of(builders, page):
    """The Markdown table, with links that hold from the folder of `page`."""
    lines = ["| id | builder | what it does and is best for | cost | paper |", "|---|---|---|---|---|"]
    for builder in builders:
        link = os.path.relpath(f"docs/builders/{builder['id']}.md", page.parent)
        name, summary, cost, paper = (builder[key] for key in ("name", "summary", "cost_class", "paper"))
        lines.append(f"| [`{builder['id']}`]({link}) | {name} | {summary} | {cost} | {paper} |")
    return "\n".join(lines) + "\n"


def pages(root):
    found = sorted(p for folder in ("docs", "examples", "bench") for p in (root / folder).rglob("*.md"))
    return sorted(root.glob("*.md")) + found


def check_tables(root, builders, write):
    has_table = False
    for path in pages(root):
        text = path.read_text(encoding="utf-8")
        page = path.relative_to(root)
        wanted = table_of(builders, page)
        has_table = has_table or page.name == "README.md" and TABLE.search(text) is not None
        renewed = TABLE.sub(lambda match: match.group(1) + wanted + match.group(3), text)
        if renewed != text and write:
            path.write_text(renewed, encoding="utf-8")
        elif renewed != text:
            yield f"{page}: its table of builders is not what the program tells; `make docs` renews it"
    if not has_table:
        yield "README.md: has no table between <!-- builders:begin --> and <!-- builders:end -->"


def check_builder_pages(root, builders):
    ids = {builder["id"] for builder in builders}
    found = {path.stem for path in (root / "docs/builders").glob("*.md")} - {"README"}
    for missing in sorted(ids - found):
        yield f"docs/builders/{missing}.md: is missing; every builder has a page"
    for stray in sorted(found - ids):
        yield f"docs/builders/{stray}.md: there is no such builder"


def check_presplits(root, presplits):
    path = root / "docs/presplits.md"
    text = path.read_text(encoding="utf-8") if path.is_file() else ""
    for presplit in presplits:
        if f"`{presplit['id']}`" not in text:
            yield f"docs/presplits.md: does not name the pre-split {presplit['id']}"


def check_papers(root, rows):
    path = root / "docs/references.bib"
    keys = set(KEY.findall(path.read_text(encoding="utf-8"))) if path.is_file() else set()
    for row in rows:
        for key in re.split(r"[\s,;]+", row["paper"].strip()):
            if key and key not in keys:
                yield f"docs/references.bib: has no entry '{key}', which {row['id']} names"


def check_links(root):
    for path in pages(root):
        for match in LINK.finditer(path.read_text(encoding="utf-8")):
            target = (match.group(1) or match.group(2)).split("#", 1)[0]
            if target and not re.match(r"[a-z]+:", target) and not (path.parent / target).exists():
                yield f"{path.relative_to(root)}: the link to {target} leads nowhere"


def check_tree(root, builders, presplits=(), write=False):
    faults = list(check_tables(root, builders, write))
    faults += check_builder_pages(root, builders)
    faults += check_presplits(root, presplits)
    faults += check_papers(root, [*builders, *presplits])
    faults += check_links(root)
    return faults


def self_test():
    row = {"id": "middle", "name": "Middle", "summary": "Halves boxes.", "cost_class": "O(n)", "paper": "doe1990"}
    presplits = [{"id": "halve", "paper": "doe1990"}]
    clean = {
        "README.md": "# x\n<!-- builders:begin -->\n<!-- builders:end -->\nSee [it](docs/builders/middle.md#top).\n",
        "docs/builders/middle.md": "# middle\n[web](https://example.org) [up](../../README.md)\n",
        "docs/presplits.md": "# `halve`\n",
        "docs/references.bib": "@article{doe1990,\n title={x}}\n",
    }
    cases = [
        ({}, None),
        ({"README.md": "# no table\n"}, "has no table"),
        ({"README.md": clean["README.md"] + "[gone](docs/gone.md)\n"}, "leads nowhere"),
        ({"docs/builders/novel.md": "# novel\n"}, "no such builder"),
        ({"docs/builders/middle.md": None}, "every builder has a page"),
        ({"docs/references.bib": "@book{other,}\n"}, "no entry 'doe1990'"),
        ({"docs/presplits.md": "# `none`\n"}, "does not name the pre-split halve"),
    ]
    failures = 0
    for change, words in cases:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            for name, content in (clean | change).items():
                if content is not None:
                    (root / name).parent.mkdir(parents=True, exist_ok=True)
                    (root / name).write_text(content, encoding="utf-8")
            stale = check_tree(root, [row], presplits)
            check_tree(root, [row], presplits, write=True)
            faults = check_tree(root, [row], presplits)
        is_right = not faults if words is None else any(words in fault for fault in faults)
        if words is None:
            is_right = is_right and any("is not what the program tells" in fault for fault in stale)
        if not is_right:
            failures += 1
            print(f"planted {list(change)}: expected {words!r}, found {faults}, before writing {stale}")
    print(f"{len(cases) - failures} of {len(cases)} planted trees judged rightly")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--program", help="path of the boxwood program")
    parser.add_argument("--write", action="store_true", help="renew the tables")
    parser.add_argument("--self-test", action="store_true")
    arguments = parser.parse_args()
    if arguments.self_test:
        return 1 if self_test() else 0
    if not arguments.program:
        parser.error("--program is needed")
    builders, presplits = ask(arguments.program, "builders"), ask(arguments.program, "presplits")
    faults = check_tree(arguments.root, builders, presplits, arguments.write)
    for fault in faults:
        print(fault)
    print(f"{len(faults)} faults in the documentation" if faults else "The documentation agrees with the program.")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
