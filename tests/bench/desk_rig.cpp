// SPDX-License-Identifier: Apache-2.0
// How soon a change of a setting is in the light of a rig (config/rigs/twin.toml), and what the
// desk costs.
//   bench_desk_rig [--goals FILE]
#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "config/live/live_board.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/unique_fd.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/control/desk_address.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "ipc/msg/projection.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/control_rig.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/process_time.hpp"
#include "tests/bench/rings_transports.hpp"
#include "tests/services/desk/page/http_client.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kRefresh_hz = 120;
constexpr int kOscPort = 19000, kChanges = 120;

/// An area that covers all of the projector's picture.
constexpr std::string_view kEverywhere = "-10 -10, 5000 -10, 5000 5000, -10 5000";

template <class T>
T needed(Result<T> result) {
  if (!result) give_up(result.error().what);
  return std::move(*result);
}

bool is_dark(const msg::Projection& frame) {
  const std::size_t count = std::size_t{frame.region_width_px} * frame.region_height_px;
  return std::all_of(frame.pixels(), frame.pixels() + count,
                     [](auto pixel) { return (pixel & 0xffffff) == 0; });
}

/// Makes changes, each the other way round. Returns the times from each to the publication of the
/// first frame that shows it, ms.
template <class Change>
std::vector<double> times_to_light_ms(const Change& change) {
  auto frames = needed(client::open_stream<msg::Projection>("twin", "projection.frames"));
  std::vector<double> times_ms;
  for (int i = 0; i < kChanges; ++i) {
    const bool is_dark_then = i % 2 == 0;
    const auto begin_ns = now_ns();
    change(is_dark_then);
    for (const auto until = Deadline::in(2s); !until.passed();) {
      const auto frame = frames.next(Deadline::in(100ms));
      if (!frame || (*frame)->header.published_ns < begin_ns || (*frame)->hand_count == 0) continue;
      if (is_dark(**frame) != is_dark_then) continue;
      times_ms.push_back(ns_to_ms((*frame)->header.published_ns - begin_ns));
      break;
    }
    ::usleep(static_cast<useconds_t>(40'000 + 1'700 * (i % 10)));
  }
  return times_ms;
}

void change_by_board(config::LiveBoard& board, bool dark) {
  const std::vector<std::string> change{dark ? fmt::format("light.keep_out={}", kEverywhere)
                                             : "light.keep_out"};
  needed(board.set(change, "bench"));
}

/// A padded OSC string.
std::string osc_text(std::string text) {
  text.append(4 - text.size() % 4, '\0');
  return text;
}

/// Sends OSC messages to the desk.
class OscSender {
 public:
  OscSender() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(kOscPort);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0)
      give_up("no UDP socket");
  }
  void send(const std::string& message) const {
    if (::send(socket_.get(), message.data(), message.size(), 0) < 0) give_up("OSC is not sent");
  }

 private:
  UniqueFd socket_;
};

/// The page of the desk, as a browser of the owner asks it.
class Page {
 public:
  Page() : address_(needed(control::read_desk_file(needed(control::desk_file("twin"))))) {
    port_ = static_cast<std::uint16_t>(std::stoi(address_.url.substr(address_.url.rfind(':') + 1)));
  }

  void change(bool dark) {
    const auto body = fmt::format(R"({{"set":["light.keep_out{}{}"]}})", dark ? "=" : "",
                                  dark ? kEverywhere : "");
    const auto begin_ns = now_ns();
    const auto answer = test::ask(port_, "POST", "/api/set", as_owner(), body);
    if (answer.status != 200) give_up("the page refuses a change: " + answer.body);
    answers_ms_.push_back(ns_to_ms(now_ns() - begin_ns));
  }
  /// How long the page took to answer the changes, which it does when they are made, ms.
  const std::vector<double>& answers_ms() const { return answers_ms_; }

  /// Opens a stream of the page.
  std::unique_ptr<test::Wire> open(const char* path) const {
    auto wire = std::make_unique<test::Wire>(port_);
    wire->send(test::request_text(port_, "GET", path, as_owner()));
    return wire;
  }

 private:
  test::HttpHeaders as_owner() const {
    return {{"Authorization", "Bearer " + address_.tokens.back()}};
  }

  control::DeskAddress address_;
  std::uint16_t port_ = 0;
  std::vector<double> answers_ms_;
};

/// The number of an image in a stream of pictures; of the last one that has come, beyond `from`.
std::optional<std::uint64_t> newest_image(const std::string& stream, std::size_t from) {
  constexpr std::string_view kId = "\"id\":";
  const auto at = stream.rfind(kId);
  if (at == stream.npos || at < from) return std::nullopt;
  const auto end = stream.find_first_of(",}", at);
  if (end == stream.npos) return std::nullopt;
  return std::stoull(stream.substr(at + kId.size(), end - at - kId.size()));
}

/// When the images of the camera were taken, as they come.
class Origins {
 public:
  std::optional<std::int64_t> of(std::uint64_t image) {
    const std::lock_guard lock(mutex_);
    const auto found = origins_.find(image);
    return found == origins_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  void read(const std::stop_token& stop) {
    auto frames = needed(client::open_stream<msg::CameraFrame>("twin", "camera.frames"));
    while (!stop.stop_requested()) {
      const auto frame = frames.next(Deadline::in(50ms));
      if (!frame) continue;
      const std::lock_guard lock(mutex_);
      origins_[(*frame)->header.frame_id] = (*frame)->header.origin_ns;
    }
  }

  std::mutex mutex_;
  std::map<std::uint64_t, std::int64_t> origins_;
  std::jthread thread_{[this](const std::stop_token& stop) { read(stop); }};
};

/// How old the pictures on a page are when they come, ms; the page is open for some time.
std::vector<double> picture_ages_ms(test::Wire& pictures, std::chrono::seconds span) {
  Origins origins;
  std::vector<double> ages_ms;
  std::size_t seen = 0;
  for (const auto until = Deadline::in(span); !until.passed();) {
    const auto& stream = pictures.receive("\"width\":", seen, 1s);
    const auto image = newest_image(stream, seen);
    const auto came_ns = now_ns();
    seen = stream.size();
    if (!image) continue;
    if (const auto origin = origins.of(*image)) ages_ms.push_back(ns_to_ms(came_ns - *origin));
  }
  return ages_ms;
}

void note(std::vector<Goal>& goals, const char* way, const std::vector<double>& times_ms,
          double most_ms) {
  fmt::print("setting to first changed frame, {}: p50 {:.1f} ms, p99 {:.1f} ms of {} changes\n",
             way, median(times_ms), percentile(times_ms, 0.99), times_ms.size());
  goals.push_back(
      {fmt::format("setting to frame, {}, p99", way), percentile(times_ms, 0.99), most_ms, "ms"});
}

/// What a page that is open costs, and how old its picture is.
void watch_a_page(const Page& page, pid_t pid, std::vector<Goal>& goals) {
  const auto events = page.open("/api/events"), pictures = page.open("/api/picture");
  events->receive("event: values");
  pictures->receive("\"id\":");
  const double before_s = busy_seconds(pid);
  const auto begin_ns = now_ns();
  const auto ages_ms = picture_ages_ms(*pictures, 10s);
  const double share = (busy_seconds(pid) - before_s) / ns_to_seconds(now_ns() - begin_ns);
  fmt::print(
      "a page: {:.1f} % of one core; its picture {:.1f} Hz, p50 {:.1f} ms, p99 {:.1f} ms old\n",
      100 * share, static_cast<double>(ages_ms.size()) / 10, median(ages_ms),
      percentile(ages_ms, 0.99));
  goals.push_back({"desk with a page, of one core", 100 * share, 5, "%"});
  goals.push_back({"picture on the page, age, p99", percentile(ages_ms, 0.99), 100, "ms"});
}

int run(const Arguments& arguments) {
  const RigFolder folder;
  std::vector<Goal> goals;
  const TwinRig rig(
      folder, {"camera.rate_hz=120", "projector.rate_hz=120", "observer.enabled=false",
               "twin.motion=builtin:still", fmt::format("desk.osc.listen=127.0.0.1:{}", kOscPort)});
  auto board = needed(config::LiveBoard::open("twin"));
  constexpr double kTwoRefreshes_ms = 2e3 / kRefresh_hz;
  note(goals, "by the ring", times_to_light_ms([&](bool dark) { change_by_board(board, dark); }),
       kTwoRefreshes_ms);
  const OscSender osc;
  const auto by_osc = times_to_light_ms([&](bool dark) {
    osc.send(dark
                 ? osc_text("/light/keep_out") + osc_text(",s") + osc_text(std::string(kEverywhere))
                 : osc_text("/light/keep_out") + osc_text(",N"));
  });
  note(goals, "by OSC", by_osc, kTwoRefreshes_ms + 5);

  Page page;
  note(goals, "by the page", times_to_light_ms([&](bool dark) { page.change(dark); }), 20);
  fmt::print("a change by the page is made: p50 {:.1f} ms, p99 {:.1f} ms after the click\n",
             median(page.answers_ms()), percentile(page.answers_ms(), 0.99));

  const auto pid = rig.pid_of("desk");
  const double before_s = busy_seconds(pid);
  const auto begin_ns = now_ns();
  ::usleep(5'000'000);
  const double share = (busy_seconds(pid) - before_s) / ns_to_seconds(now_ns() - begin_ns);
  fmt::print("the desk without a page: {:.1f} % of one core\n", 100 * share);
  goals.push_back({"desk without a page, of one core", 100 * share, 1, "%"});
  watch_a_page(page, pid, goals);
  return arguments.report(goals);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Arguments arguments("bench_desk_rig", "Measures a rig and its desk.");
  if (const auto code = arguments.answered(argc, argv)) return *code;
  return handcast::bench::run(arguments);
}
