// SPDX-License-Identifier: Apache-2.0
#include "services/runtime/command_line.hpp"

#include <fmt/format.h>

#include <string_view>

namespace handcast::service {
namespace {

bool takes_value(std::string_view option) {
  return option == "--as" || option == "--config" || option == "--set";
}

Result<void> apply(CommandLine& line, std::string_view option, std::string_view value) {
  if (option == "--as")
    line.instance = value;
  else if (option == "--config")
    line.config_file = value;
  else if (value.find('=') == std::string_view::npos)
    return fail(Errc::bad_config, fmt::format("--set {}: expected path=value", value));
  else
    line.settings.emplace_back(value);
  return {};
}

}  // namespace

Result<CommandLine> parse_command_line(int argc, const char* const* argv) {
  using Task = CommandLine::Task;
  CommandLine line;
  for (int i = 1; i < argc; ++i) {
    const std::string_view option = argv[i];
    if (option == "--help" || option == "-h")
      line.task = Task::help;
    else if (option == "--version")
      line.task = Task::version;
    else if (option == "--backends")
      line.task = Task::backends;
    else if (option == "--describe")
      line.task = Task::describe;
    else if (option == "--check")
      line.task = Task::check;
    else if (!takes_value(option))
      return fail(Errc::bad_config,
                  fmt::format("unknown argument '{}'; --help lists the known ones", option));
    else if (i + 1 == argc)
      return fail(Errc::bad_config, fmt::format("{} needs a value", option));
    else if (const auto applied = apply(line, option, argv[++i]); !applied)
      return tl::make_unexpected(applied.error());
  }
  const bool reads_rig = line.task == Task::serve || line.task == Task::check;
  if (reads_rig && line.config_file.empty())
    return fail(
        Errc::bad_config,
        "--config FILE is missing; `handcast up FILE` starts this program with a whole rig");
  return line;
}

}  // namespace handcast::service
