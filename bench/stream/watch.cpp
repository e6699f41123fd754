#include "bench/stream/watch.h"

#include <algorithm>
#include <cmath>

#include "client/connection/connection.h"
#include "error.h"

namespace caustream::bench {

using connection::nowUs;
using protocol::Json;

protocol::Json plainDocument(bool autoQuality, int side) {
    return {{"scene", {"builtin", "sphere"}},
            {"transport", {{"mode", "refined"}, {"photon_grid", 64}, {"map_size", 64}, {"wavelengths", 1}}},
            {"stream",
             {{"width", side},
              {"height", side},
              {"max_fps", 240},
              {"quality", autoQuality ? Json{"auto"} : Json{"fixed", 90}}}}};
}

Watched watch(e2e::RawClient& client, const WatchOptions& options) {
    const auto pose = options.pose ? options.pose : [](std::uint32_t seq) {
        const double angle = 0.01 * seq;
        return Json{{"camera", {{"eye", {2.0 * std::sin(angle), 1.5, 2.0 * std::cos(angle)}}}}};
    };
    const auto periodUs = static_cast<std::uint64_t>(1e6 / options.inputsPerS);
    Watched watched{.lastInput = options.firstSeq - 1};
    const std::uint64_t firstUs = nowUs() + periodUs - (nowUs() + periodUs - options.phaseUs % periodUs) % periodUs;
    for (std::uint64_t now = nowUs(), due = firstUs; now < options.untilUs && !(options.stop && *options.stop); now = nowUs()) {
        if (now >= due) {
            Json input = pose(++watched.lastInput);
            input.update({{"op", "input"}, {"seq", watched.lastInput}, {"t_us", now}});
            client.json(input);
            due = std::max(due + periodUs, now);   // late ones are not made up for
        }
        const std::uint64_t wait = std::min(due, options.untilUs) - std::min(now, std::min(due, options.untilUs));
        const e2e::Message message = client.next(static_cast<int>((wait + 999) / 1000));
        if (message.kind == e2e::Message::Kind::Close) {
            watched.ended = "closed with " + std::to_string(message.closeCode) + ": " + message.text;
            break;
        }
        if (message.kind == e2e::Message::Kind::Text) {
            if (Json text = Json::parse(message.text); text.value("op", "") == "stats") watched.stats.push_back(std::move(text));
        }
        if (message.kind != e2e::Message::Kind::Binary) continue;
        const auto header = protocol::decodeFrameHeader(message.bytes);
        if (!header) throw Error("a frame was not understood: " + header.error().message + "; are server and bench of one build?");
        const std::uint64_t at = nowUs();
        client.json({{"op", "ack"}, {"seq", header->frameSeq}, {"recv_us", at}, {"decode_us", 0}, {"paint_us", 0}});
        const double ageMs = header->inputSeq == 0 ? -1.0 : 1e-3 * static_cast<double>(at - std::min(at, header->clientUs));
        watched.frames.push_back({at, ageMs, message.bytes.size(), *header});
        watched.lastShown = std::max(watched.lastShown, header->inputSeq);
    }
    return watched;
}

Watched watchStream(int port, const protocol::Json& document, const WatchOptions& options) {
    e2e::RawClient client(port);
    client.hello({{"max_inflight", 8}, {"client", {{"name", "caustream-bench"}, {"version", "1"}}}});
    if (const Json reply = client.update(document); reply.value("op", "") != "ok") {
        throw Error("the server refuses the document: " + reply.dump() + "; are server and bench of one build?");
    }
    client.json({{"op", "stream.start"}, {"id", 1'000'000}, {"stats", true}});
    return watch(client, options);
}

std::vector<double> agesMs(const std::vector<Arrival>& frames, std::uint64_t fromUs, std::uint64_t toUs) {
    std::vector<double> ages;
    for (const Arrival& frame : frames) {
        if (frame.atUs >= fromUs && frame.atUs < toUs && frame.ageMs >= 0) ages.push_back(frame.ageMs);
    }
    return ages;
}

}  // namespace caustream::bench
