// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "services/content/projegraphy/painter.hpp"
#include "services/content/projegraphy/remote.hpp"

namespace handcast::projegraphy {

/// Lowers the priority of this thread below that of the content's own one.
void give_way();

/// A picture of a silhouette that is being made.
class Order {
 public:
  Order(Silhouette silhouette, Servers servers)
      : silhouette_(std::move(silhouette)), servers_(std::move(servers)) {}

  const Silhouette& silhouette() const { return silhouette_; }
  /// True if nothing more will come. Any thread.
  bool is_done() const;
  /// Waits for that.
  void wait() const;
  /// Of an order that is done: what it resembles, empty if nothing could be made of it, and its
  /// picture: painted(), or calm_picture() if it is no animal.
  /// @{
  const std::optional<Recognised>& recognised() const { return recognised_; }
  const renderer::Texture& picture() const { return picture_; }
  /// @}

 private:
  friend class Studio;
  void finish(std::optional<Recognised> recognised, renderer::Texture picture);

  const Silhouette silhouette_;
  const Servers servers_;
  std::optional<Recognised> recognised_;
  renderer::Texture picture_;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  bool is_done_ = false;
};

/// Recognises and paints, on a thread of low priority, for all hands of a process. The library of
/// silhouettes is made when it opens.
class Studio {
 public:
  /// The studio for hands with these meshes, left and right. Any thread.
  static std::shared_ptr<Studio> shared(const std::array<const renderer::HandMesh*, 2>& meshes);

  /// Copies the meshes.
  explicit Studio(const std::array<const renderer::HandMesh*, 2>& meshes);
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;
  ~Studio();

  /// Begins a picture; that of an equal silhouette is shared. An order that nobody holds any more
  /// is not begun. What the servers do not do is done here, with a sentence in the log. Any thread;
  /// does not wait.
  std::shared_ptr<const Order> order(Silhouette silhouette, const Servers& servers = {});

 private:
  void work(const std::stop_token& stop);
  std::shared_ptr<Order> next(const std::stop_token& stop);
  void make(const Recogniser& recogniser, Order& order, const std::stop_token& stop);
  std::optional<Recognised> recognise(const Recogniser& recogniser, const Order& order,
                                      const std::stop_token& stop);
  renderer::Texture paint(const Order& order, const Recognised& recognised,
                          const std::stop_token& stop);
  void complain(const Error& error);

  std::array<renderer::HandMesh, 2> meshes_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<std::shared_ptr<Order>> waiting_;
  std::weak_ptr<Order> last_;
  Remote remote_;          ///< of the worker
  std::string complaint_;  ///< the last one
  std::jthread worker_;    ///< the last member: it ends first
};

}  // namespace handcast::projegraphy
