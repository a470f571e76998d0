# SPDX-License-Identifier: Apache-2.0
"""The pictures of the runs side by side, as a film and as stills."""
from dataclasses import dataclass, field

import cv2
import numpy

from pages.document import data_url
from pages.files import MOST_PICTURE, Problem, check_output, read_input

STILLS = 5  # of each run
LIT = 80    # change of the grey value that only projected light causes
SAMPLES = 24  # pictures of a run in which the moving part is looked for
PANEL_WIDTH, PANEL_HEIGHT, CAPTION_HEIGHT = 480, 360, 40  # px


@dataclass
class Film:
    """What the page shows of the pictures."""
    video: str = ""  # data URL of an H.264 MP4; "" if this build of OpenCV cannot write one, which browsers need
    strips: list = field(default_factory=list)    # pairs of a run's name and the data URLs of its stills
    problems: list = field(default_factory=list)  # why something is not shown, without a full stop


def read_picture(file):
    """The picture in BGR; None if the file cannot be read."""
    try:
        return cv2.imdecode(numpy.frombuffer(read_input(file, MOST_PICTURE), numpy.uint8), cv2.IMREAD_COLOR)
    except (Problem, cv2.error):
        return None


def moving_part(run):
    """Bounds of the pixels in which light comes or goes during a run: left, top, right, bottom; None if there are none."""
    least = most = None
    for file in run.pictures[::max(len(run.pictures) // SAMPLES, 1)]:
        picture = read_picture(file)
        if picture is None or least is not None and picture.shape != least.shape:
            continue
        least = picture if least is None else numpy.minimum(least, picture)
        most = picture if most is None else numpy.maximum(most, picture)
    if least is None:
        return None
    left, top, width, height = cv2.boundingRect(numpy.uint8(cv2.cvtColor(most - least, cv2.COLOR_BGR2GRAY) > LIT))
    return (left, top, left + width, top + height) if width else None


def framed(parts, width, height):
    """All parts with a margin, in the shape of a panel and inside the picture: left, top, width, height. The whole picture if there is
    no part, or too large a one."""
    whole = (0, 0, width, height)
    if not parts:
        return whole
    left, top = (min(part[i] for part in parts) for i in (0, 1))
    right, bottom = (max(part[i] for part in parts) for i in (2, 3))
    aspect = PANEL_WIDTH / PANEL_HEIGHT
    tall = max((bottom - top) * 1.15, (right - left) * 1.15 / aspect)
    wide = tall * aspect
    if tall >= height or wide >= width:
        return whole
    x, y = (left + right - wide) / 2, (top + bottom - tall) / 2
    return int(min(max(x, 0), width - wide)), int(min(max(y, 0), height - tall)), int(wide), int(tall)


def panel(file, frame):
    """The framed part of a picture in the size of a panel; None if it cannot be read."""
    picture = read_picture(file)
    left, top, width, height = frame
    part = None if picture is None else picture[top:top + height, left:left + width]
    return None if part is None or not part.size else cv2.resize(part, (PANEL_WIDTH, PANEL_HEIGHT), interpolation=cv2.INTER_AREA)


def side_by_side(runs, moment, frame):
    """The panels of one moment. The captions are above them because players show their controls over the lower edge. A picture that
    cannot be read stays dark."""
    image = numpy.full((PANEL_HEIGHT + CAPTION_HEIGHT, PANEL_WIDTH * len(runs), 3), 16, numpy.uint8)
    for i, run in enumerate(runs):
        left = i * PANEL_WIDTH
        shown = panel(run.pictures[moment], frame)
        if shown is not None:
            image[CAPTION_HEIGHT:, left:left + PANEL_WIDTH] = shown
        cv2.putText(image, run.name, (left + 14, 26), cv2.FONT_HERSHEY_DUPLEX, 0.6, (225, 225, 225), 1, cv2.LINE_AA)
    return image


def open_video(file, rate_hz, size):
    """A writer of H.264, or else of MPEG-4 part 2, or else a closed one; and whether browsers play what it writes."""
    for codec, plays in (("avc1", True), ("mp4v", False)):
        writer = cv2.VideoWriter(str(file), cv2.VideoWriter_fourcc(*codec), rate_hz, size)
        if writer.isOpened():
            return writer, plays
    return writer, False


def rate_of(run, moments):
    """The frame rate at which the film plays at the speed of the run, from 1 to 120 Hz."""
    seconds = run.metrics.number("seconds") or 0
    return min(max(moments / seconds, 1), 120) if seconds > 0 else 30


def stills(run, moments, frame):
    """JPEG pictures of a run, at equal distances in time."""
    for i in range(STILLS):
        shown = panel(run.pictures[(2 * i + 1) * moments // (2 * STILLS)], frame)
        done, jpeg = (False, None) if shown is None else cv2.imencode(".jpg", shown, (cv2.IMWRITE_JPEG_QUALITY, 85))
        yield data_url("image/jpeg", jpeg.tobytes() if done else b"")


def shoot(film, runs, file):
    """Writes the film and the picture of its middle, and adds film and stills to the page."""
    moments = min(len(run.pictures) for run in runs)
    height, width = read_picture(runs[0].pictures[0]).shape[:2]
    frame = framed(list(filter(None, map(moving_part, runs))), width, height)
    size = (PANEL_WIDTH * len(runs), PANEL_HEIGHT + CAPTION_HEIGHT)
    writer, plays = open_video(file, rate_of(runs[0], moments), size)
    if writer.isOpened():
        for moment in range(moments):
            writer.write(side_by_side(runs, moment, frame))
        writer.release()
    else:
        film.problems.append("this build of OpenCV cannot write H.264 or MPEG-4 video")
    cv2.imwrite(str(file.with_suffix(".png")), side_by_side(runs, moments // 2, frame))
    film.video = data_url("video/mp4", file.read_bytes()) if plays else ""
    film.strips = [(run.name, list(stills(run, moments, frame))) for run in runs]


def make_film(inputs, file):
    """Writes the film, and a PNG picture of its middle beside it. Pictures are cropped to the part in which the light moves. Runs
    without pictures are left out; they and all errors are in the problems."""
    film = Film()
    runs = [run for run in inputs.runs if run.pictures and read_picture(run.pictures[0]) is not None]
    film.problems += [f"there are no pictures of {run.name} in frames/" for run in inputs.runs if run not in runs]
    if not runs:
        return film
    try:
        for output in (file, file.with_suffix(".png")):
            check_output(output)
        shoot(film, runs, file)
    except Problem as problem:
        film.problems.append(str(problem))
    except (cv2.error, OSError) as error:
        film.problems.append(f"the film could not be made: {error}")
    return film
