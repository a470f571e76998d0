// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "config/rig.hpp"
#include "services/watch/tracks.hpp"

namespace handcast::watch {

/// What a black box holds.
struct BoxContents {
  std::string fault;                                                   ///< the sentence
  std::string changes;                                                 ///< of settings, a line each
  std::vector<std::pair<std::string, std::unique_ptr<Kept>>> streams;  ///< by name
};

/// Writes black boxes: recordings that `handcast play` plays, with fault.txt and changes.txt. One
/// thread.
class BlackBoxes {
 public:
  /// The boxes of a rig in a folder, of which the newest `most` are kept. `calibration`: its file.
  BlackBoxes(std::filesystem::path folder, int most, config::Rig rig, std::string calibration);

  /// Writes a box with this name, on a thread of its own; waits for the one before. What fails is
  /// in the log.
  void write(const std::string& name, BoxContents contents);
  /// The folder of a box.
  std::filesystem::path place_of(const std::string& name) const { return folder_ / name; }

 private:
  Result<void> write_now(const std::string& name, const BoxContents& contents) const;
  void remove_old() const;

  std::filesystem::path folder_;
  int most_;
  config::Rig rig_;
  std::string calibration_;
  std::jthread thread_;  ///< the last member: it uses the others
};

}  // namespace handcast::watch
