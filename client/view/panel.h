// The panel at the window's right: everything that can be set, and what the server says of itself.
#pragma once
#include <optional>

#include "client/view/editor.h"
#include "client/view/model.h"

namespace caustream::view {

// What only this window knows.
struct Controls {
    bool panel = true;
    bool leftDragsLight = false;
    double resolution = 0.0;  // pictures' pixels per window pixel; 0: as the server's GPU suggests
    bool save = false;        // asked for; the window takes these back
    bool reconnect = false;
    std::optional<bool> record;
};

constexpr float kPanelWidth = 350.0f;  // at scale 1

// Draws it at the right edge of the display, `width` pixels wide. `convergence`: of the picture, if it has one and rests.
void drawPanel(Model& model, Controls& controls, Editor& editor, float width, const protocol::Convergence* convergence);
// Over the picture: messages, statuses; at its top whether there is a connection, while there is none.
void drawMessages(const Model& model, float pictureWidth);
void drawConnectionNote(const Model& model, float pictureWidth);

// A thin bar along the picture's lower edge, while it converges.
void drawProgress(const protocol::Convergence& convergence, float pictureWidth);

// The panel's last part: rates, stage times, plan, ledger.
void drawReadout(const Model& model);

}  // namespace caustream::view
