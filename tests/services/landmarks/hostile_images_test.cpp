// SPDX-License-Identifier: Apache-2.0
// Images that cannot be read, or not wholly, through the detector's own interface: what is wrong is
// not said with confidence, and the next good image is read as ever.
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "services/landmarks/models/landmark_models.hpp"
#include "tests/scratch.hpp"
#include "tests/services/landmarks/hostile.hpp"

namespace handcast::landmarks {
namespace {

using test::Grey;
using test::Sight;

constexpr std::int64_t kApart_ns = 1'000'000'000;  ///< long enough to forget a hand
constexpr std::int64_t kFrame_ns = 5'000'000;
constexpr float kWrong = 0.35f;  ///< of a palm
constexpr float kSure = 0.5f;
constexpr int kMostMistakes = 6;  ///< landmarks of a hand that are sure and wrong

/// The left hand's images, a few of each motion.
const std::vector<Sight>& good() {
  static const std::vector<Sight> kGood = [] {
    std::vector<Sight> sights;
    for (const char* motion : {"builtin:open_close", "builtin:rotate", "builtin:pinch"}) {
      config::Twin settings;
      settings.motion = motion;
      settings.hands = config::TwinHands::left;
      const test::Sights world(settings);
      for (const double seconds : {0.3, 1.4, 2.5}) sights.push_back(world.at(seconds));
    }
    return sights;
  }();
  return kGood;
}

/// Palm length, or half the hand's where the palm is seen from its end.
float unit_px(const Points& hand_px) {
  float longest = 0;
  for (const auto& a : hand_px)
    for (const auto& b : hand_px) longest = std::max(longest, glm::distance(a, b));
  return std::max(palm_length_px(hand_px), longest / 2);
}

/// What was said of one hand, against the truth.
struct Verdict {
  bool found = false;
  float presence = 0, confidence = 0;  ///< mean over the landmarks
  float error = 0;                     ///< mean over those seen, in units
  int sure_and_wrong = 0;              ///< landmarks
};

Verdict judge(const msg::Landmarks& landmarks, msg::Side side, const Points& truth_px) {
  const auto* hand = landmarks.find(side);
  if (!hand) return {};
  Verdict verdict{true, hand->presence};
  int seen = 0;
  for (int i = 0; i < msg::kLandmarks; ++i) {
    const auto& point = hand->points[i];
    EXPECT_TRUE(std::isfinite(point.x_px) && std::isfinite(point.y_px) &&
                std::isfinite(point.sigma_px));
    EXPECT_TRUE(point.confidence >= 0 && point.confidence <= 1);
    verdict.confidence += point.confidence / msg::kLandmarks;
    if (point.confidence == 0) continue;
    const float error =
        glm::distance(glm::vec2(point.x_px, point.y_px), truth_px[i]) / unit_px(truth_px);
    verdict.error += error;
    ++seen;
    verdict.sure_and_wrong += error > kWrong && point.confidence > kSure;
  }
  if (seen) verdict.error /= static_cast<float>(seen);
  return verdict;
}

using Edit = std::function<Grey(const Grey& image, const Points& hand_px)>;

/// Nothing of the hand is left.
const std::map<std::string, Edit>& without_a_hand() {
  static const auto of_size = [](auto value) {
    return [value](const Grey& image, const Points&) {
      return test::painted(image.width(), image.height(), value);
    };
  };
  static const std::map<std::string, Edit> kEdits{
      {"black", of_size([](int, int) { return 0; })},
      {"white", of_size([](int, int) { return 255; })},
      {"stripes", of_size([](int x, int) { return x / 16 % 2 ? 200 : 20; })},
      {"slope", of_size([](int x, int y) { return 0.2 * x + 0.1 * y; })},
      {"noise",
       [](const Grey& image, const Points&) { return test::noise(image.width(), image.height()); }},
      {"covered",
       [](const Grey& image, const Points& hand_px) {
         return test::half_covered(image, hand_px, {1, 0}, -1.2f);
       }},
  };
  return kEdits;
}

/// Some of it is left.
const std::map<std::string, Edit>& with_half_a_hand() {
  static const auto covered = [](glm::vec2 way, float beyond) {
    return [=](const Grey& image, const Points& hand_px) {
      return test::half_covered(image, hand_px, way, beyond);
    };
  };
  static const std::map<std::string, Edit> kEdits{
      {"fingers covered", covered({1, 0}, 0)},    {"finger ends covered", covered({1, 0}, 0.35f)},
      {"right half covered", covered({0, 1}, 0)}, {"left half covered", covered({0, -1}, 0)},
      {"palm covered", covered({-1, 0}, 0)},
  };
  return kEdits;
}

/// All of it is left, but it looks like none in the training.
const std::map<std::string, Edit>& with_an_odd_hand() {
  static const auto glove = [](auto share) {
    return [=](const Grey& image, const Points& hand_px) {
      return test::gloved(image, hand_px, share);
    };
  };
  static const auto smear = [](int length_px, bool down) {
    return [=](const Grey& image, const Points&) { return test::smeared(image, length_px, down); };
  };
  static const std::map<std::string, Edit> kEdits{
      {"dark glove", glove([](glm::vec2) { return 0.12; })},
      {"striped glove",
       glove([](glm::vec2 at) { return static_cast<int>(std::floor(at.x * 8)) % 2 ? 0.2 : 1.0; })},
      {"fingerless glove", glove([](glm::vec2 at) { return at.x < 0.3f ? 0.15 : 1.0; })},
      {"smeared across", smear(40, false)},
      {"smeared along", smear(40, true)},
      {"smeared far", smear(80, false)},
      {"overexposed", [](const Grey& image, const Points&) { return test::brightened(image, 6); }},
      {"burnt out", [](const Grey& image, const Points&) { return test::brightened(image, 40); }},
      {"underexposed",
       [](const Grey& image, const Points&) { return test::brightened(image, 0.06); }},
  };
  return kEdits;
}

/// A detector that has a tracker, and one image after another.
class HostileImages : public testing::TestWithParam<std::string_view> {
 protected:
  void SetUp() override {
    if (is_mediapipe()) SKIP_WITHOUT_MODELS();
    config::Rig rig;
    rig.landmarks.backend = GetParam();
    rig.landmarks.models = is_mediapipe() ? test::models() : scratch_.path();
    auto opened = open_detector(rig, calib::reference_rig(), 0);
    ASSERT_TRUE(opened) << opened.error().what;
    detector_ = std::move(*opened);
  }
  bool is_mediapipe() const { return GetParam() == "mediapipe"; }

  msg::Landmarks detect(const Sight& sight, std::int64_t step_ns = kApart_ns) {
    return test::detect(*detector_, sight, time_ns_ += step_ns);
  }
  Verdict read(const Sight& sight, std::int64_t step_ns = kApart_ns) {
    return judge(detect(sight, step_ns), msg::Side::left, *sight.truth_px[0]);
  }
  static Sight edited(const Sight& sight, const Edit& edit) {
    return {edit(sight.image, *sight.truth_px[0]), sight.tracker_px, sight.truth_px, sight.seconds};
  }

  /// The means over all good images, each spoilt by `spoil`; every one is checked for nonsense.
  Verdict check(const std::string& what, const std::function<Sight(const Sight&)>& spoil) {
    Verdict mean;
    int found = 0;
    for (const auto& sight : good()) {
      const Sight spoilt = spoil(sight);
      const Verdict verdict = read(spoilt);
      expect_no_nonsense(verdict, what);
      found += verdict.found;
      mean.presence += verdict.presence;
      mean.confidence += verdict.confidence;
      mean.error += verdict.error;
    }
    const auto all = static_cast<float>(good().size());
    std::printf("%-20s found %d of %.0f, error %.2f palms, confidence %.2f\n", what.c_str(), found,
                all, mean.error / std::max(found, 1), mean.confidence / all);
    return {found > 0, mean.presence / all, mean.confidence / all,
            found ? mean.error / static_cast<float>(found) : 0};
  }
  /// Of the mean confidence; MediaPipe's network has no sigmas.
  float sure() const { return is_mediapipe() ? kSure + 0.1f : kSure; }
  void expect_no_nonsense(const Verdict& verdict, const std::string& what) const {
    EXPECT_TRUE(verdict.error <= kWrong || verdict.confidence < sure())
        << what << ": " << verdict.error << " palms off, confidence " << verdict.confidence;
    EXPECT_LE(verdict.sure_and_wrong, kMostMistakes) << what;
  }

  test::Scratch scratch_;
  std::unique_ptr<Detector> detector_;
  std::int64_t time_ns_ = kApart_ns;
};

TEST_P(HostileImages, WhereThereIsNoHandNoneIsFoundThoughTheTrackerHasOne) {
  for (const auto& [what, edit] : without_a_hand())
    for (const auto& sight : good()) EXPECT_EQ(detect(edited(sight, edit)).count, 0u) << what;
}

TEST_P(HostileImages, AFaceIsNoHand) {
  for (const auto& sight : good()) {
    const Grey face = test::face(sight.image.width(), sight.image.height());
    const glm::vec2 middle(sight.image.width() / 2, sight.image.height() / 2);
    Sight shown = test::shifted({face, {}, {}}, glm::ivec2(centre_of(*sight.truth_px[0]) - middle));
    shown.tracker_px = sight.tracker_px;
    EXPECT_EQ(detect(shown).count, 0u);
  }
}

TEST_P(HostileImages, AFaceBehindAHandDoesNotDisturbIt) {
  config::Twin settings;
  settings.motion = "builtin:wave";
  settings.hands = config::TwinHands::left;
  const Sight plain = test::Sights(settings).at(0.4);
  settings.image.face = true;
  const Verdict alone = read(plain), before_a_face = read(test::Sights(settings).at(0.4));
  EXPECT_NEAR(alone.error, before_a_face.error, 0.03f);
  EXPECT_NEAR(alone.confidence, before_a_face.confidence, 0.05f);
}

TEST_P(HostileImages, ConfidenceFallsWithHalfOfTheHand) {
  const Verdict clean = check("clean", [](const Sight& sight) { return sight; });
  EXPECT_LT(clean.error, 0.15f);
  for (const auto& [what, edit] : with_half_a_hand()) {
    const Verdict half = check(what, [&](const Sight& sight) { return edited(sight, edit); });
    EXPECT_LT(half.confidence, clean.confidence - 0.05f) << what;
  }
  for (const glm::vec2 way : {glm::vec2(-1, 0), glm::vec2(1, 0), glm::vec2(0, -1)}) {
    const Verdict half = check("half out of the image", [&](const Sight& sight) {
      const glm::vec2 size(sight.image.width(), sight.image.height()),
          middle = centre_of(*sight.truth_px[0]);
      return test::shifted(sight, glm::ivec2(way * (way.x + way.y > 0 ? size - middle : middle)));
    });
    EXPECT_LT(half.confidence, clean.confidence - 0.2f);
  }
}

TEST_P(HostileImages, AGloveBlurOrBadLightMakeNoSureMistakes) {
  const Verdict clean = check("clean", [](const Sight& sight) { return sight; });
  for (const auto& [what, edit] : with_an_odd_hand()) {
    const Verdict odd = check(what, [&](const Sight& sight) { return edited(sight, edit); });
    EXPECT_TRUE(odd.error < 0.15f || odd.confidence < clean.confidence - 0.1f) << what;
  }
}

TEST_P(HostileImages, HandsThatCrossKeepTheirSides) {
  config::Twin settings;
  settings.motion = "builtin:crossing";
  const test::Sights world(settings);
  constexpr int kSteps = 22;
  int found = 0;
  for (int step = 0; step < kSteps; ++step) {
    const double seconds = 0.2 + 0.1 * step;
    const Sight sight = world.at(seconds);
    const auto seen = detect(sight, seconds_to_ns(0.1));
    for (const auto side : {msg::Side::left, msg::Side::right}) {
      const auto one = static_cast<std::size_t>(side);
      const Verdict verdict = judge(seen, side, *sight.truth_px[one]);
      expect_no_nonsense(verdict, "crossing");
      if (!verdict.found || verdict.confidence < sure()) continue;
      ++found;
      EXPECT_LT(verdict.error, judge(seen, side, *sight.truth_px[1 - one]).error)
          << "at " << seconds << " s it is the other hand";
    }
  }
  EXPECT_GT(found, kSteps) << "of " << 2 * kSteps;
}

class BadStretches : public HostileImages {
 protected:
  /// Three bad images, then good ones: `reads` of them until one must be read as it was before.
  void expect_recovery(const Sight& sight, int reads) {
    for (const auto* edits : {&without_a_hand(), &with_half_a_hand(), &with_an_odd_hand()})
      for (const auto& [what, edit] : *edits) {
        Sight first = sight;
        first.tracker_px = good()[0].tracker_px;
        const Verdict before = read(first);
        const Sight spoilt = edited(sight, edit);
        for (int i = 0; i < 3; ++i) read(spoilt, kFrame_ns);
        Verdict after;
        for (int i = 0; i < reads; ++i) after = read(sight, kFrame_ns);
        ASSERT_TRUE(after.found) << what;
        EXPECT_LT(after.error, before.error + 0.04f) << what;
        EXPECT_GT(after.confidence, before.confidence - 0.15f) << what;
      }
  }
};

TEST_P(BadStretches, AreForgottenWithTheNextGoodImage) { expect_recovery(good()[0], 1); }

TEST_P(BadStretches, AreForgottenWithAFewGoodImagesWhereNoTrackerHelps) {
  if (is_mediapipe()) GTEST_SKIP() << "it searches the whole image only now and then";
  Sight sight = good()[0];
  sight.tracker_px = {};
  expect_recovery(sight, 3);
}

std::vector<std::string_view> models() {
  std::vector<std::string_view> names;
  for (const auto& model : landmark_models()) names.push_back(model.name);
  return names;
}
const auto backend_name = [](const auto& named) { return std::string(named.param); };
INSTANTIATE_TEST_SUITE_P(Backends, BadStretches, testing::ValuesIn(models()), backend_name);
INSTANTIATE_TEST_SUITE_P(Backends, HostileImages, testing::ValuesIn(models()), backend_name);

}  // namespace
}  // namespace handcast::landmarks
