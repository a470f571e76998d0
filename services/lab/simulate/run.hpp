// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>

#include "ipc/base/result.hpp"
#include "services/lab/simulate/options.hpp"

namespace handcast::simulate {

/// Runs `handcast simulate`: simulates the rig, prints a summary and writes the files of the
/// options. Returns why the metrics say nothing about the rig, e.g. because no hand was in sight;
/// empty if they do. Errors: bad_config (a setting, or a file that cannot be read or written), and
/// those of score().
Result<std::string> run(const Options& options);

/// The same as the body of a main(): prints the text or the error of the options, or that of the
/// run, after the name of the verb. Returns the exit code.
int run_verb(std::string_view verb, const Result<Options>& options);

}  // namespace handcast::simulate
