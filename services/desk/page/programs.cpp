// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/programs.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "services/desk/page/json_text.hpp"

namespace handcast::desk {
namespace {

using nlohmann::json;

constexpr std::int64_t kListEvery_ns = 5'000'000'000;
constexpr std::size_t kLongestName = 48;
constexpr std::chrono::seconds kLongestDoctor{120};

/// A name that is one folder of its own, and looks like one in a shell.
bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         name.front() != '-' && std::ranges::all_of(name, [](unsigned char c) {
           return std::isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

/// Why a program failed: the last line of its log.
std::string last_line(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  return text.substr(text.rfind('\n') + 1);
}

std::string fault_of(const Errand::State& state) {
  if (state.is_running || state.exit_code == 0 || state.log.empty()) return "";
  return last_line(state.log);
}

}  // namespace

Programs::Programs(std::string rig, std::filesystem::path rig_file,
                   std::filesystem::path recordings)
    : rig_(std::move(rig)),
      rig_file_(std::move(rig_file)),
      folder_(std::move(recordings)),
      recorder_(std::chrono::seconds(kLongestRecording_s + 60)),
      doctor_(kLongestDoctor) {}

Result<void> Programs::start_recording(std::string name) {
  const std::lock_guard lock(mutex_);
  if (folder_.empty())
    return fail(Errc::bad_config, "There is no folder for recordings: see desk.page.recordings.");
  if (name.empty()) name = fmt::format("{:%Y-%m-%d_%H-%M-%S}", fmt::localtime(std::time(nullptr)));
  if (!is_name(name))
    return fail(Errc::bad_config,
                fmt::format("{} is no name of a recording; it has letters, digits, '-', '_' and "
                            "'.', {} at most",
                            quote(name), kLongestName));
  std::error_code failed;
  if (std::filesystem::exists(folder_ / name, failed))
    return fail(Errc::bad_config, fmt::format("There is a recording {} already.", quote(name)));
  std::filesystem::create_directories(folder_, failed);
  if (failed)
    return fail(Errc::unavailable, fmt::format("the folder {} cannot be made: {}", folder_.string(),
                                               failed.message()));
  auto started = recorder_.start({program_folder() / "handcast-record", (folder_ / name).string(),
                                  "--rig", rig_, "--seconds", std::to_string(kLongestRecording_s)});
  if (!started) return fail(Errc::unavailable, "A recording is being made already.");
  name_ = std::move(name);
  return {};
}

Result<void> Programs::stop_recording() {
  if (recorder_.stop()) return {};
  return fail(Errc::bad_config, "No recording is being made.");
}

Result<void> Programs::start_doctor() {
  if (rig_file_.empty())
    return fail(Errc::bad_config, "The desk does not know the rig file; see `handcast doctor`.");
  if (doctor_.start(
          {program_folder() / "handcast-doctor", rig_file_.string(), "--json", "--seconds", "3"}))
    return {};
  return fail(Errc::unavailable, "The doctor is at work already.");
}

std::string Programs::recording_name() const {
  const std::lock_guard lock(mutex_);
  return name_;
}

std::string Programs::recordings() {
  const auto state = recorder_.state();
  // The one that has ended is on the list at once.
  if (now_ns() > listed_ns_ + kListEvery_ns || was_recording_ != state.is_running) {
    all_ = recordings_in(folder_);
    listed_ns_ = now_ns();
    was_recording_ = state.is_running;
  }
  auto all = json::array();
  for (const auto& each : all_)
    all.push_back({{"name", each.name},
                   {"seconds", std::round(each.seconds * 10) / 10},
                   {"bytes", each.bytes}});
  const json running{{"name", recording_name()}, {"seconds", std::floor(state.seconds)}};
  return json_text({{"folder", folder_.string()},
                    {"running", state.is_running ? running : json()},
                    {"fault", fault_of(state)},
                    {"all", std::move(all)}});
}

std::string Programs::doctor() const {
  const auto state = doctor_.state();
  // It ends with 1 if it has found a fault.
  auto findings = state.is_running ? json() : json::parse(state.output, nullptr, false);
  const bool has_found = findings.is_array();
  return json_text({{"running", state.is_running},
                    {"findings", has_found ? std::move(findings) : json()},
                    {"fault", has_found ? "" : fault_of(state)}});
}

}  // namespace handcast::desk
