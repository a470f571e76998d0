// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"

namespace handcast {
namespace {

int complain(int exit_code, std::string_view name, const std::string& sentence) {
  std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(name.size()), name.data(),
               printable(sentence).c_str());
  return exit_code;
}

/// Standard descriptors that the caller has closed would be given to the next file or socket, into
/// which messages would be written. To read input and to write output remain errors.
void open_standard_descriptors() {
  constexpr std::array kModes{O_WRONLY, O_RDONLY, O_RDWR};
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd)
    if (::fcntl(fd, F_GETFD) < 0) (void)!::open("/dev/null", kModes[static_cast<std::size_t>(fd)]);
}

}  // namespace

int run_program(std::string_view name, int argc, char** argv,
                const std::function<int(int argc, char** argv)>& body) {
  open_standard_descriptors();
  std::signal(SIGCHLD, SIG_DFL);  // if the caller ignores it, the ends of children are not told
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of write()
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')
      return complain(kExitUsage, name, "argument " + std::to_string(i) + " is empty");
  int exit_code = kExitDone;
  try {
    exit_code = body(argc, argv);
  } catch (const std::bad_alloc&) {
    return complain(kExitRetry, name, inherited::reason_of(ENOMEM));
  } catch (const std::exception& problem) {
    return complain(kExitRetry, name, problem.what());
  }
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return exit_code;
  return complain(kExitRetry, name, "the output cannot be written: " + inherited::reason_of(errno));
}

std::filesystem::path program_folder() {
  std::error_code unknown;
  return std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path();
}

std::filesystem::path share_folder() { return program_folder().parent_path() / "share/handcast"; }

std::filesystem::path assets_folder() {
  const char* const assets = std::getenv("HANDCAST_ASSETS");
  return assets && *assets ? std::filesystem::path(assets) : share_folder();
}

}  // namespace handcast
