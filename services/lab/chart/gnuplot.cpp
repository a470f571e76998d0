// SPDX-License-Identifier: Apache-2.0
#include "services/lab/chart/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace handcast::chart {
namespace {

/// A temporary folder, which the destructor removes. The path is empty if it cannot be created.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "handcast-chart-XXXXXX").string();
    if (::mkdtemp(name.data())) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The last line of gnuplot's error output, which is the message. The source line and a caret below
/// the fault precede it.
std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \t\n");
  if (end == text.npos) return "it printed no message";
  const auto begin = text.rfind('\n', end);
  return text.substr(begin == text.npos ? 0 : begin + 1,
                     end - (begin == text.npos ? 0 : begin + 1) + 1);
}

/// Runs the program and returns its status as of waitpid(). Errors: bad_config (it cannot start).
Result<int> run(const std::string& program, const std::filesystem::path& script,
                const std::string& out, const std::string& complaints) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, 1, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&files, 2, complaints.c_str(), O_WRONLY | O_CREAT, 0600);
  std::string words[] = {program, "-d", script.string()};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, program.c_str(), &files, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed)
    return fail(
        Errc::bad_config,
        fmt::format(
            "charts are drawn by {}, which cannot be started: {}; scripts/setup installs it",
            program, std::strerror(failed)));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

}  // namespace

Result<std::string> run_gnuplot(const std::string& script, const std::string& program) {
  const TemporaryFolder folder;
  if (folder.path().empty())
    return fail(Errc::unavailable,
                fmt::format("cannot create a temporary folder: {}", std::strerror(errno)));
  const auto script_file = folder.path() / "script.gp", out = folder.path() / "out.svg",
             complaints = folder.path() / "complaints";
  std::ofstream(script_file, std::ios::binary) << script;
  const auto status = run(program, script_file, out, complaints);
  if (!status) return tl::make_unexpected(status.error());
  auto svg = text_of(out);
  const bool whole = svg.find("</svg>") != svg.npos;
  if (*status != 0 || !whole)
    return fail(Errc::bad_data,
                fmt::format("{} failed: {}", program, last_line(text_of(complaints))));
  return svg;
}

}  // namespace handcast::chart
