// The newest frame as a texture, and the one shader that shows it. The thread with the window's GL context only.
#pragma once
#include "client/connection/image.h"

namespace caustream::view {

struct Rectangle {  // pixels of the framebuffer, from its bottom left corner
    int x = 0, y = 0, width = 0, height = 0;
};

class Picture {
 public:
    Picture();
    ~Picture();
    Picture(const Picture&) = delete;

    // Linear images (the spectral map) are shown with their brightest texels white; U8 images as they are.
    // A picture that was sent smaller than its view has the view's size here.
    void set(const connection::Image& image, int viewWidth, int viewHeight);
    bool empty() const { return width_ == 0; }

    // As large as fits into `area`, in its middle.
    Rectangle fit(const Rectangle& area) const;
    void draw(const Rectangle& area) const;

 private:
    void upload(const connection::Image& image);

    unsigned texture_ = 0, program_ = 0, vertexArray_ = 0;
    int width_ = 0, height_ = 0, sample_ = 0;  // of the texture
    int viewWidth_ = 1, viewHeight_ = 1;
    float white_ = 0.0f;  // 0: bytes that are sRGB already
};

}  // namespace caustream::view
