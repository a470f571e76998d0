// SPDX-License-Identifier: Apache-2.0
// Services whose environment and descriptors the kernel hides, because their programs have
// capabilities.
#include <gmock/gmock.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>

#include <fstream>

#include "ipc/base/clock.hpp"
#include "ipc/control/rig_address.hpp"
#include "ipc/msg/stage_mark.hpp"
#include "supervisor/base/pidfd.hpp"
#include "supervisor/base/process.hpp"
#include "supervisor/succession/adoption.hpp"
#include "supervisor/succession/descriptor_store.hpp"
#include "supervisor/succession/stop_rig.hpp"
#include "tests/supervisor/scope_scratch.hpp"
#include "tests/system/command.hpp"

namespace handcast::supervisor {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

constexpr uid_t kNobody = 65534;
constexpr int kHeldFd = 200;  ///< the number of the ring in the services

/// Each test runs in a process of an ordinary user.
class Rights : public testing::Test {
 protected:
  void SetUp() override {
    if (getuid() != 0) GTEST_SKIP() << "only the superuser can give a program capabilities";
    program_ = scratch_.path() / "handcast-camera";
    std::filesystem::copy_file("/bin/bash", program_);
    std::filesystem::permissions(scratch_.path(), std::filesystem::perms(0755));
    const auto command = "setcap cap_sys_nice+ep " + program_.string() + " 2>/dev/null";
    if (std::system(command.c_str()) != 0)
      GTEST_SKIP() << "setcap, or the file system of " << program_ << ", gives no capabilities";
  }

  void as_nobody(const std::function<void()>& body) {
    const pid_t child = fork();
    if (child == 0) {
      prctl(PR_SET_CHILD_SUBREAPER, 1);
      if (setgid(kNobody) != 0 || setuid(kNobody) != 0) _exit(2);
      body();
      _exit(HasFailure() ? 1 : 0);
    }
    int status = -1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0) << "see above";
  }

  ChildSpec spec() const {
    return {.program = program_,
            .arguments = {"-c", "echo up; while :; do sleep 0.05; done"},
            .epoch_ns = 42,
            .rig = control::address_of("desk").value().text};
  }

  /// A process that was just forked says nothing of its rig until it runs its program.
  static auto services_soon(const std::string& rig, std::size_t count) {
    auto found = find_services(rig);
    for (const auto limit = Deadline::in(std::chrono::seconds(20));
         found.size() != count && !limit.passed(); found = find_services(rig))
      usleep(10'000);
    return found;
  }

  /// Waits until a process runs its program, and so has that one's capabilities.
  static bool runs_its_program(const Child& child) {
    pollfd output{child.log_fd(), POLLIN, 0};
    return poll(&output, 1, 20'000) == 1;
  }

  ScopeScratch scratch_;
  std::filesystem::path program_;
};

TEST_F(Rights, AServiceWithCapabilitiesIsFoundAndEnded) {
  as_nobody([this] {
    auto child = Child::spawn(spec());
    ASSERT_TRUE(child) << child.error().what;
    ASSERT_TRUE(runs_its_program(*child));
    EXPECT_EQ(proc_text("/proc/" + std::to_string(child->pid()) + "/environ"), "");
    const auto found = services_soon("desk", 1);
    ASSERT_THAT(found, SizeIs(1));
    EXPECT_EQ(found[0].service, "camera");
    EXPECT_EQ(found[0].epoch_ns, 42);
    EXPECT_THAT(find_services("sofa"), IsEmpty());
    const auto stopped = stop_rig("desk");
    ASSERT_TRUE(stopped) << stopped.error().what;
    EXPECT_EQ(stopped->ended, 1);
    EXPECT_TRUE(child->has_ended());
  });
}

TEST_F(Rights, AServiceWithCapabilitiesIsAdoptedWithItsRingsAndItsOutput) {
  as_nobody([this] {
    auto ring = ipc::Segment::create(ipc::RingSpec::of<msg::StageMarks>("marks.camera", 8, true));
    ASSERT_TRUE(ring);
    ASSERT_EQ(dup2(ring->fd(), kHeldFd), kHeldFd);
    auto state = StateMemory::create().value();
    auto spec = this->spec();
    spec.rings = {{"marks.camera", kHeldFd}};
    spec.state_fd = state.fd();
    auto child = Child::spawn(spec);
    ASSERT_TRUE(child) << child.error().what;
    ASSERT_TRUE(runs_its_program(*child));

    DescriptorStore store;
    auto kept = spec;
    kept.program = system_test::program_folder() / "handcast";
    kept.kept_open = {child->log_fd()};
    store.keep(kept, {child->pid()});
    SavedRig saved{.name = "desk", .epoch_ns = 42};
    saved.rings = {{"marks.camera", inode_of(kHeldFd), kHeldFd}};
    saved.services = {{"camera", child->pid(), start_ticks_of(child->pid()).value_or(0),
                       State::ready, "", "f", 0, inode_of(child->log_fd())}};
    ASSERT_TRUE(state.save(saved));
    close(kHeldFd);

    Result<std::optional<AdoptedRig>> adopted = std::optional<AdoptedRig>();
    for (const auto limit = Deadline::in(std::chrono::seconds(20)); !limit.passed();) {
      // The store needs a moment to give up what it inherited.
      if (find_services("desk").size() == 2 && state_of("desk")) break;
      usleep(10'000);
    }
    adopted = adopt("desk");
    ASSERT_TRUE(adopted && *adopted) << (adopted ? "no state" : adopted.error().what);
    ASSERT_THAT((*adopted)->services, SizeIs(1));
    EXPECT_EQ((*adopted)->services[0].saved.pid, child->pid());
    EXPECT_TRUE((*adopted)->services[0].log);
    EXPECT_EQ((*adopted)->rings.at(0).fd(), kHeldFd);
    EXPECT_FALSE(child->has_ended());
    EXPECT_TRUE(store.has_ended()) << "the successor makes one of its own";
  });
}

TEST_F(Rights, AServiceWithCapabilitiesThatNothingIsKeptOfIsEndedToBeStartedAnew) {
  as_nobody([this] {
    auto child = Child::spawn(spec());
    ASSERT_TRUE(child) << child.error().what;
    ASSERT_THAT(services_soon("desk", 1), SizeIs(1));
    const auto adopted = adopt("desk");
    ASSERT_TRUE(adopted) << adopted.error().what;
    EXPECT_FALSE(*adopted);
    EXPECT_TRUE(child->has_ended());
  });
}

TEST_F(Rights, AStoreIsOnlyMadeForServicesThatHideTheirDescriptors) {
  as_nobody([this] {
    auto plain = spec();
    plain.program = "/bin/bash";
    auto child = Child::spawn(plain);
    ASSERT_TRUE(child) << child.error().what;
    DescriptorStore store;
    plain.program = system_test::program_folder() / "handcast";
    store.keep(plain, {child->pid()});
    EXPECT_THAT(services_soon("desk", 1), SizeIs(1));
  });
}

}  // namespace
}  // namespace handcast::supervisor
