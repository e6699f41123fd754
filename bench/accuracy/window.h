// Where maps are compared. A spectral map's size and view are its own business; an error is measured on cells of a window
// that is the same for all of them.
#pragma once
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "render/frame.h"
#include "scene/scene.h"

namespace caustream::bench {

// cells x cells squares, [row][column]: of a rectangle in the world that lies on a receiver, or of the directions from the
// light that some map's view spans.
class Window {
   public:
    // A rectangle from `origin` along the edges `u` (columns) and `v` (rows), m; values there are irradiance.
    static Window onPlane(const scene::Light& light, const glm::dvec3& origin, const glm::dvec3& u, const glm::dvec3& v, int cells);
    // The view of a frame's map (render::Frame::lightMatrix); values there are flux in a cell over the mean cell's extent.
    static Window ofView(const scene::Light& light, const glm::dmat4& worldToClip, int cells);

    int cells() const { return cells_; }
    bool ofPlane() const { return plane_; }
    // A point of the world at column x and row y, in cells from the corner: on the plane, or one metre from the light.
    glm::dvec3 at(double x, double y) const;
    // What a cell's concentration is multiplied by: the direct irradiance there (plane; unit intensity), the solid angle or
    // area seen from the light over the mean of all cells (view).
    const std::vector<double>& weights() const { return weights_; }
    // The plane's corner and edges; the view's matrix.
    const glm::dvec3& origin() const { return origin_; }
    const glm::dvec3& edgeU() const { return u_; }
    const glm::dvec3& edgeV() const { return v_; }
    const glm::dmat4& worldToClip() const { return toClip_; }

   private:
    bool plane_ = true, directional_ = false;
    int cells_ = 256;
    glm::dvec3 light_{0.0}, origin_{0.0}, u_{0.0}, v_{0.0};
    glm::dmat4 toClip_{1.0}, toWorld_{1.0};
    std::vector<double> weights_;
};

// A map's concentration over the cells, each the mean of at least `samples` x `samples` points, as many as the map has
// texels there or more (nearest texel; 0 outside the map), times its weight: [band][row][column].
// `frame` is a spectral map in F32.
std::vector<float> resample(const render::Frame& frame, const Window& window, int samples = 4);

// Concentration RGB ([3][...], linear BT.709, the light's colour divided out) -> CIE XYZ over the Y of the light.
void rgbToXyz(std::vector<float>& bands, const optics::Spectrum& light);
void xyzToRgb(std::vector<float>& bands, const optics::Spectrum& light);

}  // namespace caustream::bench
