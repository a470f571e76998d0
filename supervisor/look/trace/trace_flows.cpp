// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/trace/trace_flows.hpp"

#include <map>
#include <optional>
#include <utility>

#include "supervisor/look/trace/made_frames.hpp"

namespace handcast::supervisor {
namespace {

class Flows {
 public:
  explicit Flows(std::size_t frames) : of_frame(frames) {}

  /// Adds a flow through these frames, if there are two or more.
  void connect(const std::vector<std::size_t>& frames) {
    if (frames.size() < 2) return;
    ++count_;
    for (const auto frame : frames) of_frame[frame].push_back(count_);
  }
  std::vector<std::vector<std::uint64_t>> of_frame;

 private:
  std::uint64_t count_ = 0;
};

/// The projector frames that use an input, by the input, in the order of time.
using Users = std::map<std::size_t, std::vector<std::size_t>>;

Users users_of(const std::vector<MadeFrame>& frames,
               std::optional<std::size_t> MadeFrame::*ingredient) {
  Users users;
  for (const auto& made : frames)
    if (made.*ingredient) users[*(made.*ingredient)].push_back(made.frame);
  return users;
}

}  // namespace

std::vector<std::vector<std::uint64_t>> flows_of(const HistorySnapshot& history) {
  const auto frames = made_frames(history);
  Flows flows(history.frames.size());
  for (auto [image, shown] : users_of(frames, &MadeFrame::image)) {
    shown.insert(shown.begin(), image);
    flows.connect(shown);
  }
  for (const auto& [sample, known] : users_of(frames, &MadeFrame::sample))
    flows.connect({sample, known.front()});

  const auto informed = users_of(frames, &MadeFrame::detection);
  const Records images(history, msg::Stage::capture);
  for (std::size_t i = 0; i < history.frames.size(); ++i) {
    if (!find_mark(history.frames[i], msg::Stage::detect)) continue;
    std::vector<std::size_t> way;
    const auto& seen_in = history.frames[i].header;
    if (const auto image = images.of(seen_in.origin_ns, seen_in.frame_id)) way.push_back(*image);
    way.push_back(i);
    if (const auto known = informed.find(i); known != informed.end())
      way.push_back(known->second.front());
    flows.connect(way);
  }
  return std::move(flows.of_frame);
}

}  // namespace handcast::supervisor
