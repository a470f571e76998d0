// SPDX-License-Identifier: Apache-2.0
// handcast init: asks what a rig is made of and writes its rig file.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <iterator>
#include <vector>

#include "config/measured.hpp"
#include "config/rig.hpp"
#include "ipc/base/command_line.hpp"
#include "ipc/base/exit_code.hpp"
#include "ipc/base/log.hpp"
#include "ipc/base/program.hpp"
#include "ipc/base/write_whole.hpp"
#include "services/tools/devices/attached.hpp"
#include "services/tools/init/interview.hpp"
#include "services/tools/init/options.hpp"
#include "services/tools/init/report.hpp"
#include "services/tools/init/rig_text.hpp"

namespace handcast::init {
namespace {

int complain(int exit_code, const std::string& sentence) {
  fmt::print(stderr, "handcast init: {}\n", printable(sentence));
  return exit_code;
}

/// Refuses to replace a file by accident.
Result<void> check_file(const Options& options) {
  std::error_code unknown;
  for (const auto& file : {options.file, config::measured_file_of(options.file)})
    if (!options.force && std::filesystem::is_regular_file(file, unknown))
      return fail(Errc::bad_config, fmt::format("'{}' exists; --force replaces it, or name another "
                                                "file: handcast init FILE",
                                                file.string()));
  return check_writable(options.file);
}

Result<void> write(const Options& options, const std::string& text) {
  // The file may have come while a person answered.
  if (auto possible = check_file(options); !possible) return possible;
  return write_whole(options.file, text).map([&] {
    // Measured values would win over those of the new file.
    std::error_code absent;
    std::filesystem::remove(config::measured_file_of(options.file), absent);
  });
}

/// What is attached. The search for cameras takes a second, so it is left out where the answer is
/// known. The twin's camera sees no hand in front of a real tracker.
std::vector<devices::Attached> look(const Flags& flags) {
  if (flags.camera != "twin") return devices::all_attached();
  auto attached = devices::attached_of(devices::Kind::display);
  auto controllers = devices::attached_of(devices::Kind::controller);
  std::move(controllers.begin(), controllers.end(), std::back_inserter(attached));
  return attached;
}

/// Looks, asks and writes. Returns what to tell the person.
Result<std::string> make_rig(const Options& options) {
  if (auto possible = check_file(options); !possible) return tl::make_unexpected(possible.error());
  const auto attached = look(options.flags);
  const bool asks = !options.yes && isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1;
  fmt::print(stderr, "{}", printable(troubles_of(attached)));
  Prompt prompt(std::cin, std::cerr);
  const auto plan = interview(attached, options, asks ? &prompt : nullptr);
  if (!plan) return tl::make_unexpected(plan.error());
  const auto text = rig_text(*plan, options.file);
  // A file that `handcast up` would refuse is not written.
  if (const auto rig = config::parse_rig(text, options.file); !rig)
    return tl::make_unexpected(rig.error());
  return write(options, text).map([&] { return report(*plan, options.file); });
}

int run_verb(int argc, char** argv) {
  const auto options = parse(argc, argv);
  const auto text = options.map([](const auto& each) { return each.text; });
  if (const auto code = answered("handcast init", text)) return *code;
  const auto done = make_rig(*options);
  if (!done) return complain(exit_code_of(done.error()), done.error().what);
  fmt::print("{}", printable(*done));
  return kExitDone;
}

}  // namespace
}  // namespace handcast::init

int main(int argc, char** argv) {
  return handcast::run_program("handcast init", argc, argv, handcast::init::run_verb);
}
