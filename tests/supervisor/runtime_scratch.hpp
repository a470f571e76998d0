// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdlib.h>

#include "tests/scratch.hpp"

namespace handcast::supervisor {

/// A runtime folder that only this test sees, as long as it lives.
class RuntimeScratch {
 public:
  RuntimeScratch() { setenv("XDG_RUNTIME_DIR", scratch_.path().c_str(), 1); }
  ~RuntimeScratch() { unsetenv("XDG_RUNTIME_DIR"); }
  const std::filesystem::path& path() const { return scratch_.path(); }

 private:
  test::Scratch scratch_;
};

}  // namespace handcast::supervisor
