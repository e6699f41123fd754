// The window's loop: events in, the newest frame on the screen, changes out.
#pragma once
#include <deque>
#include <optional>

#include "client/connection/connection.h"
#include "client/connection/frame_age.h"
#include "client/view/editor.h"
#include "client/view/model.h"
#include "client/view/options.h"
#include "client/view/panel.h"
#include "client/view/picture.h"
#include "client/view/window.h"

namespace caustream::view {

class App {
 public:
    explicit App(Options options);
    void run();

 private:
    enum class Drag { None, Orbit, Pan, Light };

    void takeNews(double nowS);
    void obey(double nowS);  // what the panel asked for
    void applySettings(protocol::Json& resolved, double nowS);
    void handleMouse(const Rectangle& shown);
    void handleKey(int key);
    void askForSize(int width, int height, double nowS);
    void showFile(const std::string& file);
    void startSaving(double nowS);
    void finishSaving(const connection::Frame& frame, double nowS);
    void displayed(const connection::Frame& frame, double nowS);

    Options options_;
    Window window_;
    Picture picture_;
    connection::Connection connection_;
    Model model_;
    Controls controls_;
    Editor editor_;

    Drag drag_ = Drag::None;
    LightPath lightPath_;                     // of the light that is dragged
    std::optional<connection::Frame> frame_;  // taken, not yet on the screen
    int askedWidth_ = 0, askedHeight_ = 0, wantedWidth_ = 0, wantedHeight_ = 0;
    double wantedSinceS_ = 0.0, savingSinceS_ = -1.0;
    int saved_ = 0;
    std::uint32_t shownInput_ = 0;
    connection::FrameAge age_;
    std::deque<double> frameTimesS_;  // of the last second
};

}  // namespace caustream::view
