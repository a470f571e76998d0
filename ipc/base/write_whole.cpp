// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/write_whole.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <optional>
#include <string>
#include <system_error>

#include "ipc/base/inherited.hpp"
#include "ipc/base/output_file.hpp"
#include "ipc/base/unique_fd.hpp"

namespace handcast {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> cannot(const fs::path& file, int number) {
  return fail(Errc::unavailable, fmt::format("'{}' cannot be written: {}", file.string(),
                                             inherited::reason_of(number)));
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// Where the bytes go.
struct Target {
  fs::path file;                   ///< behind all links
  std::optional<struct stat> was;  ///< nothing if the file is new
  bool is_in_place = false;
  bool is_loop = false;  ///< links that lead to each other, and to no file
};

/// A link of /proc leads to an open file, whatever its name is now; as /dev/stdout does.
bool is_of_proc(const fs::path& link) {
  struct statfs system {};
  return ::statfs(folder_of(link).c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

Target target_of(const fs::path& file) {
  constexpr int kMostLinks = 40;  // as the kernel follows
  Target target{file, std::nullopt};
  std::error_code none;
  for (int i = 0; i < kMostLinks && fs::is_symlink(target.file, none); ++i) {
    if (is_of_proc(target.file)) {
      target.is_in_place = true;
      return target;
    }
    target.file = folder_of(target.file) / fs::read_symlink(target.file, none);
  }
  target.is_loop = fs::is_symlink(target.file, none);
  struct stat status {};
  if (::stat(target.file.c_str(), &status) == 0) {
    target.was = status;
    target.is_in_place = !S_ISREG(status.st_mode) || is_standard_output(status);
  }
  return target;
}

/// 0, or errno.
int write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) return errno;
    if (count > 0) bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

/// The standard output or error of this process if that is this regular file; else -1.
int standard_fd_of(const fs::path& file) {
  struct stat wanted {
  }, open{};
  if (::stat(file.c_str(), &wanted) != 0 || !S_ISREG(wanted.st_mode)) return -1;
  for (const int fd : {STDOUT_FILENO, STDERR_FILENO})
    if (::fstat(fd, &open) == 0 && open.st_dev == wanted.st_dev && open.st_ino == wanted.st_ino)
      return fd;
  return -1;
}

/// 0, or errno.
int write_in_place(const fs::path& file, std::string_view bytes) {
  // Opening such a file again would lose what is in it, and put later output over these bytes.
  if (const int fd = standard_fd_of(file); fd >= 0) {
    std::fflush(fd == STDOUT_FILENO ? stdout : stderr);
    return write_all(fd, bytes);
  }
  const UniqueFd fd(::open(file.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC));
  return fd ? write_all(fd.get(), bytes) : errno;
}

/// A new file beside another one. It is removed with this object unless it has become the other
/// one.
class Beside {
 public:
  explicit Beside(const fs::path& file) {
    constexpr std::size_t kMostName = 200;  // of 255 bytes
    static std::atomic<unsigned> number{0};
    const auto name = file.filename().string().substr(0, kMostName);
    do {
      path_ = folder_of(file) / fmt::format(".{}.{}-{}", name, ::getpid(), ++number);
      fd_.reset(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    } while (!fd_ && errno == EEXIST);
  }
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  ~Beside() {
    if (fd_) ::unlink(path_.c_str());
  }

  int fd() const { return fd_.get(); }

  /// 0, or errno.
  int become(const fs::path& file) {
    if (::rename(path_.c_str(), file.c_str()) != 0) return errno;
    fd_.reset();
    return 0;
  }

 private:
  fs::path path_;
  UniqueFd fd_;
};

/// 0, or errno. The owner of another user's file is kept if this process may set it, as root may;
/// else its group, if it may set that.
int take_over(int fd, const struct stat& was) {
  constexpr auto kThisUser = static_cast<uid_t>(-1);
  bool kept = ::fchown(fd, was.st_uid, was.st_gid) == 0;
  kept = kept || ::fchown(fd, kThisUser, was.st_gid) == 0;
  const mode_t permissions = was.st_mode & 0777;
  // Those of a group are not for another group.
  return ::fchmod(fd, kept ? permissions : permissions & 0707) == 0 ? 0 : errno;
}

/// The name outlasts a power cut, too. The file is in its place already, so errors say nothing.
void sync_folder(const fs::path& folder) {
  const UniqueFd fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd) ::fsync(fd.get());
}

/// 0, or errno.
int replace(const Target& target, std::string_view bytes, Durable durable) {
  if (target.is_loop) return ELOOP;
  if (target.was && ::faccessat(AT_FDCWD, target.file.c_str(), W_OK, AT_EACCESS) != 0)
    return errno;  // a folder that may be written would allow it nevertheless
  Beside beside(target.file);
  if (beside.fd() < 0) return errno;
  int failed = target.was ? take_over(beside.fd(), *target.was) : 0;
  if (!failed) failed = write_all(beside.fd(), bytes);
  if (!failed && durable == Durable::yes && ::fsync(beside.fd()) != 0) failed = errno;
  if (!failed) failed = beside.become(target.file);
  if (!failed && durable == Durable::yes) sync_folder(folder_of(target.file));
  return failed;
}

}  // namespace

Result<void> write_whole(const fs::path& file, std::string_view bytes, Durable durable) {
  if (auto possible = check_output(file); !possible) return possible;
  const auto target = target_of(file);
  const int failed =
      target.is_in_place ? write_in_place(target.file, bytes) : replace(target, bytes, durable);
  if (failed) return cannot(file, failed);
  return {};
}

Result<void> check_writable(const fs::path& file) {
  if (auto possible = check_output(file); !possible) return possible;
  const auto target = target_of(file);
  const auto may_write = [](const fs::path& path) {
    return ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) == 0;
  };
  const bool is_there = target.was || target.is_in_place || target.is_loop;
  if ((!is_there || may_write(target.file)) &&
      (target.is_in_place || may_write(folder_of(target.file))))
    return {};
  return fail(Errc::bad_config,
              fmt::format("{}: cannot be written: {}", file.string(), inherited::reason_of(errno)));
}

Result<void> check_result_file(const fs::path& file) {
  std::error_code unknown;
  if (file.extension() == ".toml" && fs::exists(file, unknown))
    return fail(Errc::bad_config,
                file.string() + ": is a TOML file, and would be replaced; name another file");
  return check_writable(file);
}

}  // namespace handcast
