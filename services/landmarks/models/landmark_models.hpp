// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "config/settings/setting_list.hpp"
#include "ipc/base/result.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "renderer/base/image.hpp"
#include "services/landmarks/geometry/points.hpp"
#include "services/landmarks/geometry/region.hpp"
#include "services/landmarks/models/mediapipe_palms.hpp"

namespace handcast::landmarks {

/// The landmarks of one hand as a model sees them in one region.
struct LandmarkEstimate {
  Points points_px{};                             ///< in the image
  std::array<float, msg::kLandmarks> sigma_px{};  ///< standard deviation per axis; 0: not known
  float presence = 0;                             ///< 0..1: how likely there is a hand
  /// 0..1: how likely it is a left hand, in an image that is not mirrored. 0.5 if the model does
  /// not score sides.
  float left_score = 0.5f;
};

/// How long the parts of an estimate took.
struct EstimateTimes {
  std::int64_t crop_ns = 0;     ///< resampling of the region and encoding of the input
  std::int64_t network_ns = 0;  ///< the network itself
};

/// Estimates the landmarks of one hand in a region of an image: a neural network with its crop. One
/// thread.
class LandmarkModel {
 public:
  virtual ~LandmarkModel() = default;

  /// The properties in which models differ for their users.
  struct Traits {
    /// Number of estimates of a hand that was not in the last image. From the second on, the region
    /// is that around the previous estimate.
    int passes_at_first = 1;
    /// left_score is set. A model that does not set it needs the side as an input; its sigmas are
    /// smaller if the side is right.
    bool scores_sides = false;
    /// The tracker's joints are an input of the network.
    bool reads_tracker = false;
    /// Of a model that reports no sigmas: the standard deviation of its landmarks per axis, as a
    /// share of the region's side. It says nothing of single landmarks, and so does not change
    /// their confidence. Landmarks have it where HandFinder::Poses::of_a_tracker: poses that are
    /// made from landmarks become worse by it. Only of a model that scores sides: without scores,
    /// sigmas tell them.
    float usual_sigma = 0;
  };
  /// The traits of this model; they never change.
  virtual Traits traits() const = 0;

  /// The region for a hand with these points: those of the last image, or the tracker's joints.
  virtual Region region_around(const Points& points_px) const = 0;

  /// Estimates the landmarks of the hand in `region`. `side`: the assumed side. `tracker_px`: the
  /// tracker's joints in the image; empty if the tracker does not see the hand.
  /// Adds to `times`. Errors: bad_data.
  virtual Result<LandmarkEstimate> estimate(renderer::GreyView image, const Region& region,
                                            msg::Side side, const std::optional<Points>& tracker_px,
                                            EstimateTimes& times) = 0;
};

/// The options of a model.
struct ModelOptions {
  std::filesystem::path folder;  ///< folder of MediaPipe's files; see models_folder()
  /// File of handcast's network; empty: the one that comes with handcast.
  std::filesystem::path handcast_network;
};

/// A landmark model and a palm network.
struct OpenedModel {
  std::unique_ptr<LandmarkModel> landmarks;  ///< the model
  /// Searches a whole image for hands that neither the tracker nor the last image shows. Empty if
  /// its file is missing and the model works without it.
  std::optional<MediapipePalmNetwork> palms;
};

/// A row of the table of landmark models.
struct LandmarkModelRow {
  std::string_view name;      ///< as landmarks.backend has it
  std::string_view sentence;  ///< what it is, for handcast-landmarks --backends
  Result<OpenedModel> (*open)(const ModelOptions& options);  ///< see open_landmark_model()
  /// The files without which it cannot be opened.
  std::vector<std::filesystem::path> (*files)(const ModelOptions& options);
  config::SettingList reads;  ///< the settings that it depends on
};

/// All landmark models.
std::span<const LandmarkModelRow> landmark_models();

/// Opens the model called `name`. Errors: bad_config (no such model; a file is missing or holds
/// another network, or one that cannot be run).
Result<OpenedModel> open_landmark_model(std::string_view name, const ModelOptions& options);

/// The first file that the model called `name` needs and that does not exist. Empty if there is
/// none, also if there is no such model.
std::filesystem::path missing_file(std::string_view name, const ModelOptions& options);

}  // namespace handcast::landmarks
