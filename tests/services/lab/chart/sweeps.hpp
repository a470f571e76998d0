// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace handcast::chart {

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Writes a file of results like `handcast sweep`. `rows` have no index.
inline std::filesystem::path write_sweep(const std::filesystem::path& folder,
                                         const std::string& plan, const std::string& columns,
                                         const std::vector<std::string>& rows) {
  const auto file = folder / (plan + ".csv");
  std::ofstream stream(file, std::ios::binary);
  stream << fmt::format(
      "# handcast sweep version=0.1.0 fingerprint=0123 runs={} plan={}\nindex,variant,{},error\n",
      rows.size(), plan, columns);
  for (std::size_t i = 0; i < rows.size(); ++i) stream << fmt::format("{},{}\n", i, rows[i]);
  return file;
}

/// Rungs at two speeds: the error falls with the cost. The paper is slow and has a medium error.
inline std::filesystem::path write_ladder(const std::filesystem::path& folder) {
  std::vector<std::string> rows;
  for (const int speed : {1, 3}) {
    rows.push_back(fmt::format("paper,builtin:wave,{},8.9,2,{},1900,", speed, 4.0 * speed));
    rows.push_back(fmt::format("hold,builtin:wave,{},6.1,7,{},700,", speed, 14.0 * speed));
    rows.push_back(fmt::format("shift,builtin:wave,{},6.3,3,{},760,", speed, 5.0 * speed));
    rows.push_back(fmt::format("register,builtin:wave,{},7,1,{},1300,", speed, 2.0 * speed));
    rows.push_back(fmt::format("handcast,builtin:wave,{},6.8,1,{},1000,", speed, 2.1 * speed));
  }
  return write_sweep(
      folder, "ladder",
      "twin.motion,twin.speed,motion_to_photon_ms,interior_mm_mean,interior_mm_p95,frame_us_p50",
      rows);
}

/// Two methods with tracker samples of increasing age: the error of the paper doubles at 15 ms,
/// that of handcast never.
inline std::filesystem::path write_stress(const std::filesystem::path& folder) {
  return write_sweep(folder, "stress", "twin.tracker.age_ms,twin.seed,interior_mm_mean",
                     {"paper,5,1,2,", "paper,5,2,4,", "paper,10,1,5,", "paper,20,1,7,",
                      "handcast,5,1,1,", "handcast,10,1,1.1,", "handcast,20,1,1.9,"});
}

/// A passing fault, a lasting one, and a difficult motion.
inline std::filesystem::path write_failures(const std::filesystem::path& folder) {
  return write_sweep(folder, "failures",
                     "twin.tracker.lost_at_s,twin.tracker.lost_s,twin.motion,twin.image.dark,"
                     "interior_mm_p95,coverage,spill,foldovers,fault_worst_mm,"
                     "fault_dark_ms,fault_recovery_ms",
                     {"paper,1,0.2,builtin:wave,,4,0.9,0.1,0,60,20,73,",
                      "handcast,1,0.2,builtin:wave,,3,0.9,0.1,0,30,10,,",
                      "handcast,,,builtin:wave,0.5,2.5,0.8,0.01,0,,,,",
                      "handcast,,,builtin:cross_fingers,,2.2,0.99,0.01,0,,,,"});
}

}  // namespace handcast::chart
