// /metrics: what is read by docs/operations.md's table.
#include <algorithm>

#include "gl/names.h"
#include "metrics_text.h"
#include "service.h"

namespace caustream {

std::string Service::metrics() const {
    std::uint64_t frames = sentFrames_, bytes = sentBytes_, replaced = replaced_, outdated = outdated_;
    double waiting = 0, paused = 0, streaming = 0;
    for (const auto& [key, viewer] : viewers_) {
        frames += viewer->outbox().sent();
        bytes += viewer->outbox().sentBytes();
        replaced += viewer->outbox().drops().replaced;
        outdated += viewer->outbox().drops().outdated;
        ++(!viewer->ready() ? waiting : viewer->streaming() ? streaming : paused);
    }
    const Counters& counters = desk_.counters;
    const net::SocketCounts sockets = server_.counts();
    const auto number = [](auto value) { return static_cast<double>(value); };

    MetricsText text;
    text.gauges("build_info", "1, of this version, renderer and server.",
                {{{{"version", CAUSTREAM_VERSION}, {"renderer", renderer_->gpuName()}, {"server", desk_.serverId}}, 1}});
    text.gauges("viewers", "Open WebSockets, by what they do.",
                {{{{"state", "connecting"}}, waiting}, {{{"state", "paused"}}, paused}, {{{"state", "streaming"}}, streaming}});
    text.gauge("sessions", "Viewers that said hello.", desk_.sessions);
    text.gauge("sessions_limit", "As many may.", desk_.limits.sessions);
    text.gauge("draining", "1 from SIGTERM on.", draining_);
    text.gauge("failed", "1 from the watchdog's verdict on.", failed_);

    text.counter("frames_rendered_total", "Frames drawn.", number(renderer_->frames()));
    text.counter("render_failures_total", "Frames the GPU refused.", number(renderer_->failures()));
    text.histogram("render_seconds", "Time to draw a frame.", counters.render);
    text.histogram("encode_seconds", "Time to encode a picture.", counters.encode);
    text.histogram("frame_age_seconds", "From a change to the acknowledgement of a picture that shows it.", counters.frameAge);
    text.counter("light_runs_total", "Frames whose light was worked out.", number(renderer_->lightRuns()));
    text.counter("light_reuses_total", "Frames that found their light worked out.", number(renderer_->lightReuses()));
    text.gauge("gl_objects", "Textures, buffers, programs and the like that the renderer holds.", number(gl::liveObjects.load()));

    text.counter("frames_sent_total", "Frames handed to sockets.", number(frames));
    text.counters("frames_dropped_total", "Frames drawn and never sent, by why.", 
                  {{{{"cause", "replaced"}}, number(replaced)}, {{{"cause", "outdated"}}, number(outdated)}});
    text.counter("sent_bytes_total", "Bytes of frames handed to sockets.", number(bytes));
    text.counters("received_messages_total", "Messages from viewers.",
                  {{{{"kind", "text"}}, number(counters.texts)}, {{{"kind", "binary"}}, number(counters.binaries)}});
    text.counter("received_bytes_total", "Bytes of messages from viewers.", number(counters.receivedBytes));
    text.counter("uploads_total", "Files that were uploaded and read.", number(counters.uploads));
    std::vector<MetricsText::Labelled> errors;
    for (const protocol::ErrorCode code : {protocol::ErrorCode::RateLimited, protocol::ErrorCode::Busy}) {
        errors.push_back({{{"code", std::string(protocol::errorName(code))}}, 0});  // there from the start: rates of what appears late are wrong
    }
    for (const auto& [code, count] : counters.errors) {
        const MetricsText::Labelled now{{{"code", std::string(protocol::errorName(code))}}, number(count)};
        const auto listed = std::ranges::find(errors, now.labels, &MetricsText::Labelled::labels);
        listed == errors.end() ? void(errors.push_back(now)) : void(*listed = now);
    }
    text.counters("errors_total", "Errors that viewers were answered with.", errors);

    text.gauge("sockets", "Open sockets, those of plain HTTP too.", number(sockets.open));
    text.counter("sockets_refused_total", "Sockets turned away: too many, in all or from one address.", number(sockets.refused));
    text.counters("sockets_ended_total", "Sockets that were closed on their owners, by why.",
                  {{{{"cause", "slow"}}, number(sockets.slow)},
                   {{{"cause", "stuck"}}, number(sockets.stuck)},
                   {{{"cause", "flooding"}}, number(sockets.flooding)}});
    text.histogram("loop_lag_seconds", "How late the network thread came to its quarterly round.", counters.loopLag);
    addProcessMetrics(text);
    return text.text();
}

}  // namespace caustream
