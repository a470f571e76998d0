// SPDX-License-Identifier: Apache-2.0
// Content that does not behave, in a rig.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/system/running_rig.hpp"
#include "tests/system/variable.hpp"

namespace handcast::system_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// The brightest red of a frame: about 255 for a white hand, less while a hand fades in that the
/// tracker had lost, as on a busy machine, and 0 without content.
std::uint32_t brightest(const msg::Projection& frame) {
  const std::size_t count = std::size_t{frame.region_width_px} * frame.region_height_px;
  std::uint32_t most = 0;
  for (std::size_t i = 0; i < count; ++i) most = std::max(most, frame.pixels()[i] & 0xff);
  return most;
}

class RigWithContent : public SystemTest {
 protected:
  std::string endless_shader() const {
    const std::string file = scratch_.path() / "endless.fs";
    // x remains below 1, but a compiler does not know. Mesa ends a loop after 65,535 turns.
    std::ofstream(file) << "/*{}*/\nvoid main() {\n  float x = isf_FragNormCoord.x;\n"
                           "  for (;;) {\n    for (;;) {\n      for (;;) {\n"
                           "        x = fract(1.7 * x + 0.3);\n"
                           "        if (x > 2.0) break;\n      }\n"
                           "      if (x > 2.0) break;\n    }\n"
                           "    if (x > 2.0) break;\n  }\n  gl_FragColor = vec4(x);\n}\n";
    return file;
  }
  nlohmann::json left() const {
    return nlohmann::json::parse(handcast({"content", "--json"}).output)["left"];
  }
};

TEST_F(RigWithContent, WhatIsRefusedIsNotKept) {
  const auto rig = up({"--set", "content.left=builtin:atlas"});
  wait_until_light();
  ASSERT_EQ(handcast({"content", "builtin:white"}).exit_code, 0);
  const auto refused = handcast({"content", "tgier"});
  EXPECT_EQ(refused.exit_code, 100);
  EXPECT_THAT(refused.log, HasSubstr("tgier"));
  EXPECT_THAT(handcast({"get", "content.left"}).output, HasSubstr("builtin:white"));
  EXPECT_THAT(handcast({"get", "content.right"}).output, HasSubstr("builtin:white"));
}

TEST_F(RigWithContent, AnEndlessShaderIsEndedAndNamedWhileTheLastPictureStays) {
  const auto rig =
      up({"--set", "content.left=builtin:atlas", "--set", "twin.motion=builtin:still"});
  wait_until_light();
  const auto plain = scratch_.path() / "plain.fs";
  std::ofstream(plain) << "/*{}*/\nvoid main() { gl_FragColor = vec4(1); }\n";
  const auto tried = handcast({"content", plain});
  if (tried.log.find("need OpenGL") != std::string::npos) GTEST_SKIP() << "no OpenGL here";
  ASSERT_EQ(tried.exit_code, 0) << tried.log;
  ASSERT_EQ(handcast({"content", "builtin:white", "--transition", "cut"}).exit_code, 0);

  const Variable scope(control::kScopeVariable, scratch_.path().string());
  auto frames = client::open_stream<msg::Projection>("twin", "projection.frames");
  ASSERT_TRUE(frames) << frames.error().what;
  const auto victim = service("content")["pid"].get<pid_t>();
  Command asking(scratch_.path(), {"content", endless_shader()});
  int seen = 0;
  std::uint32_t darkest = 255;
  while (asking.running()) {
    const auto frame = frames->next(Deadline::in(100ms));
    if (!frame || (*frame)->hand_count == 0) continue;
    ++seen;
    darkest = std::min(darkest, brightest(**frame));
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(darkest, 2u) << "of 255, in " << seen << " frames";
  EXPECT_FALSE(is_alive(victim));
  EXPECT_NE(asking.wait(), 0);
  EXPECT_THAT(asking.log(), HasSubstr("endless.fs"));
  EXPECT_THAT(asking.log(), HasSubstr("died with its first picture"));
  EXPECT_THAT(rig->log(), HasSubstr("content has given no sign of life for"));
  EXPECT_THAT(rig->log(), HasSubstr("endless.fs"));

  EXPECT_TRUE(eventually([&] { return service("content")["state"] == "ready"; }));
  EXPECT_EQ(left()["content"], "builtin:white");
  EXPECT_EQ(service("content")["restarts"], 1);
  EXPECT_EQ(handcast({"content", "builtin:checker"}).exit_code, 0);
  EXPECT_EQ(left()["content"], "builtin:checker");
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
}

}  // namespace
}  // namespace handcast::system_test
