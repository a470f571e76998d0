// SPDX-License-Identifier: Apache-2.0
#include "supervisor/base/spawn.hpp"

#include <fcntl.h>
#include <unistd.h>

namespace handcast::supervisor {

void SpawnFiles::close_input() {
  posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (auto& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

tl::expected<pid_t, int> spawn(std::vector<std::string> command, const SpawnFiles& files) {
  const auto words = pointers_to(command);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, words[0], files.get(), nullptr, words.data(), environ);
  if (error != 0) return tl::make_unexpected(error);
  return pid;
}

}  // namespace handcast::supervisor
