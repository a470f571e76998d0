// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "services/lab/sweep/columns.hpp"
#include "services/lab/sweep/runs.hpp"
#include "tests/scratch.hpp"

namespace handcast::sweep {

/// The root of the repository.
inline std::filesystem::path source_root() {
  const char* root = std::getenv("HANDCAST_SOURCE");
  return std::filesystem::absolute(root ? root : ".");
}

inline std::string default_rig() {
  return "rig = \"" + (source_root() / "config/rigs/twin.toml").string() + "\"\n";
}

/// Parses a plan whose rig is config/rigs/twin.toml, unless its text names another.
inline Result<Plan> plan_of(const std::string& toml,
                            const std::filesystem::path& file = "/plans/test.toml") {
  return parse_plan(toml.starts_with("rig =") ? toml : default_rig() + toml, file);
}

/// The error message of a plan; "" if it has none.
inline std::string fault_of(const std::string& toml) {
  const auto plan = plan_of(toml);
  if (!plan) return plan.error().what;
  const auto expansion = expand(*plan);
  return expansion ? "" : expansion.error().what;
}

inline std::string fingerprint_of(const std::string& toml,
                                  const std::filesystem::path& file = "/plans/test.toml") {
  const auto plan = plan_of(toml, file);
  EXPECT_TRUE(plan) << plan.error().what;
  const auto expansion = plan ? expand(*plan) : fail(Errc::bad_data, "no plan");
  EXPECT_TRUE(expansion) << expansion.error().what;
  return expansion ? expansion->fingerprint : "";
}

inline std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace handcast::sweep
