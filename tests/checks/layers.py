"""Fails when an #include runs against the layers kernels <- engine <- models <- cli, bench, tests.

usage: layers.py SOURCE_ROOT | layers.py --self-test
"""
import pathlib
import re
import sys
import tempfile

# The front ends beside the networks, and what each may know of the others.
FRONT_ENDS = {
    "models/io": set(),
    "models/text": set(),
    "models/audio": {"models/io"},
    "models/prosody": {"models/io", "models/audio"},
    "models/words": {"models/io"},
    "models/motion": {"models/io"},
    "models/features": {"models/io", "models/text", "models/audio", "models/prosody",
                        "models/words", "models/motion", "models"},
    "models/outputs": {"models/io", "models/motion", "models"},
    "models/styles": {"models/io", "models"},
    "models/player": {"models/io", "models/outputs", "models/words", "models"},
    "models/metrics": {"models/io", "models/outputs", "models"},
}
ALL_MODELS = {"models", "engine", "kernels", *FRONT_ENDS}
# What the files of a folder may include from this project; the longest matching folder counts.
ALLOWED = {
    "kernels": {"kernels"},
    "engine": {"engine", "kernels"},
    "models": {"models", "engine", "kernels"},
    **{folder: {folder, "engine", "kernels", *known} for folder, known in FRONT_ENDS.items()},
    "models/cli": {"models/cli", *ALL_MODELS},
    "bench": {"bench", *ALL_MODELS},
    "tests": {"tests", "models/cli", *ALL_MODELS},
}
# Of the kernels' inside only the kernels themselves know, and the tests' oracle.
INSIDE = re.compile(r"kernels/(isa/|.*\.inl\.h)")
# Within the layers libraries meet only where they belong.
# The probe of the machine's peak is a kernel itself, one that only the benches link.
PROBE = "bench/peak_probe.cc"
LIBRARIES = {"xsimd": {"kernels"}, "Eigen": {"bench", "models/audio", "models/styles"},
             "unsupported": {"models/audio"},
             "nlohmann": {"models/io", "tests"}, "zip.h": {"models/cli", "tests"},
             "sndfile.h": {"models/audio", "tests"},
             "CLI": {"models/cli"}, "utf8proc.h": {"models/text"}}
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.M)


def folder_of(path):
    """The folder of ALLOWED that the relative path lies in, or None."""
    hits = [f for f in ALLOWED if path == f or path.startswith(f + "/")]
    return max(hits, key=len, default=None)


def violations(root):
    for path in sorted(p for f in ALLOWED if "/" not in f for p in (root / f).rglob("*")):
        if path.suffix not in {".h", ".cc"}:
            continue
        name = path.relative_to(root).as_posix()
        folder = "kernels" if name == PROBE else folder_of(name)
        for included in INCLUDE.findall(path.read_text(encoding="utf-8")):
            target = folder_of(included)
            if target is not None and target not in ALLOWED[folder] | ({"bench"} if name == PROBE else set()):
                yield f"{name}: includes {included}, but {folder} must not know {target}"
            if INSIDE.match(included) and folder != "kernels":
                yield f"{name}: includes {included}, which is inside the kernels"
            first = included.split("/")[0]
            if first in LIBRARIES and folder not in LIBRARIES[first]:
                yield f"{name}: includes {included}, but {folder} must not know {first}"


def self_test():
    cases = {
        "kernels/a.cc": ('#include "engine/tensor.h"', 1),
        "engine/b.cc": ('#include "models/x.h"\n#include <xsimd/xsimd.hpp>', 2),
        "models/c.h": ('#include "models/cli/npz.h"\n#include <utf8proc.h>', 2),
        "models/text/h.cc": ('#include "models/network.h"\n#include <utf8proc.h>', 1),
        "models/words/i.cc": ('#include "models/audio/wav.h"\n#include <nlohmann/json.hpp>', 2),
        "models/cli/d.cc": ('#include "tests/e.h"\n#include "models/f.h"', 1),
        "tests/g.cc": ('#include "kernels/gemm.inl.h"\n#include "kernels/kernels.h"', 1),
    }
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, (text, _) in cases.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        found = list(violations(root))
    for name, (_, count) in cases.items():
        if sum(line.startswith(name + ":") for line in found) != count:
            print(f"{name}: expected {count} violation(s) in", *found, sep="\n")
            return 1
    return 0


def main():
    if sys.argv[1] == "--self-test":
        return self_test()
    found = list(violations(pathlib.Path(sys.argv[1])))
    print("\n".join(found) if found else "all includes follow the layers")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
