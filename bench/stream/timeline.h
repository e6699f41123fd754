// Frame age and quality level against time, as an SVG: how a stream met a link that changed.
#pragma once
#include <string>
#include <vector>

namespace caustream::bench {

struct TimelinePoint {
    double s = 0, ageMs = 0;
    int level = 0;              // 0: the best
};
struct TimelinePhase {
    double fromS = 0, toS = 0;
    std::string name;           // "2 MB/s"
};

std::string timelineSvg(const std::string& title, const std::vector<TimelinePhase>& phases, const std::vector<TimelinePoint>& points,
                        double limitMs, int levels);

}  // namespace caustream::bench
