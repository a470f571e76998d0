// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "ipc/base/unique_fd.hpp"

namespace handcast::test {

/// Two computers, as far as the network and the clock go: network namespaces with a cable between
/// them (veth), and a time namespace, whose CLOCK_MONOTONIC shows more. The object is for one
/// thread, of which children inherit the namespace that it is in. For both computers it restores
/// what was before.
class TwoComputers {
 public:
  static constexpr const char *kNear = "10.77.1.1", *kFar = "10.77.1.2";
  static constexpr int kAhead_s = 1000;  ///< the far clock, if has_clocks()

  TwoComputers() : outside_(of_this_thread("net")), time_(of_this_thread("time_for_children")) {
    if (::unshare(CLONE_NEWNET) != 0) return;
    near_ = of_this_thread("net");
    if (::unshare(CLONE_NEWNET) == 0) {
      far_ = of_this_thread("net");
      is_connected_ =
          run(fmt::format("ip link add far0 type veth peer name near0 netns /proc/{}/fd/{}",
                          ::getpid(), near_.get())) &&
          set_up("far0", kFar);
      enter(near_);
      is_connected_ = is_connected_ && set_up("near0", kNear);
    }
    enter(outside_);
    if (!is_connected_) near_.reset(), far_.reset();
  }
  ~TwoComputers() {
    enter(outside_);
    if (has_clocks_) ::setns(time_.get(), CLONE_NEWTIME);
  }
  TwoComputers(const TwoComputers&) = delete;

  /// Without a cable both are this computer, with its interface "lo".
  bool is_connected() const { return is_connected_; }
  static constexpr const char* kWhyNot =
      "this user may not make network namespaces, or the "
      "kernel has no virtual cables";

  /// Does something on one of them.
  /// @{
  template <class Work>
  auto in_near(const Work& work) const {
    const Inside inside(*this, near_);
    return work();
  }
  template <class Work>
  auto in_far(const Work& work) const {
    const Inside inside(*this, far_);
    return work();
  }
  /// @}

  /// From now on, children have the far clock. Returns false if this user may not make one.
  bool set_far_clock() {
    if (::unshare(CLONE_NEWTIME) != 0) return false;
    std::ofstream("/proc/self/timens_offsets") << fmt::format("monotonic {} 0\n", kAhead_s);
    return has_clocks_ = true;
  }

  /// Pulls the cable out, and plugs it in.
  void connect(bool is_on) const {
    in_near([&] { return run(fmt::format("ip link set near0 {}", is_on ? "up" : "down")); });
  }
  /// What the cable does to messages in both directions ("delay 20ms loss 10%"). Returns false if
  /// the kernel has no netem.
  bool disturb(const std::string& netem) const {
    const auto set = [&](const char* device) {
      return run(fmt::format("tc qdisc replace dev {} root netem {}", device, netem));
    };
    return in_near([&] { return set("near0"); }) && in_far([&] { return set("far0"); });
  }

 private:
  struct Inside {
    Inside(const TwoComputers& both, const UniqueFd& of) : computers(both) {
      if (of.get() >= 0) both.enter(of);
    }
    ~Inside() { computers.enter(computers.outside_); }
    const TwoComputers& computers;
  };

  static UniqueFd of_this_thread(const char* kind) {
    return UniqueFd(
        ::open(fmt::format("/proc/thread-self/ns/{}", kind).c_str(), O_RDONLY | O_CLOEXEC));
  }
  static bool run(const std::string& command) {
    return std::system((command + " 2>/dev/null >/dev/null").c_str()) == 0;
  }
  static bool set_up(const char* device, const char* address) {
    return run(fmt::format("ip link set lo up && ip addr add {}/24 dev {} && ip link set {} up",
                           address, device, device));
  }
  void enter(const UniqueFd& space) const { ::setns(space.get(), CLONE_NEWNET); }

  UniqueFd outside_, time_, near_, far_;
  bool is_connected_ = false, has_clocks_ = false;
};

}  // namespace handcast::test
