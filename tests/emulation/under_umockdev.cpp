// SPDX-License-Identifier: Apache-2.0
#include "tests/emulation/under_umockdev.hpp"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace handcast::test {

// umockdev_in_mock_environment() is true only while there is a testbed.
bool sees_emulated_devices() {
  const char* preloaded = std::getenv("LD_PRELOAD");
  return preloaded && std::strstr(preloaded, "umockdev") != nullptr;
}

void see_emulated_devices(char** argv) {
  if (sees_emulated_devices()) return;
  std::string program = "/proc/self/exe";
  std::array<char, 4096> path{};
  if (readlink(program.c_str(), path.data(), path.size() - 1) > 0) program = path.data();
  std::vector<char*> words{const_cast<char*>("umockdev-wrapper"), program.data()};
  for (++argv; *argv; ++argv) words.push_back(*argv);
  words.push_back(nullptr);
  execvp(words.front(), words.data());
}

}  // namespace handcast::test
