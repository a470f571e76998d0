// SPDX-License-Identifier: Apache-2.0
#include "services/desk/page/board.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "services/desk/page/json_text.hpp"

namespace handcast::desk {

Board::Guest::Guest(Board& board) : board_(board) {
  {
    const std::lock_guard lock(board_.mutex_);
    ++board_.guests_;
  }
  board_.arrivals_.notify_all();
}

Board::Guest::~Guest() {
  const std::lock_guard lock(board_.mutex_);
  --board_.guests_;
}

void Board::tell(Topic topic, std::string json) {
  const auto at = static_cast<std::size_t>(topic);
  {
    const std::lock_guard lock(mutex_);
    if (texts_[at] == json) return;
    texts_[at] = std::move(json);
    ++counts_[at];
  }
  news_.notify_all();
}

void Board::tell(std::shared_ptr<const Values> values) {
  {
    const std::lock_guard lock(mutex_);
    // Two threads may have asked the panel, and the later one tells first.
    if (!values || (values_ && values->revision <= values_->revision)) return;
    values_ = std::move(values);
  }
  news_.notify_all();
}

void Board::close() {
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
  }
  news_.notify_all();
  arrivals_.notify_all();
}

bool Board::has_news(const Seen& seen) const {
  return seen.values != values_ || seen.topics != counts_;
}

/// Only what is different from what the page has seen.
void Board::append_values(const Seen& seen, std::string& events) const {
  nlohmann::json changed = nlohmann::json::object();
  for (std::size_t i = 0; i < controls_.size() && i < values_->toml.size(); ++i)
    if (!seen.values || seen.values->toml[i] != values_->toml[i])
      changed[controls_[i].path] = values_->toml[i];
  events += "event: values\ndata: " +
            json_text({{"revision", values_->revision},
                       {"source", values_->source},
                       {"change", values_->change},
                       {"undo", values_->can_undo},
                       {"redo", values_->can_redo},
                       {"values", std::move(changed)}}) +
            "\n\n";
}

bool Board::wait(Seen& seen, std::string& events, std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  news_.wait_for(lock, patience, [&] { return is_closed_ || has_news(seen); });
  if (is_closed_) return false;
  if (values_ && seen.values != values_) append_values(seen, events);
  seen.values = values_;
  for (std::size_t i = 0; i < kTopics; ++i) {
    if (seen.topics[i] == counts_[i]) continue;
    events += "event: " + std::string(kTopicNames[i]) + "\ndata: " + texts_[i] + "\n\n";
    seen.topics[i] = counts_[i];
  }
  return true;
}

bool Board::wait_for_guest() {
  std::unique_lock lock(mutex_);
  arrivals_.wait(lock, [&] { return is_closed_ || guests_ > 0; });
  return !is_closed_;
}

bool Board::pause(std::chrono::milliseconds span) {
  std::unique_lock lock(mutex_);
  return !arrivals_.wait_for(lock, span, [&] { return is_closed_; });
}

int Board::guests() const {
  const std::lock_guard lock(mutex_);
  return guests_;
}

}  // namespace handcast::desk
