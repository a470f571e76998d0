// SPDX-License-Identifier: Apache-2.0
#include "services/camera/aravis/configure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/settings/choice.hpp"
#include "ipc/base/log.hpp"
#include "services/camera/aravis/features.hpp"

namespace handcast::camera::aravis {
namespace {

using config::Trigger;

tl::unexpected<Error> outside(std::string_view setting, double value, double least, double most,
                              std::string_view unit) {
  return fail(Errc::bad_config, fmt::format("{}: {} {} is outside the {}..{} {} of this camera",
                                            setting, value, unit, least, most, unit));
}

/// One camera during its set-up.
class Setup {
 public:
  Setup(ArvCamera* camera, const config::Camera& settings, int width_px, int height_px)
      : camera_(camera), settings_(settings), width_px_(width_px), height_px_(height_px) {}

  Result<Accepted> run() {
    // A camera may still send what an ended program has started.
    (void)ask([&](GError** error) { arv_camera_stop_acquisition(camera_, error); });
    for (const auto step : {&Setup::set_format, &Setup::set_region, &Setup::set_trigger,
                            &Setup::set_exposure, &Setup::set_rate, &Setup::set_gain,
                            &Setup::set_exposure_line, &Setup::set_packets, &Setup::set_features})
      if (const auto done = (this->*step)(); !done) return tl::make_unexpected(done.error());
    return accepted_;
  }

 private:
  template <class Call>
  Result<void> step(std::string_view setting, const Call& call) {
    const auto done = ask(call);
    if (!done) return fail_in(setting, done.error());
    return {};
  }

  Result<void> set_format() {
    const std::string name(
        words_of(settings_.aravis.format)[static_cast<std::size_t>(settings_.aravis.format)]);
    const auto set = ask([&](GError** error) {
      arv_camera_set_pixel_format_from_string(camera_, name.c_str(), error);
    });
    if (set) return {};
    return fail(set.error().code,
                fmt::format("aravis.format: {}; the camera has {}", set.error().what,
                            words_of_feature(camera_, "PixelFormat")));
  }

  Result<void> set_region() {
    if (auto binned = set_binning(); !binned) return binned;
    gint least_width = 0, most_width = 0, least_height = 0, most_height = 0;
    const auto bounds = ask([&](GError** error) {
      arv_camera_set_region(camera_, 0, 0, -1, -1, error);
      if (!*error) arv_camera_get_width_bounds(camera_, &least_width, &most_width, error);
      if (!*error) arv_camera_get_height_bounds(camera_, &least_height, &most_height, error);
    });
    if (!bounds) return fail_in("region", bounds.error());
    const int x_px = settings_.aravis.offset_x_px, y_px = settings_.aravis.offset_y_px;
    if (width_px_ < least_width || height_px_ < least_height || x_px + width_px_ > most_width ||
        y_px + height_px_ > most_height)
      return fail(
          Errc::bad_config,
          fmt::format("an image of {} x {} px at {}, {} does not fit the camera's {} x {} px; the "
                      "size is that of the calibration, the corner is aravis.offset_x_px "
                      "and offset_y_px",
                      width_px_, height_px_, x_px, y_px, most_width, most_height));
    if (auto set = step("region",
                        [&](GError** error) {
                          arv_camera_set_region(camera_, x_px, y_px, width_px_, height_px_, error);
                        });
        !set)
      return set;
    return check_region();
  }

  /// A camera rounds what its steps do not allow.
  Result<void> check_region() {
    gint x_px = 0, y_px = 0, width_px = 0, height_px = 0;
    if (auto got = step("region",
                        [&](GError** error) {
                          arv_camera_get_region(camera_, &x_px, &y_px, &width_px, &height_px,
                                                error);
                        });
        !got)
      return got;
    if (x_px == settings_.aravis.offset_x_px && y_px == settings_.aravis.offset_y_px &&
        width_px == width_px_ && height_px == height_px_)
      return {};
    return fail(Errc::bad_config,
                fmt::format("the camera made {} x {} px at {}, {} of the wanted {} x {} px at {}, "
                            "{}: it has coarser steps",
                            width_px, height_px, x_px, y_px, width_px_, height_px_,
                            settings_.aravis.offset_x_px, settings_.aravis.offset_y_px));
  }

  Result<void> set_binning() {
    const int binning = settings_.aravis.binning;
    const auto available =
        ask([&](GError** error) { return arv_camera_is_binning_available(camera_, error); });
    if (!available || !*available) {
      if (binning == 1) return {};
      return fail(Errc::bad_config, "aravis.binning: this camera has no binning");
    }
    gint least = 0, most = 0;
    if (auto bounds = step("aravis.binning",
                           [&](GError** error) {
                             arv_camera_get_x_binning_bounds(camera_, &least, &most, error);
                           });
        !bounds)
      return bounds;
    if (binning > std::max(most, 1)) return outside("aravis.binning", binning, least, most, "px");
    return step("aravis.binning",
                [&](GError** error) { arv_camera_set_binning(camera_, binning, binning, error); });
  }

  Result<void> set_trigger() {
    if (auto set = step("acquisition mode",
                        [&](GError** error) {
                          arv_camera_set_acquisition_mode(camera_, ARV_ACQUISITION_MODE_CONTINUOUS,
                                                          error);
                        });
        !set)
      return set;
    if (settings_.aravis.trigger == Trigger::free_run) {
      // A camera without triggers has nothing to switch off.
      (void)ask([&](GError** error) { arv_camera_clear_triggers(camera_, error); });
      return {};
    }
    const auto source = settings_.aravis.trigger == Trigger::software
                            ? std::string("Software")
                            : settings_.aravis.trigger_line;
    const auto set =
        ask([&](GError** error) { arv_camera_set_trigger(camera_, source.c_str(), error); });
    if (set) return {};
    return fail(set.error().code,
                fmt::format("aravis.trigger_line: {}; the camera has {}", set.error().what,
                            words_of_feature(camera_, "TriggerSource")));
  }

  Result<void> set_exposure() {
    (void)ask(
        [&](GError** error) { arv_camera_set_exposure_time_auto(camera_, ARV_AUTO_OFF, error); });
    double least_us = 0, most_us = 0;
    if (auto bounds = step("exposure_ms",
                           [&](GError** error) {
                             arv_camera_get_exposure_time_bounds(camera_, &least_us, &most_us,
                                                                 error);
                           });
        !bounds)
      return bounds;
    const double wanted_us = settings_.exposure_ms * 1e3;
    if (wanted_us < least_us || wanted_us > most_us)
      return outside("exposure_ms", settings_.exposure_ms, least_us / 1e3, most_us / 1e3, "ms");
    if (auto set =
            step("exposure_ms",
                 [&](GError** error) { arv_camera_set_exposure_time(camera_, wanted_us, error); });
        !set)
      return set;
    const auto made_us =
        ask([&](GError** error) { return arv_camera_get_exposure_time(camera_, error); });
    if (!made_us) return fail_in("exposure_ms", made_us.error());
    accepted_.exposure_ms = *made_us / 1e3;
    return {};
  }

  /// The rate that is possible depends on the region and the exposure.
  Result<void> set_rate() {
    if (settings_.aravis.trigger != Trigger::free_run) return {};
    double least_hz = 0, most_hz = 0;
    if (auto bounds = step("rate_hz",
                           [&](GError** error) {
                             arv_camera_get_frame_rate_bounds(camera_, &least_hz, &most_hz, error);
                           });
        !bounds)
      return bounds;
    if (settings_.rate_hz < least_hz || settings_.rate_hz > most_hz)
      return outside("rate_hz", settings_.rate_hz, least_hz, most_hz, "Hz");
    if (auto set = step(
            "rate_hz",
            [&](GError** error) { arv_camera_set_frame_rate(camera_, settings_.rate_hz, error); });
        !set)
      return set;
    const auto made_hz =
        ask([&](GError** error) { return arv_camera_get_frame_rate(camera_, error); });
    if (!made_hz) return fail_in("rate_hz", made_hz.error());
    accepted_.rate_hz = *made_hz;
    if (std::abs(*made_hz - settings_.rate_hz) > 0.005 * settings_.rate_hz)
      log::warning("it runs at {:.1f} Hz instead of {:.1f} Hz", *made_hz, settings_.rate_hz);
    return {};
  }

  Result<void> set_gain() {
    (void)ask([&](GError** error) { arv_camera_set_gain_auto(camera_, ARV_AUTO_OFF, error); });
    const auto available =
        ask([&](GError** error) { return arv_camera_is_gain_available(camera_, error); });
    if (!available || !*available) {
      if (settings_.aravis.gain_db == 0) return {};
      return fail(Errc::bad_config, "aravis.gain_db: this camera has no gain");
    }
    double least_db = 0, most_db = 0;
    if (auto bounds = step("aravis.gain_db",
                           [&](GError** error) {
                             arv_camera_get_gain_bounds(camera_, &least_db, &most_db, error);
                           });
        !bounds)
      return bounds;
    const double wanted_db = settings_.aravis.gain_db == 0 ? least_db : settings_.aravis.gain_db;
    if (wanted_db < least_db || wanted_db > most_db)
      return outside("aravis.gain_db", wanted_db, least_db, most_db, "dB");
    return step("aravis.gain_db",
                [&](GError** error) { arv_camera_set_gain(camera_, wanted_db, error); });
  }

  Result<void> set_exposure_line() {
    if (settings_.aravis.exposure_line.empty()) return {};
    for (const auto& [feature, word] : {std::pair{"LineSelector", settings_.aravis.exposure_line},
                                        std::pair{"LineMode", std::string("Output")},
                                        std::pair{"LineSource", std::string("ExposureActive")}})
      if (auto set = set_feature(camera_, fmt::format("{}={}", feature, word)); !set)
        return fail_in("aravis.exposure_line", set.error());
    return {};
  }

  /// Without packet sockets, which hold packets back for up to 5 ms.
  Result<void> set_packets() {
    if (!arv_camera_is_gv_device(camera_)) return {};
    arv_camera_gv_set_stream_options(camera_, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    arv_camera_gv_set_packet_size_adjustment(camera_, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
    const int bytes = settings_.aravis.packet_bytes;
    if (auto set = step("aravis.packet_bytes",
                        [&](GError** error) {
                          if (bytes == 0)
                            arv_camera_gv_auto_packet_size(camera_, error);
                          else
                            arv_camera_gv_set_packet_size(camera_, bytes, error);
                        });
        !set)
      return set;
    if (auto set = step("aravis.packet_delay_us",
                        [&](GError** error) {
                          arv_camera_gv_set_packet_delay(
                              camera_, std::llround(settings_.aravis.packet_delay_us * 1e3), error);
                        });
        !set && settings_.aravis.packet_delay_us > 0)
      return set;
    const auto made =
        ask([&](GError** error) { return arv_camera_gv_get_packet_size(camera_, error); });
    if (!made) return fail_in("aravis.packet_bytes", made.error());
    accepted_.packet_bytes = static_cast<int>(*made);
    return {};
  }

  Result<void> set_features() {
    for (const auto& feature : settings_.aravis.features)
      if (auto set = set_feature(camera_, feature); !set)
        return fail_in("aravis.features", set.error());
    return {};
  }

  ArvCamera* camera_;
  const config::Camera& settings_;
  int width_px_, height_px_;
  Accepted accepted_;
};

}  // namespace

Result<Accepted> configure(ArvCamera* camera, const config::Camera& settings, int width_px,
                           int height_px) {
  return Setup(camera, settings, width_px, height_px).run();
}

}  // namespace handcast::camera::aravis
