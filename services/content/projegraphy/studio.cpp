// SPDX-License-Identifier: Apache-2.0
#include "services/content/projegraphy/studio.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "ipc/base/clock.hpp"
#include "ipc/base/log.hpp"

namespace handcast::projegraphy {
void give_way() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
}

bool Order::is_done() const {
  const std::lock_guard lock(mutex_);
  return is_done_;
}

void Order::wait() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return is_done_; });
}

void Order::finish(std::optional<Recognised> recognised, renderer::Texture picture) {
  const std::lock_guard lock(mutex_);
  recognised_ = std::move(recognised);
  picture_ = std::move(picture);
  is_done_ = true;
  changed_.notify_all();
}

std::shared_ptr<Studio> Studio::shared(const std::array<const renderer::HandMesh*, 2>& meshes) {
  static std::mutex mutex;
  static std::weak_ptr<Studio> last;
  static std::array<const renderer::HandMesh*, 2> its_meshes{};
  const std::lock_guard lock(mutex);
  auto studio = last.lock();
  if (studio && its_meshes == meshes) return studio;
  studio = std::make_shared<Studio>(meshes);
  last = studio;
  its_meshes = meshes;
  return studio;
}

Studio::Studio(const std::array<const renderer::HandMesh*, 2>& meshes)
    : meshes_{*meshes[0], *meshes[1]},
      worker_([this](const std::stop_token& stop) { work(stop); }) {}

Studio::~Studio() = default;

std::shared_ptr<const Order> Studio::order(Silhouette silhouette, const Servers& servers) {
  const std::lock_guard lock(mutex_);
  if (auto last = last_.lock();
      last && last->silhouette().mask.pixels() == silhouette.mask.pixels() &&
      last->silhouette().origin_px == silhouette.origin_px && last->servers_ == servers)
    return last;
  auto order = std::make_shared<Order>(std::move(silhouette), servers);
  waiting_.push_back(order);
  last_ = order;
  changed_.notify_all();
  return order;
}

std::shared_ptr<Order> Studio::next(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (changed_.wait(lock, stop, [&] { return !waiting_.empty(); }) && !stop.stop_requested()) {
    auto order = std::move(waiting_.front());
    waiting_.pop_front();
    if (order.use_count() > 1) return order;
  }
  return nullptr;
}

void Studio::work(const std::stop_token& stop) {
  give_way();
  const Recogniser recogniser({&meshes_[0], &meshes_[1]}, stop);
  while (const auto order = next(stop)) make(recogniser, *order, stop);
}

void Studio::make(const Recogniser& recogniser, Order& order, const std::stop_token& stop) {
  const auto begin_ns = now_ns();
  auto recognised = recognise(recogniser, order, stop);
  if (!recognised) return order.finish(std::nullopt, {});
  auto picture = paint(order, *recognised, stop);
  const bool is_animal = recognised->animal >= 0;
  log::info("projegraphy: {}, distance {:.3f} (the next animal {:.3f}), {:.0f} ms",
            is_animal ? animals()[static_cast<std::size_t>(recognised->animal)].name : "no animal",
            recognised->distance, recognised->runner_up, ns_to_ms(now_ns() - begin_ns));
  order.finish(std::move(recognised), std::move(picture));
}

std::optional<Recognised> Studio::recognise(const Recogniser& recogniser, const Order& order,
                                            const std::stop_token& stop) {
  if (order.silhouette_.area_px == 0) return std::nullopt;
  if (!order.servers_.recogniser.empty()) {
    const auto animal = remote_.animal_of(order.servers_, order.silhouette_, stop);
    if (animal && *animal < 0) return Recognised();
    if (animal) return recogniser.place(order.silhouette_, *animal);
    complain(animal.error());
  }
  return recogniser.recognise(order.silhouette_);
}

renderer::Texture Studio::paint(const Order& order, const Recognised& recognised,
                                const std::stop_token& stop) {
  if (recognised.animal < 0) return calm_picture();
  if (!order.servers_.painter.empty()) {
    const auto& animal = animals()[static_cast<std::size_t>(recognised.animal)];
    auto picture = remote_.picture_of(order.servers_, order.silhouette_, animal.name, stop);
    if (picture) return std::move(*picture);
    complain(picture.error());
  }
  return painted(order.silhouette_, recognised);
}

/// The same sentence once until there is another one.
void Studio::complain(const Error& error) {
  if (error.what == std::exchange(complaint_, error.what)) return;
  log::warning("projegraphy: {}; what is built in takes over", printable(error.what));
}

}  // namespace handcast::projegraphy
