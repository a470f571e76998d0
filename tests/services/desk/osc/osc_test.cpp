// SPDX-License-Identifier: Apache-2.0
// The surface with real sockets, and with liblo's oscsend and oscdump.
#include "services/desk/osc/osc.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <chrono>
#include <cstdio>
#include <random>
#include <thread>

#include "ipc/base/clock.hpp"
#include "services/desk/osc/udp.hpp"
#include "tests/services/desk/osc/packets.hpp"
#include "tests/services/desk/table_panel.hpp"

namespace handcast::desk {
namespace {

using osc::bind_socket;
using osc::connect_socket;
using osc::port_of;
using osc::Transport;
using test::packet;
using testing::HasSubstr;
using namespace std::chrono_literals;
using namespace std::string_literals;

/// Waits for a condition; false after 20 s.
template <class Condition>
bool comes_true(Condition condition) {
  for (const auto until = Deadline::in(20s); !until.passed(); std::this_thread::sleep_for(2ms))
    if (condition()) return true;
  return false;
}

/// An address of this computer that no one uses.
std::string free_address(Transport transport = Transport::udp) {
  const auto socket = bind_socket("127.0.0.1:0", transport, "test");
  return "127.0.0.1:" + std::to_string(port_of(*socket));
}
std::string port_in(const std::string& address) { return address.substr(address.find(':') + 1); }

bool has_program(const char* name) {
  return std::system(("command -v "s + name + " >/dev/null").c_str()) == 0;
}

class Osc : public testing::Test {
 protected:
  void open() {
    rig.desk.osc.listen = free_address();
    rig.desk.osc.query_port = std::stoi(port_in(free_address(Transport::tcp)));
    auto opened = open_osc(rig, {}, panel, nullptr);
    ASSERT_TRUE(opened) << opened.error().what;
    surface = std::move(*opened);
    to = std::move(*connect_socket(rig.desk.osc.listen, "test"));
  }
  void send(const std::string& bytes) const {
    (void)::send(to.get(), bytes.data(), bytes.size(), 0);
  }
  bool gets(std::string_view path, std::string_view value) const {
    return comes_true([&] { return panel.value(path) == value; });
  }
  /// The answer to bytes that are sent to the query port.
  std::string ask(const std::string& request) const {
    const UniqueFd socket(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(rig.desk.osc.query_port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
      return "not connected";
    (void)::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL);
    std::string answer;
    std::array<char, 4096> bytes;
    for (ssize_t count; (count = ::recv(socket.get(), bytes.data(), bytes.size(), 0)) > 0;)
      answer.append(bytes.data(), static_cast<std::size_t>(count));
    return answer;
  }

  config::Rig rig;
  test::TablePanel panel;
  std::unique_ptr<Surface> surface;
  UniqueFd to;
};

TEST_F(Osc, OscsendSetsSettings) {
  if (!has_program("oscsend")) GTEST_SKIP() << "oscsend is not installed (liblo-tools)";
  open();
  const auto command = "oscsend 127.0.0.1 " + port_in(rig.desk.osc.listen) + " ";
  ASSERT_EQ(std::system((command + "/projector/brightness f 0.5").c_str()), 0);
  EXPECT_TRUE(gets("projector.brightness", "0.5"));
  ASSERT_EQ(std::system((command + "/light/blackout T").c_str()), 0);
  EXPECT_TRUE(gets("light.blackout", "true"));
  ASSERT_EQ(std::system((command + "/content/gravity fff 1 0 0").c_str()), 0);
  EXPECT_TRUE(gets("content.gravity", "[1, 0, 0]"));
  ASSERT_EQ(std::system((command + "/cascade/predict/method s velocity").c_str()), 0);
  EXPECT_TRUE(gets("cascade.predict.method", "\"velocity\""));
}

TEST_F(Osc, OscdumpHearsHandsAndChanges) {
  if (!has_program("oscdump")) GTEST_SKIP() << "oscdump is not installed (liblo-tools)";
  const auto receiver = free_address();
  rig.desk.osc.send = {receiver};
  rig.desk.osc.tuio = {receiver};
  std::unique_ptr<FILE, int (*)(FILE*)> dump(
      ::popen(("exec timeout 30 oscdump -L " + port_in(receiver)).c_str(), "r"), ::pclose);
  open();
  Scene scene;
  scene.gestures[0].is_there = true;
  for (auto& joint : scene.joints_m[0]) joint = {0, 0, 0.5};
  const std::jthread turns([&](const std::stop_token& stop) {
    for (int i = 0; !stop.stop_requested(); ++i) {
      scene.now_ns = now_ns();
      (void)panel.set(std::vector{fmt::format("light.master={}", i % 2 ? "0.25" : "0.5")}, "page");
      surface->turn(scene);
      std::this_thread::sleep_for(20ms);
    }
  });
  std::vector<std::string> missing{
      "/hand/left/pinch f",   "/hand/left/joints fff",        "/hand/left/uv ff",
      "/light/master f 0.25", "/tuio/2Dcur siiiii \"alive\"", "/tuio/2Dcur sifffff \"set\""};
  std::array<char, 4096> line;
  while (!missing.empty() && std::fgets(line.data(), line.size(), dump.get()))
    std::erase_if(missing, [&](const auto& part) {
      return std::string_view(line.data()).find(part) != std::string_view::npos;
    });
  EXPECT_THAT(missing, testing::IsEmpty());
  dump.reset();  // ends with the next packet that it cannot print
}

TEST_F(Osc, HostileBytesChangeNothingAndTheNextMessageIsTaken) {
  open();
  const auto before = panel.values()->revision;
  std::mt19937 random(1);
  const auto whole = packet("/projector/brightness", 0.5f);
  for (int i = 0; i < 2000; ++i) {
    auto bytes = whole;
    for (int j = 0; j < 3; ++j) bytes[random() % 24] = static_cast<char>(random());
    send(bytes.substr(0, random() % bytes.size()));
    if (i % 100 == 0) std::this_thread::sleep_for(5ms);
  }
  for (const auto& bytes :
       {""s, "#bundle"s, "#bundle\0\0\0\0\0\0\0\0\1\xff\xff\xff\xff"s, "/a\0\0,s\0\0xxxx"s,
        "/a\0\0,b\0\0\x7f\xff\xff\xff"s, std::string(60'000, '/')})
    send(bytes);
  send(packet("/light/master", 0.25f));
  EXPECT_TRUE(gets("light.master", "0.25"));
  EXPECT_EQ(panel.values()->revision, before + 1);
}

TEST_F(Osc, AFloodIsFewChangesAndEndsWithItsLastValue) {
  open();
  constexpr int kMessages = 200'000;
  for (int i = 0; i < kMessages; ++i)
    send(packet("/projector/brightness", static_cast<float>(i % 1000) / 1000));
  EXPECT_TRUE(comes_true([&] {  // what the kernel drops of a flood is lost
    send(packet("/projector/brightness", 0.125f));
    return panel.value("projector.brightness") == "0.125";
  }));
  surface.reset();
  EXPECT_LT(panel.sets.size(), kMessages / 10);
}

TEST_F(Osc, ABundleOfTheFutureIsSetLater) {
  open();
  timespec wall{};
  ::clock_gettime(CLOCK_REALTIME, &wall);
  const auto tag = (static_cast<std::uint64_t>(wall.tv_sec) + 2'208'988'801) << 32;
  const std::vector parts{packet("/light/master", 0.25f)};
  send(test::bundle_at(tag + (1ull << 31), parts));
  send(packet("/projector/brightness", 0.5f));
  EXPECT_TRUE(gets("projector.brightness", "0.5"));
  EXPECT_EQ(panel.value("light.master"), "1");
  EXPECT_TRUE(gets("light.master", "0.25"));
}

TEST_F(Osc, OscQueryAnswersByHttp) {
  open();
  EXPECT_THAT(ask("GET /light/master HTTP/1.1\r\nHost: x\r\n\r\n"),
              testing::AllOf(HasSubstr("200 OK"), HasSubstr("\"FULL_PATH\":\"/light/master\"")));
  EXPECT_THAT(ask("GET /?HOST_INFO HTTP/1.1\r\n\r\n"),
              HasSubstr("\"OSC_PORT\":" + port_in(rig.desk.osc.listen)));
  EXPECT_THAT(ask("GET /no HTTP/1.1\r\n\r\n"), HasSubstr("404"));
  EXPECT_THAT(ask("GET /light?VALUE HTTP/1.1\r\n\r\n"), HasSubstr("204"));
  EXPECT_THAT(ask("POST / HTTP/1.1\r\n\r\n"), HasSubstr("405"));
  EXPECT_THAT(ask("GET /" + std::string(5000, 'x')), HasSubstr("431"));
}

TEST_F(Osc, ClientsThatSayNothingDoNotKeepOthersOut) {
  open();
  std::vector<UniqueFd> silent;
  for (int i = 0; i < 40; ++i) {
    silent.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(rig.desk.osc.query_port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)::connect(silent.back().get(), reinterpret_cast<sockaddr*>(&address), sizeof address);
  }
  send(packet("/light/master", 0.25f));
  EXPECT_TRUE(gets("light.master", "0.25")) << "OSC goes on";
  EXPECT_TRUE(comes_true([&] {  // after their 2 s
    return ask("GET /light HTTP/1.1\r\n\r\n").find("200 OK") != std::string::npos;
  }));
}

TEST_F(Osc, BadSettingsAreNamed) {
  const auto fault_of = [&](const config::DeskOsc& osc) {
    rig.desk.osc = osc;
    const auto opened = open_osc(rig, {}, panel, nullptr);
    return opened ? "" : opened.error().what;
  };
  EXPECT_THAT(fault_of({.listen = "9000"}), HasSubstr("desk.osc.listen: '9000' is no address"));
  EXPECT_THAT(fault_of({.listen = "192.0.2.1:9000"}), HasSubstr("cannot be used"));
  EXPECT_THAT(fault_of({.send = {"127.0.0.1:port"}}), HasSubstr("desk.osc.send"));
  EXPECT_THAT(fault_of({.query_port = 80}), HasSubstr("desk.osc.listen must be set"));
  const auto taken = bind_socket("127.0.0.1:0", Transport::udp, "test");
  EXPECT_THAT(fault_of({.listen = "127.0.0.1:" + std::to_string(port_of(*taken))}),
              HasSubstr("in use"));
  EXPECT_EQ(fault_of({}), "");
  EXPECT_EQ(*open_osc(rig, {}, panel, nullptr), nullptr) << "off";
}

}  // namespace
}  // namespace handcast::desk
