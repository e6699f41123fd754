#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>

#include "client/connection/convergence_text.h"
#include "client/connection/readings.h"
#include "client/view/panel.h"

namespace caustream::view {
namespace {

void row(const char* name, const char* text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name);
    ImGui::TableNextColumn();
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text).x);
    ImGui::TextUnformatted(text);
}

void row(const char* name, const char* format, double value) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    row(name, text);
}

bool beginTable(const char* id) {
    return ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp);
}

// The page has the same words (readout.js).
void drawRates(const Model& model) {
    if (!beginTable("##rates")) return;
    row("frames per second", "%.1f", model.frameRate);
    row("frame age", "%.1f ms", model.ageMs);
    row("input to picture", "%.1f ms", model.latencyMs);
    row("round trip", "%.2f ms", model.roundTripMs);
    row("hold", "%.1f ms", model.frame.holdUs / 1000.0);
    row("render", "%.1f ms", model.frame.renderUs / 1000.0);
    row("encode", "%.1f ms", model.frame.encodeUs / 1000.0);
    if (model.stats) row("send", "%.1f ms", model.stats->sendMs);
    row("decode", "%.1f ms", model.decodeMs);
    row("quality", connection::qualityText(model.frame).c_str());
    row("picture", connection::sizeText(model.frame).c_str());
    row("payload", "%.0f kB", model.frame.payloadLen / 1000.0);
    if (model.stats) {
        row("window", "%.0f frames", model.stats->window);
        row("dropped", connection::dropsText(model.stats->drops).c_str());
        row("photons", connection::countText(model.stats->photons).c_str());
        if (model.stats->error) row("map error, estimated", "%.1f %%", 100.0 * model.stats->error->total);
        if (const auto& convergence = model.stats->convergence) {
            row("photons in the map", connection::countText(convergence->photons).c_str());
            row("converges to", "%.2g %%", 100.0 * convergence->target);
        }
    }
    ImGui::EndTable();
    if (model.stats && !model.stats->choice.empty()) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", model.stats->choice.c_str());
        ImGui::PopTextWrapPos();
    }
}

void drawStages(const protocol::Stats& stats) {
    double longest = 1e-3;
    for (const auto& stage : stats.stages) longest = std::max(longest, stage.ms);
    for (const auto& stage : stats.stages) {
        char text[96];
        std::snprintf(text, sizeof text, "%s  %.2f ms", stage.pass.c_str(), stage.ms);
        ImGui::ProgressBar(static_cast<float>(stage.ms / longest), {-FLT_MIN, 0}, text);
    }
}

void drawPlan(const protocol::Stats& stats) {
    for (const auto& entry : stats.plan) {
        ImGui::TextColored(entry.run ? ImVec4{0.55f, 0.85f, 0.6f, 1} : ImVec4{0.56f, 0.56f, 0.58f, 1}, "%s %s",
                           entry.run ? "run " : "skip", entry.pass.c_str());
        if (entry.reason.empty()) continue;
        ImGui::Indent();
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", entry.reason.c_str());
        for (const std::string& part : entry.without) ImGui::TextDisabled("without %s", part.c_str());
        ImGui::PopTextWrapPos();
        ImGui::Unindent();
    }
}

void drawLedger(const protocol::Ledger& ledger) {
    const double whole = ledger.onCasters;
    if (!(whole > 0.0) || !beginTable("##ledger")) return;
    row("light on the glass", "%.4g sr", whole);
    const auto part = [&](const char* name, double value) { row(name, "%.1f %%", 100.0 * value / whole); };
    part("into the map", ledger.deposited);
    part("absorbed", ledger.absorbed);
    part("reflected", ledger.reflected);
    part("total reflection", ledger.totalReflection);
    part("rejected", ledger.rejected);
    part("outside the map", ledger.leftMap);
    part("no receiver", ledger.noReceiver);
    part("too faint, or too many bounces", ledger.cut);
    ImGui::EndTable();
}

void drawError(const protocol::ErrorEstimate& error) {
    if (!beginTable("##error")) return;
    row("map error, estimated", "%.1f %%", 100.0 * error.total);
    row("too few photons", "%.1f %%", 100.0 * error.sampling);
    row("too few wavelengths", "%.1f %%", 100.0 * error.spectral);
    ImGui::EndTable();
}

}  // namespace

void drawReadout(const Model& model) {
    ImGui::Spacing();
    if (ImGui::CollapsingHeader("Speed", ImGuiTreeNodeFlags_DefaultOpen)) drawRates(model);
    if (!model.stats) return;
    ImGui::Spacing();
    if (ImGui::CollapsingHeader("Server's stages")) drawStages(*model.stats);
    ImGui::Spacing();
    if (ImGui::CollapsingHeader("Plan")) drawPlan(*model.stats);
    if (!model.stats->ledger) return;
    ImGui::Spacing();
    if (!ImGui::CollapsingHeader("Where the light goes")) return;
    drawLedger(*model.stats->ledger);
    if (model.stats->error) drawError(*model.stats->error);
}

}  // namespace caustream::view
