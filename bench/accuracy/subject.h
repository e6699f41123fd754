// A scene that is measured: as the renderer loads it, as the reference tracer sees it, and where the two are compared.
#pragma once
#include <optional>
#include <string>

#include "bench/accuracy/window.h"
#include "bench/reference/tracer.h"
#include "bench/reference/world.h"
#include "scene/scene.h"

namespace caustream::bench {

// The wavelengths that maps are compared at, one by one: 380, 430 ... 680 nm.
const std::vector<double>& bandsNm();

struct Subject {
    std::string name;
    std::string fingerprint;         // of all that its caustic depends on, 16 hex digits
    scene::Scene scene;
    tracer::World world;
    std::optional<Window> plane;     // the reference scenes' own window; nothing: the view of the renderer's map
    std::optional<tracer::Image> storedBands;   // their maps, one for each of bandsNm(), better than a trace of minutes

    const scene::Light& light() const;   // the one that throws the caustic
};

// A built-in scene ("gem"), a GLB file, or one of tests/reference ("reference:prism", "reference:sphere" as 20,480 faces
// against the exact sphere, "reference:gem"). Throws Error, std::runtime_error for missing reference files.
Subject loadSubject(const std::string& name);

// The same with its key light's cone so wide that the caster's bounding sphere fills `share` of its solid angle.
Subject withShare(const Subject& subject, double share);
scene::Scene withShare(scene::Scene scene, double share);

// The scene after `steps` small moves of the key light, each a few thousandths of its distance.
scene::Scene withMovedLight(const scene::Scene& scene, int steps);

// What loadSubject knows, for --help.
std::string subjectHelp();

}  // namespace caustream::bench
