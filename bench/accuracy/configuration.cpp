#include "bench/accuracy/configuration.h"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace caustream::bench {

namespace {

struct ModeName {
    render::Mode mode;
    std::string name;
};
const ModeName kModeNames[] = {{render::Mode::Refined, "refined"}, {render::Mode::Thesis, "thesis"}, {render::Mode::Traced, "traced"}, {render::Mode::Auto, "auto"}};

std::string modeName(render::Mode mode) { return std::ranges::find(kModeNames, mode, &ModeName::mode)->name; }

std::string wavelengthsName(int wavelengths) {
    return wavelengths == render::kContinuous ? "continuous" : std::to_string(wavelengths);
}

bool parseInt(const std::string& text, int least, int most, int& value) {
    int parsed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc() || end != text.data() + text.size() || parsed < least || parsed > most) return false;
    value = parsed;
    return true;
}

bool parseSwitch(const std::string& text, bool& value) {
    if (text != "on" && text != "off") return false;
    value = text == "on";
    return true;
}

bool set(render::Transport& t, const std::string& key, const std::string& value) {
    if (key == "mode") {
        const auto known = std::ranges::find(kModeNames, value, &ModeName::name);
        if (known == std::end(kModeNames)) return false;
        t.mode = known->mode;
        return true;
    }
    if (key == "bounces") return parseInt(value, 0, 32, t.bounces);
    if (key == "wavelengths" && value == "continuous") {
        t.wavelengths = render::kContinuous;
        return true;
    }
    if (key == "wavelengths") return parseInt(value, 1, 64, t.wavelengths);
    if (key == "grid") return parseInt(value, 16, 4096, t.photonGrid);
    if (key == "map") return parseInt(value, 64, 2048, t.mapSize);
    if (key == "steps") return parseInt(value, 1, 16, t.backSteps);
    if (key == "levels") return parseInt(value, 1, 6, t.hierarchyLevels);
    if (key == "gap_fill") return parseSwitch(value, t.gapFill);
    if (key == "exact_receivers") return parseSwitch(value, t.exactReceivers);
    if (key == "filter") return parseSwitch(value, t.filter);
    return false;
}

Configuration make(render::Mode mode, int wavelengths, int grid, int map, bool gapFill = false) {
    Configuration c;
    c.transport.mode = mode;
    c.transport.wavelengths = wavelengths;
    c.transport.photonGrid = grid;
    c.transport.mapSize = map;
    c.transport.gapFill = gapFill;
    return c;
}

}  // namespace

std::string Configuration::name() const {
    const render::Transport& t = transport;
    const bool thesis = t.mode == render::Mode::Thesis, refined = t.mode == render::Mode::Refined;
    std::string name = modeName(t.mode) + " " + wavelengthsName(t.wavelengths) + " grid " + std::to_string(t.photonGrid) +
                       " map " + std::to_string(t.mapSize);
    if (thesis && t.hierarchyLevels != 3) name += " levels " + std::to_string(t.hierarchyLevels);
    if (!thesis && !refined && t.bounces != 8) name += " bounces " + std::to_string(t.bounces);
    if (t.exactReceivers) name += " exact receivers";
    if (refined && t.backSteps != 4) name += " steps " + std::to_string(t.backSteps);
    if (t.gapFill) name += " gap fill";
    if (!t.filter) name += " no filter";
    return name;
}

std::string Configuration::label() const {
    const render::Transport& t = transport;
    std::string label = wavelengthsName(t.wavelengths) + " at " + std::to_string(t.photonGrid) + "/" + std::to_string(t.mapSize);
    if (t.mode == render::Mode::Refined && t.backSteps != 4) label += ", " + std::to_string(t.backSteps) + (t.backSteps == 1 ? " step" : " steps");
    return label;
}

std::string Configuration::family() const {
    if (transport.mode == render::Mode::Thesis) return transport.gapFill ? "thesis with gap fill" : "thesis";
    return modeName(transport.mode) + (transport.wavelengths == render::kContinuous ? ", continuous spectrum" : ", exact wavelengths");
}

tl::expected<Configuration, std::string> parseConfiguration(const std::string& text) {
    Configuration configuration = make(render::Mode::Refined, render::kContinuous, 256, 512);
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos || !set(configuration.transport, part.substr(0, equals), part.substr(equals + 1))) {
            return tl::unexpected("configuration \"" + text + "\": \"" + part + "\" is not one of " + configurationHelp());
        }
    }
    return configuration;
}

std::string configurationHelp() {
    return "mode=refined|thesis|traced|auto, wavelengths=1..64|continuous, grid=16..4096 (photons a side; thesis: texels a side of the "
           "light's view), map=64..2048, steps=1..16 (on the back layer), levels=1..6 (thesis: hierarchy), bounces=0..32 (traced), exact_receivers=on|off (traced), gap_fill=on|off, "
           "filter=on|off";
}

std::vector<Configuration> defaultConfigurations(bool quick) {
    using enum render::Mode;
    constexpr int kContinuous = render::kContinuous;
    std::vector<Configuration> list;
    // What each further wavelength brings
    for (const int wavelengths : {1, 3, 7, 13, 21, 41}) {
        if (!quick || wavelengths == 7) list.push_back(make(Refined, wavelengths, 256, 512));
    }
    // What photons and texels bring
    struct Size {
        int grid, map;
        bool quick;
    };
    for (const auto [grid, map, inQuick] : {Size{64, 256, false}, {128, 256, true}, {128, 512, false}, {256, 256, false}, {256, 512, true},
                                            {256, 1024, false}, {512, 512, false}, {512, 1024, true}, {1024, 1024, false}}) {
        if (!quick || inQuick) list.push_back(make(Refined, kContinuous, grid, map));
    }
    if (!quick) {
        list.push_back(make(Refined, 7, 1024, 1024));
        list.push_back(make(Refined, 21, 1024, 1024));
        // What each step to the exit point brings
        for (const int steps : {1, 2, 8}) {
            list.push_back(make(Refined, kContinuous, 256, 512));
            list.back().transport.backSteps = steps;
        }
    }
    // As published
    for (const int wavelengths : {1, 7, 21}) {
        if (!quick || wavelengths != 1) list.push_back(make(Thesis, wavelengths, 512, 512, wavelengths > 1));
        if (!quick && wavelengths > 1) list.push_back(make(Thesis, wavelengths, 512, 512, false));
    }
    if (!quick) {
        list.push_back(make(Thesis, 7, 256, 256, true));
        list.push_back(make(Thesis, 7, 1024, 1024, true));
    }
    return list;
}

}  // namespace caustream::bench
