#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An installed tree runs from anywhere, and programs of other people read a rig with its library.

usage: installation_test.py BUILD_FOLDER

Installs, moves the tree, builds the examples with CMake and with pkg-config, and runs them, and the
one in Python, against a rig that was started from the moved tree.
"""
import json
import os
import pathlib
import pwd
import re
import shlex
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent
REPOSITORY = SOURCE.parent.parent
PATIENCE_S = 60  # ends what hangs
PROGRAMS = {"handcast", "handcast-camera", "handcast-pose", "handcast-landmarks",
            "handcast-projector", "handcast-observer", "handcast-simulate", "handcast-sweep",
            "handcast-detect", "handcast-report", "handcast-chart", "handcast-devices", "handcast-calibration-page",
            "handcast-doctor", "handcast-init", "handcast-record", "handcast-calibrate", "handcast-template",
            "handcast-content", "handcast-desk", "handcast-gallery", "handcast-lamp",
            "handcast-try", "handcast-guest", "handcast-watch", "handcast-day", "handcast-export-twin", "handcast-benchmark"}
OPTIONAL = {"handcast-bridge", "handcast-dlp", "handcast-exporter", "handcast-preview", "handcast-study"}
LINE = re.compile(r"frame (\d+) for ([\d.]+) ms:(?: image ([\d.]+) ms)?"
                  r"(?: pose ([\d.]+) ms)?(?: landmarks ([\d.]+) ms)? old")

PYTHON = "/usr/bin/python3"  # scripts/setup --tests installs numpy and OpenCV for it

build = scratch = tree = None


def has_modules(*names):
    return subprocess.run([PYTHON, "-c", f"import {', '.join(names)}"], capture_output=True).returncode == 0


def setUpModule():
    global scratch, tree
    scratch = pathlib.Path(tempfile.mkdtemp(prefix="handcast-"))
    run("cmake", "--install", build, "--prefix", scratch / "installed", "--strip")
    tree = scratch / "moved, with a space" / "handcast"
    tree.parent.mkdir()
    (scratch / "installed").rename(tree)


def tearDownModule():
    shutil.rmtree(scratch)


def environment(**more):
    """Nothing of the checkout, nothing of the person who runs the test."""
    return {"PATH": os.environ["PATH"], "HOME": str(scratch), "HANDCAST_SCOPE": str(scratch),
            **more}


def run(*command, codes=(0,), both=False, **env):
    done = subprocess.run([str(word) for word in command], cwd=scratch, env=environment(**env),
                          capture_output=True, text=True, timeout=PATIENCE_S)
    if done.returncode not in codes:
        said = done.stdout + done.stderr
        raise AssertionError(f"{command} ended with {done.returncode}:\n{said}")
    return done.stdout + done.stderr if both else done.stdout


def handcast(*arguments):
    return run(tree / "bin/handcast", *arguments)


def rig_file():
    return tree / "share/handcast/rigs/twin.toml"


def libraries():
    """lib/x86_64-linux-gnu or the like."""
    library, = (tree / "lib").glob("*/libhandcast.so.0")
    return library.parent


def moment_ms():
    return time.clock_gettime(time.CLOCK_MONOTONIC) * 1e3


class TheInstalledTree(unittest.TestCase):
    def test_holds_what_a_show_needs_and_no_program_of_the_tests_or_the_training(self):
        programs = {file.name for file in (tree / "bin").iterdir()}
        self.assertEqual(programs - OPTIONAL, PROGRAMS)
        for file in ("share/handcast/hand_left.glb", "share/handcast/landmarks/handcast.onnx",
                     "share/handcast/rigs/twin.toml", "share/handcast/calibrations/paper.toml",
                     "share/handcast/sweeps/stress.toml", "share/doc/handcast/README.md",
                     "share/doc/handcast/docs/operating/technician.md",
                     "share/doc/handcast/config/REFERENCE.md", "share/doc/handcast/LICENSE"):
            self.assertTrue((tree / file).is_file(), file)

    def test_holds_every_file_that_its_documents_link_to(self):
        pages = sorted((tree / "share/doc/handcast").rglob("*.md"))
        self.assertGreater(len(pages), 10)
        absent = [f"{page.name}: {link}" for page in pages
                  for link in re.findall(r"\]\(([^)\s#]+)[^)]*\)", page.read_text(encoding="utf-8"))
                  if "://" not in link and not (page.parent / link).exists()]
        self.assertEqual(absent, [])

    def test_does_not_name_the_place_it_was_built_or_installed_in(self):
        places = [str(place).encode() for place in (build, REPOSITORY, scratch / "installed")]
        for file in filter(pathlib.Path.is_file, tree.rglob("*")):
            if file.suffix == ".a":  # may hold debug information, which names the sources
                continue
            for place in places:
                self.assertFalse(place in file.read_bytes(), f"{file} names {place}")

    def test_scores_a_rig(self):
        frames = scratch / "frames"
        said = handcast("simulate", rig_file(), "--seconds", "0.1", "--frames", frames)
        self.assertRegex(said, r"interior error mean [\d.]+ mm")

    def test_names_an_installed_rig_in_place_of_one_that_is_not_there(self):
        said = run(tree / "bin/handcast", "config", "--check", "config/rigs/twin.toml", codes=(100,), both=True)
        self.assertIn(f"; there is {tree / 'share/handcast/rigs/twin.toml'}", said)

    def test_finds_the_network_of_the_detector(self):
        picture = scratch / "picture.png"
        picture.write_bytes((tree / "share/doc/handcast/config/assets/readme.png").read_bytes())
        said = run(tree / "bin/handcast", "detect", "--backend", "handcast", "--json", "--quiet", picture,
                   codes=(0, 1))  # 1: the picture has no hand
        self.assertIn("picture.png", said)

    def test_sweeps_a_plan_and_draws_a_chart(self):
        plan, results = scratch / "plan.toml", scratch / "plan.csv"
        plan.write_text(f'rig = "{rig_file()}"\nseconds = 0.2\nwarm_up_s = 0.1\n')
        handcast("sweep", plan, "-o", results, "--quiet")
        handcast("chart", results, "--out", scratch / "charts")
        self.assertTrue((scratch / "charts/charts.html").is_file())

    def test_lets_studies_find_the_library_that_they_draw_with(self):
        if not (tree / "bin/handcast-study").exists():
            self.skipTest("handcast-study has not been built")
        self.assertIn("jnd", handcast("study", "--help"))

    def test_lets_systemd_run_the_programs_where_they_are_now(self):
        unit = handcast("install-units", rig_file(), "--print")
        start = f'ExecStart="{tree}/bin/handcast" up --no-keeper "{rig_file()}" '
        self.assertIn(start, unit)
        self.assertIn(' --out "%S/handcast/twin"', unit)

    @unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
    def test_makes_units_that_systemd_accepts(self):
        for options in ([], ["--system", "--user", "daemon"]):
            unit = scratch / "handcast-twin.service"
            unit.write_text(handcast("install-units", *options, rig_file(), "--print"))
            run("systemd-analyze", "verify", "--man=no", "--recursive-errors=no", unit)

    def test_runs_no_system_unit_as_root_by_accident(self):
        command = [tree / "bin/handcast", "install-units", "--system", "--print", rig_file()]
        done = subprocess.run(command, env=environment(), capture_output=True, text=True,
                              timeout=PATIENCE_S)
        if os.getuid() == 0:
            self.assertEqual(done.returncode, 100)
            self.assertIn("would run as root; --user NAME", done.stderr)
        else:
            self.assertIn(f"\nUser={pwd.getpwuid(os.getuid()).pw_name}\n", done.stdout)

    def test_has_a_library_that_exports_its_own_functions_alone(self):
        said = run("nm", "-D", "--defined-only", "--format=posix", libraries() / "libhandcast.so.0")
        names = {line.split()[0].split("@")[0] for line in said.splitlines()} - {"HANDCAST_0"}
        header = (tree / "include/handcast.h").read_text(encoding="utf-8")
        self.assertEqual(names, set(re.findall(r"(handcast_\w+)\(", header)))

    def test_has_every_header_that_its_headers_include(self):
        folder = tree / "include/handcast"
        headers = sorted(str(file.relative_to(folder)) for file in folder.rglob("*.hpp"))
        self.assertIn("ipc/client/stream.hpp", headers)
        every = scratch / "every_header.cpp"
        every.write_text("".join(f'#include "{header}"\n' for header in headers))
        run("g++", "-std=c++20", "-Wall", "-Werror", "-fsyntax-only", *flags("--cflags"), every)


def flags(*options, package="handcast"):
    said = run("pkg-config", *options, package, PKG_CONFIG_PATH=str(libraries() / "pkgconfig"))
    return shlex.split(said)


class WithARig(unittest.TestCase):
    def setUp(self):
        self.processes = []
        self.addCleanup(self.end_processes)

    def end_processes(self):
        for process in reversed(self.processes):
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGTERM)
                process.wait(PATIENCE_S)
            for pipe in filter(None, (process.stdin, process.stdout)):
                pipe.close()

    def start(self, *command, stdin=None, **env):
        process = subprocess.Popen([str(word) for word in command], cwd=scratch, env=environment(**env),
                                   stdin=stdin, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True)
        self.processes.append(process)
        return process

    def start_rig(self, *settings, out=None, **env):
        slow = ["camera.rate_hz=60", "projector.rate_hz=60", "observer.enabled=false", *settings]
        rig = self.start(tree / "bin/handcast", "up", rig_file(),
                         *(word for setting in slow for word in ("--set", setting)), *(["--out", out] if out else []), **env)
        self.said = ""
        for line in rig.stdout:
            self.said += line
            if "projector" in line and "ready" in line:
                break
        return rig


class ABackEndOfSomebodyElse(WithARig):
    """The camera of docs/writing-a-back-end.md."""

    @classmethod
    def setUpClass(cls):
        cls.source, cls.own = scratch / "noise", scratch / "own/handcast/camera"
        cls.source.mkdir()
        cls.own.mkdir(parents=True)
        page = tree / "share/doc/handcast/docs/writing-a-back-end.md"
        for name in ("noise_camera.cpp", "CMakeLists.txt"):
            run(PYTHON, REPOSITORY / "scripts/cmake/listing.py", page, name, cls.source / name)
        run("cmake", "-G", "Ninja", "-S", cls.source, "-B", cls.source / "build", f"-DCMAKE_PREFIX_PATH={tree}",
            "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        run("cmake", "--build", cls.source / "build")
        run("cmake", "--install", cls.source / "build")

    def compile(self, name, source, *options):
        """NAME.so in the folder of $LD_LIBRARY_PATH."""
        run("g++", "-std=c++20", "-shared", "-fPIC", "-o", self.own / f"{name}.so", source, *options)

    def refusals(self, name):
        """What `config --check`, the doctor and the log of the service say."""
        env = {"LD_LIBRARY_PATH": str(scratch / "own")}
        setting = ("--set", f"camera.backend={name}")
        for command, code in (((tree / "bin/handcast", "config", "--check", rig_file()), 100),
                              ((tree / "bin/handcast", "doctor", rig_file(), "--seconds", "0.5"), 1),
                              ((tree / "bin/handcast-camera", "--config", rig_file()), 100)):
            process = self.start(*command, *setting, **env)
            said = process.stdout.read()
            self.assertEqual(process.wait(PATIENCE_S), code, said)
            yield " ".join(said.split())

    def test_is_found_by_name(self):
        self.assertRegex(run(tree / "bin/handcast-camera", "--backends"),
                         rf"noise +From {re.escape(str(tree))}/lib/handcast/camera/noise.so")
        self.assertIn("in order", handcast("config", "--check", rig_file(), "--set", "camera.backend=noise"))
        said = run(tree / "bin/handcast", "config", "--check", rig_file(), "--set", "camera.backend=nois", codes=(100,),
                   both=True)
        self.assertIn("; lib/handcast has no file of this name", said)

    def test_delivers_images_and_its_lines_reach_the_log(self):
        rig = self.start_rig("camera.backend=noise")
        handcast("swap", "camera", "twin")
        handcast("swap", "camera", "noise")
        rings = {row["stream"]: row for row in json.loads(handcast("top", "--once", "--json"))["rings"]}
        self.assertGreater(rings["camera.frames"]["published"], 0)
        handcast("down")
        self.assertRegex(self.said + rig.stdout.read(), r"camera +info +noise at 60 Hz\n")

    def test_may_be_a_tracker(self):
        source, folder = scratch / "tracker.cpp", scratch / "own/handcast/pose"
        source.write_text("""#include "services/pose/pose_source.hpp"
namespace handcast::pose {
static Result<std::unique_ptr<PoseSource>> open(const config::Rig& rig, const calib::Calibration&, const Surroundings&) {
  return fail(Errc::bad_config, "no tracker of " + rig.name);
}
const service::LoadedBackEnd<PoseBackend> handcast_pose_back_end{.row = {.name = "tracker", .open = open}};
}
""")
        folder.mkdir()
        self.compile("tracker", source, *flags("--cflags"))
        for said in self.refusals("tracker"):
            self.assertIn("tracker.so is no back end of this service: it lacks handcast_camera_back_end", said)
        (self.own / "tracker.so").rename(folder / "tracker.so")
        said = run(tree / "bin/handcast", "config", "--check", rig_file(), "--set", "pose.backend=tracker", codes=(100,),
                   both=True, LD_LIBRARY_PATH=str(scratch / "own"))
        self.assertIn("no tracker of twin", said)

    def test_may_be_a_detector_and_a_projector(self):
        sources = {
            "landmarks": """#include "services/landmarks/detector.hpp"
namespace handcast::landmarks {
/// Sees the hands where the tracker has them.
class Believer final : public Detector {
  Result<msg::Landmarks> detect(const msg::CameraFrame& frame, const Hints& hints, Deadline) override {
    msg::Landmarks seen{.header = {frame.header.frame_id, frame.header.origin_ns, 0}};
    for (int side = 0; side < msg::kMaxHands; ++side) {
      if (!hints[side] || !is_finite(*hints[side])) continue;
      auto& hand = seen.hands[seen.count++];
      hand.side = static_cast<msg::Side>(side);
      hand.presence = 1;
      for (int i = 0; i < msg::kLandmarks; ++i) hand.points[i] = {(*hints[side])[i].x, (*hints[side])[i].y, 1, 1};
    }
    return seen;
  }
};
static Result<std::unique_ptr<Detector>> open(const Opening&) { return std::make_unique<Believer>(); }
const service::LoadedBackEnd<DetectorBackend> handcast_landmarks_back_end{.row = {.name = "own", .open = open}};
}
""",
            "projector": """#include "ipc/base/log.hpp"
#include "renderer/output/light.hpp"
#include "services/projector/projector.hpp"
namespace handcast::projector {
/// Counts the pixels of the first light on a hand with landmarks.
class Meter final : public Projector {
  Result<PresentTimes> present(const renderer::Frame& frame, std::int64_t, const renderer::LightTable& table, Deadline) override {
    const auto now = now_ns();
    if (said_ || frame.hands.empty() || !frame.hands[0].has_landmarks || frame.region.empty()) return PresentTimes{now, now};
    std::vector<std::uint32_t> light(frame.colour.width * frame.colour.height);
    renderer::write_light(frame.colour, frame.region, table, {light.data(), frame.colour.width, frame.colour.height, frame.colour.width});
    const auto lit = std::count_if(light.begin(), light.end(), [](auto rgba) { return (rgba & 0xffffff) != 0; });
    log::info("{} pixels are lit", lit);
    said_ = lit > 0;
    return PresentTimes{now, now};
  }
  bool said_ = false;
};
static Result<std::unique_ptr<Projector>> open(const config::Rig&, const calib::Calibration&) { return std::make_unique<Meter>(); }
const service::LoadedBackEnd<ProjectorBackend> handcast_projector_back_end{.row = {.name = "own", .open = open}};
}
"""}
        for service, text in sources.items():
            source = scratch / f"own_{service}.cpp"
            source.write_text(text)
            (scratch / "own/handcast" / service).mkdir()
            self.compile(f"../{service}/own", source, *flags("--cflags"))
        own = {"LD_LIBRARY_PATH": str(scratch / "own")}
        self.assertIn("in order", run(tree / "bin/handcast", "config", "--check", rig_file(), "--set", "landmarks.backend=own", **own))
        without_models = scratch / "no models"
        without_models.mkdir()
        rig = self.start_rig("landmarks.backend=mediapipe", f"landmarks.models={without_models}", "landmarks.fallback=own",
                             "projector.backend=own", **own)
        for line in rig.stdout:
            self.said += line
            if re.search(r"projector +info +[1-9]\d+ pixels are lit", line):
                break
        else:
            self.fail(self.said)
        handcast("down")
        self.assertIn("so 'own' takes the place of 'mediapipe'", self.said + rig.stdout.read())

    def test_that_cannot_be_loaded_is_refused_with_a_sentence(self):
        (self.own / "text.so").write_text("no library\n")
        nothing, absent = scratch / "nothing.cpp", scratch / "libabsent.so"
        nothing.write_text("")
        self.compile("nothing", nothing)
        run("g++", "-shared", "-o", absent, nothing, "-Wl,-soname,libabsent.so.1")
        self.compile("lacking", nothing, "-Wl,--no-as-needed", absent)
        header = "services/runtime/backends.hpp"
        older = scratch / "older" / header
        older.parent.mkdir(parents=True)
        text = (tree / "include/handcast" / header).read_text(encoding="utf-8")
        older.write_text(text.replace('kAbi{"', 'kAbi{"0.'))
        self.compile("older", self.source / "noise_camera.cpp", f"-I{scratch}/older", *flags("--cflags"))
        for name, why in (("text", r"cannot be loaded: .*: (invalid ELF header|file too short)"),
                          ("lacking", r"cannot be loaded: libabsent.so.1: cannot open shared object file"),
                          ("nothing", r"is no back end of this service: it lacks handcast_camera_back_end"),
                          ("older", r"was built for handcast 0\.[\d.]+-\d+-\d+, and this is [\d.]+-\d+-\d+; build it again")):
            for said in self.refusals(name):
                self.assertRegex(said, rf"camera: \S+/own/handcast/camera/{name}\.so {why}")


class AProgramOfSomebodyElse(WithARig):
    """One after the other, on one rig."""

    @classmethod
    def setUpClass(cls):
        cls.by_cmake = scratch / "example/read_projections"
        folder = cls.by_cmake.parent
        # gcc splits a run path at its spaces.
        run("cmake", "-G", "Ninja", "-S", SOURCE, "-B", folder, f"-DCMAKE_PREFIX_PATH={tree}", "-DCMAKE_SKIP_RPATH=ON")
        run("cmake", "--build", folder)
        cls.by_pkg_config = scratch / "read_projections"
        run("g++", "-std=c++20", SOURCE / "read_projections.cpp", "-o", cls.by_pkg_config,
            *flags("--cflags", "--libs"))
        cls.ring_by_cmake = folder / "draw_ring"
        cls.ring_by_pkg_config = scratch / "draw_ring"
        run("gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", SOURCE / "draw_ring.c", "-o", cls.ring_by_pkg_config,
            *flags("--cflags", "--libs", package="handcast-c"), "-lm")

    def start_python(self, name, *arguments, **more):
        """With the Python that has numpy, if there is one."""
        return self.start(PYTHON, SOURCE / name, *arguments, **more, LD_LIBRARY_PATH=str(libraries()),
                          PYTHONPATH=str(tree / "share/handcast/python"))

    def frames(self, reader, count):
        """The next `count` frames: number, time of the light, ages of the inputs; all in ms."""
        frames = []
        while len(frames) < count:
            line = reader.stdout.readline()
            match = LINE.fullmatch(line.rstrip("\n"))
            self.assertTrue(match, f"not a frame: {line!r}")
            number, light_ms, *ages_ms = match.groups()
            frames.append((int(number), float(light_ms), [float(age) for age in ages_ms if age]))
        return frames

    def test_without_a_rig_is_told_how_to_start_one(self):
        said = self.start(self.by_cmake)
        self.assertIn("no rig is up; `handcast up RIG.toml` starts one", said.stdout.read())
        self.assertEqual(said.wait(PATIENCE_S), 1)

    def start_drawing(self, program, *arguments):
        return self.start(*program, *arguments, LD_LIBRARY_PATH=str(libraries()),
                          PYTHONPATH=str(tree / "share/handcast/python"))

    def test_that_draws_without_a_rig_is_told_how_to_start_one(self):
        for program in ([self.ring_by_pkg_config], [sys.executable, SOURCE / "draw_waves.py"]):
            said = self.start_drawing(program, "1")
            self.assertIn("no rig is up; `handcast up RIG.toml` starts one", said.stdout.read())
            self.assertEqual(said.wait(PATIENCE_S), 1)

    def test_draws_on_the_hands_in_c_and_in_python(self):
        self.start_rig()
        ring = self.start_drawing([self.ring_by_cmake], "30")
        waves = self.start_drawing([sys.executable, SOURCE / "draw_waves.py"], "30")
        seen = ring.stdout.read().splitlines()
        self.assertEqual(seen[-1].split(":")[0], "picture 29")
        self.assertIn("left 1", "".join(seen))
        self.assertEqual(waves.stdout.read().splitlines()[-1].split(":")[0], "picture 29")
        self.assertEqual([ring.wait(PATIENCE_S), waves.wait(PATIENCE_S)], [0, 0])
        rings = {row["stream"]: row for row in json.loads(handcast("top", "--once", "--json"))["rings"]}
        self.assertEqual([rings[name]["published"] for name in ("guest.left", "guest.right")], [30, 30])
        again = self.start_drawing([self.ring_by_pkg_config], "1000000")
        while "picture" not in again.stdout.readline():
            continue
        other = self.start_drawing([self.ring_by_cmake], "1")
        self.assertIn("another writer", other.stdout.read())
        handcast("down")
        self.assertIn("no longer up", again.stdout.read())
        self.assertEqual(again.wait(PATIENCE_S), 1)

    @unittest.skipUnless(has_modules("numpy"), "numpy is not installed")
    def test_is_the_tracker_of_a_rig(self):
        self.start_rig()
        sent = self.start_python("hands_to_json.py", "1").stdout.read()
        handcast("down")
        points = json.loads(sent)["left"]
        self.assertEqual(len(points), 26)
        self.start_rig("pose.backend=external")
        tracker = self.start_python("json_to_hands.py", stdin=subprocess.PIPE)
        reader = self.start_python("hands_to_json.py", "20")
        while reader.poll() is None:
            points[0][0] += 1e-5
            tracker.stdin.write(json.dumps({"left": points}) + "\n")
            tracker.stdin.flush()
            time.sleep(0.01)
        seen = [json.loads(line) for line in reader.stdout.read().splitlines()]
        self.assertAlmostEqual(seen[-1]["left"][10][1], points[10][1], places=5)
        tracker.stdin.write(json.dumps({"time_ns": 1, "left": points}) + "\n")
        tracker.stdin.close()
        self.assertIn("its time is", tracker.stdout.read())

    @unittest.skipUnless(has_modules("numpy", "cv2"), "OpenCV for Python is not installed")
    def test_is_the_detector_of_a_rig(self):
        self.start_rig("landmarks.backend=external")
        detector = self.start_python("detect_hands.py", tree / "share/handcast/landmarks/handcast.onnx", "40")
        self.assertIn("image 39: hand", detector.stdout.read())
        rings = {row["stream"]: row for row in json.loads(handcast("top", "--once", "--json"))["rings"]}
        self.assertEqual(rings["guest.landmarks"]["published"], 40)
        self.assertGreater(rings["landmarks.hands"]["published"], 20)

    @unittest.skipUnless(has_modules("numpy"), "numpy is not installed")
    def test_sends_hands_as_osc(self):
        self.start_rig()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as inbox:
            inbox.settimeout(PATIENCE_S)
            inbox.bind(("127.0.0.1", 0))
            self.start_python("hands_to_osc.py", "127.0.0.1", inbox.getsockname()[1])
            address, types, *place_m = struct.unpack(">20s8s3f", inbox.recv(1000))
        self.assertEqual((address.rstrip(b"\0"), types.rstrip(b"\0")), (b"/hand/left/thumb", b",fff"))
        self.assertTrue(0.01 < sum(each * each for each in place_m) ** 0.5 < 2, place_m)

    @unittest.skipUnless(has_modules("numpy"), "numpy is not installed")
    def test_paints_at_random(self):
        self.start_rig()
        painter = self.start_python("paint_at_random.py", "30")
        self.assertEqual((painter.stdout.read(), painter.wait(PATIENCE_S)), ("", 0))
        rings = {row["stream"]: row for row in json.loads(handcast("top", "--once", "--json"))["rings"]}
        self.assertEqual(rings["guest.left"]["published"], 30)

    @unittest.skipUnless(has_modules("matplotlib"), "matplotlib is not installed")
    def test_plots_the_error_of_the_light(self):
        out = scratch / "scored"
        self.start_rig("observer.enabled=true", out=out)
        picture = scratch / "error.png"
        plotted = self.start_python("plot_error.py", out, picture, "15").stdout.read()
        self.assertRegex(plotted, r"^[1-9]\d* points")
        self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))

    def test_reads_frames_until_the_rig_is_down(self):
        began_ms = moment_ms()
        self.start_rig()
        readers = [self.start(self.by_cmake), self.start(self.by_pkg_config, "twin")]
        for reader in readers:
            frames = self.frames(reader, 30)
            numbers = [number for number, _, _ in frames]
            self.assertEqual(numbers, sorted(set(numbers)))
            for _, light_ms, ages_ms in frames:
                self.assertGreater(light_ms, began_ms)
                self.assertLess(light_ms, moment_ms() + 1000)
                for age_ms in ages_ms:
                    self.assertGreater(age_ms, 0)
                    self.assertLess(age_ms, light_ms - began_ms)
            self.assertEqual(len(frames[-1][2]), 3, "image, pose and landmarks")
        handcast("down")
        for reader in readers:
            last_line = reader.stdout.read().splitlines()[-1]
            self.assertEqual(last_line, "read_projections: rig 'twin' is no longer up")
            self.assertEqual(reader.wait(PATIENCE_S), 1)

    def test_goes_on_while_the_supervisor_is_replaced_and_is_no_reader_of_the_rig(self):
        rig = self.start_rig()
        reader = self.start(self.by_cmake)
        self.frames(reader, 5)
        pids = {row["pid"] for ring in json.loads(handcast("top", "--once", "--json"))["rings"]
                for row in ring["readers"]}
        self.assertTrue(pids, "the services read each other's rings")
        self.assertNotIn(reader.pid, pids)
        children = pathlib.Path(f"/proc/{rig.pid}/task/{rig.pid}/children")
        os.kill(int(children.read_text().split()[0]), signal.SIGKILL)  # the supervisor
        killed_ms = moment_ms()
        while self.frames(reader, 1)[0][1] < killed_ms + 1000:
            continue
        other = self.start(self.by_pkg_config)  # finds the new supervisor
        self.frames(other, 1)
        handcast("down")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    build = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
