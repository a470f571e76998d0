// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/config/every_setting.hpp"

namespace handcast::config {
namespace {

TEST(Reference, HasARowForEverySetting) {
  const auto page = print_reference();
  Rig rig;
  for (const auto& setting : every_setting(rig))
    EXPECT_THAT(page, ::testing::HasSubstr("| `" + std::string(setting.name()) + "` | `" +
                                           print_value(setting) + "` |"))
        << setting.path;
}

}  // namespace
}  // namespace handcast::config
