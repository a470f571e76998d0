// SPDX-License-Identifier: Apache-2.0
#include "supervisor/look/metrics/metrics.hpp"

#include <fmt/format.h>
#include <prometheus/collectable.h>
#include <prometheus/exposer.h>
#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <array>
#include <exception>
#include <mutex>

#include "ipc/base/clock.hpp"
#include "supervisor/life/state.hpp"
#include "supervisor/look/figures/figures.hpp"
#include "supervisor/look/top/top_model.hpp"

namespace handcast::supervisor {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;
using Labels = std::vector<ClientMetric::Label>;

/// One metric with a value for each set of labels.
struct Family {
  MetricFamily family;

  static Family counter(std::string name, std::string help) {
    return {{std::move(name), std::move(help), MetricType::Counter, {}}};
  }
  static Family gauge(std::string name, std::string help) {
    return {{std::move(name), std::move(help), MetricType::Gauge, {}}};
  }

  template <class Number>
  void add(Labels labels, Number number) {
    ClientMetric metric;
    metric.label = std::move(labels);
    const auto value = static_cast<double>(number);
    (family.type == MetricType::Counter ? metric.counter.value : metric.gauge.value) = value;
    family.metric.push_back(std::move(metric));
  }
};

/// Adds the value of each row to a family; `value` returns an empty optional for rows without one.
template <class Row, class Label, class Value>
MetricFamily over(const std::vector<Row>& rows, Family family, Label labels_of, Value value) {
  for (const auto& row : rows)
    if (const std::optional<double> number = value(row)) family.add(labels_of(row), *number);
  return std::move(family.family);
}

void append(std::vector<MetricFamily>& families, std::vector<MetricFamily> more) {
  std::ranges::move(more, std::back_inserter(families));
}

std::vector<MetricFamily> families_of_rig(const TopModel& model) {
  auto info = Family::gauge("handcast_rig_info", "Name of the rig; always 1.");
  auto up = Family::gauge("handcast_supervisor_up", "1 while the rig's supervisor answers.");
  auto uptime = Family::gauge("handcast_supervisor_uptime_seconds",
                              "Time since the rig's start, also under earlier supervisors.");
  info.add({{"rig", model.rig}}, 1);
  up.add({}, model.missing.empty() ? 1 : 0);
  uptime.add({}, model.uptime_s);
  return {info.family, up.family, uptime.family};
}

MetricFamily states_of(const std::vector<ServiceRow>& services) {
  auto states =
      Family::gauge("handcast_service_state", "1 for the state of a service, 0 for all others.");
  for (const auto& service : services)
    for (const auto state : kStateNames)
      states.add({{"service", service.name}, {"state", std::string(state)}},
                 service.state == state);
  return states.family;
}

std::vector<MetricFamily> families_of(const std::vector<ServiceRow>& services) {
  const auto labels = [](const ServiceRow& service) { return Labels{{"service", service.name}}; };
  const auto usage = [](auto figure) {
    return [figure](const ServiceRow& service) -> std::optional<double> {
      return service.usage ? std::optional(static_cast<double>(figure(*service.usage)))
                           : std::nullopt;
    };
  };
  return {
      over(services, Family::gauge("handcast_service_up", "1 while a service is ready."), labels,
           [](const auto& service) { return service.state == "ready" ? 1.0 : 0.0; }),
      states_of(services),
      over(services,
           Family::counter("handcast_service_restarts_total", "Number of restarts of a service."),
           labels, [](const auto& service) { return service.restarts; }),
      over(services,
           Family::gauge("handcast_service_uptime_seconds",
                         "Time since the start of a service's process."),
           labels, [](const auto& service) { return service.uptime_s; }),
      over(services,
           Family::counter("handcast_service_cpu_seconds_total",
                           "Processor time of a service's process."),
           labels,
           usage([](const ProcessUsage& process) { return ns_to_seconds(process.cpu_ns); })),
      over(services,
           Family::gauge("handcast_service_resident_bytes",
                         "Memory of a service's process, shared rings included."),
           labels, usage([](const ProcessUsage& process) { return process.resident_bytes; })),
      over(services, Family::gauge("handcast_service_threads", "Threads of a service's process."),
           labels, usage([](const ProcessUsage& process) { return process.threads; })),
      over(services,
           Family::gauge("handcast_service_open_descriptors",
                         "Open file descriptors of a service's process."),
           labels, usage([](const ProcessUsage& process) { return process.descriptors; })),
  };
}

std::vector<MetricFamily> families_of(const std::vector<RingRow>& rings) {
  const auto labels = [](const RingRow& ring) { return Labels{{"ring", ring.now.stream}}; };
  const auto seconds = [](const std::optional<std::int64_t>& span_ns) {
    return span_ns ? std::optional(ns_to_seconds(*span_ns)) : std::nullopt;
  };
  return {
      over(rings,
           Family::counter("handcast_ring_messages_total",
                           "Messages published in a ring, by all its writers."),
           labels, [](const auto& ring) { return ring.now.published; }),
      over(rings,
           Family::counter("handcast_ring_dropped_total",
                           "Messages that a writer dropped because every slot was leased."),
           labels, [](const auto& ring) { return ring.now.dropped; }),
      over(rings,
           Family::gauge("handcast_ring_newest_age_seconds",
                         "Time since the newest message of a ring was published."),
           labels, [&](const auto& ring) { return seconds(ring.newest_age_ns); }),
      over(rings,
           Family::gauge("handcast_ring_latency_seconds",
                         "Time from the origin of a ring's newest message to its publication."),
           labels, [&](const auto& ring) { return seconds(ring.latency_ns); }),
      over(rings,
           Family::gauge("handcast_ring_epoch", "Number of a ring's last writer, from 1 on."),
           labels, [](const auto& ring) { return ring.now.epoch; }),
  };
}

/// A reader of one ring. Its labels include the row, because a service may have several readers.
struct RingReader {
  Labels labels;
  const ReaderRow& row;
};

std::vector<MetricFamily> families_of_readers(const std::vector<RingRow>& rings) {
  std::vector<RingReader> readers;
  for (const auto& ring : rings)
    for (const auto& reader : ring.readers)
      readers.push_back({{{"ring", ring.now.stream},
                          {"reader", reader.who},
                          {"row", std::to_string(reader.now.row)}},
                         reader});
  const auto labels = [](const RingReader& reader) { return reader.labels; };
  const auto oldest_lease = [](const RingReader& reader) {
    return ns_to_seconds(std::max<std::int64_t>(0, std::ranges::max(reader.row.now.lease_ages_ns)));
  };
  return {
      over(readers,
           Family::counter("handcast_reader_received_total", "Messages that a reader has read."),
           labels, [](const auto& reader) { return reader.row.now.received; }),
      over(readers,
           Family::counter("handcast_reader_skipped_total", "Messages that a reader has skipped."),
           labels, [](const auto& reader) { return reader.row.now.skipped; }),
      over(readers,
           Family::counter("handcast_reader_unusable_total",
                           "Messages that were invalid for a reader."),
           labels, [](const auto& reader) { return reader.row.now.unusable; }),
      over(readers,
           Family::gauge("handcast_reader_lag_messages",
                         "Messages between the newest of a ring and the last one of a reader."),
           labels, [](const auto& reader) { return reader.row.now.lag; }),
      over(readers,
           Family::gauge("handcast_reader_age_seconds",
                         "Age of a reader's last message when it was read."),
           labels, [](const auto& reader) { return ns_to_seconds(reader.row.now.age_ns); }),
      over(readers,
           Family::gauge("handcast_reader_lease_seconds",
                         "Age of a reader's oldest lease; 0: none."),
           labels, oldest_lease),
  };
}

MetricFamily stages_of(const Figures& figures) {
  auto stages = Family::gauge("handcast_stage_seconds",
                              "Time of a stage in the last ten seconds, by quantile.");
  for (const auto& [stage, times] : figures.stages) {
    stages.add({{"stage", stage}, {"quantile", "0.5"}}, times.p50_us * 1e-6);
    stages.add({{"stage", stage}, {"quantile", "0.99"}}, times.p99_us * 1e-6);
  }
  return stages.family;
}

/// A counter with a value for each count. `label` names their keys.
MetricFamily by_key(const std::map<std::string, std::uint64_t>& counts, Family family,
                    const char* label) {
  for (const auto& [key, count] : counts) family.add({{label, key}}, count);
  return std::move(family.family);
}

std::vector<MetricFamily> families_by_key(const Figures& figures) {
  return {
      by_key(figures.rungs,
             Family::counter("handcast_rung_hands_total",
                             "Hands in drawn frames, by rung of the ladder."),
             "rung"),
      by_key(figures.lost_images,
             Family::counter("handcast_camera_lost_images_total",
                             "Images of the camera that were lost, by reason."),
             "reason"),
      by_key(figures.tracker_faults,
             Family::counter("handcast_tracker_faults_total",
                             "What the tracker did wrong, by kind: how often it began."),
             "kind"),
  };
}

MetricFamily wanted_rates_of(const Figures& figures) {
  auto wanted = Family::gauge("handcast_ring_wanted_hertz",
                              "Messages per second that the rig file asks for.");
  for (const auto& [ring, stream] : figures.streams)
    if (stream.wanted_hz) wanted.add({{"ring", ring}}, *stream.wanted_hz);
  return wanted.family;
}

std::vector<MetricFamily> families_of_light(const Figures& figures) {
  auto source = Family::gauge("handcast_light_times_info",
                              "What says when light comes (label by); always 1.");
  auto missed = Family::counter("handcast_light_missed_refreshes_total",
                                "Refreshes of the output without a new frame.");
  auto doubled = Family::counter("handcast_light_doubled_frames_total",
                                 "Frames that the output showed for several refreshes.");
  for (const auto& [projector, light] : figures.lights) {
    source.add({{"service", projector}, {"by", light.times_by}}, 1);
    missed.add({{"service", projector}}, light.missed_refreshes);
    doubled.add({{"service", projector}}, light.doubled_frames);
  }
  return {source.family, missed.family, doubled.family};
}

std::vector<MetricFamily> families_of_drift(const Figures& figures) {
  auto moved = Family::gauge("handcast_tracker_moved",
                             "1 if the tracker is not where the calibration says.");
  auto across = Family::gauge("handcast_tracker_drift_millimetres",
                              "How far it is from there, across the camera's axis.");
  auto turn = Family::gauge("handcast_tracker_drift_degrees", "How far it is turned from there.");
  if (const auto& drift = figures.tracker_drift) {
    moved.add({}, drift->moved ? 1 : 0);
    across.add({}, drift->across_mm);
    turn.add({}, drift->turn_deg);
  }
  return {moved.family, across.family, turn.family};
}

std::vector<MetricFamily> metrics_of(const RigLook& look) {
  const auto model = compare(look, look);
  auto families = families_of_rig(model);
  append(families, families_of(model.services));
  append(families, families_of(model.rings));
  append(families, families_of_readers(model.rings));
  const auto figures = look.figures.value_or(Figures());
  families.push_back(stages_of(figures));
  families.push_back(wanted_rates_of(figures));
  append(families, families_by_key(figures));
  append(families, families_of_light(figures));
  append(families, families_of_drift(figures));
  std::erase_if(families, [](const auto& family) { return family.metric.empty(); });
  return families;
}

}  // namespace

std::string metrics_text(const RigLook& look) {
  return prometheus::TextSerializer().Serialize(metrics_of(look));
}

/// The metrics as they are at each scrape.
class MetricsServer::Parts : public prometheus::Collectable {
 public:
  explicit Parts(std::function<RigLook()> look) : look_(std::move(look)) {}

  std::vector<MetricFamily> Collect() const override {
    const std::lock_guard lock(mutex_);
    return metrics_of(look_());
  }

  std::unique_ptr<prometheus::Exposer> exposer;

 private:
  mutable std::mutex mutex_;
  std::function<RigLook()> look_;
};

Result<MetricsServer> MetricsServer::open(int port, std::function<RigLook()> look) try {
  auto parts = std::make_shared<Parts>(std::move(look));
  parts->exposer = std::make_unique<prometheus::Exposer>(std::vector<std::string>{
      "listening_ports", fmt::format("127.0.0.1:{}", port), "num_threads", std::to_string(kThreads),
      "request_timeout_ms", std::to_string(kPatience_ms)});
  parts->exposer->RegisterCollectable(parts);
  return MetricsServer(std::move(parts));
} catch (const std::exception& problem) {
  return fail(Errc::bad_config,
              fmt::format("port {} of 127.0.0.1 cannot be opened ({}); set supervisor.metrics_port "
                          "to another port, or to 0",
                          port, problem.what()));
}

int MetricsServer::port() const { return parts_->exposer->GetListeningPorts().front(); }

MetricsServer::MetricsServer(std::shared_ptr<Parts> parts) : parts_(std::move(parts)) {}
MetricsServer::MetricsServer(MetricsServer&&) noexcept = default;
MetricsServer::~MetricsServer() {
  if (parts_) parts_->exposer.reset();  // before what its threads call
}

}  // namespace handcast::supervisor
