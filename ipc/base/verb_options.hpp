// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "ipc/base/result.hpp"
#include "ipc/base/version.hpp"

namespace handcast {

/// Parses the command line of a program, whose options `app` has; adds --version. Returns the text
/// that --help or --version asks for; "" if the program shall run. Errors: bad_config.
inline Result<std::string> parse_options(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", fmt::format("{} {}\n", app.get_name(), version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return app.help();
  } catch (const CLI::CallForVersion& call) {
    return std::string(call.what());
  } catch (const CLI::ParseError& problem) {
    return fail(Errc::bad_config, problem.what());
  }
  return std::string();
}

}  // namespace handcast
