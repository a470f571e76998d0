// SPDX-License-Identifier: Apache-2.0
#include "services/studies/base/study_table.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "ipc/base/input_file.hpp"
#include "ipc/base/join.hpp"
#include "ipc/base/quote.hpp"

namespace handcast::study {
namespace {

/// The table in a text; `whole_bytes`: the size of all complete lines.
Result<StudyTable> parse(std::string name, std::string_view text, std::size_t& whole_bytes) {
  StudyTable table{.name = std::move(name), .columns = {}, .rows = {}};
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // what spreadsheets begin with
  whole_bytes = 0;
  std::size_t number = 1;
  for (std::size_t end = 0; (end = text.find('\n', whole_bytes)) != text.npos;
       whole_bytes = end + 1, ++number) {
    std::string_view line = text.substr(whole_bytes, end - whole_bytes);
    if (line.ends_with('\r')) line.remove_suffix(1);
    auto row = line.empty() ? CsvRow() : parse_csv(line);
    if (table.columns.empty() && !row.empty()) {
      table.columns = std::move(row);
      continue;
    }
    if (row.empty()) continue;
    if (row.size() != table.columns.size())
      return fail(Errc::bad_data,
                  fmt::format("{}:{}: the line has {} cells, the heading {}", table.name, number,
                              row.size(), table.columns.size()));
    table.rows.push_back(std::move(row));
  }
  table.is_torn = whole_bytes < text.size();
  return table;
}

Error error_of(const std::filesystem::path& file, Errc code) {
  return {code, fmt::format("{}: {}", file.string(), std::strerror(errno))};
}

}  // namespace

int StudyTable::find(std::string_view column) const {
  const auto found = std::ranges::find(columns, column);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

Result<std::size_t> StudyTable::column(std::string_view column) const {
  if (const int at = find(column); at >= 0) return static_cast<std::size_t>(at);
  return fail(Errc::bad_data, fmt::format("{}: there is no column {}; there are {}", name,
                                          quote(column), join(columns, ", ")));
}

Result<double> StudyTable::number(std::size_t row, std::size_t column) const {
  const auto& cell = rows[row][column];
  double value = 0;
  const auto* end = cell.data() + cell.size();
  const auto read = std::from_chars(cell.data(), end, value);
  if (read.ec == std::errc{} && read.ptr == end && std::isfinite(value)) return value;
  return fail(Errc::bad_data, fmt::format("{}: row {}: {} is {}, which is no number", name, row + 1,
                                          columns[column], quote(cell)));
}

Result<StudyTable> read_study_table(const std::filesystem::path& file) {
  auto text = read_input(file, kMostText);
  if (!text) return tl::make_unexpected(text.error());
  if (!text->empty() && text->back() != '\n') *text += '\n';
  std::size_t whole_bytes = 0;
  auto table = parse(file.string(), *text, whole_bytes);
  if (table && table->columns.empty())
    return fail(Errc::bad_data, fmt::format("{}: the file is empty", file.string()));
  return table;
}

Result<StudyLog> StudyLog::open(const std::filesystem::path& file, const CsvRow& columns) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  UniqueFd fd(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!fd) return tl::make_unexpected(error_of(file, Errc::bad_config));
  if (flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(Errc::unavailable,
                fmt::format("{}: another program is writing this file", file.string()));
  const auto text = read_input(file, kMostText);
  if (!text) return tl::make_unexpected(text.error());
  std::size_t whole_bytes = 0;
  auto table = parse(file.string(), *text, whole_bytes);
  if (!table) return tl::make_unexpected(table.error());
  if (!table->columns.empty() && table->columns != columns)
    return fail(Errc::bad_config,
                fmt::format("{}: the file has other columns than this version writes ({})",
                            file.string(), join(columns, ", ")));
  if (table->is_torn && ftruncate(fd.get(), static_cast<off_t>(whole_bytes)) != 0)
    return tl::make_unexpected(error_of(file, Errc::unavailable));
  const bool is_new = table->columns.empty();
  StudyLog log(file, std::move(fd), std::move(*table));
  if (is_new)
    if (auto headed = log.add(columns); !headed) return tl::make_unexpected(headed.error());
  return log;
}

Result<void> StudyLog::add(const std::vector<CsvRow>& rows) {
  std::string lines;
  for (const auto& row : rows) lines += print_csv(row);
  for (std::size_t written = 0; written < lines.size();) {
    const auto now = ::write(fd_.get(), lines.data() + written, lines.size() - written);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) return tl::make_unexpected(error_of(file_, Errc::unavailable));
    written += static_cast<std::size_t>(now);
  }
  if (fdatasync(fd_.get()) != 0 && errno != EINVAL)
    return tl::make_unexpected(error_of(file_, Errc::unavailable));
  return {};
}

}  // namespace handcast::study
