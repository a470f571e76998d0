// SPDX-License-Identifier: Apache-2.0
#include "ipc/base/program.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"

namespace handcast {
namespace {

int complain(int exit_code, std::string_view name, const std::string& sentence) {
  std::fprintf(stderr, "%.*s: %s\n", static_cast<int>(name.size()), name.data(),
               printable(sentence).c_str());
  return exit_code;
}

/// Standard descriptors that the caller has closed would be given to the next file or socket, into
/// which messages would be written.
void open_standard_descriptors() {
  for (int fd = ::open("/dev/null", O_RDWR); fd >= 0; fd = ::dup(fd))
    if (fd > STDERR_FILENO) {
      ::close(fd);
      return;
    }
}

}  // namespace

int run_program(std::string_view name, int argc, char** argv,
                const std::function<int(int argc, char** argv)>& body) {
  open_standard_descriptors();
  for (int i = 1; i < argc; ++i)
    if (*argv[i] == '\0')
      return complain(kExitUsage, name, "argument " + std::to_string(i) + " is empty");
  int exit_code = kExitDone;
  try {
    exit_code = body(argc, argv);
  } catch (const std::exception& problem) {
    return complain(kExitRetry, name, problem.what());
  }
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return exit_code;
  return complain(kExitRetry, name,
                  std::string("the output cannot be written: ") + std::strerror(errno));
}

}  // namespace handcast
