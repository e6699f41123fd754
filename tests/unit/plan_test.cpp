// What runs and what is left out, and that each says why: the plan alone, nothing is drawn.
#include "render/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/key_light.h"
#include "scene/builtin_scenes.h"

namespace caustream::render {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

const PlanEntry& row(const RenderPlan& plan, const std::string& pass) {
    for (const PlanEntry& entry : plan.entries) {
        if (entry.pass == pass) return entry;
    }
    throw std::out_of_range("no pass " + pass);
}

// One dispersive caster in the light and in view, on a floor and a wall.
PlanFacts glass() {
    PlanFacts facts;
    facts.casters = facts.castersLit = facts.glass = facts.glassInCamera = 1;
    facts.receivers = facts.receiversInShadow = facts.receiversInMap = 2;
    facts.dispersive = facts.shadowCasters = facts.castersInCamera = true;
    facts.boxShare = 0.25;
    return facts;
}

constexpr const char* kCausticPasses[] = {"caster_layers", "photon_list", "photon_trace", "map_resolve"};
constexpr const char* kLightPasses[] = {"caster_layers", "photon_list", "receiver_depth", "photon_trace", "map_resolve"};
constexpr const char* kCameraPasses[] = {"camera_receivers", "camera_casters", "dispersive_refraction", "present"};

void expectNoCaustic(const PlanFacts& facts, const std::string& why) {
    const RenderPlan plan = makePlan(facts, {});
    for (const char* pass : kCausticPasses) {
        EXPECT_FALSE(row(plan, pass).run) << pass;
        EXPECT_THAT(row(plan, pass).reason, HasSubstr(why)) << pass;
    }
    EXPECT_THAT(row(plan, "camera_receivers").without, Contains(HasSubstr("map lookups")));
}

TEST(Plan, RunsAllThatADispersiveCasterNeeds) {
    const RenderPlan plan = makePlan(glass(), {});
    for (const char* pass : kLightPasses) EXPECT_TRUE(row(plan, pass).run) << pass;
    for (const char* pass : kCameraPasses) EXPECT_TRUE(row(plan, pass).run) << pass;
    EXPECT_FALSE(row(plan, "gap_fill").run);
    EXPECT_EQ(plan.wavelengths, 4);   // nodes of the continuous spectrum
    EXPECT_TRUE(plan.continuous);
    for (const PlanEntry& entry : plan.entries) {
        EXPECT_FALSE(entry.reason.empty()) << entry.pass;
        EXPECT_THAT(entry.without, Each(Not(""))) << entry.pass;
    }
}

TEST(Plan, WithoutACaster) {
    PlanFacts facts;
    facts.receivers = 2;
    facts.shadowCasters = true;
    expectNoCaustic(facts, "no caster in the scene");
    const RenderPlan plan = makePlan(facts, {});
    EXPECT_TRUE(row(plan, "receiver_depth").run);
    EXPECT_THAT(row(plan, "receiver_depth").without, Contains(HasSubstr("maps' views")));
    EXPECT_FALSE(row(plan, "camera_casters").run);
    EXPECT_THAT(row(plan, "dispersive_refraction").reason, HasSubstr("no glass to see"));
}

TEST(Plan, WithGlassThatBendsNothing) {
    PlanFacts facts = glass();
    facts.casters = facts.castersLit = 0;
    facts.idleCasters = 1;
    expectNoCaustic(facts, "has the index of what is around it");
    facts.idleCasters = 0;
    facts.thinWalled = 1;
    expectNoCaustic(facts, "thin-walled");
    EXPECT_TRUE(makePlan(facts, {}).runs("dispersive_refraction"));   // it is seen all the same
}

TEST(Plan, WithCastersOutOfTheLight) {
    PlanFacts facts = glass();
    facts.castersLit = 0;
    expectNoCaustic(facts, "the light reaches no caster");
    facts.casters = 3, facts.castersLit = 1;
    EXPECT_THAT(row(makePlan(facts, {}), "caster_layers").without, Contains(HasSubstr("2 casters outside the light")));
    facts.lands = false;
    expectNoCaustic(facts, "lands on a receiver");
}

TEST(Plan, WithoutShadows) {
    PlanFacts facts;
    facts.receivers = 1;   // a floor
    const RenderPlan plan = makePlan(facts, {});
    EXPECT_FALSE(row(plan, "receiver_depth").run);
    EXPECT_FALSE(plan.shadow);
    EXPECT_THAT(row(plan, "receiver_depth").reason, HasSubstr("nothing throws a shadow"));
    EXPECT_THAT(row(plan, "camera_receivers").without, Contains(HasSubstr("shadow lookups")));
    facts.casters = facts.castersLit = 1;
    EXPECT_TRUE(makePlan(facts, {}).shadow);
}

TEST(Plan, ACameraMoveLeavesTheLightAlone) {
    PlanFacts facts = glass();
    facts.lightCached = true;
    const RenderPlan plan = makePlan(facts, {});
    for (const char* pass : kLightPasses) {
        EXPECT_FALSE(row(plan, pass).run) << pass;
        EXPECT_THAT(row(plan, pass).reason, HasSubstr("unchanged")) << pass;
    }
    EXPECT_TRUE(plan.runs("camera_receivers"));
    facts.castersLit = 0;   // the stronger reason
    EXPECT_THAT(row(makePlan(facts, {}), "photon_trace").reason, HasSubstr("reaches no caster"));
}

TEST(Plan, WithoutDispersionOneWavelength) {
    PlanFacts facts = glass();
    facts.dispersive = false;
    Request request;
    EXPECT_EQ(makePlan(facts, request).wavelengths, 1);
    EXPECT_THAT(row(makePlan(facts, request), "photon_trace").reason, HasSubstr("no glass disperses"));
    EXPECT_THAT(row(makePlan(facts, request), "photon_trace").without, Contains(HasSubstr("steps between wavelengths")));
    EXPECT_THAT(row(makePlan(facts, request), "dispersive_refraction").without, Contains(HasSubstr("between nodes")));
    request.transport.gapFill = true;
    EXPECT_THAT(row(makePlan(facts, request), "gap_fill").reason, HasSubstr("one wavelength leaves no gaps"));
    request.transport.forceDispersive = true;
    EXPECT_EQ(makePlan(facts, request).wavelengths, 4);
    EXPECT_TRUE(makePlan(facts, request).runs("gap_fill"));
    facts.casters = facts.castersLit = 0;
    EXPECT_THAT(row(makePlan(facts, request), "gap_fill").reason, HasSubstr("no caster"));
}

TEST(Plan, NamesThePartsThatAreNotNeeded) {
    PlanFacts facts = glass();
    Request request;
    request.transport.filter = false;
    RenderPlan plan = makePlan(facts, request);
    for (const char* part : {"cookie", "pyramid", "bands"}) {
        EXPECT_THAT(row(plan, "photon_trace").without, Contains(HasSubstr(part)));
    }
    EXPECT_THAT(row(plan, "map_resolve").without, Contains(HasSubstr("pyramid")));
    for (const char* part : {"textures", "gloss"}) EXPECT_THAT(row(plan, "camera_receivers").without, Contains(HasSubstr(part)));
    EXPECT_THAT(row(plan, "dispersive_refraction").without, Contains(HasSubstr("75% of the picture")));
    EXPECT_THAT(row(plan, "dispersive_refraction").without, Contains(HasSubstr("absorption")));
    EXPECT_THAT(row(plan, "present").without, Contains(HasSubstr("averaging")));

    facts.absorbing = facts.cookie = facts.receiversTextured = facts.receiversGlossy = true;
    facts.boxShare = 1.0;
    facts.receiversInMap = 1;
    facts.outerEmpty = true;
    request.transport.filter = true;
    request.still = true;
    plan = makePlan(facts, request);
    EXPECT_THAT(row(plan, "photon_list").without, testing::IsEmpty());
    EXPECT_THAT(row(plan, "dispersive_refraction").without, testing::IsEmpty());
    EXPECT_THAT(row(plan, "present").without, testing::IsEmpty());
    EXPECT_THAT(row(plan, "camera_receivers").without, Contains(HasSubstr("map lookups on 1 receiver:")));
    EXPECT_THAT(row(plan, "camera_receivers").without, Contains(HasSubstr("outer map")));
}

TEST(Plan, GlassOutOfTheCamerasView) {
    PlanFacts facts = glass();
    facts.glassInCamera = 0;
    facts.castersInCamera = false;
    const RenderPlan plan = makePlan(facts, {});
    for (const char* pass : {"camera_casters", "dispersive_refraction"}) {
        EXPECT_FALSE(row(plan, pass).run);
        EXPECT_THAT(row(plan, pass).reason, HasSubstr("camera's view"));
    }
    EXPECT_TRUE(plan.runs("photon_trace"));
}

TEST(Plan, TheMapAlone) {
    Request request;
    request.target = Target::Spectral;
    request.sample = Sample::F32;
    for (const char* pass : kCameraPasses) {
        EXPECT_FALSE(row(makePlan(glass(), request), pass).run) << pass;
        EXPECT_THAT(row(makePlan(glass(), request), pass).reason, HasSubstr("spectral map")) << pass;
    }
    request.sample = Sample::U8;
    EXPECT_TRUE(makePlan(glass(), request).runs("present"));
    EXPECT_FALSE(makePlan(glass(), request).runs("camera_receivers"));
    request.sample = Sample::F32;
    request.wavelengthBands = true;
    EXPECT_THAT(row(makePlan(glass(), request), "map_resolve").reason, HasSubstr("bands"));
}

TEST(Plan, APassShownAlone) {
    Request request;
    request.target = Target::Pass;
    request.pass = "shadow";
    EXPECT_FALSE(makePlan(glass(), request).runs("camera_receivers"));
    EXPECT_TRUE(makePlan(glass(), request).runs("present"));
    request.pass = "camera_casters";
    EXPECT_TRUE(makePlan(glass(), request).runs("camera_casters"));
    EXPECT_FALSE(makePlan(glass(), request).runs("dispersive_refraction"));
    request.pass = "dispersive_refraction";
    for (const char* pass : kCameraPasses) EXPECT_TRUE(makePlan(glass(), request).runs(pass)) << pass;
}

TEST(Plan, WhatIsForcedRuns) {
    PlanFacts facts = glass();
    facts.lightCached = true;
    Request request;
    request.forced.add(Omission::UnchangedLight);
    EXPECT_TRUE(makePlan(facts, request).runs("photon_trace"));
    facts.castersLit = 0;
    request.forced.add(Omission::UnlitGlass);
    EXPECT_TRUE(makePlan(facts, request).runs("photon_trace"));
    request.target = Target::Spectral;
    request.forced.add(Omission::Picture);
    EXPECT_TRUE(makePlan(facts, request).runs("dispersive_refraction"));
}

TEST(PlanFacts, TellsWhatTheGlassDoes) {
    const auto scene = std::make_shared<scene::Scene>(std::move(*scene::loadBuiltin("gem")));
    Request request;
    request.scene = scene;
    View camera;
    camera.worldToView = lookAlong(scene->cameras.front().eye, glm::vec3(0, 0, -1), glm::vec3(0, 1, 0));
    const auto facts = [&] { return gatherFacts(request, scene->lights[static_cast<std::size_t>(keyLight(*scene))], camera, Enclosure(*scene->geometry)); };
    EXPECT_GT(facts().casters, 0);
    EXPECT_TRUE(facts().dispersive);
    for (scene::Material& material : scene->materials) {
        material.dispersion = optics::Cauchy{1.5, 0.0, 0.0};
        material.absorption = {};
    }
    EXPECT_FALSE(facts().dispersive);
    EXPECT_FALSE(facts().absorbing);
    for (scene::Material& material : scene->materials) material.absorption = {{400, 600}, {0.0, 0.0}};
    EXPECT_FALSE(facts().absorbing);
    for (scene::Material& material : scene->materials) material.absorption = {{400, 600}, {2.0, 2.0}};   // grey
    EXPECT_TRUE(facts().absorbing);
    EXPECT_FALSE(facts().dispersive);
    for (scene::Material& material : scene->materials) material.absorption = {{400, 600}, {2.0, 5.0}};
    EXPECT_TRUE(facts().dispersive);
}

TEST(PlanFacts, TheWallsOfARoomShadeNothing) {
    const scene::Scene room = std::move(*scene::loadBuiltin("sphere"));
    const Enclosure enclosure(*room.geometry);
    scene::Light inside = room.lights.front(), outside = inside, sun = inside;
    outside.position = {0, 5, 0};
    sun.type = scene::LightType::Directional;
    sun.direction = {0, -1, 0};
    for (const scene::Object& object : room.geometry->objects) {
        const bool caster = room.materials[static_cast<std::size_t>(object.material)].caster;
        EXPECT_EQ(enclosure.shades(object, inside), caster) << object.name;
        EXPECT_EQ(enclosure.shades(object, outside), caster || object.name == "ceiling") << object.name;
        EXPECT_EQ(enclosure.shades(object, sun), object.name != "floor") << object.name << ", the walls edge on";
    }
}

}  // namespace
}  // namespace caustream::render
