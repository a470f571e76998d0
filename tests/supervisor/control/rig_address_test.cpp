// SPDX-License-Identifier: Apache-2.0
// The names of rigs, and access of other users to their sockets.
#include "ipc/control/rig_address.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include "ipc/control/choose_rig.hpp"
#include "tests/supervisor/control/control_fixture.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr uid_t kSomebodyElse = 65534;

void refuse_all(const Request&, const ControlServer::Reply& reply) { reply(failure("no")); }

class RigAddressTest : public Control {
 protected:
  /// The exit code of `body`, run as another user.
  static int as_somebody_else(const std::function<int()>& body) {
    const pid_t child = fork();
    if (child == 0) _exit(setuid(kSomebodyElse) == 0 ? body() : 99);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
};

TEST_F(RigAddressTest, OnlySomeCharactersMakeAName) {
  for (const auto* name : {"", "../desk", "a/b", ".", "a b", "a\nb"})
    EXPECT_FALSE(address_of(name)) << name;
  EXPECT_FALSE(address_of(std::string(200, 'x')));
  EXPECT_TRUE(address_of("Desk_2-left"));
}

TEST_F(RigAddressTest, AnAddressNamesItsRigToTheSameUserAndScope) {
  const auto text = address_of("desk").value().text;
  EXPECT_EQ(name_in(text), "desk");
  EXPECT_EQ(name_in(text + "/x"), "");
  EXPECT_EQ(name_in("handcast-1" + text), "");
  setenv(kScopeVariable, "another", 1);
  EXPECT_EQ(name_in(text), "");
  EXPECT_NE(address_of("desk").value().text, text);
}

TEST_F(RigAddressTest, ARigOfAnotherUserIsNamedWithTheWayToReachIt) {
  if (getuid() != 0) GTEST_SKIP() << "only the superuser can become another user";
  EXPECT_THAT(rigs_of_others(), IsEmpty());
  const auto rig = ControlServer::listen("desk", loop_, refuse_all);
  ASSERT_TRUE(rig);
  EXPECT_THAT(rigs_of_others(), IsEmpty()) << "its own";
  const auto pid = fmt::format("(pid {})", getpid());
  EXPECT_EQ(
      as_somebody_else([&] {
        const auto others = rigs_of_others();
        if (others.size() != 1) return 1;
        for (const std::string& part : {std::string("'desk' of user root"), pid,
                                        std::string("`sudo -u root handcast down --rig desk`")})
          if (others[0].find(part) == std::string::npos) return 2;
        const auto chosen = choose_rig("");
        return chosen || chosen.error().what.find(others[0]) == std::string::npos ? 3 : 0;
      }),
      0);
}

TEST_F(RigAddressTest, TheNameBelongsToTheProcessThatListens) {
  EXPECT_THAT(living_rigs(), IsEmpty());
  auto first = ControlServer::listen("desk", loop_, refuse_all);
  ASSERT_TRUE(first);
  EXPECT_THAT(living_rigs(), ElementsAre("desk"));
  const auto second = ControlServer::listen("desk", loop_, refuse_all);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().what, HasSubstr("'desk' is up already"));
  EXPECT_EQ(listener_of(address_of("desk").value()), getpid());
  first->reset();
  EXPECT_THAT(living_rigs(), IsEmpty());
  EXPECT_EQ(listener_of(address_of("desk").value()), -1);
  EXPECT_TRUE(ControlServer::listen("desk", loop_, refuse_all));
}

TEST_F(RigAddressTest, ANameIsFreeAfterItsProcessWasKilled) {
  std::array<int, 2> ready{};
  ASSERT_EQ(pipe(ready.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    auto loop = EventLoop::open().value();
    const auto server = ControlServer::listen("desk", loop, refuse_all);
    [[maybe_unused]] const auto told = write(ready[1], server ? "y" : "n", 1);
    for (;;) pause();
  }
  close(ready[1]);
  char word = 0;
  ASSERT_EQ(read(ready[0], &word, 1), 1);
  ASSERT_EQ(word, 'y');
  EXPECT_FALSE(ControlServer::listen("desk", loop_, refuse_all));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_TRUE(ControlServer::listen("desk", loop_, refuse_all));
}

TEST_F(RigAddressTest, AnotherUsersRequestIsNotEvenRead) {
  if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
  int requests = 0;
  serve([&](const Request&, const ControlServer::Reply& reply) {
    ++requests;
    reply(success());
  });
  const auto address = address_of("desk").value();
  const auto ask_and_read = [&address] {
    const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    const auto* where = reinterpret_cast<const sockaddr*>(&address.socket);
    if (connect(socket.get(), where, address.size) != 0) return 1;
    const std::string_view line = "{\"verb\":\"status\"}\n";
    send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
    char byte = 0;
    return recv(socket.get(), &byte, 1, 0) > 0 ? 2 : 0;
  };
  EXPECT_EQ(while_it_turns([&] { return as_somebody_else(ask_and_read); }), 0);
  EXPECT_EQ(requests, 0);
}

TEST_F(RigAddressTest, WhatListensInARigsNameForAnotherUserIsNotTrusted) {
  if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
  const auto address = address_of("desk").value();
  const UniqueFd listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto* where = reinterpret_cast<const sockaddr*>(&address.socket);
  ASSERT_EQ(bind(listener.get(), where, address.size), 0);
  ASSERT_EQ(seteuid(kSomebodyElse), 0);
  const auto listening = listen(listener.get(), 4);
  ASSERT_EQ(seteuid(0), 0);
  ASSERT_EQ(listening, 0);

  const auto answer = ask("desk", {});
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().what, HasSubstr("another user"));
  const auto server = ControlServer::listen("desk", loop_, refuse_all);
  ASSERT_FALSE(server);
  EXPECT_THAT(server.error().what, HasSubstr("another user"));
  EXPECT_THAT(living_rigs(), IsEmpty());
}

}  // namespace
}  // namespace handcast::supervisor
