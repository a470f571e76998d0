// SPDX-License-Identifier: Apache-2.0
#include "renderer/window/idle_inhibitor.hpp"

#include <gmock/gmock.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <thread>

#include "tests/scratch.hpp"

namespace handcast::renderer {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A session bus with a desktop, for one connection. It answers in the wire format of D-Bus.
class SessionBus {
 public:
  /// `type`: that of the answer to Inhibit; 2: a return, 3: an error.
  explicit SessionBus(char type) : inhibit_type_(type) {
    const auto file = (scratch_.path() / "bus").string();
    sockaddr_un where{};
    where.sun_family = AF_UNIX;
    std::memcpy(where.sun_path, file.data(), file.size());
    listener_ = UniqueFd(socket(AF_UNIX, SOCK_STREAM, 0));
    bind(listener_.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where);
    listen(listener_.get(), 1);
    setenv("DBUS_SESSION_BUS_ADDRESS", ("unix:path=" + file + ",guid=0").c_str(), 1);
    thread_ = std::thread([this] { serve(); });
  }
  ~SessionBus() {
    shutdown(listener_.get(), SHUT_RDWR);
    thread_.join();
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
  }
  /// What it was told, after the connection was closed.
  std::string heard() {
    shutdown(listener_.get(), SHUT_RDWR);
    if (thread_.joinable()) thread_.join();
    thread_ = std::thread([] {});
    return heard_;
  }

 private:
  void serve() {
    const UniqueFd client(accept(listener_.get(), nullptr, nullptr));
    int answered = 0;
    std::array<char, 4096> bytes;
    for (ssize_t got = 0; (got = read(client.get(), bytes.data(), bytes.size())) > 0;) {
      heard_.append(bytes.data(), static_cast<std::size_t>(got));
      if (answered == 0 && heard_.ends_with("\r\n")) answer(client.get(), "OK 0123\r\n", answered);
      if (answered == 1 && heard_.find("Hello") != std::string::npos)
        answer(client.get(), reply(2, 1), answered);
      if (answered == 2 && heard_.find("light") != std::string::npos)
        answer(client.get(), reply(inhibit_type_, 2), answered);
    }
  }
  static void answer(int client, const std::string& text, int& count) {
    (void)!write(client, text.data(), text.size());
    ++count;
  }
  /// A message without a body that answers the call `serial`.
  static std::string reply(char type, char serial) {
    return {'l', type, 0, 1, 0, 0, 0, 0, 9, 0, 0, 0, 8, 0, 0, 0, 5, 1, 'u', 0, serial, 0, 0, 0};
  }

  test::Scratch scratch_;
  char inhibit_type_;
  UniqueFd listener_;
  std::string heard_;
  std::thread thread_;
};

TEST(IdleInhibitor, AsksTheDesktopAsLongAsItLives) {
  SessionBus bus(2);
  {
    const auto inhibitor = IdleInhibitor::open("light");
    ASSERT_TRUE(inhibitor) << inhibitor.error().what;
  }
  const auto heard = bus.heard();
  EXPECT_THAT(heard, StartsWith(std::string(1, '\0') + "AUTH EXTERNAL "));
  EXPECT_THAT(heard, HasSubstr("Inhibit"));
  EXPECT_THAT(heard, HasSubstr("org.freedesktop.ScreenSaver"));
  EXPECT_THAT(heard, HasSubstr("handcast"));
}

TEST(IdleInhibitor, ADesktopThatRefusesAndNoneAreErrors) {
  {
    SessionBus bus(3);
    const auto refused = IdleInhibitor::open("light");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::unavailable);
  }
  for (const auto* nowhere : {"unix:path=/nowhere/bus", "tcp:host=x", ""}) {
    setenv("DBUS_SESSION_BUS_ADDRESS", nowhere, 1);
    EXPECT_FALSE(IdleInhibitor::open("light"));
  }
  unsetenv("DBUS_SESSION_BUS_ADDRESS");
}

}  // namespace
}  // namespace handcast::renderer
