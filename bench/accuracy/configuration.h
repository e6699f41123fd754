// One way to ask the renderer for a spectral map, in the words that the command line and the tables use.
#pragma once
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "render/frame.h"

namespace caustream::bench {

struct Configuration {
    render::Transport transport;

    // Canonical: equal transports have equal names. "refined continuous grid 180 map 512 steps 4"
    std::string name() const;
    // The same for a plot whose legend says the family: "continuous 256/512", grid over map.
    std::string label() const;
    // What draws points of its own in a plot: "refined, continuous spectrum"
    std::string family() const;
};

// "mode=thesis,wavelengths=21,grid=512,map=512,gap_fill=on"; whatever is left out has its default. Errors: a sentence.
tl::expected<Configuration, std::string> parseConfiguration(const std::string& text);

// What parseConfiguration knows, for --help.
std::string configurationHelp();

// From coarse to fine, both modes: about thirty. `quick` keeps a third of them.
std::vector<Configuration> defaultConfigurations(bool quick);

}  // namespace caustream::bench
