// Milliseconds per named stage of a frame: timestamp queries on hardware, wall clock around a finish on software
// rendering, where queries mean nothing.
#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "gl/debug.h"
#include "gl/names.h"

namespace caustream::gl {

class StageTimer {
   public:
    struct Row {
        std::string name;
        double ms = 0.0;
    };

    explicit StageTimer(bool software) : software_(software) {}

    void beginFrame();
    // Runs `work` as stage `name`, inside a debug group of that name. A name used twice in a frame adds up.
    template <class Work>
    void stage(std::string_view name, Work&& work) {
        const DebugGroup group(name);
        begin(name);
        work();
        end();
    }
    // The frame's rows in the order they first ran. On hardware waits for the last query, so call it after the read-back.
    std::vector<Row> rows();

   private:
    using Clock = std::chrono::steady_clock;
    struct Span {
        std::string name;
        double ms = 0.0;
        std::size_t query = 0;   // index of the first of two timestamps
    };
    void begin(std::string_view name);
    void end();
    GLuint query(std::size_t index);

    bool software_;
    Clock::time_point start_;
    std::vector<Span> spans_;
    std::vector<Query> queries_;
};

}  // namespace caustream::gl
