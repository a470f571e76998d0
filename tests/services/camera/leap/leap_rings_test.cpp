// SPDX-License-Identifier: Apache-2.0
// The programs with a controller: handcast-camera with a ring for each eye, handcast-devices.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <map>

#include "ipc/msg/stage_mark.hpp"
#include "ipc/ring/reader.hpp"
#include "services/camera/leap/calibration_block.hpp"
#include "services/camera/leap/lens_fit.hpp"
#include "tests/scratch.hpp"
#include "tests/services/camera/leap/leap_test.hpp"

namespace handcast::camera {
namespace {

using namespace std::chrono_literals;

ipc::Segment make_images(const std::string& stream) {
  return ipc::Segment::create(ipc::RingSpec::of<msg::CameraFrame>(
                                  stream, 8, false, msg::CameraFrame::bytes(640, 480)))
      .value();
}

ipc::Segment again(const ipc::Segment& ring) {
  return ipc::Segment::open(UniqueFd(dup(ring.fd()))).value();
}

/// handcast-camera in a process of its own, as a supervisor would start it.
class LeapRings : public test::LeapTest {
 protected:
  static std::string program_of(const std::string& name) {
    const char* programs = std::getenv("HANDCAST_BIN");
    return std::string(programs ? programs : "build/bin") + "/" + name;
  }
  void start() {
    const auto folder = std::filesystem::path(scratch_.path());
    const auto calibration = leap::parse_calibration(test::sample_calibration()).value();
    std::ofstream(folder / "leap.toml")
        << leap::calibration_file_of(calibration, "", config::Eye::left, kWidth, kHeight).value();
    std::ofstream(folder / "rig.toml")
        << "calibration = \"leap.toml\"\n[camera]\nbackend = \"leap\"\nrate_hz = 115\n";
    const auto program = program_of("handcast-camera");
    const auto rig = (folder / "rig.toml").string();
    const auto rings =
        fmt::format("HANDCAST_RINGS=camera.frames={},camera2.frames={},marks.camera={}", left_.fd(),
                    right_.fd(), marks_.fd());
    pid_ = fork();
    if (pid_ != 0) return;
    for (const auto* ring : {&left_, &right_, &marks_}) fcntl(ring->fd(), F_SETFD, 0);
    putenv(const_cast<char*>(rings.c_str()));
    execl(program.c_str(), program.c_str(), "--config", rig.c_str(), nullptr);
    _exit(127);
  }
  int stop() const {
    kill(pid_, SIGTERM);
    int state = 0;
    waitpid(pid_, &state, 0);
    return WIFEXITED(state) ? WEXITSTATUS(state) : -1;
  }

  test::Scratch scratch_;
  ipc::Segment left_ = make_images("camera.frames"), right_ = make_images("camera2.frames");
  ipc::Segment marks_ =
      ipc::Segment::create(ipc::RingSpec::of<msg::StageMarks>("marks.camera", 64, true)).value();
  pid_t pid_ = -1;
};

TEST_F(LeapRings, EachEyeHasItsRingAndBothHaveTheSameTimes) {
  auto left = ipc::Reader<msg::CameraFrame>::watch(again(left_)).value();
  auto right = ipc::Reader<msg::CameraFrame>::watch(again(right_)).value();
  start();
  // Either reader may be ahead of the other one.
  std::map<std::uint64_t, std::int64_t> left_origins, right_origins;
  int pairs = 0;
  for (const auto until = Deadline::in(20s); pairs < 20 && !until.passed();) {
    if (const auto image = left.next(Deadline::in(100ms))) {
      EXPECT_EQ((*image)->pixels()[100], test::LeapModel::left_of(test::number_in(**image)));
      EXPECT_NE((*image)->calibration, 0u);
      left_origins[(*image)->header.frame_id] = (*image)->header.origin_ns;
    }
    if (const auto image = right.next(Deadline::in(100ms))) {
      EXPECT_EQ((*image)->pixels()[100], test::LeapModel::right_of(test::number_in(**image)));
      EXPECT_NE((*image)->calibration, 0u) << "the calibration has both eyes";
      EXPECT_EQ((*image)->width_px, 640u);
      right_origins[(*image)->header.frame_id] = (*image)->header.origin_ns;
    }
    pairs = 0;
    for (const auto& [id, origin_ns] : left_origins)
      if (const auto twin = right_origins.find(id); twin != right_origins.end()) {
        EXPECT_EQ(twin->second, origin_ns);
        ++pairs;
      }
  }
  EXPECT_EQ(pairs, 20) << left.received() << " left, " << right.received() << " right";
  EXPECT_EQ(stop(), 0);
}

TEST_F(LeapRings, TheVerbWritesTheLensOfTheController) {
  const auto file = (std::filesystem::path(scratch_.path()) / "lens.toml").string();
  const auto run = [&](const std::string& more, const std::string& before = "") {
    return std::system((before + program_of("handcast-devices") + " --leap-calibration " + file +
                        more + " 2>/dev/null")
                           .c_str());
  };
  for (const auto* size : {"5", "15x15", "640x15", "15x480", "8193x480", "640x9999"}) {
    EXPECT_NE(run(std::string(" --size ") + size), 0) << size;
    EXPECT_FALSE(std::filesystem::exists(file)) << size;
  }
  ASSERT_EQ(run(" --size 16x16"), 0);
  EXPECT_TRUE(calib::load_calibration(file)) << "the smallest";
  std::filesystem::remove(file);
  EXPECT_NE(run("", "trap '' XFSZ; ulimit -f 0; "), 0) << "as on a full disk";
  EXPECT_FALSE(std::filesystem::exists(file)) << "nothing half-written is left";
  EXPECT_NE(run(" --leap LP0"), 0);
  ASSERT_EQ(run(" --eye right"), 0);
  const auto read = calib::load_calibration(file);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->camera_device, "LP53304172541");
  EXPECT_EQ(read->camera.width_px, 640);
  EXPECT_EQ(read->camera.height_px, 480) << "square pixels";
  EXPECT_NE(run(""), 0) << "a file that exists is kept";
}

}  // namespace
}  // namespace handcast::camera
