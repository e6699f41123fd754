// What a viewer's log gets, where the viewer asked for one and the operator allows it.
#include "log.h"
#include "session/random_id.h"
#include "viewer.h"

namespace caustream {

using protocol::Json;

void Viewer::on(const protocol::Record& record) {
    const auto refused = [&](protocol::ErrorCode code, std::string why) {
        refuse({.code = code, .message = std::move(why), .field = "op", .id = record.id});
    };
    protocol::Ok reply{.id = record.id};
    if (desk_.config.recordDir.empty()) {
        return refused(protocol::ErrorCode::Unsupported, "this server records nothing: it was started without --record-dir");
    }
    if (!following_.empty()) {
        return refused(protocol::ErrorCode::Forbidden, "a view shows what another session does: that one can be recorded");
    }
    if (!record.on) {
        recorder_.reset();
    } else if (!recorder_) {
        auto started = session::Recorder::start(desk_.config.recordDir, session_->viewId(),
                                                {{"build", CAUSTREAM_VERSION},
                                                 {"gpu", desk_.renderer->gpuName()},
                                                 {"rev", session_->rev()},
                                                 {"input_seq", session_->inputSeq},
                                                 {"state", session_->document()}});
        if (!started) {
            return refused(protocol::ErrorCode::Busy, started.error());
        }
        recorder_.emplace(std::move(*started));
        log::info("record").with("connection", connection_.id()).with("file", recorder_->file());
    }
    if (recorder_) {
        reply.recording = recorder_->file();
    }
    send(reply);
}

void Viewer::noteChange(const Json& patch, const std::optional<protocol::Input>& input) {
    if (!recorder_) {
        return;
    }
    Json line = {{"op", input ? "input" : "update"}, {"rev", session_->rev()}, {"patch", patch}};
    if (input) {
        line["seq"] = input->seq;
    }
    note(std::move(line));
}

void Viewer::noteRequest(const protocol::FrameRequest& request) {
    if (recorder_) {
        note({{"op", "frame.request"}, {"id", request.id}, {"still", request.still}, {"converge", request.converge}, {"rev", session_->rev()}});
    }
}

// The photons tell whether another run can be expected to come to the same map.
void Viewer::noteAnswer(std::uint32_t requestId, const session::OutgoingFrame& frame) {
    if (recorder_) {
        note({{"op", "frame"}, {"id", requestId}, {"map_hash", frame.mapHash}, {"photons", frame.stats.photons}});
    }
}

void Viewer::note(Json line) {
    if (const auto ended = recorder_->note(std::move(line))) {
        log::warning("record").with("connection", connection_.id()).with("message", *ended);
        send(protocol::Status{.level = protocol::Status::Level::Warning, .key = "record", .message = *ended});
        recorder_.reset();
    }
}

}  // namespace caustream
