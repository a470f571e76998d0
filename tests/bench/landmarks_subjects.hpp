// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace handcast::bench {

/// Something that a landmark detector does over and over: run a network, or estimate a hand.
struct Subject {
  std::string name, executor;
  double mmac = 0;            ///< of a network; 0: not counted
  std::function<bool()> run;  ///< false if it failed
};

/// The network of a file, ours ("onednn") and OpenCV's, on noise. What cannot be opened is reported
/// and left out.
std::vector<Subject> network_subjects(const std::filesystem::path& file);
/// A whole estimate of each landmark model: crop, network, decoding. `models`: folder of
/// MediaPipe's files.
std::vector<Subject> estimate_subjects(const std::filesystem::path& models);

/// The name of a landmark model's estimate as a subject.
std::string estimate_of(const std::string& model);

}  // namespace handcast::bench
