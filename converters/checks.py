"""Checks of configurations; each failure is one sentence."""

from .errors import ConvertError


def expect(holds, where, name, found, wanted):
    if not holds:
        raise ConvertError(f"{where}.{name}: {found}, expected {wanted}")


def positive(c, where, *names):
    for name in names:
        expect(c[name] >= 1, where, name, c[name], "at least 1")


def divides(c, where, name, of, total):
    expect(total % c[name] == 0, where, name, c[name], f"a divisor of {of} = {total}")
