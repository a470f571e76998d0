// SPDX-License-Identifier: Apache-2.0
#include "ipc/daemon/description.hpp"

#include <gmock/gmock.h>

namespace handcast::daemon {
namespace {

using testing::HasSubstr;

const ServiceDescription kCamera{
    .name = "camera",
    .summary = "Delivers \"frames\".",
    .paced_by = "its device",
    .publishes = {"camera.frames"},
    .settings = {"camera.rate_hz"},
    .backends = {{.name = "twin", .sentence = "Draws.", .settings = {"twin.image"}},
                 {.name = "aravis", .sentence = "Opens.", .exclusive = true}}};

TEST(Description, ComesBackAsItWasPrinted) {
  const auto read = parse_description(print_description(kCamera)).value();
  EXPECT_EQ(read.summary, kCamera.summary);
  EXPECT_EQ(read.paced_by, kCamera.paced_by);
  EXPECT_EQ(read.publishes, kCamera.publishes);
  EXPECT_EQ(read.settings, kCamera.settings);
  ASSERT_EQ(read.backends.size(), 2u);
  EXPECT_EQ(read.backends[0].settings, kCamera.backends[0].settings);
  EXPECT_FALSE(read.backends[0].exclusive);
  EXPECT_TRUE(read.backends[1].exclusive);
}

TEST(Description, ThatIsCutOffOrLacksAFieldIsAnError) {
  auto text = print_description(kCamera);
  EXPECT_THAT(parse_description(text.substr(0, text.size() / 2)).error().what,
              HasSubstr("not a description of a service"));
  EXPECT_EQ(parse_description(R"({"name": "camera"})").error().code, Errc::bad_data);
  EXPECT_EQ(parse_description("[1, 2]").error().code, Errc::bad_data);
  EXPECT_EQ(parse_description("").error().code, Errc::bad_data);
}

TEST(Description, PrintsItsBackEndsInColumns) {
  EXPECT_EQ(print_backends(kCamera), "twin    Draws.\naravis  Opens.\n");
  EXPECT_EQ(print_backends({}), "");
}

}  // namespace
}  // namespace handcast::daemon
