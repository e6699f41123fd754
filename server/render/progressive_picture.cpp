#include "render/progressive_picture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace caustream::render {

namespace {

constexpr std::size_t kMostPictures = 2;   // views at rest of one viewer: 6 MB each at 512^2
constexpr double kMostChange = 0.015;      // of the mean luminance, a frame
constexpr double kMostShare = 0.2;         // of a picture that is as bright: a dissolve of five frames

class Bytes {
   public:
    template <class T>
    Bytes& add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        text.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    std::string text;
};

// But for the size.
bool sameView(const std::string& a, const std::string& b) {
    constexpr std::size_t kSize = 2 * sizeof(int);
    return a.size() == b.size() && a.compare(0, a.size() - kSize, b, 0, b.size() - kSize) == 0;
}

}  // namespace

std::string pictureKey(const Request& request) {
    const scene::Scene& scene = *request.scene;
    Bytes key;
    key.add(scene.geometry.get());   // first: two pictures of one scene begin alike
    key.add(scene.environmentColor).add(scene.outsideIndex);
    const scene::Camera& camera = request.camera;
    key.add(camera.eye).add(camera.target).add(camera.up).add(camera.fovYDeg);
    key.add(request.transport.bounces);
    for (const scene::Light& light : scene.lights) {
        key.add(light.type).add(light.position).add(light.direction).add(light.innerConeDeg).add(light.outerConeDeg);
        key.add(light.intensity).add(light.color).add(light.cookie).add(light.spectrum.index());
        for (double nm = optics::kBandMinNm; nm <= optics::kBandMaxNm; nm += 10.0) key.add(optics::relativePower(light.spectrum, nm));
        if (const auto* lines = std::get_if<optics::Lines>(&light.spectrum)) {
            for (const double nm : lines->nm) key.add(nm);
        }
    }
    for (const scene::Material& material : scene.materials) {
        key.add(material.caster).add(material.thinWalled).add(material.mirror).add(material.priority);
        key.add(material.baseColor).add(material.emissive).add(material.roughness).add(material.metallic);
        if (!material.caster) continue;
        for (double nm = optics::kBandMinNm; nm <= optics::kBandMaxNm; nm += 50.0) {
            key.add(optics::refractiveIndex(material.dispersion, nm)).add(material.absorption.at(nm));
        }
    }
    key.add(request.width).add(request.height);   // last: a moving picture may be smaller than the one at rest
    return key.text;
}

void ProgressivePicture::move(const std::string& key, const gl::Texture& color) {
    const auto sameScene = [](const std::string& a, const std::string& b) { return a.compare(0, sizeof(void*), b, 0, sizeof(void*)) == 0; };
    if (!atRest_) {
        if (sameScene(key, movingKey_)) ease();
        else gain_ = 1.0;
    } else {
        const Picture& rest = pictures_.front();
        if (!sameScene(key, rest.key)) gain_ = 1.0;
        else if (rest.fades) gain_ = gainAfter(rest);
    }
    atRest_ = false;
    moving_ = &color;
    movingKey_ = key;
}

ProgressivePicture::Sample ProgressivePicture::begin(const std::string& key, double weight, int wanted, gl::Texture& color) {
    const auto known = std::find_if(pictures_.begin(), pictures_.end(), [&](const Picture& p) { return p.key == key; });
    if (known != pictures_.end()) {
        pictures_.splice(pictures_.begin(), pictures_, known);
    } else {
        if (pictures_.size() == kMostPictures) pictures_.pop_back();
        pictures_.emplace_front().key = key;
    }
    Picture& picture = pictures_.front();
    if (moving_ == &color && sameView(movingKey_, key)) {
        picture.fades = true;
        picture.share = 0.0;
        picture.luminance = 0.0;
        std::swap(picture.before, color);
    }
    if (weight < picture.newest) picture.samples = 0, picture.weight = 0.0;
    picture.newest = weight;
    picture.wanted = wanted;
    moving_ = nullptr;
    atRest_ = true;

    // Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences: R2 for the place, the golden ratio for the
    // wavelengths. The first sample is where the moving picture's are.
    const double n = pictures_.front().samples;
    const auto around = [](double x) { return static_cast<float>(x - std::floor(x)); };
    return {{around(0.5 + 0.7548776662466927 * n) - 0.5f, around(0.5 + 0.5698402909980532 * n) - 0.5f}, around(0.6180339887498949 * n)};
}

void ProgressivePicture::add(const gl::Texture& color, float scale) {
    Picture& picture = pictures_.front();
    picture.weight += picture.newest;
    ++picture.samples;
    mean_.run(color, picture.samples == 1 ? 1.0f : static_cast<float>(picture.newest / picture.weight), picture.mean);
    fade(picture, scale);
    ease();
}

// As far towards the mean as the brightness may change in a frame.
void ProgressivePicture::fade(Picture& picture, float scale) {
    const float measuredAt = std::exchange(picture.scale, scale);
    if (picture.share >= 1.0) return;
    const double from = luminance_.of(picture.before, scale), to = luminance_.of(picture.mean, scale);
    const bool known = picture.luminance > 0.0 && measuredAt == scale;
    const double last = known ? picture.luminance : std::lerp(from, to, picture.share);
    const double room = (gain_ == 1.0 ? kMostChange : 0.5 * kMostChange) * last, towards = to > from ? room : -room;
    const double reached = std::abs(to - from) > 1e-12 ? (last + towards - from) / (to - from) : 1.0;
    picture.share = std::clamp(reached, picture.share, std::min(1.0, picture.share + kMostShare));
    picture.luminance = std::lerp(from, to, picture.share);
}

// What the moving picture's exposure has to be multiplied by to be as bright as what was shown at rest.
double ProgressivePicture::gainAfter(const Picture& picture) {
    const auto scale = static_cast<float>(picture.scale * gain_);
    const double wanted = std::lerp(luminance_.of(picture.before, scale), luminance_.of(picture.mean, scale), picture.share);
    if (wanted <= 0.0) return 1.0;
    // A secant in logarithms: a tone curve answers by less than the exposure changes.
    double gain = 1.0, slope = 1.0, lastGain = 0.0, lastOff = 0.0;
    for (int i = 0; i < 6; ++i) {
        const double now = luminance_.of(picture.before, static_cast<float>(picture.scale * gain));
        if (now <= 0.0) return 1.0;
        const double off = std::log(wanted / now);
        if (std::abs(off) < 1e-3) break;
        if (i > 0 && std::abs(lastOff - off) > 1e-6) slope = std::clamp((lastOff - off) / std::log(gain / lastGain), 0.1, 2.0);
        lastGain = gain, lastOff = off;
        gain = std::clamp(gain * std::exp(off / slope), 0.25, 4.0);
        if (gain == lastGain) break;
    }
    return gain;
}

void ProgressivePicture::ease() {
    const bool shared = atRest_ && pictures_.front().share < 1.0;
    const double step = 1.0 + (shared ? 0.5 : 1.0) * kMostChange;
    gain_ = std::clamp(1.0, gain_ / step, gain_ * step);
}

ProgressivePicture::Shown ProgressivePicture::shown(bool exact) const {
    const float gain = exact ? 1.0f : static_cast<float>(gain_);
    if (!atRest_) return {moving_, nullptr, 1.0f, gain};
    const Picture& picture = pictures_.front();
    const bool mixed = picture.share < 1.0 && !exact;
    return {&picture.mean, mixed ? &picture.before : nullptr, mixed ? static_cast<float>(picture.share) : 1.0f, gain};
}

int ProgressivePicture::samples() const { return atRest_ ? pictures_.front().samples : 0; }

const gl::Texture* ProgressivePicture::mean() const { return samples() > 0 ? &pictures_.front().mean : nullptr; }

double ProgressivePicture::progress() const {
    if (!atRest_) return 0.0;
    const Picture& picture = pictures_.front();
    const double drawn = std::min(1.0, static_cast<double>(picture.samples) / picture.wanted);
    return gain_ == 1.0 ? std::min(drawn, picture.share) : std::min(drawn, 0.99);
}

}  // namespace caustream::render
