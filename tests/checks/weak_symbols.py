"""Fails when an ISA object exports anything that the linker may merge with another object's copy.

An inline function compiled with AVX flags and kept as a weak symbol can replace the baseline copy of
the same function, and a CPU without AVX then meets an illegal instruction.  The only symbol that an
ISA object may define for others is its table.

usage: weak_symbols.py NM OBJECT...
"""
import subprocess
import sys


def bad_symbols(nm, obj):
    lines = subprocess.run([nm, "-C", "--defined-only", obj], check=True, capture_output=True,
                           text=True).stdout.splitlines()
    for line in lines:
        _, kind, name = line.split(maxsplit=2)
        # W, V, u: weak or unique, mergeable.  T: a function that only the table should name.
        # The sanitizers' runtime asks for weak data of its own (DW.ref..., __odr_asan...).
        if kind in "WVuT" and not name.startswith(("DW.ref.", "__odr_asan")):
            yield f"{obj}: {kind} {name}"


def main():
    nm, objects = sys.argv[1], [o for arg in sys.argv[2:] for o in arg.split(";")]
    bad = [line for obj in objects for line in bad_symbols(nm, obj)]
    print("\n".join(bad) if bad else f"{len(objects)} object(s), no exported function")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
