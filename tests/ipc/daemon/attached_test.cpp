// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/attached.hpp"

#include <gmock/gmock.h>

namespace handcast::daemon {
namespace {

using testing::HasSubstr;

const Attached kBasler{.kind = Kind::camera,
                       .name = "Basler acA720, serial number 7",
                       .about = "GigEVision at 10.0.0.7",
                       .settings = {{"camera.backend", "aravis"}, {"camera.aravis.device", "7"}},
                       .trouble = "it is controlled by another program",
                       .names = {"7", "Basler-7"},
                       .modes = {{"GREY", 16, 8, 720, 540, 525.5}},
                       .is_operators = true};

TEST(Attached, ComesBackAsItWasPrinted) {
  const auto read = attached_from(to_json({kBasler, {.kind = Kind::tracker}})).value();
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].kind, Kind::camera);
  EXPECT_EQ(read[0].name, kBasler.name);
  EXPECT_EQ(read[0].about, kBasler.about);
  EXPECT_EQ(read[0].settings, kBasler.settings) << "in their order";
  EXPECT_EQ(read[0].trouble, kBasler.trouble);
  EXPECT_EQ(read[0].names, kBasler.names);
  EXPECT_TRUE(read[0].is_operators);
  ASSERT_EQ(read[0].modes.size(), 1u);
  EXPECT_EQ(read[0].modes[0].format, "GREY");
  EXPECT_EQ(read[0].modes[0].least_width_px, 16);
  EXPECT_EQ(read[0].modes[0].least_height_px, 8);
  EXPECT_EQ(read[0].modes[0].width_px, 720);
  EXPECT_EQ(read[0].modes[0].height_px, 540);
  EXPECT_EQ(read[0].modes[0].rate_hz, 525.5);
  EXPECT_EQ(read[1].kind, Kind::tracker);
  EXPECT_TRUE(read[1].settings.empty());
}

TEST(Attached, MayBeCalledAnything) {
  EXPECT_EQ(attached_from(to_json({{.name = "\"\n\x01"}})).value()[0].name, "\"\n\x01");
  EXPECT_TRUE(attached_from(to_json({{.name = "\xff"}})).has_value()) << "no UTF-8";
}

TEST(Attached, ThatIsNoListOfDevicesIsAnError) {
  const auto text = to_json({kBasler});
  for (const auto& bad : {text.substr(0, text.size() / 2), std::string(), std::string("[1]"),
                          std::string(R"([{"kind": "cameras"}])"), std::string("{}")})
    EXPECT_EQ(attached_from(bad).error().code, Errc::bad_data) << bad;
  auto other = text;
  other.replace(other.find("cameras"), 7, "toaster");
  EXPECT_THAT(attached_from(other).error().what, HasSubstr("not a list of devices"));
}

}  // namespace
}  // namespace handcast::daemon
