"""Builds .npy and .npz files byte by byte, so that any field can be made to lie."""

import struct
import zlib


def npy(descr="'<f4'", shape="(3, 4)", fortran="False", data=bytes(48), *, header=None,
        version=(1, 0), magic=b"\x93NUMPY", length=None):
    """A .npy file; `header` replaces the whole dictionary, `length` lies about its length."""
    if header is None:
        header = f"{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}"
    text = header if isinstance(header, bytes) else header.encode("utf-8")
    text += b"\n"
    size = struct.pack("<H" if version[0] == 1 else "<I", len(text) if length is None else length)
    return magic + bytes(version) + size + text + data


class Entry:
    """One member.  The keyword arguments overwrite fields of the local and central headers;
    those of `local` only the local one's."""

    def __init__(self, name, data, *, method=0, packed=None, local=None, **fields):
        self.raw_name = name if isinstance(name, bytes) else name.encode("utf-8")
        deflate = zlib.compressobj(9, zlib.DEFLATED, -15)
        self.packed = packed
        if packed is None:
            self.packed = deflate.compress(data) + deflate.flush() if method == 8 else data
        self.fields = dict(version=20, flags=0, method=method, time=0, date=0x21,
                           crc=zlib.crc32(data), csize=len(self.packed), usize=len(data),
                           name=self.raw_name, extra=b"", offset=None)
        self.fields.update(fields)
        self.local = dict(self.fields, **(local or {}))

    def local_header(self):
        f = self.local
        return struct.pack("<IHHHHHIIIHH", 0x04034b50, f["version"], f["flags"], f["method"],
                           f["time"], f["date"], f["crc"], f["csize"], f["usize"],
                           len(f["name"]), len(f["extra"])) + f["name"] + f["extra"]

    def central_header(self, offset):
        f = self.fields
        offset = offset if f["offset"] is None else f["offset"]
        return struct.pack("<IHHHHHHIIIHHHHHII", 0x02014b50, 20, f["version"], f["flags"],
                           f["method"], f["time"], f["date"], f["crc"], f["csize"], f["usize"],
                           len(f["name"]), len(f["extra"]), 0, 0, 0, 0, offset
                           ) + f["name"] + f["extra"]


def archive(entries, *, before=b"", after=b"", **end):
    """A zip file; `end` overwrites fields of the end record."""
    body, central = before, b""
    for entry in entries:
        central += entry.central_header(len(body))
        body += entry.local_header() + entry.packed
    e = dict(disk=0, cd_disk=0, count_here=len(entries), count=len(entries), cd_size=len(central),
             cd_offset=len(body), comment=b"", signature=0x06054b50, comment_length=None)
    e.update(end)
    length = len(e["comment"]) if e["comment_length"] is None else e["comment_length"]
    record = struct.pack("<IHHHHIIH", e["signature"], e["disk"], e["cd_disk"], e["count_here"],
                         e["count"], e["cd_size"], e["cd_offset"], length) + e["comment"]
    return body + central + record + after


def npz(data, **fields):
    """An archive with the one member x.npy."""
    return archive([Entry("x.npy", data, **fields)])
