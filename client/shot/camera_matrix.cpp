#include "client/shot/camera_matrix.h"

#include <array>
#include <cmath>
#include <numbers>

namespace caustream::shot {
namespace {

using protocol::Json;
using Vec = std::array<double, 3>;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec cross(const Vec& a, const Vec& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
Vec unit(const Vec& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

}  // namespace

Json cameraMatrix(const Json& resolved) {
    const Json& camera = resolved.at("camera");
    const Vec eye = camera.at("eye"), up = camera.at("up");
    const Vec forward = unit(minus(camera.at("target"), eye));
    Vec side = cross(forward, up);
    // As the server: `up` may be parallel to where it looks.
    if (dot(side, side) < 1e-8) side = cross(forward, std::abs(forward[1]) < 0.9 ? Vec{0, 1, 0} : Vec{1, 0, 0});
    const Vec x = unit(side), y = cross(x, forward);
    const auto row = [&](const Vec& axis, double sign) { return Json{sign * axis[0], sign * axis[1], sign * axis[2], -sign * dot(axis, eye)}; };

    const Json stream = resolved.value("stream", Json::object());
    const double width = stream.value("width", 512), height = stream.value("height", 512);
    const double focal = 0.5 * height / std::tan(0.5 * camera.at("fov_y_deg").get<double>() * std::numbers::pi / 180.0);
    return {{"world_to_camera", {row(x, 1.0), row(y, 1.0), row(forward, -1.0), {0.0, 0.0, 0.0, 1.0}}},
            {"fx", focal},
            {"fy", focal},
            {"cx", 0.5 * width},
            {"cy", 0.5 * height}};
}

}  // namespace caustream::shot
