// SPDX-License-Identifier: Apache-2.0
// The program handcast-lamp, with a projector whose rig is down.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>

#include "tests/scratch.hpp"
#include "tests/services/desk/lamp/pjlink_projector.hpp"

namespace handcast::desk {
namespace {

class LampCommand : public testing::Test {
 protected:
  /// Its exit code.
  int run(const std::string& word) const {
    const auto rig = folder_.path() / "rig.toml";
    std::ofstream(rig) << "[projector.lamp]\npjlink = \"127.0.0.1:" << projector_.place.port
                       << "\"\n";
    const char* const bin = std::getenv("HANDCAST_BIN");
    const auto command = std::string(bin ? bin : "build/bin") + "/handcast-lamp " + word +
                         " --wait 0 --file " + rig.string();
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  test::PjlinkProjector projector_;
  const test::Scratch folder_;
};

TEST_F(LampCommand, TurnsTheLampOfARigThatIsDown) {
  run("on");
  EXPECT_EQ(projector_.state("POWR"), "1");
  run("off");
  EXPECT_EQ(projector_.state("POWR"), "0");
  EXPECT_EQ(run("status"), 0);
}

TEST_F(LampCommand, AWordThatItDoesNotKnowTurnsNothingOff) {
  projector_.set("POWR", "1");
  for (const auto* word : {"onn", "OFF", "unchanged"}) EXPECT_EQ(run(word), 2) << word;
  EXPECT_TRUE(projector_.commands().empty());
}

}  // namespace
}  // namespace handcast::desk
