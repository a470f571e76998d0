// SPDX-License-Identifier: Apache-2.0
// Films are read back with OpenCV, which knows nothing of how they were written.
#include "renderer/media/film.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "renderer/media/jpeg.hpp"
#include "tests/scratch.hpp"

namespace handcast::renderer {
namespace {

constexpr int kWidth = 128, kHeight = 96;
constexpr std::int64_t kPeriod_ns = 40'000'000;

/// Black with coloured squares that move with the number of the picture.
Texture picture(int number) {
  Texture texture(kWidth, kHeight, 0xff000000);
  for (const auto& [left, colour] : {std::pair(10, 0xff0000ffu), std::pair(70, 0xff40ff80u)})
    for (int y = 0; y < 40; ++y) std::fill_n(texture.row(y + 2 * number) + left, 40, colour);
  return texture;
}

/// The mean difference of a level between a read picture and the one that was written.
double loss(const cv::Mat& read, int number) {
  auto written = picture(number);
  cv::Mat expected;
  cv::cvtColor(cv::Mat(kHeight, kWidth, CV_8UC4, written.pixels().data()), expected,
               cv::COLOR_RGBA2BGR);
  return cv::norm(read, expected, cv::NORM_L1) / (3.0 * kWidth * kHeight);
}

/// Expects that a film has the pictures 0 to `count` - 1.
void expect_pictures(const std::filesystem::path& file, int count) {
  cv::VideoCapture film(file.string(), cv::CAP_FFMPEG);
  ASSERT_TRUE(film.isOpened()) << file;
  cv::Mat read;
  for (int i = 0; i < count; ++i) {
    ASSERT_TRUE(film.read(read)) << "picture " << i;
    ASSERT_EQ(read.size(), cv::Size(kWidth, kHeight));
    EXPECT_LT(loss(read, i), 1.0) << "picture " << i;
  }
  EXPECT_FALSE(film.read(read)) << "there are more than " << count;
}

void add_pictures(Film& film, int count) {
  for (int i = 0; i < count; ++i)
    if (const auto added = film.add(jpeg_of(picture(i).view()), 5 + i * kPeriod_ns); !added)
      ADD_FAILURE() << added.error().what;
}

class FilmTest : public testing::Test {
 protected:
  Film create() {
    auto film = Film::create(file_, kWidth, kHeight);
    EXPECT_TRUE(film) << film.error().what;
    return std::move(*film);
  }
  test::Scratch scratch_;
  std::filesystem::path file_ = scratch_.path() / "light.avi";
};

TEST_F(FilmTest, HasThePicturesThatWereAdded) {
  add_pictures(*std::make_unique<Film>(create()), 20);
  expect_pictures(file_, 20);
}

TEST_F(FilmTest, PlaysAtTheRateOfItsPictures) {
  add_pictures(*std::make_unique<Film>(create()), 20);
  const cv::VideoCapture film(file_.string(), cv::CAP_FFMPEG);
  EXPECT_NEAR(film.get(cv::CAP_PROP_FPS), 25, 0.01);
  EXPECT_EQ(film.get(cv::CAP_PROP_FRAME_COUNT), 20);
}

TEST_F(FilmTest, HasAnIndexWithWhichPlayersJump) {
  add_pictures(*std::make_unique<Film>(create()), 20);
  cv::VideoCapture film(file_.string(), cv::CAP_OPENCV_MJPEG);  // it reads by the index alone
  ASSERT_TRUE(film.isOpened());
  cv::Mat read;
  for (const int i : {15, 3}) {
    ASSERT_TRUE(film.set(cv::CAP_PROP_POS_FRAMES, i));
    ASSERT_TRUE(film.read(read));
    EXPECT_LT(loss(read, i), 1.0);
  }
}

TEST_F(FilmTest, CanBeReadWhileItIsWritten) {
  auto film = create();
  add_pictures(film, 7);
  expect_pictures(file_, 7);
}

TEST_F(FilmTest, CanBeReadAfterItsWriterWasKilled) {
  const pid_t writer = fork();
  if (writer == 0) {
    auto film = Film::create(file_, kWidth, kHeight);
    if (film) add_pictures(*film, 9);
    kill(getpid(), SIGKILL);
  }
  waitpid(writer, nullptr, 0);
  std::ofstream(file_, std::ios::app) << "00dc";  // the beginning of the next picture
  expect_pictures(file_, 9);
  const cv::VideoCapture film(file_.string(), cv::CAP_FFMPEG);
  EXPECT_EQ(film.get(cv::CAP_PROP_FRAME_COUNT), 9);
  EXPECT_NEAR(film.get(cv::CAP_PROP_FPS), 25, 0.01);
}

TEST_F(FilmTest, DoesNotReplaceAnotherFile) {
  std::ofstream(file_) << "mine";
  const auto refused = Film::create(file_, kWidth, kHeight);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_config);
  EXPECT_THAT(refused.error().what, testing::HasSubstr("light.avi"));
}

TEST_F(FilmTest, EndsBeforeItIsTooLargeForItsReaders) {
  const auto film = create();
  EXPECT_TRUE(film.has_room_for(1'000'000));
  EXPECT_FALSE(film.has_room_for(Film::kMostBytes));
}

}  // namespace
}  // namespace handcast::renderer
