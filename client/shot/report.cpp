#include "client/shot/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "client/connection/convergence_text.h"

namespace caustream::shot {
namespace {

using connection::Frame;
using protocol::Json;

Json spread(std::vector<double> values) {
    if (values.empty()) return nullptr;
    std::ranges::sort(values);
    return {{"min", values.front()}, {"median", values[values.size() / 2]}, {"max", values.back()}};
}

const char* nameOf(protocol::Encoding encoding) {
    switch (encoding) {
        case protocol::Encoding::Jpeg:
            return "jpeg";
        case protocol::Encoding::Raw:
            return "raw";
        case protocol::Encoding::Zstd:
            return "zstd";
        case protocol::Encoding::Png:
            return "png";
    }
    return "";
}

Json headerJson(const protocol::FrameHeader& header) {
    return {{"frame_seq", header.frameSeq},
            {"epoch", header.epoch},
            {"flags", header.flags},
            {"encoding", nameOf(header.encoding)},
            {"width", header.width},
            {"height", header.height},
            {"view_width", header.viewWidth},
            {"view_height", header.viewHeight},
            {"bands", header.bands},
            {"sample_bytes", protocol::sampleBytes(header.sample)},
            {"jpeg_quality", header.jpegQuality},
            {"level", header.level},
            {"input_seq", header.inputSeq},
            {"state_rev", header.stateRev},
            {"hold_us", header.holdUs},
            {"render_us", header.renderUs},
            {"encode_us", header.encodeUs},
            {"payload_len", header.payloadLen},
            {"raw_len", header.rawLen},
            {"scale", header.scale}};
}

// Of the samples as floats: u8 as 0..1.
Json valuesJson(const connection::Image& image) {
    const std::vector<float> values = connection::toFloats(image);
    double sum = 0.0, min = INFINITY, max = -INFINITY;
    std::size_t finite = 0;
    for (const float value : values) {
        if (!std::isfinite(value)) continue;
        ++finite;
        sum += value;
        min = std::min<double>(min, value);
        max = std::max<double>(max, value);
    }
    Json json = {{"count", values.size()}, {"not_finite", values.size() - finite}};
    if (finite > 0) json.update({{"min", min}, {"max", max}, {"mean", sum / static_cast<double>(finite)}});
    return json;
}

Json statsJson(const protocol::Stats& stats) {
    return Json::parse(protocol::encode(stats), nullptr, false);
}

}  // namespace

Report::Report(const Options& options, const Session& session) : options_(options) {
    const auto& welcome = session.welcome();
    server_ = {{"url", options.address.text()}, {"build", welcome.build}, {"gpu", welcome.gpu}};
}

void Report::add(const Frame& frame, std::uint64_t tookUs) {
    const auto& header = frame.header;
    tookMs_.push_back(static_cast<double>(tookUs) / 1000.0);
    renderMs_.push_back(header.renderUs / 1000.0);
    encodeMs_.push_back(header.encodeUs / 1000.0);
    decodeMs_.push_back(frame.decodeUs / 1000.0);
    // Encoding, both sockets, decoding: all that is not drawing. Of a frame that answers an input, from that input on.
    const std::uint64_t end = frame.receivedUs + frame.decodeUs;
    const double whole = header.clientUs > 0 && header.clientUs < end
                             ? static_cast<double>(end - header.clientUs) / 1000.0
                             : tookMs_.back();
    overheadMs_.push_back(whole - header.renderUs / 1000.0);
    payloadBytes_ += header.payloadLen;
    hashes_.push_back(frame.mapHash);
}

Json Report::json(const std::string& file, const Frame& last, const Session& session) const {
    Json state = session.state();
    state.merge_patch(session.connection().document());
    Json json = {{"file", file},
                 {"server", server_},
                 {"stream_info", Json::parse(protocol::encode(*last.info), nullptr, false)},
                 {"header", headerJson(last.header)},
                 {"map_hash", last.mapHash},
                 {"state", state},
                 {"values", valuesJson(last.image)}};
    json["statistics"] = {{"frames", tookMs_.size()},
                          {"took_ms", spread(tookMs_)},
                          {"render_ms", spread(renderMs_)},
                          {"encode_ms", spread(encodeMs_)},
                          {"decode_ms", spread(decodeMs_)},
                          {"beyond_render_ms", spread(overheadMs_)},
                          {"round_trip_ms", spread(session.roundTripsMs())},
                          {"payload_bytes_mean", payloadBytes_ / static_cast<double>(tookMs_.size())}};
    if (hashes_.size() > 1 && !options_.moving) json["map_hashes"] = hashes_;
    if (session.stats()) json["server_stats"] = statsJson(*session.stats());
    if (!session.warnings().empty()) json["warnings"] = session.warnings();
    return json;
}

std::string Report::line(const std::string& file, const Frame& last, const Session& session) const {
    char text[256];
    std::snprintf(text, sizeof text, ": %dx%d, %d bands, rendered in %.1f ms", last.image.width, last.image.height,
                  last.image.bands, last.header.renderUs / 1000.0);
    std::string line = file + text;
    const auto& stats = session.stats();
    if (stats && stats->convergence && stats->convergence->photons > 0) {
        line += ", " + connection::convergenceText(*stats->convergence);
        const bool there = last.header.flags & protocol::kFrameConverged;
        line += there ? ", converged" : options_.converge ? "" : "; --converge waits for the rest";
    } else if (stats && stats->error) {
        std::snprintf(text, sizeof text, ", map error about %.1f%%", 100.0 * stats->error->total);
        line += text;
        if (stats->convergence) line += "; --converge traces it exactly";
    }
    if (stats && !stats->choice.empty()) line += "; " + stats->choice;
    return line;
}

}  // namespace caustream::shot
