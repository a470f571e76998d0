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

/// The table in a text; `whole_bytes`: where the last complete line ends.
Result<StudyTable> parse(std::string name, std::string_view text, std::size_t& whole_bytes) {
  StudyTable table{.name = std::move(name), .columns = {}, .rows = {}};
  constexpr std::string_view kMark = "\xef\xbb\xbf";  // with which spreadsheets begin
  whole_bytes = text.starts_with(kMark) ? kMark.size() : 0;
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

/// The heading of a file and its last line, which may be cut off, as a table of their own.
Result<std::string> heading_and_end(int fd) {
  constexpr off_t kPart = 64 << 10;  // more than any line of a study has
  const off_t size = lseek(fd, 0, SEEK_END);
  const auto read = [&](off_t from) {
    std::string part(static_cast<std::size_t>(std::min(size - from, kPart)), '\0');
    part.resize(
        static_cast<std::size_t>(std::max<ssize_t>(0, pread(fd, part.data(), part.size(), from))));
    return part;
  };
  const auto first = read(0);
  const auto heading = first.substr(0, first.find('\n') + 1);
  if (heading.empty()) return first;
  const auto end = read(std::max<off_t>(0, size - kPart));
  const auto last = end.substr(end.rfind('\n') + 1);
  return heading + last;
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

Result<int> StudyTable::whole(std::size_t row, std::size_t column, int least, int most) const {
  const auto value = number(row, column);
  if (!value) return tl::make_unexpected(value.error());
  if (*value >= least && *value <= most && *value == std::floor(*value))
    return static_cast<int>(*value);
  return fail(Errc::bad_data,
              fmt::format("{}: row {}: {} is {}; it must be a whole number, {}..{}", name, row + 1,
                          columns[column], rows[row][column], least, most));
}

Result<StudyLog> StudyLog::open(const std::filesystem::path& file, const CsvRow& columns,
                                Keeps keeps) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  UniqueFd fd(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!fd) return tl::make_unexpected(error_of(file, Errc::bad_config));
  if (flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(Errc::unavailable,
                fmt::format("{}: another program is writing this file", file.string()));
  const auto text = keeps == Keeps::all ? read_input(file, kMostText) : heading_and_end(fd.get());
  if (!text) return tl::make_unexpected(text.error());
  std::size_t whole_bytes = 0;
  auto table = parse(file.string(), *text, whole_bytes);
  if (!table) return tl::make_unexpected(table.error());
  if (!table->columns.empty() && table->columns != columns)
    return fail(Errc::bad_config,
                fmt::format("{}: the file has other columns than this version writes ({})",
                            file.string(), join(columns, ", ")));
  const auto last = std::string_view(*text).substr(whole_bytes);
  const bool is_new = table->columns.empty();
  StudyLog log(file, std::move(fd), std::move(*table));
  const off_t torn = static_cast<off_t>(last.size());
  if (torn > 0 && ftruncate(log.fd_.get(), lseek(log.fd_.get(), 0, SEEK_END) - torn) != 0)
    return tl::make_unexpected(error_of(file, Errc::unavailable));
  if (keeps == Keeps::none) log.earlier_.rows.clear();
  if (is_new)
    if (auto headed = log.add(columns); !headed) return tl::make_unexpected(headed.error());
  return log;
}

Result<void> StudyLog::add(const std::vector<CsvRow>& rows) {
  std::string lines;
  for (const auto& row : rows) lines += print_csv(row);
  return write(lines);
}

Result<void> StudyLog::write(std::string_view lines) {
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

void end_last_line(const std::filesystem::path& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NONBLOCK));
  char last = '\n';
  const off_t size = fd ? lseek(fd.get(), 0, SEEK_END) : 0;
  if (size <= 0 || pread(fd.get(), &last, 1, size - 1) != 1 || last == '\n') return;
  if (::write(fd.get(), "\n", 1) != 1) return;  // then the log says what is wrong with the file
}

}  // namespace handcast::study
