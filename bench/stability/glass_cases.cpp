// What the glass is made of: dispersion up to n = 10, down to none, absorption, and what is around it.
#include <cstdio>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

Setup plain(scene::Scene scene) { return {.scene = std::move(scene), .transport = smallTransport(), .expect = {}}; }

std::string glassName(const char* shape, double A, double B) {
    char text[64];
    std::snprintf(text, sizeof text, "%s-A%g-B%g", shape, A, B);
    return text;
}

scene::Scene withAbsorption(const std::vector<double>& nm, const std::vector<double>& perM) {
    scene::Scene scene = sphereScene(optics::Cauchy{1.5046, 0.0042});
    scene.materials.front().absorption = {nm, perM};
    return scene;
}

scene::Scene within(const optics::Dispersion& glass, double outsideIndex) {
    scene::Scene scene = sphereScene(glass);
    scene.outsideIndex = outsideIndex;
    return scene;
}

std::string nothingPasses(const render::EnergyLedger& ledger) {
    return ledger.deposited <= 1e-3 * ledger.onCasters ? "" : "light passes what absorbs all of it";
}

}  // namespace

std::vector<Case> glassCases() {
    std::vector<Case> cases;
    const auto add = [&](std::string name, std::function<Setup()> make) {
        cases.push_back({.group = "glass", .name = std::move(name), .make = std::move(make)});
    };

    // Dispersion: Cauchy's A and B over all that a scene may ask for (n <= 10)
    for (const double A : {1.0003, 1.01, 1.1, 1.3, 1.458, 2.0, 2.5, 4.0}) {
        for (const double B : {0.0, 0.0042, 0.06, 0.6}) {
            add(glassName("sphere", A, B), [=] {
                Setup setup = plain(sphereScene(optics::Cauchy{A, B}));
                if (A == 1.0003 && B == 0.0) {
                    setup.expect = [](const render::EnergyLedger& ledger) {
                        return ledger.deposited > 0.98 * ledger.onCasters ? "" : "glass that hardly is there takes light";
                    };
                }
                return setup;
            });
        }
    }
    for (const double A : {1.0003, 1.2, 1.458, 4.0}) {
        for (const double B : {0.0042, 0.06, 0.6}) add(glassName("prism", A, B), [=] { return plain(prismScene(optics::Cauchy{A, B})); });
    }
    add("sphere-B1.2", [] { return plain(sphereScene(optics::Cauchy{1.458, 1.2})); });   // n = 9.8 at 380 nm
    add("sphere-negative-C", [] { return plain(sphereScene(optics::Cauchy{1.5, 0.1, -0.01})); });
    add("sphere-anomalous", [] { return plain(sphereScene(optics::Cauchy{2.0, -0.1})); });   // red is bent most
    add("sphere-abbe-1", [] { return plain(sphereScene(optics::Abbe{1.5, 1.0})); });
    add("sphere-abbe-0.1", [] { return plain(sphereScene(optics::Abbe{1.5, 0.1})); });   // clamped at 1 in the red
    add("sphere-index-10", [] { return plain(sphereScene(optics::ConstantIndex{10.0})); });
    for (const optics::GlassPreset& preset : optics::kGlassPresets) {
        add(std::string("prism-") + preset.name, [dispersion = preset.dispersion] { return plain(prismScene(dispersion)); });
    }
    // A resonance just beyond either end of the band
    add("sphere-resonance-uv", [] { return plain(sphereScene(optics::Sellmeier{{1.0, 0.02, 0.0}, {0.01, 0.1440, 0.0}})); });
    add("sphere-resonance-ir", [] { return plain(sphereScene(optics::Sellmeier{{3.0, 0.02, 0.0}, {0.01, 0.4630, 0.0}})); });

    // What is around: water, oil, a bubble, the glass's own index at one wavelength
    add("in-water", [] { return plain(within(optics::Cauchy{1.5046, 0.0042}, 1.333)); });
    add("bubble-in-water", [] { return plain(within(optics::ConstantIndex{1.0}, 1.333)); });
    add("bubble-in-diamond", [] { return plain(within(optics::ConstantIndex{1.0}, 2.4)); });
    add("index-crosses-outside", [] { return plain(within(optics::Cauchy{1.45, 0.02}, 1.52)); });
    add("index-matched", [] { return plain(within(optics::ConstantIndex{1.5}, 1.5)); });
    add("index-almost-matched", [] { return plain(within(optics::ConstantIndex{1.500002}, 1.5)); });

    // Absorption
    add("absorbs-all", [] {
        Setup setup = plain(withAbsorption({550.0}, {1e6}));
        setup.expect = nothingPasses;
        return setup;
    });
    add("absorbs-blue", [] { return plain(withAbsorption({480.0, 500.0}, {1e4, 0.0})); });
    add("absorbs-hardly", [] { return plain(withAbsorption({380.0, 680.0}, {1e-9, 1e-9})); });
    add("absorbs-one-line", [] { return plain(withAbsorption({549.9, 550.0, 550.1}, {0.0, 1e8, 0.0})); });
    return cases;
}

}  // namespace caustream::stability
