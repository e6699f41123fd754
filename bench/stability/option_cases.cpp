// Transport options at their limits, pictures of odd sizes, lights that go round and come back.
#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"
#include "scene/builtin_scenes.h"

namespace caustream::stability {

namespace {

Setup with(const std::function<void(render::Transport&)>& change) {
    Setup setup{.scene = prismScene(optics::Cauchy{1.5046, 0.02}), .transport = smallTransport(), .expect = {}};
    change(setup.transport);
    return setup;
}

Setup withWavelengths(const std::function<void(render::Transport&)>& change) {
    Setup setup = with(change);
    setup.transport.forceDispersive = true;
    setup.ownWavelengths = true;
    return setup;
}

scene::Scene builtin(const std::string& name) {
    auto scene = scene::loadBuiltin(name);
    if (!scene) throw std::runtime_error(scene.error().message);
    return std::move(*scene);
}

}  // namespace

std::vector<Case> optionCases() {
    std::vector<Case> cases;
    const auto add = [&](std::string name, std::function<Setup()> make) {
        cases.push_back({.group = "option", .name = std::move(name), .make = std::move(make)});
    };
    for (const int count : {1, 2, 3, 4, 5, 13, 21, 31, 32, 33, 63, 64}) {
        add("wavelengths-" + std::to_string(count), [=] { return withWavelengths([=](render::Transport& t) { t.wavelengths = count; }); });
    }
    add("wavelengths-given", [] { return withWavelengths([](render::Transport& t) { t.wavelengthsNm = {380.0, 380.001, 500.0, 680.0}; }); });
    add("wavelength-given", [] { return withWavelengths([](render::Transport& t) { t.wavelengthsNm = {632.8}; }); });
    for (const int size : {64, 80, 112}) add("map-" + std::to_string(size), [=] { return with([=](render::Transport& t) { t.mapSize = size; }); });
    for (const int grid : {16, 17, 31}) add("grid-" + std::to_string(grid), [=] { return with([=](render::Transport& t) { t.photonGrid = grid; }); });
    const auto large = [&](std::string name, std::function<Setup()> make) {
        cases.push_back({.group = kLargeGroup, .name = std::move(name), .make = std::move(make)});
    };
    for (const int size : {1024, 2048}) large("map-" + std::to_string(size), [=] { return with([=](render::Transport& t) { t.mapSize = size; }); });
    large("grid-600", [] { return with([](render::Transport& t) { t.photonGrid = 600; }); });
    large("grid-2048", [] {   // two small balls far apart: of four million texels few are lit
        Setup setup = with([](render::Transport& t) { t.photonGrid = 2048; });
        tests::SyntheticScene parts;
        const int glass = parts.material(glassOf(optics::Cauchy{1.5046, 0.02}));
        parts.addSphere(glass, {-0.5f, 0.5f, -0.5f}, 0.04f);
        parts.addSphere(glass, {0.5f, 0.5f, 0.5f}, 0.04f);
        std::vector<scene::Object>& objects = parts.edit().objects;
        objects[0].indexCount += objects[1].indexCount;
        objects.pop_back();
        addFloor(parts);
        setup.scene = finish(parts, spotAbove({0.1f, 2.5f, 0.2f}, {0, 0.5f, 0}, 30.0f));
        return setup;
    });
    for (const int steps : {1, 2, 16}) add("back-steps-" + std::to_string(steps), [=] { return with([=](render::Transport& t) { t.backSteps = steps; }); });
    for (const int steps : {1, 2, 32}) add("receiver-steps-" + std::to_string(steps), [=] { return with([=](render::Transport& t) { t.receiverSteps = steps; }); });
    add("steps-of-one", [] { return with([](render::Transport& t) { t.backSteps = t.receiverSteps = 1; }); });
    add("unfiltered", [] { return with([](render::Transport& t) { t.filter = false; }); });
    add("gap-fill", [] { return with([](render::Transport& t) { t.gapFill = true; }); });
    add("gap-fill-exaggerated", [] {
        Setup setup = with([](render::Transport& t) { t.gapFill = true; });
        setup.scene = sphereScene(optics::Cauchy{1.458, 0.6});
        return setup;
    });
    add("force-dispersive", [] {
        Setup setup = with([](render::Transport& t) { t.forceDispersive = true; });
        setup.scene.materials.front().dispersion = optics::ConstantIndex{1.5};
        return setup;
    });
    for (const int side : {16, 17, 640}) {
        add("picture-" + std::to_string(side), [=] {
            Setup setup = with([](render::Transport&) {});
            setup.pictureSide = side;
            return setup;
        });
    }

    // Round and back: nothing may be left of the poses between
    const auto round = [&](std::string name, std::function<scene::Scene()> make) {
        cases.push_back({.group = "round trip", .name = "round-" + std::move(name), .make = [make = std::move(make)] {
                             return Setup{.scene = make(), .transport = smallTransport(), .roundTrip = true, .expect = {}};
                         }});
    };
    round("sphere", [] { return sphereScene(optics::Cauchy{1.5046, 0.0042}); });
    round("prism", [] { return prismScene(optics::Cauchy{1.458, 0.03}); });
    round("gem", [] { return builtin("gem"); });
    return cases;
}

std::vector<Case> builtinCases() {
    std::vector<Case> cases;
    for (const scene::BuiltinScene& known : scene::builtinScenes()) {
        const std::string name(known.name);
        cases.push_back({.group = "built-in", .name = "scene-" + name, .make = [name] {
                             Setup setup{.scene = builtin(name), .transport = smallTransport()};
                             // A brilliant throws all its light back inside, Newton's second prism is lit through the first:
                             // two interfaces see nothing of either.
                             const bool tracedOnly = name == "brilliant" || name == "newton";
                             (tracedOnly ? setup.expectTraced : setup.expect) = [](const render::EnergyLedger& ledger) {
                                 return ledger.deposited > 0.05 * ledger.onCasters ? "" : "no caustic";
                             };
                             if (name == "newton") setup.jumps = "slits cut the light";
                             return setup;
                         }});
    }
    return cases;
}

}  // namespace caustream::stability
