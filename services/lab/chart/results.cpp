// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "services/lab/sweep/columns.hpp"

namespace handcast::chart {
namespace {

constexpr const char* kTimesPlan = "times";

bool is_setting(const std::string& column) {
  return column != "index" && column != "variant" && column != "error" && !sweep::is_metric(column);
}

bool is_of_the_ladder(const std::string& path) {
  return path == "twin.motion" || path == "twin.speed" || path == "twin.seed";
}

std::string after(const std::string& stamp, const std::string& key) {
  const auto at = stamp.find(" " + key + "=");
  return at == stamp.npos ? "" : stamp.substr(at + key.size() + 2);
}

Result<Run> run_of(const sweep::Table& table, const sweep::Row& row, const std::string& file) {
  Run run{after(table.heading.stamp, "plan"), row[1], {}, {}};
  for (std::size_t i = 2; i + 1 < row.size(); ++i) {
    const auto& column = table.heading.columns[i];
    if (row[i].empty() || column == sweep::kDetector) continue;
    if (is_setting(column)) {
      run.settings[column] = row[i];
    } else if (const auto value = number_of(row[i])) {
      run.metrics[column] = *value;
    } else {
      return fail(Errc::bad_data, fmt::format("{}: run {}: {} is '{}', which is not a number", file,
                                              row.front(), column, row[i]));
    }
  }
  return run;
}

Result<void> read_file(const std::filesystem::path& file, Results& results) {
  const auto table = sweep::read_table(file);
  if (!table) return tl::make_unexpected(table.error());
  const auto& columns = table->heading.columns;
  if (columns.size() < 3 || columns[1] != "variant" || columns.back() != "error")
    return fail(Errc::bad_data,
                fmt::format("{}: the file does not hold results of a sweep", file.string()));
  Source source{after(table->heading.stamp, "plan"), file.filename().string()};
  source.planned = table->heading.runs();
  source.ladder = std::ranges::none_of(
      columns, [](const auto& column) { return is_setting(column) && !is_of_the_ladder(column); });
  for (const auto& row : table->rows) {
    if (sweep::Table::failed(row)) {
      ++source.failed;
      continue;
    }
    auto run = run_of(*table, row, file.string());
    if (!run) return tl::make_unexpected(run.error());
    results.runs.push_back(std::move(*run));
    ++source.scored;
  }
  if (source.scored == 0)
    return fail(Errc::bad_data, fmt::format("{}: the file has no scored run", file.string()));
  results.sources.push_back(source);
  return {};
}

}  // namespace

std::optional<double> number_of(const std::string& setting) {
  if (setting == "true") return 1;
  if (setting == "false") return 0;
  double value = 0;
  const char* const end = setting.data() + setting.size();
  const auto read = std::from_chars(setting.data(), end, value);
  return read.ec == std::errc{} && read.ptr == end ? std::optional(value) : std::nullopt;
}

std::optional<double> Run::metric(const std::string& column) const {
  const auto found = metrics.find(column);
  return found == metrics.end() ? std::nullopt : std::optional(found->second);
}

std::string Run::setting(const std::string& path) const {
  const auto found = settings.find(path);
  return found == settings.end() ? "" : found->second;
}

std::vector<std::string> Run::turned() const {
  std::vector<std::string> paths;
  for (const auto& [path, value] : settings)
    if (!is_of_the_ladder(path)) paths.push_back(path);
  return paths;
}

Runs Results::select(const std::function<bool(const Run&)>& wanted) const {
  Runs selected;
  for (const auto& run : runs)
    if (wanted(run)) selected.push_back(&run);
  return selected;
}

Runs Results::ladder() const {
  std::set<std::string> plans;
  for (const auto& source : sources)
    if (source.ladder && source.plan != kTimesPlan) plans.insert(source.plan);
  return select([&](const Run& run) { return plans.contains(run.plan); });
}

Result<Results> read_results(const std::vector<std::filesystem::path>& files) {
  Results results;
  for (const auto& file : files)
    if (auto read = read_file(file, results); !read) return tl::make_unexpected(read.error());
  return results;
}

std::optional<double> mean_of(const Runs& runs, const std::string& column) {
  double sum = 0;
  std::size_t count = 0;
  for (const auto* run : runs)
    if (const auto value = run->metric(column)) sum += *value, ++count;
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

std::vector<std::string> variants_of(const Runs& runs) {
  std::vector<std::string> variants;
  for (const auto* run : runs)
    if (std::ranges::find(variants, run->variant) == variants.end())
      variants.push_back(run->variant);
  return variants;
}

Runs of_variant(const Runs& runs, const std::string& variant) {
  Runs selected;
  std::ranges::copy_if(runs, std::back_inserter(selected),
                       [&](const Run* run) { return run->variant == variant; });
  return selected;
}

}  // namespace handcast::chart
