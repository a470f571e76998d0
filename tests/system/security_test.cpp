// SPDX-License-Identifier: Apache-2.0
// A running rig is not accessible to other users.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <fstream>
#include <set>
#include <sstream>

#include "ipc/control/control_client.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/live_settings.hpp"
#include "ipc/msg/test_picture.hpp"
#include "tests/system/running_rig.hpp"

namespace handcast::system_test {
namespace {

using testing::IsEmpty;

class Security : public SystemTest {
 protected:
  /// The services, their supervisor and its keeper.
  std::vector<pid_t> processes_of(const Command& rig) const {
    auto processes = pids();
    processes.insert(processes.end(), {rig.pid(), rig.supervisor()});
    return processes;
  }
  /// The descriptors of all rings that a tool gets, without those that it may write to.
  std::vector<UniqueFd> rings() const {
    setenv("HANDCAST_SCOPE", scratch_.path().c_str(), 1);
    auto answer = control::ask_with_descriptors("twin", {.verb = control::Verb::rings});
    unsetenv("HANDCAST_SCOPE");
    EXPECT_TRUE(answer);
    std::vector<UniqueFd> given;
    for (std::size_t i = 0; answer && i < answer->descriptors.size(); ++i)
      if (const auto name = answer->object["rings"][i].get<std::string>();
          name != msg::kTestPictures && name != msg::kLiveSettings && !msg::is_for_guests(name))
        given.push_back(std::move(answer->descriptors[i]));
    return given;
  }
};

std::set<std::string> socket_inodes_of(pid_t pid) {
  std::set<std::string> inodes;
  std::error_code gone;
  for (const auto& entry :
       std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd", gone)) {
    const auto target = std::filesystem::read_symlink(entry.path(), gone).string();
    if (target.starts_with("socket:[")) inodes.insert(target.substr(8, target.size() - 9));
  }
  return inodes;
}

/// The lines of /proc/net/NAME with sockets of the process.
std::vector<std::string> network_sockets_of(pid_t pid, const std::string& name) {
  const auto inodes = socket_inodes_of(pid);
  std::ifstream table("/proc/net/" + name);
  std::vector<std::string> lines;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::vector<std::string> fields{std::istream_iterator<std::string>(words), {}};
    if (fields.size() > 9 && inodes.contains(fields[9])) lines.push_back(line);
  }
  return lines;
}

/// True if a line of /proc/net/tcp is a socket that listens on 127.0.0.1.
bool listens_on_this_machine(const std::string& line) {
  return line.find(": 0100007F:") != line.npos && line.find(" 00000000:0000 0A ") != line.npos;
}

TEST_F(Security, ARigOpensNoNetworkSocketButItsPageOnThisMachine) {
  const auto rig = up();
  wait_until_light();
  const auto desk = service("desk")["pid"].get<pid_t>();
  bool has_sockets = false;
  for (const auto pid : processes_of(*rig)) {
    has_sockets = has_sockets || !socket_inodes_of(pid).empty();
    for (const auto* name : {"tcp", "tcp6", "udp", "udp6", "raw", "raw6"})
      for (const auto& line : network_sockets_of(pid, name))
        EXPECT_TRUE(pid == desk && std::string_view(name) == "tcp" && listens_on_this_machine(line))
            << name << " of process " << pid << ": " << line;
  }
  EXPECT_TRUE(has_sockets);  // at least the control socket
}

/// A free port of the loopback interface.
int free_port() {
  const UniqueFd socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), size), 0);
  getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

TEST_F(Security, TheFiguresForPrometheusAreServedToThisMachineAlone) {
  if (!std::filesystem::exists(program_folder() / "handcast-exporter"))
    GTEST_SKIP() << "handcast-exporter has not been built";
  const auto rig = up({"--set", "supervisor.metrics_port=" + std::to_string(free_port())});
  wait_until_light();
  ASSERT_TRUE(eventually([this] { return service("exporter")["state"] == "ready"; }));
  const auto exporter = service("exporter")["pid"].get<pid_t>();
  const auto sockets = network_sockets_of(exporter, "tcp");
  EXPECT_FALSE(sockets.empty());
  for (const auto& line : sockets)
    EXPECT_NE(line.find(" 0100007F:"), std::string::npos) << line;  // 127.0.0.1
  EXPECT_THAT(network_sockets_of(exporter, "tcp6"), IsEmpty());
}

TEST_F(Security, RingsHaveNoNameInTheFileSystem) {
  const auto rig = up();
  wait_until_light();
  for (const auto& name : traces()) EXPECT_EQ(name.find("/dev/shm"), std::string::npos) << name;
  for (const auto& ring : rings()) {
    struct stat status {};
    ASSERT_EQ(fstat(ring.get(), &status), 0);
    EXPECT_EQ(status.st_nlink, 0);
  }
}

TEST_F(Security, AToolGetsEveryRingToReadAndItsSizeCannotChange) {
  const auto rig = up();
  wait_until_light();
  const auto given = rings();
  EXPECT_GE(given.size(), 4 + kServices.size());  // streams and stage marks
  for (const auto& ring : given) {
    EXPECT_EQ(fcntl(ring.get(), F_GETFL) & O_ACCMODE, O_RDONLY);
    EXPECT_EQ(mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, ring.get(), 0), MAP_FAILED);
    EXPECT_EQ(fcntl(ring.get(), F_GET_SEALS) & (F_SEAL_SHRINK | F_SEAL_GROW),
              F_SEAL_SHRINK | F_SEAL_GROW);
    void* bytes = mmap(nullptr, 4096, PROT_READ, MAP_SHARED, ring.get(), 0);
    ASSERT_NE(bytes, MAP_FAILED);
    EXPECT_NE(mprotect(bytes, 4096, PROT_READ | PROT_WRITE), 0);
    munmap(bytes, 4096);
  }
  expect_more_light();
}

}  // namespace
}  // namespace handcast::system_test
