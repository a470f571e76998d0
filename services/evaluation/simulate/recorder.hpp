// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "services/evaluation/simulate/sensor_feed.hpp"
#include "services/evaluation/twin/recording.hpp"

namespace handcast::simulate {

/// A feed that passes another's messages on and keeps them, to be written as a recording: what the
/// replay back ends play. Every camera frame that has arrived is written, whether anybody asks for
/// it or not. An earlier recording in the folder is removed. Folder: timestamps.npy,
/// joints_SIDE.npy, bones_SIDE.npy (Leap's layout); landmarks_timestamps.npy, landmarks_SIDE.npy
/// (n,21,3: x, y and sigma in px, x and y not a number where not seen); camera/NNNNNN.png with
/// camera_timestamps.npy. Times in microseconds since the start. A recording holds the same hands
/// in every sample: those with others than most samples have are left out.
class RecordingFeed : public SensorFeed {
 public:
  RecordingFeed(std::unique_ptr<SensorFeed> source, const calib::CameraModel& camera,
                std::filesystem::path folder);

  std::vector<SensorEvent> until(std::int64_t now_ns) override;
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    return source_->newest_exposure(now_ns);
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override;

  /// Writes what was kept. Errors: bad_config (a picture or file cannot be written), bad_data
  /// (fewer than two samples of a hand).
  Result<void> save() const;

 private:
  void keep(const msg::HandPoses& poses) { poses_.push_back(poses); }
  void keep(const msg::Landmarks& landmarks) { landmarks_.push_back(landmarks); }
  void keep_images(std::int64_t now_ns);
  Result<void> save_landmarks() const;

  std::unique_ptr<SensorFeed> source_;
  std::filesystem::path folder_;
  std::vector<msg::HandPoses> poses_;
  std::vector<msg::Landmarks> landmarks_;
  std::optional<Exposure> newest_;
  renderer::Image<std::uint8_t> image_;  ///< of newest_
  std::int64_t asked_ns_ = -1;           ///< for the camera's frames until then
  std::vector<std::int64_t> image_times_us_;
  Result<void> pictures_;  ///< the first that could not be removed or written
};

}  // namespace handcast::simulate
