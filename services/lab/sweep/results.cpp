// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/results.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include "ipc/base/join.hpp"
#include "services/lab/sweep/columns.hpp"

namespace handcast::sweep {
namespace {

/// True if a file is empty or begins as the results of a sweep do, so that --fresh may discard it.
bool may_be_discarded(int fd) {
  std::string start(kStampStart.size(), '\0');
  const auto read = pread(fd, start.data(), start.size(), 0);
  return read >= 0 &&
         kStampStart.starts_with(std::string_view(start.data(), static_cast<std::size_t>(read)));
}

/// True if the program was built later. Its version stays while it is worked on, and its figures
/// change.
bool is_older_than_this_program(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto built = std::filesystem::last_write_time("/proc/self/exe", unknown);
  return !unknown && std::filesystem::last_write_time(file, unknown) < built && !unknown;
}

}  // namespace

Result<UniqueFd> lock_results(const std::filesystem::path& file) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  UniqueFd fd(::open(file.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644));
  if (!fd)
    return fail(Errc::bad_config, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  if (flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
    return fail(Errc::unavailable,
                fmt::format("{}: another sweep is writing this file", file.string()));
  return fd;
}

Result<std::unique_ptr<Results>> Results::open(const std::filesystem::path& file,
                                               const Heading& heading, bool fresh) {
  auto fd = lock_results(file);
  if (!fd) return tl::make_unexpected(fd.error());
  auto results = std::unique_ptr<Results>(new Results(file, std::move(*fd)));
  if (fresh && !may_be_discarded(results->fd_.get()))
    return fail(Errc::bad_config,
                fmt::format("{}: the file does not hold results of a sweep and is left as it is; "
                            "give another file with -o",
                            file.string()));
  if (fresh && ftruncate(results->fd_.get(), 0) != 0)
    return fail(Errc::bad_config, fmt::format("{}: {}", file.string(), std::strerror(errno)));
  if (auto ready = results->go_on(heading); !ready) return tl::make_unexpected(ready.error());
  return results;
}

Result<void> Results::go_on(const Heading& heading) {
  const auto table = read_table(file_);
  if (!table)
    return fail(Errc::bad_config,
                table.error().what + "; give another file with -o" +
                    (may_be_discarded(fd_.get()) ? ", or overwrite it with --fresh" : ""));
  const bool no_columns = table->heading.columns.empty() && table->rows.empty();
  const bool begun = !table->heading.stamp.empty();
  if (begun && table->heading.stamp == heading.stamp && !no_columns && table->heading != heading)
    return fail(Errc::bad_config,
                fmt::format("{}: the columns of the file are not those of this version; give "
                            "another file with -o, or overwrite it with --fresh",
                            file_.string()));
  if (begun && table->heading.stamp != heading.stamp)
    return fail(Errc::bad_config,
                fmt::format("{}: the file holds results of another plan, rig or version ({}; this "
                            "is {}); give another file with -o, or overwrite it with --fresh",
                            file_.string(), table->heading.stamp, heading.stamp));
  if (!begun && !heading.print().starts_with(table->torn))
    return fail(Errc::bad_config,
                fmt::format("{}: the file does not hold results of a sweep; give another file "
                            "with -o",
                            file_.string()));
  earlier_build_ = !table->rows.empty() && is_older_than_this_program(file_);
  const auto whole_bytes = no_columns ? 0 : table->whole_bytes;
  std::error_code unknown;  // untouched if it is whole: its time says which build wrote it
  if (std::filesystem::file_size(file_, unknown) != whole_bytes &&
      ftruncate(fd_.get(), static_cast<off_t>(whole_bytes)) != 0)
    return fail(Errc::bad_config, fmt::format("{}: {}", file_.string(), std::strerror(errno)));
  for (const auto& row : table->rows) {
    if (Table::failed(row)) continue;
    done_.insert(Table::index_of(row));
  }
  return whole_bytes == 0 ? write(heading.print()) : Result<void>();
}

Result<void> Results::append(const Row& row) {
  const std::lock_guard lock(mutex_);
  if (state_) state_ = check_in_place();
  if (state_) state_ = write(print_csv(row));
  return state_;
}

/// The open file must still be the one of that name: rows of another would be lost.
Result<void> Results::check_in_place() const {
  struct stat opened = {};
  struct stat named = {};
  if (fstat(fd_.get(), &opened) == 0 && stat(file_.c_str(), &named) == 0 &&
      opened.st_dev == named.st_dev && opened.st_ino == named.st_ino)
    return {};
  return fail(Errc::unavailable,
              fmt::format("{}: another program removed or replaced the file during the sweep",
                          file_.string()));
}

Result<void> Results::sort() {
  if (auto in_place = check_in_place(); !in_place) return in_place;
  auto table = read_table(file_);
  if (!table) return tl::make_unexpected(table.error());
  return write_table(file_, *table);
}

Result<void> Results::write(const std::string& text) {
  for (std::size_t written = 0; written < text.size();) {
    const auto now = ::write(fd_.get(), text.data() + written, text.size() - written);
    if (now < 0 && errno == EINTR) continue;
    if (now < 0)
      return fail(Errc::unavailable, fmt::format("{}: {}", file_.string(), std::strerror(errno)));
    written += static_cast<std::size_t>(now);
  }
  return {};
}

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
