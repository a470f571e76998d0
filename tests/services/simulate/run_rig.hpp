#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "services/simulate/run.hpp"
#include "services/twin/twin.hpp"

namespace handcast::simulate {

inline std::filesystem::path source_root() {
  const char* root = std::getenv("HANDCAST_SOURCE");
  return root ? root : ".";
}

inline std::filesystem::path data_root() {
  const char* root = std::getenv("HANDCAST_DATA");
  return root ? std::filesystem::path(root) : source_root() / "../shared/data";
}

/// A folder of its own for one test, removed with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    auto name = (std::filesystem::temp_directory_path() / "handcast-test-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// twin.toml with settings of a test, and its world.
inline config::Rig rig_with(const std::vector<std::string>& settings) {
  auto rig = config::load_rig(source_root() / "config/rigs/twin.toml", settings);
  EXPECT_TRUE(rig) << rig.error().what;
  return *rig;
}

inline std::unique_ptr<twin::Twin> twin_of(const config::Rig& rig) {
  auto twin = twin::Twin::create(rig, calib::reference_rig());
  EXPECT_TRUE(twin) << twin.error().what;
  return std::move(*twin);
}

/// Runs one of config/rigs and returns its metrics.
inline nlohmann::json run_rig(const std::string& rig, const std::string& motion, double seconds, std::vector<std::string> settings = {}) {
  const ScratchFolder folder;
  Options options;
  options.rig_file = (source_root() / "config/rigs" / (rig + ".toml")).string();
  options.settings = std::move(settings);
  options.settings.push_back("twin.motion=" + motion);
  options.seconds = seconds;
  options.draw_every = 24;
  options.quiet = true;
  options.json_file = (folder.path() / "metrics.json").string();
  const auto done = run(options);
  EXPECT_TRUE(done) << done.error().what;
  return done ? nlohmann::json::parse(std::ifstream(options.json_file)) : nlohmann::json();
}

}  // namespace handcast::simulate
