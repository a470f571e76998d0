// SPDX-License-Identifier: Apache-2.0
#include "services/desk/osc/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "ipc/control/control_client.hpp"
#include "services/desk/base/low_priority.hpp"
#include "services/desk/osc/addresses.hpp"
#include "services/desk/osc/packet.hpp"

namespace handcast::desk::osc {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr std::chrono::milliseconds kEvery = 1s, kPatience = 200ms;

/// A member of an object; null if there is none.
const json& member(const json& object, const char* name) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(name);
  return found == object.end() ? kNone : *found;
}

/// The sum of the counts in an object.
std::int32_t sum_of(const json& counts) {
  double sum = 0;
  if (counts.is_object())
    for (const auto& [name, count] : counts.items())
      if (count.is_number()) sum += count.get<double>();
  return static_cast<std::int32_t>(std::min(sum, 2e9));
}

class FigureWriter {
 public:
  void number(const std::string& path, const json& value) {
    if (value.is_number())
      messages_.push_back(MessageWriter(address_of(path)).add(value.get<float>()).packet());
  }
  void count(const std::string& path, std::int32_t value) {
    messages_.push_back(MessageWriter(address_of(path)).add(value).packet());
  }
  void text(const std::string& path, const json& value) {
    if (value.is_string())
      messages_.push_back(MessageWriter(address_of(path)).add(value.get<std::string>()).packet());
  }
  void stage(const std::string& path, const json& p50_us, const json& p99_us) {
    if (!p50_us.is_number() || !p99_us.is_number()) return;
    messages_.push_back(MessageWriter(address_of(path))
                            .add(p50_us.get<float>() / 1000)
                            .add(p99_us.get<float>() / 1000)
                            .packet());
  }
  std::string bundle() const { return write_bundle(messages_); }

 private:
  std::vector<std::string> messages_;
};

}  // namespace

std::string write_figures(const json& status) {
  FigureWriter writer;
  const auto each = [&](const char* name, const auto& write) {
    const auto& all = member(status, name);
    if (all.is_object())
      for (const auto& [key, value] : all.items()) write(key, value);
  };
  each("rings", [&](const std::string& ring, const json& figures) {
    writer.number("rate." + ring, member(figures, "held_hz"));
  });
  each("services", [&](const std::string& service, const json& figures) {
    writer.text("service." + service, member(figures, "state"));
  });
  each("stage_us", [&](const std::string& stage, const json& figures) {
    writer.stage("time." + stage, member(figures, "p50"), member(figures, "p99"));
  });
  auto missed = json::object();  // by projector
  each("light", [&](const std::string& projector, const json& light) {
    missed[projector] = member(light, "missed_refreshes");
  });
  writer.count("error.missed_refreshes", sum_of(missed));
  writer.count("error.lost_images", sum_of(member(status, "lost_images")));
  writer.count("error.tracker_faults", sum_of(member(status, "tracker_faults")));
  writer.number("error.drift_mm", member(member(status, "tracker_drift"), "across_mm"));
  return writer.bundle();
}

FigureFeed::FigureFeed(std::string rig)
    : rig_(std::move(rig)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::string FigureFeed::take() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock ? std::exchange(bundle_, {}) : "";
}

void FigureFeed::run(const std::stop_token& stop) {
  run_at_low_priority();
  std::mutex sleep;
  std::condition_variable_any stopped;
  std::unique_lock lock(sleep);
  while (!stop.stop_requested()) {
    const auto answer =
        control::ask_with_descriptors(rig_, {.verb = control::Verb::status}, kPatience);
    if (answer) {
      auto bundle = write_figures(answer->object.value("status", json::object()));
      const std::lock_guard guard(mutex_);
      bundle_ = std::move(bundle);
    }
    stopped.wait_for(lock, stop, kEvery, [] { return false; });
  }
}

}  // namespace handcast::desk::osc
