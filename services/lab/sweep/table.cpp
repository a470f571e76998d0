// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "ipc/base/input_file.hpp"
#include "ipc/base/write_whole.hpp"

namespace handcast::sweep {
namespace {

Result<void> check_row(const Row& row, const Heading& heading, const std::filesystem::path& file,
                       std::size_t line) {
  std::size_t index = 0;
  const auto& text = row.front();
  const auto read = std::from_chars(text.data(), text.data() + text.size(), index);
  const bool number = read.ec == std::errc{} && read.ptr == text.data() + text.size();
  if (row.size() == heading.columns.size() && number && index < heading.runs()) return {};
  return fail(Errc::bad_data,
              fmt::format("{}:{}: the line is not one of this sweep", file.string(), line));
}

}  // namespace

std::string Heading::print() const { return stamp + "\n" + print_csv(columns); }

// 0 also above kMostRuns: no file of results holds more, and the number decides how much memory
// is taken.
std::size_t Heading::runs() const {
  constexpr std::size_t kMostRuns = 10'000'000;
  const auto at = stamp.find(" runs=");
  std::size_t count = 0;
  if (at != stamp.npos) std::from_chars(stamp.data() + at + 6, stamp.data() + stamp.size(), count);
  return count <= kMostRuns ? count : 0;
}

bool Table::is_cut_off_in(const Heading& begun) const {
  const auto first = heading.stamp.empty() ? std::string() : heading.stamp + "\n";
  return heading.columns.empty() && begun.print().starts_with(first + torn);
}

std::size_t Table::index_of(const Row& row) { return std::stoul(row.front()); }

Result<Table> read_table(const std::filesystem::path& file) {
  const auto text = read_input(file, kMostResults);
  if (!text) return tl::make_unexpected(text.error());
  Table table;
  std::size_t line = 1;
  for (std::size_t end = 0; (end = text->find('\n', table.whole_bytes)) != text->npos;
       table.whole_bytes = end + 1, ++line) {
    const auto content = std::string_view(*text).substr(table.whole_bytes, end - table.whole_bytes);
    if (line == 1) {
      table.heading.stamp = content;
    } else if (line == 2) {
      table.heading.columns = parse_csv(content);
    } else {
      table.rows.push_back(parse_csv(content));
      if (auto good = check_row(table.rows.back(), table.heading, file, line); !good)
        return tl::make_unexpected(good.error());
    }
  }
  table.torn = text->substr(table.whole_bytes);
  if (line > 1 && (!table.heading.stamp.starts_with(kStampStart) || table.heading.runs() == 0))
    return fail(Errc::bad_data,
                fmt::format("{}: the file does not hold results of a sweep", file.string()));
  return table;
}

Result<void> write_table(const std::filesystem::path& file, const Table& table) {
  std::map<std::size_t, const Row*> newest;
  for (const auto& row : table.rows) newest[Table::index_of(row)] = &row;
  std::string text = table.heading.print();
  for (const auto& [index, row] : newest) text += print_csv(*row);
  return write_whole(file, text);
}

}  // namespace handcast::sweep
