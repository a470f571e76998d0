// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <string_view>

#include "config/settings/load.hpp"
#include "config/settings/settings.hpp"
#include "ipc/base/input_file.hpp"
#include "services/lab/simulate/frame_detector.hpp"
#include "services/lab/twin/ground_truth_mesh.hpp"

namespace handcast::sweep {
namespace {

constexpr std::size_t kMostRuns = 1'000'000;

/// The settings that name a file whose content decides the results. (Libraries and recordings'
/// folders are not read here.)
constexpr std::array<std::string_view, 7> kRead{"calibration",
                                                "hand.left",
                                                "hand.right",
                                                "content.left",
                                                "content.right",
                                                "twin.shape.mesh",
                                                "twin.geometry.calibration"};

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(std::string_view text) {
    for (const char c : text) byte(static_cast<unsigned char>(c));
    byte(0xff);  // separates texts: does not occur in UTF-8
  }
  std::string print() const { return fmt::format("{:016x}", state_); }

 private:
  void byte(unsigned char value) { state_ = (state_ ^ value) * 0x100000001b3u; }
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

/// Hashes of files, of which each is read once. What cannot be read has none: the run itself
/// reports the reason.
class Contents {
 public:
  const std::string& of(const std::string& file) {
    const auto [known, is_new] = hashes_.try_emplace(file);
    std::error_code absent;
    if (!is_new || !std::filesystem::is_regular_file(file, absent)) return known->second;
    if (const auto bytes = read_input(file, kMostMesh)) {
      Hash hash;
      hash.add(*bytes);
      known->second = hash.print();
    }
    return known->second;
  }

 private:
  std::map<std::string, std::string> hashes_;
};

/// The settings of a rig with the absolute paths made relative to `folder`, and what is in the
/// files.
std::string without_machine(config::Rig rig, const std::filesystem::path& folder,
                            Contents& contents) {
  std::string hashes;
  for (const auto& section : config::list_settings(rig))
    for (const auto& setting : section.settings) {
      if (!config::names_a_file(setting.path)) continue;
      auto& text = *std::get<std::string*>(setting.target);
      if (!std::filesystem::path(text).is_absolute()) continue;
      if (std::ranges::find(kRead, setting.path) != kRead.end()) hashes += contents.of(text) + '\n';
      text = std::filesystem::path(text).lexically_relative(folder).string();
    }
  return config::print_rig(rig) + hashes;
}

/// What is in the files that no setting names but a rig reads: WebXR's hand, and the networks of
/// the detector that will run, which is another one if a file is absent.
std::string unnamed_files(const config::Rig& rig, Contents& contents) {
  std::string hashes;
  if (rig.twin.shape.mesh == "webxr")
    hashes += contents.of(twin::webxr_hand_file().string()) + '\n';
  hashes += landmarks::choose_detector(rig).backend + '\n';
  for (const auto& file : simulate::network_files(rig)) hashes += contents.of(file.string()) + '\n';
  return hashes;
}

/// Advances to the next combination; returns false after the last.
bool next_choices(const Grid& grid, std::vector<std::size_t>& choices) {
  for (std::size_t axis = grid.size(); axis-- > 0;) {
    if (++choices[axis] < grid[axis].choices.size()) return true;
    choices[axis] = 0;
  }
  return false;
}

Result<std::vector<Run>> all_runs(const Plan& plan) {
  std::vector<Run> runs;
  for (std::size_t variant = 0; variant < plan.variants.size(); ++variant)
    for (std::size_t grid = 0; grid < plan.grids.size(); ++grid) {
      std::vector<std::size_t> choices(plan.grids[grid].size(), 0);
      do {
        if (runs.size() == kMostRuns)
          return fail(Errc::bad_config, fmt::format("{}: the plan has more than {} runs",
                                                    plan.file.string(), kMostRuns));
        runs.push_back({runs.size(), variant, grid, choices});
      } while (next_choices(plan.grids[grid], choices));
    }
  return runs;
}

}  // namespace

const Choice* Run::choice(const Plan& plan, const std::string& path) const {
  const auto& axes = plan.grids[grid];
  const auto axis = std::ranges::find(axes, path, &Axis::path);
  return axis == axes.end()
             ? nullptr
             : &axis->choices[choices[static_cast<std::size_t>(axis - axes.begin())]];
}

Result<config::Rig> rig_of(const Plan& plan, const Run& run) {
  const auto& variant = plan.variants[run.variant];
  std::vector<std::string> settings;
  const auto set = [&](const std::string& path, const Choice& choice) {
    settings.push_back(path + "=" + choice.assigned);
  };
  for (const auto& setting : plan.settings) set(setting.path, setting.choices.front());
  for (const auto& setting : variant.settings) set(setting.path, setting.choices.front());
  for (const auto& axis : plan.grids[run.grid]) set(axis.path, *run.choice(plan, axis.path));
  return config::parse_rig(variant.rig_text, variant.rig_file, settings);
}

Result<Expansion> expand(const Plan& plan) {
  auto runs = all_runs(plan);
  if (!runs) return tl::make_unexpected(runs.error());
  const auto folder = std::filesystem::absolute(plan.file).parent_path().lexically_normal();
  Hash hash;
  hash.add(fmt::format("{} {} {}", plan.seconds, plan.warm_up_s, plan.draw_every));
  if (plan.draw_hz > 0) hash.add(fmt::format("{} Hz", plan.draw_hz));
  Contents contents;
  config::Faults faults;
  std::vector<std::string> known;
  for (const auto& run : *runs) {
    const auto rig = rig_of(plan, run);
    if (rig) {
      hash.add(describe_run(plan, run));
      hash.add(without_machine(*rig, folder, contents));
      hash.add(unnamed_files(*rig, contents));
      const auto& variant = plan.variants[run.variant];
      for (const auto& results : {variant.poses, variant.landmarks})
        if (!results.empty()) hash.add(contents.of(results_file(results, case_of(plan, run))));
    } else if (std::ranges::find(known, rig.error().what) == known.end()) {
      known.push_back(rig.error().what);
      faults.add(fmt::format("{}: run {} ({}): {}", plan.file.string(), run.index,
                             describe_run(plan, run), rig.error().what));
    }
  }
  if (!faults.empty()) return tl::make_unexpected(faults.to_error());
  return Expansion{std::move(*runs), hash.print()};
}

std::string describe_run(const Plan& plan, const Run& run) {
  auto text = plan.variants[run.variant].name;
  for (const auto& axis : plan.grids[run.grid])
    text += fmt::format(", {}={}", axis.path, run.choice(plan, axis.path)->shown);
  return text;
}

std::optional<std::string> why_absent(const config::Rig& rig) {
  if (rig.twin.shape.mesh == "webxr" && twin::webxr_hand_file().empty())
    return "twin.shape.mesh: WebXR's hand is not installed (`scripts/setup --hands`)";
  const auto& motion = rig.twin.motion;
  std::error_code unknown;
  const auto kind = std::filesystem::status(motion, unknown).type();
  // If the status is unknown, the run itself reports the reason.
  const bool hidden = kind == std::filesystem::file_type::none;
  if (motion.starts_with("builtin:") || kind == std::filesystem::file_type::directory || hidden)
    return std::nullopt;
  return fmt::format("twin.motion: there is no folder {}", motion);
}

std::size_t case_of(const Plan& plan, const Run& run) {
  std::size_t cases = 0;
  for (const auto& grid : plan.grids) {
    std::size_t combinations = 1;
    for (const auto& axis : grid) combinations *= axis.choices.size();
    cases += combinations;
  }
  return run.index % cases;
}

std::string results_file(const std::filesystem::path& folder, std::size_t number) {
  if (folder.empty()) return {};
  std::error_code absent;
  const auto array = folder / fmt::format("{:03}.npy", number);
  return std::filesystem::exists(array, absent)
             ? array.string()
             : (folder / fmt::format("{:03}.csv", number)).string();
}

std::optional<std::string> why_absent(const Plan& plan, const Run& run, const config::Rig& rig) {
  if (auto why = why_absent(rig)) return why;
  std::error_code absent;
  for (const auto& folder :
       {plan.variants[run.variant].poses, plan.variants[run.variant].landmarks})
    if (!folder.empty() &&
        !std::filesystem::exists(results_file(folder, case_of(plan, run)), absent))
      return fmt::format("{} has no results of the case", folder.string());
  return std::nullopt;
}

Result<Shard> parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool slash = index.ec == std::errc{} && index.ptr != end && *index.ptr == '/';
  const auto count = std::from_chars(slash ? index.ptr + 1 : end, end, shard.count);
  if (!slash || count.ec != std::errc{} || count.ptr != end || shard.index >= shard.count)
    return fail(Errc::bad_config,
                fmt::format("--shard {}: a shard is I/N with I from 0 to N-1, e.g. 0/4", text));
  return shard;
}

}  // namespace handcast::sweep
