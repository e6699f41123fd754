#include "client/shot/line_files.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "client/shot/camera_matrix.h"
#include "client/shot/exr_file.h"

namespace caustream::shot {
namespace {

namespace fs = std::filesystem;
using connection::Written;
using protocol::Json;

constexpr const char* kUnfinished = ".part";

fs::path unfinished(const fs::path& file) {
    std::string name(1, '.');
    name += file.filename().string();
    return file.parent_path() / (name += kUnfinished);
}

Written finish(const fs::path& file) {
    std::error_code failed;
    fs::rename(unfinished(file), file, failed);
    if (failed) return tl::make_unexpected("cannot write " + file.string() + ": " + failed.message());
    return {};
}

// Grey levels that are the numbers of casters.
tl::expected<connection::Image, std::string> greyOf(const connection::Image& mask) {
    connection::Image grey{mask.width, mask.height, 1, protocol::Sample::U8, 1.0f, {}};
    for (const float value : connection::toFloats(mask)) {
        if (value > 255.0f) return tl::make_unexpected("caster_mask: a PNG counts to 255 casters, and here are more; use --format npy or exr");
        grey.data.push_back(static_cast<std::uint8_t>(std::lround(value)));
    }
    return grey;
}

Written writePicture(const fs::path& file, Format format, const Drawn& drawn) {
    const Shown& shown = format == Format::Png && drawn.bytes ? *drawn.bytes : drawn.any();
    const connection::Image& image = shown.frame.image;
    if (format == Format::Npy) return connection::writeNpy(file, image);
    if (format == Format::Exr) {
        const bool bands = drawn.target == "bands";
        const auto& info = *shown.frame.info;
        return writeExr(file, image, exrChannels(info.unit, image.bands, bands ? info.wavelengthsNm : std::vector<double>{}));
    }
    if (drawn.target != "caster_mask") return connection::writePng(file, image);
    const auto grey = greyOf(image);
    return grey ? connection::writePng(file, *grey) : tl::make_unexpected(grey.error());
}

// Column by column -> row by row.
Json rowsOf(const std::array<double, 16>& matrix) {
    Json rows = Json::array();
    for (std::size_t row = 0; row < 4; ++row) rows.push_back({matrix[row], matrix[row + 4], matrix[row + 8], matrix[row + 12]});
    return rows;
}

Json targetJson(const Drawn& drawn) {
    const Shown& shown = drawn.any();
    const auto& info = *shown.frame.info;
    Json json = {{"width", shown.frame.image.width},
                 {"height", shown.frame.image.height},
                 {"bands", shown.frame.image.bands},
                 {"unit", info.unit},
                 {"map_hash", shown.frame.mapHash}};
    if (!info.wavelengthsNm.empty()) json["wavelengths_nm"] = info.wavelengthsNm;
    if (info.target == protocol::Target::Spectral) json["light_matrix"] = rowsOf(info.lightMatrix);
    if (!shown.stats || shown.stats->photons == 0) return json;
    const Json stats = Json::parse(protocol::encode(*shown.stats), nullptr, false);
    for (const char* key : {"photons", "exposure_ev", "error", "ledger", "convergence", "choice"})
        if (stats.contains(key)) json[key] = stats[key];
    return json;
}

}  // namespace

Written writeWhole(const fs::path& file, std::span<const std::uint8_t> bytes) {
    if (auto written = connection::writeBytes(unfinished(file), bytes); !written) return written;
    return finish(file);
}

Written writeWhole(const fs::path& file, const std::string& text) {
    return writeWhole(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void removeUnfinished(const fs::path& folder) {
    std::error_code ignored;
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename();
        if (name.starts_with(".") && name.ends_with(kUnfinished)) left.push_back(entry.path());
    }
    for (const auto& file : left) fs::remove(file, ignored);
}

Json completeLine(const fs::path& folder, const LineJob& job) {
    std::ifstream in(folder / (job.name + ".json"));
    const Json json = Json::parse(std::string{std::istreambuf_iterator<char>(in), {}}, nullptr, false);
    if (!json.is_object() || json.value("key", Json{}) != job.key || !json.contains("files") || !json["files"].is_object()) return nullptr;
    for (const auto& [name, bytes] : json["files"].items()) {
        std::error_code failed;
        const auto size = fs::file_size(folder / name, failed);
        if (failed || bytes != size) return nullptr;
    }
    return json;
}

Json aboutLine(const Session& session) {
    Json json = {{"state", session.state()},
                 {"camera", cameraMatrix(session.state())},
                 {"casters", session.scene().casters},
                 {"warnings", session.warnings()},
                 {"server", {{"build", session.welcome().build}, {"gpu", session.welcome().gpu}}}};
    // Of the frame asked for last; each target says its own.
    for (const char* key : {"target", "encoding", "sample", "bands", "quality", "max_fps"}) json["state"]["stream"].erase(key);
    return json;
}

tl::expected<Json, std::string> writeLine(const fs::path& folder, const LineJob& job, const std::vector<Drawn>& drawn,
                                          const std::vector<Format>& formats, const Json& about) {
    Json json = about;
    json.update({{"name", job.name}, {"line", job.number}, {"key", job.key}, {"patch", job.patch}, {"files", Json::object()}});
    double renderMs = 0.0;
    std::set<std::string> warnings = about["warnings"];
    for (const Drawn& one : drawn) {
        Json target = targetJson(one);
        for (const Format format : formats) {
            if (!holds(format, one.target)) continue;
            const fs::path file = folder / (job.name + "." + one.target + "." + nameOf(format));
            if (auto written = writePicture(unfinished(file), format, one); !written) return tl::make_unexpected(written.error());
            if (auto written = finish(file); !written) return tl::make_unexpected(written.error());
            target["files"][nameOf(format)] = file.filename().string();
            json["files"][file.filename().string()] = fs::file_size(file);
        }
        for (const auto* shown : {&one.bytes, &one.floats}) {
            if (!*shown) continue;
            renderMs += (*shown)->frame.header.renderUs / 1000.0;
            if ((*shown)->stats) warnings.insert((*shown)->stats->warnings.begin(), (*shown)->stats->warnings.end());
        }
        json["targets"][one.target] = std::move(target);
    }
    json["warnings"] = warnings;
    json["timing"]["render_ms"] = renderMs;
    if (auto written = writeWhole(folder / (job.name + ".json"), json.dump(2) + "\n"); !written) return tl::make_unexpected(written.error());
    return json;
}

}  // namespace caustream::shot
