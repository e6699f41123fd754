// Draws what a line of a batch asks for.
#pragma once
#include <functional>

#include "client/shot/line_job.h"
#include "client/shot/session.h"

namespace caustream::shot {

// What the frames of `target` are asked for as: "bands" is the spectral map with a band per wavelength.
protocol::Json streamOf(const std::string& target, protocol::Sample sample);

// One frame that may be waited for where the server is busy, acknowledged, with its statistics.
tl::expected<Shown, Failure> requestShown(Session& session, bool converge, bool still = true);

// Shows the job's document and fetches every target in what `formats` need. The session's state() is then the document as the
// server resolved it. `progress` is told how far a line that converges has come.
tl::expected<std::vector<Drawn>, Failure> drawLine(Session& session, const LineJob& job, const std::vector<Format>& formats,
                                                   const std::function<void(const protocol::Convergence&)>& progress);

}  // namespace caustream::shot
