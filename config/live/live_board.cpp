// SPDX-License-Identifier: Apache-2.0
#include "config/live/live_board.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

#include "config/live/live_values.hpp"
#include "config/live_files.hpp"
#include "config/measured.hpp"
#include "config/settings/files.hpp"
#include "ipc/base/clock.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/control/control_client.hpp"
#include "ipc/ring/reader.hpp"
#include "ipc/ring/writer.hpp"

namespace handcast::config {

using namespace std::chrono_literals;

LiveBoard::LiveBoard(ipc::Segment ring, Rig filed, std::filesystem::path file)
    : ring_(std::move(ring)), filed_(std::move(filed)), file_(std::move(file)) {}

Result<LiveBoard> LiveBoard::open(const std::string& rig) {
  auto ring = client::rig_ring(rig, msg::kLiveSettings);
  if (!ring) return tl::make_unexpected(ring.error());
  const auto answer = control::ask(ring->rig, {.verb = control::Verb::rig});
  if (!answer) return tl::make_unexpected(answer.error());
  const auto text = answer->value("rig", std::string()),
             file = answer->value("file", std::string());
  auto filed = parse_rig(text, fmt::format("rig '{}'", ring->rig));
  if (!filed) return tl::make_unexpected(filed.error());
  return LiveBoard(std::move(ring->segment), std::move(*filed), file);
}

Result<ipc::Segment> LiveBoard::again() const {
  return ipc::Segment::open(UniqueFd(::dup(ring_.fd())));
}

/// The ring is mapped once: it has megabytes, and now() is called for every picture of the desk.
struct LiveBoard::View {
  ipc::Reader<msg::LiveSettings> reader;
  msg::LiveSettings newest;
};

LiveBoard::~LiveBoard() = default;
LiveBoard::LiveBoard(LiveBoard&&) noexcept = default;
LiveBoard& LiveBoard::operator=(LiveBoard&&) noexcept = default;

Result<msg::LiveSettings> LiveBoard::now() const {
  if (!view_) {
    auto reader = again().and_then(
        [](ipc::Segment&& ring) { return ipc::Reader<msg::LiveSettings>::watch(std::move(ring)); });
    if (!reader) return tl::make_unexpected(reader.error());
    view_ = std::make_unique<View>(View{std::move(*reader), {}});
  }
  if (!view_->reader.await(Deadline::now())) return view_->newest;
  const auto last = view_->reader.latest(Deadline::now());
  if (last)
    view_->newest = **last;
  else if (last.error().code != Errc::timeout)
    return tl::make_unexpected(last.error());
  return view_->newest;
}

std::string why_dark(const Light& light) {
  if (light.blackout) return "light.blackout is on";
  return light.master > 0 ? "" : "light.master is 0";
}

Result<Rig> LiveBoard::rig_now() const {
  return now().and_then([&](const auto& last) { return with_live(filed_, last.values.view()); });
}

Result<std::uint64_t> LiveBoard::amend(
    const std::function<Result<void>(msg::LiveSettings&)>& change) const {
  auto ring = again();
  if (!ring) return tl::make_unexpected(ring.error());
  auto writer = ipc::Writer<msg::LiveSettings>::attach(std::move(*ring), Deadline::in(2s));
  if (!writer) return tl::make_unexpected(writer.error());
  auto settings = now();
  if (!settings) return tl::make_unexpected(settings.error());
  settings->transition.set("");
  settings->transition_s = -1;
  if (const auto done = change(*settings); !done) return tl::make_unexpected(done.error());
  ++settings->header.frame_id;
  settings->header.origin_ns = now_ns();
  writer->publish(*settings);
  return settings->header.frame_id;
}

Result<std::uint64_t> LiveBoard::set(std::span<const std::string> assignments,
                                     std::string_view source, const Transition& transition) {
  return amend([&](msg::LiveSettings& settings) -> Result<void> {
    settings.transition.set(transition.name);
    settings.transition_s = static_cast<float>(transition.seconds);
    const auto values = changed_values(filed_, settings.values.view(), assignments);
    if (!values) return tl::make_unexpected(values.error());
    const std::vector<std::string> parts(assignments.begin(), assignments.end());
    return change(settings, *values, join(parts, ", "), source, now_ns());
  });
}

Result<std::uint64_t> LiveBoard::undo(std::string_view source) {
  return amend([&](msg::LiveSettings& settings) { return config::undo(settings, source); });
}

Result<std::uint64_t> LiveBoard::redo(std::string_view source) {
  return amend([&](msg::LiveSettings& settings) { return config::redo(settings, source); });
}

Result<std::uint64_t> LiveBoard::load(std::string_view preset, std::string_view source) {
  const auto file = preset_file_of(file_, preset);
  if (!file) return tl::make_unexpected(file.error());
  std::error_code unknown;
  if (!std::filesystem::exists(*file, unknown)) {
    const auto names = preset_names(file_);
    return fail(Errc::bad_config,
                fmt::format("there is no preset {}; {}", quote(preset),
                            names.empty() ? "`handcast preset --store NAME` makes one"
                                          : "there are: " + join(names, ", ")));
  }
  const auto text = read_text(*file);
  if (!text) return tl::make_unexpected(text.error());
  const auto values = values_of_preset(filed_, *text, file->string());
  if (!values) return tl::make_unexpected(values.error());
  return amend([&](msg::LiveSettings& settings) {
    return change(settings, *values, fmt::format("preset {}", preset), source, now_ns());
  });
}

/// The present values with those that were saved before, which filed() has already.
Result<std::string> LiveBoard::kept() const {
  const auto settings = now();
  if (!settings) return tl::make_unexpected(settings.error());
  auto kept = read_measured(live_file_of(file_));
  if (!kept) return tl::make_unexpected(kept.error());
  const auto present = parse_measured(std::string(settings->values.view()), "live settings");
  if (!present) return tl::make_unexpected(present.error());
  for (const auto& setting : *present) {
    std::erase_if(*kept, [&](const auto& old) { return old.path == setting.path; });
    kept->push_back(setting);
  }
  return print_measured(*kept);
}

Result<void> LiveBoard::store(std::string_view preset) const {
  const auto file = preset_file_of(file_, preset);
  if (!file) return tl::make_unexpected(file.error());
  return kept().and_then([&](const std::string& values) { return write_values(*file, values); });
}

Result<void> LiveBoard::save() const {
  return kept().and_then(
      [&](const std::string& values) { return write_values(live_file_of(file_), values); });
}

}  // namespace handcast::config
