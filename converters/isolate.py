"""Runs a parser written in C in a process of its own, so that a file that breaks it gives a
sentence here instead of the end of the converters."""

import faulthandler
import json
import os
import resource
import signal
import struct
import sys
import tempfile

import numpy as np

from .errors import ConvertError

_LENGTH = struct.Struct("<Q")


def arrays_of(function, path, memory, seconds):
    """`function(path)` -> (something JSON can hold, list of arrays of numbers), computed in a child
    that may take `memory` bytes more than this process and `seconds` of CPU time."""
    with tempfile.TemporaryFile() as channel:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            _child(function, path, memory, seconds, channel)
        _, status = os.waitpid(child, 0)
        code = os.waitstatus_to_exitcode(status)
        if code:
            why = signal.strsignal(-code) if code < 0 else f"exit code {code}"
            raise ConvertError(f"{path}: damaged: its parser ended with {why}")
        channel.seek(0)
        return _receive(channel)


def _child(function, path, memory, seconds, channel):
    code = 1
    faulthandler.disable()
    try:
        with open("/proc/self/statm", encoding="ascii") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        spent = int(sum(resource.getrusage(resource.RUSAGE_SELF)[:2]))
        _limit(resource.RLIMIT_AS, used + memory)
        _limit(resource.RLIMIT_CPU, spent + seconds)
        _limit(resource.RLIMIT_CORE, 0)
        try:
            value, arrays = function(path)
            _send(channel, {"value": value}, arrays)
        except ConvertError as error:
            _send(channel, {"error": str(error)}, [])
        channel.flush()
        code = 0
    finally:
        # Nothing of the parent's may run twice: no handlers, no buffers, no exception.
        os._exit(code)


def _limit(which, value):
    hard = resource.getrlimit(which)[1]
    resource.setrlimit(which, (value if hard == resource.RLIM_INFINITY else min(value, hard), hard))


def _send(channel, message, arrays):
    message["arrays"] = [[x.dtype.str, x.shape] for x in arrays]
    text = json.dumps(message).encode()
    channel.write(_LENGTH.pack(len(text)) + text)
    for x in arrays:
        channel.write(np.ascontiguousarray(x).data)


def _receive(channel):
    length, = _LENGTH.unpack(channel.read(_LENGTH.size))
    message = json.loads(channel.read(length))
    if "error" in message:
        raise ConvertError(message["error"])
    arrays = []
    for dtype, shape in message["arrays"]:
        x = np.empty(shape, dtype)
        channel.readinto(x.reshape(-1).view(np.uint8).data)
        arrays.append(x)
    return message["value"], arrays
