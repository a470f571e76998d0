// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/state_memory.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

SavedRig desk_since(std::int64_t epoch_ns) {
  SavedRig rig{.name = "desk", .epoch_ns = epoch_ns};
  rig.services.push_back({.name = "pose", .pid = 4711});
  return rig;
}

/// The same memory as another process maps it.
StateMemory elsewhere(const StateMemory& memory) {
  const auto file = "/proc/self/fd/" + std::to_string(memory.fd());
  return StateMemory::open(UniqueFd(::open(file.c_str(), O_RDWR | O_CLOEXEC))).value();
}

TEST(StateMemory, TheLastStateIsLoadedElsewhere) {
  auto memory = StateMemory::create().value();
  EXPECT_FALSE(memory.load("desk"));  // nothing is saved
  for (const auto epoch_ns : {41, 42, 43}) {
    ASSERT_TRUE(memory.save(desk_since(epoch_ns)));
    EXPECT_EQ(elsewhere(memory).load("desk").value().epoch_ns, epoch_ns);
  }
  EXPECT_FALSE(memory.load("sofa"));
}

TEST(StateMemory, OfARigThatHasStoppedNothingIsLoaded) {
  auto memory = StateMemory::create().value();
  ASSERT_TRUE(memory.save(desk_since(41)));
  memory.forget();
  EXPECT_FALSE(elsewhere(memory).load("desk"));
  ASSERT_TRUE(memory.save(desk_since(42)));
  EXPECT_EQ(elsewhere(memory).load("desk").value().epoch_ns, 42);
}

TEST(StateMemory, ItsPagesAreReservedAndItsSizeIsFixed) {
  const auto memory = StateMemory::create().value();
  struct stat status {};
  ASSERT_EQ(fstat(memory.fd(), &status), 0);
  EXPECT_GE(status.st_blocks * 512, status.st_size);
  EXPECT_NE(ftruncate(memory.fd(), 100), 0);
}

TEST(StateMemory, AStateThatIsTooLargeIsAnErrorAndTheOldOneStays) {
  auto memory = StateMemory::create().value();
  ASSERT_TRUE(memory.save(desk_since(42)));
  auto large = desk_since(43);
  large.applied.assign(1 << 20, 'x');
  const auto saved = memory.save(large);
  ASSERT_FALSE(saved);
  EXPECT_EQ(saved.error().code, Errc::unavailable);
  EXPECT_EQ(memory.load("desk").value().epoch_ns, 42);
}

TEST(StateMemory, AnotherFileIsNotMistakenForIt) {
  EXPECT_FALSE(StateMemory::open(UniqueFd(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC))));
  EXPECT_FALSE(StateMemory::open(UniqueFd(-1)));
  const auto memory = StateMemory::create().value();
  struct stat status {};
  fstat(memory.fd(), &status);
  UniqueFd same_size(memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  ASSERT_EQ(ftruncate(same_size.get(), status.st_size), 0);
  EXPECT_FALSE(StateMemory::open(UniqueFd(dup(same_size.get()))));  // it could shrink
  fcntl(same_size.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW);
  const auto opened = StateMemory::open(std::move(same_size));
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().what, HasSubstr("another file"));
}

// A process saves as fast as it can and is killed; what is left is one of the states, whole.
TEST(StateMemory, AKilledWriterLeavesAWholeState) {
  auto memory = StateMemory::create().value();
  ASSERT_TRUE(memory.save(desk_since(1)));
  std::int64_t newest_ns = 1;
  for (int round = 0; round < 30; ++round) {
    const pid_t writer = fork();
    if (writer == 0)
      for (std::int64_t epoch_ns = 2;; ++epoch_ns) (void)memory.save(desk_since(epoch_ns));
    usleep(static_cast<useconds_t>(500 + 170 * round));
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
    const auto loaded = elsewhere(memory).load("desk");
    ASSERT_TRUE(loaded) << loaded.error().what;
    EXPECT_EQ(loaded->services.at(0).pid, 4711);
    newest_ns = std::max(newest_ns, loaded->epoch_ns);
  }
  EXPECT_GT(newest_ns, 1) << "no writer has ever saved";
}

}  // namespace
}  // namespace handcast::supervisor
