// A viewer's state document -> what the renderer and the encoder are asked for.
#pragma once
#include <memory>
#include <tl/expected.hpp>

#include "protocol/messages.h"
#include "render/frame.h"
#include "stream/encoder.h"
#include "stream/ladder.h"

namespace caustream {

struct View {
    render::Request request;
    stream::EncodeSettings encode;
    stream::EncodeSettings encodeLast;  // of a picture that has converged: JPEG's losses would outlast the wait for it
    protocol::StreamState stream;
    bool adaptive = false;              // moving frames follow the quality ladder

    // The still of a picture at rest comes once more, without loss.
    bool losslessFollows() const { return adaptive && encodeLast.encoding != encode.encoding; }
};

// `scene` already has the document's lights and materials; a client that reads PNG gets its last picture as one. Errors: a pass there is not, an encoding or samples
// this server does not have, a camera without a direction.
tl::expected<View, protocol::DecodeError> resolveRequest(const protocol::State& state,
                                                         std::shared_ptr<const scene::Scene> scene, bool readsPng = true);

// About what the server holds for such a viewer, on both sides of the bus: its scene, which others may share, its maps and
// its pictures.
std::size_t estimatedBytes(const View& view);

// What a frame of this view is, for `stream.info`; its epoch is the outbox's.
protocol::StreamInfo streamInfo(const View& view, const render::Frame& frame, protocol::Encoding encoding);

// The size that such a frame is shown at: a picture's is the view's, whatever the ladder made of it.
stream::Ladder::Size shownSize(const View& view, const render::Frame& frame);

// Header and statistics of a rendered frame: all but what only the outbox and the scheduler know.
protocol::FrameHeader frameHeader(const View& view, const render::Frame& frame, const stream::EncodeSettings& encode, int level);
protocol::Stats frameStats(const render::Frame& frame);

}  // namespace caustream
