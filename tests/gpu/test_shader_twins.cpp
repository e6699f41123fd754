// GLSL functions against their C++ twins.
#include <random>

#include "optics/fresnel.h"
#include "tests/gpu/camera_fixture.h"
#include "tests/gpu/light_buffers.h"
#include "tests/gpu/shader_folder.h"

namespace caustream::tests {
namespace {

using render::View;

class ShaderTwinsTest : public CameraPass {
   protected:
    // Runs `main_` (reads in_[i], writes out_[2 i] and out_[2 i + 1]) over `inputs`.
    std::vector<glm::vec4> compute(const std::string& includes, const std::string& work, const std::vector<glm::vec4>& inputs,
                                   const View* view = nullptr) {
        const ShaderFolder folder("caustream-shader-twins");
        folder.write("passes/twin.comp", includes +
                     "layout(local_size_x = 1) in;\n"
                     "layout(std430, binding = 0) readonly buffer In { vec4 inputs[]; };\n"
                     "layout(std430, binding = 1) writeonly buffer Out { vec4 outputs[]; };\n" +
                     (view ? "uniform View u_view;\n" : "") +
                     "void main() {\n    uint i = gl_GlobalInvocationID.x;\n    vec4 a = inputs[i];\n" + work + "}\n");
        gl::ShaderLibrary library(folder.path());
        const GLuint program = library.program("twin");
        if (view) render::setView(gl::Uniforms(program), "u_view", *view);
        const gl::Buffer in(inputs.size() * sizeof(glm::vec4), inputs.data(), 0, "in");
        const gl::Buffer out(2 * inputs.size() * sizeof(glm::vec4), nullptr, 0, "out");
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.get());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.get());
        glUseProgram(program);
        glDispatchCompute(static_cast<GLuint>(inputs.size()), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);   // out -> read-back
        std::vector<glm::vec4> values(2 * inputs.size());
        glGetNamedBufferSubData(out.get(), 0, static_cast<GLsizeiptr>(out.bytes()), values.data());
        return values;
    }

    static std::vector<View> views() {
        View oblique = lookingAt({1, 2, 3}, {-0.5f, 0, 0.3f}, 50.0f);
        oblique.halfExtent = {0.3f, 0.8f};
        oblique.nearM = 0.2f;
        View parallel = parallelView({2, 1, 1}, {0, 0, 0}, 1.5f);
        parallel.nearM = 0.5f;
        return {lookingAt({0, 0, 3}, {0, 0, 0}, 90.0f), oblique, parallel};
    }
};

TEST_F(ShaderTwinsTest, RefractionAndFresnel) {
    std::vector<glm::vec4> inputs;
    for (int i = 0; i <= 64; ++i) {
        for (const float eta : {1.0f / 5.6f, 0.4f, 1.0f / 1.5f, 0.9997f, 1.0f, 1.0003f, 1.33f, 1.5f, 2.4f, 5.6f}) {
            const float cosI = float(i) / 64.0f;
            inputs.emplace_back(std::sqrt(1.0f - cosI * cosI), 0.0f, -cosI, eta);
        }
    }
    const auto got = compute("#include \"common/optics.glsl\"\n",
                             "    vec3 refracted;\n    float reflectance;\n"
                             "    bool passes = refractDielectric(a.xyz, vec3(0, 0, 1), a.w, refracted, reflectance);\n"
                             "    outputs[2 * i] = vec4(refracted, reflectance);\n    outputs[2 * i + 1] = vec4(passes ? 1 : 0);\n",
                             inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(inputs[i]));
        const double eta = inputs[i].w, sin2T = eta * eta * (1.0 - d.z * d.z);
        if (std::abs(sin2T - 1.0) < 1e-5) continue;   // where total reflection begins, float may fall on either side
        const auto refracted = optics::refract(d, {0, 0, 1}, eta);
        EXPECT_EQ(got[2 * i + 1].x, refracted ? 1.0f : 0.0f) << i;
        // Near grazing or critical angles the cosine is the root of a small difference.
        const double slack = 2e-6 + 4e-7 / std::sqrt(std::abs(1.0 - sin2T));
        EXPECT_NEAR(got[2 * i].w, optics::fresnelDielectric(-d.z, eta), 4.0 * slack) << "cos " << -d.z << " eta " << eta;
        if (refracted) {
            EXPECT_LT(glm::distance(glm::dvec3(got[2 * i]), *refracted), slack) << "cos " << -d.z << " eta " << eta;
        }
    }
}

TEST_F(ShaderTwinsTest, ViewProjectsAsItsMatrixDoes) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share(-0.95f, 0.95f), distance(0.6f, 8.0f);
    for (const View& view : views()) {
        std::vector<glm::vec4> inputs;
        for (int i = 0; i < 200; ++i) {
            const float z = distance(random);
            const glm::vec2 xy = glm::vec2(share(random), share(random)) * view.halfExtent;
            inputs.emplace_back(view.perspective ? xy * z : xy, -z, 1.0f);
        }
        const auto got = compute("#include \"common/view.glsl\"\n",
                                 "    vec2 uv = viewToUv(u_view, a.xyz);\n"
                                 "    float layer = u_view.perspective ? u_view.near / -a.z : (u_view.far + a.z) / (u_view.far - u_view.near);\n"
                                 "    outputs[2 * i] = vec4(uv, behindLayer(u_view, a.xyz * vec3(1, 1, 1.1), layer), layerToDepth(u_view, layer));\n"
                                 "    outputs[2 * i + 1] = vec4(layerToView(u_view, uv, layer), behindLayer(u_view, a.xyz, 0.0));\n",
                                 inputs, &view);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const glm::vec4 clip = view.viewToClip() * inputs[i];
            const glm::vec2 uv = 0.5f + 0.5f * glm::vec2(clip) / clip.w;
            const float z = -inputs[i].z;
            EXPECT_LT(glm::distance(glm::vec2(got[2 * i]), uv), 1e-6f);
            EXPECT_NEAR(got[2 * i].z, view.perspective ? 0.1f : 0.1f * z / (view.farM - view.nearM), 2e-6f);
            EXPECT_NEAR(got[2 * i].w, z, 1e-5f * z);
            EXPECT_NEAR(clip.z / clip.w, view.perspective ? view.nearM / z : (view.farM - z) / (view.farM - view.nearM), 1e-6f);
            EXPECT_LT(glm::distance(glm::vec3(got[2 * i + 1]), glm::vec3(inputs[i])), 2e-5f * z);
            EXPECT_EQ(got[2 * i + 1].w, -1.0f);   // nothing there: before
        }
    }
}

TEST_F(ShaderTwinsTest, TexelsAddUpToTheViewsExtent) {
    for (const View& view : views()) {
        constexpr int kTexels = 128;
        std::vector<glm::vec4> inputs;
        for (int i = 0; i < kTexels * kTexels; ++i) {
            inputs.emplace_back((glm::vec2(i % kTexels, i / kTexels) + 0.5f) / float(kTexels), 1.0f / kTexels, 0.0f);
        }
        const auto got = compute("#include \"common/view.glsl\"\n",
                                 "    outputs[2 * i] = vec4(viewDirection(u_view, a.xy), texelExtent(u_view, a.xy, a.zz));\n"
                                 "    outputs[2 * i + 1] = vec4(viewToUv(u_view, viewDirection(u_view, a.xy)), 0, 0);\n",
                                 inputs, &view);
        double sum = 0.0;
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            sum += got[2 * i].w;
            EXPECT_NEAR(glm::length(glm::vec3(got[2 * i])), 1.0f, 1e-6f);
            if (view.perspective) {
                EXPECT_LT(glm::distance(glm::vec2(got[2 * i + 1]), glm::vec2(inputs[i])), 1e-6f);
            }
        }
        EXPECT_NEAR(sum / view.extent(), 1.0, 1e-4);   // midpoint rule
    }
}

}  // namespace
}  // namespace caustream::tests
