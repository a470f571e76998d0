# SPDX-License-Identifier: Apache-2.0
"""Pictures for the hands of a handcast rig, from Python.

    import handcast_content

    with handcast_content.Content("left", 640, 400) as content:
        while content.wait(1):
            pixels = content.begin()      # height x width x 4 (numpy), or flat bytes without numpy
            pixels[:] = 255
            content.publish()

The rig shows them where its content says so: `handcast content program: --hand left`. Units, axes and rules
are those of handcast.h. Errors are exceptions of type HandcastError, except a wait that ends without a sample.
"""
import ctypes
import os
import pathlib

try:
    import numpy
except ImportError:  # pictures are flat bytes, hands are structures
    numpy = None

TIMEOUT = 1
HANDS = ("left", "right")
JOINTS = 26


class Joint(ctypes.Structure):
    """position_m (3), orientation_xyzw (4), radius_m; tracker space."""
    _fields_ = [("position_m", ctypes.c_float * 3), ("orientation_xyzw", ctypes.c_float * 4), ("radius_m", ctypes.c_float)]


class BothHands(ctypes.Structure):
    """time_ns; is_there and joints by hand, left and right."""
    _fields_ = [("time_ns", ctypes.c_int64), ("is_there", ctypes.c_int32 * 2), ("joints", Joint * JOINTS * 2)]

    def places_m(self, hand):
        """The 26 joints of a hand ("left"), 26 x 3, metres in tracker space; None if it is not there."""
        index = HANDS.index(hand)
        if not self.is_there[index]:
            return None
        places = [tuple(joint.position_m) for joint in self.joints[index]]
        return places if numpy is None else numpy.array(places)


class HandcastError(RuntimeError):
    """`code` is one of handcast_result."""

    def __init__(self, code, sentence):
        super().__init__(sentence)
        self.code = code


def _load():
    """The library: HANDCAST_LIBRARY, that of the installed tree which this file belongs to, or the system's."""
    name = "libhandcast.so.0"
    root = pathlib.Path(__file__).resolve().parents[3] if len(pathlib.Path(__file__).resolve().parents) > 3 else None
    beside = sorted(root.glob(f"lib*/{name}")) + sorted(root.glob(f"lib/*/{name}")) if root else []
    library = ctypes.CDLL(os.environ.get("HANDCAST_LIBRARY") or (str(beside[0]) if beside else name))
    pointer, text, whole = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    for function, result, arguments in (
            ("version", text, []), ("error", text, []),
            ("open", whole, [text, whole, whole, whole, ctypes.POINTER(pointer)]),
            ("begin", pointer, [pointer]), ("publish", whole, [pointer, ctypes.c_int64]),
            ("size", whole, [pointer, whole, whole]), ("set_straight", whole, [pointer, whole]),
            ("set_lasts", whole, [pointer, ctypes.c_int64]), ("hands", whole, [pointer, ctypes.POINTER(BothHands)]),
            ("wait", whole, [pointer, whole]), ("close", None, [pointer])):
        getattr(library, f"handcast_{function}").restype = result
        getattr(library, f"handcast_{function}").argtypes = arguments
    return library


class Content:
    """The pictures of one hand ("left" or "right"), width x height px; a context manager. `rig`: its name, "" for
    the only one that is up. `straight`: colours are not multiplied by alpha. `lasts_s`: how long a picture stays
    if none follows; 0: until another one follows. One thread at a time."""

    def __init__(self, hand, width=640, height=400, rig="", straight=False, lasts_s=0):
        self._library = _load()
        self._handle = ctypes.c_void_p()
        self._size = width, height
        if hand not in HANDS:
            raise ValueError(f"there is no hand {hand!r}; it is left or right")
        self._check(self._library.handcast_open(rig.encode(), HANDS.index(hand), width, height, ctypes.byref(self._handle)))
        self._check(self._library.handcast_set_straight(self._handle, int(straight)))
        self._check(self._library.handcast_set_lasts(self._handle, int(lasts_s * 1e9)))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def begin(self):
        """The pixels of the next picture, all 0, in the memory that the rig reads: do not use them after publish()."""
        address = self._library.handcast_begin(self._handle)
        if not address:
            raise HandcastError(TIMEOUT, self._sentence())
        width, height = self._size
        pixels = (ctypes.c_uint8 * (width * height * 4)).from_address(address)
        return memoryview(pixels).cast("B") if numpy is None else numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 4)

    def publish(self, time_ns=0):
        """Shows the picture. `time_ns`: what it was drawn for, CLOCK_MONOTONIC; 0: now."""
        self._check(self._library.handcast_publish(self._handle, time_ns))

    def resize(self, width, height):
        """Changes the size of the next pictures."""
        self._check(self._library.handcast_size(self._handle, width, height))
        self._size = width, height

    def hands(self):
        """BothHands, as the tracker saw them last; None before its first sample."""
        hands = BothHands()
        code = self._library.handcast_hands(self._handle, ctypes.byref(hands))
        if code == TIMEOUT:
            return None
        self._check(code)
        return hands

    def wait(self, seconds):
        """True when the tracker has a new sample; False if none came in time (10 s at most)."""
        code = self._library.handcast_wait(self._handle, int(seconds * 1000))
        if code == TIMEOUT:
            return False
        self._check(code)
        return True

    def close(self):
        """Leaves the rig."""
        self._library.handcast_close(self._handle)
        self._handle = ctypes.c_void_p()

    def _sentence(self):
        return self._library.handcast_error().decode()

    def _check(self, code):
        if code != 0:
            raise HandcastError(code, self._sentence())
