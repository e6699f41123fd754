// What the stability benchmark renders: cases by name, each made anew when it is wanted.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "render/frame.h"

namespace caustream::stability {

struct Setup {
    scene::Scene scene;
    render::Transport transport;             // mode and, unless ownWavelengths, wavelengths are the mode's
    int pictureSide = 128;                   // pixels
    bool ownWavelengths = false;             // the case is about them
    std::string jumps;                       // why a small change of the light may change the map at will; empty: it must not
    bool roundTrip = false;                  // the light goes round and comes back instead of the other checks
    // What is special about the case's energy: a sentence when it is wrong, empty otherwise. Of every mode that must pass,
    // of refined transport alone, of traced alone.
    using Expectation = std::function<std::string(const render::EnergyLedger&)>;
    Expectation expect, expectRefined = {}, expectTraced = {};
};

inline constexpr const char* kLargeGroup = "large";   // cases that take seconds each

struct Case {
    std::string group;                       // rows of the table
    std::string name;                        // unique; what --case takes
    std::uint64_t seed = 0;                  // of random scenes, which --case takes too; 0: none
    std::function<Setup()> make;
};

// "what-value": the name of a case of a sweep.
std::string numbered(const char* what, double value);

// Grid 96, map 128: small enough for hundreds of cases, and every search, view and level of the pyramid at work.
render::Transport smallTransport();

std::vector<Case> glassCases();              // dispersion, absorption, what is around
std::vector<Case> lightCases();              // where the light stands, cones, spectra, cookies
std::vector<Case> casterCases();             // shapes, broken meshes, how large and how many
std::vector<Case> receiverCases();           // what the light falls on; scale and place of the whole scene
std::vector<Case> tracedCases();             // what exact surfaces find hard
std::vector<Case> mirrorCases();             // casters that reflect
std::vector<Case> optionCases();             // wavelengths, map and grid, steps at their limits; round trips
std::vector<Case> builtinCases();            // the scenes that come with the server
Case randomCase(std::uint64_t seed);         // everything above at once, drawn by `seed` > 0

// All named ones and `random` random ones (seeds 1 to `random`), in the order of the table.
std::vector<Case> allCases(int random);

}  // namespace caustream::stability
