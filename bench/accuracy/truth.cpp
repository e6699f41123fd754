#include "bench/accuracy/truth.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "bench/accuracy/colour_difference.h"

namespace caustream::bench {

namespace {

constexpr int kContinuousSamples = 4;   // wavelengths of a photon: more places tell more than more colours of one place

// Whose view and camera the reference's picture has.
Configuration canonical() {
    Configuration configuration;
    configuration.transport.wavelengths = render::kContinuous;
    configuration.transport.photonGrid = 256;
    configuration.transport.mapSize = 512;
    return configuration;
}

void addWindow(tracer::Settings& settings, const Window& window) {
    if (window.ofPlane()) {
        settings.windows = {{window.origin(), window.edgeU(), window.edgeV(), window.cells(), window.cells(), 1e-4}};
    } else {
        settings.maps = {{window.worldToClip(), window.cells()}};
    }
}

// [channel][texel] XYZ -> [texel][channel] concentration.
std::vector<float> mapOf(tracer::Image image, const optics::Spectrum& light) {
    xyzToRgb(image.values, light);
    const std::size_t area = image.values.size() / 3;
    std::vector<float> map(image.values.size());
    for (std::size_t i = 0; i < map.size(); ++i) map[i] = image.values[i % 3 * area + i / 3];
    return map;
}

}  // namespace

double Truth::bandsNoise() const {
    return std::accumulate(bands.relativeL1.begin(), bands.relativeL1.end(), 0.0) / static_cast<double>(bands.relativeL1.size());
}

tracer::Image weighed(tracer::Image image, const Window& window) {
    if (window.ofPlane()) return image;
    const std::size_t area = window.weights().size();
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] *= static_cast<float>(window.weights()[i % area]);
    return image;
}

tracer::Result traceSpectrum(const Subject& subject, const Window& window, std::uint64_t photons, const std::string& cacheFolder,
                             const std::function<void(double)>& progress) {
    tracer::Settings spectrum;
    spectrum.continuousSamples = kContinuousSamples;
    spectrum.photons = photons;
    addWindow(spectrum, window);
    return tracer::traceCached(cacheFolder, subject.world, spectrum, progress);
}

Truth makeTruth(Renderer& renderer, const Subject& subject, const TruthSettings& settings, const std::function<void(double)>& progress) {
    const Configuration own = canonical();
    render::Pipeline& pipeline = renderer.pipeline(own, subject.fingerprint);
    const render::Frame map = pipeline.run(mapRequest(subject.scene, own));
    const glm::dmat4 view(map.lightMatrix);
    Truth truth{.window = subject.plane ? *subject.plane : Window::ofView(subject.light(), view, settings.cells)};

    tracer::Settings spectrum;
    spectrum.continuousSamples = kContinuousSamples;
    spectrum.photons = settings.photons;
    addWindow(spectrum, truth.window);
    spectrum.maps.push_back({view, own.transport.mapSize});
    const double share = subject.storedBands ? 1.0 : 0.6;   // of the time
    tracer::Result traced = tracer::traceCached(settings.cacheFolder, subject.world, spectrum, [&](double done) { progress(share * done); });
    truth.xyz = weighed((truth.window.ofPlane() ? traced.windows : traced.maps).front().xyz, truth.window);
    truth.seconds = traced.seconds, truth.cached = traced.cached;

    if (subject.storedBands) {
        truth.bands = *subject.storedBands;
    } else {
        tracer::Settings bands;
        bands.wavelengthsNm = bandsNm();
        bands.photons = settings.photons / 4;
        addWindow(bands, truth.window);
        tracer::Result result = tracer::traceCached(settings.cacheFolder, subject.world, bands, [&](double done) { progress(share + (1.0 - share) * done); });
        truth.bands = weighed(std::move((truth.window.ofPlane() ? result.windows : result.maps).front().bands), truth.window);
        truth.seconds += result.seconds, truth.cached = truth.cached && result.cached;
    }

    render::Request picture = pictureRequest(subject.scene, own, settings.pictureSize);
    truth.exposureEv = pipeline.run(picture).stats.exposureEv;
    picture.exposureEv = static_cast<float>(truth.exposureEv);
    picture.spectralMap = std::make_shared<const std::vector<float>>(mapOf(std::move(traced.maps.back().xyz), subject.light().spectrum));
    truth.picture = pipeline.run(picture).pixels;
    return truth;
}

MapError measureError(Renderer& renderer, const Subject& subject, const Truth& truth, const Configuration& configuration,
                      const TruthSettings& settings) {
    render::Pipeline& pipeline = renderer.pipeline(configuration, subject.fingerprint);
    const std::size_t area = truth.window.weights().size();
    const int cells = truth.window.cells();
    MapError error;

    // The whole spectrum as this configuration has it
    const render::Frame map = pipeline.run(mapRequest(subject.scene, configuration));
    error.photons = map.stats.photons;
    if (map.stats.error) error.estimate = map.stats.error->total;
    std::vector<float> xyz = mapOnWindow(pipeline, mapRequest(subject.scene, configuration), map, truth.window);
    rgbToXyz(xyz, subject.light().spectrum);
    const tracer::Difference Y = tracer::difference(&xyz[area], &truth.xyz.values[area], cells, cells);
    error.luminance = Y.relativeL1, error.fluxRatio = Y.fluxRatio, error.worst = Y.worst;
    double apart = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < xyz.size(); ++i) apart += std::abs(xyz[i] - truth.xyz.values[i]), sum += truth.xyz.values[i];
    error.colour = apart / sum;

    // Its transport, wavelength by wavelength
    render::Request bandsRequest = mapRequest(subject.scene, configuration);
    bandsRequest.transport.wavelengthsNm = bandsNm();
    bandsRequest.wavelengthBands = true;
    const std::vector<float> bands = mapOnWindow(pipeline, bandsRequest, truth.window);
    for (std::size_t band = 0; band < bandsNm().size(); ++band) {
        const tracer::Difference d = tracer::difference(&bands[band * area], &truth.bands.values[band * area], cells, cells);
        error.bands += d.relativeL1 / static_cast<double>(bandsNm().size());
        error.bandFluxRatio.push_back(d.fluxRatio);
        error.bandCentroid.push_back(d.centroidCells / cells);
    }

    render::Request picture = pictureRequest(subject.scene, configuration, settings.pictureSize);
    picture.exposureEv = static_cast<float>(truth.exposureEv);
    const PictureDifference difference = pictureDifference(pipeline.run(picture).pixels, truth.picture);
    error.picture = difference.mean, error.pictureP99 = difference.p99;
    return error;
}

void to_json(nlohmann::json& json, const MapError& e) {
    json = {{"luminance", e.luminance}, {"colour", e.colour}, {"flux_ratio", e.fluxRatio}, {"worst", e.worst}, {"bands", e.bands},
            {"band_flux_ratio", e.bandFluxRatio}, {"band_centroid", e.bandCentroid}, {"ciede2000", e.picture},
            {"ciede2000_p99", e.pictureP99}, {"photons", e.photons}, {"estimate", e.estimate}};
}

void from_json(const nlohmann::json& json, MapError& e) {
    json.at("luminance").get_to(e.luminance), json.at("colour").get_to(e.colour), json.at("flux_ratio").get_to(e.fluxRatio);
    json.at("worst").get_to(e.worst), json.at("bands").get_to(e.bands), json.at("band_flux_ratio").get_to(e.bandFluxRatio);
    json.at("band_centroid").get_to(e.bandCentroid), json.at("ciede2000").get_to(e.picture);
    json.at("ciede2000_p99").get_to(e.pictureP99), json.at("photons").get_to(e.photons), json.at("estimate").get_to(e.estimate);
}

}  // namespace caustream::bench
