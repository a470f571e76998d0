// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fstream>
#include <string>

#include "config/rig.hpp"
#include "tests/scratch.hpp"
#include "tests/services/pose/openxr/runtime/script.hpp"
#include "tests/system/variable.hpp"

namespace handcast::test {

/// The runtime of the tests with a script of its own.
class ScriptedRuntime {
 public:
  explicit ScriptedRuntime(const std::string& script = "") { play(script); }

  /// Replaces the script.
  void play(const std::string& script) const {
    const auto fresh = file_ + ".new";
    std::ofstream(fresh) << script << '\n';
    std::filesystem::rename(fresh, file_);
  }
  /// A rig whose tracker it is.
  config::Rig rig() const {
    config::Rig rig;
    rig.pose.backend = "openxr";
    rig.pose.openxr.runtime = HANDCAST_TEST_RUNTIME_MANIFEST;
    return rig;
  }
  std::string in_scratch(const std::string& name) const { return scratch_.path() / name; }

 private:
  Scratch scratch_;
  std::string file_ = scratch_.path() / "script";
  system_test::Variable variable_{test_runtime::kScriptVariable, file_};
};

}  // namespace handcast::test
