// SPDX-License-Identifier: Apache-2.0
#include "services/bridge/link.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <span>

#include "ipc/base/log.hpp"
#include "services/bridge/ros_joints.hpp"
#include "services/bridge/wire_messages.hpp"

namespace handcast::bridge {
namespace {

/// The quality of service of the streams; a reader finds only writers that offer the same.
/// @{
constexpr dds_duration_t kDeadline_ns = DDS_MSECS(200);
constexpr dds_duration_t kLiveliness_ns = DDS_MSECS(1000);
/// @}
/// The most peers whose messages are kept, so that a stranger cannot fill the memory.
constexpr int kMostPeers = 16;

/// What CycloneDDS says, now and then: it repeats itself for every message while a cable is out.
void pass_on_words(void*, const dds_log_data_t* said) {
  constexpr std::int64_t kRepeated_ns = 30'000'000'000;
  static std::atomic<std::int64_t> next_ns = 0;
  const auto time_ns = now_ns();
  auto due_ns = next_ns.load();
  if (time_ns < due_ns || !next_ns.compare_exchange_strong(due_ns, time_ns + kRepeated_ns)) return;
  std::string_view words(said->message, std::strlen(said->message));
  words = words.substr(0, words.find_last_not_of('\n') + 1);
  log::warning("CycloneDDS: {}", words);
}

struct FreeQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, FreeQos>;

/// The newest message of each sender, lost if it is lost.
Qos newest_only() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_deadline(qos.get(), kDeadline_ns);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, kLiveliness_ns);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

/// The newest message of each sender, also for who comes later, until it has come.
Qos until_it_came() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, 0);
  dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, kLiveliness_ns);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

/// Questions and answers, each of them lost if it is lost.
Qos some_of_all() {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kMostPeers);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

Qos for_reader(Qos qos) {
  dds_qset_resource_limits(qos.get(), DDS_LENGTH_UNLIMITED, kMostPeers, DDS_LENGTH_UNLIMITED);
  return qos;
}

/// The samples of one dds_take(), given back at the end.
template <class Sample>
class Loaned {
 public:
  explicit Loaned(dds_entity_t reader) : reader_(reader) {
    count_ = dds_take(reader, samples_.data(), infos_.data(), samples_.size(), samples_.size());
  }
  Loaned(const Loaned&) = delete;
  ~Loaned() {
    if (count_ > 0) dds_return_loan(reader_, samples_.data(), count_);
  }
  int count() const { return std::max<int>(count_, 0); }
  const dds_sample_info_t& info(int i) const { return infos_[static_cast<std::size_t>(i)]; }
  const Sample& operator[](int i) const {
    return *static_cast<const Sample*>(samples_[static_cast<std::size_t>(i)]);
  }

 private:
  dds_entity_t reader_;
  std::array<void*, kMostPeers> samples_{};
  std::array<dds_sample_info_t, kMostPeers> infos_{};
  dds_return_t count_ = 0;
};

/// A writer of another computer.
struct Author {
  Peer peer = 0;
  dds_guid_t participant{};
};

class DdsLink final : public Link {
 public:
  ~DdsLink() override {
    if (participant_ > 0) dds_delete(participant_);
    if (domain_ > 0) dds_delete(domain_);
  }

  Result<void> start(const config::Bridge& settings, const Streams& streams,
                     const std::string& name);

  void send(const msg::HandPoses& poses) override {
    if (poses_.writer > 0) write(poses_.writer, poses);
    if (ros_) ros_->send(poses);
  }
  void send(const msg::Landmarks& landmarks) override {
    if (landmarks_.writer > 0) write(landmarks_.writer, landmarks);
  }
  void send(const msg::LiveSettings& settings) override {
    if (settings_.writer <= 0) return;
    const auto sample = wire::filled(settings, self_.v, name_);
    dds_write(settings_.writer, sample.get());
  }
  void ask() override;
  void take(Receiver& receiver, Deadline deadline) override;

 private:
  struct Ends {
    dds_entity_t writer = 0, reader = 0;
  };

  Result<dds_entity_t> topic(const dds_topic_descriptor_t& type, const char* name) {
    return made(dds_create_topic(participant_, &type, name, nullptr, nullptr));
  }
  /// Makes the ends of a topic that are needed.
  Result<Ends> make(const dds_topic_descriptor_t& type, const char* name, bool writes, bool reads,
                    Qos (*qos)());
  static Result<dds_entity_t> made(dds_entity_t entity) {
    if (entity >= 0) return entity;
    return fail(Errc::unavailable, fmt::format("CycloneDDS: {}", dds_strretcode(-entity)));
  }

  template <class Message>
  void write(dds_entity_t writer, const Message& message) {
    wire::Filled<Message> filled(message, self_.v, name_);
    dds_write(writer, filled.sample());
  }
  /// Hands on the samples of a reader, and who is gone.
  template <class Sample, class Take>
  void take_samples(const Ends& ends, const char* stream, Receiver& receiver, const Take& take);
  template <class Message>
  void take_stream(const Ends& ends, Receiver& receiver) {
    using Type = wire::TypeOf<Message>;
    take_samples<typename Type::Sample>(ends, Type::kStream, receiver,
                                        [&](const Claim& claim, const auto& sample) {
                                          receiver.take(claim, wire::message_of(sample));
                                        });
  }
  void answer_questions();
  void take_answers(Receiver& receiver);
  void watch_quality(dds_entity_t reader, const char* stream, Receiver& receiver);
  std::optional<Author> author_of(dds_entity_t reader, const dds_sample_info_t& info);

  dds_entity_t domain_ = 0, participant_ = 0, waitset_ = 0;
  Ends poses_, landmarks_, settings_, questions_, answers_;
  std::unique_ptr<RosJoints> ros_;
  dds_guid_t self_{};
  std::string name_;
  std::map<dds_instance_handle_t, Author> authors_;  ///< by their writers
  std::uint32_t asked_ = 0;
  std::array<std::int64_t, 64> asked_ns_{};  ///< of the last questions, by number
};

Result<DdsLink::Ends> DdsLink::make(const dds_topic_descriptor_t& type, const char* name,
                                    bool writes, bool reads, Qos (*qos)()) {
  Ends ends;
  if (!writes && !reads) return ends;
  const auto where = topic(type, name);
  if (!where) return tl::make_unexpected(where.error());
  if (writes) {
    const auto writer = made(dds_create_writer(participant_, *where, qos().get(), nullptr));
    if (!writer) return tl::make_unexpected(writer.error());
    ends.writer = *writer;
  }
  if (reads) {
    const auto reader =
        made(dds_create_reader(participant_, *where, for_reader(qos()).get(), nullptr));
    if (!reader) return tl::make_unexpected(reader.error());
    ends.reader = *reader;
    dds_set_status_mask(ends.reader, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_, ends.reader, 0);
  }
  return ends;
}

Result<void> DdsLink::start(const config::Bridge& settings, const Streams& streams,
                            const std::string& name) {
  auto xml = dds_settings(settings);
  if (!xml) return tl::make_unexpected(xml.error());
  if (const char* more = std::getenv("CYCLONEDDS_URI"); more && *more)
    *xml += fmt::format(",{}", more);
  name_ = name;
  dds_set_log_sink(pass_on_words, nullptr);
  // A process has a domain once; a second link (of a test) uses that of the first.
  if (const auto domain =
          dds_create_domain(static_cast<dds_domainid_t>(settings.domain), xml->c_str());
      domain >= 0)
    domain_ = domain;
  else if (domain != DDS_RETCODE_PRECONDITION_NOT_MET)
    return fail(
        Errc::unavailable,
        fmt::format("CycloneDDS cannot use the interface '{}': {} (its own words are above)",
                    settings.interface, dds_strretcode(-domain)));
  const auto participant =
      made(dds_create_participant(static_cast<dds_domainid_t>(settings.domain), nullptr, nullptr));
  if (!participant) return tl::make_unexpected(participant.error());
  participant_ = *participant;
  dds_get_guid(participant_, &self_);
  waitset_ = dds_create_waitset(participant_);

  const auto keep = [](Result<Ends> made_ends, Ends& ends) -> Result<void> {
    if (!made_ends) return tl::make_unexpected(made_ends.error());
    ends = *made_ends;
    return {};
  };
  Result<void> all = keep(make(handcast_wire_HandPoses_desc, "handcast_pose_hands",
                               streams.sends_poses, streams.takes_poses, newest_only),
                          poses_);
  if (all)
    all = keep(make(handcast_wire_Landmarks_desc, "handcast_landmarks_hands",
                    streams.sends_landmarks, streams.takes_landmarks, newest_only),
               landmarks_);
  if (all)
    all = keep(make(handcast_wire_LiveSettings_desc, "handcast_live_settings",
                    streams.sends_settings, streams.takes_settings, until_it_came),
               settings_);
  if (all)
    all = keep(make(handcast_wire_ClockQuestion_desc, "handcast_clock_questions", streams.takes(),
                    streams.sends(), some_of_all),
               questions_);
  if (all)
    all = keep(make(handcast_wire_ClockAnswer_desc, "handcast_clock_answers", streams.sends(),
                    streams.takes(), some_of_all),
               answers_);
  if (all && streams.sends_ros) {
    auto ros = RosJoints::open(participant_);
    if (!ros) return tl::make_unexpected(ros.error());
    ros_ = std::move(*ros);
  }
  return all;
}

std::optional<Author> DdsLink::author_of(dds_entity_t reader, const dds_sample_info_t& info) {
  if (const auto known = authors_.find(info.publication_handle); known != authors_.end())
    return known->second;
  auto* endpoint = dds_get_matched_publication_data(reader, info.publication_handle);
  if (!endpoint) return std::nullopt;  // it is gone already
  const Author author{endpoint->participant_instance_handle, endpoint->participant_key};
  dds_builtintopic_free_endpoint(endpoint);
  if (authors_.size() >= 4 * kMostPeers) authors_.clear();
  authors_.emplace(info.publication_handle, author);
  return author;
}

template <class Sample, class Take>
void DdsLink::take_samples(const Ends& ends, const char* stream, Receiver& receiver,
                           const Take& take) {
  if (ends.reader <= 0) return;
  const Loaned<Sample> samples(ends.reader);
  for (int i = 0; i < samples.count(); ++i) {
    const auto& info = samples.info(i);
    const auto author = author_of(ends.reader, info);
    if (info.instance_state != DDS_IST_ALIVE) {
      if (author) receiver.lose(author->peer);
      authors_.erase(info.publication_handle);
    }
    if (!info.valid_data || !author) continue;
    const auto& header = samples[i].header;
    Claim claim = wire::claim_of(header);
    claim.peer = author->peer;
    claim.is_its_own = std::memcmp(header.sender, author->participant.v, sizeof header.sender) == 0;
    take(claim, samples[i]);
  }
  watch_quality(ends.reader, stream, receiver);
}

void DdsLink::watch_quality(dds_entity_t reader, const char* stream, Receiver& receiver) {
  dds_requested_incompatible_qos_status_t status{};
  if (dds_get_requested_incompatible_qos_status(reader, &status) == DDS_RETCODE_OK &&
      status.total_count_change > 0)
    receiver.complain(
        fmt::format("{}: another computer sends it as another type, or with another "
                    "quality of service (policy {}); its bridge is of another version",
                    stream, status.last_policy_id));
}

void DdsLink::ask() {
  if (questions_.writer <= 0) return;
  handcast_wire_ClockQuestion question{};
  std::memcpy(question.asker, self_.v, sizeof question.asker);
  question.version = kWireVersion;
  question.number = ++asked_;
  asked_ns_[question.number % asked_ns_.size()] = now_ns();
  dds_write(questions_.writer, &question);
}

void DdsLink::answer_questions() {
  if (questions_.reader <= 0) return;
  const Loaned<handcast_wire_ClockQuestion> questions(questions_.reader);
  const auto arrived_ns = now_ns();
  for (int i = 0; i < questions.count(); ++i) {
    if (!questions.info(i).valid_data || questions[i].version != kWireVersion) continue;
    handcast_wire_ClockAnswer answer{};
    std::memcpy(answer.asker, questions[i].asker, sizeof answer.asker);
    answer.version = kWireVersion;
    answer.number = questions[i].number;
    answer.arrived_ns = arrived_ns;
    answer.answered_ns = now_ns();
    dds_write(answers_.writer, &answer);
  }
}

void DdsLink::take_answers(Receiver& receiver) {
  if (answers_.reader <= 0) return;
  const Loaned<handcast_wire_ClockAnswer> answers(answers_.reader);
  const auto heard_ns = now_ns();
  for (int i = 0; i < answers.count(); ++i) {
    const auto& answer = answers[i];
    if (!answers.info(i).valid_data || answer.version != kWireVersion) continue;
    if (std::memcmp(answer.asker, self_.v, sizeof answer.asker) != 0) continue;
    const auto late = asked_ - answer.number;
    const auto author = author_of(answers_.reader, answers.info(i));
    if (late >= asked_ns_.size() || answer.number == 0 || !author) continue;
    receiver.hear(author->peer, {asked_ns_[answer.number % asked_ns_.size()], heard_ns,
                                 answer.arrived_ns, answer.answered_ns});
  }
}

void DdsLink::take(Receiver& receiver, Deadline deadline) {
  const auto wait_ns = std::max<std::int64_t>(deadline.time_ns() - now_ns(), 0);
  dds_waitset_wait(waitset_, nullptr, 0, wait_ns);
  answer_questions();
  take_answers(receiver);
  take_stream<msg::HandPoses>(poses_, receiver);
  take_stream<msg::Landmarks>(landmarks_, receiver);
  take_samples<handcast_wire_LiveSettings>(settings_, "live.settings", receiver,
                                           [&](const Claim& claim, const auto& sample) {
                                             receiver.take(claim, wire::text_of(sample.values));
                                           });
}

bool is_network_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == ':' || c == '-' || c == '_' || c == '%';
  });
}

}  // namespace

Result<std::string> dds_settings(const config::Bridge& settings) {
  if (!is_network_name(settings.interface))
    return fail(Errc::bad_config,
                fmt::format("bridge.interface: '{}' is not the name of a network interface",
                            settings.interface));
  std::string peers;
  for (const auto& peer : settings.peers) {
    if (!is_network_name(peer))
      return fail(Errc::bad_config,
                  fmt::format("bridge.peers: '{}' is neither a name nor an address", peer));
    peers += fmt::format("<Peer address=\"{}\"/>", peer);
  }
  const bool is_local = settings.interface == "lo";
  if (is_local) peers += "<Peer address=\"127.0.0.1\"/>";
  // Without multicast, several participants of a computer need ports of their own. Participants are
  // announced every second, so that those behind a cable that was plugged in again are found soon.
  const bool by_multicast = !is_local && settings.peers.empty();
  return fmt::format(
      "<CycloneDDS><Domain id=\"any\"><General><Interfaces><NetworkInterface name=\"{}\"/>"
      "</Interfaces><AllowMulticast>{}</AllowMulticast></General>"
      "<Discovery><SPDPInterval>1s</SPDPInterval><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>31</MaxAutoParticipantIndex><Peers>{}</Peers></Discovery>"
      "</Domain></CycloneDDS>",
      settings.interface, by_multicast ? "true" : "false", peers);
}

Result<std::unique_ptr<Link>> Link::open(const config::Bridge& settings, const Streams& streams,
                                         const std::string& name) {
  auto link = std::make_unique<DdsLink>();
  if (auto started = link->start(settings, streams, name); !started)
    return tl::make_unexpected(started.error());
  return link;
}

}  // namespace handcast::bridge
