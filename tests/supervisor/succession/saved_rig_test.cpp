// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/saved_rig.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <fstream>
#include <sstream>

#include "ipc/control/runtime_folder.hpp"
#include "tests/supervisor/runtime_scratch.hpp"

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

SavedRig desk() {
  return {.name = "desk",
          .rig_file = "/rigs/desk.toml",
          .settings = {"camera.rate_hz=60", "name=\"desk\""},
          .out = "/tmp/out",
          .epoch_ns = 42,
          .rings = {{"camera.frames", 123456789012345, 64}},
          .services = {{"pose", 4711, 99887766, State::ready, "replay", "abcdef", 3},
                       {"camera", 0, 0, State::failed, "", "", 0}}};
}

class SavedRigTest : public testing::Test {
 protected:
  std::filesystem::path file() const { return *control::runtime_folder() / "desk.state"; }
  std::string text() const {
    std::ostringstream text;
    text << std::ifstream(file()).rdbuf();
    return text.str();
  }
  void overwrite(const std::string& text) const {
    std::ofstream(file(), std::ios::trunc) << text;
    chmod(file().c_str(), 0600);
  }
  void expect_invalid(std::string_view why) const {
    const auto loaded = load_saved("desk");
    ASSERT_FALSE(loaded) << "accepted";
    EXPECT_EQ(loaded.error().code, Errc::bad_data);
    EXPECT_THAT(loaded.error().what, HasSubstr(std::string(why)));
  }
  std::string with(const std::string& from, const std::string& to) const {
    auto changed = text();
    const auto at = changed.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return changed.replace(at, from.size(), to);
  }
  RuntimeScratch scratch_;
};

TEST_F(SavedRigTest, WhatIsSavedIsLoadedAgain) {
  ASSERT_TRUE(save(desk()));
  const auto loaded = load_saved("desk");
  ASSERT_TRUE(loaded && *loaded);
  const auto& rig = **loaded;
  EXPECT_EQ(rig.rig_file, "/rigs/desk.toml");
  EXPECT_EQ(rig.settings, desk().settings);
  EXPECT_EQ(rig.out, "/tmp/out");
  EXPECT_EQ(rig.epoch_ns, 42);
  ASSERT_THAT(rig.rings, SizeIs(1));
  EXPECT_EQ(rig.rings[0].stream, "camera.frames");
  EXPECT_EQ(rig.rings[0].inode, 123456789012345u);
  EXPECT_EQ(rig.rings[0].fd, 64);
  ASSERT_THAT(rig.services, SizeIs(2));
  EXPECT_EQ(rig.services[0].pid, 4711);
  EXPECT_EQ(rig.services[0].started_ticks, 99887766u);
  EXPECT_EQ(rig.services[0].state, State::ready);
  EXPECT_EQ(rig.services[0].swapped, "replay");
  EXPECT_EQ(rig.services[0].fingerprint, "abcdef");
  EXPECT_EQ(rig.services[0].restarts, 3);
  EXPECT_EQ(rig.services[1].state, State::failed);
}

TEST_F(SavedRigTest, NothingLeftIsNotAnError) {
  EXPECT_EQ(load_saved("desk"), std::nullopt);
  ASSERT_TRUE(save(desk()));
  forget_saved("desk");
  EXPECT_EQ(load_saved("desk"), std::nullopt);
}

TEST_F(SavedRigTest, TheFileIsForItsUserAlone) {
  ASSERT_TRUE(save(desk()));
  struct stat status {};
  ASSERT_EQ(stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  chmod(file().c_str(), 0644);
  expect_invalid("other users have access to it");
}

TEST_F(SavedRigTest, ATornFileIsAnErrorAtEveryLength) {
  ASSERT_TRUE(save(desk()));
  const auto whole = text();
  for (std::size_t length = 0; length < whole.size() - 2; ++length) {
    overwrite(whole.substr(0, length));
    EXPECT_FALSE(load_saved("desk")) << length;
  }
}

TEST_F(SavedRigTest, AFileFromBeforeTheLastStartOfTheMachineIsNothing) {
  ASSERT_TRUE(save(desk()));
  const auto at = text().find("\"boot\": \"");
  ASSERT_NE(at, std::string::npos);
  auto other = text();
  other.replace(at + 9, 4, "zzzz");
  overwrite(other);
  EXPECT_EQ(load_saved("desk"), std::nullopt);
}

TEST_F(SavedRigTest, AnotherUsersFileIsAnError) {
  if (getuid() != 0) GTEST_SKIP() << "only root can give a file away";
  ASSERT_TRUE(save(desk()));
  ASSERT_EQ(chown(file().c_str(), 65534, 65534), 0);
  expect_invalid("another user");
}

TEST_F(SavedRigTest, NumbersThatCouldHitOthersAreAnError) {
  ASSERT_TRUE(save(desk()));
  const auto whole = text();
  for (const auto* pid : {"-1", "1", "99999999", "\"4711\"", "1e300"}) {
    overwrite(with("\"pid\": 4711", fmt::format("\"pid\": {}", pid)));
    EXPECT_FALSE(load_saved("desk")) << pid;
    overwrite(whole);
  }
  for (const auto* fd : {"-1", "0", "2", "null"}) {
    overwrite(with("\"fd\": 64", fmt::format("\"fd\": {}", fd)));
    EXPECT_FALSE(load_saved("desk")) << fd;
    overwrite(whole);
  }
  overwrite(with("\"name\": \"desk\"", "\"name\": \"sofa\""));
  expect_invalid("named 'sofa'");
}

TEST_F(SavedRigTest, AFullFolderIsAnErrorAndTheOldStateStays) {
  ASSERT_TRUE(save(desk()));
  auto changed = desk();
  changed.epoch_ns = 43;
  std::filesystem::create_directories(file().string() + ".new/in/the/way");
  const auto saved = save(changed);
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, Errc::unavailable);
  EXPECT_EQ(load_saved("desk").value()->epoch_ns, 42);
}

}  // namespace
}  // namespace handcast::supervisor
