// One viewer's picture at rest: each frame of an unchanged view adds a sample a pixel and a few wavelengths to a mean. It takes the
// place of the moving picture, and gives it back, without a jump in brightness.
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <list>
#include <string>

#include "gl/names.h"
#include "gl/shader_library.h"
#include "render/frame.h"
#include "render/passes/mean_luminance.h"
#include "render/passes/picture_mean.h"

namespace caustream::render {

// What a picture depends on, byte by byte, but for what moving pictures and those at rest are traced with.
std::string pictureKey(const Request& request);

class ProgressivePicture {
   public:
    struct Sample {
        glm::vec2 shift{0.0f};             // of the pixels' middles, -0.5..0.5 pixels
        float rotation = 0.0f;             // of the wavelengths, 0..1
    };
    struct Shown {                         // for `present`
        const gl::Texture* image = nullptr;
        const gl::Texture* before = nullptr;   // mixed with it, after the tone curve; may be none, or of another size
        float share = 1.0f;                // of `image`
        float gain = 1.0f;                 // of the exposure
    };

    explicit ProgressivePicture(gl::ShaderLibrary& shaders) : mean_(shaders), luminance_(shaders) {}

    // A frame in motion was drawn into `color`.
    void move(const std::string& key, const gl::Texture& color);
    // Another frame was drawn into it, whose like is not shown in a row: a still, a pass.
    void interrupt() { moving_ = nullptr; }
    // At rest: before `color` is drawn, which may still hold the last picture in motion, of any size, and is taken if it does.
    // `weight` > 0: how good the picture to be drawn is; less than before begins anew. `wanted`: samples a pixel of a
    // picture that is done.
    Sample begin(const std::string& key, double weight, int wanted, gl::Texture& color);
    // After it was drawn with that sample. `scale` as present shows it.
    void add(const gl::Texture& color, float scale);

    // What the last of these calls left to be shown; `exact`: as it is, without passage from one to the other.
    Shown shown(bool exact) const;
    int samples() const;                   // in the picture at rest; 0 in motion
    const gl::Texture* mean() const;       // of them; nullptr where there are none
    double progress() const;               // of the picture at rest, 0..1; 1: more frames would not change it

   private:
    struct Picture {
        std::string key;
        gl::Texture mean, before;
        int samples = 0, wanted = 1;
        double newest = 0.0, weight = 0.0; // of the newest sample; of all
        bool fades = false;                // there is a picture before it
        double share = 1.0;                // of the mean in what is shown
        double luminance = 0.0;            // of what is shown, without the gain
        float scale = 1.0f;                // that was measured at
    };
    void fade(Picture& picture, float scale);
    double gainAfter(const Picture& picture);
    void ease();

    PictureMean mean_;
    MeanLuminance luminance_;
    std::list<Picture> pictures_;          // newest first
    const gl::Texture* moving_ = nullptr;  // the frame in motion, when the last one was
    std::string movingKey_;
    bool atRest_ = false;
    double gain_ = 1.0;
};

}  // namespace caustream::render
