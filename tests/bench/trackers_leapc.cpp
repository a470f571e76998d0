// SPDX-License-Identifier: Apache-2.0
// What our driver adds between Ultraleap's library and the ring: from the return of the poll that
// handed a frame over to the end of its publication. The library is a stand-in that makes frames at
// a fixed rate; the two trackers of a pair are measured beside one.
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "calib/calibration.hpp"
#include "config/rig.hpp"
#include "ipc/ring/writer.hpp"
#include "services/pose/pose_source.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/services/pose/leapc/fake_leapc.hpp"

using namespace handcast;
using namespace std::chrono_literals;

namespace {

constexpr int kSamples = 3000, kWarmUp = 100;
constexpr double kRate_hz = 240;

test::FakeLeap& fake() {
  void* library = ::dlopen(FAKE_LEAPC, RTLD_NOW | RTLD_LOCAL);
  if (!library) std::abort();
  return *reinterpret_cast<test::FakeLeap* (*)()>(::dlsym(library, test::kFakeLeapSymbol))();
}

struct Added {
  std::vector<double> us;  ///< by sample
  int lost = 0;            ///< frames that were not published
};

Added measure(const config::Rig& rig, const test::FakeLeap& leap) {
  auto segment = ipc::Segment::create(ipc::RingSpec::of<msg::HandPoses>("bench", 64, true)).value();
  auto ring = ipc::Writer<msg::HandPoses>::attach(std::move(segment), Deadline::now()).value();
  const auto source = pose::open_pose_source(rig, calib::reference_rig(), now_ns()).value();
  Added added;
  std::uint64_t last = 0;
  for (int i = 0; i < kSamples + kWarmUp;) {
    msg::HandPoses poses;
    if (!source->sample(poses, Deadline::in(100ms))) continue;
    ring.publish(poses);
    const double us = ns_to_us(now_ns() - leap.handed_over_ns);
    if (i++ >= kWarmUp) {
      added.us.push_back(us);
      added.lost += static_cast<int>(poses.header.frame_id - last) - 1;
    }
    last = poses.header.frame_id;
  }
  return added;
}

void print(const char* what, const Added& added) {
  fmt::print("{:24} added: median {:6.1f} us  p99 {:6.1f} us  most {:7.1f} us; {} of {} lost\n",
             what, bench::median(added.us), bench::percentile(added.us, 0.99),
             bench::percentile(added.us, 1), added.lost, kSamples);
}

}  // namespace

int main(int argc, char** argv) {
  auto& leap = fake();
  leap.rate_hz = kRate_hz;
  leap.hands = 2;
  config::Rig rig;
  rig.pose.backend = "leapc";
  rig.pose.leapc.library = FAKE_LEAPC;
  const auto alone = measure(rig, leap);
  print("leapc, two hands", alone);
  rig.pose.second = "none";
  print("with a second source", measure(rig, leap));
  const std::vector<bench::Goal> goals{{"leapc: hand-over of the library to published, p99",
                                        bench::percentile(alone.us, 0.99) * 1e-3, 0.3, "ms"}};
  bench::print_goals(goals);
  if (argc == 3 && std::string(argv[1]) == "--goals")
    return bench::write_goals(argv[2], goals) ? 0 : 1;
  return 0;
}
