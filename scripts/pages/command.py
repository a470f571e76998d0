# SPDX-License-Identifier: Apache-2.0
"""The command lines of the verbs, and their errors: one sentence, and an exit code that says what to do about it."""
import argparse
import difflib
import functools
import importlib
import os
import re
import signal
import sys
import traceback

from pages.files import Problem
from pages.verbs import VERBS

# As in ipc/base/exit_code.hpp.
USAGE, CONFIG, RETRY = 2, 100, 111

CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f]")

# The Debian packages of the Python modules that are not Python's own.
PACKAGES = {"cv2": "python3-opencv", "jinja2": "python3-jinja2", "matplotlib": "python3-matplotlib", "numpy": "python3-numpy"}


class UsageError(Exception):
    """What is wrong with a command line, in a sentence."""


class Parser(argparse.ArgumentParser):
    """A parser that raises its errors."""

    def error(self, message):
        without_value = re.fullmatch(r"argument (\S+): expected one argument", message)
        raise UsageError(f"{without_value[1]} needs a value" if without_value else message)


def parser_of(name, version):
    """The parser of a verb: its options, --help and --version."""
    verb = VERBS[name]
    parser = Parser(prog=f"handcast {name}", description=verb.sentence, epilog=verb.footer, allow_abbrev=False,
                    formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", action="version", version=f"handcast {name} {version}")
    for option in verb.options:
        parser.add_argument(option.name, help=option.sentence, metavar=option.value, default=option.default,
                            **({"nargs": "*"} if option.is_list else {}))
    return parser


def about_rest(words, options):
    """What is wrong with the first argument that no option takes."""
    wrong = next((word for word in words if word.startswith("-")), None)
    if not wrong:
        return f"'{words[0]}' is one argument too many"
    nearest = difflib.get_close_matches(wrong.partition("=")[0], options, 1)
    return f"unknown option '{wrong}'" + (f" (did you mean '{nearest[0]}'?)" if nearest else "")


def parse(name, version, words):
    """The values of a verb's options. Raises UsageError; --help and --version end the program."""
    for number, word in enumerate(words, 1):
        if not word:
            raise UsageError(f"argument {number} is empty")
    options = VERBS[name].options
    values, rest = parser_of(name, version).parse_known_intermixed_args(words)
    if rest:
        raise UsageError(about_rest(rest, [option.name for option in options]))
    for option in options:
        if option.is_required and not getattr(values, option.key):
            raise UsageError(f"{option.value if option.is_list else option.name} is required")
    return values


def about_bug(error):
    """An error that no program expects, with its place."""
    place = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__} in {place.filename}:{place.lineno}: {error}"


def prepare_streams():
    """Prints names of files as they are, and ends silently with Ctrl-C, and with the reader of a pipe."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    for stream in (sys.stdout, sys.stderr):
        if stream:
            stream.reconfigure(encoding="utf-8", errors="surrogateescape")


def complain(name, exit_code, sentence):
    """Prints a sentence about a verb on stderr, without characters that control a terminal, and returns the exit code."""
    print(f"handcast {name}:", CONTROL.sub(" ", str(sentence)), file=sys.stderr)
    return exit_code


def finish_output():
    """Raises Problem if something that was printed cannot be written."""
    try:
        if not sys.stdout:
            raise OSError(0, "it is closed")
        sys.stdout.flush()
    except OSError as error:
        if sys.stdout:  # which Python would try to write once more
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        raise Problem(f"the output cannot be written: {error.strerror}", may_pass=True) from None


def run_verb(name, version, words):
    """Runs a verb and returns its exit code."""
    values = parse(name, version, words)
    exit_code = importlib.import_module(VERBS[name].module).run(values, functools.partial(complain, name))
    finish_output()
    return exit_code


def run_program(name, version, words):
    """Runs a verb and returns its exit code. Errors are a sentence and an exit code, those that nobody expects, too."""
    prepare_streams()
    try:
        return run_verb(name, version, words)
    except UsageError as error:
        return complain(name, USAGE, f"{error}; `handcast help {name}`")
    except Problem as problem:
        return complain(name, RETRY if problem.may_pass else CONFIG, problem)
    except ModuleNotFoundError as absent:
        package = PACKAGES.get(absent.name.partition(".")[0])
        return complain(name, CONFIG, f"the package {package} is missing; `scripts/setup --pages` installs it" if package
                        else about_bug(absent))
    except Exception as error:
        return complain(name, RETRY, about_bug(error))
