// SPDX-License-Identifier: Apache-2.0
// What listens in the name of a rig may answer anything: a client says so and goes on.
#include <gmock/gmock.h>

#include "ipc/control/control_client.hpp"
#include "tests/ipc/control/listening_rig.hpp"
#include "tests/supervisor/scope_scratch.hpp"

namespace handcast::control {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class HostileRig : public testing::Test {
 protected:
  /// Without a limit of time that a slow machine could reach: for what is refused by its content.
  static Result<Answer> ask_for_rings(std::chrono::nanoseconds patience = 60s) {
    return ask_with_descriptors("desk", {.verb = Verb::rings}, patience);
  }
  supervisor::ScopeScratch scratch_;
};

TEST_F(HostileRig, AnAnswerThatIsNoneIsRefusedWithASentence) {
  for (const std::string answer :
       {"\n", "42\n", "null\n", "[]\n", "{\n", "{}\n", "\"ok\"\n", "\xff\xfe\n", "{\"ok\":1}\n",
        "{\"ok\":false}\n", "{\"ok\":false,\"error\":{}}\n", "{\"ok\":\"true\"}\n"}) {
    const ListeningRig rig(answer);
    const auto said = ask_for_rings();
    ASSERT_FALSE(said) << answer;
    EXPECT_EQ(said.error().code, Errc::bad_data) << answer;
    EXPECT_FALSE(said.error().what.empty()) << answer;
  }
}

TEST_F(HostileRig, RingsWithoutTheirDescriptorsAreRefused) {
  for (const std::string rings : {"7", "{\"a\":1}", "[\"camera.frames\"]", "[[],[],[]]"}) {
    const ListeningRig rig("{\"ok\":true,\"rings\":" + rings + "}\n");
    const auto said = ask_for_rings();
    ASSERT_FALSE(said) << rings;
    EXPECT_THAT(said.error().what, HasSubstr("sent 0 descriptors")) << rings;
  }
}

TEST_F(HostileRig, ARigThatLeavesBeforeItsAnswerIsWholeWentAway) {
  for (const std::string answer : {"", "{\"ok\":tr"}) {
    const ListeningRig rig(answer);
    const auto said = ask_for_rings();
    ASSERT_FALSE(said) << answer;
    EXPECT_EQ(said.error().code, Errc::unavailable);
    EXPECT_THAT(said.error().what, HasSubstr("went away"));
  }
}

TEST_F(HostileRig, ALineThatStopsInTheMiddleIsNotWaitedForForEver) {
  const ListeningRig rig("{\"ok\":tr", ListeningRig::Then::keep);
  const auto said = ask_for_rings(500ms);
  ASSERT_FALSE(said);
  EXPECT_THAT(said.error().what, HasSubstr("has not answered"));
}

TEST_F(HostileRig, ALineWithoutAnEndIsCutOff) {
  const ListeningRig rig(std::string(20'000'000, ' '));
  const auto said = ask_for_rings();
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().code, Errc::bad_data);
  EXPECT_THAT(said.error().what, HasSubstr("does not end"));
}

TEST_F(HostileRig, AnAnswerOfAMillionBracketsIsRefused) {
  const ListeningRig rig("{\"ok\":" + std::string(1'000'000, '[') + "\n");
  const auto said = ask_for_rings();
  ASSERT_FALSE(said);
  EXPECT_EQ(said.error().code, Errc::bad_data);
}

}  // namespace
}  // namespace handcast::control
