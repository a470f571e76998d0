// SPDX-License-Identifier: Apache-2.0
#include "services/tools/calibrate/programs.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/program.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/daemon/stop_signal.hpp"
#include "ipc/msg/camera_frame.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

/// In the child: only calls that are safe after a fork of a program with threads.
[[noreturn]] void become(char* const* arguments, const char* log, pid_t parent) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  const int output = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  const bool in_place = nothing >= 0 && output >= 0 && ::dup2(nothing, STDIN_FILENO) >= 0 &&
                        ::dup2(output, STDOUT_FILENO) >= 0 && ::dup2(output, STDERR_FILENO) >= 0;
  for (const int fd : {nothing, output})
    if (fd > STDERR_FILENO) ::close(fd);
  ::setpgid(0, 0);
  // A session that is killed must not leave a rig that casts light.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (in_place && ::getppid() == parent) ::execv(arguments[0], arguments);
  ::_exit(127);
}

/// Why a program ended, as it says itself after its name; else the last line of its log that is not
/// empty.
std::string last_words(const std::filesystem::path& log, std::string_view name) {
  std::ifstream file(log);
  std::string line, last = "it said nothing", reason;
  while (std::getline(file, line)) {
    if (line.starts_with(name)) reason = line.substr(name.size());
    if (!line.empty()) last = line;
  }
  return reason.empty() ? last : reason;
}

/// Starts a program whose output goes to `log`, in a process group of its own: Ctrl-C reaches only
/// this program, which then stops the rig. It ends with the thread that calls this. -1 if it cannot
/// be started.
pid_t spawn(std::vector<std::string> words, const std::filesystem::path& log) {
  if (::access(words.front().c_str(), X_OK) != 0) return -1;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t self = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) become(arguments.data(), log.c_str(), self);
  return child;
}

}  // namespace

Result<void> not_stopped() {
  if (!daemon::stop_requested()) return {};
  return fail(Errc::unavailable, "stopped; the next call goes on with this step");
}

Result<OwnRig> OwnRig::start(const std::filesystem::path& rig_file, const std::string& name,
                             const std::vector<std::string>& settings,
                             const std::filesystem::path& log) {
  std::vector<std::string> words{program_folder() / "handcast", "up", rig_file.string(),
                                 "--no-keeper"};
  for (const auto& setting : settings) words.insert(words.end(), {"--set", setting});
  OwnRig rig(spawn(std::move(words), log), log);
  if (rig.child_ < 0)
    return fail(Errc::unavailable,
                "`handcast up` cannot be started; is `handcast` in the folder "
                "of its other programs?");
  if (auto seen = rig.wait_for_images(name); !seen) return tl::make_unexpected(seen.error());
  return rig;
}

Result<OwnRig> OwnRig::beside(const std::string& name) {
  if (auto streams = client::stream_names(name); !streams)
    return tl::make_unexpected(streams.error());
  OwnRig rig(0, {});
  rig.is_other_ = true;
  return rig;
}

OwnRig::OwnRig(OwnRig&& other) noexcept
    : child_(std::exchange(other.child_, 0)),
      is_other_(other.is_other_),
      log_(std::move(other.log_)) {}

void OwnRig::stop() {
  const auto child = std::exchange(child_, 0);
  if (child <= 0) return;
  ::kill(child, SIGTERM);
  while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;
}

Result<void> OwnRig::check() {
  if (auto on = not_stopped(); !on) return on;
  if (is_other_) return {};  // the streams tell if it ends
  if (::waitpid(child_, nullptr, WNOHANG) == 0) return {};
  child_ = 0;
  return fail(Errc::unavailable, "the rig has ended: " + last_words(log_, "handcast: "));
}

Result<void> OwnRig::wait_for_images(const std::string& name) {
  constexpr auto kLongest = 30s;
  for (const auto end = Deadline::in(kLongest); !end.passed();) {
    if (auto runs = check(); !runs) return runs;
    if (auto frames = client::open_stream<msg::CameraFrame>(name, "camera.frames"))
      if (frames->latest(Deadline::in(500ms))) return {};
    sleep_until_ns(now_ns() + to_ns(100ms));
  }
  return fail(Errc::timeout, fmt::format("the camera has sent no image in {} s; `handcast doctor` "
                                         "may tell why, and {} what the rig said",
                                         kLongest.count(), log_.string()));
}

Result<void> write_page(const std::filesystem::path& folder) {
  const auto log = folder / "page.log";
  const pid_t child =
      spawn({program_folder() / "handcast-calibration-page", "--folder", folder.string()}, log);
  if (child < 0) return fail(Errc::unavailable, "handcast-calibration-page is not installed");
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (status == 0) return {};
  return fail(Errc::unavailable, last_words(log, "handcast calibration-page: "));
}

}  // namespace handcast::calibrate
