// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/config/every_setting.hpp"

namespace handcast::config {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Reference, HasARowForEverySetting) {
  const auto page = print_reference();
  Rig rig;
  for (const auto& setting : every_setting(rig)) {
    if (!name_at_first(setting.path).empty()) continue;
    EXPECT_THAT(page, HasSubstr("| `" + std::string(setting.name()) +
                                (setting.effect == Effect::live ? "` (live) | `" : "` | `") +
                                print_value(setting) + "` |"))
        << setting.path;
  }
}

TEST(Reference, SaysOnceThatTheSecondCameraHasTheSettingsOfTheFirstOne) {
  const auto page = print_reference();
  EXPECT_THAT(page, HasSubstr("It has the settings and sections of [camera], but for these.\n\n"
                              "| setting | default | allowed | unit | |\n|---|---|---|---|---|\n"
                              "| `backend` | `\"none\"` |"));
  EXPECT_THAT(page, HasSubstr("It has the settings and sections of [landmarks].\n"));
  for (const auto* within : {"[camera2.v4l2]", "[landmarks2.replay]", "[projector2.kms]"})
    EXPECT_THAT(page, Not(HasSubstr(within)));
  // It is true: their sections have the same settings.
  Rig rig;
  const auto listing = list_settings(rig);
  for (const auto& setting : every_setting(rig))
    for (const auto* service : {"camera.", "landmarks."})
      if (setting.path.starts_with(service)) {
        EXPECT_NE(find_setting(listing, name_at(Viewpoint::second, setting.path)), nullptr)
            << setting.path;
      }
}

}  // namespace
}  // namespace handcast::config
