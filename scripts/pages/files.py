# SPDX-License-Identifier: Apache-2.0
"""Files that come from outside, and files that a person may have had before."""
import os
import pathlib
import stat

# The largest files that are read, in bytes. As in ipc/base/input_file.hpp.
MOST_TEXT = 16 << 20
MOST_PICTURE = 64 << 20
MOST_RESULTS = 1 << 30


class Problem(Exception):
    """What is wrong, in a sentence for the user. `may_pass`: something is missing now; trying again may help."""

    def __init__(self, sentence, may_pass=False):
        super().__init__(sentence)
        self.may_pass = may_pass


def kind_of(mode):
    """What a file is that is not one."""
    kinds = {stat.S_ISDIR: "a folder", stat.S_ISFIFO: "a pipe", stat.S_ISSOCK: "a socket"}
    return next((name for is_kind, name in kinds.items() if is_kind(mode)), "a device")


def read_input(file, most_bytes):
    """The bytes of a file from outside. Never blocks: a pipe, device, socket or folder is refused. Raises Problem."""
    try:
        descriptor = os.open(file, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY)
        mode = os.fstat(descriptor).st_mode
        if not stat.S_ISREG(mode):
            os.close(descriptor)
            raise Problem(f"{file}: cannot be read: it is {kind_of(mode)}, not a file")
        with open(descriptor, "rb") as stream:
            content = stream.read(most_bytes + 1)
    except OSError as error:
        raise Problem(f"{file}: cannot be read: {error.strerror}") from None
    if len(content) > most_bytes:
        raise Problem(f"{file}: has more than {most_bytes >> 20} MB; at most {most_bytes >> 20} MB are read")
    return content


def check_output(file):
    """Raises Problem if a file must not be written: opening a pipe may block."""
    if os.path.exists(file) and not stat.S_ISREG(mode := os.stat(file).st_mode) and not stat.S_ISCHR(mode):
        raise Problem(f"{file}: cannot be written: it is {kind_of(mode)}, not a file")


def write_whole(file, content):
    """Replaces a file as a whole: after an error, it has its old bytes. Follows links, and keeps the permissions. Raises Problem."""
    check_output(file)
    target = pathlib.Path(os.path.realpath(file))
    beside = target.with_name(f".{target.name[:200]}.{os.getpid()}")
    try:
        if target.is_char_device():
            target.write_bytes(content)
            return
        with open(beside, "xb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        if target.exists():
            os.chmod(beside, stat.S_IMODE(target.stat().st_mode))
        os.replace(beside, target)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise Problem(f"'{file}' cannot be written: {error.strerror}", may_pass=True) from None
