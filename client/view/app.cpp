#include "client/view/app.h"

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "client/connection/image_file.h"

namespace caustream::view {
namespace {

constexpr double kResizeRestS = 0.15;  // a window that is being dragged asks once it stands still
constexpr double kSavePatienceS = 30.0;
constexpr double kSoftwarePixels = 3e5;  // of a picture, when the server's GPU is a CPU
constexpr double kMostPixels = 8.2e6;

connection::Options connectionOptions(const Options& options) {
    connection::Options out{.address = options.address, .clientName = "caustream-view"};
    if (!options.token.empty()) out.token = options.token;
    out.caFile = options.caFile;
    out.follow = options.follow;
    out.maxInflight = 6;  // a long way holds more frames; on a short one the server keeps to two
    out.wake = Window::wake;
    return out;
}

bool isSoftware(const std::string& gpu) {
    return gpu.find("llvmpipe") != gpu.npos || gpu.find("softpipe") != gpu.npos || gpu.find("swrast") != gpu.npos;
}

}  // namespace

App::App(Options options)
    : options_(std::move(options)),
      window_("caustream", options_.width, options_.height),
      connection_(connectionOptions(options_)),
      editor_(connection_, model_) {
    window_.pressed = [this](int key) { handleKey(key); };
    window_.dropped = [this](const std::vector<std::string>& files) { showFile(files.front()); };
    model_.connection = "connecting to " + options_.address.text();
    model_.following = options_.follow;
    if (!options_.scene.empty()) editor_.showScene({protocol::SceneRef::Kind::Builtin, options_.scene});
    if (!options_.file.empty()) showFile(options_.file);
    connection_.startStream(true);
}

void App::run() {
    while (window_.open()) {
        // A frame or an event ends the wait at once; the rest keeps messages from outstaying their time.
        window_.waitEvents(editor_.pending() || wantedWidth_ != askedWidth_ || wantedHeight_ != askedHeight_ ? 0.01
                                                                                                             : 0.25);
        const double nowS = Window::seconds();
        takeNews(nowS);

        int width = 0, height = 0;
        window_.framebufferSize(width, height);
        const int panelWidth = controls_.panel ? static_cast<int>(kPanelWidth * window_.scale()) : 0;
        const Rectangle area{0, 0, std::max(width - panelWidth, 16), std::max(height, 16)};
        window_.beginFrame();
        handleMouse(picture_.fit(area));
        const protocol::Convergence* convergence = model_.convergence(nowS);
        if (controls_.panel) drawPanel(model_, controls_, editor_, static_cast<float>(panelWidth), convergence);
        drawMessages(model_, static_cast<float>(area.width));
        drawConnectionNote(model_, static_cast<float>(area.width));
        if (convergence) drawProgress(*convergence, static_cast<float>(area.width));
        ImGui::Render();
        obey(nowS);

        glViewport(0, 0, width, height);
        glClearColor(0.03f, 0.03f, 0.035f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        const std::uint64_t paintStartUs = connection::nowUs();
        if (frame_) picture_.set(frame_->image, frame_->header.viewWidth, frame_->header.viewHeight);
        picture_.draw(area);
        window_.endFrame();
        if (frame_) {
            connection_.acknowledge(*frame_, static_cast<std::uint32_t>(connection::nowUs() - paintStartUs));
            displayed(*frame_, nowS);
            frame_.reset();
        }
        askForSize(area.width, area.height, nowS);
        editor_.flush(nowS);
    }
}

void App::obey(double nowS) {
    if (std::exchange(controls_.save, false)) startSaving(nowS);
    if (std::exchange(controls_.reconnect, false)) connection_.reconnect();
    if (const auto on = std::exchange(controls_.record, std::nullopt)) {
        connection_.record(*on);
        if (!*on) model_.say(false, "recorded " + std::exchange(model_.recording, ""), nowS);
    }
}

void App::takeNews(double nowS) {
    for (auto& event : connection_.takeEvents()) {
        if (std::holds_alternative<protocol::Welcome>(event)) age_.reset();
        if (const auto* pong = std::get_if<connection::RoundTrip>(&event))
            age_.pong(pong->sentUs, pong->serverUs, pong->receivedUs);
        if (auto* state = std::get_if<protocol::StateMessage>(&event)) {
            // It was sent before what has moved since; and after a reconnection before the server knew all our changes.
            const protocol::Json document = connection_.document();
            if (!options_.follow.empty() ||
                document.value("scene", protocol::Json{}) == state->state.value("scene", protocol::Json{}))
                state->state.merge_patch(document);
            applySettings(state->state, nowS);
        }
        if (std::holds_alternative<protocol::ErrorMessage>(event)) savingSinceS_ = -1.0;
        const bool another = model_.take(event, nowS);
        if (another)
            window_.setTitle("caustream: " + model_.scene.name + (model_.following.empty() ? "" : ", followed"));
    }
    std::erase_if(model_.messages, [&](const Message& message) { return message.untilS < nowS; });
    if (auto frame = connection_.takeFrame()) frame_ = std::move(*frame);
    if (auto still = connection_.takeRequested()) {
        finishSaving(*still, nowS);
        frame_ = std::move(*still);
    }
    if (savingSinceS_ >= 0.0 && nowS - savingSinceS_ > kSavePatienceS) {
        savingSinceS_ = -1.0;
        model_.say(true, "the server sent no picture to save", nowS);
    }
    while (!frameTimesS_.empty() && nowS - frameTimesS_.front() > 1.0) frameTimesS_.pop_front();
    model_.frameRate = static_cast<double>(frameTimesS_.size());
}

// The command line's, once, to the scene that it asked for; `resolved` is that scene's document and takes them, too.
void App::applySettings(protocol::Json& resolved, double nowS) {
    const protocol::Json scene = resolved.value("scene", protocol::Json::array({"", ""}));
    const bool wanted = options_.file.empty() ? options_.scene.empty() || scene[1] == options_.scene : scene[0] == "asset";
    if (!wanted || options_.settings.empty()) return;
    const auto settings = std::exchange(options_.settings, {});
    const auto patch = protocol::settingsPatch(resolved, settings);
    const auto sent = patch ? connection_.update(*patch) : tl::make_unexpected(patch.error());
    if (!sent) return model_.say(true, "--set " + sent.error().field + ": " + sent.error().message, nowS);
    resolved.merge_patch(*patch);
}

void App::handleMouse(const Rectangle& shown) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool onPicture = !io.WantCaptureMouse && model_.haveScene;
    if (onPicture && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        const bool ofLight = io.KeyShift != controls_.leftDragsLight && model_.following.empty();
        drag_ = ofLight ? Drag::Light : Drag::Orbit;
        if (LightModel* light = model_.editedLight()) lightPath_ = model_.pathOf(*light);
    }
    if (onPicture && (ImGui::IsMouseClicked(ImGuiMouseButton_Right) || ImGui::IsMouseClicked(ImGuiMouseButton_Middle)))
        drag_ = Drag::Pan;
    const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left) || ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
                      ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    if (!held) drag_ = Drag::None;

    // The window's units, in which the mouse moves, may be coarser than the framebuffer's pixels.
    const double height = std::max(1.0, static_cast<double>(shown.height) / io.DisplayFramebufferScale.y);
    const glm::dvec2 move{io.MouseDelta.x / height, io.MouseDelta.y / height};
    if (drag_ != Drag::None && (move.x != 0.0 || move.y != 0.0)) {
        LightModel* light = model_.editedLight();
        if (drag_ == Drag::Orbit)
            orbit(model_.camera, move);
        else if (drag_ == Drag::Pan)
            pan(model_.camera, move);
        else if (light)
            dragLight(light->pose, lightPath_, model_.camera, move);
        if (drag_ == Drag::Light)
            editor_.lightMoved(model_.light);
        else
            editor_.cameraMoved();
    }
    if (onPicture && io.MouseWheel != 0.0f) {
        zoom(model_.camera, io.MouseWheel);
        editor_.cameraMoved();
    }
}

void App::handleKey(int key) {
    if (ImGui::GetIO().WantTextInput) return;
    if (key == GLFW_KEY_S) controls_.save = true;
    if (key == GLFW_KEY_L) controls_.leftDragsLight = !controls_.leftDragsLight;
    if (key == GLFW_KEY_TAB) controls_.panel = !controls_.panel;
    if (key == GLFW_KEY_ESCAPE) window_.close();
    if (key == GLFW_KEY_R && model_.haveScene) {
        model_.camera = model_.startCamera;
        editor_.cameraMoved();
    }
}

// The size to ask for: the picture's place in the window, smaller where the server would not keep up.
void App::askForSize(int width, int height, double nowS) {
    if (!model_.connected) return;
    const double area = static_cast<double>(width) * height;
    double scale = controls_.resolution;
    if (scale <= 0.0) scale = isSoftware(model_.welcome->gpu) ? std::min(1.0, std::sqrt(kSoftwarePixels / area)) : 1.0;
    scale = std::min(scale, std::sqrt(kMostPixels / area));
    const int w = std::clamp(static_cast<int>(width * scale) & ~1, 16, 4096),
              h = std::clamp(static_cast<int>(height * scale) & ~1, 16, 4096);
    if (w != wantedWidth_ || h != wantedHeight_) {
        wantedWidth_ = w;
        wantedHeight_ = h;
        wantedSinceS_ = nowS;
    }
    if (w == askedWidth_ && h == askedHeight_) return;
    if (askedWidth_ != 0 && nowS - wantedSinceS_ < kResizeRestS) return;
    askedWidth_ = w;
    askedHeight_ = h;
    editor_.change({{"stream", {{"width", w}, {"height", h}}}});
}

void App::showFile(const std::string& file) {
    if (!model_.following.empty())
        return model_.say(true, "another viewer's scene is followed: a file is opened there", Window::seconds());
    std::ifstream in(file, std::ios::binary);
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
    const double nowS = Window::seconds();
    if (bytes.empty()) return model_.say(true, "cannot read " + file, nowS);
    model_.fileName = std::filesystem::path(file).filename();
    model_.say(false, "sending " + model_.fileName, nowS);
    model_.upload = connection::UploadProgress{0, bytes.size()};
    connection_.showFile(std::move(bytes));
}

// A still, unpacked: the stream's JPEG is for moving.
void App::startSaving(double nowS) {
    if (savingSinceS_ >= 0.0) return;
    editor_.flush(nowS + 1.0);  // what was changed a moment ago belongs into the picture
    if (model_.stream.target != protocol::Target::Spectral) connection_.update({{"stream", {{"encoding", "raw"}}}});
    if (connection_.requestFrame(true, true) == 0) return model_.say(true, "no connection, nothing to save", nowS);
    savingSinceS_ = nowS;
}

void App::finishSaving(const connection::Frame& frame, double nowS) {
    savingSinceS_ = -1.0;
    if (model_.stream.target != protocol::Target::Spectral) connection_.update({{"stream", {{"encoding", "jpeg"}}}});
    std::filesystem::path file;
    do {
        file = std::filesystem::path(options_.saveFolder) /
               ("caustream-" + model_.scene.name.substr(0, 24) + "-" + std::to_string(++saved_) + ".png");
    } while (std::filesystem::exists(file));
    const auto written = connection::writePng(file, connection::toPicture(frame.image));
    model_.say(!written, written ? "saved " + file.string() : written.error(), nowS);
}

void App::displayed(const connection::Frame& frame, double nowS) {
    const auto& header = frame.header;
    frameTimesS_.push_back(nowS);
    model_.shown(header, nowS);
    model_.decodeMs = frame.decodeUs / 1000.0;
    if (const auto age = age_.painted(header, connection::nowUs())) model_.ageMs = *age;
    // Only of the first frame that shows an input: a later one would count the time since.
    if (header.inputSeq == shownInput_ || header.clientUs == 0) return;
    shownInput_ = header.inputSeq;
    model_.latencyMs =
        static_cast<double>(connection::nowUs() - std::min(header.clientUs, connection::nowUs())) / 1000.0;
}

}  // namespace caustream::view
