// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/remote.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <thread>

#include "ipc/base/unique_fd.hpp"
#include "renderer/media/picture.hpp"
#include "services/content/projegraphy/studio.hpp"
#include "tests/scratch.hpp"
#include "tests/services/content/projegraphy/shadow_player.hpp"

namespace handcast::projegraphy {
namespace {

using namespace std::chrono_literals;

/// A server that answers each request by a function of it; "" holds the connection.
class LocalServer {
 public:
  using Answer = std::function<std::string(const std::string& request)>;
  explicit LocalServer(Answer answer) : answer_(std::move(answer)) {
    listener_ = UniqueFd(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(bind(listener_.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(listener_.get(), 8), 0);
    getsockname(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
  }
  std::string url() const { return "http://127.0.0.1:" + std::to_string(port_); }
  int requests() const { return requests_; }
  /// The last one; after it was answered.
  const std::string& request() const { return request_; }

 private:
  static bool is_ready(int fd) {
    pollfd waiting{fd, POLLIN, 0};
    return poll(&waiting, 1, 20) == 1;
  }
  void serve(const std::stop_token& stop) {
    std::vector<UniqueFd> held;
    while (!stop.stop_requested()) {
      if (!is_ready(listener_.get())) continue;
      UniqueFd peer(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC));
      request_ = read_from(peer.get(), stop);
      ++requests_;
      const auto answer = answer_(request_);
      if (answer.empty()) {
        held.push_back(std::move(peer));
        continue;
      }
      for (std::size_t sent = 0; sent < answer.size();) {
        const auto now = send(peer.get(), answer.data() + sent, answer.size() - sent, MSG_NOSIGNAL);
        if (now <= 0) break;
        sent += static_cast<std::size_t>(now);
      }
    }
  }
  static std::string read_from(int fd, const std::stop_token& stop) {
    std::string text;
    std::size_t whole = std::string::npos;
    while (text.size() < whole && !stop.stop_requested()) {
      if (!is_ready(fd)) continue;
      char buffer[65536];
      const auto got = recv(fd, buffer, sizeof(buffer), 0);
      if (got <= 0) break;
      text.append(buffer, static_cast<std::size_t>(got));
      const auto end = text.find("\r\n\r\n"), at = text.find("Content-Length: ");
      if (end != text.npos)
        whole =
            end + 4 + static_cast<std::size_t>(at < end ? std::atoi(text.c_str() + at + 16) : 0);
    }
    return text;
  }

  Answer answer_;
  UniqueFd listener_;
  int port_ = 0;
  std::atomic<int> requests_ = 0;
  std::string request_;
  std::jthread thread_;
};

std::string http(int status, const std::string& body) {
  return "HTTP/1.1 " + std::to_string(status) +
         " X\r\nContent-Length: " + std::to_string(body.size()) + "\r\nConnection: close\r\n\r\n" +
         body;
}
/// The reply of a chat.
std::string chat(const std::string& content) {
  std::string quoted;
  for (const char c : content) quoted += c == '"' ? "\\\"" : std::string(1, c);
  return http(200, R"({"choices":[{"message":{"role":"assistant","content":")" + quoted + "\"}}]}");
}

class RemoteTest : public testing::Test {
 protected:
  RemoteTest() {
    player_.hold(animals()[static_cast<std::size_t>(projegraphy::animal_of("cat"))], 0,
                 {0, 0, 0, 0, 0});
    silhouette_ = player_.silhouette();
    servers_.model = "a-model";
    servers_.patience_s = 2;
  }
  Result<int> ask(const LocalServer& server) {
    servers_.recogniser = server.url();
    return remote_.animal_of(servers_, silhouette_, {});
  }

  ShadowPlayer player_{0};
  Silhouette silhouette_;
  Servers servers_;
  Remote remote_;
};

TEST_F(RemoteTest, AGoodServerNamesTheAnimalAndGetsTheMaskAndTheKey) {
  const LocalServer server([](const std::string&) { return chat(R"({"animal": "Owl"})"); });
  servers_.key = "sk-secret";
  const auto animal = ask(server);
  ASSERT_TRUE(animal) << animal.error().what;
  EXPECT_EQ(*animal, projegraphy::animal_of("owl"));
  const auto& request = server.request();
  EXPECT_NE(request.find("POST /v1/chat/completions "), std::string::npos);
  EXPECT_NE(request.find("Authorization: Bearer sk-secret"), std::string::npos);
  EXPECT_NE(request.find("\"a-model\""), std::string::npos);
  EXPECT_NE(request.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
}

TEST_F(RemoteTest, OnlyOurAnimalsInTheRightFormAreTaken) {
  const std::vector<std::string> answers{
      chat("owl"),
      chat(R"({"animal": "unicorn"})"),
      chat(R"({"animal": "None."})"),
      chat(R"({"animal": ["owl"]})"),
      chat(R"(["owl"])"),
      chat(R"({"animal": "owlowlowlowlowlowlowlowlowlowlowl"})"),
      http(200, "<html>owl</html>"),
      http(200, R"({"choices":[]})"),
      http(200, R"({"choices":{"0":{"message":{"content":7}}}})"),
      http(200, ""),
      http(200, std::string(50'000, '['))};
  servers_.per_hour = 100;
  for (const auto& answer : answers) {
    const LocalServer server([&](const std::string&) { return answer; });
    const auto animal = ask(server);
    ASSERT_FALSE(animal) << answer.substr(0, 200);
    EXPECT_EQ(animal.error().code, Errc::bad_data) << animal.error().what;
    EXPECT_EQ(server.requests(), 1);
  }
}

TEST_F(RemoteTest, AServerThatIsBusyIsAskedAgain) {
  int count = 0;
  const LocalServer server([&](const std::string&) {
    return ++count < 3 ? http(503, "busy") : chat(R"({"animal": "bear"})");
  });
  const auto animal = ask(server);
  ASSERT_TRUE(animal) << animal.error().what;
  EXPECT_EQ(server.requests(), 3);
}

TEST_F(RemoteTest, AWrongKeyIsNotTriedAgainAndIsInNoSentence) {
  const LocalServer server([](const std::string&) { return http(401, "who?"); });
  servers_.key = "sk-secret";
  const auto animal = ask(server);
  ASSERT_FALSE(animal);
  EXPECT_EQ(animal.error().code, Errc::bad_config);
  EXPECT_NE(animal.error().what.find("check the key"), std::string::npos);
  EXPECT_EQ(animal.error().what.find("secret"), std::string::npos);
  EXPECT_EQ(server.requests(), 1);
}

TEST_F(RemoteTest, AHugeReplyIsCutOff) {
  const LocalServer server([](const std::string&) { return http(200, std::string(8 << 20, ' ')); });
  const auto animal = ask(server);
  ASSERT_FALSE(animal);
  EXPECT_EQ(animal.error().code, Errc::bad_data);
  EXPECT_NE(animal.error().what.find("more than"), std::string::npos) << animal.error().what;
}

TEST_F(RemoteTest, AServerThatIsSilentOrAbsentIsGivenUp) {
  servers_.patience_s = 0.2;
  servers_.tries = 2;
  std::string absent;
  {
    const LocalServer server([](const std::string&) { return ""; });
    const auto animal = ask(server);
    ASSERT_FALSE(animal);
    EXPECT_EQ(animal.error().code, Errc::timeout) << animal.error().what;
    EXPECT_EQ(server.requests(), 2);
    EXPECT_FALSE(ask(server));  // it is left alone
    EXPECT_EQ(server.requests(), 2);
    absent = server.url();
  }
  servers_.recogniser = absent;
  const auto animal = Remote().animal_of(servers_, silhouette_, {});
  ASSERT_FALSE(animal);
  EXPECT_EQ(animal.error().code, Errc::unavailable) << animal.error().what;
}

TEST_F(RemoteTest, TheBudgetOfAnHourIsKept) {
  const LocalServer server([](const std::string&) { return chat(R"({"animal": "bear"})"); });
  servers_.per_hour = 2;
  EXPECT_TRUE(ask(server));
  EXPECT_TRUE(ask(server));
  const auto third = ask(server);
  ASSERT_FALSE(third);
  EXPECT_NE(third.error().what.find("are spent"), std::string::npos);
  EXPECT_EQ(server.requests(), 2);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  int bits = 0;
  std::uint32_t group = 0;
  for (const unsigned char c : bytes) {
    group = group << 8 | c;
    for (bits += 8; bits >= 6;) text += kDigits[group >> (bits -= 6) & 63];
  }
  if (bits > 0) text += kDigits[group << (6 - bits) & 63];
  while (text.size() % 4) text += '=';
  return text;
}

TEST_F(RemoteTest, AServerPaintsInTheShapeOfTheMask) {
  renderer::Image<std::uint8_t> grey(64, 64, 200);
  grey.at(0, 0) = 7;
  const auto png = renderer::png_of(std::as_const(grey).view());
  ASSERT_TRUE(png);
  const LocalServer server(
      [&](const std::string&) { return http(200, R"({"images":[")" + base64(*png) + "\"]}"); });
  servers_.painter = server.url() + "/";
  const auto picture = remote_.picture_of(servers_, silhouette_, "owl", {});
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->width(), kPictureSide_px);
  EXPECT_EQ(picture->at(0, 0), 0xff070707u);
  EXPECT_EQ(picture->at(kPictureSide_px - 1, 300), 0xffc8c8c8u);
  EXPECT_NE(server.request().find("POST /sdapi/v1/txt2img "), std::string::npos);
  EXPECT_NE(server.request().find("A cute owl"), std::string::npos);
  EXPECT_NE(server.request().find("controlnet"), std::string::npos);
  EXPECT_EQ(server.request().find("Authorization"), std::string::npos);
}

TEST_F(RemoteTest, WhatIsNoPictureIsNotShown) {
  renderer::Image<std::uint8_t> large(2400, 8, 1);
  const auto too_large = base64(*renderer::png_of(std::as_const(large).view()));
  for (const std::string& body :
       {std::string(R"({"images":[]})"), std::string(R"({"images":["%%%"]})"),
        std::string(R"({"images":["iVBORw0KGgoAAAA="]})"), std::string(R"({"images":[7]})"),
        R"({"images":[")" + too_large + "\"]}"}) {
    const LocalServer server([&](const std::string&) { return http(200, body); });
    servers_.painter = server.url();
    const auto picture = remote_.picture_of(servers_, silhouette_, "owl", {});
    ASSERT_FALSE(picture) << body.substr(0, 100);
    EXPECT_EQ(picture.error().code, Errc::bad_data);
  }
}

TEST_F(RemoteTest, WhatIsBuiltInTakesOver) {
  const std::array meshes{&content::made_hand(content::Side::left),
                          &content::made_hand(content::Side::right)};
  const LocalServer wrong([](const std::string&) { return http(200, "no"); });
  servers_.recogniser = servers_.painter = wrong.url();
  Studio studio(meshes);
  const auto alone = studio.order(silhouette_), helped = studio.order(silhouette_, servers_);
  ASSERT_NE(alone, helped);
  alone->wait();
  helped->wait();
  ASSERT_TRUE(helped->recognised());
  EXPECT_EQ(helped->recognised()->animal, projegraphy::animal_of("cat"));
  EXPECT_EQ(helped->picture().pixels(), alone->picture().pixels());
  EXPECT_EQ(wrong.requests(), 2);
}

TEST_F(RemoteTest, HandsThatLookLikeNoAnimalGetACalmPicture) {
  const LocalServer server([](const std::string&) { return chat(R"({"animal": "none"})"); });
  servers_.recogniser = servers_.painter = server.url();
  Studio studio(
      {&content::made_hand(content::Side::left), &content::made_hand(content::Side::right)});
  const auto order = studio.order(silhouette_, servers_);
  order->wait();
  ASSERT_TRUE(order->recognised());
  EXPECT_LT(order->recognised()->animal, 0);
  EXPECT_EQ(order->picture().pixels(), calm_picture().pixels());
  EXPECT_EQ(server.requests(), 1) << "the painter is not asked";
}

/// A ComfyUI whose job is done when it is asked for the third time.
class ComfyUiTest : public RemoteTest {
 protected:
  ComfyUiTest() {
    renderer::Image<std::uint8_t> grey(64, 64, 200);
    grey.at(0, 0) = 7;
    picture_ = *renderer::png_of(std::as_const(grey).view());
    servers_.workflow =
        R"({"3": {"class_type": "KSampler", "inputs": {"positive": ["6", 0]}},
            "6": {"class_type": "CLIPTextEncode", "inputs": {"text": "HANDCAST_PROMPT, soft"}},
            "10": {"class_type": "LoadImage", "inputs": {"image": "HANDCAST_MASK"}}})";
  }
  std::string answer(const std::string& request) {
    if (request.starts_with("POST /upload/image ")) return upload_ = request, uploaded_;
    if (request.starts_with("POST /prompt ")) return prompt_ = request, queued_;
    if (request.starts_with("GET /history/job-1 "))
      return ++asked_ < 3 ? http(200, "{}") : history_;
    if (request.starts_with("GET /view?filename=out%201.png&subfolder=&type=output "))
      return http(200, picture_);
    return http(404, "");
  }
  /// The error of the server, as it is now.
  Error error() {
    const LocalServer server([this](const std::string& request) { return answer(request); });
    servers_.painter = server.url();
    const auto picture = Remote().picture_of(servers_, silhouette_, "owl", {});
    return picture ? Error{Errc::timeout, "no error"} : picture.error();
  }

  std::string upload_, prompt_, picture_;
  int asked_ = 0;
  std::string uploaded_ =
                  http(200, R"({"name": "handcast.png", "subfolder": "", "type": "input"})"),
              queued_ = http(200, R"({"prompt_id": "job-1", "number": 4, "node_errors": {}})"),
              history_ = http(200, R"({"job-1": {"outputs": {"8": {"text": ["a"]}, "9": {"images":
                [{"filename": "out 1.png", "subfolder": "", "type": "output"}]}}}})");
};

TEST_F(ComfyUiTest, PaintsByAWorkflowInTheShapeOfTheMask) {
  const LocalServer server([this](const std::string& request) { return answer(request); });
  servers_.painter = server.url() + "/";
  const auto picture = remote_.picture_of(servers_, silhouette_, "owl", {});
  ASSERT_TRUE(picture) << picture.error().what;
  EXPECT_EQ(picture->width(), kPictureSide_px);
  EXPECT_EQ(picture->at(0, 0), 0xff070707u);
  EXPECT_NE(upload_.find("Content-Type: multipart/form-data; boundary="), std::string::npos);
  EXPECT_NE(upload_.find("\x89PNG"), std::string::npos);
  EXPECT_NE(prompt_.find(R"("text":"A cute owl, centred, plain background, soft")"),
            std::string::npos)
      << prompt_;
  EXPECT_NE(prompt_.find(R"("image":"handcast.png")"), std::string::npos);
  EXPECT_EQ(asked_, 3);
}

TEST_F(ComfyUiTest, OneThatDoesNotComeToAnEndIsLeftAlone) {
  history_ = http(200, "{}");
  servers_.patience_s = 0.6;
  const LocalServer server([this](const std::string& request) { return answer(request); });
  servers_.painter = server.url();
  const auto picture = remote_.picture_of(servers_, silhouette_, "owl", {});
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().code, Errc::timeout) << picture.error().what;
  const int requests = server.requests();
  EXPECT_FALSE(remote_.picture_of(servers_, silhouette_, "owl", {}));
  EXPECT_EQ(server.requests(), requests);
}

TEST_F(ComfyUiTest, WrongAndHugeAnswersAreErrorsAndNoPictures) {
  const auto with = [this](std::string& answer, const std::string& wrong) {
    const auto right = std::exchange(answer, wrong);
    asked_ = 0;
    auto found = error();
    answer = right;
    return found;
  };
  for (const char* body : {"", "no", "[]", R"({"name": 7})"})
    EXPECT_EQ(with(uploaded_, http(200, body)).code, Errc::bad_data) << body;
  for (const char* body :
       {"", "{}", R"({"prompt_id": "../../view"})", R"({"prompt_id": ["job-1"]})"})
    EXPECT_EQ(with(queued_, http(200, body)).code, Errc::bad_data) << body;
  for (const char* body :
       {"[]", R"({"job-1": {}})", R"({"job-1": {"outputs": {}}})",
        R"({"job-1": {"outputs": {"9": {"images": [{"filename": 7}]}}}})", R"({"job-1": [7]})"})
    EXPECT_EQ(with(history_, http(200, body)).code, Errc::bad_data) << body;
  EXPECT_EQ(with(history_, http(200, std::string(4 << 20, ' '))).code, Errc::bad_data);
  EXPECT_EQ(with(picture_, "GIF89a").code, Errc::bad_data);
  EXPECT_EQ(with(picture_, std::string(30 << 20, ' ')).code, Errc::bad_data);
  EXPECT_EQ(with(queued_, http(400, "the workflow is wrong")).code, Errc::bad_data);
}

TEST_F(ComfyUiTest, OneThatIsSilentOrAbsentIsGivenUp) {
  uploaded_ = "";
  servers_.patience_s = 0.2;
  servers_.tries = 1;
  EXPECT_EQ(error().code, Errc::timeout);
  servers_.painter = "http://127.0.0.1:1";
  EXPECT_EQ(remote_.picture_of(servers_, silhouette_, "owl", {}).error().code, Errc::unavailable);
}

TEST(Workflow, IsOneForTheApiWithPlacesForPromptAndMask) {
  const test::Scratch scratch;
  const auto file = scratch.path() / "workflow.json";
  const auto fault_of = [&](const std::string& text) {
    std::ofstream(file) << text;
    const auto workflow = read_workflow(file.string());
    return workflow ? "" : workflow.error().what;
  };
  EXPECT_EQ(fault_of(R"({"1": {"class_type": "A", "inputs": {"t": "HANDCAST_PROMPT"}},
                         "2": {"class_type": "B", "inputs": {"image": "HANDCAST_MASK"}}})"),
            "");
  for (const char* wrong : {"", "{}", "[]", R"({"1": {"class_type": "HANDCAST_PROMPT"}})",
                            R"({"nodes": [{"type": "HANDCAST_PROMPT HANDCAST_MASK"}]})"})
    EXPECT_NE(fault_of(wrong).find("export it for the API"), std::string::npos) << wrong;
  EXPECT_FALSE(read_workflow("/nowhere/workflow.json"));
}

// A silent server must not hold up the end of the program.
TEST_F(RemoteTest, AStudioEndsWhileAServerIsSilent) {
  const LocalServer server([](const std::string&) { return ""; });
  servers_.recogniser = server.url();
  servers_.patience_s = 600;
  std::shared_ptr<const Order> order;
  {
    Studio studio(
        {&content::made_hand(content::Side::left), &content::made_hand(content::Side::right)});
    order = studio.order(silhouette_, servers_);
    while (server.requests() == 0) std::this_thread::sleep_for(5ms);
  }
  EXPECT_TRUE(order->is_done());
}

TEST(Key, IsForTheServerThatItsFileNamesAndSaysNothingOfItself) {
  const test::Scratch scratch;
  const auto file = scratch.path() / "key";
  const auto write = [&](const std::string& text) { std::ofstream(file) << text; };
  write("https://api.example.org/ sk-abc\n");
  const auto key = read_key(file.string());
  ASSERT_TRUE(key) << key.error().what;
  EXPECT_EQ(key->for_server("https://api.example.org"), "sk-abc");
  for (const char* other : {"https://api.example.org.evil.net", "http://api.example.org",
                            "https://api.example.org:444", "https://evil.net", ""})
    EXPECT_EQ(key->for_server(other), "") << other;
  EXPECT_EQ(ServerKey().for_server(""), "");
  // Any other file of one word, e.g. a password, is none.
  for (const char* wrong :
       {"", "secret", "https://api.example.org", "secret secret",
        "https://api.example.org secret secret", "https://api.example.org secr\x01et"}) {
    write(wrong);
    const auto refused = read_key(file.string());
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().what.find("secret"), std::string::npos);
  }
  EXPECT_FALSE(read_key("/nowhere/key"));
}

}  // namespace
}  // namespace handcast::projegraphy
