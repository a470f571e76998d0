// SPDX-License-Identifier: Apache-2.0
// Access of other users to the runtime folder and its sockets.
#include "ipc/control/runtime_folder.hpp"

#include <gmock/gmock.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "tests/supervisor/control/control_fixture.hpp"

namespace handcast::supervisor {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr uid_t kSomebodyElse = 65534;

class RuntimeFolder : public Control {
 protected:
  static mode_t mode_of(const std::filesystem::path& path) {
    struct stat status {};
    EXPECT_EQ(lstat(path.c_str(), &status), 0) << path;
    return status.st_mode & 07777;
  }
  static void expect_refused() {
    const auto folder = runtime_folder();
    ASSERT_FALSE(folder);
    EXPECT_EQ(folder.error().code, Errc::bad_config);
    EXPECT_THAT(folder.error().what, HasSubstr("0700"));
    EXPECT_FALSE(socket_of("desk"));
    EXPECT_FALSE(living_rigs());
  }
  /// The exit code of `body`, run as another user with every folder on the way to the socket open
  /// to everybody.
  int as_somebody_else(const std::function<int()>& body) const {
    chmod(scratch_.path().c_str(), 0755);
    chmod(place().c_str(), 0755);
    const pid_t child = fork();
    if (child == 0) _exit(setuid(kSomebodyElse) == 0 ? body() : 99);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::filesystem::path place() const {
    return scratch_.path() / ("handcast-" + std::to_string(getuid()));
  }
};

TEST_F(RuntimeFolder, IsForItsUserAlone) {
  const auto folder = runtime_folder();
  ASSERT_TRUE(folder);
  EXPECT_EQ(*folder, place());
  EXPECT_EQ(mode_of(*folder), 0700);
}

TEST_F(RuntimeFolder, ThatOthersMayEnterIsNotUsed) {
  const auto folder = runtime_folder().value();
  for (const mode_t mode : {0755, 0710, 0701, 0770}) {
    chmod(folder.c_str(), mode);
    expect_refused();
  }
}

TEST_F(RuntimeFolder, ThatIsALinkIsNotFollowed) {
  const auto elsewhere = scratch_.path() / "elsewhere";
  ASSERT_EQ(mkdir(elsewhere.c_str(), 0700), 0);
  std::filesystem::create_directory_symlink(elsewhere, place());
  expect_refused();
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));
}

TEST_F(RuntimeFolder, ThatIsAFileIsNotUsed) {
  close(creat(place().c_str(), 0700));
  expect_refused();
}

TEST_F(RuntimeFolder, OfSomebodyElseIsNotUsed) {
  if (getuid() != 0) GTEST_SKIP() << "only root can give a folder away";
  ASSERT_EQ(chown(runtime_folder().value().c_str(), kSomebodyElse, kSomebodyElse), 0);
  expect_refused();
}

TEST_F(RuntimeFolder, ARigsNameCannotLeaveIt) {
  for (const auto* name : {"", "../desk", "a/b", ".", "a b"}) EXPECT_FALSE(socket_of(name)) << name;
  EXPECT_FALSE(socket_of(std::string(200, 'x')));
}

TEST_F(RuntimeFolder, ASocketIsForItsUserAloneWhateverTheUmask) {
  const auto before = umask(0);
  serve([](const Request&, const ControlServer::Reply& reply) { reply(success()); });
  umask(before);
  EXPECT_EQ(mode_of(socket_of("desk").value()), 0600);
}

TEST_F(RuntimeFolder, AnotherUsersRequestIsNotEvenRead) {
  if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
  int requests = 0;
  serve([&](const Request&, const ControlServer::Reply& reply) {
    ++requests;
    reply(success());
  });
  const auto path = socket_of("desk").value();
  chmod(path.c_str(), 0666);
  const auto ask_and_read = [&path] {
    const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    const auto address = address_of(path);
    if (connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      return 1;
    const std::string_view line = "{\"verb\":\"status\"}\n";
    send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL);
    char byte = 0;
    return recv(socket.get(), &byte, 1, 0) > 0 ? 2 : 0;
  };
  EXPECT_EQ(while_it_turns([&] { return as_somebody_else(ask_and_read); }), 0);
  EXPECT_EQ(requests, 0);
  EXPECT_EQ(as_somebody_else([&path] { return access(path.c_str(), W_OK) == 0 ? 0 : 1; }),
            0);  // the path is accessible
}

TEST_F(RuntimeFolder, WhatListensInARigsNameForAnotherUserIsNotTrusted) {
  if (getuid() != 0) GTEST_SKIP() << "only root can become another user";
  const auto path = socket_of("desk").value();
  const UniqueFd listener(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto address = address_of(path);
  ASSERT_EQ(bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(seteuid(kSomebodyElse), 0);  // the user who listens counts, not the owner of the file
  const auto listening = listen(listener.get(), 4);
  ASSERT_EQ(seteuid(0), 0);
  ASSERT_EQ(listening, 0);

  const auto answer = ask("desk", {});
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().what, AllOf(HasSubstr("another user"), HasSubstr("desk.sock")));
  const auto server =
      ControlServer::listen("desk", loop_, [](const Request&, const ControlServer::Reply&) {});
  ASSERT_FALSE(server);
  EXPECT_THAT(server.error().what, HasSubstr("another user"));
}

}  // namespace
}  // namespace handcast::supervisor
