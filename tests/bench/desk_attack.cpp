// SPDX-License-Identifier: Apache-2.0
// Whether the light notices what is done to the desk: the refreshes that a rig
// (config/rigs/twin.toml) misses while its desk is idle, attacked, or watched, in turns.
//   bench_desk_attack [--goals FILE] [--seconds N] [--rounds N]
// An attack is compared with the same one at a port where nobody listens.
#include <fmt/format.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "ipc/base/clock.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/control_rig.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/process_time.hpp"
#include "tests/bench/rings_transports.hpp"
#include "tests/services/desk/page/http_client.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;
using test::Wire;

constexpr std::uint16_t kOscPort = 19002, kClosedPort = 19003;
constexpr int kMessages_hz = 100'000, kBatch = 100;
constexpr int kLorises = 200, kConnections_hz = 2'000;

/// From here on, this thread takes what no other thread needs: the attacker is another computer.
void step_back() {
  const sched_param none{};
  ::sched_setscheduler(0, SCHED_IDLE, &none);
}

/// A thread that works until the object ends.
class Attacker {
 public:
  explicit Attacker(std::function<void(const std::atomic<bool>& is_over)> work)
      : thread_([this, work = std::move(work)] { work(is_over_); }) {}
  ~Attacker() {
    is_over_ = true;
    thread_.join();
  }
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;

 private:
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};
using Attackers = std::vector<std::unique_ptr<Attacker>>;

/// "/light/master ,f 1", the first one; each later one a little less.
std::string osc_message(unsigned number) {
  std::string bytes("/light/master\0\0\0,f\0\0", 20);
  const std::uint32_t value = 0x3f800000 - number % 4096;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  return bytes;
}

/// Sends messages to a port in batches.
void flood(std::uint16_t port, std::atomic<std::uint64_t>& sent, const std::atomic<bool>& is_over) {
  step_back();
  const UniqueFd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string message;
  iovec part{};
  std::array<mmsghdr, kBatch> batch{};
  for (auto& each : batch) each.msg_hdr = {&to, sizeof to, &part, 1, nullptr, 0, 0};
  unsigned number = 0;
  for (auto due_ns = now_ns(); !is_over; due_ns += 1'000'000'000ll * kBatch / kMessages_hz) {
    sleep_until_ns(due_ns);
    message = osc_message(++number);
    part = {message.data(), message.size()};
    const int count = ::sendmmsg(socket.get(), batch.data(), kBatch, MSG_DONTWAIT);
    if (count > 0) sent += static_cast<std::uint64_t>(count);
  }
}

/// Connections that never say all, kept open for as long as they are let.
void crawl(std::uint16_t port, const std::atomic<bool>& is_over) {
  step_back();
  std::vector<std::unique_ptr<Wire>> open(kLorises);
  while (!is_over)
    for (auto& each : open) {
      if (is_over) return;
      if (!each || !each->send("X")) {
        each = std::make_unique<Wire>(port);
        each->send("GET / HTTP/1.1\r\nX-Slow: ");
      }
      sleep_until_ns(now_ns() + 5'000'000);
    }
}

/// One connection after the other with a request that makes no sense.
void storm(std::uint16_t port, std::atomic<std::uint64_t>& sent, const std::atomic<bool>& is_over) {
  step_back();
  for (auto due_ns = now_ns(); !is_over; due_ns += 1'000'000'000ll / kConnections_hz) {
    sleep_until_ns(due_ns);
    Wire wire(port);
    wire.send("POST /api/set HTTP/1.1\r\nHost: evil\r\nContent-Length: 99999999999\r\n\r\n{}");
    ++sent;
  }
}

/// Takes a stream of the page until it is over. One that is turned away asks again, as a page does.
void look(std::uint16_t port, const std::string& token, const char* path,
          const std::atomic<bool>& is_over) {
  while (!is_over) {
    Wire wire(port);
    wire.send(test::request_text(port, "GET", path, {{"Authorization", "Bearer " + token}}));
    while (!is_over && !wire.is_closed()) wire.receive("", 0, 1s);
    sleep_until_ns(now_ns() + 50'000'000);
  }
}

/// Where the page is.
struct Page {
  std::uint16_t port = 0;
  std::string token;
};

Page page_of(const RigFolder& folder) {
  const auto command = (folder.programs() / "handcast").string() + " desk --for viewer";
  const std::unique_ptr<FILE, decltype(&::pclose)> pipe(::popen(command.c_str(), "r"), &::pclose);
  std::array<char, 512> line{};
  Page page;
  while (pipe && std::fgets(line.data(), line.size(), pipe.get())) {
    const std::string text(line.data());
    const auto at = text.find("127.0.0.1:"), mark = text.find('#');
    if (at == text.npos || mark == text.npos) continue;
    page.port = static_cast<std::uint16_t>(std::atoi(text.c_str() + at + 10));
    page.token = text.substr(mark + 1, text.find_first_of(" \r\n", mark) - mark - 1);
    if (const auto name = page.token.find('='); name != page.token.npos)
      page.token.erase(0, name + 1);
  }
  if (page.port == 0) give_up("`handcast desk` printed no address");
  return page;
}

struct Case {
  std::string name;
  std::function<Attackers()> begin;
  std::vector<double> missed_per_min, busy, sent_hz;
};

int run(double seconds, int rounds, const Arguments& arguments) {
  const RigFolder folder;
  const TwinRig rig(
      folder, {"camera.rate_hz=60", "projector.rate_hz=60", "observer.enabled=false",
               "landmarks.backend=twin", fmt::format("desk.osc.listen=127.0.0.1:{}", kOscPort)});
  const auto page = page_of(folder);
  std::atomic<std::uint64_t> sent = 0;
  const auto attack = [](auto... works) {
    Attackers all;
    (all.push_back(std::make_unique<Attacker>(works)), ...);
    return all;
  };
  const auto osc_to = [&](std::uint16_t port) {
    return attack([&, port](const auto& is_over) { flood(port, sent, is_over); });
  };
  const auto page_at = [&](std::uint16_t port) {
    return attack([port](const auto& is_over) { crawl(port, is_over); },
                  [&, port](const auto& is_over) { storm(port, sent, is_over); });
  };
  std::vector<Case> cases{
      {"idle", [] { return Attackers(); }, {}, {}, {}},
      {"OSC at nobody", [&] { return osc_to(kClosedPort); }, {}, {}, {}},
      {"OSC at the desk", [&] { return osc_to(kOscPort); }, {}, {}, {}},
      {"hostile clients at nobody", [&] { return page_at(kClosedPort); }, {}, {}, {}},
      {"hostile clients at the page", [&] { return page_at(page.port); }, {}, {}, {}},
      {"a page that looks",
       [&] {
         return attack(
             [&](const auto& is_over) { look(page.port, page.token, "/api/picture", is_over); },
             [&](const auto& is_over) { look(page.port, page.token, "/api/events", is_over); });
       },
       {},
       {},
       {}}};
  const auto missed = [&] {
    return rig.ask({.verb = control::Verb::status})["status"]["light"]["projector"].value(
        "missed_refreshes", 0.0);
  };
  const auto pid = rig.pid_of("desk");
  for (int round = 0; round < rounds; ++round)
    for (auto& each : cases) {
      const auto attackers = each.begin();
      ::usleep(500'000);
      const double missed_before = missed(), busy_before = busy_seconds(pid);
      const auto sent_before = sent.load();
      const auto begin_ns = now_ns();
      ::usleep(static_cast<useconds_t>(seconds * 1e6));
      const double passed_s = ns_to_seconds(now_ns() - begin_ns);
      each.missed_per_min.push_back((missed() - missed_before) / passed_s * 60);
      each.busy.push_back((busy_seconds(pid) - busy_before) / passed_s);
      each.sent_hz.push_back(static_cast<double>(sent - sent_before) / passed_s);
    }
  fmt::print("{:<28} {:>24} {:>12} {:>10}\n", "", "missed refreshes a minute", "of one core",
             "sent a s");
  fmt::print("{:<28} {:>12} {:>12}\n", "", "median", "worst");
  for (const auto& each : cases)
    fmt::print("{:<28} {:>12.1f} {:>12.1f} {:>11.1f}% {:>10.0f}\n", each.name,
               median(each.missed_per_min), percentile(each.missed_per_min, 1),
               100 * median(each.busy), median(each.sent_hz));
  const auto more = [&](std::size_t attacked, std::size_t control) {
    return std::max(0.0,
                    median(cases[attacked].missed_per_min) - median(cases[control].missed_per_min));
  };
  constexpr double kNoise = 6;  // of 3600 a minute, on a machine that has other work
  const std::vector<Goal> goals{
      {"refreshes missed because of OSC", more(2, 1), kNoise, "a minute"},
      {"refreshes missed because of hostile clients", more(4, 3), kNoise, "a minute"},
      {"refreshes missed because of a page", more(5, 0), kNoise, "a minute"}};
  return arguments.report(goals);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Arguments arguments("bench_desk_attack",
                                       "Measures the light of a rig whose desk is attacked.");
  double seconds = 10;
  int rounds = 6;
  arguments.add("--seconds N", seconds, "How long each case lasts", {1, 3600});
  arguments.add("--rounds N", rounds, "How often each case is measured", {1, 1000});
  if (const auto code = arguments.answered(argc, argv)) return *code;
  return handcast::bench::run(seconds, rounds, arguments);
}
