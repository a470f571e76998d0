// SPDX-License-Identifier: Apache-2.0
// What the always-on traces cost: the services that mark their stages, the supervisor that records
// them. On one core, in real time.
//   bench_traces [--goals FILE] [--seconds N]
#include <fcntl.h>
#include <fmt/format.h>
#include <time.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "renderer/pipeline/stage_clock.hpp"
#include "services/runtime/context.hpp"
#include "supervisor/look/trace/latency_table.hpp"
#include "supervisor/look/trace/perfetto.hpp"
#include "supervisor/record/history.hpp"
#include "supervisor/record/recorder.hpp"
#include "tests/bench/goals.hpp"
#include "tests/bench/percentiles.hpp"

namespace handcast::bench {
namespace {

using msg::Stage;

struct Marker {
  const char* service;
  double rate_hz;
  std::vector<Stage> stages;
};

/// A rig at full rate.
const std::array kMarkers{Marker{"camera", 525, {Stage::capture}},
                          Marker{"pose", 110, {Stage::sample}},
                          Marker{"landmarks", 78, {Stage::detect}},
                          Marker{"projector",
                                 946,
                                 {Stage::predict, Stage::skin, Stage::correct, Stage::mask,
                                  Stage::draw, Stage::warp, Stage::fill, Stage::gpu_draw}}};

constexpr int kMarkSlots = 254;  ///< as in supervisor/spec/service_spec.cpp
constexpr std::int64_t kPoll_ns = 50'000'000;

ipc::Segment marks_ring(const std::string& service) {
  return service::must(ipc::Segment::create(
      ipc::RingSpec::of<msg::StageMarks>("marks." + service, kMarkSlots, true)));
}

/// A service's own half of the marks: the clock's readings, the list, its publication.
struct MarkingService {
  MarkingService(const Marker& marker, const ipc::Segment& ring) : marker_(marker) {
    setenv("HANDCAST_RINGS", fmt::format("marks.{}={}", marker.service, ring.fd()).c_str(), 1);
    context_ = std::make_unique<service::Context>(
        daemon::ServiceDescription{.name = marker.service}, config::Rig{}, calib::reference_rig());
  }
  void mark_a_frame() {
    clock_.start();
    for (const auto stage : marker_.stages) clock_.mark(stage);
    clock_.finish();
    context_->mark({++frames_, now_ns(), 0}, clock_.marks());
  }

 private:
  const Marker& marker_;
  std::unique_ptr<service::Context> context_;
  renderer::StageClock clock_;
  std::uint64_t frames_ = 0;
};

/// What one frame's marks cost, µs, at the service's own rate: between two frames the caches
/// forget.
double frame_cost_us(const Marker& marker, double seconds) {
  const auto ring = marks_ring(marker.service);
  MarkingService service(marker, ring);
  std::vector<double> costs_us;
  const auto period_ns = seconds_to_ns(1 / marker.rate_hz);
  std::int64_t next_ns = now_ns();
  for (const auto end_ns = next_ns + seconds_to_ns(seconds); next_ns < end_ns;
       next_ns += period_ns) {
    sleep_until_ns(next_ns);
    costs_us.push_back(timed_us([&] { service.mark_a_frame(); }));
  }
  return median(costs_us);
}

std::int64_t cpu_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return time.tv_sec * 1'000'000'000 + time.tv_nsec;
}

/// A whole rig's services in one thread: each publishes when it is due.
void publish_until(const std::atomic<bool>& done, std::vector<MarkingService>& services) {
  std::array<std::int64_t, kMarkers.size()> next_ns;
  next_ns.fill(now_ns());
  while (!done) {
    const auto due = std::min_element(next_ns.begin(), next_ns.end()) - next_ns.begin();
    sleep_until_ns(next_ns[due]);
    services[due].mark_a_frame();
    next_ns[due] += seconds_to_ns(1 / kMarkers[due].rate_hz);
  }
}

struct Recording {
  double cpu_share = 0;  ///< of one core
  double poll_us = 0;
  std::uint64_t frames = 0, missed = 0;
};

/// The supervisor's half: a recorder that looks every 50 ms at what four services publish
/// meanwhile.
Recording record(double seconds, supervisor::Recorder& recorder) {
  std::vector<ipc::Segment> rings;
  std::vector<MarkingService> services;
  for (const auto& marker : kMarkers) {
    rings.push_back(marks_ring(marker.service));
    services.emplace_back(marker, rings.back());
    if (!recorder.follow(marker.service, rings.back().fd())) std::abort();
  }
  std::atomic<bool> done = false;
  std::thread publisher([&] { publish_until(done, services); });
  std::vector<double> polls_us;
  const auto begin_ns = now_ns(), begin_cpu_ns = cpu_ns();
  for (auto next_ns = begin_ns + kPoll_ns; next_ns < begin_ns + seconds_to_ns(seconds);
       next_ns += kPoll_ns) {
    sleep_until_ns(next_ns);
    polls_us.push_back(timed_us([&] { recorder.poll(); }));
  }
  Recording recording{
      static_cast<double>(cpu_ns() - begin_cpu_ns) / static_cast<double>(now_ns() - begin_ns),
      median(polls_us)};
  done = true;
  publisher.join();
  const auto history =
      service::must(supervisor::read_history(service::must(recorder.history().snapshot(0))));
  for (const auto& frame : history.frames) recording.missed += frame.missed;
  recording.frames = history.frames.size();
  return recording;
}

/// What looking at the past costs, once it is asked for: the supervisor only the snapshot, the tool
/// the rest.
void print_looking_back() {
  supervisor::History history(60);
  msg::StageMarks marks;
  marks.count = 10;
  for (std::int64_t i = 0; i < 946 * 60; ++i) {
    marks.header = {static_cast<std::uint64_t>(i), 1'000'000'000 + i * 1'057'000,
                    1'001'000'000 + i * 1'057'000};
    for (std::uint32_t k = 0; k < marks.count; ++k)
      marks.marks[k] = {Stage::draw, 0, marks.header.published_ns, marks.header.published_ns};
    history.add("projector", marks, 0);
  }
  const auto newest_ns = marks.header.published_ns;
  for (const std::int64_t seconds : {10, 60}) {
    UniqueFd file;
    const double snapshot_us = timed_us(
        [&] { file = service::must(history.snapshot(newest_ns - seconds * 1'000'000'000)); });
    supervisor::HistorySnapshot snapshot;
    const double read_us =
        timed_us([&] { snapshot = service::must(supervisor::read_history(file)); });
    std::size_t bytes = 0;
    const double trace_us = timed_us([&] {
      bytes = perfetto_trace(snapshot, "bench", supervisor::ClockReadings::now()).size();
    });
    const double table_us = timed_us([&] { measure_latency(snapshot, {}); });
    fmt::print(
        "  {} s of a projector: snapshot {:.1f} ms in the supervisor; in the tool reading {:.1f} "
        "ms, trace {:.0f} ms ({:.1f} MB), table "
        "{:.0f} ms\n",
        seconds, snapshot_us / 1e3, read_us / 1e3, trace_us / 1e3,
        static_cast<double>(bytes) * 1e-6, table_us / 1e3);
  }
}

std::vector<Goal> measure_goals(double seconds) {
  double total_percent = 0, projector_us = 0;
  fmt::print("marks of one frame, at the service's rate\n");
  for (const auto& marker : kMarkers) {
    const double cost_us = frame_cost_us(marker, seconds / 4);
    const double percent = cost_us * marker.rate_hz * 1e-4;
    fmt::print("  {:<10} {:>2} marks {:>6.0f} Hz {:>8.2f} us {:>7.3f} % of its period\n",
               marker.service, marker.stages.size() + 1, marker.rate_hz, cost_us, percent);
    total_percent += percent;
    projector_us = cost_us;
  }
  supervisor::Recorder recorder(60);
  const auto recording = record(seconds, recorder);
  fmt::print("recorder: {:.0f} us a poll, {:.3f} % of a core; {} frames, {} missed\n",
             recording.poll_us, recording.cpu_share * 100, recording.frames, recording.missed);
  print_looking_back();
  total_percent += recording.cpu_share * 100;
  return {{"traces: all services and the recorder", total_percent, 1, "% of a core"},
          {"traces: the recorder", recording.cpu_share * 100, 1, "% of a core"},
          {"traces: a projector frame's marks", projector_us, 1e4 / kMarkers.back().rate_hz, "us"},
          {"traces: frames whose marks were missed", static_cast<double>(recording.missed), 0,
           "frames"}};
}

}  // namespace
}  // namespace handcast::bench

int main(int argc, char** argv) {
  using namespace handcast::bench;
  std::string goals_file;
  double seconds = 8;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--goals") == 0) goals_file = argv[i + 1];
    if (std::strcmp(argv[i], "--seconds") == 0) seconds = std::atof(argv[i + 1]);
  }
  const std::vector<Goal> goals = measure_goals(seconds);
  print_goals(goals);
  if (goals_file.empty() || write_goals(goals_file, goals)) return 0;
  fmt::print(stderr, "bench_traces: cannot write '{}'.\n", goals_file);
  return 1;
}
