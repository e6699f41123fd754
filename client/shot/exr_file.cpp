#include "client/shot/exr_file.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>

namespace caustream::shot {
namespace {

// A comma for the decimal point: a point would begin a layer.
std::string bandName(double nm) {
    char text[32];
    std::snprintf(text, sizeof text, "T.%.2fnm", nm);
    std::string name = text;
    std::replace(name.begin() + 2, name.end(), '.', ',');
    return name;
}

}  // namespace

std::vector<std::string> exrChannels(const std::string& unit, int bands, const std::vector<double>& wavelengthsNm) {
    if (unit == "m" && bands == 1) return {"Z"};
    if (unit == "normal" && bands == 3) return {"N.X", "N.Y", "N.Z"};
    if (unit == "caster" && bands == 1) return {"id"};
    // Three wavelengths of a map in bands are told from its colours by who asks: it passes none for colours.
    if (unit == "concentration" && wavelengthsNm.size() == static_cast<std::size_t>(bands)) {
        std::vector<std::string> names;
        for (const double nm : wavelengthsNm) names.push_back(bandName(nm));
        return names;
    }
    if (bands == 3) return {"R", "G", "B"};
    std::vector<std::string> names;
    for (int band = 0; band < bands; ++band) names.push_back("band." + std::to_string(band));
    return names;
}

connection::Written writeExr(const std::filesystem::path& file, const connection::Image& image, const std::vector<std::string>& channels) {
    const std::vector<float> values = connection::toFloats(image);
    std::vector<std::uint32_t> ids;
    try {
        Imf::Header header(image.width, image.height);
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer pixels;
        const auto add = [&](const std::string& name, Imf::PixelType type, const void* first, std::size_t step) {
            header.channels().insert(name, Imf::Channel(type));
            // The library takes what it writes from a pointer to what might be read into.
            pixels.insert(name, Imf::Slice(type, const_cast<char*>(static_cast<const char*>(first)), step, step * static_cast<std::size_t>(image.width)));
        };
        if (channels.front() == "id") {
            for (const float value : values) ids.push_back(static_cast<std::uint32_t>(std::lround(value)));
            add("id", Imf::UINT, ids.data(), sizeof ids[0]);
        } else {
            for (std::size_t band = 0; band < channels.size(); ++band) add(channels[band], Imf::FLOAT, &values[band], channels.size() * sizeof(float));
        }
        if (channels.front() == "R") Imf::addChromaticities(header, Imf::Chromaticities());   // BT.709, said aloud
        if (channels.front().starts_with("T.")) header.insert("spectralLayoutVersion", Imf::StringAttribute("1.0"));
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(pixels);
        out.writePixels(image.height);
    } catch (const std::exception& problem) {
        return tl::make_unexpected("cannot write " + file.string() + ": " + problem.what());
    }
    return {};
}

}  // namespace caustream::shot
