// What lies over the picture.
#include <imgui.h>

#include <algorithm>
#include <cfloat>

#include "client/view/panel.h"

namespace caustream::view {
namespace {

constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                      ImGuiWindowFlags_NoFocusOnAppearing;

}  // namespace

void drawProgress(const protocol::Convergence& convergence, float pictureWidth) {
    if (convergence.converged) return;
    const float bottom = ImGui::GetIO().DisplaySize.y, top = bottom - 0.2f * ImGui::GetFontSize();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({0, top}, {pictureWidth, bottom}, IM_COL32(0, 0, 0, 110));
    list.AddRectFilled({0, top}, {pictureWidth * static_cast<float>(convergence.progress), bottom}, IM_COL32(255, 181, 74, 220));
}

void drawMessages(const Model& model, float pictureWidth) {
    std::vector<Message> lines;
    for (const auto& [key, status] : model.statuses)
        lines.push_back({status.level != protocol::Status::Level::Info, status.message});
    lines.insert(lines.end(), model.messages.begin(), model.messages.end());
    if (lines.empty()) return;
    ImGui::SetNextWindowPos({12, ImGui::GetIO().DisplaySize.y - 12}, ImGuiCond_Always, {0, 1});
    ImGui::SetNextWindowSizeConstraints({0, 0}, {std::max(pictureWidth - 24, 100.0f), FLT_MAX});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("##messages", nullptr, kOverlay);
    ImGui::PushTextWrapPos(std::max(pictureWidth - 50, 80.0f));
    for (const auto& line : lines)
        ImGui::TextColored(line.error ? ImVec4{1, 0.6f, 0.4f, 1} : ImVec4{0.9f, 0.9f, 0.92f, 1}, "%s",
                           line.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void drawConnectionNote(const Model& model, float pictureWidth) {
    if (model.connected) return;
    ImGui::SetNextWindowPos({0.5f * pictureWidth, 12}, ImGuiCond_Always, {0.5f, 0});
    ImGui::SetNextWindowBgAlpha(0.8f);
    ImGui::Begin("##connection", nullptr, kOverlay);
    ImGui::PushTextWrapPos(std::max(pictureWidth - 50, 80.0f));
    ImGui::TextColored({1, 0.6f, 0.4f, 1}, "%s", model.connection.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

}  // namespace caustream::view
