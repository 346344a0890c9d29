"""Opens HDF5 files of others: plain numbers that stand in the file itself, and nothing else.

Links, references, objects, filters of others and data in other files are not followed, and no code is
run.  To be used inside isolate.arrays_of, in a process of its own.
"""

import math
import os

from .errors import ConvertError

MAX_RANK = 8
# How much more the numbers may be than the file: compression gains little on weights and features.
MAX_RATIO = 16
SPARE_MEMORY = 512 << 20
SECONDS = 600


def need_h5py(path, what):
    try:
        import h5py  # noqa: F401  pylint: disable=unused-import
    except ModuleNotFoundError:
        raise ConvertError(f"{path}: {what} need h5py (Debian: python3-h5py)") from None


def memory_for(path):
    """What a reader of the file may take."""
    return SPARE_MEMORY + 2 * MAX_RATIO * os.path.getsize(path)


def read(path, kind):
    """kind(h5py, path, file).read(), HDF5's own errors in one sentence."""
    import h5py
    for _ in range(h5py.h5pl.size()):
        h5py.h5pl.remove(0)  # no filters from libraries, wherever the file asks for them
    try:
        with h5py.File(path, "r") as file:
            return kind(h5py, path, file).read()
    except ConvertError:
        raise
    except Exception as error:  # pylint: disable=broad-except
        # h5py passes on whatever HDF5 reports of a damaged file, as exceptions of many types.
        raise ConvertError(f"{path}: HDF5 is damaged: {type(error).__name__}: "
                           f"{str(error)[:120]}") from None


class SafeFile:
    def __init__(self, h5py, path, file):
        self.h5py, self.path, self.root = h5py, path, file
        self.size = os.path.getsize(path)
        self.budget = MAX_RATIO * self.size

    def has(self, group, name):
        return group.id.links.exists(name.encode())

    def inside(self, group, name, kind):
        """What `name`, with its slashes, leads to."""
        *parts, last = name.split("/")
        for part in parts:
            group = self.child(group, part, self.h5py.Group)
        return self.child(group, last, kind)

    def child(self, group, name, kind):
        """The group or data set that stands in `group` itself, not behind a link."""
        place = f"{group.name}/{name}".strip("/")
        where = f"{self.path}: {place[:200]}"
        if not (name.isprintable() and name not in ("", ".", "..") and "/" not in name
                and self.has(group, name)):
            raise ConvertError(f"{where}: missing")
        link = group.id.links.get_info(name.encode()).type
        if link != self.h5py.h5l.TYPE_HARD:
            kinds = {self.h5py.h5l.TYPE_SOFT: "a soft", self.h5py.h5l.TYPE_EXTERNAL: "an external"}
            raise ConvertError(f"{where}: {kinds.get(link, 'an unknown')} link, expected what "
                               "stands in this file")
        found = group[name]
        if not isinstance(found, kind):
            raise ConvertError(f"{where}: a {type(found).__name__}, expected a {kind.__name__}")
        return found

    def check(self, found, where):
        """Refuses what is not numbers of a size that the file can hold."""
        h5t, h5d, h5z = self.h5py.h5t, self.h5py.h5d, self.h5py.h5z
        kind, made = found.id.get_type(), found.id.get_create_plist()
        if kind.get_class() not in (h5t.FLOAT, h5t.INTEGER):
            raise ConvertError(where + "expected numbers")
        layout = made.get_layout()
        if layout == h5d.VIRTUAL or made.get_external_count():
            raise ConvertError(where + "its numbers stand in other files")
        shape = found.id.shape
        if shape is None or len(shape) > MAX_RANK:
            raise ConvertError(where + f"expected at most {MAX_RANK} dimensions")
        size = math.prod(shape) * kind.get_size()
        stored, chunk = found.id.get_storage_size(), 0
        if layout == h5d.CHUNKED:
            chunk = math.prod(made.get_chunk()) * kind.get_size()
            filters = {made.get_filter(i)[0] for i in range(made.get_nfilters())}
            if not filters <= {h5z.FILTER_DEFLATE, h5z.FILTER_SHUFFLE, h5z.FILTER_FLETCHER32}:
                raise ConvertError(where + "filters other than gzip and shuffle")
        elif stored != size:
            raise ConvertError(where + f"{stored} bytes for shape {shape}, expected {size}")
        self.budget -= size
        if self.budget < 0 or chunk > MAX_RATIO * self.size or not stored:
            raise ConvertError(where + f"shape {shape} is more than a file of {self.size} bytes "
                               "can hold")
