// SPDX-License-Identifier: Apache-2.0
#include "services/lab/report/inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ipc/base/input_file.hpp"
#include "services/lab/report/kinds.hpp"

namespace handcast::report {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

Source read_source(const fs::path& folder, const std::string& name) {
  Source source{.file = name};
  std::error_code unknown;
  if (!fs::exists(folder / name, unknown)) {
    source.problem = fmt::format("{} is missing", name);
    source.missing = true;
    return source;
  }
  const auto text = read_input(folder / name, kMostText);
  if (!text) {
    source.problem = text.error().what;
    return source;
  }
  auto content = parse_shallow(*text);
  if (!content.is_object())
    source.problem = fmt::format("{} is not a JSON object", name);
  else if (const auto wrong = wrong_kind(content); !wrong.empty())
    source.problem = fmt::format("{}: {}", name, wrong);
  else
    source.content = std::move(content);
  return source;
}

std::vector<fs::path> list_pictures(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Run read_run(const fs::path& folder, const std::string& stem, const std::string& name,
             const std::string& sentence) {
  return {name, sentence, read_source(folder, stem + ".json"),
          list_pictures(folder / "frames" / stem)};
}

bool is_empty(const Inputs& inputs) {
  const auto has_nothing = [](const Run& run) {
    return !run.metrics.content && run.pictures.empty();
  };
  return std::all_of(inputs.runs.begin(), inputs.runs.end(), has_nothing) && !inputs.live.content &&
         !inputs.observer.content;
}

}  // namespace

std::optional<double> Source::number(const json::json_pointer& place) const {
  if (!content || !content->contains(place) || !content->at(place).is_number()) return std::nullopt;
  return content->at(place).get<double>();
}

std::vector<std::string> faults_of(const Inputs& inputs) {
  std::vector<std::string> faults;
  const auto note = [&](const Source& source) {
    if (!source.content && !source.missing) faults.push_back(source.problem);
  };
  for (const auto& run : inputs.runs) note(run.metrics);
  for (const auto* source : {&inputs.equal_legs, &inputs.live, &inputs.observer}) note(*source);
  return faults;
}

Result<Inputs> read_inputs(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    return fail(Errc::bad_config, fmt::format("'{}' is not a folder", folder.string()));
  Inputs inputs{{read_run(folder, "baseline", "baseline",
                          "The tracker's hand at its predicted pose, without any correction."),
                 read_run(folder, "paper", "paper", "The cascade as described in the paper."),
                 read_run(folder, "twin", "handcast", "The cascade of this software.")},
                read_source(folder, "equal_legs.json"),
                read_source(folder, "live.json"),
                read_source(folder, "observer.json")};
  if (is_empty(inputs))
    return fail(Errc::bad_config,
                fmt::format("'{}' has nothing to report: there is none of baseline.json, "
                            "paper.json, twin.json, live.json and observer.json, and there are no "
                            "pictures in frames/",
                            folder.string()));
  return inputs;
}

}  // namespace handcast::report
