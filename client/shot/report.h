// The JSON beside the picture, and the line that says it is done.
#pragma once
#include <string>
#include <vector>

#include "client/shot/options.h"
#include "client/shot/session.h"

namespace caustream::shot {

class Report {
 public:
    Report(const Options& options, const Session& session);
    void add(const connection::Frame& frame, std::uint64_t tookUs);  // from asking to decoded

    protocol::Json json(const std::string& file, const connection::Frame& last, const Session& session) const;
    std::string line(const std::string& file, const connection::Frame& last, const Session& session) const;

 private:
    const Options& options_;
    protocol::Json server_;
    std::vector<double> tookMs_, renderMs_, encodeMs_, decodeMs_, overheadMs_;
    std::vector<std::string> hashes_;
    double payloadBytes_ = 0.0;
};

}  // namespace caustream::shot
