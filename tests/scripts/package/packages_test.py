#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Debian's packages hold what a technician needs, and a computer installs, runs, upgrades and removes them.

usage: packages_test.py [CLASS ...]

Packs the finished build, twice. The computer is a container of systemd-nspawn, whose root is that of this machine under a layer of its
own; it needs the superuser's rights.
"""
import collections
import contextlib
import filecmp
import gzip
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(REPOSITORY / "scripts"))
from handbook.links import faults_of

PATIENCE_S = 60
PACKAGES = {"handcast", "handcast-tools", "handcast-lab", "libhandcast0", "libhandcast-dev", "python3-handcast"}
OPTIONAL = {"handcast-aravis": "lib/handcast/camera/aravis.so", "handcast-bridge": "bin/handcast-bridge"}
PACKAGES |= {package for package, file in OPTIONAL.items() if (REPOSITORY / "build" / file).exists()}
NEEDED = ("cpack", "dpkg-deb", "dpkg-shlibdeps", "git")

scratch = None


def why_not_packed():
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing:
        return f"{', '.join(missing)} is missing; scripts/setup --package installs it"
    return "" if (REPOSITORY / ".git").exists() else "this is not a git checkout"


def why_no_computer():
    """Why no container with systemd can be started here; "" if it can."""
    if os.getuid() != 0:
        return "a container needs the superuser's rights"
    if not shutil.which("systemd-nspawn"):
        return "systemd-nspawn is missing; scripts/setup --tests installs it"
    layer = scratch / "layer"
    for name in ("upper", "work", "root"):
        (layer / name).mkdir(parents=True)
    try:
        mount_layer(layer)
    except subprocess.CalledProcessError as error:
        return f"the root of this machine takes no layer: {error.stderr.strip()}"
    subprocess.run(["umount", layer / "root"], check=True)
    return ""


def mount_layer(folder):
    subprocess.run(["mount", "-t", "overlay", "overlay", "-o", f"lowerdir=/,upperdir={folder}/upper,workdir={folder}/work",
                    folder / "root"], check=True, capture_output=True, text=True)


def output_of(*command, **more):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, timeout=PATIENCE_S, **more).stdout


def pack(folder, **environment):
    subprocess.run([REPOSITORY / "scripts/package.d/pack", folder], check=True, env={**os.environ, **environment}, stdout=subprocess.PIPE,
                   timeout=10 * PATIENCE_S)
    return {file.name.split("_")[0]: file for file in folder.glob("*.deb")}


def setUpModule():
    global scratch, packages, trees
    if reason := why_not_packed():
        raise unittest.SkipTest(reason)
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="handcast-packages-"))
    unittest.addModuleCleanup(shutil.rmtree, scratch)
    packages = pack(scratch / "packages")
    (scratch / "trees").mkdir()
    trees = {name: scratch / "trees" / name for name in packages}
    for name, file in packages.items():
        output_of("dpkg-deb", "-x", file, trees[name])


def skip_without(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class ThePackages(unittest.TestCase):
    def test_are_those_of_this_build(self):
        self.assertEqual(set(packages), PACKAGES)

    @unittest.skipUnless((REPOSITORY / "build" / OPTIONAL["handcast-aravis"]).exists(), "this build has no Aravis")
    def test_leave_aravis_to_those_who_have_an_industrial_camera(self):
        need_it = {name for name, file in packages.items() if "libaravis" in output_of("dpkg-deb", "-f", file, "Depends")}
        self.assertEqual(need_it, {"handcast-aravis"})

    def test_are_the_same_byte_by_byte_when_they_are_packed_again(self):
        os.umask(0o077)
        self.addCleanup(os.umask, 0o022)
        again = pack(scratch / "again", TZ="Asia/Tokyo", LC_ALL="C", USER="somebody")
        for name, file in packages.items():
            self.assertTrue(filecmp.cmp(file, again[name], shallow=False), name)

    def test_have_each_program_once_with_a_man_page(self):
        programs = [(name, file.name) for name, tree in trees.items() for file in (tree / "usr/bin").glob("*")]
        self.assertEqual(len({program for _, program in programs}), len(programs))
        for name, program in programs:
            self.assertTrue((trees[name] / f"usr/share/man/man1/{program}.1.gz").is_file(), program)

    def test_explain_each_verb_in_a_man_page(self):
        pages = {file.name for tree in trees.values() for file in tree.rglob("*.1.gz")}
        verbs = re.findall(r"^  ([a-z-]+)  ", output_of(trees["handcast"] / "usr/bin/handcast", "help"), re.M)
        self.assertGreater(len(verbs), 30)
        self.assertEqual([verb for verb in verbs if f"handcast-{verb}.1.gz" not in pages], [])

    @skip_without("man")
    def test_have_man_pages_that_man_reads_without_a_warning(self):
        for page in (file for tree in trees.values() for file in tree.rglob("*.1.gz")):
            said = subprocess.run(["man", "--warnings", "-l", "-Tutf8", page], capture_output=True, text=True, timeout=PATIENCE_S,
                                  env={**os.environ, "LC_ALL": "C.UTF-8", "MANROFFSEQ": "", "MANWIDTH": "80"})
            self.assertEqual((said.returncode, said.stderr), (0, ""), page.name)
            self.assertIn("User Commands", said.stdout)

    def test_say_in_the_man_page_what_help_says(self):
        page = gzip.decompress((trees["handcast"] / "usr/share/man/man1/handcast-up.1.gz").read_bytes()).decode()
        self.assertIn("\n.B \\-\\-seconds N\nStops after N seconds", page)

    def test_have_a_handbook_whose_links_lead_somewhere(self):
        folder = trees["handcast"] / "usr/share/doc/handcast"
        self.assertTrue((folder / "index.html").is_file())
        self.assertEqual(faults_of(folder), [])
        self.assertLess(sum(page.stat().st_size for kind in ("html", "css", "js") for page in folder.rglob(f"*.{kind}")), 3_000_000)

    def test_explain_the_verb_where_a_service_has_its_name(self):
        for verb, option in (("watch", "rig NAME"), ("desk", "renew")):
            page = gzip.decompress((trees["handcast"] / f"usr/share/man/man1/handcast-{verb}.1.gz").read_bytes()).decode()
            self.assertIn(f"\n.B \\-\\-{option}\n", page)

    def test_have_a_reboot_that_is_not_enabled(self):
        units = trees["handcast"] / "usr/lib/systemd/system"
        self.assertTrue((units / "handcast-reboot@.path").is_file() and (units / "handcast-reboot@.service").is_file())
        self.assertEqual(list(trees["handcast"].rglob("*.wants")), [])

    @skip_without("systemd-analyze")
    def test_have_a_unit_that_is_at_most_three_of_ten_exposed(self):
        unit = trees["handcast"] / "usr/lib/systemd/system/handcast@.service"
        output_of("systemd-analyze", "security", "--offline=true", "--threshold=30", "--no-pager", unit)

    @skip_without("desktop-file-validate")
    def test_have_entries_that_a_desktop_shows(self):
        for name in ("handcast", "handcast-tools"):
            for entry in (trees[name] / "usr/share/applications").iterdir():
                self.assertEqual(output_of("desktop-file-validate", entry), "")

    @skip_without("appstreamcli")
    def test_have_a_description_for_software_centres(self):
        output_of("appstreamcli", "validate", "--no-net", *(trees["handcast"] / "usr/share/metainfo").iterdir())

    @skip_without("lintian")
    def test_have_no_fault_that_lintian_knows(self):
        said = subprocess.run(["lintian", "--allow-root", "--fail-on", "error,warning", *packages.values()], capture_output=True, text=True)
        self.assertEqual((said.returncode, said.stdout), (0, ""))

    def test_tell_which_package_has_a_missing_verb(self):
        said = subprocess.run([trees["handcast"] / "usr/bin/handcast", "calibrate"], capture_output=True, text=True)
        self.assertEqual(said.returncode, 100)
        self.assertIn("handcast-tools", said.stderr)


class TheShow(unittest.TestCase):
    """The package handcast alone, unpacked."""

    def test_casts_light_on_the_hand_of_the_twin(self):
        usr, out = trees["handcast"] / "usr", scratch / "out"
        output_of(usr / "bin/handcast", "up", usr / "share/handcast/rigs/twin.toml", "--seconds", "8", "--out", out,
                  "--set", "camera.rate_hz=60", "--set", "projector.rate_hz=60", "--set", "supervisor.ready_s=60",
                  env={"PATH": os.environ["PATH"], "HOME": str(scratch), "HANDCAST_SCOPE": str(scratch)})
        scores = json.loads((out / "observer.json").read_text(encoding="utf-8"))
        self.assertGreater(scores["coverage"], 0.5)


class TheLibrary(unittest.TestCase):
    """Its three packages, unpacked into one tree."""

    @classmethod
    def setUpClass(cls):
        cls.usr = scratch / "library/usr"
        for name in ("libhandcast0", "libhandcast-dev", "python3-handcast"):
            shutil.copytree(trees[name] / "usr", cls.usr, symlinks=True, dirs_exist_ok=True)

    def test_is_found_by_cmake_and_linked(self):
        folder = scratch / "client"
        output_of("cmake", "-G", "Ninja", "-S", REPOSITORY / "tests/client", "-B", folder, f"-DCMAKE_PREFIX_PATH={self.usr}")
        output_of("cmake", "--build", folder)
        self.assertIn("libhandcast.so.0", output_of("readelf", "-d", folder / "draw_ring"))

    def test_is_found_by_the_python_module(self):
        module = self.usr / "lib/python3/dist-packages"
        header = (self.usr / "include/handcast.h").read_text(encoding="utf-8")
        said = output_of("python3", "-c", "import handcast; print(handcast._load().handcast_abi())", cwd=module)
        self.assertEqual(said.strip(), re.search(r"#define HANDCAST_ABI (\d+)", header)[1])


class TheCompletion(unittest.TestCase):
    def completed(self, *words):
        """What is offered for the last word."""
        script = (f'source "{trees["handcast"]}/usr/share/bash-completion/completions/handcast"; compopt() {{ :; }}\n'
                  'COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _handcast; printf "%s\\n" "${COMPREPLY[@]}"')
        return output_of("bash", "-c", script, "bash", "handcast", *words).split()

    def test_offers_verbs_and_their_options(self):
        self.assertEqual(self.completed("sta"), ["status"])
        self.assertIn("simulate", self.completed("help", "s"))
        self.assertEqual(self.completed("up", "--se"), ["--set", "--seconds"])

    def test_offers_settings_and_the_words_that_they_accept(self):
        self.assertEqual(self.completed("up", "rig.toml", "--set", "camera.back"), ["camera.backend="])
        self.assertEqual(self.completed("up", "rig.toml", "--set", "projector.packing", "=", "8"), ["8x3"])
        self.assertIn("v4l2", self.completed("up", "rig.toml", "--set", "camera.backend", "="))

    def test_offers_only_live_settings_to_be_set_at_once(self):
        self.assertIn("light.master=", self.completed("set", ""))
        self.assertNotIn("camera.backend=", self.completed("set", ""))

    def test_offers_services_back_ends_and_looks(self):
        self.assertEqual(self.completed("swap", "proj"), ["projector", "projector2"])
        self.assertEqual(self.completed("swap", "projector", "fi"), ["file"])
        self.assertEqual(self.completed("content", "la"), ["lava"])
        self.assertEqual(self.completed("desk", "--for", "v"), ["viewer"])

    def test_offers_nothing_in_place_of_what_only_a_person_knows(self):
        self.assertEqual(self.completed("preview", "--size", ""), [])
        self.assertEqual(self.completed("master", ""), [])


class Computer:
    """A container with systemd. `root`: its files, which are those of this machine until something writes them."""

    def __init__(self, folder):
        self.folder, self.root = folder, folder / "root"
        for name in ("upper", "work", "root"):
            (folder / name).mkdir(parents=True)
        mount_layer(folder)
        (self.root / "usr/sbin/policy-rc.d").unlink(missing_ok=True)  # images of Debian without systemd forbid to stop services
        self.write("in_container.sh", (HERE / "in_container.sh").read_text())
        self.write("etc/systemd/system/test.service",
                   "[Unit]\nAfter=multi-user.target\n[Service]\nType=oneshot\nExecStart=/bin/bash /script.sh\n")
        wanted = self.root / "etc/systemd/system/multi-user.target.wants/test.service"
        wanted.symlink_to("/etc/systemd/system/test.service")
        shutil.copytree(scratch / "packages", self.root / "packages")

    def write(self, name, text):
        (self.root / name).write_text(text)

    def close(self):
        subprocess.run(["umount", self.root], check=True)

    def boot(self, script, *options):
        """Starts the computer, which runs the script and ends. Returns the facts that it wrote."""
        self.write("script.sh", (HERE / script).read_text())
        results = [self.folder / f"{script}.facts", self.folder / f"{script}.log"]
        for file in results:
            file.touch()
        binds = [f"--bind={file}:/{file.suffix[1:]}" for file in results]
        for name in ("facts", "log"):
            self.write(name, "")
        with contextlib.suppress(subprocess.TimeoutExpired):
            subprocess.run(["systemd-nspawn", "--directory", self.root, "--boot", "--register=no", "--keep-unit", "--quiet", *binds, *options],
                           stdin=subprocess.DEVNULL, capture_output=True, timeout=4 * PATIENCE_S)
        facts = collections.defaultdict(lambda: "no", (line.partition(" ")[::2] for line in results[0].read_text().splitlines()))
        if "done" not in facts:
            raise AssertionError(results[1].read_text()[-6000:])
        return facts


class AComputer(unittest.TestCase):
    """One after the other: what a technician does, and the next morning."""

    @classmethod
    def setUpClass(cls):
        if reason := why_no_computer():
            raise unittest.SkipTest(reason)
        computer = Computer(scratch / "computer")
        cls.addClassCleanup(computer.close)
        cls.evening = computer.boot("technician.sh")
        cls.morning = computer.boot("morning.sh", "--volatile=overlay", "--private-network")
        print(f"start to light: {cls.evening['start_to_light_s']} s at the first start, {cls.morning['start_to_light_s']} s at boot")

    def test_has_a_user_with_the_rights_that_devices_need(self):
        self.assertEqual(self.evening["installed"], "yes")
        self.assertEqual(set(self.evening["groups"].split()), {"handcast", "video", "render", "input", "plugdev"})
        self.assertEqual(self.evening["owners"], "handcast:755 handcast:750 handcast:750")

    def test_is_told_by_init_how_the_rig_starts(self):
        self.assertEqual(self.evening["next_step"], "sudo systemctl enable --now handcast@show")

    def test_keeps_settings_and_serves_the_desk_in_its_sandbox(self):
        self.assertEqual(self.evening["saved"], "handcast")
        self.assertEqual(self.evening["desk"], "http:/")

    def test_casts_light_during_an_upgrade_and_until_it_is_restarted(self):
        self.assertEqual(self.evening["upgraded_under_the_light"], "yes")
        self.assertEqual(self.evening["restarted"], "yes")

    def test_gives_the_rig_another_supervisor_that_adopts_its_services(self):
        self.assertEqual(self.evening["adopted_by_the_next_supervisor"], "yes")

    def test_keeps_rig_files_when_handcast_is_removed_and_recordings_when_it_is_purged(self):
        self.assertEqual((self.evening["removed"], self.evening["processes_left"]), ("yes", "0"))
        self.assertEqual(self.evening["left_by_remove"].split(), ["show.live.toml", "show.toml"])
        folder = "/var/lib/handcast"
        self.assertEqual(self.evening["left_by_purge"].split(),
                         [folder, f"{folder}/show", f"{folder}/show/recordings", f"{folder}/show/recordings/first"])
        self.assertIn("recordings are kept", self.evening["purge_says"])

    def test_casts_light_in_the_morning_without_a_network_on_a_root_that_is_read_only(self):
        self.assertEqual(self.morning["interfaces"], "lo")
        self.assertEqual(self.morning["light"], "yes")

    def test_casts_light_by_the_tracker_alone_until_its_camera_comes(self):
        self.assertEqual((self.morning["light_of_the_tracker_alone"], self.morning["camera_that_came_late"]), ("yes", "yes"))

    def test_casts_light_when_its_disk_is_full(self):
        for name in ("light_with_a_full_disk", "light_after_a_death_with_a_full_disk", "light_of_a_start_with_a_full_disk"):
            self.assertEqual(self.morning[name], "yes", name)


if __name__ == "__main__":
    unittest.main(verbosity=2)
