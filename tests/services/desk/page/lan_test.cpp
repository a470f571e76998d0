// SPDX-License-Identifier: Apache-2.0
// The page for other computers: encrypted, and opened by a code.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "ipc/control/pairing.hpp"
#include "services/desk/page/certificate.hpp"
#include "services/desk/page/http_server.hpp"
#include "tests/services/desk/page/open_page.hpp"
#include "tests/services/desk/page/tls_client.hpp"

namespace handcast::test {
namespace {

using control::Role;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kDimmed = R"({"set":["projector.brightness=0.5"]})";

/// A page that other computers may open. Those of the test are this one.
class LanTest : public PageTest {
 protected:
  LanTest() {
    rig_.desk.page.lan = "127.0.0.1:0";
    open_lan();
  }
  void open_lan() {
    open();
    ASSERT_TRUE(address_.lan);
    lan_port_ = address_.lan->port;
  }

  std::filesystem::path file(const char* extension) const {
    return control::desk_file(rig_.name)->replace_extension(extension);
  }
  std::string own_origin() const { return fmt::format("https://127.0.0.1:{}", lan_port_); }
  /// A code as `handcast desk --lan` makes it.
  std::string new_code(Role role) const {
    const auto pairing = control::new_pairing(role);
    EXPECT_TRUE(control::write_pairing(file(".pair"), pairing));
    return pairing.code;
  }
  Answer enter(const std::string& code) const {
    return ask_encrypted(lan_port_, "POST", "/api/pair", {{"Origin", own_origin()}},
                         R"({"code":")" + code + "\"}");
  }
  static std::string other_than(std::string code) {
    code[0] = code[0] == '0' ? '1' : '0';
    return code;
  }
  static std::pair<std::string, std::string> cookie_of(const Answer& answer) {
    const auto at = answer.head.find("Set-Cookie: ");
    if (at == std::string::npos) return {"Cookie", ""};
    const auto begin = at + 12;
    return {"Cookie", answer.head.substr(begin, answer.head.find(';', begin) - begin)};
  }

  std::uint16_t lan_port_ = 0;
};

TEST_F(LanTest, ACodeBecomesACookieThatIsSentEncryptedOnly) {
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/").status, 200);
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/api/start").status, 401);
  const auto entered = enter(new_code(Role::operator_));
  EXPECT_EQ(entered.status, 200) << entered.body;
  EXPECT_THAT(entered.head, HasSubstr("__Host-handcast-"));
  EXPECT_THAT(entered.head, HasSubstr("HttpOnly; SameSite=Strict"));
  EXPECT_THAT(entered.head, HasSubstr("; Secure"));
  const auto cookie = cookie_of(entered);
  const auto start = ask_encrypted(lan_port_, "GET", "/api/start", {cookie});
  EXPECT_THAT(start.body, HasSubstr(R"("role":"operator")"));
  const HttpHeaders from_page{cookie, {"Origin", own_origin()}};
  EXPECT_EQ(ask_encrypted(lan_port_, "POST", "/api/set", from_page, kDimmed).status, 200);
  EXPECT_EQ(ask_encrypted(lan_port_, "POST", "/api/save", from_page, "{}").status, 403);
  EXPECT_EQ(panel_.source(), "page operator 127.0.0.1");
}

TEST_F(LanTest, ACodeIsGoodOnceAndNotAfterItsTime) {
  EXPECT_EQ(enter("00000000").status, 403) << "none was printed";
  const auto code = new_code(Role::owner);
  EXPECT_EQ(enter(code).status, 200);
  const auto again = enter(code);
  EXPECT_EQ(again.status, 403);
  EXPECT_THAT(again.head, Not(HasSubstr("Set-Cookie")));

  auto late = control::new_pairing(Role::owner);
  late.until_ns = now_ns() - 1;
  ASSERT_TRUE(control::write_pairing(file(".pair"), late));
  EXPECT_EQ(enter(late.code).status, 403);
  late.until_ns = now_ns() + 2 * control::kPairingLasts_ns;  // of a computer that was up for longer
  ASSERT_TRUE(control::write_pairing(file(".pair"), late));
  EXPECT_EQ(enter(late.code).status, 403);
}

TEST_F(LanTest, WhoeverGuessesEndsTheCode) {
  const auto code = new_code(Role::owner);
  for (int i = 1; i < 5; ++i) EXPECT_EQ(enter(other_than(code)).status, 401);
  EXPECT_EQ(enter(other_than(code)).status, 403);
  EXPECT_EQ(enter(code).status, 403) << "the right one, too late";
  EXPECT_FALSE(std::filesystem::exists(file(".pair")));

  const auto next = new_code(Role::owner);
  for (int i = 1; i < 5; ++i) enter(other_than(next));
  EXPECT_EQ(enter(next).status, 200) << "a person may mistype";
}

TEST_F(LanTest, ACodeThatMakesNoSenseIsASentence) {
  new_code(Role::owner);
  for (const auto* body : {"", "{}", "[]", R"({"code":7})", R"({"code":null})"})
    EXPECT_EQ(
        ask_encrypted(lan_port_, "POST", "/api/pair", {{"Origin", own_origin()}}, body).status, 400)
        << body;
}

TEST_F(LanTest, CodesAreNotTakenUnencryptedNorFromOtherSites) {
  const auto code = new_code(Role::owner);
  const auto body = R"({"code":")" + code + "\"}";
  EXPECT_EQ(ask(port_, "POST", "/api/pair", {{"Origin", address_.url}}, body).status, 401);
  for (const HttpHeaders& headers :
       {HttpHeaders{}, HttpHeaders{{"Origin", "https://evil.example"}},
        HttpHeaders{{"Origin", fmt::format("http://127.0.0.1:{}", lan_port_)}},
        HttpHeaders{{"Origin", own_origin()}, {"Host", "evil.example"}},
        HttpHeaders{{"Origin", own_origin()}, {"Host", fmt::format("127.0.0.1:{}", port_)}},
        HttpHeaders{{"Origin", "https://evil.example"}, {"Host", "evil.example"}}})
    EXPECT_EQ(ask_encrypted(lan_port_, "POST", "/api/pair", headers, body).status, 403);
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/", {{"Host", "evil.example"}}).status, 403);
  EXPECT_EQ(enter(code).status, 200) << "none of these has used it up";
}

TEST_F(LanTest, TheCookieOfOneDoorDoesNotOpenTheOther) {
  const auto cookie = cookie_of(enter(new_code(Role::owner)));
  EXPECT_EQ(ask(port_, "GET", "/api/start", {cookie}).status, 401);
  const std::pair<std::string, std::string> plain{
      "Cookie", "handcast-" + rig_.name + "=" + address_.tokens[2]};
  EXPECT_EQ(ask(port_, "GET", "/api/start", {plain}).status, 200);
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/api/start", {plain}).status, 401);
}

TEST_F(LanTest, RenewedTokensEndWhatACodeHasOpened) {
  const auto cookie = cookie_of(enter(new_code(Role::owner)));
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/api/start", {cookie}).status, 200);
  auto renewed = address_;
  renewed.tokens = control::new_tokens();
  ASSERT_TRUE(control::write_desk_file(*control::desk_file(rig_.name), renewed));
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/api/start", {cookie}).status, 401);
}

TEST_F(LanTest, WhatIsNotEncryptedGetsNothing) {
  EXPECT_EQ(ask(lan_port_, "GET", "/").status, 0);
  for (const std::string& bytes :
       {std::string(5000, '\0'), std::string("\x16\x03\x01\xff\xff", 5),
        "\x16\x03\x01\x02\x00\x01\x00\x01\xfc" + std::string(600, 'a')}) {
    Wire wire(lan_port_);
    wire.send(bytes);
    wire.receive("HTTP", 0, std::chrono::seconds(1));
  }
  EXPECT_EQ(ask_encrypted(lan_port_, "GET", "/").status, 200);
}

TEST_F(LanTest, ManyThatNeverGreetDoNotKeepOthersOut) {
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 3000; ++i) {
    idle.push_back(std::make_unique<Wire>(lan_port_));
    if (!idle.back()->is_open()) break;
    idle.back()->send("\x16\x03\x01");  // the begin of a greeting
    if (i > 500) idle.erase(idle.begin());
  }
  int status = 0;
  for (int i = 0; i < 1000 && status == 0; ++i) {
    status = ask_encrypted(lan_port_, "GET", "/").status;
    if (status == 0) sleep_until_ns(now_ns() + 20'000'000);
  }
  EXPECT_EQ(status, 200);
  EXPECT_EQ(ask(port_, "GET", "/").status, 200);
}

TEST(EncryptedServer, AGreetingThatStallsIsCutOff) {
  Scratch scratch;
  const auto made = desk::open_certificate(scratch.path() / "a.pem", {"127.0.0.1"});
  ASSERT_TRUE(made) << made.error().what;
  desk::HttpLimits limits;
  limits.request_ns = 300'000'000;
  const auto server = desk::HttpServer::open(
      "127.0.0.1", 0, [](const desk::HttpRequest&) { return desk::HttpAnswer{}; }, limits,
      {made->certificate, made->key});
  ASSERT_TRUE(server) << server.error().what;
  Wire wire((*server)->port());
  bool is_open = wire.send("\x16\x03\x01\x02");
  for (int i = 0; i < 2000 && is_open; ++i) {
    sleep_until_ns(now_ns() + 10'000'000);
    is_open = wire.send("a");
  }
  EXPECT_FALSE(is_open);
  EXPECT_EQ(ask_encrypted((*server)->port(), "GET", "/").status, 200);
}

TEST_F(LanTest, TheCertificateIsForThisUserAloneAndStays) {
  struct stat status {};
  ASSERT_EQ(::stat(file(".pem").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  const auto before = address_.lan->fingerprint;
  EXPECT_EQ(before.size(), 29u) << "ten bytes";
  open_lan();
  EXPECT_EQ(address_.lan->fingerprint, before);
  const TlsWire wire(lan_port_);
  gnutls_datum_t der{};
  const auto text = wire.certificate();
  der.data = reinterpret_cast<unsigned char*>(const_cast<char*>(text.data()));
  der.size = static_cast<unsigned>(text.size());
  std::array<unsigned char, 32> hash{};
  std::size_t size = hash.size();
  ASSERT_EQ(gnutls_fingerprint(GNUTLS_DIG_SHA256, &der, hash.data(), &size), 0);
  EXPECT_EQ(fmt::format("{:02X}", hash[0]), before.substr(0, 2));
  EXPECT_EQ(fmt::format("{:02X}", hash[9]), before.substr(27, 2));
}

TEST_F(LanTest, ACertificateThatIsNoneLeavesThePageOnThisComputer) {
  const auto expect_fault = [&](const char* text) {
    open();
    ASSERT_TRUE(address_.lan);
    EXPECT_THAT(address_.lan->fault, HasSubstr(text));
    EXPECT_EQ(ask(port_, "GET", "/").status, 200);
  };
  std::ofstream(file(".pem")) << "no certificate\n";
  expect_fault("is damaged; remove the file, and `handcast restart desk`");
  ASSERT_EQ(::chmod(file(".pem").c_str(), 0644), 0);
  expect_fault("is not a file of this user alone");
  std::filesystem::remove(file(".pem"));
  std::filesystem::create_directory(file(".pem"));
  expect_fault("is not a file of this user alone");
  std::filesystem::remove(file(".pem"));
  open();
  EXPECT_EQ(address_.lan->fault, "");
}

TEST_F(LanTest, ACertificateThatCannotBeKeptIsASentence) {
  const auto nowhere = scratch_.path() / "none" / "a.pem";
  const auto made = desk::open_certificate(nowhere, {"here"});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, Errc::unavailable);
  EXPECT_THAT(made.error().what, HasSubstr("cannot be kept"));
}

TEST_F(LanTest, APortThatIsTakenLeavesThePageOnThisComputer) {
  const auto taken = fmt::format("127.0.0.1:{}", port_);
  rig_.desk.page.lan = taken;
  open();
  ASSERT_TRUE(address_.lan);
  EXPECT_THAT(address_.lan->fault, HasSubstr("the port is taken"));
}

TEST_F(LanTest, AnAddressThatIsNoneIsRefused) {
  for (const auto* lan : {"8481", "0.0.0.0", "0.0.0.0:x", "0.0.0.0:70000"}) {
    rig_.desk.page.lan = lan;
    const auto page = desk::open_page(rig_, {panel_});
    ASSERT_FALSE(page) << lan;
    EXPECT_EQ(page.error().code, Errc::bad_config);
    EXPECT_THAT(page.error().what, HasSubstr("desk.page.lan"));
  }
}

}  // namespace
}  // namespace handcast::test
