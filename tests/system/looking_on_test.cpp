// SPDX-License-Identifier: Apache-2.0
// Observation of a rig: `handcast top` and the metrics for Prometheus.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>

#include <fstream>
#include <sstream>

#include "ipc/base/unique_fd.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Gt;
using testing::HasSubstr;
using testing::Lt;

class LookingOn : public SystemTest {};

sockaddr_in loopback(int port) {
  return {.sin_family = AF_INET,
          .sin_port = htons(static_cast<std::uint16_t>(port)),
          .sin_addr = {htonl(INADDR_LOOPBACK)},
          .sin_zero = {}};
}

/// A socket that listens on a free port. Close it to free the port.
std::pair<UniqueFd, int> take_port() {
  UniqueFd listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  auto address = loopback(0);
  socklen_t size = sizeof address;
  if (bind(listener.get(), reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      listen(listener.get(), 1) != 0)
    ADD_FAILURE();
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return {std::move(listener), ntohs(address.sin_port)};
}

/// The answer of a server on this machine; "" if there is none.
std::string fetch(int port, const std::string& path) {
  const UniqueFd client(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto address = loopback(port);
  if (connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return "";
  const auto request = "GET " + path + " HTTP/1.0\r\n\r\n";
  send(client.get(), request.data(), request.size(), MSG_NOSIGNAL);
  std::string answer;
  std::array<char, 4096> bytes;
  for (ssize_t count; (count = read(client.get(), bytes.data(), bytes.size())) > 0;)
    answer.append(bytes.data(), static_cast<std::size_t>(count));
  return answer;
}

/// The local addresses of sockets that listen on the port, as the kernel prints them (hexadecimal).
std::vector<std::string> listeners_at(int port) {
  std::vector<std::string> addresses;
  for (const auto* file : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream table(file);
    std::string line, number, local, remote, state;
    for (std::getline(table, line); std::getline(table, line);) {
      std::istringstream(line) >> number >> local >> remote >> state;
      const auto colon = local.find(':');
      if (state == "0A" && std::stoi(local.substr(colon + 1), nullptr, 16) == port)
        addresses.push_back(local.substr(0, colon));
    }
  }
  return addresses;
}

nlohmann::json find(const nlohmann::json& things, const std::string& key,
                    const std::string& value) {
  for (const auto& thing : things)
    if (thing[key] == value) return thing;
  ADD_FAILURE() << "no " << value;
  return {};
}

TEST_F(LookingOn, TopShowsEveryServiceAndRing) {
  const auto rig = up();
  wait_until_light();
  const auto once = handcast({"top", "--once"});
  EXPECT_EQ(once.exit_code, 0) << once.log;
  for (const auto& name : kServices) EXPECT_THAT(once.output, HasSubstr(name));
  for (const auto* ring : {"camera.frames", "pose.hands", "landmarks.hands", "projection.frames"})
    EXPECT_THAT(once.output, HasSubstr(ring));
  EXPECT_EQ(once.output.find('\x1b'), std::string::npos) << "colours in a file";
  EXPECT_EQ(handcast({"top"}).exit_code, 0) << "without a terminal it ends by itself";
}

TEST_F(LookingOn, TopsFiguresAreThoseOfTheRig) {
  const auto rig = up();
  wait_until_light();
  const auto outcome = handcast({"top", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.log;
  const auto top = nlohmann::json::parse(outcome.output);
  const auto now = status();
  for (const auto& name : kServices) {
    const auto shown = find(top["services"], "service", name);
    EXPECT_EQ(shown["pid"], now["services"][name]["pid"]);
    EXPECT_GT(shown["resident_bytes"], 0);
    EXPECT_GE(shown["cores"], 0);
  }
  const auto poses = find(top["rings"], "stream", "pose.hands");
  EXPECT_THAT(poses["rate_hz"].get<double>(), AllOf(Gt(50), Lt(130))) << "the tracker has 110.6 Hz";
  EXPECT_EQ(poses["epoch"], 1);
  EXPECT_GT(find(poses["readers"], "who", "projector")["received"], 0);
  EXPECT_EQ(
      find(find(top["rings"], "stream", "projection.frames")["readers"], "who", "observer")["gone"],
      false);
}

TEST_F(LookingOn, PrometheusGetsTheFiguresOnThisMachineAlone) {
  const int port = take_port().second;
  const auto rig = up({"--set", "supervisor.metrics_port=" + std::to_string(port)});
  wait_until_light();
  std::string text;
  ASSERT_TRUE(eventually([&] { return !(text = fetch(port, "/metrics")).empty(); }));
  for (const auto& name : kServices)
    EXPECT_THAT(text, HasSubstr("handcast_service_up{service=\"" + name + "\"} 1"));
  EXPECT_THAT(text, HasSubstr("handcast_ring_messages_total{ring=\"projection.frames\"}"));
  EXPECT_THAT(text,
              HasSubstr("handcast_reader_received_total{ring=\"pose.hands\",reader=\"projector\""));
  EXPECT_THAT(text, HasSubstr("handcast_stage_seconds{stage="));
  EXPECT_THAT(text, HasSubstr("handcast_supervisor_up 1"));
  EXPECT_THAT(listeners_at(port), testing::ElementsAre("0100007F")) << "127.0.0.1";
  EXPECT_EQ(handcast({"down"}).exit_code, 0);
  EXPECT_EQ(fetch(port, "/metrics"), "");
}

TEST_F(LookingOn, AMetricsPortThatIsTakenIsSaidAndNotTriedAgain) {
  const auto taken = take_port();
  const auto rig = up({"--set", "supervisor.metrics_port=" + std::to_string(taken.second)});
  EXPECT_EQ(rig->wait(), 100);
  EXPECT_THAT(rig->log(), HasSubstr("set supervisor.metrics_port to another port, or to 0"));
}

TEST_F(LookingOn, NothingListensUnlessAskedFor) {
  const auto rig = up();
  wait_until_light();
  EXPECT_FALSE(status()["services"].contains("exporter"));
}

}  // namespace
}  // namespace handcast::system_test
