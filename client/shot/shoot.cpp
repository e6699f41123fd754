#include "client/shot/shoot.h"

#include <cmath>
#include <numbers>

#include "client/connection/image_file.h"
#include "client/shot/configure.h"
#include "client/shot/exr_file.h"
#include "client/shot/progress_bar.h"
#include "client/shot/report.h"
#include "client/shot/session.h"

namespace caustream::shot {
namespace {

using connection::Frame;
using protocol::Json;
using namespace nlohmann::literals;

constexpr double kSwingDeg = 12.0;  // how far --moving takes the light to either side
constexpr int kSwingFrames = 40;    // for there and back

// The first light, swung about a vertical line through what it shines at.
Json movedLight(const Json& state, int frame) {
    Json patch = Json::object();
    if (!state.contains("lights") || state["lights"].empty()) return patch;
    const auto light = state["lights"].begin();
    const double phase = 2.0 * std::numbers::pi * frame / kSwingFrames;
    const double angle = kSwingDeg * std::sin(phase) * std::numbers::pi / 180.0;
    const auto turned = [&](const Json& v, double x0, double z0) {
        const double x = v[0].get<double>() - x0, z = v[2].get<double>() - z0;
        return Json{x0 + std::cos(angle) * x + std::sin(angle) * z, v[1],
                    z0 - std::sin(angle) * x + std::cos(angle) * z};
    };
    if (light->contains("position")) {
        const Json& target = state["camera"]["target"];
        patch["lights"][light.key()]["position"] = turned((*light)["position"], target[0], target[2]);
    }
    if (light->contains("direction")) patch["lights"][light.key()]["direction"] = turned((*light)["direction"], 0, 0);
    return patch;
}

std::string fileOf(const Options& options, int frame) {
    std::string name = options.out;
    if (const auto hash = name.find('#'); hash != name.npos) {
        const std::string number = std::to_string(frame);
        name.replace(hash, 1, std::string(number.size() < 4 ? 4 - number.size() : 0, '0') + number);
    }
    return name;
}

connection::Written write(const std::string& file, const Options& options, const Frame& frame, const Json& document) {
    if (options.kind == FileKind::Exr) {
        // What the document asks for, as three wavelengths are told from colours by nothing else.
        const bool bands = document.value("/stream/bands"_json_pointer, "rgb") == "wavelengths";
        return writeExr(file, frame.image, exrChannels(frame.info->unit, frame.image.bands, bands ? frame.info->wavelengthsNm : std::vector<double>{}));
    }
    if (options.kind == FileKind::Npy) return connection::writeNpy(file, frame.image);
    if (options.kind == FileKind::Png) return connection::writePng(file, connection::toPicture(frame.image));
    if (frame.header.encoding == protocol::Encoding::Jpeg) return connection::writeBytes(file, frame.encoded);
    return connection::writeJpeg(file, connection::toPicture(frame.image), kShotJpegQuality);
}

}  // namespace

tl::expected<std::string, std::string> shoot(const Options& options) {
    connection::Options to = connectionTo(options);
    to.keepEncoded = options.kind == FileKind::Jpeg;
    Session session(std::move(to), std::chrono::seconds(options.timeoutS));
    if (auto connected = session.connect(); !connected) return tl::make_unexpected(connected.error());
    if (auto configured = configure(session, options); !configured) return tl::make_unexpected(configured.error());
    if (options.moving) session.connection().startStream(true);

    if (options.converge) {
        ProgressBar bar;
        if (auto converged = session.converge([&](const auto& reached) { bar.show(reached); }); !converged)
            return tl::make_unexpected(converged.error());
    }

    Report report(options, session);
    std::string file;
    for (int i = 0; i < options.frames; ++i) {
        const std::uint64_t asked = connection::nowUs();
        if (options.moving && i > 0) {
            const auto moved = session.connection().input(movedLight(session.state(), i));
            if (!moved) return tl::make_unexpected(moved.error().field + ": " + moved.error().message);
        }
        auto frame = options.moving ? session.nextStreamed() : session.requestStill(options.converge);
        if (!frame) return tl::make_unexpected(frame.error());
        session.connection().acknowledge(*frame, 0);
        report.add(*frame, connection::nowUs() - asked);

        file = fileOf(options, i);
        const bool last = i + 1 == options.frames;
        if (!last && file == options.out) continue;
        if (auto written = write(file, options, *frame, session.connection().document()); !written) return tl::make_unexpected(written.error());
        if (last) {
            const std::string text = report.json(file, *frame, session).dump(2) + "\n";
            const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
            if (auto written = connection::writeBytes(file + ".json", bytes); !written)
                return tl::make_unexpected(written.error());
            return report.line(file, *frame, session);
        }
    }
    return file;
}

}  // namespace caustream::shot
