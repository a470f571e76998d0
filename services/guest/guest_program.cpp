// SPDX-License-Identifier: Apache-2.0
#include "services/guest/guest_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <sstream>
#include <vector>

#include "ipc/base/inherited.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/quote.hpp"
#include "ipc/base/wait_status.hpp"
#include "ipc/daemon/contract.hpp"

namespace handcast::guest {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kTurn_ns = 20'000'000;

struct Pipe {
  UniqueFd read, write;
};

Result<Pipe> open_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) == 0) return Pipe{UniqueFd(ends[0]), UniqueFd(ends[1])};
  return fail(Errc::unavailable, "a pipe to a program: " + inherited::reason_of(errno));
}

/// Python finds handcast.py, which is installed with the programs.
void add_python_folder() {
  const auto folder = (share_folder() / "python").string();
  const char* const before = getenv("PYTHONPATH");
  setenv("PYTHONPATH", before ? (folder + ":" + before).c_str() : folder.c_str(), 1);
  setenv("PYTHONUNBUFFERED", "1", 0);  // what it prints is seen when it is printed
}

/// What the child does. It tells by `fault` why it could not become the program.
[[noreturn]] void become(const config::External& settings, int output, int fault) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);
  const sched_param normal{};
  sched_setscheduler(0, SCHED_OTHER, &normal);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(SIGPIPE, SIG_DFL);
  for (const int number : {SIGINT, SIGTERM}) signal(number, SIG_DFL);
  dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
  for (const int standard : {STDOUT_FILENO, STDERR_FILENO}) dup2(output, standard);
  close_range(3, static_cast<unsigned>(fault) - 1, 0);
  close_range(static_cast<unsigned>(fault) + 1, ~0U, 0);
  for (const auto* variable : {daemon::kRingsVariable, daemon::kReadyVariable,
                               daemon::kStandbyVariable, daemon::kStateVariable})
    unsetenv(variable);
  add_python_folder();
  std::vector<char*> words;
  words.reserve(settings.command.size() + 1);
  for (const auto& word : settings.command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  if (settings.folder.empty() || chdir(settings.folder.c_str()) == 0)
    execvp(words[0], words.data());
  const int error = errno;
  (void)!write(fault, &error, sizeof error);
  _exit(EXIT_FAILURE);
}

/// Kills a program and all that it has started and left: a worker that it has forked would hold its
/// ring, to which the next program then could not send.
void kill_group(pid_t pid) { kill(-pid, SIGKILL); }

bool is_program(const fs::path& file) {
  std::error_code absent;
  return fs::is_regular_file(file, absent) && access(file.c_str(), X_OK) == 0;
}

}  // namespace

Result<GuestProgram> GuestProgram::start(const config::External& settings) {
  auto output = open_pipe();
  auto fault = open_pipe();
  if (!output || !fault) return tl::make_unexpected(output ? fault.error() : output.error());
  const auto pid = fork();
  if (pid < 0) return fail(Errc::unavailable, "a program: " + inherited::reason_of(errno));
  if (pid == 0) become(settings, output->write.get(), fault->write.get());
  fcntl(output->read.get(), F_SETFL, O_NONBLOCK);
  GuestProgram program(pid, std::move(output->read));
  fault->write.reset();
  int error = 0;
  if (read(fault->read.get(), &error, sizeof error) <= 0) return program;
  return fail(Errc::unavailable,
              fmt::format("{} cannot be started in {}: {}", quote(settings.command.front()),
                          settings.folder, inherited::reason_of(error)));
}

GuestProgram::GuestProgram(pid_t pid, UniqueFd output)
    : pid_(pid),
      output_(std::move(output)),
      lines_([](std::string_view line) { log::info("{}", printable(line)); }) {}

GuestProgram::~GuestProgram() { stop(Deadline::now()); }

bool GuestProgram::read_some() {
  constexpr int kMostReads = 4;
  std::array<char, 65536> bytes;
  for (int i = 0; i < kMostReads; ++i) {
    const auto count = output_ ? read(output_.get(), bytes.data(), bytes.size()) : 0;
    if (count == 0) output_.reset();
    if (count <= 0) return false;
    lines_.add({bytes.data(), static_cast<std::size_t>(count)}, now_ns());
  }
  return true;
}

void GuestProgram::pass_on_output(Deadline deadline) {
  while (!deadline.passed()) {
    const auto left_ns = std::clamp<std::int64_t>(deadline.time_ns() - now_ns(), 0, kTurn_ns);
    pollfd come{.fd = output_ ? output_.get() : -1, .events = POLLIN, .revents = 0};
    if (poll(&come, 1, static_cast<int>(ns_to_ms(left_ns)) + 1) < 0) return;
    lines_.add({}, now_ns());
    if (come.revents == 0) continue;
    if (read_some()) sleep_until_ns(std::min(now_ns() + kTurn_ns, deadline.time_ns()));
  }
}

std::optional<std::string> GuestProgram::end() {
  int status = 0;
  if (pid_ <= 0 || waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  kill_group(std::exchange(pid_, -1));
  read_some();
  lines_.finish(now_ns());
  const auto last = last_line();
  return last.empty() ? describe_end(status) : fmt::format("{}: {}", describe_end(status), last);
}

std::string GuestProgram::last_line() const { return printable(lines_.last()); }

void GuestProgram::stop(Deadline deadline) {
  if (pid_ <= 0) return;
  kill(-pid_, SIGTERM);
  while (!end() && !deadline.passed()) sleep_until_ns(now_ns() + kTurn_ns / 4);
  if (pid_ <= 0) return;
  kill_group(pid_);
  waitpid(std::exchange(pid_, -1), nullptr, 0);
  read_some();
  lines_.finish(now_ns());
}

Result<void> check_command(const config::External& settings) {
  if (settings.command.empty()) return {};
  const auto& program = settings.command.front();
  std::error_code absent;
  if (!settings.folder.empty() && !fs::is_directory(settings.folder, absent))
    return fail(Errc::bad_config, "there is no folder " + quote(settings.folder));
  const bool has_folder = program.find('/') != std::string::npos;
  bool found = has_folder && is_program(fs::path(settings.folder) / program);
  const char* const path = getenv("PATH");
  std::istringstream folders(path && !has_folder ? path : "");
  for (std::string folder; !found && std::getline(folders, folder, ':');)
    found = is_program(fs::path(folder) / program);
  if (found) return {};
  return fail(
      Errc::bad_config,
      fmt::format("there is no program {}{}", quote(program),
                  has_folder ? " in " + settings.folder
                             : "; one in the folder of the rig file is named with ./ before it"));
}

}  // namespace handcast::guest
