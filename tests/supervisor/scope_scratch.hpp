// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <stdlib.h>

#include "tests/scratch.hpp"

namespace handcast::supervisor {

/// A scope of rigs of this test's own (HANDCAST_SCOPE) and a folder, as long as it lives.
class ScopeScratch {
 public:
  ScopeScratch() { setenv("HANDCAST_SCOPE", scratch_.path().c_str(), 1); }
  ~ScopeScratch() { unsetenv("HANDCAST_SCOPE"); }
  const std::filesystem::path& path() const { return scratch_.path(); }

 private:
  test::Scratch scratch_;
};

}  // namespace handcast::supervisor
