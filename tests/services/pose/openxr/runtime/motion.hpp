// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "ipc/msg/hand_poses.hpp"

namespace handcast::test_runtime {

/// Hands over time, at a constant rate. After the end it begins again.
struct Motion {
  double rate_hz = 0;
  std::vector<msg::HandPoses> frames;
};

/// A motion file: rate_hz, the number of frames, the frames, as they are in memory.
/// @{
inline void write_motion(const std::string& path, const Motion& motion) {
  std::ofstream file(path, std::ios::binary);
  const std::uint64_t count = motion.frames.size();
  file.write(reinterpret_cast<const char*>(&motion.rate_hz), sizeof motion.rate_hz);
  file.write(reinterpret_cast<const char*>(&count), sizeof count);
  file.write(reinterpret_cast<const char*>(motion.frames.data()),
             static_cast<std::streamsize>(count * sizeof(msg::HandPoses)));
}
inline Motion read_motion(const std::string& path) {
  Motion motion;
  std::uint64_t count = 0;
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(&motion.rate_hz), sizeof motion.rate_hz);
  file.read(reinterpret_cast<char*>(&count), sizeof count);
  if (!file || count > 1'000'000) return {};
  motion.frames.resize(count);
  file.read(reinterpret_cast<char*>(motion.frames.data()),
            static_cast<std::streamsize>(count * sizeof(msg::HandPoses)));
  return motion;
}
/// @}

/// A left hand that sways by 50 mm twice in three seconds.
Motion swaying_hand();

}  // namespace handcast::test_runtime
