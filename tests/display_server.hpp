// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/scratch.hpp"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace handcast::test {

#ifdef __SANITIZE_ADDRESS__
/// Mesa's driver leaks its options for each connection to a server. It is unloaded afterwards, so
/// its leaks cannot be told by their place.
using IgnoreLeaks = __lsan::ScopedDisabler;
#else
struct IgnoreLeaks {};
#endif

/// An X server whose monitors exist only in memory (Xorg with the driver dummy): DUMMY0 of 1024 x
/// 768, which is primary, and DUMMY1 of 800 x 600 to its right. $DISPLAY names it while it lives.
class DisplayServer {
 public:
  DisplayServer() { start(); }
  ~DisplayServer() {
    end();
    ::unsetenv("DISPLAY");
  }
  DisplayServer(const DisplayServer&) = delete;
  DisplayServer& operator=(const DisplayServer&) = delete;

  /// False if there is no such server on this machine; why() says why.
  explicit operator bool() const { return works_; }
  static std::string why() {
    return "no X server: Xorg with the driver dummy, and xrandr, are needed (scripts/setup "
           "--tests), and it must be started by root";
  }
  const std::string& name() const { return name_; }

  /// Plugs DUMMY1 in and out. Its state changes when it is asked for, as by `xrandr --query`.
  /// @{
  bool plug_in() const {
    return xrandr("--output DUMMY1 --mode 800x600 --right-of DUMMY0") && xrandr("--query");
  }
  bool unplug() const { return xrandr("--output DUMMY1 --off") && xrandr("--query"); }
  /// @}

  /// Starts the server again under its name after end().
  bool start() {
    std::array<int, 2> number{};
    if (pipe(number.data()) != 0) return false;
    pid_ = fork();
    if (pid_ == 0) run(number[1]);
    close(number[1]);
    std::array<char, 16> text{};
    pollfd answer{number[0], POLLIN, 0};
    const bool answers = poll(&answer, 1, kPatience_ms) == 1;
    const auto length = answers ? read(number[0], text.data(), text.size()) : 0;
    close(number[0]);
    if (length <= 0) return false;
    ::setenv("DISPLAY", name_.c_str(), 1);
    works_ = xrandr("--addmode DUMMY1 800x600") && plug_in();
    return works_;
  }
  /// Kills the server.
  void end() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
    pid_ = -1;
  }

 private:
  static constexpr int kPatience_ms = 20'000;

  /// Becomes the server, which writes the number of its display to `number`.
  [[noreturn]] void run(int number) const {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const std::string log = scratch_.path() / "log",
                      file = std::filesystem::absolute("tests/dummy_display.conf"),
                      out = scratch_.path() / "out", descriptor = fmt::format("{}", number);
    if (std::freopen(out.c_str(), "w", stderr) == nullptr) _exit(1);
    std::vector<const char*> words{"Xorg",        "-displayfd", descriptor.c_str(), "-config",
                                   file.c_str(),  "-logfile",   log.c_str(),        "-noreset",
                                   "-novtswitch", "-sharevts",  "-nolisten",        "tcp"};
    words.push_back(name_.c_str());
    words.push_back(nullptr);
    execv("/usr/lib/xorg/Xorg", const_cast<char* const*>(words.data()));
    _exit(1);
  }

  static bool xrandr(const std::string& arguments) {
    return std::system(("xrandr " + arguments + " >/dev/null 2>&1").c_str()) == 0;
  }

  [[no_unique_address]] IgnoreLeaks ignore_leaks_;
  Scratch scratch_;
  pid_t pid_ = -1;
  /// Its own number: the next free one could be taken by another test while this server is dead.
  std::string name_ = fmt::format(":{}", 1000 + getpid() % 50'000);
  bool works_ = false;
};

}  // namespace handcast::test
