// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "renderer/filter/landmark_filter.hpp"

/// The filters behind make_landmark_filter, one file each. Only landmark_filter.cpp, their tests
/// and who needs a TrackerMemory include this.
namespace handcast::renderer {

/// A filter that can start afresh.
class CarryFilter : public LandmarkFilter {
 public:
  void tracker_sample(std::int64_t) override {}
  /// Drops what detections have taught it; what it remembers of the tracker stays.
  virtual void forget() = 0;
};

std::unique_ptr<CarryFilter> make_naive_filter();
std::unique_ptr<CarryFilter> make_paper_filter(const config::Filter& settings);
std::unique_ptr<CarryFilter> make_kalman_filter(const config::Filter& settings);
std::unique_ptr<CarryFilter> make_offset_kalman(const config::Filter& settings);
std::unique_ptr<CarryFilter> make_one_euro_filter(const config::Filter& settings);

/// Around another filter: fades it out when detections stay away, and blends the jumps of its
/// output in.
std::unique_ptr<LandmarkFilter> make_settled_filter(const config::Filter& settings,
                                                    std::unique_ptr<CarryFilter> inner);

/// P as it was when light was drawn for a time: "as it was predicted then". Without hindsight, the
/// P that belongs to an image is the one drawn for the moment the image was taken, known only from
/// what the tracker had said until then.
class TrackerMemory {
 public:
  void remember(std::int64_t target_ns, const LandmarkPoints& tracker);
  std::optional<LandmarkPoints> at(
      std::int64_t time_ns) const;  ///< nothing outside what is remembered

 private:
  struct Entry {
    std::int64_t target_ns;
    LandmarkPoints tracker;
  };
  std::deque<Entry> entries_;  ///< by target time
};

/// P at a detection's time: by hindsight, or (where `memory` is given and reaches back that far) as
/// it was predicted then.
std::optional<LandmarkPoints> tracker_then(const TrackerAt& tracker, const TrackerMemory* memory,
                                           std::int64_t origin_ns);

/// Offsets of points that were never seen: the mean of the others'.
void lend_offsets(std::array<glm::vec2, kLandmarks>& offsets,
                  const std::array<bool, kLandmarks>& known);
/// P moved by these offsets, those that are not known lent; nothing where none is.
std::optional<LandmarkPoints> moved_by(const LandmarkPoints& tracker,
                                       std::array<glm::vec2, kLandmarks> offsets,
                                       const std::array<bool, kLandmarks>& known);

/// Where landmarks should be.
struct ExpectedPoints {
  std::array<glm::vec2, kLandmarks> px{};
  std::array<bool, kLandmarks> known{};
};
/// How far all together were seen from there: the length of the median. 0 where nothing can be
/// compared.
float common_error_px(const msg::HandLandmarks& seen, const ExpectedPoints& expected);

}  // namespace handcast::renderer
