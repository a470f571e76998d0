// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "renderer/media/colour_film.hpp"
#include "services/content/settable_source.hpp"

namespace handcast::content {

Result<std::unique_ptr<Source>> open_stream(const Opening& opening);

namespace {

namespace fs = std::filesystem;
using renderer::ColourFilm;
using renderer::FilmOpening;
using renderer::Texture;

/// A frame at its place on the time line of a film that goes round and round.
struct FilmFrame {
  Texture picture;
  double position_s = 0;
};

/// Decodes the frames of a film ahead of time, in a thread of its own. The other functions are
/// those of one other thread; none of them waits for the decoder.
class FramesAhead {
 public:
  /// `first`: the frame that the film has decoded last.
  FramesAhead(std::unique_ptr<ColourFilm> film, FilmFrame first, std::atomic<bool>& is_over)
      : film_(std::move(film)),
        is_over_(is_over),
        period_s_(static_cast<double>(film_->period_ns()) / 1e9),
        width_(first.picture.width()),
        height_(first.picture.height()),
        newest_s_(first.position_s),
        last_s_(first.position_s) {
    ready_.push_back(std::move(first));
    thread_ = std::thread([this] { run(); });
  }
  ~FramesAhead() {
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  FramesAhead(const FramesAhead&) = delete;
  FramesAhead& operator=(const FramesAhead&) = delete;

  /// Swaps the frame of this position with `out`. Returns false if there is none that is newer
  /// than that of the last call. A decoder that is too slow takes the position back with it.
  bool take(double& position_s, Texture& out) {
    constexpr double kMostBehind_s = 1;
    const std::lock_guard lock(mutex_);
    if (jump_s_) return false;
    position_s = std::min(position_s, newest_s_ + kMostBehind_s);
    wanted_s_ = position_s;
    bool has_taken = false;
    while (!ready_.empty() && ready_.front().position_s <= position_s + kSame_s) {
      std::swap(out, ready_.front().picture);
      spare_.push_back(std::move(ready_.front().picture));
      ready_.pop_front();
      has_taken = true;
    }
    if (has_taken) wake_.notify_all();
    return has_taken;
  }
  void jump_to(double position_s) {
    const std::lock_guard lock(mutex_);
    jump_s_ = position_s;
    wake_.notify_all();
  }
  void set_loops(bool loops) {
    const std::lock_guard lock(mutex_);
    loops_ = loops;
    wake_.notify_all();
  }

 private:
  static constexpr std::size_t kMostAhead = 3;
  static constexpr double kSame_s = 1e-6;

  void run() {
    for (;;) {
      std::optional<double> jump_s;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] {
          return is_over_ || jump_s_ || (ready_.size() < kMostAhead && (!has_ended_ || loops_));
        });
        if (is_over_) return;
        jump_s = jump_s_;
      }
      if (jump_s) do_jump(*jump_s);
      if (has_ended_ ? !begin_again() : !decode()) note_end();
    }
  }

  /// Decodes one frame and makes it ready, unless it would be late. Returns false at the end.
  bool decode() {
    constexpr int kMostSkipped = 4;  // in a row, so that a slow decoder shows something
    const auto time_ns = film_->next();
    if (!time_ns || !*time_ns) return false;
    last_s_ = offset_s_ + static_cast<double>(**time_ns) / 1e9;
    const double until_s = last_s_ + period_s_;
    if (until_s <= from_s_) return true;
    // After a jump, the first frame is shown, even if the film has found only a later one.
    FilmFrame frame{{}, std::exchange(has_jumped_, false) ? std::min(last_s_, from_s_) : last_s_};
    {
      const std::lock_guard lock(mutex_);
      if (until_s <= wanted_s_ && skipped_ < kMostSkipped) {
        ++skipped_;
        return true;
      }
      if (!spare_.empty()) {
        frame.picture = std::move(spare_.back());
        spare_.pop_back();
      }
    }
    if (frame.picture.width() == 0) frame.picture = Texture(width_, height_);
    const bool is_read = film_->read(frame.picture);
    const std::lock_guard lock(mutex_);
    skipped_ = 0;
    newest_s_ = last_s_;
    if (is_read && !jump_s_) ready_.push_back(std::move(frame));
    return true;
  }

  void do_jump(double position_s) {
    offset_s_ = 0;
    from_s_ = position_s;
    has_jumped_ = true;
    has_ended_ = !film_->seek(static_cast<std::int64_t>(position_s * 1e9));
    if (has_ended_) has_ended_ = !film_->seek(0);  // it is shorter
    const std::lock_guard lock(mutex_);
    ready_.clear();
    newest_s_ = wanted_s_ = last_s_ = position_s;
    if (jump_s_ == position_s) jump_s_.reset();
  }

  /// Returns false if the film cannot be played again: then it stays at its end.
  bool begin_again() {
    if (last_s_ <= offset_s_) return false;  // one frame
    offset_s_ = last_s_ + period_s_;
    from_s_ = 0;
    if (!film_->seek(0)) return false;
    has_ended_ = false;
    return true;
  }

  void note_end() {
    const std::lock_guard lock(mutex_);
    // A film that cannot be played again would end at once, again and again.
    if (has_ended_) loops_ = false;
    has_ended_ = true;
  }

  std::unique_ptr<ColourFilm> film_;
  std::atomic<bool>& is_over_;
  const double period_s_;
  const int width_, height_;

  std::mutex mutex_;
  std::condition_variable wake_;
  /// Of both threads.
  /// @{
  std::deque<FilmFrame> ready_;
  std::vector<Texture> spare_;
  std::optional<double> jump_s_;
  double wanted_s_ = 0, newest_s_;
  bool loops_ = true;
  /// @}
  /// Of the decoding thread.
  /// @{
  bool has_ended_ = false;
  double offset_s_ = 0;  ///< of this round
  double last_s_;        ///< the frame that was decoded last
  double from_s_ = 0;    ///< frames before are not wanted
  bool has_jumped_ = false;
  int skipped_ = 0;
  /// @}
  std::thread thread_;
};

class FilmSource final : public SettableSource {
 public:
  FilmSource(fs::path file, fs::file_time_type changed)
      : SettableSource(
            {plain_parameter("loop", "Begins again at its end", Parameter::Kind::flag, {1}),
             number_parameter("speed", "Speed", 0, 10, 1),
             number_parameter("start", "Begins here, in seconds", 0, 86'400, 0)}),
        file_(std::move(file)),
        changed_(changed) {}

  /// Opens the film and decodes its first frame.
  Result<void> open(int width, int height) {
    auto film = renderer::open_colour_film(
        {.kind = FilmOpening::Kind::file, .address = file_.string()}, is_over_);
    if (!film) return tl::make_unexpected(film.error());
    const auto first = (*film)->next();
    FilmFrame frame{Texture(width, height), 0};
    if (!first || !*first || !(*film)->read(frame.picture))
      return fail(
          Errc::bad_config,
          fmt::format("'{}' has no frame that can be decoded; it is damaged", file_.string()));
    frame.position_s = static_cast<double>(**first) / 1e9;
    frames_.emplace(std::move(*film), std::move(frame), is_over_);
    return {};
  }

  Result<void> set(std::string_view name, std::string_view value) override {
    if (auto set = SettableSource::set(name, value); !set) return set;
    if (name == "loop") frames_->set_loops(number("loop") != 0);
    if (name == "start") {
      position_s_ = number("start");
      frames_->jump_to(position_s_);
    }
    return {};
  }

  Result<bool> draw(const Moment& moment, std::span<const renderer::View<const std::uint32_t>>,
                    Texture& out) override {
    if (last_s_) position_s_ += number("speed") * std::max(0., moment.time_s - *last_s_);
    last_s_ = moment.time_s;
    return frames_->take(position_s_, out);
  }

  bool is_stale() const override {
    std::error_code failed;
    const auto changed = fs::last_write_time(file_, failed);
    return !failed && changed != changed_;
  }

 private:
  fs::path file_;
  fs::file_time_type changed_;
  std::atomic<bool> is_over_ = false;
  std::optional<FramesAhead> frames_;
  double position_s_ = 0;
  std::optional<double> last_s_;  ///< the time of the last call
};

}  // namespace

Result<std::unique_ptr<Source>> open_film(const Opening& opening) {
  const std::string& what = opening.element.what;
  if (what.find("://") != what.npos) return open_stream(opening);
  std::error_code none;
  auto film = std::make_unique<FilmSource>(what, fs::last_write_time(what, none));
  if (auto opened = film->open(opening.width, opening.height); !opened)
    return tl::make_unexpected(opened.error());
  return film;
}

}  // namespace handcast::content
