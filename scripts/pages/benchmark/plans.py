# SPDX-License-Identifier: Apache-2.0
"""The plans of the benchmark as `handcast sweep` runs them here: with the paths of this machine, and with the row of somebody's method."""
import os
import pathlib
import re

from pages.files import MOST_TEXT, Problem, read_input, write_whole

VERSION = 1
PLANS = ("benchmark", "benchmark_stress")
FIRST_PERSON = 101  # the people of the benchmark are the seeds from here on
MOST_PEOPLE = 100
SHARE = pathlib.Path(__file__).resolve().parents[2]
# Installed, and in a checkout, whose build links to the pages.
FOLDERS = (SHARE / "sweeps", SHARE.parent / "config/sweeps")
RECORDINGS = "../../../shared/data"
VARIANTS = re.compile(r"^\[\[variant\]\]\n.*?(?=^\[)", re.MULTILINE | re.DOTALL)
SEEDS = re.compile(r"^twin\.seed = .*$", re.MULTILINE)
NAME = re.compile(r"[\w .+-]{1,40}")


def folder_of_plans(given):
    """The folder of the plans: the one given, or handcast's. Raises Problem."""
    folders = [pathlib.Path(given).resolve()] if given else FOLDERS
    for folder in folders:
        if (folder / f"{PLANS[0]}.toml").is_file():
            return folder
    raise Problem(f"{folders[0]}: there is no {PLANS[0]}.toml")


def recordings(folder):
    """The folder of the recordings: HANDCAST_DATA, or that beside a checkout."""
    return pathlib.Path(os.environ.get("HANDCAST_DATA") or folder / RECORDINGS).resolve()


def with_paths(text, folder):
    """The plan with absolute paths."""
    text = text.replace(f'"{RECORDINGS}/', f'"{recordings(folder)}/')
    return re.sub(r'"((?:\.\./rigs|worlds)/[^"]*)"', lambda found: f'"{(folder / found[1]).resolve()}"', text)


def with_people(text, count):
    """The plan with so many people; 0: with its own."""
    if not count:
        return text
    return SEEDS.sub(f"twin.seed = [{', '.join(str(FIRST_PERSON + i) for i in range(count))}]", text)


class Row:
    """A method whose results are in files: what it takes the place of ("landmarks" or "poses"), the folder of the files, its name."""

    def __init__(self, part, folder, name):
        self.part, self.folder, self.name = part, pathlib.Path(folder).resolve(), name
        if not NAME.fullmatch(name):
            raise Problem(f"--name {name}: a name has 1 to 40 letters, digits, spaces and .+-_")
        if not (self.folder / PLANS[0]).is_dir():
            raise Problem(f"--{part}: there is no folder {self.folder / PLANS[0]} with a file for each case")

    def text(self, plan):
        """Its variant in a plan."""
        return (f'\n[[variant]]\nname = "{self.name}"\nfrom = ["handcast"]\n{self.part} = "{self.folder / plan}"\n'
                f'settings.{self.part.replace("poses", "pose")}.backend = "external"\n')

    def has(self, plan):
        """Whether it has results of a plan."""
        return (self.folder / plan).is_dir()


def write_plan(name, folder, people, out, row=None, only_cases=False):
    """Writes a plan to the folder `out` and returns its file. `row`: a method of somebody; `only_cases`: with one variant, to record the
    cases. Raises Problem."""
    text = with_people(with_paths(read_input(folder / f"{name}.toml", MOST_TEXT).decode("utf-8"), folder), people)
    if only_cases:
        text = VARIANTS.sub("", text)
    elif row and row.has(name):
        text += row.text(name)
    file = out / f"{name}.toml"
    write_whole(file, text.encode())
    return file
