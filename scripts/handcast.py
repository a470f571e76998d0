# SPDX-License-Identifier: Apache-2.0
"""A handcast rig, from Python: its images and hands, and a tracker, detector or content of your own.

    import handcast

    rig = handcast.Rig()                       # the only one that is up
    for frame in rig.camera:                   # the newest image each time; frame.pixels is a numpy array
        points = detect(frame.pixels)          # 21 x 2, px of the image, in the order of MediaPipe
        rig.landmarks.publish({"left": points}, frame.time_ns, frame.number)

    for hands in rig.hands:                    # the tracker's
        joints = hands.joints("left")          # 26 places, axes and radii; None if it is not there
        rig.pose.publish({"left": handcast.joints_of_points(places_m, "left")}, origin_ns)

    with handcast.Content("left", 640, 400) as content:
        while content.wait(1):
            content.begin()[:] = 255           # height x width x 4 (numpy), or flat bytes without numpy
            content.publish()

The rig takes them where it is told to: `--set landmarks.backend=external`, `--set pose.backend=external`,
`handcast content program: --hand left`. Units, axes and rules are those of handcast.h. Errors are exceptions of
type HandcastError. Only Content works without numpy.
"""
from __future__ import annotations

import ctypes
import os
import pathlib
import struct
import sys
import time
from typing import Iterator, Mapping, NamedTuple, Optional, Sequence

try:
    import numpy
except ImportError:  # pictures are flat bytes, hands are structures
    numpy = None

ABI = 1
TIMEOUT = 1
HANDS = ("left", "right")
JOINTS = 26
LANDMARKS = 21
# Landmark i is joint JOINT_OF_LANDMARK[i].
JOINT_OF_LANDMARK = (1, 2, 3, 4, 5, 7, 8, 9, 10, 12, 13, 14, 15, 17, 18, 19, 20, 22, 23, 24, 25)
MEAN_RADII_M = tuple(radius * 1e-3 for radius in (
    12, 17.5, 13, 10.6, 10.2, 8.4, 12, 10.4, 9.2, 8, 7, 12, 10.6, 9.5, 8.2, 7.1, 12, 10.1, 8.9, 7.8, 6.8,
    12, 8.8, 7.8, 6.9, 6.1))


class Joint(ctypes.Structure):
    """position_m (3), orientation_xyzw (4), radius_m; tracker space."""
    _fields_ = [("position_m", ctypes.c_float * 3), ("orientation_xyzw", ctypes.c_float * 4), ("radius_m", ctypes.c_float)]


class BothHands(ctypes.Structure):
    """time_ns; is_there and joints by hand, left and right."""
    _fields_ = [("time_ns", ctypes.c_int64), ("is_there", ctypes.c_int32 * 2), ("joint", Joint * JOINTS * 2)]

    def joints(self, hand: str) -> Optional["numpy.ndarray"]:
        """A view of a hand ("left"): 26 x 8, place (m), orientation (x, y, z, w) and radius; None if it is not there."""
        index = HANDS.index(hand)
        if not self.is_there[index]:
            return None
        return numpy.frombuffer(self.joint[index], numpy.float32).reshape(JOINTS, 8)

    def places_m(self, hand: str):
        """The 26 joints of a hand ("left"), 26 x 3, metres in tracker space; None if it is not there."""
        index = HANDS.index(hand)
        if not self.is_there[index]:
            return None
        places = [tuple(joint.position_m) for joint in self.joint[index]]
        return places if numpy is None else numpy.array(places)


# What BothHands begins with: time_ns and is_there.
_HEAD_OF_HANDS = struct.Struct("=q2i")


class _Image(ctypes.Structure):
    _fields_ = [("pixels", ctypes.c_void_p), ("width", ctypes.c_int32), ("height", ctypes.c_int32),
                ("number", ctypes.c_uint64), ("time_ns", ctypes.c_int64), ("camera", ctypes.c_int32)]


class _Landmarks(ctypes.Structure):
    _fields_ = [("image", ctypes.c_uint64), ("time_ns", ctypes.c_int64), ("presence", ctypes.c_float * 2),
                ("points", ctypes.c_float * 4 * LANDMARKS * 2), ("camera", ctypes.c_int32)]


class Frame(NamedTuple):
    """An image of the camera. `pixels` (height x width, grey, read-only) are the library's: copy what is needed after
    the next frame."""
    pixels: "numpy.ndarray"
    number: int
    time_ns: int


class HandcastError(RuntimeError):
    """`code` is one of handcast_result."""

    def __init__(self, code: int, sentence: str):
        super().__init__(sentence)
        self.code = code


def _load():
    """The library: HANDCAST_LIBRARY, that of the installed tree which this file belongs to, or the system's."""
    name = "libhandcast.so.0"
    root = pathlib.Path(__file__).resolve().parents[3] if len(pathlib.Path(__file__).resolve().parents) > 3 else None
    beside = sorted(root.glob(f"lib*/{name}")) + sorted(root.glob(f"lib/*/{name}")) if root else []
    library = ctypes.CDLL(os.environ.get("HANDCAST_LIBRARY") or (str(beside[0]) if beside else name))
    pointer, text, whole = ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int
    hands = ctypes.POINTER(BothHands)
    for function, result, arguments in (
            ("version", text, []), ("error", text, []), ("abi", whole, []), ("now", ctypes.c_int64, []),
            ("open", whole, [text, whole, whole, whole, ctypes.POINTER(pointer)]),
            ("begin", pointer, [pointer]), ("publish", whole, [pointer, ctypes.c_int64]),
            ("size", whole, [pointer, whole, whole]), ("set_straight", whole, [pointer, whole]),
            ("set_lasts", whole, [pointer, ctypes.c_int64]), ("hands", whole, [pointer, hands]),
            ("wait", whole, [pointer, whole]), ("close", None, [pointer]),
            ("rig_open", whole, [text, ctypes.POINTER(pointer)]), ("rig_close", None, [pointer]),
            ("wait_image", whole, [pointer, ctypes.POINTER(_Image), whole]),
            ("wait_hands", whole, [pointer, hands, whole]), ("send_hands", whole, [pointer, hands]),
            ("send_landmarks", whole, [pointer, ctypes.POINTER(_Landmarks)]),
            ("send_image", whole, [pointer, ctypes.POINTER(_Image)])):
        getattr(library, f"handcast_{function}").restype = result
        getattr(library, f"handcast_{function}").argtypes = arguments
    if library.handcast_abi() != ABI:
        raise ImportError(f"{name} has the ABI {library.handcast_abi()}, this file is for {ABI}")
    return library


class _Handle:
    """What the library opened, and its errors as exceptions; a context manager. One thread at a time."""

    def __init__(self):
        self._library = _load()
        self._handle = ctypes.c_void_p()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _check(self, code: int) -> None:
        if code != 0:
            raise HandcastError(code, self._library.handcast_error().decode())

    def _has_come(self, code: int) -> bool:
        if code == TIMEOUT:
            return False
        self._check(code)
        return True


def now_ns() -> int:
    """The time now, CLOCK_MONOTONIC."""
    return time.monotonic_ns()


class Camera:
    """The images of the rig's camera; and the camera of a rig with camera.backend = "external"."""

    def __init__(self, rig: "Rig", number: int = 0):
        self._rig, self._number = rig, number
        self._image = _Image()

    def wait(self, seconds: float = 1) -> Optional[Frame]:
        """The next image that is newer than the last; None if none came in time (10 s at most)."""
        rig, image = self._rig, self._image
        if not rig._has_come(rig._library.handcast_wait_image(rig._handle, image, int(seconds * 1000))):
            return None
        size = image.width * image.height
        pixels = numpy.frombuffer((ctypes.c_uint8 * size).from_address(image.pixels), numpy.uint8)
        pixels.flags.writeable = False
        return Frame(pixels.reshape(image.height, image.width), image.number, image.time_ns)

    def publish(self, pixels: "numpy.ndarray", origin_ns: int) -> None:
        """Sends an image: height x width, uint8, of the size in the calibration. `origin_ns`: the middle of its
        exposure."""
        pixels = numpy.ascontiguousarray(pixels, numpy.uint8)
        height, width = pixels.shape
        rig, image = self._rig, _Image(pixels.ctypes.data, width, height, 0, origin_ns, self._number)
        rig._check(rig._library.handcast_send_image(rig._handle, image))

    def __iter__(self) -> Iterator[Frame]:
        while True:
            if (frame := self.wait()) is not None:
                yield frame


class Hands:
    """The samples of the rig's tracker."""

    def __init__(self, rig: "Rig"):
        self._rig = rig

    def wait(self, seconds: float = 1) -> Optional[BothHands]:
        """The next sample that is newer than the last; None if none came in time (10 s at most)."""
        rig, hands = self._rig, BothHands()
        come = rig._has_come(rig._library.handcast_wait_hands(rig._handle, hands, int(seconds * 1000)))
        return hands if come else None

    def __iter__(self) -> Iterator[BothHands]:
        while True:
            if (hands := self.wait()) is not None:
                yield hands


def _both(hands: Mapping[str, Sequence]) -> tuple:
    """What is given of the left and of the right hand; None of one that is left out."""
    left, right = hands.get("left"), hands.get("right")
    if len(hands) > (left is not None) + (right is not None):
        for name in hands:
            if name not in HANDS:
                raise ValueError(f"there is no hand {name!r}; it is left or right")
    return left, right


def _shaped(what: str, values: Sequence, count: int, columns: tuple) -> "numpy.ndarray":
    values = numpy.asarray(values, numpy.float32)
    if values.ndim != 2 or values.shape[0] != count or values.shape[1] not in columns:
        raise ValueError(f"{what} must be {count} x {' or '.join(map(str, columns))}, not {' x '.join(map(str, values.shape))}")
    if not numpy.isfinite(values).all():
        raise ValueError(f"{what} must be numbers, and one is NaN or infinite")
    return values


class Pose:
    """The tracker of a rig with pose.backend = "external"."""

    def __init__(self, rig: "Rig"):
        hands = BothHands()
        self._rig, self._sent, self._bytes = rig, ctypes.pointer(hands), memoryview(hands).cast("B")
        self._joints = [numpy.frombuffer(joints, numpy.float32).reshape(JOINTS, 8) for joints in hands.joint]

    def publish(self, hands: Mapping[str, Sequence], origin_ns: int) -> None:
        """Sends a sample. `hands`: by name ("left"), 26 x 8 as BothHands.joints() and joints_of_points() give them; a
        hand that is left out is not seen. `origin_ns`: when the sensor saw them."""
        rig, both = self._rig, _both(hands)
        _HEAD_OF_HANDS.pack_into(self._bytes, 0, origin_ns, both[0] is not None, both[1] is not None)
        for side in (0, 1):
            if (joints := both[side]) is not None:
                fits = getattr(joints, "shape", None) == (JOINTS, 8)
                self._joints[side][...] = joints if fits else _shaped("joints", joints, JOINTS, (8,))
        if code := rig._library.handcast_send_hands(rig._handle, self._sent):
            rig._check(code)


class Landmarks:
    """The detector of a rig with landmarks.backend = "external"."""

    def __init__(self, rig: "Rig", camera: int = 0):
        self._rig = rig
        self._found = _Landmarks(camera=camera)
        self._points = [numpy.frombuffer(self._found.points[side], numpy.float32).reshape(LANDMARKS, 4) for side in (0, 1)]

    def publish(self, hands: Mapping[str, Sequence], origin_ns: int, image: int = 0) -> None:
        """Sends the landmarks of an image. `hands`: by name ("left"), 21 x 2, 3 or 4: x and y in px of the image, the
        confidence (1) and its standard deviation in px (0: unknown). `origin_ns`, `image`: Frame.time_ns, number."""
        rig, found = self._rig, self._found
        found.time_ns, found.image = origin_ns, image
        for side, points in enumerate(_both(hands)):
            found.presence[side] = points is not None
            if points is not None:
                points = _shaped("landmarks", points, LANDMARKS, (2, 3, 4))
                self._points[side][:] = (0, 0, 1, 0)
                self._points[side][:, :points.shape[1]] = points
        rig._check(rig._library.handcast_send_landmarks(rig._handle, found))


class Rig(_Handle):
    """A rig that is up: `name`, or "" for the one that has started this program, or the only one. `camera` and `hands`
    are read; `pose`, `landmarks` and `camera`, and those of a second camera, `landmarks2` and `camera2`, can be sent."""

    def __init__(self, name: str = ""):
        if numpy is None:
            raise ImportError(f"handcast.Rig needs numpy, which {sys.executable} does not have")
        super().__init__()
        self._check(self._library.handcast_rig_open(name.encode(), ctypes.byref(self._handle)))
        self.camera, self.hands, self.pose, self.landmarks = Camera(self), Hands(self), Pose(self), Landmarks(self)
        self.camera2, self.landmarks2 = Camera(self, 1), Landmarks(self, 1)

    def close(self) -> None:
        """Leaves the rig."""
        self._library.handcast_rig_close(self._handle)
        self._handle = ctypes.c_void_p()


def _quaternions(axes: "numpy.ndarray") -> "numpy.ndarray":
    """n x 4 (x, y, z, w) of n x 3 x 3 rotations whose columns are the axes, by their largest component."""
    quaternions = []
    for m in axes:
        squares = numpy.array([1 + m[0, 0] - m[1, 1] - m[2, 2], 1 - m[0, 0] + m[1, 1] - m[2, 2],
                               1 - m[0, 0] - m[1, 1] + m[2, 2], 1 + m[0, 0] + m[1, 1] + m[2, 2]])
        row = {0: (squares[0], m[1, 0] + m[0, 1], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]),
               1: (m[1, 0] + m[0, 1], squares[1], m[2, 1] + m[1, 2], m[0, 2] - m[2, 0]),
               2: (m[0, 2] + m[2, 0], m[2, 1] + m[1, 2], squares[2], m[1, 0] - m[0, 1]),
               3: (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], squares[3])}[int(squares.argmax())]
        quaternions.append(numpy.array(row) / (2 * numpy.sqrt(squares.max())))
    return numpy.array(quaternions)


def joints_of_points(points_m: Sequence, hand: str) -> "numpy.ndarray":
    """The 26 joints (26 x 8: place, orientation, radius) of a hand ("left") whose 21 landmarks (21 x 3, in MediaPipe's
    order) or 26 joints (26 x 3) are known. Axes follow from the places: -z to the tip, +y out of the back of the hand.
    Metacarpals that are not known begin beside the wrist; radii are those of the mean hand."""
    points = numpy.asarray(points_m, float)
    places = numpy.empty((JOINTS, 3))
    if len(points) == JOINTS:
        places[:] = points
    else:
        places[list(JOINT_OF_LANDMARK)] = points
        for joint in (6, 11, 16, 21):
            places[joint] = places[1] + 0.25 * (places[joint + 1] - places[1])
        places[0] = (places[11] + places[12]) / 2
    across = places[7] - places[22]  # from the little finger to the index finger
    back = numpy.cross(places[12] - places[1], across) * (1 if hand == "left" else -1)
    ahead = numpy.empty((JOINTS, 3))
    ahead[:-1] = places[1:] - places[:-1]
    for tip in (5, 10, 15, 20, 25):
        ahead[tip] = ahead[tip - 1]
    ahead[:2] = places[12] - places[1]
    z = -ahead / numpy.linalg.norm(ahead, axis=1, keepdims=True)
    x = numpy.cross(back, z)
    x /= numpy.linalg.norm(x, axis=1, keepdims=True)
    axes = numpy.stack([x, numpy.cross(z, x), z], axis=2)
    return numpy.hstack([places, _quaternions(axes), numpy.array(MEAN_RADII_M)[:, None]])


def _rows(hands: Mapping[str, Sequence], shape: tuple, origin_ns: int, arrival_ns: int) -> list:
    rows = [[origin_ns, arrival_ns, side, 1, *numpy.asarray(values).ravel()]
            for side, values in enumerate(_both(hands)) if values is not None]
    return rows or [[origin_ns, arrival_ns, -1, *[0] * (1 + shape[0] * shape[1])]]


def pose_rows(hands: Mapping[str, Sequence], origin_ns: int, arrival_ns: int) -> list:
    """The rows of a sample for `handcast simulate --poses FILE.npy` (numpy.save). `hands` as for Pose.publish()."""
    return _rows(hands, (JOINTS, 8), origin_ns, arrival_ns)


def landmark_rows(hands: Mapping[str, Sequence], origin_ns: int, arrival_ns: int) -> list:
    """The rows of an image for `handcast simulate --landmarks FILE.npy`. `hands`: by name, 21 x 2 px of the image."""
    points = {name: numpy.hstack([_shaped("landmarks", places, LANDMARKS, (2,)), [[1, 0]] * LANDMARKS]) for name, places in hands.items() if places is not None}
    return _rows(points, (LANDMARKS, 4), origin_ns, arrival_ns)


class Content(_Handle):
    """The pictures of one hand ("left" or "right"), width x height px. `rig`: its name, "" for the only one that is
    up. `straight`: colours are not multiplied by alpha. `lasts_s`: how long a picture stays if none follows; 0: until
    another one follows."""

    def __init__(self, hand: str, width: int = 640, height: int = 400, rig: str = "", straight: bool = False,
                 lasts_s: float = 0):
        super().__init__()
        self._size = width, height
        if hand not in HANDS:
            raise ValueError(f"there is no hand {hand!r}; it is left or right")
        self._check(self._library.handcast_open(rig.encode(), HANDS.index(hand), width, height, ctypes.byref(self._handle)))
        self._check(self._library.handcast_set_straight(self._handle, int(straight)))
        self._check(self._library.handcast_set_lasts(self._handle, int(lasts_s * 1e9)))

    def begin(self):
        """The pixels of the next picture, all 0, in the memory that the rig reads: do not use them after publish()."""
        address = self._library.handcast_begin(self._handle)
        if not address:
            raise HandcastError(TIMEOUT, self._library.handcast_error().decode())
        width, height = self._size
        pixels = (ctypes.c_uint8 * (width * height * 4)).from_address(address)
        return memoryview(pixels).cast("B") if numpy is None else numpy.frombuffer(pixels, numpy.uint8).reshape(height, width, 4)

    def publish(self, time_ns: int = 0) -> None:
        """Shows the picture. `time_ns`: what it was drawn for, CLOCK_MONOTONIC; 0: now."""
        self._check(self._library.handcast_publish(self._handle, time_ns))

    def resize(self, width: int, height: int) -> None:
        """Changes the size of the next pictures."""
        self._check(self._library.handcast_size(self._handle, width, height))
        self._size = width, height

    def hands(self) -> Optional[BothHands]:
        """The hands as the tracker saw them last; None before its first sample."""
        hands = BothHands()
        come = self._has_come(self._library.handcast_hands(self._handle, hands))
        return hands if come else None

    def wait(self, seconds: float) -> bool:
        """True when the tracker has a new sample; False if none came in time (10 s at most)."""
        return self._has_come(self._library.handcast_wait(self._handle, int(seconds * 1000)))

    def close(self) -> None:
        """Leaves the rig."""
        self._library.handcast_close(self._handle)
        self._handle = ctypes.c_void_p()
