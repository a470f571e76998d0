// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace handcast {

/// Runs the body of a main() and returns its exit code. SIGXFSZ is ignored from here on, and
/// SIGCHLD is not, whatever the caller wants. An exception, or output that cannot be written (a
/// full disk), is a sentence on stderr and kExitRetry; an empty argument, which a script passes
/// when a variable is unset, is one and kExitUsage. `name`: of the program, for the sentence.
int run_program(std::string_view name, int argc, char** argv,
                const std::function<int(int argc, char** argv)>& body);

/// The folder of this program; empty if it is not known.
std::filesystem::path program_folder();
/// What was built or installed beside it: PREFIX/share/handcast of PREFIX/bin.
std::filesystem::path share_folder();
/// HANDCAST_ASSETS if it is set, else share_folder().
std::filesystem::path assets_folder();

}  // namespace handcast
