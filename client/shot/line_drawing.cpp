#include "client/shot/line_drawing.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

namespace caustream::shot {
namespace {

using protocol::Json;
using protocol::Sample;
using Progress = std::function<void(const protocol::Convergence&)>;

constexpr int kBusyTries = 60;  // of a server that sends us away for a second or two each time

bool isLabel(const std::string& target) { return target == "depth" || target == "normals" || target == "caster_mask"; }

// The masks' PNG holds their numbers, not the colours that the server shows them in.
bool wantsBytes(const std::string& target, const std::vector<Format>& formats) {
    return target != "caster_mask" && std::ranges::find(formats, Format::Png) != formats.end() && holds(Format::Png, target);
}

bool wantsFloats(const std::string& target, const std::vector<Format>& formats) {
    return std::ranges::any_of(formats, [&](Format f) { return holds(f, target) && (f != Format::Png || target == "caster_mask"); });
}

// Uploads a file's scene if the server lacks it. The document with the asset in the file's place.
tl::expected<Json, Failure> withAsset(Session& session, Json document) {
    if (!document["scene"].is_array() || document["scene"][0] != "file") return document;
    const std::string path = document["scene"][1];
    std::ifstream in(path, std::ios::binary);
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.empty()) return tl::make_unexpected("cannot read " + path);
    const Json asset = {"asset", connection::sha256Hex(bytes)};
    if (session.state().value("scene", Json{}) != asset) {
        if (auto shown = session.showFile(std::move(bytes)); !shown) return tl::make_unexpected(shown.error());
    }
    document["scene"] = asset;
    return document;
}

Session::Done showDocument(Session& session, const LineJob& job, const Json& stream) {
    auto document = withAsset(session, job.document);
    if (!document) return tl::make_unexpected(document.error());
    (*document)["stream"].update(stream);
    Json patch = patchBetween(session.connection().document(), *document);
    patch["scene"] = (*document)["scene"];  // named each time: then the server says what its document resolves to
    return session.show(patch);
}

// The stills of one target until nothing is left to gain.
tl::expected<Shown, Failure> untilConverged(Session& session, const Progress& progress) {
    for (;;) {
        auto shown = requestShown(session, true);
        if (!shown) return shown;
        const bool there = (shown->frame.header.flags & protocol::kFrameConverged) != 0;
        if (there || !shown->stats || !shown->stats->convergence) return shown;
        progress(*shown->stats->convergence);
    }
}

}  // namespace

Json streamOf(const std::string& target, Sample sample) {
    return {{"target", target == "bands" ? "spectral" : target},
            {"encoding", "raw"},
            {"sample", sample == Sample::U8 ? "u8" : "f32"},
            {"bands", target == "bands" ? "wavelengths" : "rgb"}};
}

tl::expected<Shown, Failure> requestShown(Session& session, bool converge, bool still) {
    for (int tries = 1;; ++tries) {
        auto frame = session.request(still, converge);
        if (frame) {
            session.connection().acknowledge(*frame, 0);
            return Shown{std::move(*frame), session.stats()};
        }
        const auto retryMs = session.retryMs();
        if (!retryMs || tries == kBusyTries || !session.recover()) return tl::make_unexpected(frame.error());
        std::this_thread::sleep_for(std::chrono::milliseconds(*retryMs));
    }
}

tl::expected<std::vector<Drawn>, Failure> drawLine(Session& session, const LineJob& job, const std::vector<Format>& formats,
                                                   const Progress& progress) {
    // The map first, alone, so that its photons do not depend on what else is drawn of it.
    const auto isLit = [](const std::string& target) { return !isLabel(target) && target != "bands"; };
    const bool converge = job.converge && std::ranges::any_of(job.targets, isLit);
    const std::string first = converge ? "spectral" : job.targets.front();
    if (auto shown = showDocument(session, job, streamOf(first, wantsFloats(first, formats) || converge ? Sample::F32 : Sample::U8)); !shown)
        return tl::make_unexpected(shown.error());
    std::optional<Shown> map;
    if (converge) {
        auto converged = untilConverged(session, progress);
        if (!converged) return tl::make_unexpected(converged.error());
        map = std::move(*converged);
    }

    std::vector<Drawn> all;
    for (const std::string& target : job.targets) {
        Drawn drawn{.target = target};
        if (target == "spectral" && map) {
            drawn.floats = map;
            all.push_back(std::move(drawn));
            continue;
        }
        const bool adds = converge && target == "composite";
        const auto fetch = [&](Sample sample, bool untilDone) -> tl::expected<Shown, Failure> {
            if (auto updated = session.update({{"stream", streamOf(target, sample)}}); !updated) return tl::make_unexpected(updated.error());
            return untilDone ? untilConverged(session, progress) : requestShown(session, adds);
        };
        if (adds || wantsBytes(target, formats)) {
            auto shown = fetch(Sample::U8, adds);
            if (!shown) return tl::make_unexpected(shown.error());
            if (wantsBytes(target, formats)) drawn.bytes = std::move(*shown);
        }
        if (wantsFloats(target, formats)) {
            auto shown = fetch(Sample::F32, false);
            if (!shown) return tl::make_unexpected(shown.error());
            drawn.floats = std::move(*shown);
        }
        all.push_back(std::move(drawn));
    }
    return all;
}

}  // namespace caustream::shot
