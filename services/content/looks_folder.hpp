// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace handcast::content {

/// Where handcast's looks are: the folder `looks` in the folder named by the environment variable
/// HANDCAST_ASSETS if it is set, else in ../share/handcast as seen from the program's folder.
std::filesystem::path looks_folder();
/// The names of the looks there, sorted.
std::vector<std::string> look_names();

}  // namespace handcast::content
