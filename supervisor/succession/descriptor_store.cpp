// SPDX-License-Identifier: Apache-2.0
#include "supervisor/succession/descriptor_store.hpp"

#include <fmt/format.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "ipc/base/log.hpp"
#include "supervisor/base/process.hpp"

namespace handcast::supervisor {
namespace {

/// Whether the kernel hides the descriptors of a process from its user's processes without
/// capabilities. It does not hide them from the superuser's.
bool hides_descriptors(pid_t pid) {
  if (getuid() == 0) return false;
  const std::filesystem::path folder = fmt::format("/proc/{}", pid);
  struct stat status {};
  if (stat(folder.c_str(), &status) != 0) return false;
  const auto capabilities = status_line(folder, "CapPrm");
  return status.st_uid != getuid() || capabilities.find_first_not_of('0') != std::string::npos;
}

std::vector<std::uint64_t> inodes_of(const ChildSpec& spec) {
  std::vector<std::uint64_t> inodes;
  for (const auto& [stream, fd] : spec.rings) inodes.push_back(inode_of(fd));
  for (const int fd : spec.kept_open) inodes.push_back(inode_of(fd));
  return inodes;
}

}  // namespace

void DescriptorStore::keep(ChildSpec spec, const std::vector<pid_t>& services) {
  if (std::ranges::none_of(services, hides_descriptors)) return close();
  auto inodes = inodes_of(spec);
  if (process_ && !process_->has_ended() && inodes == inodes_) return;
  spec.arguments = {kHoldOption};
  auto next = Child::spawn(spec);
  if (!next) {
    if (!std::exchange(has_failed_, true))
      log::warning("a successor of the supervisor would start services with capabilities anew: {}",
                   next.error().what);
    return;
  }
  process_ = std::make_unique<Child>(std::move(*next));  // then the one before ends
  inodes_ = std::move(inodes);
}

void hold_descriptors() {
  prctl(PR_SET_NAME, "handcast-store");
  prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> none{};
  syscall(SYS_capset, &header, none.data());
  prctl(PR_SET_DUMPABLE, 1);
  for (;;) pause();
}

}  // namespace handcast::supervisor
