// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ipc/base/join.hpp"
#include "services/lab/sweep/columns.hpp"
#include "services/lab/sweep/results.hpp"

namespace handcast::sweep {
namespace {

struct Source {
  Row row;
  std::string file;
};

/// The first column in which two rows of one run differ, machine times excepted; "" if they agree.
std::string disagreement(const Heading& heading, const Row& a, const Row& b) {
  for (std::size_t i = 0; i < heading.columns.size(); ++i)
    if (a[i] != b[i] && !is_machine_time(heading.columns[i])) return heading.columns[i];
  return {};
}

Result<void> take(const Table& table, const std::string& file,
                  std::map<std::size_t, Source>& rows) {
  for (const auto& row : table.rows) {
    const auto [known, added] = rows.try_emplace(Table::index_of(row), Source{row, file});
    if (added || Table::failed(row)) continue;
    auto& source = known->second;
    const auto column = Table::failed(source.row) || source.file == file
                            ? ""
                            : disagreement(table.heading, source.row, row);
    if (!column.empty())
      return fail(Errc::bad_data, fmt::format("run {}: {} and {} disagree on {}", known->first,
                                              source.file, file, column));
    if (Table::failed(source.row) || source.file == file) source = {row, file};
  }
  return {};
}

/// Checks that no result is lost if `whole` replaces the file: it is empty or holds results of the
/// same sweep, whose scored runs are in `rows`.
Result<void> check_replaceable(const std::filesystem::path& file, const Table& whole,
                               const std::map<std::size_t, Source>& rows) {
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return {};
  const auto before = read_table(file);
  if (before && before->is_cut_off_in(whole.heading)) return {};
  if (!before || before->heading != whole.heading)
    return fail(Errc::bad_config, fmt::format("{}: the file does not hold results of this sweep; "
                                              "give another file with -o",
                                              file.string()));
  std::vector<std::size_t> lost;
  for (const auto& row : before->rows)
    if (!Table::failed(row) && !rows.contains(Table::index_of(row)))
      lost.push_back(Table::index_of(row));
  if (lost.empty()) return {};
  std::ranges::sort(lost);
  return fail(Errc::bad_config,
              fmt::format("{}: the file holds runs that no merged file has ({}); merge it, too, or "
                          "give another file with -o",
                          file.string(), print_indices(lost)));
}

}  // namespace

Result<Merged> merge(const std::vector<std::filesystem::path>& files,
                     const std::filesystem::path& into) {
  std::map<std::size_t, Source> rows;
  Table whole;
  for (const auto& file : files) {
    const auto table = read_table(file);
    if (!table) return tl::make_unexpected(table.error());
    if (table->heading.columns.empty())
      return fail(Errc::bad_data, fmt::format("{}: the file has no heading: it does not hold "
                                              "results of a sweep",
                                              file.string()));
    if (&file == &files.front()) whole.heading = table->heading;
    if (table->heading != whole.heading)
      return fail(Errc::bad_data,
                  fmt::format("{} and {} are of different plans, rigs or versions ({}; {})",
                              files.front().string(), file.string(), whole.heading.stamp,
                              table->heading.stamp));
    if (auto taken = take(*table, file.string(), rows); !taken)
      return tl::make_unexpected(taken.error());
  }
  Merged merged;
  for (std::size_t index = 0; index < whole.heading.runs(); ++index) {
    const auto found = rows.find(index);
    if (found == rows.end()) {
      merged.missing.push_back(index);
      continue;
    }
    merged.failed += Table::failed(found->second.row);
    whole.rows.push_back(found->second.row);
  }
  merged.rows = whole.rows.size();
  auto lock = lock_results(into);
  if (!lock) return tl::make_unexpected(lock.error());
  if (auto spared = check_replaceable(into, whole, rows); !spared)
    return tl::make_unexpected(spared.error());
  if (auto written = write_table(into, whole); !written)
    return tl::make_unexpected(written.error());
  return merged;
}

std::string print_indices(const std::vector<std::size_t>& ascending) {
  std::vector<std::string> texts;
  for (std::size_t first = 0; first < ascending.size();) {
    auto last = first;
    while (last + 1 < ascending.size() && ascending[last + 1] == ascending[last] + 1) ++last;
    texts.push_back(last == first ? fmt::format("{}", ascending[first])
                                  : fmt::format("{}-{}", ascending[first], ascending[last]));
    first = last + 1;
  }
  return join(texts, ", ");
}

}  // namespace handcast::sweep
