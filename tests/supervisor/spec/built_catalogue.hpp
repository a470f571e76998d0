// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>

#include "supervisor/spec/catalogue.hpp"

namespace handcast::test {

/// The descriptions of the services of this build.
inline supervisor::Catalogue built_catalogue() {
  const char* programs = std::getenv("HANDCAST_BIN");
  return supervisor::read_catalogue(
      supervisor::catalogue_folder(programs ? programs : "build/bin"));
}

}  // namespace handcast::test
