// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/film.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include "renderer/media/jpeg.hpp"
#include "services/content/source.hpp"
#include "tests/scratch.hpp"

using namespace handcast;
using namespace handcast::content;
using namespace std::chrono_literals;
using renderer::Texture;
using testing::HasSubstr;

namespace {

constexpr int kWidth = 64, kHeight = 40;

/// A film of frames at 10 Hz whose red is 20, 40, 60, …
void write_film(const std::string& file, int count) {
  auto film = renderer::Film::create(file, kWidth, kHeight);
  ASSERT_TRUE(film) << film.error().what;
  for (int i = 0; i < count; ++i) {
    const Texture picture(kWidth, kHeight, 0xff008000u + 20u * (static_cast<std::uint32_t>(i) + 1));
    auto all = picture;
    ASSERT_TRUE(film->add(renderer::jpeg_of(all.view()), i * 100'000'000ll));
  }
}

class FilmTest : public testing::Test {
 protected:
  std::string file(const char* name) { return scratch_.path() / name; }
  Result<std::unique_ptr<Source>> open(
      const std::string& what, std::vector<std::pair<std::string, std::string>> parameters = {},
      std::string kind = "film") {
    Opening opening;
    opening.element = {std::move(kind), what, std::move(parameters)};
    opening.width = kWidth;
    opening.height = kHeight;
    return open_source(opening);
  }
  Result<bool> draw(Source& source, double time_s) {
    Moment moment;
    moment.time_s = time_s;
    return source.draw(moment, {}, out_);
  }
  /// The number of the frame that is shown, from 0.
  int shown() const { return static_cast<int>((out_.at(30, 20) & 255) + 10) / 20 - 1; }
  /// Draws the same moment until this frame is shown: it may not be decoded yet.
  void expect_frame(Source& source, double time_s, int frame) {
    for (int i = 0; i < 5000; ++i) {
      const auto drew = draw(source, time_s);
      ASSERT_TRUE(drew) << drew.error().what;
      if (shown() == frame) return;
      std::this_thread::sleep_for(2ms);
    }
    FAIL() << "at " << time_s << " s frame " << shown() << " is shown, not " << frame;
  }

  /// What the source said last. A device's first error may take long: FFmpeg's inputs are loaded
  /// for it, hundred libraries from a disk that may be busy.
  Result<bool> draw_until_an_error(Source& source) {
    Result<bool> drew = false;
    for (int i = 0; i < 60'000 && drew; ++i, std::this_thread::sleep_for(1ms))
      drew = draw(source, 0.001 * i);
    return drew;
  }

  test::Scratch scratch_;
  Texture out_{kWidth, kHeight};
};

TEST_F(FilmTest, ShowsTheFrameOfTheTimeInItsColours) {
  write_film(file("a.avi"), 10);
  auto source = open(file("a.avi"));
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(draw(**source, 0), true);
  EXPECT_EQ(shown(), 0);
  const auto pixel = out_.at(30, 20);
  EXPECT_NEAR(pixel & 255, 20, 3);
  EXPECT_NEAR(pixel >> 8 & 255, 128, 3);
  EXPECT_NEAR(pixel >> 16 & 255, 0, 3);
  EXPECT_EQ(pixel >> 24, 255u);
  EXPECT_EQ(draw(**source, 0.05), false);
  expect_frame(**source, 0.1, 1);
  expect_frame(**source, 0.35, 3);
}

TEST_F(FilmTest, LoopsUnlessItShallNot) {
  write_film(file("a.avi"), 5);
  auto loop = open(file("a.avi"));
  for (int round = 0; round < 3; ++round)
    for (int i = 0; i < 5; ++i) expect_frame(**loop, 0.5 * round + 0.1 * i + 0.05, i);
  auto once = open(file("a.avi"), {{"loop", "false"}});
  for (int i = 0; i < 5; ++i) expect_frame(**once, 0.1 * i + 0.05, i);
  for (int i = 5; i < 30; ++i) EXPECT_EQ(draw(**once, 0.1 * i), false);
  EXPECT_EQ(shown(), 4);
}

TEST_F(FilmTest, SpeedAndStartAreOfTheFilm) {
  write_film(file("a.avi"), 10);
  auto source = open(file("a.avi"), {{"start", "0.5"}, {"speed", "2"}});
  ASSERT_TRUE(source);
  expect_frame(**source, 3, 5);
  expect_frame(**source, 3.11, 7);
  ASSERT_TRUE((*source)->set("speed", "0"));
  EXPECT_EQ(draw(**source, 9), false);
  ASSERT_TRUE((*source)->set("start", "0.25"));
  expect_frame(**source, 10, 2);
  EXPECT_THAT((*source)->set("speed", "-1").error().what, HasSubstr("0 to 10"));
  EXPECT_THAT((*source)->set("sped", "1").error().what, HasSubstr("speed"));
}

TEST_F(FilmTest, AStartBehindTheEndIsTheBeginning) {
  write_film(file("a.avi"), 10);
  auto source = open(file("a.avi"), {{"start", "100"}});
  ASSERT_TRUE(source);
  for (int i = 0; i < 5000 && draw(**source, 0.001 * i) == false; ++i)
    std::this_thread::sleep_for(1ms);
  EXPECT_GE(shown(), 0);
}

TEST_F(FilmTest, BadFilesAreSentences) {
  EXPECT_THAT(open(file("none.mp4")).error().what, HasSubstr("none.mp4"));
  std::ofstream(file("text.mp4")) << "no film";
  EXPECT_THAT(open(file("text.mp4")).error().what, HasSubstr("no film that FFmpeg can read"));
  write_film(file("a.avi"), 5);
  std::filesystem::resize_file(file("a.avi"), 150);  // in its header
  EXPECT_EQ(open(file("a.avi")).error().code, Errc::bad_config);
}

TEST_F(FilmTest, AFilmWithoutADecodableFrameIsRefused) {
  write_film(file("a.avi"), 3);
  std::fstream film(file("a.avi"), std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(film), {});
  const auto first = bytes.find("\xff\xd8\xff");
  film.clear();
  film.seekp(static_cast<std::streamoff>(first));
  film << std::string(bytes.rfind("idx1") - first, 'U');
  film.close();
  EXPECT_EQ(open(file("a.avi")).error().code, Errc::bad_config);
}

TEST_F(FilmTest, DamagedFramesArePassedOver) {
  write_film(file("a.avi"), 10);
  std::fstream film(file("a.avi"), std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(film), {});
  auto at = bytes.find("\xff\xd8\xff");
  for (int i = 0; i < 4; ++i) at = bytes.find("\xff\xd8\xff", at + 3);
  film.clear();
  film.seekp(static_cast<std::streamoff>(at));
  film << std::string(200, '\x55');
  film.close();
  auto source = open(file("a.avi"));
  ASSERT_TRUE(source);
  expect_frame(**source, 0, 0);
  expect_frame(**source, 0.35, 3);
  EXPECT_EQ(draw(**source, 0.41), false);
  EXPECT_EQ(shown(), 3);
  expect_frame(**source, 0.55, 5);
}

TEST_F(FilmTest, IsStaleWhenItsFileChanges) {
  write_film(file("a.avi"), 2);
  auto source = open(file("a.avi"));
  EXPECT_FALSE((*source)->is_stale());
  std::filesystem::last_write_time(file("a.avi"),
                                   std::filesystem::file_time_type::clock::now() + 5s);
  EXPECT_TRUE((*source)->is_stale());
}

TEST_F(FilmTest, ManyOpeningsAndClosingsLeaveNoThreadWaiting) {
  write_film(file("a.avi"), 5);
  for (int i = 0; i < 50; ++i) {
    auto source = open(file("a.avi"));
    ASSERT_TRUE(source);
    if (i % 2 == 0) (void)draw(**source, 0.2);
  }
}

TEST_F(FilmTest, AFilmOfATelephoneIsTurnedAndPlays) {
  const char* data = std::getenv("HANDCAST_DATA");
  const auto film = std::string(data ? data : "") + "/cases/films/variable.mov";
  if (!std::filesystem::exists(film)) GTEST_SKIP() << "HANDCAST_DATA has no folder 'cases'";
  auto source = open(film);
  ASSERT_TRUE(source) << source.error().what;
  EXPECT_EQ(draw(**source, 0), true);
}

/// What a server does after its bytes.
enum class Then { falls_silent, hangs_up };

/// A server that gives each client these bytes.
class ByteServer {
 public:
  ByteServer(std::string bytes, Then then)
      : bytes_(std::move(bytes)), listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    (void)::bind(listening_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    (void)::listen(listening_, 8);
    socklen_t size = sizeof address;
    (void)::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
    address_ = "tcp://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this, then] {
      for (int client; (client = ::accept(listening_, nullptr, nullptr)) >= 0;) {
        clients_.push_back(client);
        ++accepted_;
        (void)::send(client, bytes_.data(), bytes_.size(), MSG_NOSIGNAL);
        if (then == Then::hangs_up) ::shutdown(client, SHUT_WR);
      }
    });
  }
  ~ByteServer() {
    ::shutdown(listening_, SHUT_RDWR);
    thread_.join();
    for (const int client : clients_) ::close(client);
    ::close(listening_);
  }
  const std::string& address() const { return address_; }
  int accepted() const { return accepted_; }

 private:
  std::string bytes_;
  int listening_;
  std::string address_;
  std::vector<int> clients_;
  std::atomic<int> accepted_ = 0;
  std::thread thread_;
};

TEST_F(FilmTest, AStreamThatStallsKeepsItsLastPictureAndConnectsAgain) {
  write_film(file("a.avi"), 20);
  std::ifstream film(file("a.avi"), std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(film), {});
  bytes.resize(bytes.size() / 2);
  ByteServer server(std::move(bytes), Then::falls_silent);
  auto source = open(server.address());
  ASSERT_TRUE(source) << source.error().what;
  int pictures = 0, troubles = 0;
  for (int i = 0; i < 30'000 && (server.accepted() < 2 || troubles == 0); ++i) {
    const auto drew = draw(**source, 0.001 * i);
    if (drew && *drew) ++pictures;
    if (!drew) {
      ++troubles;
      EXPECT_EQ(drew.error().code, Errc::timeout);
      EXPECT_THAT(drew.error().what, HasSubstr("has sent nothing for 3 s"));
      EXPECT_GT(out_.at(3, 3), 0u);
    }
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_GT(pictures, 1);
  EXPECT_EQ(troubles, 1);
  EXPECT_GE(server.accepted(), 2);
}

TEST_F(FilmTest, AStreamOfOnePictureThatEndsIsShown) {
  Texture picture(kWidth, kHeight, 0xff008050);
  const auto jpeg = renderer::jpeg_of(picture.view());
  ByteServer server(std::string(jpeg.begin(), jpeg.end()), Then::hangs_up);
  auto source = open(server.address());
  ASSERT_TRUE(source) << source.error().what;
  const auto drew = draw_until_an_error(**source);
  ASSERT_FALSE(drew);
  EXPECT_THAT(drew.error().what, HasSubstr("has ended"));
  EXPECT_EQ(shown(), 3);
}

TEST_F(FilmTest, AStreamThatIsNotThereIsASentenceAndDoesNotWait) {
  auto source = open("tcp://127.0.0.1:1");
  ASSERT_TRUE(source);
  const auto drew = draw_until_an_error(**source);
  ASSERT_FALSE(drew);
  EXPECT_EQ(drew.error().code, Errc::timeout);
  EXPECT_THAT(drew.error().what, HasSubstr("tcp://127.0.0.1:1"));
}

TEST_F(FilmTest, AnUnknownProtocolIsASentence) {
  auto source = open("gopher2://x");
  const auto drew = draw_until_an_error(**source);
  ASSERT_FALSE(drew);
  EXPECT_EQ(drew.error().code, Errc::bad_config);
  EXPECT_THAT(drew.error().what, HasSubstr("protocol"));
}

TEST_F(FilmTest, ADeviceThatIsNoneIsASentence) {
  EXPECT_THAT(open("/dev/video77", {}, "capture").error().what, HasSubstr("handcast devices"));
  std::ofstream(file("video0")) << "a file";
  EXPECT_THAT(open(file("video0"), {}, "capture").error().what, HasSubstr("is not a video device"));
  auto null = open("/dev/null", {{"width", "640"}, {"height", "480"}, {"rate", "30"}}, "capture");
  ASSERT_TRUE(null) << null.error().what;
  const auto drew = draw_until_an_error(**null);
  ASSERT_FALSE(drew);
  EXPECT_EQ(drew.error().what, "'/dev/null' is not a video device");
}

}  // namespace
