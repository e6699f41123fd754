#include "client/view/theme.h"

#include <imgui.h>

#include <filesystem>

namespace caustream::view {
namespace {

constexpr float kFontPixels = 15.0f;
constexpr const char* kFonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
};

ImVec4 grey(float level, float alpha = 1.0f) {
    return {level, level, level + 0.015f, alpha};
}

}  // namespace

void applyTheme(float scale) {
    ImGuiIO& io = ImGui::GetIO();
    for (const char* font : kFonts) {
        std::error_code ignored;
        if (!std::filesystem::exists(font, ignored)) continue;
        if (io.Fonts->AddFontFromFileTTF(font, kFontPixels * scale)) break;
    }
    if (io.Fonts->Fonts.empty()) {
        io.Fonts->AddFontDefault();
        io.FontGlobalScale = scale;
    }

    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0.0f;
    style.WindowBorderSize = 0.0f;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4.0f;
    style.WindowPadding = {14, 12};
    style.FramePadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {8, 4};
    style.ScrollbarSize = 12.0f;
    style.GrabMinSize = 12.0f;
    style.ScaleAllSizes(scale);

    const ImVec4 accent{0.38f, 0.67f, 0.98f, 1.0f}, accentDim{0.22f, 0.42f, 0.66f, 1.0f};
    ImVec4* colors = style.Colors;
    colors[ImGuiCol_Text] = grey(0.92f);
    colors[ImGuiCol_TextDisabled] = grey(0.56f);
    colors[ImGuiCol_WindowBg] = grey(0.085f);
    colors[ImGuiCol_PopupBg] = grey(0.11f);
    colors[ImGuiCol_FrameBg] = grey(0.155f);
    colors[ImGuiCol_FrameBgHovered] = grey(0.20f);
    colors[ImGuiCol_FrameBgActive] = grey(0.23f);
    colors[ImGuiCol_Header] = grey(0.13f);
    colors[ImGuiCol_HeaderHovered] = grey(0.18f);
    colors[ImGuiCol_HeaderActive] = grey(0.21f);
    colors[ImGuiCol_Button] = grey(0.19f);
    colors[ImGuiCol_ButtonHovered] = accentDim;
    colors[ImGuiCol_ButtonActive] = accent;
    colors[ImGuiCol_SliderGrab] = accentDim;
    colors[ImGuiCol_SliderGrabActive] = colors[ImGuiCol_CheckMark] = accent;
    colors[ImGuiCol_PlotHistogram] = accentDim;
    colors[ImGuiCol_Separator] = grey(0.19f);
    colors[ImGuiCol_ScrollbarBg] = grey(0.085f);
    colors[ImGuiCol_ScrollbarGrab] = grey(0.20f);
}

}  // namespace caustream::view
