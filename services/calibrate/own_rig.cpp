// SPDX-License-Identifier: Apache-2.0
#include "services/calibrate/own_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <fstream>
#include <string_view>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/camera_frame.hpp"
#include "services/calibrate/keys.hpp"

namespace handcast::calibrate {
namespace {

using namespace std::chrono_literals;

/// Starts a program whose output goes to `log`, in a process group of its own: Ctrl-C reaches only
/// this program, which then stops the rig. -1 if it cannot be started.
pid_t spawn(std::vector<std::string> words, const std::filesystem::path& log) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0644);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t child = -1;
  const int failed =
      posix_spawn(&child, arguments.front(), &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return failed ? -1 : child;
}

}  // namespace

Result<OwnRig> OwnRig::start(const std::filesystem::path& rig_file, const std::string& name,
                             const std::vector<std::string>& settings,
                             const std::filesystem::path& log) {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  std::vector<std::string> words{self.parent_path() / "handcast", "up", rig_file.string(),
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
  return fail(Errc::unavailable, "the rig has ended: " + last_words());
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

/// Why the rig ended, as it says itself; else the last line of its log that is not empty.
std::string OwnRig::last_words() const {
  constexpr std::string_view kReason = "handcast: ";
  std::ifstream file(log_);
  std::string line, last = "it said nothing", reason;
  while (std::getline(file, line)) {
    if (line.starts_with(kReason)) reason = line.substr(kReason.size());
    if (!line.empty()) last = line;
  }
  return reason.empty() ? last : reason;
}

}  // namespace handcast::calibrate
