#include <gmock/gmock.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <thread>

#include "supervisor/control_client.hpp"
#include "supervisor/control_server.hpp"
#include "supervisor/runtime_folder.hpp"

namespace handcast::supervisor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A runtime folder of the test's own.
class Control : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/handcast-control-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder_ = name;
    setenv("XDG_RUNTIME_DIR", name, 1);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  EventLoop loop_ = EventLoop::open().value();
};

void refuse(const Request&, const ControlServer::Reply& reply) { reply(failure("no")); }

TEST(ControlMessage, ARequestComesBackAsItWasSent) {
  const auto request = parse_request(print_request({Verb::swap, "pose", "replay"}));
  ASSERT_TRUE(request);
  EXPECT_EQ(request->verb, Verb::swap);
  EXPECT_EQ(request->service, "pose");
  EXPECT_EQ(request->backend, "replay");
}

TEST(ControlMessage, NonsenseIsRefusedWithASentence) {
  for (const auto* line :
       {"", "[]", "{", "42", R"({"verb":7})", R"({"verb":"fly"})", R"({"verb":"swap","service":"pose"})", R"({"verb":"restart"})"}) {
    const auto request = parse_request(line);
    ASSERT_FALSE(request) << line;
    EXPECT_EQ(request.error().code, Errc::bad_data);
    EXPECT_FALSE(request.error().what.empty());
  }
}

TEST_F(Control, AClientGetsTheAnswerToItsRequest) {
  bool asked = false;
  const auto server = ControlServer::listen("desk", loop_, [&](const Request& request, const ControlServer::Reply& reply) {
    asked = true;
    auto answer = success();
    answer["echo"] = request.service;
    reply(answer);
  });
  ASSERT_TRUE(server);
  Result<nlohmann::json> answer;
  std::thread client([&] { answer = ask("desk", {Verb::restart, "pose", ""}); });
  while (!asked) loop_.turn();
  client.join();
  ASSERT_TRUE(answer);
  EXPECT_EQ((*answer)["echo"], "pose");
}

TEST_F(Control, ARefusalIsTheServersSentence) {
  bool asked = false;
  const auto server = ControlServer::listen("desk", loop_, [&](const Request& request, const ControlServer::Reply& reply) {
    asked = true;
    refuse(request, reply);
  });
  Result<nlohmann::json> answer;
  std::thread client([&] { answer = ask("desk", {}); });
  while (!asked) loop_.turn();
  client.join();
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().what, "no");
}

TEST_F(Control, ALivingRigKeepsItsNameAndADeadOneDoesNot) {
  auto first = ControlServer::listen("desk", loop_, refuse);
  ASSERT_TRUE(first);
  const auto second = ControlServer::listen("desk", loop_, refuse);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().what, HasSubstr("'desk' is up already"));

  const auto path = socket_of("desk").value();
  const auto kept = folder_ / "kept";
  std::filesystem::rename(path, kept);  // what a supervisor that was killed leaves: a socket file nobody listens at
  first->reset();
  std::filesystem::rename(kept, path);
  EXPECT_TRUE(ControlServer::listen("desk", loop_, refuse));
}

TEST_F(Control, TheSocketFileGoesWithTheServer) {
  EXPECT_THAT(living_rigs().value(), IsEmpty());
  {
    const auto server = ControlServer::listen("desk", loop_, refuse);
    EXPECT_THAT(living_rigs().value(), ElementsAre("desk"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(runtime_folder().value()));
}

TEST_F(Control, WithoutARigTheSentenceSaysHowToStartOne) {
  const auto rig = choose_rig("");
  ASSERT_FALSE(rig);
  EXPECT_THAT(rig.error().what, HasSubstr("handcast up"));
}

TEST_F(Control, TheOnlyRigNeedsNoNameAndOneOfSeveralDoes) {
  const auto desk = ControlServer::listen("desk", loop_, refuse);
  EXPECT_EQ(choose_rig("").value(), "desk");
  const auto wall = ControlServer::listen("wall", loop_, refuse);
  const auto unnamed = choose_rig("");
  ASSERT_FALSE(unnamed);
  EXPECT_THAT(unnamed.error().what, HasSubstr("desk, wall"));
  EXPECT_EQ(choose_rig("wall").value(), "wall");
  EXPECT_FALSE(choose_rig("floor"));
}

TEST_F(Control, AFolderThatOthersMayEnterIsNotUsed) {
  const auto folder = runtime_folder().value();
  chmod(folder.c_str(), 0755);
  const auto again = runtime_folder();
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().what, HasSubstr("0700"));
}

TEST_F(Control, ARigsNameCannotLeaveTheFolder) {
  for (const auto* name : {"", "../desk", "a/b", ".", "a b"}) EXPECT_FALSE(socket_of(name)) << name;
  EXPECT_FALSE(socket_of(std::string(200, 'x')));
}

}  // namespace
}  // namespace handcast::supervisor
