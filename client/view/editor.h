// From what a hand changed to what goes over the wire: gathers changes so that a fast mouse does not flood the server.
#pragma once
#include <cstdint>
#include <functional>

#include "client/connection/connection.h"
#include "client/view/model.h"

namespace caustream::view {

class Editor {
 public:
    Editor(connection::Connection& connection, Model& model) : connection_(connection), model_(model) {}

    void change(const protocol::Json& patch);  // no nulls; answered by the server
    void cameraMoved();                        // what the model says now, as input
    void lightMoved(const std::string& name);
    void lightChanged(const std::string& name);  // cone and intensity too
    void glassChanged(const std::string& material);
    void showScene(const protocol::SceneRef& scene);
    // The stream that suits a target: JPEG for pictures, half floats for the spectral map.
    void showTarget(const std::string& target);

    bool pending() const { return !changes_.empty() || !moves_.empty(); }
    // Sends what has gathered, not more often than every few milliseconds.
    void flush(double nowS);

 private:
    connection::Connection& connection_;
    Model& model_;
    protocol::Json changes_ = protocol::Json::object(), moves_ = protocol::Json::object();
    double lastFlushS_ = 0.0;
};

}  // namespace caustream::view
