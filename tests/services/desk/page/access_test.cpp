// SPDX-License-Identifier: Apache-2.0
// Who may do what.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/services/desk/page/open_page.hpp"

namespace handcast::test {
namespace {

using control::Role;
using testing::HasSubstr;

constexpr const char* kDim = R"({"set":["projector.brightness=0.5"]})";

TEST_F(PageTest, ThePageItselfIsForEverybodyAndEverythingElseNeedsAToken) {
  const auto page = ask(port_, "GET", "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("<title>handcast desk"));
  EXPECT_THAT(page.head, HasSubstr("Content-Security-Policy: default-src 'none'"));
  for (const auto* path : {"/api/start", "/api/events", "/api/picture", "/api/set", "/nothing"})
    EXPECT_EQ(ask(port_, "GET", path).status, 401) << path;
  EXPECT_EQ(ask(port_, "POST", "/api/set", {{"Origin", address_.url}}, kDim).status, 401);
  EXPECT_TRUE(panel_.sets.empty());
}

TEST_F(PageTest, AViewerLooksAnOperatorChangesAnOwnerSaves) {
  EXPECT_EQ(ask(port_, "GET", "/api/start", as(Role::viewer)).status, 200);
  EXPECT_EQ(post("/api/set", kDim, Role::viewer).status, 403);
  EXPECT_EQ(post("/api/cue", R"({"do":"go"})", Role::viewer).status, 403);
  EXPECT_TRUE(panel_.sets.empty());

  EXPECT_EQ(post("/api/set", kDim, Role::operator_).status, 200);
  EXPECT_EQ(panel_.value("projector.brightness"), "0.5");
  EXPECT_EQ(panel_.source(), "page operator 127.0.0.1");
  for (const auto* path : {"/api/save", "/api/preset/store", "/api/service/restart"})
    EXPECT_EQ(post(path, R"({"name":"a","service":"pose"})", Role::operator_).status, 403) << path;
  EXPECT_TRUE(panel_.presets().empty());

  EXPECT_EQ(post("/api/save", "{}", Role::owner).status, 200);
  EXPECT_EQ(post("/api/preset/store", R"({"name":"a"})", Role::owner).status, 200);
  EXPECT_EQ(panel_.presets(), std::vector<std::string>{"a"});
}

TEST_F(PageTest, ATokenThatIsNoneIsRefusedInEveryPlace) {
  const auto& owner = address_.tokens[2];
  for (const auto& token : {std::string(), owner.substr(1), owner + "0", std::string(64, '0'),
                            owner.substr(0, 63) + (owner[63] == '0' ? "1" : "0")}) {
    EXPECT_EQ(ask(port_, "GET", "/api/start", {{"Authorization", "Bearer " + token}}).status, 401);
    EXPECT_EQ(
        ask(port_, "GET", "/api/start", {{"Cookie", "handcast-" + rig_.name + "=" + token}}).status,
        401);
    const auto session = ask(port_, "POST", "/api/session", {{"Origin", address_.url}},
                             R"({"token":")" + token + "\"}");
    EXPECT_EQ(session.status, 401);
    EXPECT_EQ(session.head.find("Set-Cookie"), std::string::npos);
  }
  EXPECT_EQ(ask(port_, "GET", "/api/start", {{"Cookie", "handcast-other=" + owner}}).status, 401);
  EXPECT_EQ(ask(port_, "GET", "/api/start?token=" + owner).status, 401);
}

TEST_F(PageTest, ABrowserTradesTheTokenForACookieOfThisSiteAlone) {
  const auto session = ask(port_, "POST", "/api/session", {{"Origin", address_.url}},
                           R"({"token":")" + address_.tokens[1] + "\"}");
  EXPECT_EQ(session.status, 200);
  EXPECT_THAT(session.head, HasSubstr("HttpOnly; SameSite=Strict"));
  const std::pair<std::string, std::string> cookie{
      "Cookie", "a=b; handcast-" + rig_.name + "=" + address_.tokens[1]};
  EXPECT_EQ(ask(port_, "GET", "/api/start", {cookie}).status, 200);
  EXPECT_EQ(ask(port_, "POST", "/api/set", {cookie, {"Origin", address_.url}}, kDim).status, 200);
  EXPECT_EQ(panel_.sets.size(), 1u);
}

TEST_F(PageTest, PagesOfOtherSitesAndOtherNamesAreRefused) {
  const std::pair<std::string, std::string> cookie{
      "Cookie", "handcast-" + rig_.name + "=" + address_.tokens[2]};
  const auto local = fmt::format("localhost:{}", port_);
  for (const HttpHeaders& headers : {
           HttpHeaders{cookie},  // a form of another site, in an old browser
           HttpHeaders{cookie, {"Origin", "http://evil.example"}},
           HttpHeaders{cookie, {"Origin", "null"}},
           HttpHeaders{cookie, {"Origin", "http://" + local}},
           HttpHeaders{cookie, {"Origin", address_.url}, {"Host", "evil.example"}},
           HttpHeaders{cookie, {"Origin", "http://evil.example"}, {"Host", "evil.example"}},
           HttpHeaders{cookie, {"Origin", address_.url}, {"Sec-Fetch-Site", "cross-site"}},
       })
    EXPECT_EQ(ask(port_, "POST", "/api/set", headers, kDim).status, 403);
  EXPECT_EQ(ask(port_, "GET", "/", {{"Host", "evil.example"}}).status, 403);
  EXPECT_TRUE(panel_.sets.empty());
  EXPECT_EQ(
      ask(port_, "POST", "/api/set", {cookie, {"Host", local}, {"Origin", "http://" + local}}, kDim)
          .status,
      200);
}

TEST_F(PageTest, NothingChangesByGet) {
  for (const auto* path :
       {"/api/set", "/api/undo", "/api/redo", "/api/show", "/api/cue", "/api/preset/load",
        "/api/preset/store", "/api/save", "/api/service/restart", "/api/service/swap"})
    EXPECT_EQ(ask(port_, "GET", path, as(Role::owner)).status, 405) << path;
  for (const auto* method : {"PUT", "DELETE", "OPTIONS", "PATCH", "TRACE"})
    EXPECT_EQ(ask(port_, method, "/api/set", as(Role::owner)).status, 405) << method;
  EXPECT_TRUE(panel_.sets.empty());
  EXPECT_EQ(cues_.place()->current, -1);
}

TEST_F(PageTest, ARestartKeepsAddressAndTokens) {
  const auto before = address_;
  open();
  EXPECT_EQ(address_.url, before.url);
  EXPECT_EQ(address_.tokens, before.tokens);
}

TEST_F(PageTest, RenewedTokensEndWhatIsOpenWithTheOldOnes) {
  const auto events = stream("/api/events", Role::viewer, "event: values");
  auto renewed = address_;
  renewed.tokens = control::new_tokens();
  ASSERT_TRUE(control::write_desk_file(*control::desk_file(rig_.name), renewed));
  EXPECT_EQ(ask(port_, "GET", "/api/start", as(Role::owner)).status, 401);  // a replayed token
  events->receive();
  EXPECT_TRUE(events->is_closed());
  address_ = renewed;
  EXPECT_EQ(ask(port_, "GET", "/api/start", as(Role::owner)).status, 200);
}

TEST_F(PageTest, TheTokensAreForThisUserAlone) {
  const auto file = *control::desk_file(rig_.name);
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  ASSERT_EQ(::stat(file.parent_path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0700u);
  EXPECT_NE(address_.tokens[0], address_.tokens[1]);
  EXPECT_NE(address_.tokens[1], address_.tokens[2]);
}

TEST_F(PageTest, AFolderThatOthersMayReadIsNotUsed) {
  const auto folder = control::desk_file(rig_.name)->parent_path();
  ASSERT_EQ(::chmod(folder.c_str(), 0755), 0);
  const auto file = control::desk_file(rig_.name);
  EXPECT_TRUE(!file || file->parent_path() != folder);
}

TEST_F(PageTest, ItIsServedOnThisComputerAlone) {
  for (const auto* listen :
       {"0.0.0.0:8480", "10.0.0.7:8480", "127.0.0.1", "127.0.0.1:x", ":8480", "127.0.0.1:70000"}) {
    rig_.desk.page.listen = listen;
    const auto page = desk::open_page(rig_, {panel_});
    ASSERT_FALSE(page) << listen;
    EXPECT_EQ(page.error().code, Errc::bad_config) << listen;
  }
  rig_.desk.page.listen = "";
  EXPECT_EQ(*desk::open_page(rig_, {panel_}), nullptr);
}

}  // namespace
}  // namespace handcast::test
