"""Fails when a page names something that is not in the tree.

In README.md, docs/ and the README files of folders: `path/to/file.ext` must exist, `file:name` must
be a word of that file, links must lead to a file, an excerpt that follows `<!-- from: FILE -->` must
stand in FILE line by line, options after infer-cli and commands after ./run must be known, and no
@@placeholder@@ may be left.

usage: docs_test.py SOURCE_ROOT | docs_test.py --self-test
"""
import pathlib
import re
import sys
import tempfile

PAGES = ("README.md", "docs/*.md", "docs/*/*.md", "*/README.md", "tests/*/README.md")
SPAN = re.compile(r"`([^`\n]+)`")
FILE = re.compile(r"^(?:[\w.-]+/)+[\w-]+(?:\.inl)?\.(?:cc|h|py|md|txt|fbs|cmake|svg)$")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)\)")
EXCERPT = re.compile(r"<!-- from: (\S+) -->\n```\w*\n(.*?)```", re.S)
OPTION = r"--[a-z][a-z-]*"
PLACEHOLDER = re.compile(r"@@\w+@@")
# Folders that appear only when something has been built or run.
MADE = ("build/", "out/")


def words(path):
    return set(re.findall(r"\w+", path.read_text(encoding="utf-8")))


def faults_of_span(root, span):
    file, _, name = span.partition(":")
    if not FILE.match(file) or file.startswith(MADE) or (name and not re.fullmatch(r"\w+", name)):
        return
    if not (root / file).is_file():
        yield f"`{span}`: no such file"
    elif name and name not in words(root / file):
        yield f"`{span}`: {file} does not have the word {name}"


def faults_of_excerpt(root, file, text):
    if not (root / file).is_file():
        yield f"excerpt from {file}: no such file"
        return
    lines = {line.strip() for line in (root / file).read_text(encoding="utf-8").splitlines()}
    for line in text.splitlines():
        if line.strip() and line.strip() not in lines:
            yield f"excerpt from {file}: this line is not there: {line.strip()}"


def faults_of_commands(root, text):
    run = root / "run"
    if run.is_file():
        known = words(run)
        for command in re.findall(r"\./run ([a-z]+)", text):
            if command not in known:
                yield f"./run {command}: unknown"
    arguments = root / "models/cli/args.cc"
    if arguments.is_file():
        options = set(re.findall(OPTION, arguments.read_text(encoding="utf-8")))
        for line in re.findall(r"^.*infer-cli .*$", text, re.M):
            for option in re.findall(r"(?<=\s)" + OPTION, line.split("infer-cli ", 1)[1]):
                if option not in options | {"--help"}:
                    yield f"infer-cli {option}: unknown option"


def faults_of_page(root, page):
    text = page.read_text(encoding="utf-8")
    for file, excerpt in EXCERPT.findall(text):
        yield from faults_of_excerpt(root, file, excerpt)
    prose = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    for span in SPAN.findall(prose):
        yield from faults_of_span(root, span)
    for link in LINK.findall(prose):
        if not (page.parent / link).exists():
            yield f"link to {link}: leads nowhere"
    for placeholder in PLACEHOLDER.findall(text):
        yield f"{placeholder} has not been filled in"
    yield from faults_of_commands(root, text)


def faults(root):
    for page in sorted({page for pattern in PAGES for page in root.glob(pattern)}):
        for fault in faults_of_page(root, page):
            yield f"{page.relative_to(root)}: {fault}"


def self_test():
    """Each planted mistake must be found, and nothing else."""
    page = ("`a/b.cc` `a/b.cc:Known` [b](../a/b.cc)\n<!-- from: a/b.cc -->\n```cpp\nint Known;\n```\n"
            "`a/none.cc` `a/b.cc:Unknown` [c](../a/none.cc) @@X@@ ./run nonsense\n"
            "<!-- from: a/b.cc -->\n```cpp\nint Other;\n```\n```\ninfer-cli w.fb --nonsense\n"
            "infer-cli w.fb --top-k 3\ninfer-cli w.fb --top 3\n```\n")
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name in ("a", "docs", "models/cli"):
            (root / name).mkdir(parents=True)
        (root / "a/b.cc").write_text("int Known;\n", encoding="utf-8")
        (root / "run").write_text("test\n", encoding="utf-8")
        (root / "models/cli/args.cc").write_text("--threads\n--top-k\n", encoding="utf-8")
        (root / "docs/page.md").write_text(page, encoding="utf-8")
        found = list(faults(root))
    print("\n".join(found))
    planted = ("int Other;", "`a/none.cc`", "`a/b.cc:Unknown`", "../a/none.cc", "@@X@@", "./run nonsense",
               "infer-cli --nonsense:", "infer-cli --top:")
    whole = len(found) == len(planted) and all(any(p in f for f in found) for p in planted)
    return 0 if whole else 1


def main():
    if sys.argv[1] == "--self-test":
        return self_test()
    found = list(faults(pathlib.Path(sys.argv[1])))
    print("\n".join(found) if found else "all that the pages name is there")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
