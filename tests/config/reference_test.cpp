// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cstdlib>

#include "config/settings/files.hpp"
#include "tests/config/every_setting.hpp"

namespace handcast::config {
namespace {

TEST(Reference, ThePageInTheTreeIsWhatTheDeclarationsSay) {
  const char* source = std::getenv("HANDCAST_SOURCE");
  const auto page = read_text(std::filesystem::path(source ? source : ".") / "config/REFERENCE.md");
  ASSERT_TRUE(page) << page.error().what;
  EXPECT_TRUE(*page == print_reference())
      << "config/REFERENCE.md is out of date. Update it:\n"
         "  build/bin/handcast config --reference > config/REFERENCE.md";
}

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
