// SPDX-License-Identifier: Apache-2.0
#include "services/lab/sweep/results.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

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
  if (state_) state_ = write(print_row(row));
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

}  // namespace handcast::sweep
