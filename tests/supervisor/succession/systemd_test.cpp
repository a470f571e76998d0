// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/systemd.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <array>
#include <cstddef>
#include <cstring>

#include "tests/scratch.hpp"

namespace handcast::supervisor {
namespace {

using testing::HasSubstr;

/// A datagram socket in place of systemd's.
class Systemd : public testing::Test {
 protected:
  void SetUp() override { listen_at((scratch_.path() / "notify").string()); }
  void TearDown() override {
    for (const auto* name : {"NOTIFY_SOCKET", "LISTEN_PID", "LISTEN_FDS", "LISTEN_FDNAMES",
                             "WATCHDOG_USEC", "WATCHDOG_PID"})
      unsetenv(name);
  }
  void listen_at(const std::string& name) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, name.data(), name.size());
    if (name[0] == '@') address.sun_path[0] = '\0';
    socket_ = UniqueFd(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
    const auto size = offsetof(sockaddr_un, sun_path) + name.size() + (name[0] == '@' ? 0 : 1);
    ASSERT_EQ(
        bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), static_cast<socklen_t>(size)),
        0);
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }

  /// The next datagram and the descriptor in it; "" if there is none.
  std::string receive(UniqueFd* fd = nullptr) {
    std::array<char, 4096> text;
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    iovec bytes{.iov_base = text.data(), .iov_len = text.size()};
    msghdr message{};
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const auto size = recvmsg(socket_.get(), &message, MSG_CMSG_CLOEXEC);
    if (const auto* header = CMSG_FIRSTHDR(&message); size >= 0 && header) {
      int number = -1;
      std::memcpy(&number, CMSG_DATA(header), sizeof number);
      UniqueFd received(number);
      if (fd) *fd = std::move(received);
    }
    return size < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(size));
  }

  test::Scratch scratch_;
  UniqueFd socket_;
};

std::uint64_t socket_inode_of(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 ? status.st_ino : 0;
}

TEST_F(Systemd, HearsWhatItIsTold) {
  notify_systemd("READY=1\nSTATUS=rig 'desk' is up");
  EXPECT_EQ(receive(), "READY=1\nSTATUS=rig 'desk' is up");
}

TEST_F(Systemd, MayListenAtANameThatIsNoFile) {
  listen_at("@handcast-notify-test-" + std::to_string(getpid()));
  notify_systemd("STOPPING=1");
  EXPECT_EQ(receive(), "STOPPING=1");
}

TEST_F(Systemd, IsNotMissedWhereThereIsNone) {
  for (const auto* nowhere : {"", "/nowhere/at/all", "relative", "@"}) {
    setenv("NOTIFY_SOCKET", nowhere, 1);
    notify_systemd("READY=1");
  }
  unsetenv("NOTIFY_SOCKET");
  notify_systemd("READY=1");
  EXPECT_EQ(receive(), "");
}

TEST_F(Systemd, DoesNotStopTheRigWhenItDoesNotListen) {
  for (int i = 0; i < 15; ++i) notify_systemd("WATCHDOG=1");
  EXPECT_EQ(receive(), "WATCHDOG=1");
}

TEST_F(Systemd, GetsTheRingsByTheirNames) {
  const UniqueFd ring(memfd_create("camera.frames", MFD_CLOEXEC));
  store_with_systemd({{"camera.frames", ring.get()}});
  EXPECT_EQ(receive(), "FDSTOREREMOVE=1\nFDNAME=camera.frames");
  UniqueFd stored;
  EXPECT_EQ(receive(&stored), "FDSTORE=1\nFDNAME=camera.frames");
  EXPECT_EQ(socket_inode_of(stored.get()), socket_inode_of(ring.get()));
}

TEST_F(Systemd, GetsManyRingsAlsoWhenItReadsSlowly) {
  const UniqueFd ring(memfd_create("ring", MFD_CLOEXEC));
  const pid_t reader = fork();
  if (reader == 0) {
    int stored = 0;
    for (int i = 0; i < 1000 && stored < 20; ++i, usleep(10'000)) {
      UniqueFd fd;
      receive(&fd);
      stored += fd ? 1 : 0;
    }
    _exit(stored);
  }
  store_with_systemd(std::vector<std::pair<std::string, int>>(20, {"ring", ring.get()}));
  int status = -1;
  waitpid(reader, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 20);
}

TEST_F(Systemd, HearsTheHeartTwiceInTheTimeItAllows) {
  setenv("WATCHDOG_USEC", "1000000", 1);
  setenv("WATCHDOG_PID", std::to_string(getpid()).c_str(), 1);
  EXPECT_EQ(watchdog_period_ns(), 500'000'000);
  Watchdog watchdog;
  for (std::int64_t now_ns = 1'000'000'000; now_ns <= 2'000'000'000; now_ns += 50'000'000)
    watchdog.tick(now_ns);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(receive(), "WATCHDOG=1");
  EXPECT_EQ(receive(), "");
}

TEST_F(Systemd, WatchesOnlyWhomItMeans) {
  setenv("WATCHDOG_USEC", "1000000", 1);
  setenv("WATCHDOG_PID", "1", 1);
  Watchdog watchdog;
  watchdog.tick(1'000'000'000);
  EXPECT_EQ(receive(), "");
  setenv("WATCHDOG_USEC", "often", 1);
  unsetenv("WATCHDOG_PID");
  EXPECT_EQ(watchdog_period_ns(), std::nullopt);
}

// Runs in another process, because descriptors are passed from number 3 on.
TEST_F(Systemd, GivesTheRingsBackOnce) {
  const pid_t child = fork();
  if (child == 0) {
    const int first = memfd_create("a", 0), second = memfd_create("b", 0);
    dup2(first, 100), dup2(second, 101);
    const auto a = socket_inode_of(100), b = socket_inode_of(101);
    dup2(100, 3), dup2(101, 4);
    setenv("LISTEN_PID", std::to_string(getpid()).c_str(), 1);
    setenv("LISTEN_FDS", "2", 1);
    setenv("LISTEN_FDNAMES", "camera.frames:pose.hands", 1);
    const auto taken = taken_from_systemd();
    const bool right =
        taken.size() == 2 && taken[0].first == "camera.frames" &&
        socket_inode_of(taken[0].second.get()) == a && taken[1].first == "pose.hands" &&
        socket_inode_of(taken[1].second.get()) == b && fcntl(3, F_GETFD) == FD_CLOEXEC;
    _exit(right && taken_from_systemd().empty() && !getenv("LISTEN_FDS") ? 0 : 1);
  }
  int status = -1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_F(Systemd, WhatIsMeantForAnotherProcessIsLeftAlone) {
  setenv("LISTEN_PID", "1", 1);
  setenv("LISTEN_FDS", "1", 1);
  EXPECT_TRUE(taken_from_systemd().empty());
}

}  // namespace
}  // namespace handcast::supervisor
