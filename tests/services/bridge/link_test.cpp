// SPDX-License-Identifier: Apache-2.0
// Links that hear each other, and participants of strangers, by CycloneDDS itself.
#include "services/bridge/link.hpp"

#include <dds/dds.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "ipc/msg/check_guest.hpp"
#include "ros.h"
#include "services/bridge/bridge.hpp"
#include "services/bridge/ros_joints.hpp"
#include "services/bridge/wire_messages.hpp"

namespace handcast::bridge {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;

/// Keeps what comes.
struct Kept : Receiver {
  void take(const Claim& claim, const msg::HandPoses& message) override {
    claims.push_back(claim);
    poses.push_back(message);
  }
  void take(const Claim& claim, const msg::Landmarks& message) override {
    claims.push_back(claim);
    landmarks.push_back(message);
  }
  void take(const Claim& claim, std::string_view values) override {
    claims.push_back(claim);
    settings.emplace_back(values);
  }
  void hear(Peer, const ClockExchange& exchange) override { exchanges.push_back(exchange); }
  void lose(Peer peer) override { lost.push_back(peer); }
  void complain(const std::string& sentence) override { complaints.push_back(sentence); }

  std::vector<Claim> claims;
  std::vector<msg::HandPoses> poses;
  std::vector<msg::Landmarks> landmarks;
  std::vector<std::string> settings;
  std::vector<ClockExchange> exchanges;
  std::vector<Peer> lost;
  std::vector<std::string> complaints;
};

msg::HandPoses two_hands() {
  msg::HandPoses poses{.header = {7, now_ns() - 5'000'000, now_ns() - 1'000'000}, .count = 2};
  for (std::uint32_t h = 0; h < 2; ++h) {
    auto& hand = poses.hands[h];
    hand.side = h == 0 ? msg::Side::left : msg::Side::right;
    hand.confidence = 0.75;
    for (std::size_t i = 0; i < hand.joints.size(); ++i)
      hand.joints[i] = {{0.01f * static_cast<float>(i), -0.2f, 0.5f}, {0, 0, 0.6f, 0.8f}, 0.011f};
  }
  return poses;
}

msg::Landmarks one_hand() {
  msg::Landmarks landmarks{.header = {9, now_ns() - 9'000'000, now_ns() - 1'000'000}, .count = 1};
  landmarks.hands[0].side = msg::Side::right;
  landmarks.hands[0].presence = 0.5;
  for (auto& point : landmarks.hands[0].points) point = {320.5f, 99.25f, 1, 1.5f};
  return landmarks;
}

class LinkTest : public testing::Test {
 protected:
  LinkTest() {
    settings_.domain = 100 + static_cast<int>(::getpid() % 100);  // tests run side by side
    settings_.oldest_ms = 1000;
  }
  std::unique_ptr<Link> open(const Link::Streams& streams, const char* name) const {
    auto link = Link::open(settings_, streams, name);
    EXPECT_TRUE(link) << link.error().what;
    return std::move(*link);
  }
  std::unique_ptr<Link> open_sender() const {
    return open({.sends_poses = true, .sends_landmarks = true}, "stage@left");
  }
  std::unique_ptr<Link> open_taker() const {
    return open({.takes_poses = true, .takes_landmarks = true}, "stage@right");
  }
  /// Sends and takes until something is so, at most ten seconds.
  template <class Send, class Done>
  static bool go_on(Link& taker, Receiver& receiver, const Send& send, const Done& done) {
    for (const auto until = Deadline::in(10s); !until.passed();) {
      send();
      taker.take(receiver, Deadline::in(10ms));
      if (done()) return true;
    }
    return false;
  }

  config::Bridge settings_;
};

/// A participant that is not a bridge.
class Stranger {
 public:
  explicit Stranger(const config::Bridge& settings)
      : participant_(dds_create_participant(static_cast<dds_domainid_t>(settings.domain), nullptr,
                                            nullptr)) {
    dds_get_guid(participant_, &guid);
  }
  Stranger(const Stranger&) = delete;
  ~Stranger() { dds_delete(participant_); }

  dds_entity_t writer(const dds_topic_descriptor_t& type, const char* name) const {
    auto* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_deadline(qos, DDS_MSECS(200));
    dds_qset_liveliness(qos, DDS_LIVELINESS_AUTOMATIC, DDS_MSECS(1000));
    const auto topic = dds_create_topic(participant_, &type, name, nullptr, nullptr);
    const auto made = dds_create_writer(participant_, topic, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(made, 0);
    return made;
  }
  dds_entity_t reader(const dds_topic_descriptor_t& type, const char* name) const {
    const auto topic = dds_create_topic(participant_, &type, name, nullptr, nullptr);
    return dds_create_reader(participant_, topic, nullptr, nullptr);
  }

  dds_guid_t guid{};

 private:
  dds_entity_t participant_;
};

TEST_F(LinkTest, MessagesComeAsTheyWereSentWithTheNameOfTheirSender) {
  const auto sender = open_sender(), taker = open_taker();
  const auto poses = two_hands();
  const auto landmarks = one_hand();
  Kept kept;
  ASSERT_TRUE(go_on(
      *taker, kept, [&] { sender->send(poses), sender->send(landmarks); },
      [&] { return !kept.poses.empty() && !kept.landmarks.empty(); }));
  EXPECT_EQ(kept.claims.front().name, "stage@left");
  EXPECT_EQ(kept.claims.front().version, kWireVersion);
  EXPECT_TRUE(kept.claims.front().is_its_own);
  EXPECT_EQ(kept.claims.front().peer, kept.claims.back().peer);
  EXPECT_EQ(kept.claims.front().published_ns, kept.poses.front().header.published_ns);
  EXPECT_EQ(std::memcmp(&kept.poses.front(), &poses, sizeof poses), 0);
  EXPECT_EQ(std::memcmp(&kept.landmarks.front(), &landmarks, sizeof landmarks), 0);
}

TEST_F(LinkTest, SettingsComeAlsoToWhoComesLater) {
  const auto sender = open({.sends_settings = true}, "stage@left");
  const auto settings = std::make_unique<msg::LiveSettings>();
  settings->values.set("light.brightness = 0.5\n");
  sender->send(*settings);
  const auto taker = open({.takes_settings = true}, "stage@right");
  Kept kept;
  ASSERT_TRUE(go_on(
      *taker, kept, [] {}, [&] { return !kept.settings.empty(); }));
  EXPECT_EQ(kept.settings.front(), "light.brightness = 0.5\n");
}

TEST_F(LinkTest, ASenderAnswersForItsClock) {
  const auto sender = open_sender(), taker = open_taker();
  Kept kept, none;
  ASSERT_TRUE(go_on(
      *taker, kept,
      [&] {
        taker->ask();
        sender->take(none, Deadline::in(5ms));
      },
      [&] { return kept.exchanges.size() > 3; }));
  for (const auto& exchange : kept.exchanges) {  // it is the same clock
    EXPECT_LE(exchange.asked_ns, exchange.arrived_ns);
    EXPECT_LE(exchange.arrived_ns, exchange.answered_ns);
    EXPECT_LE(exchange.answered_ns, exchange.heard_ns);
  }
}

TEST_F(LinkTest, TheEndOfASenderIsToldAndOthersAreNot) {
  const auto taker = open_taker();
  auto sender = open_sender();
  Kept kept;
  const auto poses = two_hands();
  ASSERT_TRUE(go_on(
      *taker, kept, [&] { sender->send(poses); }, [&] { return !kept.claims.empty(); }));
  EXPECT_TRUE(kept.lost.empty());
  sender.reset();
  ASSERT_TRUE(go_on(
      *taker, kept, [] {}, [&] { return !kept.lost.empty(); }));
  EXPECT_EQ(kept.lost.front(), kept.claims.front().peer);
}

TEST_F(LinkTest, WhoSendsInTheNameOfAnotherIsSeen) {
  const auto taker = open_taker();
  Stranger stranger(settings_);
  const auto writer = stranger.writer(handcast_wire_HandPoses_desc, "handcast_pose_hands");
  const auto poses = two_hands();
  std::array<std::uint8_t, 16> another{1, 2, 3};
  Kept kept;
  ASSERT_TRUE(go_on(
      *taker, kept,
      [&] {
        wire::Filled<msg::HandPoses> sample(poses, another.data(), "stage@left");
        dds_write(writer, sample.sample());
      },
      [&] { return !kept.claims.empty(); }));
  EXPECT_FALSE(kept.claims.front().is_its_own);
}

TEST_F(LinkTest, HostileNumbersAndNamesComeToNobodyWhoUsesThem) {
  const auto taker = open_taker();
  Stranger stranger(settings_);
  const auto writer = stranger.writer(handcast_wire_HandPoses_desc, "handcast_pose_hands");
  std::vector<std::string> said;
  Arrivals arrivals(settings_, {}, [&](const std::string& text) { said.push_back(text); });
  auto poses = two_hands();
  poses.hands[1].joints[3].position_m[0] = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(go_on(
      *taker, arrivals,
      [&] {
        wire::Filled<msg::HandPoses> sample(poses, stranger.guid.v, "\x1b[2Jstage");
        dds_write(writer, sample.sample());
      },
      [&] { return arrivals.refused() > 0; }));
  EXPECT_FALSE(arrivals.collect().poses);
  EXPECT_THAT(said, Contains(HasSubstr("?[2Jstage: the position of joint 3")));
}

TEST_F(LinkTest, AnotherTypeUnderTheSameNameIsNotRead) {
  const auto taker = open_taker();
  Stranger stranger(settings_);
  const auto wrong = stranger.writer(geometry_msgs_msg_dds__PoseArray__desc, "handcast_pose_hands");
  geometry_msgs_msg_dds__PoseArray_ message{};
  std::array<geometry_msgs_msg_dds__Pose_, 500> many{};
  std::string frame(5000, 'x');
  message.header.frame_id = frame.data();
  message.poses._maximum = message.poses._length = many.size();
  message.poses._buffer = many.data();
  Kept kept;
  for (int i = 0; i < 50; ++i) {
    dds_write(wrong, &message);
    taker->take(kept, Deadline::in(10ms));
  }
  EXPECT_TRUE(kept.claims.empty());
}

TEST_F(LinkTest, AWriterWithoutDeadlineIsNotReadAndNamed) {
  const auto taker = open_taker();
  Stranger stranger(settings_);
  const dds_entity_t plain = [&] {
    const auto topic = dds_create_topic(
        dds_get_participant(stranger.reader(handcast_wire_HandPoses_desc, "handcast_pose_hands")),
        &handcast_wire_HandPoses_desc, "handcast_pose_hands", nullptr, nullptr);
    return dds_create_writer(dds_get_participant(topic), topic, nullptr, nullptr);
  }();
  ASSERT_GT(plain, 0);
  Kept kept;
  ASSERT_TRUE(go_on(
      *taker, kept, [] {}, [&] { return !kept.complaints.empty(); }));
  EXPECT_THAT(kept.complaints.front(), HasSubstr("pose.hands: another computer sends it"));
}

/// Whether a message came within ten seconds of sending; `look` gets the first one.
template <class Message, class Send, class Look>
bool came(dds_entity_t reader, const Send& send, const Look& look) {
  for (const auto until = Deadline::in(10s); !until.passed();) {
    send();
    dds_sleepfor(DDS_MSECS(10));
    void* sample = nullptr;
    dds_sample_info_t info;
    const auto count = dds_take(reader, &sample, &info, 1, 1);
    if (count <= 0) continue;
    if (info.valid_data) look(*static_cast<Message*>(sample));
    dds_return_loan(reader, &sample, count);
    if (info.valid_data) return true;
  }
  return false;
}

TEST_F(LinkTest, AComputerWithRos2SeesTheJoints) {
  const auto sender = open({.sends_ros = true}, "stage@left");
  Stranger ros(settings_);
  const auto reader = ros.reader(geometry_msgs_msg_dds__PoseArray__desc, RosJoints::kTopics[1]);
  EXPECT_STREQ(geometry_msgs_msg_dds__PoseArray__desc.m_typename,
               "geometry_msgs::msg::dds_::PoseArray_");
  const auto poses = two_hands();
  EXPECT_TRUE(came<geometry_msgs_msg_dds__PoseArray_>(
      reader, [&] { sender->send(poses); },
      [](const auto& message) {
        EXPECT_STREQ(message.header.frame_id, "handcast_tracker");
        EXPECT_NEAR(message.header.stamp.sec, std::time(nullptr), 20);
        ASSERT_EQ(message.poses._length, 26u);
        EXPECT_FLOAT_EQ(static_cast<float>(message.poses._buffer[4].position.x), 0.04f);
        EXPECT_FLOAT_EQ(static_cast<float>(message.poses._buffer[4].orientation.w), 0.8f);
      }));
}

TEST_F(LinkTest, AComputerWithRos2SeesAFrameForEachJoint) {
  const auto sender = open({.sends_ros = true}, "stage@left");
  Stranger ros(settings_);
  const auto reader = ros.reader(tf2_msgs_msg_dds__TFMessage__desc, RosJoints::kTransforms);
  EXPECT_STREQ(tf2_msgs_msg_dds__TFMessage__desc.m_typename, "tf2_msgs::msg::dds_::TFMessage_");
  const auto poses = two_hands();
  EXPECT_TRUE(came<tf2_msgs_msg_dds__TFMessage_>(
      reader, [&] { sender->send(poses); },
      [&](const auto& message) {
        ASSERT_EQ(message.transforms._length, 52u);
        const auto& frame = message.transforms._buffer[26 + 4];
        EXPECT_STREQ(frame.header.frame_id, "handcast_tracker");
        EXPECT_NEAR(frame.header.stamp.sec, std::time(nullptr), 20);
        EXPECT_EQ(frame.child_frame_id, RosJoints::frame_of(poses.hands[1].side, 4));
        EXPECT_FLOAT_EQ(static_cast<float>(frame.transform.translation.x),
                        poses.hands[1].joints[4].position_m[0]);
        EXPECT_FLOAT_EQ(static_cast<float>(frame.transform.rotation.w), 0.8f);
      }));
  EXPECT_EQ(RosJoints::frame_of(msg::Side::left, 10), "handcast_left_index_finger_tip");
}

TEST_F(LinkTest, AnInterfaceThatIsNotThereIsASentence) {
  settings_.interface = "nowhere0";
  const auto link = Link::open(settings_, {.sends_poses = true}, "stage@left");
  ASSERT_FALSE(link);
  EXPECT_EQ(link.error().code, Errc::unavailable);
  EXPECT_THAT(link.error().what, HasSubstr("nowhere0"));
  settings_.interface = "\"/><Evil>";
  EXPECT_EQ(Link::open(settings_, {}, "x").error().code, Errc::bad_config);
}

}  // namespace
}  // namespace handcast::bridge
