// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <mutex>
#include <string>

#include "services/desk/page/access.hpp"
#include "services/desk/page/actions.hpp"
#include "services/desk/page/board.hpp"
#include "services/desk/page/http_server.hpp"
#include "services/desk/page/picture_feed.hpp"

namespace handcast::desk {

/// Answers the requests of browsers. All threads.
///
///   GET  /, /page.css, …      the files of the page, for everybody
///   POST /api/session         {"token": …}: the cookie that keeps it
///   POST /api/pair            {"code": …}: the same for a code, from another computer
///   GET  /api/start           who one is; controls, looks, back ends
///   GET  /api/events          server-sent events: "values" and those of kTopicNames
///   GET  /api/picture         packets of PictureFeed
///   GET  /api/look/NAME       the picture of a look, PNG
///   POST /api/…               see actions.cpp
class Router {
 public:
  /// Most open pages and most of them that look at the picture.
  static constexpr int kMostPages = 16, kMostPictures = 8;

  /// All outlive this.
  Router(Worked worked, Access& access, Board& board, PictureFeed& pictures);

  HttpAnswer answer(const HttpRequest& request);

 private:
  HttpAnswer route(const HttpRequest& request);
  HttpAnswer open_session(const HttpRequest& request);
  HttpAnswer pair(const HttpRequest& request);
  HttpAnswer get(const HttpRequest& request, control::Role role);
  HttpAnswer post(const HttpRequest& request, control::Role role);
  HttpAnswer start(control::Role role) const;
  bool is_too_often();
  void complain(const HttpRequest& request, const std::string& sentence);

  Worked worked_;
  Access& access_;
  Board& board_;
  PictureFeed& pictures_;
  std::atomic<int> pages_ = 0, lookers_ = 0;
  std::mutex mutex_;         ///< of what follows
  double changes_left_ = 0;  ///< a bucket that is refilled all the time
  std::int64_t refilled_ns_ = 0;
  std::uint64_t refused_ = 0;  ///< since the last complaint
  std::int64_t complained_ns_ = 0;
};

}  // namespace handcast::desk
