// SPDX-License-Identifier: Apache-2.0
#include "renderer/media/colour_profile.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/base/srgb.hpp"

namespace handcast::renderer {
namespace {

constexpr std::size_t kValues = 1 << 16;
constexpr std::uint32_t kOpaque = 0xff000000u;

/// Big-endian numbers of an ICC profile; 0 beyond its end.
class IccBytes {
 public:
  explicit IccBytes(std::string_view bytes) : bytes_(bytes) {}

  std::size_t size() const { return bytes_.size(); }
  std::string_view text(std::size_t at, std::size_t length) const {
    return at < bytes_.size() ? bytes_.substr(at, length) : std::string_view();
  }
  std::uint32_t u16(std::size_t at) const { return number(at, 2); }
  std::uint32_t u32(std::size_t at) const { return number(at, 4); }
  /// s15Fixed16Number.
  double fixed(std::size_t at) const { return static_cast<std::int32_t>(u32(at)) / 65536.0; }

  /// The data of a tag; empty if it is missing or lies outside the profile.
  IccBytes tag(std::string_view name) const {
    constexpr std::size_t kTable = 128, kEntry = 12, kMostTags = 1000;
    const auto count = std::min<std::size_t>(u32(kTable), kMostTags);
    for (std::size_t i = 0; i < count; ++i) {
      const auto entry = kTable + 4 + kEntry * i;
      if (text(entry, 4) != name) continue;
      const auto data = text(u32(entry + 4), u32(entry + 8));
      return IccBytes(data);
    }
    return IccBytes({});
  }

 private:
  std::uint32_t number(std::size_t at, std::size_t width) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < width; ++i)
      value = value << 8 | (at + i < size() ? static_cast<std::uint8_t>(bytes_[at + i]) : 0u);
    return value;
  }
  std::string_view bytes_;
};

/// parametricCurveType (ICC.1:2010, 10.16): functions 0 to 4 of a value 0..1.
double parametric(const IccBytes& curve, double x) {
  constexpr std::size_t kFirst = 12;
  const auto p = [&](std::size_t i) { return curve.fixed(kFirst + 4 * i); };
  const auto power = [&](double offset) {
    return std::pow(std::max(p(1) * x + p(2), 0.0), p(0)) + offset;
  };
  switch (curve.u16(8)) {
    case 0:
      return std::pow(x, p(0));
    case 1:
      return x >= -p(2) / p(1) ? power(0) : 0;
    case 2:
      return x >= -p(2) / p(1) ? power(p(3)) : p(3);
    case 3:
      return x >= p(4) ? power(0) : p(3) * x;
    default:
      return x >= p(4) ? power(p(5)) : p(3) * x + p(6);
  }
}

/// curveType (10.5): the identity, a power, or a table.
double tabulated(const IccBytes& curve, double x) {
  constexpr std::size_t kFirst = 12;
  const std::size_t count = curve.u32(8);
  if (count == 0) return x;
  if (count == 1) return std::pow(x, curve.u16(kFirst) / 256.0);
  const double at = x * static_cast<double>(count - 1);
  const auto below = std::min(static_cast<std::size_t>(at), count - 2);
  const double part = at - static_cast<double>(below);
  return ((1 - part) * curve.u16(kFirst + 2 * below) + part * curve.u16(kFirst + 2 * below + 2)) /
         65535;
}

std::optional<std::vector<float>> light_of(const IccBytes& curve) {
  const auto type = curve.text(0, 4);
  if (type != "curv" && type != "para") return std::nullopt;
  if (type == "curv" && curve.u32(8) > (curve.size() - std::min<std::size_t>(curve.size(), 12)) / 2)
    return std::nullopt;
  if (type == "para" && curve.u16(8) > 4) return std::nullopt;
  std::vector<float> light(kValues);
  for (std::size_t i = 0; i < kValues; ++i) {
    const double x = static_cast<double>(i) / (kValues - 1);
    const double y = type == "para" ? parametric(curve, x) : tabulated(curve, x);
    if (!std::isfinite(y)) return std::nullopt;
    light[i] = static_cast<float>(std::clamp(y, 0.0, 1.0));
  }
  return light;
}

/// Light of the D50 white from the lightness L* / 100.
float light_of_lightness(float lightness) {
  const double f = (100.0 * lightness + 16) / 116;
  return static_cast<float>(f > 6.0 / 29 ? f * f * f : (f - 4.0 / 29) * 108 / 841);
}

Result<ColourProfile> read_grey(const IccBytes& icc) {
  auto light = light_of(icc.tag("kTRC"));
  if (!light) return fail(Errc::bad_data, "it has no curve of grey values");
  if (icc.text(20, 4) == "Lab ") std::ranges::transform(*light, light->begin(), light_of_lightness);
  return ColourProfile{{*light, *light, *light}, glm::dmat3(1.0)};
}

Result<ColourProfile> read_matrix(const IccBytes& icc) {
  /// The primaries of sRGB in XYZ, adapted to D50 (IEC 61966-2-1, by Bradford's transform).
  static const glm::dmat3 kXyzFromSrgb{{0.4360747, 0.2225045, 0.0139322},
                                       {0.3850649, 0.7168786, 0.0971045},
                                       {0.1430804, 0.0606169, 0.7141733}};
  ColourProfile profile;
  glm::dmat3 xyz_from_rgb{};
  for (int channel = 0; channel < 3; ++channel) {
    const std::string colour(1, "rgb"[channel]);
    const auto primary = icc.tag(colour + "XYZ");
    auto light = light_of(icc.tag(colour + "TRC"));
    if (primary.text(0, 4) != "XYZ " || primary.size() < 20 || !light)
      return fail(Errc::bad_data, "it is neither a matrix with curves nor a curve of grey values");
    for (int k = 0; k < 3; ++k) xyz_from_rgb[channel][k] = primary.fixed(8 + 4 * k);
    profile.light[channel] = std::move(*light);
  }
  profile.srgb_from_rgb = glm::inverse(kXyzFromSrgb) * xyz_from_rgb;
  return profile;
}

glm::dvec3 light_at(const ColourProfile& profile, const WidePixel& pixel) {
  return profile.srgb_from_rgb * glm::dvec3(profile.light[0][pixel[0]], profile.light[1][pixel[1]],
                                            profile.light[2][pixel[2]]);
}

}  // namespace

ColourProfile profile_of_gamma(double gamma) {
  std::vector<float> light(kValues);
  for (std::size_t i = 0; i < kValues; ++i)
    light[i] = static_cast<float>(std::pow(static_cast<double>(i) / (kValues - 1), 1 / gamma));
  return {{light, light, light}, glm::dmat3(1.0)};
}

Result<ColourProfile> read_icc_profile(std::string_view bytes, bool picture_is_grey) {
  const IccBytes icc(bytes);
  constexpr std::size_t kHeader = 132;
  if (icc.size() < kHeader || icc.text(36, 4) != "acsp")
    return fail(Errc::bad_data, "it is not an ICC profile");
  const bool is_grey = icc.text(16, 4) == "GRAY";
  if (!is_grey && icc.text(16, 4) != "RGB ")
    return fail(Errc::bad_data, "it is not for red, green and blue");
  if (is_grey && !picture_is_grey) return fail(Errc::bad_data, "it is for grey values");
  return is_grey ? read_grey(icc) : read_matrix(icc);
}

std::string name_of_icc_profile(std::string_view bytes) {
  const IccBytes name = IccBytes(bytes).tag("desc");
  std::string text;
  if (name.text(0, 4) == "desc") text = name.text(12, name.u32(8));
  if (name.text(0, 4) == "mluc")  // UTF-16; the names of profiles are in ASCII
    for (std::size_t i = 0; i + 1 < name.u32(20) && i < name.size(); i += 2)
      text += static_cast<char>(name.u16(name.u32(24) + i) & 127);
  return text.substr(0, text.find('\0'));
}

bool is_srgb(const ColourProfile& profile) {
  constexpr double kSame = 2.0 / 255;
  constexpr std::uint32_t kSteps = 5;
  const auto value = [](std::uint32_t step) {
    return static_cast<std::uint16_t>(step * (kValues - 1) / kSteps);
  };
  for (std::uint32_t i = 0; i < (kSteps + 1) * (kSteps + 1) * (kSteps + 1); ++i) {
    const WidePixel pixel{value(i % (kSteps + 1)), value(i / (kSteps + 1) % (kSteps + 1)),
                          value(i / (kSteps + 1) / (kSteps + 1)), 0};
    const auto light = glm::clamp(light_at(profile, pixel), 0.0, 1.0);
    for (int k = 0; k < 3; ++k)
      if (std::abs(srgb_level(light[k]) - pixel[k] / 65535.0) > kSame) return false;
  }
  return true;
}

Texture srgb_over_black(const Image<WidePixel>& picture, const ColourProfile& profile) {
  std::vector<std::uint8_t> levels(kValues);  // of light 0..65535
  for (std::size_t i = 0; i < kValues; ++i)
    levels[i] = static_cast<std::uint8_t>(
        std::lround(255 * srgb_level(static_cast<double>(i) / (kValues - 1))));
  Texture out(picture.width(), picture.height());
  std::ranges::transform(picture.pixels(), out.pixels().begin(), [&](const WidePixel& pixel) {
    const auto light =
        glm::clamp(light_at(profile, pixel), 0.0, 1.0) * static_cast<double>(pixel[3]) + 0.5;
    const auto level = [&](int k) {
      return std::uint32_t{levels[static_cast<std::size_t>(light[k])]} << 8 * k;
    };
    return kOpaque | level(0) | level(1) | level(2);
  });
  return out;
}

void put_over_black(Texture& picture) {
  const auto has_paint = [](std::uint32_t rgba) { return (rgba & kOpaque) == kOpaque; };
  if (std::ranges::all_of(picture.pixels(), has_paint)) return;
  std::vector<std::uint8_t> levels(kValues);  // of alpha and level
  for (std::size_t i = 0; i < kValues; ++i)
    levels[i] = static_cast<std::uint8_t>(
        std::lround(255 * srgb_level(srgb_light(static_cast<double>(i & 255) / 255) *
                                     static_cast<double>(i >> 8) / 255)));
  for (auto& pixel : picture.pixels()) {
    const auto alpha = pixel >> 24 << 8;
    pixel = kOpaque | levels[alpha | (pixel & 255)] | levels[alpha | (pixel >> 8 & 255)] << 8 |
            levels[alpha | (pixel >> 16 & 255)] << 16;
  }
}

}  // namespace handcast::renderer
