// What a ray segment costs in traced transport: light into each caster, reflected inside it again and again.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>

#include "bench/commands.h"
#include "bench/statistics.h"
#include "error.h"
#include "gl/context.h"
#include "gl/shader_library.h"
#include "render/exact_surfaces.h"
#include "scene/builtin_scenes.h"
#include "tests/gpu/shader_folder.h"
#include "tests/gpu/synthetic_scene.h"

namespace caustream::bench {

namespace {

struct SegmentOptions {
    std::string gpu = "auto";
    std::vector<std::string> scenes{"gem", "prism", "sphere", "ring", "bunny"}, against;
    int photons = 10'000, wavelengths = 7, bounces = 8, rounds = 15;
};

// Refracts into the caster (indices 1.45 to 1.55), then follows the reflected part, whatever its share.
constexpr const char* kWalk = R"(#include "common/surfaces.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer In { vec4 rays[]; };
layout(std430, binding = 1) writeonly buffer Out { uint segments[]; };
uniform int u_count, u_wavelengths, u_bounces;
const ivec4 kNone = ivec4(0x7fffffff);
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_count) return;
    vec3 origin = rays[2 * (i / u_wavelengths)].xyz, direction = rays[2 * (i / u_wavelengths) + 1].xyz;
    float index = mix(1.45, 1.55, float(i % u_wavelengths) / float(u_wavelengths));
    Surface s = nearestSurface(origin, direction, -1, kNone);
    uint count = 1u;
    if (s.caster >= 0) {
        direction = refract(direction, s.shading, 1.0 / index);
        if (dot(direction, s.geometric) >= 0.0) direction = refract(rays[2 * (i / u_wavelengths) + 1].xyz, s.geometric, 1.0 / index);
    }
    for (int bounce = 0; bounce <= u_bounces && s.caster >= 0; ++bounce) {
        origin = s.point;
#if LONE
        s = exitOf(s.caster, origin, direction);
#else
        s = nearestSurface(origin, direction, s.piece, ivec4(s.caster, kNone.yzw));
#endif
        ++count;
        vec3 thrown = reflect(direction, s.shading);
        direction = dot(thrown, s.geometric) < 0.0 ? thrown : reflect(direction, s.geometric);
    }
    segments[i] = count + (origin.x == 12345.0 ? 1u : 0u);   // so that no way is left out
}
)";

double cpuMs() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1e3 * static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-3 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

double wallMs() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A ball of 1e6 triangles.
tl::expected<scene::Scene, scene::LoadError> aMillionTriangles() {
    scene::Scene scene;
    scene.materials.emplace_back().caster = true;
    tests::SyntheticScene made;
    made.addSphere(0, {0, 0.5f, 0}, 0.4f, 500);
    made.edit().casterBounds = made.edit().bounds;
    scene.geometry = made.geometry();
    scene.lights.emplace_back().position = {0.5f, 2, 0.3f};
    return scene;
}

// From the light to a disc around the casters.
std::vector<glm::vec4> lightRays(const scene::Scene& scene, int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> share(-1.0f, 1.0f);
    const scene::Bounds& bounds = scene.geometry->casterBounds;
    const glm::vec3 from = scene.lights[0].position, axis = glm::normalize(bounds.centre() - from);
    const glm::vec3 side = glm::normalize(glm::cross(axis, glm::vec3(0.3f, 0.2f, 0.9f))), up = glm::cross(side, axis);
    std::vector<glm::vec4> rays;
    while (static_cast<int>(rays.size()) < 2 * count) {
        const float x = share(random), y = share(random);
        if (x * x + y * y > 1.0f) continue;
        const glm::vec3 to = bounds.centre() + 0.6f * bounds.radius() * (x * side + y * up);
        rays.emplace_back(from, 0.0f);
        rays.emplace_back(glm::normalize(to - from), 0.0f);
    }
    return rays;
}

// The embedded shaders, or those of a folder, and the walk.
struct Shaders {
    explicit Shaders(const std::string& folder, int number) : files("caustream-segments-" + std::to_string(number)) {
        for (auto entry = folder.empty() ? std::filesystem::recursive_directory_iterator() : std::filesystem::recursive_directory_iterator(folder);
             entry != std::filesystem::recursive_directory_iterator(); ++entry) {
            if (!entry->is_regular_file()) continue;
            std::ifstream in(entry->path(), std::ios::binary);
            files.write(std::filesystem::relative(entry->path(), folder).string(), {std::istreambuf_iterator<char>(in), {}});
        }
        files.write("passes/walk.comp", kWalk);
        library = gl::ShaderLibrary(files.path());
    }
    tests::ShaderFolder files;
    gl::ShaderLibrary library;
};

void measureSegments(const SegmentOptions& options) {
    const auto context = gl::Context::create({.gpu = options.gpu});
    std::vector<std::unique_ptr<Shaders>> variants;
    variants.push_back(std::make_unique<Shaders>("", 0));
    for (const std::string& folder : options.against) variants.push_back(std::make_unique<Shaders>(folder, static_cast<int>(variants.size())));
    const int count = options.photons * options.wavelengths;
    std::printf("%s, %d photons x %d wavelengths, %d internal reflections, medians of %d in turn, calibration %.1f ms\n",
                context->renderer().c_str(), options.photons, options.wavelengths, options.bounces, options.rounds, calibrationMs());
    std::printf("%-10s %-9s %9s %10s %9s %12s %14s  %s\n", "scene", "shaders", "build, ms", "segments", "whole, ms", "ns a segment", "CPU ns", "casters");
    for (const std::string& name : options.scenes) {
        const auto scene = name == "million" ? aMillionTriangles() : scene::loadBuiltin(name);
        if (!scene) throw Error(scene.error().message);
        const render::ExactSurfaces surfaces(*scene);
        const std::vector<glm::vec4> rays = lightRays(*scene, options.photons);
        const gl::Buffer in(rays.size() * sizeof(glm::vec4), rays.data(), 0, "rays");
        const gl::Buffer out(static_cast<std::size_t>(count) * sizeof(GLuint), nullptr, 0, "segments");
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.get());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.get());
        std::vector<std::vector<double>> wall(variants.size()), cpu(variants.size());
        std::vector<double> segments(variants.size());
        for (int round = 0; round <= options.rounds; ++round) {
            for (std::size_t v = 0; v < variants.size(); ++v) {
                const GLuint program = variants[v]->library.program("walk", surfaces.flags());
                const gl::Uniforms uniforms(program);
                uniforms.set("u_count", count).set("u_wavelengths", options.wavelengths).set("u_bounces", options.bounces);
                surfaces.bind(uniforms, 0);
                glUseProgram(program);
                glFinish();
                const double wallStart = wallMs(), cpuStart = cpuMs();
                glDispatchCompute(static_cast<GLuint>((count + 63) / 64), 1, 1);
                glFinish();
                if (round == 0) {   // warms up, and counts
                    std::vector<GLuint> counted(static_cast<std::size_t>(count));
                    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // out -> read-back
                    glGetNamedBufferSubData(out.get(), 0, static_cast<GLsizeiptr>(out.bytes()), counted.data());
                    for (const GLuint each : counted) segments[v] += each;
                    continue;
                }
                wall[v].push_back(wallMs() - wallStart);
                cpu[v].push_back(cpuMs() - cpuStart);
            }
        }
        for (std::size_t v = 0; v < variants.size(); ++v) {
            const std::string which = v == 0 ? "embedded" : std::filesystem::path(options.against[v - 1]).filename().string();
            std::printf("%-10s %-9s %9.1f %10.0f %9.1f %12.0f %14.0f  %s\n", name.c_str(), which.c_str(), surfaces.buildMs(), segments[v],
                        median(wall[v]), 1e6 * median(wall[v]) / segments[v], 1e6 * median(cpu[v]) / segments[v],
                        surfaces.casters().empty() ? "none" : surfaces.casters()[0].why.c_str());
        }
        std::fflush(stdout);
    }
}

}  // namespace

void addSegments(CLI::App& app) {
    const auto options = std::make_shared<SegmentOptions>();
    CLI::App* command = app.add_subcommand("segments", "what a ray segment of traced transport costs, caster by caster");
    command->add_option("--gpu", options->gpu, "as for caustream-server")->capture_default_str();
    command->add_option("--scenes", options->scenes, "built-in scenes, or \"million\": a ball of 1e6 triangles")->delimiter(',');
    command->add_option("--photons", options->photons)->check(CLI::Range(1, 10'000'000))->capture_default_str();
    command->add_option("--wavelengths", options->wavelengths)->check(CLI::Range(1, 64))->capture_default_str();
    command->add_option("--bounces", options->bounces, "internal reflections")->check(CLI::Range(0, 1000))->capture_default_str();
    command->add_option("--rounds", options->rounds)->check(CLI::Range(1, 10'000))->capture_default_str();
    command->add_option("--against", options->against, "folders of other shaders, measured in turn with the embedded ones");
    command->callback([options] { measureSegments(*options); });
}

}  // namespace caustream::bench
