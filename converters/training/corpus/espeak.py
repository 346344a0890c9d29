"""espeak-ng's library behind a pipe: `python3 -m converters.training.corpus.espeak`.

It runs in a process of its own, so that its global state begins anew for each speaker (the same
requests give the same bytes) and a fault in it ends nothing else.  A request is a line of JSON:
{"voice", "rate", "pitch", "range", "ssml"}; the answer a line {"rate", "samples", "events"} and
then the samples, 16 bits each.  Events are [sample, type, text position, length, phoneme].
"""

import ctypes
import json
import sys

LIBRARY = "libespeak-ng.so.1"  # Debian's libespeak-ng1
WORD, SENTENCE, END, PHONEME = 1, 2, 5, 7
_SYNCHRONOUS, _PHONEME_EVENTS = 2, 1
_RATE, _PITCH, _RANGE = 1, 3, 4  # of espeak_SetParameter: words a minute, 0 to 100, 0 to 100
_UTF8, _SSML = 0x1, 0x10


class _Event(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("identifier", ctypes.c_uint), ("position", ctypes.c_int),
                ("length", ctypes.c_int), ("milliseconds", ctypes.c_int), ("sample", ctypes.c_int),
                ("user", ctypes.c_void_p), ("name", ctypes.c_char * 8)]


_CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int,
                             ctypes.POINTER(_Event))


class Synthesiser:
    def __init__(self):
        self.library = ctypes.CDLL(LIBRARY)
        self.rate = self.library.espeak_Initialize(_SYNCHRONOUS, 0, None, _PHONEME_EVENTS)
        if self.rate <= 0:
            raise OSError("espeak-ng: no data, expected those of Debian's espeak-ng-data")
        self.samples, self.events = bytearray(), []
        self.callback = _CALLBACK(self._take)
        self.library.espeak_SetSynthCallback(self.callback)

    def _take(self, wave, count, events):
        if wave:
            self.samples += ctypes.string_at(wave, 2 * count)
        at = 0
        while events[at].type != 0:
            event = events[at]
            if event.type in (WORD, SENTENCE, END, PHONEME):
                self.events.append([event.sample, event.type, event.position, event.length,
                                    event.name.decode("utf-8", "replace")
                                    if event.type == PHONEME else ""])
            at += 1
        return 0

    def speak(self, request):
        """(rate, samples, events)"""
        self.samples, self.events = bytearray(), []
        if self.library.espeak_SetVoiceByName(request["voice"].encode()) != 0:
            raise OSError(f"espeak-ng: no voice {request['voice']}")
        for parameter, name in ((_RATE, "rate"), (_PITCH, "pitch"), (_RANGE, "range")):
            self.library.espeak_SetParameter(parameter, int(request[name]), 0)
        text = request["ssml"].encode()
        self.library.espeak_Synth(text, len(text) + 1, 0, 1, 0, _UTF8 | _SSML, None, None)
        self.library.espeak_Synchronize()
        return self.rate, bytes(self.samples), self.events


def main():
    try:
        synthesiser = Synthesiser()
        for line in sys.stdin:
            rate, samples, events = synthesiser.speak(json.loads(line))
            head = {"rate": rate, "samples": len(samples) // 2, "events": events}
            sys.stdout.buffer.write(json.dumps(head).encode() + b"\n" + samples)
            sys.stdout.buffer.flush()
    except OSError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
