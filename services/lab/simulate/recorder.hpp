// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "calib/calibration.hpp"
#include "ipc/base/result.hpp"
#include "renderer/base/image.hpp"
#include "services/lab/simulate/sensor_feed.hpp"
#include "services/recording/arrays/sensor_arrays.hpp"

namespace handcast::simulate {

/// The file of picture `number` in a folder: NNNNNN.png.
std::filesystem::path numbered_png(const std::filesystem::path& folder, std::size_t number);
/// Removes all files with such names from a folder, and no others. Errors: bad_config (a file
/// cannot be removed).
Result<void> remove_numbered_pngs(const std::filesystem::path& folder);

/// Passes on the messages of another feed and writes them as a recording for the replay back ends.
/// Every camera frame that arrives is written, whether or not the cascade uses it.
///
/// The folder holds timestamps.npy, joints_SIDE.npy and bones_SIDE.npy (Leap's layout);
/// landmarks_timestamps.npy and landmarks_SIDE.npy (n,21,3: x, y and sigma in px; x and y are NaN
/// if the landmark was not seen); camera_timestamps.npy and camera/NNNNNN.png. Times are in
/// microseconds since the epoch. All samples of a recording hold the same hands: the samples with
/// other hands than most are left out.
class RecordingFeed : public SensorFeed {
 public:
  /// Creates `folder`, or removes an earlier recording from it. Errors: bad_config, unavailable.
  /// Those of writing pictures are returned by save().
  static Result<std::unique_ptr<RecordingFeed>> create(std::unique_ptr<SensorFeed> source,
                                                       const calib::CameraModel& camera,
                                                       std::filesystem::path folder);

  std::vector<SensorEvent> until(std::int64_t now_ns) override;
  std::optional<Exposure> newest_exposure(std::int64_t now_ns) override {
    return source_->newest_exposure(now_ns);
  }
  void image(const Exposure& exposure, renderer::View<std::uint8_t> pixels) override;

  /// Writes the messages and the time stamps. Errors: bad_config, unavailable (a file cannot be
  /// written), bad_data (fewer than two samples of a hand).
  Result<void> save() const;

  /// All messages, and all images, so far.
  /// @{
  const std::vector<SensorEvent>& events() const { return events_; }
  const std::vector<Exposure>& exposures() const { return exposures_; }
  /// @}

 private:
  RecordingFeed(std::unique_ptr<SensorFeed> source, const calib::CameraModel& camera,
                std::filesystem::path folder);
  void keep(const msg::HandPoses& poses) { poses_.push_back(poses); }
  void keep(const msg::Landmarks& landmarks) { landmarks_.push_back(landmarks); }
  void keep_images(std::int64_t now_ns);

  std::unique_ptr<SensorFeed> source_;
  std::filesystem::path folder_;
  std::vector<SensorEvent> events_;
  std::vector<Exposure> exposures_;
  std::vector<msg::HandPoses> poses_;
  std::vector<msg::Landmarks> landmarks_;
  std::optional<Exposure> newest_;
  renderer::Image<std::uint8_t> image_;  ///< that of newest_
  std::int64_t asked_ns_ = -1;           ///< camera frames are written up to this time
  std::vector<std::int64_t> image_times_us_;
  Result<void> pictures_;  ///< first error of writing a picture
};

}  // namespace handcast::simulate
