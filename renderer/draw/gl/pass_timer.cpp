// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/gl/pass_timer.hpp"

namespace handcast::renderer::gl {

PassTimer::PassTimer(Context& context, bool on) : context_(context), on_(on) {
  if (!on) return;
  for (Query& query : queries_) {
    GLuint name = 0;
    context.gl().CreateQueries(GL_TIME_ELAPSED, 1, &name);
    query = Query(context, name);
  }
}

void PassTimer::begin(Pass pass) {
  if (on_) context_.gl().BeginQuery(GL_TIME_ELAPSED, queries_[static_cast<int>(pass)].name());
}

void PassTimer::end(Pass pass) {
  if (!on_) return;
  context_.gl().EndQuery(GL_TIME_ELAPSED);
  used_[static_cast<int>(pass)] = true;
}

PassTimes PassTimer::take() {
  PassTimes times{};
  for (std::size_t i = 0; i < times.size() && context_.make_current(); ++i) {
    if (!std::exchange(used_[i], false)) continue;
    GLuint64 elapsed_ns = 0;
    context_.gl().GetQueryObjectui64v(queries_[i].name(), GL_QUERY_RESULT, &elapsed_ns);
    times[i] = static_cast<double>(elapsed_ns) / 1000;
  }
  return times;
}

}  // namespace handcast::renderer::gl
