// Where the light stands, how wide it shines, what it is made of.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "bench/stability/case.h"
#include "bench/stability/scene_parts.h"

namespace caustream::stability {

namespace {

constexpr glm::vec3 kMiddle(0, 0.5f, 0);   // of sphereScene()'s sphere

scene::Scene sphere() { return sphereScene(optics::Cauchy{1.5046, 0.0042}); }

Setup lit(const scene::Light& light) {
    Setup setup{.scene = sphere(), .transport = smallTransport(), .expect = {}};
    setup.scene.lights.front() = light;
    return setup;
}

Setup lit(const std::function<void(scene::Light&)>& change) {
    scene::Light light = sphere().lights.front();
    change(light);
    return lit(light);
}

scene::Light sun(const glm::vec3& direction) {
    scene::Light light;
    light.name = "sun";
    light.type = scene::LightType::Directional;
    light.direction = glm::normalize(direction);
    return light;
}

// A picture in front of the light: black but for every `pitch`-th column.
Setup withCookie(int side, int pitch) {
    Setup setup{.scene = sphere(), .transport = smallTransport(), .expect = {}};
    setup.scene = changed(std::move(setup.scene), [&](scene::Geometry& geometry) {
        scene::Texture texture{side, side, {}};
        for (int i = 0; i < side * side; ++i) {
            const std::uint8_t level = pitch > 0 && i % side % pitch == 0 ? 255 : 0;
            texture.rgba.insert(texture.rgba.end(), {level, level, level, 255});
        }
        geometry.textures.push_back(std::move(texture));
    });
    setup.scene.lights.front().cookie = 0;
    return setup;
}

}  // namespace

std::vector<Case> lightCases() {
    std::vector<Case> cases;
    const auto add = [&](std::string name, std::function<Setup()> make) {
        cases.push_back({.group = "light", .name = std::move(name), .make = std::move(make)});
    };

    // Distance from the sphere's surface, the cone just around it or 60 degrees
    for (const float gap : {0.0f, 1e-6f, 1e-4f, 1e-3f, 1e-2f, 0.1f}) {
        add(numbered("light-at", gap), [=] {
            Setup setup = lit(spotAbove({0, 0.8f + gap, 0}, {0, 0, 0}, 60.0f));
            if (gap == 0.0f) setup.jumps = "a step leads into the glass or out of it";
            return setup;
        });
    }
    for (const float distance : {10.0f, 1e3f, 1e5f}) {
        add(numbered("light-far", distance), [=] {
            const float halfAngle = std::max(glm::degrees(std::atan(0.35f / distance)), 1e-3f);
            Setup setup = lit(spotAbove(kMiddle + glm::vec3(0.3f, 1, 0.2f) * distance, kMiddle, halfAngle));
            setup.scene.lights.front().intensity *= distance * distance;
            return setup;
        });
    }
    add("light-inside", [] { return lit(spotAbove(kMiddle, {0, 0, 0}, 60.0f)); });
    add("light-inside-off-middle", [] { return lit(spotAbove({0.1f, 0.6f, 0.05f}, {0, 0, 0}, 30.0f)); });
    add("light-inside-point", [] { return lit([](scene::Light& light) { light.type = scene::LightType::Point, light.position = kMiddle; }); });
    add("light-under-floor", [] { return lit(spotAbove({0, -1, 0}, kMiddle, 15.0f)); });
    add("light-on-floor", [] { return lit(spotAbove({1, 0, 0}, kMiddle, 30.0f)); });
    add("light-aimed-away", [] { return lit(spotAbove({0, 2, 0}, {0, 4, 0}, 20.0f)); });
    add("light-through-rim", [] { return lit(spotAbove({0.3f, 2.5f, 0}, {0.3f, 0, 0}, 0.5f)); });

    // Straight down and along the axes: the view's own axes are ambiguous there (T1 parallel to the view axis)
    add("axis-down", [] { return lit(spotAbove({0, 2.5f, 0}, kMiddle, 12.0f)); });
    add("axis-down-nearly", [] { return lit(spotAbove({1e-6f, 2.5f, -1e-6f}, kMiddle, 12.0f)); });
    add("axis-x", [] { return lit(spotAbove({-2.5f, 0.5f, 0}, kMiddle, 12.0f)); });
    add("axis-z", [] { return lit(spotAbove({0, 0.5f, 2.5f}, kMiddle, 12.0f)); });

    // Grazing: the sphere's shadow is as long as the floor and longer
    for (const float height : {0.85f, 0.6f, 0.52f, 0.5001f}) {
        add(numbered("grazing", height), [=] { return lit(spotAbove({-3, height, 0}, kMiddle, 10.0f)); });
    }

    // Cones
    for (const float halfAngle : {1e-3f, 1e-2f, 0.1f, 45.0f, 80.0f, 89.9f}) {
        add(numbered("cone", halfAngle), [=] {
            Setup setup = lit([=](scene::Light& light) { light.innerConeDeg = 0.0f, light.outerConeDeg = halfAngle; });
            if (halfAngle <= 1e-3f) setup.jumps = "the step is as wide as the cone";
            return setup;
        });
    }
    add("cone-hard-narrow", [] { return lit([](scene::Light& light) { light.innerConeDeg = light.outerConeDeg = 0.05f; }); });

    // Directional, also in a scene so wide that the sphere is lost in it
    add("sun-down", [] { return lit(sun({0, -1, 0})); });
    add("sun-oblique", [] { return lit(sun({1, -1, 0.3f})); });
    add("sun-grazing", [] { return lit(sun({1, -1e-3f, 0})); });
    add("sun-level", [] {
        Setup setup = lit(sun({1, 0, 0}));
        setup.jumps = "the floor is edge-on to the light: it is a line in the map";
        return setup;
    });
    add("sun-from-below", [] { return lit(sun({0.2f, 1, 0})); });
    for (const float side : {1e3f, 1e6f, 1e9f}) {
        add(numbered("sun-wide-scene", side), [=] {
            Setup setup = lit(sun({0.3f, -1, 0.1f}));
            setup.scene = changed(std::move(setup.scene), [=](scene::Geometry& geometry) {
                for (std::uint32_t i = geometry.objects[1].firstIndex; i < geometry.indices.size(); ++i) geometry.vertices[geometry.indices[i]].position *= 0.2f * side;
            });
            return setup;
        });
    }

    // Spectra and cookies
    add("spectrum-d65", [] { return lit([](scene::Light& light) { light.spectrum = optics::DaylightD65{}; }); });
    add("spectrum-candle", [] { return lit([](scene::Light& light) { light.spectrum = optics::Blackbody{500.0}; }); });
    add("spectrum-hottest", [] { return lit([](scene::Light& light) { light.spectrum = optics::Blackbody{1e5}; }); });
    add("spectrum-one-line", [] { return lit([](scene::Light& light) { light.spectrum = optics::Lines{{546.1}}; }); });
    add("spectrum-edge-lines", [] { return lit([](scene::Light& light) { light.spectrum = optics::Lines{{380.0, 680.0}}; }); });
    add("light-without-power", [] { return lit([](scene::Light& light) { light.intensity = 0.0f; }); });
    add("light-of-one-colour", [] { return lit([](scene::Light& light) { light.color = {1, 0, 0}; }); });
    add("light-strongest", [] { return lit([](scene::Light& light) { light.intensity = 1e12f; }); });
    add("cookie-stripes", [] { return withCookie(64, 4); });
    add("cookie-black", [] { return withCookie(4, 0); });
    add("two-lights", [] {
        Setup setup = lit(sphere().lights.front());
        setup.scene.lights.push_back(sun({0.1f, -1, 0}));
        return setup;
    });
    return cases;
}

}  // namespace caustream::stability
