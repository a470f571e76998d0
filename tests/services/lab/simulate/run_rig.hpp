// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/lab/simulate/run.hpp"
#include "services/lab/twin/twin.hpp"
#include "tests/scratch.hpp"

namespace handcast::simulate {

/// The root of the repository.
inline std::filesystem::path source_root() {
  const char* root = std::getenv("HANDCAST_SOURCE");
  return root ? root : ".";
}

/// The folder of data that is not in the repository: HANDCAST_DATA or ../shared/data.
inline std::filesystem::path data_root() {
  const char* root = std::getenv("HANDCAST_DATA");
  return root ? std::filesystem::path(root) : source_root() / "../shared/data";
}

/// What tests of the cascade set, so that they are fast and see one thing at a time: a detector
/// that is the truth and white noise, and frames in time. Tests of the rigs as they are shipped say
/// so.
inline const std::vector<std::string> kPlainTwin{
    "landmarks.backend=twin",      "twin.detector.age_ms=16.2", "twin.detector.age_sd_ms=1.9",
    "twin.detector.noise_px=1",    "twin.detector.bias_px=0",   "twin.detector.bias_ms=300",
    "twin.detector.bias_hidden=1", "twin.projector.work_ms=0"};

/// The settings of a test on the plain twin of config/rigs/RIG.toml.
inline std::vector<std::string> plain(const std::string& rig,
                                      const std::vector<std::string>& settings) {
  auto all = kPlainTwin;
  if (rig != "paper") all.emplace_back("projector.software_ms=1.2");
  all.insert(all.end(), settings.begin(), settings.end());
  return all;
}

/// config/rigs/twin.toml with the plain twin and the settings of a test.
inline config::Rig rig_with(const std::vector<std::string>& settings) {
  auto rig = config::load_rig(source_root() / "config/rigs/twin.toml", plain("twin", settings));
  EXPECT_TRUE(rig) << rig.error().what;
  return *rig;
}

/// The twin of a rig with the reference calibration.
inline std::unique_ptr<twin::Twin> twin_of(const config::Rig& rig) {
  auto twin = twin::Twin::create(rig, calib::reference_rig());
  EXPECT_TRUE(twin) << twin.error().what;
  return std::move(*twin);
}

/// The options of a quiet run of config/rigs/RIG.toml on the plain twin. More settings are
/// appended.
inline Options options_of(const std::string& rig, double seconds) {
  Options options;
  options.rig_file = (source_root() / "config/rigs" / (rig + ".toml")).string();
  options.settings = plain(rig, {});
  options.seconds = seconds;
  options.quiet = true;
  return options;
}

/// Enough for filters and registration; what is learned of a person takes longer.
inline constexpr double kWarmUp_s = 0.3;

/// Runs config/rigs/RIG.toml on the plain twin and returns its metrics.
inline nlohmann::json run_rig(const std::string& rig, const std::string& motion, double seconds,
                              const std::vector<std::string>& settings = {}, int draw_every = 24,
                              double warm_up_s = Options().warm_up_s) {
  const test::Scratch folder;
  Options options = options_of(rig, seconds);
  options.warm_up_s = warm_up_s;
  options.settings.insert(options.settings.end(), settings.begin(), settings.end());
  options.settings.push_back("twin.motion=" + motion);
  options.draw_every = draw_every;
  options.json_file = (folder.path() / "metrics.json").string();
  const auto done = run(options);
  EXPECT_TRUE(done) << done.error().what;
  return done ? nlohmann::json::parse(std::ifstream(options.json_file)) : nlohmann::json();
}

/// Adds settings to the options of a run.
inline void add_settings(Options& options, const std::vector<std::string>& settings) {
  options.settings.insert(options.settings.end(), settings.begin(), settings.end());
}

/// A figure of a run. A test failure, and not a number, if the run has not measured it.
inline double figure(const nlohmann::json& metrics, const std::string& pointer) {
  const auto& value = metrics.at(nlohmann::json::json_pointer(pointer));
  EXPECT_TRUE(value.is_number()) << pointer << " was not measured";
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace handcast::simulate
