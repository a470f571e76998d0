// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "calib/solve/screen/gray_code.hpp"
#include "calib/solve/screen/gray_patch.hpp"
#include "ipc/base/statistics.hpp"

namespace handcast::calib {
namespace {

constexpr int kPatch_px = 8;
constexpr int kLeastContrast = 8;              ///< grey levels
constexpr double kLeastContrastInNoise = 6;    ///< standard deviations
constexpr double kSureShare = 0.12;            ///< of the contrast, for a bit that is sure
constexpr double kSureInNoise = 4;             ///< standard deviations
constexpr double kLeastLitShare = 0.005;       ///< of the camera's pixels
constexpr double kLeastStripeContrast = 0.25;  ///< noise of 5 % alone gives 0.05
constexpr double kMostTornShare = 0.08;  ///< of the pairs of neighbours; noise of 5 % makes 0.02
constexpr double kTremor_px = 0.12;      ///< camera px; of a board that a person holds still
constexpr double kEdgeSigma_px = 0.1;    ///< camera px; of an edge without noise
constexpr double kUnusual = 2;  ///< misfit of a patch in medians; noise makes no such patch
constexpr double kMostUnusualShare = 0.005;   ///< of the patches
constexpr double kMostEdgeResidual_px = 0.3;  ///< camera px; 0.15 in a steady picture
constexpr int kDark = -1;                     ///< a cell that was not read

/// As std::hypot(), which is ten times as slow since it cares for numbers that overflow.
double length(double a, double b) { return std::sqrt(a * a + b * b); }

/// Where an edge lies between a pixel and its neighbour.
struct Crossing {
  double share;   ///< of the way
  double weight;  ///< 1 / variance, 1/px^2
};

}  // namespace

/// Reads the images of one run of the patterns.
class GrayDecoder {
 public:
  GrayDecoder(const GrayCode& code, std::span<const GreyView> images)
      : code_(code),
        images_(images),
        width_px_(images[0].width_px),
        height_px_(images[0].height_px) {}

  Result<GrayDecoding> run();

 private:
  /// The cell of the code that lights a pixel.
  struct Cell {
    int column = kDark, row = kDark;
  };

  int grey(std::size_t image, int x, int y) const {
    return images_[image].pixels[y * images_[image].stride + x];
  }
  int contrast(int x, int y) const { return grey(0, x, y) - grey(1, x, y); }
  /// A pattern minus its inverse.
  int difference(std::size_t bit, int x, int y) const {
    return grey(2 + 2 * bit, x, y) - grey(3 + 2 * bit, x, y);
  }
  Cell& cell(int x, int y) {
    const int index = y * width_px_ + x;
    return cells_[static_cast<std::size_t>(index)];
  }
  double noise(int x, int y) const;
  double cell_px() const { return 1 << code_.lowest_bit_; }

  void measure_light();
  Cell read_cell(int x, int y) const;
  void read_cells();
  Crossing crossing(std::size_t bit, int x, int y, int dx, int dy) const;
  void add_edge(int x, int y, int dx, int dy);
  void find_edges();
  std::vector<PatchReading> read_patches() const;
  Result<void> check(const std::vector<PatchReading>& readings) const;

  const GrayCode& code_;
  std::span<const GreyView> images_;
  int width_px_, height_px_;
  GrayDecoding result_;
  int least_contrast_ = kLeastContrast;
  std::vector<Cell> cells_;
  std::vector<Patch> patches_;
  int patches_across_ = 0;
  double usual_misfit_ = 0;
  long neighbours_ = 0, torn_ = 0;  ///< pairs; those whose cells are not neighbours
};

/// A pattern and its inverse add up to white and black; what is missing is the noise of four
/// pixels.
void GrayDecoder::measure_light() {
  std::vector<double> contrasts, noises, stripes;
  const auto finest = code_.bits_.size() - 2;  // of columns, then of rows
  long saturated = 0;
  for (int y = 0; y < height_px_; ++y)
    for (int x = 0; x < width_px_; ++x) {
      if (contrast(x, y) < kLeastContrast) continue;
      contrasts.push_back(contrast(x, y));
      saturated += grey(0, x, y) == 255;
      for (const auto bit : {finest, finest + 1})
        stripes.push_back(std::abs(difference(bit, x, y)) / static_cast<double>(contrast(x, y)));
      const auto bit = static_cast<std::size_t>(x + y) % code_.bits_.size();
      noises.push_back(std::abs(grey(2 + 2 * bit, x, y) + grey(3 + 2 * bit, x, y) - grey(0, x, y) -
                                grey(1, x, y)) /
                       2.);
    }
  if (contrasts.empty()) return;
  result_.saturated_share = static_cast<double>(saturated) / static_cast<double>(contrasts.size());
  result_.contrast = median(contrasts);
  result_.stripe_contrast = median(stripes);
  result_.noise = kSigmaPerMad * median(noises);
  least_contrast_ =
      std::max(kLeastContrast, static_cast<int>(kLeastContrastInNoise * result_.noise));
}

/// The standard deviation of a pixel, grey levels: that of the camera, and at an edge of the
/// board's print also the tremor of the hand that holds it, which moves the print over the pixel.
/// Steps that the camera's noise alone makes are no print.
double GrayDecoder::noise(int x, int y) const {
  const auto step = [&](int dx, int dy) {
    const int left = std::max(x - dx, 0), right = std::min(x + dx, width_px_ - 1);
    const int upper = std::max(y - dy, 0), lower = std::min(y + dy, height_px_ - 1);
    const int behind = grey(0, left, upper), here = grey(0, x, y), ahead = grey(0, right, lower);
    return std::max(std::abs(here - behind), std::abs(ahead - here));
  };
  const double printed = length(step(1, 0), step(0, 1));
  return length(result_.noise, kTremor_px * std::max(0., printed - 3 * result_.noise));
}

/// At most one bit of each coordinate may be unsure: on an edge, either side is right.
GrayDecoder::Cell GrayDecoder::read_cell(int x, int y) const {
  const int light = contrast(x, y);
  if (light < least_contrast_) return {};
  const double sure = std::max(kSureShare * light, kSureInNoise * noise(x, y));
  int values[2] = {0, 0}, unsure[2] = {0, 0}, last[2] = {0, 0};
  for (std::size_t bit = 0; bit < code_.bits_.size(); ++bit) {
    const int axis = code_.bits_[bit].of_row;
    const int now = difference(bit, x, y);
    unsure[axis] += std::abs(now) < sure;
    last[axis] ^= now > 0;  // a binary digit is the exclusive or of all Gray digits above it
    values[axis] = 2 * values[axis] + last[axis];
  }
  if (unsure[0] > 1 || unsure[1] > 1) return {};
  return {values[0], values[1]};
}

void GrayDecoder::read_cells() {
  cells_.resize(static_cast<std::size_t>(width_px_) * static_cast<std::size_t>(height_px_));
  long lit = 0;
  for (int y = 0; y < height_px_; ++y)
    for (int x = 0; x < width_px_; ++x) {
      const auto read = read_cell(x, y);
      cell(x, y) = read;
      lit += read.column != kDark;
    }
  result_.lit_share = static_cast<double>(lit) / (width_px_ * height_px_);
}

/// The edge of a bit is where it is as bright as its inverse (linear interpolation). Both count in
/// shares of the pixel's light, so that the board's print does not move the edge.
Crossing GrayDecoder::crossing(std::size_t bit, int x, int y, int dx, int dy) const {
  const double light = contrast(x, y), next_light = contrast(x + dx, y + dy);
  const double from = difference(bit, x, y) / light;
  const double to = difference(bit, x + dx, y + dy) / next_light;
  const double rise = from - to;
  const double sigma_px =
      std::numbers::sqrt2 / (rise * rise) *
      length(to * noise(x, y) / light, from * noise(x + dx, y + dy) / next_light);
  return {from / rise, 1 / (kEdgeSigma_px * kEdgeSigma_px + sigma_px * sigma_px)};
}

/// Looks at a pixel and its neighbour: between cells c and c + 1 the bit changes that is the lowest
/// set bit of c + 1.
void GrayDecoder::add_edge(int x, int y, int dx, int dy) {
  const auto here = cell(x, y), there = cell(x + dx, y + dy);
  if (here.column == kDark || there.column == kDark) return;
  const int columns = std::abs(there.column - here.column), rows = std::abs(there.row - here.row);
  ++neighbours_;
  torn_ += columns > 1 || rows > 1;
  if (columns + rows != 1) return;
  const bool of_row = rows == 1;
  const int upper = of_row ? std::max(here.row, there.row) : std::max(here.column, there.column);
  const int number = std::countr_zero(static_cast<unsigned>(upper)) + code_.lowest_bit_;
  const auto bit = std::ranges::find_if(code_.bits_, [&](const auto& candidate) {
    return candidate.of_row == of_row && candidate.number == number;
  });
  const auto edge = crossing(static_cast<std::size_t>(bit - code_.bits_.begin()), x, y, dx, dy);
  const int index = y / kPatch_px * patches_across_ + x / kPatch_px;
  auto& patch = patches_[static_cast<std::size_t>(index)];
  const glm::dvec2 px(x % kPatch_px + edge.share * dx, y % kPatch_px + edge.share * dy);
  (of_row ? patch.row : patch.column).add(px, upper * cell_px() - 0.5, edge.weight);
}

void GrayDecoder::find_edges() {
  patches_across_ = (width_px_ + kPatch_px - 1) / kPatch_px;
  const int down = (height_px_ + kPatch_px - 1) / kPatch_px;
  patches_.resize(static_cast<std::size_t>(patches_across_) * static_cast<std::size_t>(down));
  for (int y = 0; y < height_px_; ++y)
    for (int x = 0; x < width_px_; ++x) {
      if (x + 1 < width_px_) add_edge(x, y, 1, 0);
      if (y + 1 < height_px_) add_edge(x, y, 0, 1);
    }
}

std::vector<PatchReading> GrayDecoder::read_patches() const {
  std::vector<PatchReading> readings;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const auto across = static_cast<std::size_t>(patches_across_);
    const glm::dvec2 first_px(i % across * kPatch_px, i / across * kPatch_px);
    if (const auto reading = read_patch(patches_[i], first_px)) readings.push_back(*reading);
  }
  return readings;
}

/// Errors: blurred stripes; a move. Edges of stripes that were shown before a move do not lie where
/// later ones put them: all over the image, or, of the wide stripes, in a few patches.
Result<void> GrayDecoder::check(const std::vector<PatchReading>& readings) const {
  if (result_.stripe_contrast < kLeastStripeContrast)
    return fail(Errc::bad_data,
                "the camera does not see the finest stripes: make them wider, or "
                "focus the camera and the projector");
  const auto unusual = std::ranges::count_if(
      readings, [&](const auto& reading) { return reading.misfit > kUnusual * usual_misfit_; });
  const bool torn = static_cast<double>(torn_) > kMostTornShare * static_cast<double>(neighbours_);
  if (torn || result_.edge_residual_px > kMostEdgeResidual_px || readings.empty() ||
      static_cast<double>(unusual) > kMostUnusualShare * static_cast<double>(readings.size()))
    return fail(
        Errc::bad_data,
        fmt::format(
            "the images of the patterns do not fit together (edges off by {:.2f} px, {:.1f} "
            "% of the pixels torn, {:.1f} % of the patches unusual): did the camera or the "
            "board move while the patterns were shown, or is an image missing?",
            result_.edge_residual_px,
            100.0 * static_cast<double>(torn_) / std::max(1.0, static_cast<double>(neighbours_)),
            100.0 * static_cast<double>(unusual) /
                std::max<double>(1, static_cast<double>(readings.size()))));
  return {};
}

Result<GrayDecoding> GrayDecoder::run() {
  measure_light();
  read_cells();
  if (result_.lit_share < kLeastLitShare)
    return fail(Errc::bad_data,
                fmt::format("only {:.1f} % of the camera's image is lit by the patterns well "
                            "enough to be read: is the room too bright, the exposure too short, "
                            "or the board outside the picture?",
                            100 * result_.lit_share));
  find_edges();
  const auto readings = read_patches();
  std::vector<double> misfits, rms_px;
  for (const auto& reading : readings) {
    misfits.push_back(reading.misfit);
    rms_px.push_back(reading.rms_px);
  }
  usual_misfit_ = median(misfits);
  result_.edge_residual_px = median(rms_px);
  if (const auto steady = check(readings); !steady) return tl::make_unexpected(steady.error());
  for (const auto& reading : readings) {
    if (reading.misfit > kUnusual * usual_misfit_) continue;
    result_.points.push_back(reading.point);
    result_.points.back().sigma_px *= usual_misfit_;
  }
  return std::move(result_);
}

Result<GrayDecoding> GrayCode::decode(std::span<const GreyView> images) const {
  if (static_cast<int>(images.size()) != patterns())
    return fail(Errc::bad_data, fmt::format("{} images were given, but there are {} patterns",
                                            images.size(), patterns()));
  for (const auto& image : images)
    if (!image.pixels || image.width_px != images[0].width_px ||
        image.height_px != images[0].height_px || image.width_px < 1 || image.height_px < 1)
      return fail(Errc::bad_data, "the images of the patterns are empty or differ in size");
  return GrayDecoder(*this, images).run();
}

}  // namespace handcast::calib
