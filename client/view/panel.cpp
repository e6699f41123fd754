#include "client/view/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <glm/geometric.hpp>
#include <string>

#include "client/connection/convergence_text.h"

namespace caustream::view {
namespace {

using protocol::Json;
using protocol::LightType;

// A label above its control, which then has the panel's whole width.
void label(const char* text) {
    ImGui::TextDisabled("%s", text);
    ImGui::SetNextItemWidth(-FLT_MIN);
}

bool slider(const char* text, const char* id, double& value, double low, double high, const char* format,
            bool logarithmic = false) {
    label(text);
    return ImGui::SliderScalar(id, ImGuiDataType_Double, &value, &low, &high, format,
                               ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
}

// Of the control that was drawn last; beside the panel, where it hides no other control.
void tooltip(const char* text) {
    if (!ImGui::IsItemHovered()) return;
    ImGui::SetNextWindowPos({ImGui::GetWindowPos().x - 8, ImGui::GetMousePos().y}, ImGuiCond_Always, {1, 0.5f});
    ImGui::SetTooltip("%s", text);
}

// The chosen name, when another one was chosen.
template <class Names>
const std::string* choice(const char* id, const std::string& current, const Names& names) {
    const std::string* chosen = nullptr;
    if (!ImGui::BeginCombo(id, current.c_str())) return nullptr;
    for (const std::string& name : names)
        if (ImGui::Selectable(name.c_str(), name == current) && name != current) chosen = &name;
    ImGui::EndCombo();
    return chosen;
}

template <class T>
std::vector<std::string> keysOf(const std::map<std::string, T>& map) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : map) keys.push_back(key);
    return keys;
}

std::string targetOf(const protocol::StreamState& stream) {
    return stream.target == protocol::Target::Composite  ? "composite"
           : stream.target == protocol::Target::Spectral ? "spectral"
                                                         : stream.pass;
}

void drawScene(Model& model, Editor& editor) {
    if (!model.welcome) return;
    const bool builtin = model.sceneRef.kind == protocol::SceneRef::Kind::Builtin;
    label("Scene");
    if (const auto* name = choice("##scene", builtin ? model.sceneRef.name : model.fileName.empty() ? model.scene.name : model.fileName, model.welcome->scenes))
        editor.showScene({protocol::SceneRef::Kind::Builtin, *name});
    if (model.upload) {
        const double part = model.upload->size > 0
                                ? static_cast<double>(model.upload->sent) / static_cast<double>(model.upload->size)
                                : 0.0;
        ImGui::ProgressBar(static_cast<float>(part), {-FLT_MIN, 0}, part < 1.0 ? "sending the file" : "loading");
    } else if (model.following.empty()) {
        ImGui::TextDisabled("or drop a GLB file on the window");
    }
}

// Whose scene it is, and whether what is done to it is written down.
void drawSession(const Model& model, Controls& controls) {
    // Not the session's own id: whoever knows that can take the session over.
    const std::string& session = model.following.empty() ? model.welcome->viewId : model.following;
    if (session.empty()) return;
    ImGui::TextDisabled(model.following.empty() ? "session %.8s" : "follows session %.8s", session.c_str());
    tooltip(model.following.empty() ? "Copy it for a second viewer: caustream-view --follow ID, or the page's #follow=ID"
                                    : "Its scene, light, glass and map are set there; camera and picture are this window's.");
    ImGui::SameLine();
    if (ImGui::SmallButton("copy")) ImGui::SetClipboardText(session.c_str());
    if (!model.following.empty() || !model.can("record")) return;
    const bool recording = !model.recording.empty();
    ImGui::SameLine();
    if (ImGui::SmallButton(recording ? "stop recording" : "record")) controls.record = !recording;
    if (!recording) return;
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("recording to %s", model.recording.c_str());
    ImGui::PopTextWrapPos();
}

void drawPicture(Model& model, Controls& controls, Editor& editor) {
    std::vector<std::string> targets = {"composite", "spectral"};
    if (model.welcome) targets.insert(targets.end(), model.welcome->passes.begin(), model.welcome->passes.end());
    label("Show");
    if (const auto* name = choice("##target", targetOf(model.stream), targets)) {
        model.stream.target = *name == "composite"  ? protocol::Target::Composite
                              : *name == "spectral" ? protocol::Target::Spectral
                                                    : protocol::Target::Pass;
        model.stream.pass = *name;
        editor.showTarget(*name);
    }

    bool automatic = !model.exposureEv;
    const auto exposureChanged = [&] {
        editor.change(
            {{"camera",
              {{"exposure", model.exposureEv ? Json::array({"ev", *model.exposureEv}) : Json::array({"auto"})}}}});
    };
    if (ImGui::Checkbox("Automatic exposure", &automatic)) {
        if (automatic)
            model.exposureEv.reset();
        else
            model.exposureEv = model.stats ? model.stats->exposureEv : 0.0;
        exposureChanged();
    }
    if (model.exposureEv && slider("Exposure", "##ev", *model.exposureEv, -16, 16, "%+.1f EV")) exposureChanged();

    constexpr std::pair<const char*, double> kResolutions[] = {
        {"automatic", 0.0}, {"100 %", 1.0}, {"75 %", 0.75}, {"50 %", 0.5}};
    const char* shown = kResolutions[0].first;
    for (const auto& [name, value] : kResolutions)
        if (value == controls.resolution) shown = name;
    label("Resolution");
    if (ImGui::BeginCombo("##resolution", shown)) {
        for (const auto& [name, value] : kResolutions)
            if (ImGui::Selectable(name, value == controls.resolution)) controls.resolution = value;
        ImGui::EndCombo();
    }
    if (ImGui::Button("Save picture (S)", {-FLT_MIN, 0})) controls.save = true;
}

void drawLight(Model& model, Controls& controls, Editor& editor) {
    if (model.lights.size() > 1) {
        label("Light");
        if (const auto* name = choice("##light", model.light, keysOf(model.lights))) model.light = *name;
    }
    LightModel* light = model.editedLight();
    if (!light) return;
    ImGui::Checkbox("Left button drags the light (L)", &controls.leftDragsLight);
    if (light->type != LightType::Directional) {
        label("Position, m");
        const glm::dvec3 target = lightTarget(light->pose, model.centre());
        if (ImGui::DragScalarN("##position", ImGuiDataType_Double, &light->pose.position.x, 3, 0.01f, nullptr, nullptr,
                               "%.2f")) {
            // It keeps shining where it shone.
            if (glm::distance(target, light->pose.position) > 1e-6)
                light->pose.direction = glm::normalize(target - light->pose.position);
            editor.lightMoved(model.light);
        }
    }
    if (light->type == LightType::Spot &&
        slider("Cone, half angle", "##cone", light->halfAngleDeg, 0.5, 80, "%.1f deg"))
        editor.lightChanged(model.light);
    const char* unit = light->intensity.unit == protocol::Intensity::Unit::Candela ? "%.4g cd"
                       : light->intensity.unit == protocol::Intensity::Unit::Watt  ? "%.4g W"
                                                                                   : "%.4g lx";
    if (slider("Intensity", "##intensity", light->intensity.value, 0.01, 1e6, unit, true))
        editor.lightChanged(model.light);
}

void drawGlass(Model& model, Editor& editor) {
    if (model.glasses.size() > 1) {
        label("Material");
        if (const auto* name = choice("##material", model.material, keysOf(model.glasses))) model.material = *name;
    }
    const auto found = model.glasses.find(model.material);
    if (found == model.glasses.end()) return ImGui::TextDisabled("no glass in this scene");
    Glass& glass = found->second;
    bool changed = false;
    label("Preset");
    if (ImGui::BeginCombo("##preset", "choose a glass")) {
        for (const auto& preset : model.welcome ? model.welcome->glasses : std::vector<protocol::GlassPreset>{}) {
            if (!ImGui::Selectable(preset.name.c_str())) continue;
            glass = glassOf(preset.dispersion);
            editor.change({{"materials", {{model.material, {{"dispersion", protocol::toJson(preset.dispersion)}}}}}});
        }
        ImGui::EndCombo();
    }
    changed |= slider("Cauchy A", "##A", glass.A, 1.0, 2.5, "%.4f");
    changed |= slider("Cauchy B, um^2 (0: no colours)", "##B", glass.B_um2, 0.0, 0.08, "%.5f");
    if (changed) editor.glassChanged(model.material);
}

bool converges(const protocol::TransportState& transport) {
    return transport.mode == protocol::TransportMode::Auto || transport.mode == protocol::TransportMode::Traced;
}

// The published algorithm has colours for 1, 7 or 21 wavelengths.
Json wavelengthsFor(protocol::TransportState& transport) {
    int& count = transport.wavelengths;
    if (count == protocol::kContinuous) return "continuous";
    if (transport.mode == protocol::TransportMode::Thesis) count = count < 4 ? 1 : count < 14 ? 7 : 21;
    return count;
}

// How the light is followed, and how far.
void drawMethod(Model& model, Editor& editor) {
    using protocol::TransportMode;
    struct Method {
        const char *name, *says;
        TransportMode mode;
    };
    constexpr Method kMethods[] = {
        {"auto", "Traced for faceted glass; for curved glass refined while something moves, traced at rest.", TransportMode::Auto},
        {"traced", "Every surface and every bounce, exactly. At rest it converges to the target error.", TransportMode::Traced},
        {"refined", "Two surfaces of each object, from pictures of them. The fastest.", TransportMode::Refined},
        {"thesis", "As published (Blanchette 2012), to compare with.", TransportMode::Thesis}};
    protocol::TransportState& transport = model.transport;
    const auto* current = std::ranges::find(kMethods, transport.mode, &Method::mode);
    label("Method");
    if (ImGui::BeginCombo("##mode", current->name)) {
        for (const Method& method : kMethods) {
            if (ImGui::Selectable(method.name, method.mode == transport.mode)) {
                transport.mode = method.mode;
                Json patch = {{"mode", method.name}, {"wavelengths", wavelengthsFor(transport)}};
                // To what does not converge it means something else: how many photons.
                if (!converges(transport)) patch["target_error"] = transport.targetError = 0.0;
                editor.change({{"transport", patch}});
            }
            tooltip(method.says);
        }
        ImGui::EndCombo();
    }
    tooltip(current->says);
    if (!converges(transport)) return;

    label("Bounces inside");
    if (ImGui::SliderInt("##bounces", &transport.bounces, 0, 32, "%d", ImGuiSliderFlags_AlwaysClamp))
        editor.change({{"transport", {{"bounces", transport.bounces}}}});
    if (ImGui::Checkbox("Exact receivers", &transport.exactReceivers))
        editor.change({{"transport", {{"exact_receivers", transport.exactReceivers}}}});
    tooltip("Light meets the receivers' triangles themselves, not what the map's view sees of them.");
    // 0, the server's own choice, stands for one per cent.
    double percent = transport.targetError > 0.0 ? 100.0 * transport.targetError : 1.0;
    if (slider("Converge at rest to", "##target", percent, 0.1, 20.0, "%.1f %% error", true)) {
        transport.targetError = percent / 100.0;
        editor.change({{"transport", {{"target_error", transport.targetError}}}});
    }
}

void drawTransport(Model& model, Editor& editor) {
    protocol::TransportState& transport = model.transport;
    drawMethod(model, editor);
    label("Wavelengths");
    const bool continuous = transport.wavelengths == protocol::kContinuous;
    if (ImGui::SliderInt("##wavelengths", &transport.wavelengths, protocol::kContinuous, 64, continuous ? "continuous" : "%d",
                         ImGuiSliderFlags_AlwaysClamp))
        editor.change({{"transport", {{"wavelengths", wavelengthsFor(transport)}}}});

    constexpr int kGrids[] = {0, 128, 256, 512, 1024, 2048}, kMaps[] = {256, 512, 1024, 2048};
    const auto sizes = [&](const char* title, const char* id, const char* field, int& value, auto& list) {
        label(title);
        if (!ImGui::BeginCombo(id, value == 0 ? "automatic" : std::to_string(value).c_str())) return;
        for (const int size : list) {
            if (!ImGui::Selectable(size == 0 ? "automatic" : std::to_string(size).c_str(), size == value)) continue;
            value = size;
            editor.change({{"transport", {{field, size}}}});
        }
        ImGui::EndCombo();
    };
    sizes("Photons a side", "##grid", "photon_grid", transport.photonGrid, kGrids);
    sizes("Map texels a side", "##map", "map_size", transport.mapSize, kMaps);
    if (ImGui::Checkbox("Fill gaps", &transport.gapFill))
        editor.change({{"transport", {{"gap_fill", transport.gapFill}}}});
    ImGui::SameLine();
    if (ImGui::Checkbox("Smooth", &transport.filter)) editor.change({{"transport", {{"filter", transport.filter}}}});
}

bool section(const char* name, bool open = true) {
    ImGui::Spacing();
    return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

}  // namespace

void drawPanel(Model& model, Controls& controls, Editor& editor, float width, const protocol::Convergence* convergence) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({io.DisplaySize.x - width, 0});
    ImGui::SetNextWindowSize({width, io.DisplaySize.y});
    ImGui::Begin("caustream", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoSavedSettings);
    const ImVec4 good{0.36f, 0.80f, 0.47f, 1}, bad{0.95f, 0.55f, 0.25f, 1};
    ImGui::TextColored(model.connected ? good : bad, model.connected ? "connected" : "offline");
    ImGui::SameLine();
    ImGui::TextWrapped("%s", model.connection.c_str());
    if (model.gaveUp && ImGui::Button("Connect again", {-FLT_MIN, 0})) controls.reconnect = true;
    if (model.welcome) drawSession(model, controls);

    if (convergence)
        ImGui::TextDisabled(convergence->converged ? "converged: %s photons" : "converging: %s photons",
                            connection::countText(convergence->photons).c_str());
    else if (model.connected && model.frameRate < 2.0)
        ImGui::TextDisabled("at rest: nothing changes, nothing is drawn");
    else if (model.connected)
        ImGui::TextDisabled("%.0f frames/s, %.0f ms from input to picture", model.frameRate, model.latencyMs);

    const double renderMs = model.frame.renderUs / 1000.0;
    if (convergence)
        ImGui::TextDisabled("frame %.1f ms, map error about %.1f %%", renderMs, 100.0 * convergence->error);
    else if (model.connected && model.stats && model.stats->error)
        ImGui::TextDisabled("frame %.1f ms, map error about %.1f %%", renderMs, 100.0 * model.stats->error->total);
    else if (model.connected)
        ImGui::TextDisabled("frame %.1f ms", renderMs);

    // Of a scene that is followed, everything but the picture is set elsewhere.
    const bool followed = !model.following.empty();
    ImGui::BeginDisabled(followed);
    drawScene(model, editor);
    ImGui::EndDisabled();
    if (section("Picture")) drawPicture(model, controls, editor);
    const auto drawSet = [&](const char* name, const auto& draw) {
        if (!section(name)) return;
        ImGui::BeginDisabled(followed);
        draw();
        ImGui::EndDisabled();
    };
    drawSet("Light", [&] { drawLight(model, controls, editor); });
    drawSet("Glass", [&] { drawGlass(model, editor); });
    drawSet("Spectral map", [&] { drawTransport(model, editor); });
    drawReadout(model);
    ImGui::End();
}

}  // namespace caustream::view
