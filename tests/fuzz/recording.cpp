// SPDX-License-Identifier: Apache-2.0
// The folder of a recording, opened by the three replay back ends and as a motion of the twin. The
// input is a sequence of files: number of the name, length (16 bits), contents.
// Limits: 10 s and 1 GB per input.
#include <fcntl.h>

#include <array>
#include <cmath>

#include "services/camera/camera.hpp"
#include "services/lab/twin/motion.hpp"
#include "services/landmarks/detector.hpp"
#include "services/pose/pose_source.hpp"
#include "tests/fuzz/input.hpp"

namespace {

using namespace handcast;
namespace fs = std::filesystem;

constexpr std::array kNames{
    "timestamps.npy",    "camera_timestamps.npy", "landmarks_timestamps.npy",
    "joints_left.npy",   "joints_right.npy",      "bones_left.npy",
    "bones_right.npy",   "landmarks_left.npy",    "landmarks_right.npy",
    "camera/000000.png", "camera/000001.png"};

/// A folder that is filled anew for each input.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("handcast-fuzz-" + std::to_string(getpid()))) {
    fs::create_directories(path_ / "camera");
  }
  ~Folder() { fs::remove_all(path_); }

  void fill(fuzz::Reader reader) {
    for (const auto* name : kNames) unlink((path_ / name).c_str());
    while (!reader.at_end()) {
      const auto* name = kNames[reader.number<std::uint8_t>() % kNames.size()];
      const auto bytes = reader.take(reader.number<std::uint16_t>());
      const int fd = open((path_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
      fuzz::require(write(fd, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
      close(fd);
    }
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// The recording as a motion, all along it.
void move(const fs::path& folder, const calib::Calibration& calibration) {
  config::Twin settings;
  settings.motion = folder;
  const auto motion = twin::open_motion(settings, calibration);
  if (!motion) return;
  for (int i = 0; i < 20; ++i)
    if (const auto joints = (*motion)->at(msg::Side::left, 0.1 * i))
      for (const auto& joint : *joints) fuzz::require(std::isfinite(joint[3].x));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Folder folder;
  folder.fill(fuzz::Reader({data, size}));
  auto calibration = calib::reference_rig();
  calibration.camera.width_px = calibration.camera.height_px = 16;
  config::Rig rig;
  rig.camera.backend = rig.pose.backend = rig.landmarks.backend = "replay";
  rig.camera.replay.directory = rig.pose.replay.directory = rig.landmarks.replay.directory =
      folder.path();
  const auto past = Deadline::in(std::chrono::seconds(0));
  const std::int64_t epoch_ns = now_ns();

  msg::HandPoses poses;
  if (const auto source = pose::open_pose_source(rig, calibration, epoch_ns))
    (void)(*source)->sample(poses, past);
  msg::CameraFrame frame;
  frame.header.origin_ns = epoch_ns;
  if (const auto detector = landmarks::open_detector(rig, calibration, epoch_ns))
    (void)(*detector)->detect(frame, {}, past);
  (void)camera::open_camera(rig, calibration, epoch_ns);
  move(folder.path(), calibration);
  return 0;
}
