// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace handcast::bench {

/// Something that a landmark detector does again and again: it runs a network, or looks at a hand.
struct Subject {
  std::string name, backend;
  double mmac = 0;
  std::function<bool()> run;  ///< whether all went well
};

/// Says why where there is nothing to measure.
/// The network of a file in each back end, on noise.
std::vector<Subject> network_subjects(const std::filesystem::path& file);
/// Whole looks in each back end: crop, network, reading of its answer. `models`: MediaPipe's
/// folder.
std::vector<Subject> own_looks(const std::filesystem::path& file);
std::vector<Subject> mediapipe_looks(const std::filesystem::path& models);

inline constexpr const char* kOwnLook = "whole look, ours";
inline constexpr const char* kMediaPipeLook = "whole look, MediaPipe";

}  // namespace handcast::bench
