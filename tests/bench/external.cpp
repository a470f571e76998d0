// SPDX-License-Identifier: Apache-2.0
// A program that is the tracker of a rig (config/rigs/twin.toml): how long its samples take to the
// ring that the projector reads, and what a bad program does to the light.
//   bench_external [--goals FILE] [--seconds N] [--wait futex|predictive|spin]
#include <fmt/format.h>
#include <handcast.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "ipc/base/clock.hpp"
#include "ipc/base/program.hpp"
#include "ipc/client/rig_ring.hpp"
#include "ipc/client/stream.hpp"
#include "ipc/msg/guest_streams.hpp"
#include "ipc/msg/hand_poses.hpp"
#include "tests/bench/arguments.hpp"
#include "tests/bench/control_rig.hpp"
#include "tests/bench/percentiles.hpp"
#include "tests/bench/rings_transports.hpp"
#include "tests/bench/watched_frames.hpp"

namespace handcast::bench {
namespace {

using namespace std::chrono_literals;

constexpr double kRefresh_hz = 120;

/// A child that is a program of somebody else. Killed with the object.
class Program {
 public:
  explicit Program(const std::function<void()>& body) : pid_(::fork()) {
    if (pid_ != 0) return;
    body();
    ::_exit(0);
  }
  ~Program() {
    signal(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  Program(const Program&) = delete;
  void signal(int number) const { ::kill(pid_, number); }

 private:
  pid_t pid_;
};

/// Sends a hand every `pause_us`, stamped when it is sent.
void track(unsigned pause_us) {
  handcast_rig* rig = nullptr;
  if (handcast_rig_open("twin", &rig) != HANDCAST_OK) give_up(handcast_error());
  handcast_both_hands hands{};
  hands.is_there[HANDCAST_LEFT] = 1;
  for (auto& joint : hands.joints[HANDCAST_LEFT])
    joint = {{0, 0.2f, 0.01f * static_cast<float>(&joint - hands.joints[0])}, {0, 0, 0, 1}, 0.01f};
  for (;;) {
    if (pause_us > 0) ::usleep(pause_us);
    hands.joints[HANDCAST_LEFT][0].position_m[0] += 1e-6f;
    hands.time_ns = handcast_now();
    handcast_send_hands(rig, &hands);
  }
}

void track_in_python(double seconds) {
  const std::filesystem::path root(HANDCAST_BENCH_ROOT);
  const auto library = program_folder().parent_path() / "lib/libhandcast.so.0";
  ::setenv("PYTHONPATH", (root / "scripts").c_str(), 1);
  ::setenv("HANDCAST_LIBRARY", library.c_str(), 1);
  const auto program = root / "tests/bench/external_tracker.py";
  // The Python for which scripts/setup --tests installs numpy.
  ::execl("/usr/bin/python3", "python3", program.c_str(), std::to_string(seconds).c_str(), nullptr);
}

/// Writes noise over the ring of the tracker's samples, but its header.
void write_noise() {
  auto ring = client::rig_ring("twin", msg::kGuestPoses);
  if (!ring) give_up(ring.error().what);
  std::mt19937_64 random(1);
  for (;;) {
    for (std::size_t i = 4096; i + 8 <= ring->segment.size(); i += 8) {
      const auto word = random();
      std::memcpy(ring->segment.data() + i, &word, sizeof word);
    }
    ::usleep(100);
  }
}

/// From the stamp of each sample to its being in the ring that the projector reads, us.
std::vector<double> ages_us(double seconds) {
  auto poses = client::open_stream<msg::HandPoses>("twin", "pose.hands");
  if (!poses) give_up(poses.error().what);
  std::vector<double> ages;
  for (const auto until = Deadline::in(std::chrono::nanoseconds(seconds_to_ns(seconds)));
       !until.passed();)
    if (const auto sample = poses->next(Deadline::in(100ms)); sample && (*sample)->count > 0)
      ages.push_back(ns_to_us((*sample)->header.published_ns - (*sample)->header.origin_ns));
  return ages;
}

void print_ages(const char* who, const std::vector<double>& ages) {
  fmt::print("{}: {} samples; from the call to the projector's ring p50 {:.1f} us, p99 {:.0f} us\n",
             who, ages.size(), median(ages), percentile(ages, 0.99));
}

/// What a program does, and what is done to it meanwhile.
struct Case {
  const char* name;
  std::function<void()> body;
  int signal;  ///< is sent every 200 ms; SIGKILL starts it anew. 0: none
};

int missed_with(const Case& of, double seconds) {
  int missed = 0;
  for (double left_s = seconds; left_s > 0; left_s -= of.signal ? 0.2 : seconds) {
    const Program program(of.body);
    if (of.signal == SIGSTOP) {
      ::usleep(50'000);
      program.signal(SIGSTOP);
    }
    missed += watch_frames(of.signal ? 0.2 : seconds, kRefresh_hz).missed;
  }
  return missed;
}

/// `wait`: how the service of the tracker waits for the program.
int run(double seconds, const std::string& wait, const Arguments& arguments) {
  const RigFolder folder;
  const TwinRig rig(folder,
                    {"camera.rate_hz=120", "projector.rate_hz=120", "observer.enabled=false",
                     "pose.backend=external", "pose.process.wait=" + wait});
  std::vector<Goal> goals;
  {
    const Program program([] { track(10'000); });
    ::usleep(500'000);
    const auto ages = ages_us(seconds);
    print_ages("C", ages);
    goals.push_back({"a sample from C to the projector's ring, p50", median(ages), 5, "us"});
  }
  {
    const Program program([&] { track_in_python(seconds + 2); });
    ::usleep(1'500'000);
    const auto ages = ages_us(seconds);
    print_ages("Python", ages);
    goals.push_back({"a sample from Python to the projector's ring, p50", median(ages), 60, "us"});
    goals.push_back({"the same, p99", percentile(ages, 0.99), 300, "us"});
  }
  const auto good = [] { track(10'000); };
  const std::vector<Case> cases{{"killed", good, SIGKILL},
                                {"stopped", good, SIGSTOP},
                                {"that writes noise", write_noise, 0},
                                {"that sends without a pause", [] { track(0); }, 0}};
  for (const auto& each : cases) {
    const int control = missed_with({"", good, 0}, seconds);
    const int missed = missed_with(each, seconds);
    fmt::print("a program {}: {} missed refreshes of {:.0f}; a good one: {}\n", each.name, missed,
               seconds * kRefresh_hz, control);
    goals.push_back(
        {fmt::format("missed refreshes with a program {}, more than with a good one", each.name),
         100 * (missed - control) / (seconds * kRefresh_hz), 1, "%"});
  }
  const Program program(good);
  ::usleep(500'000);
  goals.push_back({"samples a second of the next program", ages_us(2).size() / 2., 80, "Hz", true});
  return arguments.report(goals);
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  handcast::bench::Arguments arguments("bench_external", "Measures a tracker of somebody else.");
  double seconds = 10;
  std::string wait = "futex";
  arguments.add("--seconds N", seconds, "How long", {1, 3600});
  arguments.add("--wait futex|predictive|spin", wait, "How the rig waits for samples");
  if (const auto code = arguments.answered(argc, argv)) return *code;
  return handcast::bench::run(seconds, wait, arguments);
}
