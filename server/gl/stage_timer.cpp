#include "gl/stage_timer.h"

#include <algorithm>

namespace caustream::gl {

void StageTimer::beginFrame() { spans_.clear(); }

GLuint StageTimer::query(std::size_t index) {
    while (queries_.size() <= index) queries_.push_back(makeQuery(GL_TIMESTAMP));
    return queries_[index].get();
}

void StageTimer::begin(std::string_view name) {
    spans_.push_back({std::string(name), 0.0, spans_.size() * 2});
    if (software_) {
        start_ = Clock::now();
    } else {
        glQueryCounter(query(spans_.back().query), GL_TIMESTAMP);
    }
}

void StageTimer::end() {
    Span& span = spans_.back();
    if (software_) {
        glFinish();
        span.ms = std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
    } else {
        glQueryCounter(query(span.query + 1), GL_TIMESTAMP);
    }
}

std::vector<StageTimer::Row> StageTimer::rows() {
    std::vector<Row> rows;
    for (Span& span : spans_) {
        if (!software_) {
            GLuint64 from = 0, to = 0;
            glGetQueryObjectui64v(query(span.query), GL_QUERY_RESULT, &from);
            glGetQueryObjectui64v(query(span.query + 1), GL_QUERY_RESULT, &to);
            span.ms = 1e-6 * static_cast<double>(to - from);
        }
        const auto same = std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.name == span.name; });
        if (same == rows.end()) {
            rows.push_back({span.name, span.ms});
        } else {
            same->ms += span.ms;
        }
    }
    return rows;
}

}  // namespace caustream::gl
